//! Emergency output, written by the plugin watchdog if a law does not return from a step.
//!
//! The blocked thread owns the simulation in the middle of a step, so no other thread may read it. The run's
//! files are not used during a step: before each step they are handed to the watchdog, together with the
//! summary so far, and taken back afterwards.

use super::Recorder;
use super::end::{self, LAST};
use super::notice;
use crate::laws::watch::{self, Ready};
use crate::record::friction::Cycles;
use crate::record::results::Results;
use crate::record::statistics::Table;
use crate::record::summary::Summary;
use crate::record::warnings;
use crate::step::Steps;
use crate::step::{StepError, StepReport};
use cpu_time::ProcessTime;
use std::path::PathBuf;
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

/// Everything that can be written without the simulation.
struct UnsavedOutputs {
    table: Table,
    results: Results,
    cycles: Option<(Cycles, usize)>,
    summary: Summary,
    /// Wall and processor time of earlier parts of a resumed run.
    spent: (Duration, Duration),
}

/// Shared slot that holds it during a step.
#[derive(Debug)]
pub(super) struct EmergencySave {
    left: Arc<Mutex<Option<UnsavedOutputs>>>,
    _ready: Ready,
}

impl std::fmt::Debug for UnsavedOutputs {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Left").finish_non_exhaustive()
    }
}

impl EmergencySave {
    /// An empty slot, registered with the watchdog.
    pub fn new(out: PathBuf) -> Self {
        let left = Arc::new(Mutex::new(None));
        let place = Arc::clone(&left);
        let (clock, processor) = (Instant::now(), ProcessTime::now());
        let ready = watch::rescue(move |who| {
            let left: Option<UnsavedOutputs> = place.lock().ok().and_then(|mut l| l.take());
            left.is_some_and(|mut left| {
                left.summary.wall_seconds = (left.spent.0 + clock.elapsed()).as_secs_f64();
                left.summary.cpu_seconds = (left.spent.1 + processor.elapsed()).as_secs_f64();
                left.write(who, &out)
            })
        });
        Self {
            left,
            _ready: ready,
        }
    }
}

impl UnsavedOutputs {
    /// Writes the output; returns whether all of it is on disk.
    fn write(&mut self, who: &str, out: &std::path::Path) -> bool {
        let summary = &mut self.summary;
        summary.stopped = Some(who.to_owned());
        end::sum_up(summary, self.cycles.as_ref().map(|(c, _)| c));
        let list = warnings::of(summary, None);
        notice::judge(summary, &list);
        let text = serde_json::to_string_pretty(summary).unwrap_or_default();
        let table = self.table.flush().is_ok();
        let results = self.results.finish(out).is_ok();
        end::whole(&out.join(LAST), &(text + "\n")).is_ok() && table && results
    }
}

impl<S: Steps> Recorder<'_, S> {
    /// Makes a step during which the watchdog can save the records.
    pub(super) fn step(&mut self) -> Result<StepReport, StepError> {
        self.count();
        let left = UnsavedOutputs {
            table: std::mem::take(&mut self.table),
            results: std::mem::take(&mut self.results),
            cycles: self.cycles.take(),
            summary: std::mem::take(&mut self.summary),
            spent: self.spent,
        };
        let place = || self.refuge.left.lock().unwrap_or_else(|e| e.into_inner());
        *place() = Some(left);
        let report = self.simulation.step();
        let Some(left) = place().take() else {
            // The watchdog took the output just before the law returned: the program is ending.
            loop {
                std::thread::park();
            }
        };
        self.table = left.table;
        self.results = left.results;
        self.cycles = left.cycles;
        self.summary = left.summary;
        report
    }
}
