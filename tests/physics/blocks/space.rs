//! Polyhedra: sizes and areas of samples, the law's closed form over a face that is pulled, bent
//! and twisted.

use super::face::opens_by_its_law;
use super::{close, driven, scene, step};
use fretwork::contact::Key;
use fretwork::geometry::convex::Core;
use fretwork::geometry::space::Dim3;
use fretwork::record::RunEnd;
use fretwork::record::measure::measures;
use fretwork::record::run::write_outputs;
use fretwork::record::statistics::Table;
use fretwork::record::summary::Uncertainty;
use fretwork::scene::measures::MeasureSpec;
use fretwork::step::Simulation;
use nalgebra::Vector3;
use std::collections::HashMap;
use std::time::Duration;

type V = Vector3<f64>;

/// Faces of a piece at its position (m).
fn faces(s: &Simulation<Dim3>, piece: usize) -> Vec<Vec<V>> {
    let piece = &s.shapes.pieces[piece];
    let b = piece.body as usize;
    let core = piece.core.turned(&s.state.bodies.rotation[b]);
    let at = s.state.bodies.position[b] + piece.offset;
    let faces = core.outline(0.0).into_iter();
    faces.map(|f| f.iter().map(|c| c + at).collect()).collect()
}

fn area(face: &[V]) -> V {
    let at = |k: usize| face[k] - face[0];
    (1..face.len() - 1)
        .map(|k| at(k).cross(&at(k + 1)) * 0.5)
        .sum()
}

/// Area of the face that two pieces have in common (m²), of which one covers the other.
fn common(a: &[Vec<V>], b: &[Vec<V>]) -> f64 {
    let mut sum = 0.0;
    for f in a {
        let n = area(f).normalize();
        for g in b {
            let plane = g.iter().all(|p| (p - f[0]).dot(&n).abs() < 1e-9);
            if plane && area(g).dot(&n) < 0.0 {
                sum += area(f).norm().min(area(g).norm());
            }
        }
    }
    sum
}

const WALL: [&str; 5] = [
    "bodies.table.shapes.0.normal=[0.0,0.0,1.0]",
    "dimension=3",
    "gravity=[3.3552,0.0,-9.2184]",
    "grains.0.thickness=0.15",
    "grains.0.at=[0.3,-0.2,0.0]",
];

#[test]
fn a_wall_in_running_bond() {
    let s = scene::<Dim3>("block_wall", &WALL);
    assert_eq!(s.shapes.pieces.len(), 22);
    let density = s.state.bodies.mass[0] / (0.02 * 0.15);
    let mass: f64 = (0..22).map(|b| s.state.bodies.mass[b]).sum();
    assert!((mass / (density * 0.8 * 0.5 * 0.15) - 1.0).abs() < 1e-14);
    for k in 0..22 {
        let points = faces(&s, k).concat();
        let of = |axis: usize| points.iter().map(move |p| p[axis]);
        let low = |axis: usize| of(axis).fold(9.0, f64::min);
        let high = |axis: usize| of(axis).fold(-9.0, f64::max);
        assert!(low(0) > 0.3 - 1e-12 && high(0) < 1.1 + 1e-12);
        assert!((low(1) + 0.2).abs() < 1e-12 && (high(1) + 0.05).abs() < 1e-12);
        // The second course begins with half a block.
        if k == 4 {
            assert!((high(0) - 0.4).abs() < 1e-12 && (low(2) - 0.1).abs() < 1e-12);
        }
    }
}

/// A wall on a table tilted by 20 degrees stays if friction holds it, and otherwise slides as one
/// body.
#[test]
fn a_wall_stands_below_its_angle_of_friction_and_slides_above() {
    for (mu, slides) in [(0.4, false), (0.3, true)] {
        let mu_set = format!("interfaces.joints.parameters.contact.mu={mu}");
        let sets = [&WALL[..], &[mu_set.as_str()]].concat();
        let mut s = scene::<Dim3>("block_wall", &sets);
        while s.state.time < 0.05 {
            step(&mut s);
        }
        let fall = f64::sin(20f64.to_radians()) - mu * f64::cos(20f64.to_radians());
        let known = if slides {
            9.81 * fall * s.state.time
        } else {
            0.0
        };
        for v in &s.state.bodies.velocity[..22] {
            assert!((v.x - known).abs() < 1e-4, "{v:?} {known}");
        }
    }
}

#[test]
fn a_face_opens_by_its_law_over_its_whole_area() {
    opens_by_its_law::<Dim3>("verification/bonded_face_3d", 4, 0.2, 1e-13);
}

/// A face is pulled by u, bent by two small angles and twisted. Its four corners (±a, ±b) have
/// springs of a quarter of its area, so N = K_n A u, M = K_n A (b² about x, a² about y) and K_t A
/// (a² + b²) about z.
#[test]
fn a_face_that_is_bent_and_twisted_resists_at_its_corners() {
    let (k_n, k_t, face, a, b) = (1e12, 5e11, 0.2, 0.25, 0.2);
    let asked = (1.5e-7, 3e-7, -1e-7, 4e-7);
    let ramp =
        |to: f64| format!("Displacement(Ramp(from: 0.0, to: {to:e}, start: 0.0, end: 2e-6))");
    let later =
        |to: f64| format!("Displacement(Ramp(from: 0.0, to: {to:e}, start: 2e-6, end: 4e-6))");
    let (u, rx, ry, rz) = asked;
    let (z, x, y, t) = (ramp(u), later(rx), later(ry), later(rz));
    // The grip rotates about its centre, half a metre above the face: the face moves sideways, and
    // is held there.
    let (dx, dy) = (later(0.5 * ry), later(-0.5 * rx));
    let set = format!("bodies.grip.dofs=(x: {dx}, y: {dy}, z: {z}, rx: {x}, ry: {y}, rz: {t})");
    let mut s = scene::<Dim3>("verification/bonded_face_3d", &[&set]);
    let grip = driven(&s, "grip");
    while s.state.time < 4.2e-6 {
        step(&mut s);
        assert!(
            s.state.energy.relative_residual() < 1e-12,
            "{:?}",
            s.state.energy
        );
    }
    let (force, moment) = s.state.received[grip];
    let (force, moment) = (-force / s.options.scheme.h, -moment / s.options.scheme.h);
    // The actual rotation is used: rotations about several axes at once are those of the step's
    // velocities, more exactly than the square of the angles.
    let b_grip = s.state.bodies.driven[grip].body as usize;
    let u = s.state.bodies.position[b_grip].z - 1.0;
    let turned = s.state.bodies.rotation[b_grip].scaled_axis();
    let near = |x: f64, asked: f64| (x / asked - 1.0).abs() < 1e-6;
    assert!(near(u, asked.0) && near(turned.x, rx) && near(turned.y, ry) && near(turned.z, rz));
    let n = k_n * face * u;
    println!("{force:?} {moment:?} {:?}", s.state.energy);
    assert!(close(force.z, n, 1e-6), "{} {n}", force.z);
    assert!(force.xy().norm() < 1e-6 * n);
    let known = V::new(
        k_n * face * b * b * turned.x,
        k_n * face * a * a * turned.y,
        k_t * face * (a * a + b * b) * turned.z,
    );
    assert!(
        (moment - known).norm() < 1e-5 * known.norm(),
        "{moment:?} {known:?}"
    );
    let stored = 0.5 * (n * u + known.dot(&turned));
    assert!(
        close(s.state.energy.elastic, stored, 1e-5),
        "{} {stored}",
        s.state.energy.elastic
    );
    assert!(s.state.energy.fracture == 0.0);
}

#[test]
fn neighbours_are_bonded_over_their_faces_and_nothing_else_is() {
    for rounds in ["grains.0.rounds=0", "grains.0.rounds=5"] {
        let mut s = scene::<Dim3>("verification/voronoi_plate_3d", &[rounds]);
        let cells = s.shapes.pieces.len() - 2;
        assert_eq!(cells, 60);
        let density = scene::<Dim3>("block_wall", &WALL).state.bodies.mass[0] / (0.02 * 0.15);
        let mass: f64 = s.state.bodies.mass[..cells].iter().sum();
        assert!((mass / (density * 0.12 * 0.08 * 0.04) - 1.0).abs() < 1e-13);
        step(&mut s);
        let mut held: HashMap<(u32, u32), f64> = HashMap::new();
        for c in &s.state.network.contacts {
            if let Some(b) = s.state.network.bond(c).filter(|b| b.intact()) {
                *held.entry(c.key.pair()).or_default() += b.area;
            }
        }
        let all: Vec<_> = (0..s.shapes.pieces.len()).map(|k| faces(&s, k)).collect();
        let (mut shared, mut missing, mut worst) = (0, 0.0, 0.0f64);
        for i in 0..all.len() {
            for j in i + 1..all.len() {
                let area = common(&all[i], &all[j]);
                let name = (i as u32 | Key::PIECE, j as u32 | Key::PIECE);
                let bonded = held
                    .remove(&name)
                    .or_else(|| held.remove(&(name.1, name.0)));
                match bonded {
                    Some(found) => worst = worst.max((found - area).abs()),
                    None => missing += area,
                }
                shared += usize::from(area > 0.0);
            }
        }
        println!("{shared} faces, off by {worst:e} m², {missing:e} m² without bonds");
        assert!(held.is_empty() && shared > 250, "{held:?} {shared}");
        assert!(worst < 1e-14, "{worst:e}");
        assert!(missing < 1e-10, "{missing:e}");
    }
}

/// Blocks count in measures of grains: their mass above a level, the tops of stairs, the wall
/// without holes.
#[test]
fn blocks_are_measured() {
    let name = || "m".to_owned();
    let mass = MeasureSpec::Mass {
        name: name(),
        axis: 2,
        above: 0.2,
        start: 0.0,
    };
    let mut s = scene::<Dim3>("block_wall", &WALL);
    let mut scaled = measures(std::slice::from_ref(&mass), 1e3, &s);
    let mut mass = measures(&[mass], 1.0, &s);
    let whole: f64 = s.state.bodies.mass[..22].iter().sum();
    // The centres of three of the five courses are above the level.
    assert!(close(mass.sample(&s).unwrap()[0], 0.6 * whole, 1e-14));
    // In a case whose bodies are a thousand times too heavy, the measured mass is the unscaled one.
    assert!(close(scaled.sample(&s).unwrap()[0], 0.6e-3 * whole, 1e-14));

    let folder = std::env::temp_dir().join(format!("fretwork-blocks-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let profile = MeasureSpec::Profile {
        name: name(),
        axis: 2,
        low: vec![0.3, -0.2, 0.0],
        high: vec![1.1, -0.05, 0.5],
        bins: 5,
        turned: 0.0,
        start: 0.0,
    };
    let mut profile = measures(&[profile], 1.0, &s);
    step(&mut s);
    profile.sample(&s).unwrap();
    let table = Table::create(&folder.join("t.csv"), Vec::new(), 3).unwrap();
    let end = RunEnd {
        simulation: &s,
        table: &table,
        title: "",
        uncertainty: &Uncertainty::default(),
        wall: Duration::ZERO,
    };
    write_outputs(&folder, &profile.figures(&end), end.table).unwrap();
    let text = std::fs::read_to_string(folder.join("m.csv")).unwrap();
    std::fs::remove_dir_all(&folder).ok();
    for row in text.lines().skip(1) {
        let solid: f64 = row.split(',').nth(1).unwrap().parse().unwrap();
        assert!((solid - 1.0).abs() < 1e-12, "{row}");
    }
    assert_eq!(text.lines().count(), 6);

    let stairs: Vec<String> = (0..8)
        .map(|k| {
            let (x, high) = (0.05 + 0.1 * f64::from(k), 0.1 + 0.01 * f64::from(k));
            format!(
                "(at: [{x}, 0.0, {}], size: (0.1, 0.08, {high}))",
                0.5 * high
            )
        })
        .collect();
    let grains = format!(
        "grains=[Polyhedra(material: \"grain\", grains: [{}])]",
        stairs.join(", ")
    );
    let mut s = scene::<Dim3>("block_wall", &[WALL[0], WALL[1], WALL[2], &grains]);
    step(&mut s);
    let slope = MeasureSpec::Slope {
        name: name(),
        from: 0.0,
        to: 0.8,
        start: 0.0,
    };
    // In three columns the heights are three, two and three blocks.
    let known = f64::atan((0.17 - 0.12) / (0.8 * 2.0 / 3.0));
    let found = measures(&[slope], 1.0, &s).sample(&s).unwrap()[0];
    assert!((found - known).abs() < 1e-6, "{found} {known}");
}
