//! Phases: what changes when one begins, and when it ends.

use super::GravityDrive;
use crate::bodies::Dof;
use crate::geometry::space::Space;
use serde::{Deserialize, Deserializer, Serialize};

/// When a phase ends.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub enum Until {
    /// At a time of the run (s).
    Time(f64),
    /// After a duration (s).
    After(f64),
    /// After a number of steps.
    Steps(u64),
    /// When the kinetic energy of the grains has stayed small.
    AtRest {
        /// Below this share of m g d, summed over the grains.
        #[serde(default)]
        share: Option<f64>,
        /// Below this energy (J; J/m in 2D).
        #[serde(default)]
        energy: Option<f64>,
        /// For so long (s).
        held: f64,
        /// After this duration in any case (s).
        #[serde(default)]
        at_most: Option<f64>,
    },
}

/// What changes when a phase begins; all else stays as it is.
#[derive(Clone, Debug)]
pub struct Changes<S: Space> {
    /// Drives: place among the driven bodies, degree of freedom, drive on the time since the phase began.
    pub drives: Vec<(usize, usize, Dof)>,
    /// Gravity (m/s^2).
    pub gravity: Option<S::Vector>,
    /// How gravity changes, on the time since the phase began.
    pub gravity_drive: Option<GravityDrive>,
    /// Parameters of contact laws: interface, parameter, value.
    pub contact: Vec<(usize, usize, f64)>,
    /// Bodies that are taken away, by their places.
    pub open: Vec<usize>,
    /// Tolerance of the solver.
    pub tolerance: Option<f64>,
}

/// A phase.
#[derive(Clone, Debug)]
pub struct Phase<S: Space> {
    /// Name.
    pub name: String,
    /// Its end; none for the end of the run.
    pub until: Option<Until>,
    /// What changes at its start.
    pub changes: Changes<S>,
    /// Whether the same phase comes again: only its last time is worth a picture.
    pub recurs: bool,
}

/// A phase that began.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Begun {
    /// Name.
    pub name: String,
    /// When it began (s).
    pub start: f64,
    /// Steps done before it.
    pub first_step: u64,
    /// When it ended (s); null while it lasts.
    pub end: Option<f64>,
    /// Why it ended.
    #[serde(deserialize_with = "known")]
    pub ended_by: Option<Ending>,
}

/// Why a phase ended, in a word.
pub type Ending = &'static str;

const ENDS: [Ending; 5] = ["time", "duration", "steps", "rest", "at_most"];

fn known<'de, D: Deserializer<'de>>(from: D) -> Result<Option<Ending>, D::Error> {
    let said = Option::<String>::deserialize(from)?;
    let known = |said: String| ENDS.into_iter().find(|end| *end == said);
    Ok(said.and_then(known))
}

/// Where the run stands after a step.
pub(super) struct Moment {
    pub time: f64,
    pub step: u64,
    pub h: f64,
}

/// How much the grains move.
pub(super) struct Motion {
    /// Their kinetic energy (J).
    pub kinetic: f64,
    /// Sum of m g d over them (J).
    pub scale: f64,
}

/// Where the programme stands.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(super) struct Clock {
    pub begun: Vec<Begun>,
    /// Since when the grains have been at rest (s).
    still_since: Option<f64>,
}

impl Clock {
    /// Whether the next phase is to begin: none has, or the last one has ended.
    pub fn turns(&self) -> bool {
        self.begun.last().is_none_or(|b| b.end.is_some())
    }

    pub fn open(&mut self, name: &str, time: f64, step: u64) {
        self.still_since = None;
        self.begun.push(Begun {
            name: name.to_owned(),
            start: time,
            first_step: step,
            end: None,
            ended_by: None,
        });
    }

    pub fn close(&mut self, now: &Moment, why: &'static str) {
        if let Some(begun) = self.begun.last_mut() {
            (begun.end, begun.ended_by) = (Some(now.time), Some(why));
        }
    }

    /// Why the phase ends now, if it does; `motion` is measured where that depends on it.
    pub fn ends(
        &mut self,
        until: &Until,
        now: &Moment,
        motion: impl FnOnce() -> Motion,
    ) -> Option<&'static str> {
        let begun = self.begun.last()?;
        let (start, first_step) = (begun.start, begun.first_step);
        // Times are sums of steps: half a step is on neither side of an end.
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
                let Motion { kinetic, scale } = motion();
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
