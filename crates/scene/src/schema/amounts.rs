//! Numbers of a schema: also texts with units, and expressions.

use serde_json::{Value, json};

/// Begin of a number with a unit, or an expression.
const AMOUNT: &str = r"^\s*([-+.0-9]|\$\{|inf$|NaN$)";

/// Allows texts with units and expressions for all numbers of a schema.
pub(super) fn allow(schema: &mut Value) {
    match schema {
        Value::Object(fields) => {
            let number = |kind: &Value| kind == "number" || kind == "integer";
            let list = |kind: &Value| match kind {
                Value::Array(kinds) => kinds.clone(),
                kind => vec![kind.clone()],
            };
            if let Some(kinds) = fields.get("type").map(list)
                && kinds.iter().any(number)
            {
                let kinds: Vec<Value> = kinds.into_iter().chain([json!("string")]).collect();
                fields.insert("type".to_owned(), kinds.into());
                fields.insert("pattern".to_owned(), json!(AMOUNT));
                fields.remove("format");
            }
            // Defaults and examples are values, not schemas.
            let own = |key: &str| !matches!(key, "default" | "examples" | "const" | "enum");
            let inner = fields.iter_mut().filter(|(key, _)| own(key));
            inner.for_each(|(_, value)| allow(value));
        }
        Value::Array(values) => values.iter_mut().for_each(allow),
        _ => {}
    }
}
