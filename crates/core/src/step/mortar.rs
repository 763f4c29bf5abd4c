//! Contacts of the points of one mesh with the surface of another act on the place that a point faces on average over the segments at it,
//! see [`crate::geometry::mortar`], in the plane. Other contacts act on the nearest place.

use super::Simulation;
use crate::bodies::Nodes;
use crate::contact::Contact;
use crate::geometry::mortar::Footprint;
use crate::geometry::space::{Space, VectorLike};

/// Least cosine between a segment and the contact along it.
const STEEPEST: f64 = 0.2;

impl<S: Space> Simulation<S> {
    /// The nodes of the antagonist that a point of a mesh faces on average, and their mean place (m); none of other contacts, where
    /// the surface ends below the segments at the point, and of more nodes than [`Nodes::MAX`].
    pub(super) fn mean_place(&self, contact: &Contact<S>) -> Option<(Nodes, S::Vector)> {
        let carriers = contact
            .bodies
            .map(|b| self.state.bodies.carrier(b as usize));
        let ([Some(point), Some(carrier)], 2) = (carriers, S::D) else {
            return None;
        };
        let surface = &self.shapes.surfaces[contact.key.surface()?].shape;
        let systems = &self.state.systems;
        let neighbours = systems.neighbours(point)?;
        let vertices = surface.moving_vertices();
        if surface.is_closed() || vertices.len() < 2 {
            return None;
        }
        let b = contact.bodies[1] as usize;
        let (origin, rotation) = (self.state.bodies.position[b], self.state.bodies.rotation[b]);
        let local = |x: &S::Vector| S::unrotate(&rotation, &(*x - origin));
        let at = self.state.bodies.position[contact.bodies[0] as usize];
        let normal = S::unrotate(&rotation, &contact.normal);
        // The solid is on the right of a chain.
        let along = S::Vector::from_slice(&[normal[1], -normal[0]]);
        let footprint = Footprint {
            at: local(&at).dot(&along),
            neighbours: neighbours.map(|x| x.map(|x| local(&x).dot(&along))),
        };
        let near = contact.key.feature / 2;
        let near = usize::try_from(near).ok()?.min(vertices.len() - 2);
        let weights = footprint.weights(vertices.len(), near, |k| vertices[k].dot(&along))?;
        let steep = weights.windows(2).any(|w| {
            let step = vertices[w[1].0 as usize] - vertices[w[0].0 as usize];
            step.dot(&along) < STEEPEST * step.norm()
        });
        if steep {
            return None;
        }
        let mean = weights.iter().fold(S::Vector::zero(), |sum, (k, w)| {
            sum + vertices[*k as usize] * *w
        });
        let nodes = systems.vertex_nodes(carrier, &weights)?;
        Some((nodes, origin + S::rotate(&rotation, &mean)))
    }

    /// Has the contacts that were found at the start of the step reach to the place that their point faces on average.
    pub(super) fn reach_mean_places(&mut self) {
        if self.state.systems.is_empty() || S::D != 2 {
            return;
        }
        for k in 0..self.state.network.contacts.len() {
            let contact = &self.state.network.contacts[k];
            let Some((_, place)) = self.mean_place(contact) else {
                continue;
            };
            let bodies = contact
                .bodies
                .map(|b| self.state.bodies.position[b as usize]);
            let gap = (bodies[0] - place).dot(&contact.normal);
            let contact = &mut self.state.network.contacts[k];
            contact.gap = gap;
            contact.arms[1] = place - bodies[1];
        }
    }
}
