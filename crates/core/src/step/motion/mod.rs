//! Motion of the bodies in a step: to q_m, where contacts are, and to its end. Rigid bodies are
//! columns, all others dynamical systems.

mod bodies;
mod systems;

pub(super) use bodies::StepStart;
pub(super) use systems::{add_system, end_systems, system_step};

use super::{Scheme, Simulation};
use crate::geometry::space::Space;

/// Velocity and spin of a body.
pub(super) type BodyVelocity<S> = (<S as Space>::Vector, <S as Space>::Spin);

/// Moves the bodies to q_m.
pub(super) fn move_to_detection<S: Space>(s: &mut Simulation<S>) {
    let Scheme { h, theta } = s.options.scheme;
    let time = (1.0 - theta) * h;
    bodies::advance(&mut s.state.bodies, time, s.options.solver.parallel);
    systems::begin_systems(s, time);
}

/// Computes the velocities at the end of the step without contacts, from bodies at q_m. `start`
/// receives their spins at q_m.
pub(super) fn free_motion<S: Space>(
    s: &mut Simulation<S>,
    start: &mut StepStart<S>,
) -> Vec<BodyVelocity<S>> {
    start.take_rotated_spins(&s.state.bodies);
    s.state.started = start.of_driven(&s.state.bodies);
    let Scheme { h, theta } = s.options.scheme;
    let (time, parallel) = (s.state.time, s.options.solver.parallel);
    let (bodies, gravity) = (&s.state.bodies, &s.state.gravity);
    let mut free = bodies::free_velocities(bodies, gravity, time, h, theta, parallel);
    systems::free_systems(s, &mut free);
    free
}

/// Restores the velocities of all bodies at the start of the step.
pub(super) fn restart<S: Space>(s: &mut Simulation<S>, start: &StepStart<S>) {
    start.restore(&mut s.state.bodies);
    systems::restart_systems(s);
}

/// Moves the bodies from q_m to the end of the step.
pub(super) fn move_to_end<S: Space>(s: &mut Simulation<S>) {
    let Scheme { h, theta } = s.options.scheme;
    bodies::advance(&mut s.state.bodies, theta * h, s.options.solver.parallel);
    systems::carry_systems(s);
}
