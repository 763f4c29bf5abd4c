//! Values of a case as JSON, by the key paths of `--set`.

use serde_json::{Map, Value};

/// Returns the object with the fields of a value: a variant is `{"Name": {fields}}`, and its fields
/// are addressed without the variant.
fn inner<'a>(mut value: &'a Value, part: &str) -> &'a Value {
    while let Some(name) = variant(value).filter(|name| *name != part) {
        value = &value[name];
    }
    value
}

/// Returns the name of the variant of a value, if it is a variant with content.
fn variant(value: &Value) -> Option<&str> {
    let object = value.as_object().filter(|o| o.len() == 1)?;
    let name = object.keys().next()?;
    name.starts_with(|c: char| c.is_ascii_uppercase())
        .then_some(name.as_str())
}

/// Returns the index of an element of a list, from its number or its name.
fn index(list: &[Value], part: &str) -> Option<usize> {
    match part.parse::<usize>() {
        Ok(k) => (k < list.len()).then_some(k),
        Err(_) => list
            .iter()
            .position(|element| inner(element, "name")["name"] == *part),
    }
}

/// The value at a path.
pub(crate) fn find<'a>(root: &'a Value, path: &[String]) -> Option<&'a Value> {
    path.iter().try_fold(root, |value, part| {
        let value = inner(value, part);
        match value {
            Value::Array(list) => list.get(index(list, part)?),
            _ => value.get(part),
        }
    })
}

/// Sets a value at a path, with the structs and maps around it. If this is impossible, returns the
/// first part of the path that cannot exist.
pub(crate) fn put<'a>(root: &mut Value, path: &'a [String], new: Value) -> Result<(), &'a str> {
    let Some((part, rest)) = path.split_first() else {
        *root = new;
        return Ok(());
    };
    if let Some(name) = variant(root).filter(|name| name != part) {
        let name = name.to_owned();
        return put(&mut root[name], path, new);
    }
    if root.is_null() {
        *root = Value::Object(Map::new());
    }
    match root {
        Value::Array(list) => {
            let k = index(list, part).ok_or(part.as_str())?;
            put(&mut list[k], rest, new)
        }
        Value::Object(object) => put(object.entry(part).or_insert(Value::Null), rest, new),
        _ => Err(part),
    }
}

/// Whether a value contains an object.
pub(crate) fn has_object(value: &Value) -> bool {
    match value {
        Value::Object(_) => true,
        Value::Array(list) => list.iter().any(has_object),
        _ => false,
    }
}

/// A value without objects as RON.
pub(crate) fn ron(value: &Value) -> String {
    match value {
        Value::Null => "None".to_owned(),
        Value::Array(list) => {
            let list: Vec<String> = list.iter().map(ron).collect();
            format!("[{}]", list.join(", "))
        }
        // Texts of JSON are texts of RON, except for characters written as \u0000.
        Value::String(text) => {
            let escaped = text.replace('\\', "\\\\").replace('"', "\\\"");
            format!("\"{escaped}\"")
        }
        other => other.to_string(),
    }
}
