//! A simulation that Python steps, or that a run lends to an observer.

use crate::array::Array;
use crate::case::Case;
use crate::columns::{self, Column};
use crate::errors;
use crate::search::search_path;
use crate::stepper::{Moment, Stepper};
use crate::workers::Workers;
use fretwork::step::StepError;
use fretwork::{FieldInfo, FieldKind, FieldValues, GrainFields, RunView};
use pyo3::prelude::*;
use pyo3::types::PyWeakrefReference;
use std::path::PathBuf;
use std::sync::{Mutex, MutexGuard, TryLockError};
use std::time::{Duration, Instant};

/// Duration of stepping between two checks for Ctrl-C.
const PATIENCE: Duration = Duration::from_millis(50);

/// The simulation behind a Python object.
enum Held {
    /// A simulation that the object owns.
    Own(Box<Stepper>),
    /// The simulation of a run, while an observer is called.
    Lent(Lent),
    /// A simulation that a run has taken back.
    Ended,
}

/// A simulation of a run, while an observer is called.
struct Lent(*const dyn RunView);

// SAFETY: the pointer is read only under the lock of its `Simulation`, which ends the loan before
// the reference ends. The simulation is read by one thread at a time, while the thread that owns it
// waits for the observer. The parts of it that are not `Sync`, the guarded memory of laws under
// certification, hold addresses that are used only through `&mut`.
unsafe impl Send for Lent {}

impl Held {
    /// The simulation for reading.
    fn view(&self) -> PyResult<&dyn RunView> {
        match self {
            Self::Own(stepper) => Ok(stepper.simulation.view()),
            // SAFETY: the loan has not ended, see `Simulation::end_loan`.
            Self::Lent(lent) => Ok(unsafe { &*lent.0 }),
            Self::Ended => Err(errors::misused(
                "the simulation that an observer is called with can be used during the call only; keep arrays, or values",
            )),
        }
    }

    /// Returns the simulation that the object owns.
    fn own(&mut self) -> PyResult<&mut Stepper> {
        match self {
            Self::Own(stepper) => Ok(stepper),
            _ => Err(errors::misused(
                "an observer looks at a simulation and cannot step it; make one of your own by case.simulation()",
            )),
        }
    }
}

/// Name, unit and explanation of a field, and whether its values are integers.
type FieldLine = (String, String, String, bool);

/// A simulation.
#[pyclass(module = "fretwork._fretwork", name = "SimulationData", frozen)]
pub(crate) struct Simulation {
    held: Mutex<Held>,
    /// Columns that are shown to Python.
    shown: Mutex<Vec<(Column, Py<PyWeakrefReference>)>>,
    workers: Option<Workers>,
}

impl Simulation {
    fn lock(&self) -> PyResult<MutexGuard<'_, Held>> {
        self.held.try_lock().map_err(|e| match e {
            TryLockError::WouldBlock => {
                errors::misused("the simulation is being stepped by another thread; wait for it")
            }
            TryLockError::Poisoned(_) => errors::misused(
                "the program failed by an error of its own in a step; make the simulation again, and please report it",
            ),
        })
    }

    fn lent(held: Held) -> Self {
        Self {
            held: Mutex::new(held),
            shown: Mutex::default(),
            workers: None,
        }
    }

    /// A loan of a simulation of a run, which must be [ended](Self::end_loan) before the reference
    /// ends.
    pub(crate) fn lend(run: &dyn RunView) -> Self {
        let run: *const (dyn RunView + '_) = run;
        // SAFETY: the pointer is not used after the loan, which ends before the reference does.
        let run =
            unsafe { std::mem::transmute::<*const (dyn RunView + '_), *const dyn RunView>(run) };
        Self::lent(Held::Lent(Lent(run)))
    }

    /// Ends a loan. Waits for a thread that is reading the simulation.
    pub(crate) fn end_loan(&self) {
        *self.held.lock().unwrap_or_else(|e| e.into_inner()) = Held::Ended;
    }

    /// Returns the columns that Python still holds, before they change.
    fn held_by_python<'py>(&self, py: Python<'py>) -> Vec<(Column, Bound<'py, Array>)> {
        let shown = std::mem::take(&mut *self.shown.lock().unwrap_or_else(|e| e.into_inner()));
        let alive = shown.into_iter().filter_map(|(column, weak)| {
            let array = weak.bind(py).upgrade_as::<Array>().ok().flatten()?;
            Some((column, array))
        });
        alive.collect()
    }

    /// Lets arrays keep the values that they show.
    fn before_change(&self, py: Python<'_>, held: &mut Held) -> PyResult<()> {
        for (column, array) in self.held_by_python(py) {
            let memory = columns::take(&mut held.own()?.simulation, column);
            array.get().hand_over(memory);
        }
        Ok(())
    }

    /// Makes steps until `done` returns true, or Python has received a signal.
    fn step_while(
        &self,
        py: Python<'_>,
        mut go_on: impl FnMut(&Moment) -> bool + Send,
    ) -> PyResult<()> {
        let Some(workers) = &self.workers else {
            return self.lock()?.own().map(drop);
        };
        loop {
            let mut held = self.lock()?;
            self.before_change(py, &mut held)?;
            let stepper = held.own()?;
            let go_on = &mut go_on;
            let outcome = py.detach(|| {
                workers.install(move || {
                    let until = Instant::now() + PATIENCE;
                    loop {
                        if stepper.simulation.finished() || !go_on(&stepper.moment()) {
                            return Ok(true);
                        }
                        stepper.step()?;
                        if Instant::now() > until {
                            return Ok(false);
                        }
                    }
                })
            });
            let outcome: Result<bool, StepError> = outcome;
            let done = outcome.map_err(|e| errors::run(&e.to_string(), None))?;
            if done {
                return Ok(());
            }
            py.check_signals()?;
        }
    }
}

#[pymethods]
impl Simulation {
    /// Builds the scene of a case.
    #[new]
    fn new(
        py: Python<'_>,
        case: &Case,
        threads: usize,
        plugin_path: Vec<PathBuf>,
        trust_plugins: bool,
    ) -> PyResult<Self> {
        let path = search_path(&plugin_path, trust_plugins)?;
        let workers = Workers::new(threads)?;
        let loaded = &case.loaded;
        if loaded.case.accuracy.is_some() {
            let why = "a case with `accuracy` has its steps chosen by a run; to step it by hand take `accuracy` out, or give case.run \
                       an observer";
            return Err(errors::input(&loaded.source.error_at("accuracy", why)));
        }
        let held = py.detach(|| {
            workers.install(|| {
                let built = loaded.build(&path)?;
                Ok(Held::Own(Box::new(Stepper::new(loaded, built, threads))))
            })
        });
        Ok(Self {
            held: Mutex::new(held.map_err(|e| errors::input(&e))?),
            shown: Mutex::default(),
            workers: Some(workers),
        })
    }

    /// Makes a number of steps.
    fn step(&self, py: Python<'_>, steps: u64) -> PyResult<()> {
        let mut left = steps;
        self.step_while(py, move |_| {
            let more = left > 0;
            left = left.saturating_sub(1);
            more
        })
    }

    /// Makes steps until a time (s) is reached.
    fn run_until(&self, py: Python<'_>, time: f64) -> PyResult<()> {
        // If a whole number of steps reaches the end up to round-off, no further step is made.
        self.step_while(py, move |now| now.time < time - 1e-6 * now.step)
    }

    #[getter]
    fn dimension(&self) -> PyResult<usize> {
        Ok(self.lock()?.view()?.dimension())
    }

    #[getter]
    fn time(&self) -> PyResult<f64> {
        Ok(self.lock()?.view()?.time())
    }

    #[getter]
    fn steps(&self) -> PyResult<u64> {
        Ok(self.lock()?.view()?.steps())
    }

    #[getter]
    fn step_length(&self) -> PyResult<f64> {
        Ok(self.lock()?.view()?.options().scheme.h)
    }

    #[getter]
    fn finished(&self) -> PyResult<bool> {
        Ok(self.lock()?.view()?.finished())
    }

    /// The energy ledger as JSON.
    fn energies(&self) -> PyResult<String> {
        let held = self.lock()?;
        Ok(serde_json::to_string(held.view()?.energies()).unwrap_or_default())
    }

    /// Iterations, error and convergence of the solver in the last step; `None` before the first.
    fn last_step(&self) -> PyResult<Option<(u32, f64, bool)>> {
        let mut held = self.lock()?;
        let solver = held.own()?.report.as_ref().map(|report| &report.solver);
        Ok(solver.map(|s| (s.iterations, s.error, s.converged)))
    }

    /// Names, units and lines of explanation of the columns of the statistics.
    fn statistics_columns(&self) -> PyResult<Vec<(String, &'static str, &'static str)>> {
        let mut held = self.lock()?;
        let own = held.own()?;
        let dimension = own.simulation.dimension();
        let columns = own.observers.columns().into_iter();
        let line =
            |c: fretwork::record::statistics::Column| (c.name, c.unit.heading(dimension), c.doc);
        Ok(columns.map(line).collect())
    }

    /// Present values of these columns.
    fn statistics(&self) -> PyResult<Vec<f64>> {
        let mut held = self.lock()?;
        let stepper = held.own()?;
        let row = stepper.observers.sample(stepper.simulation.view());
        row.map_err(|e| errors::misused(&e.to_string()))
    }

    /// Number of all bodies, and of those before the first body that is not a grain.
    fn counts(&self) -> PyResult<(usize, usize)> {
        let held = self.lock()?;
        let bodies = held.view()?.bodies();
        let driven = bodies.driven.iter().map(|d| d.body as usize);
        let carried = (0..bodies.len()).filter(|b| bodies.carrier(*b).is_some());
        let first = driven.chain(carried).min();
        Ok((bodies.len(), first.unwrap_or(bodies.len())))
    }

    /// Names of the columns of bodies, with unit and explanation.
    #[staticmethod]
    fn columns() -> Vec<(&'static str, &'static str, &'static str)> {
        Column::ALL.iter().map(|c| c.about()).collect()
    }

    /// A column of all bodies, without a copy but for an observer.
    fn column<'py>(this: &Bound<'py, Self>, name: &str) -> PyResult<Option<Bound<'py, Array>>> {
        let py = this.py();
        let me = this.get();
        let Some(column) = Column::named(name) else {
            return Ok(None);
        };
        let held = me.lock()?;
        let mut alive = me.held_by_python(py);
        let keep = |alive: &[(Column, Bound<'py, Array>)]| -> PyResult<()> {
            let mut shown = me.shown.lock().unwrap_or_else(|e| e.into_inner());
            for (column, array) in alive {
                shown.push((*column, PyWeakrefReference::new(array)?.unbind()));
            }
            Ok(())
        };
        let known = alive.iter().find(|(c, _)| *c == column);
        let array = match known.map(|(_, array)| array.clone()) {
            Some(array) => array,
            None => {
                let Held::Own(stepper) = &*held else {
                    let copy = columns::copy(held.view()?, column);
                    keep(&alive)?;
                    return Bound::new(py, copy).map(Some);
                };
                let owner = this.clone().unbind();
                let shown = columns::show(&stepper.simulation, column, owner);
                let array = Bound::new(py, shown)?;
                alive.push((column, array.clone()));
                array
            }
        };
        keep(&alive)?;
        Ok(Some(array))
    }

    /// Names of the first bodies and their indices in the columns.
    fn first_bodies(&self) -> PyResult<Vec<(String, usize)>> {
        let held = self.lock()?;
        let driven = held.view()?.bodies().driven.iter();
        Ok(driven.map(|d| (d.name.clone(), d.body as usize)).collect())
    }

    /// Force and moment of all contacts on a first body in the last step.
    fn contact_force_on(&self, name: &str) -> PyResult<Option<(Vec<f64>, Vec<f64>)>> {
        let held = self.lock()?;
        let run = held.view()?;
        let on = run.contact_force_on(name);
        Ok(on.map(|[force, moment]| match run.dimension() {
            2 => (force[..2].to_vec(), moment[2..].to_vec()),
            _ => (force.to_vec(), moment.to_vec()),
        }))
    }

    /// The fields of grains (`grains`) or contacts (`contacts`).
    fn fields(&self, of: &str) -> PyResult<Vec<FieldLine>> {
        let held = self.lock()?;
        let fields = match of {
            "contacts" => held.view()?.contact_fields(),
            _ => held.view()?.grain_fields(GrainFields::default()),
        };
        let line = |f: FieldInfo| {
            let whole = f.kind == FieldKind::Whole;
            (
                f.name.to_owned(),
                f.unit.to_owned(),
                f.doc.to_owned(),
                whole,
            )
        };
        Ok(fields.into_iter().map(line).collect())
    }

    /// A field of all contacts.
    fn contact_field(&self, name: &str) -> PyResult<Option<Array>> {
        let values = self.lock()?.view()?.contact_field(name, false);
        Ok(values.map(array))
    }

    /// Positions of the contacts on the candidate (m).
    fn contact_points(&self) -> PyResult<Array> {
        let held = self.lock()?;
        let run = held.view()?;
        let mut points = Vec::with_capacity(run.contact_count());
        run.visit_contacts(&mut |contact| points.push(contact.point));
        Ok(columns::vectors(points, run.dimension()))
    }

    /// A field of the parts of grains and first bodies.
    fn grain_field(&self, name: &str) -> PyResult<Option<Array>> {
        let values = self.lock()?.view()?.grain_field(name);
        Ok(values.map(array))
    }

    /// The centres of the parts of grains and first bodies (m).
    fn grain_points(&self) -> PyResult<Array> {
        let held = self.lock()?;
        let run = held.view()?;
        Ok(columns::vectors(run.grain_centres(), run.dimension()))
    }
}

/// Values of a field: a row of three numbers per element for a vector, otherwise one number.
fn array(values: FieldValues) -> Array {
    match values {
        FieldValues::Number(numbers) => Array::own(numbers, 0),
        FieldValues::Whole(numbers) => Array::own(numbers, 0),
        FieldValues::Vector(numbers) => Array::own(numbers, 3),
    }
}
