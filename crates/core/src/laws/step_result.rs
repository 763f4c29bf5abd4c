//! Results of a step for the contacts, as the solver gives them to the laws, and sums of their
//! energies.

use super::spring::SpringStep;
use super::step_info::StepInfo;
use crate::contact::Contact;
use crate::geometry::space::{Space, VectorLike};
use crate::solve::MomentSolution;
use crate::solve::form::ContactSolution;

/// Result of one contact over the step.
#[derive(Clone, Copy, Debug)]
pub struct ContactStep<S: Space> {
    /// Relative velocity u^- (m/s).
    pub before: S::Vector,
    /// Theta-averaged relative velocity u_th (m/s).
    pub average: S::Vector,
    /// Whether the unilateral part can carry tension (h c_n > 0).
    pub adheres: bool,
    /// Work dissipated by the bond's damping and by the time scheme (J); `None` where it follows
    /// from the bond's stored energy, see [`crate::solve::Elastic::lost`].
    pub lost: Option<f64>,
    /// Work of the position correction (J).
    pub corrected: f64,
    /// Whether friction is at its bound (slip).
    pub slides: bool,
    /// The solver's solution.
    pub solution: ContactSolution<S>,
}

/// Result of a contact that resists rotation over the step.
#[derive(Clone, Copy, Debug)]
pub struct MomentStep<S: Space> {
    /// The solver's solution.
    pub moment: MomentSolution<S>,
    /// Theta-averaged relative spin (rad/s).
    pub spin: S::Spin,
    /// Work dissipated by the time scheme (J).
    pub lost: f64,
}

/// Results of a solved step, as laws receive them.
#[derive(Debug)]
pub struct SolvedStep<'a, S: Space> {
    /// Results of the contacts, in the network's order.
    pub contacts: &'a [ContactStep<S>],
    /// Results of compliant contacts, in the network's order; empty without a compliant law.
    pub springs: &'a [Option<SpringStep<S>>],
    /// Moments of the contacts that resist rotation.
    pub moments: &'a [MomentStep<S>],
    /// Time and scheme of the step.
    pub info: &'a StepInfo,
    /// Whether the damage used in the impulses was a prediction, which may exceed the damage at the
    /// end.
    pub predicted: bool,
}

impl<S: Space> SolvedStep<'_, S> {
    /// Returns the result of a contact, if it is compliant.
    pub fn spring(&self, contact: usize) -> Option<&SpringStep<S>> {
        self.springs.get(contact)?.as_ref()
    }
}

/// Relative velocities and overlaps of the contacts, as known at the start of a step.
#[derive(Clone, Debug)]
pub struct Velocities<S: Space> {
    /// Relative velocities u^- (m/s), one per contact.
    pub relative: Vec<S::Vector>,
    /// Relative spins (rad/s); empty unless a bond resists rotation.
    pub turning: Vec<S::Spin>,
    /// Estimates of the overlaps at the end of the step (m), one per contact; empty without a
    /// compliant law.
    pub overlap: Vec<f64>,
    /// Effective masses along the normals (kg; kg/m in 2D), zero between immovable bodies; empty
    /// without a compliant law.
    pub effective_mass: Vec<f64>,
}

impl<S: Space> Default for Velocities<S> {
    fn default() -> Self {
        Self {
            relative: Vec::new(),
            turning: Vec::new(),
            overlap: Vec::new(),
            effective_mass: Vec::new(),
        }
    }
}

impl<S: Space> Velocities<S> {
    /// Returns the values of contacts at rest, with their current overlaps.
    pub(super) fn at_rest(contacts: &[Contact<S>]) -> Self {
        Self {
            relative: vec![S::Vector::zero(); contacts.len()],
            turning: Vec::new(),
            overlap: contacts.iter().map(|c| (-c.gap).max(0.0)).collect(),
            effective_mass: vec![0.0; contacts.len()],
        }
    }
}

/// Energies and events of one step, summed over contacts (J, m^3).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Totals {
    /// Energy dissipated by friction.
    pub friction: f64,
    /// Part of it dissipated in compliant contacts, whose springs store energy.
    pub friction_of_springs: f64,
    /// Energy dissipated by impacts.
    pub impact: f64,
    /// Energy dissipated against tensile strength (cohesion without opening).
    pub adhesion: f64,
    /// Energy dissipated by damping of bonds and of compliant contacts.
    pub viscous: f64,
    /// Work done on the springs of compliant contacts, less the energy that they dissipated.
    pub springs: f64,
    /// Work of the position correction; it is negative, since it separates penetrating bodies.
    pub correction: f64,
    /// Fracture energy released by damage.
    pub fracture: f64,
    /// Number of bonds that broke.
    pub broken: u64,
    /// Volume worn off bodies that are not grains.
    pub worn_first: f64,
    /// Volume worn in contacts between grains.
    pub worn_third: f64,
}

impl Totals {
    /// Adds the totals of other contacts.
    pub(super) fn add(&mut self, other: &Self) {
        self.friction += other.friction;
        self.friction_of_springs += other.friction_of_springs;
        self.impact += other.impact;
        self.adhesion += other.adhesion;
        self.viscous += other.viscous;
        self.springs += other.springs;
        self.correction += other.correction;
        self.fracture += other.fracture;
        self.broken += other.broken;
        self.worn_first += other.worn_first;
        self.worn_third += other.worn_third;
    }
}
