//! Grains of every shape read from another run: positions, orientations, velocities, spins, mass,
//! inertia and outlines.

use fretwork::contact::detect::centre;
use fretwork::geometry::space::{Dim2, Dim3, MatrixLike, Space, VectorLike};
use fretwork::record::placement::piece_outline;
use fretwork::record::results::{Header, Part, Results};
use fretwork::record::statistics::Column;
use fretwork::step::Simulation;

use super::grains::{Folder, case};

const STEPS: u32 = 400;

impl Folder {
    /// Runs a case into the folder `out`, and in this process too, with bit-identical results.
    fn run<S: Space>(&self, case: &str) -> Simulation<S> {
        self.record(case);
        let mut first = self
            .build::<S>(case)
            .unwrap_or_else(|e| panic!("{e}"))
            .simulation;
        for _ in 0..STEPS {
            first.step().unwrap_or_else(|e| panic!("{e}"));
        }
        first
    }
}

const STATE: &str = r#"State(results: "out", material: "grain")"#;

/// All numbers of a grain: those that must agree to the bit, and those that may differ by round-off
/// (its position if that follows from one of its parts, and values in world axes).
fn numbers<S: Space>(s: &Simulation<S>, b: usize) -> (Vec<f64>, Vec<f64>) {
    let bodies = &s.state.bodies;
    let mut same = bodies.velocity[b].padded().to_vec();
    same.extend(bodies.spin[b].padded());
    same.extend(S::rotation_numbers(&bodies.rotation[b]));
    same.extend([bodies.mass[b], bodies.inertia[b], bodies.length[b]]);
    let periodic = &s.shapes.periodic;
    let origin = bodies.position[b];
    let mut near = periodic.wrapped(origin).padded().to_vec();
    let inverse = bodies.inverse_tensor(b);
    let n = S::Spin::N;
    near.extend((0..n * n).map(|k| inverse.entry(k / n, k % n) * bodies.inertia[b]));
    for ball in s.shapes.balls.iter().filter(|x| x.body as usize == b) {
        same.push(ball.radius);
        near.extend(periodic.shortest(centre(ball, bodies) - origin).padded());
    }
    for piece in s.shapes.pieces.iter().filter(|x| x.body as usize == b) {
        same.extend([piece.rounding, piece.size]);
        for corner in piece_outline(s, piece).concat() {
            near.extend(periodic.shortest(corner - origin).padded());
        }
    }
    (same, near)
}

/// Checks that the grains of two simulations are equal; returns their number.
fn compare<S: Space>(first: &Simulation<S>, second: &Simulation<S>) -> usize {
    let of = |s: &Simulation<S>| s.state.bodies.grains().collect::<Vec<_>>();
    let (ours, mut theirs) = (of(first), of(second));
    assert_eq!(ours.len(), theirs.len());
    let periodic = &first.shapes.periodic;
    for a in &ours {
        let (same, near) = numbers(first, *a);
        let apart = |b: usize| {
            let d = first.state.bodies.position[*a] - second.state.bodies.position[b];
            periodic.shortest(d).norm()
        };
        let nearest = (0..theirs.len())
            .min_by(|k, l| apart(theirs[*k]).total_cmp(&apart(theirs[*l])))
            .unwrap();
        let (other, around) = numbers(second, theirs.swap_remove(nearest));
        assert_eq!(same, other, "grain {a}");
        assert_eq!(near.len(), around.len());
        for (x, y) in near.iter().zip(&around) {
            assert!((x - y).abs() < 1e-13, "grain {a}: {x} {y}");
        }
    }
    ours.len()
}

fn begins_where_the_other_ended<S: Space>(name: &str, grains: &str, count: usize) {
    let folder = Folder::new(name);
    let first = folder.run::<S>(&case(S::D, "stone", grains, ""));
    assert!(
        first
            .state
            .network
            .contacts
            .iter()
            .any(|c| c.impulse.norm() > 0.0)
    );
    let second = folder.build::<S>(&case(S::D, "stone", STATE, ""));
    let second = second.unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(compare(&first, &second.simulation), count);
    let samples = second.samples.concat();
    assert!(
        samples.contains(&format!("{count} grains (")) && samples.contains("state 4 of"),
        "{samples}"
    );
    // The first state is that of the case before any step.
    let state = STATE.replace(")", ", frame: Number(0))");
    let start = folder.build::<S>(&case(S::D, "stone", &state, ""));
    let start = start.unwrap_or_else(|e| panic!("{e}"));
    let case_itself = folder.build::<S>(&case(S::D, "stone", grains, ""));
    let case_itself = case_itself.unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(compare(&case_itself.simulation, &start.simulation), count);
    // Twice the density gives twice the mass and inertia, to the bit.
    let heavy = folder.build::<S>(&case(S::D, "heavy", STATE, ""));
    let heavy = heavy
        .unwrap_or_else(|e| panic!("{e}"))
        .simulation
        .state
        .bodies;
    let light = &second.simulation.state.bodies;
    for b in light.grains() {
        assert_eq!(heavy.mass[b], 2.0 * light.mass[b]);
        assert_eq!(heavy.inertia[b], 2.0 * light.inertia[b]);
    }
}

/// Balls, sharp and rounded polygons, capsules, unions, and voussoirs whose mass is not that of
/// their outline; some extend across the period.
const PLANE: &str = r#"
    List(material: "grain", grains: [(at: [0.02, 0.0101], radius: 0.01, velocity: [0.1, -0.5], spin: [3.0]),
        (at: [0.05, 0.031], radius: 0.01, velocity: [0.0, -0.5])]),
    Polygons(material: "grain", grains: [
        (at: [0.198, 0.012], regular: (6, 0.01), angle: 0.3, velocity: [0.3, -0.5], spin: [-20.0]),
        (at: [0.08, 0.015], points: [(-0.01, -0.008), (0.012, -0.01), (0.0, 0.01)], rounding: 2e-3, velocity: [0.0, -0.6], spin: [9.0])]),
    Clusters(material: "grain", grains: [
        (at: [0.11, 0.0085], shapes: [Capsule(from: (-0.008, 0.003), to: (0.01, 0.0), radius: 0.005)], velocity: [0.0, -0.8], spin: [15.0]),
        (at: [0.145, 0.013], shapes: [Balls([([-0.008, 0.0], 0.008), ([0.008, 0.002], 0.006)])], velocity: [0.2, -0.4], spin: [-8.0]),
        (at: [0.175, 0.04], shapes: [Balls([([0.012, 0.0], 0.006)]), Polygon(points: [(-0.01, -0.01), (0.01, -0.01), (0.01, 0.01), (-0.01, 0.01)]),
            Capsule(from: (0.0, 0.0), to: (0.0, 0.02), radius: 0.003)], velocity: [0.2, -1.4], spin: [-30.0])]),
    Arch(material: "grain", blocks: 5, radius: 0.05, thickness: 0.02, centre: [0.1, 0.06]),
"#;

const SOLID: &str = r#"
    List(material: "grain", grains: [(at: [0.02, 0.0, 0.0101], radius: 0.01, velocity: [0.1, 0.0, -0.5], spin: [3.0, 1.0, -2.0])]),
    Polyhedra(material: "grain", grains: [
        (at: [0.198, 0.01, 0.013], size: (0.02, 0.015, 0.012), turned: [0.3, -0.4, 0.2], velocity: [0.1, 0.0, -0.5], spin: [5.0, -30.0, 11.0]),
        (at: [0.08, 0.0, 0.011], points: [(-0.01, -0.008, -0.005), (0.012, -0.01, -0.007), (0.0, 0.01, -0.006), (0.001, 0.0, 0.012)],
            rounding: 1.5e-3, velocity: [0.0, 0.0, -0.6], spin: [9.0, 2.0, 0.0])]),
    Clusters(material: "grain", grains: [
        (at: [0.11, 0.0, 0.0085], shapes: [Capsule(from: (-0.008, 0.0, 0.003), to: (0.01, 0.004, 0.0), radius: 0.005)], velocity: [0.0, 0.0, -0.8], spin: [1.0, 15.0, 0.0]),
        (at: [0.145, 0.0, 0.013], shapes: [Balls([([-0.008, 0.0, 0.0], 0.008), ([0.008, 0.003, 0.002], 0.006)])], velocity: [0.2, 0.0, -0.4], spin: [-8.0, 1.0, 2.0]),
        (at: [0.175, 0.03, 0.014], shapes: [Balls([([0.012, 0.0, 0.0], 0.006)]), Box(size: (0.02, 0.015, 0.018), rounding: 1e-3, turned: [0.1, 0.2, 0.3])],
            velocity: [0.2, 0.0, -0.4], spin: [-30.0, 4.0, 40.0])]),
"#;

#[test]
fn grains_of_every_shape_go_on_in_the_plane() {
    begins_where_the_other_ended::<Dim2>("plane", PLANE, 12);
}

#[test]
fn grains_of_every_shape_go_on_in_space() {
    begins_where_the_other_ended::<Dim3>("solid", SOLID, 6);
}

/// A layer of polygons settles in one run, and is sheared by a lid in the next.
#[test]
fn a_layer_of_polygons_settles_in_one_run_and_is_sheared_in_the_next() {
    let folder = Folder::new("shear");
    let cells = r#"Voronoi(material: "grain", size: 0.015, low: [0.0, 0.0], high: [0.2, 0.06], gap: 1e-3, rounding: 1e-3)"#;
    let first = folder.run::<Dim2>(&case(2, "stone", cells, ""));
    let top = first.shapes.pieces.iter().map(|p| {
        let high = piece_outline(&first, p).concat();
        high.iter().map(|c| c.y).fold(0.0, f64::max)
    });
    let top = top.fold(0.0, f64::max);
    let lid = format!(
        r#"(name: "lid", material: "grain", position: [0.0, {top}], mass: 5.0, shapes: [HalfSpace(normal: [0.0, -1.0])],
            dofs: (x: Velocity(Constant(0.2)), y: Force(Constant(-200.0))))"#
    );
    let second = folder.build::<Dim2>(&case(2, "stone", STATE, &lid));
    let mut second = second.unwrap_or_else(|e| panic!("{e}")).simulation;
    assert_eq!(compare(&first, &second), 53);
    let momentum = |s: &Simulation<Dim2>| -> f64 {
        let along = |b: usize| s.state.bodies.mass[b] * s.state.bodies.velocity[b].x;
        s.state.bodies.grains().map(along).sum()
    };
    let before = momentum(&second);
    for _ in 0..STEPS {
        second.step().unwrap_or_else(|e| panic!("{e}"));
    }
    assert!(momentum(&second) > before, "the lid drags nothing");
}

/// A file of an older version that lists polygons, or balls of one grain, without shapes.
#[test]
fn a_file_without_shapes_is_refused_with_a_sentence() {
    let folder = Folder::new("older");
    let names = [
        "id",
        "radius",
        "material",
        "first_body",
        "velocity_x",
        "velocity_y",
        "velocity_z",
        "spin",
        "corners",
    ];
    let fields = names.map(|name| Column::new(name, "", "")).to_vec();
    let path = folder.0.join("older.h5");
    for (ids, corners, taken) in [
        ([0.0, 1.0], 0.0, true),
        ([0.0, 1.0], 5.0, false),
        ([3.0, 3.0], 0.0, false),
    ] {
        let header = Header {
            dimension: 2,
            fields: [fields.clone(), Vec::new(), Vec::new()],
            ..Header::default()
        };
        let mut results = Results::create(&path, &header).unwrap();
        let mut data = vec![vec![0.0; 2]; 9];
        (data[0], data[1], data[8]) = (ids.to_vec(), vec![0.01; 2], vec![0.0, corners]);
        let grains = Part {
            points: vec![0.05, 0.02, 0.0, 0.1, 0.02, 0.0],
            cells: vec![vec![0], vec![1]],
            data,
            ..Part::default()
        };
        let parts = [grains, Part::default(), Part::default()];
        results.append_views(0.5, &parts, &[]).unwrap();
        results.finish(&folder.0).unwrap();
        let state = r#"State(results: "older.h5", material: "grain")"#;
        let built = folder.build::<Dim2>(&case(2, "stone", state, ""));
        match (built, taken) {
            (Ok(_), true) => {}
            (Err(said), false) => assert!(said.contains("run its case again"), "{said}"),
            (Ok(_), false) => panic!("it was taken"),
            (Err(said), true) => panic!("{said}"),
        }
    }
}
