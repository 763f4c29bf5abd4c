//! The number of an observer of one file in studies, fits and trades, made by a program of its own
//! with the command line of the library, and in Python.

use super::{Summit, ran};
use crate::resume::common::Folder;
use crate::temp::TempFolder;
use fretwork::cli;
use fretwork::program::{self, Program};
use fretwork::record::Observers;
use serde_json::Value;
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// The test that is the program, and what starts it: what follows the last word is the command
/// line.
const TEST: [&str; 5] = [
    "quantities::experiments::a_program_with_an_observer",
    "--exact",
    "--ignored",
    "--nocapture",
    "--",
];

/// A ball thrown upwards, at `grains.0.grains.0.velocity.2` (m/s).
const THROW: &str = r#"(
    name: "a ball thrown upwards", dimension: 3,
    time: (step: 1e-3, end: 0.2),
    gravity: [0.0, 0.0, -9.81],
    materials: {"glass": "glass_bead"},
    interfaces: [(name: "all", between: ("glass", "glass"), contact: "coulomb", parameters: (contact: {"mu": 0.3}))],
    grains: [List(material: "glass", grains: [(at: [0.0, 0.0, 0.0], radius: 0.01, velocity: [0.0, 0.0, 1.0])])],
    output: (frames: 0, views: 0, figures: false),
)"#;

/// How high a ball comes at a speed upwards under a gravity: the scheme is exact for a parabola,
/// whose top lies up to half a step from the end of one.
fn height(speed: f64, gravity: f64) -> f64 {
    speed * speed / (2.0 * gravity)
}

fn executable() -> PathBuf {
    std::env::current_exe().unwrap()
}

/// Not a test by itself: with a command line it is a program whose runs have [`Summit`].
#[test]
#[ignore = "the other tests of this file call it"]
fn a_program_with_an_observer() {
    let words: Vec<OsString> = std::env::args_os().skip_while(|w| w != "--").collect();
    if words.len() < 2 {
        return;
    }
    let command = std::iter::once(executable().into_os_string());
    program::declare(Program {
        file: executable(),
        command: command.chain(TEST.map(Into::into)).collect(),
    });
    cli::add_observers(|_, _| {
        let mut all = Observers::default();
        all.push(Box::new(Summit::default()));
        all
    });
    std::process::exit(cli::call(&words).into());
}

/// A folder with the case.
fn folder(name: &str) -> TempFolder {
    let folder = TempFolder::new(&format!("summit-{name}"));
    std::fs::write(folder.join("throw.ron"), THROW).unwrap();
    folder
}

fn call(folder: &Path, words: &[&str]) -> Output {
    let mut command = Command::new(executable());
    command.args(TEST).args(words).current_dir(folder);
    command.output().unwrap()
}

fn done(folder: &Path, words: &[&str]) {
    let output = call(folder, words);
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{words:?}: {said}");
}

fn json(path: &Path) -> Value {
    let text = std::fs::read_to_string(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    serde_json::from_str(&text).unwrap()
}

#[test]
fn a_study_has_a_column_with_the_unit_of_an_observer() {
    let folder = folder("study");
    let study = |outputs: &str| {
        let text = format!(
            r#"(case: "throw.ron", {outputs}
                factors: [Values(name: "speed", key: "grains.0.grains.0.velocity.2", values: [0.5, 1.0])])"#
        );
        std::fs::write(folder.join("study.ron"), text).unwrap();
    };
    // A main result is compared unless others are named.
    study("");
    done(&folder, &["study", "run", "study.ron", "--out", "usual"]);
    let table = std::fs::read_to_string(folder.join("usual/table.csv")).unwrap();
    assert!(table.contains(",summit.highest [m],"), "{table}");
    study(r#"outputs: ["summit.climbs.0.work", "statistics.summit:max", "summit.highest"],"#);
    done(&folder, &["study", "run", "study.ron", "--out", "out"]);
    let mut table = csv::Reader::from_path(folder.join("out/table.csv")).unwrap();
    let headings = table.headers().unwrap().clone();
    let place = |heading: &str| {
        let place = headings.iter().position(|h| h == heading);
        place.unwrap_or_else(|| panic!("no {heading} in {headings:?}"))
    };
    let places = [
        "summit.climbs.0.work [J]",
        "statistics.summit:max [m]",
        "summit.highest [m]",
    ]
    .map(place);
    let rows: Vec<_> = table.records().map(Result::unwrap).collect();
    for (row, speed) in rows.iter().zip([0.5, 1.0]) {
        let [work, column, highest] = places.map(|k| row[k].parse::<f64>().unwrap());
        assert_eq!((work, column), (2.5, highest));
        let expected = height(speed, 9.81);
        assert!((highest - expected).abs() < 2e-6, "{highest} {expected}");
    }
    assert_eq!(rows.len(), 2);
    // A wrong name is answered with the one that was meant.
    study(r#"outputs: ["summit.highst"],"#);
    let refused = call(&folder, &["study", "run", "study.ron", "--out", "wrong"]);
    let said = String::from_utf8_lossy(&refused.stderr);
    assert_eq!(refused.status.code(), Some(2), "{said}");
    assert!(said.contains("did you mean `summit.highest`?"), "{said}");
}

#[test]
fn a_fit_aims_at_the_number_of_an_observer() {
    let folder = folder("fit");
    let test = |name: &str, gravity: f64| {
        let measured = height(1.2, gravity);
        format!(
            r#"Value(name: "{name}", case: "throw.ron", set: ["gravity=[0.0, 0.0, -{gravity}]"],
                output: "summit.highest", measured: {measured}, sigma: 1e-4)"#
        )
    };
    let text = format!(
        r#"(tests: [{}, {}],
            parameters: [(name: "speed", key: "grains.0.grains.0.velocity.2", low: 0.5, high: 1.5, unit: "m/s")],
            search: (points: 5, generations: 3), seeds: (1, 1), half_step: false)"#,
        test("earth", 9.81),
        test("heavier", 15.0)
    );
    std::fs::write(folder.join("fit.ron"), text).unwrap();
    done(&folder, &["fit", "fit.ron", "--out", "out", "--jobs", "2"]);
    let found = json(&folder.join("out/fit.json"));
    let speed = found["parameters"][0]["value"].as_f64().unwrap();
    assert!((speed - 1.2).abs() < 5e-3, "{found}");
    let table = |name: &str| std::fs::read_to_string(folder.join("out").join(name)).unwrap();
    let points = table("evaluations.csv");
    let headings = "evaluation,stage,speed [m/s],seeds,chi_squared,reason";
    assert_eq!(points.lines().next(), Some(headings));
    let curves = table("curves.csv");
    let headings = "test,x,measured,sigma,fitted,scatter,x_unit,unit";
    assert_eq!(curves.lines().next(), Some(headings));
    assert_eq!(curves.lines().count(), 3);
    assert!(
        curves.lines().skip(1).all(|row| row.ends_with(",,m")),
        "{curves}"
    );
}

#[test]
fn a_trade_compares_the_number_of_an_observer() {
    let folder = folder("trade");
    let words = [
        "trade",
        "throw.ron",
        "--output",
        "summit.highest=1%",
        "--vary",
        "time.step=1e-3,1e-2",
        "--seeds",
        "1",
        "--out",
        "out",
    ];
    done(&folder, &words);
    let found = json(&folder.join("out/trade.json"));
    let settings = found["settings"].as_array().unwrap();
    let value = |setting: &Value| {
        let value = &setting["outputs"]["summit.highest"]["value"]["mean"];
        value.as_f64().unwrap_or_else(|| panic!("{setting}"))
    };
    assert_eq!(settings.len(), 2);
    for highest in settings.iter().map(value) {
        let expected = height(1.0, 9.81);
        assert!((highest - expected).abs() < 2e-4, "{highest} {expected}");
    }
    assert_eq!(found["outputs"][0]["unit"], "m");
    let table = std::fs::read_to_string(folder.join("out/trade.csv")).unwrap();
    for heading in [
        "summit.highest [m]",
        "summit.highest_scatter [m]",
        "summit.highest_error,",
        "seconds [s]",
    ] {
        assert!(table.contains(heading), "{heading} in {table}");
    }
}

/// What the Python package reads, without its compiled part: results are read by Python alone.
const PYTHON: &str = r#"
import sys, types
package = types.ModuleType("fretwork")
package.__path__ = [sys.argv[1]]
sys.modules["fretwork"] = package
from fretwork._results import Results
results = Results(sys.argv[2])
entry = results.quantities["summit.highest"]
print(repr(results.summary["summit"]["highest"]), entry["unit"], entry["doc"], sep="|")
"#;

#[test]
fn python_reads_the_number_of_an_observer() {
    let folder = Folder::new("quantities-python");
    let highest = ran(&folder).found.number("summit.highest").unwrap();
    let package = Path::new(env!("CARGO_MANIFEST_DIR")).join("python/fretwork");
    let mut python = Command::new("python3");
    python
        .args(["-B", "-c", PYTHON])
        .arg(package)
        .arg(&folder.0);
    let output = match python.output() {
        Err(e) if e.kind() == std::io::ErrorKind::NotFound => {
            eprintln!("there is no python3 here: not tested");
            return;
        }
        output => output.unwrap(),
    };
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{said}");
    let text = String::from_utf8_lossy(&output.stdout);
    let parts: Vec<&str> = text.trim().split('|').collect();
    assert_eq!(parts[0].parse(), Ok(highest));
    assert_eq!(parts[1..], ["m", "highest place that a ball reached"]);
}
