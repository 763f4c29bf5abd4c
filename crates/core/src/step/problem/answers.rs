//! Contact states of a step: the relative velocities before it, and the solver's results as the
//! laws receive them.

use super::nonlinear_closing::shift_of_gap;
use super::{systems, turning};
use crate::geometry::space::{Space, VectorLike};
use crate::laws::{ContactStep, Interface, MomentStep};
use crate::solve::{self, MomentForm, begins_to_slide};
use crate::step::motion::StepStart;
use crate::step::{Scheme, Simulation};
use crate::threads::fill;
use std::sync::{Mutex, PoisonError};

/// Smallest overlap, over the reduced radius, for which a law is evaluated at a contact that closes
/// within the step: the velocity before the step may not show that it closes.
const CLOSING_OVERLAP: f64 = 1e-3;

/// Returns the velocities of the candidates relative to their antagonists, at the current
/// velocities.
fn fill_relative_velocities<S: Space>(s: &Simulation<S>, list: &mut Vec<S::Vector>) {
    let (bodies, contacts) = (&s.state.bodies, &s.state.network.contacts);
    if s.state.systems.is_empty() {
        let of = |k: usize| contacts[k].relative_velocity(bodies);
        fill(s.divides_contacts(), list, contacts.len(), of);
        s.workspace.surfaces.add_to(list);
        return;
    }
    list.clear();
    list.extend(contacts.iter().enumerate().map(|(k, contact)| {
        let of_sides = systems::relative_velocity_of_sides(s, k);
        of_sides.unwrap_or_else(|| contact.relative_velocity(bodies))
    }));
    s.workspace.surfaces.add_to(list);
}

/// Computes the relative velocities and spins at the start of the step.
pub(super) fn relative_velocities<S: Space>(s: &mut Simulation<S>) {
    let mut before = std::mem::take(&mut s.workspace.solved.before);
    fill_relative_velocities(s, &mut before.relative);
    before.turning.clear();
    if s.laws.iter().any(Interface::rotates) {
        let contacts = s.state.network.contacts.iter();
        before
            .turning
            .extend(contacts.map(|c| turning::relative_spin_before(s, c)));
    }
    before.overlap.clear();
    before.effective_mass.clear();
    if s.laws.iter().any(Interface::compliant) {
        let h = s.options.scheme.h;
        let (network, bodies) = (&s.state.network, &s.state.bodies);
        let (divide, count) = (s.divides_contacts(), network.contacts.len());
        let relative = &before.relative;
        fill(divide, &mut before.overlap, count, |k| {
            // The estimate is at least the current overlap: otherwise a body that separates by more
            // than that in a step would find no spring, and stiff contacts no equilibrium.
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
            network.contacts[k].effective_mass(bodies)
        });
    }
    s.workspace.solved.before = before;
}

/// Collects the results of compliant contacts, which need the velocities at the end of the step.
pub(super) fn collect_spring_steps<S: Space>(s: &mut Simulation<S>) {
    let mut steps = std::mem::take(&mut s.workspace.solved.springs);
    let (springs, forms) = (&s.workspace.springs, &s.workspace.forms);
    let (solved, h) = (&s.workspace.solved, s.options.scheme.h);
    let contacts = &s.state.network.contacts;
    fill(s.divides_contacts(), &mut steps, springs.len(), |k| {
        let contact_step = &solved.contact_steps[k];
        Some(springs[k].as_ref()?.complete(
            &forms[k],
            &contact_step.solution,
            [&solved.after[k], &contact_step.average],
            &contacts[k].spring,
            h,
        ))
    });
    s.workspace.solved.springs = steps;
}

/// Collects the results of all contacts, except those of springs.
pub(super) fn collect_contact_steps<S: Space>(s: &mut Simulation<S>) {
    let mut after = std::mem::take(&mut s.workspace.solved.after);
    fill_relative_velocities(s, &mut after);
    let mut contact_steps = std::mem::take(&mut s.workspace.solved.contact_steps);
    let (before, after_all) = (&s.workspace.solved.before.relative, &after);
    let (forms, problem) = (&s.workspace.forms, &s.workspace.problem);
    let (network, correction) = (&s.state.network, s.options.correction);
    let nonlinear_closing = &s.workspace.nonlinear_closing;
    let Scheme { h, theta } = s.options.scheme;
    let count = network.contacts.len();
    let mut begin = std::mem::take(&mut s.workspace.solved.begin);
    begin.clear();
    let begin = Mutex::new(begin);
    fill(s.divides_contacts(), &mut contact_steps, count, |k| {
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
        // The shift comes from the position correction unless restitution replaced it; a bounce
        // does no correction work.
        let of_gap = shift_of_gap(network, contact, correction, h);
        let closing = nonlinear_closing.get(k).map_or(0.0, |s| s / h);
        let lifts = of_gap < 0.0
            && form.compliance[0] == 0.0
            && n.dot(before) >= form.shift_n
            && form.shift_n == of_gap - closing;
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
    s.workspace.solved.contact_steps = contact_steps;
    s.workspace.solved.after = after;
    let mut begin = begin.into_inner().unwrap_or_else(PoisonError::into_inner);
    begin.sort_unstable();
    s.workspace.solved.begin = begin;
}

/// Returns whether a contact begins to slide in a set that was too large for a search for another
/// solution, and whether such a contact belongs to a body squeezed by controlled bodies.
pub(super) fn is_not_searched<S: Space>(s: &mut Simulation<S>) -> [bool; 2] {
    let workspace = &mut s.workspace;
    let (begin, forms) = (&workspace.solved.begin, &workspace.forms);
    if begin.is_empty() {
        return [false; 2];
    }
    let search = s.state.auto_state.search();
    workspace.problem.is_not_searched(forms, begin, search)
}

/// Collects the results of the contacts that resist rotation.
pub(super) fn collect_moment_steps<S: Space>(s: &mut Simulation<S>, start: &StepStart<S>) {
    let mut moment_steps = std::mem::take(&mut s.workspace.solved.moment_steps);
    moment_steps.clear();
    let theta = s.options.scheme.theta;
    let turn = |(k, (form, moment)): (usize, (&MomentForm<S>, solve::MomentSolution<S>))| {
        let contact = &s.state.network.contacts[moment.contact as usize];
        let [before, after] = turning::relative_spins_of_moment(s, k, |b| start.spin(b));
        let spin = before * (1.0 - theta) + after * theta;
        let (twist, bend) = S::split_spin(&contact.normal, &spin);
        MomentStep {
            spin,
            lost: form.loss_twist * twist * twist + form.loss_bend * bend.dot(&bend),
            moment,
        }
    };
    let solved = s
        .workspace
        .moments
        .iter()
        .zip(s.workspace.problem.moments());
    moment_steps.extend(solved.enumerate().map(turn));
    s.workspace.solved.moment_steps = moment_steps;
}
