//! Where bonds form, and the opening at which they begin.

use fretwork::geometry::space::Dim2;
use fretwork::scene::{InputError, load_text};
use fretwork::shipped::search_path;
use fretwork::step::Simulation;
use std::path::Path;

fn built(alert: f64, bonds: &str, rest: &str) -> Simulation<Dim2> {
    tried(alert, bonds, rest).unwrap_or_else(|e| panic!("{e}"))
}

fn tried(alert: f64, bonds: &str, rest: &str) -> Result<Simulation<Dim2>, InputError> {
    let text = format!(
        r#"(
    name: "formation",
    dimension: 2,
    time: (step: 1e-4, end: 1.0),
    detection: (alert: {alert:?}, skin: 5e-3),
    materials: {{"grain": "verification_grain"}},
    interfaces: [(name: "all", between: ("grain", "grain"), contact: "coulomb", cohesion: "elastic-bond",
        parameters: (cohesion: {{"k_n": 1e9, "k_t": 1e9}}), {bonds})],
    output: (frames: 0, views: 0),
    {rest}
)"#
    );
    let loaded = load_text("formation.ron", &text, Path::new("."), &[])?;
    loaded.build_in::<Dim2>(&search_path())
}

/// Eleven disks in a row whose gaps increase from 0.1 to 1 mm: the number of bonds does not depend
/// on the alert distance.
#[test]
fn bonds_are_made_within_their_own_distance() {
    let mut x = 0.0;
    let mut grains = Vec::new();
    for k in 0..11 {
        x += if k > 0 {
            0.1 + 1e-4 * f64::from(k)
        } else {
            0.0
        };
        grains.push(format!("(at: [{x:?}, 0.0], radius: 0.05)"));
    }
    let row = format!(
        r#"grains: [List(material: "grain", grains: [{}])]"#,
        grains.join(", ")
    );
    let made = |alert: f64, bonds: &str| {
        let mut s = built(alert, bonds, &row);
        s.step().unwrap();
        s.state.network.bonds_made()
    };
    for alert in [5e-4, 1e-3, 2e-3] {
        assert_eq!(made(alert, "bonds_within: 4.5e-4,"), 4, "alert {alert}");
    }
    // Contacts beyond the alert distance are not known.
    let refused = tried(4e-4, "bonds_within: 4.5e-4,", &row).unwrap_err();
    assert!(refused.to_string().contains("detection.alert"), "{refused}");
    // Without `bonds_within` the alert distance decides.
    assert_eq!([5.5e-4, 9.5e-4].map(|alert| made(alert, "")), [5, 9]);
}

/// Of two disks 0.2 mm apart one moves away. The bond pulls with k A d if cement fills the gap, and
/// with k A (g + d) if it begins at the gap; it then has its energy from the start. The ledger
/// closes in both cases.
#[test]
fn a_bond_begins_filled_or_at_its_gap() {
    let (gap, area, k) = (2e-4, 0.025, 1e9);
    let pair = r#"bodies: [
        (name: "held", material: "grain", shapes: [Balls([([0.0, 0.0], 0.05)])]),
        (name: "moved", material: "grain", position: [0.1002, 0.0], shapes: [Balls([([0.0, 0.0], 0.05)])],
         dofs: (x: Velocity(Constant(0.01)), y: Fixed, rz: Fixed)),
    ]"#;
    for (opening, begins) in [("Filled", 0.0), ("Gap", gap)] {
        let bonds = format!("bond_opening: {opening},");
        let mut s = built(1e-3, &bonds, pair);
        for _ in 0..10 {
            s.step().unwrap_or_else(|e| panic!("{e}"));
        }
        let moved = 0.01 * 10.0 * 1e-4;
        let bond = &s.state.network.memory[0].bonds[0];
        // The gap is found in the middle of the first step.
        let first = if begins > 0.0 { 0.5e-6 } else { 0.0 };
        let wanted = begins + first + moved;
        assert!(
            (bond.opening_n - wanted).abs() < 1e-12,
            "{opening}: {}",
            bond.opening_n
        );
        let energy = 0.5 * k * area * wanted * wanted;
        assert!((bond.energy / energy - 1.0).abs() < 1e-9, "{opening}");
        let given = 0.5 * k * area * (begins + first).powi(2);
        assert!(
            (s.state.energy.fracture + given).abs() < 1e-9 * energy,
            "{opening}"
        );
        let closes = s.state.energy.relative_residual();
        assert!(closes < 1e-12, "{opening}: {closes:e}");
    }
    // With cement the disks cannot approach; with a bond that begins at the gap they can until they
    // touch.
    for (opening, nearest) in [("Filled", gap), ("Gap", 0.0)] {
        let push = pair
            .replace("Velocity(Constant(0.01))", "Force(Constant(-1e6))")
            .replace("position: [0.1002", "mass: 1.0, position: [0.1002");
        let mut s = built(1e-3, &format!("bond_opening: {opening},"), &push);
        for _ in 0..200 {
            s.step().unwrap_or_else(|e| panic!("{e}"));
        }
        let found = s.state.network.contacts[0].gap;
        assert!((found - nearest).abs() < 1e-6, "{opening}: {found:e}");
    }
}
