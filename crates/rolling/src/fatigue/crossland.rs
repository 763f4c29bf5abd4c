//! Crossland's criterion (B. Crossland, International Conference on Fatigue of Metals, London,
//! 1956): sqrt(J2),a + alpha p_max <= t, with the amplitude of the square root of the second
//! invariant of the deviator and the largest hydrostatic stress of a cycle.

use super::ball::smallest;
use crate::stress::{Stress, deviator, hydrostatic};
use serde::{Deserialize, Serialize};

/// Strengths at one number of cycles.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Crossland {
    /// Amplitude of reversed bending, f (Pa).
    pub bending: f64,
    /// Amplitude of reversed torsion, t (Pa).
    pub torsion: f64,
}

impl Crossland {
    /// Returns alpha = 3 t/f - sqrt(3), which both tests give.
    pub fn pressure_factor(&self) -> f64 {
        3.0 * self.torsion / self.bending - 3f64.sqrt()
    }

    /// Returns (sqrt(J2),a + alpha p_max)/t of a cycle: a crack is expected from 1 on.
    ///
    /// The amplitude is the radius of the smallest ball that holds the path of the deviator. Under
    /// stresses a quarter of a cycle out of phase it is too small: see the tests.
    pub fn index(&self, cycle: &[Stress]) -> f64 {
        let highest = cycle.iter().map(hydrostatic).fold(f64::MIN, f64::max);
        (amplitude(cycle) + self.pressure_factor() * highest) / self.torsion
    }
}

/// Returns the amplitude of sqrt(J2) (Pa): the radius of the smallest ball about the deviators, in
/// five dimensions in which the square of the distance from the origin is J2.
pub fn amplitude(cycle: &[Stress]) -> f64 {
    let points: Vec<[f64; 5]> = cycle
        .iter()
        .map(|stress| {
            let [x, y, z, yz, xz, xy] = deviator(stress);
            [0.75f64.sqrt() * x, 0.5 * (y - z), yz, xz, xy]
        })
        .collect();
    smallest(&points).radius.max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A cycle of bending and torsion (Pa), with a mean of the bending and a lag of the torsion.
    fn cycle(bending: f64, mean: f64, torsion: f64, lag: f64) -> Vec<Stress> {
        (0..72)
            .map(|k| {
                let t = f64::from(k) * std::f64::consts::TAU / 72.0;
                let mut s = [0.0; 6];
                s[0] = mean + bending * t.sin();
                s[5] = torsion * (t - lag).sin();
                s
            })
            .collect()
    }

    #[test]
    fn both_tests_that_give_the_strengths_are_at_the_limit() {
        let law = Crossland {
            bending: 700e6,
            torsion: 430e6,
        };
        for (bending, torsion) in [(700e6, 0.0), (0.0, 430e6)] {
            let index = law.index(&cycle(bending, 0.0, torsion, 0.0));
            assert!((index - 1.0).abs() < 1e-9, "{index}");
        }
    }

    /// Steel 30NCD16 in bending and torsion (M. Jabbado, thesis, École Polytechnique, 2006, after
    /// tests of L. Dubar 1992): amplitudes and mean tension (MPa) at which specimens broke, and the
    /// strengths in bending and torsion at this number of cycles.
    #[test]
    fn measured_strengths_in_phase_are_within_a_twentieth() {
        for (bending, mean, torsion, strengths) in [
            // 80,000, 200,000, 120,000, 250,000 and 250,000 cycles.
            (600e6, 0.0, 335e6, [795e6, 505e6]),
            (548e6, 0.0, 306e6, [725e6, 450e6]),
            (0.0, 290e6, 460e6, [765e6, 482e6]),
            (0.0, 450e6, 430e6, [708e6, 440e6]),
            (660e6, 290e6, 0.0, [708e6, 440e6]),
        ] {
            let [f, t] = strengths;
            let law = Crossland {
                bending: f,
                torsion: t,
            };
            let index = law.index(&cycle(bending, mean, torsion, 0.0));
            assert!(
                (index - 1.0).abs() < 0.05,
                "{bending} {mean} {torsion}: {index}"
            );
        }
    }

    /// With torsion a quarter of a cycle behind, specimens of this steel broke after 260,000 cycles
    /// at 0.74 of the limit: the smallest ball does not see that the path is round.
    #[test]
    fn stresses_out_of_phase_are_underestimated() {
        let law = Crossland {
            bending: 708e6,
            torsion: 440e6,
        };
        let index = law.index(&cycle(490e6, 450e6, 285e6, std::f64::consts::FRAC_PI_2));
        assert!((index - 0.74).abs() < 0.01, "{index}");
    }
}
