//! Every pair of shapes at displacements of 0.3 to 100 radii per step, from the side, rotating,
//! with either of them moving: a grain stays in front of what it meets, or the run reports that it
//! may not have. Shapes that deform or wear are tested up to ten radii per step.

use super::bench::{Sketch, place, up, volume};
use fretwork::geometry::space::{Dim2, Dim3, Space};
use fretwork::step::Simulation;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use std::f64::consts::TAU;

mod each_other;
mod in_space;
mod in_the_plane;

use in_space::{SOLID, solid_soft_walls};
use in_the_plane::FLAT;

/// Radius of the grains (m), and the step (s).
const R: f64 = 0.01;
const STEP: f64 = 1e-3;
/// Displacements in a step, in radii.
const SPEEDS: [f64; 9] = [0.3, 0.7, 1.1, 1.5, 2.3, 5.0, 10.7, 31.0, 100.0];
/// Displacements in a step, in radii, for shapes that deform or wear.
const SOFT_SPEEDS: [f64; 5] = [0.1, 0.4, 1.4, 3.0, 10.0];
/// Number of steps after the one of the impact.
const AFTER: usize = 3;
/// Largest distance of a centre behind the nearest vertex of a surface that is not flat (radii).
const BEHIND: f64 = 0.2;
/// One in this many throws may be reported although the whole impact is tracked: a body hit at a
/// corner rotates by about its displacement over its radius, and its corners move on arcs, of which
/// a step knows the tangents.
const SEEN_TOLD: usize = 8;
/// Relative energy gain of a throw that the error of the solver may cause.
const GAIN: f64 = 1e-6;

/// Describes a grain from its position, its motion, and an angle of rotation.
type Grain = fn(at: &str, motion: &str, turned: f64) -> String;

/// Material of a wall.
#[derive(Clone, Copy, PartialEq)]
enum Made {
    /// A first body of shapes.
    Rigid,
    /// A first body of shapes whose surface recedes by up to this depth (m) before and during the
    /// hit.
    Worn(f64),
    /// A first body of shapes that wears by the law of the interface, in an impact by about this
    /// fraction of the grain.
    Wearing(f64),
    /// A body of finite elements, held at its bottom, of this Young's modulus (Pa).
    Elements(f64),
    /// An elastic half-space of this Young's modulus (Pa).
    HalfSpace(f64),
}

/// Target of a grain: a body that is solid below the height zero.
struct Wall {
    name: &'static str,
    made: Made,
    /// Shapes of the wall, or its fields if it deforms.
    shapes: String,
    /// Origin of its frame: along x, out of plane and upwards (m).
    origin: [f64; 3],
    /// Distance along x from the point of impact at which the wall ends (m): a grain beyond has
    /// left it sideways. Where heights are measured from vertices, the distance from the nearest
    /// one.
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

    /// Lets the surface of a worn wall recede by this fraction of its depth, uneven by a tenth of
    /// it.
    fn recede<S: Space>(&self, s: &mut Simulation<S>, share: f64) {
        let Made::Worn(depth) = self.made else { return };
        for surface in &mut s.shapes.surfaces {
            let surface = surface.shape.receding_mut().expect("one that recedes");
            let all: Vec<usize> = (0..surface.vertices().len()).collect();
            let uneven = |k: &usize| share * depth * (0.9 + 0.1 * (*k as f64).sin().abs());
            let depths: Vec<f64> = all.iter().map(uneven).collect();
            surface.recede(&depths, &all);
        }
    }

    /// Height of the centre of a grain above the wall (m); infinite beside it. For a wall that is
    /// not flat, or does not remain so, it is the height above the nearest vertex plus the
    /// permitted distance behind it.
    fn height<S: Space>(&self, s: &Simulation<S>, grain: usize) -> f64 {
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
        // A body that touches by points has no surface.
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

/// Result of a throw: held, or reported, for an impact that is fully tracked or not.
enum End {
    Held,
    Reported,
    ToldSeen,
}

/// A throw: displacement in a step (m), its direction from the vertical (rad), distance from the
/// target point (m), angle of the grain and its rate (rad, rad/s), and whether the wall moves
/// instead.
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

    /// Whether grains of this reach are still apart at the first detection, at this fraction of a
    /// step after the start. `distance` is that of their centres along the throw, and `reach` the
    /// distance that they need (m). The impact is then fully tracked.
    fn is_seen(&self, distance: f64, reach: f64, first: f64) -> bool {
        distance - first * self.step > reach
    }

    /// Scene of a grain that is thrown at a wall, with this Young's modulus (Pa) if it deforms.
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
            // The modes of a sphere of two elements take a second.
            let elements = if S::D == 2 { 2 } else { 1 };
            sketch.more += &format!("elastic_grains: [(material: \"m0\", elements: {elements})],");
        }
        sketch
    }

    /// Throws the grain, and returns whether it is held, or the result that the run did not report.
    /// Balls that are tracked must be held.
    fn run<S: Space>(
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
            // All walls are flat at this scale, and below zero. An impact rotates shapes other than
            // balls, and another corner may turn into the wall in the same step.
            let seen = self.is_seen(self.from, R / self.tilt.cos(), first);
            // A deformable ball has corners too.
            let ball = soft.is_none() && ["disk", "sphere"].contains(&name);
            match seen && ball {
                true => Err(format!("{}; reported, although it is seen", what())),
                false if seen => Ok(End::ToldSeen),
                false => Ok(End::Reported),
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

/// Throws each grain at each wall, `times` times at each speed. Impacts before the first detection,
/// and those that turn a corner into the wall, may be reported; all others must be held.
fn throw_all<S: Space>(
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
            let [held, reported, seen] = ends;
            println!(
                "{name} on {}: {held} held, {reported} reported, {seen} although seen",
                wall.name
            );
            (0..3).for_each(|k| all[k] += ends[k]);
        }
    }
    let [held, reported, seen] = all;
    let total = held + reported + seen;
    println!("all: {held} held, {reported} reported, {seen} although seen");
    assert!(
        silent.is_empty(),
        "{} not held:\n{}",
        silent.len(),
        silent.join("\n")
    );
    // Start positions are spread over two steps: at most a quarter of them is nearer than half of a
    // step.
    assert!(4 * reported < total, "{reported} of {total} reported");
    assert!(
        SEEN_TOLD * seen < total,
        "{seen} of {total} reported, although seen"
    );
}

/// Heights of a bumpy line or field, of some tenths of a radius.
fn bumps(rng: &mut Pcg64) -> f64 {
    rng.random_range(-0.2..0.0) * R
}

/// A grain that is thinner than the gaps between points would only meet points: in 2D 5 mm, in 3D
/// 9.2 mm between four of them, and 10.6 mm by the largest area of a point.
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
