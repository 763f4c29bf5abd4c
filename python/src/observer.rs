//! Observers that are written in Python.
//!
//! The package gives them as objects with `name`, `every`, `columns` (name, unit and explanation of
//! each) and the methods `begin(simulation)`, `step(simulation)`, which returns the values of the
//! columns, nothing, or a reason to stop, `save()` and `restore(bytes)`; see
//! `fretwork/_observers.py`.

use crate::simulation::Simulation;
use fretwork::record::encoding::{EncodingError, decode, encode};
use fretwork::record::statistics::Column;
use fretwork::record::{Observer, RunView};
use fretwork::step::StepReport;
use pyo3::prelude::*;
use std::collections::HashSet;
use std::sync::{Arc, Mutex, MutexGuard};

/// Reason why an observer ends a run.
#[derive(Debug)]
pub(crate) enum Wish {
    /// The observer requests an end, with a reason.
    Stop(String),
    /// The observer raised an exception.
    Raised(PyErr),
}

/// The first wish of the observers of a run.
#[derive(Clone, Debug, Default)]
pub(crate) struct Wishes(Arc<Mutex<Option<Wish>>>);

impl Wishes {
    fn lock(&self) -> MutexGuard<'_, Option<Wish>> {
        self.0.lock().unwrap_or_else(|e| e.into_inner())
    }

    fn add(&self, wish: Wish) {
        let mut first = self.lock();
        if first.is_none() {
            *first = Some(wish);
        }
    }

    /// Returns the reason why the run is to stop, if there is one.
    pub(crate) fn reason(&self) -> Option<String> {
        self.lock().as_ref().map(|wish| match wish {
            Wish::Stop(reason) => reason.clone(),
            Wish::Raised(error) => format!("an observer raised an exception ({error})"),
        })
    }

    /// Returns the exception that an observer raised, if one did.
    pub(crate) fn exception(&self) -> Option<PyErr> {
        match self.lock().take() {
            Some(Wish::Raised(error)) => Some(error),
            _ => None,
        }
    }
}

/// Name, unit and explanation of a column, as Python gives them.
type ColumnLine = (String, String, String);

/// An observer in Python.
#[derive(Debug)]
pub(crate) struct PythonObserver {
    object: Py<PyAny>,
    name: String,
    every: u64,
    columns: Vec<Column>,
    /// Last values of the columns.
    latest: Vec<f64>,
    wishes: Wishes,
}

impl PythonObserver {
    pub(crate) fn new(object: &Bound<'_, PyAny>, wishes: Wishes) -> PyResult<Self> {
        let columns: Vec<ColumnLine> = object.getattr("columns")?.extract()?;
        let columns: Vec<Column> = columns
            .into_iter()
            .map(|(name, unit, doc)| Column::new(name, lasting(unit), lasting(doc)))
            .collect();
        Ok(Self {
            name: object.getattr("name")?.extract()?,
            every: object.getattr("every")?.extract::<u64>()?.max(1),
            latest: vec![f64::NAN; columns.len()],
            columns,
            object: object.clone().unbind(),
            wishes,
        })
    }

    /// Calls a method with the simulation, lent for the call.
    fn call(&mut self, method: &str, run: &dyn RunView) {
        if self.wishes.lock().is_some() {
            return;
        }
        let answer = Python::attach(|py| -> PyResult<(Option<Vec<f64>>, Option<String>)> {
            let lent = Bound::new(py, Simulation::lend(run))?;
            let answer = self.object.bind(py).call_method1(method, (&lent,));
            lent.get().end_loan();
            answer?.extract()
        });
        match answer {
            Ok((values, stop)) => {
                if let Some(values) = values {
                    self.latest = values;
                }
                if let Some(reason) = stop {
                    self.wishes.add(Wish::Stop(reason));
                }
            }
            Err(error) => self.wishes.add(Wish::Raised(error)),
        }
    }
}

impl Observer for PythonObserver {
    fn name(&self) -> String {
        format!("Python: {}", self.name)
    }

    fn begin(&mut self, run: &dyn RunView) {
        self.call("begin", run);
    }

    fn reads_statistics(&self) -> bool {
        false
    }

    fn after_step(&mut self, run: &dyn RunView, _: &StepReport) {
        if run.steps().is_multiple_of(self.every) {
            self.call("step", run);
        }
    }

    fn columns(&self) -> Vec<Column> {
        self.columns.clone()
    }

    fn sample(&mut self, _: &dyn RunView) -> Vec<f64> {
        self.latest.clone()
    }

    fn save(&self) -> Result<Vec<u8>, EncodingError> {
        let carried = Python::attach(|py| {
            let result = self.object.bind(py).call_method0("save")?;
            result.extract::<Vec<u8>>()
        });
        // If this fails there is no new checkpoint, and the previous one is kept.
        let carried = carried.map_err(|error| {
            self.wishes.add(Wish::Raised(error));
            EncodingError::other("states of observers")
        })?;
        encode(&(&self.latest, carried))
    }

    fn restore(&mut self, bytes: &[u8]) -> Result<(), EncodingError> {
        let (latest, carried): (Vec<f64>, Vec<u8>) = decode(bytes)?;
        self.latest = latest;
        let done = Python::attach(|py| -> PyResult<()> {
            let carried = pyo3::types::PyBytes::new(py, &carried);
            self.object.bind(py).call_method1("restore", (carried,))?;
            Ok(())
        });
        done.map_err(|error| {
            self.wishes.add(Wish::Raised(error));
            EncodingError::other("states of observers")
        })
    }
}

/// Returns a static copy of a text, since columns name their units for the whole life of the
/// program. Each text is stored once.
fn lasting(text: String) -> &'static str {
    static KEPT: Mutex<Option<HashSet<&'static str>>> = Mutex::new(None);
    let mut kept = KEPT.lock().unwrap_or_else(|e| e.into_inner());
    let kept = kept.get_or_insert_default();
    if let Some(same) = kept.get(text.as_str()) {
        return same;
    }
    let text: &'static str = Box::leak(text.into_boxed_str());
    kept.insert(text);
    text
}
