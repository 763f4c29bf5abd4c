//! Error of single tractions on dynamical systems.
//!
//! The norms of [`super::error`] compare residuals with all velocities of a step. Where a load
//! moves a holder of little mass, u_free = h P/m is far above the velocities of the surface, and
//! residuals that are small in comparison leave wrong pressures in single cells. A residual r_c
//! corresponds to an impulse r_c/w_c, with w_c the compliance of the contact relative to its
//! neighbours, without their common motion. The error is the largest of these impulses over the
//! largest impulse on the same system,
//!
//! ```text
//! max_c |r_c|/w_c / max |p|      w_c = sum_a weight_a^2 (C_aa - C_ab)
//! ```
//!
//! where b is the touched node before or after a in the list of the system whose motion is closest
//! to that of a. Systems number the nodes of their surfaces along it: the cells of a half-space row
//! by row, the points of a mesh as its file has them. A node that is next in number but far away
//! shares less of the motion than one of the same facet, so that w_c comes out larger and the error
//! smaller, at most by the ratio of a node's own compliance to that against a neighbour; the solver
//! does not know the facets, and a search for the nearest of all touched nodes would need the
//! blocks of all pairs. This error is computed for systems with contacts at many points; a system
//! with few contacts, such as a grain, is treated as a rigid body.

use super::error::Residual;
use super::nodal::NodalSystem;
use super::row::SystemRow;
use crate::geometry::space::{MatrixLike, Space};

/// Number of contacts from which a body or a system counts as a touching surface, whose contacts
/// have a common motion. The rigid motion of a body has six degrees of freedom: with up to six
/// contacts their tractions follow from the balance of the body, which the norms measure. With more
/// contacts the tractions vary from point to point by the deformation. A block has four to eight
/// corners on a surface.
const MIN_SURFACE_CONTACTS: u32 = 8;
/// Smallest ratio of the compliance of a node relative to its neighbours to its own compliance, for
/// nodes that move together.
const MIN_RELATIVE_COMPLIANCE: f64 = 1e-3;

/// Errors of single tractions of the contacts of a problem, valid until the contacts change.
#[derive(Clone, Debug, Default)]
pub(super) struct Tractions {
    /// 1/w_c of each contact with a system (kg); 0 where the system has few contacts.
    stiffness: Vec<f64>,
    /// Whether each system has contacts at many points.
    many: Vec<bool>,
    /// Squared error of each contact (N^2 s^2), and its squared residual (m^2/s^2).
    errors: Vec<[f64; 2]>,
    /// Largest squared impulse on each system (N^2 s^2).
    largest: Vec<f64>,
}

impl Tractions {
    /// Discards the contacts.
    pub fn clear(&mut self) {
        self.stiffness.clear();
    }

    /// Begins a measurement of the contacts of `rows`, of a problem with a number of rigid bodies.
    pub fn begin<S: Space>(
        &mut self,
        rows: &[SystemRow<S>],
        systems: &[NodalSystem<S>],
        bodies: usize,
    ) {
        if self.stiffness.len() != rows.len() {
            (self.stiffness, self.many) = stiffness(rows, systems, bodies);
        }
        self.errors.clear();
        self.largest.clear();
        self.largest.resize(systems.len(), 0.0);
    }

    /// Adds the next contact.
    pub fn add<S: Space>(&mut self, row: &SystemRow<S>, residual: &Residual) {
        let impulse = row.impulse();
        let impulse = impulse.dot(&impulse);
        for system in row.systems() {
            let largest = &mut self.largest[system as usize];
            *largest = largest.max(impulse);
        }
        let stiffness = self.stiffness[self.errors.len()];
        let error = residual.squared * stiffness * stiffness;
        self.errors.push([error, residual.squared]);
    }

    /// Returns the largest error, and the squared residual of that contact (m^2/s^2); zeros where
    /// nothing is loaded.
    pub fn worst<S: Space>(&self, rows: &[SystemRow<S>]) -> [f64; 2] {
        let mut worst = [0.0; 2];
        for (row, [error, residual]) in rows.iter().zip(&self.errors) {
            let touching = row.systems().filter(|k| self.many[*k as usize]);
            let loads = touching.map(|k| self.largest[k as usize]);
            let load = loads.fold(f64::INFINITY, f64::min);
            if load > 0.0 && load.is_finite() && error / load > worst[0] {
                worst = [error / load, *residual];
            }
        }
        [worst[0].sqrt(), worst[1]]
    }
}

/// Returns 1/w_c of each contact with a system (kg), and whether each system has contacts at many
/// points.
fn stiffness<S: Space>(
    rows: &[SystemRow<S>],
    systems: &[NodalSystem<S>],
    bodies: usize,
) -> (Vec<f64>, Vec<bool>) {
    let mut contacts = vec![0u32; systems.len()];
    let mut of_bodies = vec![0u32; bodies];
    let mut touched: Vec<Vec<u32>> = vec![Vec::new(); systems.len()];
    for row in rows {
        row.systems().for_each(|k| contacts[k as usize] += 1);
        for (body, _) in row.rigid_masses() {
            of_bodies[body as usize] += 1;
        }
        for term in row.terms() {
            touched[term.system as usize].push(term.node);
        }
    }
    let many: Vec<bool> = contacts
        .iter()
        .map(|n| *n >= MIN_SURFACE_CONTACTS)
        .collect();
    if !many.contains(&true) {
        return (vec![0.0; rows.len()], many);
    }
    for nodes in &mut touched {
        nodes.sort_unstable();
        nodes.dedup();
    }
    let own = systems.iter().zip(&touched).zip(&many);
    let own: Vec<Vec<f64>> = own
        .map(|((system, nodes), many)| against_neighbours(system, nodes, *many))
        .collect();
    let of_row = |row: &SystemRow<S>| {
        if !row.systems().any(|k| many[k as usize]) {
            return 0.0;
        }
        let of_nodes = row.terms().iter().map(|term| {
            let system = term.system as usize;
            let at = touched[system].partition_point(|a| *a < term.node);
            term.weight * term.weight * own[system][at]
        });
        let bodies = row.rigid_masses();
        let bodies = bodies.filter(|(body, _)| of_bodies[*body as usize] < MIN_SURFACE_CONTACTS);
        let sides = of_nodes.sum::<f64>() + bodies.map(|(_, inverse)| inverse).sum::<f64>();
        let w = row.compliance_beside(sides);
        if w > 0.0 { 1.0 / w } else { 0.0 }
    };
    (rows.iter().map(of_row).collect(), many)
}

/// Returns the compliance of nodes of a system along the axis where it is smallest (1/kg); where
/// they are `many`, without the motion that they share with a neighbour in their list.
fn against_neighbours<S: Space>(system: &NodalSystem<S>, nodes: &[u32], many: bool) -> Vec<f64> {
    let of_node = |at: usize| {
        let own = system.block(nodes[at], nodes[at]);
        let before = at.checked_sub(1).and_then(|at| nodes.get(at));
        let neighbours = before.into_iter().chain(nodes.get(at + 1)).filter(|_| many);
        let neighbours: Vec<S::Matrix> = neighbours.map(|b| system.block(nodes[at], *b)).collect();
        let along = |k: usize| {
            let alone = own.entry(k, k);
            let shared = neighbours.iter().map(|block| block.entry(k, k));
            let shared = shared.fold(0.0, f64::max);
            (alone - shared).max(MIN_RELATIVE_COMPLIANCE * alone)
        };
        // A node that is held along an axis has no compliance there.
        let axes = (0..S::D).map(along).filter(|w| *w > 0.0);
        let least = axes.fold(f64::INFINITY, f64::min);
        if least.is_finite() { least } else { 0.0 }
    };
    (0..nodes.len()).map(of_node).collect()
}
