//! Short cases that request much work: they are rejected at the request, before the work begins.

use super::trial::{PLANE, SOLID, refused, with};

/// The 2D case with these additional grains.
fn grains(case: &str, more: &str) -> String {
    let to = format!("    grains: [\n{more},\n");
    let list = if case == PLANE {
        "    grains: [\n"
    } else {
        "    grains: ["
    };
    with(case, list, &to)
}

#[test]
fn a_rough_profile_of_too_many_points_or_waves() {
    let floor = |fields: &str, words: &[&str]| {
        let rough = format!("RoughProfile({fields}, rms: 1e-4, side: Below)");
        refused(&with(PLANE, "HalfSpace(normal: [0.0, 1.0])", &rough), words);
    };
    floor(
        "points: ‸8000000, shortest: 0.04",
        &["at most 1000000 points, got 8000000"],
    );
    floor(
        "points: ‸100000, shortest: 1e-5",
        &[
            "100000 points with 40000 waves take too long",
            "a larger `shortest`",
        ],
    );
}

#[test]
fn an_arch_of_leaves() {
    refused(
        &grains(
            PLANE,
            "Arch(material: \"grain\", blocks: ‸270000, radius: 1.0, thickness: 0.1)",
        ),
        &["an arch has 2 to 10000 blocks, got 270000"],
    );
}

#[test]
fn cells_and_rounds_that_take_minutes() {
    refused(
        &grains(
            PLANE,
            "Voronoi(material: \"grain\", size: 3e-4, rounds: ‸200, low: [0.0, 0.03], high: [0.1, 0.06])",
        ),
        &["200 rounds over 3.333e4 cells take too long", "1e6 at most"],
    );
    refused(
        &grains(
            SOLID,
            "Voronoi(material: \"grain\", size: 0.0186, rounds: ‸2, low: [0.0, 0.0, 0.0], high: [120.0, 0.08, 0.04])",
        ),
        &["2 rounds over 5.967e4 cells", "5e4 at most in 3 dimensions"],
    );
}

#[test]
fn more_grains_than_a_line_may_make() {
    for of in [
        "Lattice(material: \"grain\", count: ‸2000001, radius: (1e-3, 1e-3),",
        "Deposit(material: \"grain\", count: ‸2000001, sizes: Uniform(radius: (1e-3, 1e-3)),",
    ] {
        refused(
            &grains(PLANE, &format!("{of} low: [0.0, 0.03], high: [0.4, 0.09])")),
            &["2000001 grains are too many", "at most 2000000"],
        );
    }
}

#[test]
fn a_skin_that_makes_all_grains_neighbours() {
    let many = grains(
        PLANE,
        "Lattice(material: \"grain\", count: 30000, radius: (1e-5, 1e-5), low: [0.0, 0.03], high: [0.4, 0.09])",
    );
    refused(
        &with(
            &many,
            "    materials:",
            "    detection: (skin: ‸1e3),\n    materials:",
        ),
        &[
            "candidate pairs, of 2e8 at most",
            "smaller than the largest radius",
        ],
    );
}

/// The message names what there are too many of.
#[test]
fn more_materials_than_a_table_of_pairs_holds() {
    let many: Vec<String> = (0..10_001)
        .map(|k| format!("\"m{k}\": \"stone\""))
        .collect();
    let many = format!("{{\"grain\": \"stone\", {}}}", many.join(", "));
    refused(
        &with(
            PLANE,
            "materials: {\"grain\": \"stone\"}",
            &format!("materials: ‸{many}"),
        ),
        &["10002 materials are too many, at most 10000"],
    );
}
