//! The state of the spring of a compliant contact.

use crate::geometry::space::Space;
use serde::{Deserialize, Serialize};

/// The spring of a compliant contact at the end of a step; all zero for a rigid contact and one
/// that does not touch.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(bound = "")]
pub struct Spring<S: Space> {
    /// Overlap of the bodies (m).
    pub overlap: f64,
    /// Normal force of the spring at this overlap (N; N/m in 2D).
    pub force_n: f64,
    /// Tangential force of the spring (N; N/m in 2D), along the displacement of the candidate.
    pub force_t: S::Tangent,
    /// Stored energy, normal and tangential (J; J/m in 2D).
    pub energy: [f64; 2],
}

impl<S: Space> Spring<S> {
    /// Returns the stored energy (J).
    pub fn stored(&self) -> f64 {
        self.energy[0] + self.energy[1]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::space::Dim2;

    #[test]
    fn it_stores_the_sum_of_both_energies() {
        let spring = Spring::<Dim2> {
            energy: [2.0, 3.0],
            ..Spring::default()
        };
        assert_eq!(spring.stored(), 5.0);
        assert_eq!(Spring::<Dim2>::default().stored(), 0.0);
    }
}
