//! Runs of a 2D case, step by step, with the counts and times for the figures.

use fretwork::geometry::space::Dim2;
use fretwork::record::biaxial::{Biaxial, BiaxialState};
use fretwork::scene::load;
use fretwork::shipped::search_path;
use fretwork::solve::local::LocalProblem;
use fretwork::step::Simulation;
use std::error::Error;
use std::path::Path;

/// One step of a run.
#[derive(Clone, Copy, Debug)]
pub struct Step {
    /// Time at its end (s).
    pub time: f64,
    /// Iterations, as counted by the solver.
    pub iterations: u32,
    /// Whether the tolerance was reached.
    pub converged: bool,
    /// Time of the solve (s).
    pub seconds: f64,
    /// Kinetic energy of the grains' translation (J/m).
    pub kinetic: f64,
    /// The biaxial test, if the case has one.
    pub test: BiaxialState,
}

/// A run.
#[derive(Clone, Debug, Default)]
pub struct Trace {
    /// Steps of the run.
    pub steps: Vec<Step>,
    /// Contact problem of the last step.
    pub last: Option<LocalProblem>,
    /// The grains at the end: centre and radius (m).
    pub grains: Vec<([f64; 2], f64)>,
    /// Tolerance of the solver.
    pub tolerance: f64,
}

/// Runs a 2D case to a time, or to its end.
pub fn run(case: &Path, sets: &[String], until: Option<f64>) -> Result<Trace, Box<dyn Error>> {
    let loaded = load(case, sets)?;
    let mut s = loaded.build_in::<Dim2>(&search_path())?;
    let mut test = loaded
        .case
        .biaxial
        .as_ref()
        .and_then(|spec| Biaxial::new(spec, &s));
    let end = until.unwrap_or(loaded.case.time.end);
    let count = (end / s.options.scheme.h).round() as u64;
    let mut trace = Trace {
        tolerance: s.options.solver.tolerance,
        ..Trace::default()
    };
    for _ in 0..count {
        let report = s.step()?;
        if let Some(test) = &mut test {
            test.follow(&s);
        }
        trace.steps.push(Step {
            time: s.state.time,
            iterations: report.solver.iterations,
            converged: report.solver.converged,
            seconds: report.timing.solve.as_secs_f64(),
            kinetic: s
                .shapes
                .balls
                .iter()
                .map(|b| kinetic(&s, b.body as usize))
                .sum(),
            test: test.as_ref().map(|t| t.state(&s)).unwrap_or_default(),
        });
    }
    trace.last = s.local_problem();
    let driven = |body: u32| s.state.bodies.driven.iter().any(|d| d.body == body);
    for ball in s.shapes.balls.iter().filter(|b| !driven(b.body)) {
        let at = s.state.bodies.position[ball.body as usize];
        trace.grains.push(([at[0], at[1]], ball.radius));
    }
    Ok(trace)
}

/// Kinetic energy of translation of a body (J/m).
fn kinetic(s: &Simulation<Dim2>, body: usize) -> f64 {
    0.5 * s.state.bodies.mass[body] * s.state.bodies.velocity[body].norm_squared()
}

impl Trace {
    /// Time of all solves (s).
    pub fn seconds(&self) -> f64 {
        self.steps.iter().map(|s| s.seconds).sum()
    }

    /// Mean iterations per step.
    pub fn iterations(&self) -> f64 {
        let sum: u64 = self.steps.iter().map(|s| u64::from(s.iterations)).sum();
        sum as f64 / self.steps.len().max(1) as f64
    }

    /// Steps that missed the tolerance.
    pub fn missed(&self) -> usize {
        self.steps.iter().filter(|s| !s.converged).count()
    }
}
