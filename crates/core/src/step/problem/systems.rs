//! The contacts of dynamical systems, which are solved with those of rigid bodies.

use super::turning;
use crate::bodies::dynamical_system::far_fewer;
use crate::bodies::{Compliance, Nodes};
use crate::geometry::space::Space;
use crate::solve::{MomentForm, NodalSystem, Side};
use crate::step::motion::system_step;
use crate::step::workspace::SystemContacts;
use crate::step::{Simulation, StepError};
use std::sync::Arc;

/// Index for a contact without systems.
const RIGID: u32 = u32::MAX;

/// Returns the distinct points in a canonical order, where they are fewer than the nodes of their
/// sums, and not single nodes: a contact on a facet is then one unknown of the solver instead of
/// one for each vertex.
fn fewer_points(mut points: Vec<Nodes>, nodes: usize) -> Vec<Nodes> {
    if points.iter().all(|point| point.count() == 1) {
        return Vec::new();
    }
    points.sort_by(Nodes::order);
    points.dedup_by(|a, b| a.order(b).is_eq());
    if points.len() >= nodes {
        points.clear();
    }
    points
}

/// Returns the sides of a contact, by its index in the network; `None` where both are rigid.
fn sides<S: Space>(s: &Simulation<S>, k: usize) -> Option<[Side<S>; 2]> {
    let contact = &s.state.network.contacts[k];
    let carriers = contact.bodies.map(|b| s.state.bodies.carrier(b as usize));
    if carriers == [None; 2] {
        return None;
    }
    let mean = s.workspace.means.nodes(k, &contact.key);
    Some(std::array::from_fn(|k| {
        let body = contact.bodies[k];
        match carriers[k] {
            Some(carrier) => Side::Nodes {
                system: carrier.system,
                nodes: match mean {
                    Some(nodes) if k == 1 => nodes.clone(),
                    _ => (s.state.systems).contact_nodes(carrier, &contact.arms[k]),
                },
            },
            None => Side::Rigid {
                body,
                arm: contact.levers()[k],
            },
        }
    }))
}

/// Discards data of systems from the previous step, whose compliance is that of its matrix A.
pub(super) fn forget_system_contacts<S: Space>(s: &mut Simulation<S>) {
    s.workspace.systems.sides.clear();
    s.workspace.systems.places.clear();
    s.workspace.systems.touched.clear();
    s.workspace.systems.nodal.clear();
    s.workspace.systems.points.clear();
    s.workspace.systems.turned.clear();
}

/// Finds the nodes and points on which the current contacts act. A second call in the same step,
/// with more contacts, keeps the compliance of systems without newly touched nodes.
pub(super) fn find_system_contacts<S: Space>(s: &mut Simulation<S>) {
    find_touched_nodes(s, &[]);
}

/// Finds the nodes and points on which the current contacts act, and the nodes that represent
/// rotation for laws that resist it, once these laws were called.
pub(super) fn find_turned_systems<S: Space>(s: &mut Simulation<S>) {
    let moments = std::mem::take(&mut s.workspace.moments);
    if !moments.is_empty() {
        find_touched_nodes(s, &moments);
    }
    s.workspace.moments = moments;
}

fn find_touched_nodes<S: Space>(s: &mut Simulation<S>, moments: &[MomentForm<S>]) {
    if s.state.systems.is_empty() {
        return;
    }
    let mut found = SystemContacts::default();
    for k in 0..s.state.network.contacts.len() {
        let place = sides(s, k).map_or(RIGID, |sides| {
            found.sides.push(sides);
            found.sides.len() as u32 - 1
        });
        found.places.push(place);
    }
    let systems = s.state.systems.len();
    let mut touched: Vec<Vec<u32>> = vec![Vec::new(); systems];
    for side in found.sides.iter().flatten() {
        if let Side::Nodes { system, nodes } = side {
            touched[*system as usize].extend(nodes.terms().map(|(node, _)| node));
        }
    }
    let contacts = &s.state.network.contacts;
    let turned = moments.iter().map(|form| &contacts[form.contact as usize]);
    found.turned = turned.map(|contact| turning::turned(s, contact)).collect();
    for at in found.turned.iter().flatten().flatten() {
        touched[at.system as usize].push(at.node);
    }
    let mut points: Vec<Vec<Nodes>> = vec![Vec::new(); systems];
    for side in found.sides.iter().flatten() {
        if let Side::Nodes { system, nodes } = side {
            points[*system as usize].push(nodes.clone());
        }
    }
    for at in found.turned.iter().flatten().flatten() {
        points[at.system as usize].push(Nodes::one(at.node));
    }
    let mut kept = Vec::with_capacity(systems);
    for (system, (nodes, points)) in touched.iter_mut().zip(&mut points).enumerate() {
        nodes.sort_unstable();
        nodes.dedup();
        *points = fewer_points(std::mem::take(points), nodes.len());
        // A few points with many nodes each do not need the compliance of all these nodes.
        let all = points.is_empty() || !far_fewer(points.len(), nodes.len());
        let of_system = all.then(|| s.state.systems.kept_compliance(system, nodes));
        let of_system = of_system.flatten();
        if of_system.is_some() {
            points.clear();
        }
        kept.push(of_system);
    }
    let before = std::mem::take(&mut s.workspace.systems);
    let known = before.nodal.into_iter().zip(before.points);
    let mut known = before.touched.into_iter().zip(known);
    let touched = touched.into_iter().zip(points).zip(kept);
    for (system, ((nodes, points), kept)) in touched.enumerate() {
        let same = known.next();
        let same = same.filter(|(touched, (_, of))| *touched == nodes && *of == points);
        let nodal = same.map_or_else(
            || nodal(s, system, &nodes, &points, kept),
            |(_, (nodal, _))| nodal,
        );
        found.nodal.push(nodal);
        found.points.push(points);
        found.touched.push(nodes);
    }
    s.workspace.systems = found;
}

/// Returns a system as the solver uses it: by all nodes of the compliance that it keeps, by touched
/// nodes, or by points if there are any.
fn nodal<S: Space>(
    s: &Simulation<S>,
    system: usize,
    touched: &[u32],
    points: &[Nodes],
    kept: Option<Arc<Compliance<S>>>,
) -> NodalSystem<S> {
    let systems = &s.state.systems;
    let free = |nodes: &[u32]| -> Vec<S::Vector> {
        let all = nodes.iter();
        all.map(|n| systems.free_velocity_of(system, *n)).collect()
    };
    if let Some(kept) = kept {
        let free = free(kept.nodes());
        return NodalSystem::kept(kept, free);
    }
    if points.is_empty() {
        let compliance = systems.compliance(system, touched);
        return NodalSystem::new(touched.to_vec(), free(touched), &compliance);
    }
    let free = points.iter().map(|p| systems.free_velocity_at(system, p));
    let nodes = (0..points.len() as u32).collect();
    let compliance = systems.point_compliance(system, points);
    NodalSystem::new(nodes, free.collect(), &compliance)
}

/// Passes systems and all contacts to the solver.
pub(super) fn pose_with_systems<S: Space>(s: &mut Simulation<S>) {
    let SystemContacts {
        sides,
        places,
        nodal,
        points,
        ..
    } = &s.workspace.systems;
    let posed = |side: &Side<S>| match side {
        Side::Nodes { system, nodes } => Side::Nodes {
            system: *system,
            nodes: SystemContacts::<S>::place_among(&points[*system as usize], nodes),
        },
        Side::Rigid { .. } => side.clone(),
    };
    let problem = &mut s.workspace.problem;
    for system in nodal {
        problem.push_system(system.clone());
    }
    for (form, place) in s.workspace.forms.iter().zip(places) {
        match sides.get(*place as usize) {
            None => problem.push(form),
            Some(sides) => {
                let sides = sides.each_ref().map(posed);
                let known = problem.push_between(form, &sides);
                debug_assert!(known, "all nodes of the sides were pushed");
            }
        }
    }
}

/// Assigns systems and their bodies the velocities that result from the solved impulses.
///
/// # Errors
/// A velocity is not finite.
pub(super) fn adopt_system_velocities<S: Space>(s: &mut Simulation<S>) -> Result<(), StepError> {
    if s.state.systems.is_empty() {
        return Ok(());
    }
    let impulses = s.workspace.problem.node_impulses();
    let SystemContacts { nodal, points, .. } = &s.workspace.systems;
    let touched = nodal.iter().zip(points).zip(impulses);
    for (system, ((nodal, points), impulses)) in touched.enumerate() {
        if points.is_empty() {
            let impulses = nodal.nodes.iter().copied().zip(impulses);
            s.state.systems.apply(system, impulses);
        } else {
            let shares = points.iter().zip(impulses).flat_map(|(point, impulse)| {
                point
                    .terms()
                    .map(move |(node, weight)| (node, impulse * weight))
            });
            s.state.systems.apply(system, shares);
        }
    }
    if let Some(name) = s.state.systems.not_finite() {
        return Err(StepError::SystemNotFinite {
            step: s.state.steps + 1,
            time: s.state.time,
            system: name.to_owned(),
        });
    }
    s.state.systems.carry(&mut s.state.bodies);
    Ok(())
}

/// Linearises nonlinear systems at the velocities that they reached; returns whether any was
/// linearised, so that the contacts must be solved again, starting from the current impulses.
///
/// # Errors
/// A system finds no equilibrium.
pub(super) fn relinearise_systems<S: Space>(s: &mut Simulation<S>) -> Result<bool, StepError> {
    if s.state.systems.is_empty() {
        return Ok(false);
    }
    let step = system_step(s);
    let changed = s.state.systems.relinearise(&step);
    let changed = changed.map_err(|(system, why)| StepError::SystemBalance {
        step: s.state.steps + 1,
        time: s.state.time,
        system: s
            .state
            .systems
            .get(system)
            .map_or_else(String::new, |s| s.name().to_owned()),
        why,
    })?;
    for system in &changed {
        let SystemContacts {
            touched, points, ..
        } = &s.workspace.systems;
        let (touched, points) = (&touched[*system], &points[*system]);
        // With points the system is known by these.
        let kept = points.is_empty();
        let kept = kept.then(|| s.state.systems.kept_compliance(*system, touched));
        let kept = kept.flatten();
        let again = nodal(s, *system, touched, points, kept);
        s.workspace.systems.nodal[*system] = again;
    }
    if !changed.is_empty() {
        for (k, form) in s.workspace.forms.iter_mut().enumerate() {
            form.impulse = s.workspace.problem.solution(k).impulse;
        }
    }
    Ok(!changed.is_empty())
}

/// Returns the velocity of a side of a contact, at the current velocities (m/s).
fn velocity_of_side<S: Space>(s: &Simulation<S>, side: &Side<S>) -> S::Vector {
    match side {
        Side::Nodes { system, nodes } => s.state.systems.velocity_at(*system as usize, nodes),
        Side::Rigid { body, arm } => {
            let (bodies, b) = (&s.state.bodies, *body as usize);
            bodies.velocity[b] + S::spin_velocity(&bodies.spin[b], arm)
        }
    }
}

/// Returns the velocity of the candidate of the `k`-th contact relative to its antagonist, where
/// one of them is a system (m/s).
pub(super) fn relative_velocity_of_sides<S: Space>(
    s: &Simulation<S>,
    k: usize,
) -> Option<S::Vector> {
    let systems = &s.workspace.systems;
    let [a, b] = systems.sides.get(*systems.places.get(k)? as usize)?;
    Some(velocity_of_side(s, a) - velocity_of_side(s, b))
}
