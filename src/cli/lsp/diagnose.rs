//! Errors of the reader and the checker as diagnostics.

use super::Server;
use super::document::Document;
use crate::cli::observers;
use crate::record::check_names;
use crate::scene::material::{Material, MaterialLibrary};
use crate::scene::source::fields_of;
use crate::scene::{InputError, LoadedCase, load_text};
use lsp_types::{Diagnostic, DiagnosticSeverity, Range};
use std::path::Path;

/// Returns the errors of a file: of reading it, and of building its scene if `whole`.
pub fn diagnostics(server: &Server, document: &Document, whole: bool) -> Vec<Diagnostic> {
    let name = document.path.display().to_string();
    let found = match kind(document) {
        Kind::Case => {
            let folder = document.path.parent().unwrap_or(Path::new(""));
            let loaded = load_text(&name, &document.text, folder, &[]);
            loaded.and_then(|loaded| match whole {
                true => build(server, &loaded),
                false => Ok(()),
            })
        }
        Kind::Material => material(&name, &document.text),
        Kind::Other => Ok(()),
    };
    let error = found.err();
    error
        .map(|error| diagnostic(document, &name, &error))
        .into_iter()
        .collect()
}

fn build(server: &Server, loaded: &LoadedCase) -> Result<(), InputError> {
    let built = loaded.build(&server.search)?;
    let observers = observers::all(loaded, built.simulation.view());
    check_names(loaded, &observers)
}

fn material(name: &str, text: &str) -> Result<(), InputError> {
    let source = MaterialLibrary::read_text(name, text)?;
    let material: Material = source.parse()?;
    material.density().map_err(|fault| source.locate(fault))?;
    Ok(())
}

/// What a file is, by its fields.
enum Kind {
    Case,
    Material,
    /// A study or fit, or no input of this program.
    Other,
}

fn kind(document: &Document) -> Kind {
    let names = fields_of(&document.path, &document.text);
    let has = |name: &&str| names.iter().any(|n| n == name);
    let of_case = ["interfaces", "bodies", "grains", "materials", "name"]
        .iter()
        .any(&has);
    match () {
        // Of a study, a fit or a trade.
        () if has(&"case") => Kind::Other,
        () if has(&"dimension") || has(&"time") && of_case => Kind::Case,
        () if has(&"density") && has(&"doc") => Kind::Material,
        () => Kind::Other,
    }
}

/// An error of this file at its place, or one of another file at the beginning.
fn diagnostic(document: &Document, name: &str, error: &InputError) -> Diagnostic {
    let own = error.file == name;
    let range = match error.span().filter(|_| own) {
        Some(span) => document.range(&(span.start..span.end.max(span.start + 1))),
        None => Range::default(),
    };
    let mut message = match own {
        true => error.message.clone(),
        false => error.with_line(),
    };
    if let Some(expected) = &error.expected {
        message += &format!("\nexpected {expected}");
    }
    if let Some(help) = &error.help {
        message += &format!("\n{help}");
    }
    Diagnostic {
        range,
        severity: Some(DiagnosticSeverity::ERROR),
        source: Some("fretwork".to_owned()),
        message,
        ..Diagnostic::default()
    }
}
