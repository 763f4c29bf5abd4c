//! A plugin: a shared library that is opened, validated and called at run time.

use super::built_in::hex;
use super::kind::Kind;
use super::range::Range;
use super::{child, watch};
use fretwork_abi as abi;
use sha2::{Digest, Sha256};
use std::ffi::{CStr, c_char};
use std::mem::{MaybeUninit, offset_of};
use std::path::{Path, PathBuf};
use std::ptr;

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
    /// The library does not have the SHA-256 that is pinned.
    #[error("the plugin {} has the SHA-256 {sha256}, not {pin} as pinned; get the library that the case was made with, or pin this one if you trust it", path.display())]
    Pinned {
        /// The library.
        path: PathBuf,
        /// Expected SHA-256.
        pin: String,
        /// Actual SHA-256.
        sha256: String,
    },
    /// No law of this name is on the search path.
    #[error("there is no {kind} law named `{name}` (available: {available}; looked in {looked}); {}", advice(name, nearest.as_deref()))]
    Unknown {
        /// Requested kind.
        kind: Kind,
        /// Requested name.
        name: String,
        /// Available laws.
        available: String,
        /// Folders searched.
        looked: String,
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
    Pairing {
        /// Why.
        reason: String,
    },
    /// A kind that cannot be registered.
    #[error("{reason}")]
    Kind {
        /// Why.
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
    /// A function of the law wrote to memory it must not write, or returned different results for equal
    /// inputs.
    #[error("the {kind} law `{name}` {what} in {call:?}; fix the law before using it again")]
    Trespass {
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
            | Self::Trespass { kind, name, .. } => Some((*kind, name)),
            Self::At { source, .. } => source.law(),
            Self::Unusable { .. }
            | Self::Pinned { .. }
            | Self::Unknown { .. }
            | Self::Pairing { .. }
            | Self::Kind { .. } => None,
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
        None if !super::search::name_is_valid(name) => {
            "a law is named by a-z, 0-9, `-` and `_`, never by a path".into()
        }
        None => format!(
            "name the folder of its library with --plugin-path or in {}",
            super::search::VARIABLE
        ),
    }
}

/// A parameter or an internal variable.
#[derive(Clone, Debug, PartialEq)]
pub struct Field {
    /// Name.
    pub name: String,
    /// SI unit.
    pub unit: String,
    /// One-line description.
    pub doc: String,
    /// Default or initial value.
    pub default: f64,
    /// Smallest accepted value.
    pub minimum: f64,
    /// Largest accepted value.
    pub maximum: f64,
    /// Whether a variable is written to the results.
    pub output: bool,
}

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

/// The codes of kinds in words: those of the plugin interface, and those registered beside them.
fn known_codes() -> String {
    let more = Kind::all()
        .into_iter()
        .filter(|k| !Kind::BUILT_IN.contains(k));
    more.fold("1 to 4".to_owned(), |codes, kind| {
        format!("{codes}, or {}", kind.code())
    })
}

/// A checked plugin. Its library stays open for the life of the program.
#[derive(Clone, Debug)]
pub struct Plugin {
    /// Kind.
    pub kind: Kind,
    /// Name used in cases.
    pub name: String,
    /// Its own version.
    pub version: String,
    /// One-line description.
    pub doc: String,
    /// Paper or DOI of the model.
    pub reference: String,
    /// `FLAG_*` of the ABI.
    pub flags: u64,
    /// Exponent m of psi = (1 - D)^m psi_0.
    pub degradation: f64,
    /// Schema of the parameters.
    pub parameters: Vec<Field>,
    /// Schema of the internal variables.
    pub variables: Vec<Field>,
    /// File of the library, or of the program for a built-in law.
    pub path: PathBuf,
    /// SHA-256 of that file, in hexadecimal.
    pub sha256: String,
    /// Whether the law is linked into the program.
    pub built_in: bool,
    pub(super) table: abi::FwPlugin,
    pub(super) label: watch::Label,
}

// SAFETY: the table is read only, and the ABI requires every function to be callable from any thread at any
// time (pure, no globals).
unsafe impl Send for Plugin {}
// SAFETY: as above.
unsafe impl Sync for Plugin {}

impl Plugin {
    /// Opens a library and performs all checks possible before the first call.
    ///
    /// # Errors
    /// A sentence that names the file and the problem.
    pub fn open(path: &Path) -> Result<Self, LawError> {
        Self::open_pinned(path, None)
    }

    /// Opens a library only if it has the given SHA-256 (in hexadecimal); otherwise no code of it runs.
    ///
    /// # Errors
    /// As for [`Self::open`]; and [`LawError::Pinned`].
    pub fn open_pinned(path: &Path, pin: Option<&str>) -> Result<Self, LawError> {
        let refuse = |reason: String| LawError::Unusable {
            path: path.to_owned(),
            reason,
        };
        let digest = || {
            let bytes = std::fs::read(path);
            let bytes = bytes.map_err(|e| refuse(format!("it cannot be read ({e})")))?;
            Ok(hex(&Sha256::digest(&bytes)))
        };
        let sha256 = digest()?;
        if let Some(pin) = pin.filter(|p| !p.eq_ignore_ascii_case(&sha256)) {
            return Err(LawError::Pinned {
                path: path.to_owned(),
                pin: pin.to_owned(),
                sha256,
            });
        }
        child::survives(path, &sha256).map_err(&refuse)?;
        // The trial may have taken seconds, in which the file can change.
        if digest()? != sha256 {
            return Err(refuse(child::CHANGED.to_owned()));
        }
        let loading = watch::label(format!("the plugin {}", path.display()));
        let loading = watch::enter(loading, 5);
        // SAFETY: opening runs the library's initialisers; the user put it on the search path.
        let library = unsafe { open_local(path) }.map_err(|e| {
            refuse(format!(
                "it is not a loadable library ({e}); build it as a `cdylib`"
            ))
        })?;
        // SAFETY: the ABI defines the type of this symbol; a library with another type violates it.
        let table = unsafe {
            let entry = library
                .get::<abi::FwEntry>(abi::ENTRY_SYMBOL)
                .map_err(|_| {
                    refuse(format!(
                        "it does not export `{}`; it is not a Fretwork plugin",
                        abi::ENTRY_SYMBOL
                    ))
                })?;
            entry()
        };
        drop(loading);
        // Never unloaded: threads may be running its code or hold its thread-local data.
        std::mem::forget(library);
        // SAFETY: the ABI guarantees a complete static table.
        unsafe { Self::from_table(table, path, &sha256, false) }
    }

    /// Validates a table and copies the fields known to both versions of the ABI.
    ///
    /// # Safety
    /// The table is null or a static table of the ABI with static text.
    pub(super) unsafe fn from_table(
        table: *const abi::FwPlugin,
        path: &Path,
        sha256: &str,
        built_in: bool,
    ) -> Result<Self, LawError> {
        let refuse = |reason: String| LawError::Unusable {
            path: path.to_owned(),
            reason,
        };
        if table.is_null() || !table.is_aligned() {
            return Err(refuse(format!(
                "`{}` returned null or a misaligned address; return the address of a static table",
                abi::ENTRY_SYMBOL
            )));
        }
        // SAFETY: the table begins with its size and version, which are checked before anything else is
        // read.
        let table = unsafe { read_table(table) }.map_err(&refuse)?;
        let kind = Kind::from_code(table.kind).ok_or_else(|| {
            refuse(format!(
                "its kind {} is unknown; use {}",
                table.kind,
                known_codes()
            ))
        })?;
        // SAFETY: the ABI promises NUL-terminated static text.
        let text =
            |p, what: &str| unsafe { text(p) }.map_err(|e| refuse(format!("its {what} {e}")));
        let name = text(table.name, "name")?;
        if !super::search::name_is_valid(&name) {
            return Err(refuse(format!(
                "its name `{name}` must be made of a-z, 0-9, - and _, and begin with a letter or digit"
            )));
        }
        let plugin = Self {
            kind,
            version: text(table.version, "version")?,
            doc: text(table.doc, "doc")?,
            reference: text(table.reference, "reference")?,
            flags: table.flags,
            degradation: table.degradation,
            // SAFETY: count and array belong to one table.
            parameters: unsafe { fields(table.parameters, table.n_parameters, "parameter") }
                .map_err(&refuse)?,
            // SAFETY: as above.
            variables: unsafe { fields(table.variables, table.n_variables, "variable") }
                .map_err(&refuse)?,
            path: path.to_owned(),
            sha256: sha256.to_owned(),
            built_in,
            label: watch::label(format!("the {kind} law `{name}`")),
            name,
            table,
        };
        plugin.check().map_err(refuse)?;
        Ok(plugin)
    }

    fn check(&self) -> Result<(), String> {
        let needed = self.kind.spec().functions;
        if let Some(call) = needed.iter().find(|call| !self.has_function(**call)) {
            return Err(format!(
                "a {} law needs the function `{}`, which is null; set it in the table",
                self.kind,
                call.name()
            ));
        }
        if !(self.degradation.is_finite() && self.degradation >= 0.0) {
            return Err(format!(
                "its degradation exponent {} must be finite and not negative",
                self.degradation
            ));
        }
        if self.flags & abi::FLAG_CONSTANT != 0 && !self.variables.is_empty() {
            return Err("it says that it depends on its parameters only (FW_FLAG_CONSTANT) and has internal variables; drop one of the two".into());
        }
        for (k, field) in self.parameters.iter().enumerate() {
            if self.parameters[..k].iter().any(|f| f.name == field.name) {
                return Err(format!("its parameter `{}` is declared twice", field.name));
            }
            if !(field.minimum..=field.maximum).contains(&field.default) {
                return Err(format!(
                    "the default {} of `{}` is out of its range [{}, {}]",
                    field.default, field.name, field.minimum, field.maximum
                ));
            }
        }
        for (k, field) in self.variables.iter().enumerate() {
            if self.variables[..k].iter().any(|f| f.name == field.name) {
                return Err(format!("its variable `{}` is declared twice", field.name));
            }
        }
        Ok(())
    }

    fn has_function(&self, call: Call) -> bool {
        let function = match call {
            Call::Initialise => self.table.initialise,
            Call::Prepare => self.table.prepare,
            Call::Commit => self.table.commit,
            Call::Energy => self.table.energy,
        };
        function.is_some()
    }

    /// Whether the law has something to do at the end of a step.
    pub fn commits(&self) -> bool {
        self.has_function(Call::Commit)
    }

    /// Returns whether the law sets the internal variables of new contacts itself.
    pub fn initialises(&self) -> bool {
        self.has_function(Call::Initialise)
    }
}

#[cfg(unix)]
unsafe fn open_local(path: &Path) -> Result<libloading::Library, libloading::Error> {
    use libloading::os::unix::{Library, RTLD_LOCAL, RTLD_NOW};
    // SAFETY: see the caller.
    unsafe { Library::open(Some(path), RTLD_NOW | RTLD_LOCAL).map(Into::into) }
}

#[cfg(not(unix))]
unsafe fn open_local(path: &Path) -> Result<libloading::Library, libloading::Error> {
    // SAFETY: see the caller.
    unsafe { libloading::Library::new(path) }
}

/// Copies the fields of the table known to both versions of the ABI.
unsafe fn read_table(table: *const abi::FwPlugin) -> Result<abi::FwPlugin, String> {
    // SAFETY: size and version come first in every version of the table.
    let (size, major) = unsafe {
        (
            ptr::addr_of!((*table).size).read(),
            ptr::addr_of!((*table).abi_major).read(),
        )
    };
    if major != abi::ABI_MAJOR {
        return Err(format!(
            "it was built for version {major} of the plugin interface and this program speaks version {}; rebuild it with the header of this release",
            abi::ABI_MAJOR
        ));
    }
    // Size of the table of version 1.0; later versions only append fields.
    let least = offset_of!(abi::FwPlugin, energy) + size_of::<abi::FwCall>();
    if size < least {
        return Err(format!(
            "its table has {size} bytes, at least {least} are needed; rebuild it with fretwork.h"
        ));
    }
    let known = size.min(size_of::<abi::FwPlugin>());
    let mut copy = MaybeUninit::<abi::FwPlugin>::zeroed();
    // SAFETY: the plugin declares this size, capped at that of our struct; all-zero bytes are valid for
    // every field (null pointers, absent functions).
    unsafe {
        ptr::copy_nonoverlapping(table.cast::<u8>(), copy.as_mut_ptr().cast(), known);
        Ok(copy.assume_init())
    }
}

unsafe fn text(pointer: *const c_char) -> Result<String, String> {
    if pointer.is_null() {
        return Err("is null".into());
    }
    // SAFETY: not null, and NUL-terminated by the ABI.
    let text = unsafe { CStr::from_ptr(pointer) };
    text.to_str()
        .map(str::to_owned)
        .map_err(|_| "is not valid UTF-8".into())
}

unsafe fn fields(first: *const abi::FwField, n: usize, what: &str) -> Result<Vec<Field>, String> {
    const MAX_FIELDS: usize = 256;
    if n > MAX_FIELDS {
        return Err(format!(
            "it declares {n} {what}s; at most {MAX_FIELDS} are accepted"
        ));
    }
    if n > 0 && first.is_null() {
        return Err(format!("it declares {n} {what}s but their table is null"));
    }
    (0..n)
        .map(|k| {
            // SAFETY: the plugin declares `n` fields.
            let f = unsafe { &*first.add(k) };
            // SAFETY: NUL-terminated by the ABI.
            let read =
                |p| unsafe { text(p) }.map_err(|e| format!("the text of its {what} {k} {e}"));
            let name = read(f.name)?;
            let plain = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_';
            if !name.starts_with(|c: char| c.is_ascii_lowercase()) || !name.chars().all(plain) {
                return Err(format!(
                    "the name `{name}` of its {what} {k} must be made of a-z, 0-9 and _ and begin with a letter"
                ));
            }
            if !f.default.is_finite() || f.minimum.is_nan() || f.maximum.is_nan() {
                return Err(format!("its {what} `{name}` has a default that is not finite or a range that is not a number"));
            }
            Ok(Field {
                unit: read(f.unit)?,
                doc: read(f.doc)?,
                name,
                default: f.default,
                minimum: f.minimum,
                maximum: f.maximum,
                output: f.flags & 1 != 0,
            })
        })
        .collect()
}
