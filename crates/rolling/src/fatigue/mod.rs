//! Crack criteria of a cycle of stresses below a patch.

pub mod ball;
pub mod crossland;
pub mod history;
pub mod materials;
pub mod swt;

pub use crossland::Crossland;
pub use history::{Block, histories};
pub use swt::{StrainLife, Swt, swt};

use crate::stress::Stress;
use fretwork_elastic::Elasticity;

/// A criterion for cracks within a number of cycles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Criterion {
    /// Crossland's, with strengths at this number of cycles.
    Crossland(Crossland),
    /// That of Smith, Watson and Topper on the critical plane.
    Swt {
        /// Elasticity of the body.
        body: Elasticity,
        /// Its strain over cycles.
        life: StrainLife,
        /// Number of cycles.
        cycles: f64,
    },
}

impl Criterion {
    /// Returns the index of a cycle of stresses (Pa): a crack is expected from 1 on. Crossland's
    /// goes with the stress, that of Smith, Watson and Topper with its square.
    pub fn index(&self, cycle: &[Stress]) -> f64 {
        match self {
            Self::Crossland(law) => law.index(cycle),
            Self::Swt { body, life, cycles } => {
                swt(body, cycle).parameter / life.parameter(body.young, *cycles)
            }
        }
    }
}
