//! Detection of disks and points, by the public functions.

use super::*;
use crate::contact::network::Key;
use crate::geometry::convex::polygon::Polygon;
use crate::geometry::polyline::Polyline;
use crate::geometry::space::Dim2;
use crate::step::Simulation;
use nalgebra::{Vector1, Vector2};

const H: f64 = 1e-3;

/// Lets shapes of material 0 touch by law 0.
fn touching(mut s: Simulation<Dim2>) -> Simulation<Dim2> {
    s.table.set(0, 0, 0);
    let Network {
        alert, skin, fast, ..
    } = s.state.network;
    s.state.network = Network::new(alert, skin, &[0]);
    s.state.network.fast = fast;
    s
}

fn find(s: &mut Simulation<Dim2>) {
    let times = [s.state.time, H];
    let scene = CollisionScene::new(&s.shapes, &s.state.bodies, &s.table);
    detect(&mut s.state.network, &scene, times, false);
}

/// Adds the contacts that bodies meet in a step with these velocities.
fn predict(s: &mut Simulation<Dim2>, velocities: &[Vector2<f64>]) {
    let velocities: Vec<_> = velocities.iter().map(|v| (*v, Vector1::zeros())).collect();
    let motion = StepMotion {
        velocities: &velocities,
        time: 0.0,
        h: H,
        parallel: false,
    };
    let scene = CollisionScene::new(&s.shapes, &s.state.bodies, &s.table);
    add_predicted(&mut s.state.network, &scene, &motion);
}

/// A pair whose bond broke is marked as such in each new contact: when it has separated and meets
/// again, and in a contact that is predicted.
#[test]
fn a_broken_pair_is_remembered_when_it_meets_again() {
    let disks = [([0.0, 0.0], 0.5), ([1.0, 0.0], 0.5), ([2.0, 0.0], 0.5)];
    let mut s = touching(Simulation::of_disks(&disks));
    find(&mut s);
    assert_eq!(s.state.network.contacts.len(), 2);
    // A bond of the second pair breaks.
    let slot = s.state.network.memory[0].allocate(true, 0.0, 1.0, &[]);
    s.state.network.contacts[1].slot = slot;
    let contact = s.state.network.contacts[1].clone();
    drop_contact(&mut s.state.network, &contact);
    s.state.network.contacts[1].slot = crate::contact::Contact::<Dim2>::NO_MEMORY;
    for apart in [0.1, 0.0] {
        s.state.bodies.position[2].x = 2.0 + apart;
        find(&mut s);
    }
    let broken: Vec<bool> = s.state.network.contacts.iter().map(|c| c.broken).collect();
    assert_eq!(broken, [false, true]);
    // The disk is beyond the alert distance, and fast.
    s.state.bodies.position[2].x = 2.1;
    s.state.bodies.position[1].x = 1.0 + 1e-6;
    find(&mut s);
    assert_eq!(s.state.network.contacts.len(), 1);
    let mut velocities = [Vector2::zeros(); 3];
    velocities[2].x = -0.2 / H;
    predict(&mut s, &velocities);
    let predicted: Vec<_> = s
        .state
        .network
        .contacts
        .iter()
        .filter(|c| c.closing)
        .collect();
    assert_eq!(predicted.len(), 1);
    assert_eq!(predicted[0].bodies, [1, 2]);
    assert!(predicted[0].broken);
    // The reduced radius of two disks of 0.5 m.
    assert_eq!(predicted[0].radius, 0.25);
}

/// A point of a body of 1 m moves fast towards a chain, which is detected from behind only within
/// the alert distance of 1 mm. The motion of the point is followed in increments of that distance,
/// whatever the size of its body, and the point meets the chain where it reaches it.
#[test]
fn a_point_is_followed_in_parts_of_the_alert_distance() {
    for (height, depth) in [(0.02, 0.5), (0.3, 0.01), (0.7, 2.0)] {
        let mut s = Simulation::of_disks(&[([0.25, height], 1.0)]);
        s.shapes.balls[0].radius = 0.0;
        let chain = [-1.0, 0.0, 1.0].map(|x| Vector2::new(x, 0.0)).to_vec();
        s.add_surface(Polyline::new(chain, None).unwrap());
        let mut s = touching(s);
        find(&mut s);
        assert!(s.state.network.contacts.is_empty());
        let down = Vector2::new(0.0, -(height + depth) / H);
        predict(&mut s, &[down, Vector2::zeros()]);
        let [contact] = &s.state.network.contacts[..] else {
            panic!("{:?}", s.state.network.contacts)
        };
        assert_eq!(contact.key.pair(), (0, Key::SURFACE));
        assert!(contact.closing && contact.beyond);
        assert_eq!(contact.normal, Vector2::new(0.0, 1.0));
        assert!(
            (contact.gap - height).abs() < 1e-12,
            "{height}: {}",
            contact.gap
        );
    }
}

/// A disk above a chain with two flanks, its centre over the edge between them.
fn disk_between_flanks() -> Simulation<Dim2> {
    let mut s = Simulation::of_disks(&[([0.0, 0.5 * 2f64.sqrt()], 0.5)]);
    let chain = [(-2.0, 2.0), (0.0, 0.0), (2.0, 2.0)];
    let chain = chain.map(|(x, y)| Vector2::new(x, y)).to_vec();
    s.add_surface(Polyline::new(chain, None).unwrap());
    touching(s)
}

/// A disk in a right-angled groove touches both flanks, each on its face.
#[test]
fn a_disk_in_a_groove_touches_two_faces() {
    let mut s = disk_between_flanks();
    find(&mut s);
    let contacts = &s.state.network.contacts;
    assert_eq!(contacts.len(), 2);
    let half = 0.5f64.sqrt();
    for (contact, side) in contacts.iter().zip([1.0, -1.0]) {
        assert!((contact.normal - Vector2::new(side * half, half)).norm() < 1e-15);
        assert!(contact.gap.abs() < 1e-15 && !contact.vertex_contact);
        assert_eq!((contact.radius, contact.bodies), (0.5, [0, 1]));
        // The arms go from either centre to one point of the flank.
        let place = Vector2::new(-side * 0.5 * half, 0.5 * half);
        let from_disk = place - s.state.bodies.position[0];
        assert!((contact.arms[0] - from_disk).norm() < 1e-15);
        assert!((contact.arms[1] - place).norm() < 1e-15);
    }
}

/// A bond holds its contact however far its bodies move apart in a step, whichever body moves;
/// without a bond the contact ends at the alert distance.
#[test]
fn a_bond_keeps_the_contact_of_bodies_that_part_fast() {
    for bonded in [true, false] {
        for (moves, way) in [(0, 0.02), (1, -0.02)] {
            let mut s = Simulation::of_disks(&[([0.25, 0.5], 0.5)]);
            let chain = [-2.0, 0.0, 2.0].map(|x| Vector2::new(x, 0.0)).to_vec();
            s.add_surface(Polyline::new(chain, None).unwrap());
            let mut s = touching(s);
            find(&mut s);
            assert_eq!(s.state.network.contacts.len(), 1);
            if bonded {
                let slot = s.state.network.memory[0].allocate(true, 0.0, 1.0, &[]);
                s.state.network.contacts[0].slot = slot;
            }
            for k in 1..=3 {
                s.state.bodies.velocity[moves].y = way / H;
                s.state.bodies.position[moves].y += way;
                find(&mut s);
                let contacts = &s.state.network.contacts;
                assert_eq!(contacts.len(), usize::from(bonded), "{moves} {k}");
                for contact in contacts {
                    assert!((contact.gap - 0.02 * f64::from(k)).abs() < 1e-15);
                    assert!(s.state.network.bond(contact).unwrap().intact());
                }
            }
            let network = &s.state.network;
            assert_eq!((network.bonds_broken(), network.torn_energy), (0, 0.0));
        }
    }
}

/// Two disks, then two squares on bodies whose centres are not those of the squares, in a row along
/// x: neighbours touch, each square at its own place.
#[test]
fn disks_and_squares_touch_where_they_stand() {
    let mut s = Simulation::of_disks(&[([0.0, 0.0], 0.5), ([1.0, 0.0], 0.5)]);
    let corners = [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)];
    for (x, offset) in [(2.0, [0.25, 0.0]), (3.0, [0.0, -0.5])] {
        let offset = Vector2::from(offset);
        let at = Vector2::new(x, 0.0) - offset;
        let corners = corners.map(|(x, y)| Vector2::new(x, y)).to_vec();
        s.shapes.pieces.push(ConvexCollider {
            body: s.state.bodies.add(at, 1.0, 1.0, 0.5),
            core: Polygon::new(corners).unwrap(),
            offset,
            rounding: 0.0,
            bound: 0.5f64.sqrt(),
            size: 0.5,
            material: 0,
        });
    }
    let mut s = touching(s);
    find(&mut s);
    let contacts = &s.state.network.contacts;
    let mut pairs: Vec<[u32; 2]> = contacts.iter().map(|c| c.bodies).collect();
    pairs.dedup();
    assert_eq!(pairs, [[0, 1], [1, 2], [2, 3]]);
    // Faces touch at both ends.
    assert_eq!(contacts.len(), 4);
    for contact in contacts {
        assert!(contact.gap.abs() < 1e-15);
        assert_eq!(contact.normal.x.abs(), 1.0);
        let [i, j] = contact.bodies.map(|b| s.state.bodies.position[b as usize]);
        let places = [i + contact.arms[0], j + contact.arms[1]];
        assert!((places[0] - places[1]).norm() < 1e-15);
        let between = 0.5 + f64::from(contact.bodies[0]);
        assert!((places[0].x - between).abs() < 1e-15);
    }
}
