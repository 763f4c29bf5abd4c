//! Cases in JSON and YAML and with names: run, checked, converted, compared with the schema; and
//! what shells know about the program.

use super::temp::TempFolder;
use serde_json::Value;
use std::path::Path;
use std::process::Command;

const YAML: &str = include_str!("../support/ball.yaml");

/// What a call prints, which ends with a code.
fn said(folder: &Path, words: &[&str], code: i32) -> String {
    let mut command = Command::new(env!("CARGO_BIN_EXE_fretwork"));
    let output = command.current_dir(folder).args(words).output().unwrap();
    let errors = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(code), "{words:?}: {errors}");
    format!("{}{errors}", String::from_utf8_lossy(&output.stdout))
}

fn summary(folder: &Path, run: &str) -> Value {
    let text = std::fs::read_to_string(folder.join(run).join("summary.json")).unwrap();
    serde_json::from_str(&text).unwrap()
}

#[test]
fn a_case_runs_in_each_format_with_the_same_bits() {
    let folder = TempFolder::new("case-formats");
    let path: &Path = &folder;
    std::fs::write(folder.join("ball.yaml"), YAML).unwrap();
    let case = said(path, &["case", "convert", "ball.yaml", "--to", "json"], 0);
    std::fs::write(folder.join("ball.json"), &case).unwrap();
    let case = said(path, &["case", "convert", "ball.json", "--to", "ron"], 0);
    assert!(
        case.contains("\"g\": 9.81 m/s^2") && case.contains("\"${2 * R}\""),
        "{case}"
    );
    std::fs::write(folder.join("ball.ron"), &case).unwrap();
    let mut energies = Vec::new();
    for name in ["ball.yaml", "ball.json", "ball.ron"] {
        let out = format!("out-{name}");
        said(path, &["run", name, "--out", &out, "--no-report"], 0);
        let summary = summary(path, &out);
        energies.push(summary["energy"]["kinetic"].as_f64().unwrap());
        assert_eq!(summary["steps"], 100, "{name}");
    }
    // m (g T)^2 / 2 of a disc of steel, to the order of the step.
    let mass = 7850.0 * std::f64::consts::PI * 1e-4;
    let fall = 0.5 * mass * (9.81f64 * 0.02).powi(2);
    assert!(
        (energies[0] / fall - 1.0).abs() < 0.01,
        "{energies:?}: {fall}"
    );
    assert_eq!(energies[0], energies[1]);
    assert_eq!(energies[0], energies[2]);
    // The results keep the case with its names, and a report reads it.
    said(path, &["report", "out-ball.yaml"], 0);
    let page = std::fs::read_to_string(path.join("out-ball.yaml/report.html")).unwrap();
    assert!(page.contains("9.81 m/s^2"));
    let slower = [
        "run",
        "ball.yaml",
        "--set",
        "let.T=10ms",
        "--out",
        "half",
        "--no-report",
    ];
    said(path, &slower, 0);
    let half = summary(path, "half")["energy"]["kinetic"].as_f64().unwrap();
    assert!((half * 4.0 / energies[0] - 1.0).abs() < 0.01, "{half}");
    let wrong = YAML.replace("T / 100", "R / 100");
    std::fs::write(folder.join("wrong.yaml"), &wrong).unwrap();
    let error = said(path, &["check", "wrong.yaml"], 2);
    assert!(error.starts_with("wrong.yaml:4:"), "{error}");
    assert!(
        error.contains("is a time, in `s`, and `R / 100` is in `m`"),
        "{error}"
    );
}

fn cases(folder: &Path, out: &mut Vec<std::path::PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap().flatten() {
        let path = entry.path();
        if path.is_dir() {
            cases(&path, out);
        } else if path.extension().is_some_and(|e| e == "ron") {
            out.push(path);
        }
    }
}

#[test]
fn the_schema_holds_the_shipped_cases_and_refuses_others() {
    use fretwork::scene::Case;
    use fretwork::scene::source::{Format, Source};
    let folder = TempFolder::new("case-schema");
    let schema = said(&folder, &["case", "schema"], 0);
    let schema: Value = serde_json::from_str(&schema).unwrap();
    let validator = jsonschema::validator_for(&schema).unwrap();
    let errors = |case: &Value| -> Vec<String> {
        let found = validator.iter_errors(case);
        found
            .map(|e| format!("{}: {e}", e.instance_path()))
            .collect()
    };
    let mut files = Vec::new();
    cases(
        &Path::new(env!("CARGO_MANIFEST_DIR")).join("cases"),
        &mut files,
    );
    let mut count = 0;
    for file in files {
        let source = Source::read(&file).unwrap();
        if Case::read(&source).is_err() {
            continue;
        }
        let json = source.in_format(Format::Json).unwrap();
        let found = errors(&serde_json::from_str(&json).unwrap());
        assert!(found.is_empty(), "{}: {found:#?}", file.display());
        count += 1;
    }
    assert!(count > 50, "{count}");
    let mut ball: Value = {
        let source = Source::text_as::<Case>("ball.yaml", YAML).unwrap();
        serde_json::from_str(&source.in_format(Format::Json).unwrap()).unwrap()
    };
    assert_eq!(errors(&ball), Vec::<String>::new());
    for (at, wrong) in [
        ("/time/step", Value::from("soon")),
        ("/time/end", Value::from(true)),
        ("/grains/0", serde_json::json!({"Lst": {}})),
        (
            "/interfaces",
            serde_json::json!([{"name": "a", "between": ["steel", "steel"]}]),
        ),
        ("/output/frams", Value::from(3)),
    ] {
        let (above, name) = at.rsplit_once('/').unwrap();
        let mut changed = ball.clone();
        let place = changed.pointer_mut(above).unwrap();
        match place.as_array_mut() {
            Some(list) => list[name.parse::<usize>().unwrap()] = wrong,
            None => place[name] = wrong,
        }
        assert!(!errors(&changed).is_empty(), "{at}");
    }
    ball["interfaces"] = serde_json::json!([{
        "name": "a", "between": ["steel", "steel"], "contact": "coulomb",
        "parameters": {"contact": {"mu": "30 %"}},
    }]);
    assert_eq!(errors(&ball), Vec::<String>::new());
    // Laws and their parameters are those of their descriptors.
    let interface = &schema["$defs"]["InterfaceSpec"]["properties"];
    let laws = interface["contact"]["anyOf"].as_array().unwrap();
    assert!(laws.iter().any(|law| law["const"] == "coulomb"));
    let mu = &interface["parameters"]["properties"]["contact"]["properties"]["mu"];
    let doc = mu["description"].as_str().unwrap();
    assert!(
        doc.contains("coulomb: ") && doc.contains("default "),
        "{doc}"
    );
    assert_eq!(schema["properties"]["inertia_scaling"]["default"], 1.0);
}

#[test]
fn shells_know_commands_and_options() {
    let folder = TempFolder::new("shells");
    for (shell, word) in [
        ("bash", "complete -F _fretwork"),
        ("zsh", "#compdef fretwork"),
        ("fish", "complete -c fretwork"),
        ("powershell", "Register-ArgumentCompleter"),
    ] {
        let script = said(&folder, &["completions", shell], 0);
        for word in [word, "contact-patch", "no-report"] {
            assert!(script.contains(word), "{shell}: {word}");
        }
        assert!(!script.contains("try-libraries"), "{shell}");
    }
    said(&folder, &["completions", "tcsh"], 2);
    said(&folder, &["man", "pages/man1"], 0);
    let page = |name: &str| {
        let path = folder.join("pages/man1").join(name);
        std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
    };
    assert!(page("fretwork-run.1").contains("KEY.PATH=VALUE"));
    assert!(page("fretwork.1").contains("fretwork\\-run(1)"));
}

#[test]
fn the_example_of_the_page_is_a_case() {
    let page = include_str!("../../docs/case_format/values.md");
    let example = page.split("```yaml\n").nth(1).unwrap();
    let folder = TempFolder::new("page-yaml");
    std::fs::write(
        folder.join("lid.yaml"),
        example.split("```").next().unwrap(),
    )
    .unwrap();
    said(&folder, &["check", "lid.yaml"], 0);
}
