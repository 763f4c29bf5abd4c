//! Bounds of a step that spans several steps of the case.

use super::GravityDrive;
use crate::bodies::{Dof, TimeFunction};
use crate::geometry::space::Space;
use crate::laws::Interface;
use crate::step::Simulation;

/// Bounds of the next step from drives, gates and phases.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepBounds {
    /// Time of the next event (s): a gate, the end of a phase or stage, a kink of a drive; infinite
    /// if there is none.
    pub event: f64,
    /// Longest step that resolves smooth changes (s); infinite where nothing changes.
    pub longest: f64,
}

impl StepBounds {
    /// Returns the bounds of the next step, for [`Simulation::step_bounds`].
    pub(in crate::step) fn of<S: Space>(s: &Simulation<S>) -> StepBounds {
        // An event that is due belongs to the step that begins.
        let t = s.state.time + 1e-6 * s.options.event_step();
        let control = &s.state.control;
        let mut bounds = StepBounds {
            event: f64::INFINITY,
            longest: f64::INFINITY,
        };
        for dof in s.state.bodies.driven.iter().flat_map(|d| &d.dofs) {
            bounds.drive(dof, t);
        }
        for (_, removal) in control.removals.iter().filter(|g| g.1 > t) {
            bounds.event = bounds.event.min(*removal);
        }
        let bonds = s.laws.iter().filter_map(Interface::bonding_time);
        bounds.event = bonds.filter(|b| *b > t).fold(bounds.event, f64::min);
        match &control.gravity_drive {
            None => {}
            Some(GravityDrive::Turned { angle: f, .. } | GravityDrive::Scaled(f)) => {
                bounds.function(f, t);
            }
            Some(GravityDrive::Axes(list)) => list.iter().for_each(|f| bounds.function(f, t)),
        }
        let phase = control.phase().checked_sub(1);
        let until = phase.and_then(|k| s.phases.get(k)?.until.as_ref());
        if let Some(until) = until {
            let [end, longest] = control.clock.bounds(until);
            bounds.event = bounds.event.min(end);
            bounds.longest = bounds.longest.min(longest);
        }
        bounds
    }

    fn function(&mut self, f: &TimeFunction, t: f64) {
        self.event = self.event.min(f.next_kink(t));
        self.longest = self.longest.min(f.resolved_step(t));
    }

    fn drive(&mut self, drive: &Dof, t: f64) {
        self.event = self.event.min(drive.next_kink(t));
        self.longest = self.longest.min(drive.resolved_step(t));
    }

    /// Returns the number of steps of `h` (s) from `time` to the event, or to the step in which it
    /// falls; and the number that one step may span while resolving smooth changes. Both are at
    /// least 1.
    pub fn steps(&self, time: f64, h: f64) -> [u64; 2] {
        let whole = |t: f64| {
            let steps = t / h;
            // Times are sums of steps, so that a whole number is only approximate.
            if (steps - steps.round()).abs() < 1e-6 * steps.abs().clamp(1.0, 1e3) {
                steps.round()
            } else {
                steps.floor()
            }
        };
        // The conversion saturates where there is no bound.
        [self.event - time, self.longest].map(|t| whole(t).max(1.0) as u64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_ends_at_an_event_or_at_the_steps_beside_it() {
        let steps =
            |event: f64, longest: f64, time: f64| StepBounds { event, longest }.steps(time, 0.1);
        assert_eq!(steps(1.0, 0.35, 0.0), [10, 3]);
        // 0.1 + 0.1 + 0.1 is above 0.3.
        assert_eq!(steps(1.0, 1.0, 0.1 + 0.1 + 0.1), [7, 10]);
        // An event between two steps: one step reaches the first of them, then a step of the case
        // follows.
        assert_eq!(steps(1.03, 1.0, 0.0), [10, 10]);
        assert_eq!(steps(1.03, 0.01, 1.0), [1, 1]);
        assert_eq!(steps(f64::INFINITY, f64::INFINITY, 0.0), [u64::MAX; 2]);
    }
}
