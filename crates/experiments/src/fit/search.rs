//! The search: points of a Latin hypercube over the whole region, then CMA-ES from the best of
//! them, with as many seeds as distinguish the points; at the end runs around the best point, from
//! which its intervals follow.
//!
//! All choices follow from the seed of the search, and runs are stored by all that determines them:
//! the same command continues after an interruption, and makes no run twice.

use super::evaluate::{Sample, Tests};
use super::spec::SearchSpec;
use crate::Error;
use fretwork_math::design::latin_hypercube::maximin_latin_hypercube;
use fretwork_math::fit::cma_es::{Cma, Limits};
use fretwork_math::fit::residuals::over_seeds;
use fretwork_math::fit::seeds::SeedsPerPoint;
use std::ops::Range;
use std::sync::atomic::{AtomicBool, Ordering};

/// Number of Latin hypercubes of which the one with the widest distances is used.
const TRIES: usize = 20;

/// Difference of the sums of squares of its points below which the search ends: a difference of one
/// is one standard deviation of a parameter.
const FLAT: f64 = 0.02;

/// Share of their ranges below which changes of the parameters end the search.
const CLOSE: f64 = 1e-3;

/// Number of points of a local design for each coefficient of a quadratic in the parameters.
const PER_COEFFICIENT: usize = 3;

/// A point that was run.
#[derive(Clone, Debug)]
pub struct Evaluation {
    /// Values of the parameters.
    pub values: Vec<f64>,
    /// Position in the unit cube.
    pub place: Vec<f64>,
    /// Range of its seeds.
    pub seeds: Range<u64>,
    /// Simulated values by seed, or the reason why a run gave none.
    pub samples: Vec<Sample>,
    /// Sum of squares of the mean over the seeds; `None` if a run failed.
    pub chi_squared: Option<f64>,
    /// Stage of the search in which it was made.
    pub stage: Stage,
}

/// A part of the search.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// Latin hypercube over the region.
    Region,
    /// A generation of CMA-ES, from 1.
    Generation(u32),
    /// The candidates for the best point, with all seeds.
    Candidates,
    /// Points around the best one.
    Local,
    /// The best point with half the step.
    HalfStep,
}

impl Stage {
    /// A word for tables.
    pub fn word(self) -> String {
        match self {
            Self::Region => "region".to_owned(),
            Self::Generation(k) => format!("generation {k}"),
            Self::Candidates => "candidates".to_owned(),
            Self::Local => "around the best".to_owned(),
            Self::HalfStep => "half the step".to_owned(),
        }
    }
}

/// Result of a search.
#[derive(Clone, Debug, Default)]
pub struct SearchResult {
    /// All points in the order of their runs.
    pub evaluations: Vec<Evaluation>,
    /// Index of the best point among them.
    pub best: Option<usize>,
    /// Why the search ended, as a sentence.
    pub ended: String,
}

/// A search on a set of tests.
pub struct Search<'a> {
    /// The tests.
    pub tests: &'a Tests,
    /// Settings of the search.
    pub spec: SearchSpec,
    /// Smallest and largest number of seeds of a point.
    pub seeds: (u16, u16),
    /// Number of parallel runs.
    pub jobs: usize,
    /// Whether the search must stop.
    pub stop: &'a AtomicBool,
    /// Called with the progress of the search.
    pub watch: &'a (dyn Fn(&Progress) + Sync),
}

impl std::fmt::Debug for Search<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Search")
            .field("spec", &self.spec)
            .finish_non_exhaustive()
    }
}

/// Progress of a search.
#[derive(Clone, Debug, PartialEq)]
pub enum Progress {
    /// A stage begins with this many runs.
    Begins(Stage, usize),
    /// A run ended.
    Run,
    /// A stage ended: smallest sum of squares so far, number of failed points of the stage.
    Ended(Stage, Option<f64>, usize),
}

impl Search<'_> {
    /// Runs the search; results up to the time when `stop` is set are returned too.
    ///
    /// # Errors
    /// A run cannot be started, or all of the region fails.
    pub fn run(&self) -> Result<SearchResult, Error> {
        let count = self.tests.bounds.len();
        let mut found = SearchResult::default();
        let (fewest, most) = self.seeds_of_points();
        let points = self.spec.points.map_or(10 * count, |n| n as usize);
        let cube = maximin_latin_hypercube(points, count, self.spec.seed, TRIES);
        self.evaluate(&mut found, cube, 0..fewest as u64, Stage::Region)?;
        if self.stopped() {
            return Ok(self.interrupted(found));
        }
        let Some(start) = found.least(0..found.evaluations.len()) else {
            let why = found
                .evaluations
                .iter()
                .flat_map(|e| &e.samples)
                .find_map(|s| s.as_ref().err());
            return Err(Error::Failed(format!(
                "no point of the region gave all curves; the first says: {}",
                why.map_or("nothing", String::as_str)
            )));
        };
        // The distance between neighbouring points of the hypercube.
        let step = (0.5 * (points as f64).powf(-1.0 / count as f64)).clamp(0.05, 0.3);
        let failed = |e: &dyn std::fmt::Display| Error::Failed(e.to_string());
        let population = self.spec.population.map(|n| n as usize);
        let mut cma = Cma::new(
            &found.evaluations[start].place,
            step,
            population,
            self.spec.seed,
        )
        .map_err(|e| failed(&e))?
        .with_largest_step(0.5)
        .with_limits(Limits {
            step: CLOSE,
            value: FLAT,
        });
        let mut seeds = SeedsPerPoint::new(fewest, most);
        // Each generation has its own seeds, so that the minimum is not that of one set of samples.
        let mut next = most as u64;
        found.ended = format!("after {} generations", self.spec.generations);
        for generation in 1..=self.spec.generations {
            let here = if self.tests.random {
                next..next + seeds.count() as u64
            } else {
                0..1
            };
            next = here.end.max(next);
            let stage = Stage::Generation(generation);
            let points: Vec<Vec<f64>> = cma.ask();
            let first = found.evaluations.len();
            self.evaluate(&mut found, points, here, stage)?;
            if self.stopped() {
                return Ok(self.interrupted(found));
            }
            let values: Vec<Option<f64>> = found.evaluations[first..]
                .iter()
                .map(|e| e.chi_squared)
                .collect();
            cma.tell(&values).map_err(|e| failed(&e))?;
            let by_seed: Vec<Vec<Option<f64>>> = found.evaluations[first..]
                .iter()
                .map(|e| self.by_seed(e))
                .collect();
            seeds.update(&by_seed);
            if let Some(stop) = cma.stop() {
                found.ended = stop.to_string();
                break;
            }
            if self.tests.random && seeds.exhausted() {
                found.ended =
                    format!("points can no longer be distinguished with {most} seeds each");
                break;
            }
        }
        self.finish(found, &cma, most)
    }

    /// Runs the candidates with all seeds, and points around the best of them.
    fn finish(
        &self,
        mut found: SearchResult,
        cma: &Cma,
        most: usize,
    ) -> Result<SearchResult, Error> {
        let mut candidates = vec![cma.mean().to_vec()];
        candidates.extend(cma.best().map(|(place, _)| place.to_vec()));
        candidates.extend(
            found
                .least(0..found.evaluations.len())
                .map(|k| found.evaluations[k].place.clone()),
        );
        candidates.dedup();
        let first = found.evaluations.len();
        self.evaluate(&mut found, candidates, 0..most as u64, Stage::Candidates)?;
        found.best = found.least(first..found.evaluations.len());
        if self.stopped() || found.best.is_none() {
            return Ok(self.interrupted(found));
        }
        Ok(found)
    }

    /// Runs values of the parameters with all seeds.
    ///
    /// # Errors
    /// A run cannot be started.
    pub fn candidate(&self, found: &mut SearchResult, values: &[f64]) -> Result<(), Error> {
        let place = self.tests.bounds.point(values);
        let (_, most) = self.seeds_of_points();
        self.evaluate(found, vec![place], 0..most as u64, Stage::Candidates)
    }

    /// Runs points around the best one, within a half-width for each coordinate of the unit cube.
    ///
    /// # Errors
    /// A run cannot be started.
    pub fn around(
        &self,
        found: &mut SearchResult,
        half_widths: &[f64],
        round: u64,
    ) -> Result<Range<usize>, Error> {
        let first = found.evaluations.len();
        let Some(best) = found.best else {
            return Ok(first..first);
        };
        let count = half_widths.len();
        let coefficients = 1 + count + count * (count + 1) / 2;
        let seed = self.spec.seed.wrapping_add(round);
        let cube = maximin_latin_hypercube(PER_COEFFICIENT * coefficients, count, seed, TRIES);
        let centre = found.evaluations[best].place.clone();
        let point = |unit: Vec<f64>| -> Vec<f64> {
            let places = unit.iter().zip(half_widths).zip(&centre);
            places.map(|((u, h), c)| c + h * (2.0 * u - 1.0)).collect()
        };
        let points = cube.into_iter().map(point).collect();
        let (fewest, _) = self.seeds_of_points();
        self.evaluate(found, points, 0..fewest as u64, Stage::Local)?;
        Ok(first..found.evaluations.len())
    }

    /// Runs a point again with half the step: simulated values by seed, or the reason why there are
    /// none.
    ///
    /// # Errors
    /// A run cannot be started.
    pub fn with_half_step(&self, point: &Evaluation) -> Result<Vec<Sample>, Error> {
        let runs = point.samples.len() * self.tests.target.tests().len();
        (self.watch)(&Progress::Begins(Stage::HalfStep, runs));
        let watch = || (self.watch)(&Progress::Run);
        let values = [point.values.clone()];
        let seeds = point.seeds.clone();
        let all = self
            .tests
            .run(&values, seeds, 2, self.jobs, self.stop, &watch)?;
        let samples: Vec<Sample> = all.into_iter().flatten().flatten().collect();
        let failed = samples.iter().filter(|s| s.is_err()).count();
        (self.watch)(&Progress::Ended(
            Stage::HalfStep,
            self.chi_squared(&samples),
            failed,
        ));
        Ok(samples)
    }

    /// Returns the numbers of seeds of a point: one for a model without randomness.
    fn seeds_of_points(&self) -> (usize, usize) {
        match self.tests.random {
            true => (usize::from(self.seeds.0), usize::from(self.seeds.1)),
            false => (1, 1),
        }
    }

    fn stopped(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }

    fn interrupted(&self, mut found: SearchResult) -> SearchResult {
        found.ended = "interrupted".to_owned();
        found
    }

    fn evaluate(
        &self,
        found: &mut SearchResult,
        places: Vec<Vec<f64>>,
        seeds: Range<u64>,
        stage: Stage,
    ) -> Result<(), Error> {
        let bounds = &self.tests.bounds;
        let values: Vec<Vec<f64>> = places.iter().map(|p| bounds.values(p)).collect();
        let runs =
            places.len() * (seeds.end - seeds.start) as usize * self.tests.target.tests().len();
        (self.watch)(&Progress::Begins(stage, runs));
        let watch = || (self.watch)(&Progress::Run);
        let all = self
            .tests
            .run(&values, seeds.clone(), 1, self.jobs, self.stop, &watch)?;
        let mut failed = 0;
        for (values, samples) in values.into_iter().zip(all) {
            let samples: Option<Vec<Sample>> = samples.into_iter().collect();
            // A point without all of its seeds, after an interruption, is not an evaluation.
            let Some(samples) = samples else { continue };
            let chi_squared = self.chi_squared(&samples);
            failed += usize::from(chi_squared.is_none());
            found.evaluations.push(Evaluation {
                place: bounds.point(&values),
                values,
                seeds: seeds.clone(),
                samples,
                chi_squared,
                stage,
            });
        }
        let least = found.least(0..found.evaluations.len());
        let least = least.and_then(|k| found.evaluations[k].chi_squared);
        (self.watch)(&Progress::Ended(stage, least, failed));
        Ok(())
    }

    /// Returns chi-squared of the mean over the seeds.
    fn chi_squared(&self, samples: &[Sample]) -> Option<f64> {
        let rows: Option<Vec<Vec<f64>>> =
            samples.iter().map(|s| s.as_ref().ok().cloned()).collect();
        let mean = over_seeds(&rows?)?.mean;
        self.tests.target.chi_squared(&mean).ok()
    }

    /// Returns chi-squared of each seed separately.
    fn by_seed(&self, evaluation: &Evaluation) -> Vec<Option<f64>> {
        let one = |s: &Sample| {
            let values = s.as_ref().ok()?;
            self.tests.target.chi_squared(values).ok()
        };
        evaluation.samples.iter().map(one).collect()
    }
}

impl SearchResult {
    /// Returns the number of points that failed.
    pub fn failed(&self) -> usize {
        let failed = self.evaluations.iter().filter(|e| e.chi_squared.is_none());
        failed.count()
    }

    /// Returns the evaluation with the smallest sum of squares in a range of them.
    pub fn least(&self, part: Range<usize>) -> Option<usize> {
        let known = part.filter_map(|k| Some((k, self.evaluations[k].chi_squared?)));
        known.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(k, _)| k)
    }
}
