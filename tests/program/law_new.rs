//! `fretwork law new`, followed literally: the printed commands build a law, certify it and run a
//! case with it.

use crate::pages::{read, root};
use crate::temp::TempFolder;
use std::path::Path;
use std::process::{Command, Output};

struct Place(TempFolder);

impl Place {
    fn new(name: &str) -> Self {
        Self(TempFolder::new(&format!("new-{name}")))
    }

    fn shell(&self, line: &str) -> Output {
        let words: Vec<&str> = line.split_whitespace().collect();
        let program = match words[0] {
            "fretwork" => env!("CARGO_BIN_EXE_fretwork"),
            other => other,
        };
        Command::new(program)
            .args(&words[1..])
            .current_dir(&self.0)
            // One build folder is used, so that the crates of the interface are compiled once.
            .env("CARGO_TARGET_DIR", self.0.join("target"))
            .output()
            .unwrap_or_else(|e| panic!("{line}: {e}"))
    }

    fn done(&self, line: &str) -> String {
        let output = self.shell(line);
        let said = String::from_utf8_lossy(&output.stdout).into_owned();
        let error = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.success(), "{line}\n{said}\n{error}");
        said
    }
}

fn line<'a>(said: &'a str, word: &str) -> &'a str {
    let found = said.lines().find_map(|l| l.trim().strip_prefix(word));
    found
        .unwrap_or_else(|| panic!("no line `{word}` in\n{said}"))
        .trim()
}

fn follow(language: &str) {
    let place = Place::new(language);
    for kind in ["contact", "cohesion", "damage", "wear", "transport"] {
        let said = place.done(&format!(
            "fretwork law new my-{kind} --kind {kind} --lang {language}"
        ));
        place.done(line(&said, "build"));
        // The test's build folder is not the law's own.
        let certify = line(&said, "certify").replace(&format!("my-{kind}/target/"), "target/");
        let table = place.done(&certify);
        assert!(table.contains("  certified"), "{table}");
        let case = Path::new(env!("CARGO_MANIFEST_DIR")).join("cases/verification/bond_mode_1.ron");
        let run = line(&said, "run")
            .replace(&format!("my-{kind}/target/"), "target/")
            .replace("CASE", case.to_str().unwrap())
            .replace("INTERFACE", "grain");
        let fitting = match kind {
            // The parameters of the case are those of the laws that it had before.
            "cohesion" => " --set interfaces.grain.parameters.cohesion={}",
            "damage" => " --set interfaces.grain.parameters.damage={}",
            _ => "",
        };
        let run = format!("{run}{fitting} --set time.end=1e-6 --out out-{kind} --verbose");
        let summary = place.done(&run);
        assert!(summary.contains(&format!("my-{kind}")), "{summary}");
    }
}

#[test]
fn in_c() {
    follow("c");
}

#[test]
fn in_rust() {
    follow("rust");
}

#[test]
fn in_fortran() {
    if Command::new("gfortran").arg("--version").output().is_err() {
        println!("skipped: there is no gfortran; install the system's package");
        return;
    }
    follow("fortran");
}

#[test]
fn the_page_begins_with_the_function_of_the_template() {
    let page = read(&root().join("docs/write_your_own_law.md"));
    let (_, rest) = page.split_once("```c\n").unwrap();
    let (function, _) = rest.split_once("```").unwrap();
    let template = read(&root().join("crates/core/src/laws/kind/templates/damage.c"));
    assert!(template.contains(function), "{function}");
}

/// Runs a case with the damage law `my-damage` in `folder`; returns exit code and error.
fn run_with(place: &Place, folder: &str) -> (Option<i32>, String) {
    let case = Path::new(env!("CARGO_MANIFEST_DIR")).join("cases/verification/bond_mode_1.ron");
    let output = place.shell(&format!(
        "fretwork run {} --plugin-path {folder} --set interfaces.grain.damage=my-damage --set interfaces.grain.parameters.damage={{}} --set time.end=2e-6 --out out --force",
        case.display()
    ));
    let error = String::from_utf8_lossy(&output.stderr).into_owned();
    (output.status.code(), error)
}

/// An error in a law ends the run with a message and exit code 1; a library that cannot be loaded
/// is rejected with code 2.
#[test]
fn laws_that_fail_in_a_run_are_named() {
    let place = Place::new("failing");
    let said = place.done("fretwork law new my-damage --kind damage --lang c");
    let build = line(&said, "build").to_owned();
    let file = place.0.join("my-damage/my_damage.c");
    let good = std::fs::read_to_string(&file).unwrap();
    let kept = "b->out_damage[k] = d;";
    for (wrong, part) in [
        ("b->out_damage[k] = NAN;", "gave a value that is not finite"),
        (
            "return fail(message, k, \"the table of the author ends here\");",
            "the table of the author ends here",
        ),
        ("return 77;", "unknown status 77"),
    ] {
        assert!(good.contains(kept));
        std::fs::write(&file, good.replace(kept, wrong)).unwrap();
        place.done(&build);
        let (code, error) = run_with(&place, "my-damage");
        assert_eq!(code, Some(1), "{wrong}: {error}");
        assert!(
            error.contains(part) && error.contains("my-damage"),
            "{wrong}: {error}"
        );
    }
    let library = place
        .0
        .join("my-damage")
        .join(if cfg!(target_os = "macos") {
            "libfretwork_damage_my_damage.dylib"
        } else {
            "libfretwork_damage_my_damage.so"
        });
    std::fs::remove_file(&library).unwrap();
    std::fs::write(&library, "not a library").unwrap();
    let (code, error) = run_with(&place, "my-damage");
    assert_eq!(code, Some(2), "{error}");
    assert!(error.contains("not a loadable library"), "{error}");
}

#[test]
fn a_law_that_panics_ends_the_run_with_a_sentence() {
    let place = Place::new("panics");
    let said = place.done("fretwork law new my-damage --kind damage --lang rust");
    let file = place.0.join("my-damage/src/lib.rs");
    let text = std::fs::read_to_string(&file).unwrap();
    let wrong = text.replace(
        "intact.soften(",
        "assert!(site.time < 1e-6, \"the clock struck\");\n        intact.soften(",
    );
    assert_ne!(text, wrong);
    std::fs::write(&file, wrong).unwrap();
    place.done(line(&said, "build"));
    let (code, error) = run_with(&place, "target/release");
    assert_eq!(code, Some(1), "{error}");
    assert!(error.contains("panicked: the clock struck"), "{error}");
}

#[test]
fn bad_names_and_kinds_are_refused() {
    let place = Place::new("bad");
    std::fs::create_dir_all(place.0.join("taken")).unwrap();
    for (line, part) in [
        (
            "fretwork law new ../x --kind damage --lang c",
            "is not a valid name for a law",
        ),
        (
            "fretwork law new My --kind damage --lang c",
            "is not a valid name for a law",
        ),
        (
            "fretwork law new x --kind damages --lang c",
            "expected contact, cohesion, damage, wear or transport",
        ),
        (
            "fretwork law new taken --kind wear --lang c",
            "exists already",
        ),
    ] {
        let output = place.shell(line);
        let error = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{line}: {error}");
        assert!(error.contains(part), "{line}: {error}");
    }
}
