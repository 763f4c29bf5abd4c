//! Contact states of a step: the relative velocities before it, and the solver's results in the form in
//! which the laws commit them.

use super::motion::StepStart;
use super::problem::shift_of_gap;
use super::{Scheme, Simulation};
use crate::bodies::Bodies;
use crate::contact::Contact;
use crate::geometry::space::{MatrixLike, Space, VectorLike};
use crate::laws::columns::StepInfo;
use crate::laws::{ContactStep, Interface, MomentStep, SolvedStep, SpringStep, Velocities};
use crate::solve::{self, MomentForm, begins_to_slide};
use crate::threads::{fill, pays};
use std::sync::{Mutex, PoisonError};

/// Results of the contacts in a solved step. The buffers are reused from step to step, because allocating
/// new ones for many contacts costs more than filling them.
#[derive(Debug)]
pub(super) struct Solved<S: Space> {
    pub before: Velocities<S>,
    /// Relative velocities at the end of the step (m/s).
    pub after: Vec<S::Vector>,
    pub contact_steps: Vec<ContactStep<S>>,
    /// Those of compliant contacts; empty without a compliant law.
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

/// Least overlap, over the reduced radius, for which a law is asked at a contact that closes within the step: its velocity before may not tell
/// of that.
const CLOSING_OVERLAP: f64 = 1e-3;

/// About what a pass over contacts takes for each (ns).
const EACH: f64 = 15.0;

/// The mass of a contact along its normal, 1/W_nn (kg; kg/m in 2D); zero between bodies that cannot move.
pub(super) fn effective_mass<S: Space>(bodies: &Bodies<S>, contact: &Contact<S>) -> f64 {
    let (n, levers) = (&contact.normal, contact.levers());
    let mobility = |side: usize| {
        let b = contact.bodies[side] as usize;
        let turning = S::rotation_block(&levers[side], &bodies.inverse_tensor(b));
        n.dot(&n.scaled_by(&bodies.inverse_mass[b])) + n.dot(&turning.apply(n))
    };
    let w = mobility(0) + mobility(1);
    if w > 0.0 { 1.0 / w } else { 0.0 }
}

/// The velocity of the candidate of a contact relative to its antagonist, at the current velocities of rigid bodies.
#[inline]
pub(super) fn relative_velocity<S: Space>(bodies: &Bodies<S>, contact: &Contact<S>) -> S::Vector {
    let [i, j] = contact.bodies.map(|b| b as usize);
    let levers = contact.levers();
    bodies.velocity[i] + S::spin_velocity(&bodies.spin[i], &levers[0])
        - bodies.velocity[j]
        - S::spin_velocity(&bodies.spin[j], &levers[1])
}

impl<S: Space> Simulation<S> {
    /// Whether a pass over the contacts is divided among threads.
    pub(super) fn divides_contacts(&self) -> bool {
        pays(
            self.options.solver.parallel,
            self.state.network.contacts.len(),
            EACH,
        )
    }

    /// The velocities of the candidates relative to their antagonists, at the current velocities.
    fn fill_relative_velocities(&self, list: &mut Vec<S::Vector>) {
        let (bodies, contacts) = (&self.state.bodies, &self.state.network.contacts);
        if self.state.systems.is_empty() {
            let of = |k: usize| relative_velocity(bodies, &contacts[k]);
            fill(self.divides_contacts(), list, contacts.len(), of);
            self.add_surface_velocities(list);
            return;
        }
        list.clear();
        list.extend(contacts.iter().enumerate().map(|(k, contact)| {
            let of_sides = self.relative_velocity_of_sides(k);
            of_sides.unwrap_or_else(|| relative_velocity(bodies, contact))
        }));
        self.add_surface_velocities(list);
    }

    /// Computes the relative velocities and spins at the start of the step.
    pub(super) fn relative_velocities(&mut self) {
        let mut before = std::mem::take(&mut self.workspace.solved.before);
        self.fill_relative_velocities(&mut before.relative);
        before.turning.clear();
        if self.laws.iter().any(Interface::rotates) {
            let contacts = self.state.network.contacts.iter();
            before
                .turning
                .extend(contacts.map(|c| self.relative_spin_before(c)));
        }
        before.overlap.clear();
        before.effective_mass.clear();
        if self.laws.iter().any(Interface::compliant) {
            let h = self.options.scheme.h;
            let (network, bodies) = (&self.state.network, &self.state.bodies);
            let (divide, count) = (self.divides_contacts(), network.contacts.len());
            let relative = &before.relative;
            fill(divide, &mut before.overlap, count, |k| {
                // Not below the overlap at hand: a body that moves apart by more than that in a step would find no spring, and
                // stiff contacts no equilibrium.
                let contact = &network.contacts[k];
                let gap = network.spring_gap(contact);
                let end = gap + h * contact.normal.dot(&relative[k]);
                let least = if contact.closing {
                    CLOSING_OVERLAP * contact.radius
                } else {
                    0.0
                };
                (-end).max(-gap).max(least)
            });
            fill(divide, &mut before.effective_mass, count, |k| {
                effective_mass(bodies, &network.contacts[k])
            });
        }
        self.workspace.solved.before = before;
    }

    /// Collects what compliant contacts did, which need their velocities at the end of the step.
    pub(super) fn collect_spring_steps(&mut self) {
        let mut steps = std::mem::take(&mut self.workspace.solved.springs);
        let (springs, forms) = (&self.workspace.springs, &self.workspace.forms);
        let (solved, h) = (&self.workspace.solved, self.options.scheme.h);
        let contacts = &self.state.network.contacts;
        fill(self.divides_contacts(), &mut steps, springs.len(), |k| {
            let contact_step = &solved.contact_steps[k];
            Some(springs[k].as_ref()?.complete(
                &forms[k],
                &contact_step.solution,
                [&solved.after[k], &contact_step.average],
                &contacts[k].spring,
                h,
            ))
        });
        self.workspace.solved.springs = steps;
    }

    /// Collects the results of all contacts, but for springs.
    pub(super) fn collect_contact_steps(&mut self) {
        let mut after = std::mem::take(&mut self.workspace.solved.after);
        self.fill_relative_velocities(&mut after);
        let mut contact_steps = std::mem::take(&mut self.workspace.solved.contact_steps);
        let (before, after_all) = (&self.workspace.solved.before.relative, &after);
        let (forms, problem) = (&self.workspace.forms, &self.workspace.problem);
        let (network, correction) = (&self.state.network, self.options.correction);
        let swerves = &self.workspace.swerves;
        let Scheme { h, theta } = self.options.scheme;
        let count = network.contacts.len();
        let mut begin = std::mem::take(&mut self.workspace.solved.begin);
        begin.clear();
        let begin = Mutex::new(begin);
        fill(self.divides_contacts(), &mut contact_steps, count, |k| {
            let (contact, before) = (&network.contacts[k], &before[k]);
            let (form, solution) = (&forms[k], problem.solution(k));
            let average = *before * (1.0 - theta) + after_all[k] * theta;
            let n = &contact.normal;
            let lost = match &form.elastic {
                None => Some(0.0),
                Some(e) => {
                    let bond = network.bond(contact).filter(|_| e.tension_only);
                    let opening = bond.map_or(0.0, |b| b.opening_n);
                    e.lost(&solution, n, opening, [&average, &after_all[k]], h)
                }
            };
            // The shift comes from the position correction unless restitution replaced it; a bounce does no
            // correction work.
            let of_gap = shift_of_gap(network, contact, correction, h);
            let swerve = swerves.get(k).map_or(0.0, |s| s / h);
            let lifts = of_gap < 0.0
                && form.compliance[0] == 0.0
                && n.dot(before) >= form.shift_n
                && form.shift_n == of_gap - swerve;
            let lift = if lifts {
                -theta * of_gap * solution.unilateral_n.max(0.0)
            } else {
                0.0
            };
            // Some solvers satisfy the friction bound of a sliding contact only within their tolerance.
            let bound = form.friction * (solution.unilateral_n + form.tension) + form.cohesion;
            let slides = solution.unilateral_t.norm() >= (1.0 - 1e-6) * bound;
            if slides && begins_to_slide(form, &contact.impulse, &solution) {
                begin.lock().unwrap_or_else(PoisonError::into_inner).push(k);
            }
            ContactStep {
                before: *before,
                slides,
                average,
                adheres: form.tension > 0.0,
                lost,
                corrected: lift,
                solution,
            }
        });
        self.workspace.solved.contact_steps = contact_steps;
        self.workspace.solved.after = after;
        let mut begin = begin.into_inner().unwrap_or_else(PoisonError::into_inner);
        begin.sort_unstable();
        self.workspace.solved.begin = begin;
    }

    /// Whether a contact begins to slide in a set that was too large to seek another solution, and one of a body that controlled bodies
    /// squeeze.
    pub(super) fn is_not_searched(&mut self) -> [bool; 2] {
        let workspace = &mut self.workspace;
        let (begin, forms) = (&workspace.solved.begin, &workspace.forms);
        if begin.is_empty() {
            return [false; 2];
        }
        let search = self.state.auto_state.search();
        workspace.problem.is_not_searched(forms, begin, search)
    }

    /// Collects the results of the contacts that resist rotation.
    pub(super) fn collect_moment_steps(&mut self, start: &StepStart<S>) {
        let mut moment_steps = std::mem::take(&mut self.workspace.solved.moment_steps);
        moment_steps.clear();
        let theta = self.options.scheme.theta;
        let turn = |(k, (form, moment)): (usize, (&MomentForm<S>, solve::MomentSolution<S>))| {
            let contact = &self.state.network.contacts[moment.contact as usize];
            let [before, after] = self.relative_spins_of_moment(k, |b| start.spin(b));
            let spin = before * (1.0 - theta) + after * theta;
            let (twist, bend) = S::split_spin(&contact.normal, &spin);
            MomentStep {
                spin,
                lost: form.loss_twist * twist * twist + form.loss_bend * bend.dot(&bend),
                moment,
            }
        };
        let solved = self
            .workspace
            .moments
            .iter()
            .zip(self.workspace.problem.moments());
        moment_steps.extend(solved.enumerate().map(turn));
        self.workspace.solved.moment_steps = moment_steps;
    }
}
