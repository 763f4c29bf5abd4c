//! Sums over steps for the measures of plane shear: momentum that contacts transmit across the
//! layers, momentum that grains carry by their motion, shear rate and solid fraction.

use crate::measure::ball::volume_below;
use crate::measure::{Grain, grains, line};
use fretwork_core::geometry::space::ball_volume;
use fretwork_core::view::RunView;
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};
use std::ops::AddAssign;

/// Sums over steps, each weighted by its duration.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Sums {
    /// Duration (s).
    pub time: f64,
    /// Impulses of the contacts times their branches, over the volume: across the layers and along
    /// (Pa s).
    pub contacts: [f64; 2],
    /// Contribution of the motion of the grains to these sums, m v' v' h over the volume (Pa s).
    pub motion: [f64; 2],
    /// Shear rate (1).
    pub rate: f64,
    /// Solid fraction (s).
    pub solid: f64,
    /// Mean mass of a grain (kg s; kg s/m in 2D).
    pub mass: f64,
    /// Mean radius (m s).
    pub radius: f64,
}

impl AddAssign<&Sums> for Sums {
    fn add_assign(&mut self, o: &Sums) {
        self.time += o.time;
        for k in 0..2 {
            self.contacts[k] += o.contacts[k];
            self.motion[k] += o.motion[k];
        }
        self.rate += o.rate;
        self.solid += o.solid;
        self.mass += o.mass;
        self.radius += o.radius;
    }
}

impl Sums {
    /// Returns the normal stress across the layers and the shear stress, of contacts and motion
    /// together (Pa).
    pub fn stress(&self) -> [f64; 2] {
        [0, 1].map(|k| (self.contacts[k] + self.motion[k]) / self.time)
    }

    /// The part of the motion (Pa).
    pub fn kinetic(&self) -> [f64; 2] {
        self.motion.map(|m| m / self.time)
    }

    /// Returns the inertial number at a shear rate and a pressure: rate sqrt(m/p) in 2D, rate d
    /// sqrt(density/p) in 3D; zero without pressure.
    pub fn inertial(&self, dimension: usize, rate: f64, p: f64) -> f64 {
        let (mass, radius) = (self.mass / self.time, self.radius / self.time);
        if p <= 0.0 || mass <= 0.0 {
            0.0
        } else if dimension == 2 {
            rate.abs() * (mass / p).sqrt()
        } else {
            rate.abs() * 2.0 * radius * (mass / ball_volume(dimension, radius) / p).sqrt()
        }
    }
}

/// The layer between two heights.
#[derive(Clone, Copy, Debug)]
pub(super) struct ShearedLayer {
    /// Lower height (m).
    pub low: f64,
    /// Upper height (m).
    pub high: f64,
}

impl ShearedLayer {
    /// Returns the sums of the last step, weighted by `weight` (s). `before` holds the velocities
    /// at its start, by body.
    pub fn step(self, run: &dyn RunView, before: &[[f64; 3]], weight: f64) -> Sums {
        let up = run.dimension() - 1;
        let section: f64 = (0..up)
            .map(|k| run.periodic().period[k].unwrap_or(1.0))
            .product();
        let volume = section * (self.high - self.low);
        let all = grains(run);
        let theta = run.options().scheme.theta;
        // Momentum is carried at v_theta, the velocity that moves the grains.
        let after = run.bodies().velocity;
        let velocity = |g: &Grain| {
            let after = Vector3::from(after.at(g.body));
            let before = before.get(g.body).map_or(after, |v| Vector3::from(*v));
            before * (1.0 - theta) + after * theta
        };
        let inside = |z: f64| (self.low..self.high).contains(&z);
        let within: Vec<(f64, Vector3<f64>, f64, f64)> = all
            .iter()
            .filter(|g| inside(g.at[up]))
            .map(|g| (g.at[up], velocity(g), g.mass, g.radius))
            .collect();
        let count = within.len().max(1) as f64;
        let rate = line(within.iter().map(|g| (g.0, g.1[0]))).unwrap_or(0.0);
        let motion = fluctuations(within.iter().map(|g| (g.2, g.0, [g.1[0], g.1[up]])));
        let solid: f64 = all
            .iter()
            .filter(|g| g.at[up] + g.radius > self.low && g.at[up] - g.radius < self.high)
            .map(|g| {
                volume_below(up + 1, g.radius, self.high - g.at[up])
                    - volume_below(up + 1, g.radius, self.low - g.at[up])
            })
            .sum();
        Sums {
            time: weight,
            contacts: self.impulses(run).map(|x| x / volume),
            motion: [motion[0] * weight / volume, -motion[1] * weight / volume],
            rate: rate * weight,
            solid: solid / volume * weight,
            mass: within.iter().map(|g| g.2).sum::<f64>() / count * weight,
            radius: within.iter().map(|g| g.3).sum::<f64>() / count * weight,
        }
    }

    /// Returns the sums of impulse times branch of the contacts, across the layers and along them,
    /// each weighted by the part of its branch in the layer; the shear is the traction of the upper
    /// side on the lower.
    fn impulses(self, run: &dyn RunView) -> [f64; 2] {
        let up = run.dimension() - 1;
        let mut sum = [0.0; 2];
        run.visit_contacts(&mut |contact| {
            let [a, b] = run.ends_of_contact(contact.place);
            // The branch is from the antagonist to the candidate, on which the impulse acts.
            let part = a[up].clamp(self.low, self.high) - b[up].clamp(self.low, self.high);
            sum[0] += contact.impulse[up] * part;
            sum[1] -= contact.impulse[0] * part;
        });
        sum
    }
}

/// Returns the sums m v_y' v_y' and m v_x' v_y' over grains given by mass, height and velocity (x,
/// y): v' is relative to the straight line through the velocities over the height, so that an
/// affine field has none.
fn fluctuations(grains: impl Iterator<Item = (f64, f64, [f64; 2])> + Clone) -> [f64; 2] {
    let (mut mass, mut height, mut momentum) = (0.0, 0.0, [0.0; 2]);
    for (m, y, v) in grains.clone() {
        mass += m;
        height += m * y;
        momentum = [0, 1].map(|k| momentum[k] + m * v[k]);
    }
    if mass <= 0.0 {
        return [0.0; 2];
    }
    let centre = height / mass;
    let mean = momentum.map(|p| p / mass);
    let (mut square, mut slope) = (0.0, [0.0; 2]);
    for (m, y, v) in grains.clone() {
        square += m * (y - centre) * (y - centre);
        slope = [0, 1].map(|k| slope[k] + m * (y - centre) * (v[k] - mean[k]));
    }
    let slope = slope.map(|x| if square > 0.0 { x / square } else { 0.0 });
    let mut sum = [0.0; 2];
    for (m, y, v) in grains {
        let [x, up] = [0, 1].map(|k| v[k] - mean[k] - slope[k] * (y - centre));
        sum = [sum[0] + m * up * up, sum[1] + m * x * up];
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_affine_field_does_not_fluctuate() {
        let grains: Vec<_> = (0..7)
            .map(|k| {
                let y = f64::from(k) * 0.3 + 0.01 * f64::from(k * k);
                (1.0 + f64::from(k), y, [3.0 - 2.0 * y, 0.5 + 0.7 * y])
            })
            .collect();
        let sum = fluctuations(grains.iter().copied());
        assert!(sum.iter().all(|x| x.abs() < 1e-12), "{sum:?}");
    }

    #[test]
    fn pairs_of_opposite_velocity_carry_momentum_across_the_layers() {
        // There are two grains of 2 kg/m at each height with v = U(y) +- (0.3, -0.2) m/s: m v_y'
        // v_y' = 0.08, m v_x' v_y' = -0.12 each.
        let grains: Vec<_> = (0..4)
            .flat_map(|k| {
                let y = f64::from(k);
                [1.0, -1.0].map(|s| (2.0, y, [5.0 * y + 0.3 * s, -0.2 * s]))
            })
            .collect();
        let sum = fluctuations(grains.iter().copied());
        assert!((sum[0] - 8.0 * 0.08).abs() < 1e-12 && (sum[1] + 8.0 * 0.12).abs() < 1e-12);
    }
}
