//! A simulation without its dimension, for code that reads, records or controls it.
//!
//! ```text
//! Simulation<Dim2> ─┐
//!                   ├─► AnySimulation ─► dyn RunControl (steps, checkpoints) ─► dyn RunView (reads)
//! Simulation<Dim3> ─┘
//! ```
//!
//! A `RunView` is a [`BodiesView`], a [`ShapesView`] and a [`ContactsView`] too: a reference to one
//! has the methods of all of them.
//!
//! Positions, velocities and forces are `[f64; 3]` in world axes. In the plane the third component
//! is zero, angular velocities and moments are about the third axis, and extensive quantities are
//! for a depth of 1 m.
//!
//! ```
//! use fretwork_core::bodies::Bodies;
//! use fretwork_core::contact::detect::LawTable;
//! use fretwork_core::geometry::periodic::Periodic;
//! use fretwork_core::geometry::shape::Shapes;
//! use fretwork_core::geometry::space::Dim2;
//! use fretwork_core::step::Simulation;
//! use fretwork_core::view::{AnySimulation, RunView};
//! use nalgebra::Vector2;
//!
//! /// Kinetic energy of the grains (J), of a simulation of either dimension.
//! fn of_grains(run: &dyn RunView) -> f64 {
//!     run.grains().into_iter().map(|grain| run.kinetic_energy(grain)).sum()
//! }
//!
//! let mut bodies = Bodies::<Dim2>::default();
//! bodies.add_ball(Vector2::new(0.0, 1.0), 0.01, 2000.0);
//! bodies.velocity[0] = Vector2::new(2.0, 0.0);
//! let periodic = Periodic { period: [None; 3] };
//! let shapes = Shapes { balls: Vec::new(), pieces: Vec::new(), surfaces: Vec::new(), periodic };
//! let mut run = AnySimulation::from(Simulation::new(bodies, shapes, Vec::new(), LawTable::new(1), 1e-3, 1e-3));
//! run.step()?;
//! assert_eq!(run.motion(0).velocity, [2.0, 0.0, 0.0]);
//! assert_eq!(of_grains(run.view()), 2.0 * run.bodies().mass[0]);
//! # Ok::<(), fretwork_core::step::StepError>(())
//! ```

mod any;
mod bodies_view;
mod contacts_view;
mod control;
mod fields;
mod memory;
mod part_corners;
pub mod placement;
mod rows;
mod run_view;
mod setup;
mod shapes_view;
mod systems;

pub use any::AnySimulation;
pub use bodies_view::BodiesView;
pub use contacts_view::ContactsView;
pub use control::RunControl;
pub use fields::{FieldInfo, FieldKind, FieldValues, GrainFields};
pub use memory::MemoryUse;
pub use rows::{
    BallView, BodyColumns, BodyMotion, BondCounts, ContactView, Outline, PieceView, ScarVertex,
    ScarView, SurfaceView,
};
pub use run_view::RunView;
pub use setup::{PointBehind, RunSetup};
pub use shapes_view::ShapesView;
pub use systems::{SystemTrial, SystemView};

#[cfg(test)]
mod tests;
