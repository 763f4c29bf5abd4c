//! The varied parameters of a trade, each level of which gives a case that can be built.

use super::deformability::keep_accepted;
use super::presets::{Solving, presets};
use super::request::Request;
use super::variant::variants;
use super::varied::{ParameterEffect, Varied};
use crate::{Error, load};
use fretwork_core::laws::SearchPath;
use fretwork_scene::LoadedCase;

/// The varied parameters, each level of which gives a case that can be built.
///
/// # Errors
/// An argument or a level is wrong.
pub fn parameters(
    request: &Request,
    loaded: &LoadedCase,
    search: &SearchPath,
    solving: &Solving,
) -> Result<Vec<Varied>, Error> {
    // Forms of the case come first, since the other parameters change values that forms set.
    let mut all: Vec<Varied> = variants(loaded, &request.variants)?.into_iter().collect();
    let only_variants = !all.is_empty() && request.presets.is_empty() && request.vary.is_empty();
    if !only_variants {
        all.extend(presets(loaded, solving, &request.presets, &request.vary)?);
    }
    all.sort_by_key(|k| k.effect != ParameterEffect::Form);
    for forms in all.iter_mut().filter(|k| k.name == "deformability") {
        let before = request.sets.clone();
        keep_accepted(forms, |sets| {
            let scene = load(&request.case, &[&before[..], sets].concat())
                .and_then(|case| case.build(search));
            scene.map(|_| ()).map_err(|e| e.message().to_owned())
        })?;
    }
    one_tolerance(&all)?;
    check_varied_cases(request, search, &all)?;
    Ok(all)
}

/// Refuses a varied tolerance together with forms of the case that have different tolerances.
fn one_tolerance(parameters: &[Varied]) -> Result<(), Error> {
    let sets = |k: &Varied, key: &str| {
        let mut sets = k.levels.iter().flat_map(|l| &l.sets);
        sets.any(|set| set.split('=').next().is_some_and(|k| k.trim() == key))
    };
    let form = |k: &&Varied| {
        k.effect == ParameterEffect::Form && (sets(k, "solver.tolerance") || sets(k, "solver"))
    };
    let varied = |k: &&Varied| k.effect != ParameterEffect::Form && sets(k, "solver.tolerance");
    let mut all = parameters.iter();
    let (Some(form), Some(varied)) = (parameters.iter().find(form), all.find(varied)) else {
        return Ok(());
    };
    Err(Error::Usage(format!(
        "`{}` and `{}` cannot be varied together: the error of a step is measured in another way, or to another tolerance, in some levels of `{}`; vary one at a time",
        form.name, varied.name, form.name
    )))
}

/// Builds the case with each value of a `--vary`, so that an invalid one is refused before any run.
fn check_varied_cases(
    request: &Request,
    search: &SearchPath,
    parameters: &[Varied],
) -> Result<(), Error> {
    let varied = |set: &&String| request.vary.iter().any(|v| same_key(set, v));
    let levels = parameters.iter().flat_map(|k| &k.levels);
    for set in levels.flat_map(|l| &l.sets).filter(varied) {
        let sets = [request.sets.clone(), vec![set.clone()]].concat();
        load(&request.case, &sets)?.build(search)?;
    }
    let variants = parameters.iter().filter(|k| k.name == "variant");
    for level in variants.flat_map(|k| &k.levels) {
        let sets = [request.sets.clone(), level.sets.clone()].concat();
        load(&request.case, &sets)?.build(search)?;
    }
    Ok(())
}

/// Returns whether a `--set` and a `--vary` have the same key.
fn same_key(set: &str, vary: &str) -> bool {
    let key = |t: &str| t.split('=').next().map(|k| k.trim().to_owned());
    key(set) == key(vary)
}
