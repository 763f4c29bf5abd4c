//! The page of a study, `study.html`.

mod effects;

use super::analysis::{Analysis, OutputAnalysis};
use super::figures::{regime_chart, response_chart};
use super::plan::Plan;
use super::rows::{DONE, NOT_RUN, Rows};
use crate::factor::Level;
use crate::page::{section, table};
use effects::{alternatives_table, effect_block, pairs_table};
use fretwork_math::statistics::interval::Mean;
use fretwork_observe::quantity::quantity;
use fretwork_view::{Block, Section, Sheet};

/// Largest number of settings that a page lists; the tables contain all.
const LISTED: usize = 100;
/// Largest number of failed runs that a page lists.
const FAILURES: usize = 30;

/// The page of a study.
pub fn sheet(plan: &Plan, rows: &Rows, analysis: &Analysis) -> Sheet {
    let counts = rows.counts();
    let mut sections = Vec::new();
    for output in &analysis.outputs {
        sections.push(output_section(plan, output));
    }
    let maps = analysis.regimes.iter();
    let maps: Vec<Block> = maps
        .filter_map(|r| Some(Block::Figure(Box::new(regime_chart(plan, r)?))))
        .collect();
    if !maps.is_empty() {
        sections.push(section("Regimes", maps));
    }
    sections.push(settings_section(plan, rows, analysis));
    sections.push(runs_section(rows));
    sections.push(inputs_section(plan));
    let mut lead = format!(
        "{} of {} runs are done: {} settings with {} seed{} of {}.",
        counts.done,
        counts.all,
        plan.settings.len(),
        plan.seeds.len(),
        if plan.seeds.len() == 1 { "" } else { "s" },
        plan.launcher.case.display()
    );
    if counts.failed > 0 {
        lead += &format!(
            " {} failed or were rejected; figures and tables are of the others.",
            counts.failed
        );
    }
    if counts.missing > 0 {
        lead += &format!(" INCOMPLETE: {} have not run.", counts.missing);
    }
    if !plan.random && plan.seeds.len() > 1 {
        lead += " Nothing in the case is drawn from its seed: runs with steps longer by multiples of 1e-10 of themselves take the place of seeds.";
    }
    if plan.seeds.len() == 1 {
        lead +=
            " One seed gives no intervals: whether a difference is more than scatter is not known.";
    }
    Sheet {
        title: plan.title.clone(),
        lead,
        sections,
        command: "fretwork study".to_owned(),
    }
}

fn output_section(plan: &Plan, output: &OutputAnalysis) -> Section {
    let mut blocks: Vec<Block> = Vec::new();
    for alternatives in &output.alternatives {
        blocks.push(alternatives_table(alternatives, &output.unit));
        blocks.push(pairs_table(alternatives, &output.unit));
    }
    let figures = output.responses.iter();
    blocks.extend(figures.map(|r| Block::Figure(Box::new(response_chart(plan, output, r)))));
    blocks.push(effect_block(plan, output));
    section(title_of(&output.name), blocks)
}

/// A name as a heading.
pub(super) fn title_of(name: &str) -> String {
    name.trim_start_matches("measures.")
        .trim_start_matches("findings.")
        .trim_start_matches("statistics.")
        .replace('_', " ")
}

fn settings_section(plan: &Plan, runs: &Rows, analysis: &Analysis) -> Section {
    let mut heads: Vec<String> = vec!["setting".to_owned()];
    heads.extend(plan.factors.iter().enumerate().map(
        |(f, factor)| match plan.unit_of(f).as_str() {
            "" => factor.name.clone(),
            unit => format!("{} [{unit}]", factor.name),
        },
    ));
    heads.extend(analysis.outputs.iter().map(|o| title_of(&o.name)));
    heads.extend(analysis.regimes.iter().map(|r| title_of(&r.name)));
    let row = |(k, setting): (usize, &super::design::Setting)| {
        let mut row = vec![(k + 1).to_string()];
        row.extend(setting.iter().map(Level::short));
        row.extend(analysis.outputs.iter().map(|o| match &o.means[k] {
            Some(mean) => mean_text(mean, &o.unit),
            None => runs.without_result(k, plan.seeds.len()),
        }));
        row.extend(analysis.regimes.iter().map(|r| r.words(k)));
        row
    };
    let rows: Vec<Vec<String>> = plan
        .settings
        .iter()
        .enumerate()
        .take(LISTED)
        .map(row)
        .collect();
    let note = match plan.settings.len() > LISTED {
        true => format!(
            "The first {LISTED} of {} settings; all are in settings.csv.",
            plan.settings.len()
        ),
        false if plan.seeds.len() == 1 => "One seed each, without intervals.".to_owned(),
        false => format!(
            "Means over {} seeds, ± half-widths of 95 %.",
            plan.seeds.len()
        ),
    };
    let heads = heads.iter().map(String::as_str);
    section("Settings", vec![table(note, heads, rows)])
}

fn runs_section(runs: &Rows) -> Section {
    let mut rows = Vec::new();
    let mut left = 0;
    for k in 0..runs.table.rows() {
        let text = |name: &str| runs.table.text(name, k).to_owned();
        let (status, doubt) = (text("status"), text("not_trustworthy"));
        if [DONE, NOT_RUN].contains(&status.as_str()) && doubt.is_empty() {
            continue;
        }
        if rows.len() == FAILURES {
            left += 1;
            continue;
        }
        rows.push(vec![
            (k + 1).to_string(),
            status,
            text("reason"),
            doubt,
            text("folder"),
        ]);
    }
    if rows.is_empty() {
        let text = "No run failed, and none says that it is not trustworthy.".to_owned();
        return section("Runs", vec![Block::Text(text)]);
    }
    let more = if left > 0 {
        format!(" {left} more are in table.csv.")
    } else {
        String::new()
    };
    let note =
        format!("Runs that failed, were rejected, or say that they are not trustworthy.{more}");
    let heads = ["run", "status", "reason", "says", "folder"];
    section("Runs", vec![table(note, heads, rows)])
}

fn inputs_section(plan: &Plan) -> Section {
    let text = std::fs::read_to_string(&plan.file).unwrap_or_default();
    let made = format!(
        "Made by fretwork {}, program {}. To repeat a run by hand: fretwork study check {} --points lists the changes of each.",
        env!("CARGO_PKG_VERSION"),
        plan.launcher.program(),
        plan.file.display()
    );
    section("The study", vec![Block::Text(made), Block::Code(text)])
}

/// Formats a mean with its interval.
pub(super) fn mean_text(mean: &Mean, unit: &str) -> String {
    let value = quantity(mean.mean, unit);
    match mean.half_width {
        Some(half) => format!("{value} ± {}", quantity(half, unit)),
        None => value,
    }
}
