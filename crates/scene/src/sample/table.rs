//! Reader of numeric tables with a header of column names, see [`crate::measured`] for their
//! layout.

use crate::measured::{Heading, Layout, lines};
use crate::source::{InputError, nearest, read_text};
use std::ops::Range;
use std::path::Path;

/// A numeric table.
#[derive(Clone, Debug)]
pub struct Table {
    name: String,
    text: String,
    header: Vec<String>,
    rows: Vec<(Range<usize>, Vec<f64>)>,
}

impl Table {
    /// Reads a table with required and optional columns. Lines that begin with `#` are comments.
    ///
    /// # Errors
    /// Returns an error at the invalid line: a missing, unknown or repeated column, a row of
    /// another length, or a value that is not a finite number.
    pub fn read(path: &Path, required: &[&str], optional: &[&str]) -> Result<Self, InputError> {
        let text = read_text(path)?;
        let name = path.display().to_string();
        Self::parse(name, text, required, optional, false)
    }

    /// Reads a table of lengths, whose columns may have a unit after the name, `z [mm]`; values are
    /// converted to metres.
    ///
    /// # Errors
    /// Returns the errors of [`Table::read`], or a unit that is not a length.
    pub fn read_lengths(
        path: &Path,
        required: &[&str],
        optional: &[&str],
    ) -> Result<Self, InputError> {
        let text = read_text(path)?;
        let name = path.display().to_string();
        Self::parse(name, text, required, optional, true)
    }

    fn parse(
        name: String,
        text: String,
        required: &[&str],
        optional: &[&str],
        lengths: bool,
    ) -> Result<Self, InputError> {
        let layout = Layout::of(&text);
        let (mut header, mut metres, mut rows) = (Vec::new(), Vec::new(), Vec::new());
        for (span, line) in lines(&text) {
            let fail = |message| InputError::at(&name, &text, span.clone(), message);
            let words = layout.cells(line);
            let words: Vec<&str> = words.iter().map(AsRef::as_ref).collect();
            if header.is_empty() {
                (header, metres) = parse_header(&words, lengths, &fail)?;
                check_header(&header, required, optional).map_err(|(message, near)| {
                    let columns = [required, optional].concat().join(", ");
                    fail(message)
                        .expected(format!("columns of the names {columns}"))
                        .did_you_mean(near.as_deref())
                })?;
                continue;
            }
            let row = parse_row(layout, &words, &header, &metres, &fail)?;
            rows.push((span, row));
        }
        if rows.is_empty() {
            let message = "there is no row of numbers below the header";
            return Err(InputError::about(&name, message));
        }
        Ok(Self {
            name,
            text,
            header,
            rows,
        })
    }

    /// Number of rows.
    pub fn len(&self) -> usize {
        self.rows.len()
    }

    /// Returns whether there are no rows; never true for a table that was read.
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// Returns the index of a column, if the table has it.
    pub fn column(&self, name: &str) -> Option<usize> {
        self.header.iter().position(|h| h == name)
    }

    /// A value; 0 for an absent column.
    pub fn value(&self, row: usize, column: Option<usize>) -> f64 {
        column.map_or(0.0, |c| self.rows[row].1[c])
    }

    /// Makes an error located at a row.
    pub fn fail(&self, row: usize, message: impl Into<String>) -> InputError {
        let span = self.rows[row].0.clone();
        InputError::at(&self.name, &self.text, span, message)
    }
}

/// Returns the names of the columns, and for a table of lengths the unit of each in metres.
fn parse_header(
    words: &[&str],
    lengths: bool,
    fail: &impl Fn(String) -> InputError,
) -> Result<(Vec<String>, Vec<f64>), InputError> {
    let mut header: Vec<String> = words.iter().map(|w| (*w).to_owned()).collect();
    let mut metres = Vec::new();
    if lengths {
        for name in &mut header {
            let (short, metre) = length(name).map_err(|m| {
                fail(m).expected("`m`, `mm`, `um` or `nm` in brackets, or no unit for metres")
            })?;
            *name = short;
            metres.push(metre);
        }
    }
    Ok((header, metres))
}

/// The values of a row, multiplied by the units of their columns.
fn parse_row(
    layout: Layout,
    words: &[&str],
    header: &[String],
    metres: &[f64],
    fail: &impl Fn(String) -> InputError,
) -> Result<Vec<f64>, InputError> {
    if words.len() != header.len() {
        let (values, columns) = (words.len(), header.len());
        // Numbers with decimal commas are read as two.
        let halves = values > columns && words.iter().all(|w| !w.contains('.'));
        let why = if halves {
            "; if commas stand for decimal points, write points, or semicolons between the columns"
        } else {
            ""
        };
        return Err(fail(format!(
            "this line has {values} values and the header {columns} columns{why}"
        )));
    }
    let mut row = Vec::with_capacity(words.len());
    for (word, column) in words.iter().zip(header) {
        let number = layout.number(word).map_err(|_| {
            fail(format!("the value `{word}` of `{column}` is not a number"))
                .expected("a finite number")
        })?;
        row.push(number * metres.get(row.len()).copied().unwrap_or(1.0));
    }
    Ok(row)
}

/// Splits a column's name into its name and its unit in metres.
fn length(name: &str) -> Result<(String, f64), String> {
    let heading = Heading::parse(name);
    let metre = match heading.unit.as_str() {
        "" | "m" => 1.0,
        "mm" => 1e-3,
        "um" | "\u{b5}m" | "\u{3bc}m" => 1e-6,
        "nm" => 1e-9,
        other => return Err(format!("`{other}` is not a unit of length")),
    };
    Ok((heading.name, metre))
}

fn check_header(
    header: &[String],
    required: &[&str],
    optional: &[&str],
) -> Result<(), (String, Option<String>)> {
    let known = || required.iter().chain(optional).copied();
    for (k, name) in header.iter().enumerate() {
        if header[..k].contains(name) {
            return Err((format!("the column `{name}` is there twice"), None));
        }
        if !known().any(|n| n == name) {
            let message = if name.parse::<f64>().is_ok() {
                "the first line must name the columns".to_owned()
            } else {
                format!("unknown column `{name}`")
            };
            return Err((message, nearest(name, known()).map(str::to_owned)));
        }
    }
    match required.iter().find(|r| !header.iter().any(|h| h == *r)) {
        Some(missing) => Err((format!("the column `{missing}` is missing"), None)),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Table, InputError> {
        Table::parse(
            "t.csv".into(),
            text.into(),
            &["x", "radius"],
            &["spin"],
            false,
        )
    }

    #[test]
    fn lengths_may_have_a_unit() {
        let read = |text: &str| Table::parse("t.csv".into(), text.into(), &["x", "z"], &[], true);
        let table = read("x [mm], z\n2,3\n").unwrap_or_else(|e| panic!("{e}"));
        let (x, z) = (table.column("x"), table.column("z"));
        assert_eq!((table.value(0, x), table.value(0, z)), (2e-3, 3.0));
        let error = read("x [kg],z\n1,2\n")
            .err()
            .unwrap_or_else(|| panic!("passed"));
        assert!(
            error.message().contains("`kg` is not a unit of length"),
            "{error}"
        );
        assert_eq!(error.position(), Some((1, 1)));
    }

    #[test]
    fn columns_are_found_in_any_order() {
        let table = read("# from a sieve\nradius, x\r\n1e-3, 2\r\n\n# more\n2e-3,-3\n");
        let table = table.unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(table.len(), 2);
        let (x, radius) = (table.column("x"), table.column("radius"));
        assert_eq!((table.value(1, x), table.value(1, radius)), (-3.0, 2e-3));
        assert_eq!(table.value(0, table.column("spin")), 0.0);
        assert_eq!(table.fail(1, "").position(), Some((6, 1)));
    }

    #[test]
    fn any_delimiter_and_decimal_commas_are_read() {
        for text in [
            "x;radius\n1,5;2\n",
            "x\tradius\n1,5\t2\n",
            "x radius\n1,5 2\n",
            "x,radius\n\"1,5\",\"2\"\n",
        ] {
            let table = read(text).unwrap_or_else(|e| panic!("{text}: {e}"));
            assert_eq!(table.rows[0].1, [1.5, 2.0], "{text}");
        }
    }

    #[test]
    fn bad_tables_are_refused_at_their_line() {
        for (text, line, says) in [
            (
                "x,radius\n1,2\n1,two\n",
                3,
                "`two` of `radius` is not a number",
            ),
            ("x,radius\n1,2\n\n# c\n1,NaN\n", 5, "`NaN` of `radius`"),
            ("x,radius\n1,2,3\n", 2, "3 values and the header 2 columns"),
            ("x,radius\n1,5,2,5\n", 2, "decimal points, write points"),
            ("x,radius,radus\n1,2,3\n", 1, "unknown column `radus`"),
            ("x,x,radius\n1,2,3\n", 1, "`x` is there twice"),
            ("x\n1\n", 1, "`radius` is missing"),
            ("1,2\n1,2\n", 1, "must name the columns"),
            ("x,radius\n", 0, "no row of numbers"),
        ] {
            let error = read(text)
                .err()
                .unwrap_or_else(|| panic!("{text:?} passed"));
            assert!(error.message().contains(says), "{error}");
            assert_eq!(error.position().map_or(0, |p| p.0), line, "{error}");
        }
    }
}
