//! A folder of results after the program was built anew: shipped laws are no inputs of a run.

use crate::temp::TempFolder;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// Runs a case with a program, and with options.
fn run(program: &Path, folder: &Path, options: &[&str]) -> Output {
    let case = Path::new(env!("CARGO_MANIFEST_DIR")).join("cases/verification/incline.ron");
    let mut command = Command::new(program);
    command.arg("run").arg(case).args(["--out", "out"]);
    let sets = ["--set", "time.end=0.01", "--no-report"];
    let output = command
        .args(sets)
        .args(options)
        .current_dir(folder)
        .output();
    output.unwrap()
}

/// Returns a copy of the program with another SHA-256. Another process writes it, since a file that
/// this one has open to write cannot be run.
fn rebuilt(folder: &Path) -> PathBuf {
    let make = "cp \"$0\" fretwork && echo >> fretwork";
    let program = env!("CARGO_BIN_EXE_fretwork");
    let mut shell = Command::new("sh");
    let made = shell
        .args(["-c", make, program])
        .current_dir(folder)
        .status();
    assert!(made.unwrap().success());
    folder.join("fretwork")
}

#[cfg(target_os = "linux")]
#[test]
fn a_finished_run_is_made_again_and_not_resumed_by_another_build() {
    let folder = TempFolder::new("rebuilt");
    let (first, second) = (Path::new(env!("CARGO_BIN_EXE_fretwork")), rebuilt(&folder));
    let said = |output: &Output, code: i32| {
        let text = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(code), "{text}");
        text
    };
    said(&run(first, &folder, &[]), 0);
    let resumed = said(&run(&second, &folder, &["--resume"]), 2);
    assert!(
        resumed.contains("another build of this version"),
        "{resumed}"
    );
    said(&run(&second, &folder, &[]), 0);
    // Other inputs are still kept.
    let other = said(&run(first, &folder, &["--set", "time.step=5e-4"]), 2);
    assert!(other.contains("a run of other inputs"), "{other}");
}
