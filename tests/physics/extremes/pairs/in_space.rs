//! Grains and walls in 3D.

use super::*;

pub(super) const SOLID: [(&str, Grain); 6] = [
    ("sphere", |at, motion, _| {
        format!("List(material: \"m0\", grains: [(at: {at}, radius: 0.01{motion})]),")
    }),
    ("cube", |at, motion, turned| {
        format!(
            "Polyhedra(material: \"m0\", grains: [(at: {at}, size: (0.0115, 0.0115, 0.0115), turned: [{turned:?}, 0.3, 0.0]{motion})]),"
        )
    }),
    ("tetrahedron", |at, motion, turned| {
        format!(
            "Polyhedra(material: \"m0\", grains: [(at: {at}, points: [(0.0057, 0.0057, 0.0057), (-0.0057, -0.0057, 0.0057), \
             (-0.0057, 0.0057, -0.0057), (0.0057, -0.0057, -0.0057)], turned: [0.4, {turned:?}, 0.0]{motion})]),"
        )
    }),
    ("rounded plate", |at, motion, turned| {
        format!(
            "Polyhedra(material: \"m0\", grains: [(at: {at}, size: (0.011, 0.011, 0.002), rounding: 0.001, \
             turned: [{turned:?}, 0.0, 0.5]{motion})]),"
        )
    }),
    ("capsule", |at, motion, turned| {
        let (c, s) = (0.007 * turned.cos(), 0.007 * turned.sin());
        format!(
            "Clusters(material: \"m0\", grains: [(at: {at}, shapes: [Capsule(from: ({:?}, 0.0, {:?}), to: ({c:?}, 0.0, {s:?}), \
             radius: 0.003)]{motion})]),",
            -c, -s
        )
    }),
    ("dumbbell", |at, motion, turned| {
        let (c, s) = (0.006 * turned.cos(), 0.006 * turned.sin());
        format!(
            "Clusters(material: \"m0\", grains: [(at: {at}, shapes: [Balls([([{:?}, 0.0, {:?}], 0.004), ([{c:?}, 0.0, {s:?}], \
             0.004)])]{motion})]),",
            -c, -s
        )
    }),
];

/// A folder for the files of one test, since tests of one process run in parallel.
fn new_folder(test: &str) -> std::path::PathBuf {
    let name = format!("fretwork-pairs-{}-{test}", std::process::id());
    let folder = std::env::temp_dir().join(name);
    std::fs::create_dir_all(&folder).expect("a folder");
    folder
}

/// Triangles of a sheet of squares with these heights, and of a closed plate of this thickness (m),
/// as text of an STL file.
fn stl(folder: &std::path::Path, name: &str, triangles: &[[[f64; 3]; 3]]) -> std::path::PathBuf {
    use std::fmt::Write as _;
    let mut text = String::from("solid s\n");
    for t in triangles {
        text.push_str("facet normal 0 0 0\nouter loop\n");
        for [x, y, z] in t {
            let _ = writeln!(text, "vertex {x:e} {y:e} {z:e}");
        }
        text.push_str("endloop\nendfacet\n");
    }
    text.push_str("endsolid s\n");
    let path = folder.join(format!("{name}.stl"));
    std::fs::write(&path, text).expect("a file");
    path
}

/// Squares of a side of 2 m about the origin, cut in two; seen from above.
fn sheet(height: impl Fn(i32, i32) -> f64, half: i32, side: f64) -> Vec<[[f64; 3]; 3]> {
    let at = |i: i32, j: i32| [side * f64::from(i), side * f64::from(j), height(i, j)];
    let mut out = Vec::new();
    for i in -half..half {
        for j in -half..half {
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            out.extend([[a, b, c], [a, c, d]]);
        }
    }
    out
}

/// The files of meshes are written into this folder.
fn solid_walls(folder: &std::path::Path) -> Vec<Wall> {
    let mut rng = Pcg64::seed_from_u64(8);
    let heights: Vec<f64> = (0..41 * 41).map(|_| bumps(&mut rng)).collect();
    let texts: Vec<String> = heights.iter().map(|h| format!("{h:?}")).collect();
    let flat = sheet(|_, _| 0.0, 1, 9.0);
    let bumpy = sheet(
        |i, j| heights[((i + 20) * 41 + j + 20) as usize],
        20,
        0.9 * R,
    );
    // The mesh has top, bottom and sides of a plate that is thinner than the grains.
    let depth = -0.4 * R;
    let mut plate = flat.clone();
    plate.extend(
        flat.iter()
            .map(|[a, b, c]| [*c, *b, *a].map(|[x, y, _]| [x, y, depth])),
    );
    let rim = [
        (-1, -1),
        (0, -1),
        (1, -1),
        (1, 0),
        (1, 1),
        (0, 1),
        (-1, 1),
        (-1, 0),
    ];
    for k in 0..8 {
        let [p, q] =
            [rim[k], rim[(k + 1) % 8]].map(|(i, j)| [9.0 * f64::from(i), 9.0 * f64::from(j)]);
        let [[a, b], [c, d]] = [p, q].map(|[x, y]| [[x, y, 0.0], [x, y, depth]]);
        plate.extend([[a, b, c], [b, d, c]]);
    }
    let mesh = |name: &'static str, triangles: &[[[f64; 3]; 3]]| {
        let path = stl(folder, name, triangles);
        Wall::new(name, format!("Mesh(file: \"{}\")", path.display()))
    };
    let row: Vec<String> = (-9..=9)
        .flat_map(|i| {
            (-9..=9).map(move |j| {
                format!(
                    "([{:?}, {:?}, {:?}], 0.02)",
                    0.018 * f64::from(i),
                    0.018 * f64::from(j),
                    -0.02
                )
            })
        })
        .collect();
    vec![
        Wall::new("half-space", "HalfSpace(normal: [0.0, 0.0, 1.0])"),
        mesh("sheet", &flat),
        mesh("bumpy sheet", &bumpy).ends_at(0.18),
        mesh("plate", &plate),
        Wall::new(
            "flat field",
            "HeightField(points: (3, 3), spacing: (9.0, 9.0), heights: [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0])",
        )
        .at(-9.0, -9.0, 0.0),
        Wall::new(
            "field",
            format!("HeightField(points: (41, 41), spacing: (0.011, 0.009), heights: [{}])", texts.join(", ")),
        )
        .at(-0.22, -0.18, 0.0)
        .ends_at(0.22),
        Wall::new("drum", "Drum(radius: 5.0, axis: 1)").at(0.0, 0.0, 5.0),
        Wall::new("block", "Box(size: (18.0, 18.0, 0.1))").at(0.0, 0.0, -0.05),
        Wall::new("thin block", "Box(size: (18.0, 18.0, 0.002))").at(0.0, 0.0, -0.001),
        Wall::new("plate of balls", format!("Balls([{}])", row.join(", "))),
    ]
}

#[test]
fn grains_stay_in_front_of_every_wall_in_space() {
    let folder = new_folder("rigid");
    let walls = solid_walls(&folder);
    throw_all::<Dim3>(&SOLID, None, &walls, &SPEEDS, 3);
    let _ = std::fs::remove_dir_all(folder);
}

/// Walls in 3D that deform or wear; [`flat_soft_walls`] has those in 2D.
pub(super) fn solid_soft_walls() -> Vec<Wall> {
    let mut rng = Pcg64::seed_from_u64(10);
    let heights: Vec<String> = (0..41 * 41)
        .map(|_| format!("{:?}", bumps(&mut rng)))
        .collect();
    let field = format!(
        "HeightField(points: (41, 41), spacing: (0.011, 0.009), heights: [{}])",
        heights.join(", ")
    );
    // The first grains do not fit between four points.
    let mesh = |touches: &str| {
        format!(
            "mesh: Block(x: (from: -0.039, to: 0.065, size: 0.0065), y: (from: -0.0585, to: 0.0325, size: 0.0065), \
             z: (from: -0.013, to: 0.0, size: 0.0065)), touches: {touches}"
        )
    };
    let cells = |touches: &str| {
        format!(
            "x: (from: -0.048, to: 0.08, size: 0.008), y: (from: -0.064, to: 0.048, size: 0.008), touches: {touches}"
        )
    };
    let mut walls = vec![
        Wall::new("points of a plate", mesh("Points(\"top\")")).made(Made::Elements(1e9)),
        Wall::new("points of a half-space", cells("Points")).made(Made::HalfSpace(1e9)),
        Wall::new("plate", mesh("Surface(\"top\")")).made(Made::Elements(1e9)),
        Wall::new("half-space", cells("Surface")).made(Made::HalfSpace(1e9)),
    ];
    walls.extend([
        Wall::new("worn field", field.clone())
            .at(-0.22, -0.18, 0.0)
            .made(Made::Worn(2.0 * R)),
        Wall::new("wearing field", field)
            .at(-0.22, -0.18, 0.0)
            .made(Made::Wearing(0.05)),
    ]);
    walls.into_iter().map(|w| w.ends_at(R)).collect()
}

#[test]
fn grains_stay_in_front_of_what_deforms_and_wears_in_space() {
    let walls = solid_soft_walls();
    throw_all::<Dim3>(&SOLID[..2], None, &walls[..2], &SOFT_SPEEDS, 2);
    throw_all::<Dim3>(&SOLID, None, &walls[2..], &SOFT_SPEEDS, 2);
}

#[test]
fn grains_that_deform_stay_in_front_of_every_wall_in_space() {
    let folder = new_folder("deform");
    let walls = solid_walls(&folder);
    throw_all::<Dim3>(&SOLID[..2], Some(1e9), &walls[..8], &SOFT_SPEEDS, 1);
    let _ = std::fs::remove_dir_all(folder);
}
