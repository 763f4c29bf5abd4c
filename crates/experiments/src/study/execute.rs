//! The runs of a study on this machine.

use super::StudyError;
use super::plan::{Plan, Point};
use crate::runs::launcher::Ended;
use crate::runs::pool::each;
use crate::runs::stored::Finished;
use std::collections::BTreeSet;
use std::path::PathBuf;
use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

/// Event for a display of progress.
#[derive(Debug)]
pub enum Event<'a> {
    /// A run begins.
    Begins(&'a Point),
    /// A run ended.
    Ended(&'a Point, &'a Finished),
}

/// A time that no run reaches.
const FOREVER: Duration = Duration::from_secs(100 * 365 * 86_400);

/// Runs that are still to be made, each once however many points need it.
pub fn missing(plan: &Plan) -> Vec<(Point, PathBuf)> {
    let mut seen = BTreeSet::new();
    let all = plan.points().map(|p| (plan.place(&p), p));
    let fresh = all.filter(|(place, _)| seen.insert(place.clone()));
    let open = fresh.filter(|(place, _)| plan.launcher.stored_in(place).is_none());
    open.map(|(place, point)| (point, place)).collect()
}

/// Makes runs, several at a time; returns how many ended. It ends early, without an error, when `stop` is set.
///
/// # Errors
/// A run cannot be started.
pub fn execute(
    plan: &Plan,
    points: Vec<Point>,
    jobs: usize,
    limit: Option<Duration>,
    stop: &AtomicBool,
    watch: &(dyn Fn(&Event<'_>) + Sync),
) -> Result<usize, StudyError> {
    let deadline = Instant::now() + FOREVER;
    let one = |point: &Point| {
        watch(&Event::Begins(point));
        let ended = plan
            .launcher
            .run(&point.sets, point.seed, deadline, limit, stop)?;
        if let Ended::Finished(run) = &ended {
            watch(&Event::Ended(point, run));
        }
        Ok(matches!(ended, Ended::Finished(_)))
    };
    let ended = each(&points, jobs, stop, &one)?;
    Ok(ended.into_iter().flatten().filter(|ended| *ended).count())
}
