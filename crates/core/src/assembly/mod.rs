//! Bodies and shapes that become a simulation, described without their dimension.
//!
//! A scene is described by vectors of three components and angular velocities about the three axes.
//! In 2D the third component of vectors is zero, and angular velocities are about the third axis
//! alone. The trait [`Assembly`] hides the dimension in which the scene is put together.

mod checks;
mod parts;
mod recorded;
mod system;
mod union;

pub use checks::Overcrowding;
pub use parts::{AnySceneParts, SceneParts};
pub use recorded::RecordedPiece;
pub use system::AnySystem;
pub use union::AnyUnion;

use crate::bodies::Driven;
use crate::contact::detect::LawTable;
use crate::geometry::any_shape::{AnyPart, AnySurface};
use crate::geometry::periodic::Periodic;
use crate::geometry::space::{Dim2, Dim3};
use crate::laws::Interface;
use crate::view::AnySimulation;
use std::fmt::Debug;

/// Position and motion of a body at the start.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct InitialState {
    /// Position (m).
    pub position: [f64; 3],
    /// Orientation as in [`crate::view::BodyMotion`]; `None` if aligned with the axes of the case.
    pub rotation: Option<[f64; 4]>,
    /// Velocity (m/s); in 2D only the components along x and y are used.
    pub velocity: [f64; 3],
    /// Angular velocity (rad/s); in 2D only the component about the third axis is used.
    pub spin: [f64; 3],
}

/// Index of a material and its density (kg/m^3).
pub type MaterialDensity = (u16, f64);

/// Moments of inertia of a first body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Inertia {
    /// Equal about all axes (kg m^2; kg m in 2D).
    Uniform(f64),
    /// Mean over the axes of the moments of inertia of the shapes, at a density (kg/m^3).
    Mean(f64),
    /// Moments of inertia of the shapes, at a density (kg/m^3).
    OfShapes(f64),
}

/// Mass and inertia of a body of several shapes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MassProperties {
    /// A grain: mass and inertia of the shapes, at a density (kg/m^3).
    Grain(f64),
    /// A first body: mass (kg; kg/m in 2D) and moments of inertia.
    First(f64, Inertia),
}

/// A body of one convex part.
#[derive(Clone, Debug)]
pub struct ConvexBody {
    /// The part.
    pub part: AnyPart,
    /// Start of the body; the position is that of the centre of mass.
    pub start: InitialState,
    /// Volume (m^3; m^2 in 2D).
    pub volume: f64,
    /// Moment of inertia about the centre of mass at unit density (m^5; m^4 in 2D); `None` for that
    /// of the part.
    pub inertia: Option<f64>,
    /// Position of the part's centre relative to the centre of mass (m).
    pub offset: [f64; 3],
}

impl ConvexBody {
    /// Returns a block of one part at rest.
    pub fn of(part: AnyPart) -> Self {
        Self {
            start: InitialState {
                position: part.centre(),
                ..InitialState::default()
            },
            volume: part.volume(),
            inertia: None,
            offset: [0.0; 3],
            part,
        }
    }
}

/// A scene while it is assembled.
pub trait Assembly: Debug + Send {
    /// Number of dimensions, 2 or 3.
    fn dimension(&self) -> usize;
    /// Lengths of the periodic cell (m).
    fn periodic(&self) -> &Periodic;
    /// Number of bodies.
    fn body_count(&self) -> usize;
    /// The driven first bodies.
    fn driven(&self) -> &[Driven];
    /// Radii of all balls, and of the bounding balls of the convex parts (m).
    fn radii(&self) -> Vec<f64>;
    /// Whether a ball or part belongs to no driven body.
    fn has_loose_shapes(&self) -> bool;
    /// Smallest radius of a grain (m): of a ball, or of the largest ball about its centre inside a
    /// convex part; infinite without grains.
    fn thinnest_grain(&self) -> f64;
    /// Number of surfaces.
    fn surface_count(&self) -> usize;
    /// Lines of a surface in its own frame (m).
    fn surface_lines(&self, surface: usize) -> Vec<Vec<[f64; 3]>>;
    /// Names of the surfaces that wear.
    fn worn_names(&self) -> Vec<&str>;

    /// Adds a ball of a radius (m) as a grain; returns its index.
    fn add_ball(&mut self, radius: f64, of: MaterialDensity, start: &InitialState) -> u32;
    /// Adds a fixed plane as a first body, with its outward unit normal.
    fn add_wall(&mut self, name: String, at: [f64; 3], normal: [f64; 3], material: u16);
    /// Adds a body of several shapes, where `start` gives the frame of the shapes; returns its
    /// index.
    fn add_union(
        &mut self,
        union: AnyUnion,
        mass_properties: MassProperties,
        material: u16,
        start: &InitialState,
    ) -> u32;
    /// Adds a grain of one convex part; returns its index.
    fn add_block(&mut self, block: ConvexBody, of: MaterialDensity) -> u32;
    /// Adds a grain of a mass (kg; kg/m in 2D), with a tensor of inertia in its axes, row by row
    /// (kg m^2; in 2D the first entry alone, kg m), which is multiplied by `factor`, and a length
    /// (m). Returns its index.
    ///
    /// # Errors
    /// The position is not finite, or the orientation is not a rotation.
    fn add_weighed(
        &mut self,
        mass: f64,
        inertia: &[f64; 9],
        factor: f64,
        length: f64,
        start: &InitialState,
    ) -> Result<u32, String>;
    /// Adds a ball to a body, at an offset in its frame (m).
    ///
    /// # Errors
    /// The radius is not above zero, or the offset is not finite.
    fn carry_ball(
        &mut self,
        body: u32,
        offset: [f64; 3],
        radius: f64,
        material: u16,
    ) -> Result<(), String>;
    /// Adds a convex part to a body from its record.
    ///
    /// # Errors
    /// The record does not describe a convex part; the text says why.
    fn carry_piece(&mut self, body: u32, piece: RecordedPiece, material: u16)
    -> Result<(), String>;
    /// Drives a body.
    fn drive(&mut self, driven: Driven);
    /// Lets a surface wear; returns whether it can.
    fn add_scar(&mut self, surface: usize, name: String, thickness: f64, every: u64) -> bool;
    /// Adds a dynamical system after those added before.
    fn add_system(&mut self, system: AnySystem);

    /// Returns an upper bound of the number of pairs of bodies within a distance of each other (m).
    fn most_pairs(&self, reach: f64) -> f64;
    /// Finds a place where too many shapes are close together: more than `most(number of shapes)`
    /// pairs of shapes with an interface are within a distance (m) of each other.
    fn overcrowding(
        &self,
        reach: f64,
        most: &dyn Fn(usize) -> usize,
        table: &LawTable,
    ) -> Option<Overcrowding>;

    /// The bodies and shapes in their dimension.
    fn parts(&mut self) -> AnySceneParts<'_>;
    /// Builds the simulation; also returns, for each dynamical system, the index of the surface
    /// that it has added, if any.
    fn into_simulation(
        self: Box<Self>,
        laws: Vec<Interface>,
        table: LawTable,
        alert: f64,
        skin: f64,
    ) -> (AnySimulation, Vec<Option<usize>>);
}

/// Returns an empty scene in a dimension.
pub fn empty(dimension: usize, periodic: Periodic) -> Box<dyn Assembly> {
    match dimension {
        2 => Box::new(SceneParts::<Dim2>::new(periodic)),
        _ => Box::new(SceneParts::<Dim3>::new(periodic)),
    }
}

/// Returns a plane whose outward unit normal points to its open side; figures show it up to a
/// distance (m).
pub fn half_space(dimension: usize, normal: [f64; 3], shown: f64) -> AnySurface {
    parts::half_space(dimension, normal, shown)
}

/// Returns the vector rotated by an orientation given in numbers; `None` if these are not a
/// rotation.
pub fn turned(dimension: usize, rotation: &[f64; 4], v: [f64; 3]) -> Option<[f64; 3]> {
    match dimension {
        2 => parts::turned::<Dim2>(rotation, v),
        _ => parts::turned::<Dim3>(rotation, v),
    }
}

#[cfg(test)]
mod tests;
