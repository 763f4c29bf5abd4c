//! Infinite numbers of cases in JSON, which has none: the second largest number represents
//! infinity, here and in `fretwork/_values.py`.

use fretwork::scene::source::Tree;
use fretwork::scene::{Case, InputError};
use serde_json::Value;

/// Number that represents infinity.
const INFINITE: f64 = f64::MAX.next_down();

/// Returns all values of a case that it does not omit.
pub(crate) fn json_of(case: &Case) -> Value {
    let mut value = serde_json::to_value(case).unwrap_or_default();
    // Infinite numbers are written as null.
    if has_null(&value)
        && let Ok(text) = case.to_ron()
    {
        let tree = Tree::of(&text);
        restore(&mut value, &text, &tree, &mut Vec::new());
    }
    value
}

fn has_null(value: &Value) -> bool {
    match value {
        Value::Null => true,
        Value::Array(list) => list.iter().any(has_null),
        Value::Object(fields) => fields.values().any(has_null),
        _ => false,
    }
}

/// Replaces nulls by the numbers that the text has in their place.
fn restore(value: &mut Value, text: &str, tree: &Tree, path: &mut Vec<String>) {
    match value {
        Value::Null => {
            let node = tree.find(text, path).ok();
            let number = node.and_then(|node| text[node.span.clone()].parse::<f64>().ok());
            if let Some(number) = number.filter(|x| x.is_infinite()) {
                *value = INFINITE.copysign(number).into();
            }
        }
        Value::Array(list) => {
            for (k, element) in list.iter_mut().enumerate() {
                path.push(k.to_string());
                restore(element, text, tree, path);
                path.pop();
            }
        }
        Value::Object(fields) => {
            for (name, field) in fields {
                // A path names the fields of a variant without the variant.
                let variant = name.starts_with(|c: char| c.is_ascii_uppercase());
                if !variant {
                    path.push(name.clone());
                }
                restore(field, text, tree, path);
                if !variant {
                    path.pop();
                }
            }
        }
        _ => {}
    }
}

/// The text of a case that was read from JSON.
///
/// # Errors
/// Writes a case as [`Case::to_ron`] does, with infinite numbers.
pub(crate) fn ron_of(case: &Case) -> Result<String, InputError> {
    Ok(case.to_ron()?.replace(&format!("{INFINITE:?}"), "inf"))
}
