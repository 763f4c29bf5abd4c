//! Results of a body of finite elements: stress, forces of its holders, its mesh and its contact
//! surface.

use super::ElasticBody;
use crate::element::Simplex;
use crate::freedom::HeldCoordinate;
use crate::material::{Elasticity, Symmetric};
use fretwork_core::bodies::{DeformedMesh, Dof, Holder, SystemStep, TouchingSurface};
use fretwork_core::geometry::space::Space;

impl<S: Space> ElasticBody<S> {
    /// Returns the stress in each element (Pa).
    fn stresses(&self) -> Vec<Symmetric> {
        if let Some(large) = &self.model.large {
            return large.stresses(&self.displacement, &self.free_strain.of_elements);
        }
        let mesh = &self.model.mesh;
        let stress = |(e, points): (usize, &[u32])| {
            let simplex = Simplex::<S>::new(&mesh.corners(points));
            let displacements: Vec<S::Vector> =
                points.iter().map(|p| self.displacement(*p)).collect();
            simplex.map_or([0.0; 6], |s| {
                let strain = s.strain(&displacements);
                let left = Elasticity::less(&strain, self.free_strain.of(e));
                self.model.material.stress(&left)
            })
        };
        mesh.elements().enumerate().map(stress).collect()
    }

    /// Returns the sum of the forces of the holder of each imposed axis over the last step, by
    /// coordinate (N; N/m in 2D): the force that imposes the motion, without the contact forces at
    /// points of the part itself.
    pub(super) fn reactions(&self, step: &SystemStep<S>) -> Vec<f64> {
        let model = &self.model;
        let (average, theta_point) = self.average(step);
        let free = model.freedoms.free;
        let imposed = free..model.freedoms.total();
        let internal: Vec<f64> = match (&model.large, self.elastic_of_step()) {
            (Some(large), _) => {
                let [elastic, viscous] = self.internal_of_step(large, step, &average);
                imposed.clone().map(|c| elastic[c] + viscous[c]).collect()
            }
            (None, of_step) => {
                let viscous = model.viscous(&average);
                let elastic: Vec<f64> = match of_step {
                    Some([start, end]) => {
                        let mean = |c: usize| (1.0 - step.theta) * start[c] + step.theta * end[c];
                        imposed.clone().map(mean).collect()
                    }
                    None => {
                        let all = model.stiffness.times(&model.strained(&theta_point));
                        all[free..].to_vec()
                    }
                };
                let viscous = imposed
                    .clone()
                    .map(|c| viscous.get(c).copied().unwrap_or(0.0));
                let free = imposed.clone().map(|c| self.free_strain.force(c));
                let elastic = elastic.iter().zip(free).map(|(e, f)| e - f);
                elastic.zip(viscous).map(|(e, v)| e + v).collect()
            }
        };
        imposed
            .map(|c| {
                let change = self.velocity[c] - self.start[1][c];
                let gravity = step.gravity[usize::from(model.freedoms.axis[c])];
                let inertia = model.mass[c] * (change / step.h - gravity);
                inertia + internal[c - free] - self.contact[c] / step.h
            })
            .collect()
    }

    /// Returns the holders and drives, by support and axis.
    pub(super) fn held_parts(&self) -> Vec<Holder> {
        let freedoms = &self.model.freedoms;
        let reactions = self.step.as_ref().map(|step| self.reactions(step));
        let averages = self.step.as_ref().map(|step| self.average(step));
        let one = |(held, drive): (&HeldCoordinate, &Dof)| {
            let c = held.coordinate as usize;
            let force = match (&self.step, &reactions) {
                (Some(_), Some(reactions)) if c >= freedoms.free => reactions[c - freedoms.free],
                (Some(step), _) => Self::force(drive, step),
                _ => 0.0,
            };
            Holder {
                part: held.part.clone(),
                axis: usize::from(freedoms.axis[c]),
                at: self.step.as_ref().map_or(1.0, |step| step.theta),
                displacement: averages.as_ref().map_or(0.0, |a| a.1[c]),
                velocity: averages.as_ref().map_or(0.0, |a| a.0[c]),
                force,
            }
        };
        let mut held: Vec<(&HeldCoordinate, &Dof)> =
            freedoms.held.iter().zip(&self.drives).collect();
        held.sort_by_key(|(h, _)| (h.support, freedoms.axis[h.coordinate as usize]));
        held.into_iter().map(one).collect()
    }

    /// Returns the mesh with its current displacements and stresses.
    pub(super) fn mesh_now(&self) -> DeformedMesh<S::Vector> {
        let mesh = &self.model.mesh;
        let all = 0..mesh.points().len() as u32;
        DeformedMesh {
            points: mesh.points().to_vec(),
            displacement: all.map(|p| self.displacement(p)).collect(),
            elements: mesh.elements().flatten().copied().collect(),
            boundary: (0..mesh.facets())
                .flat_map(|f| mesh.facet(f).iter().copied())
                .collect(),
            stress: self.stresses(),
        }
    }

    /// Returns the contact surface, with its areas; `None` where nothing touches.
    pub(super) fn surface_part(&self) -> Option<TouchingSurface<S::Vector>> {
        let part = self.model.part.as_ref()?;
        let finite = self.model.large.is_some();
        let rest = |p: u32| self.model.mesh.points()[p as usize];
        // In small strain a force acts on the unloaded surface.
        let place = |p: u32| rest(p) + self.displacement(p) * f64::from(u8::from(finite));
        Some(TouchingSurface {
            nodes: part.points.clone(),
            points: part.points.iter().map(|p| rest(*p)).collect(),
            facets: part
                .facets
                .iter()
                .flat_map(|f| f[..S::D].to_vec())
                .collect(),
            areas: part.areas::<S>(place),
        })
    }
}
