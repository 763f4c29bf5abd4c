//! Solver statistics of a run.

use super::choice::SolverStats;
use super::quantity::unit::{ENERGY, ONE, WORD};
use super::quantity::{Findings, Role, Topic, part};
use fretwork_core::solve::error::ErrorParts;
use fretwork_core::step::Agreement;
use serde::{Deserialize, Serialize};

/// Adds the numbers of steps that were and were not written as FCLIB problems.
pub fn report_problems(written: u64, skipped: u64, found: &mut Findings) {
    found.begin(Topic::Run, Role::Diagnostic);
    let doc = "steps written as FCLIB problems";
    let problems = found.add("solver.fclib_written", written, ONE, doc);
    if written + skipped > 0 {
        let skipped = match skipped {
            0 => String::new(),
            n => format!(
                "; {n} not, since they have bonds, cohesion or friction against rotation, which FCLIB cannot represent"
            ),
        };
        problems.sentence(
            "problems",
            format!("{written} steps written in fclib/{skipped}"),
        );
    }
    let doc = "steps that FCLIB cannot represent";
    found.add("solver.fclib_skipped", skipped, ONE, doc);
}

crate::described! {
    /// Parts of the error over the steps of a run, each weighted by the heat of slip of its step:
    /// what matters for friction.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct ErrorPartsOfRun {
        /// Mean unbalanced share of the work of a step.
        pub force_balance: f64 => ONE,
        /// Mean of the residual velocities over the relative velocities of the contacts.
        pub velocity: f64 => ONE,
        /// Mean energy that residuals make in violation of the contact law, over the heat of slip
        /// (the error of the norm `Power`).
        pub contact_law: f64 => ONE,
        /// Heat of slip of all steps.
        pub slip_energy: f64 => ENERGY,
    }
}

impl ErrorPartsOfRun {
    /// Adds a step.
    pub fn add(&mut self, step: &ErrorParts) {
        if step.slip_energy <= 0.0 || !step.contact_law.is_finite() {
            return;
        }
        self.slip_energy += step.slip_energy;
        let share = step.slip_energy / self.slip_energy;
        self.force_balance += share * (step.force_balance - self.force_balance);
        self.velocity += share * (step.velocity - self.velocity);
        self.contact_law += share * (step.contact_law - self.contact_law);
    }
}

crate::described! {
    /// How friction that depends on the velocity of sliding, and attraction that depends on the
    /// gap, agree with the steps of a run, each of which is solved until they do.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct LawsOfRun {
        /// Mean number of solves per step; 1 where no law asks for more.
        pub solves_mean: f64 => ONE,
        /// Mean over the steps of the share of the friction by which it differs from that of the
        /// laws at the velocities reached.
        pub friction_mean: f64 => ONE,
        /// Largest share of a step's attractions and loads by which attractions differ from those
        /// over the gaps passed.
        pub attraction_max: f64 => ONE,
        /// Number of steps over which these numbers are taken.
        pub steps: u64 => ONE,
    }
}

impl LawsOfRun {
    /// Adds a step.
    pub fn add(&mut self, step: &Agreement) {
        self.steps += 1;
        let share = 1.0 / self.steps as f64;
        self.solves_mean += share * (f64::from(step.solves) - self.solves_mean);
        self.friction_mean += share * (step.friction - self.friction_mean);
        self.attraction_max = self.attraction_max.max(step.attraction);
    }
}

crate::described! {
    /// Solver statistics over the steps of a run.
    #[derive(Clone, Debug, Default, Serialize, Deserialize)]
    pub struct SolverSummary {
        /// Mean number of iterations per step.
        pub iterations_mean: f64 => ONE,
        /// Largest number of iterations in a step.
        pub iterations_max: u32 => ONE,
        /// Largest error at the end of a step.
        pub error_max: f64 => ONE,
        /// What the solutions got wrong, in parts.
        pub error_parts: ErrorPartsOfRun = part::<ErrorPartsOfRun>(),
        /// Steps that did not reach the tolerance.
        pub unconverged_steps: u64 => ONE,
        /// Steps of which another solution was found, of more energy than the one that was taken,
        /// in which a loaded contact slides that holds in the other.
        pub several_steps: u64 => ONE,
        /// Steps in which a loaded contact began to slide in a hyperstatic set too large to seek
        /// another solution.
        #[serde(default)]
        pub not_searched_steps: u64 => ONE,
        /// Steps among `not_searched_steps` in which that contact was one of a grain that first
        /// bodies squeeze.
        #[serde(default)]
        pub pinched_steps: u64 => ONE,
        /// Steps in which damage and opening did not reach the coupling's tolerance.
        pub uncoupled_steps: u64 => ONE,
        /// Mean number of solves per step with implicit coupling; 0 for explicit coupling.
        pub coupling_iterations_mean: f64 => ONE,
        /// What the laws at the velocities and gaps reached in the steps differ from what the steps
        /// used.
        pub laws: LawsOfRun = part::<LawsOfRun>(),
        /// First unconverged step; 0 if there is none.
        pub first_unconverged: u64 => ONE,
        /// Steps in which penetrations were removed by projection.
        pub projected_steps: u64 => ONE,
        /// Largest penetration before a projection, as a fraction of the smaller body's length.
        pub overlap_before: f64 => ONE,
        /// Largest penetration after a projection, as a fraction of the smaller body's length.
        pub overlap_after: f64 => ONE,
        /// Deepest overlap of rigid contacts at a detection, over the radius of the smaller grain.
        pub overlap_max: f64 => ONE,
        /// Tolerance of the error at the end of a step.
        pub tolerance: f64 => ONE,
        /// Formula of the error.
        pub error_formula: String => WORD,
        /// Requested solver.
        pub method: String => WORD,
        /// Number of steps by the solver that converged.
        pub steps_by_method: std::collections::BTreeMap<String, u64> => ONE,
        /// Reason for the choice, as a sentence.
        pub why: String => WORD,
        /// Statistics of the solvers that `auto` chose.
        pub choice: SolverStats = part::<SolverStats>(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_are_weighted_by_the_heat_of_slip() {
        let mut run = ErrorPartsOfRun::default();
        let step = |velocity, slip_energy| ErrorParts {
            force_balance: 2.0 * velocity,
            velocity,
            contact_law: 3.0 * velocity,
            slip_energy,
            ..ErrorParts::default()
        };
        // A step at rest says nothing.
        run.add(&step(7.0, 0.0));
        run.add(&step(0.1, 1.0));
        run.add(&step(0.5, 3.0));
        assert!((run.velocity - 0.4).abs() < 1e-15 && run.slip_energy == 4.0);
        assert!((run.force_balance - 0.8).abs() < 1e-15 && (run.contact_law - 1.2).abs() < 1e-15);
    }
}
