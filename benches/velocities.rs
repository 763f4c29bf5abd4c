//! Newton in velocities beside Gauss-Seidel, as inertia falls and tolerances tighten.
//!
//! `cargo bench --bench velocities` steps `cases/wheel_rail_fretting.ron` until its bonded layer
//! begins to slide, and from there some further steps by each method, from the same state: with the
//! tolerance of the case and with a balance of 1e-10, and with the inertia of all bodies multiplied
//! by 1 to 1e-8. It prints the time of the solver in a solve, its iterations (sweeps, or
//! factorisations of Newton), and the steps that did not converge. A word selects the methods whose
//! names contain it.

mod support;

use fretwork::geometry::space::Space;
use fretwork::in_dimension;
use fretwork::scene::{Case, load, processes};
use fretwork::shipped::search_path;
use fretwork::solve::SolverOptions;
use fretwork::solve::error::Norm;
use fretwork::solve::local::solver::Method;
use fretwork::step::Simulation;
use std::path::Path;
use std::time::Duration;

/// Steps until the wheel has begun to move.
const BEFORE: u32 = 1050;
/// Steps of each method.
const STEPS: u32 = 20;

fn main() {
    support::refuse_unoptimised();
    let wanted = std::env::args().skip(1).find(|a| !a.starts_with('-'));
    let file = format!(
        "{}/cases/wheel_rail_fretting.ron",
        env!("CARGO_MANIFEST_DIR")
    );
    let loaded = load(Path::new(&file), &[]).unwrap_or_else(|e| panic!("{e}"));
    let scene = loaded
        .build(&search_path())
        .unwrap_or_else(|e| panic!("{e}"));
    in_dimension!(scene.simulation, |s| compare(
        *s,
        &loaded.case,
        wanted.as_deref()
    ));
}

fn compare<S: Space>(mut s: Simulation<S>, case: &Case, wanted: Option<&str>) {
    processes::install(case, &mut s);
    for _ in 0..BEFORE {
        s.step().unwrap_or_else(|e| panic!("{e}"));
    }
    println!(
        "{:>8} {:<14} {:<9} {:>9} {:>11} {:>14}",
        "inertia", "tolerance", "method", "ms/solve", "iterations", "not converged"
    );
    let before = s.state.clone();
    for inertia in [1.0, 1e-2, 1e-4, 1e-6, 1e-8] {
        for (norm, tolerance) in [(Norm::Power, 0.5), (Norm::Balance, 1e-10)] {
            for method in [Method::Anderson, Method::Newton, Method::Auto] {
                if wanted.is_some_and(|w| !method.name().contains(w)) {
                    continue;
                }
                s.state = before.clone();
                scale_inertia(&mut s, inertia);
                s.options.solver = SolverOptions {
                    norm,
                    tolerance,
                    method,
                    max_iterations: 20_000,
                    ..s.options.solver
                };
                let name = format!("{norm:?} {tolerance:e}");
                print!("{inertia:>8.0e} {name:<14} {:<9}", method.name());
                time(&mut s);
            }
        }
    }
}

/// Steps, and prints the means.
fn time<S: Space>(s: &mut Simulation<S>) {
    let (mut solve, mut iterations, mut solves, mut missed) = (Duration::ZERO, 0, 0, 0);
    for _ in 0..STEPS {
        let report = s.step().unwrap_or_else(|e| panic!("{e}"));
        solve += report.timing.solve;
        iterations += report.solver.iterations;
        solves += report.solves;
        missed += u32::from(!report.solver.converged);
    }
    println!(
        " {:>9.2} {:>11.1} {missed:>14}",
        1e3 * solve.as_secs_f64() / f64::from(solves),
        f64::from(iterations) / f64::from(solves)
    );
}

/// Multiplies masses and moments of inertia.
fn scale_inertia<S: Space>(s: &mut Simulation<S>, factor: f64) {
    let bodies = &mut s.state.bodies;
    let both = bodies.mass.iter_mut().chain(&mut bodies.inertia);
    both.for_each(|m| *m *= factor);
    bodies
        .inverse_mass
        .iter_mut()
        .for_each(|m| *m = *m * (1.0 / factor));
    bodies.inverse_inertia.iter_mut().for_each(|m| *m /= factor);
}
