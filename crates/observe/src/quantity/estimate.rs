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
        /// What the value is of, such as `mean of cycles 26 to 50`; null where there is one value
        /// only.
        #[serde(default)]
        pub statistic: Option<String> => WORD,
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
        /// What the scatter is over, such as `within this sample (3 cycles)`; null where there is
        /// no scatter.
        pub scope: Option<String> => WORD,
        /// Whether all half-widths together are at most a quarter of the value; null where none was
        /// estimated.
        pub determined: Option<bool> => WORD,
    }
}

/// Largest half-width of a result that is determined, as a share of its value.
pub const DETERMINED: f64 = 0.25;

impl Estimate {
    /// Returns the half-width of all causes together, the root of the sum of their squares; `None`
    /// where none was estimated. The coupling is a part of the effect of the step.
    pub fn half_width(&self) -> Option<f64> {
        let all = [self.scatter, self.step, self.tolerance];
        let squares = all.into_iter().flatten().map(|half| half * half);
        squares.reduce(|a, b| a + b).map(f64::sqrt)
    }

    /// Returns whether the result is determined, see [`DETERMINED`]; `None` where no half-width was
    /// estimated.
    pub fn is_determined(&self) -> Option<bool> {
        let computed = || {
            let size = self.value?.abs();
            Some(self.half_width()? <= DETERMINED * size)
        };
        self.determined.or_else(computed)
    }

    /// Records whether the result is determined: an infinite half-width is null in JSON.
    #[must_use]
    pub fn judged(mut self) -> Self {
        self.determined = self.is_determined();
        self
    }

    /// Returns the causes of its half-widths by their names, with their shares of the value: the
    /// scatter by what it is over.
    pub fn shares(&self) -> Vec<(String, f64)> {
        let size = self.value.unwrap_or(0.0).abs();
        let scope = self.scope.as_deref().unwrap_or("within this sample");
        let scatter = self.scatter.map(|half| (scope.to_owned(), half / size));
        let settings = [("step", self.step), ("tolerance", self.tolerance)];
        let settings = settings.into_iter();
        let settings = settings.filter_map(|(of, half)| Some((of.to_owned(), half? / size)));
        settings.chain(scatter).collect()
    }

    /// Returns the causes of its half-widths in a word each: the scatter by what it is over, as
    /// `cycles`, `blocks` or `seeds`.
    pub fn causes(&self) -> Vec<String> {
        let shares = self.shares().into_iter();
        shares.map(|(of, _)| short_cause(&of).to_owned()).collect()
    }

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

/// Returns a cause in a word: `cycles` of `within this sample (3 cycles)`.
pub fn short_cause(of: &str) -> &str {
    let over = ["within ", "over "]
        .iter()
        .any(|start| of.starts_with(start));
    match of.rsplit_once(' ').filter(|_| over) {
        Some((_, last)) => last.trim_end_matches(')'),
        None => of,
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

    #[test]
    fn a_half_width_of_more_than_a_quarter_leaves_a_result_undetermined() {
        let of = |scatter, step, tolerance| Estimate {
            value: Some(-2.0),
            scatter,
            step,
            tolerance,
            ..Estimate::default()
        };
        assert_eq!(of(None, None, None).half_width(), None);
        assert_eq!(of(None, None, None).is_determined(), None);
        // 3, 4 and 12 give 13.
        let all = of(Some(0.12), Some(0.03), Some(0.04));
        assert!((all.half_width().unwrap() - 0.13).abs() < 1e-12);
        assert_eq!(all.is_determined(), Some(true));
        assert_eq!(of(Some(0.5), None, None).is_determined(), Some(true));
        assert_eq!(of(Some(0.51), None, None).is_determined(), Some(false));
        // An infinite half-width is null in JSON, the verdict is not.
        let unknown = of(None, Some(f64::INFINITY), None).judged();
        let read = serde_json::to_string(&unknown).unwrap();
        let read: Estimate = serde_json::from_str(&read).unwrap();
        assert_eq!((read.step, read.is_determined()), (None, Some(false)));
    }

    #[test]
    fn causes_have_their_shares_of_the_value() {
        let estimate = Estimate {
            value: Some(0.4),
            scatter: Some(0.004),
            step: Some(0.002),
            scope: Some("over 8 seeds".to_owned()),
            ..Estimate::default()
        };
        let shares = estimate.shares();
        let names: Vec<&str> = shares.iter().map(|s| s.0.as_str()).collect();
        assert_eq!(names, ["step", "over 8 seeds"]);
        assert_eq!(estimate.causes(), ["step", "seeds"]);
        assert_eq!(short_cause("within this sample (10 blocks)"), "blocks");
        assert_eq!(short_cause("within this sample"), "sample");
        assert_eq!(short_cause("step and tolerance"), "step and tolerance");
        assert!((shares[1].1 - 0.01).abs() < 1e-12, "{shares:?}");
    }
}
