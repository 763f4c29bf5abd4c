//! Every pair of shapes at displacements of 0.3 to 100 radii in a step, from the side, turning, with either of them moving: a grain
//! stays in front of what it meets, or the run says that it may not have. The same of what deforms and what wears, up to ten radii a
//! step.

use super::bench::{Sketch, place, up, volume};
use fretwork::geometry::space::{Dim2, Dim3, Space};
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
/// The same where something deforms or wears.
const SOFT_SPEEDS: [f64; 5] = [0.1, 0.4, 1.4, 3.0, 10.0];
/// Steps after the one of the meeting.
const AFTER: usize = 3;
/// How far a centre may be behind the nearest vertex of a surface that is not flat (radii).
const BEHIND: f64 = 0.2;
/// One of how many throws may be told although all of it is seen: what is hit at a corner turns by about its displacement over its
/// radius, and its corners move on arcs of which a step knows the tangents.
const SEEN_TOLD: usize = 8;
/// Share of the energy that a throw may gain by the error of the solver.
const GAIN: f64 = 1e-6;

/// A grain from its place, its motion, and an angle by which it is turned.
type Grain = fn(at: &str, motion: &str, turned: f64) -> String;

/// What a wall is made of.
#[derive(Clone, Copy, PartialEq)]
enum Made {
    /// A first body of shapes.
    Rigid,
    /// The same, whose surface recedes by up to this depth (m) before it is hit and while it is.
    Worn(f64),
    /// The same, which wears by the law of the interface: in a hit by about this share of the grain.
    Wearing(f64),
    /// A body of finite elements, held at its bottom, of this Young's modulus (Pa).
    Elements(f64),
    /// An elastic half-space of this Young's modulus (Pa).
    HalfSpace(f64),
}

/// What a grain is thrown at: a body that is solid below the height zero.
struct Wall {
    name: &'static str,
    made: Made,
    /// Its shapes, or its fields if it deforms.
    shapes: String,
    /// Origin of its frame: along x, out of plane and upwards (m).
    origin: [f64; 3],
    /// It ends at this distance along x from the place that is hit (m): what is beyond has left it sideways. Where heights are measured
    /// from vertices, at this distance from the nearest one.
    half: f64,
}

impl Wall {
    fn new(name: &'static str, shapes: impl Into<String>) -> Self {
        Self {
            name,
            made: Made::Rigid,
            shapes: shapes.into(),
            origin: [0.0; 3],
            half: f64::INFINITY,
        }
    }

    fn made(mut self, made: Made) -> Self {
        self.made = made;
        self
    }

    fn ends_at(mut self, half: f64) -> Self {
        self.half = half;
        self
    }

    fn at(mut self, x: f64, across: f64, up: f64) -> Self {
        self.origin = [x, across, up];
        self
    }

    /// Lets the surface of a worn wall recede by this share of its depth, uneven by a tenth of it.
    fn recede<S: Steps>(&self, s: &mut Simulation<S>, share: f64) {
        let Made::Worn(depth) = self.made else { return };
        for surface in &mut s.shapes.surfaces {
            let surface = surface.shape.receding_mut().expect("one that recedes");
            let all: Vec<usize> = (0..surface.vertices().len()).collect();
            let uneven = |k: &usize| share * depth * (0.9 + 0.1 * (*k as f64).sin().abs());
            let depths: Vec<f64> = all.iter().map(uneven).collect();
            surface.recede(&depths, &all);
        }
    }

    /// Height of the centre of a grain above the wall (m); infinite beside it. Of a wall that is not flat, or does not stay so, it is that
    /// above the nearest vertex and what a centre may be behind that.
    fn height<S: Steps>(&self, s: &Simulation<S>, grain: usize) -> f64 {
        let last = S::D - 1;
        let bodies = &s.state.bodies;
        let at = bodies.position[grain];
        if matches!(self.made, Made::Rigid) {
            let apart = at - bodies.position[bodies.driven[0].body as usize];
            return if self.name == "drum" {
                self.origin[2] - apart[0].hypot(apart[last])
            } else if (apart[0] + self.origin[0]).abs() > self.half {
                f64::INFINITY
            } else {
                apart[last] + self.origin[2]
            };
        }
        // What touches by points has no surface.
        let mut vertices: Vec<S::Vector> = Vec::new();
        for surface in &s.shapes.surfaces {
            let origin = bodies.position[surface.body as usize];
            let outline = surface.shape.outline().into_iter().flatten();
            vertices.extend(outline.map(|x| origin + x));
        }
        if vertices.is_empty() {
            let points = s.shapes.balls.iter().filter(|b| b.radius == 0.0);
            vertices.extend(points.map(|b| bodies.position[b.body as usize]));
        }
        let beside = |x: &S::Vector| (0..last).map(|k| (at[k] - x[k]).powi(2)).sum::<f64>();
        let nearest = vertices
            .iter()
            .min_by(|a, b| beside(a).total_cmp(&beside(b)))
            .expect("a vertex");
        if beside(nearest).sqrt() > self.half {
            f64::INFINITY
        } else {
            at[last] - nearest[last] + BEHIND * R
        }
    }
}

/// How a throw ends: held, or told, of one that is all seen or not.
enum End {
    Held,
    Told,
    ToldSeen,
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

    /// Whether grains of this reach are still apart at the first detection, this share of a step after the start, `distance` being that
    /// of their centres along the throw, and `reach` what they need of it (m): then all of the meeting is seen.
    fn is_seen(&self, distance: f64, reach: f64, first: f64) -> bool {
        distance - first * self.step > reach
    }

    /// The scene of a grain that is thrown at a wall, of this Young's modulus (Pa) where it deforms.
    fn sketch<S: Space>(&self, grain: Grain, soft: Option<f64>, wall: &Wall) -> Sketch {
        let way = [self.tilt.sin(), -self.tilt.cos()];
        let at = place::<S>(-self.from * way[0], 0.003, -self.from * way[1]);
        let speed = self.step / STEP;
        let v = place::<S>(speed * way[0], 0.0, speed * way[1]);
        let spin = match S::D {
            2 => format!("[{:?}]", self.spin),
            _ => format!("[{0:?}, {1:?}, {0:?}]", 0.5 * self.spin, self.spin),
        };
        let mut motion = format!(", velocity: {v}, spin: {spin}");
        let mut drives = ["Fixed".to_owned(), "Fixed".to_owned()];
        let mut moves = place::<S>(0.0, 0.0, 0.0);
        if self.wall_moves {
            motion.clear();
            drives = way.map(|part| format!("Velocity(Constant({:?}))", -speed * part));
            moves = place::<S>(-speed * way[0], 0.0, -speed * way[1]);
        }
        let across = if S::D == 2 { "" } else { "y: Fixed, " };
        let drives = format!("x: {}, {across}{}: {}", drives[0], up::<S>(), drives[1]);
        let [x, across, up] = wall.origin;
        let head = format!(
            "name: \"wall\", material: \"m0\", position: {}",
            place::<S>(x, across, up)
        );
        let shapes = &wall.shapes;
        let rigid = |wears: &str| format!("({head}, shapes: [{shapes}], dofs: ({drives}){wears}),");
        let mut sketch = Sketch {
            step: STEP,
            gravity: 0.0,
            grains: grain(&at, &motion, self.turned),
            young: soft,
            ..Sketch::default()
        };
        match wall.made {
            Made::Rigid | Made::Worn(_) => sketch.bodies = rigid(""),
            Made::Wearing(share) => {
                // Force times slip is about the kinetic energy of the grain.
                let energy = 1000.0 * volume::<S>(R) * speed * speed;
                let k = share * volume::<S>(R) / energy;
                sketch.bodies = rigid(", wears: (thickness: 1.0)");
                sketch.interface = "wear: \"archard\",";
                sketch.parameters = format!(", wear: {{\"k\": {k:?}}}");
            }
            Made::Elements(young) => {
                sketch.young = Some(young);
                sketch.more = format!(
                    "elastic: [({head}, {shapes}, velocity: {moves}, supports: [(part: \"bottom\", {drives})])],"
                );
            }
            Made::HalfSpace(young) => {
                sketch.young = Some(young);
                sketch.theta = 1.0;
                sketch.more = format!("half_spaces: [({head}, {shapes}, dofs: ({drives}))],");
            }
        }
        if soft.is_some() {
            // Modes of a sphere of two elements take a second.
            let elements = if S::D == 2 { 2 } else { 1 };
            sketch.more += &format!("elastic_grains: [(material: \"m0\", elements: {elements})],");
        }
        sketch
    }

    /// Throws the grain, and returns whether it is held, or the end that the run is silent about. Balls that are seen are held.
    fn run<S: Dimensional + Steps>(
        &self,
        name: &str,
        grain: Grain,
        soft: Option<f64>,
        wall: &Wall,
    ) -> Result<End, String> {
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
        let sketch = self.sketch::<S>(grain, soft, wall);
        let first = 1.0 - sketch.theta;
        let mut s: Simulation<S> = sketch.build().unwrap_or_else(|e| panic!("{}: {e}", what()));
        let depth = match wall.made {
            Made::Worn(depth) => depth / self.tilt.cos(),
            _ => 0.0,
        };
        let steps = ((self.from + depth) / self.step).ceil() as usize + AFTER;
        let grain = s.state.bodies.grains().next().expect("a grain");
        let start = s.state.energy.initial_kinetic;
        let (mut lowest, mut most) = (f64::INFINITY, 0.0f64);
        wall.recede(&mut s, 0.5);
        for k in 1..=steps {
            s.step().unwrap_or_else(|e| panic!("{}: {e}", what()));
            wall.recede(&mut s, 0.5 + 0.5 * k as f64 / steps as f64);
            lowest = lowest.min(wall.height(&s, grain));
            most = most.max(s.state.energy.kinetic + s.state.energy.elastic);
        }
        if s.state.network.step_size.warning().is_some() {
            // All walls are flat at this scale, and below zero. An impact turns others than balls, and another corner may turn into the
            // wall in the same step.
            let seen = self.is_seen(self.from, R / self.tilt.cos(), first);
            // One that deforms has corners too.
            let ball = soft.is_none() && ["disk", "sphere"].contains(&name);
            match seen && ball {
                true => Err(format!("{}; told, although it is seen", what())),
                false if seen => Ok(End::ToldSeen),
                false => Ok(End::Told),
            }
        } else if lowest <= 0.0 {
            Err(format!("{}; gets to {:.2} radii", what(), lowest / R))
        } else if !self.wall_moves && most > (1.0 + GAIN) * start {
            Err(format!("{}; energy {:.6}", what(), most / start))
        } else {
            Ok(End::Held)
        }
    }
}

/// Throws each grain at each wall, `times` times at each speed. What meets before the first detection may be told, and what
/// turns a corner into the wall; all others are held.
fn throw_all<S: Dimensional + Steps>(
    grains: &[(&str, Grain)],
    soft: Option<f64>,
    walls: &[Wall],
    speeds: &[f64],
    times: usize,
) {
    let mut rng = Pcg64::seed_from_u64(19);
    let mut silent = Vec::new();
    let mut all = [0; 3];
    for wall in walls {
        for (name, grain) in grains {
            let mut ends = [0; 3];
            for speed in speeds {
                for _ in 0..times {
                    match Throw::any(&mut rng, *speed).run::<S>(name, *grain, soft, wall) {
                        Ok(end) => ends[end as usize] += 1,
                        Err(e) => silent.push(e),
                    }
                }
            }
            let [held, told, seen] = ends;
            println!(
                "{name} on {}: {held} held, {told} told, {seen} although seen",
                wall.name
            );
            (0..3).for_each(|k| all[k] += ends[k]);
        }
    }
    let [held, told, seen] = all;
    let total = held + told + seen;
    println!("all: {held} held, {told} told, {seen} although seen");
    assert!(
        silent.is_empty(),
        "{} not held:\n{}",
        silent.len(),
        silent.join("\n")
    );
    // Places to start from are spread over two steps: a quarter of them at most is nearer than half of a step.
    assert!(4 * told < total, "{told} of {total} told");
    assert!(
        SEEN_TOLD * seen < total,
        "{seen} of {total} told, although seen"
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
    throw_all::<Dim2>(&FLAT, None, &flat_walls(), &SPEEDS, 6);
}

/// Walls that deform and wear. What deforms is not hit in its middle, whose motion is taken for that of the whole.
fn flat_soft_walls() -> Vec<Wall> {
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
    // A blade is so thin that what a grain deforms counts as passing it.
    throw_all::<Dim2>(&FLAT[..3], Some(1e9), &flat_walls()[..5], &SOFT_SPEEDS, 3);
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
    throw_all::<Dim3>(&SOLID, None, &walls, &SPEEDS, 3);
    for file in files {
        let _ = std::fs::remove_file(file);
    }
}

/// As [`flat_soft_walls`].
fn solid_soft_walls() -> Vec<Wall> {
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
    let mut files = Vec::new();
    let walls = solid_walls(&mut files);
    throw_all::<Dim3>(&SOLID[..2], Some(1e9), &walls[..8], &SOFT_SPEEDS, 1);
    for file in files {
        let _ = std::fs::remove_file(file);
    }
}

/// Nothing but points would be in the way of a grain that is thinner than the gaps between them, however it is made: in the plane 5 mm,
/// in space 9.2 mm between four of them, and 10.6 mm by the largest area of a point.
#[test]
fn grains_that_fit_between_points_are_refused() {
    let throw = Throw {
        step: 0.1 * R,
        tilt: 0.0,
        from: 3.0 * R,
        turned: 0.0,
        spin: 0.0,
        wall_moves: false,
    };
    let points = "mesh: Block(x: (from: -0.1, to: 0.1, size: 0.005), y: (from: -0.02, to: 0.0, size: 0.005)), touches: Points(\"top\")";
    let wall = Wall::new("points", points).made(Made::Elements(1e9));
    for (name, grain) in FLAT {
        let built = throw.sketch::<Dim2>(grain, None, &wall).build::<Dim2>();
        // The arms of the cross and the plate are 4 mm thick, and the rounded segment is 6 mm.
        let thin = ["rounded plate", "cross"].contains(&name);
        let said = built.err().unwrap_or_default();
        assert_eq!(
            said.contains("fit between the points"),
            thin,
            "{name}: {said}"
        );
    }
    for (name, grain) in SOLID {
        let points = &solid_soft_walls()[0];
        let built = throw.sketch::<Dim3>(grain, None, points).build::<Dim3>();
        // The ball in the tetrahedron has a radius of 3.3 mm.
        let thick = ["sphere", "cube"].contains(&name);
        let said = built.err().unwrap_or_default();
        assert_eq!(
            said.contains("fit between the points"),
            !thick,
            "{name}: {said}"
        );
    }
}

/// Throws each grain at the middle of each other one, half of the time across a period: what it is thrown at is hit, or the run says
/// that it may not have been.
fn throw_at_each_other<S: Dimensional + Steps>(grains: &[(&str, Grain)]) {
    let mut rng = Pcg64::seed_from_u64(20);
    let mut silent = Vec::new();
    let (mut hit, mut told, mut told_seen) = (0, 0, 0);
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
                    let seen = throw.is_seen(from, 2.0 * R, 0.5);
                    let balls = [one, other].iter().all(|n| ["disk", "sphere"].contains(n));
                    match (seen, balls) {
                        (true, true) => silent.push(format!("{what}; told, although it is seen")),
                        (true, false) => told_seen += 1,
                        _ => told += 1,
                    }
                } else if slower != 0.0 && faster != throw.step / STEP {
                    hit += 1;
                } else {
                    silent.push(what);
                }
            }
        }
    }
    let total = hit + told + told_seen;
    println!(
        "{}D: {hit} hit, {told} told, {told_seen} although seen",
        S::D
    );
    // As of walls: what is not seen is a quarter of the throws at most.
    assert!(4 * told < total, "{told} of {total} told");
    // Both turn, by more than a radian in most throws.
    assert!(
        10 * told_seen < 3 * total,
        "{told_seen} of {total} told, although seen"
    );
    assert!(
        silent.is_empty(),
        "{} not hit:\n{}",
        silent.len(),
        silent.join("\n")
    );
}

#[test]
fn grains_meet_each_other() {
    throw_at_each_other::<Dim2>(&FLAT);
    throw_at_each_other::<Dim3>(&SOLID);
}
