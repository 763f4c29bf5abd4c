//! Invalid deformable grains: their material, elements, damping and shapes.

use super::trial::{PLANE, SOLID, Trial, with};

/// A deformable stone.
const STIFF: &str = r#"(doc: "stone", density: (value: 2600.0, unit: "kg/m^3", source: "quartz"), properties: {
    "young": (value: 7e10, unit: "Pa", source: "chosen"), "poisson": (value: 0.2, unit: "", source: "chosen")})"#;

/// The case with these entries of `elastic_grains`.
fn soft(case: &str, entries: &str) -> String {
    let key = format!("elastic_grains: {entries},\n    output:");
    with(case, "output:", &key)
}

/// The case is rejected at its mark with these words, with a stone that has a modulus.
#[track_caller]
fn stiff_refused(marked: &str, words: &[&str]) {
    refused_of(STIFF, marked, words);
}

#[track_caller]
fn refused_of(stone: &str, marked: &str, words: &[&str]) {
    let trial = Trial::new();
    trial.write("materials/stone.ron", stone);
    let (case, place) = trial.write_marked("case.ron", marked);
    let said = trial.refuses(&case, &[], words);
    let place = place.expect("a mark in the case");
    assert!(said.starts_with(&place), "not at {place}\n{said}");
}

#[test]
fn soft_grains_without_a_mistake_run() {
    for case in [PLANE, SOLID] {
        let trial = Trial::new();
        trial.write("materials/stone.ron", STIFF);
        trial.write("case.ron", soft(case, "[(material: \"grain\")]"));
        let output = trial.call(&["run", "case.ron"]);
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(0), "{said}");
    }
}

#[test]
fn materials_of_no_grains() {
    stiff_refused(
        &soft(PLANE, "[(material: ‸\"grains\")]"),
        &["no material `grains`", "did you mean `grain`?"],
    );
    let other = with(
        PLANE,
        "{\"grain\": \"stone\"}",
        "{\"grain\": \"stone\", \"other\": \"stone\"}",
    );
    stiff_refused(
        &soft(&other, "[(material: ‸\"other\")]"),
        &["has no grains of this material"],
    );
    stiff_refused(
        &soft(&other, "[(material: \"grain\"), (material: ‸\"other\")]"),
        &["has no grains of this material"],
    );
    stiff_refused(
        &soft(PLANE, "[(material: \"grain\"), (material: ‸\"grain\")]"),
        &["`grain` are here twice"],
    );
}

#[test]
fn grains_of_materials_without_moduli() {
    let marked = soft(PLANE, "[(material: ‸\"grain\")]");
    let none = r#"(doc: "stone", density: (value: 2600.0, unit: "kg/m^3", source: "quartz"))"#;
    refused_of(none, &marked, &["needs the property `young`"]);
    let half = STIFF.replace(
        ", \"poisson\": (value: 0.2, unit: \"\", source: \"chosen\")",
        "",
    );
    refused_of(&half, &marked, &["needs the property `poisson`"]);
    let liquid = STIFF.replace("0.2", "0.5");
    refused_of(&liquid, &marked, &["0.5"]);
}

#[test]
fn elements_and_damping_out_of_range() {
    for elements in ["0", "13", "100"] {
        let entry = format!("[(material: \"grain\", elements: ‸{elements})]");
        stiff_refused(&soft(PLANE, &entry), &["1 to 12 elements", elements]);
    }
    stiff_refused(
        &soft(SOLID, "[(material: \"grain\", elements: ‸6)]"),
        &["1 to 5 elements"],
    );
    for damping in [
        "(mass: ‸-1.0, stiffness: 0.0)",
        "(mass: 0.0, stiffness: ‸-1e-3)",
    ] {
        let entry = format!("[(material: \"grain\", damping: {damping})]");
        stiff_refused(&soft(PLANE, &entry), &["zero or positive"]);
    }
}

#[test]
fn grains_that_have_to_be_rigid() {
    let shapes = |grains: &str| {
        let from = PLANE.find("List(").unwrap();
        let to = PLANE.find("    friction:").unwrap();
        let case = format!("{}{grains}],\n{}", &PLANE[..from], &PLANE[to..]);
        soft(&case, "[(material: \"grain\")]")
    };
    stiff_refused(
        &shapes(
            "Polygons(material: \"grain\", grains: [‸(at: [0.1, 0.02], regular: (5, 0.01), rounding: 1e-3)])",
        ),
        &["no rounded corners"],
    );
    stiff_refused(
        &shapes(
            "Clusters(material: \"grain\", grains: [‸(at: [0.1, 0.02], shapes: [Balls([([0.0, 0.0], 0.01), ([0.01, 0.0], 0.01)])])])",
        ),
        &["one shape"],
    );
}

#[test]
fn projection_of_overlaps() {
    let marked = soft(PLANE, "[(material: \"grain\")]");
    let trial = Trial::new();
    trial.write("materials/stone.ron", STIFF);
    let case = trial.write("case.ron", marked);
    let sets = ["--set", "solver.projection=0.01"];
    trial.refuses(
        &case,
        &sets,
        &["projection", "elastic_grains", "set it to 0"],
    );
}

/// Grains are identified by their positions, since they have no names.
#[test]
fn grains_that_overlap() {
    let from = PLANE.find("List(").unwrap();
    let to = PLANE.find("    friction:").unwrap();
    let pair = "List(material: \"grain\", grains: [(at: [0.1, 0.02], radius: 0.01), (at: [0.1, 0.03], radius: 0.01)])";
    let case = format!("{}{pair}],\n{}", &PLANE[..from], &PLANE[to..]);
    let trial = Trial::new();
    trial.write("materials/stone.ron", STIFF);
    let case = trial.write("case.ron", soft(&case, "[(material: \"grain\")]"));
    let said = trial.refuses(
        &case,
        &[],
        &["the grain at [0.1, 0.02] m", "the grain at [0.1, 0.03] m"],
    );
    assert!(!said.contains("grain_"), "{said}");
}
