//! Acceleration of the Gauss-Seidel iteration over bodies, used once the first convergence tests
//! fail: momentum, with a lower bound on it where the residual does not fall between two tests,
//! then Anderson extrapolation as well, and Anderson extrapolation alone where momentum does not
//! help.

use super::body_anderson::{BodyAnderson, MEMORY};
use super::kinds::of_kind;
use super::momentum::MomentumIteration;
use super::problem::Problem;
use crate::geometry::space::Space;

/// Iterations before Anderson extrapolation starts without momentum.
const FIRST_ANDERSON: u32 = 20;
/// Number of iterations in which the squared residual has to fall by half; otherwise momentum is
/// given up. With momentum an impulse crosses n contacts in a row in about n iterations; the factor
/// of ten, and both bounds, come from trials (`docs/solvers/gauss_seidel.md`).
fn patience(contacts: usize) -> u32 {
    (10 * contacts).clamp(50, 1000) as u32
}

/// State of the acceleration in a solve.
#[derive(Debug)]
pub(super) struct Acceleration<S: Space> {
    /// Whether momentum is used: all contacts are between rigid bodies, in rows with a closed form
    /// and without a bond, and Anderson extrapolation does not span all unknowns. Over bonds
    /// momentum does not reduce the number of iterations.
    with_momentum: bool,
    parallel: bool,
    /// Number of iterations before momentum starts, up to the second convergence test: most
    /// warm-started steps need no more.
    first: u32,
    patience: u32,
    momentum: Option<MomentumIteration<S>>,
    anderson: BodyAnderson,
    /// Squared residual at the last test.
    last: f64,
    /// Whether the squared residual had risen at the last test.
    rose: bool,
    /// Squared residual that has to fall by half, and the iteration at which it was reached.
    least: f64,
    least_at: u32,
}

impl<S: Space> Acceleration<S> {
    pub fn new(problem: &Problem<S>, first: u32, parallel: bool) -> Self {
        let mut rows = problem.rows.iter();
        let bonds = rows.any(|rows| of_kind!(rows, rows => rows.may_have_bonds()));
        let unknowns = problem.contacts() * S::D;
        Self {
            with_momentum: unknowns > MEMORY && !bonds && problem.systems.is_empty(),
            parallel,
            first,
            patience: patience(problem.contacts()),
            momentum: None,
            anderson: BodyAnderson::default(),
            last: f64::INFINITY,
            rose: false,
            least: f64::INFINITY,
            least_at: 0,
        }
    }

    /// The momentum of the next iteration, after `done` iterations.
    pub fn momentum(
        &mut self,
        problem: &Problem<S>,
        done: u32,
    ) -> Option<&mut MomentumIteration<S>> {
        if self.with_momentum && done >= self.first && self.momentum.is_none() {
            self.momentum = Some(MomentumIteration::new(problem, self.parallel));
        }
        self.momentum.as_mut()
    }

    /// Returns whether iterations are relaxed, because they have no momentum.
    pub fn relaxes(&self) -> bool {
        self.momentum.is_none()
    }

    /// Discards the history of Anderson extrapolation, because the iteration has changed.
    pub fn forget(&mut self) {
        self.anderson.forget();
    }

    /// Starts momentum again from the velocities of a problem that were computed from its impulses.
    pub fn reloaded(&mut self, problem: &Problem<S>) {
        if let Some(momentum) = &mut self.momentum {
            momentum.restart(problem, self.parallel);
        }
    }

    /// Uses the squared residual of a failed test after `done` iterations, and may change the
    /// impulses.
    pub fn on_failed_test(&mut self, problem: &mut Problem<S>, done: u32, residual: f64) {
        if self.momentum.is_some() && self.stalls(done, residual) {
            (self.with_momentum, self.momentum) = (false, None);
            self.anderson = BodyAnderson::default();
        }
        let Some(momentum) = &mut self.momentum else {
            if done >= FIRST_ANDERSON {
                self.anderson.extrapolate(problem, residual);
            }
            return;
        };
        let (rises, rose) = (residual >= self.last, self.rose);
        (self.last, self.rose) = (residual, rises);
        if !rises {
            self.anderson.forget();
            momentum.speed_up();
        } else if rose && self.anderson.extrapolate(problem, residual) {
            momentum.restart(problem, self.parallel);
        } else {
            momentum.slow_down();
        }
    }

    /// Whether the squared residual has not fallen by half for long.
    fn stalls(&mut self, done: u32, residual: f64) -> bool {
        if residual < 0.5 * self.least {
            (self.least, self.least_at) = (residual, done);
        }
        done - self.least_at >= self.patience
    }
}

#[cfg(test)]
mod tests {
    use super::patience;

    #[test]
    fn few_contacts_need_little_patience() {
        assert_eq!([1, 20, 100, 10_000].map(patience), [50, 200, 1000, 1000]);
    }
}
