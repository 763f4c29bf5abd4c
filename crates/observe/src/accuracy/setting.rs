//! One setting of a run, step or tolerance, and the decision to make it finer or coarser.

use crate::error_estimate::{Change, RatioPair};
use serde::{Deserialize, Serialize};

/// Largest number of latest stretches from which the effect of a setting is determined.
const KEPT: usize = 12;
/// Number of stretches after which settings become finer although the effect may be scatter.
const PATIENCE: usize = 6;
/// Smallest number of stretches with a setting before its effect is stated.
const FEWEST: u32 = 3;

/// A setting that the run chooses.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(super) struct Setting {
    /// Current level: number of times that it was made finer.
    pub level: u32,
    /// Finest level permitted.
    pub finest: u32,
    /// Results with the present and with a finer setting, of the latest stretches.
    pairs: Vec<[[f64; 2]; 2]>,
    /// The effect of a finer setting, as last found.
    pub effect: Option<Change>,
    /// Number of stretches measured since the last change.
    measured: u32,
}

/// Decision on a setting.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Decision {
    Keep,
    Finer(u32),
    Coarser,
}

impl Setting {
    pub fn new(finest: u32) -> Self {
        Self {
            finest,
            ..Self::default()
        }
    }

    /// Adds a stretch, and decides; `factor` is the ratio of two levels, `allowed` the share of the
    /// result that the setting may change.
    pub fn decide(&mut self, pair: RatioPair, limit: f64, factor: f64, allowed: f64) -> Decision {
        self.pairs.push([pair.coarse, pair.fine]);
        self.measured += 1;
        if self.pairs.len() > KEPT {
            self.pairs.remove(0);
        }
        let pairs = self.pairs.iter().map(|[coarse, fine]| RatioPair {
            coarse: *coarse,
            fine: *fine,
        });
        let Some(effect) = Change::over(&pairs.collect::<Vec<_>>(), limit) else {
            return Decision::Keep;
        };
        self.effect = Some(effect);
        let size = effect.change.abs();
        let certain = size - effect.half_width > allowed;
        let likely = size > allowed && self.pairs.len() >= PATIENCE;
        if (certain || likely) && self.level < self.finest {
            let levels = (size / allowed).ln() / factor.ln();
            return Decision::Finer(
                (levels.ceil() as u32)
                    .clamp(1, 2)
                    .min(self.finest - self.level),
            );
        }
        // At the first order the effect then stays below half of the permitted value.
        if self.level > 0 && effect.bound() * factor < 0.5 * allowed {
            return Decision::Coarser;
        }
        Decision::Keep
    }

    /// Returns the effect, where it was measured with the present setting, not only extrapolated.
    pub fn shown(&self) -> Option<Change> {
        self.effect.filter(|_| self.measured >= FEWEST)
    }

    /// Adopts a decision; returns whether it changed anything. Earlier results are kept with the
    /// effect expected at the first order, so that they are not lost with every change.
    pub fn adopt(&mut self, decision: Decision, factor: f64) -> bool {
        let times = match decision {
            Decision::Keep => return false,
            Decision::Finer(levels) => {
                self.level += levels;
                factor.powi(-(levels as i32))
            }
            Decision::Coarser => {
                self.level -= 1;
                factor
            }
        };
        self.measured = 0;
        for [coarse, fine] in &mut self.pairs {
            for (coarse, fine) in coarse.iter().zip(fine) {
                *fine = coarse + times * (*fine - coarse);
            }
        }
        if let Some(effect) = &mut self.effect {
            effect.change *= times;
            effect.half_width *= times;
        }
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STEP_LIMIT: f64 = 4.0 / 3.0;

    fn pair(change: f64) -> RatioPair {
        RatioPair {
            coarse: [1.0, 1.0],
            fine: [1.0 + change, 1.0],
        }
    }

    #[test]
    fn a_certain_effect_makes_a_setting_finer_by_what_it_needs() {
        let mut setting = Setting::new(6);
        for expected in [Decision::Keep, Decision::Keep, Decision::Finer(2)] {
            // 4 % at the first order: two halvings bring it to 1 %.
            assert_eq!(setting.decide(pair(0.03), STEP_LIMIT, 2.0, 0.01), expected);
        }
        assert!(setting.adopt(Decision::Finer(2), 2.0) && setting.level == 2);
        // The effect is now 1 %, and another stretch with 1 % does not change it.
        assert!((setting.effect.unwrap().change - 0.01).abs() < 1e-12);
        assert_eq!(
            setting.decide(pair(0.0075), STEP_LIMIT, 2.0, 0.011),
            Decision::Keep
        );
        assert!((setting.effect.unwrap().change - 0.01).abs() < 1e-12);
        // The level does not exceed the finest.
        let mut setting = Setting::new(0);
        for _ in 0..20 {
            assert_eq!(setting.decide(pair(0.03), 1.0, 2.0, 0.01), Decision::Keep);
        }
    }

    #[test]
    fn a_small_effect_makes_a_setting_coarser_again() {
        let mut setting = Setting::new(6);
        setting.level = 1;
        for expected in [Decision::Keep, Decision::Keep, Decision::Coarser] {
            assert_eq!(setting.decide(pair(0.002), 1.0, 2.0, 0.01), expected);
        }
        // The coarser level would exceed half of the permitted value.
        setting.pairs.clear();
        for _ in 0..6 {
            assert_eq!(setting.decide(pair(0.003), 1.0, 2.0, 0.01), Decision::Keep);
        }
    }

    #[test]
    fn scatter_is_waited_for() {
        let mut setting = Setting::new(6);
        let effects = [0.1, -0.1, 0.12, -0.06, 0.1, 0.1];
        let decided = effects.map(|e| setting.decide(pair(e), 1.0, 2.0, 0.02));
        assert!(
            decided[..5].iter().all(|d| *d == Decision::Keep),
            "{decided:?}"
        );
        assert_eq!(decided[5], Decision::Finer(2));
    }
}
