//! Expected duration of the runs of a study.

use super::plan::{Plan, Point};
use crate::load;
use crate::runs::trial::{RunTime, Trial};
use fretwork_core::laws::{Kind, SearchPath};

/// Duration of a run outside its steps: start, reading, files (s).
const STARTING: f64 = 0.1;
/// Duration of the check of the laws of an interface whose bonds may break, and of the comparison
/// of its broken bonds with pulls on the bench at the end of a run (s).
const PULLED: f64 = 0.7;

/// Number of points that are tried.
const TRIED: usize = 3;

/// Expected duration of runs (s).
#[derive(Clone, Copy, Debug, Default)]
pub struct Forecast {
    /// Best estimate of the total on one worker; `None` where a single step takes too long to time.
    pub about: Option<f64>,
    /// Lower bound.
    pub least: f64,
    /// Upper bound.
    pub most: f64,
    /// Whether it is based on completed runs of this study.
    pub measured: bool,
}

impl Forecast {
    /// Computes the forecast from completed runs of the study, or otherwise from a few steps of the
    /// first, the middle and the last of these points; points that the case refuses are skipped.
    pub fn of(plan: &Plan, open: &[Point], search: &SearchPath) -> Self {
        if open.is_empty() {
            return Self {
                about: Some(0.0),
                measured: true,
                ..Self::default()
            };
        }
        let count = open.len() as f64;
        let stored = plan.points().filter_map(|p| plan.launcher.stored(&p.run));
        let walls: Vec<f64> = stored.map(|run| run.wall).collect();
        if walls.len() >= TRIED {
            let mean = walls.iter().sum::<f64>() / walls.len() as f64;
            let least = walls.iter().copied().fold(f64::INFINITY, f64::min);
            let most = walls.iter().copied().fold(0.0, f64::max);
            return Self {
                about: Some(mean * count),
                least: least * count,
                most: most * count,
                measured: true,
            };
        }
        let mut places = vec![0, open.len() / 2, open.len() - 1];
        places.dedup();
        let trial = |k: usize| {
            let run = &open[k].run;
            let seed = format!("seed={}", run.seed);
            let sets = [plan.base.source.sets(), &run.sets, &[seed]].concat();
            let loaded = load(&plan.base.path, &sets).ok()?;
            Trial::of(&loaded.case, loaded.build(search).ok()?).run_time()
        };
        let tried: Vec<RunTime> = places.into_iter().filter_map(trial).collect();
        if tried.is_empty() {
            return Self {
                most: f64::INFINITY,
                ..Self::default()
            };
        }
        let interfaces = plan.base.case.interfaces.iter();
        let bonded = interfaces.filter(|i| i.law(Kind::DAMAGE).is_some()).count();
        let besides = STARTING + PULLED * bonded as f64;
        let mean =
            |f: &dyn Fn(&RunTime) -> f64| tried.iter().map(f).sum::<f64>() / tried.len() as f64;
        let about: Option<Vec<f64>> = tried.iter().map(|t| t.about).collect();
        Self {
            about: about.map(|a| count * (besides + a.iter().sum::<f64>() / a.len() as f64)),
            least: count * mean(&|t| t.least),
            most: count * (besides + mean(&|t| t.most)),
            measured: false,
        }
    }
}
