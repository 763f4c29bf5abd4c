//! The thermal nodes of deformable bodies.

use super::bodies::{Nodes, Scene};
use crate::case::{BodyHeatSpec, Case, MeshHeatSpec, StoreSpec};
use crate::source::{ValidationError, nearest};
use fretwork_core::bodies::Conduction;
use fretwork_core::geometry::space::ball_radius;
use fretwork_core::heat::{BodyNodes, Edge, ImposedHeatFlow, Node, Store};
use fretwork_core::view::SystemView;
use std::f64::consts::PI;

impl Nodes {
    /// Nodes of the bodies of each dynamical system.
    pub(super) fn of_systems(
        &mut self,
        scene: &Scene<'_>,
    ) -> Result<Vec<BodyNodes>, ValidationError> {
        let s = scene.simulation;
        let systems = (0..s.system_count()).filter_map(|k| Some((k, s.system(k)?)));
        let mut out = Vec::with_capacity(s.system_count());
        for (index, system) in systems {
            let bodies = s.bodies_of_system(index);
            if system.is_grain() {
                let body = bodies.first().copied().unwrap_or_default() as usize;
                out.push(BodyNodes::One(self.list.len() as u32));
                self.list.push(scene.grain_that_deforms(&*system, body));
            } else {
                out.push(self.system(scene, &*system, bodies.first().copied())?);
            }
        }
        Ok(out)
    }

    fn system(
        &mut self,
        scene: &Scene<'_>,
        system: &dyn SystemView,
        body: Option<u32>,
    ) -> Result<BodyNodes, ValidationError> {
        let name = system.name();
        let fixed = BodyHeatSpec::default();
        let spec = scene.spec.bodies.get(name).unwrap_or(&fixed);
        let temperature = spec.temperature.unwrap_or(scene.spec.initial);
        let here = format!("heat.bodies.{name}.store");
        let material = material_of(scene.case, name);
        let store = match &spec.store {
            StoreSpec::Insulated => return Ok(BodyNodes::Insulated),
            StoreSpec::Fixed => Store::Fixed,
            StoreSpec::Lumped { capacity } => {
                let mass = system.mass() / scene.case.inertia_scaling;
                match capacity {
                    Some(capacity) => Store::Lumped(*capacity),
                    // The mass of a half-space is the moving mass, not that of a volume of
                    // material.
                    None if system.conduction().is_some() => {
                        Store::Lumped(mass * scene.materials[material].heat_capacity)
                    }
                    None => {
                        let message = format!(
                            "the volume of `{name}` is not known; give its heat capacity, `Lumped(capacity: 1.0)` (J/K)"
                        );
                        return Err(ValidationError::new(here, message));
                    }
                }
            }
            StoreSpec::HalfSpace(_) => {
                let message = format!("`{name}` deforms, and has no half-spaces for its heat");
                return Err(ValidationError::new(here, message).expected(
                    "`Fixed`, `Insulated`, `Lumped(..)`, or of a body of `elastic` `Mesh()`",
                ));
            }
            StoreSpec::Mesh(mesh) => {
                let Some(conduction) = system.conduction() else {
                    let message = format!("`{name}` has no mesh");
                    return Err(ValidationError::new(here, message).expected("a body of `elastic`"));
                };
                return self.mesh(scene, (&here, mesh), &conduction, (material, temperature));
            }
        };
        let first = self.list.len() as u32;
        let mut node = Node::new(temperature, store);
        if let Some(face) = spec.convection {
            node.surroundings = face.coefficient * face.area;
            node.ambient = face.ambient;
        }
        if spec.power != 0.0 {
            self.imposed.push(ImposedHeatFlow {
                body,
                node: first,
                flow: spec.power,
            });
        }
        self.list.push(node);
        Ok(BodyNodes::One(first))
    }

    fn mesh(
        &mut self,
        scene: &Scene<'_>,
        (here, spec): (&str, &MeshHeatSpec),
        conduction: &Conduction,
        (material, temperature): (usize, f64),
    ) -> Result<BodyNodes, ValidationError> {
        let material = &scene.materials[material];
        let first = self.list.len() as u32;
        let capacity = material.conductor().capacity;
        let volumes = conduction.volumes.iter();
        self.list
            .extend(volumes.map(|v| Node::new(temperature, Store::Lumped(capacity * v))));
        self.elements
            .extend(conduction.edges.iter().map(|(points, factor)| Edge {
                nodes: points.map(|p| first + p),
                conductance: material.conductivity * factor,
            }));
        let part = |kind: &str, name: &str| {
            let known = || conduction.parts.iter().map(|p| p.0.as_str());
            let found = conduction.parts.iter().find(|p| p.0 == name);
            found.map(|p| &p.1).ok_or_else(|| {
                ValidationError::new(
                    format!("{here}.{kind}.{name}"),
                    format!("the mesh has no part `{name}`"),
                )
                .expected_name(known(), "parts")
                .nearest(nearest(name, known()))
            })
        };
        for (name, convection) in &spec.convection {
            for (point, area) in part("convection", name)? {
                let node = &mut self.list[(first + point) as usize];
                let own = convection.coefficient * area;
                let all = node.surroundings + own;
                // A point shared by two parts has the mean.
                if all > 0.0 {
                    node.ambient =
                        (node.ambient * node.surroundings + convection.ambient * own) / all;
                }
                node.surroundings = all;
            }
        }
        for (name, flux) in &spec.flux {
            for (point, area) in part("flux", name)? {
                self.imposed.push(ImposedHeatFlow {
                    body: None,
                    node: first + point,
                    flow: flux * area,
                });
            }
        }
        for (name, temperature) in &spec.fixed {
            for (point, _) in part("fixed", name)? {
                let node = &mut self.list[(first + point) as usize];
                if node.store == Store::Fixed && node.temperature != *temperature {
                    let message = format!(
                        "a point of `{name}` is on another part too, and would be kept at {temperature} K and at {} K",
                        node.temperature
                    );
                    return Err(
                        ValidationError::new(format!("{here}.fixed.{name}"), message).expected(
                            "one temperature for parts that meet, or parts that do not meet",
                        ),
                    );
                }
                *node = Node::new(*temperature, Store::Fixed);
            }
        }
        Ok(BodyNodes::Mesh(first, self.list.len() as u32))
    }
}

impl Scene<'_> {
    /// Adds the node of a deformable grain, which has one temperature.
    fn grain_that_deforms(&self, system: &dyn SystemView, body: usize) -> Node {
        let material = self.material_of(body);
        let mass = system.mass() / self.case.inertia_scaling;
        let mut node = Node::new(
            self.temperature_of_grain(body),
            Store::Lumped(mass * material.heat_capacity),
        );
        if let Some(convection) = self.spec.convection {
            // The surface is that of the ball of the same volume.
            let dimension = self.simulation.dimension();
            let radius = ball_radius(dimension, mass / material.density);
            let surface = match dimension {
                2 => 2.0 * PI * radius,
                _ => 4.0 * PI * radius * radius,
            };
            node.surroundings = convection.coefficient * surface;
            node.ambient = convection.ambient;
        }
        node
    }
}

/// Returns the index of the material of a deformable body among those of the case.
pub(super) fn material_of(case: &Case, name: &str) -> usize {
    let elastic = case.elastic.iter().map(|e| (&e.name, &e.material));
    let half_spaces = case.half_spaces.iter().map(|h| (&h.name, &h.material));
    let mut all = elastic.chain(half_spaces);
    let material = all.find(|(n, _)| *n == name).map(|(_, material)| material);
    let place = case.materials.keys().position(|m| Some(m) == material);
    place.unwrap_or_default()
}
