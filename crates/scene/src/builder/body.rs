//! First bodies made in Rust.

use crate::case::{BodySpec, DofSpec, ShapeSpec, WearSpec};
use fretwork_core::bodies::Dof;

macro_rules! drives {
    ($($axis:ident $what:literal)*) => {
        impl BodySpec {
            $(
                #[doc = concat!("How it moves ", $what, "; fixed by default.")]
                #[must_use]
                pub fn $axis(mut self, drive: Dof) -> Self {
                    self.dofs.$axis = drive;
                    self
                }
            )*
        }
    };
}

drives! {
    x "along x"
    y "along y"
    z "along z (3D)"
    rx "about x (3D)"
    ry "about y (3D)"
    rz "about z (the only rotation in 2D)"
}

impl BodySpec {
    /// Creates a first body at the origin that does not move, of one shape; more shapes by
    /// [`BodySpec::shape`].
    ///
    /// # Examples
    /// ```
    /// use fretwork_core::bodies::{Dof, TimeFunction};
    /// use fretwork_scene::case::{BodySpec, ShapeSpec};
    ///
    /// // A slider of 2 kg that is pulled at 0.1 m/s and pressed down with 5 N.
    /// let slider = BodySpec::new("slider", "steel", ShapeSpec::balls([([0.0, 0.0], 0.01), ([0.05, 0.0], 0.01)]))
    ///     .position([0.0, 0.01])
    ///     .mass(2.0)
    ///     .x(Dof::Velocity(TimeFunction::Constant(0.1)))
    ///     .y(Dof::Force(TimeFunction::Constant(-5.0)));
    /// assert_eq!(slider.dofs.rz, Dof::Fixed);
    /// ```
    pub fn new(name: impl Into<String>, material: impl Into<String>, shape: ShapeSpec) -> Self {
        Self {
            name: name.into(),
            material: material.into(),
            shapes: vec![shape],
            position: Vec::new(),
            mass: None,
            inertia: None,
            vanishes: None,
            wears: None,
            dofs: DofSpec::default(),
        }
    }

    /// Adds a shape.
    #[must_use]
    pub fn shape(mut self, shape: ShapeSpec) -> Self {
        self.shapes.push(shape);
        self
    }

    /// Sets the position of the frame (m).
    #[must_use]
    pub fn position(mut self, position: impl Into<Vec<f64>>) -> Self {
        self.position = position.into();
        self
    }

    /// Sets the mass (kg; 2D kg/m), which replaces that from density and volume.
    #[must_use]
    pub fn mass(mut self, mass: f64) -> Self {
        self.mass = Some(mass);
        self
    }

    /// Sets the moment of inertia (kg m^2; 2D kg m), which replaces that from density and shape.
    #[must_use]
    pub fn inertia(mut self, inertia: f64) -> Self {
        self.inertia = Some(inertia);
        self
    }

    /// Lets the surfaces of the body recede as they wear, down to a thickness (m) at which the run
    /// stops.
    #[must_use]
    pub fn wears(mut self, thickness: f64) -> Self {
        self.wears = Some(WearSpec {
            thickness,
            every: 1,
        });
        self
    }

    /// Lets the body move freely: every degree of freedom follows contacts, gravity and inertia.
    #[must_use]
    pub fn free(mut self) -> Self {
        self.dofs = DofSpec {
            x: Dof::Free,
            y: Dof::Free,
            z: Dof::Free,
            rx: Dof::Free,
            ry: Dof::Free,
            rz: Dof::Free,
        };
        self
    }
}
