//! Expected and actual results of a row.

/// A limit that the program reports.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Cause {
    /// `TOO FAST`: contacts were first seen overlapping.
    Late,
    /// `TOO FAST`: a body moved farther in a step than the neighbour list covers.
    Unwatched,
    /// `TOO FAST`: two bodies passed into or through each other within a step.
    Passed,
    /// `NOT CONVERGED`.
    Unconverged,
    /// The scene was rejected with a message that contains these words.
    Refused(&'static str),
    /// A failed step ended the run.
    Stopped,
}

impl Cause {
    /// Words that the message must contain as advice.
    fn proposal(self) -> &'static str {
        match self {
            Self::Late | Self::Unwatched | Self::Passed => "take a smaller time.step",
            Self::Unconverged => "take a smaller time.step, raise solver.max_iterations",
            Self::Refused(words) => words,
            Self::Stopped => "",
        }
    }
}

/// Expectation of a row.
#[derive(Clone, Copy, Debug)]
pub struct Expected {
    /// Whether its criterion is met.
    pub met: bool,
    /// All reported causes, in this order.
    pub reported: &'static [Cause],
}

/// The criterion is met without warnings.
pub const HELD: Expected = Expected {
    met: true,
    reported: &[],
};

/// The criterion is missed, and these causes are reported.
pub const fn reported(reported: &'static [Cause]) -> Expected {
    Expected {
        met: false,
        reported,
    }
}

/// The criterion is met, but these causes are reported.
pub const fn held_though(reported: &'static [Cause]) -> Expected {
    Expected {
        met: true,
        reported,
    }
}

/// Result of a scene.
pub enum Verdict {
    /// The criterion is met, as expected; with the warnings.
    Held(String),
    /// The criterion is missed and the program reported the cause, as expected.
    Reported(String),
    /// Anything else.
    Broken(String),
}

impl Verdict {
    /// Compares the result with the expectation. Non-finite numbers, or a ledger that does not
    /// close, always count as broken.
    pub fn new(expected: Expected, met: bool, sound: bool, reported: &[(Cause, String)]) -> Self {
        let mut words: Vec<&str> = reported.iter().map(|(_, words)| words.as_str()).collect();
        // One message may report two causes.
        words.dedup();
        let words = words.join("; ");
        let causes = reported.iter().map(|(cause, _)| cause);
        if !sound {
            Self::Broken(format!(
                "not all is finite, or the ledger does not close; {words}"
            ))
        } else if met != expected.met {
            let what = if met { "met" } else { "missed" };
            Self::Broken(format!(
                "the criterion is {what}, against what is expected; {words}"
            ))
        } else if !causes.eq(expected.reported) {
            Self::Broken(format!("expected reports {:?}; {words}", expected.reported))
        } else if let Some((cause, _)) = reported.iter().find(|(c, w)| !w.contains(c.proposal())) {
            Self::Broken(format!("{cause:?} proposes nothing; {words}"))
        } else if met {
            Self::Held(words)
        } else {
            Self::Reported(words)
        }
    }
}

/// A row of the table.
pub struct Row {
    /// Value of the extreme parameter.
    pub value: String,
    /// Measured values.
    pub found: String,
    /// Verdict.
    pub verdict: Verdict,
}

/// Dimensions, each with the function that runs its rows.
pub type Runs = &'static [(u8, fn() -> Vec<Row>)];

/// Rows of one kind.
pub struct Group {
    /// Name of the group.
    pub name: &'static str,
    /// Criterion.
    pub criterion: &'static str,
    /// Functions that run it, by dimension.
    pub runs: Runs,
    /// Whether it takes seconds at most, so that the tests run it too.
    pub quick: bool,
}

/// A row whose scene could not be built.
pub fn refused(value: String, expected: Expected, words: &str) -> Row {
    let first = words.lines().next().unwrap_or_default();
    let sentence = first.split_once("error: ").map_or(first, |(_, s)| s);
    let cause = match expected.reported {
        [cause @ Cause::Refused(words)] if sentence.contains(words) => *cause,
        _ => Cause::Refused(""),
    };
    Row {
        value,
        found: "refused".to_owned(),
        verdict: Verdict::new(expected, false, true, &[(cause, sentence.to_owned())]),
    }
}
