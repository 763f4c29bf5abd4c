//! Rigid unions: the shapes carried by one body, with their mass properties.

use super::{Builder, Origin, components};
use crate::case::{GrainSpec, ShapeSpec};
use crate::source::{self, InputError, ValidationError};
use fretwork_core::assembly::{AnyUnion, InitialState, MassProperties};
use std::f64::consts::PI;

impl Builder<'_> {
    /// Collects the shapes of a body.
    pub(super) fn union(
        &mut self,
        path: &str,
        shapes: &[ShapeSpec],
    ) -> Result<AnyUnion, InputError> {
        let mut out = AnyUnion::default();
        for (s, shape) in shapes.iter().enumerate() {
            let here = format!("{path}.{s}");
            match shape {
                ShapeSpec::Balls(list) => {
                    for (x, r) in list {
                        let (centre, radius) = (self.vector(&here, x)?, self.radius(&here, *r)?);
                        out.add_ball(centre.into(), radius);
                    }
                }
                ShapeSpec::Cluster { file, name } => {
                    for (centre, radius) in self.cluster_of_file(&here, file, name)? {
                        out.add_ball(centre, radius);
                    }
                }
                ShapeSpec::Plate {
                    radius,
                    hole,
                    balls,
                } => {
                    for (centre, radius) in self.plate(&here, *radius, *hole, *balls)? {
                        out.add_ball(centre, radius);
                    }
                }
                ShapeSpec::Polygon { points, rounding } => {
                    out.add_part(self.polygon(&here, points, *rounding)?);
                }
                ShapeSpec::Capsule { from, to, radius } => {
                    out.add_part(self.capsule(&here, from, to, *radius)?);
                }
                ShapeSpec::Polyhedron { points, rounding } => {
                    let core = self.hull(&here, points)?;
                    out.add_part(self.polyhedron(&here, &core, *rounding)?);
                }
                ShapeSpec::Box {
                    size,
                    at,
                    turned,
                    rounding,
                } => {
                    let core = self.cuboid(&here, *size)?;
                    let core = self.placed(&here, &core, turned)?;
                    let part = self.polyhedron(&here, &core, *rounding)?;
                    let at = self.vector(&format!("{here}.at"), at)?;
                    out.add_part(part.moved(at.into()));
                }
                other => {
                    let (at, surface) = self.surface(&here, other)?;
                    out.add_surface(at.into(), surface);
                }
            }
        }
        if out.is_empty() {
            return Err(self.fail(path, "a body needs at least one shape"));
        }
        Ok(out)
    }

    fn cluster_of_file(
        &mut self,
        here: &str,
        file: &str,
        name: &str,
    ) -> Result<Vec<([f64; 3], f64)>, InputError> {
        let scene = self.scene_file(here, file)?;
        let names = || scene.clusters.iter().map(|c| c.0.as_str());
        let Some(cluster) = scene.clusters.iter().find(|c| c.0 == name) else {
            let message = format!("the scene has no cluster `{name}`");
            let fault = ValidationError::new(format!("{here}.name"), message)
                .expected_name(names(), "clusters in its scene file")
                .nearest(source::nearest(name, names()));
            return Err(self.source.locate(fault));
        };
        let ball = |(x, r): &(Vec<f64>, f64)| (components(x).into(), *r);
        Ok(cluster.1.iter().map(ball).collect())
    }

    /// Returns the balls of a plate with a hole, so close that no grain of their size passes
    /// between them.
    fn plate(
        &self,
        here: &str,
        radius: f64,
        hole: f64,
        ball: f64,
    ) -> Result<Vec<([f64; 3], f64)>, InputError> {
        if self.dimension() == 2 {
            return Err(self.fail(
                here,
                "a plate with a round hole needs three dimensions; use two profiles",
            ));
        }
        let ball = self.radius(&format!("{here}.balls"), ball)?;
        let radius = self.radius(&format!("{here}.radius"), radius)?;
        if !(hole.is_finite() && hole >= 0.0 && hole < 2.0 * radius) {
            let message = format!("a hole is narrower than the plate, got {hole} m");
            return Err(self.fail(format!("{here}.hole"), message));
        }
        if radius / ball > 1000.0 {
            let message = "the plate would take millions of balls; use larger ones";
            return Err(self.fail(format!("{here}.balls"), message));
        }
        let mut balls = Vec::new();
        let mut ring = 0.5 * hole + ball;
        while ring - ball < radius {
            let count = (PI / (ball / ring).min(1.0).asin()).floor().max(1.0);
            for k in 0..count as usize {
                let (sin, cos) = (2.0 * PI * k as f64 / count).sin_cos();
                balls.push(([ring * cos, ring * sin, -ball], ball));
            }
            ring += 2.0 * ball;
        }
        Ok(balls)
    }

    /// Adds the grains that are rigid unions.
    pub(super) fn clusters(&mut self) -> Result<(), InputError> {
        for (k, spec) in self.case.grains.iter().enumerate() {
            let GrainSpec::Clusters { material, grains } = spec else {
                continue;
            };
            let here = format!("grains.{k}");
            let (material, density) = self.material(&format!("{here}.material"), material)?;
            for (g, grain) in grains.iter().enumerate() {
                let here = format!("{here}.grains.{g}");
                let at = self.vector(&format!("{here}.at"), &grain.at)?;
                let velocity = self.vector(&format!("{here}.velocity"), &grain.velocity)?;
                let spin = self.spin(&format!("{here}.spin"), &grain.spin)?;
                let union = self.union(&format!("{here}.shapes"), &grain.shapes)?;
                if union.has_surfaces() {
                    let message = "a grain is made of Balls, Polygon, Capsule, Polyhedron, Box or Cluster; a surface belongs to a first body";
                    return Err(self.fail(format!("{here}.shapes"), message));
                }
                let start = InitialState {
                    position: at.into(),
                    rotation: None,
                    velocity: velocity.into(),
                    spin,
                };
                let mass_properties = MassProperties::Grain(density);
                self.assembly
                    .add_union(union, mass_properties, material, &start);
                self.origins.push(Origin::Grain(k, Some(g)));
            }
        }
        Ok(())
    }
}
