//! Debris of polygons and polyhedra, whose faces are bonded at several points: a plate that tears
//! off its grip.

use crate::scene;
use fretwork::geometry::space::{Dim2, Dim3, Space};
use fretwork::process::circuit::GrainCircuit;
use fretwork::scene::circuit;
use fretwork::step::Simulation;
use std::collections::HashSet;

#[test]
fn a_plate_of_polygons_comes_loose() {
    comes_loose::<Dim2>("voronoi_plate", 800);
}

#[test]
fn a_plate_of_polyhedra_comes_loose() {
    comes_loose::<Dim3>("voronoi_plate_3d", 1500);
}

/// Bodies that unbroken bonds connect to one body, by a search over all bonds.
fn walk<S: Space>(s: &Simulation<S>, from: u32) -> Vec<bool> {
    let grains: HashSet<u32> = s.state.bodies.grains().map(|b| b as u32).collect();
    let mut tied = vec![false; s.state.bodies.len()];
    tied[from as usize] = true;
    let contacts = s.state.network.contacts.iter();
    let bonds: Vec<[u32; 2]> = contacts
        .filter(|c| s.state.network.bond(c).is_some_and(|b| b.intact()))
        .map(|c| c.bodies)
        // No body belongs to one grip through the other.
        .filter(|b| b.iter().all(|b| *b == from || grains.contains(b)))
        .collect();
    loop {
        let before = tied.clone();
        for [a, b] in bonds.iter().map(|b| b.map(|k| k as usize)) {
            let both = tied[a] || tied[b];
            (tied[a], tied[b]) = (both, both);
        }
        if tied == before {
            return tied;
        }
    }
}

fn comes_loose<S: Space>(case: &str, steps: u64) {
    // With damage from the start of a step bonds release more energy, and the crack of this sample
    // runs through.
    let sets = [
        r#"circuit=(bases: ["left"], every: 1)"#,
        "coupling=Explicit",
    ]
    .map(str::to_owned);
    let loaded = scene::loaded(&format!("verification/{case}"), &sets);
    let mut s = scene::simulation::<S>(&loaded);
    s.step().unwrap();
    let mut account = GrainCircuit::new(circuit::install(&loaded.case, &s).unwrap(), &s);
    let base = account.bases()[0];
    let whole = account.tied_to(base);
    let (mut pieces, mut grains, mut mass) = (0, 0, 0.0);
    while s.state.steps < steps {
        s.step().unwrap();
        account.record_bonds(&s);
        account.update(&mut s);
        let r = account.ledger.residual();
        for a in [r.tied, r.contact, r.ejected, r.lost] {
            assert!(a.grains == 0 && a.mass.abs() < 1e-12);
        }
        for d in &account.debris {
            (pieces, grains) = (pieces + 1, grains + d.grains.len());
            mass += d.mass;
            assert!(d.bonds > 0 && d.energy > 0.0 && (0.0..=1.0).contains(&d.mode_mix));
        }
        // A face holds while one of its points does.
        let tied = walk(&s, base);
        let free: Vec<usize> = s.state.bodies.grains().collect();
        let places = free.iter().map(|b| (account.place(*b), tied[*b]));
        for (place, tied) in places {
            let here = matches!(place, Some(fretwork::wear::ledger::GrainPlace::Tied(_)));
            assert_eq!(here, tied);
        }
    }
    let f = account.ledger.flows;
    println!(
        "{} bonds broke, {pieces} pieces of {grains} grains out of {whole}",
        s.state.network.bonds_broken()
    );
    assert!(grains > 1 && grains < whole);
    assert_eq!(f.source.grains, grains as i64);
    assert_eq!(account.tied_to(base), whole - grains);
    assert!((f.source.mass / mass - 1.0).abs() < 1e-12);
}
