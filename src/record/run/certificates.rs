//! Certificates of laws that earlier runs found, in a file of the user, so that runs of the same
//! laws with the same parameters do not certify them again.

use crate::laws::{LoadedLaw, program_sha256};
use crate::record::encoding::hex;
use sha2::{Digest, Sha256};
use std::collections::HashSet;
use std::fs::{self, OpenOptions};
use std::io::Write;
use std::path::PathBuf;

/// Size of the file (bytes) from which it is begun anew.
const LARGEST: u64 = 1 << 20;

/// The laws and parameters that have passed certification.
///
/// A line of the file is the SHA-256 of the program, of the law and its libraries, of its
/// parameters, and the same of the law that it was certified with. Laws that fail are tested at
/// each run, since a loaded machine may be the reason.
pub(super) struct Certificates {
    /// The file; `None` where the system gives the program no place for one.
    file: Option<PathBuf>,
    passed: HashSet<String>,
}

impl Certificates {
    /// Reads those that earlier runs kept. A file that cannot be read has none.
    pub fn kept(file: Option<PathBuf>) -> Self {
        let size = |file: &PathBuf| fs::metadata(file).map(|m| m.len());
        if let Some(file) = file.as_ref().filter(|f| size(f).is_ok_and(|s| s > LARGEST)) {
            let _ = fs::remove_file(file);
        }
        let text = file.as_ref().and_then(|f| fs::read_to_string(f).ok());
        let passed = text
            .unwrap_or_default()
            .lines()
            .map(str::to_owned)
            .collect();
        Self { file, passed }
    }

    /// Returns whether a law passes certification with a partner, from an earlier run or by `test`.
    pub fn passes(
        &mut self,
        law: &LoadedLaw,
        partner: Option<&LoadedLaw>,
        test: impl FnOnce() -> bool,
    ) -> bool {
        let Some(line) = line(law, partner) else {
            return test();
        };
        if self.passed.contains(&line) {
            return true;
        }
        let passes = test();
        if passes {
            self.keep(line);
        }
        passes
    }

    /// Without the file the next run certifies again, so that failing to write it is no error.
    fn keep(&mut self, line: String) {
        if let Some(file) = &self.file {
            let folder = file.parent().map(fs::create_dir_all);
            if matches!(folder, Some(Ok(()))) {
                let file = OpenOptions::new().create(true).append(true).open(file);
                // One call, so that lines of runs at the same time do not mix.
                let _ = file.and_then(|mut f| f.write_all(format!("{line}\n").as_bytes()));
            }
        }
        self.passed.insert(line);
    }
}

/// The line of a law and its partner.
fn line(law: &LoadedLaw, partner: Option<&LoadedLaw>) -> Option<String> {
    let mut sum = Sha256::new();
    sum.update(program_sha256().ok()?);
    for law in [Some(law), partner].into_iter().flatten() {
        let plugin = &law.plugin;
        for text in [plugin.kind.word(), &plugin.name, &plugin.sha256] {
            sum.update((text.len() as u64).to_le_bytes());
            sum.update(text);
        }
        sum.update((law.parameters.len() as u64).to_le_bytes());
        for number in &law.parameters {
            sum.update(number.to_bits().to_le_bytes());
        }
    }
    Some(hex(&sum.finalize()))
}
