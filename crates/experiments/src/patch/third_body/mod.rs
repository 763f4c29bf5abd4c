//! A patch whose friction is that of windows of a third body, which undergo the pressures and slips
//! of its strips.
//!
//! ```text
//! patch with friction mu(x) of each strip and the compliance c of the layer
//!       ▼ pressure and displacement of the surfaces along each strip
//! runs of the window, several seeds                            window, runs
//!       ▼ traction along each strip
//! an elastic layer that slides, fitted to each                 fretwork_rolling::slider
//!       ▼ mean over the seeds
//! patch again, until the adhesion changes by less than the error of its mean over the seeds
//! ```

mod runs;
pub mod spec;
mod window;

pub use spec::ThirdBodySpec;

use super::answer::{Band, Wear};
use super::rolling::comparison;
use super::rolling::wear::{Grids, Rows};
use super::rolling::{Solved, of_law};
use super::setup::Setup;
use super::spec::{MotionSpec, one_load};
use super::{Outcome, PatchFile, numbers, rolling};
use crate::{Error, RunSetup};
use fretwork_core::laws::{Kind, SearchPath};
use fretwork_math::statistics::interval::Mean;
use fretwork_observe::quantity::{number, quantity};
use fretwork_rolling::fields::length;
use fretwork_rolling::strips::{course, places};
use fretwork_rolling::{Creepage, Refined, Rolling, Strip, Strips};
use runs::{Made, Ran, Wanted, make};
use serde::Serialize;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;
use std::time::Duration;
use window::Window;

/// Change of the adhesion over the error of the grid that does not matter.
const CHANGE: f64 = 0.1;

/// How the runs are made.
pub struct Runs<'a> {
    /// Laws, plugins and observers.
    pub setup: &'a RunSetup,
    /// Folder of the results of the patch.
    pub out: &'a Path,
    /// Runs at a time.
    pub jobs: usize,
    /// Longest duration of a run.
    pub limit: Option<Duration>,
    /// Whether to make them; otherwise it ends with the first that is missing.
    pub make: bool,
    /// Whether to interrupt them.
    pub stop: &'a AtomicBool,
    /// Gets lines of progress.
    pub say: &'a (dyn Fn(&str) + Sync),
}

/// What was reached.
pub enum Reached {
    /// All points.
    Done(Box<Outcome>),
    /// Runs are missing: the study of them, its folder, the folder of runs, and their number.
    Waits(PathBuf, PathBuf, PathBuf, usize),
}

/// The windows of a patch, in SI units.
#[derive(Clone, Debug, Serialize)]
pub struct ThirdBody {
    /// Title of the case of the windows.
    pub case: String,
    /// Number of strips and of seeds of each.
    pub strips: usize,
    /// Number of seeds of each strip.
    pub seeds: usize,
    /// Compliance of the layer (m/Pa), 0 where no passage determines it.
    pub compliance: f64,
    /// Lowest and highest compliance of the passages that determine it; otherwise 0 and the lowest
    /// of their upper bounds.
    pub compliances: [f64; 2],
    /// Number of passages that determine it, and of all of the last time.
    pub determined: [usize; 2],
    /// How each point settled.
    pub points: Vec<Settled>,
}

/// How the adhesion of a point settled.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Settled {
    /// The adhesion by the law of the file, and after each time that the windows followed.
    pub adhesions: Vec<f64>,
    /// The adhesion with the windows of each seed alone, the last time.
    pub of_seeds: Vec<f64>,
    /// Standard deviation of those.
    pub scatter: f64,
    /// Whether the last change is below the error of the mean, the scatter over the root of the
    /// number of seeds, or a tenth of the error of the grid.
    pub settled: bool,
}

/// A point on its way.
struct Point {
    creepage: Creepage,
    refined: Refined,
    layer: f64,
    strips: Option<Strips>,
    /// The windows of the strips, by seed.
    ran: Vec<Vec<Ran>>,
    settled: Settled,
}

/// Solves all points of a patch with windows of a third body.
///
/// # Errors
/// The file asks for what windows cannot follow, or a run or a point has no solution.
pub fn solve(file: &PatchFile, search: &SearchPath, runs: &Runs<'_>) -> Result<Reached, Error> {
    let Some(spec) = &file.spec.third_body else {
        return Err(Error::Usage("the patch has no `third_body`".into()));
    };
    let creepages = creepages(file)?;
    let mut setup = Setup::new(file, one_load(file, "a patch with a `third_body`")?, search)?;
    check(file, &setup)?;
    setup.laws.truncate(1);
    let window = Window::read(file, spec)?;
    let elastic = setup.layer;
    let mut compliance = Compliance::default();
    let mut points = Vec::new();
    for creepage in creepages {
        let (refined, _) = of_law(&setup, &creepage, &setup.laws[0])?;
        let mut settled = Settled::default();
        settled.adhesions.push(length(refined.force) / setup.load);
        points.push(Point {
            creepage,
            refined,
            layer: 0.0,
            strips: None,
            ran: Vec::new(),
            settled,
        });
    }
    for number in 1..=spec.iterations {
        let open: Vec<usize> = (0..points.len())
            .filter(|k| !points[*k].settled.settled)
            .collect();
        if open.is_empty() {
            break;
        }
        let mut wanted = Vec::new();
        for k in &open {
            wanted.extend(points[*k].wanted(&setup, spec.strips)?);
        }
        let all = match make(&window, spec, &wanted, number, runs)? {
            Made::All(all) => all,
            Made::Missing(study, out, count) => {
                let cache = runs.out.join("runs");
                return Ok(Reached::Waits(study, out, cache, count));
            }
        };
        for (k, ran) in open.iter().zip(all.chunks(spec.strips)) {
            points[*k].ran = ran.to_vec();
        }
        compliance = Compliance::of(points.iter().flat_map(|p| p.ran.iter().flatten()));
        for k in open {
            let point = &mut points[k];
            point.layer = compliance.value;
            setup.layer = elastic + compliance.value;
            point.follow(&mut setup, usize::from(spec.seeds))?;
            let last = point.settled.adhesions.len() - 1;
            (runs.say)(&format!(
                "creepage {} %: Q/P {}, before {}, scatter of the seeds {}",
                number_of(100.0 * point.creepage.along),
                number_of(point.settled.adhesions[last]),
                number_of(point.settled.adhesions[last - 1]),
                number_of(point.settled.scatter)
            ));
        }
    }
    let mut rolled = Vec::new();
    for point in &points {
        setup.layer = elastic + point.layer;
        setup.laws[0].follow(point.strips.clone());
        let mut solved = rolling::solve(&setup, &point.creepage)?;
        point.complete(&mut solved);
        rolled.push(solved);
    }
    let first = rolled.first().map(|s| s.rolling.pressure.clone());
    let of: Vec<_> = rolled.iter().map(|s| s.point.clone()).collect();
    let comparisons = comparison::comparisons(file, &setup, &of)?;
    let mut answer = numbers(file, &setup, &first.unwrap_or_default(), of);
    answer.comparisons = comparisons;
    answer.third_body = Some(ThirdBody {
        case: window.name,
        strips: spec.strips,
        seeds: usize::from(spec.seeds),
        compliance: compliance.value,
        compliances: compliance.range,
        determined: compliance.determined,
        points: points.into_iter().map(|p| p.settled).collect(),
    });
    Ok(Reached::Done(Box::new(Outcome {
        answer,
        setup,
        rolled,
        strokes: Vec::new(),
        course: None,
    })))
}

fn number_of(x: f64) -> String {
    number(x, 4)
}

/// Returns the creepages, which are along the rolling.
fn creepages(file: &PatchFile) -> Result<Vec<Creepage>, Error> {
    let fail = |why: &str| Err(Error::Input(file.source.error_at("motion", why)));
    if !matches!(file.spec.motion, MotionSpec::Rolling { .. }) {
        return fail(
            "windows of a third body follow a patch that rolls with creepages: give Rolling(along: ..)",
        );
    }
    let all = rolling::creepages(file)?;
    if all
        .iter()
        .any(|c| c.across != 0.0 || c.spin != 0.0 || c.along == 0.0)
    {
        return fail(
            "windows of a third body slip along the rolling: give creepages `along` that are not zero, and leave `across` and `spin` out",
        );
    }
    Ok(all)
}

/// Refuses what would be there twice.
fn check(file: &PatchFile, setup: &Setup) -> Result<(), Error> {
    let fail = |path: &str, why: &str| Err(Error::Input(file.source.error_at(path, why)));
    if !file.spec.members.is_empty() {
        return fail(
            "members",
            "with a `third_body` the band is that of its seeds: leave `members` out",
        );
    }
    if file.spec.passages.is_some() {
        return fail(
            "passages",
            "profiles wear by a law, and a `third_body` is the layer of one passage: leave one of them out",
        );
    }
    if setup.laws[0].interface().law(Kind::WEAR).is_some() {
        return fail(
            "interfaces",
            "with a `third_body` wear is that of its runs: leave `wear` out",
        );
    }
    Ok(())
}

/// Compliance of the layer over all passages.
#[derive(Debug, Default)]
struct Compliance {
    value: f64,
    range: [f64; 2],
    determined: [usize; 2],
}

impl Compliance {
    /// Returns the geometric mean of those passages that determine it.
    fn of<'a>(ran: impl Iterator<Item = &'a Ran>) -> Self {
        let all: Vec<&Ran> = ran.collect();
        let known = all.iter().filter(|r| r.fitted.knows_compliance());
        let known: Vec<f64> = known.map(|r| r.fitted.slider.compliance).collect();
        let determined = [known.len(), all.len()];
        let low = known.iter().copied().fold(f64::INFINITY, f64::min);
        let high = known.iter().copied().fold(0.0, f64::max);
        let bounds = all.iter().map(|r| r.fitted.compliances[1]);
        match known.len() {
            0 => Self {
                value: 0.0,
                range: [0.0, bounds.fold(f64::INFINITY, f64::min)],
                determined,
            },
            n => Self {
                value: (known.iter().map(|c| c.ln()).sum::<f64>() / n as f64).exp(),
                range: [low, high],
                determined,
            },
        }
    }
}

impl Point {
    fn sign(&self) -> f64 {
        self.creepage.along.signum()
    }

    /// Returns what the strips undergo.
    fn wanted(&self, setup: &Setup, strips: usize) -> Result<Vec<Wanted>, Error> {
        let fine = &self.refined.fine;
        let pressure = &fine.pressure.pressure;
        let symmetric = setup.bodies.distance.profile.is_none();
        let of = |(k, across): (usize, f64)| -> Result<Wanted, Error> {
            let course = course(
                &fine.grid,
                pressure,
                &fine.tractions,
                self.layer,
                across,
                self.sign(),
            );
            let course = course.ok_or_else(|| {
                Error::Failed(format!(
                    "nothing touches at {} across the patch: take more `cells` or fewer `strips`",
                    quantity(across, "m")
                ))
            });
            Ok(Wanted {
                name: format!(
                    "creepage {} % strip {}",
                    number_of(100.0 * self.creepage.along),
                    k + 1
                ),
                course: course?,
            })
        };
        let places = places(&fine.grid, pressure, strips, symmetric);
        places.into_iter().enumerate().map(of).collect()
    }

    /// Returns friction by strips: that of a seed, or the mean over all of them.
    fn friction(&self, setup: &Setup, seed: Option<usize>) -> Strips {
        let fine = &self.refined.fine;
        let symmetric = setup.bodies.distance.profile.is_none();
        let places = places(
            &fine.grid,
            &fine.pressure.pressure,
            self.ran.len(),
            symmetric,
        );
        let mean = |ran: &[Ran]| {
            let own = match seed {
                Some(k) => &ran[k..=k],
                None => ran,
            };
            let part = |k: usize| {
                own.iter().map(|r| r.fitted.slider.friction[k]).sum::<f64>() / own.len() as f64
            };
            (0..runs::PARTS).map(part).collect()
        };
        let strips = self.ran.iter().zip(places);
        let strips = strips.map(|(ran, across)| Strip {
            across,
            friction: mean(ran),
        });
        Strips {
            strips: strips.collect(),
            symmetric,
        }
    }

    /// Solves the patch with the friction of the windows, and with that of each seed.
    fn follow(&mut self, setup: &mut Setup, seeds: usize) -> Result<(), Error> {
        let all = self.friction(setup, None);
        let each: Vec<Strips> = (0..seeds).map(|k| self.friction(setup, Some(k))).collect();
        let mut solve = |strips: &Strips| -> Result<(Refined, f64), Error> {
            setup.laws[0].follow(Some(strips.clone()));
            let (refined, _) = of_law(setup, &self.creepage, &setup.laws[0])?;
            let adhesion = length(refined.force) / setup.load;
            Ok((refined, adhesion))
        };
        let mut of_seeds = Vec::new();
        for strips in &each {
            of_seeds.push(solve(strips)?.1);
        }
        let (refined, adhesion) = solve(&all)?;
        let before = self.settled.adhesions.last().copied().unwrap_or_default();
        let scatter = Mean::of(&of_seeds).and_then(|m| m.scatter).unwrap_or(0.0);
        let of_grid = CHANGE * length(refined.error) / setup.load;
        let least = (scatter / (seeds as f64).sqrt()).max(of_grid);
        self.settled.settled = (adhesion - before).abs() < least;
        self.settled.adhesions.push(adhesion);
        self.settled.of_seeds = of_seeds;
        self.settled.scatter = scatter;
        self.strips = Some(all);
        self.refined = refined;
        Ok(())
    }

    /// Puts the band over the seeds, the wear of the windows and what did not settle into a point.
    fn complete(&self, solved: &mut Solved) {
        let point = &mut solved.point;
        point.adhesion_band = Band::of(point.adhesion, &self.settled.of_seeds);
        if !self.settled.settled {
            point.notes.push(
                "NOT SETTLED: the adhesion still changes by more than the error of its mean over the seeds; take more `iterations`".to_owned(),
            );
        }
        let rows = |rolling: &Rolling| {
            let slip = rolling.wearing_slip();
            let cells = rolling.pressure.pressure.iter().zip(&slip);
            let rubbed: Vec<f64> = cells.map(|(p, s)| p * length(*s)).collect();
            Rows::of(rolling, &rubbed)
        };
        let grids = Grids {
            fine: rows(&solved.rolling),
            coarse: self.refined.coarse.each_ref().map(rows),
        };
        for (name, rate) in self.rates() {
            point.wear.push(Wear {
                half_width: rate.half_width.map(|half| half / rate.mean),
                ..grids.wear(name, "third body", rate.mean)
            });
        }
    }

    /// Returns the specific wear rate of each body that all runs have: the mean over the seeds, of
    /// each that over the strips.
    fn rates(&self) -> Vec<(String, Mean)> {
        let Some(first) = self.ran.first().and_then(|seeds| seeds.first()) else {
            return Vec::new();
        };
        let mean = |(name, _): &(String, f64)| {
            let own = |r: &Ran| r.wear.iter().find(|w| w.0 == *name).map(|w| w.1);
            let of_seed = |seed: usize| -> Option<f64> {
                let strips = self.ran.iter().map(|seeds| own(seeds.get(seed)?));
                let rates: Vec<f64> = strips.collect::<Option<_>>()?;
                Some(rates.iter().sum::<f64>() / rates.len() as f64)
            };
            let seeds: Option<Vec<f64>> = (0..self.ran[0].len()).map(of_seed).collect();
            Some((name.clone(), Mean::of(&seeds?)?))
        };
        first.wear.iter().filter_map(mean).collect()
    }
}

impl ThirdBody {
    /// Returns lines on the windows: their number, and the compliance of the layer.
    pub fn lines(&self) -> Vec<(&'static str, String)> {
        let [known, all] = self.determined;
        let [low, high] = self.compliances.map(|c| quantity(c, "m/Pa"));
        let layer = match known {
            0 => format!(
                "not determined: all of the {all} passages slip throughout; at most {high}, taken as rigid; a smaller creepage determines it"
            ),
            _ => format!(
                "compliance {} ({low} to {high}) from {known} of {all} passages{}",
                quantity(self.compliance, "m/Pa"),
                if known < all {
                    ", the others slip throughout"
                } else {
                    ""
                }
            ),
        };
        vec![
            (
                "third body",
                format!(
                    "{}, {} strips x {} seeds",
                    self.case, self.strips, self.seeds
                ),
            ),
            ("layer", layer),
        ]
    }
}

impl Settled {
    /// Returns a line on how a point settled.
    pub fn line(&self) -> String {
        let all: Vec<String> = self.adhesions.iter().map(|q| number_of(*q)).collect();
        let mut out = format!(
            "{} after following {}, Q/P {}",
            if self.settled {
                "settled"
            } else {
                "not settled"
            },
            match all.len() - 1 {
                1 => "once".to_owned(),
                times => format!("{times} times"),
            },
            all.join(", ")
        );
        if let [.., before, last] = self.adhesions[..] {
            let _ = write!(
                out,
                "; last change {}, scatter of {} seeds {}",
                number((last - before).abs(), 2),
                self.of_seeds.len(),
                number(self.scatter, 2)
            );
        }
        out
    }
}
