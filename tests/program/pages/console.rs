//! Blocks of pages that show a command and what it prints.
//!
//! ```text
//! $ fretwork check CASE --no-timing     # version 0.1.0, 2026-11-29
//! what it prints
//! ...
//! ```
//!
//! A version with the day on which the program printed this (ISO 8601, UTC) says that the command
//! takes too long to be run by every test. `...` alone on a line stands for lines that are left
//! out.

use chrono::NaiveDate;
use std::ops::Range;

/// What stands for lines that are left out.
const LEFT_OUT: &str = "...";

/// Texts of lines that say how long something took, which no block shows.
const TIMED: [&str; 4] = [" a second)", "run time  ", "cpu s ", "cpu_seconds"];

/// Whether a line of output says how long something took.
pub(super) fn is_timed(line: &str) -> bool {
    TIMED.iter().any(|text| line.contains(text))
}

/// A command in a page with its output.
pub(super) struct Block {
    /// Line of the page with the command.
    pub line: usize,
    /// Lines of the page with the output, from 0.
    pub output: Range<usize>,
    /// Lines of the page with the command, from 0.
    pub command: Range<usize>,
    /// Words after `fretwork`.
    pub words: Vec<String>,
    /// What printed the output, of a command that takes long.
    pub version: Option<Printed>,
}

/// By which program an output was printed, and when.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Printed {
    /// Version of the program.
    pub version: String,
    /// Day, `2026-11-29`.
    pub day: String,
}

impl Printed {
    /// Reads what follows `version` in a comment: `0.1.0, 2026-11-29`.
    fn parse(text: &str) -> Option<Self> {
        let (version, day) = text.split_once(", ")?;
        let written = day.parse::<NaiveDate>().ok()?.to_string();
        (written == day).then(|| Self {
            version: version.to_owned(),
            day: written,
        })
    }
}

/// The words of a command of a shell up to a comment, and the comment.
pub(super) fn words(command: &str) -> Result<(Vec<String>, Option<String>), String> {
    let (mut out, mut word, mut quote) = (Vec::new(), None::<String>, None);
    let mut rest = command.chars();
    while let Some(c) = rest.next() {
        match (quote, c) {
            (Some(q), _) if q == c => quote = None,
            (Some(_), _) => word.get_or_insert_default().push(c),
            (None, '\'' | '"') => {
                word.get_or_insert_default();
                quote = Some(c);
            }
            (None, '#') if word.is_none() => {
                return Ok((out, Some(rest.as_str().trim().to_owned())));
            }
            (None, c) if c.is_whitespace() => out.extend(word.take()),
            (None, '|' | '>' | '<' | '&' | ';' | '$' | '`') => {
                return Err(format!("`{c}` is for a shell: {command}"));
            }
            (None, c) => word.get_or_insert_default().push(c),
        }
    }
    out.extend(word);
    match quote {
        Some(q) => Err(format!("a {q} is not closed: {command}")),
        None => Ok((out, None)),
    }
}

/// The blocks of a page, in their order.
///
/// # Errors
/// A block that is none of the form above.
pub(super) fn blocks(page: &str) -> Result<Vec<Block>, String> {
    let lines: Vec<&str> = page.lines().collect();
    let mut out = Vec::new();
    let mut at = 0;
    while at < lines.len() {
        if lines[at] != "```console" {
            at += 1;
            continue;
        }
        let begin = at + 1;
        let length = lines[begin..].iter().position(|l| *l == "```");
        let end = begin + length.ok_or(format!("line {at}: the block has no end"))?;
        let continued = lines[begin..end].iter().take_while(|l| l.ends_with('\\'));
        let output = (begin + continued.count() + 1).min(end);
        let command = lines[begin..output].join("\n").replace("\\\n", " ");
        let call = command.strip_prefix("$ fretwork ");
        let call = call.ok_or(format!("line {}: no `$ fretwork` but {command}", begin + 1))?;
        let (words, comment) = words(call)?;
        let version = comment.map(|comment| {
            let printed = comment.strip_prefix("version ").and_then(Printed::parse);
            printed.ok_or_else(|| {
                let line = begin + 1;
                format!("line {line}: no comment `# version 0.1.0, 2026-11-29`: {command}")
            })
        });
        let version = version.transpose()?;
        out.push(Block {
            line: begin + 1,
            output: output..end,
            command: begin..output,
            words,
            version,
        });
        at = end + 1;
    }
    Ok(out)
}

/// What identifies a line of output whose numbers may change: its words before the first number
/// that follows them.
fn label(line: &str) -> String {
    let words = line.find(char::is_alphabetic).map_or("", |k| &line[k..]);
    let end = words.find(|c: char| c.is_ascii_digit());
    let words = words[..end.unwrap_or(words.len())].split_whitespace();
    words.collect::<Vec<_>>().join(" ")
}

/// The place of a line in the output from another place on: the same text, the same label, or a
/// label of which one is the beginning of the other.
fn place(line: &str, output: &[&str], from: usize) -> Option<usize> {
    let rest = output.get(from..)?;
    let wanted = label(line);
    let alike = |same: &dyn Fn(&str) -> bool| {
        let found = rest.iter().position(|l| same(&label(l)));
        found.filter(|_| !wanted.is_empty())
    };
    let same = rest.iter().position(|l| *l == line);
    let found = same.or_else(|| alike(&|l| l == wanted));
    let found = found.or_else(|| alike(&|l| l.starts_with(&wanted)));
    // One word may begin many lines.
    let found = found.or_else(|| alike(&|l| l.contains(' ') && wanted.starts_with(l)));
    found.map(|k| from + k)
}

/// Number of spaces before a line.
fn indent(line: &str) -> usize {
    line.len() - line.trim_start().len()
}

/// Column at which the text of a line begins, behind its name in the left column.
fn column(line: &str) -> usize {
    let begin = indent(line);
    let gap = line[begin..].find("  ").map(|k| begin + k);
    gap.map_or(begin, |k| k + indent(&line[k..]))
}

/// Number of lines from a line of output on over which its text goes on. Those that begin at the
/// margin are whole: what follows is indented below them.
fn height(output: &[&str]) -> usize {
    let Some(first) = output.first().filter(|l| indent(l) > 0) else {
        return 1;
    };
    let more = output.iter().skip(1);
    1 + more.take_while(|l| indent(l) == column(first) + 2).count()
}

/// The lines of a block with the output of today: what was left out stays so, and lines that say
/// how long something took are left out.
pub(super) fn renewed(shown: &[&str], output: &[&str]) -> Vec<String> {
    // A block that leaves nothing out, or does not say what it shows, has all of it.
    let whole = shown.iter().all(|l| *l != LEFT_OUT) || shown.iter().all(|l| *l == LEFT_OUT);
    let mut kept = vec![whole; output.len()];
    let mut from = 0;
    for segment in shown.split(|l| *l == LEFT_OUT).filter(|s| !s.is_empty()) {
        let mut found: Option<Range<usize>> = None;
        for line in segment {
            if let Some(at) = place(line, output, from) {
                let begin = found.map_or(at, |f| f.start);
                from = at + height(&output[at..]);
                found = Some(begin..from);
            }
        }
        kept[found.unwrap_or_default()].fill(true);
    }
    // A block that shows the beginning, or the end, goes on to do so.
    let shows = |line: Option<&&str>| line.is_some_and(|l| *l != LEFT_OUT);
    if let (true, Some(first)) = (shows(shown.first()), kept.first_mut()) {
        *first = true;
    }
    if let (true, Some(last)) = (shows(shown.last()), kept.last_mut()) {
        *last = true;
    }
    let mut out: Vec<String> = Vec::new();
    for (line, kept) in output.iter().zip(kept) {
        if kept && !is_timed(line) {
            out.push((*line).to_owned());
        } else if out.last().is_none_or(|l| l != LEFT_OUT) {
            out.push(LEFT_OUT.to_owned());
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_are_found_with_their_commands() {
        let page = "text\n```console\n$ fretwork run a.ron --set 'b=C(d: 1)' \\\n    --out e   # version 0.1.0, 2026-11-29\none\n...\n```\n```text\n$ no\n```\n";
        let found = blocks(page).unwrap();
        assert_eq!(found.len(), 1);
        let block = &found[0];
        assert_eq!(
            block.words,
            ["run", "a.ron", "--set", "b=C(d: 1)", "--out", "e"]
        );
        let printed = block.version.as_ref().unwrap();
        assert_eq!((&*printed.version, &*printed.day), ("0.1.0", "2026-11-29"));
        assert_eq!(
            (block.line, block.command.clone(), block.output.clone()),
            (3, 2..4, 4..6)
        );
        assert!(blocks("```console\n$ fretwork a > b\n```\n").is_err());
        assert!(blocks("```console\n$ ls\n```\n").is_err());
        assert!(blocks("```console\n$ fretwork a\n").is_err());
        for comment in [
            "0.1.0",
            "0.1.0, today",
            "0.1.0, 2026-13-01",
            "0.1.0, 2026-1-1",
        ] {
            let page = format!("```console\n$ fretwork a   # version {comment}\n```\n");
            assert!(blocks(&page).is_err(), "{comment}");
        }
    }

    #[test]
    fn lines_that_are_left_out_stay_so() {
        let output = ["case", "  a 1", "  b 2", "  c 3", "end"];
        let renewed = |shown: &[&str]| renewed(shown, &output);
        assert_eq!(renewed(&[]), output);
        assert_eq!(renewed(&["case", "  d 8"]), output);
        assert_eq!(renewed(&["...", "  b 1", "..."]), ["...", "  b 2", "..."]);
        assert_eq!(
            renewed(&["case", "...", "  c 2", "end"]),
            ["case", "...", "  c 3", "end"]
        );
        // What came between two lines is shown, what is gone is not.
        assert_eq!(
            renewed(&["  a 7", "  d 8", "  c 9", "..."]),
            ["case", "  a 1", "  b 2", "  c 3", "..."]
        );
        // A line that is broken is shown with its rest.
        let broken = ["  a   b 1 c", "        d 2", "      e"];
        let shown = super::renewed(&["...", "  a b 1 c d", "..."], &broken);
        assert_eq!(shown, ["  a   b 1 c", "        d 2", "..."]);
        let timed = super::renewed(&[], &["a", "b (7 a second)", "c"]);
        assert_eq!(timed, ["a", "...", "c"]);
    }
}
