//! Decides whether a library may be opened: only if nobody but the user and the administrator can
//! have placed or changed it.

#[cfg(unix)]
use super::linked;
use std::path::Path;

/// Returns why a library, or another file that a run relies on, should not be opened, if others can
/// write to it, to a folder or link on its path, or to a library to which it links.
#[cfg(unix)]
pub fn reason_to_distrust(library: &Path) -> Option<String> {
    of_all(library, &[on_the_way::effective_user()])
}

/// Returns why a library in a folder of the program is not trusted, if it is not:
/// [`reason_to_distrust`] with the owner of the folder trusted too, since the owner of the program
/// can change the program itself.
#[cfg(unix)]
pub(super) fn reason_to_distrust_beside_program(library: &Path) -> Option<String> {
    use std::os::unix::fs::MetadataExt;
    let program = crate::program::file().and_then(std::fs::metadata);
    let owners = [
        Some(on_the_way::effective_user()),
        program.ok().map(|p| p.uid()),
    ];
    of_all(library, &owners.into_iter().flatten().collect::<Vec<_>>())
}

#[cfg(unix)]
fn of_all(library: &Path, owners: &[u32]) -> Option<String> {
    let one =
        |path: &Path| on_the_way::reason_to_distrust(path, owners, on_the_way::FileStatus::of);
    one(library).or_else(|| {
        let links = match linked::libraries(library) {
            Ok(links) => links.into_iter(),
            // An error here is reported when the library is opened.
            Err(_) => return None,
        };
        let doubted = links.filter_map(|path| {
            let why = one(&path)?;
            Some(format!("it links to {}: {why}", path.display()))
        });
        doubted.into_iter().next()
    })
}

/// Permissions are not checked on systems without POSIX permissions.
#[cfg(not(unix))]
pub(super) fn reason_to_distrust_beside_program(_: &Path) -> Option<String> {
    None
}

/// Permissions are not checked on systems without POSIX permissions.
#[cfg(not(unix))]
pub fn reason_to_distrust(_: &Path) -> Option<String> {
    None
}

/// Owners and permissions of all components of a path.
#[cfg(unix)]
mod on_the_way {
    use std::collections::VecDeque;
    use std::ffi::OsString;
    use std::os::unix::fs::MetadataExt;
    use std::path::{Component, Path, PathBuf};

    /// The administrator.
    const ROOT: u32 = 0;

    /// Returns the effective user id.
    pub fn effective_user() -> u32 {
        // SAFETY: the function has no arguments and cannot fail.
        unsafe { libc::geteuid() }
    }

    /// Owner, permissions and target of a file, folder or link; links are not followed.
    #[derive(Clone, Debug)]
    pub struct FileStatus {
        pub owner: u32,
        pub mode: u32,
        /// Target of a link.
        pub link: Option<PathBuf>,
    }

    impl FileStatus {
        pub fn of(path: &Path) -> Option<Self> {
            let known = path.symlink_metadata().ok()?;
            let link = known.is_symlink().then(|| path.read_link().ok()).flatten();
            Some(Self {
                owner: known.uid(),
                mode: known.mode(),
                link,
            })
        }

        fn anybody_writes(&self) -> bool {
            // The permissions of a link itself have no effect.
            self.link.is_none() && self.mode & 0o002 != 0
        }

        /// In a sticky folder only the owners of the folder and of a file may rename or remove the
        /// file.
        fn sticky(&self) -> bool {
            self.mode & 0o1000 != 0
        }
    }

    /// Follows a path from the root, link by link, and returns the first component that users other
    /// than these owners and the administrator may change. The first owner is the user.
    pub fn reason_to_distrust(
        library: &Path,
        owners: &[u32],
        place: impl Fn(&Path) -> Option<FileStatus>,
    ) -> Option<String> {
        /// Maximum number of links; a circular path fails when it is opened.
        const LINKS: usize = 40;
        let mut left: VecDeque<OsString> = VecDeque::new();
        let mut here = PathBuf::from("/");
        let names = |path: &Path| -> Vec<OsString> {
            let parts = path.components().filter(|c| *c != Component::CurDir);
            parts.map(|c| c.as_os_str().to_owned()).collect()
        };
        left.extend(names(&std::path::absolute(library).ok()?));
        let mut links = 0;
        while let Some(name) = left.pop_front() {
            if name == ".." {
                here.pop();
                continue;
            }
            here.push(&name);
            let found = place(&here)?;
            let end = left.is_empty();
            if found.anybody_writes() && (end || !found.sticky()) {
                return Some(open(&here, &found));
            }
            // In a folder of laws, even a sticky one, others could add laws.
            let folder = here.parent().filter(|_| end);
            if let Some((path, folder)) = folder.and_then(|p| Some((p, place(p)?)))
                && folder.anybody_writes()
            {
                return Some(open(path, &folder));
            }
            if found.owner != ROOT && !owners.contains(&found.owner) {
                return Some(foreign(&here, &found, owners[0]));
            }
            if let Some(target) = found.link {
                links += 1;
                if links > LINKS {
                    return None;
                }
                here.pop();
                for name in names(&target).into_iter().rev() {
                    left.push_front(name);
                }
            }
        }
        None
    }

    fn open(path: &Path, found: &FileStatus) -> String {
        format!(
            "anybody may write to {} (mode {:04o}), so it may not be what you put there; take that right away (chmod o-w), or say \
             --trust-plugins if you know who writes there",
            path.display(),
            found.mode & 0o7777
        )
    }

    fn foreign(path: &Path, found: &FileStatus, me: u32) -> String {
        format!(
            "{} belongs to user {}, who may change it, and you are user {me}; copy the library to a folder of your own, or say \
             --trust-plugins if you trust that user",
            path.display(),
            found.owner
        )
    }

    #[cfg(test)]
    mod tests {
        use super::*;
        use std::collections::BTreeMap;

        const ME: u32 = 1000;

        /// A tree of places: owner, mode, target of a link.
        fn doubt_in(places: &[(&str, u32, u32, &str)], library: &str) -> Option<String> {
            let tree: BTreeMap<PathBuf, FileStatus> = places
                .iter()
                .map(|(path, owner, mode, link)| {
                    let place = FileStatus {
                        owner: *owner,
                        mode: *mode,
                        link: (!link.is_empty()).then(|| link.into()),
                    };
                    (PathBuf::from(path), place)
                })
                .collect();
            reason_to_distrust(Path::new(library), &[ME], |p| tree.get(p).cloned())
        }

        const ROOTS: [(&str, u32, u32, &str); 2] = [("/", 0, 0o755, ""), ("/tmp", 0, 0o1777, "")];

        fn with(more: &[(&str, u32, u32, &str)], library: &str) -> Option<String> {
            doubt_in(&[&ROOTS, more].concat(), library)
        }

        #[test]
        fn a_library_of_ones_own_below_a_sticky_folder_is_trusted() {
            let own = [("/tmp/a", ME, 0o755, ""), ("/tmp/a/law.so", ME, 0o644, "")];
            assert_eq!(with(&own, "/tmp/a/law.so"), None);
            assert_eq!(with(&own, "/tmp/a/../a/./law.so"), None);
            let roots = [("/tmp/a", 0, 0o755, ""), ("/tmp/a/law.so", 0, 0o644, "")];
            assert_eq!(with(&roots, "/tmp/a/law.so"), None);
        }

        #[test]
        fn others_own_a_part_of_the_way() {
            for other in 0..2 {
                let owner = |k| if k == other { 1001 } else { ME };
                let places = [
                    ("/tmp/a", owner(0), 0o755, ""),
                    ("/tmp/a/law.so", owner(1), 0o644, ""),
                ];
                let said = with(&places, "/tmp/a/law.so").unwrap();
                assert!(said.starts_with(places[other].0), "{said}");
                assert!(said.contains("user 1001") && said.contains("user 1000"));
            }
        }

        #[test]
        fn an_open_folder_above_is_doubted_unless_it_is_sticky() {
            let below = |mode| {
                [
                    ("/tmp/a", ME, mode, ""),
                    ("/tmp/a/b", ME, 0o755, ""),
                    ("/tmp/a/b/law.so", ME, 0o644, ""),
                ]
            };
            let said = with(&below(0o777), "/tmp/a/b/law.so").unwrap();
            assert!(said.contains("write to /tmp/a (mode 0777)"), "{said}");
            assert_eq!(with(&below(0o1777), "/tmp/a/b/law.so"), None);
            // The folder itself must not even be sticky: others could add laws beside this one.
            let beside = [("/tmp/law.so", ME, 0o644, "")];
            for path in ["/tmp/law.so", "/tmp/../tmp/law.so"] {
                assert!(with(&beside, path).unwrap().contains("/tmp (mode 1777)"));
            }
        }

        #[test]
        fn each_link_is_followed_and_doubted() {
            let linked = |mode, owner| {
                [
                    ("/a", ME, 0o755, ""),
                    ("/a/law.so", ME, 0o777, "../b/law.so"),
                    ("/b", ME, 0o777, "/c/d"),
                    ("/c", ME, mode, ""),
                    ("/c/d", ME, 0o755, ""),
                    ("/c/d/law.so", owner, 0o644, ""),
                ]
            };
            assert_eq!(with(&linked(0o755, ME), "/a/law.so"), None);
            let said = with(&linked(0o777, ME), "/a/law.so").unwrap();
            assert!(said.contains("write to /c "), "{said}");
            let said = with(&linked(0o755, 7), "/a/law.so").unwrap();
            assert!(said.starts_with("/c/d/law.so belongs to user 7"), "{said}");
            let round = [("/a", ME, 0o755, "/b"), ("/b", ME, 0o755, "/a")];
            assert_eq!(with(&round, "/a/law.so"), None);
        }
    }
}
