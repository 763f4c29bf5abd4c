//! `fretwork solve` from outside: exit codes, messages, JSON, the file of the solution.

use crate::temp::TempFolder;
use fretwork::record::fclib::{self, Problem};
use fretwork::solve::local::scale_free::scale_free_error;
use fretwork::solve::local::solver::{self, Limits, Method, field_error};
use fretwork::solve::local::{Csr, GlobalProblem, LocalProblem, Reduction};
use serde_json::Value;
use std::process::{Command, Output};

/// A separate folder, removed at the end.
struct Folder(TempFolder);

impl Folder {
    fn new() -> Self {
        Self(TempFolder::new("solve"))
    }

    fn path(&self, name: &str) -> String {
        self.0.join(name).to_str().unwrap().to_owned()
    }

    fn write(&self, name: &str, bytes: &[u8]) -> String {
        let path = self.path(name);
        std::fs::write(&path, bytes).unwrap();
        path
    }

    fn local(&self, name: &str, problem: &LocalProblem) -> String {
        let path = self.path(name);
        fclib::write_local(path.as_ref(), problem, name, "a test").unwrap();
        path
    }
}

fn shared(name: &str) -> String {
    format!("{}/tests/fclib/{name}.hdf5", env!("CARGO_MANIFEST_DIR"))
}

fn solve(arguments: &[&str]) -> Output {
    let output = Command::new(env!("CARGO_BIN_EXE_fretwork"))
        .arg("solve")
        .args(arguments)
        .env("NO_COLOR", "1")
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(!said.contains("panicked"), "{said}");
    output
}

fn json(arguments: &[&str]) -> Value {
    let mut all = arguments.to_vec();
    all.push("--json");
    let output = solve(&all);
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{said}");
    serde_json::from_slice(&output.stdout).unwrap()
}

#[track_caller]
fn refused(arguments: &[&str], words: &[&str]) {
    let output = solve(arguments);
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{said}");
    for word in words {
        assert!(said.contains(word), "no `{word}` in: {said}");
    }
}

fn one_contact(mu: f64, q: [f64; 3]) -> LocalProblem {
    LocalProblem {
        dimension: 3,
        w: Csr::from_triplets(3, 3, &[(0, 0, 2.0), (1, 1, 1.0), (2, 2, 1.0)]),
        q: q.to_vec(),
        mu: vec![mu],
    }
}

#[test]
fn the_shared_problems_are_solved() {
    for name in [
        "fc2d_FrictionContactProblem00031",
        "fc2d_SliderCrankLagrangian00000",
        "fc3d_OneContact_reduced",
        "fc3d_OneObject-i1028-138",
        "gfc3d_Example00_badly_scaled",
        "gfc3d_LMGC_GlobalFrictionContactProblem00046",
        "gfc3d_OneContact",
    ] {
        let output = solve(&[&shared(name), "--tolerance", "1e-4"]);
        let text = String::from_utf8_lossy(&output.stdout);
        assert_eq!(output.status.code(), Some(0), "{name}: {text}");
        for word in [
            "solved",
            "error",
            "|p - proj_K(p",
            "contact",
            "iterations",
            "time",
            "solver",
            "reading",
        ] {
            assert!(text.contains(word), "{name}: no `{word}` in {text}");
        }
        assert_eq!(
            text.contains("reduction"),
            name.starts_with('g'),
            "{name}: {text}"
        );
    }
}

#[test]
fn json_says_all_and_the_solution_read_back_has_the_error_printed() {
    let folder = Folder::new();
    let out = folder.path("solution.hdf5");
    for name in [
        "fc3d_OneObject-i1028-138",
        "gfc3d_LMGC_GlobalFrictionContactProblem00046",
    ] {
        let said = json(&[&shared(name), "--tolerance", "1e-5", "--out", &out]);
        assert_eq!(said["solved"], true);
        assert_eq!(said["dimension"], 3);
        assert_eq!(said["tolerance"], 1e-5);
        assert_eq!(said["out"], Value::from(out.clone()));
        assert_eq!(said["problem"], Value::from(shared(name)));
        for key in ["seconds", "read_seconds", "reduce_seconds", "error"] {
            assert!(
                said[key].as_f64().is_some_and(|x| x >= 0.0),
                "{key}: {said}"
            );
        }
        assert!(said["iterations"].as_u64().is_some_and(|n| n > 0));
        assert!(
            said["worst"]
                .as_u64()
                .is_some_and(|c| c < said["contacts"].as_u64().unwrap())
        );
        assert!(
            said["solver"]
                .as_str()
                .is_some_and(|s| s.starts_with("auto"))
        );

        let problem = fclib::read(out.as_ref()).unwrap();
        assert_eq!(problem, fclib::read(shared(name).as_ref()).unwrap());
        let solution = fclib::read_solution(out.as_ref()).unwrap().unwrap();
        let (local, v) = match &problem {
            Problem::Local(l) => (l.problem.clone(), Vec::new()),
            Problem::Global(g) => {
                let form = Reduction::new(&g.problem).unwrap();
                let v = form.velocities(&g.problem, &solution.r).0;
                (form.local, v)
            }
        };
        // The last digit may be lost in reading JSON.
        let (again, printed) = (field_error(&local, &solution.r), &said["error"]);
        let printed = printed.as_f64().unwrap();
        assert!((again - printed).abs() <= 1e-14 * printed);
        assert_eq!(local.velocities(&solution.r), solution.u);
        assert_eq!(v, solution.v);
    }
}

#[test]
fn several_files_give_several_answers() {
    let files = [
        shared("fc3d_OneContact_reduced"),
        shared("gfc3d_OneContact"),
    ];
    let said = json(&[&files[0], &files[1], "--tolerance", "1e-4"]);
    let said = said.as_array().unwrap();
    assert_eq!(said.len(), 2);
    assert_eq!(
        (&said[0]["kind"], &said[1]["kind"]),
        (&"local".into(), &"global".into())
    );

    // An invalid file does not prevent the solution of the others, and determines the exit code.
    let output = solve(&["nowhere.hdf5", &files[0], "--tolerance", "1e-4"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stdout).contains("solved"));
    assert!(String::from_utf8_lossy(&output.stderr).contains("nowhere.hdf5"));
    let folder = Folder::new();
    refused(
        &[&files[0], &files[1], "--out", &folder.path("a.hdf5")],
        &["--out", "one problem"],
    );
}

#[test]
fn all_solvers_stand_in_a_table() {
    let file = shared("fc2d_FrictionContactProblem00031");
    let said = json(&[&file, "--solver", "all", "--tolerance", "1e-4"]);
    let all = said["solvers"].as_array().unwrap();
    assert!(
        all.len() >= 2 && all[0]["solver"] == said["solver"],
        "{said}"
    );
    let solved = |o: &Value| o["solved"].as_bool().unwrap();
    let seconds = |o: &Value| o["seconds"].as_f64().unwrap();
    let in_order = all
        .windows(2)
        .all(|w| match (solved(&w[0]), solved(&w[1])) {
            (true, true) => seconds(&w[0]) <= seconds(&w[1]),
            (first, second) => first || !second,
        });
    assert!(in_order, "{said}");
    let output = solve(&[&file, "--solver", "all", "--tolerance", "1e-4"]);
    let text = String::from_utf8_lossy(&output.stdout);
    let heads = [
        "solver",
        "solved",
        "error",
        "scale-free",
        "iterations",
        "time",
    ];
    assert!(
        text.lines().any(|l| l.split_whitespace().eq(heads)),
        "{text}"
    );
}

#[test]
fn what_is_not_solved_ends_with_one_and_is_written() {
    let folder = Folder::new();
    let out = folder.path("solution.hdf5");
    let file = shared("fc3d_OneObject-i1028-138");
    let output = solve(&[
        &file,
        "--max-iterations",
        "1",
        "--tolerance",
        "1e-12",
        "--out",
        &out,
    ]);
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(
        said.contains("not solved") && said.contains("--max-iterations"),
        "{said}"
    );
    assert!(String::from_utf8_lossy(&output.stdout).contains("NOT solved"));
    assert_eq!(
        fclib::read_solution(out.as_ref()).unwrap().unwrap().r.len(),
        69
    );
}

#[test]
fn a_problem_without_contacts_is_solved() {
    let folder = Folder::new();
    for dimension in [2, 3] {
        let empty = LocalProblem {
            dimension,
            ..LocalProblem::default()
        };
        let out = folder.path("out.hdf5");
        let said = json(&[&folder.local("empty.hdf5", &empty), "--out", &out]);
        assert_eq!(
            (&said["solved"], &said["contacts"]),
            (&true.into(), &0.into())
        );
        assert_eq!(
            (&said["error"], &said["worst"]),
            (&0.0.into(), &Value::Null)
        );
        assert!(
            fclib::read_solution(out.as_ref())
                .unwrap()
                .unwrap()
                .r
                .is_empty()
        );
    }
}

#[test]
fn one_contact_sticks_slides_or_parts() {
    let folder = Folder::new();
    let out = folder.path("out.hdf5");
    // With W = diag(2, 1, 1) sticking needs p = (0.5, -0.1, 0), sliding p_t = -mu p_n; there is
    // none without friction.
    for (mu, q, exact) in [
        (0.5, [-1.0, 0.1, 0.0], [0.5, -0.1, 0.0]),
        (0.5, [-1.0, 0.0, 3.0], [0.5, 0.0, -0.25]),
        (0.0, [-1.0, 2.0, 0.0], [0.5, 0.0, 0.0]),
        (0.3, [1.0, 2.0, 0.0], [0.0, 0.0, 0.0]),
        (0.3, [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]),
    ] {
        let file = folder.local("one.hdf5", &one_contact(mu, q));
        let said = json(&[&file, "--tolerance", "1e-10", "--out", &out]);
        assert_eq!(said["solved"], true, "{said}");
        let r = fclib::read_solution(out.as_ref()).unwrap().unwrap().r;
        for (x, y) in r.iter().zip(exact) {
            assert!((x - y).abs() < 1e-8, "{r:?} {exact:?}");
        }
    }
}

#[test]
fn wrong_files_are_refused_with_a_sentence() {
    let folder = Folder::new();
    refused(&[&folder.path("none.hdf5")], &["cannot read", "none.hdf5"]);
    refused(
        &[folder.0.to_str().unwrap()],
        &["cannot read", "not a file"],
    );
    refused(&[&folder.write("empty", b"")], &["not an HDF5 file"]);
    refused(
        &[&folder.write("text", b"3 1\n")],
        &["not an HDF5 file", "FCLIB"],
    );
    let bytes = std::fs::read(shared("fc3d_OneContact_reduced")).unwrap();
    let cut = folder.write("cut.hdf5", &bytes[..bytes.len() / 2]);
    refused(&[&cut], &["cut.hdf5", "promises", "damaged or cut short"]);
    let results = folder.path("results.h5");
    let other = hdf5::H5File::create(&results).unwrap();
    other.create_group("grains").unwrap();
    other.close().unwrap();
    refused(&[&results], &["without an FCLIB problem", "/fclib_global"]);
    let negative = folder.local("negative.hdf5", &one_contact(-0.5, [0.0; 3]));
    refused(
        &[&negative],
        &["/fclib_local/vectors/mu", "contact 0", "-0.5"],
    );
    let infinite = folder.local("infinite.hdf5", &one_contact(0.5, [0.0, f64::NAN, 0.0]));
    refused(&[&infinite], &["/fclib_local/vectors/q", "value 1", "NaN"]);
    let mut small = one_contact(0.5, [0.0; 3]);
    small.mu.push(0.5);
    refused(
        &[&folder.local("small.hdf5", &small)],
        &["vectors/mu", "2 coefficients"],
    );
    let massless = GlobalProblem {
        dimension: 2,
        m: Csr::from_triplets(3, 3, &[(0, 0, 1.0), (2, 2, 1.0)]),
        h: Csr::from_triplets(3, 2, &[(0, 0, 1.0), (1, 1, 1.0)]),
        f: vec![0.0; 3],
        w: vec![-1.0; 2],
        mu: vec![0.5],
        equalities: None,
    };
    let path = folder.path("massless.hdf5");
    fclib::write_global(path.as_ref(), &massless, "no mass", "").unwrap();
    refused(
        &[&path],
        &["massless.hdf5", "M cannot be inverted", "row 1", "singular"],
    );
}

#[test]
fn wrong_arguments_are_refused_with_a_sentence() {
    let folder = Folder::new();
    let file = shared("fc3d_OneContact_reduced");
    refused(&[&file, "--solver", "nlsg"], &["nlsg", "nlgs", "all"]);
    for wrong in ["0", "-1", "NaN", "inf", "small"] {
        refused(
            &[&file, &format!("--tolerance={wrong}")],
            &["--tolerance", "above 0"],
        );
        refused(
            &[&file, &format!("--time-limit={wrong}")],
            &["--time-limit", "above 0"],
        );
    }
    refused(&[&file, "--max-iterations", "0"], &["--max-iterations"]);
    refused(&[], &["PROBLEM.hdf5"]);
    refused(
        &[&file, "--out", &folder.path("no/such/a.hdf5")],
        &["--out", "no such folder"],
    );
    refused(
        &[&file, "--out", folder.0.to_str().unwrap()],
        &["--out", "a file is expected"],
    );
    let copy = folder.path("copy.hdf5");
    std::fs::copy(&file, &copy).unwrap();
    refused(&[&copy, "--out", &copy], &["--out", "the problem itself"]);
    assert_eq!(std::fs::read(&copy).unwrap(), std::fs::read(&file).unwrap());
}

/// A local problem of the collection.
fn local_of(name: &str) -> LocalProblem {
    match fclib::read(shared(name).as_ref()).unwrap() {
        Problem::Local(l) => l.problem,
        Problem::Global(_) => panic!("{name} is global"),
    }
}

/// W times s: the motion is unchanged, impulses are divided by s.
fn rescaled(problem: &LocalProblem, s: f64) -> LocalProblem {
    let mut out = problem.clone();
    out.w.values.iter_mut().for_each(|w| *w *= s);
    out
}

const LOCAL: [&str; 4] = [
    "fc2d_FrictionContactProblem00031",
    "fc2d_SliderCrankLagrangian00000",
    "fc3d_OneContact_reduced",
    "fc3d_OneObject-i1028-138",
];

/// A change of units does not change the error, not by a bit if units differ by a power of two.
#[test]
fn the_scale_free_error_knows_no_units() {
    for name in LOCAL {
        let problem = local_of(name);
        let limits = Limits {
            tolerance: 1e-3,
            scale_free: None,
            max_iterations: 1000,
            seconds: 10.0,
        };
        let mut p = solver::solve(&problem, Method::Nlgs, &limits).p;
        // The point is away from the solution, so that the error is not round-off.
        p.iter_mut().for_each(|p| *p *= 1.01);
        let figure = scale_free_error(&problem, &p);
        assert!(figure > 1e-6, "{name}: {figure:e}");
        for (s, k) in [(1e-9, 1.0), (2f64.powi(-30), 1.0), (1e9, 1e-3), (1.0, 7.0)] {
            let mut other = rescaled(&problem, s);
            other.q.iter_mut().for_each(|q| *q *= k);
            let impulses: Vec<f64> = p.iter().map(|p| p * k / s).collect();
            let again = scale_free_error(&other, &impulses);
            let near = if s == 2f64.powi(-30) { 0.0 } else { 1e-9 };
            assert!(
                (again - figure).abs() <= near * figure,
                "{name}, W times {s:e}, q times {k}: {again:e} for {figure:e}"
            );
        }
    }
}

/// The FCLIB error of a problem with 1e-9 times its W passes although velocities are wrong by their
/// own size. It is flagged, gives exit code 1 if the scale-free error is required, and is solved to
/// both errors if there are enough iterations.
#[test]
fn what_the_fields_figure_hides_is_flagged_and_can_be_refused() {
    let folder = Folder::new();
    // The other problems are solved exactly by a sweep, in any units.
    for name in ["fc3d_OneObject-i1028-138"] {
        let problem = local_of(name);
        let whole = folder.local("whole.hdf5", &problem);
        let said = json(&[&whole, "--tolerance", "1e-6"]);
        assert_eq!(
            (&said["scale_free_met"], &said["warning"]),
            (&true.into(), &Value::Null),
            "{said}"
        );

        let file = folder.local("small.hdf5", &rescaled(&problem, 1e-9));
        let said = json(&[&file, "--tolerance", "1e-6"]);
        assert_eq!(
            (&said["solved"], &said["scale_free_met"]),
            (&true.into(), &false.into()),
            "{said}"
        );
        assert!(said["error"].as_f64().unwrap() <= 1e-6);
        assert!(said["scale_free_error"].as_f64().unwrap() > 1e-3, "{said}");
        assert_eq!(said["scale_free_tolerance"], 1e-3);
        assert!(
            said["warning"].as_str().unwrap().contains("above 1.0e-3"),
            "{said}"
        );
        let text = solve(&[&file, "--tolerance", "1e-6"]);
        let text = String::from_utf8_lossy(&text.stdout).into_owned();
        assert!(
            text.contains("WARNING") && text.contains("DOUBTFUL"),
            "{text}"
        );

        // The scale-free error is required, and the iterations do not suffice: exit code 1, with
        // both errors.
        let few = [
            &file,
            "--tolerance",
            "1e-6",
            "--scale-free-tolerance",
            "1e-6",
            "--solver",
            "pg",
            "--max-iterations",
            "1",
        ];
        let output = solve(&few);
        let error = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{error}");
        assert!(error.contains("--scale-free-tolerance 1e-6"), "{error}");

        // The scale-free error is required and reached: both errors hold, recomputed from the
        // written file.
        let out = folder.path("out.hdf5");
        let said = json(&[
            &file,
            "--tolerance",
            "1e-6",
            "--scale-free-tolerance",
            "1e-6",
            "--out",
            &out,
        ]);
        assert_eq!(
            (&said["solved"], &said["scale_free_met"]),
            (&true.into(), &true.into()),
            "{said}"
        );
        let r = fclib::read_solution(out.as_ref()).unwrap().unwrap().r;
        let small = rescaled(&problem, 1e-9);
        assert!(field_error(&small, &r) <= 1e-6 && scale_free_error(&small, &r) <= 1e-6);
        // Every solver reaches them.
        let limits = Limits {
            tolerance: 1e-6,
            scale_free: Some(1e-6),
            max_iterations: 1_000_000,
            seconds: 60.0,
        };
        for method in Method::ALL {
            let outcome = solver::solve(&small, *method, &limits);
            let [field, free] = [
                field_error(&small, &outcome.p),
                scale_free_error(&small, &outcome.p),
            ];
            assert!(
                outcome.converged && field <= 1e-6 && free <= 1e-6,
                "{}: {field:e} and {free:e}",
                method.name()
            );
        }
    }
    let file = shared("fc3d_OneContact_reduced");
    for wrong in ["0", "-1", "NaN", "inf"] {
        let argument = format!("--scale-free-tolerance={wrong}");
        refused(&[&file, &argument], &["--scale-free-tolerance", "above 0"]);
    }
}
