//! Bodies follow the paths of their imposed degrees of freedom.

use super::path::ImposedPath;
use super::state::Bodies;
use crate::geometry::space::{Space, VectorLike};

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
                paths.along[k] = Some(ImposedPath::new(stage, origin, time));
                turns_anew |= k >= S::D;
            }
        }
        if turns_anew {
            paths.reference_orientation = self.rotation[b];
            for path in paths.along[S::D..].iter_mut().flatten() {
                *path = ImposedPath::new(path.stage, 0.0, time);
            }
        }
    }

    /// Sets imposed coordinates to their paths at the end of a step of `h` between the times `from`
    /// and `to` (s).
    ///
    /// A rotation about one axis follows its path; where rotations about several axes are imposed,
    /// which do not commute, the orientation is that of the integrated velocities.
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
