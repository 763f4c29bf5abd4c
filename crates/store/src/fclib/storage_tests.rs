//! Tests of reading one small problem in every storage format, written dataset by dataset.

use super::target::Target;
use super::write::complete;
use super::{FclibError, Problem, read, write_local};
use fretwork_core::solve::local::{Csr, LocalProblem};
use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering};

struct File(PathBuf);

impl File {
    fn new() -> Self {
        static COUNT: AtomicUsize = AtomicUsize::new(0);
        let number = COUNT.fetch_add(1, Ordering::Relaxed);
        let name = format!("fretwork-fclib-{}-{number}.hdf5", std::process::id());
        Self(std::env::temp_dir().join(name))
    }

    fn with(fill: impl FnOnce(&Target) -> Result<(), FclibError>) -> Self {
        let file = Self::new();
        complete(&file.0, fill).unwrap();
        file
    }
}

impl Drop for File {
    fn drop(&mut self) {
        std::fs::remove_file(&self.0).ok();
    }
}

/// Values nz, nzmax, p, i, x of a matrix group.
type Arrays<'a> = (i64, i64, &'a [i64], &'a [i64], &'a [f64]);

fn matrix(t: &Target, name: &str, m: i64, n: i64, arrays: Arrays) -> Result<(), FclibError> {
    let (nz, nzmax, p, i, x) = arrays;
    t.group(name)?;
    for (part, value) in [("m", m), ("n", n), ("nzmax", nzmax), ("nz", nz)] {
        t.integer(&format!("{name}/{part}"), value)?;
    }
    t.integers(&format!("{name}/p"), p.iter().copied())?;
    t.integers(&format!("{name}/i"), i.iter().copied())?;
    t.reals(&format!("{name}/x"), x)
}

/// A problem with one contact in 2D and this W.
fn local(w: Arrays) -> File {
    File::with(|t| {
        t.group("/fclib_local")?;
        t.integer("/fclib_local/spacedim", 2)?;
        matrix(t, "/fclib_local/W", 2, 2, w)?;
        t.group("/fclib_local/vectors")?;
        t.reals("/fclib_local/vectors/q", &[-1.0, 0.5])?;
        t.reals("/fclib_local/vectors/mu", &[0.25])
    })
}

fn w_of(file: &File) -> Result<Csr, FclibError> {
    match read(&file.0)? {
        Problem::Local(l) => Ok(l.problem.w),
        Problem::Global(_) => panic!("a local problem"),
    }
}

#[test]
fn every_storage_gives_the_same_matrix() {
    // [2 3; 0 4]
    let exact = Csr::from_triplets(2, 2, &[(0, 0, 2.0), (0, 1, 3.0), (1, 1, 4.0)]);
    let cases: [Arrays; 5] = [
        // p holds columns and i rows, and the arrays have unused capacity.
        (3, 5, &[1, 0, 1], &[0, 0, 1], &[3.0, 2.0, 4.0]),
        (
            3,
            5,
            &[1, 0, 1, 9, 9],
            &[0, 0, 1, 9, 9],
            &[3.0, 2.0, 4.0, 9.0, 9.0],
        ),
        (-1, 3, &[0, 1, 3], &[0, 1, 0], &[2.0, 4.0, 3.0]),
        (-2, 3, &[0, 2, 3], &[1, 0, 1], &[3.0, 2.0, 4.0]),
        // One entry is split into two, which must be added.
        (4, 4, &[1, 0, 1, 1], &[0, 0, 1, 0], &[1.0, 2.0, 4.0, 2.0]),
    ];
    for (k, case) in cases.into_iter().enumerate() {
        assert_eq!(w_of(&local(case)).unwrap(), exact, "case {k}");
    }
}

#[test]
fn explicit_zeros_and_empty_matrices_are_read() {
    let zero = w_of(&local((-2, 1, &[0, 1, 1], &[1], &[0.0]))).unwrap();
    assert_eq!(zero.values, [0.0]);
    for nz in [0, -1, -2] {
        let starts: &[i64] = if nz == 0 { &[] } else { &[0, 0, 0] };
        let empty = w_of(&local((nz, 0, starts, &[], &[]))).unwrap();
        assert_eq!((empty.rows, empty.values.len()), (2, 0));
    }
}

/// M is [2 3; 0 4] on two degrees of freedom, with unit mass on the others; H has `contacts`
/// contacts in 2D.
fn global(n: i64, m: i64, by_comment: bool) -> File {
    let turn = |p: &'static [i64], i: &'static [i64]| if by_comment { (i, p) } else { (p, i) };
    File::with(|t| {
        t.group("/fclib_global")?;
        t.integer("/fclib_global/spacedim", 2)?;
        let (p, i) = turn(&[0, 1, 1, 2], &[0, 0, 1, 2]);
        matrix(
            t,
            "/fclib_global/M",
            n,
            n,
            (4, 4, p, i, &[2.0, 3.0, 4.0, 1.0]),
        )?;
        let (p, i) = turn(&[0, 1], &[2, 0]);
        matrix(t, "/fclib_global/H", n, m, (2, 2, p, i, &[5.0, 6.0]))?;
        t.group("/fclib_global/vectors")?;
        t.reals("/fclib_global/vectors/f", &vec![0.0; n as usize])?;
        t.reals("/fclib_global/vectors/w", &vec![0.0; m as usize])?;
        t.reals("/fclib_global/vectors/mu", &vec![0.0; m as usize / 2])
    })
}

#[test]
fn triplets_by_the_comment_of_the_header_are_known_by_their_bounds() {
    for by_comment in [false, true] {
        let Problem::Global(g) = read(&global(3, 2, by_comment).0).unwrap() else {
            panic!("a global problem");
        };
        // M is square, so its order follows from H.
        let entries = |a: &Csr, r: usize| a.row(r).collect::<Vec<_>>();
        assert_eq!(entries(&g.problem.m, 0), [(0, 2.0), (1, 3.0)]);
        assert_eq!(entries(&g.problem.m, 1), [(1, 4.0)]);
        assert_eq!(entries(&g.problem.h, 2), [(0, 5.0)]);
        assert_eq!(entries(&g.problem.h, 0), [(1, 6.0)]);
    }
}

#[track_caller]
fn refused(file: &File, words: &[&str]) {
    let said = read(&file.0).unwrap_err().to_string();
    for word in words {
        assert!(said.contains(word), "no `{word}` in: {said}");
    }
}

#[test]
fn what_makes_no_matrix_is_refused() {
    let x: &[f64] = &[1.0, 2.0];
    let cases: [(Arrays, &[&str]); 10] = [
        (
            (2, 2, &[0, 2], &[0, 1], x),
            &["/fclib_local/W/p", "index 2", "below 2"],
        ),
        (
            (2, 2, &[0, 1], &[0, -1], x),
            &["/fclib_local/W/i", "index -1"],
        ),
        (
            (-2, 2, &[0, 1, 2], &[0, 2], x),
            &["/fclib_local/W/i", "index 2"],
        ),
        (
            (-1, 2, &[0, 2, 1], &[0, 1], x),
            &["/fclib_local/W/p", "never decrease"],
        ),
        (
            (-1, 2, &[1, 1, 2], &[0, 1], x),
            &["/fclib_local/W/p", "begin with 0"],
        ),
        (
            (-2, 2, &[0, 2], &[0, 1], x),
            &["/fclib_local/W/p", "2 pointers", "3 are expected"],
        ),
        (
            (-2, 2, &[0, 1, 3], &[0, 1], x),
            &["/fclib_local/W/i", "2 entries", "3 are expected"],
        ),
        (
            (-3, 2, &[0, 1, 2], &[0, 1], x),
            &["/fclib_local/W/nz", "-3", "compressed rows"],
        ),
        (
            (3, 2, &[0, 1, 1], &[0, 1, 1], x),
            &["/fclib_local/W/nzmax", "2"],
        ),
        (
            (2, 2, &[0, 1], &[0, 1], &[1.0, f64::NAN]),
            &["/fclib_local/W/x", "value 1", "NaN"],
        ),
    ];
    for (arrays, words) in cases {
        refused(&local(arrays), words);
    }
    let huge = local((2_000_000_000, 2_000_000_000, &[0], &[0], &[1.0]));
    refused(
        &huge,
        &["/fclib_local/W/p", "1 column indices for 2000000000"],
    );
    refused(
        &local((2, 2, &[0, 0], &[0, 0], &[1e308, 1e308])),
        &["W/x", "beyond the range"],
    );
}

/// A local problem with this dimension, these coefficients, and a W of two rows.
fn around(dimension: i64, q: &[f64], mu: &[f64], rows: i64) -> File {
    File::with(|t| {
        t.group("/fclib_local")?;
        t.integer("/fclib_local/spacedim", dimension)?;
        matrix(t, "/fclib_local/W", rows, rows, (0, 0, &[], &[], &[]))?;
        t.group("/fclib_local/vectors")?;
        t.reals("/fclib_local/vectors/q", q)?;
        t.reals("/fclib_local/vectors/mu", mu)
    })
}

#[test]
fn what_makes_no_problem_is_refused() {
    let q = [1.0, 2.0];
    refused(
        &around(4, &q, &[0.1], 2),
        &["/fclib_local/spacedim", "is 4", "2 or 3"],
    );
    refused(
        &around(-2, &q, &[0.1], 2),
        &["/fclib_local/spacedim", "is -2"],
    );
    refused(
        &around(3, &q, &[0.1], 2),
        &["/fclib_local/vectors/mu", "2 numbers", "3 per contact"],
    );
    refused(
        &around(2, &q, &[-0.1], 2),
        &["vectors/mu", "contact 0", "-0.1"],
    );
    refused(&around(2, &q, &[f64::INFINITY], 2), &["vectors/mu", "inf"]);
    refused(
        &around(2, &[f64::NAN, 0.0], &[0.1], 2),
        &["vectors/q", "value 0", "NaN"],
    );
    refused(
        &around(2, &q, &[0.1], 2_000_000_000),
        &["W/m", "2000000000 rows", "make it 2"],
    );
    refused(&around(2, &q, &[0.1], -1), &["W/m", "-1 rows"]);

    let nothing = File::with(|t| t.group("/results"));
    refused(&nothing, &["without an FCLIB problem", "/fclib_local"]);
    let rolling = File::with(|t| t.group("/fclib_global_rolling"));
    refused(
        &rolling,
        &[
            "/fclib_global_rolling",
            "rolling friction",
            "write the problem",
        ],
    );
    let hollow = File::with(|t| t.group("/fclib_global"));
    refused(&hollow, &["/fclib_global/spacedim is missing"]);
    let wordy = File::with(|t| {
        t.group("/fclib_local")?;
        t.text("/fclib_local/spacedim", "three")
    });
    refused(&wordy, &["/fclib_local/spacedim", "whole numbers"]);
    let half = File::with(|t| {
        t.group("/fclib_local")?;
        t.integer("/fclib_local/spacedim", 2)?;
        matrix(t, "/fclib_local/W", 2, 2, (0, 0, &[], &[], &[]))?;
        matrix(t, "/fclib_local/V", 2, 1, (0, 0, &[], &[], &[]))?;
        t.group("/fclib_local/vectors")?;
        t.reals("/fclib_local/vectors/q", &q)?;
        t.reals("/fclib_local/vectors/mu", &[0.1])
    });
    refused(&half, &["/fclib_local/R is missing", "together"]);
}

#[test]
fn an_empty_problem_comes_back() {
    let file = File::new();
    let problem = LocalProblem {
        dimension: 3,
        ..LocalProblem::default()
    };
    write_local(&file.0, &problem, "nothing", "no contact").unwrap();
    let Problem::Local(back) = read(&file.0).unwrap() else {
        panic!("a local problem");
    };
    assert_eq!(back.problem.q.len(), 0);
    assert_eq!(back.problem.w.rows, 0);
    assert_eq!(back.info.title.as_deref(), Some("nothing"));
}
