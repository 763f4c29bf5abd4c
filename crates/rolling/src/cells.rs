//! Running conditions of a fretting contact by cells: bodies of any undeformed distance under
//! Coulomb's friction, each cycle from its first loading by Masing's rule.

use crate::fields::Vector;
use crate::fretting::{Fretting, FrettingError};
use crate::friction::Coulomb;
use crate::normal::normal;
use crate::running::{Conditions, Contacts, Loaded, RunningError, check_friction};
use crate::surfaces::Surfaces;
use fretwork_elastic::Elasticity;
use fretwork_elastic::half_space::CellGrid;

/// Two bodies over cells.
#[derive(Clone, Copy)]
pub struct ByCells<'a> {
    /// Elasticity of both bodies.
    pub bodies: [Elasticity; 2],
    /// Thickness over shear modulus of an elastic layer between them (m/Pa).
    pub layer: f64,
    /// Undeformed distance of the bodies at a place (m).
    pub distance: &'a dyn Fn([f64; 2]) -> f64,
    /// Cells for a load (N), which hold the patch.
    pub grid: &'a dyn Fn(f64) -> CellGrid,
    /// Coefficient of friction.
    pub friction: f64,
    /// Direction of the motion, of length 1.
    pub along: Vector,
}

/// Two bodies under a load.
#[derive(Debug)]
pub struct Contact {
    /// Load (N).
    pub load: f64,
    /// Both surfaces.
    pub surfaces: Surfaces,
    /// Pressure of each cell (Pa).
    pub pressure: Vec<f64>,
    law: Coulomb,
    along: Vector,
    scale: f64,
    half_width: f64,
}

impl Contacts for ByCells<'_> {
    fn under(&self, load: f64) -> Result<Box<dyn Loaded + '_>, RunningError> {
        Ok(Box::new(self.contact(load)?))
    }
}

impl ByCells<'_> {
    /// Returns the contact under a load (N).
    ///
    /// # Errors
    /// The load is not held, or the coefficient of friction is not positive.
    pub fn contact(&self, load: f64) -> Result<Contact, RunningError> {
        check_friction(self.friction)?;
        let grid = (self.grid)(load);
        let surfaces = Surfaces::new(grid, self.bodies, self.layer);
        let places = (0..grid.len()).map(|cell| grid.middle(cell));
        let distance: Vec<f64> = places.map(|at| (self.distance)(at)).collect();
        let found = normal(&surfaces, &distance, load, None)
            .map_err(|source| RunningError::Normal { load, source })?;
        let mut contact = Contact {
            load,
            half_width: half_width(&grid, &found.pressure, self.along),
            surfaces,
            pressure: found.pressure,
            law: Coulomb(self.friction),
            along: self.along,
            scale: 0.0,
        };
        contact.scale = self.friction * load * contact.frets().compliance()[1];
        Ok(contact)
    }
}

impl Contact {
    /// Returns the contact as one that frets.
    pub fn frets(&self) -> Fretting<'_> {
        Fretting {
            surfaces: &self.surfaces,
            pressure: &self.pressure,
            law: &self.law,
            along: self.along,
            step: 1.0,
        }
    }

    fn failed(&self, displacement: f64) -> impl Fn(FrettingError) -> RunningError {
        let load = self.load;
        move |source| RunningError::Fretting {
            load,
            displacement,
            source,
        }
    }
}

impl Loaded for Contact {
    fn conditions(&self, displacement: f64) -> Result<Conditions, RunningError> {
        let loaded = self.frets().loaded(displacement);
        let (found, force) = loaded.map_err(self.failed(displacement))?;
        let mut out = Conditions {
            load: self.load,
            amplitude: [displacement, force],
            cover: displacement / self.half_width,
            ..Conditions::default()
        };
        let area = self.surfaces.grid.area(3);
        let (mut touching, mut sticking) = (0.0, 0.0);
        for (cell, p) in self.pressure.iter().enumerate().filter(|(_, p)| **p > 0.0) {
            touching += 1.0;
            if found.sticks[cell] {
                sticking += 1.0;
                continue;
            }
            // A cycle slips four times as far as the first loading.
            let way = 4.0 * found.slip[cell][0].hypot(found.slip[cell][1]);
            out.energy += way * found.bound[cell] * area;
            out.rubbed += way * p * area;
            out.most_rubbed = out.most_rubbed.max(way * p);
        }
        out.stuck = sticking / touching;
        Ok(out)
    }

    fn slip_ratio(&self, of: &Conditions) -> Result<f64, RunningError> {
        let [displacement, force] = of.amplitude;
        let half = self.frets().displacement_under(0.5 * force);
        let half = half.map_err(self.failed(displacement))?;
        Ok((1.0 - 2.0 * half / displacement).max(0.0))
    }

    fn scale(&self) -> f64 {
        self.scale
    }

    fn half_width(&self) -> f64 {
        self.half_width
    }
}

/// Returns half of the extent of the cells with pressure along a direction (m).
fn half_width(grid: &CellGrid, pressure: &[f64], along: Vector) -> f64 {
    let touching = (0..grid.len()).filter(|cell| pressure[*cell] > 0.0);
    let (mut low, mut high) = (f64::MAX, f64::MIN);
    for cell in touching {
        let [x, y] = grid.middle(cell);
        let at = x * along[0] + y * along[1];
        (low, high) = (low.min(at), high.max(at));
    }
    let cell = (grid.size[0] * along[0]).hypot(grid.size[1] * along[1]);
    0.5 * (high - low + cell)
}
