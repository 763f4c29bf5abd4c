//! Dynamical systems in the step: they move with the bodies, their contactors follow them, and their contacts are solved with
//! those of rigid bodies.

use super::{Simulation, StepError};
use crate::bodies::dynamical_system::far_fewer;
use crate::bodies::{Compliance, ContactorShape, DynamicalSystem, Nodes, SystemStep, TurningNode};
use crate::contact::detect;
use crate::energy::BodyWork;
use crate::geometry::shape::{Ball, Carried};
use crate::geometry::space::{Space, VectorLike};
use crate::solve::{MomentForm, NodalSystem, Side};
use std::sync::Arc;

/// What the contacts of a step act on where dynamical systems take part, found once for the current contacts.
#[derive(Debug)]
pub(super) struct SystemContacts<S: Space> {
    /// The sides of the contacts with systems, in the network's order.
    sides: Vec<[Side<S>; 2]>,
    /// Where each contact of the network stands among them, [`RIGID`] where both sides are rigid; empty without systems.
    places: Vec<u32>,
    /// The nodes of each system that are touched, in increasing order.
    touched: Vec<Vec<u32>>,
    /// What the solver knows of each system: nodes, or points between them.
    nodal: Vec<NodalSystem<S>>,
    /// By system the points that stand for nodes; empty where nodes stand for themselves.
    pub(super) points: Vec<Vec<Nodes>>,
    /// The nodes that the moments of the step turn, by side.
    pub(super) turned: Vec<[Option<TurningNode>; 2]>,
}

/// Of a contact without systems.
const RIGID: u32 = u32::MAX;

impl<S: Space> Default for SystemContacts<S> {
    fn default() -> Self {
        Self {
            sides: Vec::new(),
            places: Vec::new(),
            touched: Vec::new(),
            nodal: Vec::new(),
            points: Vec::new(),
            turned: Vec::new(),
        }
    }
}

/// The different points in an order of their own, where they are fewer than the nodes that they are sums of, and not these
/// themselves: a contact on a facet is then one unknown of the solver and not one for each vertex.
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

/// A point as the solver knows it: its place among the points of the system where there are any, or itself.
pub(super) fn place_among(points: &[Nodes], point: &Nodes) -> Nodes {
    let at = points.binary_search_by(|other| other.order(point));
    at.map_or_else(|_| point.clone(), |at| Nodes::one(at as u32))
}

impl<S: Space> Simulation<S> {
    /// Adds a dynamical system to a scene that has not stepped, with a body for each contactor and its ball, point or surface; gives its index. The
    /// bodies are [`crate::bodies::Systems::bodies`]: other shapes may be added to them.
    ///
    /// Energy that it holds counts as work done on it before the start.
    pub fn add_system(&mut self, system: Box<dyn DynamicalSystem<S>>) -> usize {
        let (kinetic, stored) = (system.kinetic_energy(), system.stored_energy());
        let contactors = system.contactors();
        let index = self.state.systems.add(system, &mut self.state.bodies);
        // Contacts in the first move are looked for with the velocities at the start.
        self.state.systems.carry(&mut self.state.bodies);
        let system = self.state.systems.get(index);
        let mut points = 0..0;
        for (contactor, body) in contactors.iter().zip(self.state.systems.bodies(index)) {
            if let Some(shape) = system.and_then(|s| s.surface(contactor)) {
                self.shapes.surfaces.push(Carried {
                    body: *body,
                    offset: S::Vector::zero(),
                    shape,
                    material: contactor.material,
                });
            }
            if let (Some(system), ContactorShape::Grain) = (system, contactor.shape) {
                let surface = self.shapes.surfaces.len() - 1;
                self.state.network.of_grains.insert(surface);
                let areas = system.point_areas(contactor);
                let first = self.shapes.balls.len();
                points = first..first + areas.len();
                let vertices = system.surface_vertices(contactor).into_iter();
                let point = |(offset, area)| Ball {
                    body: *body,
                    radius: 0.0,
                    offset,
                    material: contactor.material,
                    area,
                };
                self.shapes.balls.extend(vertices.zip(areas).map(point));
            }
            let radius = match contactor.shape {
                ContactorShape::Ball => Some(contactor.radius),
                ContactorShape::Point => Some(0.0),
                ContactorShape::Surface | ContactorShape::Grain | ContactorShape::Given => None,
            };
            if let Some(radius) = radius {
                self.shapes.balls.push(Ball {
                    body: *body,
                    radius,
                    offset: S::Vector::zero(),
                    material: contactor.material,
                    area: S::Vector::zero(),
                });
            }
        }
        if !points.is_empty() {
            self.state.systems.set_points(index, points);
        }
        self.state.network.fast = detect::fast_motion(&self.shapes, self.state.network.alert);
        self.state.network.forget_neighbours();
        self.state.energy.kinetic += kinetic;
        self.state.energy.initial_kinetic += kinetic;
        self.state.energy.elastic += stored;
        self.state.energy.external_work += stored;
        self.state.energy.see(kinetic);
        self.state.energy.see(stored);
        index
    }

    /// The current step, as systems are told of it.
    fn system_step(&self) -> SystemStep<S> {
        SystemStep {
            time: self.state.time,
            h: self.options.scheme.h,
            theta: self.options.scheme.theta,
            gravity: self.state.gravity,
        }
    }

    /// Takes all systems through the first part of a step (s).
    pub(super) fn begin_systems(&mut self, time: f64) {
        if self.state.systems.is_empty() {
            return;
        }
        let step = self.system_step();
        self.state.systems.begin_step(&step);
        self.state.systems.advance(time);
        self.carry_systems();
    }

    /// Has the bodies of contactors follow their systems, and surfaces deform with them.
    pub(super) fn carry_systems(&mut self) {
        self.state.systems.carry(&mut self.state.bodies);
        self.state
            .systems
            .deform(&self.state.bodies, &mut self.shapes);
    }

    /// The velocities of systems without contacts; those of their bodies into `free`.
    pub(super) fn free_systems(&mut self, free: &mut [(S::Vector, S::Spin)]) {
        if !self.state.systems.is_empty() {
            let step = self.system_step();
            self.state.systems.free_velocities(&step, free);
        }
    }

    /// Has all systems at the velocities that they began the step with, their bodies too.
    pub(super) fn restart_systems(&mut self) {
        if !self.state.systems.is_empty() {
            self.state.systems.restart();
            self.state.systems.carry(&mut self.state.bodies);
        }
    }

    /// Takes all systems through the last part of a step (s) and adds their work; gives their kinetic and stored energy.
    pub(super) fn end_systems(&mut self, time: f64, work: &mut BodyWork) -> (f64, f64) {
        if self.state.systems.is_empty() {
            return (0.0, 0.0);
        }
        self.state.systems.advance(time);
        let own = self.state.systems.work(&self.system_step());
        work.potential += own.potential;
        work.external += own.external;
        work.damping += own.damping;
        work.scheme += own.scheme;
        work.expansion += own.expansion;
        self.state.systems.energies()
    }

    /// The sides of a contact, by its place in the network; none where both are rigid.
    fn sides(&self, k: usize) -> Option<[Side<S>; 2]> {
        let contact = &self.state.network.contacts[k];
        let carriers = contact
            .bodies
            .map(|b| self.state.bodies.carrier(b as usize));
        if carriers == [None; 2] {
            return None;
        }
        let mean = self.workspace.means.nodes(k, &contact.key);
        Some(std::array::from_fn(|k| {
            let body = contact.bodies[k];
            match carriers[k] {
                Some(carrier) => Side::Nodes {
                    system: carrier.system,
                    nodes: match mean {
                        Some(nodes) if k == 1 => nodes.clone(),
                        _ => (self.state.systems).contact_nodes(carrier, &contact.arms[k]),
                    },
                },
                None => Side::Rigid {
                    body,
                    arm: contact.levers()[k],
                },
            }
        }))
    }

    /// Forgets what the step before found of systems, whose compliance is that of its A.
    pub(super) fn forget_system_contacts(&mut self) {
        self.workspace.systems.sides.clear();
        self.workspace.systems.places.clear();
        self.workspace.systems.touched.clear();
        self.workspace.systems.nodal.clear();
        self.workspace.systems.points.clear();
        self.workspace.systems.turned.clear();
    }

    /// Finds what the current contacts act on. Asked again in the same step, for more contacts, it keeps the compliance of
    /// systems of which no other nodes are touched.
    pub(super) fn find_system_contacts(&mut self) {
        self.find_touched_nodes(&[]);
    }

    /// The same with the nodes that laws turn which resist rotation, once these laws were asked.
    pub(super) fn find_turned_systems(&mut self) {
        let moments = std::mem::take(&mut self.workspace.moments);
        if !moments.is_empty() {
            self.find_touched_nodes(&moments);
        }
        self.workspace.moments = moments;
    }

    fn find_touched_nodes(&mut self, moments: &[MomentForm<S>]) {
        if self.state.systems.is_empty() {
            return;
        }
        let mut found = SystemContacts::default();
        for k in 0..self.state.network.contacts.len() {
            let place = self.sides(k).map_or(RIGID, |sides| {
                found.sides.push(sides);
                found.sides.len() as u32 - 1
            });
            found.places.push(place);
        }
        let systems = self.state.systems.len();
        let mut touched: Vec<Vec<u32>> = vec![Vec::new(); systems];
        for side in found.sides.iter().flatten() {
            if let Side::Nodes { system, nodes } = side {
                touched[*system as usize].extend(nodes.terms().map(|(node, _)| node));
            }
        }
        let contacts = &self.state.network.contacts;
        let turned = moments.iter().map(|form| &contacts[form.contact as usize]);
        found.turned = turned.map(|contact| self.turned(contact)).collect();
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
            // A few points with many nodes each need no compliance of all these.
            let all = points.is_empty() || !far_fewer(points.len(), nodes.len());
            let of_system = all.then(|| self.state.systems.kept_compliance(system, nodes));
            let of_system = of_system.flatten();
            if of_system.is_some() {
                points.clear();
            }
            kept.push(of_system);
        }
        let before = std::mem::take(&mut self.workspace.systems);
        let known = before.nodal.into_iter().zip(before.points);
        let mut known = before.touched.into_iter().zip(known);
        let touched = touched.into_iter().zip(points).zip(kept);
        for (system, ((nodes, points), kept)) in touched.enumerate() {
            let same = known.next();
            let same = same.filter(|(touched, (_, of))| *touched == nodes && *of == points);
            let nodal = same.map_or_else(
                || self.nodal(system, &nodes, &points, kept),
                |(_, (nodal, _))| nodal,
            );
            found.nodal.push(nodal);
            found.points.push(points);
            found.touched.push(nodes);
        }
        self.workspace.systems = found;
    }

    /// A system as the solver sees it, by all nodes of the compliance that it keeps, by touched nodes, or, where there are any, by points.
    fn nodal(
        &self,
        system: usize,
        touched: &[u32],
        points: &[Nodes],
        kept: Option<Arc<Compliance<S>>>,
    ) -> NodalSystem<S> {
        let systems = &self.state.systems;
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

    /// Hands systems, as far as contacts see them, and all contacts to the solver.
    pub(super) fn pose_with_systems(&mut self) {
        let SystemContacts {
            sides,
            places,
            nodal,
            points,
            ..
        } = &self.workspace.systems;
        let posed = |side: &Side<S>| match side {
            Side::Nodes { system, nodes } => Side::Nodes {
                system: *system,
                nodes: place_among(&points[*system as usize], nodes),
            },
            Side::Rigid { .. } => side.clone(),
        };
        let problem = &mut self.workspace.problem;
        for system in nodal {
            problem.push_system(system.clone());
        }
        for (form, place) in self.workspace.forms.iter().zip(places) {
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

    /// Gives systems and their bodies the velocities that the solved impulses lead to.
    ///
    /// # Errors
    /// A velocity that is not finite.
    pub(super) fn adopt_system_velocities(&mut self) -> Result<(), StepError> {
        if self.state.systems.is_empty() {
            return Ok(());
        }
        let impulses = self.workspace.problem.node_impulses();
        let SystemContacts { nodal, points, .. } = &self.workspace.systems;
        let touched = nodal.iter().zip(points).zip(impulses);
        for (system, ((nodal, points), impulses)) in touched.enumerate() {
            if points.is_empty() {
                let impulses = nodal.nodes.iter().copied().zip(impulses);
                self.state.systems.apply(system, impulses);
            } else {
                let shares = points.iter().zip(impulses).flat_map(|(point, impulse)| {
                    point
                        .terms()
                        .map(move |(node, weight)| (node, impulse * weight))
                });
                self.state.systems.apply(system, shares);
            }
        }
        if let Some(name) = self.state.systems.not_finite() {
            return Err(StepError::SystemNotFinite {
                step: self.state.steps + 1,
                time: self.state.time,
                system: name.to_owned(),
            });
        }
        self.state.systems.carry(&mut self.state.bodies);
        Ok(())
    }

    /// Has systems whose forces are not linear linearise at the velocities that they reached; whether one did, so that the contacts
    /// are to be solved again. Their next impulses start from the current ones.
    ///
    /// # Errors
    /// A system that finds no balance.
    pub(super) fn relinearise_systems(&mut self) -> Result<bool, StepError> {
        if self.state.systems.is_empty() {
            return Ok(false);
        }
        let step = self.system_step();
        let changed = self.state.systems.relinearise(&step);
        let changed = changed.map_err(|(system, why)| StepError::SystemBalance {
            step: self.state.steps + 1,
            time: self.state.time,
            system: self
                .state
                .systems
                .get(system)
                .map_or_else(String::new, |s| s.name().to_owned()),
            why,
        })?;
        for system in &changed {
            let SystemContacts {
                touched, points, ..
            } = &self.workspace.systems;
            let (touched, points) = (&touched[*system], &points[*system]);
            // Where there are points it is known by these.
            let kept = points.is_empty();
            let kept = kept.then(|| self.state.systems.kept_compliance(*system, touched));
            let kept = kept.flatten();
            let again = self.nodal(*system, touched, points, kept);
            self.workspace.systems.nodal[*system] = again;
        }
        if !changed.is_empty() {
            for (k, form) in self.workspace.forms.iter_mut().enumerate() {
                form.impulse = self.workspace.problem.solution(k).impulse;
            }
        }
        Ok(!changed.is_empty())
    }

    /// Velocity of a side of a contact, at the current velocities (m/s).
    fn velocity_of_side(&self, side: &Side<S>) -> S::Vector {
        match side {
            Side::Nodes { system, nodes } => {
                self.state.systems.velocity_at(*system as usize, nodes)
            }
            Side::Rigid { body, arm } => {
                let (bodies, b) = (&self.state.bodies, *body as usize);
                bodies.velocity[b] + S::spin_velocity(&bodies.spin[b], arm)
            }
        }
    }

    /// Velocity of the candidate of the `k`-th contact relative to its antagonist where a system is one of them (m/s).
    pub(super) fn relative_velocity_of_sides(&self, k: usize) -> Option<S::Vector> {
        let systems = &self.workspace.systems;
        let [a, b] = systems.sides.get(*systems.places.get(k)? as usize)?;
        Some(self.velocity_of_side(a) - self.velocity_of_side(b))
    }
}
