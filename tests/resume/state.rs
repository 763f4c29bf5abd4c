//! The state of a simulation, put into bytes and taken up by a simulation that was built anew.

use fretwork::geometry::space::Space;
use fretwork::laws::SearchPath;
use fretwork::record::code::{decode, encode};
use fretwork::scene::{Built, Scene, load};
use fretwork::step::{Saved, Simulation};
use std::path::Path;

fn built(case: &str, sets: &[&str]) -> Scene {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("cases/{case}.ron"));
    let sets: Vec<String> = sets.iter().map(|s| (*s).to_owned()).collect();
    let loaded = load(&path, &sets).unwrap_or_else(|e| panic!("{e}"));
    let scene = loaded.build(&SearchPath::new(&[]));
    scene.unwrap_or_else(|e| panic!("{e}"))
}

/// All that a simulation holds, as text: numbers are printed so that they read back as they are.
fn all<S: Space>(s: &Simulation<S>) -> Vec<u8> {
    encode(&s.save()).unwrap()
}

fn steps<S: Space>(s: &mut Simulation<S>, count: u32) {
    for _ in 0..count {
        s.step().unwrap_or_else(|e| panic!("{e}"));
    }
}

pub fn goes_on<S: Space>([one, other]: [Built<S>; 2], before: u32, after: u32) {
    let (mut whole, mut resumed) = (one.simulation, other.simulation);
    steps(&mut whole, before);
    let bytes = all(&whole);
    let saved: Saved<'_, S> = decode(&bytes).unwrap();
    assert!(resumed.restore(saved));
    assert!(
        all(&resumed) == bytes,
        "what is put back is not what was kept"
    );
    steps(&mut whole, after);
    steps(&mut resumed, after);
    assert!(whole.steps == u64::from(before + after));
    assert!(all(&whole) == all(&resumed), "the steps after it differ");
    let impulses = |s: &Simulation<S>| -> Vec<S::Vector> {
        s.network.contacts.iter().map(|c| c.impulse).collect()
    };
    assert!(!whole.network.contacts.is_empty());
    assert_eq!(impulses(&whole), impulses(&resumed));
}

fn check(case: &str, sets: &[&str], before: u32, after: u32) {
    match [built(case, sets), built(case, sets)] {
        [Scene::Plane(a), Scene::Plane(b)] => goes_on([*a, *b], before, after),
        [Scene::Solid(a), Scene::Solid(b)] => goes_on([*a, *b], before, after),
        _ => panic!("one case, two dimensions"),
    }
}

#[test]
fn a_plane_scene_goes_on_with_the_same_bits() {
    check("wheel_rail_fretting", &[], 60, 60);
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

#[test]
fn a_state_of_another_scene_is_not_taken() {
    let [Scene::Plane(one), Scene::Plane(other)] = [
        built("verification/column", &[]),
        built("wheel_rail_fretting", &[]),
    ] else {
        panic!("two plane cases");
    };
    let (one, mut other) = (one.simulation, other.simulation);
    let before = all(&other);
    let saved = decode(&all(&one)).unwrap();
    assert!(!other.restore(saved));
    assert!(all(&other) == before);
}
