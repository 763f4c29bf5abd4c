//! Temperature, passages and comparisons of patches that roll, through the file of a patch.

use crate::Error;
use crate::patch::tests::{COULOMB, folder, laws, near, rolls, solved};
use crate::patch::{Outcome, PatchFile, files, solve};
use fretwork_elastic::patch::{Solid, effective_modulus, point};

/// The patch of the case `ertz_temperature` of the program CONTACT (github eve70a/CONTACT, commit
/// d431cdb): semi-axes 5.88 mm and 10.54 mm under 100 kN, mu 0.3, steel of M. Ertz and K. Knothe
/// (Wear 253, 2002), 30 m/s. Its radii follow from Hertz.
fn ertz(interface: &str, rest: &str) -> String {
    let body = Solid {
        young: 209.92e9,
        poisson: 0.28,
    };
    let modulus = effective_modulus(&[body; 2]);
    let of = |radii: [f64; 2]| point(100e3, radii.map(|r| 1.0 / r), modulus);
    let mut radii = [0.5, 1.0];
    for _ in 0..200 {
        let now = of(radii);
        radii[0] *= 5.88e-3 / now.along;
        radii[1] *= 10.54e-3 / now.across;
    }
    let found = of(radii);
    near(found.along, 5.88e-3, 1e-6);
    near(found.pressure, 770.6e6, 1e-3);
    format!(
        r#"(
            name: "a wheel", materials: {{"wheel": "contact", "rail": "harder"}},
            bodies: ((material: "wheel", radius: {} m), (material: "rail", across: {} m, RAIL)),
            interfaces: [(name: "dry", between: ("wheel", "rail"), {interface})],
            load: 100 kN, {rest}
        )"#,
        radii[0], radii[1]
    )
}

const FRICTION: &str = r#"contact: "coulomb", parameters: (contact: {"mu": 0.3})"#;

fn rise(outcome: &Outcome, from: f64) -> f64 {
    outcome.answer.points[0].temperature.unwrap() - from
}

/// A slip of 1 m/s heats by 150.3 K, the maximum of the integral under a semi-ellipse (CONTACT has
/// 166.8 K by a rule of its own for it); bodies of 0 and 150 K more meet at their mean. Of the slip
/// the strain of the surfaces is a part, up to 4 % at the trailing edge.
#[test]
fn sliding_heats_as_in_closed_form() {
    let motion = "speed: 30 m/s, motion: Rolling(along: -3.333 %)";
    let text = ertz(FRICTION, motion);
    let alike = solved("ertz", &text.replace(", RAIL", "")).unwrap();
    near(rise(&alike, 293.15), 150.3, 0.05);
    near(alike.answer.points[0].adhesion, 0.3, 3e-5);
    let hot = solved("ertz", &text.replace("RAIL", "temperature: 443.15 K")).unwrap();
    near(rise(&hot, 293.15), rise(&alike, 293.15) + 75.0, 1e-6);
}

/// Creepages along and across with spin: the forces are those of CONTACT (0.7274 and 0.1492 of mu
/// P) within the error of its cells, and the rise is its 15.85 K less the 11 % of its rule for the
/// integral. Its case rolls along -x, so that the spin of its bodies has the other sign seen from a
/// patch that rolls along +x.
#[test]
fn creep_and_spin_heat_as_in_contact() {
    let motion = "speed: 30 m/s, motion: Rolling(along: -0.2 %, across: 0.1 %, spin: -0.2 1/m)";
    let text = ertz(FRICTION, motion).replace(", RAIL", "");
    let outcome = solved("ertz-spin", &text).unwrap();
    let point = &outcome.answer.points[0];
    near(point.force[0], 0.7274 * 30e3, 5e-3);
    near(point.force[1], -0.1492 * 30e3, 1.5e-2);
    near(rise(&outcome, 293.15), 15.85 * 150.3 / 166.8, 0.03);
}

/// The rise grows with the root of the speed at one creepage: the heat with the speed, the time of
/// contact with one over it.
#[test]
fn heat_follows_the_speed() {
    let at = |speed: f64| {
        let motion = format!("speed: {speed} m/s, cells: 24, motion: Rolling(along: 2 %)");
        let text = ertz(FRICTION, &motion).replace(", RAIL", "");
        rise(&solved("speed", &text).unwrap(), 293.15)
    };
    near(at(40.0), 2.0 * at(10.0), 1e-6);
}

/// Friction that falls with temperature falls with the speed, and is that of its temperature: in
/// full slip the adhesion lies between those of the hottest place and of the bodies.
#[test]
fn hot_patches_have_less_friction() {
    let interface = r#"contact: "thermal-friction", parameters: (contact: {"cold": 0.4, "hot": 0.1, "from": 293.15 K, "to": 893.15 K})"#;
    let at = |speed: f64| {
        let motion = format!("speed: {speed} m/s, cells: 24, motion: Rolling(along: 5 %)");
        let text = ertz(interface, &motion).replace(", RAIL", "");
        let outcome = solved("hot", &text).unwrap();
        (outcome.answer.points[0].adhesion, rise(&outcome, 293.15))
    };
    let (slow, fast) = (at(1.0), at(60.0));
    assert!(slow.0 > fast.0 && slow.1 < fast.1, "{slow:?} {fast:?}");
    for (adhesion, rise) in [slow, fast] {
        let hottest = 0.4 - 0.3 * rise / 600.0;
        assert!(adhesion > hottest && adhesion < 0.4, "{adhesion} {hottest}");
    }
    // Without heat the coefficient would be 0.4; a fourth of the rise is lost at least.
    assert!(fast.0 < 0.4 - 0.25 * 0.3 * fast.1 / 600.0, "{fast:?}");
}

const WEARS: &str = r#"contact: "coulomb", wear: "archard", parameters: (contact: {"mu": 0.33}, wear: {"K": 1e-4})"#;

/// Bodies in full slip lose N k P xi, each with k = K/H of its own; the wheel passes once a turn.
#[test]
fn passages_wear_both_bodies() {
    let passages =
        "motion: Rolling(along: 20 %), passages: (count: 100, track: 392.699 m, wheels: 2)";
    let outcome = solved("passages", &rolls(WEARS, passages)).unwrap();
    let worn = outcome.answer.passages.as_ref().unwrap();
    // 100 turns of 2 pi 0.625 m over the track, by two wheels.
    near(worn.about.passages[0], 100.0 * 50.0, 1e-5);
    near(worn.about.passages[1], 100.0, 1e-12);
    let taken = 1e-4 * 106.7e3 * 0.2;
    near(worn.end.volume[0], 5000.0 * taken / 2e9, 5e-3);
    near(worn.end.volume[1], 100.0 * taken / 4e9, 5e-3);
    assert!(worn.ledger < 1e-12, "{}", worn.ledger);
    assert!(worn.end.pressure < worn.start.pressure);
    let text = outcome.answer.text();
    assert!(text.contains("100.0 turns over the track"), "{text}");
}

/// Files of passages, with the last profile that of the answer; without a point, a law or a place
/// the sentence says what is missing.
#[test]
fn passages_are_written_and_refused() {
    let passages = "motion: Pulling(force: -20 kN), passages: (count: 1000, shares: (0, 1))";
    let both = WEARS.replace(r#""K": 1e-4"#, r#""k": 5e-14"#);
    let folder = folder("written");
    let path = folder.join("patch.ron");
    std::fs::write(&path, rolls(&both, passages)).unwrap();
    let file = PatchFile::read(&path).unwrap();
    let outcome = solve(&file, &laws(), &mut |_, _| ()).unwrap();
    let worn = outcome.answer.passages.as_ref().unwrap();
    near(worn.end.adhesion[0], -20e3 / 106.7e3, 1e-4);
    assert_eq!(worn.end.depth[0], 0.0);
    files::write(&file, &outcome, &folder).unwrap();
    let table = std::fs::read_to_string(folder.join("passages.csv")).unwrap();
    // Adhesion is a size, and forces those on the first body, in both tables.
    let cell = |name: &str, column: &str| -> f64 {
        let text = std::fs::read_to_string(folder.join(name)).unwrap();
        let mut lines = text.lines();
        let headings = lines.next().unwrap().split(',');
        let mut names = headings.map(|h| h.split(" [").next().unwrap());
        let place = names.position(|h| h == column).unwrap();
        lines
            .next()
            .unwrap()
            .split(',')
            .nth(place)
            .unwrap()
            .parse()
            .unwrap()
    };
    for name in ["adhesion.csv", "passages.csv"] {
        near(cell(name, "adhesion"), 20e3 / 106.7e3, 1e-4);
        near(cell(name, "force_x"), -20e3, 1e-4);
        assert!(cell(name, "force_y").abs() < 1.0);
    }
    assert_eq!(
        table.lines().count(),
        outcome.course.as_ref().unwrap().jumps.len() + 1
    );
    assert!(folder.join("profiles.h5").is_file());
    let profiles = std::fs::read_to_string(folder.join("profiles.csv")).unwrap();
    assert!(profiles.starts_with("passages [1],y [m]") || profiles.starts_with("passages,y [m]"));
    let page = std::fs::read_to_string(folder.join("patch.html")).unwrap();
    assert!(page.contains("Profiles over passages"));
    std::fs::remove_dir_all(&folder).unwrap();
    let refused = |interface: &str, rest: &str| {
        let error = solved("refused-passages", &rolls(interface, rest)).unwrap_err();
        error.to_string()
    };
    for (interface, rest, says) in [
        (
            COULOMB,
            "motion: Rolling(along: 1 %), passages: (count: 10)",
            "nothing wears",
        ),
        (
            WEARS,
            "motion: Rolling(along: [1 %, 2 %]), passages: (count: 10)",
            "one of 1 to 2",
        ),
        (
            WEARS,
            "motion: Rolling(along: 1 %), passages: (count: -1)",
            "1 or more",
        ),
        (
            WEARS,
            "motion: Rolling(along: 1 %), passages: (count: 1e12)",
            "give a `count` below",
        ),
        (
            WEARS,
            "motion: Rolling(along: 1 %), passages: (count: 10, wheels: 3)",
            "`track`",
        ),
        (
            WEARS,
            "motion: Rolling(along: 1 %), passages: (count: 10, profiles: [20])",
            "not among",
        ),
        (
            WEARS,
            "motion: Fretting(amplitude: 1 um), passages: (count: 10)",
            "bodies that roll",
        ),
        (
            WEARS,
            "motion: Rolling(along: 1 %), passages: (count: 10, shares: (0, 1))",
            "leave `shares` out",
        ),
        (
            &both,
            "motion: Rolling(along: 1 %), passages: (count: 10, shares: (0, 0))",
            "add to 1",
        ),
        (
            &both,
            "motion: Rolling(along: 1 %), passages: (count: 10, shares: (0.3, 0.9))",
            "add to 1",
        ),
    ] {
        let got = refused(interface, rest);
        assert!(got.contains(says), "{rest}: {got}");
    }
}

/// Ranges that the solved curve meets are at no distance from it; others are
/// at theirs, and those beyond its ends are told.
#[test]
fn measured_points_beside_the_curve() {
    let folder = folder("measured");
    let table = "# made up\ncreepage [%],to [%],adhesion,high\n5,5,0.329,0.331\n10,10,0.30,0.30\n5,10,0.2,0.4\n30,30,0.3,0.3\n";
    std::fs::write(folder.join("points.csv"), table).unwrap();
    let path = folder.join("patch.ron");
    let rest = r#"speed: 10 m/s, motion: Rolling(along: [5 %, 10 %]), polach: [Dry],
        measured: [(file: "points.csv", along_to: "to", adhesion_to: "high", name: "some")]"#;
    std::fs::write(&path, rolls(COULOMB, rest)).unwrap();
    let file = PatchFile::read(&path).unwrap();
    let outcome = solve(&file, &laws(), &mut |_, _| ()).unwrap();
    let [polach, some] = &outcome.answer.comparisons[..] else {
        panic!("{:?}", outcome.answer.comparisons);
    };
    assert!(polach.curve && polach.beyond == 0);
    assert_eq!((some.beyond, some.name.as_str()), (1, "some"));
    let off = some.off.unwrap();
    assert_eq!(off.points, 3);
    near(off.largest, 0.03, 1e-3);
    near(off.mean, 0.01, 1e-3);
    near(off.rms, 0.03 / f64::sqrt(3.0), 1e-3);
    near(off.reached, 2.0 / 3.0, 1e-12);
    let text = outcome.answer.text();
    assert!(
        text.contains("beside Polach, dry") && text.contains("1 points lie beyond"),
        "{text}"
    );
    std::fs::remove_dir_all(&folder).unwrap();
}

/// A measured distance with two crests: each contact has half of the load and the pressure of Hertz
/// under it; a table that ends within the patch is told.
#[test]
fn a_measured_distance_with_two_contacts() {
    let folder = folder("gap");
    let write = |wide: i32| {
        let rows = (-wide..=wide).map(|k| {
            let y = 0.1 * f64::from(k);
            format!("{y},{}", 0.005 * (y.abs() - 20.0).powi(2))
        });
        let rows: Vec<String> = rows.collect();
        std::fs::write(
            folder.join("gap.csv"),
            format!("y [mm],distance [mm]\n{}\n", rows.join("\n")),
        )
        .unwrap();
    };
    let text = rolls(
        COULOMB,
        "motion: Rolling(along: 1 %), distance: (file: \"gap.csv\")",
    );
    let text = text
        .replace(", across: 1.776737 m", "")
        .replace("cells: 24", "cells: 96");
    let text = text.replace("106.7 kN", "20 kN");
    let path = folder.join("patch.ron");
    std::fs::write(&path, text).unwrap();
    let solved = || {
        let file = PatchFile::read(&path).unwrap();
        solve(&file, &laws(), &mut |_, _| ()).unwrap()
    };
    write(400);
    let outcome = solved();
    let body = Solid {
        young: 209.92e9,
        poisson: 0.28,
    };
    // 0.005 y² in mm is y²/(2 R) with R = 100 mm.
    let hertz = point(10e3, [1.0 / 0.625, 10.0], effective_modulus(&[body; 2]));
    near(outcome.answer.pressure, hertz.pressure, 0.05);
    near(outcome.answer.points[0].adhesion, 0.33, 0.02);
    let told = |outcome: &Outcome| {
        outcome
            .answer
            .text()
            .contains("beyond the ends of the table")
    };
    assert!(!told(&outcome));
    write(205);
    assert!(told(&solved()));
    std::fs::remove_dir_all(&folder).unwrap();
}

/// A parabola of 30 mm by ten rows, 3 mm aside: the pressure is that of Hertz at any number of
/// cells, and the force acts where the patch is.
#[test]
fn few_rows_of_a_distance_have_the_pressure_of_hertz() {
    let folder = folder("rows");
    let rows = (0..10).map(|k| {
        let y = -12.0 + 8.0 / 3.0 * f64::from(k);
        format!("{y},{}", (y - 3.0) * (y - 3.0) / 600.0)
    });
    let rows: Vec<String> = rows.collect();
    let table = format!("y [mm],distance [mm]\n{}\n", rows.join("\n"));
    std::fs::write(folder.join("gap.csv"), table).unwrap();
    let body = Solid {
        young: 209.92e9,
        poisson: 0.28,
    };
    let hertz = point(
        50e3,
        [1.0 / 0.625, 1.0 / 0.3],
        effective_modulus(&[body; 2]),
    );
    for cells in [24, 48, 96] {
        let text = rolls(
            COULOMB,
            "motion: Rolling(along: 0.1 %), distance: (file: \"gap.csv\")",
        );
        let text = text
            .replace(", across: 1.776737 m", "")
            .replace("cells: 24", &format!("cells: {cells}"))
            .replace("106.7 kN", "50 kN");
        let path = folder.join("patch.ron");
        std::fs::write(&path, text).unwrap();
        let file = PatchFile::read(&path).unwrap();
        let outcome = solve(&file, &laws(), &mut |_, _| ()).unwrap();
        near(outcome.answer.pressure, hertz.pressure, 0.01);
        let found = &outcome.answer.points[0];
        near(found.moment.unwrap(), -3e-3 * found.force[0], 0.02);
    }
    std::fs::remove_dir_all(&folder).unwrap();
}

/// What the theory does not hold for is noted, or refused where a number is missing.
#[test]
fn what_is_out_of_range_is_told() {
    let told = |text: &str| solved("range", text).unwrap().answer.text();
    let rolling = rolls(COULOMB, "motion: Rolling(along: 1 %)");
    assert!(!told(&rolling).contains("NOT IN RANGE"));
    let hard = told(&rolling.replace("106.7 kN", "1e7 kN"));
    assert!(hard.contains("above the hardness of wheel"), "{hard}");
    let line = rolling
        .replace(", across: 1.776737 m", "")
        .replace("cells: 24", "cells: 24, length: 20 mm");
    let line = told(&line);
    assert!(line.contains("the line is 20.00 mm long"), "{line}");
    let falls = r#"contact: "rail-falling-friction""#;
    let refused = solved("range", &rolls(falls, "motion: Rolling(along: 1 %)"));
    let refused = refused.unwrap_err().to_string();
    assert!(refused.contains("give the `speed`"), "{refused}");
    let large = solved("range", &rolls(COULOMB, "motion: Rolling(along: 60 %)"));
    let large = large.unwrap_err().to_string();
    assert!(
        large.contains("0.6 is more than 0.5") && !large.contains("per cent"),
        "{large}"
    );
    let misspelt = rolls(
        COULOMB,
        r#"members: [(contact: {"mo": 0.5})], motion: Rolling(along: 1 %)"#,
    );
    let misspelt = solved("range", &misspelt).unwrap_err();
    let Error::Input(misspelt) = misspelt else {
        panic!("{misspelt}");
    };
    let said = misspelt.compact();
    assert!(
        said.contains("`mo`") && misspelt.position().is_some(),
        "{said}"
    );
    let stroke = |amplitude: &str| {
        let motion = format!("motion: Fretting(amplitude: {amplitude})");
        solved("range", &rolls(COULOMB, &motion))
    };
    let long = stroke("20 mm").unwrap().answer.text();
    assert!(long.contains("more than half of the width"), "{long}");
    let tiny = stroke("1e-13 m").unwrap_err().to_string();
    assert!(tiny.contains("give a larger one"), "{tiny}");
}

/// A force that the patch does not carry is refused where it stands in the list.
#[test]
fn a_force_that_is_not_carried_is_found_in_the_file() {
    let text = rolls(COULOMB, "motion: Pulling(force: [-1 kN, -40 kN])");
    let error = solved("carried", &text).unwrap_err();
    let Error::Input(error) = error else {
        panic!("{error}");
    };
    assert!(
        error.compact().contains("at most 35.21 kN"),
        "{}",
        error.compact()
    );
    let (line, column) = error.position().unwrap();
    let found = text.lines().nth(line - 1).unwrap();
    let at = found.char_indices().nth(column - 1).unwrap().0;
    assert!(found[at..].starts_with("-40"), "{found} {column}");
}

/// Bodies start with the pressure of Hertz within the error of few cells, which is told where it is
/// large.
#[test]
fn passages_tell_the_error_of_new_bodies() {
    let passages = "motion: Rolling(along: 20 %), passages: (count: 20)";
    let of = |cells: &str| {
        let text = rolls(WEARS, passages).replace("cells: 24", cells);
        solved("start", &text).unwrap().answer
    };
    let body = Solid {
        young: 209.92e9,
        poisson: 0.28,
    };
    let curvatures = [1.0 / 0.625, 1.0 / 1.776737];
    let hertz = point(106.7e3, curvatures, effective_modulus(&[body; 2]));
    let few = rolls(WEARS, passages).replace("cells: 24", "cells: 18");
    let refused = solved("start", &few).map(|_| ()).unwrap_err().to_string();
    assert!(refused.contains("take 20 or more"), "{refused}");
    for cells in ["cells: 20", "cells: 24"] {
        let answer = of(cells);
        let worn = answer.passages.as_ref().unwrap();
        let off = (worn.start.pressure - hertz.pressure).abs();
        assert!(off < worn.start_error, "{off:e} {:e}", worn.start_error);
        let large = worn.start_error > 0.05 * worn.start.pressure;
        let text = answer.text();
        let told = text.contains("of the pressure of the new bodies");
        assert_eq!(told, large, "{text}");
        assert_eq!(
            told || !worn.notes.is_empty(),
            text.contains("results have notes")
        );
    }
}

/// A distance has units in its headings.
#[test]
fn a_distance_without_units_is_refused() {
    let folder = folder("units");
    let rest = "motion: Rolling(along: 1 %), distance: (file: \"gap.csv\")";
    let text = rolls(COULOMB, rest).replace(", across: 1.776737 m", "");
    let path = folder.join("patch.ron");
    std::fs::write(&path, text).unwrap();
    let file = PatchFile::read(&path).unwrap();
    for (headings, says) in [
        ("y,distance [um]", "write it as `y [mm]`"),
        ("y [mm],distance", "write it as `distance [mm]`"),
    ] {
        let table = format!("{headings}\n-10,100\n0,0\n10,100\n");
        std::fs::write(folder.join("gap.csv"), table).unwrap();
        let refused = solve(&file, &laws(), &mut |_, _| ())
            .unwrap_err()
            .to_string();
        assert!(refused.contains(says), "{refused}");
    }
    std::fs::remove_dir_all(&folder).unwrap();
}

/// Archard's wear is k/mu of T gamma, both extrapolated, of like bodies and of unlike ones with the
/// work of their pressures.
#[test]
fn wear_follows_t_gamma_to_cells_of_no_size() {
    let interface = r#"contact: "coulomb", wear: "archard", parameters: (contact: {"mu": 0.33}, wear: {"k": 1e-14})"#;
    let outcome = solved("k", &rolls(interface, "motion: Rolling(along: 0.1 %)")).unwrap();
    let point = &outcome.answer.points[0];
    let wear = &point.wear[0];
    near(wear.volume, 1e-14 / 0.33 * point.t_gamma, 1e-3);
    near(
        wear.volume_error / wear.volume,
        point.adhesion_error / point.adhesion,
        1.0,
    );
    assert!(outcome.answer.text().contains("by the grid, up to"));
}
