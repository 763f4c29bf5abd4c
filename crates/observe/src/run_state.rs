//! The state of a run: what every run says of its steps, contacts, bonds, energies and its solver.

use super::figures;
use super::observer::{Observer, RunEnd};
use super::output::Output;
use super::solving::SolverSummary;
use super::statistics::Column;
use super::summary::{MomentumSummary, Summary};
use fretwork_core::code::{CodeError, decode, encode};
use fretwork_core::contact::StepSizeDiagnostics;
use fretwork_core::energy::Energy;
use fretwork_core::geometry::space::Space;
use fretwork_core::momentum::Momentum;
use fretwork_core::process::cycle::CycleClock;
use fretwork_core::solve;
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

    fn put(&self, summary: &mut Summary) {
        summary.steps = self.steps;
        summary.time = self.time;
        summary.bodies = self.bodies;
        summary.contacts = self.contacts;
        summary.bonds = self.bonds;
        summary.broken = self.broken;
        summary.damage_ratio = self.damage_ratio;
        summary.step_size = self.step_size.clone();
        summary.energy = self.energy;
        summary.energy_residual_relative = self.energy.relative_residual();
        let [linear, angular] = self.momentum.drift();
        let relative = self.momentum.relative();
        summary.momentum = MomentumSummary {
            linear,
            angular,
            linear_relative: relative[0],
            angular_relative: relative[1],
        };
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
    iterations: u64,
    couplings: u64,
    /// Number of contacts in the last step; none before it.
    contacts: Option<usize>,
    /// Contacts that carried an impulse in the last step, sweeps, error, and whether the tolerance was reached.
    last: [f64; 5],
}

impl RunState {
    /// Of a run solved with these options; its friction test may have cycles.
    pub fn new(options: &solve::Options, clock: Option<CycleClock>) -> Self {
        Self {
            clock,
            counts: Counts::default(),
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

    fn put(&self, counts: &Counts, summary: &mut Summary) {
        counts.put(summary);
        summary.solver.clone_from(&self.solver);
        summary.impossible_motions.clone_from(&self.impossible);
        let steps = counts.steps.max(1) as f64;
        summary.solver.coupling_iterations_mean = self.couplings as f64 / steps;
        summary.solver.iterations_mean = self.iterations as f64 / steps;
    }
}

impl<S: Space> Observer<S> for RunState {
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
        let joule = if S::D == 2 { "J/m" } else { "J" };
        let c = |name, unit, doc| Column::new(name, unit, doc);
        let mut out = vec![
            c("step", "", "number of the step"),
            c("time", "s", "time at its end"),
            c("cycle", "", "cycle of the friction test"),
            c("contacts", "", "contacts within the alert distance"),
            c("active", "", "contacts that carry an impulse"),
            c("iterations", "", "sweeps of the solver"),
            c("error", "", "error of the solution"),
            c("converged", "", "1 if the tolerance was reached"),
            c(
                "overlap",
                "",
                "deepest overlap of rigid contacts, over the radius of the smaller grain",
            ),
            c("bonds_intact", "", "bonds that hold"),
            c("bonds_broken", "", "bonds that broke"),
            c("damage_ratio", "", "broken bonds over bonds made"),
            c("mean_damage", "", "mean damage over bonds made"),
        ];
        let entries = Energy::default().entries().into_iter();
        out.extend(entries.map(|(name, doc, _)| c(name, joule, doc)));
        let units = match S::D {
            2 => ["N s/m", "N s"],
            _ => ["N s", "N m s"],
        };
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

    fn summarise(&self, end: &RunEnd<'_, S>, summary: &mut Summary) {
        let s = end.simulation;
        let contacts = s.state.network.contact_count(s.options.solver.parallel);
        self.put(&Counts::of(s, contacts), summary);
        summary.mean_damage = s.state.network.mean_damage();
        summary.solver.why = self
            .solver
            .choice
            .why(s.options.solver.method, s.state.steps);
    }

    fn summarise_so_far(&self, summary: &mut Summary) {
        self.put(&self.counts, summary);
    }

    fn figures(&self, end: &RunEnd<'_, S>) -> Vec<Output> {
        let entries = end.simulation.state.energy.entries();
        let entries = entries.into_iter().map(|(name, ..)| name);
        let joule = if S::D == 2 { "J/m" } else { "J" };
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

/// Observes the phases of a run: the number of the current one.
#[derive(Clone, Copy, Debug)]
pub struct Phases {
    any: bool,
}

impl Phases {
    /// Of the phases of a simulation.
    pub fn of<S: Space>(s: &Simulation<S>) -> Self {
        Self {
            any: !s.phases.is_empty(),
        }
    }
}

impl<S: Space> Observer<S> for Phases {
    fn name(&self) -> String {
        "phases".to_owned()
    }

    fn reads_statistics(&self) -> bool {
        false
    }

    fn columns(&self) -> Vec<Column> {
        let column = || Column::new("phase", "", "number of the phase, from 1");
        self.any.then(column).into_iter().collect()
    }

    fn sample(&mut self, s: &Simulation<S>) -> Vec<f64> {
        let phase = || s.state.control.phase() as f64;
        self.any.then(phase).into_iter().collect()
    }

    fn summarise(&self, end: &RunEnd<'_, S>, summary: &mut Summary) {
        let control = &end.simulation.state.control;
        summary.phases = control.begun().to_vec();
        let phases = end.simulation.phases.iter().skip(summary.phases.len());
        summary.phases_missed = phases.map(|p| p.name.clone()).collect();
        summary.phases_missed.dedup();
    }
}

/// Observes the driven bodies: places, velocities and contact forces.
#[derive(Clone, Debug)]
pub struct DrivenBodies {
    /// Place among the driven bodies, and name.
    shown: Vec<(usize, String)>,
    /// Body and axis of an oscillating friction test, whose loops are drawn by themselves.
    test: Option<(String, usize)>,
}

impl DrivenBodies {
    /// Of the driven bodies of a simulation; a body and an axis whose force is drawn elsewhere may be left out of the figures.
    pub fn of<S: Space>(s: &Simulation<S>, test: Option<(String, usize)>) -> Self {
        let named = s.state.bodies.driven.iter().enumerate();
        // Walls that a scene file brought are not worth columns.
        let shown = named.filter(|(_, d)| !d.name.starts_with("wall_"));
        Self {
            shown: shown.map(|(k, d)| (k, d.name.clone())).collect(),
            test,
        }
    }
}

impl<S: Space> Observer<S> for DrivenBodies {
    fn name(&self) -> String {
        "driven bodies".to_owned()
    }

    fn reads_statistics(&self) -> bool {
        false
    }

    fn columns(&self) -> Vec<Column> {
        let newton = if S::D == 2 { "N/m" } else { "N" };
        let mut out = Vec::new();
        for (_, name) in &self.shown {
            for (what, unit, doc) in [
                ("", "m", "position of the body"),
                ("v", "m/s", "velocity of the body"),
                ("f", newton, "contact force on the body"),
            ] {
                let axes = ["x", "y", "z"].into_iter().take(S::D);
                out.extend(axes.map(|a| Column::new(format!("{name}_{what}{a}"), unit, doc)));
            }
        }
        out
    }

    fn sample(&mut self, s: &Simulation<S>) -> Vec<f64> {
        let mut row = Vec::with_capacity(self.shown.len() * 3 * S::D);
        for (d, _) in &self.shown {
            let b = s.state.bodies.driven[*d].body as usize;
            let force = s.state.received[*d].0 * (1.0 / s.options.scheme.h);
            for values in [
                s.state.bodies.position[b],
                s.state.bodies.velocity[b],
                force,
            ] {
                row.extend((0..S::D).map(|k| values[k]));
            }
        }
        row
    }

    fn summarise(&self, _: &RunEnd<'_, S>, _: &mut Summary) {}

    fn figures(&self, end: &RunEnd<'_, S>) -> Vec<Output> {
        let test = self
            .test
            .as_ref()
            .map(|(body, axis)| (body.as_str(), *axis));
        let drives = figures::drives(end.simulation, test);
        vec![figures::force_displacement(&drives)]
    }
}
