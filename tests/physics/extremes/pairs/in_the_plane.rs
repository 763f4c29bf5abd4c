//! Grains and walls in 2D.

use super::*;

pub(super) const FLAT: [(&str, Grain); 6] = [
    ("disk", |at, motion, _| {
        format!("List(material: \"m0\", grains: [(at: {at}, radius: 0.01{motion})]),")
    }),
    ("pentagon", |at, motion, turned| {
        format!(
            "Polygons(material: \"m0\", grains: [(at: {at}, regular: (5, 0.01), angle: {turned:?}{motion})]),"
        )
    }),
    ("triangle", |at, motion, turned| {
        format!(
            "Polygons(material: \"m0\", grains: [(at: {at}, regular: (3, 0.01), angle: {turned:?}{motion})]),"
        )
    }),
    ("rounded plate", |at, motion, turned| {
        format!(
            "Polygons(material: \"m0\", grains: [(at: {at}, points: [(-0.008, -0.001), (0.008, -0.001), (0.008, 0.001), \
             (-0.008, 0.001)], rounding: 0.001, angle: {turned:?}{motion})]),"
        )
    }),
    ("capsule", |at, motion, turned| {
        let (c, s) = (0.007 * turned.cos(), 0.007 * turned.sin());
        format!(
            "Clusters(material: \"m0\", grains: [(at: {at}, shapes: [Capsule(from: ({:?}, {:?}), to: ({c:?}, {s:?}), \
             radius: 0.003)]{motion})]),",
            -c, -s
        )
    }),
    ("cross", |at, motion, _| {
        format!(
            "Clusters(material: \"m0\", grains: [(at: {at}, shapes: [Polygon(points: [(-0.009, -0.002), (0.009, -0.002), \
             (0.009, 0.002), (-0.009, 0.002)]), Polygon(points: [(-0.002, -0.009), (0.002, -0.009), (0.002, 0.009), \
             (-0.002, 0.009)])]{motion})]),"
        )
    }),
];

fn flat_walls() -> Vec<Wall> {
    let mut rng = Pcg64::seed_from_u64(7);
    let rough: Vec<String> = (-40..=40)
        .map(|k| format!("({:?}, {:?})", 0.7 * R * f64::from(k), bumps(&mut rng)))
        .collect();
    let row: Vec<String> = (-60..=60)
        .map(|k| format!("([{:?}, {:?}], 0.01)", 0.9 * R * f64::from(k), -R))
        .collect();
    vec![
        Wall::new("half-space", "HalfSpace(normal: [0.0, 1.0])"),
        Wall::new(
            "line",
            "Profile(points: [(-9.0, 0.0), (-0.2, 0.0), (0.3, 0.0), (9.0, 0.0)], side: Below)",
        ),
        Wall::new(
            "profile",
            format!(
                "Profile(points: [(-9.0, 0.0), {}, (9.0, 0.0)], side: Below)",
                rough.join(", ")
            ),
        ),
        Wall::new("drum", "Drum(radius: 5.0)").at(0.0, 0.0, 5.0),
        Wall::new(
            "block",
            "Polygon(points: [(-9.0, -0.05), (9.0, -0.05), (9.0, 0.0), (-9.0, 0.0)])",
        ),
        Wall::new(
            "blade",
            "Polygon(points: [(-9.0, -0.002), (9.0, -0.002), (9.0, 0.0), (-9.0, 0.0)])",
        ),
        Wall::new("row of disks", format!("Balls([{}])", row.join(", "))),
    ]
}

#[test]
fn grains_stay_in_front_of_every_wall_in_the_plane() {
    throw_all::<Dim2>(&FLAT, None, &flat_walls(), &SPEEDS, 6);
}

/// Walls that deform and wear. Deformable walls are not hit in their middle, whose motion
/// represents that of the whole.
pub(super) fn flat_soft_walls() -> Vec<Wall> {
    let mut rng = Pcg64::seed_from_u64(9);
    let rough: Vec<String> = (-40..=40)
        .map(|k| format!("({:?}, {:?})", 0.7 * R * f64::from(k), bumps(&mut rng)))
        .collect();
    let profile = format!("Profile(points: [{}], side: Below)", rough.join(", "));
    // A rounded plate, the thinnest grain, does not fit between two points.
    let size = 0.0036;
    let mesh = |touches: &str| {
        format!(
            "mesh: Block(x: (from: -0.1, to: 0.152, size: {size}), y: (from: -0.0288, to: 0.0, size: {size})), touches: {touches}"
        )
    };
    let cells = |touches: &str| {
        format!("x: (from: -0.1, to: 0.152, size: {size}), depth: 0.3, touches: {touches}")
    };
    let (surface, points) = (mesh("Surface(\"top\")"), mesh("Points(\"top\")"));
    let mut walls = Vec::new();
    for (stiff, young) in [(true, 1e11), (false, 1e8)] {
        let name = |stiff_name, soft_name| if stiff { stiff_name } else { soft_name };
        let elements = Made::Elements(young);
        let half_space = Made::HalfSpace(young);
        walls.extend([
            Wall::new(name("stiff plate", "soft plate"), surface.clone()).made(elements),
            Wall::new(
                name("points of a stiff plate", "points of a soft plate"),
                points.clone(),
            )
            .made(elements),
            Wall::new(
                name("stiff half-space", "soft half-space"),
                cells("Surface"),
            )
            .made(half_space),
            Wall::new(
                name(
                    "points of a stiff half-space",
                    "points of a soft half-space",
                ),
                cells("Points"),
            )
            .made(half_space),
        ]);
    }
    walls.extend([
        Wall::new("worn profile", profile.clone()).made(Made::Worn(2.0 * R)),
        Wall::new("wearing profile", profile).made(Made::Wearing(0.05)),
    ]);
    walls.into_iter().map(|w| w.ends_at(R)).collect()
}

#[test]
fn grains_stay_in_front_of_what_deforms_and_wears_in_the_plane() {
    throw_all::<Dim2>(&FLAT, None, &flat_soft_walls(), &SOFT_SPEEDS, 3);
}

#[test]
fn grains_that_deform_stay_in_front_of_every_wall_in_the_plane() {
    // A blade is so thin that the deformation of a grain counts as passing it.
    throw_all::<Dim2>(&FLAT[..3], Some(1e9), &flat_walls()[..5], &SOFT_SPEEDS, 3);
}
