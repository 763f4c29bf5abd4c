//! The friction coefficient of the patch: given, or from runs with different seeds.

use super::Contact;
use super::alike::{self, Conditions};
use super::question::Question;
use super::runs::{self, Runs, WindowRun};
use crate::amounts::{self, Range};
use fretwork_math::statistics::interval::Mean;
use serde::Serialize;

/// A friction coefficient with its interval.
#[derive(Clone, Debug, Serialize)]
pub struct Friction {
    /// The coefficient; for runs their mean and the sum of both half-widths below.
    pub coefficient: Range,
    /// Number of runs; 0 if the coefficient was given.
    pub runs: usize,
    /// Half-width of the 95 % interval of the mean over runs (Student), or over the cycles of a
    /// single run.
    pub scatter: Option<f64>,
    /// Largest half-width of the runs' own estimates of the error by step, tolerance and coupling.
    pub numerical: Option<f64>,
    /// Conditions of the runs, those of the first where accepted runs differ.
    pub conditions: Option<Conditions>,
    /// Warnings on the runs.
    #[serde(skip)]
    pub(super) notes: Vec<String>,
}

impl Friction {
    /// Returns the coefficient that a question gives, or that of its runs; `None` without either.
    pub(super) fn of(
        question: &Question,
        contact: &Contact,
        runs: &Runs,
    ) -> Result<Option<Self>, String> {
        match (&question.friction, runs.list.as_slice()) {
            (None, []) => Ok(None),
            (Some(_), [_, ..]) => Err(
                "friction: give the coefficient, or the runs that it is from, not both".to_owned(),
            ),
            (Some(text), []) => Ok(Some(Self {
                coefficient: amounts::friction("friction", text)?,
                runs: 0,
                scatter: None,
                numerical: None,
                conditions: None,
                notes: Vec::new(),
            })),
            (None, _) => {
                let (conditions, differences) = alike::compare(question, contact, runs)?;
                let found = of_runs(&runs.list)?;
                Ok(Some(Self {
                    conditions,
                    notes: [runs.notes.as_slice(), &differences].concat(),
                    ..found
                }))
            }
        }
    }
}

fn of_runs(runs: &[WindowRun]) -> Result<Friction, String> {
    let values: Vec<f64> = runs.iter().map(|r| r.friction).collect();
    let mean = Mean::of(&values).ok_or("friction of runs: there is no run")?;
    let scatter = match runs {
        [one] => one.scatter,
        _ => mean.half_width,
    };
    let numerical = runs::largest(runs, |r| r.numerical);
    let half = scatter.unwrap_or(0.0) + numerical.unwrap_or(0.0);
    let value = mean.mean;
    if half.is_nan() || value <= half {
        return Err(format!(
            "friction of runs: {value:.4} +- {half:.4} contains zero; more runs with other seeds, or longer ones, narrow the interval"
        ));
    }
    Ok(Friction {
        coefficient: Range {
            low: value - half,
            value,
            high: value + half,
        },
        runs: runs.len(),
        scatter,
        numerical,
        conditions: None,
        notes: Vec::new(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::{Value, json};

    #[test]
    fn runs_give_their_mean_with_scatter_and_numerical_error() {
        let folder = std::env::temp_dir().join(format!("fretwork-patch-{}", std::process::id()));
        let mut folders = Vec::new();
        for (k, (value, step)) in [(0.30, 0.01), (0.34, 0.02)].into_iter().enumerate() {
            let run = folder.join(k.to_string());
            std::fs::create_dir_all(&run).unwrap();
            let entry = |path: &str, unit: &str, role: &str, topic: &str, estimate: Value| {
                json!({"path": path, "unit": unit, "doc": "", "role": role, "topic": topic,
                    "label": "", "estimate": estimate})
            };
            let mu = json!({"value": value, "scatter": 0.1, "step": step, "tolerance": 0.005});
            let worn = json!({"value": 2.0, "step": 0.2});
            let rate = format!("{value}e-13").parse::<f64>().unwrap();
            let summary = json!({
                "friction_coefficient": value, "stopped": null, "interrupted": false,
                "trustworthy": true, "identity": k.to_string(),
                "wear": {"volume": 2.0, "bodies": [
                    {"body": "rail", "specific_rate": rate}, {"body": "wheel", "specific_rate": null},
                ]},
                "quantities": [
                    entry("friction_coefficient", "1", "headline", "friction", mu),
                    entry("wear.volume", "m^3/m", "secondary", "wear", worn),
                    entry("wear.bodies.0.specific_rate", "m^3/(N m)", "secondary", "wear", Value::Null),
                    entry("wear.bodies.1.specific_rate", "m^3/(N m)", "secondary", "wear", Value::Null),
                ],
            });
            std::fs::write(run.join("summary.json"), summary.to_string()).unwrap();
            folders.push(run);
        }
        let both = runs::read(&folders).unwrap();
        let got = of_runs(&both.list).unwrap();
        let one = of_runs(&both.list[..1]).unwrap();
        let worn = runs::wear_rates(&both.list);
        std::fs::remove_dir_all(&folder).unwrap();
        // 0.32e-13 with the same scatter, and a tenth by the step.
        let [(body, rate)] = worn.as_slice() else {
            panic!("{worn:?}")
        };
        assert!(body == "rail" && (rate.value / 0.32e-13 - 1.0).abs() < 1e-12);
        let high = 0.32 + 12.706_205 * 0.02 + 0.032;
        assert!((rate.high / (high * 1e-13) - 1.0).abs() < 1e-6, "{rate:?}");
        // Two values 0.04 apart: s/sqrt(2) = 0.02, Student's t with one degree of freedom is
        // 12.706.
        assert!((got.scatter.unwrap() / (12.706_205 * 0.02) - 1.0).abs() < 1e-6);
        assert!((got.numerical.unwrap() - 0.025).abs() < 1e-15);
        assert!((got.coefficient.value - 0.32).abs() < 1e-15);
        assert!((one.coefficient.high - 0.415).abs() < 1e-12);
        assert!(runs::read(&folders[..1]).is_err_and(|e| e.contains("summary.json")));
    }
}
