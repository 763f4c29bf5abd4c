//! Headings of the columns of a table, and where they are below the lines that an instrument writes
//! first.

use super::{Delimiter, Layout};
use crate::units;
use std::ops::Range;

/// Heading of a column.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Heading {
    /// The heading as in the file, `stress [MPa]`.
    pub text: String,
    /// Name without the unit.
    pub name: String,
    /// Unit; empty if there is none.
    pub unit: String,
}

impl Heading {
    /// Splits a heading into its name and its unit: in brackets at the end, `delta (um)`, or after
    /// a slash or `in` between blanks, `delta / um`, `delta in um`.
    pub fn parse(text: &str) -> Self {
        let text = text.trim();
        let brackets = |open: char, close: char| {
            let (name, unit) = text.strip_suffix(close)?.rsplit_once(open)?;
            let plain = !name.trim().is_empty() && !name.trim_end().ends_with('/');
            plain.then(|| (name.trim(), unit.trim()))
        };
        let word = |between: &str| {
            let (name, unit) = text.rsplit_once(between)?;
            let unit = unbracketed(unit);
            // Q / P is a ratio and no force in poise.
            let fits = !name.trim().is_empty() && unit != "P" && is_unit(unit);
            fits.then(|| (name.trim(), unit))
        };
        let (name, unit) = brackets('[', ']')
            .or_else(|| brackets('(', ')'))
            .or_else(|| word(" / "))
            .or_else(|| word(" in "))
            .unwrap_or((text, ""));
        Self {
            text: text.to_owned(),
            name: name.to_owned(),
            unit: unit.to_owned(),
        }
    }

    /// Returns the heading with a unit of the row below it.
    fn with_unit(self, unit: &str) -> Self {
        let unit = unbracketed(unit);
        let plain = if unit == "-" { "" } else { unit };
        match plain {
            "" => self,
            unit => Self {
                text: format!("{} ({unit})", self.text),
                unit: unit.to_owned(),
                ..self
            },
        }
    }
}

/// Returns a unit without the brackets around it.
fn unbracketed(text: &str) -> &str {
    let text = text.trim();
    let inner = |open: char, close: char| text.strip_prefix(open)?.strip_suffix(close);
    let found = inner('[', ']').or_else(|| inner('(', ')'));
    found.map_or(text, str::trim)
}

fn is_unit(text: &str) -> bool {
    let text = text.trim();
    !text.is_empty() && units::known(text).is_ok()
}

/// Returns the headings of a table; between blanks, a unit in brackets belongs to the word before.
pub(super) fn headings(layout: Layout, cells: &[String]) -> Vec<Heading> {
    let mut texts: Vec<String> = Vec::new();
    for cell in cells {
        let unit = layout.delimiter == Delimiter::Blanks && cell.starts_with(['(', '[']);
        match texts.last_mut().filter(|_| unit) {
            Some(before) => *before = format!("{before} {cell}"),
            None => texts.push(cell.clone()),
        }
    }
    texts.iter().map(|t| Heading::parse(t)).collect()
}

/// Returns the headings of a line of which two blanks or more separate the columns, while one may
/// stand within a name.
fn apart(line: &str) -> Vec<Heading> {
    let parts = line.trim().split("  ").map(str::trim);
    let parts = parts.filter(|part| !part.is_empty());
    parts.map(Heading::parse).collect()
}

/// Number of lines above a table that are searched for its headings.
const PREFACE: usize = 200;

/// Number of lines that must look like a table before all of them are read.
const NEAR: usize = 20;

/// A table within the lines of a text.
pub(super) struct Found {
    /// How it is written.
    pub layout: Layout,
    /// Its headings.
    pub headings: Vec<Heading>,
    /// Index of the line of its first row.
    pub first: usize,
}

/// Returns the table of a text: its headings, or none where its first line has numbers, below lines
/// that are no part of it, and above a row of units or none. The first table with numbers in its
/// first row is taken, otherwise the whole text. `None` if the lines below a heading never have as
/// many values as it has columns.
pub(super) fn find(lines: &[(Range<usize>, &str)]) -> Option<Found> {
    let all: Vec<&str> = lines.iter().map(|(_, line)| *line).collect();
    let numeric = |k: usize| {
        let near = &all[k..all.len().min(k + NEAR)];
        begins(near, true, k > 0)?;
        begins(&all[k..], true, k > 0).map(|found| (k, found))
    };
    let found = (0..all.len().min(PREFACE)).find_map(numeric);
    let (k, (layout, headings, first)) = match found {
        Some(found) => found,
        None => (0, begins(&all, false, false)?),
    };
    Some(Found {
        layout,
        headings,
        first: k + first,
    })
}

/// Returns layout, headings and the number of lines above the rows, if a table begins at the first
/// of these lines; its first row must be `numeric` or not. Below a `preface` it has headings, of
/// two columns or more.
fn begins(lines: &[&str], numeric: bool, preface: bool) -> Option<(Layout, Vec<Heading>, usize)> {
    let layout = Layout::of_lines(lines);
    let cells = |line: &str| -> Vec<String> {
        let cells = layout.cells(line).into_iter();
        cells.map(|c| c.into_owned()).collect()
    };
    let is_row = |cells: &[String]| cells.iter().all(|c| layout.number(c).is_ok());
    let first = cells(lines.first()?);
    // A row with a gap, or with marks between thousands, is neither a heading nor one of units.
    let has_number = |cells: &[String]| cells.iter().any(|c| is_like_number(c));
    if preface && has_number(&first) {
        return None;
    }
    let (headings, rows) = match first.iter().all(|c| is_like_number(c)) {
        true => {
            let names = (1..=first.len()).map(|k| Heading::parse(&k.to_string()));
            (names.collect(), 0)
        }
        false => {
            let second = cells(lines.get(1)?);
            let names = fitting(layout, lines[0], &first, second.len())?;
            match lines.len() > 2 && !has_number(&second) && are_units(&second) {
                true => {
                    let pairs = names.into_iter().zip(&second);
                    (pairs.map(|(h, unit)| h.with_unit(unit)).collect(), 2)
                }
                false => (names, 1),
            }
        }
    };
    let rest = lines.get(rows..).filter(|rest| !rest.is_empty())?;
    let columns = headings.len();
    if preface && (rows == 0 || columns < 2) || numeric && !is_row(&cells(rest[0])) {
        return None;
    }
    let whole = rest.iter().all(|line| cells(line).len() == columns);
    whole.then_some((layout, headings, rows))
}

/// Whether a cell is meant as a number, also one that is not read: `1.234,5`.
fn is_like_number(cell: &str) -> bool {
    let of_numbers = |c: char| c.is_ascii_digit() || "+-.,eE\u{2212}'\u{2019}\u{a0} ".contains(c);
    cell.starts_with(|c: char| c.is_ascii_digit() || "+-.,\u{2212}".contains(c))
        && cell.chars().all(of_numbers)
        && cell.contains(|c: char| c.is_ascii_digit())
}

/// Returns the headings of a line, if it has this number of them.
fn fitting(layout: Layout, line: &str, cells: &[String], columns: usize) -> Option<Vec<Heading>> {
    let own = headings(layout, cells);
    if own.len() == columns {
        return Some(own);
    }
    let blanks = layout.delimiter == Delimiter::Blanks;
    let apart = || Some(apart(line)).filter(|found| found.len() == columns);
    blanks.then(apart).flatten()
}

/// Returns whether the cells of a row are units, or empty.
fn are_units(cells: &[String]) -> bool {
    let plain = || cells.iter().map(|c| unbracketed(c));
    plain().all(|c| matches!(c, "" | "-") || is_unit(c)) && plain().any(|c| c != "-" && is_unit(c))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_in_brackets_or_after_a_slash() {
        for (text, name, unit) in [
            ("delta (um)", "delta", "um"),
            ("Q [N]", "Q", "N"),
            ("delta / um", "delta", "um"),
            ("Q / (N/m)", "Q", "N/m"),
            ("Weg in \u{b5}m", "Weg", "\u{b5}m"),
            ("Q/P", "Q/P", ""),
            ("Q / P", "Q / P", ""),
            ("slip in contact", "slip in contact", ""),
            ("mu", "mu", ""),
        ] {
            let found = Heading::parse(text);
            assert_eq!(
                (found.name.as_str(), found.unit.as_str()),
                (name, unit),
                "{text}"
            );
        }
    }
}
