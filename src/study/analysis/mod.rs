//! What the runs of a study say: means over seeds, response curves, effects of factors, comparisons of alternatives, maps of
//! regimes. Only runs that are done and trusted count.

mod curves;
mod effects;
mod regimes;

pub use curves::{Curve, Response};
pub use effects::{Effects, Standing};
pub use regimes::RegimeMap;

use super::factor::{Factor, Kind};
use super::plan::Plan;
use super::spec::DesignSpec;
use super::table::Table;
use fretwork_study::interval::Mean;
use fretwork_study::tournament::Tournament;

/// Everything that is said of a study.
#[derive(Clone, Debug)]
pub struct Analysis {
    /// By output.
    pub outputs: Vec<OutputAnalysis>,
    /// By regime that is asked for.
    pub regimes: Vec<RegimeMap>,
}

/// What is said of an output.
#[derive(Clone, Debug)]
pub struct OutputAnalysis {
    /// Its name.
    pub name: String,
    /// Its SI unit.
    pub unit: String,
    /// The mean over the seeds of each setting; `None` where no run is done.
    pub means: Vec<Option<Mean>>,
    /// The output over each factor with numbers.
    pub responses: Vec<Response>,
    /// How much each factor matters.
    pub effects: Effects,
    /// Alternatives of the factors without numbers.
    pub contests: Vec<Contest>,
}

/// The alternatives of a factor compared.
#[derive(Clone, Debug)]
pub struct Contest {
    /// The factor.
    pub factor: String,
    /// Names of the alternatives.
    pub names: Vec<String>,
    /// The comparison, pairs of runs with the same seed and the same other factors.
    pub tournament: Tournament,
}

/// A study with one output by run.
struct Data<'a> {
    plan: &'a Plan,
    design: &'a DesignSpec,
    /// One for each run; `None` where it is not done.
    values: Vec<Option<f64>>,
}

impl Analysis {
    /// Analyses a table of a study with a design.
    pub fn of(plan: &Plan, design: &DesignSpec, table: &Table) -> Self {
        let outputs = plan.outputs.iter().map(|output| {
            let data = Data {
                plan,
                design,
                values: table.trusted(&output.name),
            };
            OutputAnalysis {
                name: output.name.clone(),
                unit: table
                    .column(&output.name)
                    .map_or(String::new(), |c| c.unit.clone()),
                means: data.means(),
                responses: curves::responses(&data),
                effects: effects::effects(&data),
                contests: contests(&data),
            }
        });
        Self {
            outputs: outputs.collect(),
            regimes: regimes::maps(plan, table),
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

    /// Labels that a factor takes, in the order of its first settings.
    fn labels(&self, factor: usize) -> Vec<&str> {
        let mut labels: Vec<&str> = Vec::new();
        for setting in &self.plan.settings {
            let label = setting[factor].label.as_str();
            if !labels.contains(&label) {
                labels.push(label);
            }
        }
        labels
    }

    /// Level numbers of all settings.
    fn levels(&self) -> (Vec<usize>, Vec<Vec<usize>>) {
        let labels: Vec<Vec<&str>> = (0..self.plan.factors.len())
            .map(|f| self.labels(f))
            .collect();
        let row = |setting: &Vec<super::factor::Value>| {
            let place = |(f, v): (usize, &super::factor::Value)| {
                labels[f].iter().position(|l| *l == v.label).unwrap_or(0)
            };
            setting.iter().enumerate().map(place).collect()
        };
        let rows = self.plan.settings.iter().map(row).collect();
        (labels.iter().map(Vec::len).collect(), rows)
    }
}

/// Whether all values of a factor are numbers.
pub fn numeric(plan: &Plan, factor: usize) -> bool {
    plan.settings.iter().all(|s| s[factor].number.is_some())
}

/// Whether a factor is spread evenly in its logarithm.
pub fn logarithmic(factor: &Factor) -> bool {
    matches!(
        &factor.kind,
        Kind::Range {
            scale: fretwork_study::design::scale::Scale::Logarithmic { .. },
            ..
        }
    )
}

/// The alternatives of factors without numbers, in designs that have each with the same others.
fn contests(data: &Data<'_>) -> Vec<Contest> {
    let plan = data.plan;
    let of = |factor: usize| {
        let names = data.labels(factor);
        if numeric(plan, factor) || names.len() < 2 {
            return None;
        }
        // A block is a combination of all other factors.
        let others = |k: usize| -> Vec<&str> {
            let values = plan.settings[k].iter().enumerate();
            values
                .filter(|(f, _)| *f != factor)
                .map(|(_, v)| v.label.as_str())
                .collect()
        };
        let mut blocks: Vec<Vec<&str>> = Vec::new();
        for k in 0..plan.settings.len() {
            if !blocks.contains(&others(k)) {
                blocks.push(others(k));
            }
        }
        let row = |name: &&str| -> Vec<Option<f64>> {
            let block = |block: &Vec<&str>| {
                let found = (0..plan.settings.len())
                    .find(|&k| plan.settings[k][factor].label == *name && others(k) == *block);
                match found {
                    Some(k) => data.of_setting(k).to_vec(),
                    None => vec![None; data.seeds()],
                }
            };
            blocks.iter().flat_map(block).collect()
        };
        Some(Contest {
            factor: plan.factors[factor].name.clone(),
            names: names.iter().map(|n| (*n).to_owned()).collect(),
            tournament: Tournament::of(&names.iter().map(row).collect::<Vec<_>>()),
        })
    };
    match data.design {
        DesignSpec::Grid | DesignSpec::OneAtATime | DesignSpec::Table { .. } => {
            (0..plan.factors.len()).filter_map(of).collect()
        }
        _ => Vec::new(),
    }
}
