//! Shipped cases run by name, in an empty folder of a system that has only the program.

use crate::temp::TempFolder;
use std::process::{Command, Output};

struct Machine(TempFolder);

impl Machine {
    fn new(name: &str) -> Self {
        Self(TempFolder::new(&format!("shipped-{name}")))
    }

    fn call(&self, line: &str) -> Output {
        Command::new(env!("CARGO_BIN_EXE_fretwork"))
            .args(line.split_whitespace())
            .current_dir(&self.0)
            .env("XDG_CACHE_HOME", self.0.join("cache"))
            .env("HOME", self.0.join("home"))
            .output()
            .unwrap()
    }

    fn done(&self, line: &str) -> String {
        let output = self.call(line);
        let error = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{line}: {error}");
        String::from_utf8_lossy(&output.stdout).into_owned()
    }

    fn refused(&self, line: &str) -> String {
        let output = self.call(line);
        assert_eq!(output.status.code(), Some(2), "{line}");
        String::from_utf8_lossy(&output.stderr).into_owned()
    }
}

#[test]
fn they_run_by_name() {
    let machine = Machine::new("run");
    machine.done("run newton_cradle --set time.end=1e-3");
    assert!(machine.0.join("results/newton_cradle/report.html").exists());
    // As pages write it, which follow the folder of the project.
    machine.done("run cases/newton_cradle.ron --set time.end=1e-3 --out again");
    let read = |folder: &str| std::fs::read(machine.0.join(folder).join("statistics.csv"));
    assert_eq!(
        read("again").unwrap(),
        read("results/newton_cradle").unwrap()
    );
    // A case with a file of its own, and a study of a case.
    machine.done("check fretting_scar --no-timing");
    machine.done("study check four_laws --no-timing");
    let study = machine.done("study check fretting_scar --seeds 2 --no-timing");
    assert!(study.contains("fretting_scar"), "{study}");
    machine.done("patch cylinder_on_flat --out patch");
}

#[test]
fn they_are_listed_and_copied() {
    let machine = Machine::new("copy");
    let all = machine.done("cases list");
    for name in [
        "wheel_rail_fretting",
        "four_laws",
        "bond_opening",
        "ball_on_flat",
    ] {
        assert!(all.contains(name), "{all}");
    }
    let some = machine.done("cases list cylinder flat");
    assert!(
        some.contains("cylinder_on_flat_fretting") && !some.contains("silo"),
        "{some}"
    );
    let copied = machine.done("cases copy fretting_scar");
    assert!(
        copied.contains("fretwork run ./cases/fretting_scar.ron"),
        "{copied}"
    );
    machine.done("check cases/fretting_scar.ron --no-timing");
    assert!(machine.0.join("cases/fretting_scar_flat.csv").exists());
    let files = machine.0.join("cache/fretwork");
    assert!(
        !files.exists(),
        "a copy that is there is taken before the shipped one"
    );
}

/// An input of another kind is named, with the command that takes it, by its file and by its name.
#[test]
fn inputs_of_another_kind_are_named() {
    let machine = Machine::new("kinds");
    for name in ["ball_on_flat", "newton_cradle", "four_laws", "bond_opening"] {
        machine.done(&format!("cases copy {name}"));
    }
    let kinds = [
        ("patch", "patches/ball_on_flat.ron", "ball_on_flat"),
        ("run", "cases/newton_cradle.ron", "newton_cradle"),
        ("study run", "studies/four_laws.ron", "four_laws"),
        ("fit", "fits/bond_opening.ron", "bond_opening"),
    ];
    for (command, _, _) in kinds {
        for (other, file, name) in kinds.iter().filter(|k| k.0 != command) {
            for given in [file, name] {
                let said = machine.refused(&format!("{command} {given}"));
                let right = format!("fretwork {other} {given}");
                assert!(said.contains(&right), "{command} {given}: {said}");
            }
        }
    }
    let said = machine.refused("check patches/ball_on_flat.ron");
    assert!(
        said.contains("is a patch, and a case is expected here"),
        "{said}"
    );
}

#[test]
fn other_names_are_corrected() {
    let machine = Machine::new("names");
    let said = machine.refused("run wheel_rail_freting");
    assert!(
        said.contains("did you mean `wheel_rail_fretting`?"),
        "{said}"
    );
    let said = machine.refused("cases copy newtons_cradle");
    assert!(said.contains("did you mean `newton_cradle`?"), "{said}");
    let said = machine.refused("cases list zeppelin");
    assert!(said.contains("zeppelin"), "{said}");
    // A file that is missing is one, whatever it is named.
    let said = machine.refused("run missing.ron");
    assert!(said.contains("missing.ron"), "{said}");
}
