//! What first bodies are made of.

use serde::Deserialize;

/// On which side of a profile the solid is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
pub enum Side {
    /// Solid below, open above: a rail.
    Below,
    /// Solid above, open below: a wheel.
    Above,
}

/// A part of a first body.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum ShapeSpec {
    /// Solid behind a plane; `at` is a point of it (m), `normal` points to the open side.
    HalfSpace {
        /// Outward normal.
        normal: Vec<f64>,
        /// A point of the plane.
        #[serde(default)]
        at: Vec<f64>,
    },
    /// A profile by its points, left to right (2D).
    Profile {
        /// Points (m).
        points: Vec<(f64, f64)>,
        /// Where the solid is.
        side: Side,
    },
    /// A self-affine rough profile over the period of x (2D): random phases, spectrum |q|^(-1-2H).
    RoughProfile {
        /// Points along the period.
        points: usize,
        /// Root-mean-square height (m).
        rms: f64,
        /// Hurst exponent.
        #[serde(default = "hurst")]
        hurst: f64,
        /// Longest wavelength (m); the period by default.
        #[serde(default)]
        longest: Option<f64>,
        /// Shortest wavelength (m).
        shortest: f64,
        /// Mean height (m).
        #[serde(default)]
        height: f64,
        /// Where the solid is.
        side: Side,
    },
    /// A convex polygon with rounded corners (2D).
    Polygon {
        /// Corners (m), against the clock.
        points: Vec<(f64, f64)>,
        /// Radius of the rounding about it (m).
        #[serde(default)]
        rounding: f64,
    },
    /// All that is within a radius of a segment (2D).
    Capsule {
        /// One end of the segment (m).
        from: (f64, f64),
        /// The other end (m).
        to: (f64, f64),
        /// Radius (m).
        radius: f64,
    },
    /// Balls fixed to the body: (position relative to the body's frame, radius).
    Balls(Vec<(Vec<f64>, f64)>),
    /// A level plate of balls in rings about the z axis, with a round hole (3D): the balls touch z = 0 from below.
    Plate {
        /// Radius of the plate (m).
        radius: f64,
        /// Diameter of the hole (m).
        hole: f64,
        /// Radius of the balls (m).
        balls: f64,
    },
    /// The inside of a cylinder about the body's origin, solid outside: a drum.
    Drum {
        /// Radius (m).
        radius: f64,
        /// Axis of the cylinder in 3D: 0, 1 or 2.
        #[serde(default)]
        axis: usize,
    },
    /// The cluster of this name in a scene file.
    Cluster {
        /// Path relative to the case.
        file: String,
        /// Name in the file.
        name: String,
    },
    /// Heights over a regular grid (3D), solid below; periodic where the cell is.
    HeightField {
        /// Points along x and y.
        points: (usize, usize),
        /// Spacing (m).
        spacing: (f64, f64),
        /// Heights (m), row by row; or none with `rms`.
        #[serde(default)]
        heights: Vec<f64>,
        /// Root-mean-square of random heights (m).
        #[serde(default)]
        rms: Option<f64>,
    },
}

fn hurst() -> f64 {
    0.8
}
