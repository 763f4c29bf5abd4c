//! Analysis of the runs of a study: means over seeds, response curves, effects of factors,
//! comparisons of alternatives, maps of regimes. Only runs that are done and trusted are used.

mod comparisons;
mod curves;
mod effects;
mod regimes;

pub use comparisons::Alternatives;
pub use curves::Response;
pub use effects::{Change, Effects};
pub use regimes::Regimes;

use super::plan::Plan;
use super::rows::Rows;
use super::spec::DesignSpec;
use crate::factor::{Factor, Level, Values};
use crate::runs::unit::heading;
use fretwork_math::statistics::interval::Mean;
use std::collections::HashMap;

/// Analysis of a study.
#[derive(Clone, Debug)]
pub struct Analysis {
    /// Analyses of the outputs.
    pub outputs: Vec<OutputAnalysis>,
    /// Requested regimes.
    pub regimes: Vec<Regimes>,
}

/// Analysis of an output.
#[derive(Clone, Debug)]
pub struct OutputAnalysis {
    /// Name of the output.
    pub name: String,
    /// SI unit of the output.
    pub unit: String,
    /// Mean over the seeds of each setting; `None` where no run is done.
    pub means: Vec<Option<Mean>>,
    /// The output as a function of each factor with numbers.
    pub responses: Vec<Response>,
    /// Importance of each factor.
    pub effects: Effects,
    /// Alternatives of the factors without numbers.
    pub alternatives: Vec<Alternatives>,
}

/// A study with the values of one output.
struct Data<'a> {
    plan: &'a Plan,
    design: &'a DesignSpec,
    /// One value for each run; `None` where it is not done.
    values: Vec<Option<f64>>,
}

impl Analysis {
    /// Analyses the runs of a study with a design.
    pub fn of(plan: &Plan, design: &DesignSpec, rows: &Rows) -> Self {
        let outputs = plan.outputs.iter().map(|output| {
            let data = Data {
                plan,
                design,
                values: rows.trusted(&output.name),
            };
            OutputAnalysis {
                name: output.name.clone(),
                unit: rows
                    .table
                    .column(&output.name)
                    .map_or(String::new(), |c| heading(&c.unit).to_owned()),
                means: data.means(),
                responses: curves::responses(&data),
                effects: effects::effects(&data),
                alternatives: comparisons::comparisons(&data),
            }
        });
        Self {
            outputs: outputs.collect(),
            regimes: regimes::regimes(plan, rows),
        }
    }
}

impl Data<'_> {
    fn seeds(&self) -> usize {
        self.plan.seeds.len()
    }

    /// The outputs of a setting by seed.
    fn of_setting(&self, setting: usize) -> &[Option<f64>] {
        let seeds = self.seeds();
        self.values
            .get(setting * seeds..(setting + 1) * seeds)
            .unwrap_or_default()
    }

    fn means(&self) -> Vec<Option<Mean>> {
        (0..self.plan.settings.len())
            .map(|k| {
                Mean::of(
                    &self
                        .of_setting(k)
                        .iter()
                        .copied()
                        .flatten()
                        .collect::<Vec<_>>(),
                )
            })
            .collect()
    }

    /// Returns the labels of a factor, in the order of its first settings.
    fn labels(&self, factor: usize) -> Vec<&str> {
        self.plan.labels(factor)
    }

    /// Returns the level numbers of all settings.
    fn levels(&self) -> (Vec<usize>, Vec<Vec<usize>>) {
        let places: Vec<HashMap<&str, usize>> = (0..self.plan.factors.len())
            .map(|f| self.labels(f).into_iter().zip(0..).collect())
            .collect();
        let row = |setting: &Vec<Level>| {
            let place =
                |(f, v): (usize, &Level)| places[f].get(v.label.as_str()).copied().unwrap_or(0);
            setting.iter().enumerate().map(place).collect()
        };
        let rows = self.plan.settings.iter().map(row).collect();
        (places.iter().map(HashMap::len).collect(), rows)
    }
}

/// Returns whether a factor has evenly spaced logarithms.
pub fn logarithmic(factor: &Factor) -> bool {
    matches!(
        &factor.values,
        Values::Range {
            scale: fretwork_math::design::scale::Scale::Logarithmic { .. },
            ..
        }
    )
}

/// Returns whether the values of a factor are better shown on a logarithmic axis: for a range by
/// its scale, for listed values if their ratios vary less than their differences.
pub fn logarithmic_axis(plan: &Plan, factor: usize) -> bool {
    if matches!(plan.factors[factor].values, Values::Range { .. }) {
        return logarithmic(&plan.factors[factor]);
    }
    let mut numbers: Vec<f64> = plan
        .settings
        .iter()
        .filter_map(|s| s[factor].number)
        .collect();
    numbers.sort_by(f64::total_cmp);
    numbers.dedup();
    ratios_are_alike(&numbers)
}

/// Returns, for numbers in their order, whether ratios of neighbours vary less, by their standard
/// deviation over their mean, than differences.
fn ratios_are_alike(numbers: &[f64]) -> bool {
    let variation = |of: &dyn Fn(f64) -> f64| {
        let steps: Vec<f64> = numbers.windows(2).map(|w| of(w[1]) - of(w[0])).collect();
        Mean::of(&steps).and_then(|m| Some(m.scatter? / m.mean))
    };
    match numbers {
        [low, .., high] if *low > 0.0 => match (variation(&f64::ln), variation(&|x| x)) {
            (Some(ratios), Some(differences)) => ratios < differences,
            // There are two numbers.
            _ => *high > 20.0 * *low,
        },
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::ratios_are_alike;

    #[test]
    fn axes_follow_the_spacing_of_listed_numbers() {
        for log in [
            &[0.1, 1.0, 10.0, 30.0, 100.0][..],
            &[300.0, 1e3, 3e3],
            &[1e-6, 1e-4],
        ] {
            assert!(ratios_are_alike(log), "{log:?}");
        }
        for linear in [
            &[0.1, 0.2, 0.3][..],
            &[0.0, 1.0, 10.0],
            &[-1.0, 1.0],
            &[1.0, 2.0],
            &[1.0],
        ] {
            assert!(!ratios_are_alike(linear), "{linear:?}");
        }
    }
}
