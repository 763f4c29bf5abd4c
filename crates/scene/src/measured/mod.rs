//! Tables of measured values: text files of columns with headings, as rigs, profilometers and
//! spreadsheets write them.
//!
//! Columns are separated by commas, semicolons, tabs or blanks; numbers have a decimal point or a
//! decimal comma; lines that begin with `#` are comments. A heading is a name with its unit in
//! brackets: `delta (um)`, `Q [N]`, `mu`. Without headings columns are called `1`, `2`, ...

mod layout;

pub use layout::{Delimiter, Layout, lines};

use crate::source::{InputError, nearest, read_text};
use std::ops::Range;
use std::path::Path;

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
    /// Splits a heading into its name and its unit in brackets at the end.
    pub fn parse(text: &str) -> Self {
        let text = text.trim();
        let split = |open: char, close: char| {
            let (name, unit) = text.strip_suffix(close)?.rsplit_once(open)?;
            (!name.trim().is_empty()).then(|| (name.trim(), unit.trim()))
        };
        let (name, unit) = split('[', ']')
            .or_else(|| split('(', ')'))
            .unwrap_or((text, ""));
        Self {
            text: text.to_owned(),
            name: name.to_owned(),
            unit: unit.to_owned(),
        }
    }
}

/// A table of measured values.
#[derive(Clone, Debug)]
pub struct MeasuredTable {
    name: String,
    text: String,
    layout: Layout,
    /// Headings of the columns.
    pub headings: Vec<Heading>,
    rows: Vec<(Range<usize>, Vec<String>)>,
}

impl MeasuredTable {
    /// Reads a table.
    ///
    /// # Errors
    /// The file cannot be read, has no row, or has rows of other lengths than its headings; the
    /// error is located at the line.
    pub fn read(path: &Path) -> Result<Self, InputError> {
        Self::parse(&path.display().to_string(), read_text(path)?)
    }

    /// Reads the text of a table; `name` is that of its file, for errors.
    ///
    /// # Errors
    /// Those of [`MeasuredTable::read`].
    pub fn parse(name: &str, text: String) -> Result<Self, InputError> {
        let layout = Layout::of(&text);
        let mut rows = lines(&text).map(|(span, line)| {
            let cells = layout.cells(line).into_iter();
            (span, cells.map(|c| c.into_owned()).collect::<Vec<_>>())
        });
        let Some((span, first)) = rows.next() else {
            return Err(InputError::about(name, "there is no line with values"));
        };
        let numbers = first.iter().all(|cell| layout.number(cell).is_ok());
        let (headings, before) = match numbers {
            true => {
                let names = (1..=first.len()).map(|k| Heading::parse(&k.to_string()));
                (names.collect(), Some((span, first)))
            }
            false => (headings(layout, first), None),
        };
        let rows: Vec<_> = before.into_iter().chain(rows).collect();
        let columns = headings.len();
        for (span, cells) in &rows {
            if cells.len() != columns {
                let why = format!(
                    "this line has {} values, and there are {columns} columns{}",
                    cells.len(),
                    match layout.delimiter {
                        Delimiter::Comma if cells.len() > columns =>
                            "; if commas stand for decimal points, separate the columns by semicolons or tabs",
                        Delimiter::Blanks =>
                            "; blanks separate the columns, also in headings: write names without blanks, or separate by semicolons or tabs",
                        _ => "",
                    }
                );
                return Err(InputError::at(name, &text, span.clone(), why));
            }
        }
        if rows.is_empty() {
            return Err(InputError::about(
                name,
                "there is no row below the headings",
            ));
        }
        Ok(Self {
            name: name.to_owned(),
            text,
            layout,
            headings,
            rows,
        })
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.rows.len()
    }

    /// Returns the index of a column by its name without the unit, or by its whole heading.
    pub fn column(&self, name: &str) -> Option<usize> {
        let whole = self.headings.iter().position(|h| h.text == name);
        whole.or_else(|| self.headings.iter().position(|h| h.name == name))
    }

    /// Returns the index of a column.
    ///
    /// # Errors
    /// There is none; the error names those that exist.
    pub fn required(&self, name: &str) -> Result<usize, InputError> {
        let names = || self.headings.iter().map(|h| h.name.as_str());
        self.column(name).ok_or_else(|| {
            let all: Vec<&str> = names().collect();
            let message = format!("there is no column `{name}`; there are {}", all.join(", "));
            InputError::about(&self.name, message).did_you_mean(nearest(name, names()))
        })
    }

    /// Returns a value.
    ///
    /// # Errors
    /// It is no finite number; the error is located at its line.
    pub fn value(&self, row: usize, column: usize) -> Result<f64, InputError> {
        let (span, cells) = &self.rows[row];
        self.layout.number(&cells[column]).map_err(|why| {
            let message = format!("the value of `{}` {why}", self.headings[column].name);
            InputError::at(&self.name, &self.text, span.clone(), message)
        })
    }

    /// Returns the values of a column.
    ///
    /// # Errors
    /// One is no finite number.
    pub fn values(&self, column: usize) -> Result<Vec<f64>, InputError> {
        let rows = 0..self.rows.len();
        rows.map(|row| self.value(row, column)).collect()
    }
}

/// Returns the headings of a table; between blanks, a unit in brackets belongs to the word before.
fn headings(layout: Layout, cells: Vec<String>) -> Vec<Heading> {
    let mut texts: Vec<String> = Vec::new();
    for cell in cells {
        let unit = layout.delimiter == Delimiter::Blanks && cell.starts_with(['(', '[']);
        match texts.last_mut().filter(|_| unit) {
            Some(before) => *before = format!("{before} {cell}"),
            None => texts.push(cell),
        }
    }
    texts.iter().map(|t| Heading::parse(t)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(text: &str) -> Result<MeasuredTable, InputError> {
        MeasuredTable::parse("loop.csv", text.to_owned())
    }

    #[test]
    fn tables_of_rigs_and_spreadsheets_are_read() {
        for text in [
            "delta (um),Q [N]\n0.5,1\n-1.5,2\n",
            "\u{feff}# a rig\r\ndelta (um);Q [N]\r\n0,5;1\r\n-1,5;2\r\n",
            "delta (um)\tQ [N]\n0,5\t1\n-1,5\t2",
            "delta (um)   Q [N]\n 0,5  1\n-1,5  2\n",
            "\"delta (um)\",\"Q [N]\"\n\"0,5\",\"1\"\n\"-1,5\",\"2\"\n",
        ] {
            let table = parse(text).unwrap_or_else(|e| panic!("{text}: {e}"));
            let units = table
                .headings
                .iter()
                .map(|h| (h.name.as_str(), h.unit.as_str()));
            assert_eq!(
                units.collect::<Vec<_>>(),
                [("delta", "um"), ("Q", "N")],
                "{text}"
            );
            assert_eq!(table.values(0).unwrap(), [0.5, -1.5], "{text}");
            assert_eq!(
                table.values(table.column("Q [N]").unwrap()).unwrap(),
                [1.0, 2.0]
            );
        }
        let bare = parse("1;0,3\n2;0,4\n").unwrap();
        assert_eq!(bare.values(bare.column("2").unwrap()).unwrap(), [0.3, 0.4]);
    }

    #[test]
    fn what_cannot_be_read_is_located() {
        for (text, line, says) in [
            ("# nothing\n", 0, "no line with values"),
            ("a;b\n", 0, "no row below"),
            ("a,b\n1,5,2,5\n", 2, "semicolons or tabs"),
            ("wear depth x\n1 2\n", 2, "names without blanks"),
            (
                "a;b\n1;2\n\n3;4;5\n",
                4,
                "3 values, and there are 2 columns",
            ),
        ] {
            let error = parse(text)
                .err()
                .unwrap_or_else(|| panic!("{text:?} passed"));
            assert!(error.message().contains(says), "{error}");
            assert_eq!(error.position().map_or(0, |p| p.0), line, "{error}");
        }
        let table = parse("a;b\n1;2\n3;x\n").unwrap();
        let error = table.values(1).unwrap_err();
        assert!(
            error.message().contains("value of `b` `x` is not a number"),
            "{error}"
        );
        assert_eq!(error.position(), Some((3, 1)));
        let error = table.required("c").unwrap_err();
        assert!(error.message().contains("there are a, b"), "{error}");
    }
}
