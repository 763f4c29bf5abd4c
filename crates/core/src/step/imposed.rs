//! Imposed motion in the time step: the velocity jumps between steps and their work.
//!
//! Where the velocity of an imposed degree of freedom jumps (see [`crate::bodies::path`]), its drive
//! supplies the impulse and does the work m (v_s^2 - v_e^2)/2. At time zero there is no previous drive: a
//! body that starts moving is taken to have moved before, and its energy is initial kinetic energy.

use super::Simulation;
use crate::bodies::Dof;
use crate::geometry::space::Space;

impl<S: Space> Simulation<S> {
    /// Gives driven bodies their imposed velocities at time zero, for code that inspects the scene before
    /// the first step. The drives of the first phase are included.
    pub fn set_in_motion(&mut self) {
        if self.steps > 0 {
            return;
        }
        let (time, h, theta) = (self.time, self.scheme.h, self.scheme.theta);
        let first = self.control.phases.first().map(|p| &p.changes);
        let bodies = &mut self.bodies;
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
        let kinetic = self.bodies.kinetic_energy() + self.systems.energies().0;
        (self.energy.kinetic, self.energy.initial_kinetic) = (kinetic, kinetic);
        self.started = self.motion_of_driven();
    }

    /// Applies the schedule to the step and starts its imposed motion.
    pub(super) fn begin_motion(&mut self) {
        let before = self.energies_of_driven();
        self.apply_schedule();
        let (h, theta) = (self.scheme.h, self.scheme.theta);
        self.bodies.set_off(self.time, h, theta);
        let after = self.energies_of_driven();
        let work: f64 = after.iter().zip(&before).map(|(a, b)| a - b).sum();
        self.energy.see(work);
        if self.steps == 0 {
            self.energy.initial_kinetic += work;
        } else {
            self.energy.external_work += work;
        }
    }

    /// Ends the step: advances the time and puts imposed degrees of freedom on their paths.
    pub(super) fn end_motion(&mut self) {
        let (from, h) = (self.time, self.scheme.h);
        // Kahan summation: the time after n steps equals n h to rounding, so that functions of time do not
        // drift.
        let part = h - self.time_excess;
        self.time = from + part;
        self.time_excess = (self.time - from) - part;
        self.bodies.arrive(from, self.time, h);
    }

    /// Returns the velocities and spins of the driven bodies, in their order.
    pub(super) fn motion_of_driven(&self) -> Vec<(S::Vector, S::Spin)> {
        let bodies = &self.bodies;
        let of = |b: usize| (bodies.velocity[b], bodies.spin[b]);
        bodies.driven.iter().map(|d| of(d.body as usize)).collect()
    }

    fn energies_of_driven(&self) -> Vec<f64> {
        let bodies = &self.bodies;
        let of = |b: u32| bodies.energy_of(b as usize);
        bodies.driven.iter().map(|d| of(d.body)).collect()
    }
}
