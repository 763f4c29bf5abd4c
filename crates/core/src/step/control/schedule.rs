//! Progress of the external actions that change in time.

use super::GravityDrive;
use super::phases::{Clock, Phase, StartedPhase};
use crate::bodies::pressure::{Servo, ServoTarget};
use crate::bodies::{Dof, Driven, HeldAxis};
use crate::geometry::space::{Space, VectorLike};
use crate::laws::{Interface, Kind};
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
    pub removals: Vec<(usize, f64)>,
    /// Tolerance of the solver set by a phase, which replaces that of the options.
    pub tolerance: Option<f64>,
    /// Parameters of contact laws that phases have set, by interface and parameter.
    pub(super) contact_parameters: BTreeMap<(usize, usize), f64>,
    /// Drives of holders of deformable bodies that phases have set.
    pub(super) holder_drives: BTreeMap<HeldAxis, Dof>,
    pub(super) clock: Clock,
}

impl<S: Space> Default for Control<S> {
    fn default() -> Self {
        Self {
            gravity: S::Vector::zero(),
            gravity_drive: None,
            servos: Vec::new(),
            removals: Vec::new(),
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
    pub fn begun(&self) -> &[StartedPhase] {
        &self.clock.begun
    }

    /// Whether the next phase begins with the next step.
    pub(in crate::step) fn turns(&self) -> bool {
        self.clock.turns()
    }

    /// Returns whether the schedule is at one of these phases, and sets only parameters that these
    /// laws have.
    pub(in crate::step) fn fits(
        &self,
        phases: &[Phase],
        laws: &[Interface],
        driven: &[Driven],
    ) -> bool {
        let parameters = |law: &Interface| law.contact().parameters.len();
        let mut set = self.contact_parameters.keys();
        self.phase() <= phases.len()
            && self.servos.iter().all(|s| match s.target() {
                ServoTarget::Body(place, dof) => {
                    driven.get(*place).is_some_and(|d| *dof < d.dofs.len())
                }
                ServoTarget::Holder(_) => true,
            })
            && self.removals.iter().all(|(place, _)| *place < driven.len())
            && set.all(|(law, at)| laws.get(*law).is_some_and(|law| *at < parameters(law)))
    }

    /// Sets the parameters of contact laws to the values of the phases so far.
    pub(in crate::step) fn set_parameters(&self, laws: &mut [Interface]) {
        for ((law, at), value) in &self.contact_parameters {
            set_parameter(laws, *law, *at, *value);
        }
    }
}

/// Sets a parameter of the contact law of an interface.
pub(super) fn set_parameter(laws: &mut [Interface], law: usize, at: usize, value: f64) {
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
    use crate::step::Simulation;

    /// A state read from a file is refused where it names a phase, a body, an axis or a parameter
    /// that the case does not have. The case has no phases, a body driven along x and y, and a law
    /// with one parameter.
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
            let target = ServoTarget::Body(place, dof);
            let servos = Servo::of(&s.state.bodies, &s.shapes, &target, &pressure);
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
        assert!(fits(2, &|c| c.removals.push((0, 1.0))));
        assert!(!fits(2, &|c| c.removals.push((1, 1.0))));
        for (place, known) in [((0, 0), true), ((0, 1), false), ((1, 0), false)] {
            let set = |c: &mut Control<Dim2>| c.contact_parameters.extend([(place, 0.5)]);
            assert_eq!(fits(2, &set), known);
        }
        assert!(!fits(2, &|c| c.clock.open("a phase", 0.0, 0)));
    }
}
