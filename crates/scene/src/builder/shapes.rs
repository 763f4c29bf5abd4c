//! Shapes of first bodies made in Rust; shapes without a function here are written as variants of
//! [`ShapeSpec`].

use crate::case::{Coordinates, ShapeSpec, Side};

impl ShapeSpec {
    /// Creates a half-space, solid behind a plane with an outward normal, through a point (m).
    pub fn half_space(normal: impl Into<Vec<f64>>, at: impl Into<Vec<f64>>) -> Self {
        Self::HalfSpace {
            normal: normal.into(),
            at: at.into(),
        }
    }

    /// Creates balls that move together, from centres in the body's frame and radii (m).
    pub fn balls<C: Into<Vec<f64>>>(balls: impl IntoIterator<Item = (C, f64)>) -> Self {
        let balls = balls.into_iter();
        Self::Balls(
            balls
                .map(|(centre, radius)| (centre.into(), radius))
                .collect(),
        )
    }

    /// Creates a convex polygon (2D) from its corners (m), anticlockwise.
    pub fn polygon(points: impl Into<Vec<(f64, f64)>>) -> Self {
        Self::Polygon {
            points: points.into(),
            rounding: 0.0,
        }
    }

    /// Creates a profile (2D) from its points (m) from left to right, and the side on which the
    /// solid is.
    pub fn profile(points: impl Into<Vec<(f64, f64)>>, side: Side) -> Self {
        Self::Profile {
            points: points.into(),
            file: None,
            side,
        }
    }

    /// Creates a convex polyhedron (3D) from its corners (m), in any order.
    pub fn polyhedron(points: impl Into<Vec<(f64, f64, f64)>>) -> Self {
        Self::Polyhedron {
            points: points.into(),
            rounding: 0.0,
        }
    }

    /// Creates a cuboid (3D) about the origin of the body's frame, from the lengths of its edges
    /// (m).
    pub fn cuboid(x: f64, y: f64, z: f64) -> Self {
        Self::Box {
            size: (x, y, z),
            at: Vec::new(),
            turned: Vec::new(),
            rounding: 0.0,
        }
    }

    /// Creates a capsule: all points within a radius (m) of the segment between two points (m).
    pub fn capsule(from: impl Into<Vec<f64>>, to: impl Into<Vec<f64>>, radius: f64) -> Self {
        Self::Capsule {
            from: Coordinates(from.into()),
            to: Coordinates(to.into()),
            radius,
        }
    }
}
