//! Deformable bodies: their meshes, supports and material.

use super::mesh_block::BlockShape;
use super::{Builder, Origin, components};
use crate::case::{CellTouch, ElasticSpec, MeshSpec, SupportSpec, TouchSpec};
use crate::gmsh;
use crate::holders;
use crate::material::Sourced;
use crate::names::word_fault;
use crate::source::InputError;
use fretwork_core::assembly::AnySystem;
use fretwork_core::bodies::{ContactorShape, Dof};
use fretwork_elastic::mesh::MeshError;
use fretwork_elastic::{AnyMesh, BodyError, BodySpec, Elasticity, Support, Touching};
use std::collections::BTreeMap;

impl Builder<'_> {
    /// Returns the deformable bodies of the case, in its order.
    pub(super) fn elastic_bodies(
        &mut self,
        properties: &[BTreeMap<String, Sourced>],
    ) -> Result<Vec<AnySystem>, InputError> {
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

    /// Checks names of bodies and of their held parts, which name columns and files.
    pub(super) fn check_elastic_names(&self) -> Result<(), InputError> {
        let good = |name: &str| word_fault(name).is_none();
        let rigid = self.case.bodies.iter().map(|b| b.name.as_str());
        let mut known: Vec<&str> = rigid.collect();
        let elastic = self.case.elastic.iter().enumerate();
        let elastic = elastic.map(|(k, spec)| (format!("elastic.{k}"), &spec.name));
        let half_spaces = self.case.half_spaces.iter().enumerate();
        let half_spaces = half_spaces.map(|(k, spec)| (format!("half_spaces.{k}"), &spec.name));
        for (here, name) in elastic.chain(half_spaces) {
            if !good(name) || known.contains(&name.as_str()) {
                let message = format!(
                    "the name `{name}` of a deformable body names columns and files: it must be unique and made of letters, digits, `-` and `_`, of 100 at most"
                );
                return Err(self.fail(format!("{here}.name"), message));
            }
            known.push(name);
        }
        for (k, spec) in self.case.elastic.iter().enumerate() {
            let here = format!("elastic.{k}");
            let mut held: Vec<(&str, usize)> = Vec::new();
            for (j, support) in spec.supports.iter().enumerate() {
                let at = format!("{here}.supports.{j}.part");
                if !good(&support.part) {
                    let message = format!(
                        "the part `{}` names columns: rename it in the mesh with letters, digits, `-` and `_`",
                        support.part
                    );
                    return Err(self.fail(at, message));
                }
                let axes = [&support.x, &support.y, &support.z];
                for axis in (0..3).filter(|a| axes[*a].is_some()) {
                    if held.contains(&(&support.part, axis)) {
                        let message = format!(
                            "the part `{}` is held twice along {}; leave one out",
                            support.part,
                            ["x", "y", "z"][axis]
                        );
                        return Err(self.fail(at, message));
                    }
                    held.push((&support.part, axis));
                }
            }
        }
        Ok(())
    }

    /// Checks that bodies with an interface can touch.
    pub(super) fn check_elastic_pairs(&self) -> Result<(), InputError> {
        let elastic = self.case.elastic.iter().enumerate().map(|(k, spec)| {
            let points = match spec.touches {
                TouchSpec::Nothing => None,
                TouchSpec::Points(_) => Some(true),
                TouchSpec::Surface(_) => Some(false),
            };
            (format!("elastic.{k}"), &spec.name, &spec.material, points)
        });
        let half_spaces = self.case.half_spaces.iter().enumerate();
        let half_spaces = half_spaces.map(|(k, spec)| {
            let points = Some(spec.touches == CellTouch::Points);
            (
                format!("half_spaces.{k}"),
                &spec.name,
                &spec.material,
                points,
            )
        });
        let bodies: Vec<_> = elastic.chain(half_spaces).collect();
        let meet = |a: &str, b: &str| {
            let between = self.case.interfaces.iter().map(|i| &i.between);
            between
                .into_iter()
                .any(|(c, d)| (c == a && d == b) || (c == b && d == a))
        };
        for (k, (here, name, material, points)) in bodies.iter().enumerate() {
            for (_, other, counter, others) in &bodies[..k] {
                let (Some(points), true) = (points, points == others) else {
                    continue;
                };
                if !meet(material, counter) {
                    continue;
                }
                let (same, remedy) = match points {
                    true => ("points", "Surface"),
                    false => ("a surface", "Points"),
                };
                let message = format!(
                    "`{other}` and `{name}` both touch by {same} and would pass through each other; let one of them touch as `{remedy}`, or \
                     leave out the interface between their materials if they never meet"
                );
                return Err(self.fail(format!("{here}.touches"), message));
            }
        }
        Ok(())
    }

    /// Refuses grains that fit between the points of a body, since they would fall into it. Every
    /// section through the centre of a grain contains a disk with the radius of its ball: where
    /// that is larger than the gaps between points, a point stops the grain.
    pub(super) fn check_elastic_points(&self, systems: &[AnySystem]) -> Result<(), InputError> {
        let thinnest = self.assembly.thinnest_grain();
        // The size of a point is half of the distance to the next, in space the radius of the disk
        // with its area a: a disk of radius sqrt(a/2) fits between four points.
        let wide = match self.dimension() {
            2 => 1.0,
            _ => std::f64::consts::FRAC_PI_2.sqrt(),
        };
        for system in systems {
            let points = system.contactors().into_iter();
            let points = points.filter(|c| c.shape == ContactorShape::Point);
            let widest = wide * points.fold(0.0, |most: f64, c| most.max(c.radius));
            if thinnest < widest {
                let message = format!(
                    "grains that hold balls of no more than a radius of {thinnest:.3e} m fit between the points of `{}`, up to {:.3e} m apart; let it touch as `Surface`, or make its elements or cells smaller",
                    system.name(),
                    2.0 * widest
                );
                return Err(self.fail(self.deformable_place(system.name(), "touches"), message));
            }
        }
        Ok(())
    }

    /// Returns the path of a field of a deformable body in the case.
    fn deformable_place(&self, name: &str, field: &str) -> String {
        let elastic = self.case.elastic.iter().position(|e| e.name == name);
        let half_space = self.case.half_spaces.iter().position(|e| e.name == name);
        match (elastic, half_space) {
            (Some(k), _) => format!("elastic.{k}.{field}"),
            (None, k) => format!("half_spaces.{}.{field}", k.unwrap_or(0)),
        }
    }

    /// Returns the elasticity of a material of the case, and its index.
    pub(super) fn elasticity(
        &self,
        here: &str,
        name: &str,
        properties: &[BTreeMap<String, Sourced>],
    ) -> Result<(Elasticity, u16), InputError> {
        let at = format!("{here}.material");
        let (material, density) = self.material(&at, name)?;
        let property = |property: &str, unit: &str| {
            let known = properties[usize::from(material)].get(property).ok_or_else(|| {
                format!(
                    "a deformable body needs the property `{property}` of its material, and the file of `{name}` has none; add it there, \
                     with its source"
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
        Ok((elasticity, material))
    }

    fn elastic_body(
        &self,
        here: &str,
        spec: &ElasticSpec,
        properties: &[BTreeMap<String, Sourced>],
    ) -> Result<AnySystem, InputError> {
        if self.assembly.periodic().period.iter().any(Option::is_some) {
            let message = "deformable bodies do not repeat with a period; take `periodic` away";
            return Err(self.fail(here, message));
        }
        let (elasticity, material) = self.elasticity(here, &spec.material, properties)?;
        let mesh = self.mesh(&format!("{here}.mesh"), spec)?;
        let position = self.vector(&format!("{here}.position"), &spec.position)?;
        let velocity = self.vector(&format!("{here}.velocity"), &spec.velocity)?;
        let spin = self.spin(&format!("{here}.spin"), &spec.spin)?;
        let supports = self.supports(here, spec)?;
        let touching = match &spec.touches {
            TouchSpec::Nothing => Touching::Nothing,
            TouchSpec::Points(part) => Touching::Points(part),
            TouchSpec::Surface(part) => Touching::Surface(part),
        };
        let built = BodySpec {
            name: &spec.name,
            mesh: mesh.moved(&position.into()),
            material: elasticity,
            strain: spec.strain,
            damping: spec.damping,
            supports: &supports,
            touching,
            surface_material: material,
            velocity: velocity.into(),
            spin,
        };
        built.build().map_err(|error| {
            let below = match &error {
                BodyError::Mesh(_) => "mesh",
                BodyError::Material(_) => "material",
                BodyError::Damping(..) => "damping",
                BodyError::Spins(..) => "spin",
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

    fn supports(&self, here: &str, body: &ElasticSpec) -> Result<Vec<Support>, InputError> {
        let one = |(j, spec): (usize, &SupportSpec)| {
            let axes = [&spec.x, &spec.y, &spec.z];
            for (axis, dof) in ["x", "y", "z"].iter().zip(axes) {
                let at = format!("{here}.supports.{j}.{axis}");
                let Some(dof) = dof else { continue };
                self.check_holder(&at, axis, dof)?;
            }
            let holder = holders::name(&body.name, &spec.part);
            Ok(Support {
                part: spec.part.clone(),
                axes: axes.into_iter().cloned().collect(),
                later: holders::later(self.case, &holder),
            })
        };
        body.supports.iter().enumerate().map(one).collect()
    }

    /// Checks the drive of a holder along an axis.
    pub(super) fn check_holder(&self, at: &str, axis: &str, dof: &Dof) -> Result<(), InputError> {
        if axis == "z" && self.dimension() == 2 {
            return Err(self.fail(at, "a case in two dimensions has no z; leave it out"));
        }
        if let Some((below, why)) = dof.error() {
            let dot = if below.is_empty() { "" } else { "." };
            return Err(self.fail(format!("{at}{dot}{below}"), why));
        }
        Ok(())
    }

    fn mesh(&self, here: &str, owner: &ElasticSpec) -> Result<AnyMesh, InputError> {
        let spec = &owner.mesh;
        let wrong = |error: MeshError| self.fail(here, error.to_string());
        match spec {
            MeshSpec::Block {
                x,
                y,
                z,
                round,
                profile,
                coarsen,
            } => {
                let shape = BlockShape {
                    round: round.as_ref(),
                    profile: profile.as_deref(),
                    coarsen: coarsen.as_deref(),
                };
                self.block(here, [Some(x), Some(y), z.as_ref()], &shape)
            }
            MeshSpec::Gmsh { file, scale } => {
                if !(*scale > 0.0 && scale.is_finite()) {
                    let message = format!("a scale must be positive, got {scale}");
                    return Err(self.fail(format!("{here}.scale"), message));
                }
                let path = self.folder.join(file);
                let mut read = gmsh::read(&path, self.dimension())
                    .map_err(|why| self.fail(format!("{here}.file"), why))?;
                let named = |part: &str| {
                    let touches = match &owner.touches {
                        TouchSpec::Points(name) | TouchSpec::Surface(name) => name == part,
                        TouchSpec::Nothing => false,
                    };
                    touches || owner.supports.iter().any(|s| s.part == part)
                };
                // Other groups may lie inside the body.
                read.parts.retain(|part, _| named(part));
                let points = read.points.iter();
                let points = points.map(|p| (components(p) * *scale).into());
                let points: Vec<[f64; 3]> = points.collect();
                let dimension = self.dimension();
                AnyMesh::new(dimension, &points, read.elements, &read.parts).map_err(wrong)
            }
        }
    }
}
