//! Blocks that fit each other, and bonds over the faces between them, in 2D and 3D: sizes and areas
//! of samples, the law's closed form over a face, the ledger of a plate that tears.

mod face;
mod plane;
mod plate;
mod space;

use crate::scene;
use fretwork::geometry::space::Space;
use fretwork::step::Simulation;

/// A case of the project, with `--set`s.
fn scene<S: Space>(case: &str, sets: &[&str]) -> Simulation<S> {
    scene::case::<S>(case, sets)
}

/// Makes one step, which must converge.
fn step<S: Space>(s: &mut Simulation<S>) {
    let report = s.step().unwrap_or_else(|e| panic!("{e}"));
    assert!(
        report.solver.converged,
        "step {}: {:?}",
        s.state.steps, report.solver
    );
}

/// Index of a driven body among the driven bodies.
fn driven<S: Space>(s: &Simulation<S>, name: &str) -> usize {
    let mut all = s.state.bodies.driven.iter();
    all.position(|d| d.name == name).unwrap()
}

fn close(a: f64, b: f64, tolerance: f64) -> bool {
    (a / b - 1.0).abs() < tolerance
}
