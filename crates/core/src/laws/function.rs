//! The functions of a law that are called over a batch.

/// A call over a batch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Call {
    /// New contacts.
    Initialise,
    /// Start of a step.
    Prepare,
    /// End of a step.
    Commit,
    /// Stored energy.
    Energy,
}

impl Call {
    /// The function of the plugin table.
    pub fn name(self) -> &'static str {
        match self {
            Self::Initialise => "initialise",
            Self::Prepare => "prepare",
            Self::Commit => "commit",
            Self::Energy => "energy",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn calls_have_the_names_of_their_functions() {
        let calls = [Call::Initialise, Call::Prepare, Call::Commit, Call::Energy];
        let names = calls.map(Call::name);
        assert_eq!(names, ["initialise", "prepare", "commit", "energy"]);
    }
}
