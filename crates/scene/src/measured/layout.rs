//! How the columns and numbers of a text are written: delimiter, and point or comma.

use std::borrow::Cow;
use std::ops::Range;

/// What stands between columns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Delimiter {
    /// A semicolon.
    Semicolon,
    /// A tab.
    Tab,
    /// A comma.
    Comma,
    /// One or more blanks.
    Blanks,
}

/// Delimiter of the columns, and whether numbers have a decimal comma.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Layout {
    /// What stands between columns.
    pub delimiter: Delimiter,
    /// Whether numbers have a decimal comma.
    pub decimal_comma: bool,
}

/// Returns the lines of a text that are neither empty nor a comment (`#`), with their bytes. A
/// spreadsheet writes empty rows as delimiters alone.
pub fn lines(text: &str) -> impl Iterator<Item = (Range<usize>, &str)> {
    let skipped = text.len() - text.trim_start_matches('\u{feff}').len();
    let mut at = skipped;
    text[skipped..]
        .split_inclusive('\n')
        .filter_map(move |line| {
            let start = at;
            at += line.len();
            // Tabs at the ends stand for empty columns.
            let content = line.trim_end_matches(['\r', '\n']);
            let shown = content.trim();
            let span = start..start + content.trim_end().len();
            let empty = shown.chars().all(|c| matches!(c, ';' | ',' | '\t' | ' '));
            (!empty && !shown.starts_with('#')).then_some((span, content))
        })
}

impl Layout {
    /// Determines the layout of the lines of a table, the first of which may name its columns.
    /// Semicolons and tabs separate columns wherever there are any; a comma is one within a number
    /// if blanks separate the columns, or within quotes.
    pub fn of(text: &str) -> Self {
        let all: Vec<&str> = lines(text).map(|(_, line)| line).collect();
        Self::of_lines(&all)
    }

    /// Determines the layout of the lines of a table, as [`Layout::of`].
    pub fn of_lines(all: &[&str]) -> Self {
        let body = if all.len() > 1 { &all[1..] } else { all };
        let any = |c: char| body.iter().any(|line| line.contains(c));
        let delimiter = if any(';') {
            Delimiter::Semicolon
        } else if any('\t') {
            Delimiter::Tab
        } else if any(',') && !body.iter().all(|line| blanks_separate(line)) {
            Delimiter::Comma
        } else {
            Delimiter::Blanks
        };
        let mut out = Self {
            delimiter,
            decimal_comma: false,
        };
        out.decimal_comma = body
            .iter()
            .any(|line| out.cells(line).iter().any(|cell| is_decimal(cell)));
        out
    }

    /// Splits a line into cells without blanks around them; quotes hold a cell together.
    pub fn cells<'a>(&self, line: &'a str) -> Vec<Cow<'a, str>> {
        let separates = |c: char| match self.delimiter {
            Delimiter::Semicolon => c == ';',
            Delimiter::Tab => c == '\t',
            Delimiter::Comma => c == ',',
            Delimiter::Blanks => c.is_whitespace(),
        };
        let mut quoted = false;
        let parts = line.split(|c: char| {
            quoted ^= c == '"';
            !quoted && separates(c)
        });
        let cell = |part: &'a str| {
            let part = part.trim();
            let inner = part.strip_prefix('"').and_then(|p| p.strip_suffix('"'));
            match inner {
                Some(inner) => Cow::Owned(inner.replace("\"\"", "\"").trim().to_owned()),
                None => Cow::Borrowed(part),
            }
        };
        let cells = parts.map(cell);
        match self.delimiter {
            Delimiter::Blanks => cells.filter(|c| !c.is_empty()).collect(),
            _ => cells.collect(),
        }
    }

    /// Returns the finite number in a cell.
    ///
    /// # Errors
    /// What is wrong with the cell, as the end of a sentence.
    pub fn number(&self, cell: &str) -> Result<f64, String> {
        let plain = cell.replace('\u{2212}', "-");
        if plain.is_empty() {
            return Err("is missing".to_owned());
        }
        if self.decimal_comma && plain.contains('.') && plain.contains(',') {
            return Err(format!(
                "`{cell}` has a point and a comma; write numbers without marks between thousands"
            ));
        }
        let read = match self.decimal_comma {
            true => plain.replacen(',', ".", 1).parse(),
            false => plain.parse::<f64>(),
        };
        read.ok()
            .filter(|x| x.is_finite())
            .ok_or_else(|| format!("`{cell}` is not a number"))
    }
}

/// Returns whether a cell is a number with a decimal comma.
fn is_decimal(cell: &str) -> bool {
    let parts = cell.split_once(',');
    parts.is_some_and(|(whole, rest)| {
        let digits = |text: &str| text.starts_with(|c: char| c.is_ascii_digit());
        digits(rest)
            && (digits(whole.trim_start_matches(['+', '-', '\u{2212}'])) || whole.is_empty())
    })
}

/// Returns whether the words of a line are numbers, two or more of them, with commas within them
/// alone.
fn blanks_separate(line: &str) -> bool {
    let words: Vec<&str> = line.split_whitespace().collect();
    let number = |word: &&str| word.replacen(',', ".", 1).parse::<f64>().is_ok();
    let whole = |word: &&str| !word.starts_with(',') && !word.ends_with(',');
    words.len() > 1 && words.iter().all(|w| number(w) && whole(w))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn delimiters_and_decimal_commas_are_told_apart() {
        use Delimiter::{Blanks, Comma, Semicolon, Tab};
        for (text, delimiter, decimal_comma, cells) in [
            ("a,b\n1.5,2.5\n", Comma, false, &["1.5", "2.5"][..]),
            ("a, b\n1, 2\n", Comma, false, &["1", "2"]),
            ("a;b\n1,5;2,5\n", Semicolon, true, &["1,5", "2,5"]),
            ("a;b\n1.5;2.5\n", Semicolon, false, &["1.5", "2.5"]),
            ("a\tb\n1,5\t-2,5\n", Tab, true, &["1,5", "-2,5"]),
            ("a b\n1,5  2,5\n", Blanks, true, &["1,5", "2,5"]),
            ("a b\n 1.5 2e-3\n", Blanks, false, &["1.5", "2e-3"]),
            ("a,b\n\"1,5\",\"2,5\"\n", Comma, true, &["1,5", "2,5"]),
            ("# x;y\na,b\n1,2\n", Comma, false, &["1", "2"]),
            ("a;b;c\n1;;3\n", Semicolon, false, &["1", "", "3"]),
        ] {
            let layout = Layout::of(text);
            assert_eq!(
                (layout.delimiter, layout.decimal_comma),
                (delimiter, decimal_comma),
                "{text}"
            );
            let last = lines(text).last().unwrap().1;
            assert_eq!(layout.cells(last), cells, "{text}");
        }
    }

    #[test]
    fn numbers_have_a_point_or_a_comma() {
        let layout = |decimal_comma| Layout {
            delimiter: Delimiter::Semicolon,
            decimal_comma,
        };
        assert_eq!(layout(true).number("-1,5e-3"), Ok(-1.5e-3));
        assert_eq!(layout(true).number("2"), Ok(2.0));
        assert_eq!(layout(false).number("\u{2212}1.5"), Ok(-1.5));
        let why = |decimal_comma, cell| layout(decimal_comma).number(cell).unwrap_err();
        assert!(why(true, "1.234,5").contains("thousands"));
        assert!(why(false, "").contains("missing"));
        assert!(why(false, "1,5").contains("not a number"));
        assert!(why(true, "nan").contains("not a number"));
    }
}
