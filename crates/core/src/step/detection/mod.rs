//! Contacts of a step: those at q_m, and those that close within the step.

mod first_move;
pub(super) mod mean_places;
pub(super) mod projection;

pub(super) use first_move::{watch_first_move, watch_push};

use super::motion::BodyVelocity;
use super::process::Process;
use super::{Simulation, StepError};
use crate::contact::{Contact, detect};
use crate::geometry::space::Space;
use crate::laws::StepInfo;

/// Finds the contacts at the current positions of the bodies.
pub(super) fn find_contacts<S: Space>(s: &mut Simulation<S>) {
    let time = [s.state.time, s.options.scheme.h];
    let (network, bodies) = (&mut s.state.network, &s.state.bodies);
    let scene = detect::CollisionScene::new(&s.shapes, bodies, &s.table);
    detect::detect(network, &scene, time, s.options.solver.parallel);
    mean_places::find(s);
}

/// Adds the contacts that the free velocities (without contact impulses) would close in the step.
pub(super) fn predict_contacts<S: Space>(s: &mut Simulation<S>, free: &[BodyVelocity<S>]) {
    add_predicted(s, free);
    mean_places::find_of_new_contacts(s);
}

fn add_predicted<S: Space>(s: &mut Simulation<S>, free: &[BodyVelocity<S>]) {
    // In a step that spans several steps of the case, the prediction is skipped: bodies that would
    // fall without contacts are held by those at hand. The velocities after the solve show whether
    // this is so.
    if s.options.grown > 0 {
        return;
    }
    let motion = detect::StepMotion {
        velocities: free,
        time: s.state.time,
        h: s.options.scheme.h,
        parallel: s.options.solver.parallel,
    };
    let (network, bodies) = (&mut s.state.network, &s.state.bodies);
    let scene = detect::CollisionScene::new(&s.shapes, bodies, &s.table);
    if !detect::is_calm(network, &scene, |b| free[b], motion.h, motion.parallel) {
        detect::add_predicted(network, &scene, &motion);
    }
}

/// Adds contacts that were found after a solve of the step, at the positions of detection.
pub(super) fn add_contacts<S: Space>(s: &mut Simulation<S>, found: Vec<Contact<S>>) {
    s.state.network.merge_contacts(found);
    mean_places::find_of_new_contacts(s);
}

/// Passes the contacts of the step to processes, gives new contacts their memory, and forms the
/// bonds that are due.
pub(super) fn prepare_contacts<S: Space>(
    s: &mut Simulation<S>,
    info: &StepInfo,
) -> Result<(), StepError> {
    s.act(Process::contacts_found)?;
    let remembered = s.workspace.evaluator.initialise_contacts(
        &s.laws,
        &mut s.state.law_history,
        &mut s.state.network,
        info,
    );
    remembered.map_err(|e| s.law_error(e))
}

/// Records bodies that are stopped by the edges of neighbours that were flush.
pub(super) fn watch_edges<S: Space>(s: &mut Simulation<S>) {
    let tolerance = s.solver_in_force().tolerance;
    let (solved, bodies) = (&s.workspace.solved, &s.state.bodies);
    detect::record_edges(
        &mut s.state.network,
        &s.shapes,
        bodies,
        [s.state.time, s.options.scheme.h],
        tolerance,
        |k, contact| {
            let compliant = solved.springs.get(k).is_some_and(Option::is_some);
            (!compliant).then(|| detect::Impact {
                before: solved.contact_steps[k].before,
                mass: contact.effective_mass(bodies),
            })
        },
    );
}
