//! Moments of contacts with dynamical systems: what of a system turns where a contact acts, and the spins that laws are told of.

use super::Simulation;
use super::systems::{SystemContacts, place_among};
use crate::bodies::{Nodes, TurningNode};
use crate::contact::Contact;
use crate::geometry::space::{Space, VectorLike};

impl<S: Space> Simulation<S> {
    /// By side of a contact the node that its moment turns; none of a rigid side.
    pub(super) fn turned(&self, contact: &Contact<S>) -> [Option<TurningNode>; 2] {
        std::array::from_fn(|k| {
            let carrier = self.state.bodies.carrier(contact.bodies[k] as usize)?;
            self.state.systems.turning_node(carrier, &contact.arms[k])
        })
    }

    /// Spin of the candidate of a contact relative to its antagonist at the start of the step, and now (rad/s), with the nodes that turn.
    /// `start` gives the spin of a rigid body at the start.
    fn relative_spins(
        &self,
        contact: &Contact<S>,
        turned: &[Option<TurningNode>; 2],
        start: impl Fn(usize) -> S::Spin,
    ) -> [S::Spin; 2] {
        let of = |k: usize| {
            let body = contact.bodies[k] as usize;
            match (&turned[k], self.state.bodies.carrier(body)) {
                (Some(node), _) => self.state.systems.spins(node),
                (None, Some(_)) => [S::Spin::zero(); 2],
                (None, None) => [start(body), self.state.bodies.spin[body]],
            }
        };
        let ([a, b], [c, d]) = (of(0), of(1));
        [a - c, b - d]
    }

    /// Spin of the candidate of a contact relative to its antagonist at the start of the step (rad/s).
    pub(super) fn relative_spin_before(&self, contact: &Contact<S>) -> S::Spin {
        let now = |body: usize| self.state.bodies.spin[body];
        let turned = self.turned(contact);
        self.relative_spins(contact, &turned, now)[0]
    }

    /// The same over the step of the `k`-th contact that resists rotation, at its start and its end. `start` gives the spin of a rigid body
    /// at the start.
    pub(super) fn relative_spins_of_moment(
        &self,
        k: usize,
        start: impl Fn(usize) -> S::Spin,
    ) -> [S::Spin; 2] {
        let of = self.workspace.moments[k].contact as usize;
        let turned = self.workspace.systems.turned.get(k);
        let none = [None; 2];
        let contact = &self.state.network.contacts[of];
        self.relative_spins(contact, turned.unwrap_or(&none), start)
    }

    /// Hands the moments of contacts to the solver.
    pub(super) fn pose_moments(&mut self) {
        for k in 0..self.workspace.moments.len() {
            let form = self.workspace.moments[k];
            let SystemContacts { turned, points, .. } = &self.workspace.systems;
            let sides = turned.get(k).copied().unwrap_or([None; 2]);
            let sides = sides.map(|side| {
                let side = side?;
                let node = place_among(&points[side.system as usize], &Nodes::one(side.node));
                let (node, _) = node.terms().next()?;
                Some(TurningNode { node, ..side })
            });
            let contact = &self.workspace.forms[form.contact as usize];
            let problem = &mut self.workspace.problem;
            let known = problem.push_moment_between(&form, contact, sides);
            debug_assert!(known, "the nodes that turn were pushed");
        }
    }
}
