//! Cycles of a test, as a function of time only.

use crate::geometry::space::{Space, VectorLike};
use crate::step::Simulation;
use serde::{Deserialize, Serialize};

/// Start and length of the cycles. Without a length the whole time after the start is one cycle.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct CycleClock {
    /// Start of the first cycle (s).
    pub start: f64,
    /// Length of a cycle (s).
    pub period: Option<f64>,
}

impl CycleClock {
    /// Creates cycles of a length (s) from `start` on. Without a length, the second half of the
    /// time from `start` to `end` (s) is one cycle.
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
            // A step that ends at the end of a cycle is part of that cycle.
            Some(period) => ((time - self.start) / period - 1e-9).floor().max(0.0) as u32 + 1,
            None => 1,
        }
    }

    /// Returns the completed share of the cycle at a time; 1 at its end.
    pub fn share(&self, time: f64) -> f64 {
        let before = f64::from(self.number(time).saturating_sub(1));
        let cycles = |period: f64| (time - self.start) / period - before;
        let share = self.period.map_or(0.0, cycles).max(0.0);
        if share > 1.0 - 1e-6 { 1.0 } else { share }
    }

    /// Returns start and end of a cycle (s); `None` without cycles.
    pub fn span(&self, number: u32) -> Option<[f64; 2]> {
        let begun = self.start + f64::from(number.saturating_sub(1)) * self.period?;
        Some([begun, begun + self.period?])
    }
}

/// The part that slides in a friction test.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum SlidingPart {
    /// A rigid body, by its index among the driven bodies.
    Driven(usize),
    /// A deformable body, by its index among the systems, and the holder that moves it.
    System {
        /// Index of the system.
        system: usize,
        /// Index among its holders.
        holder: usize,
    },
}

/// Force and sliding distance of a rubbed body, over a step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SlidingStep {
    /// Tangential force that moves the body (N; N/m in 2D).
    pub force: f64,
    /// Sliding distance over the step (m), signed.
    pub slide: f64,
    /// Fraction of the step at which the force has this value; 1/2 for a mean.
    pub at: f64,
}

impl SlidingStep {
    /// Returns the work over the step (J; J/m in 2D) with the force at its middle, which is
    /// interpolated between this force and that of the previous step (N; N/m): the sum over a loop
    /// is its area.
    pub fn work(&self, before: f64) -> f64 {
        if self.at == 0.5 {
            return self.force * self.slide;
        }
        (self.force - (self.at - 0.5) * (self.force - before)) * self.slide
    }
}

/// A body that slides along an axis in a friction test.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SlidingBody {
    /// The part that slides.
    pub part: SlidingPart,
    /// Axis of sliding.
    pub along: usize,
    /// Axis of the normal load.
    pub normal: usize,
}

impl SlidingBody {
    /// Returns force and sliding distance of its drive in the last step; for a deformable body
    /// those of the holder that moves it.
    pub fn drive<S: Space>(&self, s: &Simulation<S>) -> SlidingStep {
        let h = s.options.scheme.h;
        match self.part {
            SlidingPart::Driven(place) => SlidingStep {
                force: -s.state.received[place].0[self.along] / h,
                slide: h * step_velocity(s, place)[self.along],
                at: 0.5,
            },
            SlidingPart::System { system, holder } => {
                let holders = s.state.systems.get(system).map(|s| s.holders());
                let held = holders.as_ref().and_then(|h| h.get(holder));
                held.map_or_else(SlidingStep::default, |held| SlidingStep {
                    force: held.force,
                    slide: h * held.velocity,
                    at: held.at,
                })
            }
        }
    }

    /// Returns the normal force of its contacts, the mean over the last step (N; N/m in 2D),
    /// positive in compression.
    pub fn normal_force<S: Space>(&self, s: &Simulation<S>) -> f64 {
        let pushed = match self.part {
            SlidingPart::Driven(place) => s.state.received[place].0[self.normal],
            SlidingPart::System { .. } => self
                .sides(s)
                .map(|(p, _, sign)| p[self.normal] * sign)
                .sum(),
        };
        pushed * self.facing(s) / s.options.scheme.h
    }

    /// Returns the direction in which its contacts push it along the normal axis: 1 or -1.
    fn facing<S: Space>(&self, s: &Simulation<S>) -> f64 {
        let push: f64 = self
            .sides(s)
            .map(|(_, n, sign)| n[self.normal] * sign)
            .sum();
        if push < 0.0 { -1.0 } else { 1.0 }
    }

    /// Returns impulse, normal and sign of each loaded contact of the body.
    fn sides<S: Space>(
        &self,
        s: &Simulation<S>,
    ) -> impl Iterator<Item = (S::Vector, S::Vector, f64)> {
        let bodies = &s.state.bodies;
        let own = match self.part {
            SlidingPart::Driven(place) => Some(bodies.driven[place].body),
            SlidingPart::System { .. } => None,
        };
        let index = match self.part {
            SlidingPart::System { system, .. } => Some(system as u32),
            SlidingPart::Driven(_) => None,
        };
        let is = move |body: u32| match own {
            Some(own) => body == own,
            None => bodies.carrier(body as usize).map(|c| c.system) == index,
        };
        let contacts = s.state.network.contacts.iter();
        let loaded = contacts.filter(|c| c.impulse.norm() > 0.0);
        loaded.filter_map(move |c| match c.bodies {
            [i, _] if is(i) => Some((c.impulse, c.normal, 1.0)),
            [_, j] if is(j) => Some((c.impulse, c.normal, -1.0)),
            _ => None,
        })
    }
}

/// Returns the velocity of a driven body over the last step, v_theta, by its index among them
/// (m/s).
pub fn step_velocity<S: Space>(s: &Simulation<S>, place: usize) -> S::Vector {
    let theta = s.options.scheme.theta;
    let now = s.state.bodies.velocity[s.state.bodies.driven[place].body as usize];
    s.state.started[place].0 * (1.0 - theta) + now * theta
}
