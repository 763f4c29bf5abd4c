//! Sequences of drives on one degree of freedom, for example first pressing, then sliding.

use super::drive::Dof;
use serde::{Deserialize, Serialize};

/// A drive with its end time. Functions of time use the time of the case, not of the stage.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Stage {
    /// Time at which the next stage takes over (s); `None` for the last stage.
    #[serde(default)]
    pub until: Option<f64>,
    /// The drive; stages cannot be nested.
    pub drive: Dof,
}

/// Returns the active drive at a time.
pub(super) fn at(stages: &[Stage], t: f64) -> &Dof {
    stages
        .get(index_at(stages, t))
        .map_or(&Dof::Fixed, |s| &s.drive)
}

/// Returns the index of the active stage at a time.
pub(super) fn index_at(stages: &[Stage], t: f64) -> usize {
    let found = stages
        .iter()
        .position(|s| s.until.is_none_or(|end| t < end));
    found.unwrap_or(stages.len().saturating_sub(1))
}

/// Returns the error in a list of stages, if any, and the path of its key.
pub(super) fn fault(stages: &[Stage]) -> Option<(String, String)> {
    if stages.is_empty() {
        return Some((String::new(), "stages need at least one drive".into()));
    }
    let mut before = 0.0;
    // In the case file, stages have a single field, their list.
    for (k, stage) in stages.iter().enumerate() {
        let said = |field: &str, message: String| Some((format!("0.{k}.{field}"), message));
        if matches!(stage.drive, Dof::Stages(_)) {
            return said("drive", "a stage cannot hold stages again".into());
        }
        if let Some((_, message)) = stage.drive.fault() {
            return said("drive", message);
        }
        match (stage.until, k + 1 == stages.len()) {
            (None, false) => {
                let message = "a stage that another one follows needs `until`, its end (s)";
                return Some((format!("0.{k}"), message.into()));
            }
            (Some(_), true) => {
                let message = "the last stage holds for ever; leave its `until` out";
                return said("until", message.into());
            }
            (Some(end), false) if !(end.is_finite() && end > before) => {
                let message =
                    format!("stages must end one after another, got {end} after {before}");
                return said("until", message);
            }
            (Some(end), false) => before = end,
            (None, true) => {}
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bodies::TimeFunction;

    fn pressed_then_moved() -> Dof {
        Dof::Stages(vec![
            Stage {
                until: Some(0.3),
                drive: Dof::Force(TimeFunction::Constant(-2.0)),
            },
            Stage {
                until: None,
                drive: Dof::Velocity(TimeFunction::Constant(-0.5)),
            },
        ])
    }

    #[test]
    fn a_step_belongs_to_the_stage_of_its_middle() {
        let dof = pressed_then_moved();
        // Times as summed in a run: 0.1 + 0.1 + 0.1 is above 0.3.
        let end = 0.1 + 0.1 + 0.1;
        assert!(dof.over(end - 0.1, 0.1).imposed_velocity(end).is_none());
        assert_eq!(dof.over(end, 0.1).imposed_velocity(end + 0.1), Some(-0.5));
        assert_eq!((dof.force(0.2), dof.force(0.4)), (-2.0, 0.0));
        assert!(dof.yields() && dof.fault().is_none());
    }
}
