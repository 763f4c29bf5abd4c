//! Maps of regimes and comparisons of laws with known results.

use super::{Folder, json, numbers, values};
use crate::report::{chart_numbers, data};
use serde_json::Value;
use std::collections::BTreeMap;

/// A block on a floor, with tangential springs of 0.8 MPa (N/m per metre of depth) at each of its
/// two contacts, pressed by 100 N/m and moved to and fro.
const BLOCK: &str = r#"(
    name: "a block moved to and fro", dimension: 2, time: (step: 1e-4, end: 0.25),
    solver: (norm: Power, tolerance: 1e-6, max_iterations: 5000),
    detection: (alert: 1e-4, skin: 1e-3),
    materials: {"glass": "bead"},
    interfaces: [(name: "dry", between: ("glass", "glass"), contact: "linear-contact",
        parameters: (contact: {"stiffness": 1e6, "ratio": 0.8, "restitution": 0.1, "mu": 0.3}))],
    bodies: [
        (name: "floor", material: "glass", shapes: [HalfSpace(normal: [0.0, 1.0])]),
        (name: "block", material: "glass", position: [0.0, 0.01], shapes: [Balls([([0.0, 0.0], 0.01), ([0.05, 0.0], 0.01)])],
            dofs: (x: Displacement(Sine(amplitude: 1e-5, frequency: 10.0, start: 0.05)), y: Force(-100.0), rz: Fixed)),
    ],
    friction: (body: "block", start: 0.05),
)"#;

/// With the stiffness K of the springs the block slips if K d > mu N. The area of its loop is then
/// 4 mu N (d - mu N/K): the regime is gross slip from E_d/(4 Q d) = 1 - mu N/(K d) = 0.2 on, a
/// drive K d of 1.25 mu N.
#[test]
fn a_map_of_regimes_has_coulombs_bound() {
    let folder = Folder::new("regimes");
    folder.put("block.ron", BLOCK);
    let drives = [20.0, 40.0, 80.0];
    let frictions = [0.1, 0.3, 0.6];
    folder.put(
        "study.ron",
        r#"(
            case: "block.ron",
            set: ["bodies.block.dofs.x.amplitude=${drive / (2 * 0.8e6)}"],
            factors: [
                Values(name: "drive", unit: "N/m", values: [20.0, 40.0, 80.0]),
                Values(name: "friction", key: "interfaces.dry.parameters.contact.mu", values: [0.1, 0.3, 0.6]),
            ],
            outputs: ["cycles.1.work"],
            regimes: ["fretting.regime"],
        )"#,
    );
    let study = folder.run();
    assert_eq!(study["columns"]["drive"]["unit"], "N/m");
    let (regimes, works) = (
        values(&study, "fretting.regime"),
        numbers(&study, "cycles.1.work"),
    );
    let mut places: [Vec<[f64; 2]>; 2] = Default::default();
    for (i, drive) in drives.into_iter().enumerate() {
        for (j, friction) in frictions.into_iter().enumerate() {
            let (limit, stiffness) = (100.0 * friction, 1.6e6);
            let gross = drive > 1.25 * limit;
            places[usize::from(gross)].push([drive, friction]);
            let k = 3 * i + j;
            assert_eq!(
                regimes[k],
                if gross { "gross" } else { "partial" },
                "{drive} {friction}"
            );
            let area = if drive > limit {
                4.0 * limit * (drive - limit) / stiffness
            } else {
                0.0
            };
            let scale = 4.0 * drive * drive / stiffness;
            assert!(
                (works[k] - area).abs() < 0.01 * scale,
                "{drive} {friction}: {} {area}",
                works[k]
            );
        }
    }
    // The marks of the map on the page, by regime.
    let (figure, numbers) = figure(&folder, "Regimes by fretting.regime");
    let (x, y) = (&figure["x"], &figure["y"]);
    assert_eq!(
        (&x["name"], &x["unit"], &y["name"]),
        (&"drive".into(), &"N/m".into(), &"friction".into())
    );
    assert_eq!(figure["series"].as_array().unwrap().len(), 2);
    for (curve, (name, places)) in figure["series"]
        .as_array()
        .unwrap()
        .iter()
        .zip([("gross", &places[1]), ("partial", &places[0])])
    {
        assert_eq!(curve["label"], name);
        for (axis, key) in ["x", "y"].into_iter().enumerate() {
            let wanted: Vec<f32> = places.iter().map(|p| p[axis] as f32).collect();
            assert_eq!(numbers[curve[key].as_str().unwrap()], wanted);
        }
    }
    // The table has them by setting.
    let mut reader = csv::Reader::from_path(folder.0.join("out/settings.csv")).unwrap();
    let place = reader
        .headers()
        .unwrap()
        .iter()
        .position(|h| h == "fretting.regime")
        .unwrap();
    let rows: Vec<csv::StringRecord> = reader.records().map(Result::unwrap).collect();
    assert!(
        rows.iter()
            .zip(regimes)
            .all(|(row, regime)| row[place] == *regime)
            && rows.len() == 9
    );
}

/// Disks of random sizes fall on a floor of 1 kg that moves.
const DISKS: &str = r#"(
    name: "disks on a floor", dimension: 2, seed: 1, time: (step: 1e-4, end: 0.2), gravity: [0.0, -9.81],
    solver: (tolerance: 1e-10, norm: Velocity, max_iterations: 1000, test_every: 1),
    materials: {"glass": "bead"},
    interfaces: [(name: "dry", between: ("glass", "glass"), contact: "coulomb", parameters: (contact: {"mu": 0.3}))],
    bodies: [(name: "floor", material: "glass", shapes: [HalfSpace(normal: [0.0, 1.0])], mass: 1.0, dofs: (x: Velocity(Constant(0.2))))],
    grains: [Lattice(material: "glass", count: 6, radius: (0.003, 0.006), low: [0.0, 0.0], high: [0.2, 0.02])],
)"#;

/// A floor of velocity V slides below disks until they roll, at V/3: for any friction and any fall
/// slip dissipates m V^2/6, which is also their energy then. A law of two equal coefficients is
/// Coulomb's law; without friction nothing is dissipated.
#[test]
fn laws_differ_by_what_they_dissipate() {
    let folder = Folder::new("laws");
    folder.put("disks.ron", DISKS);
    folder.put(
        "study.ron",
        r#"(
            case: "disks.ron",
            factors: [Options(name: "law", options: [
                (name: "coulomb"),
                (name: "two coefficients", set: ["interfaces.dry.contact=static-dynamic", "interfaces.dry.parameters.contact={\"mu_s\": 0.3, \"mu_d\": 0.3}"]),
                (name: "frictionless", set: ["interfaces.dry.contact=frictionless", "interfaces.dry.parameters.contact={}"]),
            ])],
            seeds: 4,
            outputs: ["energy.friction", "energy.kinetic"],
        )"#,
    );
    let study = folder.run();
    let (slip, motion) = (
        numbers(&study, "energy.friction"),
        numbers(&study, "energy.kinetic"),
    );
    let floor = 0.5 * 0.2 * 0.2;
    for k in 0..4 {
        let rolling = motion[k] - floor;
        assert!(
            (slip[k] / rolling - 1.0).abs() < 1e-6,
            "{} {rolling}",
            slip[k]
        );
        assert_eq!((slip[4 + k], slip[8 + k]), (slip[k], 0.0));
    }
    let mean = slip[..4].iter().sum::<f64>() / 4.0;
    let scatter = (slip[..4].iter().map(|s| (s - mean).powi(2)).sum::<f64>() / 3.0).sqrt();
    // For means over four seeds Student's quantile has three degrees of freedom.
    let half = 3.182 * scatter / 2.0;
    assert!(scatter > 0.0 && half < mean, "{mean} {half}");
    let page = std::fs::read_to_string(folder.0.join("out/study.html")).unwrap();
    let row = |name: &str| -> Vec<String> {
        let start = page
            .find(&format!("<th scope=\"row\">{name}</th>"))
            .unwrap_or_else(|| panic!("no {name}"));
        let row = &page[start..start + page[start..].find("</tr>").unwrap()];
        row.split("<td>")
            .skip(1)
            .map(|cell| cell.replace("</td>", ""))
            .collect()
    };
    assert_eq!(
        row("two coefficients less coulomb"),
        ["0 J/m ± 0 J/m", "1.0", "not known to differ"]
    );
    for name in [
        "frictionless less coulomb",
        "frictionless less two coefficients",
    ] {
        let cells = row(name);
        assert_eq!(cells[2], "they differ");
        let numbers: Vec<f64> = cells[0].split('±').map(joules).collect();
        assert!(
            (numbers[0] / -mean - 1.0).abs() < 1e-3 && (numbers[1] / half - 1.0).abs() < 1e-3,
            "{} {mean} {half}",
            cells[0]
        );
    }
    // The table of settings has equal values.
    let mut reader = csv::Reader::from_path(folder.0.join("out/settings.csv")).unwrap();
    let means: Vec<f64> = reader
        .records()
        .map(|r| r.unwrap()[2].parse().unwrap())
        .collect();
    assert!((means[0] / mean - 1.0).abs() < 1e-12 && means[1] == means[0] && means[2] == 0.0);
    assert!(json(&folder.0.join("out/study.json"))["random"] == true);
}

/// Reads a number with a unit from the page, such as `-6.510 mJ/m`.
fn joules(text: &str) -> f64 {
    let (number, unit) = text.trim().split_once(' ').unwrap();
    let factor = match unit {
        "J/m" => 1.0,
        "mJ/m" => 1e-3,
        "uJ/m" => 1e-6,
        _ => panic!("{unit}"),
    };
    factor * number.parse::<f64>().unwrap()
}

/// Returns a figure of the page, by its title, and the numbers of the page.
fn figure(folder: &Folder, title: &str) -> (Value, BTreeMap<String, Vec<f32>>) {
    let page = std::fs::read_to_string(folder.0.join("out/study.html")).unwrap();
    let data = data(&page);
    let figures = data["figures"].as_array().unwrap();
    let found = figures.iter().find(|f| f["title"] == title);
    let figure = found.unwrap_or_else(|| panic!("no figure {title}"));
    (figure.clone(), chart_numbers(&page))
}

/// Values with units give the points of the same values in SI units.
#[test]
fn values_of_factors_have_units() {
    let folder = Folder::new("units");
    let points = |step: &str, mu: &str| {
        let step = format!(r#"Values(name: "step", key: "time.step", values: [{step}])"#);
        let range = format!(
            r#"Range(name: "mu", key: "{}", {mu}, levels: 2)"#,
            super::MU
        );
        folder.study(&format!("{step}, {range}"), "");
        let words = ["check", "study.ron", "--no-timing", "--points", "--json"];
        folder.answer(&words)
    };
    let units = points("500us, 0.25 ms", "low: 20 %, high: 0.4");
    assert_eq!(units["factors"][0]["unit"], "s");
    assert_eq!(units["points"][0]["set"][0], "time.step=500 us");
    let plain = points("5e-4, 2.5e-4", "low: 0.2, high: 0.4");
    assert_eq!(units["points"][3]["set"][1], plain["points"][3]["set"][1]);
    assert_eq!(units["runs"], plain["runs"]);
}
