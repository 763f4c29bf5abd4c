//! Schemas of types that read several notations.

use crate::case::{CaseMaterials, Coordinates};
use crate::material::{Material, NumberSpec};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde_json::{Value, json};
use std::borrow::Cow;

impl JsonSchema for NumberSpec {
    fn schema_name() -> Cow<'static, str> {
        "NumberSpec".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "description": "A number, with its unit if it has one.",
            "anyOf": [
                {"type": "number"},
                {
                    "type": "object",
                    "properties": {
                        "value": {"type": "number"},
                        "unit": {"type": "string"},
                        "source": {"type": "string"},
                    },
                    "required": ["value"],
                    "additionalProperties": false,
                },
            ],
        })
    }
}

impl JsonSchema for Coordinates {
    fn schema_name() -> Cow<'static, str> {
        "Coordinates".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "description": "A point (m): x and y, in 3D also z.",
            "type": "array",
            "items": {"type": "number"},
            "minItems": 2,
            "maxItems": 3,
        })
    }
}

impl JsonSchema for CaseMaterials {
    fn schema_name() -> Cow<'static, str> {
        "CaseMaterials".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let own = generator.subschema_for::<Material>();
        json_schema!({
            "type": "object",
            "additionalProperties": {"anyOf": [{"type": "string"}, own]},
        })
    }
}

/// Allows a number where a type reads one in place of its fields: a constant as a function of time,
/// a share as an accuracy.
pub(super) fn allow_short_forms(defs: &mut Value) {
    let number = defs["NumberSpec"]["anyOf"][0].clone();
    for name in ["TimeFunction", "AccuracySpec"] {
        let long = defs[name].take();
        let description = long["description"].clone();
        defs[name] = json!({"description": description, "anyOf": [number, long]});
    }
    // All its fields have defaults.
    if let Some(long) = defs["AccuracySpec"]["anyOf"][1].as_object_mut() {
        long.remove("required");
        long.insert("additionalProperties".to_owned(), false.into());
    }
}
