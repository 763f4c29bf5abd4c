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
    /// What the means are over, as the end of a sentence.
    pub over: String,
    /// What is paired: seeds or combinations.
    pub pairs: &'static str,
    /// The comparison, seed by seed, or combination by combination of the other factors where there is one seed.
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
    match data.design {
        DesignSpec::Grid | DesignSpec::OneAtATime | DesignSpec::Table { .. } => {
            let factors = 0..data.plan.factors.len();
            factors.filter_map(|f| contest(data, f)).collect()
        }
        _ => Vec::new(),
    }
}

fn contest(data: &Data<'_>, factor: usize) -> Option<Contest> {
    let plan = data.plan;
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
    let setting = |name: &str, block: &[&str]| {
        let same = |k: &usize| plan.settings[*k][factor].label == name && others(*k) == block;
        (0..plan.settings.len()).find(same)
    };
    let mut blocks: Vec<Vec<&str>> = Vec::new();
    for block in (0..plan.settings.len()).map(others) {
        let whole = names.iter().all(|name| setting(name, &block).is_some());
        if whole && !blocks.contains(&block) {
            blocks.push(block);
        }
    }
    // By alternative and block, the outputs by seed.
    let runs = |name: &&str| -> Vec<&[Option<f64>]> {
        let of = |block: &Vec<&str>| setting(name, block).map(|k| data.of_setting(k));
        blocks.iter().filter_map(of).collect()
    };
    let seeds = data.seeds();
    // Runs of one seed have one sample: they are not independent, and count as one.
    let by_seed = seeds > 1;
    let row = |name: &&str| -> Vec<Option<f64>> {
        let runs = runs(name);
        match by_seed {
            true => (0..seeds)
                .map(|seed| {
                    let values: Option<Vec<f64>> = runs.iter().map(|r| r[seed]).collect();
                    values
                        .filter(|v| !v.is_empty())
                        .map(|v| v.iter().sum::<f64>() / v.len() as f64)
                })
                .collect(),
            false => runs.iter().map(|r| r[0]).collect(),
        }
    };
    let over = match (by_seed, blocks.len()) {
        (true, 1) => format!("means over {seeds} seeds with intervals of 95 %"),
        (true, n) => format!(
            "means over {seeds} seeds, each the mean over {n} combinations of the other factors, with intervals of 95 %"
        ),
        (false, n) => format!("means over {n} combinations of the other factors, one run each"),
    };
    Some(Contest {
        factor: plan.factors[factor].name.clone(),
        names: names.iter().map(|n| (*n).to_owned()).collect(),
        over,
        pairs: if by_seed { "seeds" } else { "combinations" },
        tournament: Tournament::of(&names.iter().map(row).collect::<Vec<_>>()),
    })
}
