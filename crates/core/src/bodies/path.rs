//! Imposed motion: degrees of freedom follow their functions of time to rounding.
//!
//! Over a step from t to t + h an imposed degree of freedom has an initial velocity v_s and a final
//! velocity v_e, whose mean in the theta-scheme is exactly that of its path x(t): (1 - theta) v_s +
//! theta v_e = (x(t + h) - x(t))/h, v_e - v_s = x'(t + h -) - x'(t +). Where x is smooth both equal
//! its derivative to O(h^2) (O(h) with theta > 1/2). Between two steps the velocity jumps from v_e
//! to the next v_s: by O(h^3) where x is smooth (O(h^2) with theta > 1/2), and by the full jump of
//! x' at a kink. If a kink lies within a step, v_s and v_e stay between the slopes on its two
//! sides.
//!
//! At the end of a step the position is set from the function, so that errors do not accumulate.

use super::drive::Dof;
use super::time_function::TimeFunction;
use crate::geometry::space::Space;
use serde::{Deserialize, Serialize};

/// Velocities at the start and the end of a step (m/s or rad/s).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Speeds {
    /// Velocity after the jump at the start of the step.
    pub start: f64,
    /// Velocity at the end, before the jump of the next step.
    pub end: f64,
}

impl Dof {
    /// Returns the velocities of a step of `h` from `t` on, if this drive (other than stages)
    /// imposes them.
    pub fn speeds(&self, t: f64, h: f64, theta: f64) -> Option<Speeds> {
        let (mean, first, last, corners) = match self {
            Self::Fixed => return Some(Speeds::default()),
            Self::Velocity(f) => (
                f.mean(t, h),
                f.value(t),
                f.value(t + h),
                f.values_at_corners(t, h),
            ),
            Self::Displacement(f) => (
                f.mean_rate(t, h),
                f.rate_after(t),
                f.rate_before(t + h),
                f.rates_at_corners(t, h),
            ),
            _ => return None,
        };
        let mut rise = last - first;
        if let Some((low, high)) = corners {
            let low = low.min(first).min(last).min(mean);
            let high = high.max(first).max(last).max(mean);
            // Distances from the mean to the lowest and highest admissible velocity.
            let (below, above) = (mean - low, high - mean);
            // At theta = 1 the final velocity is the mean, and `min` ignores the NaN of 0/0.
            let most = if rise > 0.0 {
                (below / theta).min(above / (1.0 - theta))
            } else {
                (above / theta).min(below / (1.0 - theta))
            };
            rise = rise.signum() * rise.abs().min(most);
        }
        Some(Speeds {
            start: mean - theta * rise,
            end: mean + (1.0 - theta) * rise,
        })
    }

    /// Returns whether the drive imposes a path.
    pub(super) fn imposes_path(&self) -> bool {
        matches!(self, Self::Velocity(_) | Self::Displacement(_))
    }
}

/// Start of the path of an imposed degree of freedom, and the displacement so far.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct ImposedPath {
    /// Index of the stage of the drive that it follows.
    pub(super) stage: usize,
    /// Initial coordinate (m); zero for a rotation.
    pub(super) origin: f64,
    /// Time up to which the displacement is summed (s).
    since: f64,
    /// Displacement up to that time (m or rad), and its rounding compensation.
    displacement: [f64; 2],
}

impl ImposedPath {
    pub(super) fn new(stage: usize, origin: f64, since: f64) -> Self {
        Self {
            stage,
            origin,
            since,
            displacement: [0.0; 2],
        }
    }

    /// Returns the displacement at a time (m or rad); times must not decrease from call to call.
    pub(super) fn displacement(&mut self, drive: &Dof, t: f64) -> f64 {
        match drive {
            Dof::Displacement(f) => f.change(self.since, t),
            Dof::Velocity(f) => {
                if let Some(point) = f.last_point(self.since, t) {
                    self.accumulate(f, point);
                }
                let rest = self.displacement[1] + f.integral(self.since, t);
                self.displacement[0] + rest
            }
            _ => 0.0,
        }
    }

    /// Adds the displacement up to a point of a table, with compensated summation.
    fn accumulate(&mut self, f: &TimeFunction, point: f64) {
        let part = f.integral(self.since, point) + self.displacement[1];
        let sum = self.displacement[0] + part;
        self.displacement = [sum, part - (sum - self.displacement[0])];
        self.since = point;
    }
}

/// Paths of the imposed degrees of freedom of a driven body, in their order.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(bound = "")]
pub struct ImposedPaths<S: Space> {
    pub(super) along: Vec<Option<ImposedPath>>,
    /// Orientation relative to which the imposed rotation is measured.
    pub(super) reference_orientation: S::Rotation,
}

impl<S: Space> ImposedPaths<S> {
    pub(super) fn new(dofs: usize) -> Self {
        Self {
            along: vec![None; dofs],
            reference_orientation: S::identity(),
        }
    }

    /// Number of degrees of freedom.
    pub(super) fn dofs(&self) -> usize {
        self.along.len()
    }

    /// Starts a new path of a degree of freedom with the next step.
    pub(super) fn forget(&mut self, dof: usize) {
        self.along[dof] = None;
    }

    /// Starts new paths of all degrees of freedom.
    pub(super) fn forget_all(&mut self) {
        self.along.fill(None);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The mean over a step is that of the path, and both ends equal the derivative within h^2
    /// times the third derivative.
    #[test]
    fn a_smooth_path_has_its_derivative_at_both_ends() {
        let f = TimeFunction::Sine {
            amplitude: 1.0,
            frequency: 1.0 / std::f64::consts::TAU,
            phase: 0.3,
            offset: 5.0,
            start: 0.0,
        };
        let (h, dof) = (1e-2, Dof::Displacement(f.clone()));
        for k in 0..700 {
            let t = f64::from(k) * h;
            for theta in [0.5, 0.7, 1.0] {
                let s = dof.speeds(t, h, theta).unwrap_or_default();
                let mean = (1.0 - theta) * s.start + theta * s.end;
                let rise = (t + h + 0.3).sin() - (t + 0.3).sin();
                assert!((mean * h - rise).abs() < 1e-15);
                let bound = if theta == 0.5 { h * h / 11.0 } else { h };
                assert!((s.start - (t + 0.3).cos()).abs() < bound);
                assert!((s.end - (t + h + 0.3).cos()).abs() < bound);
            }
        }
    }

    /// For a table whose points are ends of steps, each step has the slope of its segment at both
    /// ends, including the first.
    #[test]
    fn a_table_has_the_slopes_of_its_segments() {
        let h = 0.125;
        let dof = Dof::Displacement(TimeFunction::Table(vec![
            (0.0, 1.0),
            (2.0 * h, 1.5),
            (4.0 * h, 0.5),
        ]));
        for theta in [0.5, 0.7, 1.0] {
            for (k, slope) in [2.0, 2.0, -4.0, -4.0, 0.0].into_iter().enumerate() {
                let s = dof.speeds(k as f64 * h, h, theta).unwrap_or_default();
                for v in [s.start, s.end] {
                    assert!((v - slope).abs() < 1e-13, "step {k}, theta {theta}: {s:?}");
                }
            }
        }
    }

    /// Wherever a kink lies in a step, velocities stay between the slopes, and the mean is that of
    /// the path.
    #[test]
    fn corners_do_not_overshoot() {
        for part in [1e-9, 0.1, 0.4, 0.5, 0.6, 0.99] {
            for theta in [0.5, 0.8, 1.0] {
                let ramp = TimeFunction::Ramp {
                    from: 1.0,
                    to: 1.0 + part,
                    start: -1.0,
                    end: part,
                };
                let slope = part / (1.0 + part);
                let jump = TimeFunction::Table(vec![(part, 0.0), (part + 1e-12, 1.0)]);
                for (dof, mean, high) in [
                    (Dof::Displacement(ramp), slope * part, slope),
                    (Dof::Velocity(jump), 1.0 - part, 1.0),
                ] {
                    let s = dof.speeds(0.0, 1.0, theta).unwrap_or_default();
                    let obtained = (1.0 - theta) * s.start + theta * s.end;
                    assert!((obtained - mean).abs() < 1e-11, "{dof:?} {s:?}");
                    for v in [s.start, s.end] {
                        assert!((-1e-11..=high + 1e-11).contains(&v), "{dof:?} {s:?}");
                    }
                }
            }
        }
    }
}
