//! Runs of a case: they are computed by separate threads, while Python's thread shows progress and
//! checks for Ctrl-C.

use crate::case::Case;
use crate::errors;
use crate::observer::{PythonObserver, Wishes};
use crate::search::search_path;
use crate::workers::Workers;
use fretwork::cli;
use fretwork::laws::watch::{self, RescueOutcome};
use fretwork::record::checkpoint::FolderState;
use fretwork::record::{self, Progress, Run, RunError, RunOptions};
use fretwork::scene::build::Origin;
use fretwork::scene::{Built, InputError, LoadedCase};
use pyo3::prelude::*;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, sync_channel};
use std::sync::{Arc, Mutex, Once};
use std::time::Duration;

/// Interval at which Python's thread checks for Ctrl-C and shows progress.
const PATIENCE: Duration = Duration::from_millis(50);

/// Limit on the duration of a call of a law (s), equal to that of the command line.
const LAW_TIMEOUT: Duration = Duration::from_secs(60);

/// Progress for Python: steps done and in total, steps before a resumed part, cycle and number of
/// cycles, contacts, iterations, error, steps that missed the tolerance, damage ratio.
type ProgressLine = (u64, u64, u64, u32, u32, usize, u32, f64, u64, f64);

fn line_of(p: &Progress) -> ProgressLine {
    (
        p.steps.0,
        p.steps.1,
        p.resumed_at,
        p.cycle.0,
        p.cycle.1,
        p.contacts,
        p.iterations,
        p.error,
        p.unconverged,
        p.damage_ratio,
    )
}

/// How a run ended.
enum End {
    /// The run ended with files; the flag tells whether it was not started because it was finished
    /// before.
    Done,
    /// The case is wrong.
    Input(InputError),
    /// The run failed; the text is the position of the cause in the case, if known.
    Failed(RunError, Option<String>),
}

/// Messages between Python's thread and that of the run.
#[derive(Default)]
struct Shared {
    latest: Mutex<Option<Progress>>,
    /// Reason why the run is to stop.
    stop: Mutex<Option<String>>,
    /// Whether Python is waiting for the end of the run.
    hurry: AtomicBool,
}

/// Message about a law that did not return, and what was saved of the run.
static STUCK: Mutex<Option<String>> = Mutex::new(None);

/// Installs the watch that reports laws that do not return.
fn watch_laws() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        // Without a watch thread laws have no time limit.
        let _ = watch::watch(LAW_TIMEOUT, |who, saved: RescueOutcome| {
            let text = format!(
                "{who}; {}; the thread that calls it is lost: start Python again",
                saved.words()
            );
            *lock(&STUCK) = Some(text);
        });
    });
}

fn lock<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(|e| e.into_inner())
}

/// Runs a case. The files are in `out` when it returns, and also when it raises an exception after
/// the run has begun.
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "the keywords of Case.run")]
pub(crate) fn run(
    py: Python<'_>,
    case: &Case,
    out: PathBuf,
    threads: usize,
    resume: bool,
    plugin_path: Vec<PathBuf>,
    trust_plugins: bool,
    progress: Option<Py<PyAny>>,
    observers: Vec<Bound<'_, PyAny>>,
) -> PyResult<()> {
    let path = search_path(&plugin_path, trust_plugins)?;
    let workers = Workers::new(threads)?;
    let wishes = Wishes::default();
    let watching = observers.iter();
    let watching = watching.map(|o| PythonObserver::new(o, wishes.clone()));
    let watching = watching.collect::<PyResult<Vec<_>>>()?;
    watch_laws();
    let shared = Arc::new(Shared::default());
    let task = Task {
        loaded: case.loaded.clone(),
        options: RunOptions {
            out: out.clone(),
            threads,
        },
        resume,
        observers: watching,
        wishes: wishes.clone(),
        shared: shared.clone(),
    };
    let (done, ended) = sync_channel(1);
    // Only this thread receives; the lock allows this while it is detached from Python.
    let ended = Mutex::new(ended);
    let worker = std::thread::Builder::new().spawn(move || {
        // A panic drops the sender.
        let end = workers.install(move || match task.loaded.build(&path) {
            Ok(built) => task.run(built),
            Err(e) => End::Input(e),
        });
        let _ = done.send(end);
    });
    worker.map_err(|e| errors::run(&format!("cannot start a thread: {e}"), None))?;

    let mut raised = None;
    let end = loop {
        match py.detach(|| lock(&ended).recv_timeout(PATIENCE)) {
            Ok(end) => break end,
            Err(RecvTimeoutError::Disconnected) => {
                let why =
                    "the program failed by an error of its own, printed above; please report it";
                return Err(errors::run(why, Some(&out)));
            }
            Err(RecvTimeoutError::Timeout) => {}
        }
        if let Some(stuck) = lock(&STUCK).take() {
            return Err(errors::run(&stuck, Some(&out)));
        }
        if raised.is_some() {
            // The run is writing its files.
            continue;
        }
        if let Err(error) = look(py, &shared, progress.as_ref()) {
            shared.hurry.store(true, Ordering::SeqCst);
            *lock(&shared.stop) = Some(format!("interrupted by Python ({error})"));
            raised = Some(error);
        }
    };
    if let Some(error) = raised.or_else(|| wishes.exception()) {
        return Err(error);
    }
    if let Some(progress) = &progress {
        show(py, &shared, progress)?;
    }
    match end {
        End::Done => Ok(()),
        End::Input(e) => Err(errors::input(&e)),
        End::Failed(e, place) => Err(errors::ended(&e, place, &out)),
    }
}

/// Checks for Ctrl-C, and shows progress.
fn look(py: Python<'_>, shared: &Shared, progress: Option<&Py<PyAny>>) -> PyResult<()> {
    py.check_signals()?;
    progress.map_or(Ok(()), |progress| show(py, shared, progress))
}

fn show(py: Python<'_>, shared: &Shared, progress: &Py<PyAny>) -> PyResult<()> {
    let latest = lock(&shared.latest).take();
    if let Some(latest) = latest {
        progress.call1(py, line_of(&latest))?;
    }
    Ok(())
}

/// A run before its start.
struct Task {
    loaded: LoadedCase,
    options: RunOptions,
    resume: bool,
    observers: Vec<PythonObserver>,
    wishes: Wishes,
    shared: Arc<Shared>,
}

impl Task {
    fn run(self, mut built: Built) -> End {
        let (loaded, options) = (&self.loaded, &self.options);
        let failed = |e| End::Failed(e, None);
        let mut stop = None;
        if self.resume {
            match record::stopped(loaded, &built, options) {
                Ok(FolderState::Nothing) => {}
                Ok(FolderState::State(state)) => stop = Some(state),
                Ok(FolderState::Finished) => return End::Done,
                Err(e) => return failed(e),
            }
        }
        let origins: Vec<Origin> = std::mem::take(&mut built.origins);
        let mut run = Run::new(loaded, built, options).hurry(&self.shared.hurry);
        for observer in self.observers {
            run = run.observe(observer);
        }
        if let Some(stop) = stop {
            run = run.resume(stop);
        }
        let (shared, wishes) = (&self.shared, &self.wishes);
        let summary = run.execute(&mut |progress| {
            *lock(&shared.latest) = Some(*progress);
            let wish = lock(&shared.stop).clone().or_else(|| wishes.reason());
            wish.map_or(ControlFlow::Continue(()), ControlFlow::Break)
        });
        match summary {
            Ok(_) => End::Done,
            Err(e) => {
                let place = cli::place_of(loaded, &origins, &e);
                End::Failed(e, place)
            }
        }
    }
}

/// Default folder of the results of a run: that of the command line.
#[pyfunction]
pub(crate) fn default_folder(path: PathBuf) -> PathBuf {
    cli::default_folder(Path::new(&path))
}
