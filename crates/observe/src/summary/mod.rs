//! `summary.json`, and the text summary at the end of a run.

mod circuit;
mod details;
mod estimate;
mod fracture;
mod text;
mod time_spent;

pub use self::circuit::{Base, CircuitSummary, Rates};
pub use self::estimate::{Estimate, Uncertainty};
pub use self::fracture::{BondEnergies, FractureSummary, Reference};
pub use self::time_spent::TimeSpent;

use crate::accuracy::AccuracyReport;
use crate::biaxial::Outcome;
use crate::deformable::{BorderLoad, SmallStrain};
use crate::error_estimate::Repeats;
pub use crate::first_bodies::BodyWear;
use crate::fretting;
use crate::friction::Cycle;
use crate::heat::HeatChecks;
use crate::jump::JumpSummary;
use crate::nearest_places::NearestPlaces;
use crate::resolution::Resolution;
use crate::scars::ScarSummary;
use crate::scatter::Scatter;
pub use crate::solving::SolverSummary;
use fretwork_core::contact::StepSizeDiagnostics;
use fretwork_core::energy::Energy;
use fretwork_core::step::ImpossibleMotions;
use fretwork_core::step::control::Begun;
use fretwork_scene::sampling::UnresolvedDrive;
use fretwork_scene::wear_coefficient::WearCoefficient;
use serde::Serialize;

/// A loaded plugin.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PluginStamp {
    /// Kind of the law.
    pub kind: String,
    /// Name.
    pub name: String,
    /// Its version.
    pub version: String,
    /// SHA-256 of the library.
    pub sha256: String,
    /// Path of the library.
    pub path: String,
    /// Libraries that it links to and that are not the system's: path and SHA-256.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub links: Vec<String>,
    /// Whether it passes certification with the parameters of this run, see [`fretwork_core::certify`].
    pub certified: bool,
}

/// Momentum of the free rigid bodies that nothing outside gave them.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct MomentumSummary {
    /// Linear (N s; N s/m).
    pub linear: f64,
    /// Angular (N m s; N s); zero in periodic scenes.
    pub angular: f64,
    /// Linear, over the largest sum of the bodies' |m v| so far.
    pub linear_relative: f64,
    /// Angular, over the largest sum of the bodies' |x × m v| + |I w| so far.
    pub angular_relative: f64,
}

/// Wear and mean mass flows since the start of the friction test, or of the run without one.
#[derive(Clone, Debug, Default, Serialize)]
#[allow(non_snake_case)]
pub struct Wear {
    /// Unit of the flows: kg/s; in 2D kg/(m s), per metre of depth.
    pub unit: &'static str,
    /// Start of Qs (of the wear law) and Qi (s); flows of a circuit start with the circuit.
    pub start: f64,
    /// Source: mass worn off first bodies by the wear law, or, with a circuit, mass of the grains that came
    /// loose from them.
    pub Qs: f64,
    /// Internal: mass of the third body that crosses a section, mean of |m v_x|/L.
    pub Qi: f64,
    /// Ejected: with a circuit the mass that reached its zones; without one zero in a contact that is
    /// periodic along the sliding, and null (not measured) in an open one.
    pub Qe: Option<f64>,
    /// Lost: ejected and not recirculated; as `Qe`.
    pub Qw: Option<f64>,
    /// Volume worn off first bodies by the wear law (m^3; m^3/m).
    pub volume_first_bodies: f64,
    /// Volume worn between grains (m^3; m^3/m).
    pub volume_third_body: f64,
    /// Normal force times sliding distance: the integral of P |ds| over the run (N m; N in 2D); null without
    /// a friction test.
    pub load_path: Option<f64>,
    /// Wear of the first bodies that lost material.
    pub bodies: Vec<BodyWear>,
}

impl Wear {
    /// Unit of flows in a dimension.
    pub fn unit(dimension: usize) -> &'static str {
        if dimension == 2 { "kg/(m s)" } else { "kg/s" }
    }
}

/// JSON pointers to the values that may differ between the summaries of two runs of a case: wall and
/// processor times, and the number of threads. All others are bit-identical, see `docs/checkpoints.md`.
pub const FROM_THE_CLOCK: [&str; 5] = [
    "/wall_seconds",
    "/cpu_seconds",
    "/time_spent",
    "/threads",
    "/circuit/cost_share",
];

/// Summary of a run.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Summary {
    /// Title of the case.
    pub case: String,
    /// Whether all checks passed; see `warnings` of the layer that stores it.
    pub trustworthy: bool,
    /// Reasons why it is not trustworthy, as sentences, worst first.
    pub reasons: Vec<String>,
    /// The reasons, followed by notes.
    pub warnings: Vec<String>,
    /// Identity of the run (case, materials, laws and scene), by which the results file recognises its
    /// summary.
    pub identity: String,
    /// Dimension, 2 or 3.
    pub dimension: usize,
    /// Steps done.
    pub steps: u64,
    /// Time reached (s).
    pub time: f64,
    /// Wall time of the run (s).
    pub wall_seconds: f64,
    /// Processor time of all threads (s), which depends little on other programs.
    pub cpu_seconds: f64,
    /// What the wall time was spent on.
    pub time_spent: TimeSpent,
    /// Number of bodies.
    pub bodies: usize,
    /// Number of contacts at the end.
    pub contacts: usize,
    /// Number of bonds made.
    pub bonds: u64,
    /// Number of bonds broken.
    pub broken: u64,
    /// Broken over made.
    pub damage_ratio: f64,
    /// Mean damage over all bonds.
    pub mean_damage: f64,
    /// Energy that broken bonds released, over what their laws declare; null without bonds.
    pub fracture: Option<FractureSummary>,
    /// Friction coefficient from forces, over the last complete cycle, or the second half; null without a
    /// friction test.
    pub friction_coefficient: Option<f64>,
    /// Friction coefficient from the energy ledger.
    pub friction_from_dissipation: Option<f64>,
    /// Largest |Q| over the mean P of the same cycle.
    pub peak_friction: Option<f64>,
    /// |Q|/P over the second half of the strokes of that cycle: friction without the elastic travel after a reversal.
    pub plateau_friction: Option<f64>,
    /// How the friction coefficient scatters over cycles or blocks, for its interval.
    #[serde(skip)]
    pub friction_scatter: Option<Scatter>,
    /// What repeated steps say of the error, and shares of the energy; in `uncertainty` too.
    #[serde(skip)]
    pub repeats: Repeats,
    /// How well the main results are known from this run alone.
    pub uncertainty: Uncertainty,
    /// How the run chose its step and tolerance; null where the case does not ask for an accuracy.
    pub accuracy: Option<AccuracyReport>,
    /// Cycles of the friction test.
    pub cycles: Vec<Cycle>,
    /// Evaluation of a fretting test; null without reciprocating motion.
    pub fretting: Option<fretting::Outcome>,
    /// Result of a biaxial test; null without one.
    pub biaxial: Option<Outcome>,
    /// Phases that were started, with their times; empty without phases.
    pub phases: Vec<Begun>,
    /// Names of the phases that the run did not reach.
    pub phases_missed: Vec<String>,
    /// Numeric results of the case's measures, by name (SI).
    pub measures: std::collections::BTreeMap<String, f64>,
    /// Their units; empty for a pure number.
    pub measure_units: std::collections::BTreeMap<String, &'static str>,
    /// Textual results of the case's measures, by name.
    pub findings: std::collections::BTreeMap<String, String>,
    /// Energy ledger (J; J/m).
    pub energy: Energy,
    /// Residual over the largest energy seen.
    pub energy_residual_relative: f64,
    /// Momentum of the free rigid bodies that nothing outside gave.
    pub momentum: MomentumSummary,
    /// Wear.
    pub wear: Wear,
    /// The tribological circuit; null without one.
    pub circuit: Option<CircuitSummary>,
    /// Jumps over cycles; null without.
    pub jump: Option<JumpSummary>,
    /// Scars of the surfaces that recede; empty without any.
    pub scars: Vec<ScarSummary>,
    /// Largest strain and rotation of deformable bodies in small strain; left out without any.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub small_strain: Vec<SmallStrain>,
    /// Loads on the border of half-spaces; left out without any.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub border_loads: Vec<BorderLoad>,
    /// Elements across the contacts of deformable bodies; left out without any.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub resolution: Vec<Resolution>,
    /// Contacts between deformable bodies that act on the nearest place; left out without any.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub nearest_places: Option<NearestPlaces>,
    /// Checks of heat; left out without heat.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub heat: Option<HeatChecks>,
    /// Diagnostics of whether the step was small enough to detect every contact in time.
    #[serde(rename = "haste")]
    pub step_size: StepSizeDiagnostics,
    /// Imposed motions that nothing could obey; left out without any.
    #[serde(skip_serializing_if = "ImpossibleMotions::is_empty")]
    pub impossible_motions: ImpossibleMotions,
    /// Interfaces whose transport law is not asked, in sentences.
    #[serde(skip)]
    pub without_heat: Vec<String>,
    /// Drives that the step does not resolve.
    #[serde(skip)]
    pub unresolved_drives: Vec<UnresolvedDrive>,
    /// The solver.
    pub solver: SolverSummary,
    /// Laws.
    pub plugins: Vec<PluginStamp>,
    /// Wear coefficients that follow from the hardness of materials; left out without any.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub wear_coefficients: Vec<WearCoefficient>,
    /// Threads.
    pub threads: usize,
    /// Seed.
    pub seed: u64,
    /// Version of the program.
    pub version: String,
    /// Reason why the run stopped before its end, if it did.
    pub stopped: Option<String>,
    /// Whether a signal stopped it; it can be resumed with `--resume`.
    pub interrupted: bool,
}

impl Summary {
    /// Puts in what follows from the other entries.
    pub fn complete(&mut self) {
        self.uncertainty = Uncertainty::new(self, self.friction_scatter.as_ref());
    }
}
