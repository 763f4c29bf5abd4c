//! Breaks of bonds, and the energies spent at contacts, compared with the sums of the ledger.

use crate::scene;
use fretwork::contact::ContactDissipation;
use fretwork::geometry::space::{Dim2, Dim3, Space, VectorLike};

/// Runs a number of steps of a case. The energy spent by contact adds up to the ledger's entries in
/// each step; the energies that broken bonds report and the losses of intact bonds add up to the
/// fracture energy.
fn reported<S: Space>(case: &str, sets: &[&str], steps: usize) -> u64 {
    let mut s = scene::case::<S>(case, sets);
    s.state.network.dissipation = Some(Vec::new());
    let (mut fracture, mut breaks, mut most) = (0.0, 0, 0.0f64);
    for _ in 0..steps {
        let totals = s.step().unwrap_or_else(|e| panic!("{e}")).totals;
        let spent = s.state.network.dissipation.as_ref().unwrap();
        assert_eq!(spent.len(), s.state.network.contacts.len());
        let sum = |of: fn(&ContactDissipation) -> f64| spent.iter().map(of).sum::<f64>();
        let torn: f64 = s
            .state
            .network
            .bond_breaks
            .iter()
            .map(|b| b.energies.fracture)
            .sum();
        let pairs = [
            (sum(|s| s.friction), totals.friction),
            (sum(|s| s.impact), totals.impact),
            (sum(|s| s.adhesion), totals.adhesion),
            (sum(|s| s.viscous), totals.viscous),
        ];
        let scale = s.state.energy.scale.max(f64::MIN_POSITIVE);
        for (by_contact, booked) in pairs {
            assert!((by_contact - booked).abs() < 1e-13 * scale);
        }
        for b in &s.state.network.bond_breaks {
            let energies = &b.energies;
            let work: f64 = energies.work.iter().sum();
            // All work on the bond was released or damped.
            assert!(energies.fracture > 0.0, "{b:?}");
            let missing = work - energies.fracture - energies.viscous;
            most = most.max(energies.fracture);
            assert!(missing.abs() < 1e-9 * most, "{missing} of {b:?}");
            assert!((0.0..=1.0).contains(&energies.mode_mix()));
            let near = b.bodies.iter().any(|i| {
                let d = s.state.bodies.position[*i as usize] - S::Vector::from_slice(&b.place);
                d.norm() < 3.0 * s.state.bodies.length[*i as usize].max(1e-12)
            });
            assert!(near, "{b:?}");
        }
        fracture += torn;
        breaks += s.state.network.bond_breaks.len() as u64;
    }
    assert_eq!(breaks, s.state.network.bonds_broken());
    let intact: f64 = s
        .state
        .network
        .memory
        .iter()
        .flat_map(|m| &m.bonds)
        .filter(|b| b.intact())
        .map(|b| b.energies.fracture)
        .sum();
    let booked = s.state.energy.fracture;
    assert!(
        (fracture + intact - booked).abs() < 1e-9 * booked,
        "{fracture} + {intact} reported, {booked} booked"
    );
    breaks
}

#[test]
fn breaks_of_a_torn_plate_tell_all_its_fracture_energy() {
    assert!(reported::<Dim2>("verification/voronoi_plate", &[], 800) > 10);
    assert!(reported::<Dim3>("verification/voronoi_plate_3d", &["time.step=2e-6"], 150) > 10);
}

#[test]
fn breaks_under_fretting_tell_all_its_fracture_energy() {
    assert!(reported::<Dim2>("wheel_rail_rigid", &["time.step=1e-4"], 540) > 10);
}
