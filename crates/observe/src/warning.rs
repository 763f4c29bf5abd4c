//! Warnings about a run: the observation, and what to change.

/// Category of events that the run did not reach.
pub const NOT_REACHED: &str = "NOT REACHED";

/// A warning.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Warning {
    /// Category, such as `NOT CONVERGED`.
    pub of: &'static str,
    /// The observation, and what to change.
    pub text: String,
    /// Whether results are not trustworthy because of it; otherwise it is a note.
    pub serious: bool,
}

impl Warning {
    /// Creates a warning that makes the run untrustworthy.
    pub fn serious(of: &'static str, text: impl Into<String>) -> Self {
        let text = text.into();
        let serious = true;
        Self { of, text, serious }
    }

    /// Returns the warning of energies or forces that are not finite.
    pub fn infinite() -> Self {
        let text = "energies or friction are not finite: forces, speeds or sizes of the case exceed the range of double precision";
        Self::serious("NOT FINITE", text)
    }

    /// Creates a note that does not affect trust in the run.
    pub fn note(of: &'static str, text: impl Into<String>) -> Self {
        let text = text.into();
        let serious = false;
        Self { of, text, serious }
    }
}

/// Categories in the order in which they are reported; those of other observers follow.
const ORDER: &[&str] = &[
    "INTERRUPTED",
    "STOPPED",
    "NOT FINITE",
    "REPORTED TWICE",
    "ENERGY DOES NOT ADD UP",
    "FRICTION GIVES ENERGY",
    "HEAT DOES NOT ADD UP",
    "IMPOSSIBLE MOTION",
    "TOO FAST",
    "FOUND OVERLAPPING",
    "OVERLAP",
    "MOTION LOST",
    "NOT SMALL STRAIN",
    "LOAD AT BORDER",
    "COARSE CONTACT",
    "ALIASED DRIVE",
    "NOT CONVERGED",
    "LOOSE VELOCITIES",
    "NOT COUPLED",
    "LAWS NOT MET",
    "NOT IN RANGE",
    "NOT CERTIFIED",
    "GRAINS DO NOT ADD UP",
    NOT_REACHED,
    "NOT JUMPED",
    "JUMP ERROR UNKNOWN",
    "NOT CHECKED",
    "CYCLES CHANGE",
    "JUMPS TOO LONG",
    "EDGES MET",
    "TIME INTEGRATION",
    "BONDS NOT RESOLVED",
    "NO COMPLETE CYCLE",
    "NOT STEADY",
    "NO HEAT",
    "SHALLOW HALF-SPACES",
    "HEAT OUT OF RANGE",
    "NEAREST PLACES",
    "COARSE DRIVE",
    "LAW DEFAULT",
    "NO WEAR RATE",
    "OTHER MOTION",
    "POSITION CORRECTION",
    "ACCURACY NOT SHOWN",
    "ESTIMATED ERROR",
    "ERROR NOT KNOWN",
    "NOT UNIQUE",
];

/// Sorts serious warnings before notes, and both in the order of their categories.
pub fn sort(list: &mut [Warning]) {
    let place = |w: &Warning| ORDER.iter().position(|of| *of == w.of);
    list.sort_by_key(|w| (!w.serious, place(w).unwrap_or(ORDER.len())));
}

impl std::fmt::Display for Warning {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}: {}", self.of, self.text)
    }
}
