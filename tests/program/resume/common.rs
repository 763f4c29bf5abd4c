//! Runs of the program to their end or until they are killed, and comparison of two folders.

use fretwork::record::checkpoint::{Frame, FrameKind};
use fretwork::record::results::PreviousResults;
use fretwork::record::summary::NOT_REPRODUCIBLE;
use hdf5::H5File;
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

/// A separate folder, initially empty and finally removed.
pub struct Folder(pub PathBuf);

impl Folder {
    pub fn new(name: &str) -> Self {
        let dir = format!("fretwork-resume-{}-{name}", std::process::id());
        let dir = std::env::temp_dir().join(dir);
        std::fs::remove_dir_all(&dir).ok();
        Self(dir)
    }

    /// Another folder with the same files.
    pub fn copied(&self, name: &str) -> Self {
        let copy = Self::new(name);
        std::fs::create_dir_all(&copy.0).unwrap();
        for name in files(&self.0) {
            let to = copy.0.join(&name);
            std::fs::create_dir_all(to.parent().unwrap()).unwrap();
            std::fs::copy(self.0.join(&name), to).unwrap();
        }
        copy
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        std::fs::remove_dir_all(&self.0).ok();
    }
}

/// A case of the repository with changes.
#[derive(Clone, Copy)]
pub struct Job<'a> {
    pub case: &'a str,
    pub sets: &'a [&'a str],
}

/// Environment variable that makes the results file grow in place from this number of bytes on.
pub const IN_PLACE: &str = "FRETWORK_COPY_LIMIT";

/// Whether a file is marked as being written, by a byte of its superblock.
pub fn marked(path: &Path) -> bool {
    let bytes = std::fs::read(path).unwrap();
    assert!(bytes.starts_with(b"\x89HDF\r\n\x1a\n") && bytes[8] >= 2);
    bytes[11] != 0
}

impl Job<'_> {
    pub fn command(&self, out: &Path, extra: &[&str]) -> Command {
        // Repeated steps are most of the work of a short run, so only jobs that name them make
        // them.
        let repeats = self.sets.iter().any(|s| s.starts_with("uncertainty."));
        let without: &[&str] = if repeats {
            &[]
        } else {
            &["--set", "uncertainty.repeats=0"]
        };
        let mut command = Command::new(env!("CARGO_BIN_EXE_fretwork"));
        command
            .current_dir(env!("CARGO_MANIFEST_DIR"))
            .args(["run", &format!("cases/{}.ron", self.case), "--out"])
            .arg(out)
            .args(self.sets.iter().flat_map(|s| ["--set", s]))
            .args(without)
            .args(extra)
            .stdin(Stdio::null());
        command
    }

    /// Runs to the end.
    pub fn run(&self, out: &Path, extra: &[&str]) -> Output {
        self.command(out, extra).output().unwrap()
    }

    /// Runs to the end, which must be successful; returns the output.
    pub fn done(&self, out: &Path, extra: &[&str]) -> String {
        said(&self.run(out, extra), 0)
    }

    /// Starts the run in the background, to be killed.
    pub fn start(&self, out: &Path, extra: &[&str]) -> Child {
        let mut command = self.command(out, extra);
        command.stdout(Stdio::null()).stderr(Stdio::null());
        command.spawn().unwrap()
    }

    /// Kills the run as soon as this number of states was saved.
    pub fn killed_after(&self, out: &Path, states: u64) {
        // On a busy machine a run may end before it is noticed.
        for _ in 0..5 {
            if self.try_kill(out, states) {
                return;
            }
            std::fs::remove_dir_all(out).unwrap();
        }
        panic!("{} always ended before it was killed", self.case);
    }

    fn try_kill(&self, out: &Path, states: u64) -> bool {
        let mut child = self.start(out, &[]);
        let begun = Instant::now();
        loop {
            // A file that is being written may be read in the middle of a change, so it is read
            // again.
            let last = last_frame(out);
            if last.is_some_and(|f| f.kind == FrameKind::State && f.number >= states) {
                break;
            }
            if let Some(status) = child.try_wait().unwrap() {
                assert!(status.success(), "{status}");
                return false;
            }
            assert!(begun.elapsed() < Duration::from_secs(300), "no checkpoint");
            std::thread::sleep(Duration::from_millis(2));
        }
        child.kill().unwrap();
        let status = child.wait().unwrap();
        !status.success() && !out.join("summary.json").exists()
    }
}

/// Name of the file that a run writes before it gets the name of the results; a killed run may
/// leave one.
pub fn draft(out: &Path) -> Option<Vec<u8>> {
    std::fs::read(out.join("results.h5.part")).ok()
}

/// The last whole frame of a folder.
pub fn last_frame(out: &Path) -> Option<Frame> {
    let kept = PreviousResults::open(&out.join("results.h5")).ok()?;
    let slots = kept.checkpoints().ok()?;
    let frames = slots
        .iter()
        .flatten()
        .filter_map(|bytes| Frame::read(bytes));
    frames.max_by_key(|f| f.number)
}

/// Returns the output of a command, which must have ended with this code and without a panic.
pub fn said(output: &Output, code: i32) -> String {
    let text = [&output.stdout[..], &output.stderr[..]].concat();
    let text = String::from_utf8_lossy(&text).into_owned();
    assert_eq!(output.status.code(), Some(code), "{text}");
    assert!(!text.contains("panicked"), "{text}");
    text
}

/// Returns all files below a folder, by their relative paths.
pub fn files(folder: &Path) -> Vec<String> {
    let mut out = Vec::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let entry = entry.unwrap();
        let name = entry.file_name().into_string().unwrap();
        if entry.path().is_dir() {
            out.extend(
                files(&entry.path())
                    .into_iter()
                    .map(|f| format!("{name}/{f}")),
            );
        } else {
            out.push(name);
        }
    }
    out.sort();
    out
}

/// Returns the datasets of a results file except checkpoints: shape and bytes, or texts.
fn datasets(path: &Path) -> BTreeMap<String, (Vec<usize>, Vec<u8>)> {
    let file = H5File::open(path).unwrap();
    let mut out = BTreeMap::new();
    for name in file.dataset_names() {
        if name.starts_with("checkpoints/") {
            continue;
        }
        let set = file.dataset(&name).unwrap();
        let bytes = match set.read_raw::<f64>() {
            Ok(values) => values
                .iter()
                .flat_map(|x| x.to_bits().to_le_bytes())
                .collect(),
            Err(_) => match set.read_raw::<i64>() {
                Ok(values) => values.iter().flat_map(|x| x.to_le_bytes()).collect(),
                Err(_) if name.ends_with("/Types") => set.read_raw::<u8>().unwrap(),
                Err(_) => set.read_strings().unwrap().join("\0").into_bytes(),
            },
        };
        out.insert(name, (set.shape(), bytes));
    }
    out
}

/// Returns a summary without values that depend on the clock and the machine.
fn summary(folder: &Path) -> Value {
    let text = std::fs::read_to_string(folder.join("summary.json")).unwrap();
    let mut value: Value = serde_json::from_str(&text).unwrap();
    for pointer in NOT_REPRODUCIBLE {
        if let Some(found) = value.pointer_mut(pointer) {
            *found = Value::Null;
        }
    }
    value
}

/// Returns a report without values that depend on the clock and the machine, which are rows of a
/// separate class.
fn without_clock(page: &[u8]) -> Vec<u8> {
    let lines = page.split(|b| *b == b'\n');
    let clock = |line: &&[u8]| !line.starts_with(b"<tr class=\"clock\">");
    lines.filter(clock).collect::<Vec<_>>().join(&b'\n')
}

/// Checks that two folders are bit-identical, except for values of the clock and checkpoints.
pub fn same(one: &Path, other: &Path) {
    assert_eq!(files(one), files(other));
    let (a, b) = (
        datasets(&one.join("results.h5")),
        datasets(&other.join("results.h5")),
    );
    assert!(a.len() > 20);
    assert_eq!(a.keys().collect::<Vec<_>>(), b.keys().collect::<Vec<_>>());
    for (name, values) in &a {
        assert_eq!(values.0, b[name].0, "shape of {name}");
        assert!(values.1 == b[name].1, "{name} differs");
    }
    assert_eq!(summary(one), summary(other));
    for name in files(one) {
        if ["results.h5", "summary.json"].contains(&name.as_str()) {
            continue;
        }
        let [mut a, mut b] = [one, other].map(|f| std::fs::read(f.join(&name)).unwrap());
        if name == "report.html" {
            [a, b] = [a, b].map(|page| without_clock(&page));
        }
        assert!(a == b, "{name} differs");
    }
}
