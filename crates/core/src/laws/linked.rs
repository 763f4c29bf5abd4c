//! Libraries that a law's library links to: the dynamic linker runs their code with that of the law. Those of the system are taken for
//! granted, as the linker finds them in its own folders; those that are found beside the law or through the environment are as much
//! part of the law as its own file.
//!
//! Read from ELF files (Linux); elsewhere none are known. What a law opens by itself (`dlopen`) is not known either.

use super::built_in::hex;
use sha2::{Digest, Sha256};
use std::path::{Path, PathBuf};

/// The code of a law.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct LawCode {
    /// SHA-256 of the library; with others that it links to, of the list of all their sums.
    pub sha256: String,
    /// These others: path and SHA-256.
    pub links: Vec<(PathBuf, String)>,
}

impl LawCode {
    /// Reads the code of a library.
    ///
    /// # Errors
    /// A file cannot be read.
    pub fn of(library: &Path) -> std::io::Result<Self> {
        let own = sum(library)?;
        let links: std::io::Result<Vec<_>> = libraries(library)
            .into_iter()
            .map(|path| sum(&path).map(|sum| (path, sum)))
            .collect();
        let links = links?;
        if links.is_empty() {
            return Ok(Self { sha256: own, links });
        }
        let mut all = Sha256::new();
        all.update(&own);
        for (path, sum) in &links {
            // The name by which it is linked, not the folder, so that a copy of all has the same sum.
            let name = path.file_name().unwrap_or_default();
            all.update([b"\n", sum.as_bytes(), b" ", name.as_encoded_bytes()].concat());
        }
        Ok(Self {
            sha256: hex(&all.finalize()),
            links,
        })
    }
}

/// SHA-256 of a file.
fn sum(path: &Path) -> std::io::Result<String> {
    Ok(hex(&Sha256::digest(std::fs::read(path)?)))
}

/// The libraries that a library links to, directly or not, and that are found neither in this process nor by the system alone.
pub(super) fn libraries(library: &Path) -> Vec<PathBuf> {
    #[cfg(target_os = "linux")]
    let found = linux::libraries(library);
    #[cfg(not(target_os = "linux"))]
    let found = {
        let _ = library;
        Vec::new()
    };
    found
}

#[cfg(target_os = "linux")]
mod linux {
    use std::collections::BTreeSet;
    use std::ffi::{CStr, OsStr, c_int, c_void};
    use std::os::unix::ffi::OsStrExt;
    use std::path::{Path, PathBuf};

    pub fn libraries(library: &Path) -> Vec<PathBuf> {
        let loaded = loaded();
        let environment = std::env::var_os("LD_LIBRARY_PATH").unwrap_or_default();
        let mut found: Vec<PathBuf> = Vec::new();
        // By where they are: folders such as `$ORIGIN/../lib` name one file in many ways.
        let mut seen = BTreeSet::new();
        // Each with the folders that those which link to it add (RPATH).
        let mut left = vec![(library.to_owned(), Vec::<PathBuf>::new())];
        while let Some((path, above)) = left.pop() {
            let Some(needs) = std::fs::read(&path)
                .ok()
                .and_then(|bytes| Needs::read(&bytes))
            else {
                continue;
            };
            let origin = std::path::absolute(&path).unwrap_or_else(|_| path.clone());
            let origin = origin.parent().unwrap_or(Path::new("/"));
            let mut inherited = above.clone();
            // Where there is a RUNPATH the linker does not look at an RPATH.
            if needs.runpath.is_none() {
                let own = needs.rpath.iter().flat_map(|list| folders(list, origin));
                inherited = own.chain(above).collect();
            }
            let after = folders(environment.as_bytes(), origin);
            let last = needs.runpath.iter().flat_map(|list| folders(list, origin));
            let search: Vec<PathBuf> = inherited.iter().cloned().chain(after).chain(last).collect();
            for name in &needs.names {
                if loaded.contains(name) {
                    continue;
                }
                let name = Path::new(OsStr::from_bytes(name));
                let file = if name.components().count() > 1 {
                    Some(name.to_owned()).filter(|p| p.is_file())
                } else {
                    search.iter().map(|f| f.join(name)).find(|p| p.is_file())
                };
                if let Some(file) = file
                    && seen.insert(std::fs::canonicalize(&file).unwrap_or_else(|_| file.clone()))
                {
                    found.push(file.clone());
                    left.push((file, inherited.clone()));
                }
            }
        }
        found.sort();
        found
    }

    /// The folders of a list; an empty entry is the current one, and `$ORIGIN` the folder of the library.
    fn folders(list: &[u8], origin: &Path) -> Vec<PathBuf> {
        if list.is_empty() {
            return Vec::new();
        }
        let entries = list.split(|b| *b == b':' || *b == b';');
        let folder = |entry: &[u8]| {
            let text = String::from_utf8_lossy(entry);
            let origin = origin.to_string_lossy();
            match text.as_ref() {
                "" => PathBuf::from("."),
                text => text
                    .replace("${ORIGIN}", &origin)
                    .replace("$ORIGIN", &origin)
                    .into(),
            }
        };
        entries.map(folder).collect()
    }

    /// Names of the libraries of this process, which the linker does not load again.
    fn loaded() -> Vec<Vec<u8>> {
        unsafe extern "C" fn visit(
            info: *mut libc::dl_phdr_info,
            _size: usize,
            names: *mut c_void,
        ) -> c_int {
            // SAFETY: the linker passes a valid record and the pointer given to it.
            let (info, names) = unsafe { (&*info, &mut *names.cast::<Vec<Vec<u8>>>()) };
            if !info.dlpi_name.is_null() {
                // SAFETY: a string of the linker, which ends with a zero.
                let path = unsafe { CStr::from_ptr(info.dlpi_name) }.to_bytes();
                let name = path.rsplit(|b| *b == b'/').next().unwrap_or_default();
                names.push(name.to_vec());
            }
            0
        }
        let mut names = Vec::new();
        // SAFETY: the callback receives this list only, for the duration of the call.
        unsafe { libc::dl_iterate_phdr(Some(visit), (&raw mut names).cast()) };
        names
    }

    /// What the dynamic section of an ELF file says of the libraries that it needs.
    #[derive(Debug, Default)]
    struct Needs {
        names: Vec<Vec<u8>>,
        rpath: Option<Vec<u8>>,
        runpath: Option<Vec<u8>>,
    }

    impl Needs {
        /// Of the bytes of a 64-bit file of little end; none where it is not one, or damaged.
        fn read(bytes: &[u8]) -> Option<Self> {
            const LOAD: u64 = 1;
            const DYNAMIC: u64 = 2;
            if bytes.get(..6)? != b"\x7fELF\x02\x01" {
                return None;
            }
            let number = |at: usize, length: usize| -> Option<u64> {
                let field = bytes.get(at..at.checked_add(length)?)?;
                Some(field.iter().rev().fold(0, |n, b| (n << 8) | u64::from(*b)))
            };
            let size = |at: usize, length: usize| usize::try_from(number(at, length)?).ok();
            let (table, each, count) = (size(32, 8)?, size(54, 2)?, size(56, 2)?);
            let header = |k: usize| table.checked_add(k.checked_mul(each)?);
            let headers: Vec<usize> = (0..count).map_while(header).collect();
            let is = |kind: u64| move |at: &&usize| number(**at, 4) == Some(kind);
            let dynamic = headers.iter().find(is(DYNAMIC))?;
            let (mut at, length) = (size(dynamic + 8, 8)?, size(dynamic + 32, 8)?);
            let end = at.checked_add(length)?.min(bytes.len());
            let mut entries = Vec::new();
            while at + 16 <= end {
                match (number(at, 8)?, size(at + 8, 8)?) {
                    (0, _) => break,
                    entry => entries.push(entry),
                }
                at += 16;
            }
            let text_at = entries.iter().find(|e| e.0 == 5)?.1;
            // An address in memory; where in the file it is, the segments say.
            let in_file = headers.iter().filter(is(LOAD)).find_map(|at| {
                let (offset, address, length) =
                    (size(at + 8, 8)?, size(at + 16, 8)?, size(at + 32, 8)?);
                let into = text_at.checked_sub(address).filter(|into| *into < length)?;
                offset.checked_add(into)
            })?;
            let text = |at: usize| -> Option<Vec<u8>> {
                let from = bytes.get(in_file.checked_add(at)?..)?;
                let end = from.iter().position(|b| *b == 0)?;
                Some(from[..end].to_vec())
            };
            let mut needs = Self::default();
            for (tag, at) in entries {
                match tag {
                    1 => needs.names.push(text(at)?),
                    15 => needs.rpath = text(at),
                    29 => needs.runpath = text(at),
                    _ => {}
                }
            }
            Some(needs)
        }
    }

    #[cfg(test)]
    mod tests {
        use super::*;

        #[test]
        fn folders_of_the_linker_are_those_of_the_list() {
            let here = Path::new("/laws");
            let list = b"$ORIGIN/lib:${ORIGIN}::/opt";
            let expected = ["/laws/lib", "/laws", ".", "/opt"].map(PathBuf::from);
            assert_eq!(folders(list, here), expected);
            assert!(folders(b"", here).is_empty());
        }

        /// This test links to the library of C, which it has loaded; a damaged file says nothing, and nothing fails.
        #[test]
        fn needs_are_read_from_a_program() {
            let own = std::env::current_exe().unwrap();
            let bytes = std::fs::read(&own).unwrap();
            let needs = Needs::read(&bytes).unwrap();
            assert!(
                needs.names.iter().any(|n| n.starts_with(b"libc.")),
                "{needs:?}"
            );
            assert!(libraries(&own).is_empty());
            for length in [0, 5, 40, 100, 1000] {
                assert!(Needs::read(&bytes[..length]).is_none());
            }
        }
    }
}
