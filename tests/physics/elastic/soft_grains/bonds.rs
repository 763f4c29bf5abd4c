//! Bonds between the sides of blocks.

use super::*;
use fretwork::scene::bond_sites::BondSites;

/// The areas of the bonds of a side add up to its length.
fn glued<S: Space>(what: &str, bodies: &str, grains: &str) -> f64 {
    let mut s = Soft {
        interface: "cohesion: \"elastic-bond\", damage: \"linear-softening\", bonds: Start, bonds_within: 1e-5,",
        parameters: ", cohesion: {\"k_n\": 1e10, \"k_t\": 1e10}, damage: {\"strength\": 1e4, \"energy\": 1.0}".to_owned(),
        bodies: bodies.to_owned(),
        grains: grains.to_owned(),
        elements: if S::D == 2 { 4 } else { 2 },
        tolerance: 1e-8,
        ..Soft::default()
    }
    .build::<S>();
    s.step().unwrap_or_else(|e| panic!("{e}"));
    let network = &s.state.network;
    let bonds = network.contacts.iter().filter_map(|c| network.bond(c));
    let area: f64 = bonds.map(|b| b.area).sum();
    println!(
        "{what}: {} contacts, bonds of {} of the side",
        network.contacts.len(),
        area / 0.02f64.powi(S::D as i32 - 1)
    );
    area
}

#[test]
fn bonds_stand_for_the_side() {
    let side = 0.02;
    let upper = |m: &str| square(m, [0.0, 0.03], side, 0.0, "");
    let floor = wall("floor", &[0.0, 1.0], &[0.0, 0.02], "");
    let equal = square("soft", [0.0, 0.01], side, 0.0, "");
    let wide = |m: &str| square(m, [0.0, 0.005], 0.03, 0.0, "");
    // Vertices of both grains share the side.
    near(
        side,
        glued::<Dim2>("soft on an equal one", "", &(equal + &upper("soft"))),
        1e-5,
    );
    let found = [
        glued::<Dim2>("soft on a plane", &floor, &upper("soft")),
        glued::<Dim2>(
            "soft on a rigid grain",
            "",
            &(wide("stone") + &upper("soft")),
        ),
    ];
    for area in found {
        near(side, area, 1e-5);
    }
    // Of the wider grain, the vertices under the other count, to within an element of half of the
    // area.
    near(
        side,
        glued::<Dim2>("soft on a wider one", "", &(wide("soft") + &upper("soft"))),
        0.08,
    );
    let upper = cuboid("soft", [0.0, 0.0, 0.03], [side; 3], "");
    let floor = wall("floor", &[0.0, 0.0, 1.0], &[0.0, 0.0, 0.02], "");
    let wide = |m: &str| cuboid(m, [0.0, 0.0, 0.005], [0.03; 3], "");
    let solid = [
        glued::<Dim3>("soft on a plane", &floor, &upper),
        glued::<Dim3>("soft on a rigid grain", "", &(wide("stone") + &upper)),
    ];
    for area in solid {
        near(side * side, area, 1e-5);
    }
}

/// A square on a plane: the largest area of a bond over the mass of the square, along the normal,
/// for rigid and soft squares.
#[test]
fn check_estimates_bonds_of_grains_that_deform() {
    let mut s = Soft {
        interface: "cohesion: \"elastic-bond\", damage: \"linear-softening\", bonds: Start, bonds_within: 1e-5,",
        parameters: ", cohesion: {\"k_n\": 1e10, \"k_t\": 1e10}, damage: {\"strength\": 1e4, \"energy\": 1.0}".to_owned(),
        bodies: wall("floor", &[0.0, 1.0], &[0.0, 0.0], ""),
        grains: square("soft", [0.0, 0.01], 0.02, 0.0, ""),
        ..Soft::default()
    }
    .build::<Dim2>();
    s.step().unwrap();
    let network = &s.state.network;
    let bonds = network.contacts.iter().filter_map(|c| network.bond(c));
    let area = bonds.map(|b| b.area).fold(0.0, f64::max);
    let mass = s.state.systems.get(0).unwrap().mass();
    let law = usize::from(network.contacts[0].law);
    let sites = BondSites::of(&s, law).unwrap();
    println!("{sites:?}");
    near(area / mass, sites.normal, 1e-9);
    assert!(sites.shear > sites.normal && sites.shear < 10.0 * sites.normal);
}
