//! Runs of some steps, and the warnings in them.

use super::verdict::{Cause, Expected, Row, Verdict};
use fretwork::geometry::space::{Space, VectorLike};
use fretwork::record::UnconvergedSteps;
use fretwork::step::Simulation;

/// Statistics and warnings of a run.
#[derive(Default)]
pub struct Ran {
    /// Number of steps.
    pub steps: u64,
    /// Steps that did not converge.
    pub missed: UnconvergedSteps,
    /// Message with which the run stopped.
    pub stopped: Option<String>,
    /// Largest number of iterations in a step.
    pub iterations: u32,
    /// Largest kinetic energy (J; J/m).
    pub liveliest: f64,
}

/// Makes `steps` steps.
pub fn go<S: Space>(s: &mut Simulation<S>, steps: u64) -> Ran {
    watch(s, steps, |_| ())
}

/// Makes `steps` steps and calls a function with the state after each.
pub fn watch<S: Space>(
    s: &mut Simulation<S>,
    steps: u64,
    mut look: impl FnMut(&Simulation<S>),
) -> Ran {
    let mut ran = Ran::default();
    for _ in 0..steps {
        match s.step() {
            Ok(report) => {
                ran.steps += 1;
                ran.iterations = ran.iterations.max(report.solver.iterations);
                ran.missed.add(&report.solver, s.state.steps);
                ran.liveliest = ran.liveliest.max(s.state.energy.kinetic);
                look(s);
            }
            Err(e) => {
                ran.stopped = Some(e.to_string());
                break;
            }
        }
    }
    ran
}

impl Ran {
    /// All warnings, in the words of the program.
    fn reported<S: Space>(&self, s: &Simulation<S>) -> Vec<(Cause, String)> {
        let mut reported = Vec::new();
        let stopped = self.stopped.iter().cloned();
        reported.extend(stopped.map(|words| (Cause::Stopped, words)));
        let step_size = &s.state.network.step_size;
        // One message covers all of them.
        let warning = step_size.warning().unwrap_or_default();
        let causes = [
            (step_size.late, Cause::Late),
            (step_size.unwatched_steps, Cause::Unwatched),
            (step_size.passed, Cause::Passed),
        ];
        let causes = causes.into_iter().filter(|(times, _)| *times > 0);
        reported.extend(causes.map(|(_, cause)| (cause, warning.clone())));
        let missed = self.missed.warning(s, self.steps);
        reported.extend(missed.map(|words| (Cause::Unconverged, words)));
        reported
    }

    /// Table row of a scene that ran.
    pub fn row<S: Space>(
        &self,
        s: &Simulation<S>,
        (value, found): (String, String),
        met: bool,
        expected: Expected,
    ) -> Row {
        let sound = s.state.bodies.position.iter().all(VectorLike::is_finite)
            && s.state.bodies.velocity.iter().all(VectorLike::is_finite)
            && s.state.energy.relative_residual() < 1e-6;
        Row {
            value,
            found,
            verdict: Verdict::new(expected, met, sound, &self.reported(s)),
        }
    }
}

/// Deepest overlap of the current contacts, as a fraction of their radius.
pub fn overlap<S: Space>(s: &Simulation<S>) -> f64 {
    let deep = s.state.network.contacts.iter().map(|c| -c.gap / c.radius);
    deep.fold(0.0, f64::max)
}

/// Force along the last axis on a first body in the last step (N/m; N).
pub fn carried<S: Space>(s: &Simulation<S>, name: &str) -> f64 {
    let driven = s.state.bodies.driven.iter().position(|d| d.name == name);
    driven.map_or(f64::NAN, |d| {
        -s.state.received[d].0[S::D - 1] / s.options.scheme.h
    })
}
