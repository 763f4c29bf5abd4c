//! Shapes of first bodies.

use schemars::JsonSchema;
use serde::ser::SerializeTuple;
use serde::{Deserialize, Serialize};

/// Side of a profile on which the solid is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
pub enum Side {
    /// Solid below, open above: a rail.
    Below,
    /// Solid above, open below: a wheel.
    Above,
}

/// A profile of a standard.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
pub enum StandardName {
    /// Wheel, EN 13715: S1002, flange 28 mm high and 32.5 mm thick.
    S1002,
    /// Rail head, EN 13674-1: 60E1, formerly UIC 60.
    Rail60E1,
}

/// A part of a first body.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum ShapeSpec {
    /// Half-space, solid behind the plane through `at` (m); `normal` points to the open side.
    HalfSpace {
        /// Outward normal.
        normal: Vec<f64>,
        /// A point of the plane.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        at: Vec<f64>,
    },
    /// A profile given by its points, left to right (2D).
    Profile {
        /// Points (m).
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        points: Vec<(f64, f64)>,
        /// A table of the points with the columns `x` and `z`, instead of `points`: a path relative
        /// to the case.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        file: Option<String>,
        /// Side of the solid.
        side: Side,
    },
    /// A standard profile (2D), see [`crate::standard`].
    StandardProfile {
        /// Name of the profile.
        name: StandardName,
        /// Longest segment (m).
        #[serde(default = "half_millimetre")]
        spacing: f64,
        /// Start of the section along the standard's lateral axis (m); the whole profile by
        /// default.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        from: Option<f64>,
        /// End of the section (m).
        #[serde(default, skip_serializing_if = "Option::is_none")]
        to: Option<f64>,
        /// Inclination 1:n, given by n (rail); upright by default.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        inclination: Option<f64>,
        /// Side of the solid; by default above for a wheel, below for a rail.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        side: Option<Side>,
    },
    /// A periodic, self-affine rough profile over the period of x (2D): random phases, spectrum
    /// |q|^(-1-2H).
    RoughProfile {
        /// Number of points along the period.
        points: usize,
        /// Root-mean-square height (m).
        rms: f64,
        /// Hurst exponent.
        #[serde(default = "hurst")]
        hurst: f64,
        /// Longest wavelength (m); the period by default.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        longest: Option<f64>,
        /// Shortest wavelength (m).
        shortest: f64,
        /// Mean height (m).
        #[serde(default)]
        height: f64,
        /// Side of the solid.
        side: Side,
    },
    /// A convex polygon with rounded corners (2D).
    Polygon {
        /// Corners (m), counter-clockwise.
        points: Vec<(f64, f64)>,
        /// Rounding radius of the corners (m).
        #[serde(default)]
        rounding: f64,
    },
    /// Capsule: all points within a radius of a segment.
    Capsule {
        /// One end of the segment (m).
        from: Coordinates,
        /// The other end (m).
        to: Coordinates,
        /// Radius (m).
        radius: f64,
    },
    /// A convex polyhedron with rounded edges (3D).
    Polyhedron {
        /// Corners (m), in any order.
        points: Vec<(f64, f64, f64)>,
        /// Rounding radius of the edges (m).
        #[serde(default)]
        rounding: f64,
    },
    /// A cuboid with rounded edges (3D).
    Box {
        /// Edge lengths (m).
        size: (f64, f64, f64),
        /// Centre of the shape (m).
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        at: Vec<f64>,
        /// Rotation vector (rad) about its centre.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        turned: Vec<f64>,
        /// Rounding radius of the edges (m).
        #[serde(default)]
        rounding: f64,
    },
    /// A surface of triangles from an STL or OBJ file (3D), with the solid behind it.
    Mesh {
        /// Path relative to the case.
        file: String,
        /// Factor on the lengths in the file.
        #[serde(default = "one")]
        scale: f64,
        /// Position of the origin of the file (m).
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        at: Vec<f64>,
    },
    /// Balls fixed to the body: (position in the body's frame, radius), in m.
    Balls(Vec<(Vec<f64>, f64)>),
    /// A horizontal plate of balls in rings about the z axis, with a round hole (3D): the balls
    /// touch z = 0 from below.
    Plate {
        /// Radius of the plate (m).
        radius: f64,
        /// Diameter of the hole (m).
        hole: f64,
        /// Radius of the balls (m).
        balls: f64,
    },
    /// Drum: the inside of a cylinder about the body's origin, with the solid outside.
    Drum {
        /// Radius (m).
        radius: f64,
        /// Axis of the cylinder in 3D: 0, 1 or 2.
        #[serde(default)]
        axis: usize,
    },
    /// A cluster of a scene file.
    Cluster {
        /// Path relative to the case.
        file: String,
        /// Name of the cluster in the file.
        name: String,
    },
    /// Heights over a regular grid (3D), solid below; periodic if the cell is periodic.
    HeightField {
        /// Number of points along x and y.
        points: (usize, usize),
        /// Spacing (m).
        spacing: (f64, f64),
        /// Heights (m), row by row; omitted with `rms`.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        heights: Vec<f64>,
        /// Root-mean-square of random heights (m).
        #[serde(default, skip_serializing_if = "Option::is_none")]
        rms: Option<f64>,
    },
}

fn half_millimetre() -> f64 {
    5e-4
}

fn one() -> f64 {
    1.0
}

/// A point given by its coordinates (m), (x, y) or (x, y, z).
#[derive(Clone, Debug, PartialEq)]
pub struct Coordinates(pub Vec<f64>);

impl Serialize for Coordinates {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut tuple = serializer.serialize_tuple(self.0.len())?;
        for x in &self.0 {
            tuple.serialize_element(x)?;
        }
        tuple.end()
    }
}

impl<'de> Deserialize<'de> for Coordinates {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Numbers;
        impl<'de> serde::de::Visitor<'de> for Numbers {
            type Value = Coordinates;
            fn expecting(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
                f.write_str("coordinates, (x, y) or (x, y, z)")
            }
            fn visit_seq<A: serde::de::SeqAccess<'de>>(
                self,
                mut from: A,
            ) -> Result<Coordinates, A::Error> {
                let mut out = Vec::new();
                while let Some(x) = from.next_element()? {
                    out.push(x);
                }
                Ok(Coordinates(out))
            }
        }
        deserializer.deserialize_any(Numbers)
    }
}

fn hurst() -> f64 {
    0.8
}
