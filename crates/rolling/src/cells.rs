//! Running conditions of a fretting contact by cells: bodies of any undeformed distance under a law
//! of friction. Where friction is that of the pressure alone, each cycle is from its first loading
//! by Masing's rule; else it is the first cycle after loading, step by step.

use crate::fields::Vector;
use crate::fretting::{Amplitude, Fretting, FrettingError, Loop};
use crate::friction::{Cells, Friction};
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
    /// Law of friction.
    pub law: &'a dyn Friction,
    /// Direction of the motion, of length 1.
    pub along: Vector,
    /// Mean speed of the stroke (m/s).
    pub speed: f64,
    /// Steps of a quarter of a cycle, where cycles are followed step by step.
    pub quarter: usize,
}

/// Two bodies under a load.
pub struct Contact<'a> {
    /// Load (N).
    pub load: f64,
    /// Both surfaces.
    pub surfaces: Surfaces,
    /// Pressure of each cell (Pa).
    pub pressure: Vec<f64>,
    law: &'a dyn Friction,
    along: Vector,
    speed: f64,
    quarter: usize,
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
    pub fn contact(&self, load: f64) -> Result<Contact<'_>, RunningError> {
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
            law: self.law,
            along: self.along,
            speed: self.speed,
            quarter: self.quarter,
            scale: 0.0,
        };
        let force = contact.limit();
        check_friction(force / load)?;
        contact.scale = force * contact.frets(0.0).compliance()[1];
        Ok(contact)
    }
}

impl Contact<'_> {
    /// Returns the contact as one that frets, a quarter of a cycle in one step by Masing's rule, or
    /// step by step.
    pub fn frets(&self, displacement: f64) -> Fretting<'_> {
        let steps = if self.law.constant() { 1 } else { self.quarter };
        let time = match displacement > 0.0 {
            true => displacement / (self.speed * steps as f64),
            false => 1.0,
        };
        Fretting {
            surfaces: &self.surfaces,
            pressure: &self.pressure,
            law: self.law,
            along: self.along,
            step: time,
        }
    }

    /// Returns the cycle of an amplitude of displacement (m), with the tractions of its ends at
    /// least.
    ///
    /// # Errors
    /// The cycle has no solution.
    pub fn cycle(&self, displacement: f64) -> Result<Loop, RunningError> {
        let (frets, amplitude) = (
            self.frets(displacement),
            Amplitude::Displacement(displacement),
        );
        let found = match self.law.constant() {
            true => frets.ruled(amplitude, 1),
            false => frets.cycles(amplitude, self.quarter, 1),
        };
        found.map_err(self.failed(displacement))
    }

    /// Returns the force of new contacts that slide slowly (N).
    fn limit(&self) -> f64 {
        self.law.renew(self.pressure.len());
        let cells = Cells {
            grid: &self.surfaces.grid,
            pressure: &self.pressure,
            speed: self.speed,
        };
        let bounds = self.law.bounds(cells, &vec![[0.0; 2]; self.pressure.len()]);
        bounds.iter().map(|b| b.traction).sum::<f64>() * self.surfaces.grid.area(3)
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

impl Loaded for Contact<'_> {
    fn conditions(&self, displacement: f64) -> Result<Conditions, RunningError> {
        let cycle = self.cycle(displacement)?;
        let area = self.surfaces.grid.area(3);
        let most = |values: &[f64]| values.iter().copied().fold(0.0, f64::max);
        Ok(Conditions {
            load: self.load,
            amplitude: cycle.amplitude,
            cover: displacement / self.half_width,
            stuck: cycle.stuck,
            energy: cycle.energy,
            rubbed: cycle.rubbed.iter().sum::<f64>() * area,
            most_rubbed: most(&cycle.rubbed),
            slip_ratio: cycle.slip_ratio(),
            worn: [cycle.worn.iter().sum::<f64>() * area, most(&cycle.worn)],
        })
    }

    fn slip_ratio(&self, of: &Conditions) -> Result<f64, RunningError> {
        if !self.law.constant() {
            return Ok(of.slip_ratio);
        }
        // By Masing's rule the force has vanished where a first loading has half of the amplitude.
        let [displacement, force] = of.amplitude;
        let half = self.frets(displacement).displacement_under(0.5 * force);
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
pub fn half_width(grid: &CellGrid, pressure: &[f64], along: Vector) -> f64 {
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
