//! Requested accuracy of a run, which then chooses step and tolerance itself.

use schemars::JsonSchema;
use serde::de::{MapAccess, Visitor, value::MapAccessDeserializer};
use serde::{Deserialize, Deserializer, Serialize};

/// Result whose relative error is bounded.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
pub enum AccurateResult {
    /// Friction coefficient of the friction test; in a case without one the energy of friction, or
    /// forces where nothing is driven.
    #[default]
    Friction,
    /// Forces of contacts: for scenes that are at rest or come to rest.
    Forces,
    /// Energy dissipated by friction.
    FrictionEnergy,
    /// Damage of bonds.
    Damage,
    /// Wear of first bodies.
    Wear,
}

/// Requested accuracy, and the bounds within which the run chooses its settings. `solver.tolerance`
/// is the coarsest tolerance; `time.step` is the longest step where bodies move, and longer steps
/// are used where nothing moves. A number alone is the share: `accuracy: 0.03`.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct AccuracySpec {
    /// Share of the result by which step and tolerance together may change it.
    #[schemars(default = "share")]
    pub share: f64,
    /// The result.
    #[schemars(default)]
    pub of: AccurateResult,
    /// Smallest step (s); a sixty-fourth of `time.step` by default.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub finest_step: Option<f64>,
    /// Largest step (s) where nothing moves; 100 times `time.step` by default, and `time.step` for
    /// steps that do not grow.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub largest_step: Option<f64>,
    /// Smallest tolerance; 1/256 of the case's by default.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub finest_tolerance: Option<f64>,
    /// Share of the cost of the run that repeated steps may take, by which it measures its error.
    #[schemars(default = "effort")]
    pub effort: f64,
}

impl AccuracySpec {
    /// Returns the largest step (s) where nothing moves, for a case with this `time.step`.
    pub fn largest(&self, step: f64) -> f64 {
        self.largest_step.unwrap_or(LARGEST * step)
    }
}

/// Default ratio of the largest step to that of the case.
const LARGEST: f64 = 100.0;

/// Fields of [`AccuracySpec`] as a case gives them.
#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename = "AccuracySpec")]
struct AccuracyFields {
    #[serde(default = "share")]
    share: f64,
    #[serde(default)]
    of: AccurateResult,
    #[serde(default)]
    finest_step: Option<f64>,
    #[serde(default)]
    largest_step: Option<f64>,
    #[serde(default)]
    finest_tolerance: Option<f64>,
    #[serde(default = "effort")]
    effort: f64,
}

fn share() -> f64 {
    0.03
}

fn effort() -> f64 {
    0.2
}

impl From<AccuracyFields> for AccuracySpec {
    fn from(fields: AccuracyFields) -> Self {
        Self {
            share: fields.share,
            of: fields.of,
            finest_step: fields.finest_step,
            largest_step: fields.largest_step,
            finest_tolerance: fields.finest_tolerance,
            effort: fields.effort,
        }
    }
}

impl<'de> Deserialize<'de> for AccuracySpec {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        struct ShareOrFields;

        impl<'de> Visitor<'de> for ShareOrFields {
            type Value = AccuracySpec;

            fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str("a share such as 0.03, or `(share: 0.03, ...)`")
            }

            fn visit_f64<E: serde::de::Error>(self, share: f64) -> Result<AccuracySpec, E> {
                Ok(AccuracySpec {
                    share,
                    of: AccurateResult::default(),
                    finest_step: None,
                    largest_step: None,
                    finest_tolerance: None,
                    effort: effort(),
                })
            }

            fn visit_u64<E: serde::de::Error>(self, share: u64) -> Result<AccuracySpec, E> {
                self.visit_f64(share as f64)
            }

            fn visit_i64<E: serde::de::Error>(self, share: i64) -> Result<AccuracySpec, E> {
                self.visit_f64(share as f64)
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<AccuracySpec, A::Error> {
                AccuracyFields::deserialize(MapAccessDeserializer::new(map)).map(AccuracySpec::from)
            }
        }

        from.deserialize_any(ShareOrFields)
    }
}
