//! The key of a run: a hash of the program, the plugins it may load, and the contents of its case.

use crate::Error;
use crate::load;
use fretwork_core::encoding::hex;
use fretwork_core::program;
use sha2::{Digest, Sha256};
use std::path::Path;

/// Number of characters of a key.
const LENGTH: usize = 24;

/// Creates keys for one program with one search path of plugins.
#[derive(Clone, Debug)]
pub struct Keys {
    program: Sha256,
}

impl Keys {
    /// Creates the keys of this program with these arguments of plugins for its command line,
    /// `--plugin-path DIR`; libraries in these folders and in those of `FRETWORK_PLUGIN_PATH`
    /// contribute by their content.
    ///
    /// # Errors
    /// The path of the program cannot be determined, or its file cannot be read.
    pub fn new(plugins: &[String]) -> Result<Self, Error> {
        let unknown = |e: &dyn std::fmt::Display| {
            Error::Usage(format!("the path of the program cannot be determined: {e}"))
        };
        program::command().map_err(|e| unknown(&e))?;
        let file = program::file().map_err(|e| unknown(&e))?;
        let mut hash = Sha256::new();
        hash.update(std::fs::read(&file).map_err(|e| unknown(&e))?);
        let listed = std::env::var_os("FRETWORK_PLUGIN_PATH").unwrap_or_default();
        let folders = plugins.iter().map(Into::into);
        for folder in folders.chain(std::env::split_paths(&listed)) {
            let entries = std::fs::read_dir::<&Path>(folder.as_ref());
            let mut files: Vec<_> = entries.into_iter().flatten().flatten().collect();
            files.sort_by_key(std::fs::DirEntry::file_name);
            for bytes in files.iter().filter_map(|f| std::fs::read(f.path()).ok()) {
                hash.update(Sha256::digest(bytes));
            }
        }
        Ok(Self { program: hash })
    }

    /// Returns the key of the program and its plugins.
    pub fn of_program(&self) -> String {
        hex(&self.program.clone().finalize())[..LENGTH].to_owned()
    }

    /// Returns the key of a run: equal for two runs of one program whose cases have equal contents,
    /// in any notation. A case that cannot be read has a key of its text.
    pub fn of_run(&self, case: &Path, sets: &[String]) -> String {
        let mut hash = self.program.clone();
        let mut add = |part: &[u8]| {
            hash.update((part.len() as u64).to_le_bytes());
            hash.update(part);
        };
        match load(case, sets).and_then(|loaded| loaded.contents()) {
            Ok(contents) => {
                for (name, content) in contents {
                    add(name.as_bytes());
                    add(&content);
                }
            }
            Err(_) => {
                add(&std::fs::read(case).unwrap_or_default());
                for set in sets {
                    add(set.as_bytes());
                }
            }
        }
        hex(&hash.finalize())[..LENGTH].to_owned()
    }
}
