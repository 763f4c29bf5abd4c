//! The functions of a law that are called for a batch of contacts.

/// A call for a batch of contacts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Call {
    /// Sets the variables of new contacts.
    Initialise,
    /// Computes the response at the start of a step.
    Prepare,
    /// Updates the variables at the end of a step.
    Commit,
    /// Computes the stored energy.
    Energy,
}

impl Call {
    /// Name of the function in the plugin table.
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
