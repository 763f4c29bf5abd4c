//! A row of the summary, and the rule of its verdict.

use crate::sample::Estimate;

/// A difference beyond its intervals, but below this fraction of the reference, has its own
/// verdict.
pub const CLOSE: f64 = 0.02;
/// A comparison is not decided if its intervals add up to more than this fraction of the reference.
pub const WIDE: f64 = 0.1;

/// Verdicts, from the best to the worst.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Verdict {
    Agrees,
    Close,
    Undecided,
    Differs,
}

impl Verdict {
    pub fn text(self) -> String {
        match self {
            Self::Agrees => "agrees".to_owned(),
            Self::Close => format!("differs by less than {:.0} %", 100.0 * CLOSE),
            Self::Differs => "**differs**".to_owned(),
            Self::Undecided => "not decided".to_owned(),
        }
    }
}

/// Judges `difference` from the reference, with half of the range of the reference. Also used for a
/// change that should be 0, as a fraction of `reference`.
pub fn judge(difference: Estimate, range: f64, reference: f64) -> Verdict {
    let reach = difference.half + range;
    let off = difference.mean.abs();
    let whole = reference.abs();
    // A comparison with NaN is false: it must not pass for agreement.
    if !(reach.is_finite() && off.is_finite() && whole.is_finite()) {
        Verdict::Undecided
    } else if off > reach {
        if off <= CLOSE * whole {
            Verdict::Close
        } else {
            Verdict::Differs
        }
    } else if reach > WIDE * whole {
        Verdict::Undecided
    } else {
        Verdict::Agrees
    }
}

/// Whether a change is above zero.
pub fn rises(change: Estimate) -> Verdict {
    if change.low() > 0.0 {
        Verdict::Agrees
    } else if change.high() < 0.0 {
        Verdict::Differs
    } else {
        Verdict::Undecided
    }
}

/// Texts of the columns.
#[derive(Clone, Debug)]
pub struct Row {
    pub quantity: String,
    pub ours: String,
    pub numerical: String,
    pub reference: String,
    pub difference: String,
    pub verdict: String,
}

/// A published number, with half of its range (0 if none is given), and its text.
pub struct Reference {
    pub value: f64,
    pub range: f64,
    pub digits: usize,
}

impl Reference {
    fn text(&self) -> String {
        let d = self.digits;
        if self.range > 0.0 {
            format!(
                "{:.d$} to {:.d$}",
                self.value - self.range,
                self.value + self.range
            )
        } else {
            format!("{:.d$}", self.value)
        }
    }
}

/// Results with finer step and tolerance.
#[derive(Clone, Copy)]
pub struct Finer {
    /// Change of the difference from the reference.
    pub change: Estimate,
    /// The difference itself, if the same point was repeated.
    pub difference: Option<Estimate>,
}

/// Returns the difference that is judged: with finer settings where they were run. A change at
/// another point shifts the difference and widens its interval.
pub fn judged(difference: Estimate, finer: Option<Finer>) -> Estimate {
    finer.map_or(difference, |f| {
        f.difference.unwrap_or(difference.plus(f.change))
    })
}

impl Row {
    /// Returns the row of one of our numbers beside a reference. `difference` is that of each seed
    /// from the reference at its own conditions.
    pub fn number(
        quantity: impl Into<String>,
        ours: Estimate,
        difference: Estimate,
        finer: Option<Finer>,
        reference: &Reference,
    ) -> Self {
        let judged = judged(difference, finer);
        Self {
            quantity: quantity.into(),
            ours: ours.text(reference.digits),
            numerical: finer.map_or("-".to_owned(), |f| f.change.percent(reference.value)),
            reference: reference.text(),
            difference: difference.percent(reference.value),
            verdict: judge(judged, reference.range, reference.value).text(),
        }
    }

    /// Returns the row of a published statement without a number. A statement that cannot be wrong
    /// has no verdict.
    pub fn statement(
        quantity: impl Into<String>,
        ours: impl Into<String>,
        numerical: Option<String>,
        published: impl Into<String>,
        verdict: Option<Verdict>,
    ) -> Self {
        Self {
            quantity: quantity.into(),
            ours: ours.into(),
            numerical: numerical.unwrap_or("-".to_owned()),
            reference: published.into(),
            difference: "-".to_owned(),
            verdict: verdict.map_or("-".to_owned(), Verdict::text),
        }
    }

    pub fn cells(&self) -> Vec<String> {
        let r = self.clone();
        vec![
            r.quantity,
            r.ours,
            r.numerical,
            r.reference,
            r.difference,
            r.verdict,
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn estimate(mean: f64, half: f64) -> Estimate {
        Estimate { mean, half }
    }

    #[test]
    fn the_rule_of_the_verdict() {
        let judged = |mean: f64, half: f64| judge(estimate(mean, half), 0.01, 1.0);
        assert_eq!(judged(0.02, 0.02), Verdict::Agrees);
        assert_eq!(judged(-0.02, 0.005), Verdict::Close);
        assert_eq!(judged(0.05, 0.02), Verdict::Differs);
        assert_eq!(judged(0.05, 0.2), Verdict::Undecided);
        assert_eq!(judged(0.5, 0.2), Verdict::Differs);
        // One run has no interval.
        assert_eq!(judged(0.0, f64::INFINITY), Verdict::Undecided);
    }

    #[test]
    fn what_is_not_a_number_decides_nothing() {
        for bad in [f64::NAN, f64::INFINITY] {
            assert_eq!(judge(estimate(bad, 0.01), 0.0, 1.0), Verdict::Undecided);
            assert_eq!(judge(estimate(0.0, bad), 0.0, 1.0), Verdict::Undecided);
            assert_eq!(judge(estimate(0.0, 0.01), bad, 1.0), Verdict::Undecided);
            assert_eq!(judge(estimate(0.0, 0.01), 0.0, bad), Verdict::Undecided);
        }
        assert_eq!(rises(estimate(f64::NAN, 0.01)), Verdict::Undecided);
        assert_eq!(rises(estimate(1.0, f64::INFINITY)), Verdict::Undecided);
    }

    /// A bias that finer settings show is not a tolerance.
    #[test]
    fn the_finer_value_is_judged() {
        let coarse = estimate(-0.015, 0.02);
        let finer = |difference| Finer {
            change: estimate(-0.03, 0.02),
            difference,
        };
        assert_eq!(judge(coarse, 0.0, 1.0), Verdict::Agrees);
        let shifted = judged(coarse, Some(finer(None)));
        assert!((shifted.mean + 0.045).abs() < 1e-12);
        assert!((shifted.half - 0.02 * 2f64.sqrt()).abs() < 1e-12);
        assert_eq!(judge(shifted, 0.0, 1.0), Verdict::Differs);
        let own = estimate(-0.045, 0.003);
        assert_eq!(judged(coarse, Some(finer(Some(own)))), own);
    }
}
