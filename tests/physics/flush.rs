//! Convex shapes side by side act as one surface, and a body that passes another at less than its
//! displacement in a step does so undisturbed.

use crate::extremes::bench::{G, Sketch};
use crate::stepping::steps;
use fretwork::geometry::convex::passing::{PairMotion, keep_ball_apart};
use fretwork::geometry::convex::polygon::Polygon;
use fretwork::geometry::convex::polyhedron::Polyhedron;
use fretwork::geometry::convex::{ContactTolerances, Core, CorePair, PairFace};
use fretwork::geometry::space::{Dim2, Dim3, Space, VectorLike};
use fretwork::step::Simulation;
use nalgebra::{UnitQuaternion, Vector1, Vector2, Vector3};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use std::fmt::Write as _;

fn build<S: Space>(sketch: &Sketch) -> Simulation<S> {
    sketch.build().unwrap_or_else(|e| panic!("{e}"))
}

/// The velocity and spin of the only grain.
fn motion<S: Space>(s: &Simulation<S>) -> (S::Vector, S::Spin) {
    let grain = s.state.bodies.grains().next().expect("a grain");
    (s.state.bodies.velocity[grain], s.state.bodies.spin[grain])
}

/// A rectangle or a cuboid as a shape (m).
fn shape<S: Space>(from: [f64; 3], to: [f64; 3]) -> String {
    if S::D == 2 {
        let [[x, _, y], [u, _, v]] = [from, to];
        return format!(
            "Polygon(points: [({x:?}, {y:?}), ({u:?}, {y:?}), ({u:?}, {v:?}), ({x:?}, {v:?})])"
        );
    }
    let middle: Vec<f64> = (0..3).map(|k| 0.5 * (from[k] + to[k])).collect();
    let size: Vec<f64> = (0..3).map(|k| to[k] - from[k]).collect();
    format!(
        "Box(size: ({:?}, {:?}, {:?}), at: ({:?}, {:?}, {:?}))",
        size[0], size[1], size[2], middle[0], middle[1], middle[2]
    )
}

/// Ten blocks of half a metre with their tops at zero.
fn blocks<S: Space>() -> Vec<String> {
    let of = |k: u32| {
        let x = 0.5 * f64::from(k);
        shape::<S>([x, -0.7, -0.5], [x + 0.5, 0.8, 0.0])
    };
    (0..10).map(of).collect()
}

/// A grain 0.2 m high that slides on the level zero.
fn sliders<S: Space>(v: f64) -> [String; 2] {
    match S::D {
        2 => [
            format!(
                "Polygons(material: \"m0\", grains: [(at: [0.3, 0.1], points: [(-0.1, -0.1), (0.1, -0.1), (0.1, 0.1), (-0.1, 0.1)], \
                 velocity: [{v:?}, 0.0])]),"
            ),
            format!(
                "List(material: \"m0\", grains: [(at: [0.3, 0.1], radius: 0.1, velocity: [{v:?}, 0.0])]),"
            ),
        ],
        _ => [
            format!(
                "Polyhedra(material: \"m0\", grains: [(at: [0.3, 0.03, 0.1], size: (0.2, 0.2, 0.2), velocity: [{v:?}, 0.0, 0.0])]),"
            ),
            format!(
                "List(material: \"m0\", grains: [(at: [0.3, 0.03, 0.1], radius: 0.1, velocity: [{v:?}, 0.0, 0.0])]),"
            ),
        ],
    }
}

/// Slides over a floor for four metres, at the initial speed and without rotation.
fn slides_on<S: Space>(floor: &str, bodies: &str) {
    for v in [1.0, 0.05, 7.0] {
        for (grain, name) in sliders::<S>(v).into_iter().zip(["box", "ball"]) {
            let mut s = build::<S>(&Sketch {
                mu: 0.0,
                gravity: G,
                bodies: bodies.to_owned(),
                grains: grain,
                ..Sketch::default()
            });
            let step = s.options.scheme.h;
            // Slow grains slide over one joint.
            let way = if v < 0.5 { 0.3 } else { 4.0 };
            steps(&mut s, (way / (v * step)) as usize);
            let (velocity, spin) = motion(&s);
            println!(
                "{}D, {name} on {floor} at {v} m/s: {velocity:?}, {spin:?}",
                S::D
            );
            assert!(
                // The error is the solver's tolerance of 1e-10 in each of thousands of steps.
                (velocity[0] / v - 1.0).abs() < 1e-8,
                "{floor}, {name}, {v}: {velocity:?}"
            );
            assert!(
                velocity[S::D - 1].abs() < 1e-3 * v,
                "{floor}, {name}, {v}: {velocity:?}"
            );
            assert!(spin.norm() < 1e-6 * v, "{floor}, {name}, {v}: {spin:?}");
            assert_eq!(s.state.network.step_size.warning(), None);
        }
    }
}

/// Puts all shapes into one body, or each into its own.
fn as_bodies(shapes: &[String], one: bool) -> String {
    let body = |name: usize, shapes: &str| {
        format!("(name: \"b{name}\", material: \"m0\", shapes: [{shapes}]),")
    };
    if one {
        return body(0, &shapes.join(", "));
    }
    let mut out = String::new();
    for (k, shape) in shapes.iter().enumerate() {
        let _ = write!(out, "{}", body(k, shape));
    }
    out
}

#[test]
fn a_grain_slides_over_flush_blocks_as_over_one() {
    for one in [true, false] {
        let name = if one { "a body of blocks" } else { "blocks" };
        slides_on::<Dim2>(name, &as_bodies(&blocks::<Dim2>(), one));
        slides_on::<Dim3>(name, &as_bodies(&blocks::<Dim3>(), one));
    }
}

/// A body is thrown past the corner of a block, or over it, at a clearance smaller than its
/// displacement in a step.
fn passes<S: Space>(past: &str) {
    let (v, step) = (1.0, 1e-3);
    for share in [0.01, 0.1, 0.3, 0.7, 0.9] {
        for start in [0.0, 0.13, 0.5, 0.81] {
            for up in [0.0, 0.3] {
                let clear = share * v * step;
                for grain in sliders::<S>(v) {
                    // A rising body passes the corner of the block at least at the clearance.
                    let corner = 0.5 - 0.3 - 0.1;
                    let drop = up * (corner - start * step) / v;
                    let places = ["at: [0.3, 0.1]", "at: [0.3, 0.03, 0.1]"];
                    let height = 0.1 + clear - drop;
                    let x = 0.3 + start * step;
                    let at = match S::D {
                        2 => format!("at: [{x:?}, {height:?}]"),
                        _ => format!("at: [{x:?}, 0.03, {height:?}]"),
                    };
                    let mut grain = grain.replace(places[S::D - 2], &at);
                    let level = ["velocity: [1.0, 0.0]", "velocity: [1.0, 0.0, 0.0]"][S::D - 2];
                    let climbs = level.replace("0.0]", &format!("{up:?}]"));
                    grain = grain.replace(level, &climbs);
                    let mut s = build::<S>(&Sketch {
                        step,
                        mu: 0.3,
                        gravity: 0.0,
                        bodies: past.to_owned(),
                        grains: grain.clone(),
                        ..Sketch::default()
                    });
                    let (before, _) = motion(&s);
                    steps(&mut s, 800);
                    let (after, spin) = motion(&s);
                    assert!(
                        (after - before).norm() < 1e-12 && spin.norm() < 1e-12,
                        "{}D, clearance {share} v h, start {start}, {grain}: {after:?} {spin:?}",
                        S::D
                    );
                }
            }
        }
    }
}

#[test]
fn what_passes_a_corner_closer_than_it_moves_is_not_touched() {
    passes::<Dim2>(&as_bodies(
        &[shape::<Dim2>([0.5, 0.0, -0.5], [1.0, 0.0, 0.0])],
        true,
    ));
    passes::<Dim3>(&as_bodies(
        &[shape::<Dim3>([0.5, -0.5, -0.5], [1.0, 0.5, 0.0])],
        true,
    ));
}

/// A grain slides over a floor with a small overlap, as springs have it and as rigid contacts
/// drift: its support acts only upwards, at any position.
fn slides_deep<S: Space>(floor: &str, bodies: &str) {
    // The grains move less than the alert distance in a step.
    let rigid = ("coulomb", String::new(), 5e-4);
    let springs = [1e5, 1e6, 1e7].map(|stiffness: f64| {
        let more = format!(", \"stiffness\": {stiffness:?}, \"ratio\": 0.0, \"restitution\": 0.2");
        ("linear-contact", more, 1e-4)
    });
    for (contact, of_contact, step) in std::iter::once(rigid).chain(springs) {
        // The overlaps are 0.1 % and 0.5 % of the grain's height.
        for depth in [2e-4, 1e-3] {
            for (grain, name) in sliders::<S>(1.0).into_iter().zip(["box", "ball"]) {
                let ball = name == "ball";
                let height = 0.1 - if ball { 0.5 * depth } else { depth };
                let grain = grain
                    .replace("at: [0.3, 0.1]", &format!("at: [0.3, {height:?}]"))
                    .replace(
                        "at: [0.3, 0.03, 0.1]",
                        &format!("at: [0.3, 0.03, {height:?}]"),
                    );
                let mut s = build::<S>(&Sketch {
                    step,
                    contact,
                    of_contact: of_contact.clone(),
                    mu: 0.0,
                    gravity: G,
                    bodies: bodies.to_owned(),
                    grains: grain,
                    ..Sketch::default()
                });
                steps(&mut s, (2.0 / step) as usize);
                let (velocity, spin) = motion(&s);
                let what = format!(
                    "{}D, {name} on {floor}, {contact}{of_contact}, {depth} m deep: {velocity:?}, {spin:?}",
                    S::D
                );
                println!("{what}");
                // A box on springs, of which there are more over a joint, rocks, and its weight has
                // a component along its own faces.
                let bound = if ball || contact == "coulomb" {
                    1e-8
                } else {
                    0.01
                };
                assert!((velocity[0] - 1.0).abs() < bound, "{what}");
                assert!(!ball || spin.norm() < 1e-6, "{what}");
            }
        }
    }
}

#[test]
fn a_grain_slides_over_flush_blocks_in_which_it_lies_a_little() {
    for one in [true, false] {
        let name = if one { "a body of blocks" } else { "blocks" };
        slides_deep::<Dim2>(name, &as_bodies(&blocks::<Dim2>(), one));
        slides_deep::<Dim3>(name, &as_bodies(&blocks::<Dim3>(), one));
    }
}

/// A block that is higher by 1 % or 10 % of the height of the sliding box stops the box, also if a
/// step of a tenth of that lies before it.
fn stops_at_a_step<S: Space>() {
    let rigid = ("coulomb", String::new(), 1e-3);
    let springs = [1e6, 1e7].map(|stiffness: f64| {
        let more = format!(", \"stiffness\": {stiffness:?}, \"ratio\": 0.0, \"restitution\": 0.2");
        ("linear-contact", more, 1e-4)
    });
    for (contact, of_contact, step) in std::iter::once(rigid).chain(springs) {
        for (depth, rise) in [
            (0.0, 2e-3),
            (2e-4, 2e-3),
            (1e-3, 2e-3),
            (2e-4, 0.02),
            (1e-3, 0.02),
        ] {
            for (one, tread) in [(true, false), (false, false), (true, true), (false, true)] {
                let [grain, _] = sliders::<S>(1.0);
                let height = 0.1 - depth;
                let grain = grain
                    .replace("at: [0.3, 0.1]", &format!("at: [0.3, {height:?}]"))
                    .replace(
                        "at: [0.3, 0.03, 0.1]",
                        &format!("at: [0.3, 0.03, {height:?}]"),
                    );
                // A narrow tread before the step leads nowhere.
                let from = if tread { 1.004 } else { 1.0 };
                let mut floor = vec![
                    shape::<S>([0.0, -0.7, -0.5], [1.0, 0.8, 0.0]),
                    shape::<S>([from, -0.7, -0.5], [2.0, 0.8, rise]),
                ];
                if tread {
                    floor.push(shape::<S>([1.0, -0.7, -0.5], [from, 0.8, 0.1 * rise]));
                }
                let mut s = build::<S>(&Sketch {
                    step,
                    contact,
                    of_contact: of_contact.clone(),
                    mu: 0.0,
                    gravity: G,
                    bodies: as_bodies(&floor, one),
                    grains: grain,
                    ..Sketch::default()
                });
                let mut farthest = 0.0f64;
                for _ in 0..(1.5 / step) as usize {
                    steps(&mut s, 1);
                    let grain = s.state.bodies.grains().next().expect("a grain");
                    farthest = farthest.max(s.state.bodies.position[grain][0]);
                }
                let (velocity, _) = motion(&s);
                let what = format!(
                    "{}D, {contact}{of_contact}, {depth} m deep, a step of {rise} m, one body: {one}, a tread: {tread}: up to {farthest} m, {velocity:?}",
                    S::D
                );
                println!("{what}");
                // The box tips by at most 13 degrees, by which its middle moves 0.024 m farther.
                assert!(farthest > 0.89 && farthest < 0.9 + 0.04, "{what}");
                assert!(velocity[0] < 0.2, "{what}");
            }
        }
    }
}

#[test]
fn a_step_stops_a_box_that_lies_deeper_than_others() {
    stops_at_a_step::<Dim2>();
    stops_at_a_step::<Dim3>();
}

const TOLERANCES: ContactTolerances = ContactTolerances {
    reach: 1.0,
    slack: 1e-6,
    held: false,
};

/// The gap of the lowest corner of `over`, 2.5 m above the middle of `block` and shifted along the
/// plane of its upper face, is among the gaps of the points on that plane, whichever body is the
/// candidate.
fn lowest_corner_is_found<S: Space>(block: &S::Core, over: &S::Core, corners: &[S::Vector]) {
    let up = S::D - 1;
    let lowest = |heights: &mut dyn Iterator<Item = f64>| heights.fold(f64::INFINITY, f64::min);
    let face = block.normals().iter().position(|n| n[up] > 0.9).unwrap();
    let gap = lowest(&mut corners.iter().map(|p| p[up])) + 2.5 - 1.0 - 0.15;
    for of_candidate in [false, true] {
        let sign = if of_candidate { -1.0 } else { 1.0 };
        let (a, b) = if of_candidate {
            (block, over)
        } else {
            (over, block)
        };
        for shift in [0.0, 0.7, 1.5] {
            let mut apart = S::Vector::zero();
            (apart[0], apart[up]) = (sign * shift, sign * 2.5);
            let named = PairFace { of_candidate, face };
            let pair = CorePair::<S> {
                cores: [a, b],
                apart,
                roundings: [0.1, 0.05],
                tolerances: TOLERANCES,
            };
            let mut out = Vec::new();
            S::Core::points_on_face(&pair, named, &mut out);
            let found = lowest(&mut out.iter().map(|m| m.gap));
            assert!(
                (found - gap).abs() < 1e-12,
                "{}D, {of_candidate}, {shift}: {found} {gap}",
                S::D
            );
            for m in &out {
                let way = m.on_candidate - m.on_antagonist;
                assert!((way - m.normal * m.gap).norm() < 1e-12, "{m:?}");
            }
        }
    }
}

/// A body turned over the edge of a face is kept above the plane of the face by its lowest corner,
/// which is beside the face.
#[test]
fn the_points_on_a_plane_have_the_lowest_corner() {
    let block = Polyhedron::cuboid([2.0; 3]);
    let upright = Vector3::y() * 0.3;
    let over = block.turned(&UnitQuaternion::from_scaled_axis(upright));
    lowest_corner_is_found::<Dim3>(&block, &over, over.points());
    let square = Polygon::new(
        [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
            .map(|(x, y)| Vector2::new(x, y))
            .to_vec(),
    )
    .unwrap();
    let turned = square.turned(&-0.3);
    lowest_corner_is_found::<Dim2>(&square, &turned, turned.points());
}

/// The plane that replaces the nearest points of a ball and a rotating core leaves more room at the
/// end of the step, over all corners of the core.
#[test]
fn a_plane_for_a_ball_leaves_more_room_beside_all_corners() {
    let mut rng = Pcg64::seed_from_u64(31);
    let core = Polygon::regular(4, 1.0);
    let (radius, mut taken) = (0.5, 0);
    for _ in 0..20_000 {
        let angle = rng.random_range(0.0..std::f64::consts::TAU);
        let apart = Vector2::new(angle.cos(), angle.sin()) * rng.random_range(1.1..1.6);
        let before = core.contact_point_with_ball(&apart, radius, 0.0);
        if before.gap < 0.0 {
            continue;
        }
        let motion = PairMotion::<Dim2> {
            shift: Vector2::new(rng.random_range(-0.3..0.3), rng.random_range(-0.3..0.3)),
            turns: [0.0, rng.random_range(-0.3..0.3)].map(Vector1::new),
        };
        let mut point = before;
        keep_ball_apart::<Dim2>(
            &core,
            &apart,
            [radius, 0.0],
            &TOLERANCES,
            &motion,
            &mut point,
        );
        if point == before {
            continue;
        }
        taken += 1;
        let n = point.normal;
        let end = |q: &Vector2<f64>| n.dot(&(q + Vector2::new(-q.y, q.x) * motion.turns[1].x));
        let top = core
            .points()
            .iter()
            .map(end)
            .fold(f64::NEG_INFINITY, f64::max);
        let left = n.dot(&(apart + motion.shift)) - top - radius;
        let moved = motion.shift
            - Vector2::new(-before.on_antagonist.y, before.on_antagonist.x) * motion.turns[1].x;
        let least = before.gap + before.normal.dot(&moved);
        assert!(left > least, "{left} {least}");
        // A force at the point exerts no moment on the pair.
        let way = point.on_candidate - point.on_antagonist;
        assert!((way - n * point.gap).norm() < 1e-12, "{point:?}");
    }
    assert!(taken > 100, "{taken}");
}

/// An edge between bodies at rest that is equally low belongs to the case: it stops a box, and does
/// not count as an error of the solution.
#[test]
fn an_edge_of_the_case_is_none_of_the_solution() {
    let floor = [
        shape::<Dim2>([0.0, 0.0, -0.5], [1.0, 0.0, 0.0]),
        shape::<Dim2>([1.0, 0.0, -0.5], [2.0, 0.0, 3e-4]),
    ];
    let mut s = build::<Dim2>(&Sketch {
        mu: 0.0,
        gravity: G,
        bodies: as_bodies(&floor, false),
        grains: sliders::<Dim2>(0.2)[0].clone(),
        ..Sketch::default()
    });
    steps(&mut s, 4000);
    assert!(motion(&s).0[0] < 0.1, "{:?}", motion(&s));
    assert_eq!(s.state.network.step_size.edges, 0);
}
