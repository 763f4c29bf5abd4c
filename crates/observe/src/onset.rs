//! Rise of the tangential force from the first motion on, of a test that moves one way.

use serde::{Deserialize, Serialize};

/// Number of points of the rise at most.
const POINTS: usize = 512;

/// Observer of |Q|/P along the path.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct Onset {
    /// Path (m) and |Q|/P, from the first motion on.
    points: Vec<[f64; 2]>,
    path: f64,
    /// Shortest path between two points (m).
    spacing: f64,
}

impl Onset {
    /// Adds a step: the path over it (m), and the ratio of the forces over it.
    pub fn add(&mut self, path: f64, q: f64, p: f64) {
        self.path += path;
        let last = self.points.last().map_or(0.0, |point| point[0]);
        let near = !self.points.is_empty() && self.path - last < self.spacing;
        if path == 0.0 || p <= 0.0 || near {
            return;
        }
        self.points.push([self.path, q.abs() / p]);
        if self.points.len() > POINTS {
            let mut keep = true;
            self.points.retain(|_| {
                keep = !keep;
                keep
            });
            self.spacing = 2.0 * self.path / POINTS as f64;
        }
    }

    /// Returns the path at which |Q|/P first reaches a value (m), along straight lines between the
    /// points from the origin on; `None` if it doesn't.
    pub fn path_to(&self, ratio: f64) -> Option<f64> {
        let mut before = [0.0; 2];
        for point in &self.points {
            if point[1] >= ratio {
                let share = (ratio - before[1]) / (point[1] - before[1]);
                return Some(before[0] + share * (point[0] - before[0]));
            }
            before = *point;
        }
        None
    }

    /// Returns the part of the path that is elastic where the contact slides at a ratio at the end
    /// (m). Relative to the path to half of the ratio it is 2 of a spring and 2.16 of a sphere on a
    /// flat, whose loading dissipates too (0.8 and 0.370 delta*, by Mindlin); the mean is taken. 0
    /// where the first step reaches half of the ratio.
    pub fn elastic_path(&self, ratio: f64) -> f64 {
        let at_once = self.points.first().is_none_or(|p| p[1] >= 0.5 * ratio);
        match at_once {
            true => 0.0,
            false => 2.08 * self.path_to(0.5 * ratio).unwrap_or(0.0),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_path_to_half_of_the_force_is_that_of_mindlin() {
        let mut onset = Onset::default();
        let steps = 40_000;
        let h = 2.0 / f64::from(steps);
        for k in 1..=steps {
            let delta = (f64::from(k) * h).min(1.0);
            onset.add(h, 0.5 * (1.0 - (1.0 - delta).powf(1.5)), 1.0);
        }
        assert!(onset.points.len() <= POINTS);
        // 1 - (1 - delta)^(3/2) = 1/2 at 0.370.
        let expected = 1.0 - 0.5_f64.powf(2.0 / 3.0);
        assert!((onset.path_to(0.25).unwrap() / expected - 1.0).abs() < 0.02);
        assert_eq!(onset.path_to(0.6), None);
    }
}
