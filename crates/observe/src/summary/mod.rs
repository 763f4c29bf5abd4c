//! `summary.json`, and the summary a tribologist reads at the end.

mod circuit;
mod details;
mod estimate;
mod text;

pub use self::circuit::{Base, CircuitSummary, Rates};
pub use self::estimate::{Estimate, Uncertainty};

use crate::biaxial::Outcome;
pub use crate::first_bodies::BodyWear;
use crate::fretting;
use crate::friction::Cycle;
use crate::jump::JumpSummary;
use crate::scars::ScarSummary;
use crate::scatter::Scatter;
pub use crate::solving::SolverSummary;
use fretwork_core::contact::StepSizeDiagnostics;
use fretwork_core::energy::Energy;
use fretwork_core::step::control::Begun;
use fretwork_scene::sampling::UnresolvedDrive;
use serde::Serialize;

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
    /// Whether it keeps its promises with the parameters of this run, see [`fretwork_core::certify`].
    pub certified: bool,
}

/// Flows of matter, as mean mass flows since the start of the friction test, or of the run without one.
#[derive(Clone, Debug, Default, Serialize)]
#[allow(non_snake_case)]
pub struct Wear {
    /// Unit of the flows: kg/s, in two dimensions kg/(m s), per metre of depth.
    pub unit: &'static str,
    /// Since when Qs of the wear law and Qi count (s); what a circuit counts begins with the circuit.
    pub start: f64,
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
    /// Normal force times sliding distance, the integral of P |ds| over the run (N m; N in 2D); null without a friction test.
    pub load_path: Option<f64>,
    /// The first bodies that lost something, each by itself.
    pub bodies: Vec<BodyWear>,
}

impl Wear {
    /// Unit of flows in so many dimensions.
    pub fn unit(dimension: usize) -> &'static str {
        if dimension == 2 { "kg/(m s)" } else { "kg/s" }
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
    /// Whether all checks passed; see `warnings` of the layer that stores it.
    pub trustworthy: bool,
    /// Why it is not trustworthy, in sentences, worst first.
    pub reasons: Vec<String>,
    /// The reasons, and after them what is worth knowing besides.
    pub warnings: Vec<String>,
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
    /// Largest |Q| over the mean P of the same cycle.
    pub peak_friction: Option<f64>,
    /// How the friction coefficient scatters over cycles or blocks, for its interval.
    #[serde(skip)]
    pub friction_scatter: Option<Scatter>,
    /// How well the main results are known from this run alone.
    pub uncertainty: Uncertainty,
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
    /// Their units; empty for a pure number.
    pub measure_units: std::collections::BTreeMap<String, &'static str>,
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
    /// What shows whether the step was small enough to see every contact in time.
    #[serde(rename = "haste")]
    pub step_size: StepSizeDiagnostics,
    /// Drives that the step does not resolve.
    #[serde(skip)]
    pub unresolved_drives: Vec<UnresolvedDrive>,
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
    /// Whether a signal stopped it: it goes on with `--resume`.
    pub interrupted: bool,
}

impl Summary {
    /// Puts in what follows from the other entries.
    pub fn complete(&mut self) {
        self.uncertainty = Uncertainty::new(self, self.friction_scatter.as_ref());
    }
}
