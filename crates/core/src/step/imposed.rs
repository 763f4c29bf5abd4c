//! Imposed motion in the time step: the velocity jumps between steps and their work.
//!
//! Where the velocity of an imposed degree of freedom jumps (see [`crate::bodies::path`]), its drive
//! supplies the impulse and does the work m (v_s^2 - v_e^2)/2. At time zero there is no previous drive: a
//! body that starts moving is taken to have moved before, and its energy is initial kinetic energy.

use super::{Scheme, Simulation};
use crate::bodies::Dof;
use crate::geometry::space::Space;

impl<S: Space> Simulation<S> {
    /// Gives driven bodies their imposed velocities at time zero, for code that inspects the scene before
    /// the first step. The drives of the first phase are included.
    pub fn set_in_motion(&mut self) {
        if self.state.steps > 0 {
            return;
        }
        let time = self.state.time;
        let Scheme { h, theta } = self.options.scheme;
        let first = self.phases.first().map(|p| &p.changes);
        let bodies = &mut self.state.bodies;
        for (place, driven) in bodies.driven.iter().enumerate() {
            if first.is_some_and(|c| c.open.contains(&place)) {
                continue;
            }
            let b = driven.body as usize;
            for (k, own) in driven.dofs.iter().enumerate() {
                let given = first.and_then(|c| {
                    let mut drives = c.drives.iter().rev();
                    drives.find(|d| (d.0, d.1) == (place, k))
                });
                // A phase that begins at time zero is not shifted in time.
                let dof: &Dof = given.map_or(own, |d| &d.2);
                if let Some(speeds) = dof.over(time, h).speeds(time, h, theta) {
                    if k < S::D {
                        bodies.velocity[b][k] = speeds.start;
                    } else {
                        bodies.spin[b][k - S::D] = speeds.start;
                    }
                }
            }
        }
        let kinetic = self.state.bodies.kinetic_energy() + self.state.systems.energies().0;
        (self.state.energy.kinetic, self.state.energy.initial_kinetic) = (kinetic, kinetic);
        self.state.started = self.state.bodies.motion_of_driven();
    }

    /// Applies the schedule to the step and starts its imposed motion.
    pub(super) fn begin_motion(&mut self) {
        let before = self.energies_of_driven();
        self.apply_schedule();
        let Scheme { h, theta } = self.options.scheme;
        self.state
            .bodies
            .begin_imposed_motion(self.state.time, h, theta);
        let after = self.energies_of_driven();
        let work: f64 = after.iter().zip(&before).map(|(a, b)| a - b).sum();
        self.state.energy.see(work);
        if self.state.steps == 0 {
            self.state.energy.initial_kinetic += work;
        } else {
            self.state.energy.external_work += work;
        }
    }

    /// Ends the step: advances the time and puts imposed degrees of freedom on their paths.
    pub(super) fn end_motion(&mut self) {
        let (from, h) = (self.state.time, self.options.scheme.h);
        // Kahan summation: the time after n steps equals n h to rounding, so that functions of time do not
        // drift.
        let part = h - self.state.time_excess;
        self.state.time = from + part;
        self.state.time_excess = (self.state.time - from) - part;
        self.state
            .bodies
            .end_imposed_motion(from, self.state.time, h);
    }

    fn energies_of_driven(&self) -> Vec<f64> {
        let bodies = &self.state.bodies;
        let of = |b: u32| bodies.energy_of(b as usize);
        bodies.driven.iter().map(|d| of(d.body)).collect()
    }
}
