//! Studies that are rejected before anything runs.

use super::{Folder, MU, mu};

#[test]
fn wrong_studies_are_refused_with_what_to_change() {
    let folder = Folder::new("refused");
    let range = format!(r#"Range(name: "friction", key: "{MU}", low: 0.1, high: 0.5)"#);
    let said = |factors: &str, more: &str| {
        folder.study(factors, more);
        let output = folder.call(&["run", "study.ron", "--out", "out"]);
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{said}");
        // No files are left.
        assert!(!folder.0.join("out").exists());
        said
    };
    let reported = |text: &str, parts: &[&str]| {
        for part in parts {
            assert!(text.contains(part), "no {part} in {text}");
        }
    };
    reported(
        &said(&mu("0.1"), "seds: 3"),
        &["study.ron:1:", "seds", "seeds"],
    );
    reported(&said(&mu("0.1, 0.1"), ""), &["0.1 is given twice"]);
    for (name, code) in [
        ("a\\nb", "U+000A"),
        ("a\\u{202e}b", "U+202E"),
        ("a\\tb", "U+0009"),
    ] {
        let named = mu("0.1").replace("\"friction\"", &format!("\"{name}\""));
        reported(
            &said(&named, ""),
            &["study.ron:1:", "a name has no control", code],
        );
    }
    reported(
        &said(&mu("0.1, 1e-1"), ""),
        &["study.ron:1:", "0.1 and 1e-1 are the same value"],
    );
    reported(
        &said(
            r#"Values(name: "step", key: "time.step", unit: "ms", values: [1e-4])"#,
            "",
        ),
        &["in `s`, not in `ms`"],
    );
    reported(
        &said(
            r#"Range(name: "step", key: "time.step", low: 1 um, high: 2 um, levels: 2)"#,
            "",
        ),
        &["in `s`, not in `m`"],
    );
    reported(
        &said(&mu("0.2, 0.1 m"), ""),
        &["m", "pure number", "with `friction` = 0.1 m of study.ron"],
    );
    reported(
        &said(&mu("0.1").replace("contact.mu", "contact.my"), ""),
        &["my", "mu"],
    );
    reported(
        &said(&mu("0.1, -1.0"), ""),
        &["-1", "with `friction` = -1.0 of study.ron"],
    );
    reported(
        &said(&range, ""),
        &["`friction` has no levels", "levels: 5"],
    );
    reported(
        &said(&range.replace("0.5", "0.05"), "design: Sobol(points: 4)"),
        &["study.ron:1:", "smaller first"],
    );
    reported(
        &said(&mu("0.1"), "set: [\"solver.tolerance=${1e-3 * frction}\"]"),
        &["`frction`", "there are friction"],
    );
    reported(
        &said(&format!("{}, {}", mu("0.1"), mu("0.2")), ""),
        &["two factors are named `friction`"],
    );
    reported(&said("", ""), &["varies one factor or more"]);
    reported(
        &said(r#"Values(key: "seed", values: [1, 2])"#, ""),
        &["give `seeds`"],
    );
    reported(
        &said(&mu("0.1").replace("friction", "status"), ""),
        &["a column `status` already"],
    );
    reported(
        &said(r#"Values(name: "x", values: [1.0, 2.0])"#, ""),
        &["`x` changes nothing"],
    );
    folder.put("points.csv", "fric\n0.2\n");
    reported(
        &said(&mu("0.1"), "design: Table(file: \"points.csv\")"),
        &["there is no column `friction`", "there are fric"],
    );
    // The scale of a range does not have these numbers.
    for (scale, value, why) in [
        ("Log", "0.0", "numbers are above zero"),
        ("Log", "-0.1", "numbers are above zero"),
        ("Integer", "1.5", "whole numbers"),
        ("Linear", "large", "a range of numbers"),
    ] {
        folder.put("points.csv", &format!("friction\n1\n{value}\n"));
        let range =
            format!(r#"Range(name: "friction", key: "{MU}", low: 1, high: 2, scale: {scale})"#);
        reported(
            &said(&range, "design: Table(file: \"points.csv\")"),
            &["point 2: `friction`", why],
        );
    }
    folder.put("study.ron", r#"(case: "heap.ron", factors: [], outputs: ["friction_coefficient"], design: Table(file: "points.csv"))"#);
    folder.put("points.csv", "time.end\n0.03\n");
    let output = folder.call(&["run", "study.ron", "--out", "out"]);
    reported(
        &String::from_utf8_lossy(&output.stderr),
        &["the case has no friction test"],
    );
    // A folder of something else is left alone.
    folder.study(&mu("0.1"), "");
    std::fs::create_dir_all(folder.0.join("mine")).unwrap();
    folder.put("mine/thesis.txt", "mine");
    let output = folder.call(&["run", "study.ron", "--out", "mine"]);
    reported(
        &String::from_utf8_lossy(&output.stderr),
        &["holds no study of fretwork study"],
    );
}
