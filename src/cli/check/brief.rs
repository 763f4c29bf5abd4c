//! The answer of `fretwork check` in at most 15 lines of 100 columns: the scene, three things to
//! look at, and the run time.

use super::CheckLine;
use crate::record::summary::{COLUMNS, cut, fitted, wrapped};

/// Largest number of lines.
const LINES: usize = 15;
/// Number of things to look at.
const LOOK_AT: usize = 3;
/// Columns of the labels, with the margin.
const MARGIN: usize = 17;
/// Number of lines of a thing to look at, if there is room.
const LOOK_LINES: usize = 2;

/// Label of lines on the scene, how many of them are shown, and the labels of the lines that are
/// added to them, each with its name there.
type SceneLine = (&'static str, usize, &'static [(&'static str, &'static str)]);

/// The lines on the scene.
const SCENE: [SceneLine; 9] = [
    ("steps", 1, &[("solver", "solver")]),
    ("balls", 1, &[]),
    ("convex pieces", 1, &[]),
    ("deformable body", 1, &[]),
    ("half-space", 1, &[]),
    (
        "first bodies",
        1,
        &[("contacts at start", "contacts at start")],
    ),
    ("interface", 3, &[]),
    ("pressure", 1, &[("inertial number", "inertial number")]),
    ("biaxial test", 1, &[("inertial number", "inertial number")]),
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
    let look = look_at(lines.iter().chain(&time));
    let open = look.len().saturating_sub(LOOK_AT);
    let mut look: Vec<Vec<String>> = match look.is_empty() {
        true => vec![vec!["nothing stands out".to_owned()]],
        false => {
            let look = look.iter().take(LOOK_AT).enumerate();
            look.map(|(k, text)| wrapped(&format!("{} {text}", k + 1), COLUMNS - MARGIN))
                .collect()
        }
    };
    let mut scene = scene(lines);
    let time = time.map(|(label, text)| {
        let kept = text
            .split_once(": ")
            .map_or(text.as_str(), |(kept, _)| kept);
        labelled(&label, &fitted(kept, COLUMNS - MARGIN))
    });
    // Title and last line.
    let most = LINES - 2 - usize::from(time.is_some());
    scene.truncate(most - look.len());
    let mut spare = most - look.len() - scene.len();
    for lines in &mut look {
        let shown = LOOK_LINES.min(1 + spare).min(lines.len());
        spare -= shown - 1;
        cut(lines, shown, COLUMNS - MARGIN);
    }
    let look = look.into_iter().enumerate().flat_map(|(k, lines)| {
        let label = move |line| if k + line == 0 { "look at" } else { "" };
        let lines = lines.into_iter().enumerate();
        lines.map(move |(line, text)| labelled(label(line), &text))
    });
    let mut out = vec![fitted(&title, COLUMNS)];
    out.extend(scene);
    out.extend(look);
    out.extend(time);
    out.push(match open {
        0 => "  all lines: --verbose".to_owned(),
        n => format!("  all lines, and {n} more to look at: --verbose"),
    });
    out.join("\n")
}

fn labelled(label: &str, text: &str) -> String {
    format!("  {label:<width$}{text}", width = MARGIN - 2)
}

/// Returns the lines on the scene.
fn scene(lines: &[CheckLine]) -> Vec<String> {
    let of = |wanted: &str| {
        let own = lines.iter().filter(move |(label, _)| label == wanted);
        own.map(|(label, text)| short(label, text))
            .collect::<Vec<_>>()
    };
    let mut out = Vec::new();
    for (wanted, count, added) in SCENE {
        for mut text in of(wanted).into_iter().take(count) {
            for (label, name) in added {
                if let Some(other) = of(label).first() {
                    text = format!("{text}; {name} {other}");
                }
            }
            out.push(labelled(wanted, &fitted(&text, COLUMNS - MARGIN)));
        }
    }
    out
}

/// Returns the part of a line that the answer has.
fn short(label: &str, text: &str) -> String {
    let before = |end: &str| text.split_once(end).map_or(text, |(before, _)| before);
    match label {
        // `auto (what it is), tolerance 0.5, at most 20000 iterations, tested every 10`
        "solver" => match (text.find(" ("), text.find("), ")) {
            (Some(begin), Some(end)) if begin < end => {
                let rest = text[end + 1..].split(", ").skip(1).take(1);
                let rest: Vec<&str> = rest.collect();
                format!("{}, {}", &text[..begin], rest.join(", "))
            }
            _ => before(" (").to_owned(),
        },
        // Kinds are known by their names, but for that of wear.
        "interface" => {
            let kinds = ["contact ", "cohesion ", "damage "];
            let laws = before("; ").split(", ").map(|law| {
                let (name, law) = law
                    .split_once(": ")
                    .map_or(("", law), |(name, law)| (name, law));
                let law = kinds
                    .iter()
                    .find_map(|kind| law.strip_prefix(kind))
                    .unwrap_or(law);
                match name {
                    "" => law.to_owned(),
                    name => format!("{name}: {law}"),
                }
            });
            laws.collect::<Vec<_>>().join(", ")
        }
        "inertial number" => before(" ").to_owned(),
        // What was timed follows the estimate.
        "run time" if text.starts_with("about ") => before(": ").to_owned(),
        _ => text.to_owned(),
    }
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
        let mut lines: Vec<CheckLine> = SCENE.map(|(label, ..)| line(label, &long)).into();
        lines.extend((0..5).map(|_| line("interface", &long)));
        lines.extend((0..5).map(|_| line("bonds", &format!("{long}: NOT RESOLVED: {long}"))));
        let out = text("title".to_owned(), &lines, Some(line("run time", &long)));
        assert!(out.lines().count() <= LINES, "{out}");
        assert!(out.lines().all(|l| l.chars().count() <= COLUMNS), "{out}");
        assert!(out.contains("and 2 more to look at"), "{out}");
        let scene = [
            line("steps", "7000 of 2.5e-5 s, theta 0.5"),
            line(
                "solver",
                "auto (automatic, first (one)), tolerance 5e-1, at most 20 iterations",
            ),
            line(
                "interface",
                "oxide: contact hertz-mindlin, damage mac, wear archard; bonds Start",
            ),
            line("pressure", "1.120e9 Pa"),
            line("inertial number", "5.31e-3 with inertia scaled by 5.8e8"),
        ];
        let out = text("title".to_owned(), &scene, None);
        for says in [
            "steps          7000 of 2.5e-5 s, theta 0.5; solver auto, tolerance 5e-1",
            "interface      oxide: hertz-mindlin, mac, wear archard",
            "pressure       1.120e9 Pa; inertial number 5.31e-3",
        ] {
            assert!(out.contains(says), "{says}: {out}");
        }
        let calm = text("title".to_owned(), &[line("steps", "7")], None);
        assert!(calm.contains("nothing stands out"), "{calm}");
    }
}
