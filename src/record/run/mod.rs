//! Runs a scene to its end and records it.

mod account;
mod clear;
mod dump;
mod end;
mod error;
mod flows;
mod frame;
mod jumps;
mod keep;
mod notice;
mod rescue;
mod row;
mod sample;
mod stamps;

pub use self::end::write_outputs;
pub use self::error::RunError;
pub use self::row::statistics_columns;

use self::account::Account;
use self::error::unwritable;
use self::flows::Flows;
use self::jumps::Jumps;
use self::rescue::EmergencySave;
use self::stamps::{density_of, stamps};
use super::biaxial::Biaxial;
use super::checkpoint::{CheckpointWriter, Found, Identity, Kind, ResumePoint, find};
use super::friction::{Cycles, Sample, State as Cumulated};
use super::layer::Layer;
use super::measure::Measures;
use super::picture::Camera;
use super::results::Results;
use super::statistics::Table;
use super::strain::Strain;
use super::summary::{SolverSummary, Summary};
use super::views;
use crate::bodies::TimeFunction;
use crate::geometry::space::Space;
use crate::interrupt;
use crate::scene::build::{Built, Dimensional, Loaded, Scene};
use crate::scene::sampling;
use crate::step::{Simulation, StepReport};
use cpu_time::ProcessTime;
use std::path::PathBuf;
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
    /// Broken bonds over bonds made.
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

/// Runs a scene to its end. `progress` is called after every step.
///
/// # Errors
/// A step failed or a file cannot be written; the summary is written even then.
pub fn run<S: Dimensional>(
    loaded: &Loaded,
    built: Built<S>,
    options: &RunOptions,
    progress: &mut dyn FnMut(&Progress),
) -> Result<Summary, RunError> {
    // Compiled in this crate, once for each dimension.
    match S::scene(built) {
        Scene::Dim2(built) => execute(Recorder::new(loaded, *built, options, None)?, progress),
        Scene::Dim3(built) => execute(Recorder::new(loaded, *built, options, None)?, progress),
    }
}

/// Finds the state of a stopped run of this case in the folder of the results.
///
/// # Errors
/// The state cannot be read, is damaged, or belongs to another version or case.
pub fn stopped<S: Space>(
    loaded: &Loaded,
    built: &Built<S>,
    options: &RunOptions,
) -> Result<Found, RunError> {
    Ok(find(&options.out, &Identity::of(loaded, built)?)?)
}

/// Resumes a [`stopped`] run of the same case; the results are bit-identical to those of an uninterrupted run.
/// `progress` is called after every step.
///
/// # Errors
/// As [`run`], or the state does not fit the case.
pub fn resume<S: Dimensional>(
    loaded: &Loaded,
    built: Built<S>,
    options: &RunOptions,
    stop: ResumePoint,
    progress: &mut dyn FnMut(&Progress),
) -> Result<Summary, RunError> {
    let from = Some(stop);
    match S::scene(built) {
        Scene::Dim2(built) => execute(Recorder::new(loaded, *built, options, from)?, progress),
        Scene::Dim3(built) => execute(Recorder::new(loaded, *built, options, from)?, progress),
    }
}

fn execute<S: Dimensional>(
    mut recorder: Recorder<'_, S>,
    progress: &mut dyn FnMut(&Progress),
) -> Result<Summary, RunError> {
    let outcome = recorder.go(progress).map(|interrupted| {
        recorder.summary.interrupted = interrupted.is_some();
        recorder.summary.stopped = interrupted;
    });
    if let Err(e) = &outcome {
        recorder.summary.stopped = Some(e.to_string());
    }
    let finished = recorder.finish();
    outcome.and(finished)?;
    Ok(recorder.summary)
}

struct Recorder<'a, S: Space> {
    loaded: &'a Loaded,
    out: PathBuf,
    simulation: Simulation<S>,
    table: Table,
    results: Results,
    camera: Camera,
    /// Local shear since the start of the second phase, if the case asks for it.
    strain: Option<Strain<S>>,
    cycles: Option<(Cycles, usize)>,
    biaxial: Option<Biaxial>,
    measures: Measures<S>,
    account: Account<S>,
    /// Jumps over cycles, if the case has them.
    jumps: Option<Jumps>,
    layer: Layer<S>,
    sample: Option<Sample>,
    slide: f64,
    worn: (f64, f64),
    /// Normal force times sliding distance of the friction test, over the run including jumps (N m; N).
    load_path: f64,
    flows: Flows,
    iterations: u64,
    couplings: u64,
    /// Steps done when the run was resumed.
    resumed_at: u64,
    /// Total steps of the run, and the steps over which states and pictures are distributed, as set when it
    /// was started.
    total: u64,
    spread: u64,
    keeper: CheckpointWriter,
    /// Wall and processor time of the run before it was resumed; and the start of this part.
    spent: (Duration, Duration),
    /// Output that the plugin watchdog can save during a step.
    refuge: EmergencySave,
    clock: Instant,
    processor: ProcessTime,
    density: f64,
    summary: Summary,
}

impl<'a, S: Dimensional> Recorder<'a, S> {
    /// Starts a run, or restores a stopped one.
    fn new(
        loaded: &'a Loaded,
        built: Built<S>,
        options: &RunOptions,
        stop: Option<ResumePoint>,
    ) -> Result<Self, RunError> {
        let frames = options.out.join("frames");
        std::fs::create_dir_all(&frames).map_err(|e| unwritable(&frames, &e))?;
        let case = &loaded.case;
        let number = stop.as_ref().map_or(0, |s| s.number + 1);
        let keeper = CheckpointWriter::new(
            case.output.checkpoint,
            &Identity::of(loaded, &built)?,
            number,
        )?;
        let mut simulation = built.simulation;
        simulation.solver.parallel = options.threads > 1;
        let cycles = case.friction.as_ref().and_then(|test| {
            let place = simulation
                .bodies
                .driven
                .iter()
                .position(|d| d.name == test.body)?;
            let dof = &simulation.bodies.driven[place].dofs[test.along];
            let period = test
                .period
                .or(dof.function().and_then(TimeFunction::period));
            let start = match dof.function() {
                Some(TimeFunction::Sine { start, .. }) => test.start.max(*start),
                _ => test.start,
            };
            let cycles = Cycles::new(start, period, case.time.end);
            Some(((cycles, place), start))
        });
        let (cycles, start) = cycles.unzip();
        let spec = case.biaxial.as_ref();
        let biaxial = spec.and_then(|spec| Biaxial::new(spec, &simulation));
        let measures = Measures::new(&case.measures, case.inertia_scaling);
        let jumps = cycles
            .as_ref()
            .and_then(|(cycles, _)| jumps::begin(case, cycles, &simulation));
        let mut columns = row::columns(&simulation, cycles.is_some(), biaxial.is_some());
        columns.extend(jumps.is_some().then(jumps::column));
        columns.extend(Account::<S>::columns(case));
        columns.extend(measures.columns());
        let plugins = stamps(&simulation.laws);
        let summary = Summary {
            case: case.name.clone(),
            dimension: S::D,
            plugins,
            threads: options.threads,
            seed: case.seed,
            identity: keeper.name(),
            unresolved_drives: sampling::unresolved(case),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            solver: SolverSummary {
                tolerance: case.solver.tolerance,
                error_formula: case.solver.norm.formula().to_owned(),
                method: case.solver.method.name().to_owned(),
                ..SolverSummary::default()
            },
            ..Summary::default()
        };
        let header = {
            let made = views::Made {
                simulation: &simulation,
                materials: &built.materials,
                densities: &built.densities,
            };
            views::header(loaded, &made, &summary, &columns)
        };
        // The results file is replaced first: it alone defines what the folder contains.
        let part = options.out.join("results.h5.part");
        let results = Results::create(&part, &header)?;
        let table = Table::new(columns);
        let total = (case.time.end / case.time.step - 1e-6).ceil().max(1.0) as u64;
        let first = simulation
            .shapes
            .surfaces
            .first()
            .map(|s| s.body)
            .or(simulation.bodies.driven.first().map(|d| d.body));
        let mut recorder = Self {
            camera: Camera::new(&simulation, &case.output),
            strain: case.output.shear.map(|_| Strain::new(&simulation)),
            out: options.out.clone(),
            table,
            results,
            cycles,
            biaxial,
            measures,
            account: Account::new(case),
            jumps,
            layer: Layer::new(&simulation),
            sample: None,
            slide: 0.0,
            worn: (0.0, 0.0),
            load_path: 0.0,
            flows: Flows::since(start.unwrap_or(0.0)),
            iterations: 0,
            couplings: 0,
            resumed_at: 0,
            total,
            spread: total,
            keeper,
            spent: (Duration::ZERO, Duration::ZERO),
            refuge: EmergencySave::new(options.out.clone()),
            clock: Instant::now(),
            processor: ProcessTime::now(),
            density: density_of(loaded, first.is_some()),
            summary,
            simulation,
            loaded,
        };
        recorder.measures.begin(&mut recorder.simulation);
        let begun = match stop {
            Some(stop) => recorder.take_up(stop),
            None => recorder.publish(Kind::Begun, Vec::new()),
        };
        match begun {
            Ok(()) => Ok(recorder),
            Err(e) => {
                // The previous contents of the folder are still there.
                let _ = std::fs::remove_file(&part);
                Err(e)
            }
        }
    }

    /// Steps to the end, or until a signal; returns the reason in that case.
    fn go(&mut self, progress: &mut dyn FnMut(&Progress)) -> Result<Option<String>, RunError> {
        let output = &self.loaded.case.output;
        if self.simulation.steps == 0 {
            self.views()?;
            self.frame(0)?;
        }
        for step in self.simulation.steps + 1..=self.total {
            let (before, phase) = (self.cumulated(), self.simulation.control.phase());
            let recurs = self.simulation.control.recurs();
            let report = self.step()?;
            self.follow(&report, before);
            self.measures.follow(&self.simulation);
            if phase == 1 && self.simulation.control.phase() == 2 {
                self.camera.dye(&self.simulation);
                self.measures.begin(&mut self.simulation);
                self.strain = self.strain.take().map(|_| Strain::new(&self.simulation));
            }
            let whole = self.simulation.whole();
            let reached = self.jump();
            let finished = self.simulation.control.finished() || whole.is_err() || reached;
            let last = step == self.total || finished;
            self.account(last)?;
            if output.fclib > 0 && step % output.fclib == 0 {
                self.dump(step, &report)?;
            }
            if last {
                self.simulation.show_wear();
            }
            if step % output.every == 0 || last {
                let mut row = self.row(&report);
                row.extend(self.cycles_represented());
                if self.loaded.case.circuit.is_some() {
                    row.extend(self.account.row());
                }
                row.extend(self.measures.sample(&self.simulation));
                self.table
                    .push(&row)
                    .map_err(|e| unwritable(&self.out.join("statistics.csv"), &e))?;
                self.results.append_statistics(&row)?;
            }
            if due(step, self.spread, output.views) || finished {
                self.views()?;
            }
            let turned = phase > 0 && self.simulation.control.phase() > phase && !recurs;
            if due(step, self.spread, output.frames) || finished || turned {
                self.frame(step)?;
            }
            progress(&self.progress(step, &report));
            whole?;
            if last {
                break;
            }
            if let Some(signal) = interrupt::asked() {
                self.keep()?;
                let total = self.total;
                return Ok(Some(format!(
                    "interrupted by {signal} after step {step} of {total}"
                )));
            }
            if self.keeper.due(step) {
                self.keep()?;
            }
        }
        Ok(None)
    }

    fn follow(&mut self, report: &StepReport, before: Cumulated) {
        self.sample = self.sample();
        if let (Some((_, place)), Some(test)) = (&self.cycles, &self.loaded.case.friction) {
            self.layer.follow(&self.simulation, (*place, test.along));
        }
        if let Some(test) = &mut self.biaxial {
            test.follow(&self.simulation);
        }
        self.worn.0 += report.totals.worn_first;
        self.worn.1 += report.totals.worn_third;
        let after = self.cumulated();
        let damage = self.damage_ratio();
        let s = &self.simulation;
        let h = s.scheme.h;
        if let (Some(sample), Some((cycles, _))) = (self.sample, &mut self.cycles) {
            self.slide += sample.slide;
            self.load_path += s.network.cycle_multiplier * sample.p * sample.slide.abs();
            cycles.add(&sample, h, before, after, damage);
        }
        let along = self.loaded.case.friction.as_ref().map_or(0, |t| t.along);
        let scaling = self.loaded.case.inertia_scaling;
        self.flows.add(s, along, scaling, self.worn.0);
        let solver = &mut self.summary.solver;
        self.iterations += u64::from(report.solver.iterations);
        solver.iterations_max = solver.iterations_max.max(report.solver.iterations);
        solver.error_max = solver.error_max.max(report.solver.error);
        let used = report.solver.used.name().to_owned();
        *solver.steps_by_method.entry(used).or_default() += 1;
        solver.choice.add(&report.solver);
        self.couplings += u64::from(report.coupling.iterations);
        solver.uncoupled_steps += u64::from(report.coupling.missed);
        if let Some(p) = &report.projected {
            solver.projected_steps += 1;
            solver.overlap_before = solver.overlap_before.max(p.before);
            solver.overlap_after = solver.overlap_after.max(p.after);
        }
        if !report.solver.converged {
            if solver.unconverged_steps == 0 {
                solver.first_unconverged = s.steps;
            }
            solver.unconverged_steps += 1;
        }
    }

    fn views(&mut self) -> Result<(), RunError> {
        let shear = self
            .strain
            .as_ref()
            .map(|strain| strain.shear(&self.simulation));
        Ok(views::append(
            &mut self.results,
            &self.simulation,
            self.loaded,
            shear,
        )?)
    }

    fn progress(&self, step: u64, report: &StepReport) -> Progress {
        Progress {
            steps: (step, self.total),
            resumed_at: self.resumed_at,
            cycle: self
                .cycles
                .as_ref()
                .map_or((0, 0), |(c, _)| (c.number(self.simulation.time), c.total())),
            contacts: self.simulation.network.contact_count(),
            iterations: report.solver.iterations,
            error: report.solver.error,
            unconverged: self.summary.solver.unconverged_steps,
            damage_ratio: self.damage_ratio(),
        }
    }
}

/// Whether event k of `count`, distributed over the run, falls on this step.
fn due(step: u64, total: u64, count: u32) -> bool {
    let number = |step: u64| u128::from(step) * u128::from(count) / u128::from(total.max(1));
    count > 0 && number(step) > number(step - 1)
}
