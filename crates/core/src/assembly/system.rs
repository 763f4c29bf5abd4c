//! Dynamical systems of either dimension.

use crate::bodies::{Contactor, DynamicalSystem};
use crate::geometry::space::{Dim2, Dim3};

/// A dynamical system of the plane or of space.
#[derive(Debug)]
pub enum AnySystem {
    /// In two dimensions.
    Plane(Box<dyn DynamicalSystem<Dim2>>),
    /// In three dimensions.
    Space(Box<dyn DynamicalSystem<Dim3>>),
}

impl AnySystem {
    /// Name of the system.
    pub fn name(&self) -> &str {
        match self {
            Self::Plane(system) => system.name(),
            Self::Space(system) => system.name(),
        }
    }

    /// Parts of the system that can touch.
    pub fn contactors(&self) -> Vec<Contactor> {
        match self {
            Self::Plane(system) => system.contactors(),
            Self::Space(system) => system.contactors(),
        }
    }
}
