//! Errors of loading and calling laws.

use super::function::Call;
use super::kind::Kind;
use super::names::{PATH_VARIABLE, name_is_valid};
use super::outputs::Range;
use std::path::PathBuf;

/// Error of loading or calling a law.
#[derive(Debug, thiserror::Error)]
pub enum LawError {
    /// The library cannot be loaded, or is not a Fretwork plugin.
    #[error("cannot use the plugin {}: {reason}", path.display())]
    Unusable {
        /// The library.
        path: PathBuf,
        /// The problem and its remedy.
        reason: String,
    },
    /// Opening the library loaded other libraries than its file names.
    #[error("cannot use the plugin {}: {reason}", path.display())]
    UnexpectedLibraries {
        /// The library.
        path: PathBuf,
        /// The problem and its remedy.
        reason: String,
    },
    /// The law could not be tested, for a reason outside the law.
    #[error("the {kind} law `{name}` could not be tested: {reason}")]
    Untested {
        /// Kind.
        kind: Kind,
        /// Name.
        name: String,
        /// The problem and its remedy.
        reason: String,
    },
    /// The library does not have the SHA-256 that is pinned.
    #[error("the plugin {} has the SHA-256 {sha256}, not {pin} as pinned; get the library that the case was made with, or pin this one if you trust it", path.display())]
    HashMismatch {
        /// The library.
        path: PathBuf,
        /// Expected SHA-256.
        pin: String,
        /// Actual SHA-256.
        sha256: String,
    },
    /// No law of this name is on the search path.
    #[error("there is no {kind} law named `{name}` (available: {available}; looked in {searched}); {}", advice(name, nearest.as_deref()))]
    Unknown {
        /// Requested kind.
        kind: Kind,
        /// Requested name.
        name: String,
        /// Available laws.
        available: String,
        /// Folders searched.
        searched: String,
        /// The most similar name.
        nearest: Option<String>,
    },
    /// The law rejects the parameters.
    #[error("the {kind} law `{name}` refuses its parameters: {reason}")]
    Parameters {
        /// Kind.
        kind: Kind,
        /// Name.
        name: String,
        /// The law's message.
        reason: String,
    },
    /// The laws of an interface are incompatible.
    #[error("{reason}")]
    Incompatible {
        /// Reason.
        reason: String,
    },
    /// A kind that cannot be registered.
    #[error("{reason}")]
    Kind {
        /// Reason.
        reason: String,
    },
    /// A call failed.
    #[error("the {kind} law `{name}` failed in {call:?}{}: {reason}", contact.map_or(String::new(), |c| format!(" at contact {c} of its batch")))]
    Failed {
        /// Kind.
        kind: Kind,
        /// Name.
        name: String,
        /// The call.
        call: Call,
        /// Index in the batch.
        contact: Option<usize>,
        /// The law's message.
        reason: String,
        /// Whether the law asks for a smaller time step (`FW_REDUCE_STEP`).
        smaller_step: bool,
    },
    /// A function of the law wrote beyond the end of a column.
    #[error(
        "the {kind} law `{name}` wrote behind the end of a column in {call:?}: a batch has n values per column, and memory that is not \
         the law's may be corrupted; fix the law before using it again"
    )]
    Overrun {
        /// Kind.
        kind: Kind,
        /// Name.
        name: String,
        /// The call.
        call: Call,
    },
    /// A function of the law reported success but returned a value that is not finite.
    #[error("the {kind} law `{name}` gave a value that is not finite in {call:?}{}; check its parameters and the law", contact.map_or(String::new(), |c| format!(" at contact {c} of its batch")))]
    NotFinite {
        /// Kind.
        kind: Kind,
        /// Name.
        name: String,
        /// The call.
        call: Call,
        /// Index in the batch.
        contact: Option<usize>,
    },
    /// A function of the law reported success but returned a value outside its physical range.
    #[error(
        "the {kind} law `{name}` gave {value:e} as `{column}` in {call:?}{}; it must lie in {range}: check its parameters and the law",
        contact.map_or(String::new(), |c| format!(" at contact {c} of its batch"))
    )]
    OutOfRange {
        /// Kind.
        kind: Kind,
        /// Name.
        name: String,
        /// The call.
        call: Call,
        /// Index in the batch.
        contact: Option<usize>,
        /// Column, named as in the plugin interface.
        column: &'static str,
        /// Returned value.
        value: f64,
        /// Accepted range.
        range: Range,
    },
    /// A function of the law wrote to memory outside its outputs, or returned different results for
    /// equal inputs.
    #[error("the {kind} law `{name}` {what} in {call:?}; fix the law before using it again")]
    ContractViolation {
        /// Kind.
        kind: Kind,
        /// Name.
        name: String,
        /// The call.
        call: Call,
        /// Description of the violation.
        what: String,
    },
    /// An error in an interface of a case.
    #[error("{source} (interface `{interface}`{})", bodies.map_or(String::new(), |[i, j]| format!(", contact of bodies {i} and {j}")))]
    At {
        /// Name of the interface.
        interface: String,
        /// Indices of the bodies, from 0, if the error is in one contact.
        bodies: Option<[u32; 2]>,
        /// The error.
        source: Box<LawError>,
    },
}

impl LawError {
    /// Returns the law whose call failed.
    pub fn law(&self) -> Option<(Kind, &str)> {
        match self {
            Self::Parameters { kind, name, .. }
            | Self::Failed { kind, name, .. }
            | Self::Overrun { kind, name, .. }
            | Self::NotFinite { kind, name, .. }
            | Self::OutOfRange { kind, name, .. }
            | Self::ContractViolation { kind, name, .. }
            | Self::Untested { kind, name, .. } => Some((*kind, name)),
            Self::At { source, .. } => source.law(),
            Self::Unusable { .. }
            | Self::UnexpectedLibraries { .. }
            | Self::HashMismatch { .. }
            | Self::Unknown { .. }
            | Self::Incompatible { .. }
            | Self::Kind { .. } => None,
        }
    }

    /// Whether the law asks for a smaller time step.
    pub fn asks_for_smaller_step(&self) -> bool {
        match self {
            Self::Failed { smaller_step, .. } => *smaller_step,
            Self::At { source, .. } => source.asks_for_smaller_step(),
            _ => false,
        }
    }

    /// Returns the name of the interface whose law failed.
    pub fn interface(&self) -> Option<&str> {
        match self {
            Self::At { interface, .. } => Some(interface),
            _ => None,
        }
    }

    /// Returns whether the law misbehaved without reporting an error.
    pub fn is_silent(&self) -> bool {
        match self {
            Self::NotFinite { .. } | Self::Overrun { .. } => true,
            Self::At { source, .. } => source.is_silent(),
            _ => false,
        }
    }

    /// Returns whether an output was out of its range, also where this is the source of the error
    /// of an interface.
    pub(super) fn out_of_range(&self) -> bool {
        match self {
            Self::At { source, .. } => source.out_of_range(),
            _ => matches!(self, Self::OutOfRange { .. }),
        }
    }

    /// Returns the contact with the error, as an index in the batch.
    pub(super) fn contact(&self) -> Option<usize> {
        match self {
            Self::Failed { contact, .. }
            | Self::NotFinite { contact, .. }
            | Self::OutOfRange { contact, .. } => *contact,
            _ => None,
        }
    }
}

fn advice(name: &str, nearest: Option<&str>) -> String {
    match nearest {
        Some(nearest) => format!("did you mean `{nearest}`?"),
        None if !name_is_valid(name) => {
            "a law is named by a-z, 0-9, `-` and `_`, never by a path".into()
        }
        None => format!(
            "name the folder of its library with --plugin-path or in {}",
            PATH_VARIABLE
        ),
    }
}
