//! Grains of a recorded state of another run. The reader of the record belongs to a higher layer
//! and is passed in, see [`crate::LoadedCase::reading_records`].

use std::path::{Path, PathBuf};

/// Reader of a state from a results file (the last state if no number is given), for a case of
/// dimension 2 or 3.
pub type RecordReader = fn(&Path, Option<usize>, usize) -> Result<State, StateError>;

/// A grain other than a single ball.
#[derive(Clone, Debug, PartialEq)]
pub struct ShapedBody {
    /// Identity.
    pub id: u64,
    /// Mass (kg; 2D kg/m).
    pub mass: f64,
    /// Density of its material (kg/m^3).
    pub density: f64,
    /// Characteristic length (m) that converts its spin to a velocity.
    pub length: f64,
    /// Moments of inertia in the body frame (kg m^2; 2D kg m), row by row; in 2D the first entry
    /// only.
    pub inertia: [f64; 9],
}

/// A ball of a grain with several parts.
#[derive(Clone, Debug, PartialEq)]
pub struct ShapedBall {
    /// Identity of the grain.
    pub body: u64,
    /// Radius (m).
    pub radius: f64,
    /// Centre in the grain's frame (m).
    pub offset: [f64; 3],
}

/// A convex part of a grain with several parts.
#[derive(Clone, Debug, PartialEq)]
pub struct ShapedPiece {
    /// Identity of the grain.
    pub body: u64,
    /// Radius of the rounding (m).
    pub rounding: f64,
    /// Radius of the ball (2D: disk) of the same volume (m).
    pub size: f64,
    /// Position of the part's centre in the grain's frame (m).
    pub offset: [f64; 3],
    /// Corners relative to the part's centre (m).
    pub corners: Vec<[f64; 3]>,
    /// Faces as lists of corner indices.
    pub faces: Vec<Vec<u32>>,
}

/// Position and velocity of a grain, in SI units. Unused components are zero; in 2D the spin is the
/// first component.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Motion {
    /// Position of its centre of mass, or of its first part (m), wrapped into the period if there
    /// is one.
    pub at: [f64; 3],
    /// Orientation: the angle (rad) in 2D, a quaternion (w, x, y, z) in 3D; `None` if the file has
    /// no orientations, since all its grains are single balls.
    pub rotation: Option<[f64; 4]>,
    /// Velocity (m/s).
    pub velocity: [f64; 3],
    /// Angular velocity (rad/s).
    pub spin: [f64; 3],
}

/// A ball of a state.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Grain {
    /// Radius (m).
    pub radius: f64,
    /// Position and velocity.
    pub motion: Motion,
}

/// A grain of a state that is not a single ball.
#[derive(Clone, Debug, PartialEq)]
pub struct ShapedGrain {
    /// Mass, inertia.
    pub body: ShapedBody,
    /// Balls; the first of them is its first part if there is one.
    pub balls: Vec<ShapedBall>,
    /// Convex parts; the first of them is its first part if there is no ball.
    pub pieces: Vec<ShapedPiece>,
    /// Position and velocity.
    pub motion: Motion,
    /// Deformation, if the grain is deformable.
    pub deformed: Option<Deformed>,
}

/// Deformation of a grain: values for each point of its mesh, in world axes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Deformed {
    /// Position (m), relative to the position of the grain where there is a period.
    pub places: Vec<[f64; 3]>,
    /// Displacement relative to the frame that moves with the grain (m).
    pub deformation: Vec<[f64; 3]>,
    /// Velocity (m/s).
    pub velocity: Vec<[f64; 3]>,
    /// Von Mises stress of each element (Pa).
    pub von_mises: Vec<f64>,
}

/// The grains of one state, without first bodies and without grains that were removed.
#[derive(Clone, Debug, Default)]
pub struct State {
    /// Index of the state, from 0.
    pub frame: usize,
    /// Time (s).
    pub time: f64,
    /// The balls, in the order of the file.
    pub grains: Vec<Grain>,
    /// The other grains, in the order of the file.
    pub shaped: Vec<ShapedGrain>,
}

/// Error in reading a state.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum StateError {
    /// The results file is missing or damaged.
    #[error("cannot read {}: {reason}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// Reason.
        reason: String,
    },
    /// There is no state with this number.
    #[error("{} has the states {states}, not number {asked}", path.display())]
    NoFrame {
        /// The file.
        path: PathBuf,
        /// The range of states in the file.
        states: String,
        /// The requested number.
        asked: usize,
    },
}
