//! The tables of the laws `tabulated` from the runs of a study: friction and wear over slip, slip
//! velocity, pressure and temperature, with their intervals over seeds and inputs.
//!
//! Factors with the names of axes are the axes of the table; all other factors are inputs that are
//! not known better. A patch averages over thousands of windows, so that the scatter of one window
//! does not matter, but the error of the mean does: the interval of a point reaches from the lowest
//! to the highest end of the 95 % intervals of the means over the seeds, over all inputs.

use super::plan::Plan;
use super::rows::{Rows, status};
use super::spec::{DesignSpec, StudyFile};
use crate::Error;
use crate::factor::Factor;
use crate::runs::output::OutputName;
use crate::runs::stored::summary;
use crate::runs::window::{FrictionCourse, mean_pressure};
use crate::table::csv::{NumberFormat, write_below};
use crate::table::{Column, Table};
use fretwork_math::statistics::interval::Mean;
use fretwork_observe::quantity::{DETERMINED, number, quantity};
use fretwork_observe::summary::SlidingTest;
use fretwork_observe::wear::WearSummary;
use fretwork_scene::law_table::AXES;
use fretwork_scene::material::NumberSpec;
use fretwork_scene::{Case, InputError, units};
use serde::Deserialize;
use std::collections::BTreeMap;
use std::path::Path;

/// The tables of a study as given in its file.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LawTableSpec {
    /// The friction of a run, a name as in `outputs`.
    #[serde(default = "coefficient")]
    pub friction: String,
    /// Whether to make a table of wear, too.
    #[serde(default)]
    pub wear: bool,
    /// Ends of the parts of the path of slip of each run (m), over which friction and wear are
    /// told apart; without them a run has one value.
    #[serde(default)]
    pub slip: Vec<NumberSpec>,
}

fn coefficient() -> String {
    SlidingTest::COEFFICIENT.to_owned()
}

/// Difference of the pressure of a window from that of its factor, over the latter, above which
/// they are not the same.
const PRESSURE: f64 = 0.05;
/// Share of a part of the path of slip that a run may lack.
const SHORT: f64 = 0.01;

/// The tables that a study makes.
#[derive(Clone, Debug)]
pub struct LawTable {
    friction: OutputName,
    wear: bool,
    slip: Vec<f64>,
    /// The factor of each axis.
    axes: [Option<usize>; AXES.len()],
}

/// A quantity of a table: its column, unit and file.
type Quantity = (&'static str, &'static str, &'static str);
const FRICTION: Quantity = ("friction", "1", "law_friction.csv");
const RATE: Quantity = ("k", "1/Pa", "law_wear.csv");

impl LawTable {
    /// Reads what the file of a study asks for; `units` are those of its factors.
    ///
    /// # Errors
    /// The table has no axis, or an axis is not in its unit; located in the file.
    pub fn new(
        read: &StudyFile,
        factors: &[Factor],
        units: &[String],
        case: &Case,
    ) -> Result<Option<Self>, InputError> {
        let Some(spec) = &read.spec.table else {
            return Ok(None);
        };
        let fail = |path: &str, why: String| Err(read.source.error_at(path, why));
        if !matches!(
            read.spec.design,
            DesignSpec::Grid | DesignSpec::Table { .. }
        ) {
            let why = "the table of a law has all combinations of the points of its axes: take the design `Grid`, with `levels`";
            return fail("design", why.to_owned());
        }
        let axes = AXES.map(|(name, _)| factors.iter().position(|f| f.name == name));
        for (k, (name, unit)) in axes.iter().zip(AXES) {
            let Some(k) = *k else { continue };
            let own = units[k].as_str();
            if !own.is_empty() && units::convert(1.0, own, unit) != Ok(1.0) {
                let why = format!(
                    "the axis `{name}` of a table is in `{unit}`, and the factor in `{own}`"
                );
                return fail(&format!("factors.{k}"), why);
            }
        }
        let mut slip = Vec::new();
        for (k, end) in spec.slip.iter().enumerate() {
            let path = format!("table.slip.{k}");
            let unit = end.unit.as_deref().unwrap_or_default();
            let value = units::convert(end.value, unit, "m");
            slip.push(value.map_err(|e| read.source.error_at(&path, e.message))?);
        }
        if !slip.is_empty() {
            let rises = slip[0] >= 0.0 && slip.windows(2).all(|w| w[0] < w[1]);
            if slip.len() < 2 || !rises {
                let why = "two or more paths of slip are expected, each longer than the one before, such as [0, 5 um, 20 um]";
                return fail("table.slip", why.to_owned());
            }
            if axes[0].is_some() {
                let why = "a factor is the slip, too: leave one of them out";
                return fail("table.slip", why.to_owned());
            }
            if spec.friction != SlidingTest::COEFFICIENT || case.friction.is_none() {
                let why = "parts of the path of slip are those of the case's friction test: give the case `friction`, and leave `table.friction` out";
                return fail("table.slip", why.to_owned());
            }
        } else if axes.iter().all(Option::is_none) {
            let names = AXES.map(|(name, _)| name).join(", ");
            return fail(
                "table",
                format!(
                    "the table has no axis: name a factor {names}, or give `slip`, the ends of parts of the path of each run"
                ),
            );
        }
        let friction = OutputName::parse(&spec.friction);
        Ok(Some(Self {
            friction: friction.map_err(|why| read.source.error_at("table.friction", why))?,
            wear: spec.wear,
            slip,
            axes,
        }))
    }

    /// The numbers of runs that the tables are made of, with their keys in the file of the study.
    pub fn outputs(&self) -> Vec<(&'static str, OutputName)> {
        let wear = self.wear.then_some("table.wear");
        let wear = wear.and_then(|key| Some((key, OutputName::parse(WearSummary::RATE).ok()?)));
        let mut all = vec![("table.friction", self.friction.clone())];
        all.extend(wear);
        all
    }

    /// Writes the tables into the folder of the study; returns a line for each, with its file or
    /// why there is none.
    ///
    /// # Errors
    /// A file cannot be written.
    pub fn write(&self, plan: &Plan, rows: &Rows) -> Result<Vec<String>, Error> {
        let mut lines = Vec::new();
        let wear = self.wear.then_some(RATE);
        for what in [FRICTION].into_iter().chain(wear) {
            let path = plan.out.join(what.2);
            match self.table(plan, rows, what) {
                Ok(table) => {
                    let head = self.head(plan, rows, what);
                    write_below(&head, &table, &path, NumberFormat::Exponents)?;
                    lines.push(path.display().to_string());
                }
                Err(why) => {
                    // That of an earlier state would be taken for one of these runs.
                    let _ = std::fs::remove_file(&path);
                    lines.push(format!("no {} for the law `tabulated`: {why}", what.2));
                }
            }
        }
        Ok(lines)
    }

    /// Returns what a table was made from.
    fn head(&self, plan: &Plan, rows: &Rows, what: Quantity) -> Vec<String> {
        let name = |path: &Path| {
            path.file_name()
                .unwrap_or_default()
                .to_string_lossy()
                .into_owned()
        };
        let inputs = plan.factors.iter().enumerate();
        let inputs = inputs.filter(|(k, _)| !self.axes.contains(&Some(*k)));
        let inputs: Vec<String> = inputs
            .map(|(k, f)| format!("{} {}", f.name, plan.labels(k).join(", ")))
            .collect();
        let first = plan.seeds.first().copied().unwrap_or_default();
        let mut head = vec![
            format!(
                "{} for the law `tabulated`, by fretwork {}",
                what.0,
                env!("CARGO_PKG_VERSION")
            ),
            format!(
                "study {}, case {}: {}",
                name(&plan.file),
                name(&plan.launcher.case),
                plan.base.case.name
            ),
            format!(
                "digest of case and program: {}",
                plan.launcher.fingerprint()
            ),
            match self.has_interval(plan) {
                true => {
                    let seeds = match plan.seeds.len() {
                        1 => "one seed".to_owned(),
                        n => format!("95 % of the mean over {n} seeds from {first}"),
                    };
                    let of = match inputs.is_empty() {
                        true => String::new(),
                        false => format!(", the lowest and the highest of {}", inputs.join("; ")),
                    };
                    format!("interval: {seeds}{of}")
                }
                false => "no interval: each point is one run".to_owned(),
            },
        ];
        if rows.doubted() > 0 {
            head.push(format!(
                "{} of {} runs are not trustworthy, table.csv of the study says why",
                rows.doubted(),
                plan.count()
            ));
        }
        head
    }

    fn has_interval(&self, plan: &Plan) -> bool {
        let inputs = (0..plan.factors.len()).any(|k| !self.axes.contains(&Some(k)));
        inputs || plan.seeds.len() > 1
    }

    /// Returns a table, or why there is none.
    fn table(&self, plan: &Plan, rows: &Rows, what: Quantity) -> Result<Table, String> {
        // A point of the axes as bits, whose order is that of numbers that are not negative.
        let mut points: BTreeMap<Vec<u64>, Vec<Vec<Mean>>> = BTreeMap::new();
        for (setting, levels) in plan.settings.iter().enumerate() {
            let mut of_seeds = Vec::new();
            for k in 0..plan.seeds.len() {
                let index = setting * plan.seeds.len() + k;
                let values = self.of_run(plan, rows, index, what);
                of_seeds.push(values.map_err(|why| {
                    let words = plan.point(index + 1).map(|p| plan.words(&p));
                    format!("run {} ({}) {why}", index + 1, words.unwrap_or_default())
                })?);
            }
            let parts = of_seeds[0].len();
            let means = (0..parts).map(|part| {
                let values: Vec<f64> = of_seeds.iter().map(|v| v[part]).collect();
                self.mean(plan, setting, part, &values, what)
            });
            let means: Vec<Mean> = means.collect::<Result<_, _>>()?;
            let at = |k: &Option<usize>| k.and_then(|k| levels[k].number);
            let point = self.axes.iter().map(|k| at(k).unwrap_or(0.0).to_bits());
            points.entry(point.collect()).or_default().push(means);
        }
        let mut lines: Vec<[f64; AXES.len() + 3]> = Vec::new();
        for (point, inputs) in &points {
            for (part, slip) in self.parts() {
                let own = || inputs.iter().map(|means| &means[part]);
                let half = |m: &Mean| m.half_width.unwrap_or(0.0);
                let mean = own().map(|m| m.mean).sum::<f64>() / inputs.len() as f64;
                let low = own()
                    .map(|m| m.mean - half(m))
                    .fold(f64::INFINITY, f64::min);
                let high = own().map(|m| m.mean + half(m)).fold(0.0, f64::max);
                let mut line = [0.0; AXES.len() + 3];
                for (to, from) in line.iter_mut().zip(point) {
                    *to = f64::from_bits(*from);
                }
                if let Some(slip) = slip {
                    line[0] = slip;
                }
                line[AXES.len()..].copy_from_slice(&[mean, low.max(0.0), high]);
                lines.push(line);
            }
        }
        let mut columns = Vec::new();
        for (k, (name, unit)) in AXES.into_iter().enumerate() {
            if self.axes[k].is_some() || (k == 0 && !self.slip.is_empty()) {
                columns.push(Column::real(name, unit, lines.iter().map(|l| Some(l[k]))));
            }
        }
        let ends = ["", "_low", "_high"].into_iter().enumerate();
        for (k, end) in ends.take(if self.has_interval(plan) { 3 } else { 1 }) {
            let values = lines.iter().map(|l| Some(l[AXES.len() + k]));
            columns.push(Column::real(format!("{}{end}", what.0), what.1, values));
        }
        Ok(Table { columns })
    }

    /// Returns the parts of a run, each with its place on the axis of slip: the middles of the
    /// parts, and both ends of the path, so that the table contains all of it.
    fn parts(&self) -> Vec<(usize, Option<f64>)> {
        let Some(last) = self.slip.len().checked_sub(2) else {
            return vec![(0, None)];
        };
        let middle = |k: usize| 0.5 * (self.slip[k] + self.slip[k + 1]);
        let middles = (0..=last).map(|k| (k, Some(middle(k))));
        let mut all = vec![(0, Some(self.slip[0]))];
        all.extend(middles);
        all.push((last, Some(self.slip[last + 1])));
        all
    }

    /// Returns the mean over the seeds of a setting.
    fn mean(
        &self,
        plan: &Plan,
        setting: usize,
        part: usize,
        values: &[f64],
        what: Quantity,
    ) -> Result<Mean, String> {
        let mean = Mean::of(values).ok_or("there is no seed")?;
        match mean.half_width {
            Some(half) if half > DETERMINED * mean.mean => {
                let factors = plan.factors.iter().zip(&plan.settings[setting]);
                let mut at: Vec<String> = factors
                    .map(|(f, level)| format!("{} {}", f.name, level.short()))
                    .collect();
                if !self.slip.is_empty() {
                    let ends = [part, part + 1].map(|k| quantity(self.slip[k], "m"));
                    at.push(format!("slip {} to {}", ends[0], ends[1]));
                }
                Err(format!(
                    "at {} the {} is not determined, {} +- {} over {} seeds: take more of them, longer runs, or longer parts of the slip",
                    at.join(", "),
                    what.0,
                    number(mean.mean, 3),
                    number(half, 2),
                    mean.count
                ))
            }
            _ => Ok(mean),
        }
    }

    /// Returns the values of a run, one for each part of its slip, or why there are none, as the
    /// end of a sentence that begins with the run.
    fn of_run(
        &self,
        plan: &Plan,
        rows: &Rows,
        index: usize,
        what: Quantity,
    ) -> Result<Vec<f64>, String> {
        let point = plan.point(index + 1).ok_or("is none of the study")?;
        let place = plan.launcher.place(&point.run);
        if !rows.is_done(index) {
            let run = plan.launcher.ended_in(&place);
            let (word, why) = status(run.as_ref());
            let sep = if why.is_empty() { "" } else { ": " };
            return Err(format!("is {word}{sep}{why}"));
        }
        if let Some(pressure) = self.axes[2] {
            let wanted = plan.settings[point.setting - 1][pressure].number;
            let found = mean_pressure(&plan.base.case, &place);
            if let Some((wanted, found)) = wanted.zip(found)
                && (found / wanted - 1.0).abs() > PRESSURE
            {
                return Err(format!(
                    "is under {} in the mean, and its factor `pressure` is {}: let the load of the window follow it by `set`",
                    quantity(found, "Pa"),
                    quantity(wanted, "Pa")
                ));
            }
        }
        if !self.slip.is_empty() {
            let start = plan.base.case.friction.as_ref().map_or(0.0, |t| t.start);
            let course =
                FrictionCourse::read(&place, start).ok_or("has no course of its friction test")?;
            return parts_of(&course, &self.slip, what == RATE);
        }
        let output = match what {
            RATE => OutputName::parse(WearSummary::RATE)?,
            _ => self.friction.clone(),
        };
        let value = output.read(&summary(&place), &place);
        let value = value.ok_or_else(|| format!("has no `{}`", output.name))?;
        Ok(vec![value.abs()])
    }
}

/// Returns the work of friction over load and slip in each part of the path between two of
/// `ends` (m), or the volume worn off in it; or why there is none, as the end of a sentence.
fn parts_of(course: &FrictionCourse, ends: &[f64], wear: bool) -> Result<Vec<f64>, String> {
    let mut sums = vec![[0.0; 3]; ends.len() - 1];
    let mut path = 0.0;
    for k in 1..course.delta.len() {
        let moved = course.delta[k] - course.delta[k - 1];
        let next = path + moved.abs();
        let middle = |of: &[f64]| 0.5 * (of[k] + of[k - 1]);
        let work = match wear {
            true => course
                .worn
                .get(k)
                .zip(course.worn.get(k - 1))
                .map_or(0.0, |(b, a)| b - a),
            false => middle(&course.tangential) * moved,
        };
        let load = middle(&course.normal) * moved.abs();
        for (part, sum) in ends.windows(2).zip(&mut sums) {
            let within = next.min(part[1]) - path.max(part[0]);
            if within > 0.0 {
                let share = within / moved.abs();
                *sum = [
                    sum[0] + share * work,
                    sum[1] + share * load,
                    sum[2] + within,
                ];
            }
        }
        path = next;
    }
    let of = |(part, [work, load, within]): (&[f64], &[f64; 3])| {
        if *within < (1.0 - SHORT) * (part[1] - part[0]) {
            return Err(format!(
                "slips by {}, and `table.slip` goes on to {}",
                quantity(path, "m"),
                quantity(part[1], "m")
            ));
        }
        let value = work / load;
        match value.is_finite() && value >= 0.0 {
            true => Ok(value),
            false => Err(format!(
                "has {} from {} to {} of its slip: take longer parts",
                if wear { "no wear" } else { "no friction" },
                quantity(part[0], "m"),
                quantity(part[1], "m")
            )),
        }
    };
    ends.windows(2).zip(&sums).map(of).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A slider on a spring reaches its friction after a slip of mu P/k, so that the work up to
    /// there is half of that of friction.
    #[test]
    fn friction_over_slip_is_the_work_over_load_and_slip() {
        let (mu, load, elastic) = (0.4, 5.0, 2e-6);
        let delta: Vec<f64> = (0..=100).map(|k| 1e-7 * f64::from(k)).collect();
        let q = |d: &f64| mu * load * (d / elastic).min(1.0);
        let course = FrictionCourse {
            tangential: delta.iter().map(q).collect(),
            normal: vec![load; delta.len()],
            worn: delta.iter().map(|d| 3e-13 * load * d).collect(),
            delta,
            ..FrictionCourse::default()
        };
        let ends = [0.0, 2e-6, 5.05e-6, 9e-6];
        let got = parts_of(&course, &ends, false).unwrap();
        for (got, expected) in got.iter().zip([0.5 * mu, mu, mu]) {
            assert!((got - expected).abs() < 1e-12, "{got} {expected}");
        }
        let worn = parts_of(&course, &ends, true).unwrap();
        assert!(
            worn.iter().all(|k| (k / 3e-13 - 1.0).abs() < 1e-9),
            "{worn:?}"
        );
        let short = parts_of(&course, &[0.0, 2e-5], false).unwrap_err();
        assert!(short.contains("slips by 10.00 um"), "{short}");
    }
}
