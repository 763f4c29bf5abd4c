//! Acceleration of the Gauss-Seidel iteration over bodies, where the first tests fail: momentum, less of it where the residual does not fall
//! from test to test, Anderson extrapolation where it does not fall again, and no momentum any more where that does not help.

use super::anderson::{Anderson, MEMORY};
use super::form::Problem;
use super::momentum::Momentum;
use crate::geometry::space::Space;

/// Iterations before it starts: most warm-started steps need no more.
const FIRST: u32 = 10;
/// Tests in which the squared residual has to fall by half, or momentum is given up.
const PATIENCE: u32 = 100;

/// State of the acceleration in a solve.
#[derive(Debug)]
pub(super) struct Acceleration<S: Space> {
    /// Whether momentum is used: not where Anderson extrapolation spans all unknowns, and not with bonds and bodies that deform, over
    /// which it takes as many iterations.
    with_momentum: bool,
    parallel: bool,
    momentum: Option<Momentum<S>>,
    anderson: Anderson,
    /// Squared residual at the last test.
    last: f64,
    /// Whether it had risen there.
    rose: bool,
    /// Squared residual from which it has to fall by half, and the tests since then.
    least: f64,
    tests: u32,
}

impl<S: Space> Acceleration<S> {
    pub fn new(problem: &Problem<S>, parallel: bool) -> Self {
        let bonded = problem.full.len() + problem.bonded_levers.len();
        let unknowns = problem.contacts() * S::D;
        Self {
            with_momentum: unknowns > MEMORY && bonded == 0 && problem.systems.is_empty(),
            parallel,
            momentum: None,
            anderson: Anderson::default(),
            last: f64::INFINITY,
            rose: false,
            least: f64::INFINITY,
            tests: 0,
        }
    }

    /// The momentum of the next iteration, after `done` iterations.
    pub fn momentum(&mut self, problem: &Problem<S>, done: u32) -> Option<&mut Momentum<S>> {
        if self.with_momentum && done >= FIRST && self.momentum.is_none() {
            self.momentum = Some(Momentum::new(problem, self.parallel));
        }
        self.momentum.as_mut()
    }

    /// Discards what Anderson extrapolation knows of the iteration, because that has changed.
    pub fn forget(&mut self) {
        self.anderson.forget();
    }

    /// Looks at the squared residual of a failed test after `done` iterations, and may change the impulses.
    pub fn tested(&mut self, problem: &mut Problem<S>, done: u32, residual: f64) {
        if self.stalls(residual) {
            (self.with_momentum, self.momentum) = (false, None);
            self.anderson.forget();
        }
        let Some(momentum) = &mut self.momentum else {
            if done > FIRST {
                self.anderson.extrapolate(problem, residual);
            }
            return;
        };
        let (rises, rose) = (residual >= self.last, self.rose);
        (self.last, self.rose) = (residual, rises);
        if !rises {
            self.anderson.forget();
            momentum.speed_up();
        } else if !rose {
            momentum.slow_down();
        } else if self.anderson.extrapolate(problem, residual) {
            momentum.start_anew(problem, self.parallel);
        }
    }

    /// Whether the squared residual has not fallen by half for long.
    fn stalls(&mut self, residual: f64) -> bool {
        if residual < 0.5 * self.least {
            (self.least, self.tests) = (residual, 0);
        } else {
            self.tests += 1;
        }
        self.momentum.is_some() && self.tests >= PATIENCE
    }
}
