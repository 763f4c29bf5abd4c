//! The state of a run: what every run says of its steps, contacts, bonds, energies and its solver.

mod driven;
mod energy;
mod missed;
mod phases;
mod solver;
mod step_size;

pub use driven::DrivenBodies;
pub use energy::{LEDGER, MomentumSummary};
pub use missed::Missed;
pub use phases::Phases;

use super::figures;
use super::output::Output;
use super::quantity::unit::{ANGULAR_MOMENTUM, ENERGY, METRE, MOMENTUM, ONE, SECOND, Unit, WORD};
use super::quantity::{COURSE, Field, Findings, Role, Topic, field};
use super::solving::SolverSummary;
use super::statistics::Column;
use super::warning::Warning;
use crate::typed::{ObserverIn, RunEndIn};
use fretwork_core::code::{CodeError, decode, encode};
use fretwork_core::contact::StepSizeDiagnostics;
use fretwork_core::energy::Energy;
use fretwork_core::geometry::space::Space;
use fretwork_core::laws::Interface;
use fretwork_core::momentum::Momentum;
use fretwork_core::process::cycle::CycleClock;
use fretwork_core::step::{ImpossibleMotions, Simulation, StepReport};

/// Broken bonds over bonds made.
pub fn damage_ratio<S: Space>(s: &Simulation<S>) -> f64 {
    let n = &s.state.network;
    if n.bonds_made() > 0 {
        n.bonds_broken() as f64 / n.bonds_made() as f64
    } else {
        0.0
    }
}

/// What the simulation counts, between two steps.
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
    /// Of a simulation with so many contacts.
    fn of<S: Space>(s: &Simulation<S>, contacts: usize) -> Self {
        let n = &s.state.network;
        Self {
            steps: s.state.steps,
            time: s.state.time,
            bodies: s.state.bodies.len(),
            contacts,
            bonds: n.bonds_made(),
            broken: n.bonds_broken(),
            damage_ratio: damage_ratio(s),
            step_size: n.step_size.clone(),
            energy: s.state.energy,
            momentum: s.state.momentum,
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
        found.fields("haste", &self.step_size, &step_size::FIELDS, doc);
        found.edit_all(&["haste"], |q| {
            q.lacks(COURSE);
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
    fn of<S: Space>(s: &Simulation<S>) -> Self {
        let makes =
            |l: &Interface| l.opens() && (l.bonding_time().is_some() || l.healing.is_some());
        let any = s.laws.iter().any(makes) || s.state.network.bonds_made() > 0;
        Self {
            any,
            damaged: any && s.laws.iter().any(Interface::damages),
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
    /// Number of contacts in the last step; none before it.
    contacts: Option<usize>,
    /// Contacts that carried an impulse in the last step, sweeps, error, and whether the tolerance
    /// was reached.
    last: [f64; 5],
}

impl RunState {
    /// Of a run from the current state of a simulation; its friction test may have cycles.
    pub fn new<S: Space>(s: &Simulation<S>, clock: Option<CycleClock>) -> Self {
        let options = &s.options.solver;
        Self {
            clock,
            counts: Counts::default(),
            bonds: BondsOfCase::of(s),
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

    fn count_contacts<S: Space>(&self, s: &Simulation<S>) -> usize {
        let parallel = s.options.solver.parallel;
        let counted = || s.state.network.contact_count(parallel);
        self.contacts.unwrap_or_else(counted)
    }

    fn put<S: Space>(&self, counts: &Counts, s: Option<&Simulation<S>>, found: &mut Findings) {
        counts.report(self.bonds, found);
        let mut solver = self.solver.clone();
        let steps = counts.steps.max(1) as f64;
        solver.coupling_iterations_mean = self.couplings as f64 / steps;
        solver.iterations_mean = self.iterations as f64 / steps;
        if let Some(s) = s {
            let choice = &self.solver.choice;
            solver.why = choice.why(s.options.solver.method, s.state.steps);
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
        let missed = Missed {
            steps: solver
                .unconverged_steps
                .saturating_sub(self.impossible.squeezed_steps),
            first: solver.first_unconverged,
            error: solver.error_max,
        };
        found.warn(solver.warnings(counts.steps, possible));
        let advice = match s {
            Some(s) => missed.warning(s, s.state.steps),
            None => missed.seen(counts.steps, solver.tolerance),
        };
        found.warn(advice.map(|text| Warning::serious("NOT CONVERGED", text)));
    }
}

/// What is said of motions that could not be obeyed.
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

impl<S: Space> ObserverIn<S> for RunState {
    fn name(&self) -> String {
        "run state".to_owned()
    }

    fn reads_statistics(&self) -> bool {
        false
    }

    fn before_step(&mut self, s: &Simulation<S>) {
        self.counts = Counts::of(s, self.count_contacts(s));
    }

    fn after_step(&mut self, s: &Simulation<S>, report: &StepReport) {
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
        self.impossible.add(s, report);
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
                solver.first_unconverged = s.state.steps;
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

    fn sample(&mut self, s: &Simulation<S>) -> Vec<f64> {
        let n = &s.state.network;
        let cycle = self.clock.map_or(0, |c| c.number(s.state.time));
        let mut row = vec![
            s.state.steps as f64,
            s.state.time,
            f64::from(cycle),
            self.count_contacts(s) as f64,
        ];
        row.extend(self.last);
        row.extend([
            (n.bonds_made() - n.bonds_broken()) as f64,
            n.bonds_broken() as f64,
            damage_ratio(s),
            n.mean_damage(),
        ]);
        row.extend(s.state.energy.entries().map(|(_, _, value)| value));
        row.extend(s.state.momentum.entries().map(|(_, _, value)| value));
        row
    }

    fn report(&self, end: &RunEndIn<'_, S>, found: &mut Findings) {
        let s = end.simulation;
        let contacts = s.state.network.contact_count(s.options.solver.parallel);
        self.put(&Counts::of(s, contacts), Some(s), found);
        found.begin(Topic::Damage, Role::Detail);
        let doc = "mean damage D over all bonds made, broken ones counting 1";
        let mean = found.add("mean_damage", s.state.network.mean_damage(), ONE, doc);
        if s.state.network.bonds_made() > 0 {
            mean.secondary("mean damage");
        }
        if !self.bonds.damaged {
            mean.lacks(NO_DAMAGE);
        }
    }

    fn report_so_far(&self, found: &mut Findings) {
        self.put::<S>(&self.counts, None, found);
    }

    fn figures(&self, end: &RunEndIn<'_, S>) -> Vec<Output> {
        let entries = end.simulation.state.energy.entries();
        let entries = entries.into_iter().map(|(name, ..)| name);
        let joule = ENERGY.symbol(S::D);
        vec![
            figures::damage_ratio(&end.uncertainty.damage_ratio),
            figures::energy_balance(entries, &end.uncertainty.friction_energy, joule),
        ]
    }

    fn save(&self) -> Result<Vec<u8>, CodeError> {
        encode(&(
            &self.solver,
            &self.impossible,
            self.iterations,
            self.couplings,
        ))
    }

    fn restore(&mut self, from: &[u8]) -> Result<(), CodeError> {
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
