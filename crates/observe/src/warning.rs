//! Warnings about a run: what was observed, and what to change.

/// Category of events that the run ended before.
pub const NOT_REACHED: &str = "NOT REACHED";

/// A warning.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Warning {
    /// Category, such as `NOT CONVERGED`.
    pub of: &'static str,
    /// What was observed, and what to change.
    pub text: String,
    /// Whether results are not trustworthy because of it; otherwise it is a note.
    pub serious: bool,
}

impl Warning {
    /// A warning that makes the run untrustworthy.
    pub fn serious(of: &'static str, text: impl Into<String>) -> Self {
        let text = text.into();
        let serious = true;
        Self { of, text, serious }
    }

    /// A note that does not affect trust in the run.
    pub fn note(of: &'static str, text: impl Into<String>) -> Self {
        let text = text.into();
        let serious = false;
        Self { of, text, serious }
    }
}

impl std::fmt::Display for Warning {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}: {}", self.of, self.text)
    }
}
