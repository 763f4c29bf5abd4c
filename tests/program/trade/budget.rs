//! The budget of a study, and resuming after an interruption.

use super::{BOND, Folder, call, command, study};
use serde_json::Value;
use std::path::Path;
use std::process::Command;
use std::time::{Duration, Instant};

/// A command in a separate process group.
fn in_a_group(mut command: Command) -> Command {
    #[cfg(unix)]
    std::os::unix::process::CommandExt::process_group(&mut command, 0);
    command
}

/// Command lines of the processes that name a folder; none if the system does not list them as
/// Linux does.
fn running(folder: &str) -> Vec<String> {
    let list = std::fs::read_dir("/proc").into_iter().flatten().flatten();
    let lines = list.filter_map(|p| std::fs::read(p.path().join("cmdline")).ok());
    let lines = lines.map(|l| String::from_utf8_lossy(&l).replace('\0', " "));
    lines.filter(|l| l.contains(folder)).collect()
}

#[test]
fn ends_with_the_budget_and_goes_on_after_an_interruption() {
    let folder = Folder::new("budget");
    let out = folder.out();
    // The finest setting takes 280,000 steps, longer than the budget on any machine; the case's own
    // some 1700.
    let long = [
        BOND,
        "--set",
        "time.step=4e-8",
        "--vary",
        "time.step=2.5e-10,4e-8,8e-8",
        "--output",
        "energy.fracture=1%",
        "--out",
        &out,
    ];
    let started = Instant::now();
    let output = call(&[&long[..], &["--budget", "10s"]].concat());
    let (said, wrong) = (
        String::from_utf8_lossy(&output.stdout),
        String::from_utf8_lossy(&output.stderr),
    );
    assert_eq!(output.status.code(), Some(0), "{said}{wrong}");
    assert!(
        said.contains("forecast") && said.contains("INCOMPLETE, the budget is spent"),
        "{said}"
    );
    // Building, the trial for the budget and two probes take additional time, on a machine that may
    // be busy.
    assert!(
        started.elapsed() < Duration::from_secs(60),
        "{:?}",
        started.elapsed()
    );

    let out = folder.0.join("second").display().to_string();
    let common = [
        BOND,
        "--set",
        "time.step=2.5e-10",
        "--vary",
        "time.step=4e-8,2.5e-10",
        "--vary",
        "solver.test_every=1,2",
        "--output",
        "energy.fracture=1%",
        "--out",
        &out,
        "--budget",
        "10m",
    ];
    let child = in_a_group(command(&common))
        .stdout(std::process::Stdio::null())
        .stderr(std::process::Stdio::piped())
        .spawn()
        .unwrap_or_else(|e| panic!("{e}"));
    std::thread::sleep(Duration::from_secs(5));
    // Ctrl-C on a terminal interrupts the study and the runs that it started.
    let killed = Command::new("kill")
        .args(["-INT", "--", &format!("-{}", child.id())])
        .status();
    assert!(killed.is_ok_and(|s| s.success()));
    let started = Instant::now();
    let ended = child.wait_with_output().unwrap_or_else(|e| panic!("{e}"));
    assert!(started.elapsed() < Duration::from_secs(20));
    assert_eq!(ended.status.code(), Some(1));
    let said = String::from_utf8_lossy(&ended.stderr);
    let (_, again) = said
        .split_once("to continue from there:\n")
        .unwrap_or_default();
    assert!(again.contains(" trade ") && again.contains(&out), "{said}");
    assert_eq!(running(&out), Vec::<String>::new(), "runs that were left");
    // Runs that the signal ended are not stored as failed runs.
    let runs = std::fs::read_dir(Path::new(&out).join("runs")).unwrap_or_else(|e| panic!("{e}"));
    for run in runs.flatten() {
        let kept = std::fs::read_to_string(run.path().join("run.json")).unwrap_or_default();
        assert!(!kept.contains("interrupted"), "{kept}");
    }
    let text = std::fs::read_to_string(Path::new(&out).join("trade.json")).unwrap_or_default();
    let left: Value = serde_json::from_str(&text).unwrap_or_default();
    assert_eq!(left["complete"], false, "{text}");
    // A quick study in the folder is answered.
    let quick = study(&[
        BOND,
        "--set",
        "time.step=4e-8",
        "--vary",
        "time.step=4e-8,8e-8",
        "--output",
        "energy.fracture=1%",
        "--out",
        &out,
        "--budget",
        "5m",
    ]);
    assert_eq!(quick["complete"], true);
}
