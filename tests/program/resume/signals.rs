//! SIGINT, SIGTERM, and the signals of a terminal and of limits: a run ends at the end of its step
//! with a summary, prints how to resume it, and is then bit-identical to an uninterrupted one.

use super::common::{Folder, Job, last_frame, same};
use fretwork::record::checkpoint::FrameKind;
use serde_json::Value;
use std::path::Path;
use std::process::{Child, Output, Stdio};
use std::time::{Duration, Instant};

const SETS: [&str; 3] = [
    "output.checkpoint=Steps(100)",
    "output.frames=2",
    "output.every=1",
];
/// Steps of a run.
const STEPS: u64 = 1000;

const JOB: Job<'static> = Job {
    case: "verification/energy",
    sets: &SETS,
};

/// Sends a signal.
fn signal(child: &Child, signal: i32) {
    // SAFETY: no memory is touched; the child has not been waited for, so the number is its own.
    let sent = unsafe { libc::kill(child.id() as libc::pid_t, signal) };
    assert_eq!(sent, 0);
}

/// Whether the run in a folder has kept a state.
fn kept(out: &Path) -> bool {
    last_frame(out).is_some_and(|f| f.kind == FrameKind::State && f.number >= 1)
}

/// Interrupts a run between its first checkpoint and its end; returns its output.
fn interrupted(job: &Job<'_>, out: &Path, number: i32) -> Output {
    // On a busy machine a run may end before it is noticed.
    for _ in 0..5 {
        let mut command = job.command(out, &[]);
        command.stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = command.spawn().unwrap();
        let begun = Instant::now();
        while !kept(out) && child.try_wait().unwrap().is_none() {
            assert!(begun.elapsed() < Duration::from_secs(300), "no checkpoint");
            std::thread::sleep(Duration::from_millis(2));
        }
        if child.try_wait().unwrap().is_none() {
            signal(&child, number);
            let output = child.wait_with_output().unwrap();
            if !output.status.success() {
                return output;
            }
        }
        std::fs::remove_dir_all(out).unwrap();
    }
    panic!("{} always ended before the signal", job.case);
}

fn summary(out: &Path) -> Value {
    let text = std::fs::read_to_string(out.join("summary.json")).unwrap();
    serde_json::from_str(&text).unwrap()
}

#[test]
fn a_run_that_is_interrupted_ends_well_and_goes_on_with_the_same_bits() {
    let whole = Folder::new("signals-whole");
    JOB.done(&whole.0, &[]);
    for (number, name) in [
        (libc::SIGINT, "SIGINT"),
        (libc::SIGTERM, "SIGTERM"),
        (libc::SIGHUP, "SIGHUP"),
        (libc::SIGXCPU, "SIGXCPU"),
        (libc::SIGXFSZ, "SIGXFSZ"),
    ] {
        let folder = Folder::new(&format!("signals-{name}"));
        let output = interrupted(&JOB, &folder.0, number);
        assert_eq!(output.status.code(), Some(1), "{output:?}");
        let said = String::from_utf8_lossy(&output.stderr);
        let (stop, said) = said.split_once("error: interrupted by ").unwrap();
        assert!(
            !stop.contains("panicked") && said.starts_with(name),
            "{said}"
        );
        let command = said.lines().last().unwrap();
        assert!(
            command.contains("run cases/verification/energy.ron") && command.ends_with("--resume")
        );
        let printed = String::from_utf8_lossy(&output.stdout);
        assert!(
            printed.contains("NOT TRUSTWORTHY\n  INTERRUPTED: interrupted by "),
            "{printed}"
        );
        assert!(folder.0.join("energy.png").exists());
        let kept = summary(&folder.0);
        assert_eq!(kept["trustworthy"], false);
        let steps = kept["steps"].as_u64().unwrap();
        assert!((100..STEPS).contains(&steps), "{steps}");
        assert!(
            kept["reasons"][0]
                .as_str()
                .unwrap()
                .starts_with("INTERRUPTED: ")
        );
        // The state is that of the step with which the run ended: nothing is computed again.
        let rows = std::fs::read_to_string(folder.0.join("statistics.csv")).unwrap();
        assert_eq!(rows.lines().count() as u64, steps + 1);
        // The printed command is run literally in a shell.
        let mut shell = std::process::Command::new("sh");
        shell
            .args(["-c", command.trim()])
            .current_dir(env!("CARGO_MANIFEST_DIR"));
        let resumed = shell.output().unwrap();
        assert!(resumed.status.success(), "{resumed:?}");
        assert!(String::from_utf8_lossy(&resumed.stdout).contains("resuming the run"));
        let first = String::from_utf8_lossy(&resumed.stderr);
        let first = first.lines().find_map(|l| l.strip_prefix("step ")).unwrap();
        let step: u64 = first.split('/').next().unwrap().parse().unwrap();
        assert!(step > steps, "{first}");
        same(&whole.0, &folder.0);
    }
}

#[test]
fn a_run_without_checkpoints_is_kept_when_it_is_interrupted() {
    let sets = ["output.checkpoint=Never", "output.frames=0"];
    let job = Job {
        case: JOB.case,
        sets: &sets,
    };
    let (whole, folder) = (
        Folder::new("signals-never-whole"),
        Folder::new("signals-never"),
    );
    job.done(&whole.0, &[]);
    let mut ended = false;
    for _ in 0..5 {
        let mut child = job.start(&folder.0, &["--json"]);
        let begun = Instant::now();
        // Rows are flushed at most once a second; the file exists before the first step.
        while !folder.0.join("statistics.csv").exists() && child.try_wait().unwrap().is_none() {
            assert!(begun.elapsed() < Duration::from_secs(300));
            std::thread::sleep(Duration::from_millis(1));
        }
        std::thread::sleep(Duration::from_millis(5));
        signal(&child, libc::SIGINT);
        ended = child.wait().unwrap().code() == Some(1);
        if ended {
            break;
        }
        std::fs::remove_dir_all(&folder.0).unwrap();
    }
    assert!(ended && kept(&folder.0));
    job.done(&folder.0, &["--resume"]);
    same(&whole.0, &folder.0);
}
