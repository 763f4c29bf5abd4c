//! Moments of contacts on a body of finite elements: the contact surface rotates as its facet does,
//! see [`crate::facet_spin`].
//!
//! Nodes that represent rotation follow the points of the mesh: one for each facet of the contact
//! surface, then one for each point of the mesh, with the mean rotation of its facets, and in space
//! one for each edge of each facet, with the mean rotation of the two facets at it.

use super::ElasticBody;
use crate::facet_spin::FacetSpin;
use crate::surface::NearestPart;
use fretwork_core::bodies::{Compliance, Contactor, ContactorShape, block_of};
use fretwork_core::geometry::space::{MatrixLike, Space, VectorLike};

impl<S: Space> ElasticBody<S> {
    /// Returns the current rotation of a node; `None` for points of the mesh.
    pub(super) fn facet_spin(&self, node: u32) -> Option<FacetSpin<S>> {
        let part = self.model.part.as_ref()?;
        let facet = (node as usize).checked_sub(self.model.mesh.points().len())?;
        let position = |p: u32| self.point_now(p);
        let Some(point) = facet.checked_sub(part.facets.len()) else {
            return Some(FacetSpin::new(&[part.corners(facet)], position));
        };
        let facets: Vec<[u32; 3]> = match point.checked_sub(self.model.mesh.points().len()) {
            None => part
                .facets_around(point as u32)
                .map(|f| part.corners(f))
                .collect(),
            Some(edge) => {
                let beside = part.facets_beside(edge / 3, edge % 3);
                beside.map(|f| part.corners(f)).collect()
            }
        };
        Some(FacetSpin::new(&facets, position))
    }

    /// Returns the node that represents rotation at a contactor, at an arm from its origin (m).
    pub(super) fn turning(&self, contactor: &Contactor, arm: &S::Vector) -> Option<(u32, f64)> {
        let part = self.model.part.as_ref()?;
        let points = self.model.mesh.points().len() as u32;
        let after = points + part.facets.len() as u32;
        let node = if contactor.shape == ContactorShape::Surface {
            let at = self.point_now(part.origin()) + *arm;
            match part.nearest_part::<S>(&at, |p| self.point_now(p)) {
                NearestPart::Facet(facet) => points + facet as u32,
                NearestPart::Point(point) => after + point,
                NearestPart::Edge(facet, corner) => after + points + (3 * facet + corner) as u32,
            }
        } else {
            let (point, _) = contactor.nodes.terms().next()?;
            after + point
        };
        Some((node, self.facet_spin(node)?.length))
    }

    /// Returns the compliance of nodes, some of which represent rotation, from the kept columns of
    /// contact points; `None` where these are not kept.
    pub(super) fn compliance_with_turning(&self, nodes: &[u32]) -> Option<Vec<S::Matrix>> {
        let formed = self.formed.as_ref()?;
        let kept = formed.surface.as_ref()?;
        let spins: Vec<_> = nodes.iter().map(|n| self.facet_spin(*n)).collect();
        let of_nodes = nodes.iter().zip(&spins).flat_map(|(node, spin)| {
            let points = spin.iter().flat_map(FacetSpin::points);
            points.chain(spin.is_none().then_some(*node))
        });
        let mut points: Vec<u32> = of_nodes.collect();
        points.sort_unstable();
        points.dedup();
        let places: Option<Vec<usize>> = points.iter().map(|p| kept.place(*p)).collect();
        let places = places?;
        for place in &places {
            self.model.column(formed, *place);
        }
        let index = |point: u32| points.binary_search(&point).unwrap_or_default();
        let (count, row) = (nodes.len(), S::D * kept.nodes().len());
        let mut out = vec![S::Matrix::uniform(0.0); count * count];
        for (b, (node, turns)) in nodes.iter().zip(&spins).enumerate() {
            for axis in 0..S::D {
                let mut unit = S::Vector::zero();
                unit[axis] = 1.0;
                let impulses = match turns {
                    None => vec![(*node, unit)],
                    Some(spin) => spin.forces(moment::<S>(&unit, spin.length)).collect(),
                };
                let mut velocities = vec![S::Vector::zero(); points.len()];
                for (point, p) in impulses {
                    let column = kept.column(places[index(point)]);
                    for (k, response) in column.chunks_exact(row).enumerate() {
                        for (v, place) in velocities.iter_mut().zip(&places) {
                            *v += S::Vector::from_slice(&response[place * S::D..][..S::D]) * p[k];
                        }
                    }
                }
                for (a, (seen, turns)) in nodes.iter().zip(&spins).enumerate() {
                    let v = match turns {
                        None => velocities[index(*seen)],
                        Some(spin) => spin.velocity(|p| velocities[index(p)]),
                    };
                    let block = &mut out[a * count + b];
                    *block = *block + S::Matrix::dyad(&v, &unit);
                }
            }
        }
        Some(out)
    }
}

/// Returns the compliance of points from their kept columns; `None` where one is not kept.
pub(super) fn blocks_of_points<S: Space>(
    kept: &Compliance<S>,
    nodes: &[u32],
) -> Option<Vec<S::Matrix>> {
    let places: Option<Vec<usize>> = nodes.iter().map(|n| kept.place(*n)).collect();
    let (places, count) = (places?, nodes.len());
    let mut out = vec![S::Matrix::uniform(0.0); count * count];
    // The blocks are read column by column, as they are stored.
    for (of, b) in places.iter().enumerate() {
        let column = kept.column(*b);
        for (row, a) in places.iter().enumerate() {
            out[row * count + of] = block_of::<S>(column, kept.nodes().len(), *a);
        }
    }
    Some(out)
}

/// Returns the moment of an impulse on a node that represents rotation with a length (m).
pub(super) fn moment<S: Space>(impulse: &S::Vector, length: f64) -> S::Spin {
    let mut out = S::Spin::zero();
    for k in 0..S::Spin::N {
        out[k] = impulse[k] * length;
    }
    out
}
