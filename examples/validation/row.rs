//! A row of the summary, and the rule of its verdict.

use crate::sample::Estimate;

/// Beyond its intervals a number is still called close up to this share of the published one.
pub const CLOSE: f64 = 0.02;
/// A comparison is not decided if its intervals add up to more than this share of the published number.
pub const WIDE: f64 = 0.1;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    Agrees,
    Close,
    Differs,
    Undecided,
}

impl Verdict {
    pub fn text(self) -> &'static str {
        match self {
            Self::Agrees => "agrees",
            Self::Close => "within 2 %",
            Self::Differs => "**differs**",
            Self::Undecided => "not decided",
        }
    }
}

/// `difference` from the published number with the half-width over seeds, the error of step and tolerance, and half of the
/// published interval.
pub fn judge(difference: Estimate, numerical: f64, range: f64, published: f64) -> Verdict {
    let reach = difference.half + numerical + range;
    let off = difference.mean.abs();
    let whole = published.abs();
    if off > reach {
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

/// Texts of the columns.
#[derive(Clone, Debug)]
pub struct Row {
    pub quantity: String,
    pub ours: String,
    pub numerical: String,
    pub published: String,
    pub difference: String,
    pub verdict: String,
}

/// A published number, with half of its range (0 if none is given), and how it is written.
pub struct Theirs {
    pub value: f64,
    pub range: f64,
    pub digits: usize,
}

impl Theirs {
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

impl Row {
    /// A number of ours beside a published one. `numerical` is the change with finer step and tolerance, `difference` that of
    /// each seed from what is published at its own conditions.
    pub fn number(
        quantity: impl Into<String>,
        ours: Estimate,
        difference: Estimate,
        numerical: Option<Estimate>,
        theirs: &Theirs,
    ) -> Self {
        let error = numerical.map_or(0.0, |n| n.mean.abs());
        Self {
            quantity: quantity.into(),
            ours: ours.text(theirs.digits),
            numerical: numerical.map_or("-".to_owned(), |n| n.percent(ours.mean)),
            published: theirs.text(),
            difference: difference.percent(theirs.value),
            verdict: judge(difference, error, theirs.range, theirs.value)
                .text()
                .to_owned(),
        }
    }

    /// A published statement without a number; `holds` is `None` where the runs do not tell.
    pub fn statement(
        quantity: impl Into<String>,
        ours: impl Into<String>,
        numerical: Option<String>,
        published: impl Into<String>,
        holds: Option<bool>,
    ) -> Self {
        let verdict = match holds {
            Some(true) => Verdict::Agrees,
            Some(false) => Verdict::Differs,
            None => Verdict::Undecided,
        };
        Self {
            quantity: quantity.into(),
            ours: ours.into(),
            numerical: numerical.unwrap_or("-".to_owned()),
            published: published.into(),
            difference: "-".to_owned(),
            verdict: verdict.text().to_owned(),
        }
    }

    pub fn cells(&self) -> Vec<String> {
        let r = self.clone();
        vec![
            r.quantity,
            r.ours,
            r.numerical,
            r.published,
            r.difference,
            r.verdict,
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rule_of_the_verdict() {
        let judged = |mean: f64, half: f64| judge(Estimate { mean, half }, 0.01, 0.0, 1.0);
        assert_eq!(judged(0.02, 0.02), Verdict::Agrees);
        assert_eq!(judged(-0.02, 0.005), Verdict::Close);
        assert_eq!(judged(0.05, 0.02), Verdict::Differs);
        assert_eq!(judged(0.05, 0.2), Verdict::Undecided);
        assert_eq!(judged(0.5, 0.2), Verdict::Differs);
        // One run has no interval.
        assert_eq!(judged(0.0, f64::INFINITY), Verdict::Undecided);
    }
}
