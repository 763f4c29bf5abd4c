//! Convex polygons, as grains and as parts of first bodies.

use super::{Builder, Origin, in_dimension};
use crate::case::{Coordinates, GrainSpec, OnePolygon};
use crate::source::InputError;
use fretwork_core::assembly::{ConvexBody, InitialState, MaterialDensity};
use fretwork_core::geometry::any_shape::AnyPart;
use fretwork_core::geometry::convex::polygon::{Polygon, PolygonError};
use nalgebra::{Vector2, Vector3};

/// Limit on the sides of a regular polygon: a larger number is taken for a typing error.
const MAX_SIDES: usize = 10_000;

impl Builder<'_> {
    /// Adds the grains that are polygons.
    pub(super) fn polygons(&mut self) -> Result<(), InputError> {
        for (k, spec) in self.case.grains.iter().enumerate() {
            let here = format!("grains.{k}");
            match spec {
                GrainSpec::Polygons { material, grains } => {
                    let of = self.material(&format!("{here}.material"), material)?;
                    for (g, grain) in grains.iter().enumerate() {
                        let block = self.one_polygon(&format!("{here}.grains.{g}"), grain)?;
                        self.add_block(block, of, Origin::Grain(k, Some(g)));
                    }
                }
                GrainSpec::Arch { material, .. } => {
                    let of = self.material(&format!("{here}.material"), material)?;
                    for block in self.arch(&here, spec)? {
                        self.add_block(block, of, Origin::Grain(k, None));
                    }
                }
                GrainSpec::Voronoi(spec) => {
                    let of = self.material(&format!("{here}.material"), &spec.material)?;
                    for block in self.voronoi(k, spec)? {
                        self.add_block(block, of, Origin::Grain(k, None));
                    }
                }
                GrainSpec::BlockWall(spec) => {
                    let of = self.material(&format!("{here}.material"), &spec.material)?;
                    for block in self.block_wall(&here, spec)? {
                        self.add_block(block, of, Origin::Grain(k, None));
                    }
                }
                _ => {}
            }
        }
        Ok(())
    }

    pub(super) fn add_block(&mut self, block: ConvexBody, of: MaterialDensity, origin: Origin) {
        self.assembly.add_block(block, of);
        self.origins.push(origin);
    }

    fn one_polygon(&self, here: &str, grain: &OnePolygon) -> Result<ConvexBody, InputError> {
        let at = self.vector(&format!("{here}.at"), &grain.at)?;
        let velocity = self.vector(&format!("{here}.velocity"), &grain.velocity)?;
        let spin = self.spin(&format!("{here}.spin"), &grain.spin)?;
        if !grain.angle.is_finite() {
            return Err(self.fail(format!("{here}.angle"), "must be a finite number"));
        }
        let points: Vec<(f64, f64)> = match grain.regular {
            Some(_) if !grain.points.is_empty() => {
                return Err(self.fail(here, "has both `points` and `regular`; give one of them"));
            }
            Some((sides, radius)) => {
                let path = format!("{here}.regular");
                if !(3..=MAX_SIDES).contains(&sides) {
                    let message =
                        format!("a regular polygon has 3 to {MAX_SIDES} sides, got {sides}");
                    return Err(self.fail(path, message));
                }
                self.radius(&path, radius)?;
                let polygon = Polygon::regular(sides, radius);
                polygon.points().iter().map(|p| (p.x, p.y)).collect()
            }
            None => grain.points.clone(),
        };
        let (s, c) = grain.angle.sin_cos();
        let turned: Vec<(f64, f64)> = points
            .iter()
            .map(|(x, y)| (c * x - s * y, s * x + c * y))
            .collect();
        let part = self.polygon(here, &turned, grain.rounding)?;
        let mut block = ConvexBody::of(part);
        let centre = Vector3::from(block.start.position);
        block.start = InitialState {
            position: (at + centre).into(),
            rotation: None,
            velocity: velocity.into(),
            spin,
        };
        Ok(block)
    }

    /// Makes a convex part from the corners of a polygon (m).
    pub(super) fn polygon(
        &self,
        here: &str,
        points: &[(f64, f64)],
        rounding: f64,
    ) -> Result<AnyPart, InputError> {
        if !(rounding.is_finite() && rounding >= 0.0) {
            let message = format!("must not be negative, got {rounding}");
            return Err(self.fail(format!("{here}.rounding"), message));
        }
        if self.dimension() == 3 {
            let message = "polygons and arches need two dimensions; use polyhedra in three";
            return Err(self.fail(here, message));
        }
        let points = points.iter().map(|p| Vector2::new(p.0, p.1)).collect();
        let bad = |e: PolygonError| self.fail(format!("{here}.points"), e.to_string());
        let polygon = Polygon::new(points).map_err(bad)?;
        Ok(AnyPart::Plane(polygon.part(rounding)))
    }

    /// Makes a capsule.
    pub(super) fn capsule(
        &self,
        here: &str,
        from: &Coordinates,
        to: &Coordinates,
        radius: f64,
    ) -> Result<AnyPart, InputError> {
        self.radius(&format!("{here}.radius"), radius)?;
        let from = self.vector(&format!("{here}.from"), &from.0)?;
        let to = self.vector(&format!("{here}.to"), &to.0)?;
        let length = (to - from).norm();
        if !(length.is_finite() && length > 0.0) {
            let message =
                "the ends of a capsule must be two different points; for a disk use Balls";
            return Err(self.fail(here, message));
        }
        Ok(in_dimension::capsule(self.dimension(), &from, &to, radius))
    }
}
