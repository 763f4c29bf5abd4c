//! The case of an experiment.

use crate::runs::randomness::seed_matters;
use crate::{Error, RunSetup};
use fretwork_scene::{Built, InputError, LoadedCase};
use fretwork_store::results::state;
use std::path::Path;

/// Reads a case and applies the `--set` arguments; grains of another run are read from its
/// `results.h5`.
///
/// # Errors
/// Returns an error with file, line and column.
pub fn load(path: &Path, sets: &[String]) -> Result<LoadedCase, InputError> {
    Ok(fretwork_scene::load(path, sets)?.reading_records(state::read))
}

/// Builds a case as its runs will; returns the scene, and whether the seed changes it.
///
/// # Errors
/// The case is refused.
pub fn build(loaded: &LoadedCase, setup: &RunSetup) -> Result<(Built, bool), Error> {
    let scene = loaded.build(&setup.search)?;
    let observers = (setup.observers)(loaded, scene.simulation.view());
    (setup.check_names)(loaded, &observers)?;
    let random = seed_matters(loaded, &scene, &setup.search)?;
    Ok((scene, random))
}
