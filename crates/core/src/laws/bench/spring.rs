//! The spring of a compliant contact under any law: its force at an overlap, and the overlap under
//! a force.

use super::{Bench, BenchMotion};
use crate::laws::{Call, LawError};

/// Smallest and largest overlap of a search, as fractions of the reduced radius.
const RANGE: [f64; 2] = [1e-15, 1e3];
/// Number of bisections of the logarithm of the overlap: a relative error of 1e-9.
const BISECTIONS: u32 = 40;

/// The spring at an overlap (N, N/m; per metre of depth in 2D).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SpringAnswer {
    /// Normal force.
    pub force: f64,
    /// Slope of the normal force.
    pub stiffness: f64,
    /// Slope of the tangential force at zero force; 0 for a rigid tangential contact.
    pub tangential: f64,
}

impl Bench {
    /// Returns the spring at an overlap (m); `None` if the contact law is rigid.
    ///
    /// # Errors
    /// The law's error.
    pub fn spring(&mut self, overlap: f64) -> Result<Option<SpringAnswer>, LawError> {
        if !self.law.compliant() {
            return Ok(None);
        }
        let state = self.fresh();
        let motion = BenchMotion {
            gap: -overlap,
            ..BenchMotion::default()
        };
        let info = crate::laws::StepInfo {
            dimension: self.dimension,
            time: 0.0,
            h: 1.0,
            theta: 0.5,
            correction: 0.0,
        };
        self.fill(&[state], &[motion], &info, false);
        let contact = self.law.contact().clone();
        self.batch.run(&contact, &info, 0.0, Call::Prepare)?;
        let out = &self.batch.columns.out;
        Ok(Some(SpringAnswer {
            force: out.contact_force[0][0],
            stiffness: out.contact_stiffness_n[0],
            tangential: out.contact_stiffness_t[0],
        }))
    }

    /// Returns the overlap (m) under a normal force (N; N/m in 2D), at most a thousand times the
    /// reduced radius; `None` if the contact law is rigid.
    ///
    /// # Errors
    /// The law's error.
    pub fn overlap_under(&mut self, force: f64) -> Result<Option<f64>, LawError> {
        let [mut low, mut high] = RANGE.map(|share| (share * self.radius).ln());
        for _ in 0..BISECTIONS {
            let middle = 0.5 * (low + high);
            let Some(spring) = self.spring(middle.exp())? else {
                return Ok(None);
            };
            if spring.force < force {
                low = middle;
            } else {
                high = middle;
            }
        }
        Ok(Some((0.5 * (low + high)).exp()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laws::interface::Interface;
    use crate::laws::sample_laws::{elastic, interface};

    /// A spring of 8 N/m has an overlap of F/8, whatever its radius; a rigid contact has none.
    #[test]
    fn a_force_has_its_overlap() {
        for radius in [0.01, 1.0] {
            let mut bench = Bench::new(Interface::new("test", [elastic()]).unwrap(), 3, radius);
            for force in [1e-6, 0.02, 0.08] {
                let overlap = bench.overlap_under(force).unwrap().unwrap();
                assert!((overlap / (force / 8.0) - 1.0).abs() < 1e-8, "{overlap}");
            }
        }
        let mut rigid = Bench::new(interface([]), 3, 1.0);
        assert_eq!(rigid.overlap_under(1.0).unwrap(), None);
    }
}
