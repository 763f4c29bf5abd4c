//! Imposed motion in the time step: the velocity jumps between steps and their work.
//!
//! Where the velocity of an imposed degree of freedom jumps (see [`crate::bodies::path`]), its
//! drive supplies the impulse and does the work m (v_s^2 - v_e^2)/2. At time zero there is no
//! previous drive: a body that starts moving is taken to have moved before, and its energy is
//! initial kinetic energy.

use super::loads;
use crate::bodies::Dof;
use crate::geometry::space::Space;
use crate::step::detection::watch_first_move;
use crate::step::{Scheme, Simulation};

/// Sets driven bodies in motion before the first step, for [`Simulation::set_in_motion`].
pub(in crate::step) fn set_in_motion<S: Space>(s: &mut Simulation<S>) {
    if s.state.steps > 0 {
        return;
    }
    let time = s.state.time;
    let Scheme { h, theta } = s.options.scheme;
    let first = s.phases.first().map(|p| &p.changes);
    let bodies = &mut s.state.bodies;
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
    let kinetic = s.state.bodies.kinetic_energy() + s.state.systems.energies().0;
    (s.state.energy.kinetic, s.state.energy.initial_kinetic) = (kinetic, kinetic);
    s.state.started = s.state.bodies.motion_of_driven();
}

/// Applies the schedule to the step and starts its imposed motion.
pub(in crate::step) fn begin_motion<S: Space>(s: &mut Simulation<S>) {
    let motion = s.state.bodies.motion_of_driven();
    let before = energies_of_driven(s);
    loads::apply_schedule(s);
    let Scheme { h, theta } = s.options.scheme;
    s.state.bodies.begin_imposed_motion(s.state.time, h, theta);
    let after = energies_of_driven(s);
    let work: f64 = after.iter().zip(&before).map(|(a, b)| a - b).sum();
    s.state.energy.raise_scale(work);
    if s.state.steps == 0 {
        s.state.energy.initial_kinetic += work;
    } else {
        s.state.energy.external_work += work;
    }
    watch_first_move(s, &motion);
}

/// Counts the step, advances the time and sets imposed degrees of freedom to their paths.
pub(in crate::step) fn end_motion<S: Space>(s: &mut Simulation<S>) {
    let (from, h) = (s.state.time, s.options.scheme.h);
    // Kahan summation: the time after n steps equals n h to rounding, so that functions of time do
    // not drift.
    let part = h - s.state.time_excess;
    s.state.time = from + part;
    s.state.time_excess = (s.state.time - from) - part;
    s.state.steps += 1;
    s.state.bodies.end_imposed_motion(from, s.state.time, h);
}

fn energies_of_driven<S: Space>(s: &Simulation<S>) -> Vec<f64> {
    let bodies = &s.state.bodies;
    let of = |b: u32| bodies.energy_of(b as usize);
    bodies.driven.iter().map(|d| of(d.body)).collect()
}
