//! Observers that still read a simulation in its dimension.

use super::observer::{Event, EventTable, Observer, RunEnd};
use super::output::Output;
use super::picture::Picture;
use super::quantity::Findings;
use super::statistics::{Column, Table};
use super::summary::Uncertainty;
use fretwork_core::code::CodeError;
use fretwork_core::geometry::space::Space;
use fretwork_core::step::{Simulation, StepReport};
use fretwork_core::view::RunView;
use std::fmt::Debug;
use std::marker::PhantomData;
use std::time::Duration;

/// The end of a run, see [`RunEnd`], in the dimension of the run.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RunEndIn<'a, S: Space> {
    pub simulation: &'a Simulation<S>,
    pub table: &'a Table,
    pub uncertainty: &'a Uncertainty,
    pub wall: Duration,
}

impl<'a, S: Space> RunEndIn<'a, S> {
    fn of(end: &RunEnd<'a>) -> Self {
        Self {
            simulation: end.simulation.in_dimension().get(),
            table: end.table,
            uncertainty: end.uncertainty,
            wall: end.wall,
        }
    }
}

/// [`Observer`] in the dimension of the run.
pub(crate) trait ObserverIn<S: Space>: Debug + Send {
    fn name(&self) -> String;
    fn begin(&mut self, _: &Simulation<S>) {}
    fn needs_dissipation(&self) -> bool {
        false
    }
    fn reads_statistics(&self) -> bool {
        true
    }
    fn before_step(&mut self, _: &Simulation<S>) {}
    fn after_step(&mut self, _: &Simulation<S>, _: &StepReport) {}
    fn event_tables(&self) -> Vec<EventTable> {
        Vec::new()
    }
    fn after_processes(&mut self, _: &Simulation<S>) -> Vec<Event> {
        Vec::new()
    }
    fn columns(&self) -> Vec<Column> {
        Vec::new()
    }
    fn sample(&mut self, _: &Simulation<S>) -> Vec<f64> {
        Vec::new()
    }
    fn grain_columns(&self) -> Vec<Column> {
        Vec::new()
    }
    fn grain_values(&self, _: &Simulation<S>) -> Vec<Vec<f64>> {
        Vec::new()
    }
    fn cycle(&self, _: f64) -> Option<(u32, u32)> {
        None
    }
    fn caption(&self, _: &Simulation<S>) -> Vec<String> {
        Vec::new()
    }
    fn pictures(&self, _: &Simulation<S>) -> Vec<Picture> {
        Vec::new()
    }
    fn picture_names(&self) -> Vec<&'static str> {
        Vec::new()
    }
    fn report(&self, _: &RunEndIn<'_, S>, _: &mut Findings) {}
    fn report_so_far(&self, _: &mut Findings) {}
    fn files(&self, _: &RunEndIn<'_, S>) -> Vec<Output> {
        Vec::new()
    }
    fn figures(&self, _: &RunEndIn<'_, S>) -> Vec<Output> {
        Vec::new()
    }
    fn file_names(&self) -> Vec<String> {
        Vec::new()
    }
    fn save(&self) -> Result<Vec<u8>, CodeError> {
        Ok(Vec::new())
    }
    fn restore(&mut self, _: &[u8]) -> Result<(), CodeError> {
        Ok(())
    }
    fn set_end(&mut self, _end: f64, _later: bool) -> Result<(), &'static str> {
        Ok(())
    }
}

/// An observer of runs of one dimension as one of any.
pub(crate) fn in_dimension<S: Space, O: ObserverIn<S> + 'static>(observer: O) -> Box<dyn Observer> {
    Box::new(In(observer, PhantomData::<S>))
}

/// An observer of runs of one dimension.
#[derive(Debug)]
struct In<S, O>(O, PhantomData<S>);

impl<S: Space, O: ObserverIn<S>> Observer for In<S, O> {
    fn name(&self) -> String {
        self.0.name()
    }
    fn begin(&mut self, run: &dyn RunView) {
        self.0.begin(run.in_dimension().get())
    }
    fn needs_dissipation(&self) -> bool {
        self.0.needs_dissipation()
    }
    fn reads_statistics(&self) -> bool {
        self.0.reads_statistics()
    }
    fn before_step(&mut self, run: &dyn RunView) {
        self.0.before_step(run.in_dimension().get())
    }
    fn after_step(&mut self, run: &dyn RunView, b: &StepReport) {
        self.0.after_step(run.in_dimension().get(), b)
    }
    fn event_tables(&self) -> Vec<EventTable> {
        self.0.event_tables()
    }
    fn after_processes(&mut self, run: &dyn RunView) -> Vec<Event> {
        self.0.after_processes(run.in_dimension().get())
    }
    fn columns(&self) -> Vec<Column> {
        self.0.columns()
    }
    fn sample(&mut self, run: &dyn RunView) -> Vec<f64> {
        self.0.sample(run.in_dimension().get())
    }
    fn grain_columns(&self) -> Vec<Column> {
        self.0.grain_columns()
    }
    fn grain_values(&self, run: &dyn RunView) -> Vec<Vec<f64>> {
        self.0.grain_values(run.in_dimension().get())
    }
    fn cycle(&self, a: f64) -> Option<(u32, u32)> {
        self.0.cycle(a)
    }
    fn caption(&self, run: &dyn RunView) -> Vec<String> {
        self.0.caption(run.in_dimension().get())
    }
    fn pictures(&self, run: &dyn RunView) -> Vec<Picture> {
        self.0.pictures(run.in_dimension().get())
    }
    fn picture_names(&self) -> Vec<&'static str> {
        self.0.picture_names()
    }
    fn report(&self, end: &RunEnd<'_>, b: &mut Findings) {
        self.0.report(&RunEndIn::of(end), b)
    }
    fn report_so_far(&self, a: &mut Findings) {
        self.0.report_so_far(a)
    }
    fn files(&self, end: &RunEnd<'_>) -> Vec<Output> {
        self.0.files(&RunEndIn::of(end))
    }
    fn figures(&self, end: &RunEnd<'_>) -> Vec<Output> {
        self.0.figures(&RunEndIn::of(end))
    }
    fn file_names(&self) -> Vec<String> {
        self.0.file_names()
    }
    fn save(&self) -> Result<Vec<u8>, CodeError> {
        self.0.save()
    }
    fn restore(&mut self, a: &[u8]) -> Result<(), CodeError> {
        self.0.restore(a)
    }
    fn set_end(&mut self, end: f64, later: bool) -> Result<(), &'static str> {
        self.0.set_end(end, later)
    }
}
