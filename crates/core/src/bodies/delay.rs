//! Drives shifted in time: the drive of a phase is a function of the time since the phase began.

use super::drive::{Dof, TimeFunction};
use super::stages::Stage;

impl TimeFunction {
    /// Returns the same function, shifted to `by` seconds later.
    pub fn delayed(&self, by: f64) -> Self {
        let mut later = self.clone();
        match &mut later {
            Self::Constant(_) => {}
            Self::Ramp { start, end, .. } => (*start, *end) = (*start + by, *end + by),
            Self::Sine { start, .. } => *start += by,
            Self::Table(points) => points.iter_mut().for_each(|p| p.0 += by),
        }
        later
    }
}

impl Dof {
    /// Returns the same drive, shifted to `by` seconds later.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_delayed_drive_is_the_drive_of_the_time_since() {
        let functions = [
            TimeFunction::Constant(2.0),
            TimeFunction::Ramp {
                from: 1.0,
                to: 3.0,
                start: 0.5,
                end: 1.5,
            },
            TimeFunction::Sine {
                amplitude: 2.0,
                frequency: 0.3,
                phase: 0.2,
                offset: 1.0,
                start: 0.1,
            },
            TimeFunction::Table(vec![(0.0, 0.0), (0.7, 2.0), (1.4, -1.0)]),
        ];
        for f in functions {
            let dof = Dof::Stages(vec![
                Stage {
                    until: Some(0.8),
                    drive: Dof::Velocity(f.clone()),
                },
                Stage {
                    until: None,
                    drive: Dof::Displacement(f),
                },
            ]);
            for t in [0.05, 0.6, 0.9, 2.0] {
                let (now, later) = (
                    dof.imposed_velocity(t).unwrap_or(f64::NAN),
                    dof.delayed(3.0)
                        .imposed_velocity(t + 3.0)
                        .unwrap_or(f64::NAN),
                );
                assert!((now - later).abs() < 1e-12, "{dof:?} at {t}");
            }
        }
    }
}
