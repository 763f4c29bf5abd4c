//! First bodies: balls, convex parts and surfaces that move together, driven or free.

use super::{Builder, Origin};
use crate::case::{BodySpec, ShapeSpec};
use crate::source::InputError;
use fretwork_core::assembly::{Inertia, InitialState, MassProperties};
use fretwork_core::bodies::Driven;

impl Builder<'_> {
    pub(super) fn first_bodies(&mut self) -> Result<(), InputError> {
        for (k, spec) in self.case.bodies.iter().enumerate() {
            self.first_body(&format!("bodies.{k}"), spec)?;
            self.origins.push(Origin::Body(k));
        }
        Ok(())
    }

    fn first_body(&mut self, here: &str, spec: &BodySpec) -> Result<(), InputError> {
        let (material, density) = self.material(&format!("{here}.material"), &spec.material)?;
        let position = self.vector(&format!("{here}.position"), &spec.position)?;
        let union = self.union(&format!("{here}.shapes"), &spec.shapes)?;
        let volume = union.volume(self.dimension());
        let dofs = spec.ordered(self.dimension());
        self.check_dofs(here, spec, volume > 0.0)?;
        self.check_periods(here, spec)?;
        let mass = spec
            .mass
            .unwrap_or(if volume > 0.0 { density * volume } else { 1.0 });
        let inertia = match spec.inertia {
            Some(inertia) => Inertia::Uniform(inertia),
            // If a drive imposes its rotation at any time, the body has one scalar inertia
            // throughout, so that its energy does not jump when the drive ends.
            None if volume > 0.0 && self.turned_by_drives(spec) => Inertia::Mean(density),
            None if volume > 0.0 => Inertia::OfShapes(density),
            None => Inertia::Uniform(1.0),
        };
        let start = InitialState {
            position: position.into(),
            ..InitialState::default()
        };
        let first = self.assembly.surface_count();
        let mass_properties = MassProperties::First(mass, inertia);
        let body = self
            .assembly
            .add_union(union, mass_properties, material, &start);
        self.assembly.drive(Driven {
            name: spec.name.clone(),
            body,
            dofs,
        });
        self.wears(here, spec, first)
    }

    /// Rejects half-spaces that are not parallel to a periodic axis. A half-space normal to the
    /// axis is accepted: it is a wall of a case that became periodic by `--set`, and is removed.
    fn check_periods(&self, here: &str, spec: &BodySpec) -> Result<(), InputError> {
        let periods = self.assembly.periodic().period;
        for (k, shape) in spec.shapes.iter().enumerate() {
            let ShapeSpec::HalfSpace { normal, .. } = shape else {
                continue;
            };
            let cut = (0..self.dimension()).find(|a| periods[*a].is_some() && normal[*a] != 0.0);
            if let (Some(axis), None) = (cut, spec.vanishes) {
                let axis = ["x", "y", "z"][axis];
                let message = format!(
                    "a half-space must run along a period, and this one cuts across {axis}; give its normal no part along \
                     {axis}, or take `periodic` away"
                );
                return Err(self.fail(format!("{here}.shapes.{k}.normal"), message));
            }
        }
        Ok(())
    }

    /// Whether a rotation of the body is imposed at some time.
    fn turned_by_drives(&self, spec: &BodySpec) -> bool {
        let drives = crate::phases::drives_of(self.case, spec);
        drives
            .iter()
            .any(|d| d.0 >= self.dimension() && d.1.imposes())
    }

    fn check_dofs(&self, here: &str, spec: &BodySpec, has_mass: bool) -> Result<(), InputError> {
        let drives = crate::phases::drives_of(self.case, spec);
        let moves = fretwork_core::bodies::Dof::yields;
        if drives.iter().any(|d| moves(&d.1)) && spec.mass.is_none() && !has_mass {
            return Err(self.fail(
                here,
                format!(
                    "the body `{}` moves under forces, so it needs a `mass`",
                    spec.name
                ),
            ));
        }
        if drives
            .iter()
            .any(|d| d.0 >= self.dimension() && moves(&d.1))
        {
            let all = |d: usize| drives.iter().filter(|x| x.0 == d).all(|x| moves(&x.1));
            let named = |d: usize| drives.iter().any(|x| x.0 == d);
            if self.dimension() == 3 && !(3..6).all(|d| named(d) && all(d)) {
                return Err(self.fail(format!("{here}.dofs"), "in three dimensions a body turns freely about all axes or about none; free rx, ry and rz, or fix or drive all three"));
            }
            if spec.inertia.is_none() && !has_mass {
                return Err(self.fail(
                    here,
                    format!(
                        "the body `{}` turns under moments, so it needs an `inertia`",
                        spec.name
                    ),
                ));
            }
        }
        Ok(())
    }
}
