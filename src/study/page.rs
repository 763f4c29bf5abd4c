//! The page of a study, `study.html`.

use super::analysis::{Analysis, Contest, Effects, OutputAnalysis, RegimeMap, Response};
use super::plan::Plan;
use super::table::{Cell, Table};
use fretwork_observe::quantity::{number, quantity};
use fretwork_report::{Block, Section, Sheet, SheetCurve, SheetFigure, SheetTable};
use fretwork_study::interval::{Interval, Mean};

/// Settings that a page lists; all are in the tables.
const LISTED: usize = 100;
/// Failed runs that a page lists.
const FAILURES: usize = 30;

/// The page of a study.
pub fn sheet(plan: &Plan, table: &Table, analysis: &Analysis) -> Sheet {
    let counts = table.counts();
    let mut sections = Vec::new();
    for output in &analysis.outputs {
        sections.push(output_section(plan, output));
    }
    if !analysis.regimes.is_empty() {
        let figures = analysis
            .regimes
            .iter()
            .map(|m| Block::Figure(regime_figure(plan, m)));
        sections.push(Section {
            title: "Regimes".to_owned(),
            blocks: figures.collect(),
        });
    }
    sections.push(settings_section(plan, analysis));
    sections.push(runs_section(table));
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
    for contest in &output.contests {
        blocks.push(Block::Table(contest_table(contest, &output.unit)));
        blocks.push(Block::Table(pair_table(contest, &output.unit)));
    }
    blocks.extend(
        output
            .responses
            .iter()
            .map(|r| Block::Figure(response_figure(plan, output, r))),
    );
    blocks.extend(effect_blocks(plan, output));
    Section {
        title: title_of(&output.name),
        blocks,
    }
}

/// A name as a heading.
pub(super) fn title_of(name: &str) -> String {
    name.trim_start_matches("measures.")
        .trim_start_matches("statistics.")
        .replace('_', " ")
}

fn response_figure(plan: &Plan, output: &OutputAnalysis, response: &Response) -> SheetFigure {
    let factor = &plan.factors[response.factor];
    let interval = |m: &Mean| match m.half_width {
        Some(h) => (m.mean - h, m.mean + h),
        None => (f64::NAN, f64::NAN),
    };
    let curve = |c: &super::analysis::Curve| SheetCurve {
        label: if c.label.is_empty() {
            title_of(&output.name)
        } else {
            c.label.clone()
        },
        points: c.points.iter().map(|(x, m)| (*x, m.mean)).collect(),
        intervals: c.points.iter().map(|(_, m)| interval(m)).collect(),
        line: !response.scattered,
        markers: true,
    };
    SheetFigure {
        title: format!("{} over {}", title_of(&output.name), factor.name),
        note: response.note.clone(),
        x: (factor.name.clone(), plan.unit_of(response.factor)),
        y: (title_of(&output.name), output.unit.clone()),
        curves: response.curves.iter().map(curve).collect(),
    }
}

fn regime_figure(plan: &Plan, map: &RegimeMap) -> SheetFigure {
    let name = |f: usize| plan.factors[f].name.clone();
    let (first, second) = map.axes;
    let curves = map.regimes.iter().map(|(regime, points)| SheetCurve {
        label: regime.clone(),
        points: points
            .iter()
            .filter(|p| p.share >= 0.5)
            .map(|p| (p.x, p.y))
            .collect(),
        markers: true,
        ..SheetCurve::default()
    });
    SheetFigure {
        title: format!("Regimes by {}", title_of(&map.name)),
        note: "The regime that at least half of the runs of a setting show; a setting without a mark shows several.".to_owned(),
        x: (name(first), plan.unit_of(first)),
        y: second.map_or((String::new(), String::new()), |f| (name(f), plan.unit_of(f))),
        curves: curves.collect(),
    }
}

fn effect_blocks(plan: &Plan, output: &OutputAnalysis) -> Vec<Block> {
    let name = |f: usize| plan.factors[f].name.clone();
    let share = |x: f64| format!("{:.1} %", 100.0 * x);
    match &output.effects {
        Effects::Nothing(why) => vec![Block::Text(format!(
            "Effects of the factors are not known: {why}."
        ))],
        Effects::Levels { effects, anova } => {
            let mut rows = Vec::new();
            for (f, effect) in effects
                .iter()
                .enumerate()
                .filter(|(_, e)| e.levels.len() > 1)
            {
                let found = anova
                    .as_ref()
                    .ok()
                    .and_then(|a| a.effects.iter().find(|e| e.factors == [f]));
                rows.push(vec![
                    name(f),
                    quantity(effect.range, &output.unit),
                    found.map_or(String::new(), |e| share(e.eta_squared)),
                    found.and_then(|e| e.p).map_or(String::new(), probability),
                ]);
            }
            let Ok(anova) = anova else {
                let why = anova.as_ref().err().cloned().unwrap_or_default();
                let note = format!("Shares of the variance are not known: {why}.");
                let heads = ["factor", "largest less smallest mean", "", ""]
                    .map(str::to_owned)
                    .to_vec();
                return vec![Block::Table(SheetTable { note, heads, rows })];
            };
            for effect in anova.effects.iter().filter(|e| e.factors.len() == 2) {
                rows.push(vec![
                    format!(
                        "{} with {}",
                        name(effect.factors[0]),
                        name(effect.factors[1])
                    ),
                    String::new(),
                    share(effect.eta_squared),
                    effect.p.map_or(String::new(), probability),
                ]);
            }
            rows.push(vec![
                "other interactions".to_owned(),
                String::new(),
                share(anova.higher),
                String::new(),
            ]);
            rows.push(vec![
                "scatter of seeds".to_owned(),
                String::new(),
                share(anova.noise_share),
                String::new(),
            ]);
            let note = "Effects: how much the mean changes over the levels of a factor, which share of the variance of all runs it explains, and how probable such a share is by chance alone (analysis of variance).";
            let heads = [
                "factor",
                "largest less smallest mean",
                "share of the variance",
                "by chance",
            ];
            vec![Block::Table(SheetTable {
                note: note.to_owned(),
                heads: heads.map(str::to_owned).to_vec(),
                rows,
            })]
        }
        Effects::FromCase(standings) => {
            let rows = standings.iter().map(|s| {
                vec![
                    name(s.factor),
                    s.label.clone(),
                    s.change
                        .as_ref()
                        .map_or("no run".to_owned(), |m| mean_text(m, &output.unit)),
                    s.change
                        .as_ref()
                        .map_or("", |m| {
                            if m.may_be_zero() {
                                "not known to differ"
                            } else {
                                "differs"
                            }
                        })
                        .to_owned(),
                ]
            });
            let note = "Changes from the case as it is, one factor at a time, with intervals of 95 % over the seeds.".to_owned();
            let heads = ["factor", "level", "change", ""]
                .map(str::to_owned)
                .to_vec();
            vec![Block::Table(SheetTable {
                note,
                heads,
                rows: rows.collect(),
            })]
        }
        Effects::Indices(indices) => {
            let index = |i: &fretwork_study::sensitivity::sobol_indices::Index| {
                format!(
                    "{:.3}{}",
                    i.value,
                    i.interval.as_ref().map_or(String::new(), range)
                )
            };
            let rows = (0..indices.first.len())
                .map(|f| vec![name(f), index(&indices.first[f]), index(&indices.total[f])]);
            let note = format!(
                "Sobol indices from {} base points ({} left out, since a run of theirs failed): the share of the variance that a factor explains alone, and with all its interactions, with intervals of 95 %. The mean is {}, the standard deviation {}.",
                indices.used,
                indices.left_out,
                quantity(indices.mean, &output.unit),
                quantity(indices.variance.sqrt(), &output.unit)
            );
            let heads = ["factor", "first-order index", "total index"]
                .map(str::to_owned)
                .to_vec();
            vec![Block::Table(SheetTable {
                note,
                heads,
                rows: rows.collect(),
            })]
        }
        Effects::Trend { regression, ranks } => {
            let mut rows = Vec::new();
            for (f, rank) in ranks.iter().enumerate() {
                let of = regression.as_ref().ok().and_then(|r| r.coefficients.get(f));
                rows.push(vec![
                    name(f),
                    of.map_or(String::new(), |c| {
                        format!(
                            "{:.3}{}",
                            c.standardised,
                            c.interval.as_ref().map_or(String::new(), range)
                        )
                    }),
                    format!(
                        "{:.3}{}",
                        rank.value,
                        rank.interval.as_ref().map_or(String::new(), range)
                    ),
                    rank.p.map_or(String::new(), probability),
                ]);
            }
            let fit = match regression {
                Ok(r) => format!(
                    "The linear trend explains {} of the variance.",
                    share(r.r_squared)
                ),
                Err(why) => format!("There is no linear trend: {why}."),
            };
            let note = format!(
                "Standardised coefficients of a linear trend, rank correlations with intervals of 95 %, and how probable such a correlation is by chance alone. {fit}"
            );
            let heads = ["factor", "coefficient", "rank correlation", "by chance"]
                .map(str::to_owned)
                .to_vec();
            vec![Block::Table(SheetTable { note, heads, rows })]
        }
    }
}

fn contest_table(contest: &Contest, unit: &str) -> SheetTable {
    let rows = contest
        .names
        .iter()
        .zip(&contest.tournament.means)
        .map(|(name, mean)| {
            vec![
                name.clone(),
                mean.as_ref()
                    .map_or("no run".to_owned(), |m| mean_text(m, unit)),
            ]
        });
    SheetTable {
        note: format!("Alternatives of {}: {}.", contest.factor, contest.over),
        heads: vec![contest.factor.clone(), "mean".to_owned()],
        rows: rows.collect(),
    }
}

fn pair_table(contest: &Contest, unit: &str) -> SheetTable {
    let rows = contest.tournament.pairs.iter().map(|pair| {
        let names = format!(
            "{} less {}",
            contest.names[pair.second], contest.names[pair.first]
        );
        let verdict = match (pair.p, pair.differs) {
            (None, _) => "one run each: not known".to_owned(),
            (_, true) => "they differ".to_owned(),
            (_, false) => match pair.seeds_needed {
                Some(n) => {
                    format!(
                        "not known to differ; {n} {} would tell a difference of this size",
                        contest.pairs
                    )
                }
                None => "not known to differ".to_owned(),
            },
        };
        vec![
            names,
            pair.difference
                .as_ref()
                .map_or(String::new(), |m| mean_text(m, unit)),
            pair.p.map_or(String::new(), probability),
            verdict,
        ]
    });
    SheetTable {
        note: "Differences, paired; probabilities by chance are adjusted for the number of pairs (Holm).".to_owned(),
        heads: ["pair", "difference", "by chance", ""].map(str::to_owned).to_vec(),
        rows: rows.collect(),
    }
}

fn settings_section(plan: &Plan, analysis: &Analysis) -> Section {
    let mut heads: Vec<String> = vec!["setting".to_owned()];
    heads.extend(plan.factors.iter().map(|f| f.name.clone()));
    heads.extend(analysis.outputs.iter().map(|o| title_of(&o.name)));
    let row = |(k, setting): (usize, &super::design::Setting)| {
        let mut row = vec![(k + 1).to_string()];
        row.extend(setting.iter().map(|v| v.label.clone()));
        row.extend(analysis.outputs.iter().map(|o| {
            o.means[k]
                .as_ref()
                .map_or("no run".to_owned(), |m| mean_text(m, &o.unit))
        }));
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
        false => "Means over the seeds, with intervals of 95 %.".to_owned(),
    };
    Section {
        title: "Settings".to_owned(),
        blocks: vec![Block::Table(SheetTable { note, heads, rows })],
    }
}

fn runs_section(table: &Table) -> Section {
    let cells = |name: &str| {
        table
            .column(name)
            .map(|c| c.cells.as_slice())
            .unwrap_or_default()
    };
    let text = |c: Option<&Cell>| match c {
        Some(Cell::Text(text)) => text.clone(),
        Some(Cell::Number(x)) => format!("{x}"),
        _ => String::new(),
    };
    let mut rows = Vec::new();
    let mut left = 0;
    for k in 0..table.rows() {
        let (status, doubt) = (
            text(cells("status").get(k)),
            text(cells("not_trustworthy").get(k)),
        );
        if [super::table::DONE, super::table::NOT_RUN].contains(&status.as_str())
            && doubt.is_empty()
        {
            continue;
        }
        if rows.len() == FAILURES {
            left += 1;
            continue;
        }
        let reason = text(cells("reason").get(k));
        rows.push(vec![
            text(cells("point").get(k)),
            status,
            reason,
            doubt,
            text(cells("folder").get(k)),
        ]);
    }
    if rows.is_empty() {
        let said = "No run failed, and none says that it is not trustworthy.".to_owned();
        return Section {
            title: "Runs".to_owned(),
            blocks: vec![Block::Text(said)],
        };
    }
    let more = if left > 0 {
        format!(" {left} more are in table.csv.")
    } else {
        String::new()
    };
    let note =
        format!("Runs that failed, were rejected, or say that they are not trustworthy.{more}");
    let heads = ["run", "status", "reason", "says", "folder"]
        .map(str::to_owned)
        .to_vec();
    Section {
        title: "Runs".to_owned(),
        blocks: vec![Block::Table(SheetTable { note, heads, rows })],
    }
}

fn inputs_section(plan: &Plan) -> Section {
    let text = std::fs::read_to_string(&plan.file).unwrap_or_default();
    Section {
        title: "The study".to_owned(),
        blocks: vec![
            Block::Text(format!(
                "Made by fretwork {}, program {}. To repeat a run by hand: fretwork study check {} --points lists the changes of each.",
                env!("CARGO_PKG_VERSION"),
                plan.launcher.program(),
                plan.file.display()
            )),
            Block::Code(text),
        ],
    }
}

/// A mean with its interval.
pub(super) fn mean_text(mean: &Mean, unit: &str) -> String {
    let value = quantity(mean.mean, unit);
    match mean.half_width {
        Some(half) => format!("{value} ± {}", quantity(half, unit)),
        None => value,
    }
}

fn range(interval: &Interval) -> String {
    format!(" ({:.3} to {:.3})", interval.low, interval.high)
}

fn probability(p: f64) -> String {
    match p {
        p if p < 1e-4 => "below 0.0001".to_owned(),
        p => number(p, 2),
    }
}
