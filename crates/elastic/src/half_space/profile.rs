//! The shape of the surface of a half-space without load: heights that are small compared with
//! their lateral extent.

use std::f64::consts::PI;

/// Outward height above the plane, as a function of the position on it.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Profile {
    /// A plane.
    #[default]
    Flat,
    /// -x^2/(2 R_x) - y^2/(2 R_y): the parabola that approximates circles of these radii of
    /// curvature (m); an infinite radius is straight.
    Paraboloid([f64; 2]),
    /// A wave cos(2 pi x/L), in space cos(2 pi x/L) cos(2 pi y/L_y), with an amplitude (m) and
    /// lengths (m); an infinite length is a factor of 1.
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
