//! Time-dependent external actions on a scene: phases, gravity, servo pressures, gates.
//!
//! Each step begins by applying them: first the current phase, then removals, then gravity, loaded areas and
//! drives.

mod gravity;
mod phases;

pub use gravity::GravityDrive;
pub use phases::{Begun, Changes, Phase, Until};

use super::Simulation;
use crate::bodies::pressure::Servo;
use crate::geometry::space::{Space, VectorLike};
use crate::laws::Kind;
use phases::Clock;
use serde::{Deserialize, Serialize};

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
    /// Phases in the order in which they run, from the case.
    #[serde(skip)]
    pub phases: Vec<Phase<S>>,
    clock: Clock,
}

impl<S: Space> Default for Control<S> {
    fn default() -> Self {
        Self {
            gravity: S::Vector::zero(),
            gravity_drive: None,
            servos: Vec::new(),
            gates: Vec::new(),
            phases: Vec::new(),
            clock: Clock::default(),
        }
    }
}

impl<S: Space> Control<S> {
    /// Returns the number of the current phase, from 1; 0 before the first step and without phases.
    pub fn phase(&self) -> usize {
        self.clock.begun.len()
    }

    /// Returns whether the current phase is repeated later.
    pub fn recurs(&self) -> bool {
        let now = self.phase().checked_sub(1).and_then(|k| self.phases.get(k));
        now.is_some_and(|p| p.recurs)
    }

    /// Returns the phases begun so far, in order.
    pub fn begun(&self) -> &[Begun] {
        &self.clock.begun
    }

    /// Returns whether the last phase has ended.
    pub fn finished(&self) -> bool {
        self.phase() > 0 && self.phase() == self.phases.len() && self.clock.turns()
    }
}

impl<S: Space> Simulation<S> {
    /// Applies the schedule to the step that begins.
    pub(super) fn apply_schedule(&mut self) {
        if self.control.clock.turns() {
            self.begin_phase();
        }
        self.loads();
    }

    /// Ends the current phase if its end condition holds after a step.
    pub(super) fn end_phase(&mut self) {
        let Some(phase) = self.control.phase().checked_sub(1) else {
            return;
        };
        let Some(until) = self.control.phases[phase].until.clone() else {
            return;
        };
        let now = phases::Moment {
            time: self.time,
            step: self.steps,
            h: self.scheme.h,
        };
        let mut clock = std::mem::take(&mut self.control.clock);
        if let Some(why) = clock.ends(&until, &now, || self.motion_of_free()) {
            clock.close(&now, why);
        }
        self.control.clock = clock;
    }

    fn begin_phase(&mut self) {
        let Some(phase) = self.control.phases.get(self.control.phase()).cloned() else {
            return;
        };
        self.control.clock.open(&phase.name, self.time, self.steps);
        let (changes, time) = (phase.changes, self.time);
        for (place, dof, drive) in changes.drives {
            let servos = Servo::of(&self.bodies, &self.shapes, place, dof, &drive);
            self.control.servos.retain(|s| !s.serves(place, dof));
            // The servos were validated when the scene was built.
            self.control.servos.extend(servos.unwrap_or_default());
            let middle = time + 0.5 * self.scheme.h;
            self.bodies
                .set_drive(place, dof, drive.delayed(time), middle);
        }
        if let Some(gravity) = changes.gravity {
            (self.control.gravity, self.control.gravity_drive) = (gravity, None);
            self.gravity = gravity;
        }
        if let Some(drive) = changes.gravity_drive {
            self.control.gravity_drive = Some(drive.delayed(time));
        }
        for (law, parameter, value) in changes.contact {
            if let Some(parameters) = self.laws[law].parameters_mut(Kind::CONTACT) {
                parameters[parameter] = value;
            }
        }
        for place in changes.open {
            self.bodies.remove(place);
        }
        if let Some(tolerance) = changes.tolerance {
            self.solver.tolerance = tolerance;
        }
        // The sets of fixed and present bodies may have changed.
        self.network.forget_neighbours();
    }

    fn loads(&mut self) {
        let (time, h, theta) = (self.time, self.scheme.h, self.scheme.theta);
        let (due, later) = std::mem::take(&mut self.control.gates)
            .into_iter()
            .partition(|gate: &(usize, f64)| time + 0.5 * h > gate.1);
        self.control.gates = later;
        let due: Vec<(usize, f64)> = due;
        for (place, _) in &due {
            self.bodies.remove(*place);
            self.network.forget_neighbours();
        }
        if let Some(drive) = &self.control.gravity_drive {
            self.gravity = drive.at::<S>(&self.control.gravity, time + theta * h);
        }
        self.measure_areas();
        self.bodies.engage_stages(time + 0.5 * h);
    }

    /// Measures the loaded areas of all servo pressures.
    pub fn measure_areas(&mut self) {
        for servo in &self.control.servos {
            servo.measure(&mut self.bodies);
        }
    }

    /// What a condition of rest looks at: the grains, first bodies of which nothing is imposed, and dynamical systems.
    fn motion_of_free(&self) -> phases::Motion {
        let bodies = &self.bodies;
        let free = |b: &usize| (0..S::D).all(|k| bodies.inverse_mass[*b][k] > 0.0);
        let moving = || (0..bodies.len()).filter(free);
        // Work of gravity on a grain over its own diameter.
        let weight = |b: usize| bodies.mass[b] * 2.0 * bodies.length[b];
        let systems = self.systems.energies().0;
        phases::Motion {
            kinetic: moving().map(|b| bodies.energy_of(b)).sum::<f64>() + systems,
            scale: moving().map(weight).sum::<f64>() * self.gravity.norm(),
        }
    }
}
