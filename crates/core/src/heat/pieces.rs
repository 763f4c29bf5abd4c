//! Pieces of the surface of a first body: strips along one axis, or rectangles along two, in the
//! axes of the body.

use crate::geometry::space::{Space, VectorLike};
use fretwork_math::diffusion::{ColumnAxis, Columns};

/// The strips along an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PieceAxis {
    /// The axis of the body, 0 is x.
    pub axis: usize,
    /// Start of the first strip, in the axes of the body (m).
    pub low: f64,
    /// Length of all strips (m).
    pub length: f64,
    /// Number of strips.
    pub count: u32,
    /// Whether the strips are periodic: a position beyond the last is in the first again.
    pub periodic: bool,
}

impl PieceAxis {
    /// The strip of a coordinate (m); beyond the ends the nearest.
    fn strip(&self, x: f64) -> u32 {
        let place = (x - self.low) / self.length;
        let place = if self.periodic {
            place.rem_euclid(1.0)
        } else {
            place
        };
        let last = self.count.saturating_sub(1);
        ((place * f64::from(self.count)).floor().max(0.0) as u32).min(last)
    }
}

/// Pieces of the surface of a body.
#[derive(Clone, Debug, PartialEq)]
pub struct Pieces {
    /// Strips along one axis in two dimensions, along two in three.
    pub axes: Vec<PieceAxis>,
}

impl Pieces {
    /// Number of pieces.
    pub fn count(&self) -> u32 {
        self.axes.iter().map(|a| a.count).product()
    }

    /// Returns the area of each piece (m^2; in 2D length times unit depth).
    pub fn area(&self) -> f64 {
        let each = self.axes.iter();
        each.map(|a| a.length / f64::from(a.count)).product()
    }

    /// Returns the half-spaces below the pieces and their neighbours, starting at a first node, for
    /// a material of this diffusivity (m^2/s).
    pub fn columns(&self, first: u32, diffusivity: f64) -> Columns {
        let axis = |a: &PieceAxis| ColumnAxis {
            count: a.count,
            width: a.length / f64::from(a.count),
            periodic: a.periodic,
        };
        Columns {
            nodes: first as usize..(first + self.count()) as usize,
            axes: self.axes.iter().map(axis).collect(),
            diffusivity,
        }
    }

    /// The piece of a place in the axes of the body (m).
    pub fn piece<S: Space>(&self, place: &S::Vector) -> u32 {
        let axes = self.axes.iter();
        axes.fold(0, |index, a| {
            index * a.count + a.strip(place.padded()[a.axis])
        })
    }

    /// Returns the middle of a piece along each of its axes (m), in the axes of the body.
    pub fn middle(&self, piece: u32) -> Vec<f64> {
        let mut left = piece;
        let mut out: Vec<f64> = self
            .axes
            .iter()
            .rev()
            .map(|a| {
                let strip = left % a.count;
                left /= a.count;
                a.low + a.length * (f64::from(strip) + 0.5) / f64::from(a.count)
            })
            .collect();
        out.reverse();
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::space::{Dim2, Dim3};
    use nalgebra::{Vector2, Vector3};

    #[test]
    fn a_place_is_in_the_piece_around_it() {
        let axis = |axis, count, periodic| PieceAxis {
            axis,
            low: -1.0,
            length: 2.0,
            count,
            periodic,
        };
        let line = Pieces {
            axes: vec![axis(0, 4, true)],
        };
        let at = |x: f64| line.piece::<Dim2>(&Vector2::new(x, 7.0));
        assert_eq!(
            [-1.0, -0.6, 0.1, 0.99, 1.1, 3.1].map(at),
            [0, 0, 2, 3, 0, 0]
        );
        let ends = Pieces {
            axes: vec![axis(0, 4, false)],
        };
        assert_eq!(ends.piece::<Dim2>(&Vector2::new(9.0, 0.0)), 3);
        assert_eq!(ends.piece::<Dim2>(&Vector2::new(-9.0, 0.0)), 0);
        let plane = Pieces {
            axes: vec![axis(0, 4, false), axis(2, 3, false)],
        };
        assert_eq!((plane.count(), plane.area()), (12, 0.5 * 2.0 / 3.0));
        for piece in 0..12 {
            let middle = plane.middle(piece);
            let place = Vector3::new(middle[0], 5.0, middle[1]);
            assert_eq!(plane.piece::<Dim3>(&place), piece);
        }
    }
}
