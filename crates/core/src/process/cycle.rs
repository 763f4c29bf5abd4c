//! The cycles of a test, as a function of time alone.

use crate::geometry::space::Space;
use crate::step::Simulation;
use serde::{Deserialize, Serialize};

/// When cycles begin and end. Without a period everything after the start is one cycle.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct CycleClock {
    /// When the first begins (s).
    pub start: f64,
    /// Length of a cycle (s).
    pub period: Option<f64>,
}

impl CycleClock {
    /// Cycles of a length (s) from `start` on; without one the second half of what remains until `end` is one cycle (s).
    pub fn new(start: f64, period: Option<f64>, end: f64) -> Self {
        let start = if period.is_some() {
            start
        } else {
            0.5 * (start + end)
        };
        Self { start, period }
    }

    /// Number of the cycle at a time, from 1; 0 before the start.
    pub fn number(&self, time: f64) -> u32 {
        if time <= self.start {
            return 0;
        }
        match self.period {
            // A step that ends on the border belongs to the cycle it closes.
            Some(period) => ((time - self.start) / period - 1e-9).floor().max(0.0) as u32 + 1,
            None => 1,
        }
    }

    /// Share of its cycle that is done at a time; 1 at its end.
    pub fn share(&self, time: f64) -> f64 {
        let before = f64::from(self.number(time).saturating_sub(1));
        let cycles = |period: f64| (time - self.start) / period - before;
        let share = self.period.map_or(0.0, cycles).max(0.0);
        if share > 1.0 - 1e-6 { 1.0 } else { share }
    }

    /// When a cycle begins and ends (s); none without cycles.
    pub fn span(&self, number: u32) -> Option<[f64; 2]> {
        let begun = self.start + f64::from(number.saturating_sub(1)) * self.period?;
        Some([begun, begun + self.period?])
    }
}

/// A body that is rubbed along an axis.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct RubbedBody {
    /// Its place among the driven bodies.
    pub place: usize,
    /// Axis of sliding.
    pub along: usize,
    /// Axis of the normal load.
    pub normal: usize,
}

impl RubbedBody {
    /// Tangential force that moves it, the mean over the last step (N; N/m in 2D).
    pub fn tangential_force<S: Space>(&self, s: &Simulation<S>) -> f64 {
        -s.state.received[self.place].0[self.along] / s.options.scheme.h
    }

    /// Its sliding over the last step (m), signed.
    pub fn slide<S: Space>(&self, s: &Simulation<S>) -> f64 {
        s.options.scheme.h * step_velocity(s, self.place)[self.along]
    }
}

/// Velocity of a driven body over the last step, v_theta, by its place among them (m/s).
pub fn step_velocity<S: Space>(s: &Simulation<S>, place: usize) -> S::Vector {
    let theta = s.options.scheme.theta;
    let now = s.state.bodies.velocity[s.state.bodies.driven[place].body as usize];
    s.state.started[place].0 * (1.0 - theta) + now * theta
}
