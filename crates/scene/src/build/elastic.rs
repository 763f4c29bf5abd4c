//! Deformable bodies: their meshes, supports and material.

use super::{Builder, Dimensional, Origin};
use crate::case::{ElasticSpec, LineSpec, MeshSpec, RoundSpec, SupportSpec, TouchSpec};
use crate::gmsh;
use crate::material::Sourced;
use crate::source::InputError;
use fretwork_core::bodies::{Dof, DynamicalSystem};
use fretwork_core::geometry::space::VectorLike;
use fretwork_elastic::generate::{block, even, graded, mapped_block};
use fretwork_elastic::mesh::MeshError;
use fretwork_elastic::{BodyError, BodySpec, Elasticity, Mesh, Support, Touching};
use std::collections::BTreeMap;

/// Most points of a block along an axis, and at all.
const MAX_LINE: f64 = 1e5;
const MAX_POINTS: usize = 1_000_000;

impl<S: Dimensional> Builder<'_, S> {
    /// The deformable bodies of the case, in its order.
    pub(super) fn elastic_bodies(
        &mut self,
        properties: &[BTreeMap<String, Sourced>],
    ) -> Result<Vec<Box<dyn DynamicalSystem<S>>>, InputError> {
        let mut out = Vec::new();
        for (k, spec) in self.case.elastic.iter().enumerate() {
            let system = self.elastic_body(&format!("elastic.{k}"), spec, properties)?;
            let contactors = system.contactors().len();
            self.origins
                .extend((0..contactors).map(|_| Origin::Elastic(k)));
            out.push(system);
        }
        Ok(out)
    }

    fn elastic_body(
        &self,
        here: &str,
        spec: &ElasticSpec,
        properties: &[BTreeMap<String, Sourced>],
    ) -> Result<Box<dyn DynamicalSystem<S>>, InputError> {
        if self.shapes.periodic.period.iter().any(Option::is_some) {
            let message = "deformable bodies do not repeat with a period; take `periodic` away";
            return Err(self.fail(here, message));
        }
        let at = format!("{here}.material");
        let (material, density) = self.material(&at, &spec.material)?;
        let property = |name: &str, unit: &str| {
            let known = properties[usize::from(material)].get(name).ok_or_else(|| {
                format!(
                    "a deformable body needs the property `{name}` of its material, and the file of `{}` has none; add it there, \
                     with its source",
                    spec.material
                )
            });
            let value = known.and_then(|p| p.in_unit(unit).map_err(|e| e.message));
            value.map_err(|why| self.fail(at.as_str(), why))
        };
        let elasticity = Elasticity {
            young: property("young", "Pa")?,
            poisson: property("poisson", "")?,
            density,
        };
        let mesh = self.mesh(&format!("{here}.mesh"), &spec.mesh)?;
        let position = self.vector(&format!("{here}.position"), &spec.position)?;
        let velocity = self.vector(&format!("{here}.velocity"), &spec.velocity)?;
        let supports = self.supports(here, &spec.supports)?;
        let touching = match &spec.touches {
            TouchSpec::Nothing => Touching::Nothing,
            TouchSpec::Points(part) => Touching::Points(part),
            TouchSpec::Surface(part) => Touching::Surface(part),
        };
        let built = S::elastic_body(BodySpec {
            name: &spec.name,
            mesh: mesh.moved(&position),
            material: elasticity,
            damping: spec.damping,
            supports: &supports,
            touching,
            surface_material: material,
            velocity,
        });
        built.map_err(|error| {
            let below = match &error {
                BodyError::Mesh(_) => "mesh",
                BodyError::Material(_) => "material",
                BodyError::Damping(..) => "damping",
                BodyError::NoChain(..) | BodyError::NoSurface(..) => "touches",
                BodyError::NoPart(part, _) => match &spec.touches {
                    TouchSpec::Points(touching) | TouchSpec::Surface(touching)
                        if touching == part && !spec.supports.iter().any(|s| s.part == *part) =>
                    {
                        "touches"
                    }
                    _ => "supports",
                },
                _ => "supports",
            };
            self.fail(format!("{here}.{below}"), error.to_string())
        })
    }

    fn supports(&self, here: &str, specs: &[SupportSpec]) -> Result<Vec<Support>, InputError> {
        let one = |(j, spec): (usize, &SupportSpec)| {
            let axes = [&spec.x, &spec.y, &spec.z];
            for (axis, dof) in ["x", "y", "z"].iter().zip(axes) {
                let at = format!("{here}.supports.{j}.{axis}");
                let Some(dof) = dof else { continue };
                if *axis == "z" && S::D == 2 {
                    return Err(self.fail(at, "a case in two dimensions has no z; leave it out"));
                }
                if dof.drives().any(|d| matches!(d, Dof::Pressure { .. })) {
                    let message = "a servo of pressure needs rigid walls; give a force";
                    return Err(self.fail(at, message));
                }
                if let Some((below, why)) = dof.fault() {
                    let dot = if below.is_empty() { "" } else { "." };
                    return Err(self.fail(format!("{at}{dot}{below}"), why));
                }
            }
            Ok(Support {
                part: spec.part.clone(),
                axes: axes.map(Clone::clone).to_vec(),
            })
        };
        specs.iter().enumerate().map(one).collect()
    }

    fn mesh(&self, here: &str, spec: &MeshSpec) -> Result<Mesh<S>, InputError> {
        let wrong = |error: MeshError| self.fail(here, error.to_string());
        match spec {
            MeshSpec::Block { x, y, z, round } => {
                let axes = match (S::D, z) {
                    (2, Some(_)) => {
                        let message = "a block in two dimensions has no z; leave it out";
                        return Err(self.fail(format!("{here}.z"), message));
                    }
                    (3, None) => {
                        return Err(self.fail(here, "a block in three dimensions needs `z`"));
                    }
                    (_, None) => vec![("x", x), ("y", y)],
                    (_, Some(z)) => vec![("x", x), ("y", y), ("z", z)],
                };
                let lines: Result<Vec<Vec<f64>>, _> = axes
                    .iter()
                    .map(|(axis, line)| {
                        coordinates(line).map_err(|(below, why)| {
                            self.fail(format!("{here}.{axis}.{below}"), why)
                        })
                    })
                    .collect();
                let lines = lines?;
                let points: usize = lines.iter().map(Vec::len).product();
                if points > MAX_POINTS {
                    let message = format!(
                        "the block has {points} points, more than {MAX_POINTS}; make its elements larger, or let them grow away from `fine`"
                    );
                    return Err(self.fail(here, message));
                }
                match round {
                    None => block::<S>(&lines).map_err(wrong),
                    Some(round) => self.rounded(&format!("{here}.round"), &lines, round),
                }
            }
            MeshSpec::Gmsh { file, scale } => {
                if !(*scale > 0.0 && scale.is_finite()) {
                    let message = format!("a scale must be positive, got {scale}");
                    return Err(self.fail(format!("{here}.scale"), message));
                }
                let path = self.folder.join(file);
                let read = gmsh::read(&path, S::D)
                    .map_err(|why| self.fail(format!("{here}.file"), why))?;
                let points = read.points.iter();
                let points = points.map(|p| S::Vector::from_slice(p) * *scale).collect();
                Mesh::new(points, read.elements, &read.parts).map_err(wrong)
            }
        }
    }

    /// Bends a side of a block, and what is behind it less and less.
    fn rounded(
        &self,
        here: &str,
        lines: &[Vec<f64>],
        round: &RoundSpec,
    ) -> Result<Mesh<S>, InputError> {
        let up = S::D - 1;
        let ends: Vec<[f64; 2]> = lines.iter().map(|l| [l[0], l[l.len() - 1]]).collect();
        let [bottom, top] = ends[up];
        let into = match round.side.as_str() {
            "bottom" => 1.0,
            "top" => -1.0,
            other => {
                let message = format!("only `top` and `bottom` can be round, got `{other}`");
                return Err(self.fail(format!("{here}.side"), message));
            }
        };
        let curved = if round.cylinder { 1 } else { up };
        let middle: Vec<f64> = ends.iter().map(|[a, b]| 0.5 * (a + b)).collect();
        let squared: f64 = (0..curved).map(|k| (ends[k][1] - middle[k]).powi(2)).sum();
        let deepest = round.radius - (round.radius * round.radius - squared).sqrt();
        if !(round.radius > 0.0 && deepest < 0.9 * (top - bottom)) {
            let message = format!(
                "a radius of {} m does not fit: the side would recede by more than 0.9 of the height of the block, {} m",
                round.radius,
                top - bottom
            );
            return Err(self.fail(format!("{here}.radius"), message));
        }
        let map = |p: &S::Vector| {
            let squared: f64 = (0..curved).map(|k| (p[k] - middle[k]).powi(2)).sum();
            let sagitta = squared / (round.radius + (round.radius * round.radius - squared).sqrt());
            let from = if into > 0.0 {
                top - p[up]
            } else {
                p[up] - bottom
            };
            let mut out = *p;
            out[up] += into * sagitta * from / (top - bottom);
            out
        };
        mapped_block(lines, map).map_err(|e| self.fail(here, e.to_string()))
    }
}

/// The points of a line, or the field that is wrong and why.
fn coordinates(line: &LineSpec) -> Result<Vec<f64>, (&'static str, String)> {
    let LineSpec {
        from,
        to,
        size,
        fine,
        growth,
    } = *line;
    if !(from.is_finite() && to.is_finite() && to > from) {
        return Err((
            "to",
            format!("`to` must be above `from`, got {from} and {to}"),
        ));
    }
    if !(size > 0.0 && size.is_finite()) {
        return Err((
            "size",
            format!("the size of an element must be positive, got {size}"),
        ));
    }
    let (low, high) = fine.unwrap_or((from, to));
    if !(from <= low && low < high && high <= to) {
        let message =
            format!("`fine` must lie within {from} and {to} and rise, got ({low}, {high})");
        return Err(("fine", message));
    }
    if !(growth >= 1.0 && growth <= 10.0) {
        return Err((
            "growth",
            format!("a growth must be from 1 to 10, got {growth}"),
        ));
    }
    let most = if growth > 1.0 { high - low } else { to - from };
    if most / size > MAX_LINE {
        return Err((
            "size",
            format!("elements of {size} m are more than {MAX_LINE} in a line"),
        ));
    }
    let cells = ((high - low) / size).round().max(1.0) as usize;
    let before = graded(low, from, size, growth);
    let after = graded(high, to, size, growth);
    let before = before.iter().skip(1).rev().copied();
    let before = before.filter(|_| low > from);
    let after = after.iter().skip(1).copied().filter(|_| to > high);
    Ok(before.chain(even(low, high, cells)).chain(after).collect())
}
