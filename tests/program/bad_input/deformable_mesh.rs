//! Invalid meshes of deformable bodies.

use super::deformable::{HELD, MESH, STIFF, block, stiff_refused};
use super::trial::{MARK, Trial};

#[test]
fn blocks_that_are_none() {
    let wrong = |old: &str, new: &str, words: &[&str]| {
        stiff_refused(&block(&MESH.replacen(old, new, 1), HELD), words);
    };
    wrong("to: 0.2", "to: ‸-0.2", &["`to` must be above `from`"]);
    wrong("size: 0.05", "size: ‸0.0", &["must be positive"]);
    wrong("size: 0.05", "size: ‸1e-9", &["in a line"]);
    wrong(
        "size: 0.05)",
        "size: 0.05, fine: ‸(0.1, 0.3))",
        &["`fine` must lie within"],
    );
    wrong(
        "size: 0.05))",
        "size: 0.05), round: (side: \"top\", radius: ‸0.09))",
        &["does not fit"],
    );
}

#[test]
fn files_of_gmsh() {
    let trial = |text: &str, words: &[&str]| {
        let trial = Trial::new();
        trial.write("materials/stone.ron", STIFF);
        trial.write("block.msh", text);
        let (case, place) =
            trial.write_marked("case.ron", &block("Gmsh(file: ‸\"block.msh\")", HELD));
        let said = trial.refuses(&case, &[], words);
        assert!(said.starts_with(&place.unwrap()), "{said}");
    };
    trial("$MeshFormat\n4.1 1 8\n", &["line 2", "binary"]);
    trial(
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n2\n1 0 0\n",
        &["line 6", "4 numbers"],
    );
    trial("solid\n", &["no file of Gmsh"]);
}

#[test]
fn a_side_with_a_profile_that_cannot_be() {
    let shaped = |more: &str| {
        let mesh = MESH.replace("size: 0.05))", &format!("size: 0.05), {more})"));
        block(&mesh, HELD)
    };
    let wave = "shape: Wave(amplitude: 0.01, x: 0.1)";
    stiff_refused(
        &shaped(&format!("profile: (side: {MARK}\"left\", {wave})")),
        &["only `top` and `bottom` can have a profile"],
    );
    stiff_refused(
        &shaped(&format!(
            "profile: (side: \"top\", shape: {MARK}Wave(amplitude: 0.15, x: 0.1))"
        )),
        &[
            "more than half of the height of the block",
            "make it smaller",
        ],
    );
    stiff_refused(
        &shaped(&format!(
            "round: (side: \"top\", radius: 0.5), profile: {MARK}(side: \"top\", {wave})"
        )),
        &["leave one out"],
    );
}

/// Four columns, and rows of 5, 3.75 and 11.25 cm from the top.
const GROWN: &str = "Block(x: (from: 0.0, to: 0.2, size: 0.05), y: (from: -0.3, to: -0.1, size: 0.05, fine: (-0.15, -0.1), growth: 3.0), coarsen: (from: \"top\"))";

/// Only the last row is as high as two columns are wide: 5 + 5 + 5 + 3 points and a centre for each
/// of 4 + 4 + 2 cells, of which the last two are cut in five. With three times the width the
/// columns join in the second row too.
#[test]
fn blocks_that_coarsen_are_checked_and_run() {
    let trial = Trial::new();
    trial.write("materials/stone.ron", STIFF);
    let touches = format!("{HELD}, touches: Surface(\"top\")");
    for (mesh, size) in [
        (GROWN.to_owned(), "28 points, 42 elements"),
        (
            GROWN.replace("\"top\")", "\"top\", ratio: 3.0)"),
            "22 points, 31 elements",
        ),
    ] {
        trial.write("case.ron", block(&mesh, &touches));
        let output = trial.call(&["check", "case.ron", "--no-timing", "--verbose"]);
        let said = String::from_utf8_lossy(&output.stdout);
        assert_eq!(output.status.code(), Some(0), "{said}");
        assert!(said.contains(size), "{said}");
    }
    let sides = [
        "round: (side: \"top\", radius: 0.5)",
        "profile: (side: \"top\", shape: Wave(amplitude: 0.01, x: 0.1))",
    ];
    for side in sides {
        let mesh = GROWN.replace("coarsen", &format!("{side}, coarsen"));
        trial.write("case.ron", block(&mesh, &touches));
        let output = trial.call(&["run", "case.ron"]);
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(0), "{said}");
    }
}

#[test]
fn blocks_that_cannot_coarsen() {
    let wrong = |old: &str, new: &str, words: &[&str]| {
        stiff_refused(&block(&GROWN.replacen(old, new, 1), HELD), words);
    };
    wrong(
        "\"top\"",
        "‸\"front\"",
        &["no side `front`", "`left`, `right`, `bottom`, `top`"],
    );
    wrong(
        "\"top\"",
        "\"top\", ratio: ‸0.0",
        &["must be positive, got 0"],
    );
    wrong(
        ", fine: (-0.15, -0.1), growth: 3.0), coarsen: (",
        "), coarsen: ‸(",
        &[
            "no cells would join",
            "5.000e-2 m",
            "1.000e-1 m",
            "`fine` and `growth` along y",
        ],
    );
    wrong(
        "size: 0.05), y: (from: -0.3, to: -0.1, size: 0.05, fine: (-0.15, -0.1), growth: 3.0), coarsen: (",
        "size: 0.2), y: (from: -0.3, to: -0.1, size: 0.05), coarsen: ‸(",
        &["a single column", "leave `coarsen` out"],
    );
    wrong("from: \"top\"", "‸side: \"top\"", &["side", "from"]);
    let many = GROWN
        .replace("to: 0.2, size: 0.05", "to: 0.2, size: 1e-5")
        .replace(
            "size: 0.05, fine: (-0.15, -0.1), growth: 3.0",
            "size: 1e-5, fine: (-0.15, -0.1), growth: 1.1",
        )
        .replace("Block", "‸Block");
    stiff_refused(
        &block(&many, HELD),
        &["more than 1000000 points", "make its elements larger"],
    );
}

/// A wave as short as four columns: columns joined to its length would be inverted above its
/// troughs.
#[test]
fn a_side_that_bends_too_much_to_coarsen_below() {
    let fine = "Block(x: (from: 0.0, to: 0.2, size: 0.005), y: (from: -0.3, to: -0.1, size: 0.005, fine: (-0.11, -0.1), growth: 1.5)";
    let wave = "profile: ‸(side: \"top\", shape: Wave(amplitude: 0.05, x: 0.02))";
    stiff_refused(
        &block(&format!("{fine}, {wave}, coarsen: (from: \"top\"))"), HELD),
        &[
            "is inverted",
            "bends too much for cells that double there",
            "a smaller `ratio`",
        ],
    );
    let trial = Trial::new();
    trial.write("materials/stone.ron", STIFF);
    let whole = format!("{fine}, {})", wave.replace('‸', ""));
    trial.write("case.ron", block(&whole, HELD));
    let output = trial.call(&["check", "case.ron", "--no-timing"]);
    assert_eq!(output.status.code(), Some(0), "without `coarsen` it fits");
}
