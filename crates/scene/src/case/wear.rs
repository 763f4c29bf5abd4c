//! How the surfaces of a first body follow their wear.

use serde::{Deserialize, Serialize};

/// What a first body says of its wear.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct WearSpec {
    /// Depth at which a surface is worn through and the run stops (m).
    pub thickness: f64,
    /// Steps between two at which surfaces follow.
    #[serde(default = "one")]
    pub every: u64,
}

fn one() -> u64 {
    1
}
