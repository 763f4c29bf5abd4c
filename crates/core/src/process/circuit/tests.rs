//! Debris of bonds that break in a given way, between disks at rest.

use super::*;
use crate::contact::events::{BondEnergies, Break};
use crate::contact::memory::Memory;
use crate::contact::network::{Contact, ContactGeometry, Key};
use crate::geometry::space::Dim2;
use nalgebra::{Vector2, Vector3};

/// Creates a first body with index 0, and two grains next to it.
fn scene() -> Simulation<Dim2> {
    let mut s = Simulation::of_disks(&[([0.0, 0.0], 0.5), ([1.0, 0.0], 0.5), ([2.0, 0.0], 0.5)]);
    s.drive(0, Default::default());
    s.state.network.memory = vec![Memory::new(0)];
    s
}

fn key([candidate, antagonist]: [u32; 2]) -> Key {
    Key::new(candidate, antagonist, 0)
}

/// Forms a bond between these bodies.
fn bond(s: &mut Simulation<Dim2>, bodies: [u32; 2]) {
    let geometry = ContactGeometry {
        gap: 0.0,
        normal: Vector2::new(-1.0, 0.0),
        arms: [Vector2::zeros(); 2],
        radius: 0.25,
    };
    let network = &mut s.state.network;
    let slot = network.memory[0].allocate(true, 0.0, 1.0, &[]);
    let contact = Contact::new(key(bodies), bodies, 0, geometry, 0.0);
    network.contacts.push(Contact { slot, ..contact });
}

fn spec() -> CircuitParameters {
    CircuitParameters {
        bases: vec![0],
        interfaces: vec![0],
        zones: Vec::new(),
        scaling: 1.0,
    }
}

/// Returns a zone of x from 0.5 to 1.5 m.
fn zone(outcome: EjectionOutcome) -> Zone {
    Zone {
        name: "drain".into(),
        low: [0.5, f64::NEG_INFINITY, 0.0],
        high: [1.5, f64::INFINITY, 0.0],
        carrier: None,
        outcome,
    }
}

fn circuit(s: &Simulation<Dim2>) -> GrainCircuit {
    GrainCircuit::new(spec(), s)
}

/// Records a step in which bonds formed and broke; broken ones have work of opening, work of
/// sliding and fracture energy (J/m).
fn step(
    circuit: &mut GrainCircuit,
    s: &mut Simulation<Dim2>,
    formed: &[[u32; 2]],
    broken: &[([u32; 2], [f64; 2], f64)],
) {
    let network = &mut s.state.network;
    network.bonds_formed = formed.iter().map(|bodies| (*bodies, 0)).collect();
    let broken = broken
        .iter()
        .map(|(bodies, [open, slide], fracture)| Break {
            key: key(*bodies),
            bodies: *bodies,
            law: 0,
            place: [0.0; 3],
            opening: [0.0; 2],
            rotation: [0.0; 2],
            area: 1.0,
            torn: 0.0,
            damaged: true,
            damage_before: 0.0,
            energies: BondEnergies {
                work: [*open, *slide, 100.0],
                fracture: *fracture,
                ..BondEnergies::default()
            },
        });
    network.bond_breaks = broken.collect();
    circuit.record_bonds(s);
    circuit.update(s);
}

/// Debris has the share of sliding in the work on its bonds to other bodies, their energy and
/// number. Work that a bond returned does not count, nor does one of two bonds inside the debris.
#[test]
fn debris_has_the_work_of_the_bonds_that_held_it() {
    let mut s = scene();
    for bodies in [[0, 1], [0, 2], [1, 2], [1, 2]] {
        bond(&mut s, bodies);
    }
    let mut circuit = circuit(&s);
    assert_eq!(circuit.tied_to(0), 2);
    step(&mut circuit, &mut s, &[], &[([1, 2], [0.0, 32.0], 64.0)]);
    step(&mut circuit, &mut s, &[], &[([0, 1], [6.0, 1.0], 0.5)]);
    assert!(circuit.debris.is_empty());
    step(&mut circuit, &mut s, &[], &[([0, 2], [-9.0, 1.0], 0.25)]);
    let [debris] = &circuit.debris[..] else {
        panic!("{:?}", circuit.debris)
    };
    assert_eq!((debris.base, debris.bonds), (0, 2));
    assert_eq!(debris.grains, [1, 2]);
    assert_eq!((debris.mode_mix, debris.energy), (0.25, 0.75));
    // The centre of mass is between two equal disks.
    assert!((Vector3::from(debris.place) - Vector3::new(1.5, 0.0, 0.0)).norm() < 1e-15);
    assert_eq!(debris.mass, s.state.bodies.mass[1] + s.state.bodies.mass[2]);
}

/// Pure opening is mode I, pure sliding mode II; without work there is no mode mixture.
#[test]
fn debris_of_one_mode() {
    for (work, mix) in [([2.0, 0.0], 0.0), ([0.0, 2.0], 1.0), ([0.0, 0.0], 0.0)] {
        let mut s = scene();
        bond(&mut s, [0, 1]);
        let mut circuit = circuit(&s);
        step(&mut circuit, &mut s, &[], &[([0, 1], work, 1.0)]);
        assert_eq!(circuit.debris[0].mode_mix, mix, "{work:?}");
        let energies = BondEnergies {
            work: [work[0], work[1], 5.0],
            ..BondEnergies::default()
        };
        assert_eq!(energies.mode_mix(), mix);
    }
}

/// A grain that is bonded again and then detaches again counts the new bond only; the earlier bonds
/// are not counted again.
#[test]
fn bonds_of_earlier_debris_do_not_count_again() {
    let mut s = scene();
    bond(&mut s, [0, 1]);
    let mut circuit = circuit(&s);
    for (work, energy) in [([1.0, 3.0], 2.0), ([1.0, 0.0], 5.0), ([0.0, 1.0], 7.0)] {
        step(&mut circuit, &mut s, &[], &[([0, 1], work, energy)]);
        let debris = &circuit.debris[0];
        assert_eq!((debris.bonds, debris.energy), (1, energy));
        assert_eq!(debris.mode_mix, work[1] / (work[0] + work[1]));
        assert_eq!(circuit.place(1), Some(GrainPlace::Contact));
        step(&mut circuit, &mut s, &[], &[]);
        assert!(circuit.debris.is_empty());
        step(&mut circuit, &mut s, &[[0, 1]], &[]);
        assert_eq!(circuit.place(1), Some(GrainPlace::Tied(0)));
        assert_eq!(circuit.tied_to(0), 1);
    }
    // The grain moved from source to reattachment three times each.
    let flows = circuit.ledger.flows;
    assert_eq!((flows.source.grains, flows.attached.grains), (3, 3));
}

/// A bond that broke while its grain was held by another bond counts only for the debris that it
/// held.
#[test]
fn a_grain_that_is_tied_anew_forgets_what_broke_before() {
    let mut s = scene();
    bond(&mut s, [1, 2]);
    let mut circuit = circuit(&s);
    // Two loose grains separate; one is tied later, and detaches.
    step(&mut circuit, &mut s, &[], &[([1, 2], [1.0, 1.0], 3.0)]);
    assert!(circuit.debris.is_empty());
    step(&mut circuit, &mut s, &[[0, 1]], &[]);
    step(&mut circuit, &mut s, &[], &[([0, 1], [1.0, 0.0], 4.0)]);
    let debris = &circuit.debris[0];
    assert_eq!(
        (debris.bonds, debris.energy, debris.mode_mix),
        (1, 4.0, 0.0)
    );
}

/// Bonds of interfaces that do not belong to the circuit, and of first bodies that are not its
/// bases, tie no grains.
#[test]
fn other_bonds_do_not_tie() {
    let mut s = scene();
    s.drive(2, Default::default());
    bond(&mut s, [0, 1]);
    bond(&mut s, [1, 2]);
    s.state.network.contacts[0].law = 1;
    let memory = &mut s.state.network.memory;
    memory.push(memory[0].clone());
    let mut circuit = circuit(&s);
    assert_eq!(circuit.place(1), Some(GrainPlace::Contact));
    assert_eq!(circuit.place(2), None);
    step(&mut circuit, &mut s, &[[1, 2]], &[]);
    assert_eq!(circuit.place(1), Some(GrainPlace::Contact));
    s.state.network.bonds_formed = vec![([0, 1], 1)];
    circuit.record_bonds(&s);
    circuit.update(&mut s);
    assert_eq!(circuit.place(1), Some(GrainPlace::Contact));
}

/// A zone of x from 0.5 to 1.5 m contains the first grain at the start: the grain is lost after a
/// time in the zone, not before; a grain that left and came back starts again.
#[test]
fn a_grain_is_lost_after_its_time_in_the_zone() {
    let mut s = scene();
    let spec = CircuitParameters {
        zones: vec![zone(EjectionOutcome::LostAfter(2.0))],
        scaling: 4.0,
        ..spec()
    };
    let mut circuit = GrainCircuit::new(spec, &s);
    assert_eq!(circuit.place(1), Some(GrainPlace::Ejected(0)));
    assert_eq!(circuit.place(2), Some(GrainPlace::Contact));
    let mass = circuit.ledger.contents.ejected.mass;
    assert_eq!(mass, 0.25 * s.state.bodies.mass[1]);
    let times = [1.0, 1.5, 2.0, 3.5, 4.0];
    let places = [1.0, 9.0, 1.0, 1.0, 1.0];
    let (zone, loose) = (GrainPlace::Ejected(0), GrainPlace::Contact);
    for ((time, x), place) in
        times
            .iter()
            .zip(places)
            .zip([zone, loose, zone, zone, GrainPlace::Lost])
    {
        s.state.time = *time;
        s.state.bodies.position[1].x = x;
        circuit.update(&mut s);
        assert_eq!(circuit.place(1), Some(place), "{time} s");
        assert_eq!(s.state.bodies.removed[1], place == GrainPlace::Lost);
    }
    let flows = circuit.ledger.flows;
    let grains = [flows.ejected, flows.recirculated, flows.wear].map(|a| a.grains);
    assert_eq!(grains, [1, 1, 1]);
    assert_eq!(flows.wear.mass, mass);
}

/// A circuit starts at its time, at which a bond must tie a grain, is updated at an interval of
/// steps and at the end, and continues from its saved bytes.
#[test]
fn an_account_is_kept_between_steps_and_goes_on_from_its_bytes() {
    let intervals = Intervals {
        every: 2,
        rows: Some(3),
    };
    let new = || CircuitProcess::new(spec(), 1.0, intervals);
    let mut s = scene();
    s.options.scheme.h = 0.5;
    let mut account = new();
    assert_eq!(account.start(), 1.0);
    let pass = |account: &mut CircuitProcess, s: &mut Simulation<Dim2>, step: u64| {
        (s.state.steps, s.state.time) = (step, 0.5 * step as f64);
        account.between_steps(s)
    };
    pass(&mut account, &mut s, 1).unwrap();
    assert!(account.circuit().is_none());
    assert!(pass(&mut account, &mut s, 2).is_err(), "nothing is tied");
    bond(&mut s, [0, 1]);
    let mut account = new();
    let mut due = Vec::new();
    for k in 2..=9 {
        pass(&mut account, &mut s, k).unwrap();
        due.push(account.is_up_to_date(s.state.steps));
    }
    // The circuit starts at the first of these steps; it is then updated at 3, 4, 6, 8 and 9.
    assert_eq!(due[1..], [true, true, false, true, false, true, true]);
    assert_eq!(account.circuit().unwrap().tied_to(0), 1);
    let bytes = Process::<Dim2>::save(&account).unwrap();
    let mut again = new();
    Process::<Dim2>::restore(&mut again, &bytes).unwrap();
    assert!(again.is_up_to_date(s.state.steps));
    assert_eq!(again.circuit().unwrap().tied_to(0), 1);
    assert_eq!(Process::<Dim2>::save(&again).unwrap(), bytes);
    // An update that is not due is made at the end, once.
    for account in [&mut account, &mut again] {
        pass(account, &mut s, 11).unwrap();
        assert!(!account.is_up_to_date(s.state.steps));
        account.at_end(&mut s).unwrap();
        assert!(account.is_up_to_date(s.state.steps));
        assert!(Process::<Dim2>::repeats(account));
    }
    assert!(Process::<Dim2>::restore(&mut new(), &bytes[..1]).is_err());
}

/// A zone from 0.5 to 1.5 m, in the frame of its carrier, contains positions in it or a period
/// away; along a period without bounds it contains all.
#[test]
fn a_zone_holds_images_and_follows_its_carrier() {
    let mut s = scene();
    let mut zone = zone(EjectionOutcome::Stays);
    let open = Periodic { period: [None; 3] };
    let periodic = Periodic {
        period: [Some(4.0), None, None],
    };
    for carrier in [None, Some(2)] {
        zone.carrier = carrier;
        s.state.bodies.position[2].x = 10.0;
        let origin = carrier.map_or(0.0, |_| 10.0);
        for (x, inside, image) in [
            (0.5, true, true),
            (1.4, true, true),
            (1.5, false, false),
            (0.4, false, false),
            (4.6, false, true),
            (-3.4, false, true),
            (5.6, false, false),
            (-2.4, false, false),
        ] {
            let at = Vector2::new(x + origin, 7.0);
            let holds = |periodic, at| zone.holds(&s.state.bodies, periodic, at);
            assert_eq!(holds(&open, &at), inside, "{x}");
            assert_eq!(holds(&periodic, &at), image, "{x}");
        }
    }
    zone.low[0] = f64::NEG_INFINITY;
    assert!(zone.holds(&s.state.bodies, &periodic, &Vector2::new(99.0, 0.0)));
}
