//! An elastic half-space represents a body that is large compared with its contacts: its surface
//! deforms under loads by the closed forms of Boussinesq, Cerruti and Flamant, instantaneously and
//! without inertia.
//!
//! The displacement of its cells is u = F f, f the forces of contacts on them over the step, so
//! that with q = u at the time of detection in the step
//!
//! ```text
//! v_free = -q/(h theta)        v+ = v_free + F p/(h^2 theta)        q + h theta v+ = F p/h
//! ```
//!
//! In addition the half-space moves with its distant holder, with a mass where it moves under
//! forces. Where the surface rolls through the contact, the cells are fixed in space and material
//! passes them: along the surface a step begins with u(x - V h), the displacement of the material
//! that has arrived there, from the forces of the previous step. Along the normal it begins with
//! u(x), since a gap belongs to a position. The work of normal forces on passing material, f_n
//! (u_n(x) - u_n(x - V h)), is done by the drive of the rolling.
//!
//! Sources: K. L. Johnson, "Contact Mechanics" (1985), chapters 2, 3 and 8; J. J. Kalker,
//! "Three-dimensional elastic bodies in rolling contact" (1990), chapter 4.

mod dynamics;
mod error;
mod grid;
pub mod influence;
mod kernel;
mod profile;
mod transforms;

pub use error::HalfSpaceError;
pub use grid::CellGrid;
pub use kernel::{Kernel, Reach};
pub use profile::Profile;
pub use transforms::{Complex64, Transforms, padded_length};

use crate::material::Elasticity;
use crate::touching_surface::open_surface;
use fretwork_core::bodies::{
    Compliance, Contactor, ContactorShape, Dof, Nodes, SystemStep, TimeFunction,
};
use fretwork_core::geometry::space::{MatrixLike, Space, VectorLike};
use std::sync::Arc;

/// Largest number of cells: each cell that touches by its point is a separate body.
const MAX_CELLS: usize = 1_000_000;

/// Largest number of coordinates of cells whose compliance is kept, as far as they were touched:
/// 128 MB.
const MAX_KEPT: usize = 4_000;

/// Side of its surface that a half-space fills.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FilledSide {
    /// The space below: its surface faces up, along the last axis.
    Below,
    /// The space above: its surface faces down.
    Above,
}

/// How the cells of a half-space touch. Where two half-spaces meet one must touch by its points and
/// the other by its surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cells {
    /// The middle of each cell touches balls, pieces and surfaces.
    Points,
    /// The surface between the middles of cells touches grains, points, and corners and edges of
    /// pieces.
    Surface,
}

/// Parameters of a half-space.
#[derive(Clone, Debug)]
pub struct HalfSpaceSpec<'a> {
    /// Name in messages.
    pub name: &'a str,
    /// Material; the density has no effect.
    pub material: Elasticity,
    /// Side of the surface that is solid.
    pub fills: FilledSide,
    /// Position of the origin of the plane and of the grid (m).
    pub position: [f64; 3],
    /// Cells that may be loaded.
    pub grid: CellGrid,
    /// Extent.
    pub reach: Reach,
    /// Whether the surface is periodic along x with the extent of its cells (2D), in a scene with
    /// that period.
    pub repeats: bool,
    /// Shape of the surface.
    pub profile: Profile,
    /// Mass that moves with it (kg; kg/m in 2D); zero for none.
    pub mass: f64,
    /// Drive along each axis; a force (N; N/m in 2D) acts on the whole.
    pub axes: &'a [Dof],
    /// Velocity of the material along x through the cells (m/s).
    pub rolling: Option<TimeFunction>,
    /// How the cells touch.
    pub touching: Cells,
    /// Index of the material for interface laws.
    pub surface_material: u16,
}

/// Name of the part of a half-space that is held.
pub const HOLDER: &str = "holder";

/// Constant data, shared by copies.
#[derive(Debug)]
struct Fixed<S: Space> {
    name: String,
    material: Elasticity,
    grid: CellGrid,
    reach: Reach,
    kernel: Kernel,
    /// Positions of the cells without load (m).
    places: Vec<S::Vector>,
    /// Sign of the outward normal along the last axis.
    outward: f64,
    mass: f64,
    rolling: Option<TimeFunction>,
    touching: Cells,
    surface_material: u16,
    repeats: bool,
    /// Cells in the order of the vertices of the surface, and its facets. Where the surface is
    /// periodic, an index past the last cell represents the image of the first.
    vertices: Vec<u32>,
    facets: Vec<[u32; 3]>,
}

/// An elastic half-space.
///
/// Coordinates are the displacements of the cells along each axis, those of the holder, and the
/// distance rolled.
#[derive(Clone, Debug)]
pub struct HalfSpace<S: Space> {
    fixed: Arc<Fixed<S>>,
    /// Current drive of the holder along each axis.
    axes: Vec<Dof>,
    displacement: Vec<f64>,
    velocity: Vec<f64>,
    /// Forces on the cells and on the whole, by coordinate (N; N/m in 2D), in the last step.
    force: Vec<f64>,
    /// Displacements and velocities at the start of the step.
    start: [Vec<f64>; 2],
    /// Strain energy at the start of the step, and kinetic energy due to a jump of imposed
    /// velocities there (J).
    stored: f64,
    jump: f64,
    step: Option<SystemStep<S>>,
    /// Kernel of material that has arrived from a distance behind, and that distance (m).
    behind: Option<Arc<(f64, Kernel)>>,
    /// Displacements of the material that has arrived at each cell of a rolling surface (m).
    passing: Vec<f64>,
    /// Compliance of the cells for the length of the step, where there are not too many.
    kept: Option<Arc<Compliance<S>>>,
}

impl<S: Space> HalfSpace<S> {
    /// A half-space at rest and without load.
    ///
    /// # Errors
    /// A dimension, a material or a setting is invalid; [`HalfSpaceError`] lists the reasons.
    pub fn new(spec: HalfSpaceSpec) -> Result<Self, HalfSpaceError> {
        check::<S>(&spec)?;
        let HalfSpaceSpec { grid, material, .. } = spec;
        let up = S::D - 1;
        let outward = match spec.fills {
            FilledSide::Below => 1.0,
            FilledSide::Above => -1.0,
        };
        let place = |cell: usize| {
            let middle = grid.middle(cell);
            let mut at = S::Vector::from_slice(&spec.position);
            for (axis, x) in middle.iter().enumerate().take(up) {
                at[axis] += x;
            }
            at[up] += outward * spec.profile.height(cell, middle);
            at
        };
        let places: Vec<S::Vector> = (0..grid.len()).map(place).collect();
        if let Some(bad) = places.iter().find(|p| (0..S::D).any(|k| !p[k].is_finite())) {
            return Err(HalfSpaceError::Height(bad[0]));
        }
        let images = u32::from(spec.repeats);
        let mut vertices: Vec<u32> = (0..grid.len() as u32 + images).collect();
        let mut facets = grid.facets(S::D);
        if spec.fills == FilledSide::Above {
            match S::D {
                2 => vertices.reverse(),
                _ => facets.iter_mut().for_each(|f| f.swap(1, 2)),
            }
        }
        let kernel = Kernel::new(&grid, &material, spec.reach, S::D, 0.0);
        let fixed = Fixed {
            name: spec.name.to_owned(),
            material,
            grid,
            reach: spec.reach,
            kernel,
            places,
            outward,
            mass: spec.mass,
            rolling: spec.rolling,
            repeats: spec.repeats,
            touching: spec.touching,
            surface_material: spec.surface_material,
            vertices,
            facets,
        };
        let total = (grid.len() + 1) * S::D + 1;
        let zeros = || vec![0.0; total];
        let body = Self {
            fixed: Arc::new(fixed),
            axes: spec.axes.to_vec(),
            displacement: zeros(),
            velocity: zeros(),
            force: zeros(),
            start: [zeros(), zeros()],
            stored: 0.0,
            jump: 0.0,
            step: None,
            behind: None,
            passing: Vec::new(),
            kept: None,
        };
        if spec.touching == Cells::Surface {
            let vertices =
                fretwork_core::bodies::DynamicalSystem::surface_vertices(&body, &body.whole());
            open_surface::<S>(vertices, &body.fixed.facets, body.period())
                .map_err(HalfSpaceError::NoSurface)?;
        }
        Ok(body)
    }

    /// Returns the length of the period of its surface along x (m).
    fn period(&self) -> Option<f64> {
        self.fixed.repeats.then(|| self.fixed.grid.extent()[0])
    }

    /// The contactor of a surface.
    fn whole(&self) -> Contactor {
        let grid = &self.fixed.grid;
        Contactor {
            nodes: Nodes::one(self.origin()),
            radius: 0.5 * grid.size[0],
            shape: ContactorShape::Surface,
            material: self.fixed.surface_material,
        }
    }

    /// Returns the cell that carries the frame of the surface.
    fn origin(&self) -> u32 {
        (self.fixed.grid.len() / 2) as u32
    }

    /// Returns the index of the first coordinate of the holder.
    fn held(&self) -> usize {
        self.fixed.grid.len() * S::D
    }

    /// Returns the index of the distance rolled.
    fn rolled(&self) -> usize {
        self.held() + S::D
    }

    /// Whether the holder moves under forces along an axis.
    fn yields(&self, axis: usize) -> bool {
        self.axes[axis].yields()
    }

    /// Returns the sign of a local axis in the world: the last is the inward normal.
    fn sign(&self, axis: usize) -> f64 {
        if axis + 1 == S::D {
            -self.fixed.outward
        } else {
            1.0
        }
    }

    /// Returns the displacements of all cells due to forces on them, both by coordinate.
    fn displacements(&self, kernel: &Kernel, forces: &[f64]) -> Vec<f64> {
        let d = S::D;
        let cells = self.fixed.grid.len();
        let along = |axis: usize| -> Vec<f64> {
            let sign = self.sign(axis);
            (0..cells).map(|c| sign * forces[c * d + axis]).collect()
        };
        let local: Vec<Vec<f64>> = (0..d).map(along).collect();
        let found = kernel.displacements(&local);
        (0..cells * d)
            .map(|k| self.sign(k % d) * found[k % d][k / d])
            .collect()
    }

    /// Returns blocks of the compliance of two cells in the last step (1/kg), with the inertia of
    /// the holder; zero before the first step.
    fn blocks(&self) -> impl Fn(u32, u32) -> S::Matrix {
        let scale = self.step.map(|s| 1.0 / (s.h * s.h * s.theta));
        let mut inertia = S::Vector::zero();
        for axis in (0..S::D).filter(|a| self.yields(*a)) {
            inertia[axis] = 1.0 / self.fixed.mass;
        }
        let mut units = [S::Vector::zero(); 3];
        for (axis, unit) in units.iter_mut().enumerate().take(S::D) {
            unit[axis] = 1.0;
        }
        move |a, b| {
            let Some(scale) = scale else {
                return S::Matrix::uniform(0.0);
            };
            let influence = self.fixed.kernel.between(a as usize, b as usize);
            let mut block = S::Matrix::diagonal(&inertia);
            for j in 0..S::D {
                let mut column = S::Vector::zero();
                for i in 0..S::D {
                    column[i] = scale * self.sign(i) * self.sign(j) * influence[i][j];
                }
                block = block + S::Matrix::dyad(&column, &units[j]);
            }
            block
        }
    }

    /// Returns the elastic displacement of a cell (m).
    fn elastic(&self, cell: u32) -> S::Vector {
        self.entries(&self.displacement, cell as usize)
    }

    /// Returns the entries of a vector of coordinates at a cell; at the holder where the cell is
    /// one past the last.
    fn entries(&self, values: &[f64], cell: usize) -> S::Vector {
        let mut out = S::Vector::zero();
        for axis in 0..S::D {
            out[axis] = values[cell * S::D + axis];
        }
        out
    }

    /// Returns the force of the holder along an axis over the last step (N; N/m in 2D).
    fn reaction(&self, axis: usize, step: &SystemStep<S>) -> f64 {
        let c = self.held() + axis;
        let drive = self.axes[axis].over(step.time, step.h);
        if self.yields(axis) {
            return drive.force(step.time + step.theta * step.h);
        }
        let change = self.velocity[c] - self.start[1][c];
        self.fixed.mass * (change / step.h - step.gravity[axis]) - self.force[c]
    }

    /// Returns v_theta of a coordinate (m/s).
    fn average(&self, coordinate: usize, theta: f64) -> f64 {
        let (v, w) = (self.start[1][coordinate], self.velocity[coordinate]);
        v + theta * (w - v)
    }

    /// Returns the velocities imposed along the holder's axes and by rolling, at the start and the
    /// end of a step.
    fn imposed(&self, step: &SystemStep<S>) -> Vec<(usize, [f64; 2])> {
        let SystemStep { time, h, theta, .. } = *step;
        let held = self.held();
        let of = |(axis, dof): (usize, &Dof)| {
            let speeds = dof.over(time, h).speeds(time, h, theta)?;
            Some((held + axis, [speeds.start, speeds.end]))
        };
        let axes = self.axes.iter().enumerate().filter_map(of);
        let rolling = self.fixed.rolling.as_ref().map(|f| {
            let mean = f.mean(time, h);
            (self.rolled(), [mean, mean])
        });
        axes.chain(rolling).collect()
    }

    /// Where the surface rolls, gives each cell the displacement along the surface of the material
    /// that is there now: before, it was a distance (m) behind.
    fn roll(&mut self, distance: f64) {
        if self.behind.as_ref().is_none_or(|b| b.0 != distance) {
            let Fixed {
                grid,
                material,
                reach,
                ..
            } = &*self.fixed;
            let kernel = Kernel::new(grid, material, *reach, S::D, -distance);
            self.behind = Some(Arc::new((distance, kernel)));
        }
        if let Some(behind) = &self.behind {
            self.passing = self.displacements(&behind.1, &self.force);
        }
        for (k, u) in self.passing.iter().enumerate() {
            if k % S::D + 1 < S::D {
                self.displacement[k] = *u;
            }
        }
    }
}

fn check<S: Space>(spec: &HalfSpaceSpec) -> Result<(), HalfSpaceError> {
    spec.material.check()?;
    let grid = &spec.grid;
    let sides = S::D - 1;
    for k in 0..sides {
        if !(grid.size[k] > 0.0 && grid.size[k].is_finite()) {
            return Err(HalfSpaceError::Size(grid.size[k]));
        }
        if grid.cells[k] < 2 {
            return Err(HalfSpaceError::Few(["x", "y"][k], grid.cells[k]));
        }
    }
    if grid.cells[..sides].iter().fold(1.0, |n, c| n * *c as f64) > MAX_CELLS as f64 {
        return Err(HalfSpaceError::Many(MAX_CELLS));
    }
    let widest = grid.extent()[..sides]
        .iter()
        .fold(0.0, |a: f64, b| a.max(*b));
    match spec.reach {
        // Below this depth the compliance of a plane half-space is not positive.
        Reach::Infinite(depth) if S::D == 2 && !(depth >= widest && depth.is_finite()) => {
            return Err(HalfSpaceError::Depth(depth, widest));
        }
        Reach::Periodic(depth) if !(depth > 0.0 && depth.is_finite()) => {
            return Err(HalfSpaceError::Depth(depth, 0.0));
        }
        _ => {}
    }
    if !(spec.mass >= 0.0 && spec.mass.is_finite()) {
        return Err(HalfSpaceError::Mass(spec.mass));
    }
    for (axis, dof) in spec.axes.iter().enumerate() {
        if dof.yields() && dof.imposes() {
            return Err(HalfSpaceError::Changes(["x", "y", "z"][axis]));
        }
        if dof.yields() && spec.mass == 0.0 {
            return Err(HalfSpaceError::NoMass(["x", "y", "z"][axis]));
        }
    }
    Ok(())
}
