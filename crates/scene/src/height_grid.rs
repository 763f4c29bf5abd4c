//! Heights over a grid: the reader of files of heights, and checks that their lines are the rows of
//! the grid.
//!
//! A file has one line for each row of the grid along x, with numbers that are separated by blanks,
//! tabs, commas or semicolons, and have a decimal point; or a decimal comma, where something else
//! separates them. Empty lines, and lines that begin with `#`, are skipped. A profile of a single
//! row may have one height per line.

use super::measured::Layout;
use super::source::{InputError, read_text};
use std::ops::Range;
use std::path::Path;

/// Smallest number of lines of three numbers that count as positions with heights although a grid
/// of three columns would fit.
const FEWEST_PLACES: usize = 6;
/// Relative deviation of positions from equal distances.
const UNEVEN: f64 = 1e-3;

/// Reads the heights of a grid of `nx` by `ny`, row by row along x, in the unit of the file.
///
/// # Errors
/// Returns an error at the invalid line: a value that is not a finite number, decimal commas, lines
/// of different lengths, or rows and columns that are not those of the grid.
pub fn read(path: &Path, [nx, ny]: [usize; 2]) -> Result<Vec<f64>, InputError> {
    let (text, name) = (read_text(path)?, path.display().to_string());
    let body = text.strip_prefix('\u{feff}').unwrap_or(&text);
    let mut rows: Vec<Vec<f64>> = Vec::new();
    // A text with points has no decimal commas.
    let layout = Layout::of(body);
    let commas = Some(layout).filter(|l| l.decimal_comma && !body.contains('.'));
    let (mut at, mut whole) = (text.len() - body.len(), true);
    for line in body.split_inclusive('\n') {
        let span = at..at + line.trim_end().len();
        at += line.len();
        let line = line.trim();
        if line.is_empty() || line.starts_with('#') {
            continue;
        }
        let row = match commas {
            Some(layout) => layout
                .cells(line)
                .iter()
                .map(|w| layout.number(w))
                .collect(),
            None => numbers(line),
        };
        let row = row.map_err(|why| InputError::at(&name, &text, span.clone(), why))?;
        if let Some(before) = rows.last()
            && before.len() != row.len()
        {
            let message = format!(
                "this line has {} numbers and the one before {}; write one line for each row of the grid along x",
                row.len(),
                before.len()
            );
            return Err(InputError::at(&name, &text, span, message));
        }
        whole &= !line.contains('.');
        rows.push(row);
    }
    let columns = rows.first().map_or(0, Vec::len);
    let fail = |why: &str| {
        let message = format!(
            "{} in {} of {columns}, and there are {} cells, {nx} along x{}: {why}",
            count(columns * rows.len(), "height"),
            count(rows.len(), "line"),
            nx * ny,
            if ny > 1 {
                format!(" in {ny} rows")
            } else {
                String::new()
            }
        );
        InputError::about(&name, message)
    };
    let alone = ny == 1 && columns == 1 && rows.len() == nx;
    if !alone && let Some(why) = misfit(&rows, [nx, ny]) {
        return Err(fail(why));
    }
    if alone || (columns == nx && rows.len() == ny) {
        return Ok(rows.concat());
    }
    if whole && columns == 2 * nx && rows.len() == ny {
        return Err(fail(
            "twice as many, as if commas stood for decimal points; write numbers with a decimal point",
        ));
    }
    if columns == 2 && ny == 1 && rows.len() == nx {
        return Err(fail(
            "these look like places and heights; write heights alone, and give their places by the cells",
        ));
    }
    Err(fail("write one line for each row of the grid along x"))
}

/// Returns why rows of numbers are not those of a grid of `nx` by `ny`, although their total number
/// may fit: they are its columns, or positions with heights. `None` for other numbers of rows and
/// columns too.
pub fn misfit(rows: &[Vec<f64>], [nx, ny]: [usize; 2]) -> Option<&'static str> {
    let (columns, lines) = (rows.first().map_or(0, Vec::len), rows.len());
    let fits = (columns, lines) == (nx, ny);
    if columns == 3 && places(rows) && (!fits || lines >= FEWEST_PLACES) {
        return Some(
            "these look like places x, y and heights z; write heights alone, one line for each row of the grid along x",
        );
    }
    (!fits && (columns, lines) == (ny, nx)).then_some(
        "the lines are the columns of the grid, which is transposed; write one line for each row of the grid along x",
    )
}

/// Returns whether the first two of three columns are the positions of a full grid at equal
/// distances, each once.
fn places(rows: &[Vec<f64>]) -> bool {
    let along = |k: usize| {
        let mut all: Vec<f64> = rows.iter().map(|row| row[k]).collect();
        all.sort_by(f64::total_cmp);
        all.dedup();
        all
    };
    let even = |all: &[f64]| {
        let ways: Vec<f64> = all.windows(2).map(|w| w[1] - w[0]).collect();
        let mean = ways.iter().sum::<f64>() / ways.len().max(1) as f64;
        ways.iter().all(|w| (w / mean - 1.0).abs() < UNEVEN)
    };
    let (x, y) = (along(0), along(1));
    if rows.len() < 3 || x.len() * y.len() != rows.len() || !even(&x) || !even(&y) {
        return false;
    }
    let mut pairs: Vec<[f64; 2]> = rows.iter().map(|row| [row[0], row[1]]).collect();
    pairs.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    pairs.windows(2).all(|w| w[0] != w[1])
}

fn count(n: usize, what: &str) -> String {
    let plural = if n == 1 { "" } else { "s" };
    format!("{n} {what}{plural}")
}

/// Returns the message for a number with a decimal comma.
fn decimal_comma(word: &str) -> String {
    format!("`{word}` has a comma within; write numbers with a decimal point, or all with a comma")
}

/// The numbers of a line.
fn numbers(line: &str) -> Result<Vec<f64>, String> {
    let separates = |c: char| c.is_whitespace() || c == ';';
    let words: Vec<&str> = line.split(separates).filter(|w| !w.is_empty()).collect();
    let within = |w: &&&str| w.trim_matches(',').contains(',');
    if let Some(word) = words.iter().find(within)
        && (words.len() > 1 || line.contains(';'))
    {
        return Err(decimal_comma(word));
    }
    let marks = |c: char| c == ',' || c == ';';
    let fields: Vec<&str> = line.split(marks).map(str::trim).collect();
    let last = fields.len() - 1;
    if let Some(k) = fields.iter().position(|f| f.is_empty())
        && (k < last || last == 0)
    {
        return Err(format!("value {} of this line is missing", k + 1));
    }
    let words = line.split(|c: char| separates(c) || c == ',');
    let number = |w: &str| {
        let finite = w.parse().ok().filter(|x: &f64| x.is_finite());
        finite.ok_or_else(|| format!("`{w}` is not a finite number; the file has heights alone"))
    };
    words.filter(|w| !w.is_empty()).map(number).collect()
}

/// Returns the values of a list in a text as rows, one for each line; empty if lines have different
/// numbers of values.
pub fn rows_of_list(text: &str, values: &[Range<usize>], heights: &[f64]) -> Vec<Vec<f64>> {
    let mut rows: Vec<Vec<f64>> = Vec::new();
    let mut end = 0;
    for (span, height) in values.iter().zip(heights) {
        let new = rows.is_empty() || text[end..span.start].contains('\n');
        end = span.end;
        match rows.last_mut() {
            Some(row) if !new => row.push(*height),
            _ => rows.push(vec![*height]),
        }
    }
    let alike = values.len() == heights.len() && rows.windows(2).all(|w| w[0].len() == w[1].len());
    if alike { rows } else { Vec::new() }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(text: &str, grid: [usize; 2]) -> Result<Vec<f64>, InputError> {
        let thread = std::thread::current().id();
        let file = format!("fretwork-heights-{}-{thread:?}.txt", std::process::id());
        let path = std::env::temp_dir().join(file);
        std::fs::write(&path, text).unwrap();
        let read = read(&path, grid);
        std::fs::remove_file(&path).unwrap();
        read
    }

    #[test]
    fn lines_are_rows_along_x() {
        let six = vec![1.0, 2.0, 3.0, 4.0, 5.0, 6.5];
        for text in [
            "# a map\n1 2 3\n\n4 5 6.5\n",
            "\u{feff}1,2,3\r\n4,5,6.5\r\n",
            "1, 2, 3,\n4, 5, 6.5\n  # end",
            "1;2;3\n4;5;6.5",
            "1\t2 3\n4\t5\t6.5",
            "1,0 2,0 3,0\n4,0 5,0 6,5",
            "1,0;2,0;3,0\n4,0;5,0;6,5",
        ] {
            assert_eq!(of(text, [3, 2]).unwrap(), six, "{text:?}");
        }
        assert_eq!(of("1\n2\n3\n4\n5\n6.5\n", [6, 1]).unwrap(), six);
        assert_eq!(of("1 2 3 4 5 6.5", [6, 1]).unwrap(), six);
        // These are positions of a grid three columns wide, but too few to be sure.
        assert!(of("0 0 1\n0 1 2\n1 0 3\n1 1 4\n", [3, 4]).is_ok());
    }

    #[test]
    fn what_is_no_grid_is_refused() {
        let places = "0 0 1\n1 0 2\n2 0 3\n0 1 4\n1 1 5\n2 1 6\n";
        for (text, grid, line, says) in [
            ("1 2 3\n4 5 6\n7 8 9\n10 11 12\n", [4, 3], 0, "transposed"),
            ("1 2 3 4\n5 6 7 8\n9 10 11 12\n", [3, 4], 0, "transposed"),
            (
                "1 2 3 4 5 6\n7 8 9 10 11 12\n",
                [4, 3],
                0,
                "in 2 lines of 6",
            ),
            ("1 2 3 4 5 6 7 8 9 10 11 12\n", [4, 3], 0, "in 1 line of 12"),
            ("1,0 2,0\n3,0 4,0\n", [4, 1], 0, "in 2 lines of 2"),
            ("1,0 2.0\n3,0 4,0\n", [2, 2], 1, "decimal point"),
            ("1.5 2\n1,0;2,0\n", [2, 2], 2, "decimal point"),
            ("1,0,2,0\n3,0,4,0\n", [2, 2], 0, "decimal point"),
            ("0 0 1\n1 0 2\n2 0 3\n3 0 4\n", [4, 3], 0, "places x, y"),
            (places, [3, 2], 0, "places x, y"),
            (places, [3, 6], 0, "places x, y"),
            ("0 1\n1 2\n2 3\n", [3, 1], 0, "places and heights"),
            ("1 2 3\n4 5\n", [3, 2], 2, "2 numbers and the one before 3"),
            ("1 2 3\n4 5 # x\n", [3, 2], 2, "`#` is not"),
            ("1,,3\n", [3, 1], 1, "value 2 of this line is missing"),
            ("1 nan 3\n", [3, 1], 1, "`nan` is not a finite number"),
            ("# nothing\n", [3, 1], 0, "0 heights"),
        ] {
            let error = of(text, grid).err();
            let error = error.unwrap_or_else(|| panic!("{text:?} passed"));
            assert!(error.message().contains(says), "{text:?}: {error}");
            assert_eq!(error.position().map_or(0, |p| p.0), line, "{error}");
        }
    }

    #[test]
    fn a_list_has_the_rows_of_its_lines() {
        let text = "[\n 1, 2, 3,\n 4, 5, 6]";
        let at: Vec<Range<usize>> = "123456"
            .chars()
            .filter_map(|c| text.find(c).map(|k| k..k + 1))
            .collect();
        let heights = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0];
        let rows = rows_of_list(text, &at, &heights);
        assert_eq!(rows, [vec![1.0, 2.0, 3.0], vec![4.0, 5.0, 6.0]]);
        assert!(misfit(&rows, [2, 3]).is_some_and(|why| why.contains("transposed")));
        assert!(misfit(&rows, [3, 2]).is_none() && misfit(&rows, [6, 1]).is_none());
    }
}
