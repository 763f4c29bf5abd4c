//! Algebra of the Lorentz cone x0 >= |x1|: the Jordan product, the Nesterov-Todd scaling, and step
//! lengths.

use super::block::Block;
use super::law::slip;

/// Returns x0^2 - |x1|^2.
fn determinant<const D: usize>(x: &[f64; D]) -> f64 {
    let t = slip(x);
    (x[0] - t) * (x[0] + t)
}

/// Returns the Jordan product.
pub(super) fn product<const D: usize>(x: &[f64; D], y: &[f64; D]) -> [f64; D] {
    std::array::from_fn(|k| {
        if k == 0 {
            (0..D).map(|i| x[i] * y[i]).sum()
        } else {
            x[0] * y[k] + y[0] * x[k]
        }
    })
}

/// Returns z with x o z = y.
pub(super) fn divide<const D: usize>(x: &[f64; D], y: &[f64; D]) -> [f64; D] {
    let d = determinant(x);
    let cross: f64 = (1..D).map(|k| x[k] * y[k]).sum();
    let z0 = (x[0] * y[0] - cross) / d;
    std::array::from_fn(|k| {
        if k == 0 {
            z0
        } else {
            (y[k] - z0 * x[k]) / x[0]
        }
    })
}

/// Nesterov-Todd scaling: P r = P^-1 v.
#[derive(Debug)]
pub(super) struct Scaling<const D: usize> {
    eta: f64,
    w: [f64; D],
}

impl<const D: usize> Scaling<D> {
    /// Returns the scaling at two points inside the cone.
    pub(super) fn new(r: &[f64; D], v: &[f64; D]) -> Self {
        let (dr, dv) = (determinant(r).max(1e-300), determinant(v).max(1e-300));
        let (a, b) = (1.0 / dr.sqrt(), 1.0 / dv.sqrt());
        let inner: f64 = (0..D).map(|k| r[k] * v[k]).sum::<f64>() * a * b;
        let gamma = (0.5 * (1.0 + inner)).sqrt();
        let w: [f64; D] = std::array::from_fn(|k| {
            let sign = if k == 0 { 1.0 } else { -1.0 };
            (v[k] * b + sign * r[k] * a) / (2.0 * gamma)
        });
        Self {
            eta: (dv / dr).powf(0.25),
            w,
        }
    }

    /// Returns P x.
    pub(super) fn apply(&self, x: &[f64; D]) -> [f64; D] {
        let w = &self.w;
        let cross: f64 = (1..D).map(|k| w[k] * x[k]).sum();
        let along = x[0] + cross / (1.0 + w[0]);
        std::array::from_fn(|k| {
            self.eta
                * if k == 0 {
                    w[0] * x[0] + cross
                } else {
                    x[k] + along * w[k]
                }
        })
    }

    /// Returns P^-1 x.
    pub(super) fn apply_inverse(&self, x: &[f64; D]) -> [f64; D] {
        let w = &self.w;
        let cross: f64 = (1..D).map(|k| w[k] * x[k]).sum();
        let along = -x[0] + cross / (1.0 + w[0]);
        std::array::from_fn(|k| {
            (if k == 0 {
                w[0] * x[0] - cross
            } else {
                x[k] + along * w[k]
            }) / self.eta
        })
    }

    /// Returns P^2 = eta^2 (2 w w^T - J).
    pub(super) fn square(&self) -> Block<D> {
        let e = self.eta * self.eta;
        std::array::from_fn(|i| {
            std::array::from_fn(|j| {
                let sign = if i != j {
                    0.0
                } else if i == 0 {
                    1.0
                } else {
                    -1.0
                };
                e * (2.0 * self.w[i] * self.w[j] - sign)
            })
        })
    }
}

/// Returns the largest t for which x + t d stays in the cone.
pub(super) fn longest_step<const D: usize>(x: &[f64; D], d: &[f64; D]) -> f64 {
    let mut a = d[0] * d[0];
    let mut b = x[0] * d[0];
    let mut c = x[0] * x[0];
    for k in 1..D {
        a -= d[k] * d[k];
        b -= x[k] * d[k];
        c -= x[k] * x[k];
    }
    // Smallest positive root of a t^2 + 2 b t + c.
    let mut t = f64::INFINITY;
    let disc = b * b - a * c;
    if disc >= 0.0 {
        let q = -(b + b.signum() * disc.sqrt());
        for root in [q / a, c / q] {
            if root > 0.0 && root < t {
                t = root;
            }
        }
    }
    if d[0] < 0.0 {
        t = t.min(-x[0] / d[0]);
    }
    t
}
