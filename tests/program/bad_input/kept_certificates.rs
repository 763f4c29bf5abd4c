//! Certificates that runs keep for the next ones: of the same program, law and parameters only, and
//! of laws that pass.

use super::trial::{PLANE, Trial, with};
use std::fs::Permissions;
use std::os::unix::fs::PermissionsExt;
use std::path::Path;
use std::process::Command;

/// A law with a partner: damage is certified beside each cohesion law.
#[test]
fn of_laws_with_their_partners() {
    let trial = Trial::new();
    let case = with(
        PLANE,
        r#"contact: "coulomb""#,
        r#"contact: "coulomb", cohesion: "mac", damage: "mac""#,
    );
    let case = with(
        &case,
        r#"contact: {"mu": 0.3}"#,
        r#"contact: {"mu": 0.3}, cohesion: {"c_n": 1e12, "c_t": 1e12}, damage: {"w": 0.1, "b": 0.0, "beta_broken": 0.0}"#,
    );
    trial.write("case.ron", case);
    assert_eq!(run(&trial, &[]), (true, 3));
    // Cohesion of another stiffness, and damage beside it.
    let other = "interfaces.grains.parameters.cohesion.c_n=2e12";
    assert_eq!(run(&trial, &["--set", other]), (true, 5));
    assert_eq!(run(&trial, &["--set", other]), (true, 5));
}

/// Runs the trial's case, and returns whether its laws are certified and how many certificates are
/// kept then.
fn run(trial: &Trial, more: &[&str]) -> (bool, usize) {
    run_by(Path::new(env!("CARGO_BIN_EXE_fretwork")), trial, more)
}

fn run_by(program: &Path, trial: &Trial, more: &[&str]) -> (bool, usize) {
    let output = Command::new(program)
        .args("run case.ron --json --force --plugin-path .".split(' '))
        .args(more)
        .current_dir(trial.path(""))
        .env("XDG_CACHE_HOME", trial.path("cache"))
        .output()
        .unwrap();
    let error = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{error}");
    let summary: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let laws = summary["plugins"].as_array().unwrap();
    let certified = laws.iter().all(|law| law["certified"] == true);
    let kept = std::fs::read(trial.path("cache/fretwork/certificates.txt"));
    let kept = kept.unwrap_or_default();
    (certified, String::from_utf8_lossy(&kept).lines().count())
}

#[test]
fn of_shipped_laws_with_their_parameters() {
    let trial = Trial::new();
    trial.write("case.ron", PLANE);
    assert_eq!(run(&trial, &[]), (true, 1));
    assert_eq!(run(&trial, &[]), (true, 1));
    let other = "interfaces.grains.parameters.contact.mu=0.31";
    assert_eq!(run(&trial, &["--set", other]), (true, 2));
    assert_eq!(run(&trial, &["--set", other]), (true, 2));
    // What is no certificate is none, and a file that has grown large is begun anew.
    let file = trial.path("cache/fretwork/certificates.txt");
    std::fs::write(&file, b"\xff yes\n\n").unwrap();
    assert_eq!(run(&trial, &[]), (true, 3));
    std::fs::write(&file, "a line\n".repeat(200_000)).unwrap();
    assert_eq!(run(&trial, &[]), (true, 1));
    // Another program certifies by itself.
    let program = trial.path("program");
    let mut bytes = std::fs::read(env!("CARGO_BIN_EXE_fretwork")).unwrap();
    bytes.push(0);
    std::fs::write(&program, bytes).unwrap();
    std::fs::set_permissions(&program, Permissions::from_mode(0o755)).unwrap();
    assert_eq!(run_by(&program, &trial, &[]), (true, 2));
    assert_eq!(run(&trial, &[]), (true, 2));
    // What others may write is not believed, and left alone.
    std::fs::set_permissions(&file, Permissions::from_mode(0o666)).unwrap();
    let other = "interfaces.grains.parameters.contact.mu=0.33";
    assert_eq!(run(&trial, &["--set", other]), (true, 2));
    // Without a place for the file every run certifies.
    std::fs::remove_dir_all(trial.path("cache")).unwrap();
    trial.write("cache", "a file");
    assert_eq!(run(&trial, &[]), (true, 0));
}

#[test]
fn of_own_laws_by_their_libraries() {
    let trial = Trial::new();
    let case = with(PLANE, r#"contact: "coulomb""#, r#"contact: "own""#);
    trial.write("case.ron", with(&case, r#"parameters_from: "laws","#, ""));
    trial.compile_helper("lib", "0.2");
    trial.compile_linked_law("own", "lib", "$ORIGIN/lib");
    assert_eq!(run(&trial, &[]), (true, 1));
    assert_eq!(run(&trial, &[]), (true, 1));
    trial.compile_helper("lib", "0.25");
    assert_eq!(run(&trial, &[]), (true, 2));
    // A law that fails is tested at each run.
    trial.compile_bad_law("own", "0", "ROUNDS_UP");
    assert_eq!(run(&trial, &[]), (false, 2));
    assert_eq!(run(&trial, &[]), (false, 2));
}
