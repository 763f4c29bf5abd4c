//! End of a run: summary, figures and final output.

use super::error::unreadable;
use super::{Recorder, RunError, unwritable};
use crate::geometry::space::Space;
use crate::record::biaxial::Outcome;
use crate::record::checkpoint::Kind;
pub(super) use crate::record::checkpoint::LAST;
use crate::record::figures::{self, biaxial, circuit, jump};
use crate::record::friction::{Cycle, Cycles};
use crate::record::output::Output;
use crate::record::summary::{Summary, Uncertainty, Wear};
use crate::record::{first_bodies, fretting, scars};
use crate::report::{draw_panels, noted};
use crate::scene::build::Dimensional;
use std::path::Path;

impl<S: Space> Recorder<'_, S> {
    /// Updates the cheap parts of the summary between two steps.
    pub(super) fn count(&mut self) {
        let (s, n) = (&self.simulation, &self.simulation.network);
        let summary = &mut self.summary;
        summary.steps = s.steps;
        summary.time = s.time;
        summary.bodies = s.bodies.len();
        summary.contacts = n.contact_count();
        summary.bonds = n.bonds_made();
        summary.broken = n.bonds_broken();
        summary.damage_ratio = if n.bonds_made() > 0 {
            n.bonds_broken() as f64 / n.bonds_made() as f64
        } else {
            0.0
        };
        summary.step_size = n.step_size.clone();
        summary.energy = s.energy;
        summary.energy_residual_relative = s.energy.relative_residual();
        summary.solver.coupling_iterations_mean = self.couplings as f64 / s.steps.max(1) as f64;
        summary.solver.iterations_mean = self.iterations as f64 / s.steps.max(1) as f64;
    }
}

/// Fills the summary from the cycles of a friction test.
pub(super) fn sum_up(summary: &mut Summary, cycles: Option<&Cycles>) {
    if let Some(cycles) = cycles {
        summary.friction_coefficient = cycles.last().map(|c| c.friction_coefficient);
        summary.friction_from_dissipation = cycles.last().map(|c| c.friction_from_dissipation);
        summary.peak_friction = cycles.last().and_then(Cycle::peak_ratio);
        summary.cycles.clone_from(&cycles.list);
        summary.fretting = fretting::Outcome::new(&cycles.list).filter(|_| cycles.oscillates());
    }
    let scatter = cycles.and_then(Cycles::scatter);
    summary.uncertainty = Uncertainty::new(summary, scatter.as_ref());
}

impl<S: Dimensional> Recorder<'_, S> {
    /// Writes the final output of a run, however it ended.
    pub(super) fn finish(&mut self) -> Result<(), RunError> {
        let recalled = self.recall();
        self.count();
        let (s, n) = (&self.simulation, &self.simulation.network);
        let summary = &mut self.summary;
        let wall = self.spent.0 + self.clock.elapsed();
        summary.wall_seconds = wall.as_secs_f64();
        summary.cpu_seconds = (self.spent.1 + self.processor.elapsed()).as_secs_f64();
        summary.mean_damage = n.mean_damage();
        let start = self.loaded.case.biaxial.as_ref().map_or(0.0, |t| t.start);
        if let Some(test) = &self.biaxial {
            summary.biaxial = Some(Outcome::new(&self.table, start, test.grain_mass(s)));
        }
        summary.phases = s.control.begun().to_vec();
        let phases = s.control.phases.iter().skip(summary.phases.len());
        summary.phases_missed = phases.map(|p| p.name.clone()).collect();
        summary.phases_missed.dedup();
        summary.scars = scars::outcome(s);
        summary.measures = self.measures.outcome(&self.table);
        summary.measure_units = self.measures.units();
        let found = &summary.measures;
        summary
            .measure_units
            .retain(|name, _| found.contains_key(name));
        summary.findings = self.measures.verdict(&self.table);
        summary.jump = self.jumps.as_ref().map(|j| j.outcome(s, self.worn));
        // Wear continues over the cycles that were jumped over.
        let share = self.cycles.as_ref().map_or(1.0, |(c, _)| c.share(s.time));
        let share = if share < 1.0 { share } else { 0.0 };
        let cycles = self.jumps.as_ref().map_or(0.0, |j| j.jumped(share));
        let period = self.cycles.as_ref().and_then(|(c, _)| c.period());
        let over = cycles * period.unwrap_or(0.0);
        // No material leaves a contact that is periodic along the sliding.
        let along = self.loaded.case.friction.as_ref().map_or(0, |t| t.along);
        let closed = s.shapes.periodic.period[along].map(|_| 0.0);
        let load_path = self.cycles.as_ref().map(|_| self.load_path);
        summary.wear = Wear {
            unit: Wear::unit(S::D),
            start: self.flows.start,
            Qs: self.flows.source(over) * self.density,
            Qi: self.flows.internal(),
            Qe: closed,
            Qw: closed,
            volume_first_bodies: self.worn.0,
            volume_third_body: self.worn.1,
            load_path,
            bodies: first_bodies::wear(s, load_path),
        };
        sum_up(summary, self.cycles.as_ref().map(|(c, _)| c));
        summary.circuit = self.account.summary(s, wall);
        if let Some(circuit) = &summary.circuit {
            let span = (s.time - circuit.start).max(f64::MIN_POSITIVE);
            summary.wear.Qs += circuit.flows.source.mass / span;
            summary.wear.Qe = Some(circuit.flows.ejected.mass / span);
            summary.wear.Qw = Some(circuit.flows.wear.mass / span);
        }
        summary.solver.why = summary.solver.choice.why(s.solver.method, s.steps);
        let notice = self.warn();
        let files = noted(notice, || self.files()).and(recalled);
        if let (Err(e), None) = (&files, &self.summary.stopped) {
            self.summary.stopped = Some(e.to_string());
            self.warn();
        }
        let text = serde_json::to_string_pretty(&self.summary).unwrap_or_default();
        whole(&self.out.join(LAST), &(text + "\n"))?;
        files
    }

    /// Reads the rows of the statistics back, if they are needed.
    fn recall(&mut self) -> Result<(), RunError> {
        let case = &self.loaded.case;
        if !case.output.figures && case.biaxial.is_none() && case.measures.is_empty() {
            return Ok(());
        }
        let path = self.out.join("statistics.csv");
        self.table.recall().map_err(|e| unreadable(&path, &e))
    }

    /// Writes all other files; a failure of one does not stop the next.
    fn files(&mut self) -> Result<(), RunError> {
        let table = self.table.flush();
        let table = table.map_err(|e| unwritable(&self.out.join("statistics.csv"), &e));
        let scars = write_outputs(&self.out, &scars::tables(&self.simulation));
        let results = self.end_results();
        table.and(results).and(scars).and(self.draw())
    }

    /// Closes the results file, and marks it complete if the run reached its end.
    fn end_results(&mut self) -> Result<(), RunError> {
        if self.summary.stopped.is_none() {
            let (number, bytes) = self.keeper.frame(Kind::Ended, Vec::new());
            self.results.keep(number, &bytes);
        }
        Ok(self.results.finish(&self.out)?)
    }

    /// Draws the figures.
    fn draw(&self) -> Result<(), RunError> {
        let start = self.loaded.case.biaxial.as_ref().map_or(0.0, |t| t.start);
        if self.loaded.case.output.figures {
            let cycles = self.cycles.as_ref().map(|c| &c.0);
            // The fretting loops already show the test itself.
            let test = self.loaded.case.friction.as_ref();
            let test = test.filter(|_| cycles.is_some_and(Cycles::oscillates));
            let test = test.map(|t| (t.body.as_str(), t.along));
            figures::draw(
                &self.out,
                &self.loaded.case.name,
                &self.table,
                cycles,
                &figures::drives(&self.simulation, test),
                S::D,
            )?;
            if let Some(c) = &self.summary.circuit {
                let title = &self.loaded.case.name;
                circuit::draw(&self.out, title, &self.table, c.window, S::D)?;
            }
            if let Some(j) = &self.summary.jump {
                jump::draw(&self.out, &self.loaded.case.name, j, S::D)?;
            }
            let title = &self.loaded.case.name;
            write_outputs(&self.out, &self.measures.outputs(title, &self.table))?;
            figures::scars::draw(&self.out, &self.loaded.case.name, &self.simulation)?;
            if self.biaxial.is_some() {
                let title = &self.loaded.case.name;
                biaxial::draw(&self.out.join("biaxial.png"), title, &self.table, start)?;
            }
        }
        Ok(())
    }
}

/// Writes and draws the outputs of observers into a folder.
///
/// # Errors
/// A file cannot be written.
pub fn write_outputs(folder: &Path, outputs: &[Output]) -> Result<(), RunError> {
    outputs.iter().try_for_each(|output| match output {
        Output::Text { file, text } => {
            let path = folder.join(file);
            std::fs::write(&path, text).map_err(|e| unwritable(&path, &e))
        }
        Output::Charts {
            file,
            charts,
            columns,
        } => Ok(draw_panels(charts, *columns, &folder.join(file))?),
    })
}

/// Writes a file atomically: it is complete whenever it exists.
pub(super) fn whole(path: &Path, text: &str) -> Result<(), RunError> {
    let part = path.with_extension("part");
    std::fs::write(&part, text).map_err(|e| unwritable(&part, &e))?;
    std::fs::rename(&part, path).map_err(|e| unwritable(path, &e))
}
