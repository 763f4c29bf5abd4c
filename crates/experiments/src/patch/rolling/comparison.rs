//! The curve of adhesion beside that of Polach, and beside measured points or ranges.

use crate::Error;
use crate::patch::answer::{Motion, Point};
use crate::patch::columns::column;
use crate::patch::setup::Setup;
use crate::patch::spec::{PatchFile, value};
use fretwork_elastic::patch::Solid;
use fretwork_rolling::{Creepage, Polach};
use fretwork_scene::InputError;
use fretwork_scene::material::NumberSpec;
use fretwork_scene::measured::MeasuredTable;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// A curve of Polach.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum PolachSpec {
    /// His dry rail.
    Dry,
    /// His wet rail.
    Wet,
    /// Other parameters.
    Of {
        /// Coefficient of friction without slip.
        mu_0: f64,
        /// That at high velocity over it.
        a: f64,
        /// Decrease with the velocity of slip (s/m).
        b: NumberSpec,
        /// Reductions of the slope.
        k_a: f64,
        /// In the area of slip.
        k_s: f64,
    },
}

/// Measured adhesion over creepage.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MeasuredSpec {
    /// A CSV file with headings, relative to the file of the patch.
    pub file: PathBuf,
    /// What it is; the name of the file by default.
    #[serde(default)]
    pub name: Option<String>,
    /// Heading of the creepage along the rolling, or of the lower end of its range.
    #[serde(default = "creepage")]
    pub along: String,
    /// Heading of the upper end of the range.
    #[serde(default)]
    pub along_to: Option<String>,
    /// Heading of the force over the load, or of the lower end of its range.
    #[serde(default = "adhesion")]
    pub adhesion: String,
    /// Heading of the upper end of the range.
    #[serde(default)]
    pub adhesion_to: Option<String>,
}

fn creepage() -> String {
    "creepage".into()
}

fn adhesion() -> String {
    "adhesion".into()
}

/// A curve or points beside the solved curve.
#[derive(Clone, Debug, Serialize)]
pub struct Comparison {
    /// What it is.
    pub name: String,
    /// Ranges of creepage and adhesion, in order.
    pub points: Vec<MeasuredRange>,
    /// Whether they are points of a curve.
    pub curve: bool,
    /// The solved curve less these, where both are known.
    pub off: Option<Deviation>,
    /// Number of points outside the creepages that were solved.
    pub beyond: usize,
}

/// Ranges of a point; both ends are equal where it is one number.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct MeasuredRange {
    /// Creepages along the rolling.
    pub creepage: [f64; 2],
    /// Forces over the load.
    pub adhesion: [f64; 2],
}

/// Distances of the solved curve from points: 0 within a range.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Deviation {
    /// Number of points.
    pub points: usize,
    /// Mean: positive where the curve is above.
    pub mean: f64,
    /// Root of the mean square.
    pub rms: f64,
    /// The largest, with its sign.
    pub largest: f64,
    /// Creepage at which it is.
    pub at: f64,
    /// Share of the points that the band of the curve reaches.
    pub reached: f64,
}

/// Creepages of a drawn curve.
const DRAWN: usize = 60;

/// The solved curve: creepage, adhesion and its band, ascending.
struct Solved(Vec<(f64, [f64; 3])>);

impl Solved {
    fn of(points: &[Point]) -> Self {
        let mut list = Vec::new();
        for point in points {
            let Motion::Rolling(Creepage { along, .. }) = point.motion else {
                continue;
            };
            let a = point.adhesion;
            let (low, high) = match point.adhesion_band {
                Some(band) => (band.low, band.high),
                None => (a - point.adhesion_error, a + point.adhesion_error),
            };
            list.push((along.abs(), [a, low, high]));
        }
        list.sort_by(|a, b| a.0.total_cmp(&b.0));
        list.dedup_by(|a, b| a.0 == b.0);
        Self(list)
    }

    /// Returns adhesion with its band at a creepage, on straight lines between solved points.
    fn at(&self, creepage: f64) -> Option<[f64; 3]> {
        let list = &self.0;
        let exact = list.iter().find(|(x, _)| (x - creepage).abs() <= 1e-9 * x);
        if let Some((_, values)) = exact {
            return Some(*values);
        }
        let next = list.partition_point(|(x, _)| *x < creepage);
        let (before, after) = (list.get(next.checked_sub(1)?)?, list.get(next)?);
        let share = (creepage - before.0) / (after.0 - before.0);
        Some([0, 1, 2].map(|k| before.1[k] + share * (after.1[k] - before.1[k])))
    }

    /// Returns the distance of the curve from a range and whether its band reaches it, at the place
    /// of the range where it is largest.
    fn off(&self, range: &MeasuredRange) -> Option<(f64, f64, bool)> {
        let [from, to] = range.creepage;
        let places = [from, 0.5 * (from + to), to];
        let of = |x: f64| {
            let [a, low, high] = self.at(x)?;
            let away = |a: f64| {
                let [least, most] = range.adhesion;
                (a - most).max(0.0) + (a - least).min(0.0)
            };
            let reached = low <= range.adhesion[1] && high >= range.adhesion[0];
            Some((away(a), x, reached))
        };
        let all = places.into_iter().filter_map(of);
        all.max_by(|a, b| a.0.abs().total_cmp(&b.0.abs()))
    }

    fn compare(&self, points: &[MeasuredRange]) -> (Option<Deviation>, usize) {
        let known: Vec<_> = points.iter().filter_map(|p| self.off(p)).collect();
        let beyond = points.len() - known.len();
        let Some(largest) = known
            .iter()
            .max_by(|a, b| a.0.abs().total_cmp(&b.0.abs()))
            .copied()
        else {
            return (None, beyond);
        };
        let count = known.len() as f64;
        let off = Deviation {
            points: known.len(),
            mean: known.iter().map(|o| o.0).sum::<f64>() / count,
            rms: (known.iter().map(|o| o.0 * o.0).sum::<f64>() / count).sqrt(),
            largest: largest.0,
            at: largest.1,
            reached: known.iter().filter(|o| o.2).count() as f64 / count,
        };
        (Some(off), beyond)
    }
}

/// Reads measured points.
///
/// # Errors
/// A file or a column is missing, or a number is out of range.
pub(in crate::patch) fn measured(
    file: &PatchFile,
) -> Result<Vec<(String, Vec<MeasuredRange>)>, InputError> {
    let read = |(k, spec): (usize, &MeasuredSpec)| {
        let at = format!("measured.{k}.file");
        let table = MeasuredTable::read(&file.beside(&spec.file));
        let table = table.map_err(|e| file.source.named_at(&at, e))?;
        let pure = |name: &str| column(&file.source, &at, &table, (name, ""));
        let pair = |from: &str, to: Option<&String>| -> Result<Vec<[f64; 2]>, InputError> {
            let low = pure(from)?;
            let high = match to {
                Some(to) => pure(to)?,
                None => low.clone(),
            };
            let ends = low.into_iter().zip(high);
            Ok(ends.map(|(a, b)| [a.min(b), a.max(b)]).collect())
        };
        let creepages = pair(&spec.along, spec.along_to.as_ref())?;
        let adhesions = pair(&spec.adhesion, spec.adhesion_to.as_ref())?;
        let ranges = creepages.into_iter().zip(adhesions);
        let ranges: Vec<MeasuredRange> = ranges
            .map(|(creepage, adhesion)| MeasuredRange { creepage, adhesion })
            .collect();
        let wrong = ranges
            .iter()
            .flat_map(|r| r.creepage)
            .find(|x| !(0.0..=1.0).contains(x));
        if let Some(wrong) = wrong {
            return Err(file.source.error_at(
                &at,
                format!(
                    "a creepage of {wrong} is not between 0 and 1: give the column `{}` its unit, as in `{} [%]`",
                    spec.along, spec.along
                ),
            ));
        }
        let stem = || spec.file.file_stem().unwrap_or_default().to_string_lossy();
        let name = spec.name.clone().unwrap_or_else(|| stem().into_owned());
        Ok((name, ranges))
    };
    file.spec.measured.iter().enumerate().map(read).collect()
}

/// Returns the curves of Polach that are asked for: both of his where the file names none and the
/// bodies have a speed.
///
/// # Errors
/// A number is out of range, or a speed is missing.
fn polach(file: &PatchFile, setup: &Setup) -> Result<Vec<(String, Polach)>, InputError> {
    let of = |spec: &PolachSpec| match spec {
        PolachSpec::Dry => Ok(("Polach, dry".to_owned(), Polach::DRY)),
        PolachSpec::Wet => Ok(("Polach, wet".to_owned(), Polach::WET)),
        PolachSpec::Of {
            mu_0,
            a,
            b,
            k_a,
            k_s,
        } => {
            let b = value(&file.source, "polach.b", b, "s/m")?;
            let curve = Polach {
                mu_0: *mu_0,
                a: *a,
                b,
                k_a: *k_a,
                k_s: *k_s,
            };
            let fits =
                *mu_0 > 0.0 && (0.0..=1.0).contains(a) && b >= 0.0 && *k_a >= *k_s && *k_s > 0.0;
            match fits {
                true => Ok((format!("Polach, mu_0 {mu_0}"), curve)),
                false => Err(file.source.error_at(
                    "polach",
                    "mu_0 must be above 0, a from 0 to 1, b 0 or more, and k_a at least k_s above 0",
                )),
            }
        }
    };
    match &file.spec.polach {
        Some(list) if setup.speed.is_none() && !list.is_empty() => Err(file.source.error_at(
            "polach",
            "his friction falls with the velocity of slip: give a `speed`",
        )),
        Some(list) => list.iter().map(of).collect(),
        None if setup.speed.is_some() => {
            [PolachSpec::Dry, PolachSpec::Wet].iter().map(of).collect()
        }
        None => Ok(Vec::new()),
    }
}

/// Compares the points along the rolling with Polach's curves, and with measured points.
///
/// # Errors
/// A file or a number is wrong.
pub(in crate::patch) fn comparisons(
    file: &PatchFile,
    setup: &Setup,
    points: &[Point],
) -> Result<Vec<Comparison>, Error> {
    let measured = measured(file)?;
    // His curves are of ellipses.
    let curves = match setup.bodies.length {
        Some(_) => Vec::new(),
        None => polach(file, setup)?,
    };
    let plain = |point: &Point| match point.motion {
        Motion::Rolling(c) => c.across == 0.0 && c.spin == 0.0,
        _ => false,
    };
    if points.is_empty() || !points.iter().all(plain) {
        return match measured.is_empty() {
            true => Ok(Vec::new()),
            false => Err(Error::Input(file.source.error_at(
                "measured",
                "measured adhesion is compared over the creepage along the rolling, without creepage across it and spin",
            ))),
        };
    }
    let solved = Solved::of(points);
    let ends = [solved.0.first(), solved.0.last()].map(|p| p.map_or(0.0, |p| p.0));
    let solids = setup.bodies.elasticity.map(|b| Solid {
        young: b.young,
        poisson: b.poisson,
    });
    let hertz = setup
        .bodies
        .distance
        .hertz(setup.load, &setup.bodies.elasticity);
    let speed = setup.rolling_speed();
    let mut out = Vec::new();
    for (name, curve) in curves {
        let at = |x: f64| {
            let adhesion = curve.adhesion(&hertz, setup.load, &solids, x, speed)?;
            Some(MeasuredRange {
                creepage: [x; 2],
                adhesion: [adhesion; 2],
            })
        };
        let same: Option<Vec<MeasuredRange>> = solved.0.iter().map(|(x, _)| at(*x)).collect();
        // Outside of Kalker's table there is no curve.
        let Some(same) = same else { continue };
        let (off, beyond) = solved.compare(&same);
        let place = |k: usize| ends[0] * (ends[1] / ends[0]).powf(k as f64 / DRAWN as f64);
        let drawn: Vec<MeasuredRange> = match ends[0] > 0.0 && ends[1] > ends[0] {
            true => (0..=DRAWN).filter_map(|k| at(place(k))).collect(),
            false => same,
        };
        out.push(Comparison {
            name,
            points: drawn,
            curve: true,
            off,
            beyond,
        });
    }
    for (name, ranges) in measured {
        let (off, beyond) = solved.compare(&ranges);
        out.push(Comparison {
            name,
            points: ranges,
            curve: false,
            off,
            beyond,
        });
    }
    Ok(out)
}
