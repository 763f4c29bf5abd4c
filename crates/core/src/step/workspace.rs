//! What a step makes for itself and throws away.

use super::answers::Solved;
use super::expansion::Expanding;
use super::mortar::MeanPlaces;
use super::systems::SystemContacts;
use crate::geometry::space::Space;
use crate::laws::SpringForm;
use crate::laws::evaluator::LawEvaluator;
use crate::solve::{ContactForm, MomentForm, Problem};

/// What a step makes for itself and throws away; its memory is kept from step to step, nothing else.
#[derive(Debug)]
pub(super) struct Workspace<S: Space> {
    /// Calls the laws.
    pub evaluator: LawEvaluator,
    /// The contact problem.
    pub problem: Problem<S>,
    /// Its contacts in the standard form, in the network's order.
    pub forms: Vec<ContactForm<S>>,
    /// What the motion closes of each gap beyond its velocity (m), in the same order; empty where nothing does.
    pub swerves: Vec<f64>,
    /// What the laws of compliant contacts gave, in the same order; empty without one.
    pub springs: Vec<Option<SpringForm<S>>>,
    /// Energy in springs of contacts at the start of the step (J).
    pub spring_energy: f64,
    /// Those that resist rotation.
    pub moments: Vec<MomentForm<S>>,
    /// What contacts with dynamical systems act on.
    pub systems: SystemContacts<S>,
    /// The mean places that contacts reach to.
    pub means: MeanPlaces<S>,
    /// What bodies do by thermal expansion.
    pub expanding: Expanding,
    /// What contacts did in the step.
    pub solved: Solved<S>,
    /// Whether a process has given a body an impulse in the step, see [`super::Simulation::apply_impulse`].
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
            expanding: Expanding::default(),
            solved: Solved::default(),
            pushed: false,
        }
    }
}
