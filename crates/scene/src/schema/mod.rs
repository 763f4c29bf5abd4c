//! The JSON Schema of cases: fields with their documentation and defaults, from the types that are
//! read, and laws with their parameters, from their descriptors.

mod amounts;
mod interface;
mod lookup;
mod own;

pub use lookup::{Described, Schema};

use crate::case::Case;
use fretwork_core::laws::Plugin;
use schemars::generate::SchemaSettings;
use serde_json::Value;

/// Returns the JSON Schema (draft 2020-12) of a case in JSON or YAML, with these laws. Numbers may
/// be texts with units or expressions. Names of other laws are valid too: a plugin path may hold
/// them.
pub fn case(laws: &[Plugin]) -> Value {
    let generator = SchemaSettings::draft2020_12().into_generator();
    let mut schema = generator.into_root_schema_for::<Case>().to_value();
    amounts::allow(&mut schema);
    if let Some(defs) = schema.get_mut("$defs") {
        interface::spread_slots(defs, laws);
        own::allow_short_forms(defs);
    }
    schema
}
