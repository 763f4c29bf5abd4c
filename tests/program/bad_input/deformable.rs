//! Invalid deformable bodies: their supports and materials.

use super::trial::{MARK, PLANE, Trial, refused, with};

/// The 2D case without its period and with a deformable block of the given mesh and further fields.
pub(super) fn block(mesh: &str, more: &str) -> String {
    let body = format!(
        "elastic: [(name: \"block\", material: \"grain\", mesh: {mesh}, {more})],\n    friction:"
    );
    let open = with(PLANE, "periodic: (x: 0.4),", "");
    with(&open, "friction:", &body)
}

pub(super) const MESH: &str =
    "Block(x: (from: 0.0, to: 0.2, size: 0.05), y: (from: -0.3, to: -0.1, size: 0.05))";
pub(super) const HELD: &str = "supports: [(part: \"bottom\", x: Fixed, y: Fixed)]";

/// The stone of the trials has no modulus.
pub(super) const STIFF: &str = r#"(doc: "stone", density: (value: 2600.0, unit: "kg/m^3", source: "quartz"), properties: {
    "young": (value: 7e10, unit: "Pa", source: "chosen"), "poisson": (value: 0.2, unit: "", source: "chosen")})"#;

/// The case is rejected at its mark with these words, with a stone that has a modulus.
#[track_caller]
pub(super) fn stiff_refused(marked: &str, words: &[&str]) {
    let trial = Trial::new();
    trial.write("materials/stone.ron", STIFF);
    let (case, place) = trial.write_marked("case.ron", marked);
    let said = trial.refuses(&case, &[], words);
    let place = place.expect("a mark in the case");
    assert!(said.starts_with(&place), "not at {place}\n{said}");
}

#[test]
fn the_block_without_a_mistake_runs() {
    let trial = Trial::new();
    trial.write("materials/stone.ron", STIFF);
    trial.write(
        "case.ron",
        block(MESH, &format!("{HELD}, touches: Surface(\"top\")")),
    );
    let output = trial.call(&["run", "case.ron"]);
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{said}");
}

#[test]
fn a_material_without_a_modulus() {
    let marked = block(MESH, HELD).replace(
        "material: \"grain\", mesh",
        &format!("material: {MARK}\"grain\", mesh"),
    );
    refused(&marked, &["needs the property `young`"]);
}

#[test]
fn supports_that_do_not_hold() {
    stiff_refused(
        &block(MESH, "supports: ‸[(part: \"sides\", x: Fixed)]"),
        &["no part `sides`", "bottom, left, right, top"],
    );
    stiff_refused(
        &block(MESH, "supports: ‸[(part: \"bottom\", x: Fixed)]"),
        &["nothing keeps the body `block` from turning"],
    );
    stiff_refused(
        &block(
            MESH,
            "supports: ‸[(part: \"bottom\", y: Fixed), (part: \"left\", y: Force(Constant(1.0)))]",
        ),
        &["`bottom` and `left` share points that both drive along y"],
    );
    stiff_refused(
        &block(MESH, "supports: [(part: \"bottom\", x: Fixed, z: ‸Fixed)]"),
        &["no z"],
    );
    stiff_refused(
        &block(MESH, &format!("{HELD}, touches: ‸Points(\"up\")")),
        &["no part `up`"],
    );
}

/// A body that rotates needs a measure of strain that follows rotations, and may then be free.
#[test]
fn strains_that_cannot_be() {
    stiff_refused(
        &block(MESH, "strain: ‸Large"),
        &["Corotational", "NeoHookean"],
    );
    stiff_refused(
        &block(MESH, &format!("{HELD}, spin: ‸[1.0]")),
        &["the body `block` spins", "strain: Corotational"],
    );
    stiff_refused(
        &block(MESH, "strain: Corotational, spin: ‸[1.0, 0.0, 0.0]"),
        &["a spin has 1 components"],
    );
    let trial = Trial::new();
    trial.write("materials/stone.ron", STIFF);
    for strain in ["Corotational", "NeoHookean"] {
        let more = format!("strain: {strain}, spin: [0.1], touches: Surface(\"top\")");
        trial.write("case.ron", block(MESH, &more));
        let output = trial.call(&["run", "case.ron"]);
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(0), "{said}");
    }
}

/// A block in small strain that is sheared by a tenth runs, but is not trustworthy; in large strain
/// it is.
#[test]
fn strains_that_are_not_small_are_warned_of() {
    let trial = Trial::new();
    trial.write("materials/stone.ron", STIFF);
    let shear = "(part: \"top\", x: Displacement(Ramp(from: 0.0, to: 0.02, start: 0.0, end: 0.002)), y: Fixed)";
    let supports = format!("supports: [(part: \"bottom\", x: Fixed, y: Fixed), {shear}]");
    for (strain, warned) in [("Small", true), ("NeoHookean", false)] {
        let case = block(MESH, &format!("{supports}, strain: {strain}"));
        trial.write("case.ron", case);
        let output = trial.call(&["run", "case.ron", "--json"]);
        let said = String::from_utf8_lossy(&output.stdout);
        assert_eq!(output.status.code(), Some(0), "{said}");
        let sentence = "NOT SMALL STRAIN: the body `block`";
        assert_eq!(said.contains(sentence), warned, "{strain}: {said}");
        assert_eq!(said.contains("\"rotation\""), warned, "{strain}: {said}");
    }
}

#[test]
fn names_that_are_none_and_bodies_that_would_pass_through_each_other() {
    let named =
        |name: &str| block(MESH, HELD).replace("(name: \"block\"", &format!("(name: ‸\"{name}\""));
    for name in ["", "a/b", "lid"] {
        stiff_refused(&named(name), &["must be unique and made of letters"]);
    }
    stiff_refused(
        &block(
            MESH,
            "supports: [(part: \"bottom\", x: Fixed, y: Fixed), (part: ‸\"bottom\", y: Free)]",
        ),
        &["held twice along y"],
    );
    let touches = format!("{HELD}, touches: Points(\"top\")");
    let other = MESH.replace("-0.1,", "-0.2,");
    let second = format!(
        "{touches}), (name: \"second\", material: \"grain\", mesh: {other}, {}",
        touches.replace("touches: ", "touches: ‸")
    );
    stiff_refused(
        &block(MESH, &second),
        &["pass through each other", "`Surface`"],
    );
    // The grains have 1 cm, between points 5 cm apart.
    stiff_refused(
        &block(MESH, &format!("{HELD}, touches: ‸Points(\"top\")")),
        &["fit between the points of `block`"],
    );
}
