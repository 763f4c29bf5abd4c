//! Mean flows of matter from the start of the friction test on. Preparation, such as placing and compressing
//! the grains, is not a flow of the contact.

use crate::geometry::space::Space;
use crate::step::Simulation;
use serde::{Deserialize, Serialize};

/// Flows since the start of the friction test, or of the run without one.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
pub(super) struct Flows {
    /// Start time (s).
    pub start: f64,
    /// Time since the start (s).
    time: f64,
    /// Volume worn off first bodies before the start (m^3; m^3/m).
    before: f64,
    /// Volume worn off first bodies since the start (m^3; m^3/m).
    worn: f64,
    /// Mass of the third body that crossed a section since the start (kg; kg/m).
    crossed: f64,
}

impl Flows {
    /// Flows that are counted from a start time (s).
    pub fn since(start: f64) -> Self {
        Self {
            start,
            ..Self::default()
        }
    }

    /// Adds a step: the sliding axis, the inertia scaling of the case, and the volume worn off first bodies
    /// so far.
    pub fn add<S: Space>(&mut self, s: &Simulation<S>, along: usize, scaling: f64, worn: f64) {
        let h = s.scheme.h;
        if s.time - 0.5 * h < self.start {
            self.before = worn;
            return;
        }
        self.time += h;
        self.worn = worn - self.before;
        self.crossed += h * internal_flow(s, along) / scaling;
    }

    /// Wear rate of first bodies (m^3/s; m^3/(m s)), over the elapsed time multiplied by `over`; zero before
    /// the start.
    pub fn source(&self, over: f64) -> f64 {
        mean(self.worn, self.time + over)
    }

    /// Mean mass flow through a section (kg/s; kg/(m s)); zero before the start.
    pub fn internal(&self) -> f64 {
        mean(self.crossed, self.time)
    }
}

fn mean(amount: f64, time: f64) -> f64 {
    if time > 0.0 { amount / time } else { 0.0 }
}

/// Mass flow of the third body through a section: sum m |v| / L along the sliding.
fn internal_flow<S: Space>(s: &Simulation<S>, along: usize) -> f64 {
    let grains = || {
        (0..s.bodies.len())
            .filter(|b| s.bodies.inverse_mass[*b][along] > 0.0 && s.bodies.length[*b] > 0.0)
    };
    let length = s.shapes.periodic.period[along].unwrap_or_else(|| {
        let x = |b: usize| s.bodies.position[b][along];
        let (low, high) = grains().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), b| {
            (l.min(x(b)), h.max(x(b)))
        });
        high - low
    });
    if !(length.is_finite() && length > 0.0) {
        return 0.0;
    }
    let grain = s.bodies.grain_flags();
    grains()
        .filter(|b| grain[*b])
        .map(|b| s.bodies.mass[b] * s.bodies.velocity[b][along].abs())
        .sum::<f64>()
        / length
}
