//! Runs a scene to its end and records it.

mod certificates;
mod checkpoints;
mod clear;
#[cfg(feature = "view")]
mod drawing;
#[cfg(not(feature = "view"))]
#[path = "not_drawing.rs"]
mod drawing;
mod dump;
mod emergency;
mod end;
mod error;
#[cfg(feature = "view")]
mod frame;
mod names;
mod notice;
mod schedule;
mod stamps;
mod timed;

pub use self::end::write_outputs;
pub use self::error::RunError;
pub use self::names::check_names;

use self::drawing::{Camera, Drawing};
use self::emergency::EmergencySave;
use self::error::unwritable;
use self::schedule::due;
use self::stamps::stamps;
use super::checkpoint::{
    CheckpointWriter, FolderState, FrameKind, Identity, ResumePoint, find, occupied,
};
use super::quantity::Findings;
use super::results::Results;
use super::statistics::{Column, Table};
use super::summary::{RunFacts, SampleFacts, Summary, Uncertainty};
use super::views;
use crate::scene::case::Case;
use crate::scene::input_ranges::given_ranges;
use crate::scene::processes;
use crate::scene::{Built, LoadedCase};
use crate::step::StepReport;
use crate::{AnySimulation, RunView};
use cpu_time::ProcessTime;
use fretwork_observe::accuracy::{AccuracyControl, StepParts};
use fretwork_observe::error_estimate::ErrorEstimate;
use fretwork_observe::first_bodies::WearMaterials;
use fretwork_observe::run_state::damage_ratio;
use fretwork_observe::standard;
use fretwork_observe::{Observer, Observers};
use fretwork_store::folder_lock::{FolderLock, RUN_LOCK};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

/// Progress report of a run.
#[derive(Clone, Copy, Debug)]
pub struct Progress {
    /// Steps done, and total steps.
    pub steps: (u64, u64),
    /// Steps done before the run was resumed; 0 for a run from the start.
    pub resumed_at: u64,
    /// Current cycle, and total cycles; 0 before the first.
    pub cycle: (u32, u32),
    /// Number of contacts.
    pub contacts: usize,
    /// Solver iterations of the last step.
    pub iterations: u32,
    /// Solver error of the last step.
    pub error: f64,
    /// Number of steps that missed the tolerance.
    pub unconverged: u64,
    /// Ratio of broken bonds to bonds made.
    pub damage_ratio: f64,
}

/// Options of a run.
#[derive(Clone, Debug)]
pub struct RunOptions {
    /// Folder of the results.
    pub out: PathBuf,
    /// Number of threads; results are bit-identical for any number.
    pub threads: usize,
}

/// Callback with the progress of a run. [`ControlFlow::Break`] with a reason stops the run after
/// the step; all files are written, with a checkpoint from which the run may be resumed.
pub type OnProgress<'a> = dyn FnMut(&Progress) -> ControlFlow<String> + 'a;

/// A run of a case before its first step, with the observers that a user of the library adds.
/// Processes are added to the simulation in its dimension before
/// ([`Simulation::add_process`](crate::step::Simulation::add_process)).
///
/// ```no_run
/// use fretwork::record::{Run, RunOptions};
/// use fretwork::scene::load;
/// use fretwork::shipped::search_path;
/// use std::ops::ControlFlow;
/// use std::path::Path;
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let loaded = load(Path::new("cases/block_tower.ron"), &[])?;
/// let built = loaded.build(&search_path())?;
/// let options = RunOptions { out: "results/tower".into(), threads: 1 };
/// let summary = Run::new(&loaded, built, &options).execute(&mut |progress| {
///     if progress.damage_ratio > 0.5 {
///         return ControlFlow::Break("half of the bonds are broken".to_owned());
///     }
///     ControlFlow::Continue(())
/// })?;
/// if let Some(friction) = summary.found.number("energy.friction") {
///     println!("{friction} J of friction");
/// }
/// # Ok(())
/// # }
/// ```
#[derive(Debug)]
pub struct Run<'a> {
    loaded: &'a LoadedCase,
    built: Built,
    options: &'a RunOptions,
    stop: Option<ResumePoint>,
    observers: Observers,
    hurry: Option<&'a AtomicBool>,
    keeping: bool,
}

impl<'a> Run<'a> {
    /// Returns a run of a case from its start.
    pub fn new(loaded: &'a LoadedCase, built: Built, options: &'a RunOptions) -> Self {
        Self {
            loaded,
            built,
            options,
            stop: None,
            observers: Observers::default(),
            hurry: None,
            keeping: false,
        }
    }

    /// Refuses to replace results in the folder that this run would not give again: those of other
    /// inputs, or of a longer run or one that is not at its end, see
    /// [`occupied`]. Without it a run replaces what is there.
    #[must_use]
    pub fn keeping(mut self) -> Self {
        self.keeping = true;
        self
    }

    /// Omits the figures if the flag is set when the run ends, so that a stopped run ends sooner.
    /// They are drawn when the run is resumed and ends.
    #[must_use]
    pub fn hurry(mut self, flag: &'a AtomicBool) -> Self {
        self.hurry = Some(flag);
        self
    }

    /// Adds an observer, whose columns follow all others.
    #[must_use]
    pub fn observe(mut self, observer: impl Observer + 'static) -> Self {
        self.observers.push(Box::new(observer));
        self
    }

    /// Adds observers, as [`Run::observe`] adds one.
    #[must_use]
    pub fn observe_all(mut self, observers: Observers) -> Self {
        self.observers.append(observers);
        self
    }

    /// Resumes a run of the case, with equal observers and processes, from the state at which it
    /// [`stopped`]. The results are bit-identical to those of an uninterrupted run.
    #[must_use]
    pub fn resume(mut self, stop: ResumePoint) -> Self {
        self.stop = Some(stop);
        self
    }

    /// Runs to the end, or until `progress`, which is called after every step, requests a stop.
    ///
    /// # Errors
    /// A step failed, a file cannot be written, or a state does not fit the case. The summary is
    /// written even then, unless the run had not begun.
    pub fn execute(self, progress: &mut OnProgress<'_>) -> Result<Summary, RunError> {
        let mut recorder = Recorder::new(self)?;
        let outcome = recorder.run_steps(progress).map(|stopped| {
            recorder.summary.run.interrupted = stopped.is_some();
            recorder.summary.run.stopped = stopped;
        });
        if let Err(e) = &outcome {
            recorder.summary.run.stopped = Some(e.to_string());
        }
        let outcome = match outcome {
            Err(e) if e.is_last() => return Err(e),
            other => other,
        };
        match recorder.finish() {
            // This error is the reason why others occurred.
            Err(e) if e.is_last() => return Err(e),
            finished => outcome.and(finished)?,
        }
        Ok(recorder.summary)
    }
}

/// Runs to the end. `progress` is called after every step.
///
/// # Errors
/// The errors are those of [`Run::execute`].
pub fn run(
    loaded: &LoadedCase,
    built: Built,
    options: &RunOptions,
    progress: &mut dyn FnMut(&Progress),
) -> Result<Summary, RunError> {
    Run::new(loaded, built, options).execute(&mut |p| {
        progress(p);
        ControlFlow::Continue(())
    })
}

/// Finds the state of a stopped run of this case in the folder of the results.
///
/// # Errors
/// The state cannot be read, is damaged, or belongs to another version or case.
pub fn stopped(
    loaded: &LoadedCase,
    built: &Built,
    options: &RunOptions,
) -> Result<FolderState, RunError> {
    Ok(find(&options.out, &Identity::of(loaded, built)?)?)
}

/// Returns the observers that a run of a case has, for a program that steps without a run.
pub fn run_observers(loaded: &LoadedCase, s: &dyn RunView) -> Observers {
    let any = !(s.surfaces().is_empty() && s.bodies().driven.is_empty());
    standard::observers(&loaded.case, s, &WearMaterials::of(loaded, s, any))
}

/// Returns the columns of the statistics that a run of a case has.
pub fn statistics_columns(case: &Case, s: &dyn RunView) -> Vec<Column> {
    standard::observers(case, s, &WearMaterials::default()).columns()
}

/// A run in progress.
struct Recorder<'a> {
    loaded: &'a LoadedCase,
    out: PathBuf,
    simulation: AnySimulation,
    observers: Observers,
    table: Table,
    results: Results,
    camera: Camera,
    drawing: Drawing,
    /// Number of steps written as FCLIB problems, and number of those with features that the format
    /// cannot express.
    problems: (u64, u64),
    /// Steps that missed the tolerance.
    unconverged: u64,
    /// The estimate of the error of the run.
    estimate: ErrorEstimate,
    /// Choice of step and tolerance if the case requires an accuracy, and the parts of a step made
    /// so far.
    accuracy: Option<AccuracyControl>,
    parts: Option<StepParts>,
    /// Number of steps of the case that are done. Each may have several parts, which the simulation
    /// counts.
    done: u64,
    /// Number of steps that were done when the run was resumed.
    resumed_at: u64,
    /// Total steps of the run, and the steps over which states and pictures are distributed, as set
    /// when it was started.
    total: u64,
    spread: u64,
    checkpoint_writer: CheckpointWriter,
    /// The state shortly before the end, from which a longer run can continue; it is written with
    /// the end.
    last_state: Option<Vec<u8>>,
    /// Wall and processor time of the run before it was resumed; and the start of this part.
    elapsed_before_resume: (Duration, Duration),
    /// Slot in which the watch over plugins finds the files during a step.
    emergency: EmergencySave,
    clock: Instant,
    processor: ProcessTime,
    summary: Summary,
    /// Uncertainty of the main results, at the end.
    uncertainty: Uncertainty,
    /// Flag by which figures are left out at the end ([`Run::hurry`]).
    hurry: Option<&'a AtomicBool>,
    /// Error because of which rows of `statistics.csv` are missing. The file is regenerated from
    /// the results when the run is resumed.
    unwritten: Option<RunError>,
    /// Lock by which the run owns the folder until it ends.
    lock: FolderLock,
}

impl<'a> Recorder<'a> {
    /// Prepares a run from the start, or from the state at which it was stopped.
    fn new(run: Run<'a>) -> Result<Self, RunError> {
        let (loaded, mut built, options) = (run.loaded, run.built, run.options);
        let case = &loaded.case;
        let number = run.stop.as_ref().map_or(0, |s| s.number + 1);
        let identity = Identity::of(loaded, &built)?;
        let checkpoint_writer = CheckpointWriter::new(case.output.checkpoint, &identity, number)?;
        let simulation = &mut built.simulation;
        simulation.options_mut().solver.parallel = options.threads > 1;
        processes::install(case, simulation.setup());
        let mut observers = run_observers(loaded, simulation.view());
        observers.append(run.observers);
        names::check(loaded, &observers)?;
        let lock = match &run.stop {
            Some(stop) => stop.lock.clone(),
            None => {
                let made = std::fs::create_dir_all(&options.out);
                made.map_err(|e| unwritable(&options.out, &e))?;
                let lock = FolderLock::exclusive(&options.out, RUN_LOCK)?;
                if run.keeping
                    && let Some(found) = occupied(&options.out, &identity, || {
                        // The end is that with which they were made.
                        observers.set_end(case.time.end, true).err()
                    })
                {
                    return Err(RunError::Occupied(Box::new(found)));
                }
                lock
            }
        };
        let frames = options.out.join("frames");
        std::fs::create_dir_all(&frames).map_err(|e| unwritable(&frames, &e))?;
        let facts = RunFacts {
            case: case.name.clone(),
            dimension: simulation.dimension(),
            plugins: stamps(simulation.laws()),
            wear_coefficients: std::mem::take(&mut built.wear_coefficients),
            sample: SampleFacts::of(loaded, &built.materials, simulation.view()),
            given: given_ranges(case, &built.materials, simulation.view().laws()),
            threads: options.threads,
            seed: case.seed,
            identity: checkpoint_writer.name(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            ..RunFacts::default()
        };
        let columns = observers.columns();
        // The results file is opened first, since only it tells what the folder contains.
        let part = options.out.join("results.h5.part");
        let mut results = create_results(&part, loaded, &built, &facts, &observers)?;
        results.owned_by(lock.clone());
        let simulation = built.simulation;
        let total = (case.time.end / case.time.step - 1e-6).ceil().max(1.0) as u64;
        let mut recorder = Self {
            estimate: ErrorEstimate::new(case, simulation.view(), total),
            accuracy: AccuracyControl::new(case, simulation.view()),
            parts: None,
            done: 0,
            camera: Camera::new(simulation.view(), &case.output),
            drawing: Drawing::default(),
            out: options.out.clone(),
            table: Table::new(columns, simulation.dimension()),
            results,
            observers,
            problems: (0, 0),
            unconverged: 0,
            resumed_at: 0,
            total,
            spread: total,
            checkpoint_writer,
            last_state: None,
            elapsed_before_resume: (Duration::ZERO, Duration::ZERO),
            emergency: EmergencySave::new(options.out.clone(), lock.clone()),
            clock: Instant::now(),
            processor: ProcessTime::now(),
            summary: Summary {
                run: facts,
                found: Findings::new(simulation.dimension()),
            },
            uncertainty: Uncertainty::default(),
            simulation,
            loaded,
            hurry: run.hurry,
            unwritten: None,
            lock,
        };
        recorder.observers.begin(&mut *recorder.simulation);
        let begun = match run.stop {
            Some(stop) => recorder.restore(stop),
            None => recorder.publish(FrameKind::Begun, Vec::new()),
        };
        match begun {
            Ok(()) => Ok(recorder),
            Err(e) => {
                // The previous contents of the folder are still in place.
                let _ = std::fs::remove_file(&part);
                Err(e)
            }
        }
    }

    /// Steps to the end or until a stop is requested; returns the reason of the stop.
    fn run_steps(&mut self, progress: &mut OnProgress<'_>) -> Result<Option<String>, RunError> {
        if self.simulation.steps() == 0 {
            self.timed(|t| &mut t.files, Self::record_state)?;
            self.timed(|t| &mut t.pictures, |run| run.draw_pictures(0))?;
        }
        while self.done < self.total {
            let phase = self.simulation.phase();
            let recurs = self.simulation.phase_recurs();
            let report = self.whole_step()?;
            self.done += self.accuracy.as_ref().map_or(1, AccuracyControl::spanned);
            let step = self.done;
            if phase == 1 && self.simulation.phase() == 2 {
                self.camera.assign_layers(self.simulation.view());
                self.observers.begin(&mut *self.simulation);
            }
            self.simulation.between_steps()?;
            let worn_through = self.simulation.check_worn_through();
            let finished = self.simulation.finished() || worn_through.is_err();
            let last = step == self.total || finished;
            let turned = phase > 0 && self.simulation.phase() > phase && !recurs;
            self.record(&report, last, finished, turned)?;
            if let Some(e) = self.unwritten.take() {
                // The results are complete, so the run can be resumed when there is space.
                let _ = self.timed(|t| &mut t.files, Self::write_checkpoint);
                return Err(e);
            }
            let wish = progress(&self.progress(step, &report));
            worn_through?;
            if last {
                break;
            }
            if let ControlFlow::Break(reason) = wish {
                self.timed(|t| &mut t.files, Self::write_checkpoint)?;
                let total = self.total;
                return Ok(Some(format!("{reason} after step {step} of {total}")));
            }
            if self.checkpoint_writer.due(step) {
                self.timed(|t| &mut t.files, Self::write_checkpoint)?;
            } else if self.last_state.is_none() && self.near_end() {
                self.last_state = Some(self.timed(|t| &mut t.files, Self::state)?);
            }
        }
        Ok(None)
    }

    /// Makes a step of the case, in all its parts; returns the report of the last part.
    fn whole_step(&mut self) -> Result<StepReport, RunError> {
        loop {
            let report = self.step()?;
            self.unconverged += u64::from(!report.solver.converged);
            self.estimate.after_step(self.simulation.view(), &report);
            self.timed(
                |t| &mut t.observers,
                |run| run.observers.after_step(run.simulation.view(), &report),
            );
            // After a step of the case, the run loop needs the state of its last part only.
            if self.parts.is_none() {
                return Ok(report);
            }
            self.simulation.between_steps()?;
            if self.simulation.finished() || self.simulation.check_worn_through().is_err() {
                self.parts = None;
                return Ok(report);
            }
            for event in self.observers.after_processes(self.simulation.view()) {
                self.results.append_event(&event)?;
            }
        }
    }

    /// Records a step: its events, and its problem, row, state and pictures if they are due. `last`
    /// is the last step of the run, `finished` the one that ended it, `turned` one after which
    /// another phase begins.
    fn record(
        &mut self,
        report: &StepReport,
        last: bool,
        finished: bool,
        turned: bool,
    ) -> Result<(), RunError> {
        let (output, step) = (&self.loaded.case.output, self.done);
        if last {
            self.simulation.end()?;
        }
        for event in self.observers.after_processes(self.simulation.view()) {
            self.results.append_event(&event)?;
        }
        if output.fclib > 0 && step.is_multiple_of(output.fclib) {
            self.timed(|t| &mut t.files, |run| run.write_problem(step, report))?;
        }
        if step.is_multiple_of(output.every) || last {
            self.record_row()?;
        }
        if due(step, self.spread, output.views) || finished {
            self.timed(|t| &mut t.files, Self::record_state)?;
        }
        if due(step, self.spread, output.frames) || finished || turned {
            self.timed(|t| &mut t.pictures, |run| run.draw_pictures(step))?;
        }
        Ok(())
    }

    /// Writes a row of the statistics.
    fn record_row(&mut self) -> Result<(), RunError> {
        let row = self.timed(
            |t| &mut t.observers,
            |run| run.observers.sample(run.simulation.view()),
        )?;
        self.timed(
            |t| &mut t.files,
            |run| {
                run.results.append_statistics(&row)?;
                if let Err(e) = run.table.push(&row) {
                    run.unwritten = Some(unwritable(&run.out.join("statistics.csv"), &e));
                }
                Ok(())
            },
        )
    }

    /// Writes the current state.
    fn record_state(&mut self) -> Result<(), RunError> {
        let values = self.observers.grain_values(self.simulation.view());
        let (results, run) = (&mut self.results, self.simulation.view());
        Ok(views::append(results, run, self.loaded, values)?)
    }

    fn progress(&self, step: u64, report: &StepReport) -> Progress {
        Progress {
            steps: (step, self.total),
            resumed_at: self.resumed_at,
            cycle: self
                .observers
                .cycle(self.simulation.time())
                .unwrap_or((0, 0)),
            contacts: report.contacts,
            iterations: report.solver.iterations,
            error: report.solver.error,
            unconverged: self.unconverged,
            damage_ratio: damage_ratio(self.simulation.view()),
        }
    }
}

/// Creates the results file under a temporary name, which it keeps until it has content.
fn create_results(
    part: &Path,
    loaded: &LoadedCase,
    built: &Built,
    facts: &RunFacts,
    observers: &Observers,
) -> Result<Results, RunError> {
    let made = views::BuiltScene {
        simulation: built.simulation.view(),
        materials: &built.materials,
        densities: &built.densities,
        deforming: &built.deforming,
    };
    let header = views::header(loaded, &made, facts, observers);
    Ok(Results::create(part, &header)?)
}
