//! The state of a run: results of every run on its steps, contacts, bonds, energies and its solver.

mod driven;
mod energy;
mod phases;
mod solver;
mod step_size;
mod unconverged;

pub use driven::DrivenBodies;
pub use energy::{LEDGER_TOLERANCE, MomentumSummary};
pub use phases::Phases;
pub use unconverged::UnconvergedSteps;

use super::figures;
use super::output::Output;
use super::quantity::unit::{ANGULAR_MOMENTUM, ENERGY, METRE, MOMENTUM, ONE, SECOND, Unit, WORD};
use super::quantity::{DESCRIBES_THE_RUN, Field, Findings, Role, Topic, field};
use super::solving::SolverSummary;
use super::statistics::Column;
use super::warning::Warning;
use crate::observer::{Observer, RunEnd};
use fretwork_core::contact::StepSizeDiagnostics;
use fretwork_core::encoding::{EncodingError, decode, encode};
use fretwork_core::energy::Energy;
use fretwork_core::laws::Interface;
use fretwork_core::momentum::Momentum;
use fretwork_core::process::cycle::CycleClock;
use fretwork_core::step::{ImpossibleMotions, StepReport};
use fretwork_core::view::RunView;

/// Returns broken bonds over bonds made.
pub fn damage_ratio(run: &dyn RunView) -> f64 {
    let made = run.bonds_made();
    if made > 0 {
        run.bonds_broken() as f64 / made as f64
    } else {
        0.0
    }
}

/// Counters of the simulation, between two steps.
#[derive(Clone, Debug, Default)]
struct Counts {
    steps: u64,
    time: f64,
    bodies: usize,
    contacts: usize,
    bonds: u64,
    broken: u64,
    damage_ratio: f64,
    step_size: StepSizeDiagnostics,
    energy: Energy,
    momentum: Momentum,
}

impl Counts {
    /// Creates the counters of a simulation with this number of contacts.
    fn of(run: &dyn RunView, contacts: usize) -> Self {
        Self {
            steps: run.steps(),
            time: run.time(),
            bodies: run.bodies().len(),
            contacts,
            bonds: run.bonds_made(),
            broken: run.bonds_broken(),
            damage_ratio: damage_ratio(run),
            step_size: run.step_size().clone(),
            energy: *run.energies(),
            momentum: *run.momentum(),
        }
    }

    fn report(&self, bonds: BondsOfCase, found: &mut Findings) {
        found.begin(Topic::Run, Role::Diagnostic);
        found.add("steps", self.steps, ONE, "steps done");
        found.add("time", self.time, SECOND, "time reached");
        found.begin(Topic::Run, Role::Detail);
        found.add("bodies", self.bodies, ONE, "number of bodies");
        let said = format!("{} between {} bodies", self.contacts, self.bodies);
        let contacts = found.add(
            "contacts",
            self.contacts,
            ONE,
            "number of contacts at the end",
        );
        contacts.sentence("contacts", said);
        found.begin(Topic::Damage, Role::Detail);
        for (name, count, label, doc) in [
            ("bonds", self.bonds, "bonds made", "number of bonds made"),
            (
                "broken",
                self.broken,
                "bonds broken",
                "number of bonds broken",
            ),
        ] {
            let count = found.add(name, count, ONE, doc);
            if self.bonds > 0 {
                count.secondary(label).silent();
            }
        }
        let doc = "broken bonds over bonds made";
        let ratio = found.add("damage_ratio", self.damage_ratio, ONE, doc);
        if self.bonds > 0 || bonds.damaged {
            let said = format!("({} of {} bonds broken)", self.broken, self.bonds);
            ratio.secondary("damage ratio").remark(said);
        }
        if bonds.damaged {
            ratio.role = Role::Headline;
        }
        if self.bonds == 0 {
            ratio.silent();
        }
        if !bonds.any {
            for name in ["bonds", "broken", "damage_ratio"] {
                found.edit(name, |q| {
                    q.lacks(NO_BONDS);
                });
            }
        }
        energy::report(&self.energy, self.momentum, bonds, found);
        found.begin(Topic::Run, Role::Diagnostic);
        let doc = "whether the step was small enough to detect every contact in time";
        found.fields("step_size", &self.step_size, &step_size::FIELDS, doc);
        found.edit_all(&["step_size"], |q| {
            q.lacks(DESCRIBES_THE_RUN);
        });
    }
}

/// Whether the laws of a case make bonds, and damage them.
#[derive(Clone, Copy, Debug)]
struct BondsOfCase {
    any: bool,
    damaged: bool,
}

const NO_BONDS: &str = "no interface of the case makes bonds";
const NO_DAMAGE: &str = "no interface of the case has a damage law";

impl BondsOfCase {
    fn of(run: &dyn RunView) -> Self {
        let makes =
            |l: &Interface| l.opens() && (l.bonding_time().is_some() || l.healing.is_some());
        let any = run.laws().iter().any(makes) || run.bonds_made() > 0;
        Self {
            any,
            damaged: any && run.laws().iter().any(Interface::damages),
        }
    }
}

/// Observes the state of a run.
#[derive(Debug)]
pub struct RunState {
    /// Cycles of a friction test, for their numbers.
    clock: Option<CycleClock>,
    counts: Counts,
    solver: SolverSummary,
    impossible: ImpossibleMotions,
    bonds: BondsOfCase,
    iterations: u64,
    couplings: u64,
    /// Number of contacts in the last step; `None` before it.
    contacts: Option<usize>,
    /// Number of contacts with an impulse in the last step, iterations, error, and whether the
    /// tolerance was reached.
    last: [f64; 5],
}

impl RunState {
    /// Creates the observer of a run from the current state of a simulation; its friction test may
    /// have cycles.
    pub fn new(run: &dyn RunView, clock: Option<CycleClock>) -> Self {
        let options = &run.options().solver;
        Self {
            clock,
            counts: Counts::default(),
            bonds: BondsOfCase::of(run),
            solver: SolverSummary {
                tolerance: options.tolerance,
                error_formula: options.norm.formula().to_owned(),
                method: options.method.name().to_owned(),
                ..SolverSummary::default()
            },
            impossible: ImpossibleMotions::default(),
            iterations: 0,
            couplings: 0,
            contacts: None,
            last: [0.0; 5],
        }
    }

    fn count_contacts(&self, run: &dyn RunView) -> usize {
        self.contacts.unwrap_or_else(|| run.counted_contacts())
    }

    fn put(&self, counts: &Counts, run: Option<&dyn RunView>, found: &mut Findings) {
        counts.report(self.bonds, found);
        let mut solver = self.solver.clone();
        let steps = counts.steps.max(1) as f64;
        solver.coupling_iterations_mean = self.couplings as f64 / steps;
        solver.iterations_mean = self.iterations as f64 / steps;
        if let Some(run) = run {
            let choice = &self.solver.choice;
            solver.why = choice.why(run.options().solver.method, run.steps());
        }
        solver.report(found);
        if !self.impossible.is_empty() {
            let doc = "imposed motions that nothing could obey";
            found.fields("impossible_motions", &self.impossible, &IMPOSSIBLE, doc);
        }
        let possible = self.impossible.is_empty();
        energy::warn(&counts.energy, found);
        found.warn(
            self.impossible
                .warning()
                .map(|text| Warning::serious("IMPOSSIBLE MOTION", text)),
        );
        found.warn(step_size::warnings(&counts.step_size));
        let missed = UnconvergedSteps {
            steps: solver
                .unconverged_steps
                .saturating_sub(self.impossible.squeezed_steps),
            first: solver.first_unconverged,
            error: solver.error_max,
        };
        found.warn(solver.warnings(counts.steps, possible));
        let advice = match run {
            Some(run) => missed.warning(run, run.steps()),
            None => missed.seen(counts.steps, solver.tolerance),
        };
        found.warn(advice.map(|text| Warning::serious("NOT CONVERGED", text)));
    }
}

/// Fields of imposed motions that were impossible.
const IMPOSSIBLE: [Field; 7] = [
    field(
        "squeezed_steps",
        ONE,
        "steps in which imposed motions squeezed others without bound",
    ),
    field("squeezed_at", SECOND, "end of the first of them"),
    field("squeezing", WORD, "the bodies that did so"),
    field(
        "overlapping_steps",
        ONE,
        "steps in which bodies whose motions are both imposed moved into each other",
    ),
    field("overlapping_at", SECOND, "end of the first of them"),
    field("overlapping", WORD, "the bodies with the largest overlap"),
    field("overlap", METRE, "largest overlap of them"),
];

impl Observer for RunState {
    fn name(&self) -> String {
        "run state".to_owned()
    }

    fn reads_statistics(&self) -> bool {
        false
    }

    fn before_step(&mut self, run: &dyn RunView) {
        self.counts = Counts::of(run, self.count_contacts(run));
    }

    fn after_step(&mut self, run: &dyn RunView, report: &StepReport) {
        let solver = &mut self.solver;
        self.iterations += u64::from(report.solver.iterations);
        solver.iterations_max = solver.iterations_max.max(report.solver.iterations);
        solver.error_max = solver.error_max.max(report.solver.error);
        solver.error_parts.add(&report.solver.parts);
        let used = report.solver.used.name().to_owned();
        *solver.steps_by_method.entry(used).or_default() += 1;
        solver.choice.add(&report.solver);
        solver.several_steps += u64::from(report.solver.several);
        solver.not_searched_steps += u64::from(report.solver.not_searched);
        solver.pinched_steps += u64::from(report.solver.pinched);
        let name = |body| run.body_name(body);
        self.impossible.add(run.time(), name, report);
        self.couplings += u64::from(report.coupling.iterations);
        solver.uncoupled_steps += u64::from(report.coupling.missed);
        solver.laws.add(&report.agreement);
        solver.overlap_max = solver.overlap_max.max(report.overlap);
        if let Some(p) = &report.projected {
            solver.projected_steps += 1;
            solver.overlap_before = solver.overlap_before.max(p.before);
            solver.overlap_after = solver.overlap_after.max(p.after);
        }
        if !report.solver.converged {
            if solver.unconverged_steps == 0 {
                solver.first_unconverged = run.steps();
            }
            solver.unconverged_steps += 1;
        }
        self.contacts = Some(report.contacts);
        self.last = [
            report.active as f64,
            f64::from(report.solver.iterations),
            report.solver.error,
            f64::from(u8::from(report.solver.converged)),
            report.overlap,
        ];
    }

    fn columns(&self) -> Vec<Column> {
        let c = |name, unit: Unit, doc| Column::new(name, unit, doc);
        let mut out = vec![
            c("step", ONE, "number of the step"),
            c("time", SECOND, "time at its end"),
            c("cycle", ONE, "cycle of the friction test"),
            c("contacts", ONE, "contacts within the alert distance"),
            c("active", ONE, "contacts that carry an impulse"),
            c("iterations", ONE, "sweeps of the solver"),
            c("error", ONE, "error of the solution"),
            c("converged", ONE, "1 if the tolerance was reached"),
            c(
                "overlap",
                ONE,
                "deepest overlap of rigid contacts, over the radius of the smaller grain",
            ),
            c("bonds_intact", ONE, "bonds that hold"),
            c("bonds_broken", ONE, "bonds that broke"),
            c("damage_ratio", ONE, "broken bonds over bonds made"),
            c("mean_damage", ONE, "mean damage over bonds made"),
        ];
        let entries = Energy::default().entries().into_iter();
        out.extend(entries.map(|(name, doc, _)| c(name, ENERGY, doc)));
        let units = [MOMENTUM, ANGULAR_MOMENTUM];
        let entries = Momentum::default().entries().into_iter().zip(units);
        out.extend(entries.map(|((name, doc, _), unit)| c(name, unit, doc)));
        out
    }

    fn sample(&mut self, run: &dyn RunView) -> Vec<f64> {
        let cycle = self.clock.map_or(0, |c| c.number(run.time()));
        let mut row = vec![
            run.steps() as f64,
            run.time(),
            f64::from(cycle),
            self.count_contacts(run) as f64,
        ];
        row.extend(self.last);
        row.extend([
            (run.bonds_made() - run.bonds_broken()) as f64,
            run.bonds_broken() as f64,
            damage_ratio(run),
            run.mean_damage(),
        ]);
        row.extend(run.energies().entries().map(|(_, _, value)| value));
        row.extend(run.momentum().entries().map(|(_, _, value)| value));
        row
    }

    fn report(&self, end: &RunEnd<'_>, found: &mut Findings) {
        let run = end.simulation;
        let contacts = run.counted_contacts();
        self.put(&Counts::of(run, contacts), Some(run), found);
        found.begin(Topic::Damage, Role::Detail);
        let doc = "mean damage D over all bonds made, broken ones counting 1";
        let mean = found.add("mean_damage", run.mean_damage(), ONE, doc);
        if run.bonds_made() > 0 {
            mean.secondary("mean damage");
        }
        if !self.bonds.damaged {
            mean.lacks(NO_DAMAGE);
        }
    }

    fn report_so_far(&self, found: &mut Findings) {
        self.put(&self.counts, None, found);
    }

    fn file_names(&self) -> Vec<String> {
        ["damage_ratio.png", "energy.png"]
            .map(str::to_owned)
            .to_vec()
    }

    fn figures(&self, end: &RunEnd<'_>) -> Vec<Output> {
        let entries = end.simulation.energies().entries();
        let entries = entries.into_iter().map(|(name, ..)| name);
        let joule = ENERGY.symbol(end.simulation.dimension());
        vec![
            figures::damage_ratio(&end.uncertainty.damage_ratio),
            figures::energy_balance(entries, &end.uncertainty.friction_energy, joule),
        ]
    }

    fn save(&self) -> Result<Vec<u8>, EncodingError> {
        encode(&(
            &self.solver,
            &self.impossible,
            self.iterations,
            self.couplings,
        ))
    }

    fn restore(&mut self, from: &[u8]) -> Result<(), EncodingError> {
        (
            self.solver,
            self.impossible,
            self.iterations,
            self.couplings,
        ) = decode(from)?;
        self.contacts = None;
        Ok(())
    }
}
