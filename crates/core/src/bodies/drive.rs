//! Driven degrees of freedom, and sequences of drives on one of them, for example first pressing,
//! then sliding.

use super::time_function::TimeFunction;
use serde::{Deserialize, Serialize};

/// Motion of one degree of freedom of a first body.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum Dof {
    /// Free to move under contact forces, gravity and inertia.
    #[default]
    Free,
    /// Fixed.
    Fixed,
    /// Imposed velocity (m/s or rad/s); the body follows its integral.
    Velocity(TimeFunction),
    /// Imposed displacement (m or rad): the body follows the change of the function since this
    /// drive took effect.
    Displacement(TimeFunction),
    /// Imposed force (N; N/m of depth in 2D) or moment.
    Force(TimeFunction),
    /// Servo: a force that is a pressure times the current area between walls, see
    /// [`super::pressure`].
    Pressure {
        /// The pressure (Pa), with the sign of the force along the axis.
        value: TimeFunction,
        /// Names of opposite walls, one pair for each other axis that is not periodic.
        #[serde(default)]
        between: Vec<(String, String)>,
        /// Current area (m^2; in 2D a length, m), measured in every step.
        #[serde(skip)]
        area: f64,
    },
    /// A sequence of drives, see [`Stage`].
    Stages(Vec<Stage>),
}

/// A drive with its end time. Functions of time use the time of the case, not of the stage.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Stage {
    /// Time at which the next stage takes over (s); `None` for the last stage.
    #[serde(default)]
    pub until: Option<f64>,
    /// The drive; stages cannot be nested.
    pub drive: Dof,
}

impl Stage {
    /// Creates a stage that ends at a time (s); `None` for the last one.
    pub fn new(until: Option<f64>, drive: Dof) -> Self {
        Self { until, drive }
    }
}

impl Dof {
    /// Returns the active drive at a time; `self` where there are no stages.
    pub fn at(&self, t: f64) -> &Self {
        match self {
            Self::Stages(stages) => stages
                .get(self.stage_at(t))
                .map_or(&Self::Fixed, |s| &s.drive),
            simple => simple,
        }
    }

    /// Returns the active drive over a step of `h` from `time` on: a step belongs to the stage that
    /// contains its midpoint, so that the rounding of times does not matter.
    pub fn over(&self, time: f64, h: f64) -> &Self {
        self.at(time + 0.5 * h)
    }

    /// Returns the index of the active stage at a time; 0 where there are no stages.
    pub fn stage_at(&self, t: f64) -> usize {
        match self {
            Self::Stages(stages) => {
                let found = stages
                    .iter()
                    .position(|s| s.until.is_none_or(|end| t < end));
                found.unwrap_or(stages.len().saturating_sub(1))
            }
            _ => 0,
        }
    }

    /// Iterates over all its drives, in order; only `self` where there are no stages.
    pub fn drives(&self) -> impl DoubleEndedIterator<Item = &Self> {
        let stages = match self {
            Self::Stages(stages) => stages.as_slice(),
            _ => &[],
        };
        let simple = (!matches!(self, Self::Stages(_))).then_some(self);
        stages.iter().map(|s| &s.drive).chain(simple)
    }

    /// Returns whether contacts can move the degree of freedom at some time.
    pub fn yields(&self) -> bool {
        self.drives()
            .any(|d| matches!(d, Self::Free | Self::Force(_) | Self::Pressure { .. }))
    }

    /// Returns whether the motion is imposed at some time.
    pub fn imposes(&self) -> bool {
        self.drives()
            .any(|d| matches!(d, Self::Fixed | Self::Velocity(_) | Self::Displacement(_)))
    }

    /// Returns the velocity imposed at a time, if any.
    pub fn imposed_velocity(&self, t: f64) -> Option<f64> {
        match self {
            Self::Free | Self::Force(_) | Self::Pressure { .. } => None,
            Self::Fixed => Some(0.0),
            Self::Velocity(f) => Some(f.value(t)),
            Self::Displacement(f) => Some(f.rate(t)),
            Self::Stages(_) => self.at(t).imposed_velocity(t),
        }
    }

    /// Returns the force imposed at a time.
    pub fn force(&self, t: f64) -> f64 {
        match self {
            Self::Force(f) => f.value(t),
            Self::Pressure { value, area, .. } => value.value(t) * area,
            Self::Stages(_) => self.at(t).force(t),
            _ => 0.0,
        }
    }

    /// Returns the time function, if any: that of the last stage where there are stages.
    pub fn function(&self) -> Option<&TimeFunction> {
        match self {
            Self::Free | Self::Fixed => None,
            Self::Velocity(f) | Self::Displacement(f) | Self::Force(f) => Some(f),
            Self::Pressure { value, .. } => Some(value),
            Self::Stages(stages) => stages.last().and_then(|s| s.drive.function()),
        }
    }

    /// Returns the error of this drive, if any, and the path of its key relative to the drive
    /// (empty for the drive itself).
    pub fn error(&self) -> Option<(String, String)> {
        match self {
            Self::Stages(stages) => error_of_stages(stages),
            simple => simple.function()?.error().map(|f| (String::new(), f)),
        }
    }

    /// Returns the same drive with a delay of `by` seconds.
    pub fn delayed(&self, by: f64) -> Self {
        let mut later = self.clone();
        match &mut later {
            Self::Free | Self::Fixed => {}
            Self::Velocity(f) | Self::Displacement(f) | Self::Force(f) => *f = f.delayed(by),
            Self::Pressure { value, .. } => *value = value.delayed(by),
            Self::Stages(stages) => {
                for Stage { until, drive } in stages {
                    *until = until.map(|t| t + by);
                    *drive = drive.delayed(by);
                }
            }
        }
        later
    }
}

/// Returns the error in a list of stages, if any, and the path of its key.
fn error_of_stages(stages: &[Stage]) -> Option<(String, String)> {
    if stages.is_empty() {
        return Some((String::new(), "stages need at least one drive".into()));
    }
    let mut before = 0.0;
    // In the case file, stages have a single field, their list.
    for (k, stage) in stages.iter().enumerate() {
        let error = |field: &str, message: String| Some((format!("0.{k}.{field}"), message));
        if matches!(stage.drive, Dof::Stages(_)) {
            return error("drive", "a stage cannot hold stages again".into());
        }
        if let Some((_, message)) = stage.drive.error() {
            return error("drive", message);
        }
        match (stage.until, k + 1 == stages.len()) {
            (None, false) => {
                let message = "a stage that another one follows needs `until`, its end (s)";
                return Some((format!("0.{k}"), message.into()));
            }
            (Some(_), true) => {
                let message = "the last stage holds for ever; leave its `until` out";
                return error("until", message.into());
            }
            (Some(end), false) if !(end.is_finite() && end > before) => {
                let message =
                    format!("stages must end one after another, got {end} after {before}");
                return error("until", message);
            }
            (Some(end), false) => before = end,
            (None, true) => {}
        }
    }
    None
}

/// A first body with driven degrees of freedom: translations first, then rotations.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Driven {
    /// Name in the case.
    pub name: String,
    /// Index of the body.
    pub body: u32,
    /// Translations (D of them), then rotations (one in 2D, three in 3D).
    pub dofs: Vec<Dof>,
}

impl Driven {
    /// Returns whether only contacts and gravity move the body along all axes, as a grain.
    pub fn is_free(&self) -> bool {
        let dimension = if self.dofs.len() == 3 { 2 } else { 3 };
        let translations = self.dofs.iter().take(dimension);
        translations.into_iter().all(|dof| matches!(dof, Dof::Free))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pressed_then_moved() -> Dof {
        Dof::Stages(vec![
            Stage::new(Some(0.3), Dof::Force(TimeFunction::Constant(-2.0))),
            Stage::new(None, Dof::Velocity(TimeFunction::Constant(-0.5))),
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
        assert!(dof.yields() && dof.error().is_none());
    }

    #[test]
    fn a_delayed_drive_is_the_drive_of_the_time_since() {
        for f in TimeFunction::samples() {
            let dof = Dof::Stages(vec![
                Stage::new(Some(0.8), Dof::Velocity(f.clone())),
                Stage::new(None, Dof::Displacement(f)),
            ]);
            for t in [0.05, 0.6, 0.9, 2.0] {
                let now = dof.imposed_velocity(t).unwrap();
                let later = dof.delayed(3.0).imposed_velocity(t + 3.0).unwrap();
                assert!((now - later).abs() < 1e-12, "{dof:?} at {t}");
            }
        }
    }
}
