//! Output that the watch over plugins writes if a law does not return during a step.
//!
//! The thread that hangs owns the simulation in the middle of a step, so nobody else may read it.
//! The files and observers of the run are not used during a step. Before a step they are therefore
//! stored where the watch finds them, with what is known at that time, and they are taken back
//! after the step. Whoever started the watch decides how the program ends.

use super::end::{self, SUMMARY_FILE};
use super::{Recorder, RunError};
use crate::laws::watch::{self, RescueGuard};
use crate::record::results::Results;
use crate::record::statistics::Table;
use crate::record::summary::{Summary, Uncertainty};
use crate::step::StepReport;
use cpu_time::ProcessTime;
use fretwork_observe::Observers;
use fretwork_observe::error_estimate::Repeats;
use fretwork_store::folder_lock::FolderLock;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

/// All outputs that can be written without the simulation.
struct UnsavedOutputs {
    table: Table,
    results: Results,
    observers: Observers,
    summary: Summary,
    /// Wall and processor time of the parts of the run before it was resumed.
    spent: (Duration, Duration),
}

/// The shared slot that holds the outputs during a step.
pub(super) struct EmergencySave {
    outputs: Arc<Mutex<Option<UnsavedOutputs>>>,
    _ready: RescueGuard,
}

impl EmergencySave {
    /// Creates an empty slot and registers it with the watch.
    pub fn new(out: PathBuf, lock: FolderLock) -> Self {
        let outputs: Arc<Mutex<Option<UnsavedOutputs>>> = Arc::new(Mutex::new(None));
        let place = Arc::clone(&outputs);
        let (clock, processor) = (Instant::now(), ProcessTime::now());
        let ready = watch::rescue(move |who| {
            let outputs = place.lock().ok().and_then(|mut l| l.take());
            outputs.is_some_and(|mut outputs| {
                let spent = outputs.spent;
                outputs.summary.run.wall_seconds = (spent.0 + clock.elapsed()).as_secs_f64();
                outputs.summary.run.cpu_seconds = (spent.1 + processor.elapsed()).as_secs_f64();
                lock.check_still_owned().is_ok() && outputs.write(who, &out)
            })
        });
        Self {
            outputs,
            _ready: ready,
        }
    }
}

impl UnsavedOutputs {
    /// Writes the outputs; returns whether all of them are on disk.
    fn write(&mut self, who: &str, out: &Path) -> bool {
        let summary = &mut self.summary;
        summary.run.stopped = Some(who.to_owned());
        summary.found = self.observers.report_so_far(summary.run.dimension);
        let estimate = Uncertainty::new(&summary.found, Repeats::default());
        estimate.report(&mut summary.found);
        summary.check();
        let text = serde_json::to_string_pretty(summary).unwrap_or_default();
        let table = self.table.flush().is_ok();
        let results = self.results.finish(out).is_ok();
        end::write_atomic(&out.join(SUMMARY_FILE), &(text + "\n")).is_ok() && table && results
    }
}

impl Recorder<'_> {
    /// Makes a step, during which the watch can save what was recorded.
    pub(super) fn step(&mut self) -> Result<StepReport, RunError> {
        let begun = Instant::now();
        self.observers.before_step(self.simulation.view());
        let slides = self.observers.slides();
        let outputs = UnsavedOutputs {
            table: std::mem::take(&mut self.table),
            results: std::mem::take(&mut self.results),
            observers: std::mem::take(&mut self.observers),
            summary: std::mem::take(&mut self.summary),
            spent: self.elapsed_before_resume,
        };
        let place = Arc::clone(&self.emergency.outputs);
        let place = || place.lock().unwrap_or_else(|e| e.into_inner());
        *place() = Some(outputs);
        // A law may also hang in a repeated step.
        let repeated = (self.estimate).before_step(&mut *self.simulation, self.done, slides);
        let repeated = repeated.map_err(RunError::from);
        let report = repeated.and_then(|()| self.part());
        // If the slot is empty, the watch took and wrote the outputs just before the law returned.
        let outputs = place().take().ok_or(RunError::TakenOver)?;
        self.table = outputs.table;
        self.results = outputs.results;
        self.observers = outputs.observers;
        self.summary = outputs.summary;
        let report = report?;
        self.add_step(begun, &report);
        Ok(report)
    }

    /// Makes a step, or a part of one if the run chooses the number of parts.
    fn part(&mut self) -> Result<StepReport, RunError> {
        let most = self.until_record();
        let Some(control) = &mut self.accuracy else {
            return Ok(self.simulation.step()?);
        };
        let spans = [self.done, self.total];
        let parts = match &mut self.parts {
            Some(parts) => parts,
            none => none.insert(control.begin_step(&mut *self.simulation, spans, most)?),
        };
        let report = loop {
            if let Some(report) = control.part(&mut *self.simulation, parts)? {
                break report;
            }
        };
        if control.complete(parts) {
            self.parts = None;
        }
        Ok(report)
    }
}
