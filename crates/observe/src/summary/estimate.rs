//! Uncertainty of the main results.

use super::Summary;
use crate::error_estimate::{Change, Effects, Repeats};
use crate::scatter::{self, Scatter};
use serde::Serialize;

/// A result with its uncertainties, each as a half-width of a 95 % confidence interval in the unit of the
/// value; null if it was not estimated.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Estimate {
    /// The value to which the half-widths refer.
    pub value: Option<f64>,
    /// From the scatter within the run.
    pub scatter: Option<f64>,
    /// From the time step, by repeated steps: the size of the change that they show, and what is not known of it.
    pub step: Option<f64>,
    /// From the solver's tolerance, in the same way.
    pub tolerance: Option<f64>,
    /// From the explicit coupling of damage and opening, in the same way; a part of the effect of the step too.
    pub coupling: Option<f64>,
    /// Method of the scatter estimate, or the reason why there is none.
    pub method: Option<String>,
}

/// The main results.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Uncertainty {
    /// Friction coefficient: the mean over the steady cycles or blocks.
    pub friction_coefficient: Estimate,
    /// Broken bonds over bonds made; its half-widths are those of the sum of the damage of all bonds, of which the ratio counts the
    /// part that is complete.
    pub damage_ratio: Estimate,
    /// Volume worn off first bodies (m^3; m^3/m in 2D).
    pub wear: Estimate,
    /// Energy dissipated by friction (J; J/m in 2D).
    pub friction_energy: Estimate,
    /// The repeated steps on which `step`, `tolerance` and `coupling` rest, and shares of the energy.
    pub repeats: Repeats,
}

impl Estimate {
    /// ` +- 0.004 (step) +- 0.002 (tolerance)`, with the half-widths formatted by `shown`; those as large as the value say that nothing
    /// is known of that effect. Empty where nothing was estimated.
    pub fn from_settings(&self, shown: impl Fn(f64) -> String) -> String {
        let known = [
            (self.step, "step"),
            (self.tolerance, "tolerance"),
            (self.coupling, "coupling"),
        ];
        let known = known.iter().filter_map(|(half, of)| Some(((*half)?, *of)));
        let size = self.value.unwrap_or(0.0).abs();
        let (known, unknown): (Vec<_>, Vec<_>) = known.partition(|(half, _)| *half < size);
        let mut text: String = known
            .iter()
            .map(|(half, of)| format!(" +- {} ({of})", shown(*half)))
            .collect();
        if !unknown.is_empty() {
            let unknown: Vec<&str> = unknown.iter().map(|(_, of)| *of).collect();
            text += &format!(" (effect of {} not known)", unknown.join(" and "));
        }
        text
    }

    /// Puts in what repeated steps say of a result.
    fn repeated(&mut self, repeats: &Repeats, part: fn(&Effects) -> Option<Change>) {
        let half = |effects: &Effects| Some(self.value?.abs() * part(effects)?.bound());
        let (step, tolerance) = (half(&repeats.step), half(&repeats.tolerance));
        self.coupling = repeats.coupling.as_ref().and_then(half);
        (self.step, self.tolerance) = (step, tolerance);
    }
}

impl Uncertainty {
    /// Estimates for a summary with its other values; `friction` is the scatter of the friction coefficient.
    pub fn new(summary: &Summary, friction: Option<&Scatter>) -> Self {
        let mut all = Self::scattered(summary, friction);
        let repeats = &summary.repeats;
        all.friction_energy.value = Some(summary.energy.friction).filter(|e| *e > 0.0);
        (all.friction_coefficient).repeated(repeats, |e| e.friction_coefficient);
        all.damage_ratio.repeated(repeats, |e| e.damage);
        all.wear.repeated(repeats, |e| e.wear);
        all.friction_energy.repeated(repeats, |e| e.friction_energy);
        all.repeats = repeats.clone();
        all
    }

    /// Values, and their scatter within the run.
    fn scattered(summary: &Summary, friction: Option<&Scatter>) -> Self {
        let mut all = Self::default();
        let mu = &mut all.friction_coefficient;
        mu.value = summary.friction_coefficient;
        if let Some(scatter) = friction {
            mu.method = Some(scatter.method());
            mu.scatter = scatter.half_width();
            mu.value = mu.scatter.map_or(mu.value, |_| Some(scatter.flow.mean));
        }
        if summary.bonds > 0 {
            all.damage_ratio.value = Some(summary.damage_ratio);
        }
        let worn = summary.wear.volume_first_bodies;
        if worn <= 0.0 {
            return all;
        }
        all.wear.value = Some(worn);
        // A cycle that represents several is not a sample like the others.
        let alike = summary.fretting.is_some() && summary.cycles.iter().all(|c| c.jumped == 0);
        if let Some(s) = scatter::over_cycles(&summary.cycles, |c| c.wear_volume).filter(|_| alike)
        {
            let cycles = summary.cycles.iter().filter(|c| c.complete).count();
            all.wear.scatter = s.half_width().map(|w| w * cycles as f64);
            all.wear.method = Some(format!("wear of a cycle times {cycles}: {}", s.method()));
        }
        all
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_half_width_as_large_as_the_value_says_that_nothing_is_known() {
        let damage = Estimate {
            value: Some(0.5),
            step: Some(2.6),
            tolerance: Some(0.25),
            coupling: Some(0.5),
            ..Estimate::default()
        };
        let text = damage.from_settings(|x| x.to_string());
        assert_eq!(
            text,
            " +- 0.25 (tolerance) (effect of step and coupling not known)"
        );
        assert_eq!(Estimate::default().from_settings(|x| x.to_string()), "");
    }
}
