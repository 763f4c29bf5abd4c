//! What a run says of the settings that it chose.

use super::AccuracyControl;
use crate::error_estimate::Change;
use crate::observer::Observer;
use crate::statistics::Column;
use fretwork_core::geometry::space::Space;
use fretwork_core::step::Simulation;
use serde::{Deserialize, Serialize};

/// A change of step or tolerance.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SettingChange {
    /// When (s).
    pub time: f64,
    /// The step from then on (s).
    pub step: f64,
    /// The tolerance from then on.
    pub tolerance: f64,
    /// Relative change of the result with a smaller step, before; null where it was not known.
    pub step_effect: Option<Change>,
    /// The same with a smaller tolerance.
    pub tolerance_effect: Option<Change>,
}

/// Accuracy of a run that chose its settings.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct AccuracyReport {
    /// Share asked for.
    pub share: f64,
    /// The result.
    pub of: String,
    /// Coarsest, mean and smallest step (s).
    pub steps: [f64; 3],
    /// Coarsest and smallest tolerance.
    pub tolerances: [f64; 2],
    /// Stretches repeated, and those that failed.
    pub stretches: [u64; 2],
    /// Cost of repeated stretches over that of the run, in solver iterations times contacts.
    pub cost_share: f64,
    /// Changes of the settings.
    pub changes: Vec<SettingChange>,
    /// Requests of laws for a smaller step.
    pub requests: u64,
    /// Relative change of the result with a smaller step, with the last settings; null where it is not known.
    pub step_effect: Option<Change>,
    /// The same with a smaller tolerance.
    pub tolerance_effect: Option<Change>,
    /// Whether both effects, with their intervals, are known and together below the share.
    pub reached: bool,
}

impl AccuracyControl {
    /// What it has done, in `done` steps of the case.
    pub fn report(&self, done: u64) -> AccuracyReport {
        let [h, tolerance, _] = self.coarsest;
        let parts = (self.parts.max(1) as f64) / (done.max(1) as f64);
        let bound = |effect: Option<Change>| effect.map_or(f64::INFINITY, |e| e.bound());
        let bounds = bound(self.step.effect) + bound(self.tolerance.effect);
        AccuracyReport {
            share: self.share,
            of: self.of.name().to_owned(),
            steps: [h, h / parts.max(1.0), h / self.most_parts as f64],
            tolerances: [tolerance, self.smallest_tolerance],
            stretches: self.stretches,
            cost_share: if self.cost[0] > 0.0 {
                self.cost[1] / self.cost[0]
            } else {
                0.0
            },
            changes: self.changes.clone(),
            requests: self.requests,
            step_effect: self.step.effect,
            tolerance_effect: self.tolerance.effect,
            reached: bounds <= self.share,
        }
    }
}

impl AccuracyReport {
    /// One line for the terminal.
    pub fn line(&self) -> String {
        let effect = |what: &str, effect: &Option<Change>| {
            effect.map_or(format!("{what} not known"), |e| {
                format!(
                    "{what} {:+.1} +- {:.1} %",
                    100.0 * e.change,
                    100.0 * e.half_width
                )
            })
        };
        let asked = match self.requests {
            0 => String::new(),
            n => format!("; laws asked {n} times for a smaller step"),
        };
        format!(
            "{:.3} % of the {} asked; steps of {:.3e} to {:.3e} s, tolerance {:.2e} to {:.2e}, {} changes; finer settings would change it by: {}, {} \
             ({} stretches repeated, {:.0} % of the cost){asked}",
            100.0 * self.share,
            self.of,
            self.steps[0],
            self.steps[2],
            self.tolerances[0],
            self.tolerances[1],
            self.changes.len(),
            effect("step", &self.step_effect),
            effect("tolerance", &self.tolerance_effect),
            self.stretches[0],
            100.0 * self.cost_share,
        )
    }

    /// Why the accuracy is not reached, where it is not.
    pub fn shortfall(&self) -> Option<String> {
        if self.reached {
            return None;
        }
        Some(format!(
            "the {} is not shown to be right to {:.3} %: {}; a longer run, more effort (accuracy.effort), or finer bounds \
             (accuracy.finest_step, accuracy.finest_tolerance)",
            self.of,
            100.0 * self.share,
            self.line()
                .split("change it by: ")
                .nth(1)
                .unwrap_or_default()
        ))
    }
}

/// Observes the settings that a run has chosen.
#[derive(Clone, Copy, Debug)]
pub struct ChosenSettings;

impl<S: Space> Observer<S> for ChosenSettings {
    fn name(&self) -> String {
        "chosen settings".to_owned()
    }

    fn reads_statistics(&self) -> bool {
        false
    }

    fn columns(&self) -> Vec<Column> {
        vec![
            Column::new("step_length", "s", "length of the last part of the step"),
            Column::new("solver_tolerance", "", "tolerance of the solver"),
        ]
    }

    fn sample(&mut self, s: &Simulation<S>) -> Vec<f64> {
        vec![s.options.scheme.h, s.options.solver.tolerance]
    }
}
