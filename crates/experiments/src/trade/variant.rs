//! The option `--variant NAME=FILE`: other files as forms of the case, given from the finest to the
//! coarsest.

use super::varied::{ParameterEffect, Varied};
use crate::Error;
use crate::factor::Level;
use crate::load;
use fretwork_scene::case::Case;
use fretwork_scene::source::{Source, Tree};
use fretwork_scene::{InputError, LoadedCase};
use std::collections::BTreeSet;
use std::path::Path;

/// Returns the text of a field of a struct, on one line; `None` if the text omits it.
pub fn field(text: &str, name: &str) -> Option<String> {
    let tree = Tree::of(text);
    let node = tree.find(text, &[name.to_owned()]).ok()?;
    let lines = text[node.span.clone()].lines();
    let lines: Vec<&str> = lines.map(str::trim).collect();
    Some(lines.join(" "))
}

/// The names of the fields of a struct.
fn fields(text: &str) -> BTreeSet<String> {
    let tree = Tree::of(text);
    let group = tree.root.as_ref().and_then(|root| root.group());
    let keys = group.into_iter().flat_map(|g| &g.entries);
    let keys = keys.filter_map(|entry| entry.key.clone());
    keys.map(|key| text[key].to_owned()).collect()
}

/// Returns the case without its name, description, seed and output files, which a trade does not
/// compare.
fn compared(case: &Case) -> Case {
    let mut case = case.clone();
    (case.name, case.doc, case.seed) = (String::new(), String::new(), 0);
    case.output = fretwork_scene::case::OutputSpec::default();
    case
}

/// Returns the parameter `variant`, if there are any variants.
///
/// # Errors
/// An argument is malformed or given twice, its file is invalid, lies elsewhere, or cannot be
/// reached from the case by `--set`.
pub fn variants(loaded: &LoadedCase, arguments: &[String]) -> Result<Option<Varied>, Error> {
    let mut levels: Vec<Level> = Vec::new();
    for argument in arguments {
        let wrong = |why: &str| Error::Usage(format!("--variant {argument}: {why}"));
        let (name, file) = argument
            .split_once('=')
            .map(|(name, file)| (name.trim(), Path::new(file.trim())))
            .filter(|(name, _)| !name.is_empty())
            .ok_or_else(|| wrong("expected NAME=FILE"))?;
        let other = load(file, loaded.source.sets())?;
        let folder = |path: &Path| path.canonicalize().ok()?.parent().map(Path::to_owned);
        if folder(file) != folder(&loaded.path) {
            return Err(wrong(
                "the file is in another folder than the case, where other materials and tables may lie; put both into one folder",
            ));
        }
        let sets = difference(loaded, &other).map_err(|e| wrong(&e.in_a_sentence()))?;
        let level = Level::named(name, sets);
        if let Some(same) = levels
            .iter()
            .find(|l| l.label == name || l.sets == level.sets)
        {
            return Err(wrong(&format!(
                "it has the name or the content of the variant {}; give each case once",
                same.label
            )));
        }
        levels.push(level);
    }
    if levels.is_empty() {
        return Ok(None);
    }
    let own = levels.iter().position(|l| l.sets.is_empty());
    Ok(Some(Varied::new(
        "variant",
        ParameterEffect::Form,
        levels,
        own,
    )))
}

/// Returns the `--set` arguments that change this case to another one.
fn difference(loaded: &LoadedCase, other: &LoadedCase) -> Result<Vec<String>, InputError> {
    let (mine, wanted) = (compared(&loaded.case), compared(&other.case));
    let texts = (mine.to_ron()?, wanted.to_ron()?);
    let before = loaded.source.sets();
    let mut sets: Vec<String> = Vec::new();
    for name in fields(&texts.0).union(&fields(&texts.1)) {
        let (a, b) = (field(&texts.0, name), field(&texts.1, name));
        if a == b {
            continue;
        }
        // An omitted field has the empty value of its type.
        let empty = |text: &&str| {
            let mut source = Source::from_text(&loaded.path, loaded.source.text());
            let set = Case::set(&mut source, &format!("{name}={text}"));
            let case = set.and_then(|()| Case::read(&source));
            case.and_then(|case| case.to_ron())
                .is_ok_and(|text| field(&text, name).is_none())
        };
        let text = b.or_else(|| {
            let empties = ["None", "[]", "{}", "()"];
            empties.into_iter().find(empty).map(str::to_owned)
        });
        sets.extend(text.map(|text| format!("{name}={text}")));
    }
    let all = [before, &sets].concat();
    if compared(&load(&loaded.path, &all)?.case) != wanted {
        return Err(InputError::about(
            other.path.display(),
            "cannot be made from the case by --set; run a study of its own for it",
        ));
    }
    Ok(sets)
}
