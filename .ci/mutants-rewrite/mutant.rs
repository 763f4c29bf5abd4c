//! Which fault acts: part of a tree with faults only, see docs/dev/mutants.md.

use std::fs::{File, OpenOptions};
use std::io::Write;
use std::sync::LazyLock;
use std::sync::atomic::{AtomicBool, Ordering};

static ACTIVE: LazyLock<usize> = LazyLock::new(|| std::env::var("FRETWORK_MUTANT").map_or(0, |n| n.parse().unwrap_or(0)));
/// The file to which the numbers of faults are added whose place is reached.
static RECORD: LazyLock<Option<File>> = LazyLock::new(|| {
    let path = std::env::var_os("FRETWORK_REACHED")?;
    OpenOptions::new().create(true).append(true).open(path).ok()
});
static REACHED: [AtomicBool; 1 << 16] = [const { AtomicBool::new(false) }; 1 << 16];

pub fn active(number: usize) -> bool {
    if let Some(mut file) = RECORD.as_ref()
        && !REACHED[number].swap(true, Ordering::Relaxed)
    {
        let _ = file.write_all(format!("{number}\n").as_bytes());
    }
    *ACTIVE == number
}
