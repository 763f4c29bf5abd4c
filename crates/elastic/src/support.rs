//! What holds and drives a body: parts of its boundary move along an axis as one.

use fretwork_core::bodies::Dof;
use serde::{Deserialize, Serialize};

/// A part of the boundary in a holder that does not turn: along each axis all its points move as
/// one, free, fixed, at an imposed velocity or displacement, or under a force. Axes that are `None`
/// are left to the points.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Support {
    /// Name of the part in the mesh.
    pub part: String,
    /// The drive along each axis; a force (N; N/m in 2D) is that on the whole part.
    pub axes: Vec<Option<Dof>>,
    /// Drives that take over during the run, in phases whose start
    /// [`ElasticBody`](crate::ElasticBody) is notified of: index of the phase, axis, drive. Parts
    /// with a common corner must have the same.
    pub later: Vec<(usize, usize, Dof)>,
}

impl Support {
    /// The drives that take over along an axis.
    pub(crate) fn later(&self, axis: usize) -> impl Iterator<Item = (usize, &Dof)> {
        let along = self.later.iter().filter(move |l| l.1 == axis);
        along.map(|(phase, _, drive)| (*phase, drive))
    }
}

/// Rayleigh damping, C = alpha M + beta K.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Rayleigh {
    /// Factor alpha of the mass (1/s): a mode of angular frequency w is damped by alpha/(2 w) of
    /// its critical damping.
    #[serde(default)]
    pub mass: f64,
    /// Factor beta of the stiffness (s): beta w/2 of the critical damping.
    #[serde(default)]
    pub stiffness: f64,
}
