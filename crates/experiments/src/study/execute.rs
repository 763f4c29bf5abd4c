//! The runs of a study on this machine.

use super::plan::{Plan, Point};
use crate::Error;
use crate::runs::launcher::WaitLimits;
use crate::runs::pool::each;
use crate::runs::stored::FinishedRun;
use std::collections::BTreeSet;
use std::sync::atomic::AtomicBool;
use std::time::Duration;

/// Returns the runs that are still to be made, each once even if several points need it.
pub fn missing(plan: &Plan) -> Vec<Point> {
    let mut seen = BTreeSet::new();
    let open = plan.points().filter(|point| {
        let place = plan.launcher.place(&point.run);
        plan.launcher.stored_in(&place).is_none() && seen.insert(place)
    });
    open.collect()
}

/// Makes runs, several at a time, and calls `watch` with each; returns how many ended. It ends
/// early, without an error, when `stop` is set.
///
/// # Errors
/// A run cannot be started.
pub fn execute(
    plan: &Plan,
    points: Vec<Point>,
    jobs: usize,
    limit: Option<Duration>,
    stop: &AtomicBool,
    watch: &(dyn Fn(&Point, &FinishedRun) + Sync),
) -> Result<usize, Error> {
    let wait = WaitLimits {
        deadline: None,
        limit,
        stop,
    };
    let one = |point: &Point| {
        let ended = plan.launcher.run(&point.run, wait)?;
        if let Some(run) = &ended {
            watch(point, run);
        }
        Ok(ended.is_some())
    };
    let ended = each(&points, jobs, stop, &one)?;
    Ok(ended.into_iter().flatten().filter(|ended| *ended).count())
}
