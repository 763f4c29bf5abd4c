//! First bodies: balls, convex pieces and surfaces that move together, driven or free.

use super::surface::Placed;
use super::{Builder, Dimensional, Origin};
use crate::bodies::Driven;
use crate::geometry::convex::Part;
use crate::geometry::shape::{Ball, Carried};
use crate::geometry::space::VectorLike;
use crate::scene::case::{BodySpec, ShapeSpec};
use crate::scene::source::{self, Fault, InputError};
use std::f64::consts::PI;

impl<S: Dimensional> Builder<'_, S> {
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
        let mut balls: Vec<(S::Vector, f64)> = Vec::new();
        let mut parts: Vec<Part<S>> = Vec::new();
        let mut surfaces: Vec<Placed<S>> = Vec::new();
        for (s, shape) in spec.shapes.iter().enumerate() {
            let here = format!("{here}.shapes.{s}");
            match shape {
                ShapeSpec::Balls(list) => {
                    for (x, r) in list {
                        balls.push((self.vector(&here, x)?, self.radius(&here, *r)?));
                    }
                }
                ShapeSpec::Plate {
                    radius,
                    hole,
                    balls: ball,
                } => balls.extend(self.plate(&here, *radius, *hole, *ball)?),
                ShapeSpec::Cluster { file, name } => {
                    let scene = self.scene_file(file)?;
                    let cluster = scene.clusters.iter().find(|c| c.0 == *name);
                    let names = || scene.clusters.iter().map(|c| c.0.as_str());
                    let Some(cluster) = cluster else {
                        return Err(self.source.locate(
                            Fault::new(
                                format!("{here}.name"),
                                format!("the scene has no cluster `{name}`"),
                            )
                            .expected(format!("one of {}", names().collect::<Vec<_>>().join(", ")))
                            .nearest(source::nearest(name, names())),
                        ));
                    };
                    balls.extend(
                        cluster
                            .1
                            .iter()
                            .map(|(x, r)| (S::Vector::from_slice(x), *r)),
                    );
                }
                ShapeSpec::Polygon { points, rounding } => {
                    parts.push(self.polygon(&here, points, *rounding)?);
                }
                ShapeSpec::Capsule { from, to, radius } => {
                    parts.push(self.capsule(&here, *from, *to, *radius)?);
                }
                other => surfaces.push(self.surface(&here, other)?),
            }
        }
        if balls.is_empty() && parts.is_empty() && surfaces.is_empty() {
            return Err(self.fail(
                format!("{here}.shapes"),
                "a first body needs at least one shape",
            ));
        }
        // A body made of balls and convex pieces has its frame at their centre of mass.
        let volumes = || {
            let balls = balls.iter().map(|(x, r)| {
                let volume = S::ball_volume(*r);
                (*x, volume, S::BALL_INERTIA * r * r * volume)
            });
            balls.chain(parts.iter().map(|p| (p.centre, p.volume, p.inertia)))
        };
        let weight: f64 = volumes().map(|v| v.1).sum();
        let mut centre = S::Vector::null();
        if weight > 0.0 && surfaces.is_empty() {
            for (x, volume, _) in volumes() {
                centre += x * (volume / weight);
            }
        }
        let inertia: f64 = volumes()
            .map(|(x, volume, own)| {
                let d = x - centre;
                density * (own + volume * d.dot(&d))
            })
            .sum();
        let dofs = spec.ordered(S::D);
        self.check_dofs(here, spec, weight > 0.0)?;
        let mass = spec
            .mass
            .unwrap_or(if weight > 0.0 { density * weight } else { 1.0 });
        let inertia = spec
            .inertia
            .unwrap_or(if inertia > 0.0 { inertia } else { 1.0 });
        let only = if surfaces.is_empty() && parts.is_empty() && balls.len() == 1 {
            balls[0].1
        } else {
            0.0
        };
        let length = if only > 0.0 {
            only
        } else {
            (inertia / mass).sqrt()
        };
        let body = self.bodies.add(position + centre, mass, inertia, length);
        self.bodies.drive(Driven {
            name: spec.name.clone(),
            body,
            dofs,
        });
        for (x, radius) in balls {
            let offset = if only > 0.0 {
                S::Vector::null()
            } else {
                x - centre
            };
            self.shapes.balls.push(Ball {
                body,
                radius,
                offset,
                material,
            });
        }
        for part in parts {
            let offset = part.centre - centre;
            self.shapes
                .pieces
                .push(part.carried(body, offset, material));
        }
        for (offset, shape) in surfaces {
            self.shapes.surfaces.push(Carried {
                body,
                offset,
                shape,
                material,
            });
        }
        Ok(())
    }

    /// The balls of a plate with a hole: no grain as large as they are gets through between them.
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

    fn check_dofs(&self, here: &str, spec: &BodySpec, has_mass: bool) -> Result<(), InputError> {
        let drives = crate::scene::phases::drives_of(self.case, spec);
        let moves = crate::bodies::Dof::yields;
        if drives.iter().any(|d| moves(&d.1)) && spec.mass.is_none() && !has_mass {
            return Err(self.fail(
                here,
                format!(
                    "the body `{}` moves under forces, so it needs a `mass`",
                    spec.name
                ),
            ));
        }
        if drives.iter().any(|d| d.0 >= S::D && moves(&d.1)) {
            if S::D == 3 {
                return Err(self.fail(format!("{here}.dofs"), "a first body cannot turn freely in three dimensions yet; fix or drive rx, ry and rz"));
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
