//! Cost forecast of a setting from short probes, corrected by finished runs.

use super::parameters::{Sense, StudyParameter};
use super::setting::Setting;
use super::{TradeError, study::Ledger};
use crate::runs::launcher::{Ended, Launcher};
use crate::runs::quantity::column;
use crate::runs::stored::{Finished, Status};
use serde::{Deserialize, Serialize};
use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

/// Cost = own (h0/h) (tol0/tol)^power, times the factor of each other form of the case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Forecast {
    /// Duration of the case's own setting (s).
    pub own: f64,
    /// Exponent of the cost in the inverse of the tolerance.
    pub power: f64,
    /// Cost of a form of the case over that of its own: parameter, level, factor.
    #[serde(default)]
    pub forms: Vec<(usize, usize, f64)>,
    /// Whether every probe measured a row of statistics or a whole run; otherwise the forecast is a guess,
    /// and not stored.
    pub measured: bool,
}

impl Forecast {
    /// Runs the case's own setting, its other forms and the finest setting for a short while each. A run that ends within that time
    /// is added to `done`.
    ///
    /// # Errors
    /// A run cannot be started.
    pub fn probe(
        launcher: &Launcher,
        parameters: &[StudyParameter],
        steps: f64,
        seed: u64,
        each: Duration,
        done: &mut Ledger,
        stop: &AtomicBool,
    ) -> Result<Self, TradeError> {
        let mut measured = true;
        let mut seconds = |setting: &Setting| -> Result<f64, TradeError> {
            let sets = setting.sets(parameters);
            if let Some(run) = launcher.stored(&sets, seed) {
                return Ok(run.wall);
            }
            let all = steps / shrink(setting, parameters, Sense::Step);
            let table = launcher.place(&sets, seed).join("statistics.csv");
            let mut guess = f64::INFINITY;
            // Rows are written in batches: without one, the probe is repeated once with more time.
            for longer in [1, 3] {
                let started = Instant::now();
                let ended = launcher.run(&sets, seed, started + longer * each, None, stop)?;
                let ended_at = std::time::SystemTime::now();
                if let Ended::Finished(run) = ended {
                    let wall = run.wall;
                    done.insert((setting.clone(), seed), run);
                    return Ok(wall);
                }
                // Steps are timed from the creation of the table; the time before is a constant.
                let begun = std::fs::metadata(&table).and_then(|m| m.created()).ok();
                let stepping = begun.and_then(|t| ended_at.duration_since(t).ok());
                let stepping = stepping.unwrap_or_else(|| started.elapsed()).as_secs_f64();
                let last = column(&table, "step").and_then(|r| r.last().copied());
                guess = stepping * all / last.unwrap_or(1.0).max(1.0);
                if last.is_some() {
                    return Ok(guess);
                }
            }
            measured = false;
            Ok(guess)
        };
        let (own, finest) = (Setting::own(parameters), Setting::reference(parameters));
        let base = seconds(&own)?;
        let mut forms = Vec::new();
        for (k, parameter) in parameters.iter().enumerate() {
            let others = (0..parameter.levels.len()).filter(|l| *l != parameter.own);
            for level in others.filter(|_| parameter.sense == Sense::Form) {
                forms.push((k, level, seconds(&own.with(k, level))? / base.max(1e-3)));
            }
        }
        let fine = shrink(&finest, parameters, Sense::Tolerance);
        let power = if fine < 1.0 && own != finest {
            let other = factor(&forms, &finest);
            let ratio = seconds(&finest)? / base * shrink(&finest, parameters, Sense::Step) / other;
            (ratio.ln() / (1.0 / fine).ln()).clamp(0.0, 1.0)
        } else {
            0.0
        };
        Ok(Self {
            own: base,
            power,
            forms,
            measured,
        })
    }

    /// Duration of a run (s): that of its other seeds, or the cost law above, multiplied by its mean error so
    /// far.
    pub fn seconds(&self, setting: &Setting, parameters: &[StudyParameter], done: &Ledger) -> f64 {
        let ended = |r: &&Finished| r.status == Status::Done;
        let same: Vec<f64> = done
            .iter()
            .filter(|((s, _), r)| s == setting && ended(r))
            .map(|(_, r)| r.wall)
            .collect();
        if !same.is_empty() {
            return same.iter().sum::<f64>() / same.len() as f64;
        }
        // Correct by the case's own setting if it ran, otherwise by all that ran.
        let own = Setting::own(parameters);
        let ratios = |only: bool| -> Vec<f64> {
            done.iter()
                .filter(|((s, _), r)| ended(r) && (!only || *s == own))
                .map(|((s, _), r)| (r.wall / self.law(s, parameters)).ln())
                .collect()
        };
        let known = [ratios(true), ratios(false)]
            .into_iter()
            .find(|r| !r.is_empty());
        let off = known.map_or(0.0, |r| r.iter().sum::<f64>() / r.len() as f64);
        self.law(setting, parameters) * off.exp()
    }

    /// Duration from the probes alone (s).
    pub fn law(&self, setting: &Setting, parameters: &[StudyParameter]) -> f64 {
        let step = shrink(setting, parameters, Sense::Step);
        let tolerance = shrink(setting, parameters, Sense::Tolerance);
        self.own.max(1e-3) / step * tolerance.powf(-self.power) * factor(&self.forms, setting)
    }
}

/// Product of the cost factors of a setting's forms.
fn factor(forms: &[(usize, usize, f64)], setting: &Setting) -> f64 {
    let here = forms
        .iter()
        .filter(|(k, level, _)| setting.0.get(*k) == Some(level));
    here.map(|(_, _, factor)| factor).product()
}

/// Ratio of the case's own step or tolerance to that of the setting; 1 if it is not varied.
fn shrink(setting: &Setting, parameters: &[StudyParameter], sense: Sense) -> f64 {
    let of = |(k, level): (&StudyParameter, &usize)| {
        let number = |l: usize| k.levels.get(l).and_then(|l| l.number);
        Some(number(*level)? / number(k.own)?)
    };
    let mut all = parameters
        .iter()
        .zip(&setting.0)
        .filter(|(k, _)| k.sense == sense);
    all.find_map(of).unwrap_or(1.0)
}
