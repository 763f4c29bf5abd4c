//! Limits: nothing to solve, contacts that nothing moves, numbers that are not finite, no time.

use super::made::{Made, friction, rng, well};
use super::{run, tolerance};
use fretwork::solve::error::Norm;
use fretwork::solve::local::LocalProblem;
use fretwork::solve::local::solver::{Limits, Method, field_error, solve};
use fretwork::solve::local::state::Budget;
use nalgebra::DMatrix;

const LIMITS: Limits = Limits {
    tolerance: 1e-8,
    scale_free: None,
    max_iterations: 200,
    seconds: 1.0,
};

fn all() -> impl Iterator<Item = Method> {
    Method::ALL.iter().copied()
}

#[test]
fn nothing_to_solve() {
    for dimension in [2, 3] {
        let problem = LocalProblem {
            dimension,
            w: fretwork::solve::local::Csr::from_triplets(0, 0, &[]),
            ..LocalProblem::default()
        };
        for method in all() {
            let outcome = solve(&problem, method, &LIMITS);
            assert!(outcome.converged, "{}", method.name());
            assert_eq!((outcome.error, outcome.p.len()), (0.0, 0));
        }
    }
}

fn immovable<const D: usize>() {
    let mut rng = rng(21);
    for mu in [0.0, 0.3] {
        for at in [0, 3, 5] {
            let mut w = well(6 * D, 3.0, &mut rng);
            for k in at * D..at * D + D {
                w.row_mut(k).fill(0.0);
                w.column_mut(k).fill(0.0);
            }
            let name = format!("{D}D, contact {at} between immovable bodies, mu {mu}");
            let mut made = Made::<D>::new(w, friction(6, mu, true), name, &mut rng);
            // The contact slides freely, and is not pressed.
            made.q[at * D] = made.q[at * D].abs();
            for method in all() {
                if made.q[at * D] > 0.0 || made.q[at * D + 1..at * D + D].iter().all(|x| *x == 0.0)
                {
                    let (state, solved) = run(&made, method, Norm::Field);
                    let (name, error) = (method.name(), state.error);
                    // With p = 0 and u = 0 in one contact the interior point method ends near 1e-8.
                    let near = method == Method::Interior && error <= 1e-7;
                    assert!(solved || near, "{name} on {}: {error:e}", made.name);
                }
            }
            // If the contact is pressed there is no solution, and no method may report one.
            made.q[at * D] = -1.0;
            for method in all() {
                let (_, solved) = run(&made, method, Norm::Field);
                assert!(!solved, "{} on {}", method.name(), made.name);
            }
        }
    }
    // No contact moves.
    let mut made = Made::<D>::new(
        DMatrix::zeros(2 * D, 2 * D),
        friction(2, 0.3, false),
        format!("{D}D, no body moves"),
        &mut rng,
    );
    made.q = vec![1.0; 2 * D];
    for method in all() {
        assert!(run(&made, method, Norm::Field).1, "{}", method.name());
    }
    made.q = vec![-1.0; 2 * D];
    for method in all() {
        assert!(!run(&made, method, Norm::Field).1, "{}", method.name());
    }
}

#[test]
fn contacts_that_nothing_moves() {
    immovable::<2>();
    immovable::<3>();
}

fn made<const D: usize>(seed: u64) -> Made<D> {
    let mut rng = rng(seed);
    let w = well(5 * D, 3.0, &mut rng);
    let mut made = Made::new(w, friction(5, 0.3, true), "five contacts".into(), &mut rng);
    // One contact is pressed, so that p = 0 is not a solution.
    made.q[0] = -1.0;
    made
}

fn not_a_number<const D: usize>() {
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for entry in [0, 1, D, 4 * D] {
            let good = made::<D>(22).problem();
            assert!(good.check().is_ok());
            let (mut in_w, mut in_q, mut in_mu) = (good.clone(), good.clone(), good);
            in_w.w.values[entry * 5] = bad;
            in_q.q[entry] = bad;
            in_mu.mu[entry / D] = bad;
            for problem in [in_w, in_q, in_mu] {
                let reason = problem.check().unwrap_err();
                assert!(reason.contains("NaN") || reason.contains("inf"), "{reason}");
                assert_eq!(
                    field_error(&problem, &vec![0.0; 5 * D]),
                    f64::INFINITY,
                    "{reason}"
                );
                for method in all() {
                    let outcome = solve(&problem, method, &LIMITS);
                    assert!(!outcome.converged, "{}", method.name());
                    assert!(outcome.p.iter().all(|x| *x == 0.0));
                }
            }
            // The solver behind that check is tested too.
            for in_w in [false, true] {
                let mut made = made::<D>(22);
                if in_w {
                    made.w[(entry, 0)] = bad;
                } else {
                    made.q[entry] = bad;
                }
                for norm in [Norm::Field, Norm::Velocity, Norm::Balance] {
                    for method in all() {
                        let (w, q) = (made.blocks(), made.free());
                        let mut budget = Budget::new(1e-8, 200, 1.0);
                        let state = method.solve_blocks(&w, &q, &made.laws, norm, &mut budget);
                        assert!(
                            state.error > 1e-8,
                            "{} with {bad} at {entry} (in W: {in_w}): {norm:?}",
                            method.name()
                        );
                    }
                }
            }
        }
    }
}

#[test]
fn numbers_that_are_none() {
    not_a_number::<2>();
    not_a_number::<3>();
}

#[test]
fn a_problem_that_does_not_fit_is_refused() {
    let good = made::<3>(22).problem();
    let mut few = good.clone();
    few.q.pop();
    let mut below = good.clone();
    below.mu[3] = -0.1;
    let mut line = good;
    line.dimension = 1;
    for (problem, why) in [(few, "5 contacts"), (below, "contact 3"), (line, "not 1")] {
        let reason = problem.check().unwrap_err();
        assert!(reason.contains(why), "{reason}");
        assert!(!solve(&problem, Method::Auto, &LIMITS).converged);
    }
}

/// q is larger than what a square can represent.
#[test]
fn tiny_and_huge_velocities() {
    let made = made::<3>(23);
    for scale in [1e-250, 1e-160, 1e-100, 1e100, 1e160, 1e250] {
        let mut problem = made.problem();
        for q in &mut problem.q {
            *q *= scale;
        }
        for method in all() {
            let outcome = solve(&problem, method, &LIMITS);
            let p: Vec<f64> = outcome.p.iter().map(|p| p / scale).collect();
            let error = made.error(&p, Norm::Field);
            let name = method.name();
            assert!(
                (outcome.error - error).abs() <= 1e-6 * error + 1e-13,
                "{name} at {scale:e}: says {:e}, has {error:e}",
                outcome.error
            );
            assert!(error <= tolerance(method), "{name} at {scale:e}: {error:e}");
        }
    }
}

fn at_once<const D: usize>() {
    let made = made::<D>(24);
    let (w, q) = (made.blocks(), made.free());
    let before = made.error(&vec![0.0; made.p.len()], Norm::Field);
    for method in all() {
        for (iterations, seconds) in [(1, 10.0), (0, 10.0), (1_000_000, 0.0)] {
            let mut budget = Budget::new(0.0, iterations, seconds);
            let state = method.solve_blocks(&w, &q, &made.laws, Norm::Field, &mut budget);
            let name = method.name();
            let most = if seconds > 0.0 { iterations } else { 0 };
            assert!(
                state.iterations <= most,
                "{name}: {} of {most}",
                state.iterations
            );
            assert!(state.p.as_flattened().iter().all(|x| x.is_finite()));
            let error = made.error(state.p.as_flattened(), Norm::Field);
            assert!(error <= before * (1.0 + 1e-12), "{name} made it worse");
            assert!((error - state.error).abs() <= 1e-12, "{name}");
        }
        // The result agrees with its report, also through the other interface.
        let outcome = solve(&made.problem(), method, &LIMITS);
        assert_eq!(outcome.error <= LIMITS.tolerance, outcome.converged);
        let error = made.error(&outcome.p, Norm::Field);
        assert!((error - outcome.error).abs() <= 1e-6 * error + 1e-13);
        assert!(error <= tolerance(method), "{}: {error:e}", method.name());
    }
}

#[test]
fn no_time_and_no_iterations() {
    at_once::<2>();
    at_once::<3>();
}

/// Returns a problem of one contact from its block.
fn single<const D: usize>(w: [[f64; D]; D], q: [f64; D], mu: f64) -> LocalProblem {
    let entries: Vec<(u32, u32, f64)> = (0..D * D)
        .map(|k| ((k / D) as u32, (k % D) as u32, w[k / D][k % D]))
        .collect();
    LocalProblem {
        dimension: D,
        w: fretwork::solve::local::Csr::from_triplets(D, D, &entries),
        q: q.to_vec(),
        mu: vec![mu],
    }
}

/// Bodies move along some directions only: the slip in the other directions is given, and friction
/// opposes it.
#[test]
fn blocks_of_less_than_full_rank() {
    let r = 0.3f64.hypot(1.0);
    let problems = [
        (
            single([[1.0, 0.0], [0.0, 0.0]], [-1.0, -1.0], 0.5),
            vec![1.0, 0.5],
        ),
        (
            single([[1.0, 0.0], [0.0, 0.0]], [-1.0, 1.0], 0.5),
            vec![1.0, -0.5],
        ),
        // The equations are u_n = p_n + p_t/2 - 1 = 0 and p_t = mu p_n, against u_t < 0.
        (
            single([[1.0, 0.5], [0.5, 0.25]], [-1.0, -1.0], 0.3),
            vec![1.0 / 1.15, 0.3 / 1.15],
        ),
        (
            single(
                [[1.0, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]],
                [-1.0, -1.0, 0.3],
                0.5,
            ),
            vec![1.0, 0.5 / r, -0.15 / r],
        ),
    ];
    for (problem, expected) in problems {
        for method in all() {
            let limits = Limits {
                max_iterations: 20_000,
                ..LIMITS
            };
            let outcome = solve(&problem, method, &limits);
            let name = method.name();
            assert!(
                outcome.converged,
                "{name} on {problem:?}: {:e}",
                outcome.error
            );
            for (p, e) in outcome.p.iter().zip(&expected) {
                assert!(
                    (p - e).abs() < 1e-6,
                    "{name}: {:?}, not {expected:?}",
                    outcome.p
                );
            }
        }
    }
    // One tangent is free: |p_t| = mu p_n along (u_1, u_2) with u_1 = p_1 - 0.3.
    let problem = single(
        [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 0.0]],
        [-1.0, -0.3, 0.3],
        0.5,
    );
    for method in all() {
        let limits = Limits {
            max_iterations: 20_000,
            ..LIMITS
        };
        let outcome = solve(&problem, method, &limits);
        assert!(outcome.converged, "{}: {:e}", method.name(), outcome.error);
        let (p, u) = (&outcome.p, &outcome.u);
        assert!((p[1].hypot(p[2]) - 0.5).abs() < 1e-6 && (p[1] * u[2] - p[2] * u[1]).abs() < 1e-6);
        assert!(p[2] < 0.0);
    }
}

/// With a large mu the natural map is hardly affected if nothing is carried.
#[test]
fn large_friction_hides_no_penetration() {
    for mu in [1e3, 1e5, 1e6, 1e10, 1e50, 1e160] {
        let w = [[1.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 2.0]];
        let problem = single(w, [-1.0, 3.0, 0.4], mu);
        for tolerance in [1e-4, 1e-8] {
            let mut solved = 0;
            for method in all() {
                let limits = Limits {
                    tolerance,
                    ..LIMITS
                };
                let outcome = solve(&problem, method, &limits);
                solved += u32::from(outcome.converged);
                let gap = outcome.p[0].min(outcome.u[0]).abs();
                let name = method.name();
                assert!(
                    !outcome.converged || gap <= 10.0 * tolerance,
                    "{name}, mu {mu:e}: {gap}"
                );
            }
            assert!(mu > 1e6 || solved >= 3, "mu {mu:e}: {solved} methods");
        }
    }
}

/// u_1 + u_2 = -2 for any impulses: no method may report a solution.
#[test]
fn no_answer_is_no_success() {
    for mu in [0.0, 0.3] {
        let entries: Vec<(u32, u32, f64)> = [(0, 0, 1.0), (0, 2, -1.0), (2, 0, -1.0), (2, 2, 1.0)]
            .into_iter()
            .chain([(1, 1, 1.0), (3, 3, 1.0)])
            .collect();
        let problem = LocalProblem {
            dimension: 2,
            w: fretwork::solve::local::Csr::from_triplets(4, 4, &entries),
            q: vec![-1.0, 0.0, -1.0, 0.0],
            mu: vec![mu; 2],
        };
        for method in all() {
            for tolerance in [1e-4, 1e-8] {
                let limits = Limits {
                    tolerance,
                    max_iterations: 20_000,
                    ..LIMITS
                };
                let outcome = solve(&problem, method, &limits);
                assert!(!outcome.converged, "{}: {:?}", method.name(), outcome.p);
            }
        }
    }
}
