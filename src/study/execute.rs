//! The runs of a study on this machine.

use super::StudyError;
use super::plan::{Plan, Point};
use crate::runs::RunsError;
use crate::runs::launcher::Ended;
use crate::runs::stored::Finished;
use std::collections::{BTreeSet, VecDeque};
use std::path::PathBuf;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};
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
    let queue = Mutex::new(VecDeque::from(points));
    let ended: Mutex<usize> = Mutex::new(0);
    let failure: Mutex<Option<RunsError>> = Mutex::new(None);
    let deadline = Instant::now() + FOREVER;
    let next = || match stop.load(Ordering::Relaxed) {
        true => None,
        false => queue.lock().ok()?.pop_front(),
    };
    let work = || {
        while let Some(point) = next() {
            watch(&Event::Begins(&point));
            match plan
                .launcher
                .run(&point.sets, point.seed, deadline, limit, stop)
            {
                Ok(Ended::Finished(run)) => {
                    watch(&Event::Ended(&point, &run));
                    if let Ok(mut ended) = ended.lock() {
                        *ended += 1;
                    }
                }
                Ok(Ended::Interrupted) => {}
                Err(e) => {
                    if let Ok(mut queue) = queue.lock() {
                        queue.clear();
                    }
                    if let Ok(mut failure) = failure.lock() {
                        *failure = Some(e);
                    }
                }
            }
        }
    };
    std::thread::scope(|scope| {
        for _ in 1..jobs {
            // Fewer jobs if the system provides no more threads.
            let _ = std::thread::Builder::new().spawn_scoped(scope, work);
        }
        work();
    });
    match failure.into_inner() {
        Ok(Some(e)) => Err(e.into()),
        _ => Ok(ended.into_inner().unwrap_or(0)),
    }
}
