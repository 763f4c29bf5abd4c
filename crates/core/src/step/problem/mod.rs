//! The contact problem of a step: contacts in the standard form, solved until laws, damage and
//! contacts agree with the resulting velocities.

mod action;
mod agreement;
mod answers;
mod attraction;
mod coupling;
mod law_step;
mod nonlinear_closing;
mod posing;
mod sliding;
pub(super) mod surfaces;
mod systems;
mod turning;

use super::detection::{add_contacts, prepare_contacts};
use super::motion::{BodyVelocity, StepStart, restart};
use super::{Simulation, StepError, StepReport};
use crate::contact::{Key, Occurrence, detect};
use crate::geometry::space::{Space, VectorLike};
use crate::laws::StepInfo;
use crate::threads::{count, fill, worth_dividing};
use std::time::Instant;

/// Maximum number of solves of a step: each solve may close contacts that the previous one did not.
const MAX_SOLVES: usize = 6;
/// Approximate time to copy the velocity of a body, and to check whether a contact carries an
/// impulse (ns).
const COPY: f64 = 3.0;
const ACTS: f64 = 5.0;

/// Solves the step, and repeats while the resulting velocities close contacts that were not part of
/// the problem.
pub(super) fn solve<S: Space>(
    s: &mut Simulation<S>,
    start: &StepStart<S>,
    free: &[BodyVelocity<S>],
    info: &StepInfo,
    report: &mut StepReport,
) -> Result<(), StepError> {
    solve_with_all(s, start, free, info, report)?;
    report_held_back(s);
    Ok(())
}

fn solve_with_all<S: Space>(
    s: &mut Simulation<S>,
    start: &StepStart<S>,
    free: &[BodyVelocity<S>],
    info: &StepInfo,
    report: &mut StepReport,
) -> Result<(), StepError> {
    let mut last: Vec<(Key, S::Vector)> = Vec::new();
    systems::forget_system_contacts(s);
    for solves in 1.. {
        action::place_actions(s);
        systems::find_system_contacts(s);
        answers::relative_velocities(s);
        posing::geometry_of_forms(s, free, info.h);
        for (form, contact) in s.workspace.forms.iter_mut().zip(&s.state.network.contacts) {
            // Initial impulses come from the previous solve.
            if let Ok(at) = last.binary_search_by_key(&contact.key, |c| c.0) {
                form.impulse = last[at].1;
            }
        }
        coupling::couple(s, start, free, info, report)?;
        report.solves = solves as u32;
        let (network, bodies) = (&mut s.state.network, &s.state.bodies);
        let velocity = |b: usize| (bodies.velocity[b], bodies.spin[b]);
        let scene = detect::CollisionScene::new(&s.shapes, bodies, &s.table);
        let parallel = s.options.solver.parallel;
        if detect::is_calm(network, &scene, velocity, info.h, parallel) {
            return Ok(());
        }
        let (mut velocities, divide) = (Vec::new(), worth_dividing(parallel, bodies.len(), COPY));
        fill(divide, &mut velocities, bodies.len(), velocity);
        let motion = detect::StepMotion {
            velocities: &velocities,
            time: s.state.time,
            h: info.h,
            parallel,
        };
        if solves == MAX_SOLVES {
            detect::report_passing(network, &scene, &motion);
            return Ok(());
        }
        let (steps, forms) = (&s.workspace.solved.contact_steps, &s.workspace.forms);
        let pushes = |k: usize| steps[k].solution.unilateral_n + forms[k].tension > 0.0;
        let found = detect::find_missed(network, &scene, &motion, pushes);
        if found.is_empty() {
            return Ok(());
        }
        let solved = network
            .contacts
            .iter()
            .zip(&s.workspace.solved.contact_steps);
        last = solved.map(|(c, s)| (c.key, s.solution.impulse)).collect();
        restart(s, start);
        add_contacts(s, found);
        prepare_contacts(s, info)?;
    }
    Ok(())
}

/// Reports impacts with restitution that were only kept from closing, because other impacts of the
/// step preceded them.
fn report_held_back<S: Space>(s: &mut Simulation<S>) {
    for k in &s.workspace.evaluator.held_back {
        if s.workspace.solved.contact_steps[*k].solution.impulse != S::Vector::zero() {
            let pair = s.state.network.contacts[*k].bodies;
            let (time, bodies) = (s.state.time, &s.state.bodies);
            let first = || Occurrence::new(time, bodies, &pair);
            s.state.network.step_size.record_held_back(first);
        }
    }
}

/// Clears the work arrays of the last step.
pub(super) fn begin_step<S: Space>(s: &mut Simulation<S>) {
    s.workspace.evaluator.parallel = s.options.solver.parallel;
    s.workspace.surfaces.velocities.clear();
    s.workspace.surfaces.work = 0.0;
    s.workspace.pushed = false;
    s.state.auto_state.begin_step();
}

/// Lets laws update damage, bonds and wear with the impulses of the step, and counts its contacts.
pub(super) fn commit_laws<S: Space>(
    s: &mut Simulation<S>,
    info: &StepInfo,
    report: &mut StepReport,
) -> Result<(), StepError> {
    let clock = Instant::now();
    let committed = s.workspace.evaluator.commit(
        &s.laws,
        &mut s.state.law_history,
        &mut s.state.network,
        &s.workspace.solved.step(info),
    );
    report.totals = committed.map_err(|e| s.law_error(e))?;
    s.state.network.locate_breaks(&s.state.bodies);
    report.timing.laws += clock.elapsed();
    let steps = &s.workspace.solved.contact_steps;
    let acts = |k: usize| steps[k].solution.impulse != S::Vector::zero();
    report.active = count(s.options.solver.parallel, steps.len(), ACTS, acts);
    let beyond = s.workspace.evaluator.beyond();
    report.contacts = steps.len() - beyond.filter(|k| !acts(*k)).count();
    debug_assert_eq!(
        report.contacts,
        s.state.network.contact_count(false),
        "contacts of the step"
    );
    Ok(())
}
