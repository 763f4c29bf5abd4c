//! Grains of a state of another run, as a record of it holds them. Who reads that record is above this layer: the program
//! hands a reader over, see [`crate::Loaded::reading_records`].

use std::path::{Path, PathBuf};

/// Reads a state of a record (the last one without a number) for a case of 2 or 3 dimensions.
pub type RecordReader = fn(&Path, Option<usize>, usize) -> Result<State, StateError>;

/// A grain that is no lone ball.
#[derive(Clone, Debug, PartialEq)]
pub struct ShapedBody {
    /// Its identity.
    pub id: u64,
    /// Mass (kg; 2D kg/m).
    pub mass: f64,
    /// Density of its material (kg/m^3).
    pub density: f64,
    /// The length that makes its spin a velocity (m).
    pub length: f64,
    /// Moments of inertia in its own axes (kg m^2; 2D kg m), row by row; in the plane the first.
    pub inertia: [f64; 9],
}

/// A ball of such a grain.
#[derive(Clone, Debug, PartialEq)]
pub struct ShapedBall {
    /// Identity of the grain.
    pub body: u64,
    /// Radius (m).
    pub radius: f64,
    /// Centre in the grain's frame (m).
    pub offset: [f64; 3],
}

/// A convex piece of such a grain.
#[derive(Clone, Debug, PartialEq)]
pub struct ShapedPiece {
    /// Identity of the grain.
    pub body: u64,
    /// Radius of the rounding (m).
    pub rounding: f64,
    /// Radius of the ball of its volume (m).
    pub size: f64,
    /// Its centre in the grain's frame (m).
    pub offset: [f64; 3],
    /// Corners about its centre (m).
    pub corners: Vec<[f64; 3]>,
    /// Faces by their corners.
    pub faces: Vec<Vec<u32>>,
}

/// How a grain moves, in SI units; unused components are zero, the spin of a plane case is the first.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Motion {
    /// Where its centre is, or that of its first part (m), within the period where there is one.
    pub at: [f64; 3],
    /// Orientation: the angle (rad) in the plane, a quaternion (w, x, y, z) in space; none where the file has none, which
    /// is where all grains are lone balls.
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
    /// How it moves.
    pub motion: Motion,
}

/// A grain of a state that is no lone ball.
#[derive(Clone, Debug, PartialEq)]
pub struct ShapedGrain {
    /// Mass, inertia.
    pub body: ShapedBody,
    /// Its balls; the first is its first part where there is one,
    pub balls: Vec<ShapedBall>,
    /// and the first of its pieces where there is none.
    pub pieces: Vec<ShapedPiece>,
    /// How it moves.
    pub motion: Motion,
}

/// The grains of one state; first bodies and grains that were taken out are left out.
#[derive(Clone, Debug, Default)]
pub struct State {
    /// Number of the state, from 0.
    pub frame: usize,
    /// Its time (s).
    pub time: f64,
    /// The balls, in the order of the file.
    pub grains: Vec<Grain>,
    /// The other grains, in the order of the file.
    pub shaped: Vec<ShapedGrain>,
}

/// Why a state cannot be read.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum StateError {
    /// No file of results, or a damaged one.
    #[error("cannot read {}: {reason}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        reason: String,
    },
    /// A number that is too high.
    #[error("{} has the states {states}, not number {asked}", path.display())]
    NoFrame {
        /// The file.
        path: PathBuf,
        /// Which it has.
        states: String,
        /// Which was asked for.
        asked: usize,
    },
}
