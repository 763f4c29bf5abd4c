//! One time step: the list of its stages, in the order of the picture in [`super`].
//!
//! Features beyond bodies in contact act at the named moments of [`Process`]; none of them is named
//! here.

use super::motion::StepStart;
use super::process::Process;
use super::{Scheme, Simulation, StepError, StepReport};
use super::{control, detection, ledger, motion, problem};
use crate::geometry::space::Space;
use crate::laws::StepInfo;
use std::time::Instant;

/// Makes one step, for [`Simulation::step`].
pub(super) fn one_step<S: Space>(s: &mut Simulation<S>) -> Result<StepReport, StepError> {
    detection::projection::check_bodies(s)?;
    s.between_steps()?;
    let mut report = StepReport::default();

    s.act(Process::at_start)?;
    ledger::begin_step(s);
    problem::begin_step(s);
    control::begin_motion(s);
    s.act(Process::before_detection)?;
    detection::watch_push(s);

    let clock = Instant::now();
    let info = step_info(s);
    let mut start = StepStart::new(&s.state.bodies);
    motion::move_to_detection(s);
    detection::find_contacts(s);
    report.projected = detection::projection::project(s);
    let free = motion::free_motion(s, &mut start);
    detection::predict_contacts(s, &free);
    detection::prepare_contacts(s, &info)?;
    report.timing.detect = clock.elapsed();

    problem::solve(s, &start, &free, &info, &mut report)?;
    problem::commit_laws(s, &info, &mut report)?;
    s.act(Process::after_solve)?;

    ledger::close_energy(s, &start, &mut report);
    ledger::close_momentum(s, &start, &mut report);
    detection::watch_edges(s);

    motion::move_to_end(s);
    control::end_motion(s);
    ledger::check_finite(s)?;
    s.act(|process, s| process.after_move(s, &report))?;
    control::end_phase(s);
    s.state.settled = false;
    Ok(report)
}

/// Returns the data of the current step for the laws.
fn step_info<S: Space>(s: &Simulation<S>) -> StepInfo {
    let Scheme { h, theta } = s.options.scheme;
    StepInfo {
        dimension: S::D as u32,
        time: s.state.time,
        h,
        theta,
        correction: s.options.correction,
    }
}
