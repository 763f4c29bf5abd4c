//! A simulation that Python steps, or that a run lends to an observer.

use crate::array::Array;
use crate::case::Case;
use crate::columns::{self, Column};
use crate::errors;
use crate::search::search_path;
use crate::stepper::{Moment, Stepper};
use crate::workers::Workers;
use fretwork::fields::{Field, GrainPart, Value};
use fretwork::geometry::space::{Dim2, Dim3, Space};
use fretwork::record::RunView;
use fretwork::scene::Scene;
use fretwork::step;
use pyo3::prelude::*;
use pyo3::types::PyWeakrefReference;
use std::path::PathBuf;
use std::sync::{Mutex, MutexGuard, TryLockError};
use std::time::{Duration, Instant};

/// How long steps are made before Python looks for Ctrl-C.
const PATIENCE: Duration = Duration::from_millis(50);

/// A simulation in its dimension.
enum Held {
    Dim2(Box<Stepper<Dim2>>),
    Dim3(Box<Stepper<Dim3>>),
    Lent2(Lent<Dim2>),
    Lent3(Lent<Dim3>),
    /// Lent by a run that took it back.
    Ended,
}

/// A simulation of a run, while an observer is called.
struct Lent<S: Space>(*const step::Simulation<S>);

// SAFETY: the pointer is read only under the lock of its `Simulation`, which ends the loan before
// the reference ends. The simulation is read by one thread at a time, while that which owns it
// waits for the observer; what of it has no `Sync`, the guarded memory of laws under certification,
// holds addresses that are used through `&mut` only.
unsafe impl<S: Space> Send for Lent<S> {}

/// A simulation in one of the dimensions, for what is the same in both.
macro_rules! in_dimension {
    ($held:expr, |$s:ident| $body:expr) => {
        match &*$held {
            Held::Dim2(stepper) => {
                let $s = &stepper.simulation;
                Ok($body)
            }
            Held::Dim3(stepper) => {
                let $s = &stepper.simulation;
                Ok($body)
            }
            Held::Lent2(lent) => {
                // SAFETY: the loan has not ended, see `Simulation::end_loan`.
                let $s = unsafe { &*lent.0 };
                Ok($body)
            }
            Held::Lent3(lent) => {
                // SAFETY: as above.
                let $s = unsafe { &*lent.0 };
                Ok($body)
            }
            Held::Ended => Err(errors::misused(
                "the simulation that an observer is called with can be used during the call only; keep arrays, or values",
            )),
        }
    };
}

/// A simulation that is stepped by one who owns it.
macro_rules! owned {
    ($held:expr, |$s:ident| $body:expr) => {
        match &mut *$held {
            Held::Dim2($s) => Ok($body),
            Held::Dim3($s) => Ok($body),
            _ => Err(errors::misused(
                "an observer looks at a simulation and cannot step it; make one of your own by case.simulation()",
            )),
        }
    };
}

/// Name, unit and line of explanation of a field, and whether its values are whole numbers.
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
        Self::lent(match run.in_dimension() {
            step::InDimension::Dim2(s) => Held::Lent2(Lent(s)),
            step::InDimension::Dim3(s) => Held::Lent3(Lent(s)),
        })
    }

    /// Ends a loan. Waits for a thread that looks at it just now.
    pub(crate) fn end_loan(&self) {
        *self.held.lock().unwrap_or_else(|e| e.into_inner()) = Held::Ended;
    }

    /// The columns that Python still holds, before they change.
    fn held_by_python<'py>(&self, py: Python<'py>) -> Vec<(Column, Bound<'py, Array>)> {
        let shown = std::mem::take(&mut *self.shown.lock().unwrap_or_else(|e| e.into_inner()));
        let alive = shown.into_iter().filter_map(|(column, weak)| {
            let array = weak.bind(py).upgrade_as::<Array>().ok().flatten()?;
            Some((column, array))
        });
        alive.collect()
    }

    /// Lets arrays keep the numbers that they show.
    fn before_change(&self, py: Python<'_>, held: &mut Held) -> PyResult<()> {
        for (column, array) in self.held_by_python(py) {
            let memory = owned!(held, |s| columns::take(
                &mut s.simulation.state.bodies,
                column
            ))?;
            array.get().hand_over(memory);
        }
        Ok(())
    }

    /// Makes steps until `done` says so, or Python has a signal.
    fn step_while(
        &self,
        py: Python<'_>,
        mut go_on: impl FnMut(&Moment) -> bool + Send,
    ) -> PyResult<()> {
        let Some(workers) = &self.workers else {
            return owned!(self.lock()?, |_s| ());
        };
        loop {
            let mut held = self.lock()?;
            self.before_change(py, &mut held)?;
            let held = &mut *held;
            let go_on = &mut go_on;
            let outcome = py.detach(|| {
                workers.install(move || {
                    let until = Instant::now() + PATIENCE;
                    owned!(held, |s| loop {
                        if s.simulation.finished() || !go_on(&s.moment()) {
                            break Ok(true);
                        }
                        if let Err(e) = s.step() {
                            break Err(e);
                        }
                        if Instant::now() > until {
                            break Ok(false);
                        }
                    })
                })
            });
            let done = outcome?.map_err(|e| errors::run(&e.to_string(), None))?;
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
                Ok(match loaded.build(&path)? {
                    Scene::Dim2(built) => Held::Dim2(Stepper::new(loaded, *built, threads)),
                    Scene::Dim3(built) => Held::Dim3(Stepper::new(loaded, *built, threads)),
                })
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
        // An end that a whole number of steps reaches up to rounding takes no step more.
        self.step_while(py, move |now| now.time < time - 1e-6 * now.step)
    }

    #[getter]
    fn dimension(&self) -> PyResult<usize> {
        fn dimension<S: Space>(_: &step::Simulation<S>) -> usize {
            S::D
        }
        in_dimension!(self.lock()?, |s| dimension(s))
    }

    #[getter]
    fn time(&self) -> PyResult<f64> {
        in_dimension!(self.lock()?, |s| s.state.time)
    }

    #[getter]
    fn steps(&self) -> PyResult<u64> {
        in_dimension!(self.lock()?, |s| s.state.steps)
    }

    #[getter]
    fn step_length(&self) -> PyResult<f64> {
        in_dimension!(self.lock()?, |s| s.options.scheme.h)
    }

    #[getter]
    fn finished(&self) -> PyResult<bool> {
        in_dimension!(self.lock()?, |s| s.finished())
    }

    /// The energy ledger as JSON.
    fn energies(&self) -> PyResult<String> {
        let energy = in_dimension!(self.lock()?, |s| *s.energies())?;
        Ok(serde_json::to_string(&energy).unwrap_or_default())
    }

    /// Iterations, error and whether the solver converged in the last step; none before the first.
    fn last_step(&self) -> PyResult<Option<(u32, f64, bool)>> {
        owned!(self.lock()?, |s| s.report.as_ref().map(|r| (
            r.solver.iterations,
            r.solver.error,
            r.solver.converged
        )))
    }

    /// Names, units and lines of explanation of the columns of the statistics.
    fn statistics_columns(&self) -> PyResult<Vec<(String, &'static str, &'static str)>> {
        let columns = owned!(self.lock()?, |s| s.observers.columns())?;
        Ok(columns
            .into_iter()
            .map(|c| (c.name, c.unit, c.doc))
            .collect())
    }

    /// Their values now.
    fn statistics(&self) -> PyResult<Vec<f64>> {
        owned!(self.lock()?, |s| s.observers.sample(&s.simulation))
    }

    /// Number of all bodies, and of those before the first that is no grain.
    fn counts(&self) -> PyResult<(usize, usize)> {
        in_dimension!(self.lock()?, |s| {
            let bodies = &s.state.bodies;
            let driven = bodies.driven.iter().map(|d| d.body as usize);
            let carried = (0..bodies.len()).filter(|b| bodies.carrier(*b).is_some());
            let first = driven.chain(carried).min();
            (bodies.len(), first.unwrap_or(bodies.len()))
        })
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
                let lent = matches!(&*held, Held::Lent2(_) | Held::Lent3(_));
                let owner = (!lent).then(|| this.clone().unbind());
                let made = in_dimension!(held, |s| columns::show(&s.state.bodies, column, owner))?;
                let array = Bound::new(py, made)?;
                if !lent {
                    alive.push((column, array.clone()));
                }
                array
            }
        };
        keep(&alive)?;
        Ok(Some(array))
    }

    /// Names of the first bodies and their places in the columns.
    fn first_bodies(&self) -> PyResult<Vec<(String, usize)>> {
        in_dimension!(self.lock()?, |s| {
            let driven = s.state.bodies.driven.iter();
            driven.map(|d| (d.name.clone(), d.body as usize)).collect()
        })
    }

    /// Force and moment of all contacts on a first body in the last step.
    fn contact_force_on(&self, name: &str) -> PyResult<Option<(Vec<f64>, Vec<f64>)>> {
        in_dimension!(self.lock()?, |s| {
            let on = s.contact_force_on(name);
            on.map(|(force, moment)| (force.as_slice().to_vec(), moment.as_slice().to_vec()))
        })
    }

    /// The fields of grains (`grains`) or contacts (`contacts`).
    fn fields(&self, of: &str) -> PyResult<Vec<FieldLine>> {
        let line = |name: &str, unit: &str, doc: &str, whole| {
            (name.to_owned(), unit.to_owned(), doc.to_owned(), whole)
        };
        in_dimension!(self.lock()?, |s| match of {
            "contacts" => {
                let fields = s.fields.contacts.iter();
                fields
                    .map(|f| line(f.name, f.unit, f.doc, f.is_whole()))
                    .collect()
            }
            _ => {
                let fields = s.fields.grains.iter();
                fields
                    .map(|f| line(f.name, f.unit, f.doc, f.is_whole()))
                    .collect()
            }
        })
    }

    /// A field of all contacts.
    fn contact_field(&self, name: &str) -> PyResult<Option<Array>> {
        fn of<S: Space>(s: &step::Simulation<S>, name: &str) -> Option<Array> {
            let field = s.fields.contacts.get(name)?;
            let contacts = s.state.network.contacts.iter();
            Some(of_field(s, field, contacts))
        }
        in_dimension!(self.lock()?, |s| of(s, name))
    }

    /// Where contacts touch, seen from the candidate (m).
    fn contact_points(&self) -> PyResult<Array> {
        fn of<S: Space>(s: &step::Simulation<S>) -> Array {
            let points: Vec<S::Vector> = s.contacts().map(|c| c.point).collect();
            Array::own(columns::numbers(&points), S::D)
        }
        in_dimension!(self.lock()?, |s| of(s))
    }

    /// A field of the parts of grains and first bodies.
    fn grain_field(&self, name: &str) -> PyResult<Option<Array>> {
        fn of<S: Space>(s: &step::Simulation<S>, name: &str) -> Option<Array> {
            let field = s.fields.grains.get(name)?;
            Some(of_field(s, field, GrainPart::all(s)))
        }
        in_dimension!(self.lock()?, |s| of(s, name))
    }

    /// The centres of the parts of grains and first bodies (m).
    fn grain_points(&self) -> PyResult<Array> {
        fn of<S: Space>(s: &step::Simulation<S>) -> Array {
            let points: Vec<S::Vector> = GrainPart::all(s).map(|part| part.centre).collect();
            Array::own(columns::numbers(&points), S::D)
        }
        in_dimension!(self.lock()?, |s| of(s))
    }
}

/// A field of all things that carry it: a row of three numbers each for a vector, a number each for
/// others.
fn of_field<S: Space, T>(
    s: &step::Simulation<S>,
    field: &Field<S, T>,
    all: impl Iterator<Item = impl std::borrow::Borrow<T>>,
) -> Array {
    if let Value::Vector(get) = &field.value {
        let numbers = all.flat_map(|one| get(s, one.borrow()));
        return Array::own(numbers.collect::<Vec<f64>>(), field.width());
    }
    values(all.map(|one| field.get(s, one.borrow())), field.is_whole())
}

fn values(numbers: impl Iterator<Item = f64>, whole: bool) -> Array {
    match whole {
        true => Array::own::<i64>(numbers.map(|x| x as i64).collect(), 0),
        false => Array::own::<f64>(numbers.collect(), 0),
    }
}
