//! The windows of a third body in the file of a patch.

use fretwork_scene::source::{InputError, Source};
use serde::Deserialize;
use std::path::PathBuf;

/// Runs of a window of a third body, each under the pressure and the slip of a strip of the patch.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ThirdBodySpec {
    /// The case of the window, relative to the file of the patch.
    pub case: PathBuf,
    /// Changes of all runs, `key.path=value`, as `--set` takes them.
    #[serde(default)]
    pub set: Vec<String>,
    /// Number of strips across the patch; of a patch whose two sides are alike, those of one side.
    #[serde(default = "strips")]
    pub strips: usize,
    /// Number of seeds of each strip.
    #[serde(default = "seeds")]
    pub seeds: u16,
    /// Largest number of times that the windows follow the patch.
    #[serde(default = "iterations")]
    pub iterations: usize,
}

fn strips() -> usize {
    3
}

fn seeds() -> u16 {
    3
}

fn iterations() -> usize {
    5
}

/// Most strips and most iterations.
const MOST: [usize; 2] = [64, 20];

impl ThirdBodySpec {
    /// Checks the numbers.
    ///
    /// # Errors
    /// A number is out of range; located in the file.
    pub fn check(&self, source: &Source) -> Result<(), InputError> {
        let [strips, iterations] = MOST;
        let fail = |key: &str, why: String| Err(source.error_at(&format!("third_body.{key}"), why));
        if !(1..=strips).contains(&self.strips) {
            return fail("strips", format!("1 to {strips} strips are expected"));
        }
        if self.seeds < 2 {
            let why = "two seeds or more are expected, whose scatter says when the patch and its windows have settled";
            return fail("seeds", why.to_owned());
        }
        if !(1..=iterations).contains(&self.iterations) {
            return fail("iterations", format!("1 to {iterations} are expected"));
        }
        Ok(())
    }
}
