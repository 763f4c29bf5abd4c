//! `fretwork check` lists the methods that support a case, and rejects an unsupported method before
//! a run.

use std::process::{Command, Output};

fn fretwork(args: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_fretwork"))
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .args(args)
        .output()
        .unwrap()
}

/// Output of `check` for a verification case.
fn check(case: &str, sets: &[&str]) -> (bool, String) {
    let path = format!("cases/verification/{case}.ron");
    let mut args = vec!["check", "--verbose", &path];
    for set in sets {
        args.extend(["--set", set]);
    }
    let output = fretwork(&args);
    let text = [output.stdout, output.stderr].concat();
    (
        output.status.success(),
        String::from_utf8_lossy(&text).into_owned(),
    )
}

/// Returns a line by its label.
fn line<'a>(text: &'a str, label: &str) -> &'a str {
    let found = text.lines().find_map(|l| {
        let (name, rest) = l.trim_start().split_once(' ')?;
        (name == label).then(|| rest.trim())
    });
    found.unwrap_or_else(|| panic!("no line `{label}` in {text}"))
}

const ALL: &str = "auto, nlgs, nlgs-symmetric, anderson, pg, cpg, pcpg, apgd, newton, interior";
const GRADIENTS: &str = "auto, nlgs, nlgs-symmetric, anderson, pg, cpg, pcpg, apgd";

/// A contact law with shear cohesion.
const COHESIVE: [&str; 2] = [
    "interfaces.0.contact=mohr-coulomb",
    "interfaces.0.parameters.contact={}",
];

#[test]
fn the_methods_of_a_case_are_listed() {
    // Coulomb friction is supported by all methods.
    let (fine, text) = check("column", &[]);
    assert!(fine);
    assert_eq!(line(&text, "methods"), ALL);
    assert_eq!(line(&text, "method"), "auto supports this case");
    // Bonds are supported by all methods, unless the law has shear cohesion too.
    let (fine, text) = check("beam_2d", &["solver.method=Newton"]);
    assert!(fine);
    assert_eq!(
        line(&text, "methods"),
        format!("{GRADIENTS}, newton, interior?")
    );
    assert_eq!(line(&text, "method"), "newton supports this case");
    // Friction against rotation is supported by neither of the two.
    let (fine, text) = check("rolling_stop_sphere", &[]);
    assert!(fine);
    assert_eq!(line(&text, "methods"), GRADIENTS);
    assert!(
        text.contains("not newton, interface `") && text.contains("rotation"),
        "{text}"
    );
    // Shear cohesion at touching surfaces is not supported by the interior point method; for
    // rotation only the samples are known.
    let (_, text) = check("column", &COHESIVE);
    assert_eq!(line(&text, "methods"), format!("{GRADIENTS}, newton?"));
    assert!(
        text.contains("not interior, interface `") && text.contains("cohesion"),
        "{text}"
    );
}

#[test]
fn a_law_that_decides_at_run_time_is_told_apart() {
    let law = "interfaces.0.contact=velocity-weakening";
    let none = "interfaces.0.parameters.contact={}";
    let (fine, text) = check("column", &[law, none, "solver.method=Newton"]);
    assert!(fine, "{text}");
    assert_eq!(
        line(&text, "methods"),
        format!("{GRADIENTS}, newton?, interior?")
    );
    let chosen = line(&text, "method");
    assert!(
        chosen.starts_with("newton may be refused") && chosen.contains("sampled contacts"),
        "{chosen}"
    );
}

#[test]
fn a_method_that_cannot_is_refused_before_the_run() {
    for (case, method, word) in [
        ("rolling_stop_disk", "Newton", "rotation"),
        ("rolling_stop_sphere", "Interior", "rotation"),
        ("column", "Interior", "cohesion"),
    ] {
        let set = format!("solver.method={method}");
        let mut sets = vec![set.as_str()];
        if word == "cohesion" {
            sets.extend(COHESIVE);
        }
        let (fine, text) = check(case, &sets);
        assert!(
            !fine && text.contains(word) && text.contains("interface `"),
            "{case} {text}"
        );
        let path = format!("cases/verification/{case}.ron");
        let out = std::env::temp_dir().join(format!("fretwork-refused-{}", std::process::id()));
        let mut args = vec!["run", &path, "--out", out.to_str().unwrap()];
        for set in &sets {
            args.extend(["--set", set]);
        }
        let output = fretwork(&args);
        assert_eq!(output.status.code(), Some(2));
        assert!(!out.exists(), "nothing is written");
    }
}
