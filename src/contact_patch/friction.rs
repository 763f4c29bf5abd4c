//! The friction coefficient of the patch: given, or that of runs with other seeds.

use super::question::{Question, range};
use super::range::Range;
use crate::trade::interval::Mean;
use serde::Serialize;
use serde_json::Value;
use std::path::Path;

/// A friction coefficient with its interval.
#[derive(Clone, Debug, Serialize)]
pub struct Friction {
    /// The coefficient: of runs, their mean and the sum of both half-widths below.
    pub coefficient: Range,
    /// Number of runs that it is from; 0 if it was given.
    pub runs: usize,
    /// Half-width of the 95 % interval of the mean over runs (Student), or over the cycles of a single run.
    pub scatter: Option<f64>,
    /// Largest half-width of the runs' own estimates of the error by step, tolerance and coupling.
    pub numerical: Option<f64>,
}

impl Friction {
    /// That of a question, if it gives one.
    pub(super) fn of(question: &Question) -> Result<Option<Self>, String> {
        match (&question.friction, question.runs.as_slice()) {
            (None, []) => Ok(None),
            (Some(_), [_, ..]) => Err(
                "friction: give the coefficient, or the runs that it is from, not both".to_owned(),
            ),
            (Some(text), []) => Ok(Some(Self {
                coefficient: range("friction", text)?,
                runs: 0,
                scatter: None,
                numerical: None,
            })),
            (None, folders) => of_runs(folders).map(Some),
        }
    }
}

/// What the summary of a run says of its friction coefficient: value, scatter within the run, numerical error.
fn of_run(folder: &Path) -> Result<(f64, Option<f64>, Option<f64>), String> {
    let path = folder.join("summary.json");
    let text = std::fs::read_to_string(&path).map_err(|e| {
        format!(
            "friction of a run: cannot read {}: {e}; give the folder of a finished run",
            path.display()
        )
    })?;
    let summary: Value = serde_json::from_str(&text)
        .map_err(|e| format!("friction of a run: {} is damaged: {e}", path.display()))?;
    if !summary["stopped"].is_null() || summary["interrupted"] == true {
        return Err(format!(
            "friction of a run: {} did not reach its end; run it again",
            folder.display()
        ));
    }
    let value = summary["friction_coefficient"].as_f64().ok_or_else(|| {
        format!(
            "friction of a run: {} has no friction coefficient; its case needs `friction`",
            folder.display()
        )
    })?;
    let error = &summary["uncertainty"]["friction_coefficient"];
    let parts = ["step", "tolerance", "coupling"].map(|name| error[name].as_f64());
    let numerical = match parts {
        [None, None, None] => None,
        parts => Some(parts.into_iter().flatten().sum()),
    };
    Ok((value, error["scatter"].as_f64(), numerical))
}

fn of_runs(folders: &[std::path::PathBuf]) -> Result<Friction, String> {
    let mut values = Vec::new();
    let (mut within, mut numerical) = (None, Some(0.0f64));
    for folder in folders {
        let (value, scatter, error) = of_run(folder)?;
        values.push(value.abs());
        within = scatter;
        numerical = numerical.zip(error).map(|(a, b)| a.max(b));
    }
    let mean = Mean::of(&values).ok_or("friction of runs: there is no run")?;
    let scatter = match values.len() {
        1 => within,
        _ => mean.half_width,
    };
    let half = scatter.unwrap_or(0.0) + numerical.unwrap_or(0.0);
    let value = mean.mean;
    if !(value - half > 0.0) {
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
        runs: values.len(),
        scatter,
        numerical,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_give_their_mean_with_scatter_and_numerical_error() {
        let folder = std::env::temp_dir().join(format!("fretwork-patch-{}", std::process::id()));
        let mut runs = Vec::new();
        for (k, (value, step)) in [(0.30, 0.01), (0.34, 0.02)].into_iter().enumerate() {
            let run = folder.join(k.to_string());
            std::fs::create_dir_all(&run).unwrap();
            let text = format!(
                r#"{{"friction_coefficient": {value}, "stopped": null, "interrupted": false,
                "uncertainty": {{"friction_coefficient": {{"scatter": 0.1, "step": {step}, "tolerance": 0.005, "coupling": null}}}}}}"#
            );
            std::fs::write(run.join("summary.json"), text).unwrap();
            runs.push(run);
        }
        let got = of_runs(&runs).unwrap();
        let one = of_runs(&runs[..1]).unwrap();
        std::fs::remove_dir_all(&folder).unwrap();
        // Two values 0.04 apart: s/sqrt(2) = 0.02, Student's t with one degree of freedom is 12.706.
        assert!((got.scatter.unwrap() / (12.706_205 * 0.02) - 1.0).abs() < 1e-6);
        assert!((got.numerical.unwrap() - 0.025).abs() < 1e-15);
        assert!((got.coefficient.value - 0.32).abs() < 1e-15);
        assert!((one.coefficient.high - 0.415).abs() < 1e-12);
        assert!(of_runs(&runs[..1]).is_err_and(|e| e.contains("summary.json")));
    }
}
