//! Standard streams that are closed or full: nothing panics, a run ends as usual, and a requested
//! answer that could not be written is a failure.
#![cfg(unix)]

use super::folder;
use std::process::{Command, Output, Stdio};

/// A command through a shell, which redirects its streams.
fn shell(arguments: &str, streams: &str) -> Output {
    let program = env!("CARGO_BIN_EXE_fretwork");
    Command::new("sh")
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .args(["-c", &format!("exec {program} {arguments} {streams}")])
        .output()
        .unwrap()
}

/// A command whose streams go into pipes that nobody reads.
fn broken_pipe(arguments: &str) -> Option<i32> {
    let mut child = Command::new(env!("CARGO_BIN_EXE_fretwork"))
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .args(arguments.split(' '))
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    drop((child.stdout.take(), child.stderr.take()));
    child.wait().unwrap().code()
}

fn code(output: &Output) -> i32 {
    let reported = String::from_utf8_lossy(&output.stderr);
    assert!(!reported.contains("panicked"), "{reported}");
    output.status.code().expect("ended by a signal")
}

const CASE: &str = "cases/verification/bouncing_ball.ron";

/// Commands that are fast, and their exit codes if all streams are open.
fn commands(out: &str) -> Vec<(String, i32)> {
    let solve = "solve tests/fclib/fc3d_OneContact_reduced.hdf5";
    vec![
        (format!("run {CASE} --out {out} --set time.end=0.01"), 0),
        ("run cases/none.ron".to_owned(), 2),
        (format!("check {CASE}"), 0),
        ("law show coulomb".to_owned(), 0),
        ("law drive contact/nothing".to_owned(), 2),
        (solve.to_owned(), 0),
        ("trade cases/none.ron".to_owned(), 2),
    ]
}

#[test]
fn standard_error_that_is_closed_or_full_changes_no_exit_code() {
    let out = folder("stderr");
    let place = out.to_str().unwrap();
    for (arguments, expected) in commands(place) {
        for streams in ["2>&-", "2>/dev/full", "2>/dev/full --json"] {
            if streams.contains("json") && !arguments.starts_with("run") {
                continue;
            }
            let output = shell(&arguments, streams);
            assert_eq!(code(&output), expected, "{arguments} {streams}");
        }
    }
    assert!(out.join("summary.json").exists());
    std::fs::remove_dir_all(out).ok();
}

#[test]
fn standard_output_that_is_full_fails_answers_and_no_run() {
    let out = folder("stdout");
    let place = out.to_str().unwrap();
    for (arguments, expected) in commands(place) {
        let run = arguments.starts_with("run");
        let output = shell(&arguments, ">/dev/full");
        let fails = if expected == 0 && !run { 1 } else { expected };
        assert_eq!(code(&output), fails, "{arguments} >/dev/full");
        if expected == 0 && !run {
            let reported = String::from_utf8_lossy(&output.stderr);
            assert!(reported.contains("cannot write the answer"), "{reported}");
        }
        assert_eq!(code(&shell(&arguments, ">&-")), expected, "{arguments} >&-");
    }
    for arguments in [
        format!("run {CASE} --out {place} --set time.end=0.01 --json"),
        format!("run {CASE} --out {place} --set time.end=0.01 --json --resume"),
        "solve --json tests/fclib/fc3d_OneContact_reduced.hdf5".to_owned(),
        "--help".to_owned(),
    ] {
        let output = shell(&arguments, ">/dev/full");
        assert_eq!(code(&output), 1, "{arguments}");
        let reported = String::from_utf8_lossy(&output.stderr);
        assert!(reported.contains("cannot write the answer"), "{reported}");
    }
    // The recorded results exist.
    assert!(out.join("summary.json").exists());
    std::fs::remove_dir_all(out).ok();
}

#[test]
fn both_streams_full_or_read_by_nobody() {
    let out = folder("both");
    let place = out.to_str().unwrap();
    for (arguments, expected) in commands(place) {
        let answers = expected == 0 && !arguments.starts_with("run");
        let fails = if answers { 1 } else { expected };
        let output = shell(&arguments, ">/dev/full 2>/dev/full");
        assert_eq!(code(&output), fails, "{arguments}");
        assert_eq!(
            code(&shell(&arguments, ">&- 2>&-")),
            expected,
            "{arguments}"
        );
        // A reader that closed its pipe is not an error.
        assert_eq!(broken_pipe(&arguments), Some(expected), "{arguments}");
    }
    std::fs::remove_dir_all(out).ok();
}

/// A study of three short runs, with its progress.
#[test]
fn a_study_goes_on_without_its_streams() {
    let out = folder("trade-streams");
    let trade = format!(
        "trade cases/verification/bond_mode_1.ron --out {} --output energy.elastic=10% --set time.end=7e-6 --set time.step=4e-8 --vary time.step=4e-8,8e-8 --budget 10m",
        out.display()
    );
    let open = code(&shell(&trade, ""));
    for (streams, json) in [(">/dev/full 2>/dev/full", false), (">/dev/full", true)] {
        let arguments = format!("{trade}{}", if json { " --json" } else { "" });
        let ended = code(&shell(&arguments, streams));
        let expected = if json && open == 0 { 1 } else { open };
        assert_eq!(ended, expected, "{arguments} {streams}");
    }
    assert_eq!(open, 0);
    assert!(out.join("trade.json").exists());
    std::fs::remove_dir_all(out).ok();
}

/// Memory for this number of stacks does not exist: there is a message, and not a panic.
#[test]
fn threads_that_cannot_be_started_are_told() {
    let out = folder("threads-limit");
    let run = format!("run {CASE} --out {} --threads 1024", out.display());
    let program = env!("CARGO_BIN_EXE_fretwork");
    let output = Command::new("sh")
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .args(["-c", &format!("ulimit -v 1000000; exec {program} {run}")])
        .output()
        .unwrap();
    assert_eq!(code(&output), 1);
    let reported = String::from_utf8_lossy(&output.stderr);
    assert!(reported.contains("cannot start 1024 threads"), "{reported}");
    std::fs::remove_dir_all(out).ok();
}

/// Memory that the system refuses ends the program with a message and exit code 1, without a
/// signal.
#[cfg(target_os = "linux")]
#[test]
fn memory_that_runs_out_is_told() {
    let out = folder("memory-limit");
    std::fs::create_dir_all(&out).unwrap();
    let case = out.join("many.ron");
    let grain = |k: usize| format!("(at: [{}.0, {}.0], radius: 0.5)", k % 1000, k / 1000);
    let grains: Vec<String> = (0..200_000).map(grain).collect();
    let text = format!(
        r#"(name: "many", dimension: 2, time: (step: 1e-4, end: 1e-3), materials: {{"g": "glass_bead"}},
        interfaces: [(name: "g", between: ("g", "g"), contact: "frictionless")],
        grains: [List(material: "g", grains: [{}])])"#,
        grains.join(",")
    );
    std::fs::write(&case, text).unwrap();
    let program = env!("CARGO_BIN_EXE_fretwork");
    let run = format!("run {} --out {}/run", case.display(), out.display());
    for limit in [200_000, 300_000] {
        let output = Command::new("sh")
            .args(["-c", &format!("ulimit -v {limit}; exec {program} {run}")])
            .output()
            .unwrap();
        let reported = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{reported}");
        assert!(
            reported.contains("error: memory ran out: the system refused "),
            "{reported}"
        );
        assert_eq!(reported.lines().count(), 1, "{reported}");
    }
    std::fs::remove_dir_all(out).ok();
}
