use super::{
    AnyUnion, Assembly, ConvexBody, Inertia, InitialState, MassProperties, RecordedPiece, empty,
    half_space, turned,
};
use crate::bodies::{Dof, Driven};
use crate::contact::detect::LawTable;
use crate::geometry::any_shape::AnyPart;
use crate::geometry::convex::polygon::Polygon;
use crate::geometry::periodic::Periodic;
use nalgebra::Vector2;
use std::f64::consts::{FRAC_PI_2, PI};

/// A scene without a period.
fn scene(dimension: usize) -> Box<dyn Assembly> {
    empty(dimension, Periodic { period: [None; 3] })
}

/// Returns two balls of one radius, one metre to the left and right of a position.
fn dumbbell(radius: f64) -> AnyUnion {
    let mut union = AnyUnion::default();
    union.add_ball([-1.0, 0.0, 0.0], radius);
    union.add_ball([1.0, 0.0, 0.0], radius);
    union
}

#[test]
fn a_union_has_the_mass_and_inertia_of_its_shapes() {
    for (dimension, volume, share) in [(2, PI * 0.25, 0.5), (3, PI / 6.0, 0.4)] {
        let mut scene = scene(dimension);
        let start = InitialState {
            position: [3.0, 1.0, 0.0],
            velocity: [0.5, 0.0, 0.0],
            spin: [0.0, 0.0, 2.0],
            ..InitialState::default()
        };
        let union = dumbbell(0.5);
        assert!((union.volume(dimension) - 2.0 * volume).abs() < 1e-14);
        let body = scene.add_union(union, MassProperties::Grain(1000.0), 0, &start);
        let (run, _) = scene.into_simulation(Vec::new(), LawTable::new(1), 0.1, 0.1);
        let mass = 2000.0 * volume;
        let (motion, bodies) = (run.motion(body as usize), run.bodies());
        assert_eq!(motion.position, start.position);
        assert_eq!((motion.velocity, motion.spin), (start.velocity, start.spin));
        assert!((bodies.mass[0] - mass).abs() < 1e-9 * mass);
        let tensor = run.inertia_tensor(0);
        let along = share * 0.25;
        let [first, across] = match dimension {
            2 => [along + 1.0; 2],
            _ => [along, along + 1.0],
        };
        assert!((tensor[0] - mass * first).abs() < 1e-9 * mass, "{tensor:?}");
        if dimension == 3 {
            assert!((tensor[4] - mass * across).abs() < 1e-9 * mass);
            assert!((tensor[8] - mass * across).abs() < 1e-9 * mass);
        }
    }
}

#[test]
fn a_first_body_has_its_own_mass_and_wears_where_it_can() {
    let mut scene = scene(2);
    let mut union = AnyUnion::default();
    union.add_surface([0.0; 3], half_space(2, [0.0, 1.0, 0.0], 1.0));
    let mass_properties = MassProperties::First(2.0, Inertia::Uniform(8.0));
    let body = scene.add_union(union, mass_properties, 0, &InitialState::default());
    scene.drive(Driven {
        name: "floor".to_owned(),
        body,
        dofs: vec![Dof::Fixed; 3],
    });
    assert!(!scene.has_loose_shapes() && scene.thinnest_grain().is_infinite());
    assert!(!scene.add_scar(0, "floor".to_owned(), 1e-3, 1), "a plane");
    assert!(scene.worn_names().is_empty());
    let (run, added) = scene.into_simulation(Vec::new(), LawTable::new(1), 0.1, 0.1);
    assert!(added.is_empty() && run.surfaces()[0].flat.is_some());
    assert_eq!((run.bodies().mass[0], run.bodies().inertia[0]), (2.0, 8.0));
    assert_eq!(run.bodies().length[0], 2.0);
}

#[test]
fn blocks_and_records_are_placed_by_their_centres() {
    let mut scene = scene(2);
    let corners = [(0.0, 0.0), (2.0, 0.0), (2.0, 1.0), (0.0, 1.0)];
    let corners = corners.map(|(x, y)| Vector2::new(x, y)).to_vec();
    let part = AnyPart::Plane(Polygon::new(corners).unwrap().part(0.0));
    let block = ConvexBody::of(part.moved([1.0, 0.0, 0.0]));
    let [x, y, z] = block.start.position;
    assert!((x - 2.0).abs() < 1e-14 && (y - 0.5).abs() < 1e-14 && z == 0.0);
    scene.add_block(block, (0, 10.0));
    let start = InitialState {
        rotation: Some([FRAC_PI_2, 0.0, 0.0, 0.0]),
        ..InitialState::default()
    };
    let inertia = [3.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    let weighed = scene.add_weighed(4.0, &inertia, 2.0, 1.0, &start);
    let body = weighed.unwrap();
    let piece = RecordedPiece {
        rounding: -1.0,
        size: 1.0,
        offset: [0.0; 3],
        corners: vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
        faces: Vec::new(),
    };
    assert!(scene.carry_piece(body, piece, 0).is_err());
    assert!(scene.carry_ball(body, [0.0; 3], 0.0, 0).is_err());
    let (run, _) = scene.into_simulation(Vec::new(), LawTable::new(1), 0.1, 0.1);
    let bodies = run.bodies();
    assert!((bodies.mass[0] - 20.0).abs() < 1e-12 && bodies.mass[1] == 4.0);
    assert!((bodies.inertia[0] - 20.0 * 5.0 / 12.0).abs() < 1e-12);
    assert_eq!(bodies.inertia[1], 6.0);
    assert_eq!(run.motion(1).rotation[0], FRAC_PI_2);
}

#[test]
fn a_vector_turns_by_the_numbers_of_an_orientation() {
    let half = [FRAC_PI_2, 0.0, 0.0, 0.0];
    let [x, y, z] = turned(2, &half, [1.0, 0.0, 0.0]).unwrap();
    assert!(x.abs() < 1e-15 && (y - 1.0).abs() < 1e-15 && z == 0.0);
    assert_eq!(
        turned(3, &[1.0, 0.0, 0.0, 0.0], [1.0, 2.0, 3.0]),
        Some([1.0, 2.0, 3.0])
    );
    assert_eq!(turned(2, &[f64::NAN; 4], [0.0; 3]), None);
}
