//! When to try Newton in velocities: after Gauss-Seidel has taken about as long as Newton would.
//!
//! The rule follows from sizes and counts, not from timings, so that a case takes the same path on
//! any machine.

use crate::geometry::space::Space;
use crate::solve::nlgs::Report;
use crate::solve::problem::Problem;
use serde::{Deserialize, Serialize};

/// Largest numbers of bodies of which the matrix is factorised, in 2D and 3D: some gigabytes.
const MAX_BODIES: [usize; 2] = [200_000, 15_000];
/// Time of an iteration in sweeps, measured with as many bodies (`cargo bench --bench velocities`).
const SWEEPS: f64 = 60.0;
const MEASURED: f64 = 1000.0;
/// The same by body in 3D: an estimate, from the size of separators in a cube.
const SWEEPS_PER_BODY: f64 = 0.15;
/// Number of iterations of a solve, until one was done.
const ITERATIONS: f64 = 5.0;
/// Number of solves after which all sweeps are done again, although they have not sufficed lately.
const ALL_AFTER: u32 = 16;
/// Smallest and largest factor on the number of sweeps.
const LIMITS: [f64; 2] = [0.05, 64.0];

/// Returns the number of sweeps that take the time of one iteration; `None` where the matrix is too
/// large.
pub(in crate::solve) fn sweeps_per_iteration<S: Space>(problem: &Problem<S>) -> Option<f64> {
    let bodies = problem.solver_bodies.len();
    if bodies > MAX_BODIES[S::D - 2] {
        return None;
    }
    // Operations of a factorisation grow as N^1.5 in 2D and N^2 in 3D, of a sweep as N.
    let growing = match S::D {
        2 => SWEEPS * (bodies as f64 / MEASURED).sqrt(),
        _ => SWEEPS_PER_BODY * bodies as f64,
    };
    Some(SWEEPS.max(growing))
}

/// What earlier solves say about the next one.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(in crate::solve) struct Patience {
    /// Mean number of iterations of Newton.
    iterations: f64,
    /// Factor on the number of sweeps that take their time.
    factor: f64,
    /// Number of solves since all sweeps were done.
    since: u32,
}

impl Default for Patience {
    fn default() -> Self {
        Self {
            iterations: ITERATIONS,
            factor: 1.0,
            since: 0,
        }
    }
}

impl Patience {
    /// Returns the time to give to sweeps, in iterations of Newton. Where sweeps have not sufficed
    /// it falls, so that they take a small part of the time; from time to time all are done, since
    /// another step may need few.
    pub fn before(&mut self) -> f64 {
        self.since += 1;
        let mut factor = self.factor;
        if self.since >= ALL_AFTER {
            self.since = 0;
            factor = factor.max(1.0);
        }
        self.iterations * factor
    }

    /// Records that sweeps solved a problem.
    pub fn sweeps_sufficed(&mut self) {
        self.factor = if self.factor > 1.0 {
            (0.5 * self.factor).max(1.0)
        } else {
            (2.0 * self.factor).min(1.0)
        };
    }

    /// Records that sweeps did not solve a problem, and the report of Newton: where it failed, it
    /// is tried later.
    pub fn tried(&mut self, report: &Report) {
        let [least, most] = LIMITS;
        if report.converged {
            self.iterations = 0.75 * self.iterations + 0.25 * f64::from(report.iterations.max(1));
            self.factor = (0.5 * self.factor).clamp(least, 1.0);
        } else {
            self.factor = (4.0 * self.factor).clamp(1.0, most);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sweeps that never suffice get a twentieth of the time of Newton, but all of it in one solve
    /// of sixteen; where Newton fails, they get more than its time.
    #[test]
    fn sweeps_get_the_time_that_they_are_worth() {
        let mut patience = Patience::default();
        let ended = Report {
            iterations: 8,
            converged: true,
            ..Report::default()
        };
        let mut given = Vec::new();
        for _ in 0..64 {
            given.push(patience.before());
            patience.tried(&ended);
        }
        let last = &given[48..];
        assert_eq!(last.iter().filter(|n| (**n - 8.0).abs() < 0.1).count(), 1);
        assert_eq!(last.iter().filter(|n| (**n - 0.4).abs() < 0.1).count(), 15);
        patience.tried(&Report::default());
        assert!((patience.before() - 8.0).abs() < 0.1);
        patience.tried(&Report::default());
        assert!((patience.before() - 32.0).abs() < 0.4);
        for _ in 0..5 {
            patience.sweeps_sufficed();
        }
        assert!((patience.before() - 8.0).abs() < 0.1);
    }
}
