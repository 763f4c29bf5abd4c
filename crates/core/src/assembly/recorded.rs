//! Convex parts from the record of another run.

use crate::geometry::convex::{Boundary, ConvexCollider, Core};
use crate::geometry::space::{Space, VectorLike};

/// A convex part of a body, from a record.
#[derive(Clone, Debug, PartialEq)]
pub struct RecordedPiece {
    /// Rounding radius (m).
    pub rounding: f64,
    /// Radius of the ball (2D: disk) of the same volume (m).
    pub size: f64,
    /// Position of the part's centre in the frame of the body (m).
    pub offset: [f64; 3],
    /// Corners relative to the part's centre (m).
    pub corners: Vec<[f64; 3]>,
    /// Faces as lists of corner indices.
    pub faces: Vec<Vec<u32>>,
}

impl RecordedPiece {
    /// The part on a body.
    ///
    /// # Errors
    /// Returns why the record is invalid.
    pub(super) fn carried<S: Space>(
        self,
        body: u32,
        material: u16,
    ) -> Result<ConvexCollider<S>, String> {
        let corners = self.corners.iter();
        let corners: Vec<S::Vector> = corners.map(|c| S::Vector::from_slice(c)).collect();
        let farthest = corners.iter().map(VectorLike::norm).fold(0.0, f64::max);
        let core = S::Core::bounded_by(Boundary {
            corners,
            faces: self.faces,
        })?;
        let offset = S::Vector::from_slice(&self.offset);
        let size = self.size;
        let known = self.rounding.is_finite() && self.rounding >= 0.0 && offset.is_finite();
        if !(known && size.is_finite() && size > 0.0 && farthest.is_finite()) {
            return Err("a piece of it has no size".to_owned());
        }
        Ok(ConvexCollider {
            body,
            core,
            offset,
            rounding: self.rounding,
            bound: farthest + self.rounding,
            size,
            material,
        })
    }
}
