//! Functions that step a scene, with checks of each step, and comparisons of results.

use fretwork::geometry::space::Space;
use fretwork::step::Simulation;

/// Makes a number of steps, converged or not.
pub(crate) fn steps<S: Space>(s: &mut Simulation<S>, count: usize) {
    for _ in 0..count {
        s.step().unwrap_or_else(|e| panic!("{e}"));
    }
}

/// Makes one step, which must converge.
fn converged<S: Space>(s: &mut Simulation<S>) {
    let solver = s.step().unwrap_or_else(|e| panic!("{e}")).solver;
    assert!(solver.converged, "step {}: {solver:?}", s.state.steps);
}

/// Makes a number of steps, each of which must converge.
pub(crate) fn go<S: Space>(s: &mut Simulation<S>, count: usize) {
    (0..count).for_each(|_| converged(s));
}

/// Steps to a time (s); each step must converge.
pub(crate) fn until<S: Space>(s: &mut Simulation<S>, end: f64) {
    while s.state.time < end - 0.5 * s.options.scheme.h {
        converged(s);
    }
}

/// Checks that the ledger of energy closes within a fraction of its largest entry.
pub(crate) fn closes<S: Space>(s: &Simulation<S>, tolerance: f64) {
    let off = s.state.energy.relative_residual();
    assert!(off < tolerance, "{off:e}: {:?}", s.state.energy);
}

/// Checks that a number is the expected one within a relative tolerance.
#[track_caller]
pub(crate) fn near(expected: f64, obtained: f64, tolerance: f64) {
    let off = (obtained - expected).abs() / expected.abs();
    assert!(
        off <= tolerance || obtained == expected,
        "expected {expected:e}, obtained {obtained:e}: off by {off:e}"
    );
}
