//! Rigid unions: the shapes carried by one body, with their mass properties.

use super::surface::Placed;
use super::{Builder, Origin};
use crate::case::{GrainSpec, ShapeSpec};
use crate::source::{self, InputError, ValidationError};
use fretwork_core::bodies::tensor;
use fretwork_core::geometry::convex::ConvexPart;
use fretwork_core::geometry::shape::{Ball, Carried};
use fretwork_core::geometry::space::{MatrixLike, Space, VectorLike};
use std::f64::consts::PI;

/// Balls, convex parts and surfaces that move together.
pub(super) struct Union<S: Space> {
    balls: Vec<(S::Vector, f64)>,
    parts: Vec<ConvexPart<S>>,
    surfaces: Vec<Placed<S>>,
}

impl<S: Space> Union<S> {
    /// Centre (m), volume (m^3; 2D: m^2) and moments of inertia about it at unit density, of each
    /// shape that has a volume.
    fn volumes(&self) -> impl Iterator<Item = (S::Vector, f64, S::Tensor)> + '_ {
        let ball = |(x, r): &(S::Vector, f64)| {
            let volume = S::ball_volume(*r);
            (
                *x,
                volume,
                S::Tensor::uniform(S::BALL_INERTIA * r * r * volume),
            )
        };
        let parts = self.parts.iter().map(|p| (p.centre, p.volume, p.inertia));
        self.balls.iter().map(ball).chain(parts)
    }

    /// Total volume (m^3; 2D: m^2).
    pub fn volume(&self) -> f64 {
        self.volumes().map(|v| v.1).sum()
    }

    /// Centre of mass (m); the origin if the union has surfaces only, which have no volume.
    pub fn centre(&self) -> S::Vector {
        let (mut centre, volume) = (S::Vector::zero(), self.volume());
        if volume > 0.0 && self.surfaces.is_empty() {
            for (x, v, _) in self.volumes() {
                centre += x * (v / volume);
            }
        }
        centre
    }

    /// Moments of inertia about a point at unit density (m^5; 2D: m^4).
    pub fn inertia(&self, about: &S::Vector) -> S::Tensor {
        self.volumes()
            .fold(S::Tensor::uniform(0.0), |sum, (x, volume, own)| {
                sum + own + S::steiner(&(x - *about)).scaled(volume)
            })
    }

    /// The radius (m), if the union is a single ball.
    pub fn only_ball(&self) -> Option<f64> {
        let alone = self.balls.len() == 1 && self.parts.is_empty() && self.surfaces.is_empty();
        alone.then(|| self.balls[0].1)
    }
}

impl<S: Space> Builder<'_, S> {
    /// Collects the shapes of a body.
    pub(super) fn union(
        &mut self,
        path: &str,
        shapes: &[ShapeSpec],
    ) -> Result<Union<S>, InputError> {
        let mut out = Union::<S> {
            balls: Vec::new(),
            parts: Vec::new(),
            surfaces: Vec::new(),
        };
        for (s, shape) in shapes.iter().enumerate() {
            let here = format!("{path}.{s}");
            match shape {
                ShapeSpec::Balls(list) => {
                    for (x, r) in list {
                        let ball = (self.vector(&here, x)?, self.radius(&here, *r)?);
                        out.balls.push(ball);
                    }
                }
                ShapeSpec::Cluster { file, name } => {
                    out.balls.extend(self.cluster_of_file(&here, file, name)?);
                }
                ShapeSpec::Plate {
                    radius,
                    hole,
                    balls,
                } => out.balls.extend(self.plate(&here, *radius, *hole, *balls)?),
                ShapeSpec::Polygon { points, rounding } => {
                    out.parts.push(self.polygon(&here, points, *rounding)?);
                }
                ShapeSpec::Capsule { from, to, radius } => {
                    out.parts.push(self.capsule(&here, from, to, *radius)?);
                }
                ShapeSpec::Polyhedron { points, rounding } => {
                    let core = self.hull(&here, points)?;
                    out.parts.push(self.polyhedron(&here, &core, *rounding)?);
                }
                ShapeSpec::Box {
                    size,
                    at,
                    turned,
                    rounding,
                } => {
                    let core = self.cuboid(&here, *size)?;
                    let core = self.placed(&here, &core, turned)?;
                    let mut part = self.polyhedron(&here, &core, *rounding)?;
                    part.centre += self.vector(&format!("{here}.at"), at)?;
                    out.parts.push(part);
                }
                other => out.surfaces.push(self.surface(&here, other)?),
            }
        }
        if out.balls.is_empty() && out.parts.is_empty() && out.surfaces.is_empty() {
            return Err(self.fail(path, "a body needs at least one shape"));
        }
        Ok(out)
    }

    fn cluster_of_file(
        &mut self,
        here: &str,
        file: &str,
        name: &str,
    ) -> Result<Vec<(S::Vector, f64)>, InputError> {
        let scene = self.scene_file(here, file)?;
        let names = || scene.clusters.iter().map(|c| c.0.as_str());
        let Some(cluster) = scene.clusters.iter().find(|c| c.0 == name) else {
            let message = format!("the scene has no cluster `{name}`");
            let fault = ValidationError::new(format!("{here}.name"), message)
                .expected_name(names(), "clusters in its scene file")
                .nearest(source::nearest(name, names()));
            return Err(self.source.locate(fault));
        };
        let ball = |(x, r): &(Vec<f64>, f64)| (S::Vector::from_slice(x), *r);
        Ok(cluster.1.iter().map(ball).collect())
    }

    /// Makes the balls of a plate with a hole, so close that no grain of their size passes between
    /// them.
    fn plate(
        &self,
        here: &str,
        radius: f64,
        hole: f64,
        ball: f64,
    ) -> Result<Vec<(S::Vector, f64)>, InputError> {
        if S::D == 2 {
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
                balls.push((
                    S::Vector::from_slice(&[ring * cos, ring * sin, -ball]),
                    ball,
                ));
            }
            ring += 2.0 * ball;
        }
        Ok(balls)
    }

    /// Attaches the shapes to a body whose centre of mass is at `centre` (m).
    pub(super) fn carry(&mut self, union: Union<S>, body: u32, material: u16, centre: &S::Vector) {
        let alone = union.only_ball().is_some();
        let balls = union.balls.into_iter().map(|(x, radius)| Ball {
            body,
            radius,
            offset: if alone {
                S::Vector::zero()
            } else {
                x - *centre
            },
            material,
            area: S::Vector::zero(),
        });
        self.shapes.balls.extend(balls);
        for part in union.parts {
            let offset = part.centre - *centre;
            let piece = part.carried(body, offset, material);
            self.shapes.pieces.push(piece);
        }
        let carried = |(offset, shape)| Carried {
            body,
            offset,
            shape,
            material,
        };
        let surfaces = union.surfaces.into_iter().map(carried);
        self.shapes.surfaces.extend(surfaces);
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
                if !union.surfaces.is_empty() {
                    let message = "a grain is made of Balls, Polygon, Capsule, Polyhedron, Box or Cluster; a surface belongs to a first body";
                    return Err(self.fail(format!("{here}.shapes"), message));
                }
                let (centre, volume) = (union.centre(), union.volume());
                let inertia = union.inertia(&centre);
                let length = match union.only_ball() {
                    Some(radius) => radius,
                    None => (tensor::mean::<S>(&inertia) / volume).sqrt(),
                };
                let (mass, inertia) = (density * volume, inertia.scaled(density));
                let body = self.bodies.add_shaped(at + centre, mass, &inertia, length);
                self.bodies.velocity[body as usize] = velocity;
                self.bodies.spin[body as usize] = spin;
                self.origins.push(Origin::Grain(k, Some(g)));
                self.carry(union, body, material, &centre);
            }
        }
        Ok(())
    }
}
