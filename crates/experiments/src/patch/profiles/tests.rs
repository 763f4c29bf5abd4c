//! Profiles of bodies: those of parabolas, the shipped rail, and what is refused.

use crate::patch::spec::PatchFile;
use crate::patch::tests::{folder, laws};
use crate::patch::{Outcome, solve};
use std::path::Path;

/// A parabolic head under a plane wheel.
const PLAIN: &str = r#"(
    name: "", materials: {"wheel": "contact", "rail": "harder"},
    bodies: ((material: "wheel", radius: 0.5 m), (material: "rail")),
    profiles: (first: (file: "wheel.csv"), second: (file: "rail.csv")),
    interfaces: [(name: "dry", between: ("wheel", "rail"), contact: "coulomb", parameters: (contact: {"mu": 0.3}))],
    load: 50 kN, cells: 24, motion: Rolling(along: 0.1 %),
)"#;

fn plain(folder: &Path, from: &str, to: &str) -> Result<Outcome, crate::Error> {
    let rows = |of: &dyn Fn(f64) -> f64| {
        let rows = (-150..=150).map(|k| 0.2 * f64::from(k));
        let rows = rows.map(|y| format!("{y:.3},{:.9}", of(y)));
        format!("y [mm],z [mm]\n{}\n", rows.collect::<Vec<_>>().join("\n"))
    };
    let write = |name: &str, text: &str| std::fs::write(folder.join(name), text).unwrap();
    write("wheel.csv", &rows(&|_| 0.0));
    write("rail.csv", &rows(&|y| -y * y / 600.0));
    write(
        "coarse.csv",
        "y [mm],z [mm]\n-20,-1\n-10,0\n0,1\n10,0\n20,-1\n",
    );
    write("back.csv", "y [mm],z [mm]\n-2,0\n0,1\n2,0\n1.5,-1\n");
    write("bare.csv", "y,z\n-2,0\n0,1\n2,0\n");
    assert!(PLAIN.contains(from), "{from}");
    write("patch.ron", &PLAIN.replacen(from, to, 1));
    let file = PatchFile::read(&folder.join("patch.ron"))?;
    solve(&file, &laws(), &mut |_, _| ())
}

/// The pressure of a parabola of 300 mm under a plane wheel is that of Hertz, and a rail that is
/// turned and shifted has it where its normal is vertical; a vertical load is divided by the cosine
/// of the contact angle, and the spin is that of the angle.
#[test]
fn places_and_loads_of_parabolas() {
    let folder = folder("parabolas");
    let straight = plain(&folder, "load", "load").unwrap().answer;
    let turned = r#"second: (file: "rail.csv", turn: 0.02 rad, shift: 3 mm)"#;
    let turned = plain(&folder, r#"second: (file: "rail.csv")"#, turned).unwrap();
    let contact = turned.answer.contact.unwrap();
    assert!((contact.inclination).abs() < 1e-4, "{contact:?}");
    assert!((contact.places[1] - 0.02_f64.tan() * 0.3).abs() < 1e-4);
    assert!((turned.answer.pressure / straight.pressure - 1.0).abs() < 3e-3);
    assert!((1.0 / contact.across[1] / 0.3 - 1.0).abs() < 0.01);
    let leans = r#"first: (file: "wheel.csv", turn: 0.07 rad)"#;
    let both = r#"spin: true, vertical: true, first: (file: "wheel.csv", turn: 0.07 rad)"#;
    for (first, load) in [(leans, 50e3), (both, 50e3 / 0.07_f64.cos())] {
        let outcome = plain(&folder, r#"first: (file: "wheel.csv")"#, first).unwrap();
        let contact = outcome.answer.contact.clone().unwrap();
        assert!((contact.inclination - 0.07).abs() < 1e-3);
        assert!((outcome.answer.load / load - 1.0).abs() < 1e-3);
        let spin = -contact.inclination.sin() / contact.rolling_radii[0].unwrap();
        assert!((contact.spin / spin - 1.0).abs() < 1e-9);
        let crate::patch::Motion::Rolling(creepage) = outcome.answer.points[0].motion else {
            panic!("a patch that rolls");
        };
        let expected = if contact.spin_used { contact.spin } else { 0.0 };
        assert_eq!(creepage.spin, expected);
    }
    std::fs::remove_dir_all(&folder).unwrap();
}

#[test]
fn what_is_no_pair_of_profiles_is_refused() {
    let folder = folder("no-profiles");
    let rail = r#"second: (file: "rail.csv")"#;
    let other = |file: &str| format!(r#"second: (file: "{file}")"#);
    let fretting = (
        "motion: Rolling(along: 0.1 %)",
        "motion: Fretting(amplitude: 1 um)",
    );
    for (from, to, says) in [
        (
            rail,
            r#"second: (file: "rail.csv", shift: 1 m)"#,
            "do not overlap",
        ),
        (
            rail,
            r#"second: (file: "rail.csv", down: true)"#,
            "`down: true`",
        ),
        (rail, &other("coarse.csv"), "give closer rows, or at most"),
        (rail, &other("back.csv"), "the profile overhangs"),
        (rail, &other("bare.csv"), "write it as `y [mm]`"),
        (rail, &other("nothing.csv"), "nothing.csv"),
        (
            rail,
            r#"second: (file: "rail.csv", y: "x")"#,
            "no column `x`",
        ),
        (
            rail,
            r#"second: (file: "rail.csv", turn: 1.7 rad)"#,
            "that overhang",
        ),
        (
            r#"(material: "rail")"#,
            r#"(material: "rail", across: 0.3 m)"#,
            "leave out the bodies' `across`",
        ),
        (
            fretting.0,
            &format!("{}, length: 1 m", fretting.1),
            "straight across",
        ),
    ] {
        let refused = plain(&folder, from, to).err().map(|e| e.to_string());
        let refused = refused.unwrap_or_else(|| panic!("{to} is taken"));
        assert!(refused.contains(says), "{to}: {refused}");
    }
    let spins = PLAIN.replace(fretting.0, fretting.1);
    let spins = spins.replace("profiles: (", "profiles: (spin: true, ");
    std::fs::write(folder.join("spins.ron"), spins).unwrap();
    let file = PatchFile::read(&folder.join("spins.ron")).unwrap();
    let refused = solve(&file, &laws(), &mut |_, _| ())
        .unwrap_err()
        .to_string();
    assert!(
        refused.contains("spin is that of bodies that roll"),
        "{refused}"
    );
    std::fs::remove_dir_all(&folder).unwrap();
}
