//! Errors in the text: names of fields, types, brackets, files.

use super::trial::{PLANE, Trial, refused, with};

#[test]
fn an_unknown_field() {
    refused(
        &with(PLANE, "step: 1e-3", "‸stepp: 1e-3"),
        &["stepp", "expected", "did you mean `step`?"],
    );
}

#[test]
fn a_wrong_type() {
    refused(
        &with(PLANE, "step: 1e-3", r#"step: ‸"fast""#),
        &["expected", "number"],
    );
    refused(
        &with(PLANE, "dimension: 2", "dimension: ‸-2"),
        &["expected"],
    );
}

#[test]
fn an_unknown_kind_of_shape() {
    refused(
        &with(
            PLANE,
            "HalfSpace(normal: [0.0, 1.0])",
            "‸HalfSpac(normal: [0.0, 1.0])",
        ),
        &["HalfSpac", "did you mean `HalfSpace`?"],
    );
}

#[test]
fn a_missing_field() {
    refused(
        &with(PLANE, "step: 1e-3, ", "").replace("time: (", "time: ‸("),
        &["step"],
    );
}

#[test]
fn a_bracket_that_is_not_closed() {
    refused(
        &with(PLANE, "gravity: [0.0, -9.81]", "gravity: ‸[0.0, -9.81"),
        &["this `[` is not closed by `]`"],
    );
    refused(
        &format!(
            "‸{}",
            with(PLANE, "figures: false),\n)", "figures: false),\n")
        ),
        &["never closed"],
    );
    refused(
        &with(PLANE, "theta: 0.5)", "theta: 0.5‸]"),
        &["`]` does not close the `(` before it"],
    );
}

#[test]
fn a_text_nested_200_levels_deep() {
    let nested = format!("{}0{}", "[".repeat(200), "]".repeat(200));
    let trial = Trial::new();
    let (case, _) = trial.write_marked("case.ron", &with(PLANE, "[0.0, -9.81]", &nested));
    let said = trial.refuses(&case, &[], &["nested more than"]);
    // `gravity` is on line 5; the position is that of one of its brackets.
    assert!(
        said.starts_with(&format!("{}:5:", case.display())),
        "{said}"
    );
}

#[test]
fn a_file_that_cannot_be_read() {
    let trial = Trial::new();
    trial.write("case.ron", PLANE);
    let missing = trial.path("casse.ron");
    trial.refuses(
        &missing,
        &[],
        &[
            "casse.ron",
            "there is no such file",
            "did you mean",
            "case.ron",
        ],
    );
    trial.refuses(
        &trial.path("materials"),
        &[],
        &["it is a folder, not a file"],
    );
    trial.refuses(
        &trial.write("empty.ron", " \n"),
        &[],
        &["empty.ron:1:1: error: is empty"],
    );
    let latin = trial.write("latin.ron", b"(\n  name: \"caf\xe9\",\n)");
    trial.refuses(
        &latin,
        &[],
        &[
            "latin.ron:2:13: error: is not UTF-8",
            "save the file as UTF-8",
        ],
    );
}
