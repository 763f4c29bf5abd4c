//! Laws linked into the program, which need no libraries. The program passes their tables to the
//! core, which refers to no law by name.

use super::error::LawError;
use super::kind::Kind;
use super::library::Plugin;
use crate::encoding::hex;
use fretwork_abi::LinkedLaw;
use sha2::{Digest, Sha256};
use std::ffi::CStr;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};

/// A linked-in law.
#[derive(Clone)]
struct Entry {
    kind: Kind,
    name: String,
    law: &'static LinkedLaw,
}

/// The laws linked into a program; empty by default.
#[derive(Clone, Default)]
pub struct BuiltInLaws(Arc<[Entry]>);

impl std::fmt::Debug for BuiltInLaws {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_list().entries(self.names()).finish()
    }
}

impl BuiltInLaws {
    /// Returns the laws of a program from the statics `TABLE` that `plugin_table!` of the crate
    /// `fretwork-law` makes. Laws whose kind or name cannot be read are left out.
    pub fn new(laws: impl IntoIterator<Item = &'static LinkedLaw>) -> Self {
        let known = laws.into_iter().filter_map(|law| {
            // SAFETY: the name of a linked law is NUL-terminated static text.
            let name = unsafe { CStr::from_ptr(law.table().name) };
            Some(Entry {
                kind: Kind::from_code(law.table().kind)?,
                name: name.to_str().ok()?.to_owned(),
                law,
            })
        });
        Self(known.collect())
    }

    /// Appends further laws; of two laws of the same kind and name the first is used.
    #[must_use]
    pub fn and(&self, others: &Self) -> Self {
        Self(self.0.iter().chain(others.0.iter()).cloned().collect())
    }

    /// Iterates over the kinds and names of all laws.
    pub fn names(&self) -> impl Iterator<Item = (Kind, &str)> {
        self.0.iter().map(|e| (e.kind, e.name.as_str()))
    }

    /// Returns the law of this kind and name if it is linked in, with the path and SHA-256 of the
    /// program.
    pub fn open(&self, kind: Kind, name: &str) -> Option<Result<Plugin, LawError>> {
        let entry = self.0.iter().find(|e| e.kind == kind && e.name == name)?;
        Some(executable().and_then(|(path, sha256)| {
            // SAFETY: the table of a linked law is static and follows the interface of this
            // version.
            unsafe { Plugin::from_table(entry.law.table(), path, sha256, true) }
        }))
    }
}

/// Returns the SHA-256 of the program's own file.
///
/// # Errors
/// If the file cannot be read.
pub fn program_sha256() -> Result<&'static str, LawError> {
    executable().map(|(_, sha256)| sha256)
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
