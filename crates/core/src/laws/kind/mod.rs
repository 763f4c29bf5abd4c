//! Kinds of interface laws: a registry with one entry per kind.
//!
//! An interface is a list of slots, with at most one law of each kind. Everything that depends on
//! the kind is in its [`KindSpec`]: the keyword that cases, file names and the command line use,
//! the code in the plugin table, the functions that a law must implement, the contacts on which it
//! acts, its outputs, its requirements on the other slots, what the host does with it at the end of
//! a step, how it is certified, and the templates of `fretwork law new`. A further kind is one such
//! entry, here or in another crate by [`Kind::register`].

pub mod cohesion;
pub mod contact;
pub mod damage;
pub mod transport;
pub mod wear;

use super::error::LawError;
use super::function::Call;
use super::interface::Interface;
pub use super::outputs::Output;
use super::outputs::Outputs;
use super::slot::SlotCommit;
use crate::geometry::space::{Dim2, Dim3, Space};
use std::any::Any;
use std::fmt;
use std::hash::{Hash, Hasher};
use std::sync::{PoisonError, RwLock};

/// A kind of interface law. Kinds are ordered by their codes; the laws of an interface are
/// evaluated in this order.
#[derive(Clone, Copy)]
pub struct Kind(&'static KindSpec);

/// Properties of a kind.
pub struct KindSpec {
    /// The word used in cases, file names and on the command line: a-z.
    pub word: &'static str,
    /// Code in the plugin table, which also gives the order of evaluation.
    pub code: i32,
    /// Purpose of laws of this kind, in one line.
    pub doc: &'static str,
    /// Functions that a law of this kind must implement.
    pub functions: &'static [Call],
    /// Contacts on which laws of this kind act.
    pub domain: Domain,
    /// The columns that a call writes.
    pub outputs: for<'a> fn(&'a mut Outputs, Call) -> Vec<Output<'a>>,
    /// Check of the other slots of the interface.
    pub fits: fn(&Interface) -> Result<(), LawError>,
    /// Function that uses the outputs of a law of this kind at the end of a step, for laws that act
    /// on contacts, not on bonds. Laws without a `prepare` receive slip and friction work in
    /// addition to the state of the contacts; the others are called only if they have internal
    /// variables.
    pub commit: CommitHook,
    /// Certification of laws of this kind.
    pub certificate: CertificateSpec,
    /// Templates of `fretwork law new`; `None` if it does not offer the kind.
    pub templates: Option<Templates>,
}

/// Contacts on which laws of a kind act.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Domain {
    /// All contacts, including those predicted before they close because the bodies are fast.
    All,
    /// Contacts within the alert distance or held by a bond.
    Near,
    /// Intact bonds.
    Bonds,
    /// Intact bonds if the law has an opening (`FLAG_OPENING`), otherwise as [`Domain::Near`].
    ByOpening,
}

/// Function that uses the outputs of a law at the end of a step.
pub type CommitFn<S> = for<'a, 'b> fn(&'a mut SlotCommit<'b, S>) -> Result<(), LawError>;

/// A [`CommitFn`] for each dimension; [`commit_hook!`](crate::commit_hook) creates it.
#[derive(Clone, Copy)]
pub struct CommitHook {
    /// Function in two dimensions.
    pub dim2: CommitFn<Dim2>,
    /// Function in three dimensions.
    pub dim3: CommitFn<Dim3>,
}

impl CommitHook {
    /// The function for a space.
    pub(super) fn of<S: Space>(&self) -> Option<CommitFn<S>> {
        let known: [&dyn Any; 2] = [&self.dim2, &self.dim3];
        let mut fitting = known.into_iter().filter_map(|f| f.downcast_ref());
        fitting.next().copied()
    }
}

/// Creates a [`CommitHook`] from a function that is generic over the space.
#[macro_export]
macro_rules! commit_hook {
    ($function:path) => {
        $crate::laws::kind::CommitHook {
            dim2: |slot| $function(slot),
            dim3: |slot| $function(slot),
        }
    };
}

/// Certification of the laws of a kind.
#[derive(Clone, Copy, Debug)]
pub struct CertificateSpec {
    /// Partner laws, by kind and name; a certificate is made with each of these sets. A set without
    /// a contact law gets a frictionless one, unless the tested law is a contact law.
    pub partners: &'static [&'static [(Kind, &'static str)]],
    /// Checks of the certificate.
    pub checks: CheckSet,
}

/// Checks of a certificate, in addition to those of the plugin interface that all laws must pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CheckSet {
    /// Signs and objectivity of laws of contacts.
    Contact,
    /// Work, damage and convergence of bonds, where the laws make bonds; otherwise as
    /// [`CheckSet::Contact`].
    Bond,
    /// The checks of [`CheckSet::Contact`], and that the volume removed does not depend on the
    /// number of steps.
    Removal,
    /// Conductances are not negative, symmetric in the bodies, and continuous in force, gap, damage
    /// and temperature.
    Transport,
}

/// Templates of `fretwork law new`, by language. `@NAME@`, `@TYPE@`, `@KIND@`, `@KINDUP@` and
/// `@VERSION@` are replaced.
#[derive(Clone, Copy, Debug)]
pub struct Templates {
    /// Rust, with the crate `fretwork-law`.
    pub rust: &'static str,
    /// C, without the parts that all laws share, see [`Self::whole_c`].
    pub c: &'static str,
    /// Fortran, without the parts that all laws share, see [`Self::whole_fortran`].
    pub fortran: &'static str,
}

impl Templates {
    /// Returns the template in C, with the shared parts that it names.
    pub fn whole_c(&self) -> String {
        framed(self.c, include_str!("templates/frame.c"))
    }

    /// Returns the template in Fortran, with the shared parts that it names.
    pub fn whole_fortran(&self) -> String {
        framed(self.fortran, include_str!("templates/frame.f90"))
    }
}

/// Returns a template in which lines `@PART@` are replaced by the parts of a frame, each of which
/// begins with a line `@@ PART`.
fn framed(template: &str, frame: &str) -> String {
    let parts = frame.split("@@ ").filter_map(|part| part.split_once('\n'));
    parts.fold(template.to_owned(), |text, (name, part)| {
        text.replace(&format!("@{name}@\n"), part)
    })
}

/// Includes the template files of a kind from this folder.
macro_rules! templates {
    ($word:literal) => {
        Some($crate::laws::kind::Templates {
            rust: include_str!(concat!("templates/", $word, ".rs.txt")),
            c: include_str!(concat!("templates/", $word, ".c")),
            fortran: include_str!(concat!("templates/", $word, ".f90")),
        })
    };
}
use templates;

/// Accepts any slots, for laws without requirements on the others.
///
/// # Errors
/// It never fails.
pub fn fits_always(_: &Interface) -> Result<(), LawError> {
    Ok(())
}

/// Returns no columns, for laws that write only their internal variables.
pub fn no_outputs(_: &mut Outputs, _: Call) -> Vec<Output<'_>> {
    Vec::new()
}

/// Does nothing, for laws of which the host only stores the new internal variables: laws whose
/// outputs are used at the start of a step, and laws that only observe contacts.
///
/// # Errors
/// It never fails.
pub fn commit_record<S: Space>(_: &mut SlotCommit<'_, S>) -> Result<(), LawError> {
    Ok(())
}

/// Kinds that other crates have registered.
static REGISTERED: RwLock<Vec<Kind>> = RwLock::new(Vec::new());

impl Kind {
    /// Friction, restitution, rolling.
    pub const CONTACT: Self = Self(&contact::SPEC);
    /// Traction against opening.
    pub const COHESION: Self = Self(&cohesion::SPEC);
    /// Growth of damage.
    pub const DAMAGE: Self = Self(&damage::SPEC);
    /// Removal of material.
    pub const WEAR: Self = Self(&wear::SPEC);

    /// Thermal and electrical conductance.
    pub const TRANSPORT: Self = Self(&transport::SPEC);

    /// The kinds of the plugin interface, in the order of evaluation.
    pub const BUILT_IN: [Self; 5] = [
        Self::CONTACT,
        Self::COHESION,
        Self::DAMAGE,
        Self::WEAR,
        Self::TRANSPORT,
    ];

    /// Adds a kind for the lifetime of the program: afterwards its keyword is a slot of cases, and
    /// plugins may have its code. Registering a kind again has no effect.
    ///
    /// # Errors
    /// The keyword has other letters than a-z, or belongs to another kind; the code is below those
    /// of the built-in kinds, or belongs to another kind; or the domain is that of bonds.
    pub fn register(spec: &'static KindSpec) -> Result<Self, LawError> {
        let refuse = |reason: String| Err(LawError::Kind { reason });
        if spec.word.is_empty() || !spec.word.chars().all(|c| c.is_ascii_lowercase()) {
            return refuse(format!("the kind `{}` must be named by a-z", spec.word));
        }
        if spec.code <= Self::TRANSPORT.code() {
            return refuse(format!(
                "the kind `{}` cannot have the code {}: codes up to {} are those of the kinds of the plugin interface",
                spec.word,
                spec.code,
                Self::TRANSPORT.code()
            ));
        }
        if !matches!(spec.domain, Domain::All | Domain::Near) {
            return refuse(format!(
                "the kind `{}` asks for intact bonds, on which cohesion and damage laws act alone; take Domain::All or Domain::Near",
                spec.word
            ));
        }
        let mut registered = REGISTERED.write().unwrap_or_else(PoisonError::into_inner);
        if let Some(same) = registered.iter().find(|k| std::ptr::eq(k.0, spec)) {
            return Ok(*same);
        }
        for other in Self::BUILT_IN.iter().chain(registered.iter()) {
            if other.word() == spec.word || other.code() == spec.code {
                return refuse(format!(
                    "the kind `{}` of code {} cannot be registered: `{other}` has code {}",
                    spec.word,
                    spec.code,
                    other.code()
                ));
            }
        }
        let kind = Self(spec);
        registered.push(kind);
        registered.sort_unstable();
        Ok(kind)
    }

    /// Returns all kinds, in the order of evaluation.
    pub fn all() -> Vec<Self> {
        let registered = REGISTERED.read().unwrap_or_else(PoisonError::into_inner);
        let mut all: Vec<Self> = Self::BUILT_IN
            .into_iter()
            .chain(registered.iter().copied())
            .collect();
        all.sort_unstable();
        all
    }

    /// The kind of a word.
    pub fn from_word(word: &str) -> Option<Self> {
        Self::all().into_iter().find(|k| k.word() == word)
    }

    /// The kind of a code of the plugin table.
    pub fn from_code(code: i32) -> Option<Self> {
        Self::all().into_iter().find(|k| k.code() == code)
    }

    /// The word used in cases and file names.
    pub fn word(self) -> &'static str {
        self.0.word
    }

    /// The code in the plugin table.
    pub fn code(self) -> i32 {
        self.0.code
    }

    /// Returns the properties of the kind.
    pub fn spec(self) -> &'static KindSpec {
        self.0
    }

    /// The words of all kinds as a list in a sentence: `a, b or c`.
    pub fn words() -> String {
        let words: Vec<&str> = Self::all().into_iter().map(Self::word).collect();
        match words.split_last() {
            Some((last, rest)) if !rest.is_empty() => format!("{} or {last}", rest.join(", ")),
            _ => words.join(""),
        }
    }
}

impl PartialEq for Kind {
    fn eq(&self, other: &Self) -> bool {
        self.code() == other.code()
    }
}

impl Eq for Kind {}

impl PartialOrd for Kind {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Kind {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.code().cmp(&other.code())
    }
}

impl Hash for Kind {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.code().hash(state);
    }
}

impl fmt::Debug for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Kind({})", self.word())
    }
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.word())
    }
}
