//! Checkpoints of a run: their contents, and how a stopped run is restored from them.

use super::clear;
use super::{Recorder, RunError, unwritable};
use crate::record::checkpoint::{FrameKind, ResumeError, ResumePoint, SUMMARY_FILE};
use crate::record::encoding::{EncodingError, decode, encode};
use crate::step::ProcessState;
use fretwork_observe::accuracy::AccuracyControl;
use fretwork_observe::error_estimate::ErrorEstimate;
use fretwork_observe::observer::ObserverState;
use fretwork_observe::output::REPORT;
use fretwork_observe::picture::Paint;
use fretwork_observe::summary::TimeSpent;
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::path::Path;
use std::time::{Duration, Instant};

/// State of the run loop that does not follow from the case and the state of the simulation; in a
/// checkpoint it is stored after the latter. Rows are in the results file; the number of rows that
/// belong to this state is stored here.
#[derive(Serialize, Deserialize)]
struct RunLoopState<'a> {
    /// Number of steps over which states and pictures are distributed.
    spread: u64,
    /// Rows and chunks of each growing dataset of the results, in the order of their declaration.
    rows: Vec<(u64, u32)>,
    paints: Cow<'a, [Paint]>,
    processes: Vec<ProcessState>,
    observers: Vec<ObserverState>,
    problems: (u64, u64),
    unconverged: u64,
    estimate: Cow<'a, ErrorEstimate>,
    accuracy: Cow<'a, Option<AccuracyControl>>,
    /// Number of steps of the case that are done.
    done: u64,
    wall: Duration,
    processor: Duration,
    time_spent: TimeSpent,
}

impl Recorder<'_> {
    /// Writes a checkpoint of the current state to the results.
    pub(super) fn write_checkpoint(&mut self) -> Result<(), RunError> {
        let begun = Instant::now();
        // A resumed run does not draw the pictures before the checkpoint again.
        self.drawing.wait()?;
        let state = self.state()?;
        self.write_frame(FrameKind::State, state)?;
        self.last_state = None;
        // The other files can be regenerated from the results; this one is written for the user to
        // read.
        self.table
            .flush()
            .map_err(|e| unwritable(&self.out.join("statistics.csv"), &e))?;
        self.checkpoint_writer.written(begun);
        Ok(())
    }

    /// Writes a checkpoint frame into the results.
    pub(super) fn write_frame(&mut self, kind: FrameKind, state: Vec<u8>) -> Result<(), RunError> {
        let (number, bytes) = self.checkpoint_writer.frame(kind, state);
        Ok(self.results.checkpoint(number, &bytes)?)
    }

    /// Moves the results file to its final name, with a first checkpoint in it, and opens the
    /// table.
    pub(super) fn publish(&mut self, kind: FrameKind, state: Vec<u8>) -> Result<(), RunError> {
        self.write_frame(kind, state)?;
        // The marker of an earlier finished run and its page are removed: from now on this folder
        // contains an unfinished run.
        for path in [SUMMARY_FILE, REPORT].map(|name| self.out.join(name)) {
            match std::fs::remove_file(&path) {
                Err(e) if e.kind() != std::io::ErrorKind::NotFound && !path.is_dir() => {
                    return Err(unwritable(&path, &e));
                }
                _ => {}
            }
        }
        let results = self.out.join("results.h5");
        let replaces = kind == FrameKind::Begun && results.exists();
        self.results.publish(&results)?;
        if replaces {
            clear::clear(&self.out, &self.observers)?;
        }
        let path = self.out.join("statistics.csv");
        self.table.open(&path).map_err(|e| unwritable(&path, &e))?;
        self.describe_figures(Duration::ZERO)
    }

    /// Whether the next step may be the last, which ends the run in another way than a longer run
    /// would continue: with a row, and with the last phase.
    pub(super) fn near_end(&self) -> bool {
        let longest = self.accuracy.as_ref().map_or(1, AccuracyControl::longest);
        self.checkpoint_writer.keeps_last() && self.total - self.done <= longest
    }

    pub(super) fn state(&mut self) -> Result<Vec<u8>, RunError> {
        let rows = self.results.rows()?;
        let mut bytes = self.simulation.save()?;
        bytes.extend(encode(&RunLoopState {
            spread: self.spread,
            rows,
            paints: Cow::Borrowed(self.camera.paints()),
            processes: self.simulation.save_processes()?,
            observers: self.observers.save()?,
            problems: self.problems,
            unconverged: self.unconverged,
            estimate: Cow::Borrowed(&self.estimate),
            accuracy: Cow::Borrowed(&self.accuracy),
            done: self.done,
            wall: self.elapsed_before_resume.0 + self.clock.elapsed(),
            processor: self.elapsed_before_resume.1 + self.processor.elapsed(),
            time_spent: self.summary.run.time_spent,
        })?);
        Ok(bytes)
    }

    /// Restores the state of a stopped run, and copies its rows up to that state to a new file,
    /// which then replaces the old one.
    pub(super) fn restore(&mut self, stop: ResumePoint) -> Result<(), RunError> {
        let path = stop.results.path().to_owned();
        let refused = |source: EncodingError| ResumeError::State {
            path: path.clone(),
            source,
        };
        let restored = self.simulation.restore(&stop.state).map_err(refused)?;
        let other = || refused(EncodingError::other("bodies or laws"));
        let state: RunLoopState<'_> = decode(restored.ok_or_else(other)?).map_err(refused)?;
        let processes = self.simulation.restore_processes(&state.processes);
        processes.map_err(refused)?;
        self.observers.restore(&state.observers).map_err(refused)?;
        self.set_end(state.spread, &path)?;
        self.camera.paint(state.paints.into_owned());
        (self.done, self.resumed_at) = (state.done, state.done);
        self.accuracy = state.accuracy.into_owned();
        if let Some(accuracy) = &mut self.accuracy {
            accuracy.resume(&mut *self.simulation);
        }
        (self.problems, self.unconverged) = (state.problems, state.unconverged);
        self.estimate = state.estimate.into_owned();
        self.elapsed_before_resume = (state.wall, state.processor);
        self.summary.run.time_spent = state.time_spent;
        self.results.take_over(&stop.results, &state.rows)?;
        let names: Vec<String> = self.table.columns.iter().map(|c| c.name.clone()).collect();
        // The columns of the statistics are declared first.
        let rows = state.rows.first().map_or(0, |r| r.0 as usize);
        let columns = stop.results.statistics(&names, rows)?;
        self.publish(FrameKind::State, stop.state)?;
        let written = self.table.extend(&columns);
        written.map_err(|e| unwritable(&self.out.join("statistics.csv"), &e))?;
        Ok(())
    }

    /// Keeps the spacing of states and pictures with which the run was started, also beyond its
    /// original end.
    fn set_end(&mut self, spread: u64, path: &Path) -> Result<(), ResumeError> {
        self.spread = spread;
        let end = self.loaded.case.time.end;
        let set = self.observers.set_end(end, self.total > spread);
        set.map_err(|why| ResumeError::Longer {
            path: path.to_owned(),
            why,
        })
    }
}
