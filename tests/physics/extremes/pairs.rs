//! Every pair of shapes at displacements of 0.3 to 100 radii in a step, from the side, turning, with either of them moving: a grain
//! stays in front of what it meets, or the run says that it may not have.

use super::bench::{Sketch, place};
use fretwork::scene::build::Dimensional;
use fretwork::step::{Simulation, Steps};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use std::f64::consts::TAU;

/// Radius of the grains (m), and the step (s).
const R: f64 = 0.01;
const STEP: f64 = 1e-3;
/// Displacements in a step, in radii.
const SPEEDS: [f64; 9] = [0.3, 0.7, 1.1, 1.5, 2.3, 5.0, 10.7, 31.0, 100.0];
/// Steps after the one of the meeting.
const AFTER: usize = 3;

/// A grain from its place, its motion, and an angle by which it is turned.
type Grain = fn(at: &str, motion: &str, turned: f64) -> String;

/// What a grain is thrown at: a body that is solid below the height zero.
struct Wall {
    name: &'static str,
    shapes: String,
    /// Origin of its frame: along x, out of plane and upwards (m).
    origin: [f64; 3],
    /// It ends at this distance along x from the place that is hit (m): what is beyond has left it sideways.
    half: f64,
}

impl Wall {
    fn new(name: &'static str, shapes: impl Into<String>) -> Self {
        Self {
            name,
            shapes: shapes.into(),
            origin: [0.0; 3],
            half: f64::INFINITY,
        }
    }

    fn ends_at(mut self, half: f64) -> Self {
        self.half = half;
        self
    }

    fn at(mut self, x: f64, across: f64, up: f64) -> Self {
        self.origin = [x, across, up];
        self
    }
}

/// A throw: displacement in a step (m), its direction from the vertical (rad), distance from the place that is hit (m), angle of the
/// grain and its rate (rad, rad/s), and whether the wall moves instead.
struct Throw {
    step: f64,
    tilt: f64,
    from: f64,
    turned: f64,
    spin: f64,
    wall_moves: bool,
}

impl Throw {
    fn any(rng: &mut Pcg64, speed: f64) -> Self {
        let step = speed * R;
        let tilt: f64 = rng.random_range(-1.0..1.0);
        Self {
            step,
            tilt,
            // The whole grain is in front.
            from: 1.4 * R / tilt.cos() + rng.random_range(0.0..2.0) * step.max(R),
            turned: rng.random_range(0.0..TAU),
            spin: rng.random_range(-0.5..0.5f64) * speed.min(1.0) / STEP,
            wall_moves: rng.random_range(0.0..1.0) < 0.3,
        }
    }

    /// Whether grains of this reach are still apart at the first detection, half a step after the start, `distance` being that of their
    /// centres along the throw, and `reach` what they need of it (m): then all of the meeting is seen.
    fn is_seen(&self, distance: f64, reach: f64) -> bool {
        distance - 0.5 * self.step > reach
    }

    /// Returns whether the grain is held, or the end that the run is silent about. Balls that are seen are held.
    fn run<S: Dimensional + Steps>(
        &self,
        name: &str,
        grain: Grain,
        wall: &Wall,
    ) -> Result<bool, String> {
        let way = [self.tilt.sin(), -self.tilt.cos()];
        let at = place::<S>(-self.from * way[0], 0.003, -self.from * way[1]);
        let speed = self.step / STEP;
        let v = place::<S>(speed * way[0], 0.0, speed * way[1]);
        let spin = match S::D {
            2 => format!("[{:?}]", self.spin),
            _ => format!("[{0:?}, {1:?}, {0:?}]", 0.5 * self.spin, self.spin),
        };
        let (mut motion, mut dofs) = (String::new(), String::new());
        if self.wall_moves {
            let up = if S::D == 2 { "y" } else { "z" };
            let drive = |k: usize| format!("Velocity(Constant({:?}))", -speed * way[k]);
            dofs = format!("dofs: (x: {}, {up}: {}),", drive(0), drive(1));
        } else {
            motion = format!(", velocity: {v}, spin: {spin}");
        }
        let sketch = Sketch {
            step: STEP,
            gravity: 0.0,
            bodies: format!(
                "(name: \"wall\", material: \"m0\", position: {}, shapes: [{}], {dofs}),",
                {
                    let [x, across, up] = wall.origin;
                    place::<S>(x, across, up)
                },
                wall.shapes
            ),
            grains: grain(&at, &motion, self.turned),
            ..Sketch::default()
        };
        let what = || {
            format!(
                "{name} on {}: {:.2} radii a step, tilt {:.3}, from {:.3} radii, turned {:.3}, spin {:.2}, wall moves: {}",
                wall.name,
                self.step / R,
                self.tilt,
                self.from / R,
                self.turned,
                self.spin,
                self.wall_moves
            )
        };
        let mut s: Simulation<S> = sketch.build().unwrap_or_else(|e| panic!("{}: {e}", what()));
        let last = S::D - 1;
        let body = s.state.bodies.driven[0].body as usize;
        let ground = s.state.bodies.position[body][last];
        for _ in 0..(self.from / self.step).ceil() as usize + AFTER {
            s.step().unwrap_or_else(|e| panic!("{}: {e}", what()));
        }
        let grain = s.state.bodies.grains().next().expect("a grain");
        let apart = s.state.bodies.position[grain] - s.state.bodies.position[body];
        let height = if wall.name == "drum" {
            wall.origin[2] - apart[0].hypot(apart[last])
        } else {
            apart[last] + ground
        };
        if s.state.network.step_size.warning().is_some() {
            // All walls are flat at this scale, and below zero. Others than balls may touch by a corner that turns.
            let ball = ["disk", "sphere"].contains(&name);
            match ball && self.is_seen(self.from, R / self.tilt.cos()) {
                true => Err(format!("{}; told, although it is seen", what())),
                false => Ok(false),
            }
        } else if height > 0.0 || (apart[0] + wall.origin[0]).abs() > wall.half {
            Ok(true)
        } else {
            Err(format!("{}; ends at {:.2} radii", what(), height / R))
        }
    }
}

/// Throws each grain at each wall, `times` times at each speed. What meets before the first detection may be told, and what
/// turns a corner into the wall; all others are held.
fn throw_all<S: Dimensional + Steps>(grains: &[(&str, Grain)], walls: &[Wall], times: usize) {
    let mut rng = Pcg64::seed_from_u64(19);
    let mut silent = Vec::new();
    let (mut all_held, mut all_told) = (0, 0);
    for wall in walls {
        for (name, grain) in grains {
            let (mut held, mut told) = (0, 0);
            for speed in SPEEDS {
                for _ in 0..times {
                    match Throw::any(&mut rng, speed).run::<S>(name, *grain, wall) {
                        Ok(true) => held += 1,
                        Ok(false) => told += 1,
                        Err(e) => silent.push(e),
                    }
                }
            }
            println!("{name} on {}: {held} held, {told} told", wall.name);
            (all_held, all_told) = (all_held + held, all_told + told);
        }
    }
    assert!(
        silent.is_empty(),
        "{} not held:\n{}",
        silent.len(),
        silent.join("\n")
    );
    // A quarter of the places to start from are nearer than half of a step, if that is long.
    assert!(
        4 * all_told < all_held + all_told,
        "{all_held} held, {all_told} told"
    );
}

/// Heights of a bumpy line or field, of some tenths of a radius.
fn bumps(rng: &mut Pcg64) -> f64 {
    rng.random_range(-0.2..0.0) * R
}

const FLAT: [(&str, Grain); 6] = [
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
    throw_all::<fretwork::geometry::space::Dim2>(&FLAT, &flat_walls(), 6);
}

const SOLID: [(&str, Grain); 6] = [
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

/// Triangles of a sheet of squares with these heights, and of a closed plate of this thickness (m), as text of an STL file.
fn stl(name: &str, triangles: &[[[f64; 3]; 3]]) -> std::path::PathBuf {
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
    let path =
        std::env::temp_dir().join(format!("fretwork-pairs-{}-{name}.stl", std::process::id()));
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

fn solid_walls(files: &mut Vec<std::path::PathBuf>) -> Vec<Wall> {
    let mut rng = Pcg64::seed_from_u64(8);
    let heights: Vec<f64> = (0..41 * 41).map(|_| bumps(&mut rng)).collect();
    let texts: Vec<String> = heights.iter().map(|h| format!("{h:?}")).collect();
    let flat = sheet(|_, _| 0.0, 1, 9.0);
    let bumpy = sheet(
        |i, j| heights[((i + 20) * 41 + j + 20) as usize],
        20,
        0.9 * R,
    );
    // Top, bottom and sides of a plate that is thinner than the grains.
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
    let mut mesh = |name: &'static str, triangles: &[[[f64; 3]; 3]]| {
        let path = stl(name, triangles);
        let wall = Wall::new(name, format!("Mesh(file: \"{}\")", path.display()));
        files.push(path);
        wall
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
    let mut files = Vec::new();
    let walls = solid_walls(&mut files);
    throw_all::<fretwork::geometry::space::Dim3>(&SOLID, &walls, 3);
    for file in files {
        let _ = std::fs::remove_file(file);
    }
}

/// Throws each grain at the middle of each other one, half of the time across a period: what it is thrown at is hit, or the run says
/// that it may not have been.
fn throw_at_each_other<S: Dimensional + Steps>(grains: &[(&str, Grain)]) {
    let mut rng = Pcg64::seed_from_u64(20);
    let mut silent = Vec::new();
    let (mut hit, mut told) = (0, 0);
    for (one, thrown) in grains {
        for (other, target) in grains {
            for (k, speed) in SPEEDS.into_iter().enumerate() {
                let throw = Throw::any(&mut rng, speed);
                let from = throw.from + 1.1 * R;
                let period = 2.5 * (from + 4.0 * throw.step).max(0.2);
                let across = k % 2 == 0;
                // The target is beside the border of the period, over which it is hit.
                let x = if across { 0.5 * period - 0.5 * R } else { 0.0 };
                let start = if across { x + from - period } else { x + from };
                let v = place::<S>(-throw.step / STEP, 0.0, 0.0);
                let spin = match S::D {
                    2 => format!("[{:?}]", throw.spin),
                    _ => format!("[0.0, {:?}, 0.0]", throw.spin),
                };
                let sketch = Sketch {
                    step: STEP,
                    gravity: 0.0,
                    grains: thrown(
                        &place::<S>(start, 0.0, 0.0),
                        &format!(", velocity: {v}, spin: {spin}"),
                        throw.turned,
                    ) + &target(&place::<S>(x, 0.0, 0.0), "", 0.7 * throw.turned),
                    more: if across {
                        format!("periodic: (x: {period:?}),")
                    } else {
                        String::new()
                    },
                    ..Sketch::default()
                };
                let what = format!(
                    "{one} on {other}: {speed} radii a step, from {:.3} radii, turned {:.3}, spin {:.2}, across a period: {across}",
                    from / R,
                    throw.turned,
                    throw.spin
                );
                let mut s: Simulation<S> = sketch.build().unwrap_or_else(|e| panic!("{what}: {e}"));
                for _ in 0..(from / throw.step).ceil() as usize + AFTER {
                    s.step().unwrap_or_else(|e| panic!("{what}: {e}"));
                }
                let [slower, faster] = {
                    let speeds = s
                        .state
                        .bodies
                        .grains()
                        .map(|b| -s.state.bodies.velocity[b][0]);
                    let mut speeds: Vec<f64> = speeds.collect();
                    speeds.sort_by(f64::total_cmp);
                    [speeds[0], speeds[1]]
                };
                if s.state.network.step_size.warning().is_some() {
                    told += 1;
                } else if slower != 0.0 && faster != throw.step / STEP {
                    hit += 1;
                } else {
                    silent.push(what);
                }
            }
        }
    }
    println!("{}D: {hit} hit, {told} told", S::D);
    // Two turning grains start within half of a step of each other more often than one and a wall.
    assert!(5 * told < 2 * (hit + told), "{hit} hit, {told} told");
    assert!(
        silent.is_empty(),
        "{} not hit:\n{}",
        silent.len(),
        silent.join("\n")
    );
}

#[test]
fn grains_meet_each_other() {
    throw_at_each_other::<fretwork::geometry::space::Dim2>(&FLAT);
    throw_at_each_other::<fretwork::geometry::space::Dim3>(&SOLID);
}
