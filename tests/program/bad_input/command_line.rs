//! The command line.

use super::trial::{PLANE, Trial, refusal, with};

#[test]
fn a_set_without_a_value() {
    for (set, words) in [
        (
            "time.step",
            [
                "no `=` between a key and a value",
                "expected key.path=value",
            ],
        ),
        ("=1", ["no key before the `=`", "expected key.path=value"]),
        (
            "time.step=",
            ["no value after the `=`", "expected key.path=value"],
        ),
    ] {
        let trial = Trial::new();
        let case = trial.write("case.ron", PLANE);
        let place = format!("--set {set}: error: ");
        assert!(
            trial
                .refuses(&case, &["--set", set], &words)
                .starts_with(&place)
        );
    }
}

#[test]
fn a_set_of_an_unknown_path() {
    let trial = Trial::new();
    let case = trial.write("case.ron", PLANE);
    let words = [
        "there is no `tyme`",
        "expected one of",
        "did you mean `time.step`?",
    ];
    let said = trial.refuses(&case, &["--set", "tyme.step=1e-4"], &words);
    assert!(said.starts_with("--set tyme.step=1e-4: error: "), "{said}");
    let words = ["from `--set time.stepp=1e-4`", "did you mean `step`?"];
    let said = trial.refuses(&case, &["--set", "time.stepp=1e-4"], &words);
    assert!(
        said.starts_with(&format!("{}:4:", case.display())),
        "{said}"
    );
}

#[test]
fn a_set_of_a_bad_value() {
    for (set, words) in [
        ("time.step=fast", "expected"),
        ("time.step=-1", "must be positive, got -1"),
        ("time.step=(1", "is not a value"),
        (
            "interfaces.grains.parameters.contact.mu=NaN",
            "expected a value between",
        ),
        (
            "interfaces.grains.contact=columb",
            "did you mean `coulomb`?",
        ),
    ] {
        let trial = Trial::new();
        let case = trial.write("case.ron", PLANE);
        let given = format!("--set {set}");
        trial.refuses(&case, &["--set", set], &[words, &given]);
    }
}

#[test]
fn a_missing_plugin_folder() {
    let trial = Trial::new();
    let case = trial.write("case.ron", PLANE);
    trial.refuses(
        &case,
        &["--plugin-path", "nowhere"],
        &["--plugin-path nowhere", "no such folder"],
    );
}

#[test]
fn an_unknown_word_on_the_command_line() {
    let trial = Trial::new();
    trial.write("case.ron", PLANE);
    refusal(&trial.call(&["rum", "case.ron"]), &["rum", "run"]);
    refusal(
        &trial.call(&["run", "case.ron", "--thread", "2"]),
        &["--thread", "--threads"],
    );
    refusal(
        &trial.call(&["run", "case.ron", "--threads", "0"]),
        &["--threads", "1..=1024"],
    );
    refusal(&trial.call(&["run"]), &["<CASE>"]);
    refusal(
        &trial.call(&["law", "show", "mohr"]),
        &["no law named `mohr`"],
    );
    refusal(
        &trial.call(&["law", "show", "columb"]),
        &["did you mean `coulomb`?"],
    );
    refusal(
        &trial.call(&["law", "show", "friction/mac"]),
        &["contact, cohesion, damage, wear or transport"],
    );
}

#[test]
fn check_refuses_what_run_refuses() {
    let trial = Trial::new();
    let (_, place) = trial.write_marked("case.ron", &with(PLANE, "theta: 0.5", "theta: ‸2"));
    let output = trial.call(&["check", "case.ron"]);
    let place = place.unwrap();
    let place = place.rsplit('/').next().unwrap();
    refusal(&output, &[place, "expected a number between 0.5 and 1"]);
}

/// A study compares results of the case, not the course of the run, and no friction without a
/// friction test.
#[test]
fn a_study_of_what_the_case_does_not_have() {
    let trial = Trial::new();
    trial.write("case.ron", PLANE);
    for (output, words) in [
        ("step_size.first_late", "the course of the run"),
        ("haste.late", "`haste.late` is called `step_size.late` now"),
        ("uncertainty.wear.step", "the course of the run"),
        (
            "uncertainty.friction_coefficient.scatter",
            "the course of the run",
        ),
        ("energy.scale", "the course of the run"),
        ("peak_friction", "no friction test"),
    ] {
        let said = refusal(
            &trial.call(&[
                "trade",
                "case.ron",
                "--set",
                "friction=None",
                "--output",
                output,
            ]),
            &[output, words],
        );
        let listed = said.split("nothing to compare").nth(1).unwrap_or_default();
        assert!(
            !listed.contains("step_size.")
                && !listed.contains("uncertainty.")
                && !listed.contains("peak_friction"),
            "{said}"
        );
    }
}

#[test]
fn a_body_that_is_asked_for_where_there_is_none() {
    let trial = Trial::new();
    let (bodies, rest) = PLANE.split_once("bodies: [").unwrap();
    let (_, grains) = rest.split_once("grains: [").unwrap();
    trial.write("case.ron", format!("{bodies}grains: [{grains}"));
    let test = r#"friction=(body: "x", along: 0, normal: 1)"#;
    refusal(
        &trial.call(&["check", "case.ron", "--set", test]),
        &[
            "there is no body `x`",
            "a case with bodies: this one has none",
        ],
    );
}
