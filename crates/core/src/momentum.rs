//! The ledger of momentum: the momentum that free rigid bodies gained without an external cause.

use crate::energy::LedgerEntry;
use crate::geometry::space::{Space, VectorLike};
use serde::{Deserialize, Serialize};

/// Momentum gained by the free rigid bodies since the start, less the impulses of gravity and of
/// contacts with other bodies (N s and N m s; per metre of depth in 2D). It is zero up to rounding
/// if contacts act at the same position on both bodies.
///
/// First bodies and dynamical systems count as other bodies. Changes between steps are not counted:
/// removing, adding, pushing and displacing bodies are external.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Momentum {
    /// Linear momentum, x, y, z (N s).
    pub linear: [f64; 3],
    /// Angular momentum, x, y, z (in 2D z), about [`Self::about`] (N m s).
    pub angular: [f64; 3],
    /// Mean position of the free bodies at the start (m); `None` before the first step. In periodic
    /// scenes angular momentum is not computed.
    pub about: Option<[f64; 3]>,
    /// Largest sums so far of the magnitudes of the bodies' linear and angular momenta (N s, N m
    /// s).
    pub scale: [f64; 2],
}

/// Momentum of some bodies, or a change of it.
#[derive(Clone, Copy, Debug)]
pub struct MomentumSum<S: Space> {
    /// Linear momentum (N s).
    pub linear: S::Vector,
    /// Angular momentum (N m s).
    pub angular: S::Spin,
    /// Sums of the magnitudes of the momenta (N s, N m s).
    pub sizes: [f64; 2],
}

impl<S: Space> MomentumSum<S> {
    /// Returns a sum of no bodies.
    pub fn zero() -> Self {
        Self {
            linear: S::Vector::zero(),
            angular: S::Spin::zero(),
            sizes: [0.0; 2],
        }
    }

    /// Adds another sum.
    pub fn add(&mut self, other: &Self) {
        self.linear += other.linear;
        self.angular += other.angular;
        self.sizes = [0, 1].map(|k| self.sizes[k] + other.sizes[k]);
    }
}

impl Momentum {
    /// Adds a step: the gain without external cause, and the sizes of the momenta.
    pub fn add_step<S: Space>(&mut self, step: &MomentumSum<S>) {
        let angular = match S::D {
            2 => [0.0, 0.0, step.angular[0]],
            _ => step.angular.padded(),
        };
        let linear = step.linear.padded();
        for k in 0..3 {
            self.linear[k] += linear[k];
            self.angular[k] += angular[k];
        }
        self.scale = [0, 1].map(|k| self.scale[k].max(step.sizes[k]));
    }

    /// Returns the magnitudes of the gains, linear (N s) and angular (N m s).
    pub fn drift(&self) -> [f64; 2] {
        [self.linear, self.angular].map(|v| v[0].hypot(v[1]).hypot(v[2]))
    }

    /// Returns the drift, linear and angular, relative to the largest sums of the magnitudes of
    /// momenta; zero if nothing moved.
    pub fn relative(&self) -> [f64; 2] {
        let drift = self.drift();
        [0, 1].map(|k| match self.scale[k] > 0.0 {
            true => drift[k] / self.scale[k],
            false => 0.0,
        })
    }

    /// Returns every entry: name, description, value (N s, N m s).
    pub fn entries(&self) -> [LedgerEntry; 2] {
        let [linear, angular] = self.drift();
        [
            (
                "momentum_drift",
                "momentum of free rigid bodies that nothing outside gave",
                linear,
            ),
            (
                "angular_momentum_drift",
                "angular momentum of free rigid bodies that nothing outside gave; 0 in periodic scenes",
                angular,
            ),
        ]
    }
}
