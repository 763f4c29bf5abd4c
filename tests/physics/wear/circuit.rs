//! The mass ledger of whole runs, compared with the known motion of the scene.

use crate::scene;
use fretwork::geometry::space::Dim2;
use fretwork::record::Summary;
use fretwork::record::circuit::CircuitSummary;

fn summary(case: &str, sets: &[&str]) -> Summary {
    scene::ran(case, sets, |_| {})
}

#[test]
fn what_falls_off_a_ceiling_passes_every_flow_once() {
    let s = summary("verification/falling_debris", &[]);
    let number = |name: &str| s.found.number(name).unwrap();
    let circuit = s.found.get::<CircuitSummary>().unwrap();
    let f = &circuit.flows;
    assert_eq!([f.source, f.ejected, f.wear].map(|a| a.grains), [8; 3]);
    assert_eq!([f.attached, f.recirculated].map(|a| a.grains), [0; 2]);
    assert_eq!((circuit.pieces, circuit.largest_piece), (5, 2));
    // Disks of 0.1 m have 1000 kg/m^3.
    let mass = 8.0 * 1e3 * std::f64::consts::PI * 0.01;
    assert!((f.wear.mass / mass - 1.0).abs() < 1e-12);
    assert!((number("wear.Qw") * (number("time") - circuit.start) / mass - 1.0).abs() < 1e-12);
    let r = &circuit.residual;
    for a in [r.tied, r.contact, r.ejected, r.lost] {
        assert!(a.grains == 0 && a.mass.abs() < 1e-12 * mass);
    }
    // Grains that are removed take their kinetic energy with them: each falls from rest, from a
    // mean depth of 0.1 or 0.3 m to more than 1 m, under two to three times the weight.
    assert!(number("energy.carried") > mass * 9.81 * 0.7 * 2.0);
    assert!(
        number("energy_residual_relative") < 1e-6,
        "{}",
        number("energy_residual_relative")
    );
    assert_eq!(
        number("broken"),
        8.0,
        "the joints of three pieces tear when they are taken out"
    );
}

#[test]
fn a_zone_that_comes_and_goes_ejects_and_gives_back() {
    let s = summary("verification/moving_zone", &[]);
    let f = &s.found.get::<CircuitSummary>().unwrap().flows;
    assert_eq!([f.ejected, f.recirculated].map(|a| a.grains), [2; 2]);
    assert_eq!([f.source, f.attached, f.wear].map(|a| a.grains), [0; 3]);
}

/// Two roots of different strength hold a bar of two grains: the first breaks alone, the second
/// frees the bar, whose debris has the energy of both.
#[test]
fn debris_remembers_the_bonds_that_broke_before_the_last() {
    use fretwork::process::circuit::GrainCircuit;
    use fretwork::scene::circuit;
    // The root of the heavy grain breaks before that of the light one.
    let sets = [
        "grains.0=List(material: \"grain\", grains: [(at: [0.0, -0.1], radius: 0.1), (at: [0.2, -0.1], radius: 0.1), (at: [0.2, -0.3], radius: 0.1)])",
        "interfaces.1.parameters.cohesion={\"k_n\": 1e8, \"k_t\": 1e6}",
    ]
    .map(str::to_owned);
    let loaded = scene::loaded("verification/falling_debris", &sets);
    let mut s = scene::simulation::<Dim2>(&loaded);
    s.step().unwrap();
    let mut account = GrainCircuit::new(circuit::install(&loaded.case, &s).unwrap(), &s);
    let (mut when, mut cost) = (Vec::new(), 0.0);
    while account.debris.is_empty() && s.state.time < 0.8 {
        s.step().unwrap();
        account.record_bonds(&s);
        for b in &s.state.network.bond_breaks {
            when.push(s.state.time);
            cost += b.energies.fracture;
        }
        account.update(&mut s);
    }
    let debris = &account.debris[0];
    assert_eq!((debris.grains.len(), debris.bonds, when.len()), (3, 2, 2));
    assert!(when[1] > when[0] + 1e-3, "{when:?}");
    assert!((debris.energy / cost - 1.0).abs() < 1e-12);
}
