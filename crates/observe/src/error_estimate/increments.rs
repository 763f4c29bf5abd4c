//! Growth of the results of a run over a few steps.

use fretwork_core::process::sliding::SlidingBody;
use fretwork_core::step::{StepError, StepReport};
use fretwork_core::view::{RunControl, RunView};
use serde::{Deserialize, Serialize};

/// Growth of the results over a stretch of steps (per metre of depth in 2D).
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Increments {
    /// Work of the tangential force that moves the rubbed body (J).
    pub work: f64,
    /// Normal force on that body times its sliding distance (N m).
    pub load_path: f64,
    /// Energy dissipated by friction (J).
    pub friction_energy: f64,
    /// Sum of the damage of all bonds.
    pub damage: f64,
    /// Volume worn off first bodies (m^3).
    pub wear: f64,
}

/// A stretch of steps.
#[derive(Clone, Copy, Debug, Default)]
pub struct Stretch {
    /// Growth of the results.
    pub increments: Increments,
    /// Cost, see [`cost`].
    pub cost: f64,
    /// Largest number of solver iterations of a step.
    pub iterations: u32,
    /// Whether all steps reached the tolerance.
    pub converged: bool,
}

/// Cost of a step without its iterations, in iterations: detection, laws and motion take about as
/// long as this number of sweeps of contacts with three laws each.
const FIXED_ITERATIONS: f64 = 60.0;

/// Returns the cost of a step in iterations times contacts, which is the same on every machine.
pub fn cost(run: &dyn RunView, report: &StepReport) -> f64 {
    let iterations = f64::from(report.solver.iterations) + FIXED_ITERATIONS;
    iterations * run.counted_contacts().max(1) as f64
}

/// Returns the sum of the damage of all bonds; broken bonds count 1.
fn damage(run: &dyn RunView) -> f64 {
    run.mean_damage() * run.bonds_made() as f64
}

impl Stretch {
    /// Makes `length` steps of a run, each in `parts`, and measures those after the first half: by
    /// then effects of the change of settings have mostly decayed, such as damage that lags by a
    /// step with explicit coupling.
    ///
    /// # Errors
    /// A step failed.
    pub fn of(
        run: &mut dyn RunControl,
        [length, parts]: [u32; 2],
        body: Option<&SlidingBody>,
    ) -> Result<Self, StepError> {
        let (mut friction, mut bonds) = (run.energies().friction, damage(run));
        let mut force = body.map_or(0.0, |body| run.rubbing(body).0.force);
        let mut stretch = Self {
            converged: true,
            ..Self::default()
        };
        let sums = &mut stretch.increments;
        let steps = parts * length;
        for k in 0..steps {
            // The measured time is the same for any number of parts.
            if k == parts * (length / 2) {
                *sums = Increments::default();
                (friction, bonds) = (run.energies().friction, damage(run));
            }
            let report = run.step()?;
            stretch.cost += cost(run, &report);
            stretch.converged &= report.solver.converged;
            stretch.iterations = stretch.iterations.max(report.solver.iterations);
            sums.wear += report.totals.worn_first;
            if let Some(body) = body {
                let (drive, normal_force) = run.rubbing(body);
                sums.work += drive.work(force);
                force = drive.force;
                sums.load_path += normal_force * drive.slide.abs();
            }
        }
        sums.friction_energy = run.energies().friction - friction;
        sums.damage = damage(run) - bonds;
        Ok(stretch)
    }
}
