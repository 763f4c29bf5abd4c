//! Temporary data of a step.

use super::problem::surfaces::Surfaces;
use crate::bodies::{Nodes, TurningNode};
use crate::contact::{Contact, Key};
use crate::geometry::space::Space;
use crate::laws::StepInfo;
use crate::laws::evaluator::LawEvaluator;
use crate::laws::{ContactStep, MomentStep, SolvedStep, SpringForm, SpringStep, Velocities};
use crate::solve::{ContactForm, MomentForm, NodalSystem, Problem, Side};

/// Temporary data of a step; only the allocated memory is kept from step to step.
#[derive(Debug)]
pub(crate) struct Workspace<S: Space> {
    /// Evaluator of the laws.
    pub evaluator: LawEvaluator,
    /// The contact problem.
    pub problem: Problem<S>,
    /// Contacts in the standard form, in the network's order.
    pub forms: Vec<ContactForm<S>>,
    /// Distance by which the motion closes each gap beyond its velocity (m), in the same order;
    /// empty if it is zero for all.
    pub nonlinear_closing: Vec<f64>,
    /// Linearised springs of compliant contacts, in the same order; empty without one.
    pub springs: Vec<Option<SpringForm<S>>>,
    /// Energy in springs of contacts at the start of the step (J).
    pub spring_energy: f64,
    /// Forms of the contacts that resist rotation.
    pub moments: Vec<MomentForm<S>>,
    /// Nodes and points on which contacts with dynamical systems act.
    pub systems: SystemContacts<S>,
    /// Mean positions that contacts face.
    pub means: MeanPlaces<S>,
    /// Motion of surfaces relative to their bodies.
    pub surfaces: Surfaces<S>,
    /// Results of the contacts in the step.
    pub solved: Solved<S>,
    /// Whether a process has given a body an impulse in the step, see
    /// [`super::Simulation::apply_impulse`].
    pub pushed: bool,
}

impl<S: Space> Default for Workspace<S> {
    fn default() -> Self {
        Self {
            evaluator: LawEvaluator::default(),
            problem: Problem::default(),
            forms: Vec::new(),
            nonlinear_closing: Vec::new(),
            springs: Vec::new(),
            spring_energy: 0.0,
            moments: Vec::new(),
            systems: SystemContacts::default(),
            means: MeanPlaces::default(),
            surfaces: Surfaces::default(),
            solved: Solved::default(),
            pushed: false,
        }
    }
}

/// Results of the contacts in a solved step. The buffers are reused from step to step, because
/// allocating new ones for many contacts costs more than filling them.
#[derive(Debug)]
pub(crate) struct Solved<S: Space> {
    pub before: Velocities<S>,
    /// Relative velocities at the end of the step (m/s).
    pub after: Vec<S::Vector>,
    pub contact_steps: Vec<ContactStep<S>>,
    /// Steps of the springs of compliant contacts; empty without a compliant law.
    pub springs: Vec<Option<SpringStep<S>>>,
    pub moment_steps: Vec<MomentStep<S>>,
    /// The contacts that held a load before and slide now, in order.
    pub begin: Vec<usize>,
    /// Whether the step was solved with predicted damage.
    pub predicted: bool,
}

impl<S: Space> Solved<S> {
    /// Returns the results as laws receive them.
    pub fn step<'a>(&'a self, info: &'a StepInfo) -> SolvedStep<'a, S> {
        SolvedStep {
            contacts: &self.contact_steps,
            springs: &self.springs,
            moments: &self.moment_steps,
            info,
            predicted: self.predicted,
        }
    }
}

impl<S: Space> Default for Solved<S> {
    fn default() -> Self {
        Self {
            before: Velocities::default(),
            after: Vec::new(),
            contact_steps: Vec::new(),
            springs: Vec::new(),
            moment_steps: Vec::new(),
            begin: Vec::new(),
            predicted: false,
        }
    }
}

/// Nodes and points on which the contacts of the step act where dynamical systems take part,
/// computed once for the current contacts.
#[derive(Debug)]
pub(crate) struct SystemContacts<S: Space> {
    /// The sides of the contacts with systems, in the network's order.
    pub sides: Vec<[Side<S>; 2]>,
    /// Index of each contact of the network in this list, [`RIGID`] where both sides are rigid;
    /// empty without systems.
    pub places: Vec<u32>,
    /// The nodes of each system that are touched, in increasing order.
    pub touched: Vec<Vec<u32>>,
    /// Systems as the solver uses them: nodes, or points between them.
    pub nodal: Vec<NodalSystem<S>>,
    /// Points of each system that replace nodes; empty where the solver uses the nodes.
    pub points: Vec<Vec<Nodes>>,
    /// Nodes on which the moments of the step act, by side.
    pub turned: Vec<[Option<TurningNode>; 2]>,
}

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

impl<S: Space> SystemContacts<S> {
    /// Returns a point as the solver identifies it: its index among the points of the system if
    /// there are any, or itself.
    pub fn place_among(points: &[Nodes], point: &Nodes) -> Nodes {
        let at = points.binary_search_by(|other| other.order(point));
        at.map_or_else(|_| point.clone(), |at| Nodes::one(at as u32))
    }
}

/// Position of the antagonist on which a contact acts.
#[derive(Clone, Debug)]
pub(crate) enum Reach<S: Space> {
    /// The mean position that its point faces.
    Mean(Box<MeanPlace<S>>),
    /// The nearest position, because the mean one does not exist.
    Nearest,
    /// The nearest position, for a contact that is not between a point of a deformable body and the
    /// surface of another, or that is between equal grids, where it carries a uniform pressure.
    Other,
}

/// The mean position that a point faces.
#[derive(Clone, Debug)]
pub(crate) struct MeanPlace<S: Space> {
    /// Nodes on which the contact acts.
    pub nodes: Nodes,
    /// Position (m).
    pub place: S::Vector,
    /// Normal of the contact: beyond the border of a surface that of the facets at the border.
    pub normal: S::Vector,
    /// Vertices of the surface with their shares of the worn volume.
    pub shares: Vec<(u32, f64)>,
}

/// Positions on which the contacts of the network act, in its order, found once for the positions
/// of the step.
#[derive(Debug)]
pub(crate) struct MeanPlaces<S: Space> {
    /// The contacts, and their normals when the positions were found.
    pub of: Vec<(Key, S::Vector)>,
    pub found: Vec<Reach<S>>,
}

impl<S: Space> Default for MeanPlaces<S> {
    fn default() -> Self {
        let (of, found) = (Vec::new(), Vec::new());
        Self { of, found }
    }
}

impl<S: Space> MeanPlaces<S> {
    /// Returns the position found for a contact with this normal.
    pub fn known(&self, contact: &Contact<S>) -> Option<&Reach<S>> {
        let at = self.of.binary_search_by_key(&contact.key, |of| of.0).ok()?;
        (self.of[at].1 == contact.normal).then(|| &self.found[at])
    }

    /// The nodes of the mean place of the contact at a place in the network.
    pub fn nodes(&self, contact: usize, key: &Key) -> Option<&Nodes> {
        debug_assert!(self.of.get(contact).is_none_or(|of| of.0 == *key));
        match self.found.get(contact)? {
            Reach::Mean(mean) => Some(&mean.nodes),
            Reach::Nearest | Reach::Other => None,
        }
    }
}
