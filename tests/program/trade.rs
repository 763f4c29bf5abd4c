//! `fretwork trade` through the program: errors against a closed form, statistics recomputed from what the runs left, the
//! frontier by its definition, resuming, the budget, interruption, and wrong input.

use serde_json::Value;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::time::{Duration, Instant};

/// A MAC bond (C = 1e12 N/m3, w = 0.1 J/m2, b = 0) opened from 0 to 10 u0, u0 = sqrt(w/C): beyond u0 beta = (u0/u)^2, and
/// damage releases w (1 - beta) A = 0.1 (1 - 1/100) A. A = 0.5 m2/m: the effective radius of two disks of 1 m, times the
/// unit depth.
const BOND: &str = concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/cases/verification/bond_mode_1.ron"
);
const RELEASED: f64 = 0.1 * 0.99 * 0.5;

/// A heap that collapses; its sizes come from the seed.
const HEAP: &str = r#"(
    name: "a small heap",
    dimension: 2,
    seed: 3,
    time: (step: 5e-4, end: 0.05),
    gravity: [0.0, -9.81],
    solver: (tolerance: 1e-3, max_iterations: 5000),
    materials: {"glass": "glass_bead"},
    interfaces: [(name: "all", between: ("glass", "glass"), contact: "coulomb", parameters: (contact: {"mu": 0.3}))],
    bodies: [(name: "floor", material: "glass", shapes: [HalfSpace(normal: [0.0, 1.0])])],
    grains: [Lattice(material: "glass", count: 24, radius: (0.003, 0.006), low: [0.0, 0.0], high: [0.06, 0.2])],
)"#;

/// Disks that are thrown at each other in a box. Nothing is drawn, but every collision of disks spreads a difference.
const BILLIARD: &str = r#"(
    name: "a billiard",
    dimension: 2,
    time: (step: 1e-3, end: 3.0),
    solver: (tolerance: 1e-6, max_iterations: 5000),
    materials: {"glass": "glass_bead"},
    interfaces: [(name: "all", between: ("glass", "glass"), contact: "coulomb",
        parameters: (contact: {"mu": 0.0, "restitution_n": 0.98}))],
    bodies: [
        (name: "floor", material: "glass", shapes: [HalfSpace(normal: [0.0, 1.0])]),
        (name: "left", material: "glass", shapes: [HalfSpace(normal: [1.0, 0.0])]),
        (name: "right", material: "glass", shapes: [HalfSpace(normal: [-1.0, 0.0])], position: [1.0, 0.0]),
        (name: "top", material: "glass", shapes: [HalfSpace(normal: [0.0, -1.0])], position: [0.0, 1.0]),
    ],
    grains: [List(material: "glass", grains: [
        (at: [0.21, 0.20], radius: 0.09, velocity: [2.0, 0.4]), (at: [0.55, 0.18], radius: 0.09, velocity: [-1.0, 0.9]),
        (at: [0.82, 0.27], radius: 0.09, velocity: [-1.5, 0.2]), (at: [0.18, 0.53], radius: 0.09, velocity: [0.7, -1.6]),
        (at: [0.51, 0.48], radius: 0.09, velocity: [1.1, 1.3]), (at: [0.80, 0.55], radius: 0.09, velocity: [-0.6, -1.2]),
        (at: [0.23, 0.82], radius: 0.09, velocity: [1.4, -0.8]), (at: [0.54, 0.79], radius: 0.09, velocity: [0.3, 1.7]),
        (at: [0.83, 0.84], radius: 0.09, velocity: [-0.9, -0.5]),
    ])],
    output: (every: 100),
)"#;

/// A folder of a test, taken away at its end.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path =
            std::env::temp_dir().join(format!("fretwork-trade-{}-{name}", std::process::id()));
        let _ = std::fs::remove_dir_all(&path);
        std::fs::create_dir_all(&path).unwrap_or_else(|e| panic!("{e}"));
        Self(path)
    }

    fn file(&self, name: &str, text: &str) -> String {
        let path = self.0.join(name);
        std::fs::write(&path, text).unwrap_or_else(|e| panic!("{e}"));
        path.display().to_string()
    }

    fn out(&self) -> String {
        self.0.join("out").display().to_string()
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

fn command(arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_fretwork"));
    command.arg("trade").args(arguments);
    command
}

fn call(arguments: &[&str]) -> Output {
    command(arguments)
        .output()
        .unwrap_or_else(|e| panic!("{e}"))
}

fn study(arguments: &[&str]) -> Value {
    let output = call(&[arguments, &["--json"]].concat());
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{said}");
    serde_json::from_slice(&output.stdout).unwrap_or_else(|e| panic!("{e}"))
}

fn settings(study: &Value) -> Vec<Value> {
    study["settings"].as_array().cloned().unwrap_or_default()
}

fn number(value: &Value, path: &str) -> f64 {
    let found = value.pointer(path).and_then(Value::as_f64);
    found.unwrap_or_else(|| panic!("no {path} in {value}"))
}

/// Where a set of `--set` says `key=`.
fn set_to(setting: &Value, key: &str) -> Option<f64> {
    let sets = setting["sets"].as_array()?;
    let texts = sets.iter().filter_map(Value::as_str);
    texts
        .filter_map(|t| t.strip_prefix(key)?.strip_prefix('=')?.parse().ok())
        .next()
}

/// Flags of the frontier against its definition.
fn frontier_is_what_nothing_dominates(study: &Value, output: &str) {
    let all = settings(study);
    let point = |s: &Value| {
        let error = s.pointer(&format!("/outputs/{output}/at_most_with_reference"));
        // Where nothing tells the reference's own error, it is right by definition.
        let unknown = if s["reference"] == true {
            0.0
        } else {
            f64::INFINITY
        };
        let error = error.and_then(Value::as_f64).unwrap_or(unknown);
        let failed = !s["failed"].is_null();
        (
            number(s, "/seconds"),
            if failed { f64::INFINITY } else { error },
        )
    };
    let mut on = 0;
    for s in &all {
        let (cost, error) = point(s);
        let beaten = all
            .iter()
            .map(&point)
            .any(|(c, e)| c <= cost && e <= error && (c < cost || e < error));
        let flag = s
            .pointer(&format!("/outputs/{output}/frontier"))
            .and_then(Value::as_bool);
        assert_eq!(flag.unwrap_or(false), error.is_finite() && !beaten, "{s}");
        on += usize::from(flag == Some(true));
    }
    assert!(on > 0);
}

const STEPS: &str = "time.step=4e-8,8e-8,1.6e-7,3.2e-7";

#[test]
fn errors_fall_with_the_step_against_a_closed_form() {
    let folder = Folder::new("bond");
    let out = folder.out();
    let exact = format!("energy.fracture={RELEASED}");
    let base = [
        "--set",
        "time.step=4e-8",
        "--vary",
        STEPS,
        "--budget",
        "5m",
        "--out",
        &out,
    ];
    let common = [&[BOND][..], &base].concat();
    let found = study(
        &[
            &common[..],
            &["--output", "energy.fracture=1%", "--exact", &exact],
        ]
        .concat(),
    );
    assert_eq!(found["complete"], true);
    assert_eq!(found["random"], false, "nothing in this case is drawn");
    assert_eq!(found["runs"]["fresh"], 4);
    let mut errors: Vec<(f64, f64)> = settings(&found)
        .iter()
        .map(|s| {
            let step = set_to(s, "time.step").unwrap_or(4e-8);
            (step, number(s, "/outputs/energy.fracture/error/mean"))
        })
        .collect();
    errors.sort_by(|a, b| a.0.total_cmp(&b.0));
    assert_eq!(errors.len(), 4);
    // Damage is coupled explicitly: first order, each halving of the step halves the error.
    for pair in errors.windows(2) {
        let ratio = pair[1].1 / pair[0].1;
        assert!((1.7..2.3).contains(&ratio), "{errors:?}");
    }
    assert!(errors[0].1.abs() < 5e-3, "{errors:?}");
    frontier_is_what_nothing_dominates(&found, "energy.fracture");
    // The cheapest for 1 % is the cheapest of those within 1 % of the truth.
    let within: Vec<Value> = settings(&found)
        .into_iter()
        .filter(|s| number(s, "/outputs/energy.fracture/error/mean").abs() <= 0.01)
        .collect();
    let cheapest = within
        .iter()
        .min_by(|a, b| number(a, "/seconds").total_cmp(&number(b, "/seconds")));
    assert_eq!(
        found["cheapest"][0]["setting"],
        cheapest.unwrap_or(&Value::Null)["setting"]
    );
    assert_eq!(found["cheapest"][0]["holds"], true);
    let table = std::fs::read_to_string(Path::new(&out).join("trade.csv")).unwrap_or_default();
    assert_eq!(table.lines().count(), 5, "{table}");
    let picture = std::fs::read(Path::new(&out).join("trade.png")).unwrap_or_default();
    assert!(picture.starts_with(b"\x89PNG") && picture.len() > 5000);

    // Again, without the truth, from the runs that are there: the reference's own error is what its neighbour differs by, and
    // what is claimed with it must hold against the truth.
    let again = study(&[&common[..], &["--output", "energy.fracture=1%"]].concat());
    assert_eq!(
        (&again["runs"]["fresh"], &again["runs"]["reused"]),
        (&0.into(), &4.into())
    );
    let own = number(&again, "/outputs/0/reference_error_at_most");
    let truth = errors[0].1;
    assert!(
        (own - (errors[1].1 - truth)).abs() < 1e-2 * own.abs(),
        "{own} {errors:?}"
    );
    for s in settings(&again) {
        let step = set_to(&s, "time.step").unwrap_or(4e-8);
        let error = errors
            .iter()
            .find(|e| (e.0 - step).abs() < 1e-3 * step)
            .map_or(f64::NAN, |e| e.1);
        let bound = number(&s, "/outputs/energy.fracture/at_most_with_reference");
        assert!(error.abs() <= bound * 1.05, "{error} against {bound}");
        assert!(
            bound <= 1.3 * error.abs(),
            "{bound} says nothing of {error}"
        );
    }
    // An error that the reference itself does not reach is not claimed.
    let fine = study(&[&common[..], &["--output", "energy.fracture=0.1%"]].concat());
    assert_eq!(fine["cheapest"][0]["holds"], false);
}

#[test]
fn errors_are_told_from_scatter() {
    let folder = Folder::new("heap");
    let (case, out) = (folder.file("heap.ron", HEAP), folder.out());
    let found = study(&[
        &case,
        "--vary",
        "time.step=2.5e-4,5e-4,1e-3",
        "--output",
        "energy.friction=5%",
        "--output",
        "statistics.potential:last=1e-2",
        "--seeds",
        "3",
        "--jobs",
        "2",
        "--budget",
        "5m",
        "--out",
        &out,
    ]);
    assert_eq!(
        (&found["random"], &found["complete"]),
        (&true.into(), &true.into())
    );
    assert_eq!(found["seeds"], serde_json::json!([3, 4, 5]));
    assert_eq!(found["runs"]["fresh"], 9);
    // By hand, from what the runs left.
    let mut friction: BTreeMap<(String, u64), f64> = BTreeMap::new();
    for entry in std::fs::read_dir(Path::new(&out).join("runs")).unwrap_or_else(|e| panic!("{e}")) {
        let place = entry.unwrap_or_else(|e| panic!("{e}")).path();
        let read = |name: &str| -> Value {
            let text = std::fs::read_to_string(place.join(name)).unwrap_or_default();
            serde_json::from_str(&text).unwrap_or_default()
        };
        let (run, summary) = (read("run.json"), read("summary.json"));
        let seed = run["seed"].as_u64().unwrap_or(0);
        friction.insert(
            (run["sets"].to_string(), seed),
            number(&summary, "/energy/friction"),
        );
    }
    let by_seed = |s: &Value| -> Vec<f64> {
        (3..6)
            .map(|seed| friction[&(s["sets"].to_string(), seed)])
            .collect()
    };
    let all = settings(&found);
    let reference = all
        .iter()
        .find(|s| s["reference"] == true)
        .map(by_seed)
        .unwrap_or_default();
    let scale = reference.iter().sum::<f64>() / 3.0;
    let mut hidden = 0;
    for s in all.iter().filter(|s| s["reference"] == false) {
        let d: Vec<f64> = by_seed(s)
            .iter()
            .zip(&reference)
            .map(|(a, b)| (a - b) / scale)
            .collect();
        let mean = d.iter().sum::<f64>() / 3.0;
        let sd = (d.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / 2.0).sqrt();
        // Student's t of 95 % and two degrees of freedom: 4.303.
        let half = 4.3027 * sd / 3f64.sqrt();
        let close = |path: &str, x: f64| {
            let got = number(s, &format!("/outputs/energy.friction{path}"));
            assert!(
                (got - x).abs() <= 1e-4 * x.abs() + 1e-12,
                "{path}: {got} and {x}"
            );
        };
        close("/error/mean", mean);
        close("/error/half_width", half);
        close("/at_most", mean.abs() + half);
        let told = s.pointer("/outputs/energy.friction/distinguishable_from_zero");
        assert_eq!(told.and_then(Value::as_bool), Some(mean.abs() > half));
        hidden += usize::from(mean.abs() <= half);
    }
    frontier_is_what_nothing_dominates(&found, "energy.friction");
    assert!(
        hidden > 0,
        "chance hides no error here: the test shows nothing"
    );
}

/// Runs whose steps differ by parts in 1e10 stand for seeds where nothing is drawn and collisions are chaotic; a bond that
/// opens is not, see above.
#[test]
fn chaos_without_draws_has_intervals() {
    let folder = Folder::new("billiard");
    let (case, out) = (folder.file("billiard.ron", BILLIARD), folder.out());
    let found = study(&[
        &case,
        "--vary",
        "time.step=1e-3,2e-3",
        "--output",
        "energy.impact=1%",
        "--seeds",
        "3",
        "--budget",
        "5m",
        "--out",
        &out,
    ]);
    assert_eq!(
        (&found["random"], &found["nudged"], &found["complete"]),
        (&Value::Bool(true), &Value::Bool(true), &Value::Bool(true))
    );
    let notes = found["notes"].to_string();
    assert!(notes.contains("contacts are chaotic here"), "{notes}");
    for s in settings(&found) {
        assert_eq!(s["seeds"], 3);
        if s["reference"] == false {
            assert!(number(&s, "/outputs/energy.impact/error/half_width") > 0.0);
        }
    }
}

#[test]
fn failed_runs_are_marked_and_kept_off_the_frontier() {
    let folder = Folder::new("failed");
    let (case, out) = (folder.file("heap.ron", HEAP), folder.out());
    let common = [
        &case[..],
        "--output",
        "energy.friction=5%",
        "--seeds",
        "2",
        "--budget",
        "5m",
        "--out",
        &out,
    ];
    let found = study(&[&common[..], &["--vary", "solver.max_iterations=5000,1"]].concat());
    let all = settings(&found);
    let failed: Vec<&Value> = all.iter().filter(|s| !s["failed"].is_null()).collect();
    assert_eq!((all.len(), failed.len()), (2, 1));
    assert!(failed[0]["failed"].to_string().contains("did not converge"));
    let flag = failed[0]
        .pointer("/outputs/energy.friction/frontier")
        .and_then(Value::as_bool);
    assert_ne!(flag, Some(true));
    frontier_is_what_nothing_dominates(&found, "energy.friction");
    // Without a reference there is nothing to compare with.
    let output = call(&[&common[..], &["--vary", "solver.max_iterations=1,2"]].concat());
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(
        said.contains("the reference") && said.contains("did not converge"),
        "{said}"
    );
}

/// A command in a process group of its own.
fn in_a_group(mut command: Command) -> Command {
    #[cfg(unix)]
    std::os::unix::process::CommandExt::process_group(&mut command, 0);
    command
}

/// Command lines of the processes that name a folder; none where the system does not list them as Linux does.
fn running(folder: &str) -> Vec<String> {
    let list = std::fs::read_dir("/proc").into_iter().flatten().flatten();
    let lines = list.filter_map(|p| std::fs::read(p.path().join("cmdline")).ok());
    let lines = lines.map(|l| String::from_utf8_lossy(&l).replace('\0', " "));
    lines.filter(|l| l.contains(folder)).collect()
}

#[test]
fn ends_with_the_budget_and_goes_on_after_an_interruption() {
    let folder = Folder::new("budget");
    let out = folder.out();
    // The finest step takes 280,000 steps, longer than the budget on any machine; the case's own some 1700.
    let long = [
        BOND,
        "--set",
        "time.step=4e-8",
        "--vary",
        "time.step=2.5e-10,4e-8,8e-8",
        "--output",
        "energy.fracture=1%",
        "--out",
        &out,
    ];
    let started = Instant::now();
    let output = call(&[&long[..], &["--budget", "10s"]].concat());
    let (said, wrong) = (
        String::from_utf8_lossy(&output.stdout),
        String::from_utf8_lossy(&output.stderr),
    );
    assert_eq!(output.status.code(), Some(0), "{said}{wrong}");
    assert!(
        said.contains("forecast") && said.contains("INCOMPLETE, the budget is spent"),
        "{said}"
    );
    // Building, a trial of two steps and two probes come on top, on a machine that may be busy.
    assert!(
        started.elapsed() < Duration::from_secs(60),
        "{:?}",
        started.elapsed()
    );

    let out = folder.0.join("second").display().to_string();
    let common = [
        BOND,
        "--set",
        "time.step=2.5e-10",
        "--vary",
        "time.step=4e-8,2.5e-10",
        "--vary",
        "solver.test_every=1,2",
        "--output",
        "energy.fracture=1%",
        "--out",
        &out,
        "--budget",
        "10m",
    ];
    let child = in_a_group(command(&common))
        .stdout(std::process::Stdio::null())
        .stderr(std::process::Stdio::piped())
        .spawn()
        .unwrap_or_else(|e| panic!("{e}"));
    std::thread::sleep(Duration::from_secs(5));
    // As Ctrl-C on a terminal does: the study and the runs that it started.
    let killed = Command::new("kill")
        .args(["-INT", "--", &format!("-{}", child.id())])
        .status();
    assert!(killed.is_ok_and(|s| s.success()));
    let started = Instant::now();
    let ended = child.wait_with_output().unwrap_or_else(|e| panic!("{e}"));
    assert!(started.elapsed() < Duration::from_secs(20));
    assert_eq!(ended.status.code(), Some(1));
    let said = String::from_utf8_lossy(&ended.stderr);
    let (_, again) = said
        .split_once("to go on from there:\n")
        .unwrap_or_default();
    assert!(again.contains(" trade ") && again.contains(&out), "{said}");
    assert_eq!(running(&out), Vec::<String>::new(), "runs that were left");
    // What the signal ended is not kept as a run that failed.
    let runs = std::fs::read_dir(Path::new(&out).join("runs")).unwrap_or_else(|e| panic!("{e}"));
    for run in runs.flatten() {
        let kept = std::fs::read_to_string(run.path().join("run.json")).unwrap_or_default();
        assert!(!kept.contains("interrupted"), "{kept}");
    }
    let text = std::fs::read_to_string(Path::new(&out).join("trade.json")).unwrap_or_default();
    let left: Value = serde_json::from_str(&text).unwrap_or_default();
    assert_eq!(left["complete"], false, "{text}");
    // A quick question to the same folder is answered.
    let quick = study(&[
        BOND,
        "--set",
        "time.step=4e-8",
        "--vary",
        "time.step=4e-8,8e-8",
        "--output",
        "energy.fracture=1%",
        "--out",
        &out,
        "--budget",
        "5m",
    ]);
    assert_eq!(quick["complete"], true);
}

#[test]
fn wrong_input_is_answered_with_the_nearest_name() {
    let folder = Folder::new("wrong");
    let out = folder.out();
    for (arguments, said) in [
        (&["--knob", "stpe"][..], "did you mean `step`?"),
        (&["--knob", "precision"], "f64 only"),
        (&["--knob", "grains"], "no lattice or deposit"),
        (
            &["--output", "frction_coefficient=1%"],
            "did you mean `friction_coefficient`?",
        ),
        (
            &["--output", "fracture=1%"],
            "did you mean `energy.fracture`?",
        ),
        (
            &["--output", "statistics.kinetc=1%"],
            "did you mean `statistics.kinetic`?",
        ),
        (&["--output", "energy.fracture=0%"], "above zero"),
        (
            &["--output", "energy.residual=1%"],
            "its true value is zero",
        ),
        (
            &["--vary", "tme.step=1e-8,2e-8"],
            "did you mean `time.step`?",
        ),
        (&["--vary", "time.step=1e-8"], "two values or more"),
        (&["--vary", "time.step=-1,2e-8"], "must be positive"),
        (
            &["--exact", "energy.fractur=1"],
            "no --output has this name",
        ),
        (&["--budget", "soon"], "is no time"),
        (&["--budget", "NaN"], "is no time"),
        (
            &["--unconverged", "NaN"],
            "a number from 0 to 1 is expected",
        ),
        (&["--residual=-1"], "a number from 0 up is expected"),
        (&["--output", "energy.fracture=NaN%"], "a number above zero"),
        (&["--output", "energy.fracture=100%"], "less than 100 %"),
        (
            &["--output", "measures.bulk_mu"],
            "a run of this case has no such output",
        ),
        (&["--output", "wear.Qs"], "has a wear law"),
        (&["--output", "wear.Qw"], "no circuit of grains"),
        (&["--output", "biaxial.angle"], "no biaxial test"),
        (&["--output", "plugins"], "it is no number"),
        (
            &["--output", "statistics.M"],
            "a run of this case has no such output",
        ),
        (
            &["--vary", "time.step=2e-8,2.0e-8"],
            "2e-8 and 2.0e-8 are the same case",
        ),
        (
            &["--set", "solver.method=Newton", "--knob", "test_every"],
            "makes no sweeps",
        ),
        (
            &["--set", "time.step=1e-13", "--budget", "3s"],
            "one run of the case as it is takes",
        ),
        (&["--vary", "seed=1,2"], "for more seeds give --seeds"),
        (&["--vary", "output.every=1,2"], "a study sets this itself"),
        (
            &[
                "--output",
                "energy.fracture",
                "--output",
                "energy.fracture=2%",
            ],
            "given twice",
        ),
    ] {
        let all = [&[BOND, "--out", &out][..], arguments].concat();
        let output = call(&all);
        let text = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {text}");
        assert!(text.contains(said), "{arguments:?}: {text}");
    }
}

/// What a case does not have is told before anything runs, with what it has: nothing is left on disk.
#[test]
fn outputs_that_a_case_does_not_have_are_refused_before_a_run() {
    let folder = Folder::new("absent");
    let (case, out) = (folder.file("heap.ron", HEAP), folder.out());
    for (output, why) in [
        ("friction_coefficient", "no friction test"),
        ("cycles.2.work", "no friction test"),
        ("damage_ratio", "no interface of the case makes bonds"),
        ("energy.fracture", "bonds that are damaged"),
        ("wear.Qs", "no interface of the case has a wear law"),
        ("jump.cycles", "jumps over no cycles"),
        ("measures.layer_flow", "did you mean"),
        ("statistics.slide", "a run of this case has no such output"),
    ] {
        let answer = call(&[&case, "--out", &out, "--output", output]);
        let said = String::from_utf8_lossy(&answer.stderr);
        assert_eq!(answer.status.code(), Some(2), "{output}: {said}");
        if output != "measures.layer_flow" {
            assert!(said.contains(why), "{output}: {said}");
        }
        // The list of those it has, or of the columns.
        let list = if output.starts_with("statistics") {
            "kinetic"
        } else {
            "energy.friction"
        };
        assert!(said.contains(list), "{output}: {said}");
        assert!(!said.contains("there are friction_coefficient"), "{said}");
        assert!(!Path::new(&out).exists(), "{output} left something");
    }
    // The default asks for what there is, and there is nothing here.
    let answer = call(&[&case, "--out", &out]);
    let said = String::from_utf8_lossy(&answer.stderr);
    assert_eq!(answer.status.code(), Some(2), "{said}");
    assert!(said.contains("name an output"), "{said}");
}
