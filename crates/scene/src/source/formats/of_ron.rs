//! RON texts as values of JSON and YAML.

use super::item::{Item, ItemKind, Key, Text};
use crate::quantity;
use crate::source::tree::{Group, Node, Shape, ValueKind, plain, unquoted};
use crate::source::{InputError, Source};

/// Returns a value of a well-formed text: variants become objects with one key, `Some(x)` is `x`,
/// numbers with units are texts.
pub(super) fn item(source: &Source, node: &Node) -> Result<Item, InputError> {
    let node = node.unwrap_some(source.text());
    let written = &source.text()[node.span.clone()];
    let text = |content: String| ItemKind::Text(Text { content, at: None });
    let kind = match &node.kind {
        ValueKind::Number => number(source, node)?,
        ValueKind::Quantity(_) => text(written.to_owned()),
        ValueKind::Text => text(node.string(source.text()).unwrap_or_default()),
        ValueKind::Word => match written {
            "None" => ItemKind::Null,
            "true" => ItemKind::Bool(true),
            "false" => ItemKind::Bool(false),
            word => text(plain(word).to_owned()),
        },
        ValueKind::Group(group) => group_of(source, group)?,
        ValueKind::Char | ValueKind::Other => {
            return Err(source.error_in(&node.span, "JSON and YAML have no such value"));
        }
    };
    Ok(Item {
        span: node.span.clone(),
        kind,
    })
}

/// Returns a group, within the object of its variant if it has a name.
fn group_of(source: &Source, group: &Group) -> Result<ItemKind, InputError> {
    let entries = &group.entries;
    let items = || -> Result<Vec<Item>, InputError> {
        entries.iter().map(|e| item(source, &e.value)).collect()
    };
    let inner = match (group.shape, group.name.is_some(), entries.as_slice()) {
        (Shape::List, ..) => ItemKind::List(items()?),
        (Shape::Tuple, _, []) => ItemKind::Object(Vec::new()),
        (Shape::Tuple, true, [only]) => item(source, &only.value)?.kind,
        (Shape::Tuple, ..) => ItemKind::List(items()?),
        (Shape::Struct | Shape::Map, ..) => {
            let keys = entries.iter().map(|e| e.key.clone().unwrap_or_default());
            let keys = keys.map(|span| {
                let name = unquoted(&source.text()[span.clone()]);
                Key { name, span }
            });
            ItemKind::Object(keys.zip(items()?).collect())
        }
    };
    let Some(name) = &group.name else {
        return Ok(inner);
    };
    let key = Key {
        name: plain(&source.text()[name.clone()]).to_owned(),
        span: name.clone(),
    };
    let content = Item {
        span: name.clone(),
        kind: inner,
    };
    Ok(ItemKind::Object(vec![(key, content)]))
}

/// Returns a number in the spelling of JSON.
fn number(source: &Source, node: &Node) -> Result<ItemKind, InputError> {
    let written = source.text()[node.span.clone()].replace('_', "");
    if let "inf" | "-inf" | "NaN" = written.as_str() {
        return Ok(ItemKind::Number(written));
    }
    if quantity::parts(&written).0 != written.len() {
        let error = source.error_in(&node.span, "the number has a base or type");
        return Err(error.expected("a decimal number"));
    }
    let (sign, digits) = match written.strip_prefix('-') {
        Some(digits) => ("-", digits),
        None => ("", written.trim_start_matches('+')),
    };
    // JSON has a digit on both sides of the point, and no zeros in front.
    let (mantissa, exponent) = match digits.find(['e', 'E']) {
        Some(at) => digits.split_at(at),
        None => (digits, ""),
    };
    let (whole, decimals) = match mantissa.split_once('.') {
        Some((whole, decimals)) => (whole, Some(decimals)),
        None => (mantissa, None),
    };
    let whole = match whole.trim_start_matches('0') {
        "" => "0",
        whole => whole,
    };
    let decimals = match decimals {
        Some("") => ".0".to_owned(),
        Some(decimals) => format!(".{decimals}"),
        None => String::new(),
    };
    Ok(ItemKind::Number(format!(
        "{sign}{whole}{decimals}{exponent}"
    )))
}
