//! Files of a run, written by the program: their contents and their agreement.

mod contacts;
mod documented;
mod elastic_grains;
mod fields;
mod ledger;
mod meshes;
mod names;
mod streams;

use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn fretwork(args: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_fretwork"))
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .args(args)
        .output()
        .unwrap()
}

fn folder(name: &str) -> PathBuf {
    let dir = std::env::temp_dir().join(format!("fretwork-results-{}-{name}", std::process::id()));
    std::fs::remove_dir_all(&dir).ok();
    dir
}

fn run(case: &str, out: &Path, extra: &[&str]) -> (Output, Value) {
    let mut args = vec!["run", case, "--out", out.to_str().unwrap()];
    args.extend(extra);
    let output = fretwork(&args);
    let text = std::fs::read_to_string(out.join("summary.json")).unwrap_or_default();
    (output, serde_json::from_str(&text).unwrap_or(Value::Null))
}

#[test]
fn a_run_leaves_the_files_of_the_contract() {
    let out = folder("contract");
    let (output, s) = run(
        "cases/verification/energy.ron",
        &out,
        &["--set", "output.frames=2"],
    );
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    for key in [
        "case",
        "steps",
        "time",
        "wall_seconds",
        "contacts",
        "bonds",
        "broken",
        "damage_ratio",
        "energetic_coefficient",
        "plugins",
        "seed",
        "version",
    ] {
        assert!(!s[key].is_null(), "{key}");
    }
    // None in partial slip.
    assert!(s.get("friction_coefficient").is_some());
    for key in [
        "kinetic",
        "potential",
        "elastic",
        "fracture",
        "friction",
        "impact",
        "correction",
        "external_work",
        "residual",
    ] {
        assert!(s["energy"][key].is_number(), "energy.{key}");
    }
    for key in ["Qs", "Qi", "Qe", "Qw"] {
        assert!(s["wear"][key].is_number(), "wear.{key}");
    }
    for key in [
        "iterations_mean",
        "iterations_max",
        "error_max",
        "unconverged_steps",
    ] {
        assert!(s["solver"][key].is_number(), "solver.{key}");
    }
    let steps = s["steps"].as_u64().unwrap() as usize;
    let table = std::fs::read_to_string(out.join("statistics.csv")).unwrap();
    assert_eq!(table.lines().count(), steps + 1);
    assert!(table.starts_with("step,time [s],"));
    let signature = std::fs::read(out.join("results.h5")).unwrap();
    assert!(signature.starts_with(b"\x89HDF\r\n\x1a\n"));
    assert_eq!(std::fs::read_dir(out.join("frames")).unwrap().count(), 3);
    // The hash in the summary is that of the library that was opened.
    let plugin = &s["plugins"][0];
    let library = std::fs::read(plugin["path"].as_str().unwrap()).unwrap();
    use sha2::{Digest, Sha256};
    let sha: String = Sha256::digest(library)
        .iter()
        .map(|b| format!("{b:02x}"))
        .collect();
    assert_eq!(plugin["sha256"].as_str().unwrap(), sha);
    std::fs::remove_dir_all(out).ok();
}

#[test]
fn results_are_the_same_for_any_number_of_threads() {
    let runs: Vec<String> = ["1", "2"]
        .map(|threads| {
            let out = folder(&format!("threads-{threads}"));
            let sets = [
                "--threads",
                threads,
                "--set",
                "time.end=1e-5",
                "--set",
                "output.frames=0",
                "--set",
                "output.views=0",
            ];
            let (output, _) = run("cases/benchmarks/cohesive_disks_3000.ron", &out, &sets);
            assert!(
                output.status.success(),
                "{}",
                String::from_utf8_lossy(&output.stderr)
            );
            let table = std::fs::read_to_string(out.join("statistics.csv")).unwrap();
            std::fs::remove_dir_all(out).ok();
            table
        })
        .into();
    assert_eq!(runs[0], runs[1]);
}

#[test]
fn one_word_swaps_a_law() {
    let out = folder("swap");
    let sets = [
        "--set",
        "interfaces.grain.cohesion=mac",
        "--set",
        "interfaces.grain.parameters.cohesion={\"c_n\": 1e7}",
        "--set",
        "time.end=0.03",
    ];
    let (output, s) = run("cases/verification/energy.ron", &out, &sets);
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    let names: Vec<&str> = s["plugins"]
        .as_array()
        .unwrap()
        .iter()
        .filter_map(|p| p["name"].as_str())
        .collect();
    assert_eq!(names, ["coulomb", "mac"]);
    std::fs::remove_dir_all(out).ok();
}

#[test]
fn bonds_break_stay_broken_and_go_on_as_contacts() {
    let out = folder("broken");
    let sets = [
        "--set",
        "interfaces.grain.damage=mohr-coulomb-brittle",
        "--set",
        "interfaces.grain.parameters.damage={\"tensile_strength\": 2e3, \"cohesion\": 2e3, \"friction\": 0.0}",
    ];
    let (output, s) = run("cases/verification/energy.ron", &out, &sets);
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    assert!(s["broken"].as_u64().unwrap() > 0 && s["bonds"].as_u64() >= s["broken"].as_u64());
    assert!(
        s["energy"]["fracture"].as_f64().unwrap() > 0.0
            && s["energy"]["friction"].as_f64().unwrap() > 0.0
    );
    // The ledger closes through the breaking.
    assert!(s["energy_residual_relative"].as_f64().unwrap() < 1e-9);
    let table = std::fs::read_to_string(out.join("statistics.csv")).unwrap();
    let mut lines = table.lines();
    let column = lines
        .next()
        .unwrap()
        .split(',')
        .position(|c| c == "bonds_broken")
        .unwrap();
    let counts: Vec<f64> = lines
        .map(|l| l.split(',').nth(column).unwrap().parse().unwrap())
        .collect();
    assert!(counts.windows(2).all(|w| w[1] >= w[0]));
    std::fs::remove_dir_all(out).ok();
}

#[test]
fn a_folder_that_cannot_be_written_is_said() {
    let file = folder("file");
    std::fs::write(&file, "in the way").unwrap();
    let out = file.join("below");
    let output = fretwork(&[
        "run",
        "cases/verification/column.ron",
        "--out",
        out.to_str().unwrap(),
    ]);
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(
        said.contains("cannot write") && said.contains("--out"),
        "{said}"
    );
    std::fs::remove_file(file).ok();
}

#[test]
fn a_biaxial_test_leaves_its_figure_and_its_columns() {
    let out = folder("biaxial");
    let sets = ["--set", "time.end=0.42", "--set", "output.figures=true"];
    let words = [&sets[..], &["--verbose"]].concat();
    let (output, s) = run("cases/verification/biaxial.ron", &out, &words);
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(output.status.success(), "{said}");
    assert!(said.contains("friction angle"), "{said}");
    let test = &s["biaxial"];
    // The sample of some 0.1 m is compressed at 0.02 m/s for 0.02 s.
    let strain = test["axial_strain"].as_f64().unwrap();
    assert!((3e-3..6e-3).contains(&strain), "{strain}");
    let compacity = test["compacity_start"].as_f64().unwrap();
    assert!((0.7..0.9).contains(&compacity), "{compacity}");
    let table = std::fs::read_to_string(out.join("statistics.csv")).unwrap();
    let header = table.lines().next().unwrap();
    for column in [
        "sigma_axial [Pa]",
        "p_contacts [Pa]",
        "q_over_p",
        "compacity",
    ] {
        assert!(header.split(',').any(|c| c == column), "{column}");
    }
    assert!(out.join("biaxial.png").exists());
    std::fs::remove_dir_all(out).ok();
}
