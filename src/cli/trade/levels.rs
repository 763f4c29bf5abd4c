//! The varied parameters of a study, and checks that each of their levels is a case that can be built.

use super::{Facts, TradeArgs};
use crate::cli::Failure;
use crate::experiments::trade::form::variants;
use crate::experiments::trade::parameters::{Sense, StudyParameter, parameters};
use crate::experiments::trade::rung::keep_accepted;
use crate::laws::SearchPath;
use crate::scene::{Loaded, load};

/// The varied parameters, each level of which gives a case that can be built.
pub fn parameters_of(
    args: &TradeArgs,
    loaded: &Loaded,
    search: &SearchPath,
    first: &Facts,
) -> Result<Vec<StudyParameter>, Failure> {
    // Forms of the case come first: the other parameters change what these write.
    let mut all: Vec<StudyParameter> = variants(loaded, &args.variants)?.into_iter().collect();
    let only_variants = !all.is_empty() && args.parameters.is_empty() && args.vary.is_empty();
    if !only_variants {
        all.extend(parameters(
            loaded,
            &first.solving,
            &args.parameters,
            &args.vary,
        )?);
    }
    all.sort_by_key(|k| k.sense != Sense::Form);
    for rung in all.iter_mut().filter(|k| k.name == "rung") {
        let before = args.case.sets.clone();
        keep_accepted(rung, |sets| {
            let scene = load(&args.case.case, &[&before[..], sets].concat())
                .and_then(|case| case.build(search));
            scene.map(|_| ()).map_err(|e| e.message().to_owned())
        })?;
    }
    one_tolerance(&all)?;
    check_varied_cases(args, search, &all)?;
    Ok(all)
}

/// Refuses a tolerance beside forms of the case that have another one.
fn one_tolerance(parameters: &[StudyParameter]) -> Result<(), Failure> {
    let sets = |k: &StudyParameter, key: &str| {
        let mut sets = k.levels.iter().flat_map(|l| &l.sets);
        sets.any(|set| set.split('=').next().is_some_and(|k| k.trim() == key))
    };
    let form = |k: &&StudyParameter| {
        k.sense == Sense::Form && (sets(k, "solver.tolerance") || sets(k, "solver"))
    };
    let varied = |k: &&StudyParameter| k.sense != Sense::Form && sets(k, "solver.tolerance");
    let mut all = parameters.iter();
    let (Some(form), Some(varied)) = (parameters.iter().find(form), all.find(varied)) else {
        return Ok(());
    };
    Err(Failure::Usage(format!(
        "`{}` and `{}` cannot be varied together: the error of a step is measured in another way, or to another tolerance, in some levels of `{}`; vary one at a time",
        form.name, varied.name, form.name
    )))
}

/// Builds the case with each value of a `--vary`, so that a wrong one is refused before any run.
fn check_varied_cases(
    args: &TradeArgs,
    search: &SearchPath,
    parameters: &[StudyParameter],
) -> Result<(), Failure> {
    let varied = |set: &&String| args.vary.iter().any(|v| same_key(set, v));
    let levels = parameters.iter().flat_map(|k| &k.levels);
    for set in levels.flat_map(|l| &l.sets).filter(varied) {
        let sets = [args.case.sets.clone(), vec![set.clone()]].concat();
        load(&args.case.case, &sets)?.build(search)?;
    }
    let variants = parameters.iter().filter(|k| k.name == "variant");
    for level in variants.flat_map(|k| &k.levels) {
        let sets = [args.case.sets.clone(), level.sets.clone()].concat();
        load(&args.case.case, &sets)?.build(search)?;
    }
    Ok(())
}

/// Whether a `--set` and a `--vary` have the same key.
fn same_key(set: &str, vary: &str) -> bool {
    let key = |t: &str| t.split('=').next().map(|k| k.trim().to_owned());
    key(set) == key(vary)
}
