//! Observers read the state of a run without changing it. The run loop keeps a list of them,
//! independent of their types; users of the library can add their own.
//!
//! The order of calls in a step is: `before_step` ─► the step ─► `after_step` ─► the processes act
//! between the steps ─► `after_processes` ─► `sample` where a row of the statistics is due. At the
//! end come `report`, `files` and `figures`.

use super::output::Output;
use super::picture::Picture;
use super::quantity::Findings;
use super::statistics::{Column, Table};
use super::summary::Uncertainty;
use fretwork_core::encoding::EncodingError;
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
    /// The main results with their uncertainty, given only when files and figures are written.
    pub uncertainty: &'a Uncertainty,
    /// Wall time of the run.
    pub wall: Duration,
}

/// A table of events in `results.h5`, `/events/NAME`.
#[derive(Clone, Debug, PartialEq)]
pub struct EventTable {
    /// Name of the table, which differs from those of all other observers.
    pub name: &'static str,
    /// Columns, with one value per event.
    pub columns: Vec<Column>,
    /// A column with any number of values per event, one event after another; `None` where there is
    /// none.
    pub list: Option<Column>,
}

/// An event for a table of events.
#[derive(Clone, Debug, PartialEq)]
pub struct Event {
    /// The table, see [`EventTable`].
    pub table: &'static str,
    /// One value per column.
    pub row: Vec<f64>,
    /// Values for the list of the table.
    pub list: Vec<f64>,
}

/// An observer reads a run and produces columns, events, quantities and files. All methods except
/// its name may be left out.
pub trait Observer: Debug + Send {
    /// Returns the name, which identifies the observer in checkpoints.
    fn name(&self) -> String;

    /// Called in the state from which deformations count: at the start, and again when the second
    /// phase begins.
    fn begin(&mut self, _: &dyn RunView) {}

    /// Returns whether the simulation must record the energy that each contact dissipates in a step
    /// (`network.dissipation`).
    fn needs_dissipation(&self) -> bool {
        false
    }

    /// Returns whether its report or files use the rows of the statistics: the rows are read back
    /// at the end if an observer needs them, or if figures are drawn.
    fn reads_statistics(&self) -> bool {
        true
    }

    /// Called before a step; it may be called more than once.
    fn before_step(&mut self, _: &dyn RunView) {}

    /// Called after each step.
    fn after_step(&mut self, _: &dyn RunView, _: &StepReport) {}

    /// Returns its tables of events, which must be the same over the run.
    fn event_tables(&self) -> Vec<EventTable> {
        Vec::new()
    }

    /// Called after the processes have acted between two steps; returns the events of the step.
    fn after_processes(&mut self, _: &dyn RunView) -> Vec<Event> {
        Vec::new()
    }

    /// Returns its columns in the statistics, which must be the same over the run.
    fn columns(&self) -> Vec<Column> {
        Vec::new()
    }

    /// Returns the values of its columns at the end of a step; it may store what it needs for the
    /// end.
    fn sample(&mut self, _: &dyn RunView) -> Vec<f64> {
        Vec::new()
    }

    /// Returns its columns of the balls, and then of the pieces, in the recorded states of
    /// `results.h5`, which must be the same over the run.
    fn grain_columns(&self) -> Vec<Column> {
        Vec::new()
    }

    /// Returns the values of its grain columns, one list per column; missing values at the end
    /// become NaN.
    fn grain_values(&self, _: &dyn RunView) -> Vec<Vec<f64>> {
        Vec::new()
    }

    /// Returns the number of the cycle at a time (s), and the number of cycles of the run, if it
    /// follows cycles.
    fn cycle(&self, _: f64) -> Option<(u32, u32)> {
        None
    }

    /// Returns whether the contact of its friction test slides now; `None` if it follows none, or
    /// none that reciprocates.
    fn slides(&self) -> Option<bool> {
        None
    }

    /// Returns lines of text below the pictures of the current step.
    fn caption(&self, _: &dyn RunView) -> Vec<String> {
        Vec::new()
    }

    /// Returns its pictures of the current step; of two pictures with the same name that of the
    /// first observer is drawn.
    fn pictures(&self, _: &dyn RunView) -> Vec<Picture> {
        Vec::new()
    }

    /// Returns the names of all pictures that it may produce. A run that starts again in a folder
    /// first removes those of an older run, `frames/NAME_STEP.png`.
    fn picture_names(&self) -> Vec<&'static str> {
        Vec::new()
    }

    /// Returns the names of the observers whose results [`Observer::report`] reads: they report
    /// before, wherever they stand.
    fn reads_results_of(&self) -> &'static [&'static str] {
        &[]
    }

    /// Adds its results at the end of a run: quantities and warnings. Observers are called in their
    /// order, but for [`Observer::reads_results_of`]: results of earlier ones are available.
    fn report(&self, _: &RunEnd<'_>, _: &mut Findings) {}

    /// Adds results that need no simulation, as of its last [`Observer::before_step`]: for a run
    /// that a law ends within a step, and for messages during a run.
    fn report_so_far(&self, _: &mut Findings) {}

    /// Returns the files that it writes at the end of a run, independently of `output.figures`.
    fn files(&self, _: &RunEnd<'_>) -> Vec<Output> {
        Vec::new()
    }

    /// Returns figures of the run, and tables that are written with them if the case requests
    /// figures (`output.figures`). Figures are also requested at the start of a run, since its
    /// report contains them wherever the run ends.
    fn figures(&self, _: &RunEnd<'_>) -> Vec<Output> {
        Vec::new()
    }

    /// Returns the names of files that it may leave at the end. A run that starts again in a folder
    /// first removes them, so that files of an older run are not mistaken for those of a stopped
    /// run. Names must differ between observers.
    fn file_names(&self) -> Vec<String> {
        Vec::new()
    }

    /// Encodes the state that the observer carries from step to step for a checkpoint, by
    /// [`fretwork_core::encoding::encode`]; no bytes if there is none.
    ///
    /// # Errors
    /// The state cannot be encoded.
    fn save(&self) -> Result<Vec<u8>, EncodingError> {
        Ok(Vec::new())
    }

    /// Restores the state that [`Observer::save`] returned.
    ///
    /// # Errors
    /// The bytes do not encode its state.
    fn restore(&mut self, _: &[u8]) -> Result<(), EncodingError> {
        Ok(())
    }

    /// Called after restoring, if the run ends at another time (s); `later` says whether that is
    /// later than the previous end.
    ///
    /// # Errors
    /// Returns why it cannot continue beyond the end with which the run was started.
    fn set_end(&mut self, _end: f64, _later: bool) -> Result<(), &'static str> {
        Ok(())
    }
}

/// An observer returned a number of values different from that of its columns.
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
    /// Number of columns of each observer, known from the first row on.
    widths: Vec<usize>,
}

impl Observers {
    /// Adds an observer after the existing ones.
    pub fn push(&mut self, observer: Box<dyn Observer>) {
        self.list.push(observer);
    }

    /// Adds observers after the existing ones.
    pub fn append(&mut self, others: Self) {
        self.list.extend(others.list);
    }

    /// Iterates over all observers, in the order of their columns.
    pub fn iter(&self) -> impl Iterator<Item = &dyn Observer> {
        self.list.iter().map(|o| &**o)
    }

    /// Calls [`Observer::begin`] of all observers.
    pub fn begin(&mut self, run: &mut dyn RunControl) {
        if self.list.iter().any(|o| o.needs_dissipation()) {
            run.options_mut().record_dissipation = true;
        }
        self.list.iter_mut().for_each(|o| o.begin(run));
    }

    /// Returns whether an observer reads the rows of the statistics at the end, see
    /// [`Observer::reads_statistics`].
    pub fn read_statistics(&self) -> bool {
        self.list.iter().any(|o| o.reads_statistics())
    }

    /// Calls [`Observer::before_step`] of all observers.
    pub fn before_step(&mut self, run: &dyn RunView) {
        self.list.iter_mut().for_each(|o| o.before_step(run));
    }

    /// Returns the first answer to [`Observer::slides`].
    pub fn slides(&self) -> Option<bool> {
        self.list.iter().find_map(|o| o.slides())
    }

    /// Calls [`Observer::after_step`] of all observers.
    pub fn after_step(&mut self, run: &dyn RunView, report: &StepReport) {
        self.list.iter_mut().for_each(|o| o.after_step(run, report));
    }

    /// Calls [`Observer::after_processes`] of all observers, and returns their events.
    pub fn after_processes(&mut self, run: &dyn RunView) -> Vec<Event> {
        let list = self.list.iter_mut();
        list.flat_map(|o| o.after_processes(run)).collect()
    }

    /// Returns the columns of all observers, in their order.
    pub fn columns(&self) -> Vec<Column> {
        self.list.iter().flat_map(|o| o.columns()).collect()
    }

    /// Returns the values of [`Observers::columns`].
    ///
    /// # Errors
    /// An observer returns a number of values different from that of its columns.
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

    /// Returns the columns of [`Observer::grain_columns`] of all observers.
    pub fn grain_columns(&self) -> Vec<Column> {
        self.list.iter().flat_map(|o| o.grain_columns()).collect()
    }

    /// Returns the values of [`Observer::grain_values`] of all observers.
    pub fn grain_values(&self, run: &dyn RunView) -> Vec<Vec<f64>> {
        self.list.iter().flat_map(|o| o.grain_values(run)).collect()
    }

    /// Returns the cycle of the first observer that follows cycles, see [`Observer::cycle`].
    pub fn cycle(&self, time: f64) -> Option<(u32, u32)> {
        self.list.iter().find_map(|o| o.cycle(time))
    }

    /// Returns the lines of [`Observer::caption`] of all observers.
    pub fn caption(&self, run: &dyn RunView) -> Vec<String> {
        self.list.iter().flat_map(|o| o.caption(run)).collect()
    }

    /// Returns the pictures at this time, each name once.
    pub fn pictures(&self, run: &dyn RunView) -> Vec<Picture> {
        let mut all: Vec<Picture> = Vec::new();
        for picture in self.list.iter().flat_map(|o| o.pictures(run)) {
            if all.iter().all(|p| p.name != picture.name) {
                all.push(picture);
            }
        }
        all
    }

    /// Returns the names of [`Observer::picture_names`] of all observers.
    pub fn picture_names(&self) -> Vec<&'static str> {
        self.list.iter().flat_map(|o| o.picture_names()).collect()
    }

    /// Returns the names of [`Observer::file_names`] of all observers.
    pub fn file_names(&self) -> Vec<String> {
        self.list.iter().flat_map(|o| o.file_names()).collect()
    }

    /// Returns the results of all observers, see [`Observer::report`].
    pub fn report(&self, end: &RunEnd<'_>) -> Findings {
        let mut found = Findings::new(end.simulation.dimension());
        for observer in self.in_order_of_reports() {
            found.begin_observer(&observer.name());
            observer.report(end, &mut found);
        }
        found.begin_observer("");
        found
    }

    /// Returns the observers in their order, each after those whose results it reads; where two
    /// read each other's, in their order.
    fn in_order_of_reports(&self) -> Vec<&dyn Observer> {
        let mut waiting: Vec<&dyn Observer> = self.list.iter().map(AsRef::as_ref).collect();
        let mut out = Vec::with_capacity(waiting.len());
        while !waiting.is_empty() {
            let names: Vec<String> = waiting.iter().map(|o| o.name()).collect();
            let ready = waiting.iter().position(|o| {
                let mut reads = o.reads_results_of().iter();
                reads.all(|name| !names.iter().any(|n| n == name))
            });
            out.push(waiting.remove(ready.unwrap_or(0)));
        }
        out
    }

    /// Returns the results that need no simulation, see [`Observer::report_so_far`].
    pub fn report_so_far(&self, dimension: usize) -> Findings {
        let mut found = Findings::new(dimension);
        for observer in &self.list {
            found.begin_observer(&observer.name());
            observer.report_so_far(&mut found);
        }
        found.begin_observer("");
        found
    }

    /// The tables of events of all, see [`Observer::event_tables`].
    pub fn event_tables(&self) -> Vec<EventTable> {
        self.list.iter().flat_map(|o| o.event_tables()).collect()
    }

    /// Returns the files of [`Observer::files`] of all observers.
    pub fn files(&self, end: &RunEnd<'_>) -> Vec<Output> {
        self.list.iter().flat_map(|o| o.files(end)).collect()
    }

    /// Returns the figures of [`Observer::figures`] of all observers; the title of the case heads
    /// every figure.
    pub fn figures(&self, end: &RunEnd<'_>) -> Vec<Output> {
        let mut out: Vec<Output> = self.list.iter().flat_map(|o| o.figures(end)).collect();
        for output in &mut out {
            if let Output::Figure(figure) = output {
                figure.heading = end.title.to_owned();
            }
        }
        out
    }

    /// Returns the states of all observers, see [`Observer::save`].
    ///
    /// # Errors
    /// A state cannot be encoded.
    pub fn save(&self) -> Result<Vec<ObserverState>, EncodingError> {
        let list = self.list.iter();
        list.map(|o| Ok((o.name(), o.save()?))).collect()
    }

    /// Restores the states that [`Observers::save`] returned.
    ///
    /// # Errors
    /// The states belong to other observers.
    pub fn restore(&mut self, from: &[ObserverState]) -> Result<(), EncodingError> {
        let names = self.list.iter().map(|o| o.name());
        if !names.eq(from.iter().map(|(name, _)| name.clone())) {
            return Err(EncodingError::other("observers"));
        }
        let mut pairs = self.list.iter_mut().zip(from);
        pairs.try_for_each(|(observer, (_, bytes))| observer.restore(bytes))
    }

    /// Calls [`Observer::set_end`] of all observers.
    ///
    /// # Errors
    /// Returns the error of the first observer that cannot continue.
    pub fn set_end(&mut self, end: f64, later: bool) -> Result<(), &'static str> {
        let mut list = self.list.iter_mut();
        list.try_for_each(|o| o.set_end(end, later))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Debug)]
    struct Named(&'static str, &'static [&'static str]);

    impl Observer for Named {
        fn name(&self) -> String {
            self.0.to_owned()
        }

        fn reads_results_of(&self) -> &'static [&'static str] {
            self.1
        }
    }

    fn order(list: &[(&'static str, &'static [&'static str])]) -> Vec<String> {
        let mut all = Observers::default();
        for &(name, reads) in list {
            all.push(Box::new(Named(name, reads)));
        }
        let found = all.in_order_of_reports();
        found.iter().map(|o| o.name()).collect()
    }

    #[test]
    fn observers_report_after_those_whose_results_they_read() {
        assert_eq!(order(&[("a", &[]), ("b", &["a"])]), ["a", "b"]);
        assert_eq!(
            order(&[("b", &["a", "none"]), ("c", &[]), ("a", &["c"])]),
            ["c", "a", "b"]
        );
        // Two that read each other's results keep their order.
        assert_eq!(order(&[("a", &["b"]), ("b", &["a"])]), ["a", "b"]);
    }
}
