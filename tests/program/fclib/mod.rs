//! FCLIB files: shared files, reading of written files, and damaged bytes.

mod damage;

use fretwork::record::fclib::{self, Global, Info, Local, Problem, Solution};
use fretwork::solve::local::{
    Csr, Elimination, Equalities, GlobalProblem, LocalProblem, Multipliers, Reduction,
};
use std::path::{Path, PathBuf};

fn shared(name: &str) -> PathBuf {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/fclib")).join(name)
}

fn local(path: &Path) -> Local {
    match fclib::read(path).unwrap() {
        Problem::Local(l) => l,
        Problem::Global(_) => panic!("{} is global", path.display()),
    }
}

fn global(path: &Path) -> Global {
    match fclib::read(path).unwrap() {
        Problem::Global(g) => g,
        Problem::Local(_) => panic!("{} is local", path.display()),
    }
}

/// A separate file name, removed at the end.
struct Scratch(PathBuf);

impl Scratch {
    fn new(name: &str) -> Self {
        let name = format!("fretwork-fclib-test-{}-{name}.hdf5", std::process::id());
        Self(std::env::temp_dir().join(name))
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        std::fs::remove_file(&self.0).ok();
    }
}

fn close(a: &[f64], b: &[f64], what: &str) {
    assert_eq!(a.len(), b.len(), "{what}");
    let scale = b.iter().fold(0.0f64, |s, x| s.max(x.abs()));
    for (x, y) in a.iter().zip(b) {
        assert!((x - y).abs() <= 1e-10 * scale, "{what}: {x} and {y}");
    }
}

fn dense(a: &Csr) -> Vec<f64> {
    let mut out = vec![0.0; a.rows * a.columns];
    for r in 0..a.rows {
        for (c, x) in a.row(r) {
            out[r * a.columns + c] = x;
        }
    }
    out
}

#[test]
fn a_global_problem_has_the_local_form_that_was_computed_elsewhere() {
    let problem = global(&shared("gfc3d_OneContact.hdf5")).problem;
    let reduction = Reduction::new(&problem).unwrap();
    let known = local(&shared("fc3d_OneContact_reduced.hdf5")).problem;
    close(&dense(&reduction.local.w), &dense(&known.w), "W");
    close(&reduction.local.q, &known.q, "q");
    assert_eq!(reduction.local.mu, known.mu);
    // In return, the velocities of any impulses give the relative velocities of the local form.
    let r = [0.5, -1.0, 2.0];
    let (v, l) = reduction.velocities(&problem, &r);
    assert!(l.is_empty());
    let u = problem.relative_velocities(&v);
    close(&u, &reduction.local.velocities(&r), "u");
}

#[test]
fn a_diagonal_matrix_is_inverted_exactly() {
    let problem = global(&shared("gfc3d_Example00_badly_scaled.hdf5")).problem;
    let mut entries = Vec::new();
    for i in 0..problem.m.rows {
        for (c, m) in problem.m.row(i) {
            assert!(c == i || m == 0.0);
            entries.extend(problem.h.row(i).flat_map(|(a, x)| {
                let row = problem.h.row(i);
                row.map(move |(b, y)| (a as u32, b as u32, x * y / m))
            }));
        }
    }
    let m = problem.w.len();
    let known = Csr::from_triplets(m, m, &entries);
    let reduced = Reduction::new(&problem).unwrap().local;
    close(&dense(&reduced.w), &dense(&known), "W");
}

#[test]
fn the_upper_triangle_of_a_matrix_is_read_as_it_stands() {
    let problem = global(&shared("gfc3d_LMGC_GlobalFrictionContactProblem00046.hdf5")).problem;
    assert!((0..problem.m.rows).all(|r| problem.m.row(r).all(|(c, x)| c >= r || x == 0.0)));
    let local = Reduction::new(&problem).unwrap().local;
    assert_eq!(local.mu.len(), 9);
    // W read as a triangle is far from symmetric (index of the collection: 0.16 of its largest
    // entry).
    let w = dense(&local.w);
    let largest = w.iter().fold(0.0f64, |s, x| s.max(x.abs()));
    let gap = (0..27).flat_map(|i| (0..27).map(move |j| (i, j)));
    let gap = gap.fold(0.0f64, |s, (i, j)| {
        s.max((w[i * 27 + j] - w[j * 27 + i]).abs())
    });
    assert!((0.1..0.3).contains(&(gap / largest)), "{}", gap / largest);
}

#[test]
fn every_shared_file_comes_back_as_it_was_read() {
    let out = Scratch::new("shared");
    let mut count = 0;
    for entry in std::fs::read_dir(shared("")).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_string_lossy();
        if !name.ends_with(".hdf5") || name.starts_with("foreign") {
            continue;
        }
        let problem = fclib::read(&path).unwrap();
        fclib::write(&out.0, &problem).unwrap();
        assert_eq!(fclib::read(&out.0).unwrap(), problem, "{}", path.display());
        count += 1;
    }
    assert_eq!(count, 8);
}

#[test]
fn what_other_writers_do_is_read_or_refused_with_what_to_do() {
    // The file has big-endian 64-bit integers and 32-bit reals, attributes, and texts that are not
    // valid.
    let foreign = local(&shared("foreign_types.hdf5"));
    assert_eq!(foreign.problem.w.values, [2.0, 1.0]);
    assert_eq!(foreign.problem.q, [-1.0, 0.0]);
    assert_eq!(foreign.problem.mu, [0.5]);
    assert_eq!(
        foreign.info.title.as_deref(),
        Some("caf\u{fffd} [2J \u{fffd}")
    );
    assert_eq!(foreign.info.description.as_deref(), Some("of any length"));
    assert_eq!(foreign.info.math_info, None);
    let solution = fclib::read_solution(&shared("foreign_types.hdf5")).unwrap();
    assert_eq!(solution.unwrap().r, [0.0; 2]);
    // Unwritten data read as zeros.
    assert_eq!(local(&shared("foreign_unwritten.hdf5")).problem.q, [0.0; 2]);

    for (name, words) in [
        ("huge", "claims to be larger than the whole file"),
        ("chunked", "h5repack -l CONTI"),
        ("outside", "in another file"),
        ("linked", "q is missing"),
    ] {
        let path = shared(&format!("foreign_{name}.hdf5"));
        let said = fclib::read(&path).unwrap_err().to_string();
        assert!(
            said.contains(words) && said.contains("/fclib_local/vectors/q"),
            "{said}"
        );
    }
}

fn unit(n: u32, x: f64) -> Csr {
    Csr::from_triplets(
        n as usize,
        n as usize,
        &(0..n).map(|i| (i, i, x)).collect::<Vec<_>>(),
    )
}

/// A local problem with one multiplier, which holds the first tangent.
fn constrained_local() -> Local {
    let mut w = unit(3, 1.0);
    // The block is full, as it is written.
    w = Csr::from_triplets(
        3,
        3,
        &(0..9)
            .map(|k| {
                (
                    k / 3,
                    k % 3,
                    w.row(k as usize / 3)
                        .find(|e| e.0 == k as usize % 3)
                        .map_or(0.0, |e| e.1),
                )
            })
            .collect::<Vec<_>>(),
    );
    Local {
        problem: LocalProblem {
            dimension: 3,
            w,
            q: vec![-1.0, 0.5, 0.0],
            mu: vec![0.3],
        },
        multipliers: Some(Multipliers {
            v: Csr::from_triplets(3, 1, &[(1, 0, 1.0)]),
            r: Csr::from_triplets(1, 1, &[(0, 0, 2.0)]),
            s: vec![0.25],
        }),
        info: Info {
            title: Some("one contact".to_owned()),
            description: Some("with a multiplier".to_owned()),
            math_info: Some("unknown".to_owned()),
        },
    }
}

/// Two masses tied together, one of them in contact.
fn constrained_global() -> GlobalProblem {
    GlobalProblem {
        dimension: 2,
        m: unit(4, 2.0),
        h: Csr::from_triplets(4, 2, &[(0, 0, 1.0), (1, 1, 1.0)]),
        f: vec![-2.0, 0.5, 0.0, 0.0],
        w: vec![0.0, 0.1],
        mu: vec![0.5],
        equalities: Some(Equalities {
            g: Csr::from_triplets(
                4,
                2,
                &[(0, 0, 1.0), (2, 0, -1.0), (1, 1, 1.0), (3, 1, -1.0)],
            ),
            b: vec![0.0, 0.1],
        }),
    }
}

#[test]
fn multipliers_and_solutions_come_back() {
    let out = Scratch::new("multipliers");
    let problem = constrained_local();
    let m = problem.multipliers.clone().unwrap();
    let form = Elimination::new(&problem.problem, &m).unwrap();
    assert_eq!(form.local.w.row(1).collect::<Vec<_>>()[1], (1, 0.5));
    assert_eq!(form.local.q, [-1.0, 0.375, 0.0]);
    let r = vec![1.0, -0.2, 0.0];
    let solution = Solution {
        v: Vec::new(),
        l: form.multipliers(&m, &r),
        u: form.local.velocities(&r),
        r,
    };
    assert!((solution.l[0] - 0.5 * (0.2 - 0.25)).abs() < 1e-15);
    let problem = Problem::Local(problem);
    fclib::write_with_solution(&out.0, &problem, &solution).unwrap();
    assert_eq!(fclib::read(&out.0).unwrap(), problem);
    assert_eq!(fclib::read_solution(&out.0).unwrap().unwrap(), solution);
}

#[test]
fn constraints_come_back_and_hold() {
    let out = Scratch::new("constraints");
    let problem = constrained_global();
    fclib::write_global(&out.0, &problem, "tied", "two masses").unwrap();
    let back = global(&out.0);
    assert_eq!(back.problem, problem);
    assert_eq!(back.info.title.as_deref(), Some("tied"));
    assert_eq!(fclib::read_solution(&out.0).unwrap(), None);
    let form = Reduction::new(&problem).unwrap();
    // The two masses move as one of four kilograms.
    close(&dense(&form.local.w), &[0.25, 0.0, 0.0, 0.25], "W");
    let (v, l) = form.velocities(&problem, &[1.0, 0.0]);
    assert!((v[0] - v[2]).abs() < 1e-15 && (v[1] - v[3] + 0.1).abs() < 1e-15);
    assert_eq!(l.len(), 2);
}

#[test]
fn text_that_is_no_ascii_is_written_as_question_marks() {
    let out = Scratch::new("text");
    fclib::write_local(
        &out.0,
        &LocalProblem {
            dimension: 2,
            ..LocalProblem::default()
        },
        "µ\0ü",
        "a\nb",
    )
    .unwrap();
    let info = local(&out.0).info;
    assert_eq!(info.title.as_deref(), Some("???"));
    assert_eq!(info.description.as_deref(), Some("a\nb"));
    assert_eq!(info.math_info.as_deref(), Some("unknown"));
}

#[test]
fn a_file_that_cannot_be_written_is_said_and_leaves_nothing() {
    let nowhere = std::env::temp_dir().join("fretwork-no-such-folder/a.hdf5");
    let said = fclib::write_local(&nowhere, &LocalProblem::default(), "", "")
        .unwrap_err()
        .to_string();
    assert!(
        said.contains("cannot write") && said.contains("fretwork-no-such-folder"),
        "{said}"
    );
}
