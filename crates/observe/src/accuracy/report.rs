//! Report of a run on the settings that it chose.

use super::AccuracyControl;
use crate::error_estimate::Change;
use crate::observer::Observer;
use crate::quantity::unit::{ONE, SECOND, WORD};
use crate::quantity::{Findings, Role, Topic, number, part, parts, quantity, values};
use crate::statistics::Column;
use crate::warning::Warning;
use fretwork_core::view::RunView;
use serde::{Deserialize, Serialize};

crate::described! {
    /// A change of step or tolerance.
    #[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
    pub struct SettingChange {
        /// Time of the change.
        pub time: f64 => SECOND,
        /// Time step after the change.
        pub step: f64 => SECOND,
        /// Tolerance after the change.
        pub tolerance: f64 => ONE,
        /// Relative change of the result with a smaller step, before; null where it was not known.
        pub step_effect: Option<Change> = part::<Change>(),
        /// Relative change of the result with a smaller tolerance; null where it is not known.
        pub tolerance_effect: Option<Change> = part::<Change>(),
    }
}

crate::described! {
    /// Accuracy of a run that chose its settings.
    #[derive(Clone, Debug, Default, PartialEq, Serialize)]
    pub struct AccuracyReport {
        /// Accuracy that the case asks for, as a share of the result.
        pub share: f64 => ONE,
        /// Name of the result whose accuracy the case asks for.
        pub of: String => WORD,
        /// Largest, mean and smallest step.
        pub steps: [f64; 3] = values(SECOND),
        /// Share of the time that was made in steps longer than that of the case.
        pub grown: f64 => ONE,
        /// Steps longer than that of the case that were made again as shorter ones, since something
        /// moved.
        pub repeated: u64 => ONE,
        /// Coarsest and smallest tolerance.
        pub tolerances: [f64; 2] = values(ONE),
        /// Stretches repeated, and those that failed.
        pub stretches: [u64; 2] = values(ONE),
        /// Cost of repeated stretches over that of the run, in solver iterations times contacts.
        pub cost_share: f64 => ONE,
        /// Changes of the settings.
        pub changes: Vec<SettingChange> = parts::<SettingChange>(),
        /// Requests of laws for a smaller step.
        pub requests: u64 => ONE,
        /// Relative change of the result with a smaller step, with the last settings; null where it
        /// is not known.
        pub step_effect: Option<Change> = part::<Change>(),
        /// Relative change of the result with a smaller tolerance; null where it is not known.
        pub tolerance_effect: Option<Change> = part::<Change>(),
        /// Whether both effects, with their intervals, were measured with the last settings and are
        /// together below the share.
        pub reached: bool => WORD,
    }
}

impl AccuracyControl {
    /// Returns the report after `done` steps of the case.
    pub fn report(&self, done: u64) -> AccuracyReport {
        let [h, tolerance, _] = self.coarsest;
        let parts = (self.parts.max(1) as f64) / (done.max(1) as f64);
        let bound = |effect: Option<Change>| effect.map_or(f64::INFINITY, |e| e.bound());
        let bounds = bound(self.step.shown()) + bound(self.tolerance.shown());
        AccuracyReport {
            share: self.share,
            of: self.of.name().to_owned(),
            steps: [
                h * f64::from(self.growth.longest),
                h / parts,
                h / self.most_parts as f64,
            ],
            grown: self.growth.spanned as f64 / done.max(1) as f64,
            repeated: self.growth.repeated,
            tolerances: [tolerance, self.smallest_tolerance],
            stretches: self.stretches,
            cost_share: if self.cost[0] > 0.0 {
                self.cost[1] / self.cost[0]
            } else {
                0.0
            },
            changes: self.changes.clone(),
            requests: self.requests,
            step_effect: self.step.shown(),
            tolerance_effect: self.tolerance.shown(),
            reached: bounds <= self.share,
        }
    }
}

/// Adds how a run chose its step and tolerance, where the case asks for an accuracy.
pub fn report(accuracy: Option<&AccuracyReport>, found: &mut Findings) {
    found.begin(Topic::Run, Role::Diagnostic);
    let doc = "how the run chose its step and tolerance; null where the case does not ask for an accuracy";
    found.parts::<AccuracyReport>("accuracy", &accuracy, doc);
    if let Some(accuracy) = accuracy {
        found.edit("accuracy.share", |q| {
            q.secondary("accuracy")
                .sentence("accuracy", accuracy.line());
        });
        let text = accuracy.shortfall();
        found.warn(text.map(|text| Warning::note("ACCURACY NOT SHOWN", text)));
    }
}

impl AccuracyReport {
    /// Returns the sentence for the terminal.
    fn line(&self) -> String {
        let range = |coarse: String, fine: String| match coarse == fine {
            true => coarse,
            false => format!("{coarse} to {fine}"),
        };
        let steps = [self.steps[0], self.steps[2]].map(|h| quantity(h, "s"));
        let tolerances = self.tolerances.map(|t| number(t, 3));
        let [coarse, fine] = steps;
        let steps = range(coarse, fine);
        let [coarse, fine] = tolerances;
        let changes = match self.changes.len() {
            1 => "1 change".to_owned(),
            n => format!("{n} changes"),
        };
        let asked = match self.requests {
            0 => String::new(),
            1 => ", 1 request of a law for a smaller step".to_owned(),
            n => format!(", {n} requests of laws for a smaller step"),
        };
        format!(
            "{} to {} %: steps of {steps}, tolerance {}, {changes}{asked}; {} ({} stretches repeated, {:.0} % of the cost)",
            self.of,
            number(100.0 * self.share, 3),
            range(coarse, fine),
            self.effects(),
            self.stretches[0],
            100.0 * self.cost_share,
        )
    }

    /// Returns the effects of finer settings as text.
    fn effects(&self) -> String {
        let effect = |effect: &Option<Change>| {
            effect.map_or("not known".to_owned(), |e| {
                let (change, half) = (100.0 * e.change, 100.0 * e.half_width);
                format!("{change:+.2} +- {half:.2} %")
            })
        };
        format!(
            "finer ones would change it by {} (step), {} (tolerance)",
            effect(&self.step_effect),
            effect(&self.tolerance_effect)
        )
    }

    /// Returns why the accuracy is not shown to be reached, where it is not.
    fn shortfall(&self) -> Option<String> {
        (!self.reached).then(|| {
            format!(
                "the {} is not shown to be right to {} %: {}; take a longer run, more effort (accuracy.effort), or finer bounds \
                 (accuracy.finest_step, accuracy.finest_tolerance)",
                self.of,
                number(100.0 * self.share, 3),
                self.effects()
            )
        })
    }
}

/// Observes the settings that a run has chosen.
#[derive(Clone, Copy, Debug)]
pub struct ChosenSettings;

impl Observer for ChosenSettings {
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

    fn sample(&mut self, run: &dyn RunView) -> Vec<f64> {
        vec![run.options().scheme.h, run.solver_in_force().tolerance]
    }
}
