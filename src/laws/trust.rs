//! Whether a library may be opened: only who may change the user's own files may have put it there.

use std::path::Path;

/// Why a library should not be opened, if it should not: anybody can write to it or to its folder.
#[cfg(unix)]
pub(super) fn doubt(library: &Path) -> Option<String> {
    use std::os::unix::fs::PermissionsExt;
    // A link is judged by what it leads to.
    let real = library.canonicalize().ok()?;
    let open = |path: &Path| {
        let mode = path.metadata().ok()?.permissions().mode();
        (mode & 0o002 != 0).then(|| {
            format!(
                "anybody may write to {} (mode {:04o}), so it may not be what you put there; take that right away (chmod o-w), or \
                 say --trust-plugins if you know who writes there",
                path.display(),
                mode & 0o7777
            )
        })
    };
    let folders = [library.parent(), real.parent()];
    let folders = folders.into_iter().flatten();
    open(&real).or_else(|| folders.filter(|f| !f.as_os_str().is_empty()).find_map(open))
}

/// Rights are not looked at where they are not those of POSIX.
#[cfg(not(unix))]
pub(super) fn doubt(_: &Path) -> Option<String> {
    None
}
