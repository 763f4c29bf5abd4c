//! Texts in lines of a number of columns, and what is left of them in fewer lines.

/// Largest number of columns of a line of an answer.
pub const COLUMNS: usize = 100;
/// Fewest characters of the first clauses of a text that say something without the rest.
const SAYS: usize = 24;
/// What ends a clause.
const ENDS: [&str; 5] = ["; ", ". ", ": ", ", ", " ("];

/// Keeps this number of lines of a broken text, at least one: the clauses at its beginning that
/// have room there. Where not even the first has, its words, with an end that shows that more
/// follows.
pub fn cut(lines: &mut Vec<String>, count: usize, columns: usize) {
    let count = count.max(1);
    if lines.len() <= count {
        return;
    }
    let words: Vec<&str> = lines.iter().map(|line| line.trim_start()).collect();
    let text = words.join(" ");
    let ends = ENDS.iter().flat_map(|end| text.match_indices(end));
    let mut ends: Vec<usize> = ends.map(|(at, _)| at).collect();
    ends.sort_unstable();
    let shorter = ends.into_iter().rev().map(|at| &text[..at]);
    let mut shorter = shorter.filter(|kept| kept.len() >= SAYS && is_closed(kept));
    let kept =
        shorter.find_map(|kept| Some(wrapped(kept, columns)).filter(|lines| lines.len() <= count));
    if let Some(kept) = kept {
        *lines = kept;
        return;
    }
    let rest = lines.split_off(count);
    if let Some(last) = lines.last_mut() {
        for line in rest {
            *last = format!("{last} {}", line.trim_start());
        }
        *last = fitted(last, columns);
    }
}

/// Whether a text ends outside of brackets and of code.
fn is_closed(text: &str) -> bool {
    let count = |of: char| text.matches(of).count();
    count('(') == count(')') && count('`').is_multiple_of(2)
}

/// Breaks a text into lines, between words; a line after the first is indented.
pub fn wrapped(text: &str, columns: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if line.chars().count() + 1 + word.chars().count() <= columns => {
                *line += " ";
                *line += word;
            }
            Some(_) => lines.push(format!("  {word}")),
            None => lines.push(word.to_owned()),
        }
    }
    lines.iter().map(|line| fitted(line, columns)).collect()
}

/// Puts entries into lines. One that does not fit into a line is broken between its clauses, and a
/// clause between words.
pub(super) fn flow(entries: &[String], columns: usize) -> Vec<String> {
    let length = |text: &str| text.chars().count();
    let mut lines: Vec<String> = Vec::new();
    let mut add = |entry: &str| match lines.last_mut() {
        Some(line) if length(line) + 2 + length(entry) <= columns => {
            *line = format!("{line}; {entry}");
        }
        _ => lines.extend(wrapped(entry, columns)),
    };
    for entry in entries {
        match length(entry) <= columns {
            true => add(entry),
            false => entry.split("; ").for_each(&mut add),
        }
    }
    lines
}

/// Cuts a text to a number of columns, at the end of a clause if it keeps most of them, and
/// otherwise between words.
pub fn fitted(text: &str, columns: usize) -> String {
    if text.chars().count() <= columns {
        return text.to_owned();
    }
    let kept: String = text.chars().take(columns - 4).collect();
    let clause = [". ", "; ", ": ", ", "].iter();
    let clause = clause.filter_map(|end| kept.rfind(end)).max();
    let end = clause.filter(|end| 4 * *end > 3 * kept.len());
    let end = end.or_else(|| kept.rfind(' ')).unwrap_or(kept.len());
    format!("{} ...", kept[..end].trim_end_matches([';', ':', ',']))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_text_is_cut_at_a_clause_or_between_words() {
        assert_eq!(fitted("short", 10), "short");
        assert_eq!(
            fitted("NOT KNOWN: the first clause, the second clause", 34),
            "NOT KNOWN: the first clause ..."
        );
        assert_eq!(
            fitted("only one clause of words", 20),
            "only one clause ..."
        );
        let long = fitted(&"é".repeat(300), COLUMNS);
        assert!(long.chars().count() <= COLUMNS, "{long}");
    }

    #[test]
    fn an_entry_is_broken_between_clauses_and_a_clause_between_words() {
        let clause = |word: &str| [word; 8].join(" ");
        let long = [clause("first"), clause("second"), "short".to_owned()].join("; ");
        let lines = flow(&["one".to_owned(), long], 62);
        let expected = [
            format!("one; {}", clause("first")),
            format!("{}; short", clause("second")),
        ];
        assert_eq!(lines, expected);
        assert_eq!(
            flow(&[clause("first")], 30),
            [["first"; 5].join(" "), "  first first first".to_owned()]
        );
    }

    #[test]
    fn fewer_lines_have_the_clauses_that_fit() {
        let text = "1 NOT STEADY: friction has no interval: 10 blocks of equal time still show a trend (by a test, p < 0.01); let it run longer";
        let of = |count: usize, columns: usize| {
            let mut lines = wrapped(text, columns);
            cut(&mut lines, count, columns);
            lines
        };
        assert_eq!(of(9, 200), [text]);
        assert_eq!(
            of(1, 90),
            ["1 NOT STEADY: friction has no interval: 10 blocks of equal time still show a trend"]
        );
        // Not within the brackets.
        assert_eq!(
            of(1, 100),
            ["1 NOT STEADY: friction has no interval: 10 blocks of equal time still show a trend"]
        );
        assert_eq!(of(1, 60), ["1 NOT STEADY: friction has no interval"]);
        assert_eq!(
            of(2, 60),
            [
                "1 NOT STEADY: friction has no interval: 10 blocks of equal",
                "  time still show a trend (by a test, p < 0.01)"
            ]
        );
        assert_eq!(of(1, 30), ["1 NOT STEADY: friction ..."]);
    }
}
