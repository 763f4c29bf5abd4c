//! A plugin: a shared library that is opened, validated and called at run time.

use super::child::{read_request, send_done, send_message};
use super::error::LawError;
use super::function::Call;
use super::kind::Kind;
use super::linked::{LawCode, LibraryOpening};
use super::loading::{self, Library};
use super::names::name_is_valid;
use super::outside::{self, DisturbedState};
use super::plugin_table::{LawField, fields, read_table, text};
use super::watch;
use fretwork_abi as abi;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::Ordering;

/// Describes the codes of kinds: those of the plugin interface, and registered ones.
fn known_codes() -> String {
    let more = Kind::all()
        .into_iter()
        .filter(|k| !Kind::BUILT_IN.contains(k));
    more.fold(format!("1 to {}", Kind::TRANSPORT.code()), |codes, kind| {
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
    /// Version of the law.
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
    pub parameters: Vec<LawField>,
    /// Schema of the internal variables.
    pub variables: Vec<LawField>,
    /// File of the library, or of the program for a built-in law.
    pub path: PathBuf,
    /// SHA-256 of that file, in hexadecimal; with [links](Self::links), of the list of all sums.
    pub sha256: String,
    /// Libraries that it links to and that are not the system's: path and SHA-256.
    pub links: Vec<(PathBuf, String)>,
    /// Whether the law is linked into the program.
    pub built_in: bool,
    pub(super) table: abi::FwPlugin,
    pub(super) label: watch::Label,
    /// Records, shared by all clones, of what the law changed.
    pub(super) disturbed: Arc<DisturbedState>,
}

// SAFETY: the table is read only, and the ABI requires every function to be callable from any
// thread at any time (pure, no globals).
unsafe impl Send for Plugin {}
// SAFETY: the reasons for `Send` apply.
unsafe impl Sync for Plugin {}

impl Plugin {
    /// Opens a library and performs all checks possible before the first call.
    ///
    /// # Errors
    /// Returns a sentence that names the file and the problem.
    pub fn open(path: &Path) -> Result<Self, LawError> {
        Self::open_pinned(path, None)
    }

    /// Opens a library only if it has the given SHA-256 (in hexadecimal); otherwise no code of it
    /// runs.
    ///
    /// # Errors
    /// Returns the errors of [`Self::open`], and [`LawError::HashMismatch`].
    pub fn open_pinned(path: &Path, pin: Option<&str>) -> Result<Self, LawError> {
        let refuse = |reason: String| LawError::Unusable {
            path: path.to_owned(),
            reason,
        };
        let read = || LawCode::of(path).map_err(refuse);
        let code = read()?;
        let sha256 = code.sha256.clone();
        if let Some(pin) = pin.filter(|p| !p.eq_ignore_ascii_case(&sha256)) {
            return Err(LawError::HashMismatch {
                path: path.to_owned(),
                pin: pin.to_owned(),
                sha256,
            });
        }
        loading::check_loads(path, &sha256).map_err(&refuse)?;
        // The trial may have taken seconds, in which the file can change.
        if read()? != code {
            return Err(refuse(loading::CHANGED.to_owned()));
        }
        let loading = watch::label(format!("the plugin {}", path.display()));
        let disturbed = DisturbedState::default();
        // A name without a folder would be searched for where the system has its libraries.
        let absolute = std::path::absolute(path).map_err(|e| refuse(e.to_string()))?;
        let opening = LibraryOpening::begin();
        let load = || {
            // SAFETY: opening runs the library's initialisers; the user put it on the search path.
            let library = unsafe { open_local(&absolute) }.map_err(|e| {
                refuse(format!(
                    "it is not a loadable library ({}); build it as a `cdylib`",
                    with_cause(&e)
                ))
            })?;
            // SAFETY: the ABI defines the type of this symbol; only the permission to unwind is
            // added. A library with another type violates the ABI.
            let table = unsafe {
                let entry = library
                    .get::<EntryFunction>(abi::ENTRY_SYMBOL)
                    .map_err(|_| {
                        refuse(format!(
                            "it does not export `{}`; it is not a Fretwork plugin",
                            abi::ENTRY_SYMBOL
                        ))
                    })?;
                entry()
            };
            // The library stays loaded: threads may run its code or hold its thread-local data.
            std::mem::forget(library);
            Ok(table)
        };
        let table = outside::keep_folder(|| {
            outside::call(loading, watch::LOADING, &disturbed.loading, load)
        })?;
        opening
            .check(path)
            .map_err(|reason| LawError::UnexpectedLibraries {
                path: path.to_owned(),
                reason,
            })?;
        // SAFETY: the ABI guarantees a complete static table.
        let mut plugin = unsafe { Self::from_table(table, path, &sha256, false) }?;
        plugin.disturbed = Arc::new(disturbed);
        plugin.links = code.links;
        Ok(plugin)
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
        // SAFETY: the table begins with its size and version, which are checked before anything
        // else is read.
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
        if !name_is_valid(&name) {
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
            // SAFETY: count and array belong to one table.
            variables: unsafe { fields(table.variables, table.n_variables, "variable") }
                .map_err(&refuse)?,
            path: path.to_owned(),
            sha256: sha256.to_owned(),
            built_in,
            disturbed: Arc::default(),
            links: Vec::new(),
            label: watch::label(format!("the {kind} law `{name}`")),
            name,
            table,
        };
        plugin.check().map_err(refuse)?;
        Ok(plugin)
    }

    fn check(&self) -> Result<(), String> {
        let unknown = self.flags & !abi::FLAGS;
        if unknown != 0 {
            return Err(format!(
                "it sets flags that this program does not know ({unknown:#x}); it was built for a later plugin interface, or its table is wrong: build it with the header of this version"
            ));
        }
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
        if self.flags & abi::FLAG_COMPLIANT != 0 {
            if self.kind != Kind::CONTACT {
                return Err("only a contact law can be a spring (FW_FLAG_COMPLIANT)".into());
            }
            if self.flags & abi::FLAG_CONSTANT != 0 {
                return Err("a spring depends on the overlap of each contact: drop FW_FLAG_CONSTANT or FW_FLAG_COMPLIANT".into());
            }
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

    /// Returns whether the law changed the floating-point control (rounding, subnormal numbers),
    /// which the caller restores: while its library was loaded, or in a call.
    pub fn disturbs_floating_point(&self) -> Option<&'static str> {
        if self.disturbed.calling.load(Ordering::Relaxed) {
            return Some("in a call");
        }
        let loading = self.disturbed.loading.load(Ordering::Relaxed);
        loading.then_some("while it is loaded, as libraries do that are built with -ffast-math")
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

/// The entry of a library, which may unwind.
type EntryFunction = unsafe extern "C-unwind" fn() -> *const abi::FwPlugin;

/// Formats an error with the cause that the system gives.
fn with_cause(error: &dyn std::error::Error) -> String {
    let text = error.to_string();
    match error.source() {
        Some(source) if !text.contains(&source.to_string()) => format!("{text}: {source}"),
        _ => text,
    }
}

#[cfg(unix)]
unsafe fn open_local(path: &Path) -> Result<libloading::Library, libloading::Error> {
    use libloading::os::unix::{Library, RTLD_LOCAL, RTLD_NOW};
    // SAFETY: the caller opens the library under the conditions of `open`.
    unsafe { Library::open(Some(path), RTLD_NOW | RTLD_LOCAL).map(Into::into) }
}

#[cfg(not(unix))]
unsafe fn open_local(path: &Path) -> Result<libloading::Library, libloading::Error> {
    // SAFETY: the caller opens the library under the conditions of `open`.
    unsafe { libloading::Library::new(path) }
}

/// Opens the requested libraries one by one in the child process, each only if its SHA-256 is
/// unchanged. The trial checks that opening returns, and that it loads only the examined libraries;
/// the parent reports other errors when it opens the library.
///
/// # Errors
/// The request cannot be read.
pub fn try_libraries() -> Result<(), String> {
    let libraries: Vec<Library> =
        serde_json::from_value(read_request()?).map_err(|e| e.to_string())?;
    for library in libraries {
        send_message(
            &match Plugin::open_pinned(&library.path, Some(&library.sha256)) {
                Err(LawError::HashMismatch { .. }) => json!(loading::CHANGED),
                // The code of the library is not loaded into the process that requested the trial.
                Err(LawError::UnexpectedLibraries { reason, .. }) => json!(reason),
                _ => Value::Null,
            },
        );
    }
    send_done();
    Ok(())
}
