//! Grains made in Rust; kinds without a function here are written as variants of [`GrainSpec`].

use crate::case::{GrainSpec, OneGrain, OnePolygon, OnePolyhedron};

impl GrainSpec {
    /// Creates balls, one by one.
    pub fn balls(material: impl Into<String>, grains: impl IntoIterator<Item = OneGrain>) -> Self {
        Self::List {
            material: material.into(),
            grains: grains.into_iter().collect(),
        }
    }

    /// Creates a hexagonal (2D) or cubic (3D) lattice that fills a box from its low corner (m) up:
    /// at most `count` balls, with radii (m) distributed uniformly between two values.
    pub fn lattice(
        material: impl Into<String>,
        count: usize,
        radius: (f64, f64),
        low: impl Into<Vec<f64>>,
        high: impl Into<Vec<f64>>,
    ) -> Self {
        Self::Lattice {
            material: material.into(),
            count,
            radius,
            low: low.into(),
            high: high.into(),
        }
    }

    /// Creates convex polygons, one by one (2D).
    pub fn polygons(
        material: impl Into<String>,
        grains: impl IntoIterator<Item = OnePolygon>,
    ) -> Self {
        Self::Polygons {
            material: material.into(),
            grains: grains.into_iter().collect(),
        }
    }

    /// Creates convex polyhedra, one by one (3D).
    pub fn polyhedra(
        material: impl Into<String>,
        grains: impl IntoIterator<Item = OnePolyhedron>,
    ) -> Self {
        Self::Polyhedra {
            material: material.into(),
            grains: grains.into_iter().collect(),
        }
    }
}

impl OneGrain {
    /// A ball at rest: centre and radius (m).
    pub fn new(at: impl Into<Vec<f64>>, radius: f64) -> Self {
        Self {
            at: at.into(),
            radius,
            velocity: Vec::new(),
            spin: Vec::new(),
        }
    }

    /// Sets the velocity (m/s).
    #[must_use]
    pub fn velocity(mut self, velocity: impl Into<Vec<f64>>) -> Self {
        self.velocity = velocity.into();
        self
    }

    /// Sets the angular velocity (rad/s): one number in 2D, three in 3D.
    #[must_use]
    pub fn spin(mut self, spin: impl Into<Vec<f64>>) -> Self {
        self.spin = spin.into();
        self
    }
}

impl OnePolygon {
    /// Creates a polygon at rest from its corners (m), anticlockwise, relative to a position (m).
    pub fn new(at: impl Into<Vec<f64>>, points: impl Into<Vec<(f64, f64)>>) -> Self {
        Self {
            at: at.into(),
            points: points.into(),
            regular: None,
            rounding: 0.0,
            angle: 0.0,
            velocity: Vec::new(),
            spin: Vec::new(),
        }
    }

    /// Creates a regular polygon at rest from its number of sides and circumscribed radius (m).
    pub fn regular(at: impl Into<Vec<f64>>, sides: usize, radius: f64) -> Self {
        Self {
            regular: Some((sides, radius)),
            ..Self::new(at, Vec::new())
        }
    }
}

impl OnePolyhedron {
    /// Creates a polyhedron at rest, the hull of its corners (m) relative to a position (m).
    pub fn new(at: impl Into<Vec<f64>>, points: impl Into<Vec<(f64, f64, f64)>>) -> Self {
        Self {
            at: at.into(),
            points: points.into(),
            size: None,
            file: None,
            scale: 1.0,
            turned: Vec::new(),
            rounding: 0.0,
            velocity: Vec::new(),
            spin: Vec::new(),
        }
    }

    /// Creates a cuboid at rest from its centre and the lengths of its edges (m).
    pub fn cuboid(at: impl Into<Vec<f64>>, size: (f64, f64, f64)) -> Self {
        Self {
            size: Some(size),
            ..Self::new(at, Vec::new())
        }
    }
}
