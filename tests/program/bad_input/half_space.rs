//! Invalid elastic half-spaces: their cells, depths, holders, profiles, and unsupported uses.

use super::trial::{MARK, PLANE, SOLID, Trial, with};

/// The stone of the trials has no modulus.
const STIFF: &str = r#"(doc: "stone", density: (value: 2600.0, unit: "kg/m^3", source: "quartz"), properties: {
    "young": (value: 7e10, unit: "Pa", source: "chosen"), "poisson": (value: 0.2, unit: "", source: "chosen")})"#;

/// A half-space in the plane, below the floor of the case.
const LINE: &str = r#"name: "ground", material: "grain", position: [0.0, -0.5], x: (from: 0.0, to: 0.2, size: 0.01), depth: 0.3, touches: Surface"#;

/// A half-space in space.
const AREA: &str = r#"name: "ground", material: "grain", position: [0.0, 0.0, -0.5], x: (from: 0.0, to: 0.2, size: 0.05), y: (from: 0.0, to: 0.2, size: 0.05), touches: Surface"#;

/// The 2D case without its period and with these half-spaces.
fn plane(half_spaces: &str) -> String {
    let case = with(PLANE, "periodic: (x: 0.4),", "");
    added(
        &with(&case, "theta: 0.5", "theta: 1.0"),
        "half_spaces",
        half_spaces,
    )
}

/// The 3D case with these half-spaces.
fn solid(half_spaces: &str) -> String {
    let time = "time: (step: 1e-3, end: 0.002";
    let case = with(SOLID, time, &format!("{time}, theta: 1.0"));
    added(&case, "half_spaces", half_spaces)
}

fn added(case: &str, field: &str, list: &str) -> String {
    with(
        case,
        "    output: (",
        &format!("    {field}: [{list}],\n    output: ("),
    )
}

fn line(old: &str, new: &str) -> String {
    plane(&format!("({})", with(LINE, old, new)))
}

fn area(old: &str, new: &str) -> String {
    solid(&format!("({})", with(AREA, old, new)))
}

/// Two half-spaces of which the second differs.
fn two(old: &str, new: &str) -> String {
    let second = with(
        &with(LINE, "[0.0, -0.5]", "[0.0, 0.09]"),
        "name: \"ground\"",
        "name: \"roof\", side: Above",
    );
    plane(&format!("({LINE}), ({})", with(&second, old, new)))
}

/// The case is rejected at its mark with these words, with a stone that has a modulus and with
/// these files beside it.
#[track_caller]
fn refused_beside(marked: &str, files: &[(&str, &str)], words: &[&str]) {
    let trial = Trial::new();
    trial.write("materials/stone.ron", STIFF);
    for (name, text) in files {
        trial.write(name, text);
    }
    let (case, place) = trial.write_marked("case.ron", marked);
    let said = trial.refuses(&case, &[], words);
    let place = place.expect("a mark in the case");
    assert!(said.starts_with(&place), "not at {place}\n{said}");
}

#[track_caller]
fn refused(marked: &str, words: &[&str]) {
    refused_beside(marked, &[], words);
}

#[track_caller]
fn runs(case: &str) {
    let trial = Trial::new();
    trial.write("materials/stone.ron", STIFF);
    trial.write("case.ron", case);
    let output = trial.call(&["run", "case.ron"]);
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{said}");
}

#[test]
fn half_spaces_without_a_mistake_run() {
    runs(&plane(&format!("({LINE})")));
    runs(&solid(&format!("({AREA})")));
    runs(&two("touches: Surface", "touches: Points"));
    // Without an interface between their materials both may touch in one way.
    let two_materials = two("material: \"grain\"", "material: \"other\"");
    runs(&with(
        &two_materials,
        "materials: {\"grain\": \"stone\"}",
        "materials: {\"grain\": \"stone\", \"other\": \"stone\"}",
    ));
}

#[test]
fn a_theta_at_which_they_ring() {
    let case = plane(&format!("({LINE})"));
    refused(
        &with(&case, "theta: 1.0", "theta: ‸0.5"),
        &["alternate from step to step"],
    );
}

#[test]
fn points_that_lie_deep_in_another_body() {
    let case = two("touches: Surface", "touches: Points");
    let second = "(name: \"roof\"";
    let case = case.replace(second, &format!("‸{second}"));
    refused(
        &with(&case, "[0.0, 0.09]", "[0.0, -0.55]"),
        &["points of the body `roof` lie 5.500e-1 m behind the surface of the body `floor`"],
    );
}

#[test]
fn depths() {
    refused(
        &plane(&format!("‸({})", with(LINE, "depth: 0.3, ", ""))),
        &["has no displacement without a `depth`"],
    );
    for depth in ["0.1", "0.0", "-1.0"] {
        refused(
            &line("depth: 0.3", &format!("depth: ‸{depth}")),
            &["not less than the extent of the cells, 0.2 m"],
        );
    }
    refused(
        &area("touches", "depth: ‸0.5, touches"),
        &["in three dimensions displacements vanish at infinity"],
    );
    refused(
        &solid(&format!(
            "‸({})",
            with(AREA, "touches", "periodic: true, touches")
        )),
        &["has no displacement without a `depth`"],
    );
    refused(
        &area("touches", "periodic: true, depth: ‸0.0, touches"),
        &["must be positive"],
    );
}

#[test]
fn cells() {
    refused(
        &line("depth", "y: ‸(from: 0.0, to: 0.2, size: 0.05), depth"),
        &["cells along x alone"],
    );
    refused(
        &solid(&format!(
            "‸({})",
            with(AREA, "y: (from: 0.0, to: 0.2, size: 0.05), ", "")
        )),
        &["needs its cells along `y` too"],
    );
    for size in ["0.0", "-0.01", "inf", "NaN"] {
        refused(&line("size: 0.01", &format!("size: ‸{size}")), &["size"]);
    }
    for to in ["0.0", "-0.2"] {
        refused(
            &line("to: 0.2", &format!("to: ‸{to}")),
            &["`to` must be above `from`"],
        );
    }
    refused(
        &line("size: 0.01", "size: ‸1e-9"),
        &["more than a million in a line"],
    );
    refused(
        &line("x: (from", "x: ‸(from").replace("size: 0.01", "size: 0.2"),
        &["at least two cells along x, got 1"],
    );
    refused(
        &area(
            "y: (from: 0.0, to: 0.2, size: 0.05)",
            "y: ‸(from: 0.0, to: 0.2, size: 0.3)",
        ),
        &["at least two cells along y, got 1"],
    );
    refused(
        &area("x: (from", "x: ‸(from").replace("size: 0.05", "size: 1e-4"),
        &["1000000 cells at most"],
    );
}

#[test]
fn masses_and_drives() {
    for dof in ["Free", "Force(Constant(-1.0))"] {
        refused(
            &plane(&format!(
                "‸({})",
                with(LINE, "touches", &format!("dofs: (y: {dof}), touches"))
            )),
            &["free or under a force along y needs a `mass`"],
        );
    }
    for mass in ["-1.0", "inf", "NaN"] {
        refused(&line("depth", &format!("mass: ‸{mass}, depth")), &["mass"]);
    }
    refused(
        &line(
            "depth",
            "mass: 1.0, dofs: ‸(y: Stages([(until: 1e-3, drive: Force(Constant(-1.0))), (drive: Fixed)])), depth",
        ),
        &["imposes motion at one time and a force at another"],
    );
    refused(&line("depth", "dofs: (z: ‸Fixed), depth"), &["no z"]);
    refused(
        &line(
            "depth",
            "mass: 1.0, dofs: (y: ‸Pressure(value: Constant(-1.0))), depth",
        ),
        &["a pressure needs the length along x: name two walls in `between`"],
    );
}

#[test]
fn surfaces_that_roll_past_their_cells() {
    runs(&line("depth", "rolling: Constant(10.0), depth"));
    refused(
        &line("depth", "rolling: ‸Constant(20.0), depth"),
        &["more than a cell", "shorten `time.step`"],
    );
    // The speed is reached within the run.
    refused(
        &line(
            "depth",
            "rolling: ‸Ramp(from: 0.0, to: -20.0, start: 0.0, end: 0.001), depth",
        ),
        &["at 20 m/s"],
    );
    refused(
        &line("depth", "rolling: ‸Table([(1.0, 0.0), (0.0, 1.0)]), depth"),
        &["time"],
    );
}

#[test]
fn a_case_that_repeats() {
    refused(
        &added(
            PLANE,
            "half_spaces",
            &format!("({})", with(LINE, "x: (", "x: ‸(")),
        ),
        &["repeat with it: let them extend over 0.4 m"],
    );
}

#[test]
fn bodies_that_would_pass_through_each_other() {
    refused(
        &two("touches: Surface", "touches: ‸Surface"),
        &["`ground` and `roof` both touch by a surface", "`Points`"],
    );
    let both = two("touches: Surface", "touches: ‸Points").replacen(
        "touches: Surface",
        "touches: Points",
        1,
    );
    refused(&both, &["both touch by points", "`Surface`"]);
    // A body of finite elements and a half-space.
    let block = "(name: \"block\", material: \"grain\", mesh: Block(x: (from: 0.0, to: 0.2, size: 0.05), y: (from: -0.3, to: -0.1, size: 0.05)), \
                 supports: [(part: \"bottom\", x: Fixed, y: Fixed)], touches: Surface(\"top\"))";
    let case = line("touches: Surface", "touches: ‸Surface");
    refused(
        &added(&case, "elastic", block),
        &["`block` and `ground` both touch by a surface"],
    );
    // The grains have 1 cm, between points 5 cm apart.
    refused(
        &line("touches: Surface", "touches: ‸Points").replace("size: 0.01", "size: 0.05"),
        &["fit between the points of `ground`"],
    );
}

#[test]
fn names_that_are_none() {
    for name in ["", "a/b", "lid"] {
        refused(
            &line("name: \"ground\"", &format!("name: ‸\"{name}\"")),
            &["must be unique and made of letters"],
        );
    }
    refused(
        &two("name: \"roof\"", "name: ‸\"ground\""),
        &["must be unique"],
    );
}

#[test]
fn materials() {
    let marked = line("material: \"grain\"", &format!("material: {MARK}\"grain\""));
    super::trial::refused(&marked, &["needs the property `young`"]);
    refused(
        &line("material: \"grain\"", "material: ‸\"grian\""),
        &["grian", "grain"],
    );
}

#[test]
fn profiles() {
    let profile = |text: &str| line("depth", &format!("profile: {text}, depth"));
    refused(&profile("Summit(x: ‸0.0)"), &["must be positive"]);
    refused(
        &profile("Wave(amplitude: 1e-3, x: ‸-1.0)"),
        &["must be positive"],
    );
    refused(&profile("‸Wave(amplitude: inf, x: 0.1)"), &["not finite"]);
    let file = profile("Heights(file: ‸\"heights.txt\")");
    refused(&file, &["heights.txt", "cannot be read"]);
    refused_beside(
        &file,
        &[("heights.txt", "0.0 0.0, 1e-6\n")],
        &["3 heights in 1 line of 3, and there are 20 cells, 20 along x"],
    );
    let endless = "0.0 ".repeat(19) + "inf";
    for (text, line, says) in [
        (
            "# a scan\n0.0 level 0.0\n",
            2,
            "`level` is not a finite number",
        ),
        (&endless, 1, "`inf` is not a finite number"),
        ("0,5 0.25\n", 1, "decimal point"),
    ] {
        refused_in("heights.txt", &unmarked(&file), (text, line), &[says]);
    }
}

/// A file of heights must fit the cells by its rows and columns, not only by its count of numbers.
#[test]
fn heights_of_other_rows() {
    let file = |cells: &str| {
        let profile = format!("profile: Heights(file: ‸\"h.txt\"), {cells}");
        area(
            "x: (from: 0.0, to: 0.2, size: 0.05), y: (from: 0.0, to: 0.2, size: 0.05)",
            &profile,
        )
    };
    let wide = file("x: (from: 0.0, to: 0.2, size: 0.05), y: (from: 0.0, to: 0.15, size: 0.05)");
    let rows = "# a scan, in metres\n1e-6 2e-6 3e-6 4e-6\n5e-6 6e-6 7e-6 8e-6\n\n9e-6 1e-5 1.1e-5 1.2e-5\n";
    let trial = Trial::new();
    trial.write("materials/stone.ron", STIFF);
    trial.write("h.txt", rows);
    trial.write("case.ron", unmarked(&wide));
    let output = trial.call(&["check", "case.ron"]);
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{said}");
    let turned = "1e-6 2e-6 3e-6\n4e-6 5e-6 6e-6\n7e-6 8e-6 9e-6\n1e-5 1.1e-5 1.2e-5\n";
    refused_beside(&wide, &[("h.txt", turned)], &["transposed"]);
    let places = "0 0 1e-6\n1 0 2e-6\n2 0 3e-6\n3 0 4e-6\n";
    refused_beside(&wide, &[("h.txt", places)], &["places x, y and heights z"]);
    let commas = "1,0 2,0 3.0 4,0\n".repeat(3);
    refused_in("h.txt", &unmarked(&wide), (&commas, 1), &["decimal point"]);
}

fn unmarked(case: &str) -> String {
    case.replace('‸', "")
}

/// The case is rejected at a line of a file beside it.
#[track_caller]
fn refused_in(file: &str, case: &str, (text, line): (&str, usize), words: &[&str]) {
    let trial = Trial::new();
    trial.write("materials/stone.ron", STIFF);
    trial.write(file, text);
    trial.write("case.ron", case);
    let said = trial.refuses(&trial.path("case.ron"), &[], words);
    assert!(said.contains(&format!("{file}:{line}:")), "{said}");
}

#[test]
fn wear() {
    let law = |case: String| {
        with(
            &case,
            "contact: \"coulomb\",",
            "contact: \"coulomb\", wear: \"archard\",",
        )
    };
    runs(&law(line("touches", "wears: (thickness: 1e-3), touches")));
    refused(
        &law(line(
            "touches: Surface",
            "touches: Points, wears: ‸(thickness: 1e-3)",
        )),
        &["`ground` touches by its points, which do not recede"],
    );
    refused(
        &line("touches", "wears: ‸(thickness: 1e-3), touches"),
        &["no interface of the material `grain` has a wear law"],
    );
    for thickness in ["0.0", "-1.0", "inf"] {
        refused(
            &law(line(
                "touches",
                &format!("wears: (thickness: ‸{thickness}), touches"),
            )),
            &["a thickness must be positive"],
        );
    }
    refused(
        &law(line(
            "touches",
            "wears: (thickness: 1e-3, every: ‸0), touches",
        )),
        &["must be at least 1"],
    );
    // This holds in 3D too.
    let worn = |case: &str| {
        let law = "contact: \"coulomb\", wear: \"archard\")";
        with(case, "contact: \"coulomb\")", law)
    };
    let ground = area("touches", "wears: (thickness: 1e-3), touches");
    runs(&worn(&ground));
}

/// Only a surface with one height at each position can recede.
#[test]
fn wear_of_walls() {
    let line = "(from: 0.0, to: 0.2, size: 0.1)";
    let block = |depth: &str, side: &str, mark: &str| {
        format!(
            "(name: \"block\", material: \"grain\", mesh: Block(x: {line}, y: {line}{depth}), position: [{}], \
             supports: [(part: \"bottom\", x: Fixed, y: Fixed{})], touches: Surface(\"{side}\"), wears: {mark}(thickness: 1e-3))",
            if depth.is_empty() {
                "0.0, -0.5"
            } else {
                "0.0, 0.0, -0.5"
            },
            if depth.is_empty() { "" } else { ", z: Fixed" },
        )
    };
    let words = &[
        "the part of `block` that touches is vertical or overhangs at (",
        "let a part touch that has one height at each place, as `Surface(\"top\")`",
    ];
    let time = "time: (step: 1e-3, end: 0.002";
    let solid = with(SOLID, time, &format!("{time}, theta: 1.0"));
    let law = [
        "contact: \"coulomb\")",
        "contact: \"coulomb\", wear: \"archard\")",
    ];
    let solid = with(&solid, law[0], law[1]);
    let deep = format!(", z: {line}");
    for side in ["left", "right", "front", "back"] {
        refused(&added(&solid, "elastic", &block(&deep, side, "‸")), words);
    }
    for side in ["top", "bottom"] {
        runs(&added(&solid, "elastic", &block(&deep, side, "")));
    }
    let plane = with(PLANE, "periodic: (x: 0.4),", "");
    let plane = with(
        &plane,
        "contact: \"coulomb\",",
        "contact: \"coulomb\", wear: \"archard\",",
    );
    refused(&added(&plane, "elastic", &block("", "left", "‸")), words);
    runs(&added(&plane, "elastic", &block("", "top", "")));
}

#[test]
fn friction_tests_of_bodies_that_nothing_holds() {
    let block = "(name: \"block\", material: \"grain\", mesh: Block(x: (from: 0.0, to: 0.2, size: 0.05), y: (from: -0.3, to: -0.1, size: 0.05)), \
                 supports: [(part: \"bottom\", y: Fixed), (part: \"left\", y: Fixed)], strain: Small)";
    let open = with(PLANE, "periodic: (x: 0.4),", "");
    let case = added(&open, "elastic", block);
    refused(
        &with(
            &case,
            "friction: (body: \"lid\"",
            "friction: (body: ‸\"block\"",
        ),
        &["no part of `block` is held along axis 0"],
    );
    // A half-space has a drive along each axis.
    runs(&with(
        &plane(&format!("({LINE})")),
        "friction: (body: \"lid\"",
        "friction: (body: \"ground\"",
    ));
    refused(
        &with(
            &plane(&format!("({LINE})")),
            "friction: (body: \"lid\"",
            "friction: (body: ‸\"grund\"",
        ),
        &["grund", "ground"],
    );
}
