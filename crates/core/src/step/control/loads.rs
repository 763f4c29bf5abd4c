//! A step begins by applying the schedule: the current phase, then removals, gravity, loaded areas
//! and drives; it ends by ending the phase if due.

use super::phases;
use super::schedule::set_parameter;
use crate::bodies::Dof;
use crate::bodies::pressure::{Servo, ServoTarget};
use crate::geometry::space::{Space, VectorLike};
use crate::step::{Scheme, Simulation};

/// Gives holders of deformable bodies the drives that phases have set so far.
pub(in crate::step) fn set_holder_drives<S: Space>(s: &mut Simulation<S>) {
    for (held, drive) in &s.state.control.holder_drives {
        if let Some(current) = s.state.systems.drive_mut(held) {
            current.clone_from(drive);
        }
    }
}

/// Replaces the servos of the degrees of freedom that a phase drives by those of its drives.
fn replace_servos<S: Space>(s: &mut Simulation<S>, target: &ServoTarget, drive: &Dof) {
    let servos = Servo::of(&s.state.bodies, &s.shapes, target, drive);
    s.state.control.servos.retain(|s| s.target() != target);
    // The servos were validated when the scene was built.
    s.state.control.servos.extend(servos.unwrap_or_default());
}

/// Applies the schedule to the step that begins.
pub(in crate::step) fn apply_schedule<S: Space>(s: &mut Simulation<S>) {
    if s.state.control.clock.turns() {
        begin_phase(s);
    }
    loads(s);
}

/// Ends the current phase if its end condition holds after a step.
pub(in crate::step) fn end_phase<S: Space>(s: &mut Simulation<S>) {
    let Some(phase) = s.state.control.phase().checked_sub(1) else {
        return;
    };
    let Some(until) = s.phases[phase].until.clone() else {
        return;
    };
    let now = phases::StepTime {
        time: s.state.time,
        step: s.state.steps,
        h: s.options.event_step(),
    };
    let mut clock = std::mem::take(&mut s.state.control.clock);
    if let Some(why) = clock.ends(&until, &now, || motion_of_free(s)) {
        clock.close(&now, why);
    }
    s.state.control.clock = clock;
}

fn begin_phase<S: Space>(s: &mut Simulation<S>) {
    let Some(phase) = s.phases.get(s.state.control.phase()).cloned() else {
        return;
    };
    s.state
        .control
        .clock
        .open(&phase.name, s.state.time, s.state.steps);
    let (changes, time) = (phase.changes, s.state.time);
    for (place, dof, drive) in changes.drives {
        replace_servos(s, &ServoTarget::Body(place, dof), &drive);
        let middle = time + 0.5 * s.options.event_step();
        s.state
            .bodies
            .set_drive(place, dof, drive.delayed(time), middle);
    }
    for (held, drive) in changes.holders {
        replace_servos(s, &ServoTarget::Holder(held.clone()), &drive);
        let set = &mut s.state.control.holder_drives;
        set.insert(held, drive.delayed(time));
    }
    set_holder_drives(s);
    if let Some(gravity) = changes.gravity {
        let gravity = S::Vector::from_slice(&gravity);
        (s.state.control.gravity, s.state.control.gravity_drive) = (gravity, None);
        s.state.gravity = gravity;
    }
    if let Some(drive) = changes.gravity_drive {
        s.state.control.gravity_drive = Some(drive.delayed(time));
    }
    for (law, at, value) in changes.contact {
        set_parameter(&mut s.laws, law, at, value);
        s.state.control.contact_parameters.insert((law, at), value);
    }
    for place in changes.open {
        take_away(s, place);
    }
    s.state.control.tolerance = changes.tolerance.or(s.state.control.tolerance);
    // The sets of fixed and present bodies may have changed.
    s.state.network.forget_neighbours();
}

/// Removes a driven body permanently.
fn take_away<S: Space>(s: &mut Simulation<S>, place: usize) {
    s.state.bodies.remove(place);
    let body = s.state.bodies.driven[place].body as usize;
    s.notify(|process, simulation| process.body_removed(simulation, body));
}

fn loads<S: Space>(s: &mut Simulation<S>) {
    let time = s.state.time;
    let Scheme { h, theta } = s.options.scheme;
    let soon = time + 0.5 * s.options.event_step();
    let (due, later) = std::mem::take(&mut s.state.control.removals)
        .into_iter()
        .partition(|removal: &(usize, f64)| soon > removal.1);
    s.state.control.removals = later;
    let due: Vec<(usize, f64)> = due;
    for (place, _) in &due {
        take_away(s, *place);
        s.state.network.forget_neighbours();
    }
    if let Some(drive) = &s.state.control.gravity_drive {
        s.state.gravity = drive.at::<S>(&s.state.control.gravity, time + theta * h);
    }
    s.measure_areas();
    s.state.bodies.engage_stages(soon);
}

/// Returns the motion that a condition of rest evaluates: that of grains, and of first bodies and
/// dynamical systems without imposed motion.
fn motion_of_free<S: Space>(s: &Simulation<S>) -> phases::UndrivenMotion {
    let bodies = &s.state.bodies;
    let free = |b: &usize| (0..S::D).all(|k| bodies.inverse_mass[*b][k] > 0.0);
    let moving = || (0..bodies.len()).filter(free);
    // The scale is the work of gravity on a grain over its diameter.
    let weight = |b: usize| bodies.mass[b] * 2.0 * bodies.length[b];
    let (systems, size) = s.state.systems.motion_of_free();
    phases::UndrivenMotion {
        kinetic: moving().map(|b| bodies.energy_of(b)).sum::<f64>() + systems,
        scale: (moving().map(weight).sum::<f64>() + size) * s.state.gravity.norm(),
    }
}
