//! Cost of a setting from short probes, corrected by finished runs.

use super::combination::Combination;
use super::plan::Trade;
use super::varied::{ParameterEffect, Varied};
use crate::Error;
use crate::runs::launcher::WaitLimits;
use crate::runs::output::column;
use crate::runs::stored::{FinishedRun, Status};
use serde::{Deserialize, Serialize};
use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

/// Cost of a setting: own (h0/h) (tol0/tol)^power, times the factor of each other form of the case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CostLaw {
    /// Duration of the case's own setting (s).
    pub own: f64,
    /// Exponent of the cost in the inverse of the tolerance.
    pub power: f64,
    /// Ratio of the cost of a form of the case to that of its own: parameter, level, factor.
    #[serde(default)]
    pub forms: Vec<(usize, usize, f64)>,
    /// Whether every probe measured a row of statistics or a whole run; otherwise the law is
    /// uncertain, and not stored.
    pub measured: bool,
}

impl Default for CostLaw {
    fn default() -> Self {
        Self {
            own: 1.0,
            power: 0.0,
            forms: Vec::new(),
            measured: false,
        }
    }
}

impl Trade {
    /// Runs the case's own setting, its other forms and the finest setting for a short time each. A
    /// run that ends within that time counts as done.
    ///
    /// # Errors
    /// A run cannot be started.
    pub(super) fn probe(&mut self, stop: &AtomicBool) -> Result<(), Error> {
        let each = self.budget.mul_f64(0.03);
        let each = each.clamp(Duration::from_millis(300), Duration::from_secs(20));
        let mut measured = true;
        let parameters = self.parameters.clone();
        let mut seconds = |setting: &Combination| -> Result<f64, Error> {
            let (guess, known) = self.probe_setting(setting, each, stop)?;
            measured &= known;
            Ok(guess)
        };
        let own = Combination::own(&parameters);
        let finest = Combination::reference(&parameters);
        let base = seconds(&own)?;
        let mut forms = Vec::new();
        for (k, parameter) in parameters.iter().enumerate() {
            let others = (0..parameter.levels.len()).filter(|l| *l != parameter.own);
            for level in others.filter(|_| parameter.effect == ParameterEffect::Form) {
                forms.push((k, level, seconds(&own.with(k, level))? / base.max(1e-3)));
            }
        }
        let fine = shrink(&finest, &parameters, ParameterEffect::Tolerance);
        let power = if fine < 1.0 && own != finest {
            let other = factor(&forms, &finest);
            let ratio = seconds(&finest)? / base
                * shrink(&finest, &parameters, ParameterEffect::Step)
                / other;
            (ratio.ln() / (1.0 / fine).ln()).clamp(0.0, 1.0)
        } else {
            0.0
        };
        self.cost = CostLaw {
            own: base,
            power,
            forms,
            measured,
        };
        Ok(())
    }

    /// Returns the duration of a setting (s), and whether it was measured.
    fn probe_setting(
        &mut self,
        setting: &Combination,
        each: Duration,
        stop: &AtomicBool,
    ) -> Result<(f64, bool), Error> {
        let run = self.run_of(setting, self.seeds[0]);
        if let Some(run) = self.launcher.stored(&run) {
            return Ok((run.wall, true));
        }
        let all = self.steps / shrink(setting, &self.parameters, ParameterEffect::Step);
        let table = self.launcher.place(&run).join("statistics.csv");
        let mut guess = f64::INFINITY;
        // Rows are written in batches: without one, the probe is repeated once with more time.
        for longer in [1, 3] {
            let started = Instant::now();
            let wait = WaitLimits {
                deadline: Some(started + longer * each),
                limit: None,
                stop,
            };
            let ended = self.launcher.run(&run, wait)?;
            let ended_at = std::time::SystemTime::now();
            if let Some(finished) = ended {
                let wall = finished.wall;
                self.done.insert((setting.clone(), run.seed), finished);
                return Ok((wall, true));
            }
            // Steps are timed from the creation of the table; the time before it is constant.
            let begun = std::fs::metadata(&table).and_then(|m| m.created()).ok();
            let stepping = begun.and_then(|t| ended_at.duration_since(t).ok());
            let stepping = stepping.unwrap_or_else(|| started.elapsed()).as_secs_f64();
            let last = column(&table, "step").and_then(|r| r.last().copied());
            guess = stepping * all / last.unwrap_or(1.0).max(1.0);
            if last.is_some() {
                return Ok((guess, true));
            }
        }
        Ok((guess, false))
    }

    /// Returns the duration of a run (s): that of its other seeds, or the cost law, multiplied by
    /// its mean error so far.
    pub fn seconds(&self, setting: &Combination) -> f64 {
        let ended = |r: &&FinishedRun| r.status == Status::Done;
        let of = |setting: &Combination| -> Vec<f64> {
            let own = self.done.iter().filter(|((s, _), _)| s == setting);
            own.map(|(_, r)| r).filter(ended).map(|r| r.wall).collect()
        };
        let same = of(setting);
        if !same.is_empty() {
            return same.iter().sum::<f64>() / same.len() as f64;
        }
        // The correction uses the case's own setting if it ran, otherwise all settings that ran.
        let own = Combination::own(&self.parameters);
        let ratios = |only: bool| -> Vec<f64> {
            self.done
                .iter()
                .filter(|((s, _), r)| ended(r) && (!only || *s == own))
                .map(|((s, _), r)| (r.wall / self.cost_law(s)).ln())
                .collect()
        };
        let known = [ratios(true), ratios(false)]
            .into_iter()
            .find(|r| !r.is_empty());
        let off = known.map_or(0.0, |r| r.iter().sum::<f64>() / r.len() as f64);
        self.cost_law(setting) * off.exp()
    }

    /// Returns the duration according to the probes alone (s).
    pub fn cost_law(&self, setting: &Combination) -> f64 {
        let step = shrink(setting, &self.parameters, ParameterEffect::Step);
        let tolerance = shrink(setting, &self.parameters, ParameterEffect::Tolerance);
        let law = &self.cost;
        law.own.max(1e-3) / step * tolerance.powf(-law.power) * factor(&law.forms, setting)
    }
}

/// Returns the product of the cost factors of a setting's forms.
fn factor(forms: &[(usize, usize, f64)], setting: &Combination) -> f64 {
    let here = forms
        .iter()
        .filter(|(k, level, _)| setting.0.get(*k) == Some(level));
    here.map(|(_, _, factor)| factor).product()
}

/// Returns the ratio of the case's own step or tolerance to that of the setting; 1 if it is not
/// varied.
fn shrink(setting: &Combination, parameters: &[Varied], effect: ParameterEffect) -> f64 {
    let of = |(k, level): (&Varied, &usize)| {
        let number = |l: usize| k.levels.get(l).and_then(|l| l.number);
        Some(number(*level)? / number(k.own)?)
    };
    let mut all = parameters
        .iter()
        .zip(&setting.0)
        .filter(|(k, _)| k.effect == effect);
    all.find_map(of).unwrap_or(1.0)
}
