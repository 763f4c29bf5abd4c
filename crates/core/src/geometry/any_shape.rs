//! Shapes of either dimension, for what makes them from descriptions.

use super::convex::ConvexPart;
use super::shape::Surface;
use super::space::{Dim2, Dim3, Space};
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
    /// The surface in dimension `S`; `None` if it has the other.
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
    /// The part in dimension `S`; `None` if it has the other.
    pub fn into_dimension<S: Space>(self) -> Option<ConvexPart<S>> {
        match self {
            Self::Plane(part) => same(part),
            Self::Space(part) => same(part),
        }
    }
}

/// The value under another name of its type; `None` if that is another type.
fn same<T: 'static, U: 'static>(value: T) -> Option<U> {
    let mut value = Some(value);
    let value: &mut dyn Any = &mut value;
    value.downcast_mut::<Option<U>>()?.take()
}
