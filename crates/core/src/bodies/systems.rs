//! The dynamical systems of a scene, and the bodies that represent their contactors.

use super::compliance::Compliance;
use super::contactor::{Carrier, Contactor, ContactorShape};
use super::drive::Dof;
use super::dynamical_system::{DynamicalSystem, SystemStep, SystemWork};
use super::nodes::Nodes;
use super::state::Bodies;
use crate::geometry::shape::Shapes;
use crate::geometry::space::{Space, VectorLike};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::borrow::Cow;
use std::ops::Range;
use std::sync::Arc;

/// A node that represents the rotation of a part of a system, see
/// [`DynamicalSystem::turning_node`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TurningNode {
    /// Index of the system.
    pub system: u32,
    /// Id of the node in the system.
    pub node: u32,
    /// Ratio of the node's velocity to the angular velocity (m).
    pub length: f64,
}

/// A held part of a system along an axis.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct HeldAxis {
    /// Index of the system.
    pub system: usize,
    /// Name of the part.
    pub part: String,
    /// Axis, 0 is x.
    pub axis: usize,
}

/// A system with its data for steps.
#[derive(Clone, Debug)]
struct SystemEntry<S: Space> {
    system: Box<dyn DynamicalSystem<S>>,
    contactors: Vec<Contactor>,
    /// Bodies that represent the contactors, in order.
    bodies: Vec<u32>,
    /// For a grain, the range of its surface points among the balls.
    points: Range<usize>,
    /// Velocities at the start of the step, and without contacts at its end.
    start: Vec<f64>,
    free: Vec<f64>,
}

/// Name and saved state of a system.
type SystemState = (String, Vec<u8>);

/// All systems of a scene that are not rigid bodies.
///
/// Systems are serialised as their names and states. After deserialisation there are only states,
/// until [`Systems::resume`] restores them into systems that were built again.
#[derive(Clone, Debug, Default)]
pub struct Systems<S: Space> {
    entries: Vec<SystemEntry<S>>,
    /// States that were deserialised and not yet restored.
    read: Vec<SystemState>,
}

impl<S: Space> Serialize for Systems<S> {
    fn serialize<T: Serializer>(&self, to: T) -> Result<T::Ok, T::Error> {
        self.states().serialize(to)
    }
}

impl<'de, S: Space> Deserialize<'de> for Systems<S> {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        let read = Vec::deserialize(from)?;
        let entries = Vec::new();
        Ok(Self { entries, read })
    }
}

impl<S: Space> Systems<S> {
    /// Returns whether there are no systems.
    pub fn is_empty(&self) -> bool {
        self.entries.is_empty()
    }

    /// Number of systems.
    pub fn len(&self) -> usize {
        self.entries.len()
    }

    /// Returns a system by its index, in the order in which they were added.
    pub fn get(&self, system: usize) -> Option<&dyn DynamicalSystem<S>> {
        self.entries.get(system).map(|e| e.system.as_ref())
    }

    /// Returns the bodies that represent the contactors of a system, in order.
    pub fn bodies(&self, system: usize) -> &[u32] {
        self.entries.get(system).map_or(&[], |e| &e.bodies)
    }

    /// Adds a system, and a body for each of its contactors; returns its index.
    pub fn add(&mut self, system: Box<dyn DynamicalSystem<S>>, bodies: &mut Bodies<S>) -> usize {
        let index = self.entries.len();
        let contactors = system.contactors();
        let carried = contactors.iter().enumerate().map(|(k, contactor)| {
            let carrier = Carrier {
                system: index as u32,
                contactor: k as u32,
                touches_itself: system.touches_itself(),
                grain: contactor.shape == ContactorShape::Grain,
            };
            let at = system.contactor_motion(contactor).position;
            let positive = contactor.radius > 0.0;
            let length = if positive { contactor.radius } else { 1.0 };
            let body = bodies.add_carried(at, length, carrier);
            if carrier.grain {
                // The mass of the body is used in measures only; the system has the inertia.
                bodies.mass[body as usize] = system.mass();
            }
            body
        });
        let carried = carried.collect();
        let velocity = system.velocity().to_vec();
        self.entries.push(SystemEntry {
            bodies: carried,
            points: 0..0,
            contactors,
            start: velocity.clone(),
            free: velocity,
            system,
        });
        self.carry(bodies);
        index
    }

    /// The current drive of a held part, see [`DynamicalSystem::drive_mut`].
    pub fn drive_mut(&mut self, of: &HeldAxis) -> Option<&mut Dof> {
        let entry = self.entries.get_mut(of.system)?;
        entry.system.drive_mut(&of.part, of.axis)
    }

    /// Returns the index of a system by its name.
    pub fn named(&self, name: &str) -> Option<usize> {
        self.entries.iter().position(|e| e.system.name() == name)
    }

    /// Moves the bodies of all contactors to the positions in their systems.
    pub fn carry(&self, bodies: &mut Bodies<S>) {
        for entry in &self.entries {
            for (contactor, body) in entry.contactors.iter().zip(&entry.bodies) {
                let motion = entry.system.contactor_motion(contactor);
                let b = *body as usize;
                bodies.position[b] = motion.position;
                bodies.rotation[b] = motion.rotation;
                bodies.velocity[b] = motion.velocity;
                bodies.spin[b] = motion.spin;
                // The system's own coordinates move, so that rounding the position of the body
                // loses nothing.
                if let Some(lost) = bodies.lost.get_mut(b) {
                    *lost = S::Vector::zero();
                }
            }
        }
    }

    /// Sets which balls are the points of a grain, in the order of the vertices of its surface.
    pub(crate) fn set_points(&mut self, system: usize, balls: Range<usize>) {
        self.entries[system].points = balls;
    }

    /// Updates the vertices of the surfaces of contactors, and the positions of the points of
    /// grains.
    pub fn deform(&self, bodies: &Bodies<S>, shapes: &mut Shapes<S>) {
        for surface in &mut shapes.surfaces {
            let Some(carrier) = bodies.carrier(surface.body as usize) else {
                continue;
            };
            let (system, contactor) = self.contactor(carrier);
            if matches!(
                contactor.shape,
                ContactorShape::Surface | ContactorShape::Grain
            ) {
                let vertices = system.surface_vertices(contactor);
                surface.shape.move_vertices(&vertices);
                let points = self.entries[carrier.system as usize].points.clone();
                let points = &mut shapes.balls[points];
                for (point, vertex) in points.iter_mut().zip(&vertices) {
                    point.offset = *vertex;
                }
            }
        }
    }

    /// Sets free strains of a system, see [`DynamicalSystem::set_free_strain`].
    pub fn set_free_strain(&mut self, system: usize, of_points: &[f64]) {
        self.entries[system].system.set_free_strain(of_points);
    }

    /// Begins a step for all systems.
    pub fn begin_step(&mut self, step: &SystemStep<S>) {
        for entry in &mut self.entries {
            // An imposed velocity may jump at the start of a step.
            entry.system.begin_step(step);
            entry.start.clear();
            entry.start.extend_from_slice(entry.system.velocity());
        }
    }

    /// Moves all systems by a time (s).
    pub fn advance(&mut self, time: f64) {
        for entry in &mut self.entries {
            entry.system.advance(time);
        }
    }

    /// Linearises all systems and computes their velocities without contacts; those of the bodies
    /// of contactors are written to `free`, which has an entry per body.
    pub fn free_velocities(&mut self, step: &SystemStep<S>, free: &mut [(S::Vector, S::Spin)]) {
        for entry in &mut self.entries {
            // Free rotation may have changed spins since the start.
            entry.start.clear();
            entry.start.extend_from_slice(entry.system.velocity());
            entry.system.linearise(step);
            entry.free = entry.system.free_velocity(step);
            for (contactor, body) in entry.contactors.iter().zip(&entry.bodies) {
                free[*body as usize] = entry.system.expected_velocity(contactor, &entry.free);
            }
        }
    }

    /// Linearises again the systems whose forces differ from those at their current velocities, and
    /// computes their velocities without contacts; returns the indices of these systems.
    ///
    /// # Errors
    /// Returns the index of a system that finds no equilibrium, and the reason.
    pub fn relinearise(&mut self, step: &SystemStep<S>) -> Result<Vec<usize>, (usize, String)> {
        let mut changed = Vec::new();
        for (k, entry) in self.entries.iter_mut().enumerate() {
            if entry.system.relinearise(step).map_err(|why| (k, why))? {
                entry.free = entry.system.free_velocity(step);
                changed.push(k);
            }
        }
        Ok(changed)
    }

    /// The velocity without contacts of a node of a system (m/s).
    pub fn free_velocity_of(&self, system: usize, node: u32) -> S::Vector {
        let entry = &self.entries[system];
        entry.system.node_velocity(node, &entry.free)
    }

    /// Returns the compliance of nodes of a system, see [`DynamicalSystem::compliance`].
    pub fn compliance(&self, system: usize, nodes: &[u32]) -> Vec<S::Matrix> {
        self.entries[system].system.compliance(nodes)
    }

    /// Returns the compliance that a system keeps, where at least a third of its nodes are touched:
    /// with it an impulse changes the velocities of all nodes.
    pub fn kept_compliance(&self, system: usize, touched: &[u32]) -> Option<Arc<Compliance<S>>> {
        let system = &self.entries[system].system;
        let nodes = system.kept_nodes()?;
        if 3 * touched.len() < nodes {
            return None;
        }
        system.kept_compliance(touched)
    }

    /// Returns the compliance of points of a system, see [`DynamicalSystem::point_compliance`].
    pub fn point_compliance(&self, system: usize, points: &[Nodes]) -> Vec<S::Matrix> {
        self.entries[system].system.point_compliance(points)
    }

    /// The velocity without contacts of a point of a system (m/s).
    pub fn free_velocity_at(&self, system: usize, point: &Nodes) -> S::Vector {
        point.sum_of(|node| self.free_velocity_of(system, node))
    }

    /// Returns the system and the contactor that a body represents.
    fn contactor(&self, carrier: Carrier) -> (&dyn DynamicalSystem<S>, &Contactor) {
        let entry = &self.entries[carrier.system as usize];
        let contactor = &entry.contactors[carrier.contactor as usize];
        (entry.system.as_ref(), contactor)
    }

    /// Returns the nodes on which a contact with a contactor's body acts, at an arm from its centre
    /// (m).
    pub fn contact_nodes(&self, carrier: Carrier, arm: &S::Vector) -> Nodes {
        let (system, contactor) = self.contactor(carrier);
        system.contact_nodes(contactor, arm)
    }

    /// Returns the node that represents the rotation of a contactor's body at an arm from its
    /// centre (m); see [`DynamicalSystem::turning_node`].
    pub fn turning_node(&self, carrier: Carrier, arm: &S::Vector) -> Option<TurningNode> {
        let (system, contactor) = self.contactor(carrier);
        let (node, length) = system.turning_node(contactor, arm)?;
        Some(TurningNode {
            system: carrier.system,
            node,
            length,
        })
    }

    /// Returns the angular velocities that a node represents, at the start of the step and now
    /// (rad/s).
    pub fn spins(&self, of: &TurningNode) -> [S::Spin; 2] {
        let entry = &self.entries[of.system as usize];
        [&entry.start[..], entry.system.velocity()].map(|velocity| {
            let moves = entry.system.node_velocity(of.node, velocity);
            let mut spin = S::Spin::zero();
            for k in 0..S::Spin::N {
                spin[k] = moves[k] / of.length;
            }
            spin
        })
    }

    /// Returns the facets at a contactor that is a point, see [`DynamicalSystem::facets_at`].
    pub(crate) fn facets_at(&self, carrier: Carrier) -> Vec<([S::Vector; 3], usize)> {
        let entry = &self.entries[carrier.system as usize];
        entry.system.facets_at(carrier.contactor as usize)
    }

    /// Returns the nodes of a weighted sum of vertices, see [`DynamicalSystem::vertex_nodes`].
    pub(crate) fn vertex_nodes(&self, carrier: Carrier, weights: &[(u32, f64)]) -> Option<Nodes> {
        let (system, contactor) = self.contactor(carrier);
        system.vertex_nodes(contactor, weights)
    }

    /// Returns whether two contactors are on grids of equal cells, within a relative tolerance.
    pub(crate) fn equal_cells(&self, carriers: [Carrier; 2], tolerance: f64) -> bool {
        let cells = carriers.map(|c| self.entries[c.system as usize].system.cell_size());
        let [Some(one), Some(other)] = cells else {
            return false;
        };
        let mut along = one.iter().zip(other).take(S::D - 1);
        along.all(|(a, b)| (a - b).abs() <= tolerance * a)
    }

    /// Returns the velocity of a point of a system at the current velocities (m/s).
    pub fn velocity_at(&self, system: usize, nodes: &Nodes) -> S::Vector {
        let system = &self.entries[system].system;
        nodes.sum_of(|node| system.node_velocity(node, system.velocity()))
    }

    /// Sets the velocity of a system that results from impulses on its nodes (N s).
    pub fn apply(&mut self, system: usize, impulses: impl Iterator<Item = (u32, S::Vector)>) {
        let entry = &mut self.entries[system];
        let mut impulses = impulses.peekable();
        let mut change = vec![0.0; entry.system.freedoms()];
        if impulses.peek().is_none() {
            entry.system.set_contact_impulse(&change);
            return entry.system.set_velocity(&entry.free);
        }
        for (node, impulse) in impulses {
            entry.system.add_impulse(node, &impulse, &mut change);
        }
        entry.system.set_contact_impulse(&change);
        entry.system.solve(&mut change);
        for (change, free) in change.iter_mut().zip(&entry.free) {
            *change += free;
        }
        entry.system.set_velocity(&change);
    }

    /// Restores the velocities of all systems at the start of the step.
    pub fn restart(&mut self) {
        for entry in &mut self.entries {
            entry.system.set_velocity(&entry.start);
        }
    }

    /// Returns the kinetic and stored energy of all systems (J; J/m in 2D).
    pub fn energies(&self) -> (f64, f64) {
        self.entries.iter().fold((0.0, 0.0), |sum, entry| {
            let system = &entry.system;
            (
                sum.0 + system.kinetic_energy(),
                sum.1 + system.stored_energy(),
            )
        })
    }

    /// Returns the kinetic energy (J) and the mass times twice the length (kg m) of the systems
    /// without imposed motion (per metre of depth in 2D).
    pub fn motion_of_free(&self) -> (f64, f64) {
        let free = self.entries.iter().map(|e| &e.system);
        free.filter(|s| !s.is_driven()).fold((0.0, 0.0), |sum, s| {
            let scale = s.mass() * 2.0 * s.length();
            (sum.0 + s.kinetic_energy(), sum.1 + scale)
        })
    }

    /// The work of the step over all systems.
    pub fn work(&self, step: &SystemStep<S>) -> SystemWork {
        let mut sum = SystemWork::default();
        for entry in &self.entries {
            let work = entry.system.work(step);
            sum.potential += work.potential;
            sum.external += work.external;
            sum.damping += work.damping;
            sum.scheme += work.scheme;
            sum.expansion += work.expansion;
        }
        sum
    }

    /// Returns the name of the first system with a velocity that is not finite.
    pub fn not_finite(&self) -> Option<&str> {
        let bad = |e: &&SystemEntry<S>| e.system.velocity().iter().any(|v| !v.is_finite());
        self.entries.iter().find(bad).map(|e| e.system.name())
    }

    /// The states of all systems.
    fn states(&self) -> Cow<'_, [SystemState]> {
        if !self.read.is_empty() {
            return Cow::Borrowed(&self.read);
        }
        let one = |e: &SystemEntry<S>| (e.system.name().to_owned(), e.system.save());
        self.entries.iter().map(one).collect()
    }

    /// Replaces these systems by those of a scene that was built again, restored to the states of
    /// the present ones. Returns false, without a change, if the states belong to other systems.
    #[must_use]
    pub fn resume(&mut self, built: &Self) -> bool {
        let states = self.states();
        if states.len() != built.entries.len() {
            return false;
        }
        let mut systems = built.clone();
        for (entry, (name, bytes)) in systems.entries.iter_mut().zip(states.iter()) {
            if entry.system.name() != name.as_str() || !entry.system.restore(bytes) {
                return false;
            }
            entry.start = entry.system.velocity().to_vec();
            entry.free.clone_from(&entry.start);
        }
        *self = systems;
        true
    }
}
