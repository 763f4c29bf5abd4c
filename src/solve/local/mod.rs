//! Contact problems given as a matrix: u = W p + q, K* of (u + mu |u_t| n) perpendicular to p of K.
//!
//! This is the form of the field's shared collection (FCLIB). Components are (n, t) or (n, t1, t2),
//! contact after contact.

pub mod accelerated;
pub mod anderson;
pub mod auto;
pub mod block;
pub mod contact;
pub mod csr;
pub mod factor;
pub mod form;
pub mod global;
pub mod gradient;
pub mod interior;
pub mod law;
pub mod linear;
pub mod newton;
pub mod nlgs;
pub mod reduce;
pub mod solver;
pub mod state;

pub use csr::Csr;
pub use global::{Equalities, GlobalProblem, Multipliers};
pub use reduce::{Elimination, ReduceError, Reduction};

/// A local problem, whatever its dimension.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LocalProblem {
    /// Components of a contact: 2 or 3.
    pub dimension: usize,
    /// The Delassus operator, `dimension * mu.len()` square (1/kg, or what the file has).
    pub w: Csr,
    /// Free relative velocities.
    pub q: Vec<f64>,
    /// Friction coefficients.
    pub mu: Vec<f64>,
}
