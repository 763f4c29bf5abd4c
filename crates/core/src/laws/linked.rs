//! Libraries to which a law's library links: the dynamic linker runs their code when it loads the
//! law. Libraries of the system, found in the linker's own folders, are trusted. Libraries that are
//! found beside the law or through the environment are part of the law, like its own file.
//!
//! The links are read from ELF files (Linux); on other systems none are known. Libraries that a law
//! opens itself (`dlopen`) are not known either.
//!
//! What is read predicts only approximately what the linker does. A law for which the linker would
//! search folders that depend on the machine is refused before it is opened; after opening, the
//! [loaded libraries](Opening) are compared with those that were read.

use crate::encoding::hex;
use sha2::{Digest, Sha256};
use std::path::{Path, PathBuf};

/// The code of a law.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct LawCode {
    /// SHA-256 of the library, or, if it links to others, of the list of all sums.
    pub sha256: String,
    /// The linked libraries: path and SHA-256.
    pub links: Vec<(PathBuf, String)>,
}

impl LawCode {
    /// Reads the code of a library.
    ///
    /// # Errors
    /// Returns a sentence: a file cannot be read, or the links of the library depend on the
    /// machine.
    pub fn of(library: &Path) -> Result<Self, String> {
        let unread =
            |e: std::io::Error| format!("it, or a library that it links to, cannot be read ({e})");
        let links = libraries(library)?;
        let own = sum(library).map_err(unread)?;
        let links: std::io::Result<Vec<_>> = links
            .into_iter()
            .map(|path| sum(&path).map(|sum| (path, sum)))
            .collect();
        let links = links.map_err(unread)?;
        if links.is_empty() {
            return Ok(Self { sha256: own, links });
        }
        let mut all = Sha256::new();
        all.update(&own);
        for (path, sum) in &links {
            // The list has the linked name, not the folder, so that a copy of all files has the
            // same sum.
            let name = path.file_name().unwrap_or_default();
            all.update([b"\n", sum.as_bytes(), b" ", name.as_encoded_bytes()].concat());
        }
        Ok(Self {
            sha256: hex(&all.finalize()),
            links,
        })
    }
}

/// Returns the SHA-256 of a file.
fn sum(path: &Path) -> std::io::Result<String> {
    Ok(hex(&Sha256::digest(std::fs::read(path)?)))
}

/// Returns the libraries to which a library links, directly or not, and that are found neither in
/// the program nor by the system alone.
///
/// # Errors
/// A sentence: where the linker looks depends on the machine.
pub(super) fn libraries(library: &Path) -> Result<Vec<PathBuf>, String> {
    #[cfg(target_os = "linux")]
    let found = linux::LinkPlan::of(library).map(|plan| plan.found);
    #[cfg(not(target_os = "linux"))]
    let found = {
        let _ = library;
        Ok(Vec::new())
    };
    found
}

/// The libraries of the process before a law is opened.
pub(super) struct LibraryOpening {
    #[cfg(target_os = "linux")]
    before: Vec<PathBuf>,
}

impl LibraryOpening {
    /// Records the libraries that are loaded now.
    pub fn begin() -> Self {
        Self {
            #[cfg(target_os = "linux")]
            before: linux::loaded(),
        }
    }

    /// Checks that the libraries loaded since are those that were read from the files of the law.
    ///
    /// # Errors
    /// Returns a sentence: a library that was read is not loaded, or another one was loaded from
    /// the folders that the law names.
    pub fn check(self, library: &Path) -> Result<(), String> {
        #[cfg(target_os = "linux")]
        linux::LinkPlan::of(library)?.check(&self.before, &linux::loaded())?;
        let _ = library;
        Ok(())
    }
}

#[cfg(target_os = "linux")]
mod linux {
    use std::collections::BTreeSet;
    use std::ffi::{CStr, OsStr, c_int, c_void};
    use std::os::unix::ffi::OsStrExt;
    use std::os::unix::fs::MetadataExt;
    use std::path::{Path, PathBuf};
    use std::sync::OnceLock;

    /// Prediction of what the linker will do with a library, from its file and the files to which
    /// it links.
    #[derive(Debug, Default)]
    pub struct LinkPlan {
        /// Libraries that the linker will find in folders that the law names.
        pub found: Vec<PathBuf>,
        /// Folders that the law names.
        folders: BTreeSet<PathBuf>,
        /// Names for which the linker will search.
        names: BTreeSet<Vec<u8>>,
    }

    /// Folders that only the administrator can change, and that the linker searches by default.
    const OF_SYSTEM: [&str; 6] = [
        "/lib",
        "/lib32",
        "/lib64",
        "/usr/lib",
        "/usr/lib32",
        "/usr/lib64",
    ];

    /// Sub-folders in which the linker prefers variants for some processors; the names of
    /// [`VARIANTS`] may also be nested.
    const PREFERRED: &str = "glibc-hwcaps";
    const VARIANTS: [&str; 6] = [
        "tls", "x86_64", "haswell", "xeon_phi", "avx512_1", "aarch64",
    ];

    impl LinkPlan {
        /// Examines a library that has not been opened.
        pub fn of(library: &Path) -> Result<Self, String> {
            Self::beside(library, program())
        }

        /// Examines the links of a library, given the names that are loaded already.
        fn beside(library: &Path, loaded: &BTreeSet<Vec<u8>>) -> Result<Self, String> {
            let environment = std::env::var_os("LD_LIBRARY_PATH").unwrap_or_default();
            let mut plan = Self::default();
            // Libraries are compared by their place: folders such as `$ORIGIN/../lib` give one file
            // many names.
            let mut seen = BTreeSet::new();
            // Each library has the folders (RPATH) of the libraries that link to it.
            let mut left = vec![(library.to_owned(), Vec::<PathBuf>::new())];
            while let Some((path, above)) = left.pop() {
                let Some(needs) = std::fs::read(&path)
                    .ok()
                    .and_then(|bytes| DynamicSection::read(&bytes))
                else {
                    continue;
                };
                let origin = std::path::absolute(&path).unwrap_or_else(|_| path.clone());
                let origin = origin.parent().unwrap_or(Path::new("/"));
                let list = |list: &Option<Vec<u8>>| match list {
                    Some(list) => folders(list, origin)
                        .map_err(|word| depends(&path, &format!("its run path has `{word}`"))),
                    None => Ok(Vec::new()),
                };
                let mut inherited = above.clone();
                // The linker ignores RPATH where there is a RUNPATH.
                if needs.runpath.is_none() {
                    inherited = [list(&needs.rpath)?, above].concat();
                }
                let after = folders(environment.as_bytes(), origin)
                    .map_err(|word| depends(&path, &format!("LD_LIBRARY_PATH has `{word}`")))?;
                let last = list(&needs.runpath)?;
                let search = [inherited.clone(), after, last].concat();
                for name in &needs.names {
                    if loaded.contains(name) {
                        continue;
                    }
                    plan.names.insert(name.clone());
                    let name = Path::new(OsStr::from_bytes(name));
                    let file = if name.components().count() > 1 {
                        Some(name.to_owned()).filter(|p| p.is_file())
                    } else {
                        if let Some(variant) = search.iter().find_map(|f| variant(f, name)) {
                            return Err(depends(&path, &format!("{} is there", variant.display())));
                        }
                        let files = search.iter().map(|f| f.join(name));
                        files.into_iter().find(|p| p.is_file() && fits(p))
                    };
                    if let Some(file) = file
                        && seen
                            .insert(std::fs::canonicalize(&file).unwrap_or_else(|_| file.clone()))
                    {
                        plan.found.push(file.clone());
                        left.push((file, inherited.clone()));
                    }
                }
                plan.folders.extend(search);
            }
            plan.found.sort();
            Ok(plan)
        }

        /// Compares the prediction with the libraries of the process before and after opening.
        pub fn check(&self, before: &[PathBuf], now: &[PathBuf]) -> Result<(), String> {
            let there: BTreeSet<_> = now.iter().filter_map(|p| place(p)).collect();
            let missing = |p: &&PathBuf| place(p).is_none_or(|place| !there.contains(&place));
            if let Some(path) = self.found.iter().find(missing) {
                let same = |p: &&PathBuf| p.file_name() == path.file_name();
                let other = now.iter().find(same).map_or_else(String::new, |p| {
                    format!(", {} of the same name stood for it", p.display())
                });
                return Err(format!(
                    "it links to {}, and the system did not load that file{other}; give the library another name, also that which it has in \
                     itself (`soname`)",
                    path.display()
                ));
            }
            let expected: BTreeSet<_> = self.found.iter().filter_map(|p| place(p)).collect();
            let unseen = |p: &&PathBuf| {
                let named = p.file_name().map(|n| n.as_bytes().to_vec());
                let wanted = named.is_some_and(|name| self.names.contains(&name));
                let below = |f: &PathBuf| {
                    let folder = std::fs::canonicalize(f).unwrap_or_else(|_| f.clone());
                    p.starts_with(f) || p.starts_with(folder)
                };
                wanted
                    && !before.contains(p)
                    && place(p).is_none_or(|place| !expected.contains(&place))
                    && !OF_SYSTEM.iter().any(|f| p.starts_with(f))
                    && self.folders.iter().any(below)
            };
            match now.iter().find(unseen) {
                None => Ok(()),
                Some(path) => Err(format!(
                    "it loaded {}, which was not examined before; put the library into a folder of the run path itself",
                    path.display()
                )),
            }
        }
    }

    /// Returns the place of a file: device and number.
    fn place(path: &Path) -> Option<(u64, u64)> {
        std::fs::metadata(path).ok().map(|m| (m.dev(), m.ino()))
    }

    fn depends(path: &Path, why: &str) -> String {
        format!(
            "what {} links to depends on the machine: {why}; link it to a library in a folder that is named in full or from `$ORIGIN`",
            path.display()
        )
    }

    /// Returns the variant of a library in a folder that the linker may prefer.
    fn variant(folder: &Path, name: &Path) -> Option<PathBuf> {
        // Variants in folders of the system belong to the system.
        if OF_SYSTEM.iter().any(|f| folder.starts_with(f)) {
            return None;
        }
        let entries = std::fs::read_dir(folder.join(PREFERRED)).into_iter();
        let preferred = entries.flatten().flatten().map(|e| e.path().join(name));
        let first = preferred.into_iter().find(|p| p.is_file());
        first.or_else(|| {
            let mut open = vec![(folder.to_owned(), 0)];
            while let Some((folder, depth)) = open.pop() {
                let file = folder.join(name);
                if depth > 0 && file.is_file() {
                    return Some(file);
                }
                if depth < 3 {
                    let inner = VARIANTS.iter().map(|v| (folder.join(v), depth + 1));
                    open.extend(inner.filter(|(f, _)| f.is_dir()));
                }
            }
            None
        })
    }

    /// Returns whether the linker accepts a file: it skips libraries of other machines, and fails
    /// at files that are no libraries.
    fn fits(path: &Path) -> bool {
        use std::io::Read;
        let head = |path: &Path| {
            let mut head = [0; 20];
            let read = std::fs::File::open(path).and_then(|mut f| f.read_exact(&mut head));
            read.is_ok_and(|()| head[..4] == *b"\x7fELF")
                .then(|| [head[4], head[5], head[18], head[19]])
        };
        match (head(path), head(Path::new("/proc/self/exe"))) {
            (Some(of), Some(own)) => of == own,
            _ => true,
        }
    }

    /// Returns the folders of a list; an empty entry is the current folder, and `$ORIGIN` the
    /// folder of the library. The error is another word that the linker would replace.
    fn folders(list: &[u8], origin: &Path) -> Result<Vec<PathBuf>, &'static str> {
        if list.is_empty() {
            return Ok(Vec::new());
        }
        let entries = list.split(|b| *b == b':' || *b == b';');
        let folder = |entry: &[u8]| {
            let text = String::from_utf8_lossy(entry);
            let words = ["$LIB", "${LIB}", "$PLATFORM", "${PLATFORM}"];
            if let Some(word) = words.into_iter().find(|word| text.contains(word)) {
                return Err(word);
            }
            let origin = origin.to_string_lossy();
            Ok(match text.as_ref() {
                "" => PathBuf::from("."),
                text => text
                    .replace("${ORIGIN}", &origin)
                    .replace("$ORIGIN", &origin)
                    .into(),
            })
        };
        entries.map(folder).collect()
    }

    /// Returns the names of the libraries that were loaded with the program, which the linker does
    /// not load again. The list is made once, before the first law is opened: libraries that a law
    /// loads are part of each law that links to them.
    fn program() -> &'static BTreeSet<Vec<u8>> {
        static NAMES: OnceLock<BTreeSet<Vec<u8>>> = OnceLock::new();
        NAMES.get_or_init(|| names(&loaded()))
    }

    fn names(paths: &[PathBuf]) -> BTreeSet<Vec<u8>> {
        let names = paths.iter().filter_map(|p| p.file_name());
        names.map(|n| n.as_bytes().to_vec()).collect()
    }

    /// Returns the libraries of this process.
    pub fn loaded() -> Vec<PathBuf> {
        unsafe extern "C" fn visit(
            info: *mut libc::dl_phdr_info,
            _size: usize,
            paths: *mut c_void,
        ) -> c_int {
            // SAFETY: the linker passes a valid record and the pointer given to it.
            let (info, paths) = unsafe { (&*info, &mut *paths.cast::<Vec<PathBuf>>()) };
            if !info.dlpi_name.is_null() {
                // SAFETY: the string of the linker ends with a zero.
                let path = unsafe { CStr::from_ptr(info.dlpi_name) }.to_bytes();
                paths.push(PathBuf::from(OsStr::from_bytes(path)));
            }
            0
        }
        let mut paths = Vec::new();
        // SAFETY: the callback receives this list only, for the duration of the call.
        unsafe { libc::dl_iterate_phdr(Some(visit), (&raw mut paths).cast()) };
        paths
    }

    /// Content of the dynamic section of an ELF file about the libraries that it needs.
    #[derive(Debug, Default)]
    struct DynamicSection {
        names: Vec<Vec<u8>>,
        rpath: Option<Vec<u8>>,
        runpath: Option<Vec<u8>>,
    }

    impl DynamicSection {
        /// Reads the bytes of a 64-bit little-endian file; `None` if the file has another format or
        /// is damaged.
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
            // The address is in memory; the segments give the offset in the file.
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

        /// The libraries of the program are among those of the process; the C library is one of
        /// them, unless it is linked statically.
        #[test]
        fn libraries_of_the_program_are_known() {
            let now = names(&loaded());
            assert!(program().is_subset(&now));
            let mut of_c = now.iter().filter(|name| name.starts_with(b"libc."));
            assert!(of_c.all(|name| program().contains(name)));
        }

        #[test]
        fn folders_of_the_linker_are_those_of_the_list() {
            let here = Path::new("/laws");
            let list = b"$ORIGIN/lib:${ORIGIN}::/opt";
            let expected = ["/laws/lib", "/laws", ".", "/opt"].map(PathBuf::from);
            assert_eq!(folders(list, here).unwrap(), expected);
            assert!(folders(b"", here).unwrap().is_empty());
            for word in ["$LIB", "${LIB}", "$PLATFORM", "${PLATFORM}"] {
                let list = format!("/opt:$ORIGIN/{word}/x");
                assert_eq!(folders(list.as_bytes(), here), Err(word));
            }
        }

        /// This test links to the C library, which its process has loaded: it is not part of a law
        /// that links to it. In a process without it the linker searches for it.
        #[test]
        fn needs_are_read_from_a_program() {
            let own = std::env::current_exe().unwrap();
            let bytes = std::fs::read(&own).unwrap();
            let needs = DynamicSection::read(&bytes).unwrap();
            let libc = needs.names.iter().find(|n| n.starts_with(b"libc."));
            let libc = libc.unwrap_or_else(|| panic!("{needs:?}"));
            let process = names(&loaded());
            assert!(process.contains(libc), "{process:?}");
            let with = LinkPlan::beside(&own, &process).unwrap();
            assert!(with.found.is_empty() && !with.names.contains(libc));
            let without = LinkPlan::beside(&own, &BTreeSet::new()).unwrap();
            assert!(without.names.contains(libc), "{without:?}");
            for length in [0, 5, 40, 100, 1000] {
                assert!(DynamicSection::read(&bytes[..length]).is_none());
            }
        }

        #[test]
        fn variants_for_processors_are_found() {
            let folder =
                std::env::temp_dir().join(format!("fretwork-hwcaps-{}", std::process::id()));
            let name = Path::new("libx.so");
            for inner in ["glibc-hwcaps/x86-64-v2", "tls", "haswell/x86_64"] {
                let inner = folder.join(inner);
                std::fs::create_dir_all(&inner).unwrap();
                assert_eq!(variant(&folder, name), None);
                std::fs::write(inner.join(name), "").unwrap();
                assert_eq!(variant(&folder, name), Some(inner.join(name)));
                std::fs::remove_file(inner.join(name)).unwrap();
            }
            std::fs::remove_dir_all(&folder).unwrap();
        }

        /// Loaded libraries are compared with those that were read.
        #[test]
        fn libraries_that_came_are_those_that_were_read() {
            let folder = std::env::temp_dir().join(format!("fretwork-came-{}", std::process::id()));
            let inner = folder.join("inner");
            std::fs::create_dir_all(&inner).unwrap();
            let [read, variant] = [&folder, &inner].map(|f| f.join("libx.so"));
            std::fs::write(&read, "read").unwrap();
            std::fs::write(&variant, "variant").unwrap();
            let plan = LinkPlan {
                found: vec![read.clone()],
                folders: [folder.clone()].into(),
                names: [b"libx.so".to_vec()].into(),
            };
            let said = |before: &[&PathBuf], now: &[&PathBuf]| {
                let owned = |list: &[&PathBuf]| -> Vec<PathBuf> {
                    list.iter().map(|p| (*p).clone()).collect()
                };
                plan.check(&owned(before), &owned(now))
            };
            assert_eq!(said(&[], &[&read]), Ok(()));
            // Another law loaded it.
            assert_eq!(said(&[&read], &[&read]), Ok(()));
            let other = said(&[], &[&variant]).unwrap_err();
            assert!(other.contains("did not load that file") && other.contains("inner"));
            let more = said(&[], &[&read, &variant]).unwrap_err();
            assert!(more.contains("was not examined"), "{more}");
            assert_eq!(said(&[&variant], &[&variant, &read]), Ok(()));
            std::fs::remove_dir_all(&folder).unwrap();
        }
    }
}
