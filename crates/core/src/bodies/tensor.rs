//! Anisotropic inertia of non-spherical bodies in 3D.

use crate::geometry::space::{MatrixLike, Space, VectorLike};
use serde::{Deserialize, Serialize};

/// Inertia tensor of a body in its own axes (kg m^2), and its inverse.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
#[serde(bound = "")]
pub struct InertiaTensor<S: Space> {
    own: S::Tensor,
    inverse: S::Tensor,
    /// Largest rotation per substep (rad).
    turn: f64,
}

impl<S: Space> InertiaTensor<S> {
    /// Creates a tensor; `None` if it is isotropic or singular.
    pub fn new(own: S::Tensor) -> Option<Self> {
        const ALIKE: f64 = 1e-12;
        let mean = mean::<S>(&own);
        let n = S::Spin::N;
        let alike = (0..n).all(|i| {
            (0..n).all(|j| {
                let uniform = if i == j { mean } else { 0.0 };
                (own.entry(i, j) - uniform).abs() <= ALIKE * mean
            })
        });
        let inverse = (!alike).then(|| own.inverse())??;
        // The fixed-point iteration for the midpoint contracts by half the rotation times the root
        // of the ratio of inertias, which is at most that of the product of the traces.
        let ratio = mean * self::mean::<S>(&inverse) * (n * n) as f64;
        let turn = f64::min(0.05, 0.5 / ratio.sqrt());
        Some(Self { own, inverse, turn })
    }

    /// Returns the tensor in the body's own axes (kg m^2).
    pub fn own(&self) -> &S::Tensor {
        &self.own
    }

    /// Returns the inverse in world axes (1/(kg m^2)).
    pub fn inverse(&self, rotation: &S::Rotation) -> S::Tensor {
        S::turned_tensor(rotation, &self.inverse)
    }

    /// Returns the angular momentum at a spin (kg m^2/s).
    pub fn momentum(&self, rotation: &S::Rotation, spin: &S::Spin) -> S::Spin {
        let own = self.own.apply(&S::unrotate_spin(rotation, spin));
        S::rotate_spin(rotation, &own)
    }

    /// Returns orientation and spin after free rotation for `time` (s); angular momentum is
    /// conserved to rounding, energy to the tolerance of the iteration.
    ///
    /// The midpoint rule for the momentum in body axes, P' = P x (I^-1 P), with the corresponding
    /// rotation: Austin, Krishnaprasad and Wang, "Almost Poisson integration of rigid body
    /// systems", J. Comput. Phys. 107 (1993). Second order; the length of the substeps follows from
    /// the spin.
    pub fn free_rotation(
        &self,
        rotation: &S::Rotation,
        spin: &S::Spin,
        time: f64,
    ) -> (S::Rotation, S::Spin) {
        /// Upper limit of the rotation in half a step (rad) that is resolved; it bounds the number
        /// of substeps.
        const MAX_TURN: f64 = 100.0;
        const MAX_PARTS: f64 = 1e5;
        let parts = (spin.norm() * time.abs()).min(MAX_TURN) / self.turn;
        let parts = parts.ceil().clamp(1.0, MAX_PARTS);
        let time = time / parts;
        let mut rotation = *rotation;
        let mut momentum = self.own.apply(&S::unrotate_spin(&rotation, spin));
        for _ in 0..parts as usize {
            let half = self.middle(&momentum, time) * (0.5 * time);
            rotation = S::turned_within(&rotation, &half);
            momentum = turned_back::<S>(&momentum, &half);
        }
        let spin = S::rotate_spin(&rotation, &self.inverse.apply(&momentum));
        (rotation, spin)
    }

    /// Returns the midpoint spin, in body axes.
    fn middle(&self, momentum: &S::Spin, time: f64) -> S::Spin {
        const MAX_ITERATIONS: usize = 50;
        let mut spin = self.inverse.apply(momentum);
        for _ in 0..MAX_ITERATIONS {
            let after = turned_back::<S>(momentum, &(spin * (0.5 * time)));
            let next = self.inverse.apply(&((*momentum + after) * 0.5));
            let change = (next - spin).norm();
            spin = next;
            if change <= 4.0 * f64::EPSILON * spin.norm() {
                break;
            }
        }
        spin
    }
}

/// Returns the mean moment of inertia (kg m^2).
pub fn mean<S: Space>(tensor: &S::Tensor) -> f64 {
    let n = S::Spin::N;
    (0..n).map(|k| tensor.entry(k, k)).sum::<f64>() / n as f64
}

/// Returns a vector in axes rotated by the Cayley map of `half`: (1 + [half])^-1 (1 - [half]) v.
fn turned_back<S: Space>(v: &S::Spin, half: &S::Spin) -> S::Spin {
    let once = *v - S::spin_cross(half, v);
    // (1 + [a])^-1 b = (b - a x b + (a . b) a)/(1 + a . a)
    (once - S::spin_cross(half, &once) + *half * half.dot(&once)) * (1.0 / (1.0 + half.dot(half)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::space::{Dim2, Dim3};
    use nalgebra::{Matrix1, Matrix3, UnitQuaternion, Vector3};

    type Rigid = InertiaTensor<Dim3>;

    fn diagonal(a: f64, b: f64, c: f64) -> Rigid {
        Rigid::new(Matrix3::from_diagonal(&Vector3::new(a, b, c))).unwrap()
    }

    #[test]
    fn what_is_alike_about_all_axes_needs_no_tensor() {
        assert!(Rigid::new(Matrix3::identity() * 3.0).is_none());
        assert!(InertiaTensor::<Dim2>::new(Matrix1::new(2.0)).is_none());
    }

    #[test]
    fn a_symmetric_top_precesses_as_the_books_say() {
        // Landau and Lifshitz, Mechanics, section 33: the axis precesses about the momentum at the
        // rate L/I_1.
        let (i1, i3) = (2.0, 3.0);
        let top = diagonal(i1, i1, i3);
        let start = Vector3::new(0.4, 0.0, 1.1);
        let momentum = top.momentum(&UnitQuaternion::identity(), &start);
        let (time, steps) = (3.0, 3000);
        let (mut rotation, mut spin) = (UnitQuaternion::identity(), start);
        for _ in 0..steps {
            (rotation, spin) = top.free_rotation(&rotation, &spin, time / f64::from(steps));
        }
        let precession = UnitQuaternion::from_scaled_axis(momentum * (time / i1));
        let axis = precession * Vector3::z();
        assert!((rotation * Vector3::z() - axis).norm() < 1e-6);
        // The spin follows from the conserved momentum.
        let now = top.momentum(&rotation, &spin);
        assert!((now - momentum).norm() < 1e-12 * momentum.norm());
    }

    #[test]
    fn a_needle_keeps_energy_and_momentum() {
        for ratio in [1e3, 1e4, 1e6] {
            let needle = diagonal(1.0 / ratio, 1.0, 1.2);
            let (mut rotation, mut spin) =
                (UnitQuaternion::identity(), Vector3::new(5.0, 20.0, 3.0));
            let momentum = needle.momentum(&rotation, &spin);
            let energy = spin.dot(&momentum);
            for _ in 0..50 {
                (rotation, spin) = needle.free_rotation(&rotation, &spin, 5e-3);
            }
            let now = needle.momentum(&rotation, &spin);
            assert!(
                (now - momentum).norm() < 1e-10 * momentum.norm(),
                "{ratio:e}"
            );
            let e = spin.dot(&now) / energy - 1.0;
            assert!(e.abs() < 1e-9, "{ratio:e}: {e:e}");
        }
    }

    #[test]
    fn a_body_that_tumbles_keeps_energy_and_momentum() {
        // Rotation about the intermediate axis: the Dzhanibekov effect.
        let body = diagonal(1.0, 2.0, 3.0);
        let (mut rotation, mut spin) = (UnitQuaternion::identity(), Vector3::new(1e-3, 5.0, 1e-3));
        let momentum = body.momentum(&rotation, &spin);
        let energy = spin.dot(&momentum);
        let mut turned_over = false;
        for _ in 0..2000 {
            (rotation, spin) = body.free_rotation(&rotation, &spin, 0.01);
            turned_over |= (rotation * Vector3::y()).dot(&momentum) < 0.0;
        }
        let now = body.momentum(&rotation, &spin);
        assert!((now - momentum).norm() < 1e-11 * momentum.norm());
        assert!((spin.dot(&now) - energy).abs() < 1e-11 * energy);
        assert!(turned_over);
    }
}
