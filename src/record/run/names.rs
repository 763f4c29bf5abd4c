//! Checks that the columns of the statistics, the files in the folder of a run, and its tables of
//! events have different names.

use super::RunError;
use super::clear::OWN;
use crate::scene::LoadedCase;
use crate::scene::case::Case;
use crate::scene::source::{InputError, ValidationError};
use fretwork_observe::Observers;
use fretwork_observe::output::REPORT;
use fretwork_store::folder_lock::RUN_LOCK;
use std::collections::BTreeSet;

/// Files and folders of a run besides those of an older run that it [removes](super::clear).
const OTHERS: [&str; 5] = [
    "results.h5.part",
    "summary.part",
    "frames",
    "fclib",
    RUN_LOCK,
];

/// A table of events, whose name no case gives.
const TABLE: &str = "table of events";

/// Kind of two items with the same name, and the name.
type Twice = (&'static str, String);

/// Rejects equal names of two columns, files or tables of events of the case and its observers.
///
/// # Errors
/// The error reports the name, at the line of the case that gives it.
pub(super) fn check(loaded: &LoadedCase, observers: &Observers) -> Result<(), RunError> {
    let Some((what, name)) = twice(observers) else {
        return Ok(());
    };
    match at_line(loaded, what, &name) {
        Some(error) => Err(RunError::Input(Box::new(error))),
        None => Err(RunError::NameTwice { what, name }),
    }
}

/// Checks that no two columns, files or tables of events of a run of a case with these observers
/// have the same name.
///
/// # Errors
/// The error reports the name, at the line of the case that gives it; without a line if an observer
/// of the library's user does.
pub fn check_names(loaded: &LoadedCase, observers: &Observers) -> Result<(), InputError> {
    match check(loaded, observers) {
        Ok(()) => Ok(()),
        Err(RunError::Input(error)) => Err(*error),
        Err(error) => {
            let case = loaded.path.display();
            Err(InputError::about(case, error.to_string()))
        }
    }
}

/// Finds two columns, two files or two tables of events of the same name. Names of files that
/// differ only in case are the same file on some systems.
fn twice(observers: &Observers) -> Option<Twice> {
    let mut columns = BTreeSet::new();
    for column in observers.columns() {
        if let Some(name) = columns.replace(column.name) {
            return Some(("column of statistics.csv", name));
        }
    }
    let own = OWN.iter().chain(&OTHERS).chain(&[REPORT]);
    let mut files: BTreeSet<String> = own.map(|name| (*name).to_owned()).collect();
    for file in observers.file_names() {
        if let Some(name) = files.replace(file.to_lowercase()) {
            return Some(("file in the folder of the results", name));
        }
    }
    let mut tables = BTreeSet::new();
    let mut names = observers.event_tables().into_iter().map(|table| table.name);
    let name = names.find(|name| !tables.insert(*name))?;
    Some((TABLE, name.to_owned()))
}

/// Returns the error at the line of the case that gives a name; `None` if the name belongs to an
/// observer of the library's user.
fn at_line(loaded: &LoadedCase, what: &str, name: &str) -> Option<InputError> {
    let message = format!("another {what} is named `{name}`; take another name here");
    let path = path(&loaded.case, name).filter(|_| what != TABLE)?;
    Some(loaded.source.locate(ValidationError::new(path, message)))
}

/// Returns the path in the case of the name from which that of a column or a file is made: the
/// longest one that it has as whole parts, with measures before bodies.
fn path(case: &Case, made: &str) -> Option<String> {
    let measures = case.measures.iter().map(|m| m.name());
    let elastic = case.elastic.iter().map(|b| b.name.as_str());
    let half_spaces = case.half_spaces.iter().map(|b| b.name.as_str());
    let bodies = case.bodies.iter().map(|b| b.name.as_str());
    let lists: [(&str, Vec<&str>); 4] = [
        ("bodies", bodies.collect()),
        ("half_spaces", half_spaces.collect()),
        ("elastic", elastic.collect()),
        ("measures", measures.collect()),
    ];
    let named = lists.iter().flat_map(|(list, names)| {
        let path = move |k: usize| format!("{list}.{k}.name");
        names
            .iter()
            .enumerate()
            .map(move |(k, name)| (name.len(), path(k), *name))
    });
    let named = named.filter(|(_, _, name)| has(made, name));
    named
        .max_by_key(|(length, ..)| *length)
        .map(|(_, path, _)| path)
}

/// Whether a name of a column or a file has another name as whole parts: `top` is one of `top_fx`,
/// and none of `stop_fx`.
fn has(made: &str, name: &str) -> bool {
    let parts = |text: &str| {
        let text = text.to_lowercase();
        format!("_{}_", text.replace(|c: char| !c.is_alphanumeric(), "_"))
    };
    !name.is_empty() && parts(made).contains(&parts(name))
}

#[cfg(test)]
mod tests {
    use super::has;

    #[test]
    fn a_name_is_made_of_whole_parts() {
        for (made, name) in [
            ("top_fx", "top"),
            ("scar_Left wheel.csv", "left wheel"),
            ("width", "width"),
        ] {
            assert!(has(made, name), "{made} {name}");
        }
        for (made, name) in [("stop_fx", "top"), ("summit", "sum"), ("width", "")] {
            assert!(!has(made, name), "{made} {name}");
        }
    }
}
