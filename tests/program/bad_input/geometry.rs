//! Grains, surfaces and scene files.

use super::trial::{PLANE, SOLID, Trial, refused, with};

#[test]
fn overlapping_grains() {
    refused(
        &with(PLANE, "(at: [0.1, 0.011]", "‸(at: [0.06, 0.011]"),
        &[
            "overlap by 1.000e-2 m at the start",
            "move them apart or make them smaller",
        ],
    );
}

#[test]
fn a_grain_in_a_wall() {
    refused(
        &with(PLANE, "(at: [0.1, 0.011]", "‸(at: [0.1, 0.004]"),
        &["the body `floor`", "overlap by 6.000e-3 m at the start"],
    );
}

#[test]
fn vectors_of_the_other_dimension() {
    refused(
        &with(PLANE, "at: [0.1, 0.011]", "at: ‸[0.1, 0.011, 0.0]"),
        &[
            "3 components in a case of dimension 2",
            "expected 2 numbers",
        ],
    );
    refused(
        &with(
            PLANE,
            "gravity: [0.0, -9.81]",
            "gravity: ‸[0.0, 0.0, -9.81]",
        ),
        &["expected 2 numbers"],
    );
    refused(
        &with(SOLID, "at: [0.15, 0.15, 0.02]", "at: ‸[0.15, 0.02]"),
        &[
            "2 components in a case of dimension 3",
            "expected 3 numbers",
        ],
    );
}

#[test]
fn vectors_that_are_not_finite() {
    refused(
        &with(PLANE, "at: [0.1, 0.011]", "at: ‸[NaN, 0.011]"),
        &["the components must be finite numbers"],
    );
    refused(
        &with(
            PLANE,
            "(at: [0.1, 0.011], radius: 0.01)",
            "(at: [0.1, 0.011], radius: 0.01, spin: ‸[inf])",
        ),
        &["the components must be finite numbers"],
    );
}

#[test]
fn surfaces_of_the_other_dimension() {
    let field = "HeightField(points: (4, 4), spacing: (0.1, 0.1), rms: 1e-4)";
    refused(
        &with(PLANE, "HalfSpace(normal: [0.0, 1.0])", &format!("‸{field}")),
        &[
            "a height field needs three dimensions",
            "Profile or RoughProfile",
        ],
    );
    refused(
        &with(
            SOLID,
            field,
            "‸Profile(points: [(0.0, 0.0), (1.0, 0.0)], side: Below)",
        ),
        &["a profile needs two dimensions", "HeightField"],
    );
}

/// Heights written in lines are the rows of the grid.
#[test]
fn a_height_field_that_is_transposed() {
    let field = "HeightField(points: (4, 4), spacing: (0.1, 0.1), rms: 1e-4)";
    let lines = |heights: &str| {
        let field = format!("HeightField(points: (4, 3), spacing: (0.1, 0.1), heights: {heights})");
        with(
            SOLID,
            "HeightField(points: (4, 4), spacing: (0.1, 0.1), rms: 1e-4)",
            &field,
        )
    };
    assert!(SOLID.contains(field));
    refused(
        &lines("‸[\n0.0, 0.0, 1e-5,\n0.0, 0.0, 1e-5,\n0.0, 0.0, 1e-5,\n0.0, 0.0, 1e-5]"),
        &["4 heights along x in 3 rows", "transposed"],
    );
    refused(
        &lines("‸[\n0.0, 0.0, 1e-5,\n1.0, 0.0, 2e-5,\n2.0, 0.0, 1e-5,\n3.0, 0.0, 1e-5]"),
        &["places x, y"],
    );
}

#[test]
fn a_height_field_of_absurd_size() {
    refused(
        &with(
            SOLID,
            "HeightField(points: (4, 4)",
            "‸HeightField(points: (4294967296, 4294967296)",
        ),
        &["at most 10,000,000 points"],
    );
}

#[test]
fn a_normal_that_is_null() {
    refused(
        &with(PLANE, "normal: [0.0, 1.0]", "normal: ‸[0.0, 0.0]"),
        &["a normal must not be null"],
    );
}

#[test]
fn a_radius_that_is_none() {
    for bad in ["-0.01", "0", "NaN", "inf"] {
        refused(
            &with(
                PLANE,
                "(at: [0.1, 0.011], radius: 0.01)",
                &format!("(at: [0.1, 0.011], radius: ‸{bad})"),
            ),
            &["a radius must be positive, got"],
        );
    }
}

#[test]
fn a_lattice_without_a_box() {
    let lattice = |count: &str, high: &str| {
        let new = format!(
            r#"Lattice(material: "grain", count: {count}, radius: (0.01, 0.01), low: [0.0, 0.02], high: {high}), List("#
        );
        with(PLANE, "List(", &new)
    };
    refused(
        &lattice("2", "‸[]"),
        &["a corner of the box is empty", "expected 2 numbers"],
    );
    refused(
        &lattice("‸20000000", "[0.4, 0.1]"),
        &["too many", "expected at most"],
    );
    refused(
        &lattice("‸5000", "[0.4, 0.1]"),
        &["of 5000 grains fit into the box"],
    );
}

#[test]
fn a_period_shorter_than_four_grains() {
    refused(
        &with(PLANE, "periodic: (x: 0.4)", "periodic: (x: ‸0.07)"),
        &["at least 4 diameters of the largest grain (8e-2 m)"],
    );
}

#[test]
fn a_scene_file_of_the_other_dimension() {
    for (line, words) in [
        (
            "‸wall 1 PLANx 0 0 0 1 1 1 0 0 1",
            "a PLANx wall does not exist in 2 dimensions",
        ),
        ("‸body 1 sphere 0 0 0 0.1", "expected 3 numbers"),
        ("‸dim 3", "this scene has dimension 3, the case has 2"),
        ("‸ball 1", "unknown record `ball`"),
    ] {
        let trial = Trial::new();
        let place = trial
            .write_marked("scene.txt", &format!("# a scene\n{line}\n"))
            .1
            .unwrap();
        let grains = r#"Scene(file: "scene.txt", material: "grain", walls: "grain"), List("#;
        let case = trial.write("case.ron", with(PLANE, "List(", grains));
        let said = trial.refuses(&case, &[], &[words]);
        assert!(said.contains(&place), "not at {place}\n{said}");
    }
}

/// Meshes that are truncated or refer to missing points.
#[test]
fn meshes_that_are_damaged() {
    let stl: Vec<u8> = [&[0u8; 80][..], &12u32.to_le_bytes(), &[1u8; 250]].concat();
    let obj = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n".to_vec();
    for (name, bytes, sentence) in [
        (
            "cut.stl",
            stl,
            "ends before its last triangle: it was cut short",
        ),
        ("cut.obj", obj, "names a vertex that it does not have"),
    ] {
        let trial = Trial::new();
        trial.write(name, bytes);
        let floor = "HeightField(points: (4, 4), spacing: (0.1, 0.1), rms: 1e-4)";
        let mesh = format!("Mesh(file: \"{name}\")");
        let case = trial.write("case.ron", with(SOLID, floor, &mesh));
        trial.refuses(&case, &[], &[sentence]);
    }
}
