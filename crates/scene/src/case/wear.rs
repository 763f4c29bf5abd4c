//! Specification of a first body's wear.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Wear of a first body.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct WearSpec {
    /// Depth at which a surface is worn through and the run stops (m).
    pub thickness: f64,
    /// Steps between updates of the surfaces.
    #[serde(default = "one")]
    pub every: u64,
}

fn one() -> u64 {
    1
}
