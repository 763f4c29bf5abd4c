//! What the terminal says at the end of a run and for `check`: at most 15 lines of 100 columns; the
//! grade of a run, differences of runs with their significance, and studies of a case itself.

use crate::temp::TempFolder;
use fretwork::scene::input_ranges::{GivenRange, given_ranges};
use fretwork::scene::load;
use fretwork::shipped::search_path;
use serde_json::Value;
use std::path::Path;
use std::process::Command;

/// Output of a call that succeeds.
fn answer(folder: &Path, words: &[&str]) -> String {
    let mut command = Command::new(env!("CARGO_BIN_EXE_fretwork"));
    let output = command.args(words).current_dir(folder).output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{words:?}: {said}");
    String::from_utf8(output.stdout).unwrap()
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Path of a shipped case.
fn case(name: &str) -> String {
    root()
        .join(format!("cases/{name}.ron"))
        .display()
        .to_string()
}

/// Whether a text has at most 15 lines of 100 columns; its lines with paths of this machine may be
/// longer.
fn brief(text: &str) -> bool {
    let short = |line: &str| line.chars().count() <= 100 || line.contains("results in ");
    text.lines().count() <= 15 && text.lines().all(short)
}

#[test]
fn a_run_ends_with_its_grade_and_at_most_15_lines() {
    let folder = TempFolder::new("end-of-run");
    let sets = ["--set", "time.end=0.03", "--set", "output.frames=0"];
    let fretting = case("fretting_scar");
    let words = [&["run", &fretting, "--out", "one"][..], &sets].concat();
    let text = answer(&folder, &words);
    // The first line has the path and the title.
    let end = text.split_once('\n').unwrap().1;
    assert!(brief(end), "{end}");
    let last = end.lines().last().unwrap();
    assert!(
        last.starts_with("  results in one, report in report.html"),
        "{end}"
    );
    let summary = std::fs::read_to_string(folder.join("one/summary.json")).unwrap();
    let summary: Value = serde_json::from_str(&summary).unwrap();
    let grade = summary["grade"].as_str().unwrap();
    let begins = match summary["trustworthy"].as_bool().unwrap() {
        false => "NOT TRUSTWORTHY\n",
        true if grade == "error known" => "ERROR KNOWN: ",
        true => "CONSISTENT: ",
    };
    assert!(end.starts_with(begins), "{grade}: {end}");
    assert_eq!(
        grade == "not trustworthy",
        summary["trustworthy"] == false,
        "{grade}"
    );
    assert_eq!(summary["sample"]["random"], false);
    // All details on request.
    let words = [&words[..], &["--verbose"]].concat();
    let all = answer(&folder, &words);
    assert!(all.lines().count() > text.lines().count(), "{all}");
    let words = [&["run", &fretting, "--out", "two"][..], &sets].concat();
    answer(&folder, &words);
    let both = answer(&folder, &["compare", "one", "two"]);
    assert!(both.contains("less one: equal"), "{both}");
    assert!(both.contains("all inputs are the same"), "{both}");
}

#[test]
fn check_says_in_at_most_15_lines_what_to_look_at() {
    for name in [
        "wheel_rail_fretting",
        "cylinder_on_flat_fretting",
        "sphere_on_flat_fretting",
        "silo",
        "surface_temperatures",
        "fretting_scar",
    ] {
        let path = format!("cases/{name}.ron");
        let text = answer(root(), &["check", &path, "--no-timing"]);
        assert!(brief(&text), "{text}");
        assert!(text.contains("\n  look at "), "{text}");
    }
    let text = answer(
        root(),
        &["check", "cases/wheel_rail_fretting.ron", "--no-timing"],
    );
    for words in [
        "look at        1 OTHER MOTION: `K` of the wear law `archard`",
        "2 bonds of third_body:",
        "NOT RESOLVED",
    ] {
        assert!(text.contains(words), "{words} in {text}");
    }
}

#[test]
fn a_study_of_a_case_varies_its_seeds_or_the_ranges_of_its_inputs() {
    let folder = TempFolder::new("study-of-case");
    let fretting = case("wheel_rail_fretting");
    let check = |words: &[&str]| -> Value {
        let words = [
            &["study", "check", &fretting, "--no-timing", "--json"][..],
            words,
        ]
        .concat();
        serde_json::from_str(&answer(&folder, &words)).unwrap()
    };
    let ranges = check(&["--ranges"]);
    let factors = ranges["factors"].as_array().unwrap();
    let mu = factors
        .iter()
        .find(|f| f["name"] == "oxide_third_body hertz-mindlin mu");
    let keys = mu.unwrap_or_else(|| panic!("{factors:?}"))["keys"]
        .as_array()
        .unwrap();
    assert_eq!(keys.len(), 3, "{keys:?}");
    assert_eq!(keys[0], "interfaces.third_body.parameters.contact.mu");
    assert_eq!(ranges["settings"], 10 * factors.len());
    // The wear rate is compared unasked.
    let seeds = check(&["--seeds", "8"]);
    for outputs in [&ranges["outputs"], &seeds["outputs"]] {
        let names = outputs.to_string();
        for name in ["friction_coefficient", "wear.specific_rate"] {
            assert!(names.contains(name), "{names}");
        }
    }
    assert_eq!(
        (&seeds["settings"], &seeds["runs"]["all"]),
        (&1.into(), &8.into())
    );
    // A case whose inputs have no ranges is refused.
    let output = Command::new(env!("CARGO_BIN_EXE_fretwork"))
        .args(["study", "check", &case("newton_cradle"), "--ranges"])
        .current_dir(&*folder)
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(said.contains("range: (low, high)"), "{said}");
}

#[test]
fn what_a_file_gives_with_a_range_is_known_unless_the_case_replaces_it() {
    let of = |sets: &[&str]| {
        let sets: Vec<String> = sets.iter().map(|s| (*s).to_owned()).collect();
        let path = root().join("cases/wheel_rail_fretting.ron");
        let loaded = load(&path, &sets).unwrap_or_else(|e| panic!("{e}"));
        let built = loaded
            .build(&search_path())
            .unwrap_or_else(|e| panic!("{e}"));
        given_ranges(
            &loaded.case,
            &built.materials,
            built.simulation.view().laws(),
        )
    };
    let given = of(&[]);
    let find = |given: &[GivenRange], law: &str, parameter: &str| {
        let found = given
            .iter()
            .find(|g| g.law == law && g.parameter == parameter);
        found.cloned().unwrap_or_else(|| panic!("{given:?}"))
    };
    let mu = find(&given, "hertz-mindlin", "mu");
    assert_eq!((mu.value, mu.range, mu.keys.len()), (0.4, [0.1, 0.73], 3));
    assert_eq!(mu.file, "oxide_third_body");
    let w = find(&given, "mac", "w");
    assert_eq!(
        (w.range, w.unit.as_str(), w.keys.len()),
        ([0.1, 60.0], "J/m^2", 1)
    );
    assert_eq!(find(&given, "archard", "K").keys.len(), 2);
    let own = of(&["interfaces.third_body.parameters.contact.mu=0.5"]);
    assert_eq!(find(&own, "hertz-mindlin", "mu").keys.len(), 2);
}

/// Seeds of a small random scene in one command, with the half-widths over them.
#[test]
fn seeds_of_a_case_have_half_widths_over_them() {
    let folder = TempFolder::new("seeds-of-case");
    let text = std::fs::read_to_string(case("collapse")).unwrap();
    // The small scene ends before much has fallen.
    let end = text.find("end: ").unwrap();
    let comma = end + text[end..].find([',', ')']).unwrap();
    let text = format!("{}end: 2e-3{}", &text[..end], &text[comma..]);
    std::fs::write(folder.join("collapse.ron"), text).unwrap();
    let words = ["study", "run", "collapse.ron", "--seeds", "3"];
    let output = ["--output", "energy.friction"];
    let said = answer(&folder, &[&words[..], &output].concat());
    assert!(said.contains("energy.friction: "), "{said}");
    assert!(said.contains("over 3 seeds (95 %)"), "{said}");
}
