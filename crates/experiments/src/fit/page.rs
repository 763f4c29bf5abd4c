//! Results of a fit for a reader: lines for the terminal, the page `fit.html` and the picture
//! `fit.png`.

use super::evaluate::Tests;
use super::measured::heading;
use super::outcome::{HalfStep, Moved, Outcome, mean_of};
use super::search::SearchResult;
use super::spec::{FitFile, TestSpec};
use crate::page::{section, table};
use fretwork_math::fit::identify::{End, ParameterEstimate};
use fretwork_observe::quantity::number;
use fretwork_view::{Axis, Block, Chart, DrawError, Series, Sheet, Style, draw_panels};
use std::fmt::Write as _;
use std::path::Path;

/// Correlation above which the report calls two parameters hard to distinguish.
const HIGH: f64 = 0.9;

/// Describes the parts of a fit.
pub fn consists_of(read: &FitFile, tests: &Tests) -> String {
    let mut out = format!("{}: {}\n", read.path.display(), title(read));
    for test in tests.target.tests() {
        let values = if test.x.len() == 1 { "value" } else { "values" };
        let _ = writeln!(
            out,
            "  test {}: {} measured {values}",
            test.name,
            test.x.len()
        );
    }
    for p in &read.spec.parameters {
        let [low, high] = p.limits();
        let _ = writeln!(out, "  {}: {low} to {high} {}", p.name, p.shown_unit());
    }
    let seeds = match tests.random {
        true => format!(
            "{} to {} seeds for each point",
            read.spec.seeds.0, read.spec.seeds.1
        ),
        false => "nothing is drawn from the seed: one run for each point".to_owned(),
    };
    let _ = write!(out, "  {seeds}");
    out
}

fn title(read: &FitFile) -> String {
    read.spec
        .title
        .clone()
        .unwrap_or_else(|| "a fit".to_owned())
}

/// The sentences of the result, worst first.
fn verdict(read: &FitFile, found: &SearchResult, outcome: &Outcome) -> Vec<String> {
    let known = &outcome.identification;
    let names = read.spec.names();
    let mut out = Vec::new();
    if !known.describes {
        out.push(format!(
            "NOT DESCRIBED: the curves differ from the measured ones by more than their errors (reduced sum of squares {}, probability {}); intervals are widened by {}, which holds only if the departures are as random as noise",
            known.reduced.map_or("unknown".to_owned(), |r| number(r, 3)),
            known.p.map_or("unknown".to_owned(), |p| number(p, 2)),
            number(known.widened, 3)
        ));
    }
    if !outcome.settled && !known.at_edge {
        out.push("NOT SETTLED: the estimate fits worse than the best point, or the runs around it are not as wide as its intervals; take the intervals as rough, and look at evaluations.csv".to_owned());
    }
    if known.at_edge {
        out.push("NOT SETTLED: the least squares lie at the edge of the runs around the best point; more generations or points may find better values".to_owned());
    }
    for direction in known.directions.iter().filter(|d| !d.determined) {
        out.push(format!(
            "NOT DETERMINED: the measurements do not determine {} (all at once, in shares of their ranges); measure something else too, or fix one of them",
            direction.words(&names)
        ));
    }
    for e in &known.estimates {
        if let Some(end) = e.at {
            let end = match end {
                End::Lowest => "lower",
                End::Highest => "upper",
            };
            out.push(format!("AT AN END: {} lies at the {end} end of its range; extend the range, unless the end is physical", e.name));
        }
    }
    for i in 0..names.len() {
        for j in i + 1..names.len() {
            if let Some(r) = known.correlation[i][j].filter(|r| r.abs() > HIGH) {
                let way = if r > 0.0 { "the same" } else { "opposite" };
                out.push(format!("{} and {} are hard to distinguish: their errors go {way} ways (correlation {r:.2})", names[i], names[j]));
            }
        }
    }
    match &outcome.half_step {
        Some(HalfStep::Moves { parameters, beyond }) => {
            for &i in beyond {
                let e = &known.estimates[i];
                let unit = &read.spec.parameters[i].shown_unit();
                let half = parameters[i].map_or(String::new(), moved_text);
                out.push(format!(
                    "STEP NOT SMALL: with half the step {} would be {half} instead of {} {unit}, a change by more than an eighth of the half-width of its interval; take a smaller step (`time.step` in `set` of the tests)",
                    e.name, number(e.value, 4)
                ));
            }
        }
        Some(HalfStep::Failed(why)) => out.push(format!(
            "what the step does to the estimates is not known: a run with half the step failed ({why})"
        )),
        None => {}
    }
    let failed = found.failed();
    if failed > 0 {
        out.push(format!(
            "{failed} of {} points failed; evaluations.csv has the reasons",
            found.evaluations.len()
        ));
    }
    out
}

/// Formats a value with its interval.
fn value_text(e: &ParameterEstimate, unit: &str) -> String {
    let unit = if unit.is_empty() {
        String::new()
    } else {
        format!(" {unit}")
    };
    let low = if e.open_below {
        format!("below {}", number(e.interval.low, 4))
    } else {
        number(e.interval.low, 4)
    };
    let high = if e.open_above {
        format!("above {}", number(e.interval.high, 4))
    } else {
        number(e.interval.high, 4)
    };
    match e.determined {
        true => format!("{} ({low} to {high}){unit}", number(e.value, 4)),
        false => format!(
            "not determined within {} to {}{unit}",
            number(e.interval.low, 4),
            number(e.interval.high, 4)
        ),
    }
}

/// Formats a parameter with half the step, with its interval if runs scatter.
fn moved_text(moved: Moved) -> String {
    let Moved { value, low, high } = moved;
    match low < high {
        true => format!(
            "{} ({} to {})",
            number(value, 4),
            number(low, 4),
            number(high, 4)
        ),
        false => number(value, 4),
    }
}

/// The result for the terminal.
pub fn answer(read: &FitFile, tests: &Tests, found: &SearchResult, outcome: &Outcome) -> String {
    let known = &outcome.identification;
    let mut out = format!(
        "{} points, search ended: {}\n",
        found.evaluations.len(),
        found.ended
    );
    for (e, p) in known.estimates.iter().zip(&read.spec.parameters) {
        let _ = writeln!(out, "  {:<16} {}", e.name, value_text(e, &p.shown_unit()));
    }
    let _ = writeln!(
        out,
        "  with intervals of 95 %; sum of squares {} for {} measured values",
        number(
            found.evaluations[outcome.best]
                .chi_squared
                .unwrap_or(known.chi_squared),
            4
        ),
        tests.target.measured().len()
    );
    for line in verdict(read, found, outcome) {
        let _ = writeln!(out, "  {line}");
    }
    out.trim_end().to_owned()
}

/// Returns the axes of a test, of abscissae and of values. Those of a curve are called as its file
/// heads the columns, with their units.
fn axes(read: &FitFile, tests: &Tests, test: usize) -> [Axis; 2] {
    match &read.spec.tests[test] {
        TestSpec::Curve { measured, .. } => {
            let file = read.beside(&measured.file);
            [&measured.x, &measured.y].map(|column| Axis::new(heading(&file, column), ""))
        }
        TestSpec::Value { output, .. } => {
            let unit = crate::runs::unit::heading(&tests.units[test].value);
            [Axis::new("", ""), Axis::new(output, unit)]
        }
    }
}

/// Measured and fitted points of a test: positions, measured values, standard deviations, fitted
/// values, scatter of one run.
type TestPoints = Vec<(f64, f64, f64, f64, f64)>;

fn points(tests: &Tests, found: &SearchResult, outcome: &Outcome) -> Vec<TestPoints> {
    let (mean, deviation) = mean_of(&found.evaluations[outcome.best]).unwrap_or_default();
    let mut place = 0;
    let of = |test: &fretwork_math::fit::residuals::Measurement| {
        let mut points: TestPoints = Vec::new();
        for j in 0..test.x.len() {
            let fitted = mean.get(place).copied().unwrap_or(f64::NAN);
            let scatter = deviation
                .as_ref()
                .and_then(|d| d.get(place))
                .copied()
                .unwrap_or(f64::NAN);
            points.push((test.x[j], test.y[j], test.sigma[j], fitted, scatter));
            place += 1;
        }
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        points
    };
    tests.target.tests().iter().map(of).collect()
}

/// The page of a fit.
pub fn sheet(read: &FitFile, tests: &Tests, found: &SearchResult, outcome: &Outcome) -> Sheet {
    let known = &outcome.identification;
    let figures = charts(read, tests, found, outcome).into_iter();
    let figures = figures.map(|chart| Block::Figure(Box::new(chart)));
    let made = format!("Made by fretwork {}.", env!("CARGO_PKG_VERSION"));
    let text = read.source.text().to_owned();
    let sections = vec![
        section("Parameters", parameter_blocks(read, found, outcome)),
        section("Curves", figures.collect()),
        section("Search", search_blocks(found)),
        section("The fit", vec![Block::Text(made), Block::Code(text)]),
    ];
    let state = match (
        known.describes,
        known.directions.iter().all(|d| d.determined),
    ) {
        (true, true) => "The model describes the measurements, which determine all parameters.",
        (true, false) => {
            "The model describes the measurements, which do not determine all parameters."
        }
        (false, _) => "The model does not describe the measurements within their errors.",
    };
    Sheet {
        title: title(read),
        lead: state.to_owned(),
        sections,
        command: "fretwork fit".to_owned(),
    }
}

fn parameter_blocks(read: &FitFile, found: &SearchResult, outcome: &Outcome) -> Vec<Block> {
    let known = &outcome.identification;
    let names = read.spec.names();
    let rows = known
        .estimates
        .iter()
        .zip(&read.spec.parameters)
        .enumerate()
        .map(|(i, (e, p))| {
            let half = match &outcome.half_step {
                Some(HalfStep::Moves { parameters, .. }) => {
                    parameters[i].map_or("-".to_owned(), moved_text)
                }
                _ => String::new(),
            };
            let both = format!(
                "{} to {}",
                number(e.simultaneous.low, 4),
                number(e.simultaneous.high, 4)
            );
            vec![
                e.name.clone(),
                value_text(e, &p.shown_unit()),
                both,
                half,
                {
                    let [low, high] = p.limits();
                    format!("{low} to {high} {}", p.shown_unit())
                },
            ]
        });
    let note = "Values with intervals of 95 % for each parameter alone, and such that all of them hold at once in 95 %.";
    let heads = [
        "parameter",
        "value",
        "all at once",
        "with half the step",
        "range of the search",
    ];
    let mut blocks = vec![table(note, heads, rows.collect())];
    let sentences = verdict(read, found, outcome);
    if !sentences.is_empty() {
        blocks.push(Block::List(sentences));
    }
    if names.len() > 1 {
        let cell = |r: &Option<f64>| r.map_or(String::new(), |r| format!("{r:.2}"));
        let rows = names.iter().zip(&known.correlation).map(|(name, row)| {
            std::iter::once((*name).to_owned())
                .chain(row.iter().map(cell))
                .collect()
        });
        let heads = std::iter::once("").chain(names.iter().copied());
        let note = "Correlations of the errors of the parameters.";
        blocks.push(table(note, heads, rows.collect()));
        let rows = known.directions.iter().map(|d| {
            let width = d.half_width.map_or("no limit".to_owned(), |h| {
                format!("± {:.2} % of the range", 100.0 * h)
            });
            let known = if d.determined {
                "determined"
            } else {
                "not determined"
            };
            vec![d.words(&names), width, known.to_owned()]
        });
        let note = "Combinations of parameters, the best known first, in shares of their ranges.";
        blocks.push(table(note, ["together", "known to", ""], rows.collect()));
    }
    blocks
}

fn search_blocks(found: &SearchResult) -> Vec<Block> {
    let mut least = f64::INFINITY;
    let mut points = Vec::new();
    let mut best = Vec::new();
    for (k, e) in found.evaluations.iter().enumerate() {
        if let Some(x) = e.chi_squared {
            least = least.min(x);
            points.push(((k + 1) as f64, x.max(1e-12).log10()));
            best.push(((k + 1) as f64, least.max(1e-12).log10()));
        }
    }
    let failed = found.failed();
    let x = Axis::new("evaluation", "").whole();
    let y = Axis::new("log10 of the sum of squares", "");
    let chart = Chart::new("Sum of squares", x, y)
        .note("Of each point in the order of the search (logarithm to base 10), and the least so far.")
        .with(Series::new("a point", points).style(Style::Markers))
        .with(Series::new("least so far", best));
    vec![
        Block::Text(format!(
            "{} points were run, {failed} of which failed. The search ended: {}.",
            found.evaluations.len(),
            found.ended
        )),
        Block::Figure(Box::new(chart)),
    ]
}

/// Returns charts of the measured and fitted curves of each test, with two standard deviations.
fn charts(read: &FitFile, tests: &Tests, found: &SearchResult, outcome: &Outcome) -> Vec<Chart> {
    let all = points(tests, found, outcome).into_iter().enumerate();
    let chart = |(t, points): (usize, TestPoints)| {
        let [x, y] = axes(read, tests, t);
        let name = tests.target.tests()[t].name.clone();
        type Bar = (f64, f64, f64, f64, f64);
        let bars = |of: fn(&Bar) -> [f64; 2]| {
            let ends = points
                .iter()
                .map(of)
                .map(|[y, s]| (y - 2.0 * s, y + 2.0 * s));
            ends.collect()
        };
        let measured = Series::new("measured", points.iter().map(|p| (p.0, p.1)).collect())
            .style(Style::Markers)
            .intervals(bars(|p| [p.1, p.2]));
        let fitted = Series::new("fitted", points.iter().map(|p| (p.0, p.3)).collect())
            .intervals(bars(|p| [p.3, p.4]));
        let mut chart = Chart::new(name, x, y)
            .note("Bars are two standard deviations: of the measurement, and of one run from seed to seed.");
        chart.subtitle = Some(format!(
            "{}: measured, and fitted (mean over seeds)",
            title(read)
        ));
        chart.with(measured).with(fitted)
    };
    all.map(chart).collect()
}

/// Draws measured and fitted curves.
///
/// # Errors
/// The file cannot be written.
pub fn draw(
    read: &FitFile,
    tests: &Tests,
    found: &SearchResult,
    outcome: &Outcome,
    path: &Path,
) -> Result<(), DrawError> {
    let charts = charts(read, tests, found, outcome);
    draw_panels(&charts, charts.len().min(2), path)
}
