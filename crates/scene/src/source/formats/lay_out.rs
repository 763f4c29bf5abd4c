//! Texts of values, laid out in lines of at most 100 characters.

use super::Format;
use super::item::{Item, ItemKind, is_word};
use crate::source::tree::{Group, Node, Shape};

/// Characters of a line, above which a group has a line for each entry.
const WIDE: usize = 100;

/// Spaces of a level.
const STEP: usize = 4;

/// Returns a value as JSON or YAML. An infinite number is a text in JSON, which has none.
pub(super) fn item(item: &Item, format: Format) -> String {
    let mut out = String::new();
    match (format, &item.kind) {
        (Format::Yaml, ItemKind::Object(entries)) if !entries.is_empty() => {
            block(item, 0, false, &mut out);
            out.remove(0);
        }
        (Format::Yaml, _) => out = flow(item, true),
        _ => json(item, 0, &mut out),
    }
    out.trim_end().to_owned() + "\n"
}

/// Writes JSON.
fn json(item: &Item, depth: usize, out: &mut String) {
    let short = flow(item, false);
    let leaf = !matches!(item.kind, ItemKind::List(_) | ItemKind::Object(_));
    if leaf || depth > 0 && fits(&short, depth, out) {
        *out += &short;
        return;
    }
    let line = |out: &mut String, depth: usize| {
        *out += "\n";
        *out += &" ".repeat(STEP * depth);
    };
    let (brackets, count) = match &item.kind {
        ItemKind::List(items) => (["[", "]"], items.len()),
        ItemKind::Object(entries) => (["{", "}"], entries.len()),
        _ => return,
    };
    *out += brackets[0];
    for k in 0..count {
        line(out, depth + 1);
        match &item.kind {
            ItemKind::List(items) => json(&items[k], depth + 1, out),
            ItemKind::Object(entries) => {
                *out += &quoted(&entries[k].0.name);
                *out += ": ";
                json(&entries[k].1, depth + 1, out);
            }
            _ => {}
        }
        *out += if k + 1 < count { "," } else { "" };
    }
    line(out, depth);
    *out += brackets[1];
}

/// Whether a text fits behind the last line of another.
fn fits(short: &str, depth: usize, out: &str) -> bool {
    let line = out.rsplit('\n').next().unwrap_or_default();
    !short.contains('\n') && line.chars().count().max(STEP * depth) + short.chars().count() < WIDE
}

/// Writes a value of YAML in lines below its key, the first of them behind the dash of a list if
/// `dashed`.
fn block(item: &Item, depth: usize, dashed: bool, out: &mut String) {
    let indent = format!("\n{}", " ".repeat(2 * depth));
    let short = flow(item, true);
    let (count, list) = match &item.kind {
        ItemKind::List(items) => (items.len(), true),
        ItemKind::Object(entries) => (entries.len(), false),
        _ => (0, false),
    };
    if count == 0 || depth > 0 && fits(&short, depth, out) {
        *out += " ";
        *out += &short;
        return;
    }
    for k in 0..count {
        *out += if dashed && k == 0 { " " } else { &indent };
        match &item.kind {
            ItemKind::List(items) if list => {
                *out += "-";
                block(&items[k], depth + 1, true, out);
            }
            ItemKind::Object(entries) => {
                *out += &key(&entries[k].0.name, true);
                *out += ":";
                block(&entries[k].1, depth + 1, false, out);
            }
            _ => {}
        }
    }
}

/// Returns a value on one line.
fn flow(item: &Item, yaml: bool) -> String {
    match &item.kind {
        ItemKind::Null => "null".to_owned(),
        ItemKind::Bool(value) => value.to_string(),
        ItemKind::Number(number) => match (number.as_str(), yaml) {
            ("inf", true) => ".inf".to_owned(),
            ("-inf", true) => "-.inf".to_owned(),
            ("NaN", true) => ".nan".to_owned(),
            ("inf" | "-inf" | "NaN", false) => quoted(number),
            (number, _) => number.to_owned(),
        },
        ItemKind::Text(text) => quoted(&text.content),
        ItemKind::List(items) => {
            let items: Vec<String> = items.iter().map(|item| flow(item, yaml)).collect();
            format!("[{}]", items.join(", "))
        }
        ItemKind::Object(entries) => {
            let one = |(k, v): &(super::item::Key, Item)| {
                format!("{}: {}", key(&k.name, yaml), flow(v, yaml))
            };
            let entries: Vec<String> = entries.iter().map(one).collect();
            format!("{{{}}}", entries.join(", "))
        }
    }
}

/// Returns a key; YAML needs no quotes for words that are no values of its own.
fn key(name: &str, yaml: bool) -> String {
    let value = matches!(
        name.to_lowercase().as_str(),
        "null" | "true" | "false" | "yes" | "no" | "on" | "off" | "y" | "n"
    );
    match yaml && is_word(name) && (!value || name.len() == 1) {
        true => name.to_owned(),
        false => quoted(name),
    }
}

fn quoted(text: &str) -> String {
    serde_json::Value::from(text).to_string()
}

/// Returns a value of a RON text without its comments, laid out anew.
pub(super) fn ron(text: &str, root: &Node) -> String {
    let mut out = String::new();
    ron_value(text, root, 0, &mut out);
    out + "\n"
}

fn ron_value(text: &str, node: &Node, depth: usize, out: &mut String) {
    let Some(group) = node.group() else {
        *out += text[node.span.clone()].trim();
        return;
    };
    let short = ron_flow(text, node);
    if depth > 0 && fits(&short, depth, out) || group.entries.is_empty() {
        *out += &short;
        return;
    }
    let (open, close) = brackets(text, group);
    *out += &open;
    for entry in &group.entries {
        *out += "\n";
        *out += &" ".repeat(STEP * (depth + 1));
        if let Some(key) = &entry.key {
            *out += &text[key.clone()];
            *out += ": ";
        }
        ron_value(text, &entry.value, depth + 1, out);
        *out += ",";
    }
    *out += "\n";
    *out += &" ".repeat(STEP * depth);
    *out += close;
}

/// Returns the name with the opening bracket, and the closing one.
fn brackets(text: &str, group: &Group) -> (String, &'static str) {
    let name = group.name.clone().map_or("", |name| &text[name]);
    let (open, close) = match group.shape {
        Shape::List => ("[", "]"),
        Shape::Map => ("{", "}"),
        Shape::Struct | Shape::Tuple => ("(", ")"),
    };
    (format!("{name}{open}"), close)
}

fn ron_flow(text: &str, node: &Node) -> String {
    let Some(group) = node.group() else {
        return text[node.span.clone()].to_owned();
    };
    let entry = |e: &crate::source::Entry| match &e.key {
        Some(key) => format!("{}: {}", &text[key.clone()], ron_flow(text, &e.value)),
        None => ron_flow(text, &e.value),
    };
    let entries: Vec<String> = group.entries.iter().map(entry).collect();
    let (open, close) = brackets(text, group);
    format!("{open}{}{close}", entries.join(", "))
}
