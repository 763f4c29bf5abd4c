//! Wheel and rail profiles against the Manchester benchmark as the program CONTACT has it, and what
//! is refused.

use crate::patch::spec::PatchFile;
use crate::patch::tests::{COULOMB, folder, laws};
use crate::patch::{Contact, Outcome, solve};
use std::path::Path;

const SHIPPED: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../patches/profiles");

/// Height of a rail head of arcs of 300, 80 and 13 mm that end at these half-widths (mm), downwards
/// from its top.
fn head(ends: [f64; 2], y: f64) -> f64 {
    let [large, middle, small] = [300.0, 80.0, 13.0_f64];
    let (sin, cos) = (ends[0] / large).asin().sin_cos();
    let second = [(large - middle) * sin, large - (large - middle) * cos];
    let (sin, cos) = ((ends[1] - second[0]) / middle).asin().sin_cos();
    let third = [
        second[0] + (middle - small) * sin,
        second[1] - (middle - small) * cos,
    ];
    let arc = |centre: [f64; 2], radius: f64| {
        centre[1] - (radius * radius - (y.abs() - centre[0]).powi(2)).sqrt()
    };
    match y.abs() {
        y if y <= ends[0] => arc([0.0, large], large),
        y if y <= ends[1] => arc(second, middle),
        _ => arc(third, small),
    }
}

/// The shipped rail is that of its drawing: its arcs end 20.456 and 52.053 mm apart.
#[test]
fn the_shipped_rail_is_made_of_arcs() {
    let text = std::fs::read_to_string(Path::new(SHIPPED).join("60e1.csv")).unwrap();
    let rows = text.lines().filter(|l| !l.starts_with(['#', 'y']));
    let mut count = 0;
    for row in rows {
        let (y, z) = row.split_once(',').unwrap();
        let (y, z): (f64, f64) = (y.parse().unwrap(), z.parse().unwrap());
        if y.abs() < 35.9 {
            assert!((z + head([10.228, 26.0265], y)).abs() < 1e-6, "{row}");
            count += 1;
        }
    }
    assert!(count > 1000);
}

/// A case of the benchmark: whether it is the right wheel, lateral displacement (mm), roll and yaw
/// of the wheelset (rad), normal force (N), creepages of the rail along and across; then places of
/// the contact on rail and wheel (mm), its angle (rad), approach (mm), largest pressure (MPa) and
/// the force on the rail along and across (N).
type Benchmark = ([f64; 7], [f64; 7]);

/// Manchester contact benchmark, case A-2.2, by CONTACT (github eve70a/CONTACT, commit d431cdb,
/// `examples/mbench_a22_right.ref_out` and `_left.ref_out`): S1002 on UIC 60 at 1:40, G 82 GPa, nu
/// 0.28, friction 0.3, 10 kN on each wheel of 460 mm.
const BENCHMARK: [Benchmark; 8] = [
    (
        [1.0, 0.0, 0.0, 0.0, 9997.0, -5.665e-5, 0.0],
        [-8.66, 1.8726, 0.0290, 1.596e-2, 338.3, 0.2783, -253.6],
    ),
    (
        [1.0, 1.0, -5.049e-5, 2.4e-3, 9827.0, 6.943e-4, 2.407e-3],
        [-18.5418, -9.0305, 0.0696, 2.448e-2, 741.3, -814.3, -2832.0],
    ),
    (
        [1.0, 2.5, -1.457e-4, 6.0e-3, 9787.0, 9.607e-4, 6.025e-3],
        [-20.0706, -12.0933, 0.0862, 2.461e-2, 730.4, -456.2, -2900.0],
    ),
    (
        [1.0, 4.5, -2.977e-4, 1.08e-2, 9726.0, 1.430e-3, 1.088e-2],
        [-22.6421, -16.7104, 0.1185, 2.310e-2, 625.5, -376.8, -2893.0],
    ),
    (
        [0.0, 1.0, -5.049e-5, 2.4e-3, 10050.0, -6.297e-4, 2.4e-3],
        [-5.2886, 6.2694, 0.0176, 1.946e-2, 423.9, 829.2, -2893.0],
    ),
    (
        [0.0, 3.0, -1.803e-4, 7.2e-3, 10030.0, -1.103e-3, 7.197e-3],
        [-3.2967, 10.3382, 0.0110, 2.128e-2, 498.8, 460.5, -2974.0],
    ),
    (
        [0.0, 6.0, -6.272e-4, 1.44e-2, 10020.0, -4.901e-3, 1.437e-2],
        [-2.5116, 14.3878, 0.0084, 2.278e-2, 578.5, 973.1, -2845.0],
    ),
    (
        [0.0, 8.0, -8.606e-3, 1.92e-2, 10020.0, -2.281e-2, 1.899e-2],
        [-2.3103, 20.3458, 0.0077, 2.458e-2, 701.1, 2310.0, -1921.0],
    ),
];

/// Solves the contact of a case of the benchmark, on its own rail: its arcs end 20.96 and 52.0 mm
/// apart, which has its points within 5 um. Its places are from the top of the inclined rail, and y
/// points away from the middle of the track here, to the right in the benchmark.
fn benchmark(folder: &Path, given: &[f64; 7]) -> Outcome {
    let [right, lateral, roll, yaw, force, along, across] = *given;
    let side = if right > 0.0 { 1.0 } else { -1.0 };
    let turn = (1.0_f64 / 40.0).atan();
    let places = (-1600..=1600).map(|k| 0.0225 * f64::from(k));
    let rows = places.map(|y| {
        let z = head([10.48, 26.0], y);
        let across = y * turn.cos() + z * turn.sin() - 300.0 * turn.sin();
        let height = y * turn.sin() - z * turn.cos() + 300.0 * (turn.cos() - 1.0);
        format!("{across:.7},{height:.7}")
    });
    let rows: Vec<String> = rows.collect();
    std::fs::write(
        folder.join("rail.csv"),
        format!("y [mm],z [mm]\n{}\n", rows.join("\n")),
    )
    .unwrap();
    // Tape circles are 1500 mm apart, tops of the rails 1521.0652 mm, by their gauge of 1435 mm;
    // the wheelset rolls about the middle of its axle, and its yaw takes the wheels inward.
    let (sin, cos) = (side * roll).sin_cos();
    let moved = 750.0 * (cos - 1.0) - 460.0 * sin - 375.0 * yaw * yaw;
    let shift = 750.0 - 760.5326 + side * lateral + moved;
    // Spin is by the contact angle; the creepages are those of the wheel.
    let (along, across) = (-along, -side * across);
    let text = format!(
        r#"(
            name: "", materials: {{"wheel": "contact", "rail": "harder"}},
            bodies: ((material: "wheel", radius: 460 mm), (material: "rail")),
            profiles: (
                first: (file: "{SHIPPED}/s1002.csv", shift: {shift} mm, turn: {} rad),
                second: (file: "rail.csv"), spin: true,
            ),
            interfaces: [(name: "dry", between: ("wheel", "rail"), {})],
            load: {force} N, cells: 64, motion: Rolling(along: {along}, across: {across}),
        )"#,
        -side * roll,
        COULOMB.replace("0.33", "0.3")
    );
    let path = folder.join("patch.ron");
    std::fs::write(&path, text).unwrap();
    solve(&PatchFile::read(&path).unwrap(), &laws(), &mut |_, _| ()).unwrap()
}

/// Place, angle, approach, pressure and forces are those of CONTACT on the points of the benchmark
/// with cells of 0.2 mm.
#[test]
fn a_wheelset_of_the_manchester_benchmark() {
    let folder = folder("manchester");
    let mut wrong = Vec::new();
    for (given, expected) in &BENCHMARK {
        let outcome = benchmark(&folder, given);
        let Contact {
            places,
            inclination,
            ..
        } = outcome.answer.contact.clone().unwrap();
        let point = &outcome.answer.points[0];
        let side = if given[0] > 0.0 { 1.0 } else { -1.0 };
        let got = [
            1e3 * places[1],
            1e3 * places[0],
            inclination,
            1e3 * outcome.answer.approach,
            1e-6 * outcome.answer.pressure,
            -point.force[0],
            -side * point.force[1],
        ];
        let force = 0.3 * given[4];
        let within = [
            0.1,
            0.1,
            1e-3,
            0.01 * expected[3],
            0.015 * expected[4],
            0.01 * force,
            0.01 * force,
        ];
        println!("{given:?}\n  {got:?}\n  {expected:?}");
        for k in 0..got.len() {
            if (got[k] - expected[k]).abs() > within[k] {
                wrong.push((given[1], k, got[k], expected[k]));
            }
        }
    }
    std::fs::remove_dir_all(&folder).unwrap();
    assert!(wrong.is_empty(), "{wrong:?}");
}

/// At a displacement of 5 mm CONTACT finds two patches on the right rail, and one at 4.5 mm (its
/// user guide, "The Manchester wheel-rail benchmark").
#[test]
fn two_places_of_contact_are_told() {
    let folder = folder("two-places");
    let noted = |given: [f64; 7]| {
        let text = benchmark(&folder, &given).answer.text();
        text.contains("NOT ONE PATCH")
    };
    assert!(noted([1.0, 5.0, -3.554e-4, 0.012, 9619.0, 0.01, 0.0]));
    assert!(!noted([1.0, 4.5, -2.977e-4, 0.0108, 9726.0, 0.01, 0.0]));
    std::fs::remove_dir_all(&folder).unwrap();
}

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
    let leans = r#"first: (file: "wheel.csv", turn: 0.2 rad)"#;
    let both = r#"spin: true, vertical: true, first: (file: "wheel.csv", turn: 0.2 rad)"#;
    for (first, load) in [(leans, 50e3), (both, 50e3 / 0.2_f64.cos())] {
        let outcome = plain(&folder, r#"first: (file: "wheel.csv")"#, first).unwrap();
        let contact = outcome.answer.contact.clone().unwrap();
        assert!((contact.inclination - 0.2).abs() < 2e-3);
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
