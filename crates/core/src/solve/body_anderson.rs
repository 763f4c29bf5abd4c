//! Anderson acceleration of the Gauss-Seidel iteration over bodies, between convergence tests. At
//! each failed test the impulses are extrapolated and the velocities recomputed. The iterations
//! between two tests count as one application of the fixed-point map, so that the cost of an
//! extrapolation, about three iterations, is spread over ten.

use super::extrapolation::{Extrapolation, Safeguard};
use super::problem::Problem;
use crate::geometry::space::Space;

/// Number of stored differences.
pub(super) const MEMORY: usize = 6;
/// Number of tests without a reduction of the residual by a tenth, after which the acceleration
/// pauses.
const PATIENCE: u32 = 10;
/// Length of the first pause in tests; doubled each time.
const PAUSE: u32 = 6;

/// State of the acceleration in a solve.
#[derive(Debug)]
pub(super) struct BodyAnderson {
    sequence: Option<Extrapolation>,
    impulses: Vec<f64>,
    least: f64,
    idle: u32,
    paused: u32,
    pause: u32,
}

impl Default for BodyAnderson {
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

impl BodyAnderson {
    /// Extrapolates after a failed test with the given squared residual; returns whether it changed
    /// the impulses.
    pub fn extrapolate<S: Space>(&mut self, problem: &mut Problem<S>, residual: f64) -> bool {
        if self.paused > 0 {
            self.paused -= 1;
            return false;
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
                return false;
            }
        }
        problem.store(&mut self.impulses);
        match &mut self.sequence {
            None => {
                let sequence = Extrapolation::new(MEMORY, Safeguard::Back, &self.impulses);
                self.sequence = Some(sequence);
                false
            }
            Some(sequence) => {
                sequence.next(&self.impulses);
                problem.restore(&sequence.start);
                true
            }
        }
    }

    /// Discards the stored differences, because the map has changed.
    pub fn forget(&mut self) {
        self.sequence = None;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solve::form::ContactForm;
    use nalgebra::Vector2;

    /// Extrapolation begins with the second call, continues for ten tests without progress, and
    /// then pauses for six.
    #[test]
    fn it_rests_where_it_does_not_help() {
        let mut problem = Problem::of_unit_bodies(2);
        let normal = Vector2::new(0.0, 1.0);
        problem.push(&ContactForm {
            normal,
            arms: [-normal, normal],
            friction: 0.5,
            impulse: normal,
            ..ContactForm::default()
        });
        crate::solve::nlgs::prepare(&mut problem);
        let mut anderson = BodyAnderson::default();
        let changed: Vec<bool> = (0..20)
            .map(|_| anderson.extrapolate(&mut problem, 1.0))
            .collect();
        // The first call has the smallest residual.
        let mut wanted = vec![true; 20];
        wanted[0] = false;
        wanted[11..18].fill(false);
        // The sequence begins anew.
        wanted[18] = false;
        assert_eq!(changed, wanted);
    }
}
