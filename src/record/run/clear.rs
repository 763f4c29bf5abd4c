//! Removal of an older run's files that the new run would not overwrite: the report, pictures of
//! the scene, problems, the pictures and files that observers name (`picture_names`, `file_names`),
//! those of observers that only some cases have, and pictures with measured curves. No other files
//! are removed.

use super::{RunError, unwritable};
use fretwork_observe::Observers;
use fretwork_observe::chart::Figure;
use fretwork_observe::output::{REPORT, is_measured_picture};
use fretwork_observe::standard::{figures_of_some_cases, pictures_of_some_cases};
use std::path::Path;

/// Name prefixes of pictures of the scene, `frames/NAME_STEP.png`, which no observer names.
const PICTURES: [&str; 2] = ["frame", "bonds"];

/// Files of the program in the folder of a run that exist when older files are removed; they do not
/// belong to an observer.
pub(super) const OWN: [&str; 8] = [
    "results.h5",
    "grains.vtkhdf",
    "bodies.vtkhdf",
    "shapes.vtkhdf",
    "contacts.vtkhdf",
    "statistics.csv",
    Figure::FILE,
    "summary.json",
];

/// Removes the report, pictures, problems and figures of an older run from its folder, and the
/// pictures and files whose names observers of the new run declare as their own.
pub(super) fn clear(folder: &Path, observers: &Observers) -> Result<(), RunError> {
    let (mut pictures, files) = (observers.picture_names(), observers.file_names());
    pictures.extend(PICTURES);
    pictures.extend(pictures_of_some_cases());
    let picture = |name: &str| {
        pictures
            .iter()
            .any(|p| numbered(name, &format!("{p}_"), ".png"))
    };
    remove(&folder.join("frames"), &picture)?;
    remove(&folder.join("fclib"), &|name| {
        numbered(name, "step-", ".hdf5")
    })?;
    remove(folder, &|name| {
        let of_observers = files.iter().any(|f| f == name) && !OWN.contains(&name);
        let of_another_case = figures_of_some_cases().any(|f| f == name);
        name == REPORT || is_measured_picture(name) || of_observers || of_another_case
    })
}

/// Whether a name has a step number of at least eight digits between two given texts.
fn numbered(name: &str, before: &str, after: &str) -> bool {
    let rest = name.strip_prefix(before);
    let Some(number) = rest.and_then(|r| r.strip_suffix(after)) else {
        return false;
    };
    let digits = number.bytes().all(|b| b.is_ascii_digit());
    digits && (number.len() == 8 || number.len() > 8 && !number.starts_with('0'))
}

/// Removes the files of a folder whose names are accepted by `ours`.
fn remove(folder: &Path, ours: &dyn Fn(&str) -> bool) -> Result<(), RunError> {
    let Ok(entries) = std::fs::read_dir(folder) else {
        return Ok(());
    };
    for entry in entries.flatten() {
        let is_file = entry.file_type().is_ok_and(|t| t.is_file());
        if is_file && entry.file_name().to_str().is_some_and(ours) {
            let path = entry.path();
            std::fs::remove_file(&path).map_err(|e| unwritable(&path, &e))?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_steps_are_told_from_names_of_others() {
        let ours = |name: &str| numbered(name, "frame_", ".png");
        assert!(ours("frame_00000012.png") && ours("frame_123456789.png"));
        for name in [
            "frame_12.png",
            "frame_0000001a.png",
            "frame_000000012.png",
            "frame_00000012.jpg",
            "my_frame_00000012.png",
            "frame_00000012.png.bak",
            "frame_.png",
        ] {
            assert!(!ours(name), "{name}");
        }
    }
}
