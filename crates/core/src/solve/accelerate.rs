//! Anderson's acceleration of the sweeps over bodies: at a convergence test that was missed the impulses
//! are extrapolated and the velocities formed again. What lies between two tests is one application of the
//! map, so an extrapolation, which costs about three sweeps, is paid for by ten.

use super::extrapolation::{Extrapolation, Safeguard};
use super::form::Problem;
use crate::geometry::space::Space;

/// Differences remembered.
const MEMORY: usize = 6;
/// Sweeps before it begins: most warm steps need no more.
const START: u32 = 20;

/// Tests without a residual smaller by a tenth after which it is let be for a while.
const PATIENCE: u32 = 10;
/// For so many tests at first; doubled each time.
const PAUSE: u32 = 6;

/// The extrapolation at work in a solve.
#[derive(Debug)]
pub(super) struct Acceleration {
    sequence: Option<Extrapolation>,
    impulses: Vec<f64>,
    least: f64,
    idle: u32,
    paused: u32,
    pause: u32,
}

impl Default for Acceleration {
    fn default() -> Self {
        Self {
            sequence: None,
            impulses: Vec::new(),
            least: f64::INFINITY,
            idle: 0,
            paused: 0,
            pause: PAUSE,
        }
    }
}

impl Acceleration {
    /// After a test that was missed, with its squared residual.
    pub fn extrapolate<S: Space>(&mut self, problem: &mut Problem<S>, done: u32, residual: f64) {
        if done < START {
            return;
        }
        if self.paused > 0 {
            self.paused -= 1;
            return;
        }
        if residual < 0.8 * self.least {
            (self.least, self.idle) = (residual, 0);
        } else {
            self.idle += 1;
            if self.idle > PATIENCE {
                self.forget();
                (self.least, self.idle) = (f64::INFINITY, 0);
                self.paused = self.pause;
                self.pause *= 2;
                return;
            }
        }
        problem.store(&mut self.impulses);
        match &mut self.sequence {
            None => {
                let sequence = Extrapolation::new(MEMORY, Safeguard::Back, &self.impulses);
                self.sequence = Some(sequence);
            }
            Some(sequence) => {
                sequence.next(&self.impulses);
                problem.restore(&sequence.start);
            }
        }
    }

    /// The map has changed: what was learnt of it is void.
    pub fn forget(&mut self) {
        self.sequence = None;
    }
}
