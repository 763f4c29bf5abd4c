//! End of a run: summary, figures and final output.

use super::drawing::{draw_figure, noted};
use super::error::unreadable;
use super::notice::band;
use super::{Recorder, RunError, unwritable};
use crate::record::checkpoint::FrameKind;
pub(super) use crate::record::checkpoint::SUMMARY_FILE;
use crate::record::output::Output;
use crate::record::summary::Uncertainty;
use fretwork_observe::RunEnd;
use fretwork_observe::accuracy::report_accuracy;
use fretwork_observe::chart::{Figure, TableColumns};
use fretwork_observe::friction_report::Friction;
use fretwork_observe::solving::report_problems;
use fretwork_observe::statistics::Table;
use std::path::Path;
use std::sync::atomic::Ordering;
use std::time::Duration;

impl Recorder<'_> {
    /// Writes the final output of a run, however it ended.
    pub(super) fn finish(&mut self) -> Result<(), RunError> {
        self.lock.check_still_owned()?;
        let statistics_read = self.timed(|t| &mut t.files, Self::read_statistics);
        let wall = self.elapsed_before_resume.0 + self.clock.elapsed();
        let run = &mut self.summary.run;
        run.wall_seconds = wall.as_secs_f64();
        run.cpu_seconds = (self.elapsed_before_resume.1 + self.processor.elapsed()).as_secs_f64();
        let mut found = self.observers.report(&self.end(wall));
        let (written, skipped) = self.problems;
        report_problems(written, skipped, &mut found);
        let driven = self.simulation.bodies().driven.iter();
        let driven = driven
            .map(|d| self.simulation.kinetic_energy(d.body as usize))
            .sum();
        let friction = found.get::<Friction>();
        let repeats = (self.estimate).report(self.simulation.energies(), driven, friction);
        self.uncertainty = Uncertainty::new(&found, repeats);
        self.uncertainty.report(&mut found);
        let accuracy = self.accuracy.as_ref().map(|a| a.report(self.done));
        report_accuracy(accuracy.as_ref(), &mut found);
        self.summary.found = found;
        let notice = band(&self.summary.check());
        let files = noted(notice, || self.files(wall)).and(statistics_read);
        if let (Err(e), None) = (&files, &self.summary.run.stopped) {
            self.summary.run.stopped = Some(e.to_string());
            self.summary.check();
        }
        self.lock.check_still_owned()?;
        let text = serde_json::to_string_pretty(&self.summary).unwrap_or_default();
        write_atomic(&self.out.join(SUMMARY_FILE), &(text + "\n"))?;
        files
    }

    /// The ended run, for observers.
    fn end(&self, wall: Duration) -> RunEnd<'_> {
        RunEnd {
            simulation: self.simulation.view(),
            table: &self.table,
            title: &self.loaded.case.name,
            uncertainty: &self.uncertainty,
            wall,
        }
    }

    /// Reads the rows of the statistics back, if figures or observers need them.
    fn read_statistics(&mut self) -> Result<(), RunError> {
        if !self.has_figures() && !self.observers.read_statistics() {
            return Ok(());
        }
        let path = self.out.join("statistics.csv");
        self.table.recall().map_err(|e| unreadable(&path, &e))
    }

    /// Writes the statistics, the results, the files of observers and the figures. All are
    /// attempted; the first error is returned.
    fn files(&mut self, wall: Duration) -> Result<(), RunError> {
        let written = self.timed(
            |t| &mut t.files,
            |run| {
                let table = run.table.flush();
                let table = table.map_err(|e| unwritable(&run.out.join("statistics.csv"), &e));
                let outputs =
                    write_outputs(&run.out, &run.observers.files(&run.end(wall)), &run.table);
                let figures = run.describe_figures(wall);
                table.and(run.end_results()).and(outputs).and(figures)
            },
        );
        let drawn = self.timed(
            |t| &mut t.pictures,
            |run| {
                let figures = run.draw(wall);
                run.drawing.wait().and(figures)
            },
        );
        written.and(drawn)
    }

    /// Whether figures are drawn: the case requests them, and the run is not stopped in a hurry.
    fn has_figures(&self) -> bool {
        let hurried = self.hurry.is_some_and(|flag| flag.load(Ordering::SeqCst));
        self.loaded.case.output.figures && !hurried
    }

    /// Closes the results file, and marks it as complete if the run reached its end.
    fn end_results(&mut self) -> Result<(), RunError> {
        if self.summary.run.stopped.is_none() {
            if let Some(state) = self.last_state.take() {
                let (number, bytes) = self.checkpoint_writer.frame(FrameKind::State, state);
                self.results.keep_state(number, &bytes)?;
            }
            let (number, bytes) = self.checkpoint_writer.frame(FrameKind::Ended, Vec::new());
            self.results.set_final_checkpoint(number, &bytes);
        }
        Ok(self.results.finish(&self.out)?)
    }

    /// Writes the data of the figures known so far, for the report and for other programs.
    pub(super) fn describe_figures(&self, wall: Duration) -> Result<(), RunError> {
        let outputs = self.observers.figures(&self.end(wall)).into_iter();
        let figure = |output| match output {
            Output::Figure(figure) => Some(figure),
            Output::Text { .. } => None,
        };
        let figures: Vec<Figure> = outputs.filter_map(figure).collect();
        let text = serde_json::to_string(&figures).unwrap_or_default();
        write_atomic(&self.out.join(Figure::FILE), &text)
    }

    /// Draws the figures, unless they are disabled.
    fn draw(&self, wall: Duration) -> Result<(), RunError> {
        if !self.has_figures() {
            return Ok(());
        }
        write_outputs(
            &self.out,
            &self.observers.figures(&self.end(wall)),
            &self.table,
        )
    }
}

/// Writes and draws the outputs of observers into a folder.
///
/// # Errors
/// A file cannot be written.
pub fn write_outputs(folder: &Path, outputs: &[Output], table: &Table) -> Result<(), RunError> {
    outputs.iter().try_for_each(|output| match output {
        Output::Text { file, text } => {
            let path = folder.join(file);
            std::fs::write(&path, text).map_err(|e| unwritable(&path, &e))
        }
        Output::Figure(figure) => {
            let figure = figure.resolve(&TableColumns::of(table));
            let path = folder.join(format!("{}.png", figure.name));
            draw_figure(&figure, &path)
        }
    })
}

/// Writes a file under another name and renames it, so that it is never incomplete.
pub(super) fn write_atomic(path: &Path, text: &str) -> Result<(), RunError> {
    let part = path.with_extension("part");
    std::fs::write(&part, text).map_err(|e| unwritable(&part, &e))?;
    std::fs::rename(&part, path).map_err(|e| unwritable(path, &e))
}
