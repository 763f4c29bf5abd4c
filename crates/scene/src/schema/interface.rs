//! Laws and their parameters in the schema.

use fretwork_core::laws::{Kind, Plugin};
use serde_json::{Map, Value, json};
use std::collections::BTreeMap;

/// Puts the slots of an interface in the place of the fields that hold them in Rust, with the names
/// and parameters of laws.
pub(super) fn spread_slots(defs: &mut Value, laws: &[Plugin]) {
    if let Some(fields) = properties(defs, "InterfaceSpec") {
        fields.remove("laws");
        for kind in Kind::all() {
            fields.insert(kind.word().to_owned(), law(kind, laws));
        }
        let of = |one: &dyn Fn(Kind) -> Value| by_slot(one);
        set(fields, "parameters", of(&|kind| parameters(kind, laws)));
        set(fields, "tables", of(&|_| json!({"type": "string"})));
    }
    let required = json!(["name", "between", Kind::CONTACT.word()]);
    defs["InterfaceSpec"]["required"] = required;
    defs["InterfaceSpec"]["additionalProperties"] = false.into();
    if let Some(fields) = properties(defs, "InterfaceParameters") {
        fields.remove("slots");
        let numbers = json!({
            "type": "object",
            "additionalProperties": {
                "type": "object",
                "additionalProperties": {"$ref": "#/$defs/Sourced"},
            },
        });
        for kind in Kind::all() {
            fields.insert(kind.word().to_owned(), numbers.clone());
        }
    }
    defs["InterfaceParameters"]["required"] = json!([]);
    defs["InterfaceParameters"]["additionalProperties"] = false.into();
}

fn properties<'a>(defs: &'a mut Value, name: &str) -> Option<&'a mut Map<String, Value>> {
    defs.get_mut(name)?.get_mut("properties")?.as_object_mut()
}

/// Replaces a property and keeps its documentation.
fn set(fields: &mut Map<String, Value>, name: &str, mut new: Value) {
    if let Some(doc) = fields.get(name).and_then(|old| old.get("description")) {
        new["description"] = doc.clone();
    }
    fields.insert(name.to_owned(), new);
}

fn by_slot(of: &dyn Fn(Kind) -> Value) -> Value {
    let kinds = Kind::all();
    let slots = kinds.iter().map(|kind| (kind.word().to_owned(), of(*kind)));
    json!({
        "type": "object",
        "properties": slots.collect::<Map<_, _>>(),
        "additionalProperties": false,
    })
}

/// The names of the laws of a kind.
fn law(kind: Kind, laws: &[Plugin]) -> Value {
    let own = laws.iter().filter(|law| law.kind == kind);
    let mut names: Vec<Value> = own
        .map(|law| json!({"const": law.name, "description": law.doc}))
        .collect();
    // A law on another plugin path.
    names.push(json!({"type": "string"}));
    if kind != Kind::CONTACT {
        names.push(json!({"type": "null"}));
    }
    json!({"description": format!("Name of the {kind} law."), "anyOf": names})
}

/// The parameters of the laws of a kind: each with what the laws that have it say about it.
fn parameters(kind: Kind, laws: &[Plugin]) -> Value {
    let mut found: BTreeMap<&str, Vec<(&Plugin, usize)>> = BTreeMap::new();
    for law in laws.iter().filter(|law| law.kind == kind) {
        for (k, parameter) in law.parameters.iter().enumerate() {
            found.entry(&parameter.name).or_default().push((law, k));
        }
    }
    let described = found.into_iter().map(|(name, owners)| {
        let lines = owners.iter().map(|(law, k)| {
            let p = &law.parameters[*k];
            let unit = match p.unit.is_empty() {
                true => String::new(),
                false => format!(" {}", p.unit),
            };
            format!(
                "{}: {} (default {:e}{unit}, from {:e} to {:e})",
                law.name, p.doc, p.default, p.minimum, p.maximum
            )
        });
        let lines: Vec<String> = lines.collect();
        let field = json!({
            "description": lines.join("\n\n"),
            "allOf": [{"$ref": "#/$defs/NumberSpec"}],
        });
        (name.to_owned(), field)
    });
    json!({
        "type": "object",
        "properties": described.collect::<Map<_, _>>(),
        "additionalProperties": {"$ref": "#/$defs/NumberSpec"},
    })
}
