//! What a name or value is: documentation, unit and default.

use super::Server;
use super::complete::{law_of, only_of};
use super::document::Document;
use crate::scene::Case;
use crate::scene::material::MaterialLibrary;
use crate::scene::source::Source;
use lsp_types::{Hover, HoverContents, MarkupContent, MarkupKind, Position};

/// Returns what is at a position.
pub fn hover(server: &Server, document: &Document, position: Position) -> Option<Hover> {
    let name = document.path.display().to_string();
    let source = Case::source_of_text(&name, &document.text).ok()?;
    let place = source.place_at(document.byte(position))?;
    let written = document.text.get(place.span.clone())?.trim_matches('"');
    let mut parts = Vec::new();
    // A law by its name, a variant, or else the field whose value it is.
    let values = server.schema.values(&place.path);
    let value = values.iter().find(|value| value.name == written);
    let of_material = material(document, &place.path, written);
    parts.extend(
        value
            .map(|v| v.doc.clone())
            .filter(|doc| !doc.is_empty())
            .or(of_material),
    );
    if parts.is_empty() {
        let doc = server.schema.doc(&place.path);
        let law = law_of(&source, &place.path);
        let own = law.and_then(|law| only_of(&law, doc.as_deref()?).map(str::to_owned));
        parts.extend(own.or(doc));
    }
    match Case::unit_at(&place.path, dimension(&source)) {
        Some("") | None => {}
        Some(unit) => parts.push(format!("Unit: `{unit}`")),
    }
    if parts.is_empty() {
        return None;
    }
    Some(Hover {
        contents: HoverContents::Markup(MarkupContent {
            kind: MarkupKind::Markdown,
            value: parts.join("\n\n"),
        }),
        range: Some(document.range(&place.span)),
    })
}

/// The dimension that a text gives, 3 by default.
pub fn dimension(source: &Source) -> usize {
    let found = source.tree().find(source.text(), &["dimension".to_owned()]);
    match found.is_ok_and(|node| &source.text()[node.span.clone()] == "2") {
        true => 2,
        false => 3,
    }
}

/// The description of the material that an entry of `materials` names.
fn material(document: &Document, path: &[String], name: &str) -> Option<String> {
    if path.len() != 2 || path[0] != "materials" {
        return None;
    }
    let source = MaterialLibrary::beside(&document.path).read(name).ok()?;
    let material: crate::scene::material::Material = source.parse().ok()?;
    let density = material.density().ok()?;
    Some(format!("{}\n\nDensity: {density} kg/m^3", material.doc))
}
