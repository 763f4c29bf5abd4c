//! The smallest problems on which sweeps over rigid contacts never end, a disk that spins between
//! walls, and the methods that solve them.
//!
//! A sweep solves one contact after the other. A contact that sticks projects the velocity
//! orthogonally, one that slides along (1, mu) against its normal, which lengthens it by up to
//! 1/cos(delta), tan(delta) = mu. If all n walls slide, whose contact lines are pi/n apart, a sweep
//! multiplies the velocity by (cos(pi/n - delta)/cos(delta))^n: above one for mu > tan(pi/(2n)).

use fretwork::record::fclib::{self, Problem};
use fretwork::solve::local::solver::{Limits, Method, Outcome, solve};
use fretwork::solve::local::{Csr, LocalProblem};
use nalgebra::{DMatrix, DVector};
use std::f64::consts::PI;
use std::path::Path;

/// A disk of mass 1, radius 1 and inertia 1/2 between walls whose normals have these angles (rad),
/// with this free velocity (m/s, rad/s); `compliance` on the diagonal of W.
fn pit(angles: &[f64], velocity: [f64; 3], mu: f64, compliance: f64) -> LocalProblem {
    let rows = angles.iter().flat_map(|a| {
        let (s, c) = a.sin_cos();
        [c, s, 0.0, -s, c, -1.0]
    });
    let h = DMatrix::from_row_iterator(2 * angles.len(), 3, rows);
    let inverse_mass = DMatrix::from_diagonal(&DVector::from_vec(vec![1.0, 1.0, 2.0]));
    let n = 2 * angles.len();
    let w = &h * inverse_mass * h.transpose() + DMatrix::identity(n, n) * compliance;
    let entries: Vec<_> = (0..n * n)
        .map(|k| ((k / n) as u32, (k % n) as u32, w[(k / n, k % n)]))
        .collect();
    LocalProblem {
        dimension: 2,
        w: Csr::from_triplets(n, n, &entries),
        q: (&h * DVector::from_row_slice(&velocity))
            .as_slice()
            .to_vec(),
        mu: vec![mu; angles.len()],
    }
}

/// A corner of floor and wall.
fn corner(mu: f64, compliance: f64) -> LocalProblem {
    pit(&[0.5 * PI, 0.0], [0.0, -1.0, 10.0], mu, compliance)
}

/// Five walls in a half circle, in an order that cycles; most orders do not.
fn five(mu: f64) -> LocalProblem {
    let angles = [0.0, 144.0, 108.0, 72.0, 36.0f64].map(f64::to_radians);
    pit(&angles, [0.0, -1.0, 10.0], mu, 0.0)
}

fn by(method: Method, problem: &LocalProblem) -> Outcome {
    let limits = Limits {
        tolerance: 1e-8,
        scale_free: None,
        max_iterations: 10_000,
        seconds: 20.0,
    };
    solve(problem, method, &limits)
}

/// Two contacts: all contacts slide for mu = 1.2 > tan(pi/4), and p = (1, mu, mu, mu^2)/(1 + mu^2)
/// solves the problem.
#[test]
fn a_disk_that_spins_in_a_corner_is_not_solved_by_sweeps() {
    let problem = corner(1.2, 0.0);
    let p = [1.0, 1.2, 1.2, 1.44].map(|x| x / 2.44);
    let u = |r: usize| problem.q[r] + problem.w.row(r).map(|(c, w)| w * p[c]).sum::<f64>();
    assert!(u(0).abs() < 1e-12 && u(2).abs() < 1e-12);
    assert!(u(1) < -1.0 && u(3) < -1.0);
    let sweeps = [
        Method::Nlgs,
        Method::NlgsSymmetric,
        Method::Pg,
        Method::Cpg,
        Method::Pcpg,
        Method::Apgd,
    ];
    for method in sweeps {
        let outcome = by(method, &problem);
        assert!(
            !outcome.converged && outcome.error > 1e-2,
            "{}: {:e}",
            method.name(),
            outcome.error
        );
    }
    for method in [
        Method::Anderson,
        Method::Newton,
        Method::Interior,
        Method::Auto,
    ] {
        let outcome = by(method, &problem);
        assert!(outcome.converged, "{}: {:e}", method.name(), outcome.error);
    }
    // Sweeps end below the threshold, and above it if the contacts are compliant: all slide with
    // mu/(1 + c) < 1.
    assert!(by(Method::Nlgs, &corner(0.9, 0.0)).converged);
    assert!(!by(Method::Nlgs, &corner(1.2, 0.19)).converged);
    assert!(by(Method::Nlgs, &corner(1.2, 0.21)).converged);
}

/// The file of the documentation is the corner problem.
#[test]
fn the_shipped_problem_is_the_corner() {
    let file = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/tests/fclib/disk_in_a_corner.hdf5"
    );
    let Ok(Problem::Local(shipped)) = fclib::read(Path::new(file)) else {
        panic!("{file} is no local problem");
    };
    let (shipped, made) = (shipped.problem, corner(1.2, 0.0));
    assert_eq!((shipped.dimension, &shipped.mu), (2, &made.mu));
    let row = |of: &LocalProblem, r: usize| {
        let mut row = [0.0; 5];
        of.w.row(r).for_each(|(c, x)| row[c] += x);
        row[4] = of.q[r];
        row
    };
    for r in 0..4 {
        let pairs = row(&shipped, r).into_iter().zip(row(&made, r));
        assert!(
            pairs.into_iter().all(|(a, b)| (a - b).abs() < 1e-12),
            "row {r}"
        );
    }
}

/// Five contacts have the threshold tan(pi/10) = 0.325, which is the friction of grains.
#[test]
fn five_walls_cycle_at_the_friction_of_grains() {
    assert!(by(Method::Nlgs, &five(0.32)).converged);
    assert!(!by(Method::Nlgs, &five(0.33)).converged);
    assert!(by(Method::Auto, &five(0.4)).converged);
}
