//! Text at the end of a run: warnings, friction, damage, wear, energies. Further output is in `details`.

use super::{BodyWear, FractureSummary, Summary};
use crate::biaxial::Outcome;
use crate::friction::Cycle;
use crate::jump;
use crate::quantity::{number, quantity, wear_rate};
use std::fmt::Write as _;

/// Largest number of measured values that are printed without `--verbose`.
const MEASURES: usize = 8;

/// Energies below this fraction of the largest are omitted, as in the energy figure.
const NEGLIGIBLE: f64 = 1e-3;

/// Lines of label and text.
#[derive(Default)]
pub(super) struct Lines(String);

impl Lines {
    pub fn add(&mut self, label: &str, text: impl AsRef<str>) {
        let _ = writeln!(self.0, "  {label:<22} {}", text.as_ref());
    }

    pub fn all(&mut self, lines: impl IntoIterator<Item = (&'static str, String)>) {
        lines
            .into_iter()
            .for_each(|(label, text)| self.add(label, text));
    }
}

impl Summary {
    /// The text: warnings first, then the results, with all details if `verbose`.
    pub fn text(&self, verbose: bool) -> String {
        let mut out = String::new();
        if !self.trustworthy {
            out += "NOT TRUSTWORTHY\n";
        }
        for warning in &self.warnings {
            let _ = writeln!(out, "  {warning}");
        }
        let _ = writeln!(out, "{}", self.case);
        let mut lines = Lines::default();
        self.friction(&mut lines);
        self.damage(&mut lines);
        self.worn(&mut lines);
        self.energies(&mut lines);
        self.others(&mut lines, verbose);
        if let Some(accuracy) = &self.accuracy {
            lines.add("accuracy", accuracy.line());
        }
        if verbose {
            self.details(&mut lines);
        }
        let rate = self.steps as f64 / self.wall_seconds.max(1e-9);
        lines.add(
            "run",
            format!(
                "{} steps to t = {} in {} ({rate:.0} a second)",
                self.steps,
                quantity(self.time, "s"),
                quantity(self.wall_seconds, "s")
            ),
        );
        out + &lines.0
    }

    /// Unit of a quantity that is per metre of depth in 2D.
    pub(super) fn unit(&self, solid: &'static str, plane: &'static str) -> &'static str {
        if self.dimension == 3 { solid } else { plane }
    }

    /// The last complete cycle, or the last one if none is complete.
    fn last_cycle(&self) -> Option<&Cycle> {
        let complete = self.cycles.iter().rfind(|c| c.complete);
        complete.or(self.cycles.last())
    }

    fn friction(&self, lines: &mut Lines) {
        let (Some(mu), Some(cycle)) = (self.friction_coefficient, self.last_cycle()) else {
            return;
        };
        let fretting = self.fretting.is_some();
        let over = match (fretting, cycle.complete) {
            (true, true) => format!("in cycle {}, the last complete one", cycle.cycle),
            (false, true) => "over the second half".to_owned(),
            (_, false) => "over the completed part of the evaluated time".to_owned(),
        };
        let known = &self.uncertainty.friction_coefficient;
        let settings = known.from_settings(|half| number(half, 2));
        let text = match (known.value, known.scatter, &known.method) {
            (Some(value), Some(half), Some(method)) => format!(
                "{} +- {} ({method}){settings}; {} {over}, from forces",
                number(value, 4),
                number(half, 2),
                number(mu, 4)
            ),
            _ => format!("{}{settings} {over}, from forces", number(mu, 4)),
        };
        lines.add("friction coefficient", text);
        if let Some(energetic) = self.friction_from_dissipation {
            let text = format!(
                "{} {over}: energy dissipated and stored over P times the path",
                number(energetic, 4)
            );
            lines.add("energetic coefficient", text);
        }
        if let Some(peak) = self.peak_friction {
            let text = format!("{} {over}: largest |Q| over mean P", number(peak, 4));
            lines.add("peak Q/P", text);
        }
        if let Some(plateau) = self.plateau_friction {
            let text = format!(
                "{} {over}: |Q|/P over the second half of each stroke, without the elastic travel after a reversal",
                number(plateau, 4)
            );
            lines.add("plateau Q/P", text);
        }
        let Some(f) = &self.fretting else { return };
        let complete = self.cycles.iter().filter(|c| c.complete);
        if let (Some(first), true) = (complete.clone().next(), complete.clone().count() > 1) {
            let text = format!(
                "{} complete; {} in the first, {} in the last",
                complete.count(),
                number(first.friction_coefficient, 4),
                number(mu, 4)
            );
            lines.add("cycles", text);
        }
        let same = f.regime == cycle.regime;
        let whole = if same {
            "in all cycles".to_owned()
        } else {
            format!(
                "in cycle {}; {} over all cycles",
                cycle.cycle,
                f.regime.name()
            )
        };
        let text = format!(
            "{} {whole}; E_d/(4 Q delta) {}, E_d {}, stroke +-{}",
            cycle.regime.name(),
            number(cycle.energy_ratio, 3),
            quantity(cycle.work, self.unit("J", "J/m")),
            quantity(cycle.amplitude, "m")
        );
        lines.add("sliding regime", text);
    }

    fn damage(&self, lines: &mut Lines) {
        if self.bonds > 0 {
            let known = &self.uncertainty.damage_ratio;
            let text = format!(
                "ratio {}{} ({} of {} bonds broken), mean damage {}",
                number(self.damage_ratio, 4),
                known.from_settings(|half| number(half, 2)),
                self.broken,
                self.bonds,
                number(self.mean_damage, 4)
            );
            lines.add("damage", text);
            lines.all(self.fracture.iter().flat_map(FractureSummary::lines));
        }
    }

    fn worn(&self, lines: &mut Lines) {
        let volume = self.unit("m3", "m3/m");
        let w = &self.wear;
        for body in &w.bodies {
            lines.add(&format!("wear of {}", body.body), of_body(body, volume));
        }
        for scar in self.scars.iter().filter(|s| s.volume > 0.0) {
            lines.add(&format!("scar of {}", scar.body), scar.outline());
        }
        if w.volume_third_body > 0.0 {
            lines.add("wear between grains", quantity(w.volume_third_body, volume));
        }
        let known = &self.uncertainty.wear;
        let settings = known.from_settings(|half| quantity(half, volume));
        if w.bodies.len() > 1 || !settings.is_empty() {
            let half = known
                .scatter
                .map_or(String::new(), |h| format!(" +- {}", quantity(h, volume)));
            let text = format!(
                "{}{half}{settings}",
                quantity(w.volume_first_bodies, volume)
            );
            lines.add("wear of first bodies", text);
        }
        if let Some(alpha) = self.fretting.as_ref().and_then(|f| f.alpha) {
            let half = alpha
                .half_width
                .map_or(String::new(), |h| format!(" +- {}", number(1e9 * h, 2)));
            let text = format!(
                "{}{half} mm3/J over all cycles (95 %, jackknife)",
                number(1e9 * alpha.value, 4)
            );
            lines.add("wear per energy", text);
        }
        lines.all(self.jump.iter().flat_map(jump::lines));
        let any = w.Qs > 0.0 || self.circuit.is_some();
        if any {
            let unit = self.unit("kg/s", "kg/(m s)");
            let flow = |q: f64| format!("{} {unit}", number(q, 3));
            let known = |q: Option<f64>| q.map_or("not measured".to_owned(), flow);
            let text = format!(
                "Qs {}, Qe {}, Qw {}; Qi {}",
                flow(w.Qs),
                known(w.Qe),
                known(w.Qw),
                flow(w.Qi)
            );
            lines.add("flows", text);
        }
        lines.all(self.circuit.iter().flat_map(|c| c.lines()));
    }

    /// Energy balance: external work + gravity + kinetic energy at the start = dissipated + stored.
    fn energies(&self, lines: &mut Lines) {
        let unit = self.unit("J", "J/m");
        let e = &self.energy;
        let largest = e.entries().into_iter().map(|(_, _, x)| x.abs());
        let largest = largest.fold(0.0, f64::max);
        let shown = |x: f64| x.is_nan() || x.abs() > NEGLIGIBLE * largest;
        let parts = [
            ("friction", e.friction),
            ("fracture", e.fracture),
            ("impact", e.impact),
            ("damping", e.viscous),
            ("adhesion", e.adhesion),
            ("time integration", e.scheme),
            ("position correction", e.correction),
            ("carried off", e.carried),
        ];
        let parts = parts.iter().filter(|(_, x)| shown(*x));
        let parts: Vec<String> = parts
            .map(|(name, x)| format!("{name} {}", quantity(*x, unit)))
            .collect();
        if !parts.is_empty() {
            lines.add("dissipated", parts.join(", "));
        }
        let mut stored = Vec::new();
        if shown(e.kinetic) || shown(e.initial_kinetic) {
            stored.push(format!(
                "kinetic energy {}, {} at the start",
                quantity(e.kinetic, unit),
                quantity(e.initial_kinetic, unit)
            ));
        }
        if shown(e.elastic) {
            stored.push(format!("elastic energy {}", quantity(e.elastic, unit)));
        }
        if !stored.is_empty() {
            lines.add("stored", stored.join("; "));
        }
        let gravity = match e.potential {
            x if !shown(x) => String::new(),
            x if x < 0.0 => format!("; gravity gave {}", quantity(-x, unit)),
            x => format!("; gravity took {}", quantity(x, unit)),
        };
        let expansion = match e.expansion {
            x if !shown(x) => String::new(),
            x => format!("; thermal expansion did {}", quantity(x, unit)),
        };
        let text = format!(
            "{}{gravity}{expansion}; the ledger closes to {} of the largest energy",
            quantity(e.external_work, unit),
            number(self.energy_residual_relative, 2)
        );
        lines.add("external work", text);
    }

    /// Further results of the case.
    fn others(&self, lines: &mut Lines, verbose: bool) {
        lines.all(self.biaxial.iter().flat_map(Outcome::lines));
        let worst = self.resolution.iter();
        let worst = worst.max_by(|a, b| a.heat_error.total_cmp(&b.heat_error));
        if let Some(contact) = worst {
            lines.add("elements across", contact.line());
        }
        for (name, text) in &self.findings {
            lines.add(name, text);
        }
        if self.measures.len() > MEASURES && !verbose {
            lines.add(
                "measures",
                format!(
                    "{} values: --verbose, or `measures` in summary.json",
                    self.measures.len()
                ),
            );
            return;
        }
        for (name, value) in &self.measures {
            let unit = self.measure_units.get(name).copied().unwrap_or_default();
            lines.add(name, quantity(*value, unit));
        }
    }
}

/// Volume, depths and specific wear rate.
fn of_body(w: &BodyWear, volume: &str) -> String {
    let mut text = quantity(w.volume, volume);
    if let (Some(mean), Some(most)) = (w.depth_mean, w.depth_max) {
        let _ = write!(
            text,
            ", {} deep on average where worn, {} at most",
            quantity(mean, "m"),
            quantity(most, "m")
        );
    }
    if let Some(k) = w.specific_rate {
        let _ = write!(text, "; k = V/(P s) = {}", wear_rate(k));
    }
    text
}

#[cfg(test)]
#[path = "text_tests.rs"]
mod tests;
