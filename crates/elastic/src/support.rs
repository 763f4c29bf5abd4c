//! Supports of a deformable body, parts of whose boundary move along an axis as one, and Rayleigh
//! damping.

use fretwork_core::bodies::Dof;
use serde::{Deserialize, Serialize};

/// A part of the boundary in a holder that does not rotate. Along each axis all its points move as
/// one: free, fixed, at an imposed velocity or displacement, or under a force. Along an axis that
/// is `None` each point moves by itself.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Support {
    /// Name of the part in the mesh.
    pub part: String,
    /// The drive along each axis; a force (N; N/m in 2D) acts on the part as a whole.
    pub axes: Vec<Option<Dof>>,
    /// Drives that take effect during the run: index of the phase at whose start the drive takes
    /// effect, axis, drive. [`ElasticBody`](crate::ElasticBody) is notified of the start of each
    /// phase. Parts that share a corner must have equal drives.
    pub later: Vec<(usize, usize, Dof)>,
}

impl Support {
    /// Returns the later drives along an axis, with the index of their phase.
    pub(crate) fn later(&self, axis: usize) -> impl Iterator<Item = (usize, &Dof)> {
        let along = self.later.iter().filter(move |l| l.1 == axis);
        along.map(|(phase, _, drive)| (*phase, drive))
    }
}

/// Rayleigh damping, C = alpha M + beta K.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Rayleigh {
    /// Factor alpha of the mass (1/s): a mode of angular frequency w is damped by alpha/(2 w) of
    /// its critical damping.
    #[serde(default)]
    pub mass: f64,
    /// Factor beta of the stiffness (s): a mode of angular frequency w is damped by beta w/2 of its
    /// critical damping.
    #[serde(default)]
    pub stiffness: f64,
}
