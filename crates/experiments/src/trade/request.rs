//! The request for a trade, with its checks and first runs.

use super::combination::Combination;
use super::cost_law::CostLaw;
use super::deformability::Deformability;
use super::output::Output;
use super::plan::{RunsBySetting, Trade};
use super::presets::Solving;
use super::varied::Varied;
use super::{OWNER, parameters, refuse};
use crate::runs::available::AvailableQuantities;
use crate::runs::launcher::Launcher;
use crate::runs::stored::Limits;
use crate::{Error, RunSetup, build, load};
use fretwork_core::solve::local::solver::Method;
use fretwork_scene::methods::{SolverRequirements, SolverSupport};
use fretwork_scene::most_steps::most_steps;
use fretwork_scene::{Built, LoadedCase};
use fretwork_store::folder_lock::FolderLock;
use std::collections::BTreeSet;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

/// A request for a trade, with the texts of the command line.
#[derive(Clone, Debug)]
pub struct Request {
    /// The case.
    pub case: PathBuf,
    /// `--set` arguments of all runs.
    pub sets: Vec<String>,
    /// Outputs with the wanted errors, `NAME=ERROR`; by default those that the case has.
    pub outputs: Vec<String>,
    /// Exact values of outputs, `NAME=VALUE`.
    pub exact: Vec<String>,
    /// Names of presets; by default those that suit the case.
    pub presets: Vec<String>,
    /// Values of the case with their levels, `KEY.PATH=A,B,C`.
    pub vary: Vec<String>,
    /// Other forms of the case, `NAME=FILE`.
    pub variants: Vec<String>,
    /// Seeds of each setting.
    pub seeds: u16,
    /// Time budget.
    pub budget: Duration,
    /// Parallel runs.
    pub jobs: u16,
    /// Folder of the results.
    pub out: PathBuf,
    /// Limits of accepted runs.
    pub limits: Limits,
}

impl Request {
    /// Checks the request and makes the first runs, which show whether contacts are chaotic, and
    /// what settings cost. Also returns the lock on the folder of the results.
    ///
    /// # Errors
    /// The case or an argument is invalid, the budget is below one run, or nothing can be run.
    pub fn begin(&self, setup: &RunSetup, stop: &AtomicBool) -> Result<(Trade, FolderLock), Error> {
        let started = Instant::now();
        let loaded = load(&self.case, &self.sets)?;
        let (scene, random) = build(&loaded, setup)?;
        let first = SceneFacts::of(&loaded, &scene, setup);
        let outputs = refuse::outputs(self, &first.available)?;
        let parameters = parameters::parameters(self, &loaded, &setup.search, &first.solving)?;
        if parameters.is_empty() {
            let text = "nothing to vary; name a --setting or --vary";
            return Err(Error::Usage(text.into()));
        }
        // An earlier trade in the folder may have done all runs already.
        let runs = self.out.join("runs");
        let mut scene = Some(scene);
        if !runs.is_dir()
            && let Some(scene) = scene.take()
        {
            refuse::budget(self, &loaded.case, scene)?;
        }
        let lock = OWNER.take(&self.out)?;
        let sets = loaded.source.sets();
        let mut launcher = Launcher::new(&loaded.path, sets, setup, &runs, self.limits)?;
        launcher.perturb_unless(random, loaded.case.seed);
        let mut trade = self.trade(&loaded, launcher, parameters, outputs, random, started);
        let own = trade.run_of(&Combination::own(&trade.parameters), loaded.case.seed);
        if let Some(scene) = scene
            && trade.launcher.stored(&own).is_none()
        {
            refuse::budget(self, &loaded.case, scene)?;
        }
        trade.test_for_chaos(self.seeds.into(), stop)?;
        trade.prepare(stop)?;
        Ok((trade, lock))
    }

    /// Returns the trade before its first run, with notes on its options.
    fn trade(
        &self,
        loaded: &LoadedCase,
        launcher: Launcher,
        parameters: Vec<Varied>,
        outputs: Vec<Output>,
        random: bool,
        started: Instant,
    ) -> Trade {
        let seeds = if random { u64::from(self.seeds) } else { 1 };
        let mut notes = Vec::new();
        if !random && self.seeds == 1 {
            notes.push("Nothing in the case is drawn from its seed, and one run a setting does not show whether contacts are chaotic: errors have no intervals.".into());
        } else if random && seeds == 1 {
            notes.push("One seed gives no scatter: no error has an interval, and no conclusion can be drawn. Give --seeds 3 or more.".into());
        }
        notes.push("Precision is not varied: Fretwork computes and stores in f64 only.".into());
        for k in &parameters {
            let left_out = k.left_out.iter();
            notes.extend(
                left_out.map(|(level, why)| format!("{} {level} is not offered: {why}.", k.name)),
            );
        }
        if self.jobs > 1 {
            notes.push(format!("{} runs ran in parallel, which disturbs their timing; visits (contacts times iterations) do not depend on it.", self.jobs));
        }
        Trade {
            title: loaded.case.name.clone(),
            launcher: Arc::new(launcher),
            parameters,
            outputs,
            seeds: (0..seeds)
                .map(|k| loaded.case.seed.wrapping_add(k))
                .collect(),
            random,
            steps: most_steps(&loaded.case) as f64,
            jobs: self.jobs.into(),
            budget: self.budget,
            done: RunsBySetting::new(),
            cost: CostLaw::default(),
            reused: 0,
            fresh: 0,
            left_out: BTreeSet::new(),
            notes,
            started,
        }
    }
}

/// Properties of a scene that a trade needs.
struct SceneFacts {
    solving: Solving,
    available: AvailableQuantities,
}

impl SceneFacts {
    fn of(loaded: &LoadedCase, built: &Built, setup: &RunSetup) -> Self {
        let requirements = SolverRequirements::of(built.simulation.view());
        let serves = |m: &Method| {
            *m == loaded.case.solver.method || requirements.support(*m) == SolverSupport::Serves
        };
        Self {
            available: AvailableQuantities::of(loaded, built, setup),
            solving: Solving {
                methods: Method::ALL.iter().copied().filter(serves).collect(),
                tolerance: built.simulation.options().solver.tolerance,
                deformability: Deformability::of(&loaded.case, built),
            },
        }
    }
}
