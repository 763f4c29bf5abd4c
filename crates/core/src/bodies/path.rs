//! Imposed motion: degrees of freedom follow their functions of time to rounding.
//!
//! Over a step from t to t + h an imposed degree of freedom has an initial velocity v_s and a final velocity
//! v_e, whose mean in the theta-scheme is exactly that of its path x(t):
//! (1 - theta) v_s + theta v_e = (x(t + h) - x(t))/h, v_e - v_s = x'(t + h -) - x'(t +). Where x is smooth
//! both equal its derivative to O(h^2) (O(h) with theta > 1/2). Between two steps the velocity jumps from
//! v_e to the next v_s: by O(h^3) where x is smooth (O(h^2) with theta > 1/2), and by the full jump of x' at
//! a kink. If a kink lies within a step, v_s and v_e stay between the slopes on its two sides.
//!
//! At the end of a step the position is set from the function, so that errors do not accumulate.

use super::drive::{Dof, TimeFunction};
use super::state::Bodies;
use crate::geometry::space::{Space, VectorLike};
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
    /// Returns the velocities of a step of `h` from `t` on, if this drive (other than stages) imposes them.
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

    /// Returns whether it imposes a path.
    fn imposes_path(&self) -> bool {
        matches!(self, Self::Velocity(_) | Self::Displacement(_))
    }
}

/// Start of the path of an imposed degree of freedom, and the displacement so far.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Path {
    /// Index of the stage of the drive that it follows.
    stage: usize,
    /// Initial coordinate (m); zero for a rotation.
    origin: f64,
    /// Time up to which the displacement is summed (s).
    since: f64,
    /// Displacement up to that time (m or rad), and its rounding compensation.
    displacement: [f64; 2],
}

impl Path {
    fn new(stage: usize, origin: f64, since: f64) -> Self {
        Self {
            stage,
            origin,
            since,
            displacement: [0.0; 2],
        }
    }

    /// Returns the displacement at a time (m or rad); times must not decrease from call to call.
    fn displacement(&mut self, drive: &Dof, t: f64) -> f64 {
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

/// Paths of a driven body, in the order of its degrees of freedom.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(bound = "")]
pub struct Paths<S: Space> {
    along: Vec<Option<Path>>,
    /// Orientation relative to which the imposed rotation is measured.
    reference_orientation: S::Rotation,
}

impl<S: Space> Paths<S> {
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

impl<S: Space> Bodies<S> {
    /// Starts the paths of the drives that take effect with the step from `time` on, at the current
    /// positions, and sets the initial velocities of all imposed degrees of freedom.
    pub fn begin_imposed_motion(&mut self, time: f64, h: f64, theta: f64) {
        for place in 0..self.driven.len() {
            self.begin_paths(place, time, h);
            let driven = &self.driven[place];
            let b = driven.body as usize;
            for (k, dof) in driven.dofs.iter().enumerate() {
                if let Some(speeds) = dof.over(time, h).speeds(time, h, theta) {
                    if k < S::D {
                        self.velocity[b][k] = speeds.start;
                    } else {
                        self.spin[b][k - S::D] = speeds.start;
                    }
                }
            }
        }
    }

    fn begin_paths(&mut self, place: usize, time: f64, h: f64) {
        let driven = &self.driven[place];
        let b = driven.body as usize;
        let paths = &mut self.paths[place];
        let mut turns_anew = false;
        for (k, dof) in driven.dofs.iter().enumerate() {
            let stage = dof.stage_at(time + 0.5 * h);
            if !dof.over(time, h).imposes_path() {
                turns_anew |= k >= S::D && paths.along[k].take().is_some();
                paths.along[k] = None;
                continue;
            }
            if paths.along[k].as_ref().is_none_or(|p| p.stage != stage) {
                let origin = if k < S::D { self.position[b][k] } else { 0.0 };
                paths.along[k] = Some(Path::new(stage, origin, time));
                turns_anew |= k >= S::D;
            }
        }
        if turns_anew {
            paths.reference_orientation = self.rotation[b];
            for path in paths.along[S::D..].iter_mut().flatten() {
                *path = Path::new(path.stage, 0.0, time);
            }
        }
    }

    /// Sets imposed coordinates to their paths at the end of the step of `h` from `from` to `to` (s).
    ///
    /// A rotation about one axis follows its path; where rotations about several axes are imposed, which do
    /// not commute, the orientation is that of the integrated velocities.
    pub fn end_imposed_motion(&mut self, from: f64, to: f64, h: f64) {
        for (driven, paths) in self.driven.iter().zip(&mut self.paths) {
            let b = driven.body as usize;
            let turning = paths.along[S::D..].iter().flatten().count();
            for (k, dof) in driven.dofs.iter().enumerate() {
                let Some(path) = &mut paths.along[k] else {
                    continue;
                };
                let displacement = path.displacement(dof.over(from, h), to);
                if k < S::D {
                    self.position[b][k] = path.origin + displacement;
                } else if turning == 1 {
                    let mut angle = S::Spin::zero();
                    angle[k - S::D] = displacement;
                    self.rotation[b] = S::turned(&paths.reference_orientation, &angle);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The mean over a step is that of the path, and both ends equal the derivative within h^2 times the
    /// third derivative.
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

    /// Linear between points that are the ends of steps: each step has the slope of its segment at both ends, the first one too.
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

    /// Wherever a kink lies in a step, velocities stay between the slopes, and the mean is that of the path.
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
