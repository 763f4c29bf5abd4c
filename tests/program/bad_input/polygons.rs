//! Convex polygons, capsules and arches.

use super::trial::{PLANE, SOLID, refused, with};

/// The 2D case with these additional grains.
fn grains(more: &str) -> String {
    with(
        PLANE,
        "    grains: [\n",
        &format!("    grains: [\n{more},\n"),
    )
}

/// The 2D case with this shape as its lid.
fn lid(shape: &str) -> String {
    with(PLANE, "HalfSpace(normal: [0.0, -1.0])", shape)
}

#[test]
fn polygons_that_are_none() {
    let of = |points: &str, sentence: &str| {
        let grain = format!("(at: [0.3, 0.05], points: ‸[{points}])");
        let list = format!("Polygons(material: \"grain\", grains: [{grain}])");
        refused(&grains(&list), &[sentence]);
    };
    of("(0.0, 0.0), (0.01, 0.0)", "at least three points, got 2");
    of(
        "(0.0, 0.0), (0.0, 0.01), (0.01, 0.0)",
        "in anticlockwise order; reverse their order",
    );
    of("(0.0, 0.0), (0.01, 0.0), (0.02, 0.0)", "lie on one line");
    of(
        "(0.0, 0.0), (0.02, 0.0), (0.005, 0.005), (0.0, 0.02)",
        "not convex at point 2; divide it into convex ones",
    );
    of(
        "(0.0, 0.0), (0.01, 0.0), (0.01, 0.0), (0.0, 0.01)",
        "points 1 and 2 of the polygon coincide",
    );
}

#[test]
fn regular_polygons_and_roundings() {
    let of = |fields: &str, sentence: &str| {
        let list = format!("Polygons(material: \"grain\", grains: [(at: [0.3, 0.05], {fields})])");
        refused(&grains(&list), &[sentence]);
    };
    of("regular: ‸(2, 0.01)", "has 3 to 10000 sides, got 2");
    of(
        "regular: ‸(5, -0.01)",
        "a radius must be positive, got -0.01",
    );
    of(
        "regular: (5, 0.01), rounding: ‸-1.0",
        "must not be negative, got -1",
    );
    of(
        "regular: (5, 0.01), spin: ‸[0.0, 1.0]",
        "a spin has 1 components",
    );
}

#[test]
fn capsules_without_length() {
    refused(
        &lid("‸Capsule(from: (0.0, 0.0), to: (0.0, 0.0), radius: 0.01)"),
        &["two different points; for a disk use Balls"],
    );
}

#[test]
fn arches_that_cannot_be() {
    let of = |fields: &str, sentence: &str| {
        refused(
            &grains(&format!("Arch(material: \"grain\", {fields})")),
            &[sentence],
        );
    };
    of(
        "blocks: ‸1, radius: 0.03, thickness: 0.005",
        "an arch has 2 to 10000 blocks, got 1",
    );
    of(
        "blocks: 5, radius: 0.03, thickness: ‸0.06",
        "below twice the radius (6e-2 m), got 0.06",
    );
    of(
        "blocks: 5, radius: 0.03, thickness: 0.005, span: ‸4.0",
        "at most pi (half a circle), got 4",
    );
}

#[test]
fn voronoi_cells_that_cannot_be() {
    let of = |fields: &str, sentence: &str| {
        refused(
            &grains(&format!("Voronoi(material: \"grain\", {fields})")),
            &[sentence],
        );
    };
    let region = "low: [0.2, 0.03], high: [0.3, 0.06]";
    of(
        &format!("size: ‸-0.01, {region}"),
        "a length must be positive, got -0.01",
    );
    of(
        &format!("size: ‸1e-6, {region}"),
        "would hold 3.000e9 cells of this size",
    );
    of(
        &format!("size: ‸0.1, {region}"),
        "wider and higher than half of that",
    );
    of(
        "size: 0.01, low: [0.2, 0.03], high: ‸[0.3, 0.03]",
        "the region has no area",
    );
    of(
        "size: 0.01, low: [0.0, 0.03], high: ‸[0.5, 0.06]",
        "wider than the period `periodic.x` (4e-1 m)",
    );
    of(
        &format!("size: 0.01, rounds: ‸100000, {region}"),
        "at most 1000 rounds",
    );
    of(
        &format!("size: 0.01, gap: ‸-1e-4, {region}"),
        "must not be negative, got -0.0001",
    );
    of(
        &format!("size: 0.01, rounding: ‸0.02, {region}"),
        "leaves nothing of the thinnest cell; make them smaller",
    );
    of(
        "size: 0.01, low: ‸[0.2, 0.03, 0.0], high: [0.3, 0.06]",
        "3 components in a case of dimension 2",
    );
}

#[test]
fn walls_that_cannot_be() {
    let of = |fields: &str, sentence: &str| {
        refused(
            &grains(&format!("BlockWall(material: \"grain\", {fields})")),
            &[sentence],
        );
    };
    of(
        "rows: 2, columns: ‸0, block: (0.02, 0.01)",
        "a wall has at least one",
    );
    of(
        "rows: 2, columns: 3, block: (0.02, ‸0.0)",
        "a length must be positive, got 0",
    );
    of(
        "rows: 2, columns: 3, block: (0.02, 0.01), gap: ‸0.02",
        "must be smaller than a block (2e-2 m), got 2e-2",
    );
    of(
        "rows: ‸100000000, columns: 3, block: (0.02, 0.01)",
        "400000000 blocks are too many",
    );
}

#[test]
fn voronoi_cells_in_space() {
    let of = |fields: &str, sentence: &str| {
        let cells = format!("    grains: [Voronoi(material: \"grain\", {fields}), ");
        refused(&with(SOLID, "    grains: [", &cells), &[sentence]);
    };
    let region = "low: [0.2, 0.03, 0.2], high: [0.3, 0.06, 0.3]";
    of(
        &format!("size: ‸1e-5, {region}"),
        "would hold 3.000e11 cells of this size",
    );
    of(
        &format!("size: ‸0.1, {region}"),
        "wider and higher and deeper than half of that",
    );
    of(
        "size: 0.01, low: [0.2, 0.03, 0.2], high: ‸[0.3, 0.06, 0.2]",
        "the region has no volume",
    );
    of(
        &format!("size: 0.01, rounding: ‸0.02, {region}"),
        "take 2e-2 m off each face, which leaves nothing of the thinnest cell",
    );
    of(
        &format!("size: 0.01, gap: ‸0.04, {region}"),
        "take 2e-2 m off each face, which leaves nothing of the thinnest cell",
    );
    of(
        "size: 0.01, low: ‸[0.2, 0.03], high: [0.3, 0.06, 0.3]",
        "2 components in a case of dimension 3",
    );
}

#[test]
fn walls_in_space() {
    let of = |case: &str, list: &str, sentence: &str| {
        let more = format!("    grains: [{list}, ");
        refused(&with(case, "    grains: [", &more), &[sentence]);
    };
    let wall = "BlockWall(material: \"grain\", rows: 2, columns: 3, block: (0.02, 0.01)";
    let says = "has a `thickness` in three dimensions, and in three alone";
    of(SOLID, &format!("‸{wall})"), says);
    of(PLANE, &format!("‸{wall}, thickness: 0.1)"), says);
    of(
        SOLID,
        &format!("{wall}, thickness: ‸-0.1)"),
        "a length must be positive, got -0.1",
    );
}

#[test]
fn polygons_in_space() {
    let of = |shape: &str, sentence: &str| {
        let body = format!(
            "    bodies: [\n        (name: \"rod\", material: \"grain\", shapes: [{shape}]),\n"
        );
        refused(&with(SOLID, "    bodies: [\n", &body), &[sentence]);
    };
    of(
        "‸Polygon(points: [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)])",
        "need two dimensions; use polyhedra in three",
    );
    of(
        "Capsule(from: ‸(0.0, 0.0), to: (0.0, 1.0), radius: 0.01)",
        "2 components in a case of dimension 3",
    );
}

#[test]
fn polyhedra_that_are_none() {
    let of = |grain: &str, sentence: &str| {
        let list = format!("Polyhedra(material: \"grain\", grains: [{grain}])");
        let more = format!("    grains: [{list}, ");
        refused(&with(SOLID, "    grains: [", &more), &[sentence]);
    };
    let cube = "(0.0, 0.0, 0.0), (0.01, 0.0, 0.0), (0.0, 0.01, 0.0), (0.0, 0.0, 0.01)";
    let at = "at: [0.3, 0.1, 0.3]";
    of(
        &format!("‸({at})"),
        "needs one of `points`, `size` (a cuboid) and `file`",
    );
    of(
        &format!("({at}, points: ‸[(0.0, 0.0, 0.0), (0.01, 0.0, 0.0), (0.0, 0.01, 0.0)])"),
        "needs at least four points, got 3",
    );
    of(
        &format!("({at}, points: ‸[{cube}, (0.002, 0.002, 0.002)])"),
        "point 4 of the polyhedron is not a corner of the convex hull",
    );
    of(
        &format!("({at}, points: ‸[{cube}, (0.0, 0.0, 0.01)])"),
        "points 3 and 4 of the polyhedron are at the same place",
    );
    of(
        &format!(
            "({at}, points: ‸[(0.0, 0.0, 0.0), (0.01, 0.0, 0.0), (0.0, 0.01, 0.0), (0.01, 0.01, 0.0)])"
        ),
        "lie in one plane",
    );
    of(
        &format!("({at}, size: ‸(0.01, 0.0, 0.01))"),
        "the edges of a cuboid must be positive",
    );
    of(
        &format!("({at}, size: (0.01, 0.01, 0.01), rounding: ‸-1.0)"),
        "must not be negative, got -1",
    );
    of(
        &format!("({at}, file: ‸\"missing.stl\")"),
        "there is no such file",
    );
    of(
        &format!("({at}, file: ‸\"case.ron\")"),
        "neither an .stl nor an .obj file",
    );
}

#[test]
fn a_body_in_space_that_turns_about_one_axis() {
    let body = "    bodies: [\n        (name: \"rod\", material: \"grain\", shapes: [Box(size: (0.1, 0.1, 0.1))], position: [0.3, 0.1, 0.4], dofs: ‸(x: Free, y: Free, z: Free, rx: Free)),\n";
    refused(
        &with(SOLID, "    bodies: [\n", body),
        &["turns freely about all axes or about none"],
    );
}
