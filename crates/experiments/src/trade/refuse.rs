//! Checks of a trade before it runs: outputs that the case does not have, and a budget below one
//! run.

use super::output::Output;
use super::request::Request;
use crate::Error;
use crate::duration::seconds;
use crate::runs::available::AvailableQuantities;
use crate::runs::trial::Trial;
use fretwork_scene::Built;
use fretwork_scene::case::Case;
use fretwork_scene::quantity::quantity;

/// Returns the requested outputs, or the default ones, with their exact values where given; an
/// error if the case does not have one.
///
/// # Errors
/// An output or an exact value is wrong.
pub fn outputs(request: &Request, available: &AvailableQuantities) -> Result<Vec<Output>, Error> {
    let requested = request.outputs.iter().map(|t| Output::parse(t));
    let usual = available.usual();
    let usual = usual.iter().map(|name| Output::parse(name));
    let mut outputs: Vec<Output> = match request.outputs.is_empty() {
        true => usual.collect::<Result<_, _>>()?,
        false => requested.collect::<Result<_, _>>()?,
    };
    if outputs.is_empty() {
        return Err(Error::Usage(
            "the case has no main result to compare; name an output, such as --output energy.kinetic=1%".into(),
        ));
    }
    for (k, output) in outputs.iter().enumerate() {
        if outputs[..k].iter().any(|o| o.name() == output.name()) {
            return Err(Error::Usage(format!(
                "--output {} is given twice; name it once, with the error wanted",
                output.name()
            )));
        }
        available
            .check(&output.quantity)
            .map_err(|why| output.refused(&why))?;
    }
    for output in &mut outputs {
        let unit = available.unit(&output.quantity);
        let taken = output.take_unit(unit);
        taken.map_err(|why| output.refused(&why))?;
    }
    for text in &request.exact {
        let wrong = |why: &str| {
            Error::Usage(format!(
                "--exact {text}: {why}; expected NAME=VALUE of one of the outputs"
            ))
        };
        let (name, value) = text
            .split_once('=')
            .ok_or_else(|| wrong("there is no `=`"))?;
        let found = outputs.iter_mut().find(|o| o.name() == name.trim());
        let output = found.ok_or_else(|| wrong("no --output has this name"))?;
        let value = quantity(value, &output.unit).map_err(|e| wrong(&e.message))?;
        output.exact = Some(value);
    }
    Ok(outputs)
}

/// Rejects a budget smaller than one run of the case, as estimated by a short trial: a trade takes
/// many runs. A case that phases or jumps may end early is not checked.
///
/// # Errors
/// The budget is too small.
pub fn budget(request: &Request, case: &Case, scene: Built) -> Result<(), Error> {
    let early = case.jump.is_some() || case.phases.last().is_some_and(|p| p.until.is_some());
    if early {
        return Ok(());
    }
    let trial = Trial::of(case, scene);
    let budget = request.budget.as_secs_f64();
    let Some(run) = trial.run_time() else {
        // A failing step is reported by the run itself.
        return Ok(());
    };
    let one = run.about.unwrap_or(run.least);
    if one <= budget {
        return Ok(());
    }
    // The runs are the case's own setting, a reference and two neighbours at half the step, over
    // all seeds.
    let usual = one * 8.0 * f64::from(request.seeds);
    Err(Error::Usage(format!(
        "--budget {}: one run of the case as it is takes {}; give --budget {:.0}m or more, or a shorter case (--set time.end=...)",
        seconds(budget),
        trial.text(),
        (usual / 60.0).ceil()
    )))
}
