//! Shapes of either dimension, for code that makes them from descriptions.

use super::convex::ConvexPart;
use super::drum::Drum;
use super::shape::Surface;
use super::space::{Dim2, Dim3, Space, VectorLike};
use nalgebra::{Vector2, Vector3};
use std::any::Any;

/// A surface of the plane or of space.
#[derive(Debug)]
pub enum AnySurface {
    /// In two dimensions.
    Plane(Box<dyn Surface<Dim2>>),
    /// In three dimensions.
    Space(Box<dyn Surface<Dim3>>),
}

impl AnySurface {
    /// The inside of a drum of a radius (m); `axis` is 0, 1 or 2 in 3D and ignored in 2D.
    pub fn drum(dimension: usize, radius: f64, axis: usize) -> Self {
        match dimension {
            2 => Self::Plane(Box::new(Drum::new(radius, axis))),
            _ => Self::Space(Box::new(Drum::new(radius, axis))),
        }
    }

    /// Returns the surface in dimension `S`; `None` if it has the other dimension.
    pub fn into_dimension<S: Space>(self) -> Option<Box<dyn Surface<S>>> {
        match self {
            Self::Plane(surface) => same(surface),
            Self::Space(surface) => same(surface),
        }
    }
}

/// A convex part of the plane or of space.
#[derive(Clone, Debug)]
pub enum AnyPart {
    /// In two dimensions.
    Plane(ConvexPart<Dim2>),
    /// In three dimensions.
    Space(ConvexPart<Dim3>),
}

impl AnyPart {
    /// Returns the centre of mass (m).
    pub fn centre(&self) -> [f64; 3] {
        match self {
            Self::Plane(part) => part.centre.padded(),
            Self::Space(part) => part.centre.padded(),
        }
    }

    /// Returns the volume including the rounding (m^3; in 2D area times unit depth).
    pub fn volume(&self) -> f64 {
        match self {
            Self::Plane(part) => part.volume,
            Self::Space(part) => part.volume,
        }
    }

    /// The part moved by a vector (m).
    #[must_use]
    pub fn moved(mut self, by: [f64; 3]) -> Self {
        match &mut self {
            Self::Plane(part) => part.centre += <Vector2<f64> as VectorLike>::from_slice(&by),
            Self::Space(part) => part.centre += <Vector3<f64> as VectorLike>::from_slice(&by),
        }
        self
    }

    /// Returns the part in dimension `S`; `None` if it has the other dimension.
    pub fn into_dimension<S: Space>(self) -> Option<ConvexPart<S>> {
        match self {
            Self::Plane(part) => same(part),
            Self::Space(part) => same(part),
        }
    }
}

/// Returns the value as another type that names the same type; `None` if the types differ.
pub(crate) fn same<T: 'static, U: 'static>(value: T) -> Option<U> {
    let mut value = Some(value);
    let value: &mut dyn Any = &mut value;
    value.downcast_mut::<Option<U>>()?.take()
}
