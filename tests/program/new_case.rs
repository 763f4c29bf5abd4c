//! `fretwork new case`: what it makes runs at first try, and is trusted.

use crate::temp::TempFolder;
use std::process::{Command, Output, Stdio};

fn program(folder: &TempFolder, words: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_fretwork"))
        .args(words)
        .current_dir(folder)
        .stdin(Stdio::null())
        .output()
        .unwrap()
}

/// Makes a case by the words of a line and runs it by the command that is printed.
fn runs(name: &str, line: &str) {
    let folder = TempFolder::new(&format!("new-{name}"));
    let mut words: Vec<&str> = ["new", "case", "mine.ron"].to_vec();
    words.extend(line.split_whitespace());
    let made = program(&folder, &words);
    let said = String::from_utf8_lossy(&made.stdout).into_owned();
    let error = String::from_utf8_lossy(&made.stderr).into_owned();
    assert!(made.status.success(), "{line}: {error}");
    let command = said.lines().last().unwrap().trim().to_owned();
    let mut words: Vec<&str> = command.split_whitespace().skip(1).collect();
    words.extend(["--out", "out"]);
    if command.contains(" run ") {
        // Anything that is not trustworthy fails.
        words.extend(["--strict", "--no-report"]);
    }
    let run = program(&folder, &words);
    let said = String::from_utf8_lossy(&run.stdout).into_owned();
    let error = String::from_utf8_lossy(&run.stderr).into_owned();
    let text = std::fs::read_to_string(folder.join("mine.ron")).unwrap();
    assert!(run.status.success(), "{line}\n{said}\n{error}\n{text}");
    assert!(!said.contains("NOT TRUSTWORTHY"), "{said}");
    assert!(!said.contains("without convergence"), "{said}");
}

const STEEL: &str = "--material rail_steel_r260";

#[test]
fn balls_without_debris() {
    for (k, more) in [
        "--load 20N --amplitude 1um",
        "--load 200N --amplitude 20um --wear 1e-4",
        "--load 5N --amplitude 2um --friction 0.3 --frequency 100Hz",
    ]
    .iter()
    .enumerate()
    {
        runs(
            &format!("ball-{k}"),
            &format!("--geometry sphere-on-flat --radius 10mm {STEEL} {more}"),
        );
    }
}

#[test]
fn cylinders_without_debris() {
    for (k, more) in [
        "--load 200N/mm --amplitude 20um --wear 1e-14m^2/N",
        "--load 20N/mm --amplitude 2um --friction 0.4",
    ]
    .iter()
    .enumerate()
    {
        runs(
            &format!("cylinder-{k}"),
            &format!("--geometry cylinder-on-flat --radius 10mm --length 10mm {STEEL} {more}"),
        );
    }
}

#[test]
fn wheels_without_debris() {
    for (k, more) in [
        "--load 75kN --creepage 0.5%",
        "--load 20kN --creepage 0.1% --wear 1e-4 --rail-radius 0.2m",
    ]
    .iter()
    .enumerate()
    {
        runs(
            &format!("wheel-{k}"),
            &format!(
                "--geometry wheel-on-rail --radius 0.46m --speed 100km/h --material wheel_steel_er7,rail_steel_r260 {more}"
            ),
        );
    }
}

#[test]
fn pins_and_pads_without_debris() {
    for (k, more) in [
        "--distance 1m",
        "--distance 100m --wear 1e-4 --friction 0.45",
        "--distance 1m --speed 2m/s",
    ]
    .iter()
    .enumerate()
    {
        let speed = if more.contains("--speed") {
            ""
        } else {
            "--speed 0.1m/s"
        };
        runs(
            &format!("pin-{k}"),
            &format!(
                "--geometry pin-on-disc --radius 3mm --track-radius 10mm --load 10N {STEEL} {speed} {more}"
            ),
        );
    }
    for (k, more) in [
        "--load 100N --amplitude 50um",
        "--load 1kN --amplitude 5um --wear 1e-4",
    ]
    .iter()
    .enumerate()
    {
        runs(
            &format!("pad-{k}"),
            &format!("--geometry flat-on-flat --area 25mm^2 {STEEL} {more}"),
        );
    }
}

#[test]
fn windows_of_debris() {
    for (k, more) in [
        "--pressure 1GPa --amplitude 1.5um --debris magnetite --debris-size 4um --cycles 1",
        "--pressure 50MPa --amplitude 1.5um --debris magnetite --debris-size 4um --cycles 1 --friction 0.4",
        "--pressure 300MPa --amplitude 5um --debris sand --debris-size 20um --cycles 1",
        "--pressure 2GPa --amplitude 1um --debris rail_steel_r260 --debris-size 1um --cycles 1 --layer 5um",
    ].iter().enumerate() {
        runs(&format!("window-{k}"), &format!("--geometry window {STEEL} {more}"));
    }
}

#[test]
fn debris_in_contacts() {
    for (k, line) in [
        "--geometry sphere-on-flat --radius 20mm --load 100N --amplitude 3um --debris magnetite --debris-size 2um --cycles 1",
        "--geometry cylinder-on-flat --radius 20mm --load 200N/mm --amplitude 1.5um --debris magnetite --debris-size 3um --cycles 1 --wear 1e-4",
        "--geometry flat-on-flat --area 25mm^2 --load 1kN --amplitude 2um --debris clay --debris-size 5um --cycles 1",
        "--geometry pin-on-disc --radius 50mm --load 10N --speed 0.1m/s --debris magnetite --debris-size 2um --layer 10um",
    ].iter().enumerate() {
        runs(&format!("debris-{k}"), &format!("{STEEL} {line}"));
    }
    runs(
        "debris-wheel",
        "--geometry wheel-on-rail --radius 0.46m --load 75kN --speed 30m/s --creepage 0.1% --material wheel_steel_er7,rail_steel_r260 --debris magnetite --debris-size 4um",
    );
}

#[test]
fn what_is_missing_is_said_and_nothing_is_replaced() {
    let folder = TempFolder::new("new-words");
    let refused = |words: &[&str]| {
        let output = program(&folder, words);
        assert_eq!(output.status.code(), Some(2));
        String::from_utf8_lossy(&output.stderr).into_owned()
    };
    let said = refused(&["new", "case"]);
    assert!(
        said.contains("--geometry") && said.contains("pin-on-disc"),
        "{said}"
    );
    let said = refused(&["new", "case", "--geometry", "window", "--pressure", "1GPa"]);
    assert!(said.contains("--material: give the materials"), "{said}");
    std::fs::write(folder.join("case.ron"), "mine").unwrap();
    let said = refused(&["new", "case", "--geometry", "window"]);
    assert!(said.contains("case.ron is there"), "{said}");
    assert_eq!(
        std::fs::read_to_string(folder.join("case.ron")).unwrap(),
        "mine"
    );
}
