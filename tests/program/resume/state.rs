//! The state of a simulation is serialised, and restored by a simulation that was built again.

use fretwork::AnySimulation;
use fretwork::geometry::space::{Dim2, Space};
use fretwork::record::encoding::{decode, encode};
use fretwork::scene::load;
use fretwork::shipped::search_path;
use fretwork::solve::local::solver::Method;
use fretwork::step::{Simulation, State};
use std::path::Path;

pub fn built(case: &str, sets: &[&str]) -> AnySimulation {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("cases/{case}.ron"));
    let sets: Vec<String> = sets.iter().map(|s| (*s).to_owned()).collect();
    let loaded = load(&path, &sets).unwrap_or_else(|e| panic!("{e}"));
    let built = loaded.build(&search_path());
    built.unwrap_or_else(|e| panic!("{e}")).simulation
}

/// The simulation of a case of this dimension.
fn in_its_dimension<S: Space>(case: &str, sets: &[&str]) -> Simulation<S> {
    let simulation = built(case, sets).into_dimension();
    simulation.unwrap_or_else(|_| panic!("{case} has another dimension"))
}

/// Content of a simulation as text, with numbers in a form that reads back exactly.
pub fn all<S: Space>(s: &Simulation<S>) -> Vec<u8> {
    encode(&s.state).unwrap()
}

pub fn steps<S: Space>(s: &mut Simulation<S>, count: u32) {
    for _ in 0..count {
        s.step().unwrap_or_else(|e| panic!("{e}"));
    }
}

pub fn goes_on<S: Space>(both: [Simulation<S>; 2], before: u32, after: u32) {
    let [mut whole, mut resumed] = both;
    steps(&mut whole, before);
    let bytes = all(&whole);
    let saved: State<S> = decode(&bytes).unwrap();
    assert!(resumed.restore(saved));
    assert!(
        all(&resumed) == bytes,
        "what is put back is not what was kept"
    );
    steps(&mut whole, after);
    steps(&mut resumed, after);
    assert!(whole.state.steps == u64::from(before + after));
    assert!(all(&whole) == all(&resumed), "the steps after it differ");
    let impulses = |s: &Simulation<S>| -> Vec<S::Vector> {
        s.state.network.contacts.iter().map(|c| c.impulse).collect()
    };
    assert!(!whole.state.network.contacts.is_empty());
    assert_eq!(impulses(&whole), impulses(&resumed));
}

fn check(case: &str, sets: &[&str], before: u32, after: u32) {
    match [built(case, sets), built(case, sets)] {
        [AnySimulation::Plane(a), AnySimulation::Plane(b)] => goes_on([*a, *b], before, after),
        [AnySimulation::Space(a), AnySimulation::Space(b)] => goes_on([*a, *b], before, after),
        _ => panic!("one case, two dimensions"),
    }
}

#[test]
fn a_plane_scene_goes_on_with_the_same_bits() {
    check("wheel_rail_rigid", &[], 60, 60);
}

#[test]
fn a_scene_in_space_goes_on_with_the_same_bits() {
    check("shear_cell_3d", &[], 40, 40);
}

#[test]
fn bodies_of_any_inertia_go_on_with_the_same_bits() {
    check("verification/voronoi_plate_3d", &[], 20, 20);
}

#[test]
fn a_surface_that_wears_goes_on_from_what_it_shows() {
    check("verification/worn_slide", &[], 50, 60);
    check("verification/worn_slide_3d", &[], 50, 60);
}

/// A sphere slips on a half-space that wears, and on a block of finite elements.
#[test]
fn a_deformable_body_that_wears_in_space_goes_on_with_the_same_bits() {
    let law = "interfaces=[(name: \"contact\", between: (\"steel\", \"steel\"), contact: \"coulomb\", wear: \"archard\", \
               parameters: (contact: {\"mu\": 0.6}, wear: {\"k\": 2e-10}))]";
    let slides =
        "half_spaces.1.dofs.x=Displacement(Sine(amplitude: 5e-6, frequency: 20.0, start: 0.01))";
    let wears = "half_spaces.0.wears=(thickness: 1e-4, every: 3)";
    check("sphere_on_flat_fretting", &[law, slides, wears], 25, 10);
    let cells = "x: (from: -4e-4, to: 4e-4, size: 1e-4), y: (from: -4e-4, to: 4e-4, size: 1e-4)";
    let block = "elastic=[(
        name: \"flat\", material: \"steel\",
        mesh: Block(x: (from: -1e-3, to: 1e-3, size: 2e-4), y: (from: -1e-3, to: 1e-3, size: 2e-4), z: (from: -1e-3, to: 0.0, size: 2e-4)),
        supports: [(part: \"bottom\", x: Fixed, y: Fixed, z: Fixed)], touches: Surface(\"top\"), wears: (thickness: 1e-4),
    )]";
    let sphere = format!(
        "half_spaces=[(
            name: \"sphere\", material: \"steel\", side: Above, {cells}, profile: Summit(x: 0.05, y: 0.05), mass: 0.01, touches: Points,
            dofs: (x: Displacement(Sine(amplitude: 5e-6, frequency: 20.0, start: 0.01)), z: Force(Ramp(from: 0.0, to: -99.52, start: 0.0, end: 8e-3))),
        )]"
    );
    check(
        "sphere_on_flat_fretting",
        &[law, block, &sphere, "friction.body=sphere"],
        25,
        10,
    );
}

/// A state has no tangent, which is formed again.
#[test]
fn a_body_in_large_strain_goes_on_with_the_same_bits() {
    check("verification/rubber_block", &[], 10, 10);
}

#[test]
fn a_state_of_another_scene_is_not_taken() {
    let one = in_its_dimension::<Dim2>("verification/column", &[]);
    let mut other = in_its_dimension::<Dim2>("wheel_rail_rigid", &[]);
    let before = all(&other);
    let saved = decode(&all(&one)).unwrap();
    assert!(!other.restore(saved));
    assert!(all(&other) == before);
}

/// Load on a column is crossed neither by sweeps in their share of a step nor by Newton's method:
/// what `auto` learns from this is part of the state. Results on two threads are bit-identical to
/// those on one.
#[test]
fn what_auto_learned_goes_on_with_the_same_bits() {
    const DISKS: usize = 10_000;
    let grains: Vec<String> = (0..DISKS)
        .map(|k| format!("(at: [0.0, {:?}], radius: 0.1)", 0.1 + 0.2 * k as f64))
        .collect();
    let case = format!(
        r#"(name: "column", dimension: 2, time: (step: 1e-3, end: 1.0), gravity: [0.0, -9.81],
            solver: (tolerance: 1e-12, max_iterations: 100000), detection: (alert: 1e-3, skin: 1e-2),
            materials: {{"grain": "grain"}},
            interfaces: [(name: "all", between: ("grain", "grain"), contact: "coulomb", parameters: (contact: {{"mu": 0.3}}))],
            bodies: [(name: "floor", material: "grain", shapes: [HalfSpace(normal: [0.0, 1.0])])],
            grains: [List(material: "grain", grains: [{}])], output: (frames: 0, views: 0, figures: false))"#,
        grains.join(", ")
    );
    let folder = super::common::Folder::new("column");
    std::fs::create_dir_all(folder.0.join("materials")).unwrap();
    let material = r#"(doc: "stone", density: (value: 1000.0, unit: "kg/m^3", source: "chosen"))"#;
    std::fs::write(folder.0.join("materials/grain.ron"), material).unwrap();
    let path = folder.0.join("case.ron");
    std::fs::write(&path, case).unwrap();
    let loaded = load(&path, &[]).unwrap_or_else(|e| panic!("{e}"));
    let build = || loaded.build_in::<Dim2>(&search_path()).unwrap();
    // The weight is doubled in each step, so that the previous solution does not help.
    fn step<S: Space>(s: &mut Simulation<S>) {
        let report = s.step().unwrap_or_else(|e| panic!("{e}"));
        assert!(report.solver.converged, "{:?}", report.solver);
        assert_eq!(report.solver.used, Method::Interior);
        s.state.gravity += s.state.gravity;
    }
    let (mut whole, mut resumed, mut threads) = (build(), build(), build());
    step(&mut whole);
    let bytes = all(&whole);
    assert!(resumed.restore(decode(&bytes).unwrap()));
    assert!(all(&resumed) == bytes);
    step(&mut whole);
    step(&mut resumed);
    assert!(all(&whole) == all(&resumed), "the step after it differs");
    threads.options.solver.parallel = true;
    let pool = rayon::ThreadPoolBuilder::new().num_threads(2).build();
    pool.unwrap().install(|| {
        step(&mut threads);
        step(&mut threads);
    });
    assert!(all(&whole) == all(&threads), "two threads give other bits");
}

/// Phases set friction and the tolerance of the solver for a block on a plane, pulled by an oblique
/// gravity. The state contains the present values, and restores them to a scene that was built
/// again; a scene without the phases rejects it.
#[test]
fn what_phases_have_set_goes_on() {
    let phases = r#"phases=[
        (name: "smooth", until: Steps(20), friction: {"grain": 0.1}, tolerance: 1e-9),
        (name: "tight", until: Steps(20), tolerance: 1e-10),
        (name: "rough", friction: {"grain": 0.4}),
    ]"#;
    let sets = [phases, "gravity=[5.0, -9.81]"];
    check("verification/slide_to_stop", &sets, 30, 20);
    let scene = |sets: &[&str]| in_its_dimension::<Dim2>("verification/slide_to_stop", sets);
    let (mut whole, mut resumed) = (scene(&sets), scene(&sets));
    let mu = |s: &Simulation<_>| s.laws[0].contact().parameters.clone();
    let (given, first) = (resumed.options, mu(&resumed));
    steps(&mut whole, 30);
    let bytes = all(&whole);
    assert!(resumed.restore(decode(&bytes).unwrap()));
    assert_eq!(resumed.solver_in_force().tolerance, 1e-10);
    assert_eq!(resumed.options, given, "no step changes the options");
    assert_eq!(mu(&resumed), mu(&whole));
    assert!(mu(&resumed) != first && mu(&resumed)[0] == 0.1);
    assert!(!scene(&[r#"phases=[(name: "only")]"#]).restore(decode(&bytes).unwrap()));
    let before = all(&whole);
    assert!(
        !whole.restore(decode(&bytes).unwrap()),
        "a scene that has stepped"
    );
    assert!(all(&whole) == before);
}

/// Bonds formed and broken in the last step are read by processes before the next step: they are
/// part of the state.
#[test]
fn bonds_of_the_last_step_are_part_of_the_state() {
    let scene = || in_its_dimension::<Dim2>("verification/healing", &[]);
    let mut whole = scene();
    let formed = (0..2000).any(|_| {
        steps(&mut whole, 1);
        !whole.state.network.bonds_formed.is_empty()
    });
    assert!(formed, "no bond formed");
    let mut resumed = scene();
    assert!(resumed.restore(decode(&all(&whole)).unwrap()));
    assert_eq!(
        resumed.state.network.bonds_formed,
        whole.state.network.bonds_formed
    );
    let broken = (0..4000).any(|_| {
        steps(&mut whole, 1);
        !whole.state.network.bond_breaks.is_empty()
    });
    assert!(broken, "no bond broke");
    let mut resumed = scene();
    assert!(resumed.restore(decode(&all(&whole)).unwrap()));
    let keys = |s: &fretwork::step::Simulation<_>| {
        let breaks = &s.state.network.bond_breaks;
        breaks.iter().map(|b| b.key).collect::<Vec<_>>()
    };
    assert_eq!(keys(&resumed), keys(&whole));
}

/// The motion of the walls in the last step is part of the state: values read between a resumption
/// and the next step are those read before.
#[test]
fn readings_of_the_last_step_are_the_same_after_a_resumption() {
    let scene = || in_its_dimension::<Dim2>("wheel_rail_rigid", &[]);
    let (mut whole, mut resumed) = (scene(), scene());
    steps(&mut whole, 40);
    assert!(resumed.restore(whole.state.clone()));
    let moves = whole.state.started.iter().any(|(v, _)| v.norm() > 0.0);
    assert!(moves, "no wall moves");
    assert_eq!(whole.state.started, resumed.state.started);
    assert_eq!(whole.state.received, resumed.state.received);
}

/// A state with invalid numbers behind a valid checksum is rejected before a step is made.
#[test]
fn a_state_of_no_scene_is_refused() {
    use fretwork::geometry::space::Dim3;
    let scene = || in_its_dimension::<Dim3>("shear_cell_3d", &[]);
    let mut whole = scene();
    steps(&mut whole, 20);
    let bytes = all(&whole);
    type Change = fn(&mut State<Dim3>);
    let changes: [(&str, Change); 16] = [
        ("a ball that is not there", |s| {
            s.network.contacts[0].key.candidate = 1 << 29
        }),
        ("a piece that is not there", |s| {
            s.network.contacts[0].key.antagonist = 1 << 30
        }),
        ("a surface that is not there", |s| {
            s.network.contacts[0].key.antagonist = u32::MAX
        }),
        ("a body that is not there", |s| {
            s.network.contacts[0].bodies[1] = u32::MAX
        }),
        ("another body", |s| s.network.contacts[0].bodies.reverse()),
        ("a law that is not there", |s| s.network.contacts[0].law = 9),
        ("memory that is not there", |s| {
            s.network.contacts[0].slot = 1_000_000
        }),
        ("no gap", |s| s.network.contacts[0].gap = f64::NAN),
        ("no normal", |s| {
            s.network.contacts[0].normal.x = f64::INFINITY
        }),
        ("no order", |s| s.network.contacts.reverse()),
        ("no place", |s| s.bodies.position[3].y = f64::NAN),
        ("no velocity", |s| s.bodies.velocity[3].y = f64::INFINITY),
        ("a mass too many", |s| s.bodies.mass.push(1.0)),
        ("a body less", |s| _ = s.bodies.id.pop()),
        ("a drive less", |s| drop(s.bodies.driven[0].dofs.pop())),
        ("no time", |s| s.time = f64::NAN),
    ];
    for (what, change) in changes {
        let mut state: State<Dim3> = decode(&bytes).unwrap();
        change(&mut state);
        assert!(!scene().restore(state), "{what}");
    }
    assert!(scene().restore(decode(&bytes).unwrap()));
    none_of(
        "verification/worn_slide",
        &[
            ("a scar less", |s| drop(s.scars.pop())),
            ("a scar more", |s| s.scars.push(s.scars[0].clone())),
            ("a scar of another name", |s| s.scars[0].name.push('x')),
            ("a scar of another surface", |s| s.scars[0].surface += 1),
            ("wear of a surface that is not there", |s| {
                _ = s.network.worn.insert(1000, 1.0)
            }),
        ],
    );
    none_of(
        "verification/thermal/slide_to_stop",
        &[
            ("no heat", |s| s.heat = None),
            ("a node less", |s| {
                drop(s.heat.as_mut().map(|h| h.nodes.pop()))
            }),
            ("heat of one body more", |s| {
                s.heat.iter_mut().for_each(|h| h.received.push(0.0));
            }),
            ("a size of one body more", |s| {
                s.heat.iter_mut().for_each(|h| h.stretch.push(1.0))
            }),
        ],
    );
    none_of(
        "verification/healing",
        &[
            ("a law less", |s| drop(s.network.memory.pop())),
            ("a variable more", |s| {
                s.network.memory[0].variables.push(Vec::new())
            }),
            ("other springs", |s| s.network.memory[0].compliant ^= true),
            ("other rotations", |s| s.network.memory[0].rotates ^= true),
            ("a gate of a drive that is not there", |s| {
                s.control.removals.push((1000, 0.0))
            }),
            ("no gravity", |s| s.gravity.x = f64::NAN),
        ],
    );
}

/// A kind of fault of a state, and a function that causes it.
type Fault<'a> = (&'a str, fn(&mut State<Dim2>));

/// States of a 2D case with one of these faults are rejected.
fn none_of(case: &str, changes: &[Fault<'_>]) {
    let scene = || in_its_dimension::<Dim2>(case, &[]);
    let mut whole = scene();
    steps(&mut whole, 20);
    let bytes = all(&whole);
    for (what, change) in changes {
        let mut state: State<Dim2> = decode(&bytes).unwrap();
        change(&mut state);
        assert!(!scene().restore(state), "{case}: {what}");
    }
    assert!(scene().restore(decode(&bytes).unwrap()), "{case}");
}
