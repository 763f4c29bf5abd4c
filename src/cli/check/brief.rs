//! The answer of `fretwork check` in at most 15 lines of 100 columns: the scene, three things to
//! look at, and the run time.

use super::{CheckLine, line_of};
use crate::record::summary::{COLUMNS, fitted};

/// Largest number of lines.
const LINES: usize = 15;
/// Number of things to look at.
const LOOK_AT: usize = 3;
/// Columns of the labels, with the margin.
const MARGIN: usize = 23;

/// Columns before the text of a thing to look at, which is long.
const LOOK_MARGIN: usize = 13;

/// Labels of the lines on the scene, and how many of each are shown.
const SCENE: [(&str, usize); 11] = [
    ("steps", 1),
    ("balls", 1),
    ("convex pieces", 1),
    ("deformable body", 1),
    ("half-space", 1),
    ("first bodies", 1),
    ("contacts at start", 1),
    ("interface", 3),
    ("pressure", 1),
    ("inertial number", 1),
    ("solver", 1),
];

/// Words that mark what to look at, the worst first. A label in capitals marks its line too.
const MARKS: [&str; 11] = [
    "FAILED",
    "SOFT",
    "NOT RESOLVED",
    "NOT KNOWN",
    "WEAK",
    "COARSE",
    "too large for a step",
    "not of one temperature",
    "they pass through each other",
    "coarse:",
    "STRONG",
];

/// Returns the answer from all lines, and the line of the run time.
pub(super) fn text(title: String, lines: &[CheckLine], time: Option<CheckLine>) -> String {
    let mut out = vec![title];
    let look = look_at(lines.iter().chain(&time));
    let open = look.len().saturating_sub(LOOK_AT);
    let look: Vec<String> = match look.is_empty() {
        true => vec!["  look at  nothing stands out".to_owned()],
        false => {
            let look = look.iter().take(LOOK_AT).enumerate();
            let look = look.map(|(k, text)| {
                let label = if k == 0 { "look at" } else { "" };
                let text = fitted(text, COLUMNS - LOOK_MARGIN);
                format!("  {label:<9}{} {text}", k + 1)
            });
            look.collect()
        }
    };
    let most = LINES - out.len() - look.len() - usize::from(time.is_some()) - 1;
    let mut scene = Vec::new();
    for (wanted, count) in SCENE {
        let own = lines.iter().filter(|(label, _)| label == wanted);
        let own = own.take(count).map(|(label, text)| {
            let text = fitted(text, COLUMNS - MARGIN);
            line_of(label, &text)
        });
        scene.extend(own);
    }
    scene.truncate(most);
    out.extend(scene);
    out.extend(look);
    out.extend(time.map(|(label, text)| line_of(&label, &fitted(&text, COLUMNS - MARGIN))));
    out.push(match open {
        0 => "  all lines: --verbose".to_owned(),
        n => format!("  all lines, and {n} more to look at: --verbose"),
    });
    out.join("\n")
}

/// Returns what stands out, the worst first, each with the label of its line.
fn look_at<'a>(lines: impl Iterator<Item = &'a CheckLine>) -> Vec<String> {
    let mut found: Vec<(usize, String)> = Vec::new();
    let (mut label, mut of) = ("", "");
    for (given, text) in lines {
        if !given.is_empty() {
            // A block begins with its name, `third_body: 5652 contacts at the start, ...`.
            label = given;
            of = text.split_once(": ").map_or("", |(name, _)| name);
        }
        let capitals = label.chars().any(char::is_alphabetic)
            && label.chars().all(|c| c.is_ascii_uppercase() || c == ' ');
        let place = MARKS
            .iter()
            .position(|mark| text.contains(mark) || label.contains(mark));
        let Some(place) = place.or(capitals.then_some(0)) else {
            continue;
        };
        let text = match given.is_empty() && !of.is_empty() {
            true => format!("{label} of {of}: {text}"),
            false => format!("{label}: {text}"),
        };
        found.push((place, worst_first(&text, MARKS[place])));
    }
    found.sort_by_key(|(place, _)| *place);
    found.into_iter().map(|(_, text)| text).collect()
}

/// Leaves out the numbers between the beginning of a text and the clause with the mark.
fn worst_first(text: &str, mark: &str) -> String {
    let Some(at) = text.find(mark).filter(|at| *at > 60) else {
        return text.to_owned();
    };
    // The beginning is the label with its name and the subject of the line.
    let mut colons = text.match_indices(": ").map(|(k, _)| k);
    let begins = colons.nth(1).filter(|k| *k < at).unwrap_or(at);
    format!("{}: {}", &text[..begins], &text[at..])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(label: &str, text: &str) -> CheckLine {
        (label.to_owned(), text.to_owned())
    }

    #[test]
    fn what_stands_out_comes_worst_first_with_its_subject() {
        let lines = [
            line("steps", "7000 of 2.5e-5 s"),
            line(
                "no interface",
                "rail and wheel: they pass through each other",
            ),
            line(
                "bonds",
                "third_body: 5652 contacts at the start, reduced radius 1.26e-6 m",
            ),
            line("", "opened: strength 6e8 Pa"),
            line(
                "",
                "slide a step: 1.57e-8 m by `wheel`, 3.14e-1 of the opening at break (3.14e-1 of that at the peak): NOT RESOLVED: a bond breaks within 4 steps",
            ),
            line("ALIASED DRIVE", "`pin` along x"),
        ];
        assert_eq!(
            look_at(lines.iter()),
            [
                "ALIASED DRIVE: `pin` along x",
                "bonds of third_body: slide a step: NOT RESOLVED: a bond breaks within 4 steps",
                "no interface: rail and wheel: they pass through each other",
            ]
        );
    }

    #[test]
    fn the_answer_has_at_most_15_lines_of_100_columns() {
        let long = "x ".repeat(120);
        let mut lines: Vec<CheckLine> = SCENE.map(|(label, _)| line(label, &long)).into();
        lines.extend((0..5).map(|_| line("interface", &long)));
        lines.extend((0..5).map(|_| line("bonds", &format!("{long}: NOT RESOLVED: {long}"))));
        let out = text("title".to_owned(), &lines, Some(line("run time", &long)));
        assert!(out.lines().count() <= LINES, "{out}");
        assert!(out.lines().all(|l| l.chars().count() <= COLUMNS), "{out}");
        assert!(out.contains("and 2 more to look at"), "{out}");
        let calm = text("title".to_owned(), &[line("steps", "7")], None);
        assert!(calm.contains("nothing stands out"), "{calm}");
    }
}
