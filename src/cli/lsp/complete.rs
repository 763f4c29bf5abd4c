//! What may be written at a place: fields, variants, laws and their parameters, materials, units.

use super::Server;
use super::document::Document;
use super::hover::dimension;
use crate::laws::Kind;
use crate::scene::Case;
use crate::scene::material::MaterialLibrary;
use crate::scene::schema::Described;
use crate::scene::source::{CursorSlot, SlotKind, Source};
use crate::scene::units;
use lsp_types::{CompletionItem, CompletionItemKind, Documentation, Position};

/// Returns what may be written at a position.
pub fn items(server: &Server, document: &Document, position: Position) -> Vec<CompletionItem> {
    let source = Source::from_text(&document.path, document.text.as_str());
    let Some(slot) = source.slot_at(document.byte(position)) else {
        return Vec::new();
    };
    let described = |kind: CompletionItemKind, found: Vec<Described>| -> Vec<CompletionItem> {
        let items = found.into_iter().map(|d| item(&d.name, kind, d.doc));
        items.collect()
    };
    let quoted = |items: Vec<CompletionItem>| in_quotes(items, slot.quoted);
    match slot.kind {
        SlotKind::Unit => {
            let unit = Case::unit_at(&slot.path, dimension(&source)).or_else(|| {
                let doc = server.schema.doc(&slot.path)?;
                // The unit of a law's parameter stands in its documentation.
                let known = units::all().iter().copied();
                known
                    .into_iter()
                    .find(|unit| doc.contains(&format!(" {unit}, from ")))
            });
            let units = unit.map(units::usual).unwrap_or_default();
            let unit = |name| item(name, CompletionItemKind::UNIT, String::new());
            units.into_iter().map(unit).collect()
        }
        SlotKind::Field => {
            let mut fields = server.schema.fields(&slot.path);
            fields.retain(|field| !slot.present.contains(&field.name));
            let mut items = described(CompletionItemKind::FIELD, fields);
            for item in &mut items {
                item.insert_text = Some(format!("{}: ", item.label));
            }
            items.extend(described(
                CompletionItemKind::ENUM_MEMBER,
                server.schema.values(&slot.path),
            ));
            items
        }
        SlotKind::Key => {
            let mut keys = server.schema.fields(&slot.path);
            keys.retain(|key| !slot.present.contains(&key.name));
            if let Some(law) = law_of(&source, &slot.path) {
                let own = |key: &Described| only_of(&law, &key.doc).is_some();
                if keys.iter().any(own) {
                    keys.retain(own);
                }
            }
            quoted(described(CompletionItemKind::FIELD, keys))
        }
        SlotKind::Value => match names(&source, &slot, document) {
            Some(names) => {
                let items = names.into_iter();
                let value =
                    |(name, doc): (String, String)| item(&name, CompletionItemKind::VALUE, doc);
                quoted(items.map(value).collect())
            }
            None => {
                let values = server.schema.values(&slot.path);
                let law = slot.path.last().and_then(|name| Kind::from_word(name));
                match law.filter(|_| slot.path.first().is_some_and(|n| n == "interfaces")) {
                    Some(_) => quoted(described(CompletionItemKind::FUNCTION, values)),
                    None if slot.quoted => Vec::new(),
                    None => described(CompletionItemKind::ENUM_MEMBER, values),
                }
            }
        },
    }
}

/// The name of the law that an interface has beside the parameters at a path.
pub fn law_of(source: &Source, path: &[String]) -> Option<String> {
    let [list, index, parameters, kind, ..] = path else {
        return None;
    };
    if list != "interfaces" || parameters != "parameters" {
        return None;
    }
    let law = [list, index, kind].map(String::clone);
    let node = source.tree().find(source.text(), &law).ok()?;
    node.unwrap_some(source.text()).string(source.text())
}

/// What the documentation of a parameter, a line for each law that has it, says of one law.
pub fn only_of<'d>(law: &str, doc: &'d str) -> Option<&'d str> {
    doc.lines().find(|line| {
        line.strip_prefix(law)
            .is_some_and(|rest| rest.starts_with(": "))
    })
}

fn item(name: &str, kind: CompletionItemKind, doc: String) -> CompletionItem {
    CompletionItem {
        label: name.to_owned(),
        kind: Some(kind),
        documentation: (!doc.is_empty()).then_some(Documentation::String(doc)),
        ..CompletionItem::default()
    }
}

/// Puts names in quotes, unless these are open.
fn in_quotes(mut items: Vec<CompletionItem>, open: bool) -> Vec<CompletionItem> {
    for item in items.iter_mut().filter(|_| !open) {
        item.insert_text = Some(format!("\"{}\"", item.label));
    }
    items
}

/// Names that a value takes from the case or the library of materials.
fn names(source: &Source, slot: &CursorSlot, document: &Document) -> Option<Vec<(String, String)>> {
    let last = slot.path.last()?.as_str();
    let above = slot.path.iter().nth_back(1).map(String::as_str);
    if slot.path.len() == 2 && above == Some("materials") {
        let library = MaterialLibrary::beside(&document.path);
        let doc = |listed: &crate::scene::material::Listed| {
            listed
                .material
                .as_ref()
                .map_or_else(|_| String::new(), |m| m.doc.clone())
        };
        let listed = library.list();
        return Some(listed.iter().map(|l| (l.name.clone(), doc(l))).collect());
    }
    let of = |list: &str, field: Option<&str>| {
        let node = source.tree().find(source.text(), &[list.to_owned()]).ok();
        let entries = node.and_then(|node| node.group()).map(|g| &g.entries);
        let name = |e: &crate::scene::source::Entry| match field {
            None => e
                .key
                .clone()
                .map(|key| source.text()[key].trim_matches('"').to_owned()),
            Some(field) => {
                let group = e.value.group()?;
                let own = |f: &&crate::scene::source::Entry| {
                    f.key
                        .as_ref()
                        .is_some_and(|key| &source.text()[key.clone()] == field)
                };
                group.entries.iter().find(own)?.value.string(source.text())
            }
        };
        let found = entries.into_iter().flatten().filter_map(name);
        Some(found.map(|name| (name, String::new())).collect())
    };
    match (last, above) {
        ("material", _) => of("materials", None),
        ("0" | "1", Some("between")) if slot.path[0] == "interfaces" => of("materials", None),
        ("body", Some("friction")) => of("bodies", Some("name")),
        _ => None,
    }
}
