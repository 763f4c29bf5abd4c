//! How long the runs of a study will take.

use super::StudyError;
use super::plan::{Plan, Point};
use crate::load;
use crate::runs::cost::{RunTime, Trial};
use fretwork_core::geometry::space::Space;
use fretwork_core::laws::SearchPath;
use fretwork_scene::build::Built;
use fretwork_scene::most_steps::most_steps;
use fretwork_scene::{Loaded, Scene};

/// What a run takes besides its steps: start, reading, files (s).
const STARTING: f64 = 0.1;

/// Points that are tried.
const TRIED: usize = 3;

/// Expected duration of runs (s).
#[derive(Clone, Copy, Debug, Default)]
pub struct Forecast {
    /// Best estimate of all together on one worker; `None` where a single step takes too long to time.
    pub about: Option<f64>,
    /// Lower bound.
    pub least: f64,
    /// Upper bound.
    pub most: f64,
    /// Whether it is from runs of this study that ended.
    pub measured: bool,
}

impl Forecast {
    /// From the runs of the study that ended, or else from a few steps of the first, the middle and the last of these points.
    ///
    /// # Errors
    /// A point that the case refuses does not count; none.
    pub fn of(plan: &Plan, open: &[Point], search: &SearchPath) -> Result<Self, StudyError> {
        if open.is_empty() {
            return Ok(Self {
                about: Some(0.0),
                measured: true,
                ..Self::default()
            });
        }
        let count = open.len() as f64;
        let stored = plan
            .points()
            .filter_map(|p| plan.launcher.stored(&p.sets, p.seed));
        let walls: Vec<f64> = stored.map(|run| run.wall).collect();
        if walls.len() >= TRIED {
            let mean = walls.iter().sum::<f64>() / walls.len() as f64;
            let least = walls.iter().copied().fold(f64::INFINITY, f64::min);
            let most = walls.iter().copied().fold(0.0, f64::max);
            return Ok(Self {
                about: Some(mean * count),
                least: least * count,
                most: most * count,
                measured: true,
            });
        }
        let mut tried: Vec<RunTime> = Vec::new();
        let mut places = vec![0, open.len() / 2, open.len() - 1];
        places.dedup();
        for k in places {
            let point = &open[k];
            let sets = [
                plan.base.source.sets(),
                &point.sets,
                &[format!("seed={}", point.seed)],
            ]
            .concat();
            let time = load(&plan.base.path, &sets).ok().and_then(|loaded| {
                let scene = loaded.build(search).ok()?;
                match scene {
                    Scene::Dim2(built) => trial(&loaded, *built),
                    Scene::Dim3(built) => trial(&loaded, *built),
                }
            });
            tried.extend(time);
        }
        if tried.is_empty() {
            return Ok(Self {
                most: f64::INFINITY,
                ..Self::default()
            });
        }
        let mean =
            |f: &dyn Fn(&RunTime) -> f64| tried.iter().map(f).sum::<f64>() / tried.len() as f64;
        let about: Option<Vec<f64>> = tried.iter().map(|t| t.about).collect();
        Ok(Self {
            about: about.map(|a| count * (STARTING + a.iter().sum::<f64>() / a.len() as f64)),
            least: count * mean(&|t| t.least),
            most: count * (STARTING + mean(&|t| t.most)),
            measured: false,
        })
    }
}

fn trial<S: Space>(loaded: &Loaded, built: Built<S>) -> Option<RunTime> {
    let steps = most_steps(&loaded.case);
    let grains = built.simulation.state.bodies.grains().count();
    Trial::of(built.simulation, steps).run_time(steps, grains, S::D)
}
