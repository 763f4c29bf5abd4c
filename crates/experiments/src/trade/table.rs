//! Report of a trade on a terminal.

use super::combination::Combination;
use super::compare::{Comparison, OutputError, Row, ShownError, share};
use super::output::Output;
use super::plan::{Findings, Trade};
use super::verdict::{amount, three};
use crate::duration::seconds;
use crate::shell;
use std::fmt::Write as _;

/// Returns the forecast that is printed before the runs.
pub fn forecast(trade: &Trade) -> String {
    let (first, one_at_a_time) = (trade.first(), trade.one_at_a_time());
    let seeds = trade.seeds.len();
    let all: Vec<Combination> = first.iter().chain(&one_at_a_time).cloned().collect();
    let count = |n: usize| {
        format!(
            "{n} settings x {seeds} seed{}",
            if seeds == 1 { "" } else { "s" }
        )
    };
    let names: Vec<String> = trade
        .parameters
        .iter()
        .map(|k| {
            let levels: Vec<&str> = k.levels.iter().map(|l| l.label.as_str()).collect();
            format!(
                "  {:<14} {}  (case {}, reference {})",
                k.name,
                levels.join(" "),
                k.levels[k.own].label,
                k.levels[k.reference].label
            )
        })
        .collect();
    let left_out = trade.parameters.iter().flat_map(|k| &k.left_out);
    let left_out: String = left_out
        .map(|(level, why)| format!("\n  not offered    {level}: {why}"))
        .collect();
    format!(
        "varied\n{}{left_out}\nforecast, from short probes: the case's own setting {} a run, the reference {}; the reference and its neighbours {} ({}), \
         one parameter at a time {} more ({}), combinations as time allows; budget {}",
        names.join("\n"),
        seconds(trade.cost_law(&Combination::own(&trade.parameters))),
        seconds(trade.cost_law(&Combination::reference(&trade.parameters))),
        seconds(trade.work(&first)),
        count(first.len()),
        seconds(trade.work(&all) - trade.work(&first)),
        count(one_at_a_time.len()),
        seconds(trade.budget.as_secs_f64()),
    )
}

/// The table of the settings and the verdicts.
pub fn text(trade: &Trade, answer: &Findings) -> String {
    let found = &answer.found;
    let mut out = String::new();
    push_settings(&mut out, trade, found);
    out.push('\n');
    push_outputs(&mut out, trade, found);
    out.push('\n');
    for v in &answer.verdicts {
        let _ = writeln!(out, "{}: {}", v.wanted, v.text);
        if let Some(row) = v.row {
            let sets = found.rows[row].setting.sets(&trade.parameters);
            let _ = writeln!(out, "  {}", command(trade, &sets));
        }
    }
    for note in &trade.notes {
        let _ = writeln!(out, "{note}");
    }
    out
}

/// Returns the runs that a trade left out, and why.
pub fn incomplete(trade: &Trade, interrupted: bool) -> String {
    let left_out = trade.left_out.iter();
    let names: Vec<String> = left_out.map(|s| s.name(&trade.parameters)).collect();
    let dropped = trade.dropped();
    let why = match interrupted {
        true => "interrupted",
        false => "the budget is spent",
    };
    let mut what = String::new();
    if !names.is_empty() {
        what = format!(" Not run, or not over all seeds: {}.", names.join("; "));
    }
    if !dropped.is_empty() {
        let _ = write!(
            what,
            " Finer than this budget allows the reference: {}; a larger --budget includes them.",
            dropped.join("; ")
        );
    }
    format!("INCOMPLETE, {why}.{what} The same command continues from here.")
}

/// Adds one line for each setting: cost, and the errors of the outputs.
fn push_settings(out: &mut String, trade: &Trade, found: &Comparison) {
    let reference = Combination::reference(&trade.parameters);
    let label = |row: &Row| {
        let mark = if row.setting == reference {
            " (reference)"
        } else {
            ""
        };
        format!("{}{mark}", row.name)
    };
    let widths = found.rows.iter().map(|r| label(r).len());
    let width = widths.max().unwrap_or(8).clamp(16, 70);
    let _ = write!(
        out,
        "{:<width$}  {:>9}  {:>8}  {:>9}",
        "setting", "cpu s", "faster", "visits"
    );
    for o in &trade.outputs {
        let unit = match o.error_unit() {
            "" => String::new(),
            unit => format!(" ({unit})"),
        };
        let _ = write!(out, "  {:>24}", format!("{}{unit}", o.name()));
    }
    out.push('\n');
    for row in &found.rows {
        let faster = row.faster.as_ref().map_or("-".into(), |f| three(f.0));
        let name = label(row);
        let _ = write!(
            out,
            "{name:<width$}  {:>9.3}  {faster:>8}  {:>9.2e}",
            row.seconds, row.visits
        );
        if let Some(why) = &row.failed {
            let _ = writeln!(out, "  NOT USED: {why}");
            continue;
        }
        for (e, o) in row.errors.iter().zip(&trade.outputs) {
            let cell = error_cell(e.as_ref(), o, row.setting == reference);
            let _ = write!(out, "  {cell:>24}");
        }
        if let Some(why) = row.not_trustworthy() {
            let _ = write!(out, "  ! {why}");
        }
        if row.seeds < trade.seeds.len() {
            let _ = write!(out, "  {} of {} seeds", row.seeds, trade.seeds.len());
        }
        out.push('\n');
    }
    let _ = writeln!(
        out,
        "* on the frontier: no other setting is cheaper with a smaller error bound"
    );
    if found.rows.iter().any(|row| row.not_trustworthy().is_some()) {
        let _ = writeln!(
            out,
            "! runs that warn about themselves; the reasons are in `summary.json` of their folders in runs/"
        );
    }
}

/// Formats the error of an output in a row; for the reference its own error.
fn error_cell(error: Option<&OutputError>, output: &Output, of_reference: bool) -> String {
    let Some(e) = error else {
        return "no value  ".into();
    };
    let mark = if e.on_frontier { " *" } else { "  " };
    if !of_reference || output.exact.is_some() {
        let error = ShownError(&e.error, output.wanted)
            .to_string()
            .replace(" %", "");
        return format!("{error}{mark}");
    }
    let own = if e.bound.is_finite() {
        amount(e.bound, output).replace(" %", "")
    } else {
        "?".into()
    };
    format!("own <= {own}{mark}")
}

/// Adds the value of each output in the reference, and its largest error.
fn push_outputs(out: &mut String, trade: &Trade, found: &Comparison) {
    for (own, o) in found.own.iter().zip(&trade.outputs) {
        let Some(own) = own else {
            let _ = writeln!(out, "{}: no value in the reference", o.name());
            continue;
        };
        let scatter = own.value.scatter.map_or(String::new(), |s| {
            let part = if own.value.mean == 0.0 {
                format!("{s:.1e}")
            } else {
                format!("{} %", share(s / own.value.mean.abs()))
            };
            format!(", scatter among {} seeds {part}", own.value.count)
        });
        let truth = o
            .exact
            .map_or(String::new(), |x| format!(", true value {x}"));
        let _ = writeln!(
            out,
            "{}: {:.6} in the reference{scatter}{truth}",
            o.name(),
            SignificantDigits(own.value.mean)
        );
        if o.exact.is_none() {
            let known = if own.at_most.is_finite() {
                amount(own.at_most, o)
            } else {
                "an unknown amount".into()
            };
            let _ = writeln!(
                out,
                "  the reference may itself be off by {known}: {}",
                own.why
            );
        }
    }
}

/// Returns the command that runs a setting.
fn command(trade: &Trade, sets: &[String]) -> String {
    let launcher = &trade.launcher;
    let mut words = vec!["run".to_owned(), launcher.case.display().to_string()];
    for set in launcher.sets.iter().chain(sets) {
        words.extend(["--set".to_owned(), set.clone()]);
    }
    words.extend(launcher.plugins.iter().cloned());
    format!("fretwork {} --threads 1", shell::command(&words))
}

/// A number with significant digits.
struct SignificantDigits(f64);

impl std::fmt::Display for SignificantDigits {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        if self.0 != 0.0 && !(1e-3..1e5).contains(&self.0.abs()) {
            write!(f, "{:.4e}", self.0)
        } else {
            write!(f, "{:.5}", self.0)
        }
    }
}
