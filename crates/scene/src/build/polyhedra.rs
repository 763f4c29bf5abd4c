//! Convex polyhedra, as grains and as parts of bodies, and meshes from files.

use super::{Builder, Origin, in_dimension};
use crate::case::{GrainSpec, OnePolyhedron};
use crate::mesh_file;
use crate::source::InputError;
use fretwork_core::assembly::{ConvexBody, InitialState};
use fretwork_core::geometry::any_shape::AnyPart;
use fretwork_core::geometry::convex::polyhedron::Polyhedron;
use nalgebra::{UnitQuaternion, Vector3};

type V = Vector3<f64>;

impl Builder<'_> {
    /// Adds the grains that are polyhedra.
    pub(super) fn polyhedra(&mut self) -> Result<(), InputError> {
        for (k, spec) in self.case.grains.iter().enumerate() {
            let GrainSpec::Polyhedra { material, grains } = spec else {
                continue;
            };
            let here = format!("grains.{k}");
            let of = self.material(&format!("{here}.material"), material)?;
            for (g, grain) in grains.iter().enumerate() {
                let block = self.one_polyhedron(&format!("{here}.grains.{g}"), grain)?;
                self.add_block(block, of, Origin::Grain(k, Some(g)));
            }
        }
        Ok(())
    }

    fn one_polyhedron(&self, here: &str, grain: &OnePolyhedron) -> Result<ConvexBody, InputError> {
        let at = self.vector(&format!("{here}.at"), &grain.at)?;
        let given = [
            !grain.points.is_empty(),
            grain.size.is_some(),
            grain.file.is_some(),
        ];
        if given.iter().filter(|g| **g).count() != 1 {
            let message = "a polyhedron needs one of `points`, `size` (a cuboid) and `file`";
            return Err(self.fail(here, message));
        }
        let core = match (&grain.size, &grain.file) {
            (Some(size), _) => self.cuboid(here, *size)?,
            (_, Some(file)) => {
                let (points, _) = self.mesh_file(here, file, grain.scale)?;
                let hull = Polyhedron::hull(&points);
                hull.map_err(|e| self.fail(format!("{here}.file"), e.to_string()))?
            }
            _ => self.hull(here, &grain.points)?,
        };
        let core = self.placed(here, &core, &grain.turned)?;
        let part = self.polyhedron(here, &core, grain.rounding)?;
        let mut block = ConvexBody::of(part);
        block.start = InitialState {
            position: (at + V::from(block.start.position)).into(),
            rotation: None,
            velocity: self
                .vector(&format!("{here}.velocity"), &grain.velocity)?
                .into(),
            spin: self.spin(&format!("{here}.spin"), &grain.spin)?,
        };
        Ok(block)
    }

    /// Makes the convex hull of points (m).
    pub(super) fn hull(
        &self,
        here: &str,
        points: &[(f64, f64, f64)],
    ) -> Result<Polyhedron, InputError> {
        let points: Vec<V> = points.iter().map(|p| V::new(p.0, p.1, p.2)).collect();
        let bad = |e: String| self.fail(format!("{here}.points"), e);
        Polyhedron::new(&points).map_err(|e| bad(e.to_string()))
    }

    /// Creates a cuboid about the origin from the lengths of its edges (m).
    pub(super) fn cuboid(
        &self,
        here: &str,
        size: (f64, f64, f64),
    ) -> Result<Polyhedron, InputError> {
        let size = [size.0, size.1, size.2];
        if size.iter().all(|s| s.is_finite() && *s > 0.0) {
            return Ok(Polyhedron::cuboid(size));
        }
        let message = format!("the edges of a cuboid must be positive, got {size:?}");
        Err(self.fail(format!("{here}.size"), message))
    }

    /// Rotates a polyhedron about its origin by a rotation vector (rad).
    pub(super) fn placed(
        &self,
        here: &str,
        core: &Polyhedron,
        turned: &[f64],
    ) -> Result<Polyhedron, InputError> {
        use fretwork_core::geometry::convex::Core;
        let turned = self.vector(&format!("{here}.turned"), turned)?;
        Ok(core.turned(&UnitQuaternion::from_scaled_axis(turned)))
    }

    /// Makes a convex part with rounded edges.
    pub(super) fn polyhedron(
        &self,
        here: &str,
        core: &Polyhedron,
        rounding: f64,
    ) -> Result<AnyPart, InputError> {
        if !(rounding.is_finite() && rounding >= 0.0) {
            let message = format!("must not be negative, got {rounding}");
            return Err(self.fail(format!("{here}.rounding"), message));
        }
        in_dimension::polyhedron(self.dimension(), core, rounding).map_err(|e| self.fail(here, e))
    }

    /// Reads the points (m) and triangles of a mesh file, given by a path relative to the case.
    pub(super) fn mesh_file(
        &self,
        here: &str,
        file: &str,
        scale: f64,
    ) -> Result<(Vec<V>, Vec<[u32; 3]>), InputError> {
        if !(scale.is_finite() && scale > 0.0) {
            let message = format!("must be positive, got {scale}");
            return Err(self.fail(format!("{here}.scale"), message));
        }
        let read = mesh_file::read(&self.folder.join(file));
        let (mut points, triangles) = read.map_err(|e| self.fail(format!("{here}.file"), e))?;
        points.iter_mut().for_each(|p| *p *= scale);
        Ok((points, triangles))
    }
}
