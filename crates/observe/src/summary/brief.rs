//! The end of a run in at most 14 lines of 100 columns: the grade with what is known of the error,
//! results by topic, and three things to look at.

use super::{Grade, Summary};
use crate::quantity::{Findings, Quantity, Role, Topic, Wording, quantity, with_half_width};
use fretwork_scene::input_ranges::GivenRange;
use serde_json::Value;

/// Largest number of lines: the caller adds one with the folder of the results.
const LINES: usize = 14;
/// Largest number of columns of a line of an answer.
pub const COLUMNS: usize = 100;
/// Columns of the labels, with the margin.
const MARGIN: usize = 13;
/// Number of things to look at.
const LOOK_AT: usize = 3;

/// Topics in the order of their lines, with their labels.
const TOPICS: [(Topic, &str); 6] = [
    (Topic::Friction, "friction"),
    (Topic::Wear, "wear"),
    (Topic::Damage, "damage"),
    (Topic::Regime, "regime"),
    (Topic::Measures, "measures"),
    (Topic::Energy, "energy"),
];

/// Number of topics at the beginning of these that come before the others.
const MAIN: usize = 4;

impl Summary {
    /// Returns the lines of the text without details.
    pub(super) fn brief(&self) -> Vec<String> {
        let all = self.quantities();
        let run = &self.run;
        let mut head = vec![run.grade.words().to_owned()];
        let trusted = run.grade != Grade::NotTrustworthy;
        let mut warnings = run.warnings.iter();
        head.push(match trusted {
            true => format!("  {}", fitted(&run.grade_sentence, COLUMNS - 2)),
            false => {
                let first = warnings.next().map_or("", String::as_str);
                format!("  {}", fitted(first, COLUMNS - 2))
            }
        });
        let mut look: Vec<String> = warnings.cloned().collect();
        look.extend(undetermined(&all));
        look.extend(run.sample.seeds.clone());
        let look = look.iter().take(LOOK_AT).enumerate().map(|(k, text)| {
            let label = if k == 0 { "look at" } else { "" };
            let text = fitted(text, COLUMNS - MARGIN - 2);
            labelled(label, &format!("{} {text}", k + 1))
        });
        let look: Vec<String> = look.collect();
        let mut tail = Vec::new();
        let given: Vec<String> = run.given.iter().map(given).collect();
        let given = flow(&given, COLUMNS - MARGIN).into_iter().next();
        let given = given.map(|text| labelled("given", &text));
        let last = all.all().iter();
        let mut last = last.filter(|q| q.topic == Topic::Run && q.role == Role::Secondary);
        if let Some(Wording::Sentence(label, text)) = last.next().map(|q| &q.wording) {
            tail.push(labelled(label, &fitted(text, COLUMNS - MARGIN)));
        }
        let fixed = head.len() + look.len() + tail.len() + usize::from(given.is_some());
        let left = LINES - fixed;
        let topics = TOPICS.map(|(topic, label)| (label, entries(&all, topic)));
        head.extend(within(left, &topics));
        let rest = given.into_iter().chain(look).chain(tail);
        head.into_iter().chain(rest).collect()
    }
}

/// Returns a parameter that was given, with the range in its source.
fn given(of: &GivenRange) -> String {
    let plain = |x: f64| match x == 0.0 || (1e-3..1e5).contains(&x.abs()) {
        true => x.to_string(),
        false => format!("{x:e}"),
    };
    let [low, high] = of.range.map(plain);
    let value = format!("{} {}", plain(of.value), of.unit);
    format!(
        "{} of {} {} (range {low} to {high} in its source)",
        of.parameter,
        of.law,
        value.trim_end()
    )
}

/// Returns the lines of the topics: one of each main topic, second ones of these, one of each other
/// topic, and more as long as there is room.
fn within(most: usize, topics: &[(&str, Vec<String>)]) -> Vec<String> {
    let flowed = topics.iter();
    let flowed: Vec<Vec<String>> = flowed
        .map(|(_, entries)| flow(entries, COLUMNS - MARGIN))
        .collect();
    // Places of the lines: rank, topic, line of the topic.
    let mut places: Vec<[usize; 3]> = Vec::new();
    for (topic, lines) in flowed.iter().enumerate() {
        // The first lines of other topics come before the third ones of main topics.
        let rank = |line: usize| match topic < MAIN {
            true => line + usize::from(line >= 2),
            false => line + 2,
        };
        places.extend((0..lines.len()).map(|line| [rank(line), topic, line]));
    }
    places.sort_unstable();
    places.truncate(most);
    places.sort_unstable_by_key(|[_, topic, line]| [*topic, *line]);
    let line = |[_, topic, line]: [usize; 3]| {
        let label = if line == 0 { topics[topic].0 } else { "" };
        labelled(label, &flowed[topic][line])
    };
    places.into_iter().map(line).collect()
}

fn labelled(label: &str, text: &str) -> String {
    format!("  {label:<width$}{text}", width = MARGIN - 2)
}

/// Breaks entries into lines; an entry that does not fit into a line is cut.
fn flow(entries: &[String], columns: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for entry in entries {
        let length = entry.chars().count();
        match lines.last_mut() {
            Some(line) if line.chars().count() + 2 + length <= columns => {
                *line = format!("{line}; {entry}");
            }
            _ => lines.push(fitted(entry, columns)),
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

/// Returns the results of a topic: those with half-widths first, main results before others.
fn entries(all: &Findings, topic: Topic) -> Vec<String> {
    let own = |q: &&Quantity| {
        q.topic == topic && q.role <= Role::Secondary && q.wording != Wording::Silent
    };
    let mut list: Vec<&Quantity> = all.all().iter().filter(own).collect();
    list.sort_by_key(|q| (q.estimate.is_none(), q.role));
    let dimension = all.dimension();
    let mut causes = topic != Topic::Energy;
    let mut out = Vec::new();
    for q in list {
        let entry = entry(q, dimension, causes);
        causes &= entry.is_none();
        out.extend(entry);
    }
    out
}

/// Returns a result with its half-width, and the causes of that if requested.
fn entry(q: &Quantity, dimension: usize, causes: bool) -> Option<String> {
    if q.topic == Topic::Regime {
        return match &q.wording {
            Wording::Sentence(_, text) => Some(text.clone()),
            _ => q.value.as_str().map(str::to_owned),
        };
    }
    let unit = q.unit.symbol(dimension);
    let estimate = q.estimate.as_ref().filter(|e| e.half_width().is_some());
    if let (Some(estimate), Value::Number(_)) = (estimate, &q.value) {
        let (value, half) = (estimate.value?, estimate.half_width()?);
        let shown = match half < value.abs() {
            true => with_half_width(value, half, unit),
            false => format!("{} (error as large)", quantity(value, unit)),
        };
        if estimate.is_determined() == Some(false) {
            return Some(format!("{} not determined: {shown}", q.label()));
        }
        let by: Vec<String> = estimate.shares().into_iter().map(|(of, _)| of).collect();
        let by = match causes {
            true => format!(" ({})", by.join(", ")),
            false => String::new(),
        };
        return Some(format!("{} {shown}{by}", q.label()));
    }
    match &q.wording {
        Wording::Sentence(label, text) => Some(format!("{label} {text}")),
        _ => {
            let value = match &q.value {
                Value::Number(n) if n.is_f64() => quantity(n.as_f64()?, unit),
                Value::Number(n) => n.to_string(),
                Value::String(text) => text.clone(),
                _ => return None,
            };
            Some(format!("{} {value}", q.label()))
        }
    }
}

/// Returns a sentence on each main result that is not determined.
fn undetermined(all: &Findings) -> Vec<String> {
    let main = all.all().iter().filter(|q| q.role == Role::Headline);
    let open = main.filter(|q| {
        let estimate = q.estimate.as_ref();
        estimate.and_then(|e| e.is_determined()) == Some(false)
    });
    let says = |q: &Quantity| {
        let estimate = q.estimate.as_ref()?;
        let (of, share) = estimate
            .shares()
            .into_iter()
            .max_by(|a, b| a.1.total_cmp(&b.1))?;
        let share = match share < 1.0 {
            true => format!("{:.0} %", 100.0 * share),
            false => "all of it".to_owned(),
        };
        Some(format!(
            "{} is not determined: {of} may change {share}",
            q.label()
        ))
    };
    open.filter_map(says).collect()
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
    fn topics_share_the_lines_there_are() {
        let entry = |k: usize| format!("entry {k} {}", "x".repeat(70));
        let many = |n: usize| (0..n).map(entry).collect::<Vec<_>>();
        let topics = [
            ("friction", many(3)),
            ("wear", many(1)),
            ("none", many(0)),
            ("energy", many(9)),
        ];
        let lines = within(6, &topics);
        let label = |l: &String| l[2..MARGIN].trim().to_owned();
        let labels: Vec<String> = lines.iter().map(label).collect();
        assert_eq!(
            labels,
            ["friction", "", "", "wear", "energy", ""].map(str::to_owned)
        );
        assert!(lines.iter().all(|l| l.chars().count() <= COLUMNS));
        assert_eq!(within(2, &topics).len(), 2);
    }
}
