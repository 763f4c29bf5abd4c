//! Results of a study, compared with closed forms and independent computations.

use super::{Folder, mu, numbers, values};
use serde_json::Value;

/// A MAC bond is opened far: damage releases w (1 - 1/100) times an area of 0.5 m^2/m for any
/// stiffness, if it is opened to ten times the opening of its strength; see
/// cases/verification/bond_mode_1.ron.
const BOND: &str = concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/cases/verification/bond_mode_1.ron"
);

fn bond(folder: &Folder, factors: &str, more: &str) -> Value {
    folder.put(
        "study.ron",
        &format!(
            r#"(case: "{BOND}", set: ["time.step=4e-7", "output.figures=false"], factors: [{factors}], outputs: ["energy.fracture"], {more})"#
        ),
    );
    folder.run()
}

/// The released energy is w A to a few per cent, and the tangential stiffness has no effect on it.
/// With w uniform the total index of w is 1, that of a factor without effect 0.
#[test]
fn sobol_indices_find_what_matters() {
    let folder = Folder::new("indices");
    let factors = r#"Range(name: "w", key: "interfaces.grain.parameters.damage.w", low: 0.02, high: 0.1),
        Range(name: "nothing", key: "interfaces.grain.parameters.cohesion.c_t", low: 5e11, high: 2e12, scale: Log)"#;
    bond(&folder, factors, "design: Sensitivity(points: 16)");
    let page = std::fs::read_to_string(folder.0.join("out/study.html")).unwrap();
    // The total index is given with its interval, `1.02 (0.9 to 1.1)`.
    let total = |name: &str| -> Vec<f64> {
        let start = page
            .find(&format!("<th scope=\"row\">{name}</th><td>"))
            .unwrap();
        let row = &page[start..start + page[start..].find("</tr>").unwrap()];
        let cell = row.split("<td>").nth(2).unwrap();
        let words = cell.split(|c: char| !(c.is_ascii_digit() || ".-".contains(c)));
        words.filter_map(|w| w.parse().ok()).collect()
    };
    let w = total("w");
    assert!(
        (w[0] - 1.0).abs() < 0.1 && w[1] <= 1.0 && 1.0 <= w[2],
        "{w:?}"
    );
    assert!(
        total("nothing").iter().all(|x| x.abs() < 1e-3),
        "{:?}",
        total("nothing")
    );
}

/// A grid in its order, with an expression: w is replaced by half of it.
#[test]
fn values_follow_from_factors() {
    let folder = Folder::new("follow");
    let factors = r#"Values(name: "twice", values: [0.1, 0.2]), Options(name: "coupling", options: [(name: "midpoint", set: ["coupling=Midpoint"]), (name: "explicit", set: ["coupling=Explicit"])])"#;
    folder.put(
        "study.ron",
        &format!(
            r#"(case: "{BOND}", set: ["time.step=4e-7", "output.figures=false", "interfaces.grain.parameters.damage.w=${{0.5 * twice}}"],
                factors: [{factors}], outputs: ["energy.fracture"])"#
        ),
    );
    let study = folder.run();
    assert_eq!(numbers(&study, "twice"), [0.1, 0.1, 0.2, 0.2]);
    assert_eq!(values(&study, "coupling")[1], "explicit");
    let energy = numbers(&study, "energy.fracture");
    // The energy is w A up to the energy left at the end of the opening and the error of the coarse
    // step.
    for (k, w) in [(0, 0.05), (2, 0.1)] {
        assert!((energy[k] / (0.5 * w) - 1.0).abs() < 0.03, "{energy:?}");
    }
    let page = std::fs::read_to_string(folder.0.join("out/study.html")).unwrap();
    assert!(page.contains("explicit less midpoint"));
}

/// Means and half-widths over three seeds have Student's t of 4.303.
#[test]
fn means_have_students_intervals() {
    let folder = Folder::new("means");
    folder.study(&mu("0.1, 0.4"), "seeds: 3");
    let study = folder.run();
    let energy = numbers(&study, "energy.friction");
    let mut reader = csv::Reader::from_path(folder.0.join("out/settings.csv")).unwrap();
    let headings = reader.headers().unwrap().clone();
    let place = |name: &str| headings.iter().position(|h| h == name).unwrap();
    let rows: Vec<csv::StringRecord> = reader.records().map(Result::unwrap).collect();
    for (k, row) in rows.iter().enumerate() {
        let of: Vec<f64> = energy[3 * k..3 * k + 3].to_vec();
        let mean = of.iter().sum::<f64>() / 3.0;
        let scatter = (of.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / 2.0).sqrt();
        let number = |name: &str| row[place(name)].parse::<f64>().unwrap();
        assert!((number("energy.friction [J/m]") - mean).abs() < 1e-12);
        let half = number("energy.friction_half_width [J/m]");
        assert!((half - 4.303 * scatter / 3f64.sqrt()).abs() < 1e-3 * half);
    }
    assert_eq!(rows.len(), 2);
}

/// Points of the designs: the requested number, in their ranges; a longer Sobol sequence begins
/// with the shorter one, whose runs exist.
#[test]
fn designs_have_their_points() {
    let folder = Folder::new("designs");
    let range = format!(
        r#"Range(name: "friction", key: "{}", low: 0.1, high: 0.5)"#,
        super::MU
    );
    let points = |design: &str| -> Vec<f64> {
        folder.study(&range, &format!("design: {design}"));
        numbers(&folder.run(), "friction")
    };
    let four = points("Sobol(points: 4)");
    let eight = points("Sobol(points: 8)");
    assert_eq!(eight[..4], four[..]);
    assert_eq!(folder.runs().len(), 8);
    let mut cube = points("LatinHypercube(points: 4)");
    cube.sort_by(f64::total_cmp);
    for (k, x) in cube.iter().enumerate() {
        let stratum = (x - 0.1) / 0.1;
        assert!(
            (k as f64 - 1e-9..=k as f64 + 1.0 + 1e-9).contains(&stratum),
            "{cube:?}"
        );
    }
    folder.put("points.csv", "friction,time.end\n0.2,0.03\n0.3,0.04\n");
    assert_eq!(points("Table(file: \"points.csv\")"), [0.2, 0.3]);
    folder.study(&mu("0.1, 0.5"), "design: OneAtATime");
    let study = folder.run();
    assert_eq!(numbers(&study, "friction"), [0.3, 0.1, 0.5]);
}

/// No spreadsheet takes a heading for a formula, and the table of a study can be read as its
/// points.
#[test]
fn headings_are_no_formulas_and_read_back() {
    let folder = Folder::new("headings");
    let named = mu("0.2, 0.3").replace("\"friction\"", "\"=1+1\"");
    folder.study(&named, "");
    let study = folder.run();
    assert_eq!(numbers(&study, "=1+1"), [0.2, 0.3]);
    for table in ["table.csv", "settings.csv"] {
        let text = std::fs::read_to_string(folder.0.join("out").join(table)).unwrap();
        let headings: Vec<&str> = text.lines().next().unwrap().split(',').collect();
        assert!(headings.contains(&"'=1+1"), "{headings:?}");
        let formula = |h: &&str| h.starts_with(['=', '+', '-', '@', '\t']);
        assert!(!headings.iter().any(formula), "{headings:?}");
    }
    folder.put("points.csv", "'=1+1\n0.4\n0.5\n");
    folder.study(&named, "design: Table(file: \"points.csv\")");
    assert_eq!(numbers(&folder.run(), "=1+1"), [0.4, 0.5]);
}

/// A value that the file of a case does not give, a default of a law, is unknown; the levels beside
/// it are numbers.
#[test]
fn levels_beside_a_default_are_numbers() {
    let folder = Folder::new("default");
    folder.study(
        r#"Values(name: "bounce", key: "interfaces.all.parameters.contact.restitution_n", values: [0.3, 0.6])"#,
        "design: OneAtATime",
    );
    let study = folder.run();
    let bounce = values(&study, "bounce");
    assert!(bounce[0].is_null(), "{bounce:?}");
    assert_eq!(numbers(&study, "bounce")[1..], [0.3, 0.6]);
    let page = std::fs::read_to_string(folder.0.join("out/study.html")).unwrap();
    assert!(page.contains("The other factors as in the case"));
}

/// A misspelled regime is reported with the existing texts; a valid one is not.
#[test]
fn a_regime_that_no_run_has_is_told() {
    let folder = Folder::new("regime");
    let said = |name: &str| {
        folder.study(&mu("0.3"), &format!("regimes: [\"{name}\"]"));
        let output = folder.call(&["run", "study.ron", "--out", "out"]);
        String::from_utf8_lossy(&output.stdout).into_owned()
    };
    let wrong = said("trustworth");
    assert!(
        wrong.contains("`regimes` names `trustworth`, which is no text in the summary"),
        "{wrong}"
    );
    assert!(wrong.contains("name one of `"), "{wrong}");
    assert!(!said("identity").contains("is no text"));
}
