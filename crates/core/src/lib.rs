//! The computing core of Fretwork: rigid bodies in dry contact, integrated in time by non-smooth
//! contact dynamics, with interface laws from plugins.
//!
//! Modules in the order in which they build on each other: [`geometry`] (dimension, algebra,
//! shapes, distances), [`bodies`], [`contact`] (detection and memory of contacts),
//! [`solve`] (the contact problem and its solvers), [`laws`] (the plugin host), [`certify`] (tests
//! of laws), [`wear`], [`energy`] and [`momentum`] (the ledgers of a step), [`heat`]
//! (temperatures and current), [`step`] (the time step), [`process`] (what acts on a simulation at
//! the named moments of a step), and [`view`] (a simulation without its dimension). State goes to
//! bytes and back by [`code`].
//!
//! A [`Simulation`](step::Simulation) holds the data of a case (shapes, laws, phases), the
//! [`Options`](step::Options) of the computation, which no step changes, and its
//! [`State`](step::State), which a checkpoint contains. Between steps, its
//! [`contacts`](step::Simulation::contacts), [`positions`](step::Simulation::positions) and
//! [`energies`](step::Simulation::energies) can be read:
//!
//! ```
//! use fretwork_core::bodies::Bodies;
//! use fretwork_core::contact::detect::LawTable;
//! use fretwork_core::geometry::periodic::Periodic;
//! use fretwork_core::geometry::shape::{Ball, Shapes};
//! use fretwork_core::geometry::space::{Dim2, VectorLike};
//! use fretwork_core::step::{Scheme, Simulation};
//! use nalgebra::Vector2;
//! use std::ops::ControlFlow;
//!
//! // A disk of 1 cm and 2000 kg/m^3 falls; materials without an interface law pass through each
//! // other.
//! let mut bodies = Bodies::<Dim2>::default();
//! let body = bodies.add_ball(Vector2::new(0.0, 1.0), 0.01, 2000.0);
//! let ball = Ball { body, radius: 0.01, offset: Vector2::zero(), material: 0, area: Vector2::zero() };
//! let shapes = Shapes {
//!     balls: vec![ball],
//!     pieces: Vec::new(),
//!     surfaces: Vec::new(),
//!     periodic: Periodic { period: [None; 3] },
//! };
//! let mut simulation = Simulation::new(bodies, shapes, Vec::new(), LawTable::new(1), 1e-3, 1e-3);
//! simulation.state.gravity = Vector2::new(0.0, -9.81);
//! simulation.options.scheme = Scheme { h: 1e-3, theta: 0.5 };
//! let end = simulation.run_until(0.1, |_, _| ControlFlow::<()>::Continue(()))?;
//! assert_eq!(end, ControlFlow::Continue(()));
//! // The theta scheme is exact for a constant acceleration.
//! let fall = 1.0 - simulation.positions()[0].y;
//! assert!((fall - 0.5 * 9.81 * 0.1 * 0.1).abs() < 1e-12, "{fall}");
//! assert!(simulation.energies().residual.abs() < 1e-12);
//! # Ok::<(), fretwork_core::step::StepError>(())
//! ```
//!
//! The layer above, `fretwork_scene::CaseBuilder`, makes scenes with interface laws with less code.
//!
//! The core neither parses cases nor writes result files; the layers above it do.

#![deny(clippy::print_stdout, clippy::print_stderr)]

pub mod assembly;
pub mod bodies;
pub mod certify;
pub mod contact;
pub mod encoding;
pub mod energy;
pub mod geometry;
pub mod heat;
pub mod huge_pages;
pub mod lanes;
pub mod laws;
pub mod momentum;
pub mod out_of_memory;
pub mod process;
pub mod program;
pub mod solve;
pub mod step;
pub mod threads;
pub mod unit;
pub mod view;
pub mod wear;

pub use step::fields;
