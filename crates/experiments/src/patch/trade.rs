//! Accuracy against cost of a patch: its methods and numbers of cells, each compared with the
//! finest grid of half-spaces.
//!
//! Errors of adhesion, force, energy and T gamma are relative to the value of a point, those of a
//! moment to the largest one of all points, since it may pass through 0. Of several points the
//! largest error counts.

use super::PatchFile;
use super::answer::{Motion, Point};
use super::fretting;
use super::method::{Method, Rung};
use super::rolling::{self, pulling};
use super::setup::Setup;
use super::spec::{MotionSpec, one_load};
use crate::Error;
use crate::duration::seconds;
use crate::table::csv::{self, NumberFormat};
use crate::table::{Column, Table};
use crate::trade::frontier::frontier;
use fretwork_core::laws::SearchPath;
use fretwork_observe::quantity::{number, quantity};
use serde::Serialize;
use std::fmt::Write as _;
use std::path::Path;
use std::time::{Duration, Instant};

/// Cells along each side of the grids that are compared.
pub const CELLS: [usize; 5] = [16, 32, 48, 96, 192];
/// Duration up to which a setting is solved again, since short ones are hard to time (s).
const SHORT: f64 = 0.2;
/// Growth of the cost with the number of cells along a side, at least, before it is measured.
const GROWTH: f64 = 2.0;
/// Moment over load and extent of the grid below which it is rounding, and is not compared.
const ROUNDING: f64 = 1e-6;

/// A trade of a patch.
#[derive(Debug, Serialize)]
pub struct PatchTrade {
    /// Title of the patch.
    pub name: String,
    /// Outputs that are compared.
    pub outputs: Vec<&'static str>,
    /// Wanted error, relative.
    pub wanted: f64,
    /// Settings, from the cheapest.
    pub settings: Vec<Setting>,
    /// Method and cells that were not tried, with the reason.
    pub left_out: Vec<String>,
    /// Error of the reference itself by output: the change from the next coarser grid.
    pub own: Vec<f64>,
}

/// A method on a grid.
#[derive(Clone, Debug, Serialize)]
pub struct Setting {
    /// The method.
    pub method: Method,
    /// Cells along each side.
    pub cells: usize,
    /// Time of all points (s).
    pub seconds: f64,
    /// Cost of the reference over that of this one.
    pub faster: f64,
    /// Largest error over the points, by output; that of the reference is its own.
    pub errors: Vec<f64>,
    /// The error with that of the reference, by output.
    pub at_most: Vec<f64>,
    /// Whether no other setting is cheaper with a smaller error, by output.
    pub on_frontier: Vec<bool>,
    /// Whether the others are compared with it.
    pub reference: bool,
    /// Values of the outputs, point by point.
    #[serde(skip)]
    values: Vec<Vec<f64>>,
}

impl Setting {
    fn name(&self) -> String {
        let cells = format!("{}, {} cells", self.method.name(), self.cells);
        match self.method {
            Method::ClosedForm => self.method.name().to_owned(),
            _ => cells,
        }
    }
}

/// Runs the trade of a patch for a wanted error on grids of some cells along each side: no setting
/// begins that is expected to take longer than `limit`. `follow` gets the name of each setting that
/// begins.
///
/// # Errors
/// A law fails, a point has no solution on the grids, or the patch has windows of a third body.
pub fn run(
    file: &mut PatchFile,
    search: &SearchPath,
    (wanted, grids): (f64, &[usize]),
    limit: Duration,
    follow: &mut dyn FnMut(&str),
) -> Result<PatchTrade, Error> {
    if file.spec.third_body.is_some() {
        let why = "a trade compares grids and methods under one law: leave out the `third_body`";
        return Err(file.source.error_at("third_body", why).into());
    }
    one_load(file, "a trade")?;
    let mut settings: Vec<Setting> = Vec::new();
    let mut left_out = Vec::new();
    let mut arm = 0.0;
    file.spec.passages = None;
    for method in Method::ALL {
        file.spec.method = method;
        let mut tried: Vec<(f64, f64)> = Vec::new();
        for cells in grids.iter().copied() {
            file.spec.cells = cells;
            let name = format!("{}, {cells} cells", method.name());
            let expected = expected(&tried, cells as f64);
            if expected > limit.as_secs_f64() {
                let long = seconds(expected);
                left_out.push(format!(
                    "{name}: {long} expected, a larger --limit allows it"
                ));
                break;
            }
            follow(&name);
            let measured = match measure(file, search) {
                Ok(measured) => measured,
                Err(Error::Input(error)) if method != Method::Exact => {
                    // What to write in the file instead is not asked here.
                    let why = error.message();
                    let why = why.split("; leave out").next().unwrap_or_default();
                    left_out.push(why.to_owned());
                    break;
                }
                Err(error) => return Err(error),
            };
            tried.push((cells as f64, measured.seconds));
            arm = measured.arm;
            settings.push(Setting {
                method,
                cells,
                seconds: measured.seconds,
                faster: 1.0,
                errors: Vec::new(),
                at_most: Vec::new(),
                on_frontier: Vec::new(),
                reference: false,
                values: measured.values,
            });
            if method == Method::ClosedForm {
                break;
            }
        }
    }
    let names = names(&file.spec.motion);
    let mut out = PatchTrade {
        name: file.spec.name.clone(),
        outputs: names,
        wanted,
        settings,
        left_out,
        own: Vec::new(),
    };
    out.compare(arm);
    Ok(out)
}

/// Returns the expected cost of a number of cells along a side (s), by the last two (0 if none).
fn expected(tried: &[(f64, f64)], cells: f64) -> f64 {
    match tried {
        [] => 0.0,
        [(n, time)] => time * (cells / n).powf(GROWTH),
        [.., (n, t), (m, time)] => {
            let growth = (time / t).ln() / (m / n).ln();
            time * (cells / m).powf(growth.max(GROWTH))
        }
    }
}

/// Returns the outputs of a motion.
fn names(motion: &MotionSpec) -> Vec<&'static str> {
    match motion {
        MotionSpec::Rolling { .. } => vec!["adhesion", "moment", "T gamma"],
        MotionSpec::Pulling { .. } => vec!["creepage", "moment", "T gamma"],
        MotionSpec::Fretting(spec) => match spec.force.0.is_empty() {
            true => vec!["force", "energy"],
            false => vec!["displacement", "energy"],
        },
    }
}

/// Points of a setting.
struct Measured {
    /// Time of all points (s).
    seconds: f64,
    /// Outputs of each point.
    values: Vec<Vec<f64>>,
    /// Load times extent of the grid (N m).
    arm: f64,
}

fn measure(file: &PatchFile, search: &SearchPath) -> Result<Measured, Error> {
    let mut creepages = rolling::creepages(file)?;
    let (_, drives) = fretting::strokes(file)?;
    let mut pulls = pulling::forces(file)?;
    let mut setup = Setup::new(file, one_load(file, "a trade")?, search)?;
    setup.laws.truncate(1);
    let spin = setup.added_spin();
    creepages.iter_mut().for_each(|c| c.spin += spin);
    pulls.iter_mut().for_each(|p| p.spin += spin);
    let pulled = !pulls.is_empty();
    let solve = || -> Result<Vec<Point>, Error> {
        let mut points = Vec::new();
        for creepage in &creepages {
            points.push(rolled(&setup, creepage)?);
        }
        for pull in &pulls {
            points.push(rolled(&setup, &pulling::creepage(file, &setup, pull)?)?);
        }
        for drive in &drives {
            points.push(fretting::solve(file, &setup, drive)?.point);
        }
        Ok(points)
    };
    let started = Instant::now();
    let (mut count, mut points) = (0.0, Vec::new());
    while count == 0.0 || started.elapsed().as_secs_f64() < SHORT {
        points = solve()?;
        count += 1.0;
    }
    Ok(Measured {
        seconds: started.elapsed().as_secs_f64() / count,
        values: points.iter().map(|p| outputs(p, pulled)).collect(),
        arm: setup.load * setup.grid.extent()[0],
    })
}

fn rolled(setup: &Setup, creepage: &fretwork_rolling::Creepage) -> Result<Point, Error> {
    match &setup.rung {
        Rung::Ellipse(_) | Rung::Line(..) => rolling::closed::point(setup, creepage),
        Rung::Exact | Rung::Fastsim(_) => Ok(rolling::solve(setup, creepage)?.point),
    }
}

/// Returns the outputs of a point, in the order of their names.
fn outputs(point: &Point, pulled: bool) -> Vec<f64> {
    let moment = point.moment.unwrap_or(f64::NAN);
    match (&point.stroke, &point.motion) {
        (Some(cycle), _) if cycle.by_force => vec![cycle.displacement.value, cycle.energy.value],
        (Some(cycle), _) => vec![cycle.force.value, cycle.energy.value],
        (None, Motion::Rolling(c)) if pulled => vec![c.along, moment, point.t_gamma],
        _ => vec![point.adhesion, moment, point.t_gamma],
    }
}

impl PatchTrade {
    /// Compares all settings with the finest grid of half-spaces; outputs that are 0 are left out,
    /// moments by load times length (N m).
    fn compare(&mut self, arm: f64) {
        let Some(last) = self.settings.len().checked_sub(1) else {
            return;
        };
        let reference = self.settings[last].values.clone();
        let largest = |k: usize| reference.iter().map(|p| p[k].abs()).fold(0.0, f64::max);
        let shown = |k: usize| match self.outputs[k] {
            "moment" => largest(k) > ROUNDING * arm,
            _ => largest(k) > 0.0,
        };
        let kept: Vec<usize> = (0..self.outputs.len()).filter(|k| shown(*k)).collect();
        let off = |values: &[Vec<f64>], k: usize| {
            let pairs = values.iter().zip(&reference);
            let each = pairs.map(|(a, b)| {
                let size = match self.outputs[k] {
                    "moment" => largest(k),
                    _ => b[k].abs(),
                };
                let error = (a[k] - b[k]).abs() / size.max(f64::MIN_POSITIVE);
                // What is not known may be anything.
                if error.is_nan() { f64::INFINITY } else { error }
            });
            each.fold(0.0, f64::max)
        };
        let next = last.checked_sub(1).map(|k| &self.settings[k]);
        let next = next.filter(|s| s.method == Method::Exact);
        let of_next = |k: &usize| next.map_or(f64::INFINITY, |s| off(&s.values, *k));
        let own: Vec<f64> = kept.iter().map(of_next).collect();
        let errors: Vec<Vec<f64>> = self
            .settings
            .iter()
            .map(|s| kept.iter().map(|k| off(&s.values, *k)).collect())
            .collect();
        let cost = self.settings[last].seconds;
        for (place, (setting, errors)) in self.settings.iter_mut().zip(errors).enumerate() {
            setting.reference = place == last;
            setting.faster = cost / setting.seconds;
            setting.at_most = errors.iter().zip(&own).map(|(e, own)| e + own).collect();
            setting.errors = match setting.reference {
                true => own.clone(),
                false => errors,
            };
        }
        self.outputs = kept.iter().map(|k| self.outputs[*k]).collect();
        self.own = own;
        for k in 0..self.outputs.len() {
            let points = self.settings.iter().map(|s| (s.seconds, s.at_most[k]));
            let on = frontier(&points.collect::<Vec<_>>());
            let both = self.settings.iter_mut().zip(on);
            both.for_each(|(setting, on)| setting.on_frontier.push(on));
        }
    }

    /// Returns the cheapest setting that is within the wanted error in some outputs.
    fn cheapest(&self, outputs: &[usize]) -> Option<&Setting> {
        let within = |s: &&Setting| outputs.iter().all(|k| s.at_most[*k] <= self.wanted);
        let good = self.settings.iter().filter(within);
        good.min_by(|a, b| a.seconds.total_cmp(&b.seconds))
    }

    /// Returns the table and the verdicts.
    pub fn text(&self) -> String {
        let mut out = format!(
            "{}\n\n{:<20}  {:>9}  {:>8}",
            self.name, "setting", "cost", "faster"
        );
        for name in &self.outputs {
            let _ = write!(out, "  {:>14}", format!("{name} (%)"));
        }
        for setting in &self.settings {
            let time = quantity(setting.seconds, "s");
            let _ = write!(
                out,
                "\n{:<20}  {time:>9}  {:>8}",
                setting.name(),
                number(setting.faster, 3)
            );
            for (error, on) in setting.errors.iter().zip(&setting.on_frontier) {
                let mark = if *on { "*" } else { " " };
                let own = if setting.reference { "own " } else { "" };
                let _ = write!(
                    out,
                    "  {:>14}",
                    format!("{own}{} {mark}", three(100.0 * error))
                );
            }
        }
        out += "\n* on the frontier: no other setting is cheaper with a smaller error\n";
        let all: Vec<usize> = (0..self.outputs.len()).collect();
        let each = all.iter().map(|k| (self.outputs[*k].to_owned(), vec![*k]));
        let together = (all.len() > 1).then(|| ("all of them".to_owned(), all.clone()));
        for (name, places) in each.chain(together) {
            let wanted = three(100.0 * self.wanted);
            let verdict = match self.cheapest(&places) {
                Some(s) => format!(
                    "{}, {} times faster than the reference, at most {} % with its own error: `{}`",
                    s.name(),
                    number(s.faster, 3),
                    three(100.0 * places.iter().map(|k| s.at_most[*k]).fold(0.0, f64::max)),
                    s.keys()
                ),
                None => "no setting can be shown to be within it".to_owned(),
            };
            let _ = write!(out, "\n{wanted} % on {name}: {verdict}");
        }
        for why in &self.left_out {
            let _ = write!(out, "\nnot used: {why}");
        }
        out
    }

    /// Writes `trade.csv` and `trade.json` into a folder; returns the JSON.
    ///
    /// # Errors
    /// A file cannot be written.
    pub fn write(&self, out: &Path) -> Result<String, Error> {
        let settings = || self.settings.iter();
        let mut columns = vec![
            Column::text("method", settings().map(|s| s.method.name().to_owned())),
            Column::whole("cells", settings().map(|s| Some(s.cells as f64))),
            Column::real("seconds", "s", settings().map(|s| Some(s.seconds))),
            Column::real("faster", "1", settings().map(|s| Some(s.faster))),
        ];
        for (k, name) in self.outputs.iter().enumerate() {
            let name = name.replace(' ', "_").to_lowercase();
            let of = |pick: fn(&Setting) -> &[f64]| settings().map(move |s| Some(pick(s)[k]));
            columns.push(Column::real(
                format!("{name}_error"),
                "1",
                of(|s| &s.errors),
            ));
            columns.push(Column::real(
                format!("{name}_at_most"),
                "1",
                of(|s| &s.at_most),
            ));
            let on = settings().map(|s| Some(f64::from(u8::from(s.on_frontier[k]))));
            columns.push(Column::whole(format!("{name}_on_frontier"), on));
        }
        csv::write(
            &Table { columns },
            &out.join("trade.csv"),
            NumberFormat::Plain,
        )?;
        let json = serde_json::to_string_pretty(self).map_err(|e| Error::Failed(e.to_string()))?;
        let path = out.join("trade.json");
        std::fs::write(&path, &json).map_err(|e| Error::write(&path, &e))?;
        Ok(json)
    }
}

impl Setting {
    /// Returns the keys of a file that solves a patch so.
    fn keys(&self) -> String {
        match self.method {
            Method::ClosedForm => "method: ClosedForm".to_owned(),
            method => format!("method: {}, cells: {}", method.name(), self.cells),
        }
    }
}

/// Formats an error with two or three significant digits.
fn three(x: f64) -> String {
    match x {
        x if !x.is_finite() => "none".to_owned(),
        x if x >= 100.0 => format!("{x:.0}"),
        x if x >= 1.0 => format!("{x:.1}"),
        x if x >= 0.01 => format!("{x:.3}"),
        _ => format!("{x:.1e}"),
    }
}
