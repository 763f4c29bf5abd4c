//! Observers: everything that reads the state of a run without changing it. The run loop keeps a
//! list of them, independent of their types; users of the library can add their own.
//!
//! After a step: `before_step` ─► the step ─► `after_step` ─► the processes act between the steps
//! ─► `after_processes` ─► where a row of the statistics is due `sample`. At the end: `report`,
//! `files` and `figures`.

use super::output::Output;
use super::picture::Picture;
use super::quantity::{Findings, Role, Topic};
use super::statistics::{Column, Table};
use super::summary::Uncertainty;
use fretwork_core::code::CodeError;
use fretwork_core::step::StepReport;
use fretwork_core::view::{RunControl, RunView};
use std::fmt::Debug;
use std::time::Duration;

/// A run at its end.
#[derive(Clone, Copy, Debug)]
pub struct RunEnd<'a> {
    /// The simulation, after its last step.
    pub simulation: &'a dyn RunView,
    /// The rows of the statistics, read back.
    pub table: &'a Table,
    /// Title of the case.
    pub title: &'a str,
    /// The main results with what is known of their error. Filled only when files and figures are
    /// written.
    pub uncertainty: &'a Uncertainty,
    /// Time that the run took by the clock.
    pub wall: Duration,
}

/// A table of events in `results.h5`, `/events/NAME`.
#[derive(Clone, Debug, PartialEq)]
pub struct EventTable {
    /// Its name.
    pub name: &'static str,
    /// Its columns, one value an event.
    pub columns: Vec<Column>,
    /// A column of which an event has any number of values, one event after another; `None` where
    /// there is none.
    pub list: Option<Column>,
}

/// An event for a table of events.
#[derive(Clone, Debug, PartialEq)]
pub struct Event {
    /// The table, see [`EventTable`].
    pub table: &'static str,
    /// One value a column.
    pub row: Vec<f64>,
    /// Its values in the list of the table.
    pub list: Vec<f64>,
}

/// Something that looks at a run and leaves columns, events, quantities and files. All but its name
/// may be left out.
pub trait Observer: Debug + Send {
    /// Its name: tells the observers of a run apart in checkpoints.
    fn name(&self) -> String;

    /// The current state is the one from which deformations count: that of the start, and again
    /// that at which the second phase begins.
    fn begin(&mut self, _: &dyn RunView) {}

    /// Whether the simulation is to keep what each contact dissipates in a step
    /// (`network.dissipation`).
    fn needs_dissipation(&self) -> bool {
        false
    }

    /// Whether what it reports, or its files, are made of the rows of the statistics: they are read
    /// back at the end where an observer says so, or where figures are drawn.
    fn reads_statistics(&self) -> bool {
        true
    }

    /// Before a step; it may be called more than once.
    fn before_step(&mut self, _: &dyn RunView) {}

    /// After each step.
    fn after_step(&mut self, _: &dyn RunView, _: &StepReport) {}

    /// Its tables of events; the same over the run.
    fn event_tables(&self) -> Vec<EventTable> {
        Vec::new()
    }

    /// After the processes have acted between two steps: the events of the step.
    fn after_processes(&mut self, _: &dyn RunView) -> Vec<Event> {
        Vec::new()
    }

    /// Its columns in the statistics; the same over the run.
    fn columns(&self) -> Vec<Column> {
        Vec::new()
    }

    /// Values of its columns at the end of a step; it may keep what it needs for the end.
    fn sample(&mut self, _: &dyn RunView) -> Vec<f64> {
        Vec::new()
    }

    /// Its columns of the balls, and then of the pieces, in the recorded states of `results.h5`;
    /// the same over the run.
    fn grain_columns(&self) -> Vec<Column> {
        Vec::new()
    }

    /// Values of its grain columns, one list a column; what is missing at the end is not a number.
    fn grain_values(&self, _: &dyn RunView) -> Vec<Vec<f64>> {
        Vec::new()
    }

    /// Number of the cycle at a time (s), and how many the run has, where it follows cycles.
    fn cycle(&self, _: f64) -> Option<(u32, u32)> {
        None
    }

    /// Lines of text below the pictures of the current step.
    fn caption(&self, _: &dyn RunView) -> Vec<String> {
        Vec::new()
    }

    /// Its pictures of the current step; of two with the same name the first observer's is drawn.
    fn pictures(&self, _: &dyn RunView) -> Vec<Picture> {
        Vec::new()
    }

    /// Names of all pictures that it may have. A run that starts over in a folder first removes
    /// those that an older run left there, `frames/NAME_STEP.png`.
    fn picture_names(&self) -> Vec<&'static str> {
        Vec::new()
    }

    /// Adds what it found to that of a run at its end: quantities and warnings. Observers come in
    /// their order, so that what earlier ones found is there.
    fn report(&self, _: &RunEnd<'_>, _: &mut Findings) {}

    /// Adds what it knows without the simulation, as of its last [`Observer::before_step`]: of a
    /// run that a law ends within a step, and for what is said of a run as it goes.
    fn report_so_far(&self, _: &mut Findings) {}

    /// Files that it writes at the end of a run, independently of `output.figures`.
    fn files(&self, _: &RunEnd<'_>) -> Vec<Output> {
        Vec::new()
    }

    /// Figures of the run, and tables that are written beside them if the case asks for figures
    /// (`output.figures`). Figures are also asked for at the start of a run: its report has them
    /// wherever the run ends.
    fn figures(&self, _: &RunEnd<'_>) -> Vec<Output> {
        Vec::new()
    }

    /// Names of files that it may leave at the end. A run that starts over in a folder first
    /// removes them, so that no file of an older run is taken for one of a run that was stopped;
    /// and no two observers may name the same.
    fn file_names(&self) -> Vec<String> {
        Vec::new()
    }

    /// Encodes the state that the observer carries from step to step for a checkpoint, by
    /// [`fretwork_core::code::encode`]; no bytes if it carries nothing.
    ///
    /// # Errors
    /// It cannot be put into bytes.
    fn save(&self) -> Result<Vec<u8>, CodeError> {
        Ok(Vec::new())
    }

    /// Restores the state that [`Observer::save`] returned.
    ///
    /// # Errors
    /// The bytes do not encode its state.
    fn restore(&mut self, _: &[u8]) -> Result<(), CodeError> {
        Ok(())
    }

    /// The run that it was restored in ends at a time (s), which is later than it was to end where
    /// `later` says so.
    ///
    /// # Errors
    /// Why it cannot go on beyond the end that the run was begun with.
    fn set_end(&mut self, _end: f64, _later: bool) -> Result<(), &'static str> {
        Ok(())
    }
}

/// An observer gave another number of values than it has columns.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "the observer `{observer}` gave {values} values for its {columns} columns of the statistics; it must give one value a column"
)]
pub struct RowError {
    /// Name of the observer.
    pub observer: String,
    /// Number of values.
    pub values: usize,
    /// Number of columns.
    pub columns: usize,
}

/// The state of one observer: its name and its bytes.
pub type ObserverState = (String, Vec<u8>);

/// The observers of a run, in the order of their columns.
#[derive(Debug, Default)]
pub struct Observers {
    list: Vec<Box<dyn Observer>>,
    /// Number of columns of each, known from the first row on.
    widths: Vec<usize>,
}

impl Observers {
    /// Adds one after those that are there.
    pub fn push(&mut self, observer: Box<dyn Observer>) {
        self.list.push(observer);
    }

    /// Adds others after those that are there.
    pub fn append(&mut self, others: Self) {
        self.list.extend(others.list);
    }

    /// All, in the order of their columns.
    pub fn iter(&self) -> impl Iterator<Item = &dyn Observer> {
        self.list.iter().map(|o| &**o)
    }

    /// See [`Observer::begin`].
    pub fn begin(&mut self, run: &mut dyn RunControl) {
        if self.list.iter().any(|o| o.needs_dissipation()) {
            run.options_mut().record_dissipation = true;
        }
        self.list.iter_mut().for_each(|o| o.begin(run));
    }

    /// Whether one reads the rows of the statistics at the end, see [`Observer::reads_statistics`].
    pub fn read_statistics(&self) -> bool {
        self.list.iter().any(|o| o.reads_statistics())
    }

    /// See [`Observer::before_step`].
    pub fn before_step(&mut self, run: &dyn RunView) {
        self.list.iter_mut().for_each(|o| o.before_step(run));
    }

    /// See [`Observer::after_step`].
    pub fn after_step(&mut self, run: &dyn RunView, report: &StepReport) {
        self.list.iter_mut().for_each(|o| o.after_step(run, report));
    }

    /// See [`Observer::after_processes`].
    pub fn after_processes(&mut self, run: &dyn RunView) -> Vec<Event> {
        let list = self.list.iter_mut();
        list.flat_map(|o| o.after_processes(run)).collect()
    }

    /// Columns of all, in their order.
    pub fn columns(&self) -> Vec<Column> {
        self.list.iter().flat_map(|o| o.columns()).collect()
    }

    /// Values of [`Observers::columns`].
    ///
    /// # Errors
    /// An observer gives another number of values than it has columns.
    pub fn sample(&mut self, run: &dyn RunView) -> Result<Vec<f64>, RowError> {
        if self.widths.len() != self.list.len() {
            self.widths = self.list.iter().map(|o| o.columns().len()).collect();
        }
        let mut row = Vec::with_capacity(self.widths.iter().sum());
        for (observer, width) in self.list.iter_mut().zip(&self.widths) {
            let values = observer.sample(run);
            if values.len() != *width {
                return Err(RowError {
                    observer: observer.name(),
                    values: values.len(),
                    columns: *width,
                });
            }
            row.extend(values);
        }
        Ok(row)
    }

    /// See [`Observer::grain_columns`].
    pub fn grain_columns(&self) -> Vec<Column> {
        self.list.iter().flat_map(|o| o.grain_columns()).collect()
    }

    /// See [`Observer::grain_values`].
    pub fn grain_values(&self, run: &dyn RunView) -> Vec<Vec<f64>> {
        self.list.iter().flat_map(|o| o.grain_values(run)).collect()
    }

    /// Of the first that follows cycles, see [`Observer::cycle`].
    pub fn cycle(&self, time: f64) -> Option<(u32, u32)> {
        self.list.iter().find_map(|o| o.cycle(time))
    }

    /// See [`Observer::caption`].
    pub fn caption(&self, run: &dyn RunView) -> Vec<String> {
        self.list.iter().flat_map(|o| o.caption(run)).collect()
    }

    /// The pictures of a moment, each name once.
    pub fn pictures(&self, run: &dyn RunView) -> Vec<Picture> {
        let mut all: Vec<Picture> = Vec::new();
        for picture in self.list.iter().flat_map(|o| o.pictures(run)) {
            if all.iter().all(|p| p.name != picture.name) {
                all.push(picture);
            }
        }
        all
    }

    /// See [`Observer::picture_names`].
    pub fn picture_names(&self) -> Vec<&'static str> {
        self.list.iter().flat_map(|o| o.picture_names()).collect()
    }

    /// See [`Observer::file_names`].
    pub fn file_names(&self) -> Vec<String> {
        self.list.iter().flat_map(|o| o.file_names()).collect()
    }

    /// What all found, see [`Observer::report`].
    pub fn report(&self, end: &RunEnd<'_>) -> Findings {
        let mut found = Findings::new(end.simulation.dimension());
        for observer in &self.list {
            found.begin(Topic::default(), Role::default());
            observer.report(end, &mut found);
        }
        found
    }

    /// What all know without the simulation of a dimension, see [`Observer::report_so_far`].
    pub fn report_so_far(&self, dimension: usize) -> Findings {
        let mut found = Findings::new(dimension);
        for observer in &self.list {
            found.begin(Topic::default(), Role::default());
            observer.report_so_far(&mut found);
        }
        found
    }

    /// The tables of events of all, see [`Observer::event_tables`].
    pub fn event_tables(&self) -> Vec<EventTable> {
        self.list.iter().flat_map(|o| o.event_tables()).collect()
    }

    /// See [`Observer::files`].
    pub fn files(&self, end: &RunEnd<'_>) -> Vec<Output> {
        self.list.iter().flat_map(|o| o.files(end)).collect()
    }

    /// See [`Observer::figures`]; the title of the case heads every figure.
    pub fn figures(&self, end: &RunEnd<'_>) -> Vec<Output> {
        let mut out: Vec<Output> = self.list.iter().flat_map(|o| o.figures(end)).collect();
        for output in &mut out {
            if let Output::Figure(figure) = output {
                figure.heading = end.title.to_owned();
            }
        }
        out
    }

    /// What each carries, see [`Observer::save`].
    ///
    /// # Errors
    /// One cannot be put into bytes.
    pub fn save(&self) -> Result<Vec<ObserverState>, CodeError> {
        let list = self.list.iter();
        list.map(|o| Ok((o.name(), o.save()?))).collect()
    }

    /// Goes on from what [`Observers::save`] gave.
    ///
    /// # Errors
    /// The states are of other observers.
    pub fn restore(&mut self, from: &[ObserverState]) -> Result<(), CodeError> {
        let names = self.list.iter().map(|o| o.name());
        if !names.eq(from.iter().map(|(name, _)| name.clone())) {
            return Err(CodeError::other("observers"));
        }
        let mut pairs = self.list.iter_mut().zip(from);
        pairs.try_for_each(|(observer, (_, bytes))| observer.restore(bytes))
    }

    /// See [`Observer::set_end`].
    ///
    /// # Errors
    /// Why the first that cannot go on does not.
    pub fn set_end(&mut self, end: f64, later: bool) -> Result<(), &'static str> {
        let mut list = self.list.iter_mut();
        list.try_for_each(|o| o.set_end(end, later))
    }
}
