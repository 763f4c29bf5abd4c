//! Additional output of `--verbose`: contacts, first and last cycle, phases, solver, laws.

use super::Summary;
use super::text::Lines;
use crate::quantity::{number, quantity};

impl Summary {
    pub(super) fn details(&self, lines: &mut Lines) {
        lines.add(
            "contacts",
            format!("{} between {} bodies", self.contacts, self.bodies),
        );
        let (first, last) = (
            self.cycles.first(),
            self.cycles.last().filter(|c| c.cycle > 1),
        );
        for c in first.into_iter().chain(last) {
            let unfinished = if c.complete { "" } else { " (unfinished)" };
            let text = format!(
                "friction {}, E_d {}, mean P {}, largest |Q| {}, {} bonds broken, worn {}",
                number(c.friction_coefficient, 4),
                quantity(c.work, self.unit("J", "J/m")),
                quantity(c.normal_force, self.unit("N", "N/m")),
                quantity(c.tangential_amplitude, self.unit("N", "N/m")),
                c.broken,
                quantity(c.wear_volume, self.unit("m3", "m3/m"))
            );
            lines.add(&format!("cycle {}{unfinished}", c.cycle), text);
        }
        self.repeat_lines(lines);
        self.phase_lines(lines);
        self.solver_lines(lines);
        for p in &self.plugins {
            let hash = &p.sha256[..12.min(p.sha256.len())];
            let certified = if p.certified {
                "certified"
            } else {
                "NOT certified"
            };
            let text = format!("{} {} {} ({hash}), {certified}", p.kind, p.name, p.version);
            lines.add("law", text);
        }
        for w in &self.wear_coefficients {
            lines.add(
                "wear coefficient",
                format!("{}, {}: {}", w.interface, w.law, w.derivation),
            );
        }
        lines.add(
            "made with",
            format!(
                "fretwork {}, seed {}, {} threads, {} of processor time",
                self.version,
                self.seed,
                self.threads,
                quantity(self.cpu_seconds, "s")
            ),
        );
        self.time_spent.line(lines);
    }

    /// The repeated steps from which the error is estimated.
    fn repeat_lines(&self, lines: &mut Lines) {
        let r = &self.uncertainty.repeats;
        let text = match &r.reason {
            Some(reason) => format!("none, {reason}"),
            None => format!(
                "{} steps repeated at each of {} places, at the cost of {} % of the run",
                r.steps,
                r.places,
                number(100.0 * r.cost_share, 2)
            ),
        };
        lines.add("estimate of the error", text);
    }

    fn phase_lines(&self, lines: &mut Lines) {
        for (k, p) in self.phases.iter().enumerate() {
            if self.phases[..k].iter().any(|q| q.name == p.name) {
                continue;
            }
            let same = || self.phases.iter().filter(|q| q.name == p.name);
            let end = same().next_back().and_then(|last| last.end);
            let end = end.map_or_else(|| "the end of the run".to_owned(), |t| quantity(t, "s"));
            let start = quantity(p.start, "s");
            let text = match (same().count(), p.ended_by) {
                (1, Some(why)) => format!("from {start} to {end}, ended by {why}"),
                (1, None) => format!("from {start} to {end}"),
                (count, _) => format!("{count} times, from {start} to {end}"),
            };
            lines.add(&format!("phase {}", p.name), text);
        }
    }

    fn solver_lines(&self, lines: &mut Lines) {
        let s = &self.solver;
        let text = format!(
            "{:.1} iterations per step, {} at most; error at most {:.2e} (tolerance {:.0e})",
            s.iterations_mean, s.iterations_max, s.error_max, s.tolerance
        );
        lines.add("solver", text);
        let e = &s.error_parts;
        if e.slip_energy > 0.0 {
            let text = format!(
                "force balance {:.1e} of the work, velocities {:.1e}, contact law {:.1e} of the heat of slip; means over slip",
                e.force_balance, e.velocity, e.contact_law
            );
            lines.add("parts of the error", text);
        }
        let used = s.steps_by_method.iter();
        let used: Vec<String> = used
            .map(|(name, n)| format!("{name} ended {n} steps"))
            .collect();
        lines.add("method", format!("{}: {}", s.method, used.join(", ")));
        if s.method == "auto" {
            lines.add("why", &s.why);
        }
        if s.projected_steps > 0 {
            let text = format!(
                "{} steps removed overlaps: up to {:.2e} of a body's length before, {:.2e} after",
                s.projected_steps, s.overlap_before, s.overlap_after
            );
            lines.add("projection", text);
        }
        if s.coupling_iterations_mean > 0.0 {
            let text = format!(
                "{:.1} solves per step for the damage coupling",
                s.coupling_iterations_mean
            );
            lines.add("coupling", text);
        }
        if s.laws.solves_mean > 1.0 {
            let text = format!(
                "{:.1} solves per step for friction that depends on velocity or attraction that depends on the gap",
                s.laws.solves_mean
            );
            lines.add("laws", text);
        }
        if s.fclib_written + s.fclib_skipped > 0 {
            let skipped = match s.fclib_skipped {
                0 => String::new(),
                n => format!(
                    "; {n} not, since they have bonds, cohesion or friction against rotation, which FCLIB cannot represent"
                ),
            };
            lines.add(
                "problems",
                format!("{} steps written in fclib/{skipped}", s.fclib_written),
            );
        }
    }
}
