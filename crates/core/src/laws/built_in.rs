//! Laws linked into the program, for installations without the plugin libraries. The program passes
//! their tables to the core, which refers to no law by name.

use super::error::LawError;
use super::kind::Kind;
use super::library::Plugin;
use super::linked::hex;
use fretwork_abi::FwPlugin;
use sha2::{Digest, Sha256};
use std::ffi::CStr;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};

/// A linked-in law.
struct Entry {
    kind: Kind,
    name: String,
    table: &'static FwPlugin,
}

// SAFETY: tables are static and never written.
unsafe impl Send for Entry {}
// SAFETY: as above.
unsafe impl Sync for Entry {}

/// The laws linked into a program; empty by default.
#[derive(Clone, Default)]
pub struct BuiltInLaws(Arc<[Entry]>);

impl std::fmt::Debug for BuiltInLaws {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_list().entries(self.names()).finish()
    }
}

impl BuiltInLaws {
    /// Collects the laws of these tables, leaving out those whose kind or name cannot be read.
    ///
    /// # Safety
    /// Each table must have been made by `plugin_table!` of the crate `fretwork-law`, for the
    /// interface version this program is built with: its pointers are dereferenced.
    pub unsafe fn from_tables(tables: impl IntoIterator<Item = &'static FwPlugin>) -> Self {
        let known = tables.into_iter().filter_map(|table| {
            // SAFETY: the caller guarantees tables of the wrapper, whose names are NUL-terminated
            // static text.
            let name = unsafe { CStr::from_ptr(table.name) };
            Some(Entry {
                kind: Kind::from_code(table.kind)?,
                name: name.to_str().ok()?.to_owned(),
                table,
            })
        });
        Self(known.collect())
    }

    /// Iterates over the kinds and names of all laws.
    pub fn names(&self) -> impl Iterator<Item = (Kind, &str)> {
        self.0.iter().map(|e| (e.kind, e.name.as_str()))
    }

    /// Returns the law of this kind and name if it is linked in. Its path and SHA-256 are those of
    /// the program.
    pub fn open(&self, kind: Kind, name: &str) -> Option<Result<Plugin, LawError>> {
        let entry = self.0.iter().find(|e| e.kind == kind && e.name == name)?;
        Some(executable().and_then(|(path, sha256)| {
            // SAFETY: a static table of the wrapper, of this version, see `from_tables`.
            unsafe { Plugin::from_table(entry.table, path, sha256, true) }
        }))
    }
}

/// Returns the path of the program's own file and its SHA-256, computed once.
fn executable() -> Result<(&'static Path, &'static str), LawError> {
    static KNOWN: OnceLock<Result<(PathBuf, String), String>> = OnceLock::new();
    let known = KNOWN.get_or_init(|| {
        let path = crate::program::file().map_err(|e| e.to_string())?;
        let sha256 = file_sum(&path).map_err(|e| e.to_string())?;
        Ok((path, sha256))
    });
    match known {
        Ok((path, sha256)) => Ok((path, sha256)),
        Err(reason) => Err(LawError::Unusable {
            path: PathBuf::from("built in"),
            reason: format!(
                "the program's own file, whose SHA-256 identifies its built-in laws, cannot be read ({reason})"
            ),
        }),
    }
}

fn file_sum(path: &Path) -> std::io::Result<String> {
    let mut file = std::fs::File::open(path)?;
    let mut sum = Sha256::new();
    let mut buffer = vec![0; 1 << 16];
    loop {
        let n = file.read(&mut buffer)?;
        if n == 0 {
            break;
        }
        sum.update(&buffer[..n]);
    }
    Ok(hex(&sum.finalize()))
}
