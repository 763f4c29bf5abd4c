//! Tables of measured values: text files of columns with headings, as rigs, profilometers and
//! spreadsheets write them.
//!
//! Columns are separated by commas, semicolons, tabs or blanks; numbers have a decimal point or a
//! decimal comma; lines that begin with `#` are comments. A heading is a name with its unit: `delta
//! (um)`, `Q [N]`, `delta / um`, `mu`; units may also stand in a row below the names. Without
//! headings columns are called `1`, `2`, ... Lines of another form above the headings, as
//! instruments write them, are skipped.

mod heading;
mod layout;

pub use heading::Heading;
pub use layout::{Delimiter, Layout, lines};

use crate::source::{InputError, MAX_BYTES, nearest, read_bytes};
use std::ops::Range;
use std::path::Path;

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
        Self::parse(
            &path.display().to_string(),
            decoded(read_bytes(path, MAX_BYTES)?),
        )
    }

    /// Reads the text of a table; `name` is that of its file, for errors.
    ///
    /// # Errors
    /// Those of [`MeasuredTable::read`].
    pub fn parse(name: &str, text: String) -> Result<Self, InputError> {
        let all: Vec<(Range<usize>, &str)> = lines(&text).collect();
        if all.is_empty() {
            return Err(InputError::about(name, "there is no line with values"));
        }
        let cells_of = |layout: Layout, (span, line): &(Range<usize>, &str)| {
            let cells = layout.cells(line).into_iter();
            let cells = cells.map(|c| c.into_owned()).collect::<Vec<_>>();
            (span.clone(), cells)
        };
        let (layout, headings, first) = match heading::find(&all) {
            Some(found) => (found.layout, found.headings, found.first),
            None => {
                let layout = Layout::of(&text);
                let (_, first) = cells_of(layout, &all[0]);
                (layout, heading::headings(layout, &first), 1)
            }
        };
        let rows = all[first..].iter().map(|line| cells_of(layout, line));
        let rows: Vec<(Range<usize>, Vec<String>)> = rows.collect();
        let columns = headings.len();
        for (span, cells) in &rows {
            if cells.len() != columns {
                let why = format!(
                    "this line has {} values, and there are {columns} columns{}",
                    cells.len(),
                    match layout.delimiter {
                        Delimiter::Comma if cells.len() > columns =>
                            "; if commas stand for decimal points, separate the columns by semicolons or tabs",
                        Delimiter::Comma =>
                            "; commas separate the columns, also in headings: write units in brackets",
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

/// Returns the text of a file: in UTF-8, in UTF-16 with a byte order mark, or else in Latin-1,
/// whose bytes are the first characters of Unicode, in which older instruments write micrometres.
fn decoded(bytes: Vec<u8>) -> String {
    let wide = |pair: fn([u8; 2]) -> u16| {
        let units = bytes[2..].as_chunks::<2>().0.iter().map(|p| pair(*p));
        char::decode_utf16(units)
            .map(|c| c.unwrap_or(char::REPLACEMENT_CHARACTER))
            .collect()
    };
    match bytes.get(..2) {
        Some([0xff, 0xfe]) => return wide(u16::from_le_bytes),
        Some([0xfe, 0xff]) => return wide(u16::from_be_bytes),
        _ => {}
    }
    String::from_utf8(bytes)
        .unwrap_or_else(|e| e.as_bytes().iter().map(|b| char::from(*b)).collect())
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
    fn lines_of_an_instrument_above_the_headings_are_skipped() {
        for text in [
            "Rig 7\nDate: 2024-05-03; operator X\n\nTest;12\ndelta;Q\n(um);(N)\n0,5;1\n-1,5;2\n\n\n",
            "DATA FILE\nVersion 2.1\n[Data]\ndelta [um]\tQ [N]\n0.5\t1\n-1.5\t2\n",
            "a rig, of 1998\ndelta / um,Q / N\n0.5,1\n-1.5,2\n,\n",
            "delta;Q\num;N\n0.5;1\n-1.5;2\n;\n",
            "Channel  Value\n\ndelta (um)  Q [N]\n 0,5  1\n-1,5  2\n",
        ] {
            let table = parse(text).unwrap_or_else(|e| panic!("{text}: {e}"));
            let units = table.headings.iter();
            let units = units.map(|h| (h.name.as_str(), h.unit.as_str()));
            assert_eq!(
                units.collect::<Vec<_>>(),
                [("delta", "um"), ("Q", "N")],
                "{text}"
            );
            assert_eq!(table.values(0).unwrap(), [0.5, -1.5], "{text}");
        }
        let spaced = parse("Cycle number  Friction coefficient\n1  0.41\n2  0.43\n").unwrap();
        assert_eq!(spaced.headings[1].name, "Friction coefficient");
    }

    #[test]
    fn texts_of_other_encodings_are_read() {
        let text = "delta (\u{b5}m);Q\n1;2\n";
        let latin: Vec<u8> = text.chars().map(|c| c as u8).collect();
        let wide = |pair: fn(u16) -> [u8; 2]| -> Vec<u8> {
            let all = format!("\u{feff}{text}");
            all.encode_utf16().flat_map(pair).collect()
        };
        for bytes in [
            text.as_bytes().to_vec(),
            latin,
            wide(u16::to_le_bytes),
            wide(u16::to_be_bytes),
        ] {
            assert_eq!(decoded(bytes), text);
        }
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
        for gap in ["NaN", "-"] {
            let table = parse(&format!("a;b\n1;{gap}\n3;4\n")).unwrap();
            let error = table.values(1).unwrap_err();
            assert_eq!(error.position(), Some((2, 1)), "{gap}");
        }
        // Marks between thousands make a row no heading.
        for text in ["a;b\n1.234,5;2.345,5\n0,5;1\n", "1.234,5;2.345,5\n0,5;1\n"] {
            let table = parse(text).unwrap();
            let error = table.values(0).unwrap_err();
            let says = format!("value of `{}` `1.234,5` has a", table.headings[0].name);
            assert!(error.message().contains(&says), "{error}");
            assert!(["a", "1"].contains(&&*table.headings[0].name), "{text}");
        }
        let error = table.required("c").unwrap_err();
        assert!(error.message().contains("there are a, b"), "{error}");
    }
}
