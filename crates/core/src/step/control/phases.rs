//! Phases: the changes at the start of each phase, and its end condition.

use super::GravityDrive;
use crate::bodies::{Dof, HeldAxis};
use serde::{Deserialize, Deserializer, Serialize};

/// When a phase ends.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub enum Until {
    /// The phase ends at a time of the run (s).
    Time(f64),
    /// The phase ends after a duration (s).
    After(f64),
    /// The phase ends after a number of steps.
    Steps(u64),
    /// The phase ends when the kinetic energy of the grains, and of first bodies and dynamical
    /// systems without imposed motion, has stayed below a bound.
    AtRest {
        /// Bound as a fraction of m g d, summed over these bodies; for a system, d is twice
        /// [`crate::bodies::DynamicalSystem::length`].
        #[serde(default)]
        share: Option<f64>,
        /// Bound as an energy (J; J/m in 2D).
        #[serde(default)]
        energy: Option<f64>,
        /// Time for which the bound must hold (s).
        held: f64,
        /// Maximum duration of the phase (s).
        #[serde(default)]
        at_most: Option<f64>,
    },
}

/// Changes at the start of a phase; everything else keeps its value.
#[derive(Clone, Debug)]
pub struct Changes {
    /// Drives: index among the driven bodies, degree of freedom, drive as a function of the time
    /// since the phase began.
    pub drives: Vec<(usize, usize, Dof)>,
    /// Drives of the holders of deformable bodies.
    pub holders: Vec<(HeldAxis, Dof)>,
    /// Gravity (m/s^2).
    pub gravity: Option<[f64; 3]>,
    /// Time dependence of gravity, as a function of the time since the phase began.
    pub gravity_drive: Option<GravityDrive>,
    /// Parameters of contact laws: interface index, parameter index, value.
    pub contact: Vec<(usize, usize, f64)>,
    /// Indices of the bodies to remove.
    pub open: Vec<usize>,
    /// Tolerance of the solver.
    pub tolerance: Option<f64>,
}

/// A phase.
#[derive(Clone, Debug)]
pub struct Phase {
    /// Name.
    pub name: String,
    /// End condition; `None` for the end of the run.
    pub until: Option<Until>,
    /// Changes at the start of the phase.
    pub changes: Changes,
    /// Whether the phase is repeated; only the last repetition is then drawn.
    pub recurs: bool,
}

/// A phase that has begun.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StartedPhase {
    /// Name.
    pub name: String,
    /// Start of the phase (s).
    pub start: f64,
    /// Number of steps completed before the phase.
    pub first_step: u64,
    /// End of the phase (s); `None` while it runs.
    pub end: Option<f64>,
    /// Reason for its end.
    #[serde(deserialize_with = "known")]
    pub ended_by: Option<EndReason>,
}

/// Reason why a phase ended, as one word.
pub type EndReason = &'static str;

const ENDS: [EndReason; 5] = ["time", "duration", "steps", "rest", "at_most"];

fn known<'de, D: Deserializer<'de>>(from: D) -> Result<Option<EndReason>, D::Error> {
    let said = Option::<String>::deserialize(from)?;
    let known = |said: String| ENDS.into_iter().find(|end| *end == said);
    Ok(said.and_then(known))
}

/// Time and step count after a step.
pub(super) struct StepTime {
    pub time: f64,
    pub step: u64,
    pub h: f64,
}

/// Motion of the grains and of other bodies without imposed motion.
pub(super) struct UndrivenMotion {
    /// Kinetic energy of these bodies (J).
    pub kinetic: f64,
    /// Sum of m g d over these bodies (J).
    pub scale: f64,
}

/// Progress of the schedule.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(super) struct Clock {
    pub begun: Vec<StartedPhase>,
    /// Time since which the grains have been at rest (s).
    still_since: Option<f64>,
}

impl Clock {
    /// Returns whether the next phase begins now: none has begun yet, or the last one has ended.
    pub fn turns(&self) -> bool {
        self.begun.last().is_none_or(|b| b.end.is_some())
    }

    pub fn open(&mut self, name: &str, time: f64, step: u64) {
        self.still_since = None;
        self.begun.push(StartedPhase {
            name: name.to_owned(),
            start: time,
            first_step: step,
            end: None,
            ended_by: None,
        });
    }

    pub fn close(&mut self, now: &StepTime, why: &'static str) {
        if let Some(begun) = self.begun.last_mut() {
            (begun.end, begun.ended_by) = (Some(now.time), Some(why));
        }
    }

    /// Returns the latest end of the phase (s), and the longest step (s) after which its end
    /// condition is evaluated: infinite where there is none.
    pub fn bounds(&self, until: &Until) -> [f64; 2] {
        let Some(begun) = self.begun.last() else {
            return [f64::INFINITY; 2];
        };
        match until {
            Until::Time(t) => [*t, f64::INFINITY],
            Until::After(t) => [begun.start + t, f64::INFINITY],
            // A number of steps does not depend on times.
            Until::Steps(_) => [f64::INFINITY, 0.0],
            Until::AtRest { held, at_most, .. } => {
                let rest = self.still_since.map_or(f64::INFINITY, |t| t + held);
                let latest = at_most.map_or(f64::INFINITY, |t| begun.start + t);
                [rest.min(latest), *held]
            }
        }
    }

    /// Returns why the phase ends now, or `None`; `motion` is evaluated only if the condition
    /// depends on it.
    pub fn ends(
        &mut self,
        until: &Until,
        now: &StepTime,
        motion: impl FnOnce() -> UndrivenMotion,
    ) -> Option<&'static str> {
        let begun = self.begun.last()?;
        let (start, first_step) = (begun.start, begun.first_step);
        // Times are sums of steps, so that comparing at half a step is safe from rounding.
        let reached = |t: f64| now.time > t - 0.5 * now.h;
        match until {
            Until::Time(t) => reached(*t).then_some("time"),
            Until::After(t) => reached(start + t).then_some("duration"),
            Until::Steps(n) => (now.step >= first_step + n).then_some("steps"),
            Until::AtRest {
                share,
                energy,
                held,
                at_most,
            } => {
                let UndrivenMotion { kinetic, scale } = motion();
                let still =
                    share.is_none_or(|s| kinetic < s * scale) && energy.is_none_or(|e| kinetic < e);
                if !still {
                    self.still_since = None;
                } else if reached(*self.still_since.get_or_insert(now.time) + held) {
                    return Some("rest");
                }
                at_most
                    .is_some_and(|t| reached(start + t))
                    .then_some("at_most")
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const NEVER: f64 = f64::INFINITY;

    fn begun(start: f64) -> Clock {
        let mut clock = Clock::default();
        clock.open("a phase", start, 7);
        clock
    }

    /// A phase began at 3 s; a phase of rest has been at rest since 10 s.
    #[test]
    fn steps_end_with_phases() {
        let clock = begun(3.0);
        let rest = |at_most| Until::AtRest {
            share: None,
            energy: Some(1.0),
            held: 0.5,
            at_most,
        };
        for (until, bounds) in [
            (Until::Time(5.0), [5.0, NEVER]),
            (Until::After(5.0), [8.0, NEVER]),
            (Until::Steps(5), [NEVER, 0.0]),
            (rest(None), [NEVER, 0.5]),
            (rest(Some(20.0)), [23.0, 0.5]),
        ] {
            assert_eq!(clock.bounds(&until), bounds, "{until:?}");
        }
        assert_eq!(Clock::default().bounds(&Until::Time(5.0)), [NEVER; 2]);
        let still = Clock {
            still_since: Some(10.0),
            ..clock
        };
        assert_eq!(still.bounds(&rest(None)), [10.5, 0.5]);
        assert_eq!(still.bounds(&rest(Some(20.0))), [10.5, 0.5]);
        assert_eq!(still.bounds(&rest(Some(5.0))), [8.0, 0.5]);
    }

    /// Times are reached within half a step of 1 s; rest has to last for 2 s, and a motion in
    /// between restarts that time.
    #[test]
    fn phases_end_when_their_conditions_say() {
        let now = |time: f64| StepTime {
            time,
            step: 10,
            h: 1.0,
        };
        let motion = |kinetic| UndrivenMotion {
            kinetic,
            scale: 4.0,
        };
        for (until, time, end) in [
            (Until::Time(5.0), 4.4, None),
            (Until::Time(5.0), 4.6, Some("time")),
            (Until::After(5.0), 7.4, None),
            (Until::After(5.0), 7.6, Some("duration")),
            (Until::Steps(4), 0.0, None),
            (Until::Steps(3), 0.0, Some("steps")),
        ] {
            assert_eq!(begun(3.0).ends(&until, &now(time), || motion(0.0)), end);
        }
        let until = Until::AtRest {
            share: Some(0.5),
            energy: Some(3.0),
            held: 2.0,
            at_most: Some(8.0),
        };
        let mut clock = begun(0.0);
        // The bounds are 0.5 times 4 J, and 3 J.
        for (time, kinetic, end) in [
            (1.0, 1.5, None),
            (2.0, 2.5, None),
            (3.0, 1.5, None),
            (4.0, 1.5, None),
            (5.0, 1.5, Some("rest")),
            (8.0, 2.5, Some("at_most")),
        ] {
            assert_eq!(
                clock.ends(&until, &now(time), || motion(kinetic)),
                end,
                "{time}"
            );
        }
    }
}
