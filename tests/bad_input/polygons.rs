//! Convex polygons, capsules and arches.

use crate::trial::{PLANE, SOLID, refused, with};

/// The plane case with these grains beside its own.
fn grains(more: &str) -> String {
    with(
        PLANE,
        "    grains: [\n",
        &format!("    grains: [\n{more},\n"),
    )
}

/// The plane case with this shape as its lid.
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
        "against the clock; turn their order",
    );
    of("(0.0, 0.0), (0.01, 0.0), (0.02, 0.0)", "lie on one line");
    of(
        "(0.0, 0.0), (0.02, 0.0), (0.005, 0.005), (0.0, 0.02)",
        "not convex at point 2; make it of several convex ones",
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
        "an arch has 2 to 1000000 blocks, got 1",
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
    let cells =
        "‸Voronoi(material: \"grain\", size: 0.1, low: [0.0, 0.0, 0.0], high: [1.0, 1.0, 1.0])";
    refused(
        &with(SOLID, "    grains: [", &format!("    grains: [{cells}, ")),
        &["need two dimensions; use a Deposit of balls in three"],
    );
}

#[test]
fn polygons_in_space() {
    let capsule = "‸Capsule(from: (0.0, 0.0), to: (0.0, 1.0), radius: 0.01)";
    let body = format!(
        "    bodies: [\n        (name: \"rod\", material: \"grain\", shapes: [{capsule}]),\n"
    );
    refused(
        &with(SOLID, "    bodies: [\n", &body),
        &["need two dimensions; use Balls in three"],
    );
}
