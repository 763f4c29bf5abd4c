//! Moments of contacts with dynamical systems: the nodes that represent rotation where a contact
//! acts, and the spins that laws receive.

use crate::bodies::{Nodes, TurningNode};
use crate::contact::Contact;
use crate::geometry::space::{Space, VectorLike};
use crate::step::Simulation;
use crate::step::workspace::SystemContacts;

/// Returns, by side of a contact, the node on which its moment acts; `None` for a rigid side.
pub(super) fn turned<S: Space>(
    s: &Simulation<S>,
    contact: &Contact<S>,
) -> [Option<TurningNode>; 2] {
    std::array::from_fn(|k| {
        let carrier = s.state.bodies.carrier(contact.bodies[k] as usize)?;
        s.state.systems.turning_node(carrier, &contact.arms[k])
    })
}

/// Returns the spin of the candidate of a contact relative to its antagonist, at the start of the
/// step and now (rad/s), with the nodes that represent rotation. `start` gives the spin of a rigid
/// body at the start.
fn relative_spins<S: Space>(
    s: &Simulation<S>,
    contact: &Contact<S>,
    turned: &[Option<TurningNode>; 2],
    start: impl Fn(usize) -> S::Spin,
) -> [S::Spin; 2] {
    let of = |k: usize| {
        let body = contact.bodies[k] as usize;
        match (&turned[k], s.state.bodies.carrier(body)) {
            (Some(node), _) => s.state.systems.spins(node),
            (None, Some(_)) => [S::Spin::zero(); 2],
            (None, None) => [start(body), s.state.bodies.spin[body]],
        }
    };
    let ([a, b], [c, d]) = (of(0), of(1));
    [a - c, b - d]
}

/// Returns the spin of the candidate of a contact relative to its antagonist at the start of the
/// step (rad/s).
pub(super) fn relative_spin_before<S: Space>(s: &Simulation<S>, contact: &Contact<S>) -> S::Spin {
    let now = |body: usize| s.state.bodies.spin[body];
    let turned = turned(s, contact);
    relative_spins(s, contact, &turned, now)[0]
}

/// Returns the relative spins of the `k`-th contact that resists rotation, at the start and the end
/// of the step. `start` gives the spin of a rigid body at the start.
pub(super) fn relative_spins_of_moment<S: Space>(
    s: &Simulation<S>,
    k: usize,
    start: impl Fn(usize) -> S::Spin,
) -> [S::Spin; 2] {
    let of = s.workspace.moments[k].contact as usize;
    let turned = s.workspace.systems.turned.get(k);
    let none = [None; 2];
    let contact = &s.state.network.contacts[of];
    relative_spins(s, contact, turned.unwrap_or(&none), start)
}

/// Passes the moments of contacts to the solver.
pub(super) fn pose_moments<S: Space>(s: &mut Simulation<S>) {
    for k in 0..s.workspace.moments.len() {
        let form = s.workspace.moments[k];
        let SystemContacts { turned, points, .. } = &s.workspace.systems;
        let sides = turned.get(k).copied().unwrap_or([None; 2]);
        let sides = sides.map(|side| {
            let side = side?;
            let node = SystemContacts::<S>::place_among(
                &points[side.system as usize],
                &Nodes::one(side.node),
            );
            let (node, _) = node.terms().next()?;
            Some(TurningNode { node, ..side })
        });
        let contact = &s.workspace.forms[form.contact as usize];
        let problem = &mut s.workspace.problem;
        let known = problem.push_moment_between(&form, contact, sides);
        debug_assert!(known, "the nodes that turn were pushed");
    }
}
