//! A warning about a run: what was seen, and what to change.

/// Heading of what a run ended before.
pub const NOT_REACHED: &str = "NOT REACHED";

/// A warning.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Warning {
    /// What it is of, such as `NOT CONVERGED`.
    pub of: &'static str,
    /// What was seen, and what to change.
    pub text: String,
    /// Whether results are not to be trusted because of it; else it is a note.
    pub serious: bool,
}

impl Warning {
    /// A reason not to trust the run.
    pub fn serious(of: &'static str, text: impl Into<String>) -> Self {
        let text = text.into();
        let serious = true;
        Self { of, text, serious }
    }

    /// What is worth knowing.
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
