//! Time-dependent gravity.

use crate::bodies::TimeFunction;
use crate::geometry::space::Space;
use serde::{Deserialize, Serialize};

/// Time dependence of gravity.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub enum GravityDrive {
    /// The case's gravity rotated by an angle (rad) about an axis: 0, 1 or 2, by default z, which
    /// is the only axis in 2D. A positive angle turns x towards y (y towards z about x, z towards x
    /// about y).
    Turned {
        /// Angle (rad).
        angle: TimeFunction,
        /// Axis.
        #[serde(default = "axis_z")]
        about: usize,
    },
    /// The case's gravity times a scalar function of time.
    Scaled(TimeFunction),
    /// One function per axis (m/s^2), replacing the case's gravity.
    Axes(Vec<TimeFunction>),
}

fn axis_z() -> usize {
    2
}

impl GravityDrive {
    /// Returns gravity at a time (m/s^2); `base` is the case's gravity.
    pub fn at<S: Space>(&self, base: &S::Vector, t: f64) -> S::Vector {
        let mut g = *base;
        match self {
            Self::Turned { angle, about } => {
                let (i, j) = ((about + 1) % 3, (about + 2) % 3);
                let (sin, cos) = angle.value(t).sin_cos();
                let (x, y) = (base[i], base[j]);
                (g[i], g[j]) = (cos * x - sin * y, sin * x + cos * y);
            }
            Self::Scaled(f) => g = g * f.value(t),
            Self::Axes(functions) => {
                for (k, f) in functions.iter().enumerate().take(S::D) {
                    g[k] = f.value(t);
                }
            }
        }
        g
    }

    /// Returns the same drive with a delay of `by` seconds.
    pub fn delayed(&self, by: f64) -> Self {
        match self {
            Self::Turned { angle, about } => Self::Turned {
                angle: angle.delayed(by),
                about: *about,
            },
            Self::Scaled(f) => Self::Scaled(f.delayed(by)),
            Self::Axes(list) => Self::Axes(list.iter().map(|f| f.delayed(by)).collect()),
        }
    }

    /// Returns the error of this drive in a case of the given dimension, if any, with the key at
    /// which it occurs.
    pub fn error(&self, dimension: usize) -> Option<(String, String)> {
        match self {
            Self::Turned { angle, about } => {
                let known = if dimension == 2 {
                    *about == 2
                } else {
                    *about < 3
                };
                if !known {
                    let axes = if dimension == 2 { "2" } else { "0, 1 or 2" };
                    let message = format!("gravity cannot turn about axis {about}; use {axes}");
                    return Some(("about".into(), message));
                }
                angle.error().map(|f| ("angle".into(), f))
            }
            Self::Scaled(f) => f.error().map(|f| (String::new(), f)),
            Self::Axes(list) if list.len() != dimension => {
                let message = format!(
                    "{} functions in a case of dimension {dimension}; give one function per axis",
                    list.len()
                );
                Some((String::new(), message))
            }
            Self::Axes(list) => list
                .iter()
                .find_map(|f| f.error().map(|f| (String::new(), f))),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::space::{Dim2, Dim3};
    use nalgebra::{Vector2, Vector3};
    use std::f64::consts::FRAC_PI_2;

    #[test]
    fn a_turned_gravity_keeps_its_magnitude() {
        let quarter = |about| GravityDrive::Turned {
            angle: TimeFunction::Ramp {
                from: 0.0,
                to: FRAC_PI_2,
                start: 0.0,
                end: 1.0,
            },
            about,
        };
        let down = Vector2::new(0.0, -9.81);
        let g = quarter(2).at::<Dim2>(&down, 1.0);
        assert!((g - Vector2::new(9.81, 0.0)).norm() < 1e-14);
        let g = quarter(2).at::<Dim2>(&down, 1.0 / 3.0);
        assert!((g - Vector2::new(9.81 * 0.5, -9.81 * 0.75f64.sqrt())).norm() < 1e-14);
        let down = Vector3::new(0.0, 0.0, -2.0);
        let about_y = quarter(1).delayed(5.0).at::<Dim3>(&down, 6.0);
        assert!((about_y - Vector3::new(-2.0, 0.0, 0.0)).norm() < 1e-14);
        assert!(quarter(1).error(2).is_some() && quarter(1).error(3).is_none());
    }
}
