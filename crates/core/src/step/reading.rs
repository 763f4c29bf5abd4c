//! Data of a simulation at the end of a step, for readers: columns of bodies, rows of contacts.

use super::Simulation;
use super::change::ContactForces;
use super::control::StepBounds;
use super::detection::{mean_places, projection};
use super::process::Process;
use crate::bodies::Nodes;
use crate::contact::Contact;
use crate::energy::Energy;
use crate::geometry::space::{Space, VectorLike};
use crate::momentum::Momentum;
use crate::solve;
use crate::solve::local::LocalProblem;
use std::any::Any;

/// A contact at the end of a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactRow<S: Space> {
    /// The two bodies, by their places in the columns: candidate, antagonist.
    pub bodies: [u32; 2],
    /// Index of the interface in the case.
    pub interface: u16,
    /// Contact point on the candidate's side (m).
    pub point: S::Vector,
    /// Unit normal, from the antagonist to the candidate.
    pub normal: S::Vector,
    /// Distance at detection (m), positive when open.
    pub gap: f64,
    /// Mean force of the last step on the candidate (N; 2D N/m); the antagonist has its opposite.
    pub force: S::Vector,
    /// Part of the force along the normal (N; 2D N/m), positive in compression.
    pub normal_force: f64,
    /// Whether friction is at its bound.
    pub slides: bool,
}

impl<S: Space> Simulation<S> {
    /// Returns the number of bodies, grains first, then first bodies: the length of every column.
    pub fn body_count(&self) -> usize {
        self.state.bodies.len()
    }

    /// Returns the index of a first body in the columns, by its name.
    pub fn body_named(&self, name: &str) -> Option<usize> {
        let mut driven = self.state.bodies.driven.iter();
        driven.find(|d| d.name == name).map(|d| d.body as usize)
    }

    /// Returns the centres of mass (m).
    pub fn positions(&self) -> &[S::Vector] {
        &self.state.bodies.position
    }

    /// Returns the velocities of the centres of mass (m/s).
    pub fn velocities(&self) -> &[S::Vector] {
        &self.state.bodies.velocity
    }

    /// Returns the angular velocities (rad/s).
    pub fn spins(&self) -> &[S::Spin] {
        &self.state.bodies.spin
    }

    /// Returns the contacts of the last step, including open ones within the alert distance; empty
    /// before the first step.
    pub fn contacts(&self) -> impl ExactSizeIterator<Item = ContactRow<S>> + '_ {
        let contacts = self.state.network.contacts.iter();
        contacts.map(|contact| self.row(contact))
    }

    fn row(&self, contact: &Contact<S>) -> ContactRow<S> {
        let force = contact.impulse * (1.0 / self.options.scheme.h);
        let candidate = contact.bodies[0] as usize;
        ContactRow {
            bodies: contact.bodies,
            interface: contact.law,
            point: self.state.bodies.position[candidate] + contact.arms[0],
            normal: contact.normal,
            gap: contact.gap,
            force,
            normal_force: force.dot(&contact.normal),
            slides: contact.slides,
        }
    }

    /// Returns the mean force (N; 2D N/m) and the mean moment about its centre (N m; 2D N) in the
    /// last step by the contacts on a first body; `None` for an unknown name.
    pub fn contact_force_on(&self, name: &str) -> Option<(S::Vector, S::Spin)> {
        let place = self
            .state
            .bodies
            .driven
            .iter()
            .position(|d| d.name == name)?;
        let (impulse, moment) = self.state.received.get(place)?;
        let rate = 1.0 / self.options.scheme.h;
        Some((*impulse * rate, *moment * rate))
    }

    /// Returns the temperature of a body (K): the mean over the nodes of its surface, or over its
    /// mesh weighted by heat capacity; `None` where it has none or no heat is computed.
    pub fn temperature(&self, body: usize) -> Option<f64> {
        self.mean_temperature(self.heat.as_ref()?.nodes.get(body)?.range())
    }

    /// Returns the mean temperature of some nodes (K), see
    /// [`crate::heat::HeatState::mean_temperature`].
    pub fn mean_temperature(&self, nodes: std::ops::Range<usize>) -> Option<f64> {
        self.state.heat.as_ref()?.mean_temperature(nodes)
    }

    /// Returns the problem of the last solved step, in the form of the collection FCLIB; `None`
    /// where a bond, cohesion or friction against rotation acted, which that form does not contain.
    pub fn local_problem(&self) -> Option<LocalProblem> {
        let (forms, contacts) = (&self.workspace.forms, &self.state.network.contacts);
        let of_bodies = self.workspace.surfaces.forms_of_bodies(forms, contacts);
        solve::choose::coulomb(
            &self.workspace.problem,
            of_bodies.as_ref().unwrap_or(forms),
            &self.workspace.moments,
        )
    }

    /// The ledger of momentum (N s, N m s; 2D per m).
    pub fn momentum(&self) -> &Momentum {
        &self.state.momentum
    }

    /// The energy ledger (J; 2D J/m).
    pub fn energies(&self) -> &Energy {
        &self.state.energy
    }

    /// Returns whether the current phase is repeated later.
    pub fn phase_recurs(&self) -> bool {
        let now = self.state.control.phase().checked_sub(1);
        now.and_then(|k| self.phases.get(k))
            .is_some_and(|p| p.recurs)
    }

    /// Returns whether the last phase has ended.
    pub fn phases_finished(&self) -> bool {
        let phase = self.state.control.phase();
        phase > 0 && phase == self.phases.len() && self.state.control.turns()
    }

    /// Returns whether the next step is the first of a phase, whose bounds are known only after it.
    pub fn phase_begins(&self) -> bool {
        self.state.control.turns() && self.state.control.phase() < self.phases.len()
    }

    /// Returns the bounds of the next step. Drives of deformable bodies are not included.
    pub fn step_bounds(&self) -> StepBounds {
        StepBounds::of(self)
    }

    /// Returns the nodes of a system on which a contact acts at the current positions: those of the
    /// mean position that its point faces, or of the contact point. Empty where that side, 0 for
    /// the candidate or 1 for the antagonist, is rigid.
    pub fn nodes_of_side(&self, contact: &Contact<S>, side: usize) -> Option<Nodes> {
        mean_places::nodes_of_side(self, contact, side)
    }

    /// Returns the vertices of the surface of the antagonist opposite the facets of a point, with
    /// their shares of the volume worn there; `None` for a contact on the nearest position.
    pub(crate) fn worn_shares(&self, contact: &Contact<S>) -> Option<&[(u32, f64)]> {
        mean_places::worn_shares(self, contact)
    }

    /// Returns the contacts of points of deformable bodies, other than grains, with surfaces of
    /// others in the last step, and whether each acted on the mean position that its point faces;
    /// the others acted on the nearest position.
    pub fn acted_on_mean_places(&self) -> impl Iterator<Item = (&Contact<S>, bool)> {
        mean_places::acted_on_mean_places(self)
    }

    /// Returns the deepest penetration that a displacement can remove, as a fraction of the smaller
    /// body's length (a grain's radius; walls do not count).
    pub fn deepest_overlap(&self) -> f64 {
        projection::deepest_overlap(self)
    }

    /// The forces of the contacts in the last step.
    pub fn contact_forces(&self) -> ContactForces {
        let per = 1.0 / self.options.scheme.h;
        let contacts = self.state.network.contacts.iter();
        let carrying = contacts.filter(|c| c.impulse != S::Vector::zero());
        let force = |c: &Contact<S>| (c.key, (c.impulse * per).padded().into());
        ContactForces(carrying.map(force).collect())
    }

    /// Returns the largest displacement of a point of a body in a step at the current velocities,
    /// over the length of the smallest grain, or over the alert distance without grains. Infinite
    /// where a surface rotates so that it changes its place, since its extent is not known. A ball
    /// that rotates about its centre does not move.
    pub fn largest_displacement(&self) -> f64 {
        let (bodies, network) = (&self.state.bodies, &self.state.network);
        let turning = self.shapes.surfaces.iter().any(|surface| {
            let b = surface.body as usize;
            let spin = S::unrotate_spin(&bodies.rotation[b], &bodies.spin[b]);
            bodies.spin[b].norm() > 0.0 && !surface.shape.is_unchanged_by(&spin)
        });
        if turning {
            return f64::INFINITY;
        }
        let speed = |b: usize| {
            let lever = network.extents.lever(b);
            let turn = if lever > 0.0 {
                lever * bodies.spin[b].norm()
            } else {
                0.0
            };
            bodies.velocity[b].norm() + turn
        };
        let present = (0..bodies.len()).filter(|b| !bodies.removed[*b]);
        let grains = bodies.grains().filter(|b| !bodies.removed[*b]);
        let smallest = grains
            .map(|b| bodies.length[b])
            .fold(f64::INFINITY, f64::min);
        let size = if smallest.is_finite() {
            smallest
        } else {
            network.alert
        };
        self.options.scheme.h * present.map(speed).fold(0.0, f64::max) / size
    }

    /// Returns the process of a type, the first where there are several.
    pub fn process<P: Process<S>>(&self) -> Option<&P> {
        self.processes_as_any().find_map(|p| p.downcast_ref())
    }

    /// Iterates over the features that the core added, and then over the processes.
    pub(crate) fn processes_as_any(&self) -> impl Iterator<Item = &dyn Any> {
        let list = self.features.iter().chain(&self.processes);
        list.map(|p| p.as_ref() as &dyn Any)
    }

    /// Returns whether the last phase has ended, or a process has reached its goal.
    pub fn finished(&self) -> bool {
        self.phases_finished() || self.processes.iter().any(|p| p.finished())
    }
}
