//! What is expected of a row, and whether it came so.

/// A limit that the program told of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Cause {
    /// `TOO FAST`: contacts were first seen overlapping.
    Late,
    /// `TOO FAST`: a body moved so far in a step that not all in its way was looked at.
    Unwatched,
    /// `TOO FAST`: two bodies went into or through each other within a step.
    Passed,
    /// `NOT CONVERGED`.
    Unconverged,
    /// The scene was refused, in a sentence that holds these words.
    Refused(&'static str),
    /// A step ended the run.
    Stopped,
}

impl Cause {
    /// What its sentence must hold: what to change.
    fn proposal(self) -> &'static str {
        match self {
            Self::Late | Self::Unwatched | Self::Passed => "take a smaller time.step",
            Self::Unconverged => "take a smaller time.step, raise solver.max_iterations",
            Self::Refused(words) => words,
            Self::Stopped => "",
        }
    }
}

/// What a row declares.
#[derive(Clone, Copy, Debug)]
pub struct Expected {
    /// Whether its criterion is met.
    pub met: bool,
    /// All that is told, in this order.
    pub told: &'static [Cause],
}

/// The criterion is met and nothing is told.
pub const HELD: Expected = Expected {
    met: true,
    told: &[],
};

/// The criterion is missed, and these causes are told.
pub const fn told(told: &'static [Cause]) -> Expected {
    Expected { met: false, told }
}

/// The criterion is met, and these causes are told none the less.
pub const fn held_though(told: &'static [Cause]) -> Expected {
    Expected { met: true, told }
}

/// What became of a scene.
pub enum Verdict {
    /// The criterion is met, as expected; with what was told none the less.
    Held(String),
    /// It is not, and the program said why, as expected.
    Told(String),
    /// All else.
    Broken(String),
}

impl Verdict {
    /// Compares what came with what was expected. Numbers that are not finite, or a ledger that does not close, are
    /// never excused.
    pub fn new(expected: Expected, met: bool, sound: bool, told: &[(Cause, String)]) -> Self {
        let mut words: Vec<&str> = told.iter().map(|(_, words)| words.as_str()).collect();
        // One sentence may tell of two causes.
        words.dedup();
        let words = words.join("; ");
        let causes = told.iter().map(|(cause, _)| cause);
        if !sound {
            Self::Broken(format!(
                "not all is finite, or the ledger does not close; {words}"
            ))
        } else if met != expected.met {
            let what = if met { "held" } else { "missed" };
            Self::Broken(format!(
                "the criterion is {what}, against what is expected; {words}"
            ))
        } else if !causes.eq(expected.told) {
            Self::Broken(format!("expected to be told {:?}; {words}", expected.told))
        } else if let Some((cause, _)) = told.iter().find(|(c, w)| !w.contains(c.proposal())) {
            Self::Broken(format!("{cause:?} proposes nothing; {words}"))
        } else if met {
            Self::Held(words)
        } else {
            Self::Told(words)
        }
    }
}

/// A row of the table.
pub struct Row {
    /// The value of the extreme.
    pub value: String,
    /// The figures that were found.
    pub found: String,
    /// What became of it.
    pub verdict: Verdict,
}

/// Dimensions, each with what runs its rows.
pub type Runs = &'static [(u8, fn() -> Vec<Row>)];

/// Rows of one kind.
pub struct Group {
    /// Its name.
    pub name: &'static str,
    /// What must hold.
    pub criterion: &'static str,
    /// Runs them, in each dimension that has them.
    pub runs: Runs,
    /// Whether it takes seconds at most, so that the tests run it too.
    pub quick: bool,
}

/// A row whose scene could not be built.
pub fn refused(value: String, expected: Expected, words: &str) -> Row {
    let first = words.lines().next().unwrap_or_default();
    let sentence = first.split_once("error: ").map_or(first, |(_, s)| s);
    let cause = match expected.told {
        [cause @ Cause::Refused(words)] if sentence.contains(words) => *cause,
        _ => Cause::Refused(""),
    };
    Row {
        value,
        found: "refused".to_owned(),
        verdict: Verdict::new(expected, false, true, &[(cause, sentence.to_owned())]),
    }
}
