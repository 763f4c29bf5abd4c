//! Certificates of laws that earlier runs found, in a file of the user, so that runs of the same
//! laws with the same parameters do not certify them again.

use crate::laws::{LoadedLaw, program_sha256, reason_to_distrust};
use crate::record::encoding::hex;
use sha2::{Digest, Sha256};
use std::collections::HashMap;
use std::fs::{self, OpenOptions};
use std::io::Write;
use std::path::PathBuf;

/// Size of the file (bytes) from which it is begun anew.
const LARGEST: u64 = 1 << 20;

/// What is known of laws with their parameters.
///
/// A line of the file is the SHA-256 of the program, of the law with the libraries that it links
/// to, of its parameters, of the way in which it was tested, and the same of the law that it was
/// tested with. Only laws that pass are kept: a loaded machine may be the reason why one fails.
pub(super) struct Certificates {
    /// The file; `None` where the system gives the program no place for one, or others may write
    /// to it.
    file: Option<PathBuf>,
    /// Lines, and whether the law passes.
    known: HashMap<String, bool>,
}

impl Certificates {
    /// Reads those that earlier runs kept. A file that cannot be read has none.
    pub fn read(file: Option<PathBuf>) -> Self {
        let file = file.filter(|f| reason_to_distrust(f).is_none());
        let size = |file: &PathBuf| fs::metadata(file).map(|m| m.len());
        if let Some(file) = file.as_ref().filter(|f| size(f).is_ok_and(|s| s > LARGEST)) {
            let _ = fs::remove_file(file);
        }
        let bytes = file.as_ref().and_then(|f| fs::read(f).ok());
        let text = String::from_utf8_lossy(bytes.as_deref().unwrap_or_default());
        let known = text.lines().map(|line| (line.to_owned(), true)).collect();
        Self { file, known }
    }

    /// Returns whether a law passes certification with a partner, from this or an earlier run or by
    /// `test`; `inside` says whether it is tested within this process.
    pub fn passes(
        &mut self,
        law: &LoadedLaw,
        partner: Option<&LoadedLaw>,
        inside: bool,
        test: impl FnOnce() -> bool,
    ) -> bool {
        let line = line(law, partner, inside);
        if let Some(passes) = self.known.get(&line) {
            return *passes;
        }
        let passes = test();
        let laws = [Some(law), partner];
        if passes && laws.into_iter().flatten().all(is_identified) {
            self.keep(&line);
        }
        self.known.insert(line, passes);
        passes
    }

    /// Without the file the next run certifies again, so that failing to write it is no error.
    fn keep(&self, line: &str) {
        let Some(file) = &self.file else { return };
        let folder = file.parent().map(fs::create_dir_all);
        if matches!(folder, Some(Ok(()))) {
            let file = OpenOptions::new().create(true).append(true).open(file);
            // One call, so that lines of runs at the same time do not mix.
            let _ = file.and_then(|mut f| f.write_all(format!("{line}\n").as_bytes()));
        }
    }
}

/// Returns whether the hashes of program and law cover all code of the law: libraries that a law
/// links to are known on Linux only.
fn is_identified(law: &LoadedLaw) -> bool {
    program_sha256().is_ok() && (law.plugin.built_in || cfg!(target_os = "linux"))
}

/// The line of a law and its partner.
fn line(law: &LoadedLaw, partner: Option<&LoadedLaw>, inside: bool) -> String {
    let mut sum = Sha256::new();
    sum.update(program_sha256().unwrap_or_default());
    sum.update([u8::from(inside)]);
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
    hex(&sum.finalize())
}
