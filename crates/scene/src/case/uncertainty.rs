//! Estimate of a run's own error: the run repeats some of its steps with finer settings.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Repetitions by which a run estimates its error.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct UncertaintySpec {
    /// Number of times in the run at which steps are repeated; 0 for no estimate. By default as
    /// many as cost less than 5 % of the run, and none in a run that is too short for three.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub repeats: Option<u32>,
    /// Number of successive steps that are repeated each time; by default 1 to 8, more in longer
    /// runs.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub steps: Option<u32>,
}
