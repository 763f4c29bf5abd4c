//! Uncertainty of a result.

use serde::{Deserialize, Serialize};

use super::unit::{ONE, WORD};

crate::described! {
    /// A result with its uncertainties, each as a half-width of a 95 % confidence interval in the
    /// unit of the value; null if it was not estimated.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct Estimate {
        /// Value to which the half-widths refer.
        pub value: Option<f64> => ONE,
        /// Half-width from the scatter within the run.
        pub scatter: Option<f64> => ONE,
        /// Half-width from the time step, by repeated steps: the change that they show, and what is
        /// not known of it.
        pub step: Option<f64> => ONE,
        /// Half-width from the solver's tolerance, by repeated steps.
        pub tolerance: Option<f64> => ONE,
        /// Half-width from the explicit coupling of damage and opening, by repeated steps; a part
        /// of the effect of the step too.
        pub coupling: Option<f64> => ONE,
        /// Method of the scatter estimate, or the reason why there is none.
        pub method: Option<String> => WORD,
    }
}

impl Estimate {
    /// Returns the half-widths due to settings: by step, tolerance and coupling, with their names.
    pub fn settings(&self) -> impl Iterator<Item = (&'static str, f64)> {
        let all = [
            ("step", self.step),
            ("tolerance", self.tolerance),
            ("coupling", self.coupling),
        ];
        all.into_iter().filter_map(|(of, half)| Some((of, half?)))
    }

    /// Returns the half-widths of settings that are smaller than the value, and the names of the
    /// others: a half-width as large as the value means that nothing is known.
    pub fn known(&self) -> (Vec<(&'static str, f64)>, Vec<&'static str>) {
        let size = self.value.unwrap_or(0.0).abs();
        let (known, unknown): (Vec<_>, Vec<_>) = self.settings().partition(|(_, h)| *h < size);
        (known, unknown.into_iter().map(|(of, _)| of).collect())
    }

    /// Returns ` +- 0.004 (step) +- 0.002 (tolerance)`, with the half-widths formatted by `shown`.
    /// Empty where nothing was estimated.
    pub fn from_settings(&self, shown: impl Fn(f64) -> String) -> String {
        let (known, unknown) = self.known();
        let known = known.iter();
        let mut text: String = known
            .map(|(of, half)| format!(" +- {} ({of})", shown(*half)))
            .collect();
        if !unknown.is_empty() {
            text += &format!(" (effect of {} not known)", unknown.join(" and "));
        }
        text
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
