//! What a step makes for itself and throws away.

use super::problem::surfaces::Surfaces;
use crate::bodies::{Nodes, TurningNode};
use crate::contact::{Contact, Key};
use crate::geometry::space::Space;
use crate::laws::StepInfo;
use crate::laws::evaluator::LawEvaluator;
use crate::laws::{ContactStep, MomentStep, SolvedStep, SpringForm, SpringStep, Velocities};
use crate::solve::{ContactForm, MomentForm, NodalSystem, Problem, Side};

/// What a step makes for itself and throws away; its memory is kept from step to step, nothing
/// else.
#[derive(Debug)]
pub(crate) struct Workspace<S: Space> {
    /// Calls the laws.
    pub evaluator: LawEvaluator,
    /// The contact problem.
    pub problem: Problem<S>,
    /// Its contacts in the standard form, in the network's order.
    pub forms: Vec<ContactForm<S>>,
    /// What the motion closes of each gap beyond its velocity (m), in the same order; empty where
    /// nothing does.
    pub swerves: Vec<f64>,
    /// What the laws of compliant contacts gave, in the same order; empty without one.
    pub springs: Vec<Option<SpringForm<S>>>,
    /// Energy in springs of contacts at the start of the step (J).
    pub spring_energy: f64,
    /// Forms of the contacts that resist rotation.
    pub moments: Vec<MomentForm<S>>,
    /// What contacts with dynamical systems act on.
    pub systems: SystemContacts<S>,
    /// The mean places that contacts reach to.
    pub means: MeanPlaces<S>,
    /// How surfaces move on their bodies.
    pub surfaces: Surfaces<S>,
    /// What contacts did in the step.
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
            swerves: Vec::new(),
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
    /// What laws are given of it.
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

/// What the contacts of a step act on where dynamical systems take part, found once for the current
/// contacts.
#[derive(Debug)]
pub(crate) struct SystemContacts<S: Space> {
    /// The sides of the contacts with systems, in the network's order.
    pub sides: Vec<[Side<S>; 2]>,
    /// Where each contact of the network stands among them, [`RIGID`] where both sides are rigid;
    /// empty without systems.
    pub places: Vec<u32>,
    /// The nodes of each system that are touched, in increasing order.
    pub touched: Vec<Vec<u32>>,
    /// What the solver knows of each system: nodes, or points between them.
    pub nodal: Vec<NodalSystem<S>>,
    /// By system the points that stand for nodes; empty where nodes stand for themselves.
    pub points: Vec<Vec<Nodes>>,
    /// The nodes that the moments of the step turn, by side.
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
    /// A point as the solver knows it: its place among the points of the system where there are
    /// any, or itself.
    pub fn place_among(points: &[Nodes], point: &Nodes) -> Nodes {
        let at = points.binary_search_by(|other| other.order(point));
        at.map_or_else(|_| point.clone(), |at| Nodes::one(at as u32))
    }
}

/// What a contact acts on of its antagonist.
#[derive(Clone, Debug)]
pub(crate) enum Reach<S: Space> {
    /// The mean place that its point faces.
    Mean(Box<MeanPlace<S>>),
    /// The nearest place, because the mean one is not to be found.
    Nearest,
    /// The nearest place, of a contact that is none of a point of a deformable body with the
    /// surface of another, or of one on an equal grid, where that carries a uniform pressure.
    Other,
}

/// The mean place that a point faces.
#[derive(Clone, Debug)]
pub(crate) struct MeanPlace<S: Space> {
    /// The nodes that the contact acts on.
    pub nodes: Nodes,
    /// Where it is (m).
    pub place: S::Vector,
    /// Normal of the contact: beyond the border of a surface that of the facets there.
    pub normal: S::Vector,
    /// Vertices of the surface with their shares of what is worn off.
    pub shares: Vec<(u32, f64)>,
}

/// What the contacts of the network act on, in its order, found once for the places of the step.
#[derive(Debug)]
pub(crate) struct MeanPlaces<S: Space> {
    /// The contacts and their normals when that was found.
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
    /// What was found of a contact with this normal.
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
