//! Every refusal of runs that are to give the friction coefficient of a patch, and every note on
//! runs that are taken.

use super::runs::{self, Runs};
use super::setup::Setup;
use super::slip::Window;
use super::*;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

/// Window of 0.4 mm of both steels.
const CASE: &str = r#"(
    name: "window", dimension: 2, seed: 1, time: (step: 1e-3, end: 0.1), periodic: (x: 4e-4),
    materials: {"rail": "rail_steel_r260", "wheel": "wheel_steel_er7"}, interfaces: [],
    bodies: [
        (name: "low", material: "rail", shapes: [HalfSpace(normal: [0.0, 1.0])]),
        (name: "high", material: "wheel", shapes: [HalfSpace(normal: [0.0, -1.0])]),
    ],
    friction: (body: "high", along: 0, normal: 1),
)"#;

/// Folder of runs, removed at the end.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let process = std::process::id();
        let path = std::env::temp_dir().join(format!("fretwork-patch-{name}-{process}"));
        std::fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    /// Writes a run with changes of its summary, that slips one way by 62 um under 449.8 kN/m.
    fn run(&self, name: &str, changes: &Value) -> PathBuf {
        let path = self.0.join(name);
        std::fs::create_dir_all(&path).unwrap();
        let mu = 0.3 + 1e-3 * f64::from(u32::from(name.as_bytes()[0]));
        let mut summary = json!({
            "friction_coefficient": mu, "stopped": null, "interrupted": false, "trustworthy": true,
            "identity": name, "quantities": [],
        });
        for (key, value) in changes.as_object().unwrap() {
            summary[key] = value.clone();
        }
        std::fs::write(path.join("summary.json"), summary.to_string()).unwrap();
        let rows = "time,delta,P\n0,0,449800\n1,62e-6,449800\n";
        std::fs::write(path.join("statistics.csv"), rows).unwrap();
        path
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

/// The wheel on the rail of the documentation.
fn wheel() -> Question {
    let texts = |list: &[&str]| list.iter().map(|t| (*t).to_owned()).collect();
    Question {
        load: "75 kN".into(),
        radius: texts(&["0.46 m", "flat"]),
        across: texts(&["flat", "0.30 m"]),
        material: texts(&["wheel_steel_er7", "rail_steel_r260"]),
        creepage: Some("0.5 %".into()),
        ..Question::default()
    }
}

/// Reads runs, whose case is this one.
fn of_case(folders: &[PathBuf], case: &str) -> Runs {
    let mut read = runs::read(folders).unwrap();
    for run in &mut read.list {
        run.setup = Setup::of(case);
    }
    read
}

/// Compares runs with the patch in all but their motion.
fn compared(question: &Question, runs: &Runs) -> Result<Vec<String>, String> {
    let contact = Contact::of(question).unwrap();
    alike::compare(question, &contact, runs).map(|(_, notes)| notes)
}

/// A window of a patch that slips by this length (m).
fn window(slip: Option<f64>) -> Window {
    Window {
        width: 4e-4,
        pressure: 1.12e9,
        load: 4.5e5,
        pressure_drop: 0.0,
        gap: 0.0,
        slip: slip.map(Range::certain),
    }
}

/// Compares the motion of runs with a patch that slips by this length (m).
fn driven(question: &Question, runs: &Runs, slip: f64) -> Result<Vec<String>, String> {
    alike::drive(question, runs, &window(Some(slip)))
}

/// Expects a refusal with these words that says what to accept, and a note under the heading once
/// it is accepted.
fn refused(
    question: &Question,
    check: impl Fn(&Question) -> Result<Vec<String>, String>,
    what: &str,
    [words, advice, heading]: [&str; 3],
) {
    let said = check(question).unwrap_err();
    for part in [words, advice, &format!("--accept {what}")] {
        assert!(said.contains(part), "{part} in {said}");
    }
    let accept = vec![what.to_owned()];
    let accepting = Question {
        accept,
        ..question.clone()
    };
    let notes = check(&accepting).unwrap();
    let noted = notes.iter().any(|n| n.starts_with(heading));
    assert!(noted && notes.concat().contains(words), "{notes:?}");
}

#[test]
fn a_run_of_this_patch_is_taken_without_a_note() {
    let folder = Folder::new("alike");
    let runs = of_case(
        &[folder.run("a", &json!({})), folder.run("b", &json!({}))],
        CASE,
    );
    assert_eq!(compared(&wheel(), &runs), Ok(Vec::new()));
    assert_eq!(driven(&wheel(), &runs, 62e-6), Ok(Vec::new()));
}

#[test]
fn folders_without_a_complete_run_that_slides_are_refused() {
    let folder = Folder::new("incomplete");
    let says = |path: &Path, words: &str| {
        let said = runs::read(&[path.to_owned()]).err().unwrap();
        assert!(said.contains(words), "{words} in {said}");
        assert!(said.contains(&path.display().to_string()), "{said}");
    };
    says(&folder.0.join("none"), "give the folder of a finished run");
    let damaged = folder.run("a", &json!({}));
    std::fs::write(damaged.join("summary.json"), "{").unwrap();
    says(&damaged, "is damaged");
    let stopped = folder.run("b", &json!({"stopped": "a step failed"}));
    says(&stopped, "did not reach its end; resume it");
    says(&folder.run("c", &json!({"interrupted": true})), "resume it");
    let partial = json!({"friction_coefficient": null, "fretting": {"regime": "partial"}});
    says(&folder.run("d", &partial), "in partial slip");
    let none = json!({"friction_coefficient": null});
    says(&folder.run("e", &none), "its case needs `friction`");
}

#[test]
fn a_run_counts_once_and_a_single_one_has_no_scatter() {
    let folder = Folder::new("once");
    let one = folder.run("a", &json!({}));
    let mu = runs::read(std::slice::from_ref(&one)).unwrap().list[0].friction;
    let copied = folder.run("b", &json!({"identity": "a"}));
    let equal = folder.run("c", &json!({"friction_coefficient": mu}));
    for (other, words) in [
        (&one, "is given twice"),
        (&copied, "with all its inputs"),
        (&equal, "to the last digit"),
    ] {
        let read = runs::read(&[one.clone(), other.clone()]).unwrap();
        assert_eq!(read.list.len(), 1);
        let note = read.notes.concat();
        assert!(note.starts_with("COUNTED ONCE: ") && note.contains(words));
    }
}

#[test]
fn trust_and_inputs_of_runs_are_compared() {
    let folder = Folder::new("trust");
    let untrusted = json!({"trustworthy": false, "reasons": ["NOT CONVERGED: of a test"]});
    let runs = of_case(&[folder.run("a", &untrusted)], CASE);
    let words = [
        "NOT CONVERGED: of a test",
        "mend what it names",
        "NOT TRUSTED",
    ];
    refused(&wheel(), |q| compared(q, &runs), "untrusted", words);
    let mut runs = of_case(
        &[folder.run("b", &json!({})), folder.run("c", &json!({}))],
        CASE,
    );
    runs.list[1].setup = Setup::of(&CASE.replace("step: 1e-3", "step: 2e-3"));
    let words = ["in `time.step`", "differ in `seed` alone", "INPUTS DIFFER"];
    refused(&wheel(), |q| compared(q, &runs), "inputs", words);
    let unsure = json!({"grade": "consistent", "grade_sentence": "its error is not estimated"});
    let runs = of_case(&[folder.run("d", &unsure)], CASE);
    let notes = compared(&wheel(), &runs).unwrap().concat();
    assert!(notes.starts_with("ERROR NOT KNOWN: "), "{notes}");
    let question = Question {
        accept: vec!["everything".into()],
        ..wheel()
    };
    let said = compared(&question, &runs).unwrap_err();
    assert!(
        said.contains("`everything` is none of untrusted, inputs"),
        "{said}"
    );
}

#[test]
fn materials_and_pressure_are_those_of_the_patch() {
    let folder = Folder::new("materials");
    let paths = [folder.run("a", &json!({}))];
    let runs = of_case(&paths, CASE);
    let other = Question {
        material: vec!["rail_steel_r350ht".into()],
        ..wheel()
    };
    let words = [
        "are of rail_steel_r260 and wheel_steel_er7, those of the patch of rail_steel_r350ht",
        "--set materials.NAME=MATERIAL",
        "OTHER MATERIALS",
    ];
    refused(&other, |q| compared(q, &runs), "materials", words);
    let moduli = Question {
        material: Vec::new(),
        young: vec!["210 GPa".into()],
        poisson: vec!["0.3".into()],
        ..wheel()
    };
    let words = ["moduli alone", "name its materials", "OTHER MATERIALS"];
    refused(&moduli, |q| compared(q, &runs), "materials", words);
    let light = Question {
        load: "20 kN".into(),
        ..wheel()
    };
    let words = [
        "is under 1.12",
        "run its case with a load of",
        "OTHER PRESSURE",
    ];
    refused(&light, |q| compared(q, &runs), "pressure", words);
    let open = of_case(&paths, &CASE.replace("periodic: (x: 4e-4),", ""));
    let words = ["no periodic window", "`periodic`", "OTHER PRESSURE"];
    refused(&wheel(), |q| compared(q, &open), "pressure", words);
    // Without results the case is not known, and neither are materials nor pressure.
    let unknown = runs::read(&paths).unwrap();
    let said = compared(&wheel(), &unknown).unwrap_err();
    for words in [
        "no results.h5",
        "keep results.h5",
        "--accept materials,pressure",
    ] {
        assert!(said.contains(words), "{words} in {said}");
    }
}

/// A patch without creepage and displacement has runs that move alike, and says that they were not
/// compared with it.
#[test]
fn motions_are_compared_with_each_other_where_the_patch_has_none() {
    let folder = Folder::new("among");
    let [one, two] = ["a", "b"].map(|name| folder.run(name, &json!({})));
    let window = window(None);
    let still = Question {
        creepage: None,
        ..wheel()
    };
    let both = |second: &str| {
        let mut runs = of_case(&[one.clone(), two.clone()], CASE);
        runs.list[1].setup = Setup::of(second);
        runs
    };
    let other = CASE.replace("end: 0.1", "end: 0.2");
    let notes = alike::drive(&still, &both(&other), &window).unwrap();
    let said = notes.concat();
    let words = "DRIVE NOT COMPARED: the patch has neither creepage nor displacement";
    assert!(notes.len() == 1 && said.starts_with(words), "{notes:?}");
    assert!(said.contains("slips one way by 62.00 um"), "{said}");
    assert_eq!(
        alike::drive(&still, &Runs::default(), &window),
        Ok(Vec::new())
    );
    let mut unlike = both(&other);
    let motion = unlike.list[1].motion.as_mut().unwrap();
    (motion.reciprocates, motion.slip) = (true, 5e-6);
    let words = [
        "slips one way by 62.00 um",
        "give runs of one motion",
        "OTHER DRIVE",
    ];
    let compare = |q: &Question| alike::drive(q, &unlike, &window);
    refused(&still, compare, "drive", words);
    let rolls = Question {
        speed: Some("30 m/s".into()),
        ..still
    };
    let words = [
        "to and fro by +-5.000 um, and the patch rolls",
        "give runs that slip one way",
        "OTHER DRIVE",
    ];
    refused(&rolls, compare, "drive", words);
}

#[test]
fn the_motion_is_that_of_the_patch() {
    let folder = Folder::new("drive");
    let paths = [folder.run("a", &json!({}))];
    let runs = of_case(&paths, CASE);
    let words = [
        "slips one way by 62.00 um, the patch one way by 100.0 um",
        "give its case the slip of the patch",
        "OTHER DRIVE",
    ];
    refused(&wheel(), |q| driven(q, &runs, 1e-4), "drive", words);
    let frets = Question {
        creepage: None,
        displacement: Some("100 um".into()),
        ..wheel()
    };
    let words = [
        "the patch to and fro",
        "the slip of the patch",
        "OTHER DRIVE",
    ];
    refused(&frets, |q| driven(q, &runs, 62e-6), "drive", words);
    std::fs::remove_file(paths[0].join("statistics.csv")).unwrap();
    let still = of_case(&paths, CASE);
    let words = ["no displacement", "keep statistics.csv", "OTHER DRIVE"];
    refused(&wheel(), |q| driven(q, &still, 62e-6), "drive", words);
}

#[test]
fn a_coefficient_comes_from_runs_or_is_given_and_lies_above_zero() {
    let folder = Folder::new("both");
    let small = json!({"friction_coefficient": 0.01});
    let paths = vec![folder.run("a", &json!({})), folder.run("b", &small)];
    let accept = || ACCEPTABLE.map(|(name, _)| name.to_owned()).to_vec();
    let both = Question {
        runs: paths,
        accept: accept(),
        friction: Some("0.4".into()),
        ..wheel()
    };
    let laws = SearchPath::new(&[]);
    let said = answer(&both, &laws).unwrap_err();
    assert!(said.contains("not both"), "{said}");
    let scattered = Question {
        friction: None,
        ..both
    };
    let said = answer(&scattered, &laws).unwrap_err();
    assert!(said.contains("contains zero; more runs"), "{said}");
}

#[test]
fn a_run_alone_without_an_estimate_is_named() {
    let folder = Folder::new("alone");
    let question = Question {
        creepage: None,
        displacement: Some("100 um".into()),
        runs: vec![folder.run("a", &json!({}))],
        accept: ACCEPTABLE.map(|(name, _)| name.to_owned()).to_vec(),
        ..wheel()
    };
    let found = answer(&question, &SearchPath::new(&[])).unwrap();
    for heading in ["ONE RUN: ", "NUMERICAL ERROR NOT KNOWN: ", "OTHER DRIVE: "] {
        let noted = found.warnings.iter().any(|w| w.starts_with(heading));
        assert!(noted, "{heading} in {:?}", found.warnings);
    }
}
