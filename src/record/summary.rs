//! `summary.json`, and the summary a tribologist reads at the end.

use super::biaxial::Outcome;
use super::fretting;
use super::friction::Cycle;
use super::jump::JumpSummary;
use super::ledger::Energy;
use super::scars::ScarSummary;
pub use super::solving::SolverSummary;
use super::steady::Flow;
use super::warnings::Warning;
use crate::contact::Haste;
use crate::step::control::Begun;
use crate::wear::ledger::{Contents, Flows};
use serde::Serialize;
use std::fmt::Write as _;

/// A plugin that was loaded.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PluginStamp {
    /// Slot.
    pub kind: String,
    /// Name.
    pub name: String,
    /// Its version.
    pub version: String,
    /// SHA-256 of the library.
    pub sha256: String,
    /// Where it was found.
    pub path: String,
    /// Whether it keeps its promises with the parameters of this run, see [`crate::certify`].
    pub certified: bool,
}

/// Flows of matter, as mean mass flows over the run (kg/s; kg/(m s) in 2D).
#[derive(Clone, Debug, Default, Serialize)]
#[allow(non_snake_case)]
pub struct Wear {
    /// Source: mass worn off first bodies by the wear law, and with a circuit the grains that came loose from them.
    pub Qs: f64,
    /// Internal: mass of the third body that crosses a section, mean of |m v_x|/L.
    pub Qi: f64,
    /// Ejected: with a circuit what reached its zones; without one zero in a contact that is periodic along the sliding, and
    /// not measured (null) in an open one.
    pub Qe: Option<f64>,
    /// Lost: ejected and not recirculated; as `Qe`.
    pub Qw: Option<f64>,
    /// Volume worn off first bodies by the wear law (m^3; m^3/m).
    pub volume_first_bodies: f64,
    /// Volume worn between grains (m^3; m^3/m).
    pub volume_third_body: f64,
}

/// Mean flows over the second half of the account, with their intervals (kg/s; kg/(m s) in 2D); null where it was brought up
/// to date too seldom.
#[derive(Clone, Copy, Debug, Default, Serialize)]
#[allow(non_snake_case)]
pub struct Rates {
    /// Source.
    pub Qs: Option<Flow>,
    /// What bonds tied again.
    pub Qa: Option<Flow>,
    /// Ejected.
    pub Qe: Option<Flow>,
    /// Recirculated.
    pub Qr: Option<Flow>,
    /// Wear.
    pub Qw: Option<Flow>,
    /// Qs - Qa - Qw, block by block: within its interval of zero in steady sliding.
    pub Qs_less_Qw: Option<Flow>,
    /// Growth of the mass in the contact.
    pub M: Option<Flow>,
}

/// A first body that grains can belong to.
#[derive(Clone, Debug, Serialize)]
pub struct Base {
    /// Its name.
    pub name: String,
    /// Grains tied to it at the end.
    pub grains: usize,
}

/// The tribological circuit; see [`crate::wear::ledger`].
#[derive(Clone, Debug, Serialize)]
pub struct CircuitSummary {
    /// When the account began (s).
    pub start: f64,
    /// Window of the rates (s).
    pub window: [f64; 2],
    /// What there is at the end.
    pub contents: Contents,
    /// What passed since the start.
    pub flows: Flows,
    /// What does not add up.
    pub residual: Contents,
    /// Mean flows.
    pub rates: Rates,
    /// First bodies.
    pub bases: Vec<Base>,
    /// Pieces that came loose.
    pub pieces: u64,
    /// Grains of the largest.
    pub largest_piece: usize,
    /// Share of the run's wall time that the account took.
    pub cost_share: f64,
}

impl CircuitSummary {
    /// Lines for a terminal.
    fn lines(&self) -> Vec<(&'static str, String)> {
        let (c, f, r) = (&self.contents, &self.flows, &self.rates);
        let tied: Vec<String> = self
            .bases
            .iter()
            .map(|b| format!("{} to {}", b.grains, b.name))
            .collect();
        let flow = |q: &Option<Flow>| {
            q.map_or("not known".to_owned(), |q| {
                format!("{:.2e} +- {:.1e}", q.mean, q.half_width)
            })
        };
        let steady = |q: &Option<Flow>| match q {
            Some(q) if q.steady => "no trend",
            Some(_) => "TREND",
            None => "too few updates",
        };
        let equal = match (&r.Qs, &r.Qw, &r.Qs_less_Qw) {
            (Some(s), Some(w), Some(d)) if d.may_be_zero() => {
                if d.half_width < s.mean.max(w.mean) {
                    "equal within the interval"
                } else {
                    "no verdict: the interval of their difference is wider than they are"
                }
            }
            (Some(_), Some(_), Some(_)) => "they differ",
            _ => "no verdict",
        };
        vec![
            (
                "grains",
                format!(
                    "tied {}, {} in the contact, {} ejected, {} lost",
                    tied.join(", "),
                    c.contact.grains,
                    c.ejected.grains,
                    c.lost.grains
                ),
            ),
            (
                "passed",
                format!(
                    "{} came loose in {} pieces (largest {}), {} tied again, {} ejected, {} came back, {} lost",
                    f.source.grains,
                    self.pieces,
                    self.largest_piece,
                    f.attached.grains,
                    f.ejected.grains,
                    f.recirculated.grains,
                    f.wear.grains
                ),
            ),
            (
                "flows, second half",
                format!(
                    "Qs {} ({}), Qw {} ({}), {equal}; Qe {}, Qr {}, Qa {} kg/s",
                    flow(&r.Qs),
                    steady(&r.Qs),
                    flow(&r.Qw),
                    steady(&r.Qw),
                    flow(&r.Qe),
                    flow(&r.Qr),
                    flow(&r.Qa)
                ),
            ),
        ]
    }
}

/// What may differ between the summaries of two runs of one case, as JSON pointers: what the clock gives, and the number
/// of threads, which is the command line's. All else has the same bits; `docs/checkpoints.md` says so.
pub const FROM_THE_CLOCK: [&str; 4] = [
    "/wall_seconds",
    "/cpu_seconds",
    "/threads",
    "/circuit/cost_share",
];

/// The whole run.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Summary {
    /// Title of the case.
    pub case: String,
    /// Name of what the run is of, case, materials, laws and scene: the results file knows its summary by it.
    pub identity: String,
    /// 2 or 3.
    pub dimension: usize,
    /// Steps done.
    pub steps: u64,
    /// Time reached (s).
    pub time: f64,
    /// Time it took (s).
    pub wall_seconds: f64,
    /// Processor time of it, of all threads (s): what other programs on the machine do not change much.
    pub cpu_seconds: f64,
    /// Bodies.
    pub bodies: usize,
    /// Contacts at the end.
    pub contacts: usize,
    /// Bonds made.
    pub bonds: u64,
    /// Bonds broken.
    pub broken: u64,
    /// Broken over made.
    pub damage_ratio: f64,
    /// Mean damage over all bonds.
    pub mean_damage: f64,
    /// From forces, over the last complete cycle, or the second half; null without a friction test.
    pub friction_coefficient: Option<f64>,
    /// The same from the energy ledger.
    pub friction_from_dissipation: Option<f64>,
    /// Cycle by cycle.
    pub cycles: Vec<Cycle>,
    /// What the cycles of a fretting test say together; null where nothing moves to and fro.
    pub fretting: Option<fretting::Outcome>,
    /// What a biaxial test found; null without one.
    pub biaxial: Option<Outcome>,
    /// Phases that began, with their times; empty without phases.
    pub phases: Vec<Begun>,
    /// Names of the phases that the run did not reach.
    pub phases_missed: Vec<String>,
    /// What the case's measures found, by name (SI).
    pub measures: std::collections::BTreeMap<String, f64>,
    /// What they found in words, by name.
    pub findings: std::collections::BTreeMap<String, String>,
    /// Energy ledger (J; J/m).
    pub energy: Energy,
    /// Residual over the largest energy seen.
    pub energy_residual_relative: f64,
    /// Wear.
    pub wear: Wear,
    /// The tribological circuit; null without one.
    pub circuit: Option<CircuitSummary>,
    /// Jumps over cycles; null without.
    pub jump: Option<JumpSummary>,
    /// Scars of the surfaces that follow their wear; empty without.
    pub scars: Vec<ScarSummary>,
    /// What went wrong without ending the run, each with what to change; empty where nothing did.
    pub warnings: Vec<Warning>,
    /// What was too fast for the step.
    pub haste: Haste,
    /// The solver.
    pub solver: SolverSummary,
    /// Laws.
    pub plugins: Vec<PluginStamp>,
    /// Threads.
    pub threads: usize,
    /// Seed.
    pub seed: u64,
    /// Version of the program.
    pub version: String,
    /// Why the run stopped before its end, if it did.
    pub stopped: Option<String>,
}

/// A flow, or that it was not measured.
fn flow(value: Option<f64>) -> String {
    value.map_or("not measured".to_owned(), |v| format!("{v:.3e}"))
}

impl Summary {
    /// Some lines for a terminal.
    pub fn text(&self) -> String {
        let mut out = String::new();
        let (joule, newton, volume) = if self.dimension == 3 {
            ("J", "N", "m3")
        } else {
            ("J/m", "N/m", "m3/m")
        };
        let mut line = |label: &str, value: String| {
            let _ = writeln!(out, "  {label:<22} {value}");
        };
        let rate = self.steps as f64 / self.wall_seconds.max(1e-9);
        line(
            "steps",
            format!(
                "{} to t = {:.4e} s in {:.1} s ({rate:.0} a second)",
                self.steps, self.time, self.wall_seconds
            ),
        );
        line(
            "contacts",
            format!("{} between {} bodies", self.contacts, self.bodies),
        );
        if self.bonds > 0 {
            line(
                "bonds",
                format!(
                    "{} of {} broken, damage ratio {:.4}, mean damage {:.4}",
                    self.broken, self.bonds, self.damage_ratio, self.mean_damage
                ),
            );
        }
        if let (Some(mu), Some(heat)) = (self.friction_coefficient, self.friction_from_dissipation)
        {
            line(
                "friction coefficient",
                format!("{mu:.4} from forces, {heat:.4} from dissipation"),
            );
        }
        for c in &self.cycles {
            let unfinished = if c.complete { "" } else { " (unfinished)" };
            line(
                &format!("cycle {}{unfinished}", c.cycle),
                format!(
                    "mu {:.4}, E_d {:.4e} {joule}, mean P {:.4e} {newton}, E_d/(4 Q delta) {:.3}, {} bonds broken",
                    c.friction_coefficient, c.work, c.normal_force, c.energy_ratio, c.broken
                ),
            );
        }
        if let Some(f) = &self.fretting {
            let slope = f.alpha.map_or(String::new(), |a| {
                let width = a
                    .half_width
                    .map_or(String::new(), |w| format!(" +- {w:.1e}"));
                format!(", {:.3e}{width} m3 worn a J", a.value)
            });
            let text = format!(
                "{}, {:.4e} {joule} in all{slope}",
                f.regime.name(),
                f.energy
            );
            line("regime", text);
        }
        for (label, text) in self.jump.iter().flat_map(JumpSummary::lines) {
            line(label, text);
        }
        for (label, text) in self.biaxial.iter().flat_map(Outcome::lines) {
            line(label, text);
        }
        for (k, p) in self.phases.iter().enumerate() {
            let same = || self.phases.iter().filter(|q| q.name == p.name);
            let (count, last) = (same().count(), same().next_back());
            if self.phases[..k].iter().any(|q| q.name == p.name) {
                continue;
            }
            if let (true, Some(last)) = (count > 1, last) {
                let end = last
                    .end
                    .map_or_else(|| "the end of the run".to_owned(), |t| format!("{t:.4e} s"));
                let text = format!("{count} times, from {:.4e} s to {end}", p.start);
                line(&format!("phase {}", p.name), text);
                continue;
            }
            let text = match (p.end, p.ended_by) {
                (Some(end), Some(why)) => {
                    format!("from {:.4e} to {end:.4e} s, ended by {why}", p.start)
                }
                _ => format!("from {:.4e} s to the end of the run", p.start),
            };
            line(&format!("phase {}", p.name), text);
        }
        if !self.phases_missed.is_empty() {
            line(
                "NOT REACHED",
                format!(
                    "the run ended before the phases {}; let it run longer (time.end)",
                    self.phases_missed.join(", ")
                ),
            );
        }
        for (name, value) in &self.measures {
            line(name, format!("{value:.5e}"));
        }
        for (name, text) in &self.findings {
            line(name, text.clone());
        }
        let e = &self.energy;
        let carried = match e.carried {
            0.0 => String::new(),
            x => format!(", carried off by what was taken out {x:.4e}"),
        };
        line(
            "dissipated",
            format!(
                "friction {:.4e}, fracture {:.4e}, impact {:.4e}, viscous {:.4e}, position correction {:.4e}{carried} {joule}",
                e.friction,
                e.fracture,
                e.impact,
                e.viscous + e.adhesion + e.scheme,
                e.correction
            ),
        );
        line(
            "energy residual",
            format!(
                "{:.3e} {joule}, {:.2e} of the largest energy",
                e.residual, self.energy_residual_relative
            ),
        );
        let w = &self.wear;
        line(
            "wear",
            format!(
                "{:.4e} {volume} off first bodies, {:.4e} {volume} between grains; Qs {:.3e}, Qi {:.3e}, Qe {}, Qw {} kg/s",
                w.volume_first_bodies,
                w.volume_third_body,
                w.Qs,
                w.Qi,
                flow(w.Qe),
                flow(w.Qw)
            ),
        );
        for (label, text) in self.circuit.iter().flat_map(CircuitSummary::lines) {
            line(label, text);
        }
        for scar in &self.scars {
            let (label, text) = scar.line(volume);
            line(&label, text);
        }
        let s = &self.solver;
        line(
            "solver",
            format!(
                "{:.1} iterations a step, {} at most; error at most {:.2e} (tolerance {:.0e})",
                s.iterations_mean, s.iterations_max, s.error_max, s.tolerance
            ),
        );
        let used: Vec<String> = s
            .steps_by_method
            .iter()
            .map(|(name, steps)| format!("{name} ended {steps} steps"))
            .collect();
        line("method", format!("{}: {}", s.method, used.join(", ")));
        if s.projected_steps > 0 {
            line(
                "projection",
                format!(
                    "{} steps took overlaps out: up to {:.2e} of a radius before, {:.2e} after",
                    s.projected_steps, s.overlap_before, s.overlap_after
                ),
            );
        }
        if s.method == "auto" {
            line("why", s.why.clone());
        }
        if s.fclib_written + s.fclib_skipped > 0 {
            let skipped = match s.fclib_skipped {
                0 => String::new(),
                n => format!(
                    "; {n} not, they hold bonds, cohesion or friction against rotation, which FCLIB does not"
                ),
            };
            line(
                "problems",
                format!("{} steps written in fclib/{skipped}", s.fclib_written),
            );
        }
        if s.coupling_iterations_mean > 0.0 {
            line(
                "coupling",
                format!(
                    "{:.1} solves a step, damage and opening together",
                    s.coupling_iterations_mean
                ),
            );
        }
        for warning in &self.warnings {
            line(warning.of, warning.text.clone());
        }
        for p in &self.plugins {
            line(
                "law",
                format!(
                    "{} {} {} ({}){}",
                    p.kind,
                    p.name,
                    p.version,
                    &p.sha256[..12.min(p.sha256.len())],
                    if p.certified {
                        ""
                    } else {
                        ", NOT certified with these parameters: fretwork law certify says why"
                    }
                ),
            );
        }
        if let Some(why) = &self.stopped {
            line("STOPPED", why.clone());
        }
        out
    }
}
