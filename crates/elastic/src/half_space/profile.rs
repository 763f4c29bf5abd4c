//! The shape of the surface of a half-space without load: heights that are small against what they
//! extend over.

use std::f64::consts::PI;

/// Height above the plane, outward, by the place on it.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Profile {
    /// A plane.
    #[default]
    Flat,
    /// -x^2/(2 R_x) - y^2/(2 R_y): the parabola that stands for a circle of these radii of
    /// curvature (m); an infinite one is straight.
    Paraboloid([f64; 2]),
    /// A wave cos(2 pi x/L), in space cos(2 pi x/L) cos(2 pi y/L_y), of an amplitude (m) and
    /// lengths (m); an infinite length is no wave.
    Wave(f64, [f64; 2]),
    /// The height in the middle of each cell (m).
    Heights(Vec<f64>),
}

impl Profile {
    /// The height of a cell at a place (m).
    pub fn height(&self, cell: usize, [x, y]: [f64; 2]) -> f64 {
        match self {
            Self::Flat => 0.0,
            Self::Paraboloid([along, across]) => -0.5 * (x * x / along + y * y / across),
            Self::Wave(amplitude, [along, across]) => {
                amplitude * (2.0 * PI * x / along).cos() * (2.0 * PI * y / across).cos()
            }
            Self::Heights(heights) => heights[cell],
        }
    }
}
