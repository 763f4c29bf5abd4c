//! Time-dependent external actions on a scene: phases, gravity, servo pressures, gates.
//!
//! Each step begins by applying them: first the current phase, then removals, then gravity, loaded areas and
//! drives.

mod gravity;
mod phases;
mod step_bounds;

pub use gravity::GravityDrive;
pub use phases::{Begun, Changes, Phase, Until};
pub use step_bounds::StepBounds;

use super::{Scheme, Simulation};
use crate::bodies::pressure::{Pushed, Servo};
use crate::bodies::{Dof, Driven, HeldAxis};
use crate::geometry::space::{Space, VectorLike};
use crate::laws::{Interface, Kind};
use phases::Clock;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// The schedule of a run.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(bound = "")]
pub struct Control<S: Space> {
    /// Constant gravity, before `gravity_drive` is applied (m/s^2).
    pub gravity: S::Vector,
    /// Time dependence of gravity.
    pub gravity_drive: Option<GravityDrive>,
    /// Drives whose force follows the loaded area.
    pub servos: Vec<Servo>,
    /// Bodies to remove: index among the driven bodies, and time (s).
    pub gates: Vec<(usize, f64)>,
    /// Tolerance of the solver that a phase has set, in place of that of the options.
    pub tolerance: Option<f64>,
    /// Parameters of contact laws that phases have set, by interface and parameter.
    contact_parameters: BTreeMap<(usize, usize), f64>,
    /// Drives of holders of deformable bodies that phases have set.
    holder_drives: BTreeMap<HeldAxis, Dof>,
    clock: Clock,
}

impl<S: Space> Default for Control<S> {
    fn default() -> Self {
        Self {
            gravity: S::Vector::zero(),
            gravity_drive: None,
            servos: Vec::new(),
            gates: Vec::new(),
            tolerance: None,
            contact_parameters: BTreeMap::new(),
            holder_drives: BTreeMap::new(),
            clock: Clock::default(),
        }
    }
}

impl<S: Space> Control<S> {
    /// Returns the number of the current phase, from 1; 0 before the first step and without phases.
    pub fn phase(&self) -> usize {
        self.clock.begun.len()
    }

    /// Returns the phases begun so far, in order.
    pub fn begun(&self) -> &[Begun] {
        &self.clock.begun
    }

    /// Whether it is at one of these phases, and sets no other parameters than these laws have.
    pub(super) fn fits(&self, phases: &[Phase<S>], laws: &[Interface], driven: &[Driven]) -> bool {
        let parameters = |law: &Interface| law.contact().parameters.len();
        let mut set = self.contact_parameters.keys();
        self.phase() <= phases.len()
            && self.servos.iter().all(|s| match s.pushed() {
                Pushed::Body(place, dof) => driven.get(*place).is_some_and(|d| *dof < d.dofs.len()),
                Pushed::Holder(_) => true,
            })
            && self.gates.iter().all(|(place, _)| *place < driven.len())
            && set.all(|(law, at)| laws.get(*law).is_some_and(|law| *at < parameters(law)))
    }

    /// Gives contact laws the parameters that phases have set so far.
    pub(super) fn set_parameters(&self, laws: &mut [Interface]) {
        for ((law, at), value) in &self.contact_parameters {
            set_parameter(laws, *law, *at, *value);
        }
    }
}

impl<S: Space> Simulation<S> {
    /// Gives holders of deformable bodies the drives that phases have set so far.
    pub(super) fn set_holder_drives(&mut self) {
        for (held, drive) in &self.state.control.holder_drives {
            if let Some(current) = self.state.systems.drive_mut(held) {
                current.clone_from(drive);
            }
        }
    }

    /// Replaces the servos of what a phase drives anew by those of its drive.
    fn replace_servos(&mut self, pushed: &Pushed, drive: &Dof) {
        let servos = Servo::of(&self.state.bodies, &self.shapes, pushed, drive);
        self.state.control.servos.retain(|s| s.pushed() != pushed);
        // The servos were validated when the scene was built.
        self.state.control.servos.extend(servos.unwrap_or_default());
    }

    /// Returns whether the current phase is repeated later.
    pub fn phase_recurs(&self) -> bool {
        let now = self.state.control.phase().checked_sub(1);
        now.and_then(|k| self.phases.get(k))
            .is_some_and(|p| p.recurs)
    }

    /// Returns whether the last phase has ended.
    pub fn phases_finished(&self) -> bool {
        let phase = self.state.control.phase();
        phase > 0 && phase == self.phases.len() && self.state.control.clock.turns()
    }

    /// Applies the schedule to the step that begins.
    pub(super) fn apply_schedule(&mut self) {
        if self.state.control.clock.turns() {
            self.begin_phase();
        }
        self.loads();
    }

    /// Ends the current phase if its end condition holds after a step.
    pub(super) fn end_phase(&mut self) {
        let Some(phase) = self.state.control.phase().checked_sub(1) else {
            return;
        };
        let Some(until) = self.phases[phase].until.clone() else {
            return;
        };
        let now = phases::Moment {
            time: self.state.time,
            step: self.state.steps,
            h: self.options.event_step(),
        };
        let mut clock = std::mem::take(&mut self.state.control.clock);
        if let Some(why) = clock.ends(&until, &now, || self.motion_of_free()) {
            clock.close(&now, why);
        }
        self.state.control.clock = clock;
    }

    fn begin_phase(&mut self) {
        let Some(phase) = self.phases.get(self.state.control.phase()).cloned() else {
            return;
        };
        self.state
            .control
            .clock
            .open(&phase.name, self.state.time, self.state.steps);
        let (changes, time) = (phase.changes, self.state.time);
        for (place, dof, drive) in changes.drives {
            self.replace_servos(&Pushed::Body(place, dof), &drive);
            let middle = time + 0.5 * self.options.event_step();
            self.state
                .bodies
                .set_drive(place, dof, drive.delayed(time), middle);
        }
        for (held, drive) in changes.holders {
            self.replace_servos(&Pushed::Holder(held.clone()), &drive);
            let set = &mut self.state.control.holder_drives;
            set.insert(held, drive.delayed(time));
        }
        self.set_holder_drives();
        if let Some(gravity) = changes.gravity {
            (self.state.control.gravity, self.state.control.gravity_drive) = (gravity, None);
            self.state.gravity = gravity;
        }
        if let Some(drive) = changes.gravity_drive {
            self.state.control.gravity_drive = Some(drive.delayed(time));
        }
        for (law, at, value) in changes.contact {
            set_parameter(&mut self.laws, law, at, value);
            self.state
                .control
                .contact_parameters
                .insert((law, at), value);
        }
        for place in changes.open {
            self.take_away(place);
        }
        self.state.control.tolerance = changes.tolerance.or(self.state.control.tolerance);
        // The sets of fixed and present bodies may have changed.
        self.state.network.forget_neighbours();
    }

    /// Removes a driven body for good.
    fn take_away(&mut self, place: usize) {
        self.state.bodies.remove(place);
        self.insulate(self.state.bodies.driven[place].body as usize);
    }

    fn loads(&mut self) {
        let time = self.state.time;
        let Scheme { h, theta } = self.options.scheme;
        let soon = time + 0.5 * self.options.event_step();
        let (due, later) = std::mem::take(&mut self.state.control.gates)
            .into_iter()
            .partition(|gate: &(usize, f64)| soon > gate.1);
        self.state.control.gates = later;
        let due: Vec<(usize, f64)> = due;
        for (place, _) in &due {
            self.take_away(*place);
            self.state.network.forget_neighbours();
        }
        if let Some(drive) = &self.state.control.gravity_drive {
            self.state.gravity = drive.at::<S>(&self.state.control.gravity, time + theta * h);
        }
        self.measure_areas();
        self.state.bodies.engage_stages(soon);
    }

    /// Measures the loaded areas of all servo pressures.
    pub fn measure_areas(&mut self) {
        for servo in &self.state.control.servos {
            servo.measure(&mut self.state.bodies, &mut self.state.systems);
        }
    }

    /// What a condition of rest looks at: the grains, first bodies and dynamical systems of which nothing is imposed.
    fn motion_of_free(&self) -> phases::Motion {
        let bodies = &self.state.bodies;
        let free = |b: &usize| (0..S::D).all(|k| bodies.inverse_mass[*b][k] > 0.0);
        let moving = || (0..bodies.len()).filter(free);
        // Work of gravity on a grain over its own diameter.
        let weight = |b: usize| bodies.mass[b] * 2.0 * bodies.length[b];
        let (systems, size) = self.state.systems.motion_of_free();
        phases::Motion {
            kinetic: moving().map(|b| bodies.energy_of(b)).sum::<f64>() + systems,
            scale: (moving().map(weight).sum::<f64>() + size) * self.state.gravity.norm(),
        }
    }
}

/// Sets a parameter of the contact law of an interface.
fn set_parameter(laws: &mut [Interface], law: usize, at: usize, value: f64) {
    if let Some(parameters) = laws[law].parameters_mut(Kind::CONTACT) {
        parameters[at] = value;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bodies::TimeFunction;
    use crate::geometry::space::Dim2;
    use crate::laws::sample_laws::interface;

    /// A state that was read is refused where it names a phase, a body, an axis or a parameter that the case has not. The case has no phases,
    /// a body that is driven along x and y, and a law with one parameter.
    #[test]
    fn a_schedule_of_another_case_does_not_fit() {
        let mut s = Simulation::<Dim2>::of_disks(&[]);
        s.shapes.periodic.period = [Some(1.0), Some(1.0), None];
        let pressure = Dof::Pressure {
            value: TimeFunction::Constant(1.0),
            between: Vec::new(),
            area: 0.0,
        };
        let servo = |place, dof| {
            let pushed = Pushed::Body(place, dof);
            let servos = Servo::of(&s.state.bodies, &s.shapes, &pushed, &pressure);
            servos.unwrap().remove(0)
        };
        let body = |dofs| Driven {
            name: "lid".into(),
            body: 0,
            dofs: vec![Dof::Fixed; dofs],
        };
        let laws = [interface([])];
        let fits = |dofs, change: &dyn Fn(&mut Control<Dim2>)| {
            let mut control = Control::default();
            change(&mut control);
            control.fits(&[], &laws, &[body(dofs)])
        };
        assert!(fits(2, &|_| {}));
        assert!(fits(2, &|c| c.servos.push(servo(0, 0))));
        assert!(fits(2, &|c| c.servos.push(servo(0, 1))));
        assert!(!fits(1, &|c| c.servos.push(servo(0, 1))));
        assert!(!fits(2, &|c| c.servos.push(servo(1, 0))));
        assert!(fits(2, &|c| c.gates.push((0, 1.0))));
        assert!(!fits(2, &|c| c.gates.push((1, 1.0))));
        for (place, known) in [((0, 0), true), ((0, 1), false), ((1, 0), false)] {
            let set = |c: &mut Control<Dim2>| c.contact_parameters.extend([(place, 0.5)]);
            assert_eq!(fits(2, &set), known);
        }
        assert!(!fits(2, &|c| c.clock.open("a phase", 0.0, 0)));
    }
}
