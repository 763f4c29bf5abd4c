//! A contact keeps its name over a restart, without another grain, and with the grains listed in
//! another order.

#![allow(clippy::unwrap_used, reason = "a test fails by it")]

use fretwork_core::contact::{ContactId, ContactNames};
use fretwork_core::geometry::space::{Dim2, Dim3, Space};
use fretwork_core::laws::{BuiltInLaws, SearchPath};
use fretwork_core::step::{Simulation, State};
use fretwork_core::view::AnySimulation;
use fretwork_scene::load;
use std::collections::{BTreeMap, BTreeSet};

fn path() -> SearchPath {
    let laws = BuiltInLaws::new(fretwork_laws::plugins());
    SearchPath::new(&[]).with_built_in(laws)
}

/// A case of grains on a plane, which are listed as given.
fn scene(name: &str, dimension: usize, group: &str, grains: &[String]) -> AnySimulation {
    let (normal, gravity) = match dimension {
        2 => ("[0.0, 1.0]", "[0.0, -9.81]"),
        _ => ("[0.0, 0.0, 1.0]", "[0.0, 0.0, -9.81]"),
    };
    let text = format!(
        "(name: \"names\", dimension: {dimension}, time: (step: 1e-3, end: 1.0), gravity: {gravity},
        solver: (tolerance: 1e-12, norm: Velocity, max_iterations: 100000),
        detection: (alert: 2e-3, skin: 1e-2), materials: {{\"grain\": \"verification_grain\"}},
        interfaces: [(name: \"joints\", between: (\"grain\", \"grain\"), contact: \"coulomb\", parameters: (contact: {{\"mu\": 0.5}}))],
        bodies: [(name: \"ground\", material: \"grain\", shapes: [HalfSpace(normal: {normal})])],
        grains: [{group}(material: \"grain\", grains: [{}])])",
        grains.join(", ")
    );
    let file = std::env::temp_dir().join(format!("fretwork-{}-{name}.ron", std::process::id()));
    std::fs::write(&file, text).unwrap();
    let built = load(&file, &[]).and_then(|loaded| loaded.build(&path()));
    std::fs::remove_file(&file).ok();
    built.unwrap_or_else(|e| panic!("{e}")).simulation
}

fn plane(simulation: AnySimulation) -> Simulation<Dim2> {
    simulation.into_dimension().unwrap()
}

fn solid(simulation: AnySimulation) -> Simulation<Dim3> {
    simulation.into_dimension().unwrap()
}

fn steps<S: Space>(s: &mut Simulation<S>, count: u32) {
    for _ in 0..count {
        s.step().unwrap();
    }
}

/// Returns gaps by the names of the contacts, which are unique.
fn named<S: Space>(s: &Simulation<S>) -> BTreeMap<ContactId, f64> {
    let names = ContactNames::of(&s.shapes, &s.state.bodies);
    let places = names.places(&s.state.network);
    assert_eq!(
        places.len(),
        s.state.network.contacts.len(),
        "two of one name"
    );
    let gap = |k: usize| s.state.network.contacts[k].gap;
    places.into_iter().map(|(id, k)| (id, gap(k))).collect()
}

/// A stack of four blocks, each slightly displaced and rotated, so that corners and sides differ.
fn blocks() -> Vec<String> {
    let block = |k: usize| {
        let (x, y) = (0.011 * k as f64 * k as f64, 0.05 + 0.1005 * k as f64);
        let corners = "[(-0.1,-0.05), (0.1,-0.05), (0.1,0.05), (-0.1,0.05)]";
        format!("(at: [{x}, {y}], points: {corners})")
    };
    (0..4).map(block).collect()
}

/// Three stacked boxes, rotated about the vertical, so that edges cross.
fn boxes() -> Vec<String> {
    let one = |k: usize| {
        let z = 0.05 + 0.1005 * k as f64;
        let mut corners = Vec::new();
        for x in [-0.1, 0.1] {
            for y in [-0.1, 0.1] {
                corners.extend([-0.05, 0.05].map(|z| format!("({x}, {y}, {z})")));
            }
        }
        let corners = corners.join(", ");
        let turned = 0.3 * k as f64;
        format!("(at: [0.0, 0.0, {z}], points: [{corners}], turned: [0.0, 0.0, {turned}])")
    };
    (0..3).map(one).collect()
}

/// Returns the scene with its grains in reverse order, under the same identities.
fn backwards<S: Space>(mut s: Simulation<S>, grains: usize) -> Simulation<S> {
    let ids: Vec<u64> = s.state.bodies.id.clone();
    let grain: Vec<usize> = (0..s.state.bodies.len())
        .filter(|b| !s.state.bodies.driven.iter().any(|d| d.body as usize == *b))
        .collect();
    assert_eq!(grain.len(), grains);
    for (k, b) in grain.iter().enumerate() {
        s.state.bodies.id[*b] = ids[grain[grains - 1 - k]];
    }
    s
}

fn same_names<S: Space>(mut one: Simulation<S>, mut other: Simulation<S>) -> usize {
    steps(&mut one, 20);
    steps(&mut other, 20);
    let (a, b) = (named(&one), named(&other));
    let keys = |m: &BTreeMap<ContactId, f64>| m.keys().copied().collect::<BTreeSet<_>>();
    assert_eq!(keys(&a), keys(&b));
    for (id, gap) in &a {
        assert!((gap - b[id]).abs() < 1e-6, "{id:?}: {gap:e} {:e}", b[id]);
    }
    a.len()
}

#[test]
fn in_another_listing() {
    let mut listed = blocks();
    let one = plane(scene("one", 2, "Polygons", &listed));
    listed.reverse();
    let other = backwards(plane(scene("other", 2, "Polygons", &listed)), 4);
    assert!(same_names(one, other) >= 8);
    let mut listed = boxes();
    let one = solid(scene("one-3d", 3, "Polyhedra", &listed));
    listed.reverse();
    let other = backwards(solid(scene("other-3d", 3, "Polyhedra", &listed)), 3);
    assert!(same_names(one, other) >= 12);
}

#[test]
fn without_another_grain() {
    let all = blocks();
    let mut whole = plane(scene("whole", 2, "Polygons", &all));
    steps(&mut whole, 1);
    let (a, ids) = (named(&whole), whole.state.bodies.id.clone());
    // In a stack without its top or its lowest block, the others and the ground keep their
    // identities.
    for (name, gone) in [("top", 3), ("lowest", 0)] {
        let mut left = all.clone();
        left.remove(gone);
        let mut short = plane(scene(name, 2, "Polygons", &left));
        short.state.bodies.id = ids.clone();
        short.state.bodies.id.remove(gone);
        steps(&mut short, 1);
        let b = named(&short);
        let stays = |id: &&ContactId| id.sides.iter().all(|s| s.body != ids[gone]);
        let kept: Vec<&ContactId> = a.keys().filter(stays).collect();
        assert!(kept.len() >= 4 && kept.len() < a.len(), "{name}");
        assert!(kept.iter().all(|id| b.contains_key(id)), "{name}: {b:?}");
        // Keys number contactors as they are listed, so that they differ.
        let names = |s: &Simulation<Dim2>| ContactNames::of(&s.shapes, &s.state.bodies);
        let matched =
            names(&whole).matched(&whole.state.network, &names(&short), &short.state.network);
        assert_eq!(matched.len(), kept.len(), "{name}");
        assert!(matched.iter().all(|(x, y)| (x.gap - y.gap).abs() < 1e-6));
        assert_eq!(matched.iter().any(|(x, y)| x.key != y.key), gone == 0);
    }
}

#[test]
fn over_a_restart() {
    let mut whole = solid(scene("before", 3, "Polyhedra", &boxes()));
    steps(&mut whole, 30);
    let before = named(&whole);
    let bytes = postcard::to_stdvec(&whole.state).unwrap();
    let mut resumed = solid(scene("after", 3, "Polyhedra", &boxes()));
    let saved: State<Dim3> = postcard::from_bytes(&bytes).unwrap();
    assert!(resumed.restore(saved));
    assert!(before.len() >= 12);
    assert_eq!(named(&resumed), before);
    steps(&mut whole, 10);
    steps(&mut resumed, 10);
    let (a, b) = (named(&whole), named(&resumed));
    assert!(a.keys().eq(b.keys()));
    assert!(
        a.values()
            .zip(b.values())
            .all(|(x, y)| x.to_bits() == y.to_bits())
    );
}
