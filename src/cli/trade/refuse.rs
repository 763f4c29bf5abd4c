//! Checks of a study before anything runs: outputs that the case does not have, and a budget below one run.

use super::TradeArgs;
use crate::cli::Failure;
use crate::experiments::runs::cost::Trial;
use crate::experiments::runs::duration::seconds;
use crate::experiments::runs::launcher::{Ended, Launcher};
use crate::experiments::runs::offer::{Offer, measure_names};
use crate::experiments::runs::stored::summary;
use crate::experiments::trade::TradeError;
use crate::experiments::trade::output::Output;
use crate::geometry::space::Space;
use crate::scene::build::Built;
use crate::scene::most_steps::most_steps;
use crate::scene::{Loaded, Scene};
use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

/// The requested outputs, or the default ones, with their exact values where given; an error if the case does
/// not have one.
pub fn outputs(args: &TradeArgs, offer: &Offer) -> Result<Vec<Output>, Failure> {
    let asked = args.outputs.iter().map(|t| Output::parse(t));
    let usual = offer.usual().into_iter().map(Output::parse);
    let all: Result<Vec<Output>, TradeError> = match args.outputs.is_empty() {
        true => usual.collect(),
        false => asked.collect(),
    };
    let mut outputs = all?;
    if outputs.is_empty() {
        return Err(Failure::Usage(
            "the case has no friction test, damage or wear to compare; name an output, such as --output energy.kinetic=1%".into(),
        ));
    }
    for (k, output) in outputs.iter().enumerate() {
        if outputs[..k].iter().any(|o| o.name() == output.name()) {
            return Err(Failure::Usage(format!(
                "--output {} is given twice; name it once, with the error wanted",
                output.name()
            )));
        }
        offer
            .check(&output.quantity)
            .map_err(|why| output.refused(&why))?;
    }
    for text in &args.exact {
        let wrong = |why: &str| {
            Failure::Usage(format!(
                "--exact {text}: {why}; expected NAME=VALUE of one of the outputs"
            ))
        };
        let (name, value) = text
            .split_once('=')
            .ok_or_else(|| wrong("there is no `=`"))?;
        let value: f64 = value
            .trim()
            .parse()
            .ok()
            .filter(|v: &f64| v.is_finite())
            .ok_or_else(|| wrong("the value is not a number"))?;
        let found = outputs.iter_mut().find(|o| o.name() == name.trim());
        found
            .ok_or_else(|| wrong("no --output has this name"))?
            .exact = Some(value);
    }
    Ok(outputs)
}

/// Rejects a budget smaller than one run of the case, as estimated by a short trial: a study takes many runs.
/// A case that phases or jumps may end early is not checked.
pub fn budget(args: &TradeArgs, loaded: &Loaded, scene: Scene) -> Result<(), Failure> {
    let case = &loaded.case;
    let early = case.jump.is_some() || case.phases.last().is_some_and(|p| p.until.is_some());
    if early {
        return Ok(());
    }
    match scene {
        Scene::Dim2(built) => budget_of(args, loaded, *built),
        Scene::Dim3(built) => budget_of(args, loaded, *built),
    }
}

fn budget_of<S: Space>(args: &TradeArgs, loaded: &Loaded, built: Built<S>) -> Result<(), Failure> {
    let steps = most_steps(&loaded.case);
    let grains = built.simulation.state.bodies.grains().count();
    let trial = Trial::of(built.simulation, steps);
    let budget = args.budget.as_secs_f64();
    let Some(run) = trial.run_time(steps, grains, S::D) else {
        // A failing step is reported by the run itself.
        return Ok(());
    };
    if run.about.unwrap_or(run.least) <= budget {
        return Ok(());
    }
    // The case's own setting, a reference and two neighbours at half the step, over all seeds.
    let usual = run.about.unwrap_or(run.least) * 8.0 * f64::from(args.seeds);
    Err(Failure::Usage(format!(
        "--budget {}: one run of the case as it is takes {}; give --budget {:.0}m or more, or a shorter case (--set time.end=...)",
        seconds(budget),
        trial.text(steps, grains, S::D),
        (usual / 60.0).ceil()
    )))
}

/// Checks names in groups that only a run fills against a run of two steps, if the case allows one so short.
pub fn after_two_steps(
    args: &TradeArgs,
    loaded: &Loaded,
    launcher: &Launcher,
    outputs: &[Output],
    stop: &AtomicBool,
) -> Result<(), Failure> {
    let short = vec![format!("time.end={:e}", 2.0 * loaded.case.time.step)];
    let seed = loaded.case.seed;
    let begun = launcher.stored(&short, seed).is_some();
    let soon = Instant::now() + Duration::from_secs(60).min(args.budget);
    if begun
        || matches!(
            launcher.run(&short, seed, soon, None, stop)?,
            Ended::Finished(_)
        )
    {
        let place = launcher.place(&short, seed);
        let summary = summary(&place);
        if summary.is_object() {
            for output in outputs {
                output
                    .quantity
                    .check(&summary, &place, &measure_names(&loaded.case))
                    .map_err(|why| output.refused(&why))?;
            }
        }
    }
    Ok(())
}
