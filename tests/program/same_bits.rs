//! Equal input gives equal bits: every shipped case, twice and on two and three threads, and all
//! shapes in motion. Contacts in another order give another path of the solver: in a hyperstatic
//! set of contacts it ends with other forces, so sums are compared instead.

use fretwork::contact::Key;
use fretwork::geometry::space::{Space, VectorLike};
use fretwork::scene::{LoadedCase, load, load_text};
use fretwork::shipped::search_path;
use fretwork::step::Simulation;
use fretwork::threads::divide_loops_from;
use fretwork::{AnySimulation, in_dimension};
use std::path::PathBuf;
use std::time::{Duration, Instant};

fn cases() -> Vec<PathBuf> {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/cases");
    let files = std::fs::read_dir(folder).unwrap().flatten();
    let mut cases: Vec<PathBuf> = files
        .map(|f| f.path())
        .filter(|p| p.extension().is_some_and(|e| e == "ron"))
        .collect();
    cases.sort();
    cases
}

fn built(loaded: &LoadedCase) -> AnySimulation {
    let built = loaded.build(&search_path());
    built.unwrap_or_else(|e| panic!("{e}")).simulation
}

/// All bits of bodies and contacts, and the number of steps; for a duration (s), or a number of
/// steps.
fn stepped<S: Space>(s: &mut Simulation<S>, steps: Result<u64, Duration>) -> (Vec<u64>, u64) {
    let clock = Instant::now();
    let goes_on = |done: u64| match steps {
        Ok(n) => done < n,
        Err(time) => done < 3 || (done < 400 && clock.elapsed() < time),
    };
    while goes_on(s.state.steps) {
        s.step().unwrap_or_else(|e| panic!("{e}"));
    }
    let mut bits = Vec::new();
    let mut push = |v: &S::Vector| bits.extend((0..S::D).map(|k| v[k].to_bits()));
    s.state.bodies.position.iter().for_each(&mut push);
    s.state.bodies.velocity.iter().for_each(&mut push);
    for c in &s.state.network.contacts {
        push(&c.impulse);
    }
    for memory in &s.state.network.memory {
        bits.extend(memory.bonds.iter().map(|b| b.damage.to_bits()));
        bits.extend(memory.variables.iter().flatten().map(|x| x.to_bits()));
    }
    bits.push(s.state.energy.residual.to_bits());
    (bits, s.state.steps)
}

fn bits(loaded: &LoadedCase, threads: usize, steps: Result<u64, Duration>) -> (Vec<u64>, u64) {
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .unwrap();
    // Threads are used in small scenes too.
    divide_loops_from((threads > 1).then_some(0));
    pool.install(|| {
        let mut simulation = built(loaded);
        simulation.options_mut().solver.parallel = threads > 1;
        in_dimension!(&mut simulation, |s| stepped(s, steps))
    })
}

#[test]
fn every_shipped_case_twice_and_on_two_threads() {
    all_cases_repeat(Duration::from_millis(200), &[2]);
}

#[test]
#[ignore = "nightly: minutes; the same with fewer steps is every_shipped_case_twice_and_on_two_threads"]
fn every_shipped_case_for_longer() {
    all_cases_repeat(Duration::from_secs(3), &[2, 3]);
}

fn all_cases_repeat(time: Duration, more_threads: &[usize]) {
    for path in cases() {
        let loaded = load(&path, &[]).unwrap_or_else(|e| panic!("{e}"));
        let (first, steps) = bits(&loaded, 1, Err(time));
        let name = path.file_stem().unwrap().to_string_lossy().into_owned();
        println!("{name}: {steps} steps, {} numbers", first.len());
        assert!(first.len() > 4);
        let again = bits(&loaded, 1, Ok(steps)).0;
        assert!(first == again, "{name}: another run, other bits");
        for threads in more_threads {
            let many = bits(&loaded, *threads, Ok(steps)).0;
            assert!(first == many, "{name}: {threads} threads, other bits");
        }
    }
}

/// A case in which grains of all shapes fall fast on a surface, and over each other.
fn falling(dimension: usize, floor: &str, period: &str) -> LoadedCase {
    let mut grains = [String::new(), String::new(), String::new()];
    for k in 0..48u32 {
        let t = f64::from(k);
        let (column, row) = (f64::from(k % 8), f64::from(k / 8));
        let (x, turn) = (0.1 * column - 0.35, (1.7 * t).sin());
        let speed = -3.0 - (0.7 * t).cos();
        let shift = 0.01 * (2.3 * t).sin();
        let (kind, grain) = if dimension == 2 {
            let at = format!(
                "at: [{}, {}], velocity: [{turn}, {speed}]",
                x + shift,
                0.15 + 0.1 * row
            );
            let pentagon =
                "(0.03, 0.0), (0.01, 0.03), (-0.03, 0.02), (-0.03, -0.02), (0.01, -0.03)";
            match k % 3 {
                0 => (0, format!("({at}, radius: 0.03)")),
                1 => (
                    1,
                    format!("({at}, points: [{pentagon}], spin: [{}])", 9.0 * turn),
                ),
                _ => (
                    2,
                    format!(
                        "({at}, shapes: [Capsule(from: (-0.02, 0.0), to: (0.02, 0.0), radius: 0.015)])"
                    ),
                ),
            }
        } else {
            let y = 0.1 * f64::from(k / 8 % 3) - 0.1;
            let at = format!(
                "at: [{}, {}, {}], velocity: [{turn}, {shift}, {speed}]",
                x + shift,
                y - shift,
                0.3 + 0.1 * f64::from(k / 24)
            );
            match k % 3 {
                0 => (0, format!("({at}, radius: 0.03)")),
                1 => (
                    1,
                    format!(
                        "({at}, size: (0.05, 0.04, 0.03), turned: [{turn}, 0.3, 0.2], spin: [{turn}, 9.0, 2.0])"
                    ),
                ),
                _ => (
                    2,
                    format!(
                        "({at}, shapes: [Capsule(from: (-0.02, 0.0, 0.0), to: (0.02, 0.0, 0.0), radius: 0.015)])"
                    ),
                ),
            }
        };
        grains[kind] += &(grain + ", ");
    }
    let solids = if dimension == 2 {
        "Polygons"
    } else {
        "Polyhedra"
    };
    let gravity = ["[0.0, -9.81]", "[0.0, 0.0, -9.81]"][dimension - 2];
    let text = format!(
        r#"(
    name: "all shapes fall",
    dimension: {dimension},
    time: (step: 2e-3, end: 1.0),
    gravity: {gravity},
    {period}
    detection: (alert: 1e-3, skin: 0.01),
    solver: (tolerance: 1e-4, max_iterations: 2000),
    materials: {{"grain": "verification_grain"}},
    interfaces: [(name: "joints", between: ("grain", "grain"), contact: "coulomb", parameters: (contact: {{"mu": 0.3}}))],
    bodies: [(name: "floor", material: "grain", shapes: [{floor}])],
    grains: [
        List(material: "grain", grains: [{}]),
        {solids}(material: "grain", grains: [{}]),
        Clusters(material: "grain", grains: [{}]),
    ],
)"#,
        grains[0], grains[1], grains[2]
    );
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/cases/verification");
    load_text("falling.ron", &text, folder.as_ref(), &[]).unwrap_or_else(|e| panic!("{e}"))
}

#[test]
fn all_shapes_on_every_surface_on_any_number_of_threads() {
    let rough = "RoughProfile(points: 60, rms: 0.01, hurst: 0.8, longest: 0.4, shortest: 0.05, height: 0.0, side: Below)";
    let field = "HeightField(points: (16, 16), spacing: (0.1, 0.1), rms: 0.02)";
    for (dimension, floor, period) in [
        (2, "HalfSpace(normal: [0.0, 1.0])", ""),
        (2, rough, "periodic: (x: 0.8),"),
        (2, "Drum(radius: 0.9)", ""),
        (3, "HalfSpace(normal: [0.0, 0.0, 1.0])", ""),
        (3, field, "periodic: (x: 1.6, y: 1.6),"),
        (3, "Mesh(file: \"valley.obj\", scale: 0.5)", ""),
        (3, "Drum(radius: 0.7, axis: 1)", ""),
    ] {
        let loaded = falling(dimension, floor, period);
        let first = bits(&loaded, 1, Ok(160)).0;
        let contacts = first.len() / dimension - 2 * 49;
        assert!(contacts >= 10, "{floor}: {contacts} contacts");
        for threads in [2, 3] {
            let many = bits(&loaded, threads, Ok(160)).0;
            assert!(first == many, "{floor}: {threads} threads, other bits");
        }
    }
}

/// Sums over the contacts.
#[derive(Default)]
struct Sums {
    /// Sum of normal impulses over contacts and steps (N s).
    pressed: f64,
    /// Energy dissipated by friction and impacts (J).
    lost: f64,
    contacts: usize,
    broken: u64,
}

impl Sums {
    fn add(&mut self, other: &Self) {
        self.pressed += other.pressed;
        self.lost += other.lost;
        self.contacts += other.contacts;
        self.broken += other.broken;
    }
}

/// State after some steps with the grains' balls in their order, or in reverse order: names, order
/// and sides of contacts follow.
fn sums<S: Space>(s: &mut Simulation<S>, turned: bool, steps: u64) -> Sums {
    if turned {
        let grain: Vec<bool> = s.state.bodies.grain_flags();
        let of_grains = |b: &usize| grain[s.shapes.balls[*b].body as usize];
        let places: Vec<usize> = (0..s.shapes.balls.len()).filter(of_grains).collect();
        let balls: Vec<_> = places.iter().map(|p| s.shapes.balls[*p].clone()).collect();
        for (place, ball) in places.iter().zip(balls.into_iter().rev()) {
            s.shapes.balls[*place] = ball;
        }
    }
    let mut pressed = 0.0;
    while s.state.steps < steps {
        s.step().unwrap_or_else(|e| panic!("{e}"));
        let contacts = s.state.network.contacts.iter();
        pressed += contacts.map(|c| c.impulse.dot(&c.normal)).sum::<f64>();
    }
    let names: Vec<Key> = s.state.network.contacts.iter().map(|c| c.key).collect();
    assert!(names.is_sorted());
    Sums {
        pressed,
        lost: s.state.energy.friction + s.state.energy.impact,
        contacts: s.state.network.contacts.len(),
        broken: s.state.network.bonds_broken(),
    }
}

#[test]
fn contacts_in_another_order_give_the_same_sums() {
    let far = |x: f64, y: f64| (x - y).abs() / x.abs().max(y.abs()).max(f64::MIN_POSITIVE);
    // Collapsing columns differ after each impact: only averages over some of them agree.
    for (case, steps, samples) in [
        ("biaxial", 600, 1),
        ("plane_shear", 600, 1),
        ("wheel_rail_rigid", 300, 1),
        ("shear_cell_3d", 300, 1),
        ("collapse", 1200, 8),
    ] {
        let path = format!("{}/cases/{case}.ron", env!("CARGO_MANIFEST_DIR"));
        let [mut a, mut b] = [Sums::default(), Sums::default()];
        for seed in 1..=samples {
            let set = (samples > 1).then(|| format!("seed={seed}"));
            let loaded = load(path.as_ref(), set.as_slice()).unwrap_or_else(|e| panic!("{e}"));
            let [one, other] = [false, true]
                .map(|turned| in_dimension!(&mut built(&loaded), |s| sums(s, turned, steps)));
            // A heap at rest may carry its load in ways that differ by this much.
            let apart = far(one.pressed, other.pressed);
            assert!(apart < 0.15, "{case}, sample {seed}: {apart:.1e}");
            a.add(&one);
            b.add(&other);
        }
        let (pressed, lost) = (far(a.pressed, b.pressed), far(a.lost, b.lost));
        println!(
            "{case}, {steps} steps: normal impulses {pressed:.1e} apart, lost energy {lost:.1e}, contacts {} and {}, broken \
             bonds {} and {}",
            a.contacts, b.contacts, a.broken, b.broken
        );
        assert!(pressed < 0.05 && lost < 0.05, "{case}");
    }
}
