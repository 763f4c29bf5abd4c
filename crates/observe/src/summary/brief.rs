//! The end of a run in at most 14 lines of 100 columns: the grade with what is known of the error,
//! results by topic, and three things to look at.

use super::{Grade, Summary};
use crate::quantity::unit::WEAR_RATE;
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

/// Ranks of the lines of a block: a line of a lower rank is shown before one of a higher rank.
type Ranks = [usize; 4];

/// Topics in the order of their blocks, with their labels and ranks. Wear has the most lines: its
/// volumes, and the wear rate of each body.
const TOPICS: [(Topic, &str, Ranks); 6] = [
    (Topic::Friction, "friction", [0, 3, 5, 6]),
    (Topic::Wear, "wear", [0, 1, 2, 6]),
    (Topic::Damage, "damage", [0, 3, 5, 6]),
    (Topic::Regime, "regime", [0, 3, 6, 6]),
    (Topic::Measures, "measures", [2, 4, 5, 5]),
    (Topic::Energy, "energy", [4, 6, 7, 7]),
];
/// Beginning of the labels of the wear of each body.
const WEAR_OF: &str = "wear of ";

const GRADE: Ranks = [0, 2, 8, 8];
const LOOK: Ranks = [0, 3, 5, 9];
const GIVEN: Ranks = [0, 6, 8, 8];

/// Lines under a label.
struct Block {
    /// The label; `None` where the lines begin in its place.
    label: Option<&'static str>,
    lines: Vec<String>,
    ranks: Ranks,
    /// Whether the lines are those of one text, whose end shows that it is cut.
    text: bool,
}

impl Block {
    /// Creates the block of a text.
    fn of_text(label: Option<&'static str>, text: &str, ranks: Ranks) -> Self {
        Self {
            label,
            lines: wrapped(text, columns_beside(label)),
            ranks,
            text: true,
        }
    }

    /// Creates the block of entries that may stand in one line.
    fn of_entries(label: &'static str, entries: &[String], ranks: Ranks) -> Self {
        let label = Some(label);
        Self {
            label,
            lines: flow(entries, columns_beside(label)),
            ranks,
            text: false,
        }
    }

    fn rank(&self, line: usize) -> usize {
        let last = self.ranks[self.ranks.len() - 1];
        self.ranks.get(line).copied().unwrap_or(last + line)
    }

    /// Returns the first lines with the label.
    fn shown(&self, count: usize) -> Vec<String> {
        let mut lines = self.lines.clone();
        match self.text {
            true => cut(&mut lines, count, columns_beside(self.label)),
            false => lines.truncate(count),
        }
        let line = |(k, line): (usize, &String)| match self.label {
            None => format!("  {line}"),
            Some(label) => labelled(if k == 0 { label } else { "" }, line),
        };
        lines.iter().enumerate().map(line).collect()
    }
}

/// Returns the columns of the lines of a block with this label.
fn columns_beside(label: Option<&str>) -> usize {
    COLUMNS - label.map_or(2, |_| MARGIN)
}

/// Returns the lines of the blocks, at most this number: those of the lowest ranks.
fn within(most: usize, blocks: &[Block]) -> Vec<String> {
    let mut places: Vec<[usize; 3]> = Vec::new();
    for (k, block) in blocks.iter().enumerate() {
        places.extend((0..block.lines.len()).map(|line| [block.rank(line), line, k]));
    }
    places.sort_unstable();
    places.truncate(most);
    let count = |k: usize| places.iter().filter(|place| place[2] == k).count();
    let blocks = blocks.iter().enumerate();
    blocks
        .flat_map(|(k, block)| match count(k) {
            0 => Vec::new(),
            n => block.shown(n),
        })
        .collect()
}

impl Summary {
    /// Returns the lines of the text without details.
    pub(super) fn brief(&self) -> Vec<String> {
        let all = self.quantities();
        let run = &self.run;
        let mut warnings = run.warnings.iter();
        let grade = match run.grade {
            Grade::NotTrustworthy => warnings.next().map_or("", String::as_str),
            _ => &run.grade_sentence,
        };
        let mut blocks = vec![Block::of_text(None, grade, GRADE)];
        for (topic, label, ranks) in TOPICS {
            blocks.push(Block::of_entries(
                label,
                &entries(&all, topic, grade),
                ranks,
            ));
        }
        let given: Vec<String> = run.given.iter().map(given).collect();
        blocks.push(Block::of_entries("given", &given, GIVEN));
        let mut look: Vec<String> = warnings.cloned().collect();
        look.extend(undetermined(&all));
        look.extend(run.sample.seeds.clone());
        if look.is_empty() {
            let none = Block::of_text(Some("look at"), "nothing stands out", LOOK);
            blocks.push(none);
        }
        for (k, text) in look.iter().take(LOOK_AT).enumerate() {
            let label = if k == 0 { "look at" } else { "" };
            let text = format!("{} {text}", k + 1);
            blocks.push(Block::of_text(Some(label), &text, LOOK));
        }
        let last = all.all().iter();
        let mut last = last.filter(|q| q.topic == Topic::Run && q.role == Role::Secondary);
        if let Some(Wording::Sentence(_, text)) = last.next().map(|q| &q.wording) {
            blocks.push(Block::of_text(Some("run"), text, [0; 4]));
        }
        let mut out = vec![run.grade.words().to_owned()];
        out.extend(within(LINES - 1, &blocks));
        out
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

fn labelled(label: &str, text: &str) -> String {
    format!("  {label:<width$}{text}", width = MARGIN - 2)
}

/// Keeps this number of lines of a broken text, at least one; the end of the last shows that more
/// follows.
pub fn cut(lines: &mut Vec<String>, count: usize, columns: usize) {
    let rest = lines.split_off(count.min(lines.len()));
    let Some(last) = lines.last_mut().filter(|_| !rest.is_empty()) else {
        return;
    };
    for line in rest {
        *last = format!("{last} {}", line.trim_start());
    }
    *last = fitted(last, columns);
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
fn flow(entries: &[String], columns: usize) -> Vec<String> {
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

/// Returns the place of a result of wear: volumes with half-widths, rates of bodies, others, flows.
fn place(q: &Quantity) -> u8 {
    match &q.wording {
        _ if q.topic != Topic::Wear => 0,
        _ if q.role == Role::Headline => 3,
        Wording::Value(_) if q.estimate.is_some() => 0,
        Wording::Sentence(label, _) if label.starts_with(WEAR_OF) || q.unit == WEAR_RATE => 1,
        _ => 2,
    }
}

/// Returns the results of a topic: those with half-widths first, main results before others. The
/// causes of the half-width of the result of the `sentence` on the error are in that.
fn entries(all: &Findings, topic: Topic, sentence: &str) -> Vec<String> {
    let own = |q: &&Quantity| {
        q.topic == topic && q.role <= Role::Secondary && q.wording != Wording::Silent
    };
    let mut list: Vec<&Quantity> = all.all().iter().filter(own).collect();
    list.sort_by_key(|q| (place(q), q.estimate.is_none(), q.role));
    let dimension = all.dimension();
    let mut causes = topic != Topic::Energy;
    let mut out: Vec<String> = Vec::new();
    // Values that were shown with their half-widths.
    let mut shown: Vec<String> = Vec::new();
    for q in list {
        let known = sentence.starts_with(&format!("error of {}", q.label()));
        let Some(mut entry) = entry(q, dimension, causes && !known) else {
            continue;
        };
        causes = false;
        match (&q.wording, q.value.as_f64()) {
            (_, Some(value)) if q.estimate.is_some() => {
                shown.push(quantity(value, q.unit.symbol(dimension)));
            }
            (Wording::Sentence(label, text), _) => {
                // The label of the block says what it is about.
                let label = label.strip_prefix(WEAR_OF).unwrap_or(label);
                let mut again = shown.iter().filter_map(|v| text.strip_prefix(v.as_str()));
                entry = match again.find_map(|rest| rest.strip_prefix(", ")) {
                    Some(rest) => format!("{label}: {rest}"),
                    None if topic == Topic::Wear => format!("{label} {text}"),
                    None => entry,
                };
            }
            _ => {}
        }
        out.push(entry);
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
        let plain = format!("{} {shown}", q.label());
        let caused = format!("{plain} ({})", by.join(", "));
        let fits = causes && caused.chars().count() <= COLUMNS - MARGIN;
        return Some(if fits { caused } else { plain });
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
    fn blocks_share_the_lines_there_are() {
        let entry = |k: usize| format!("entry {k} {}", "x".repeat(70));
        let many = |n: usize| (0..n).map(entry).collect::<Vec<_>>();
        let [friction, wear, damage, .., energy] = TOPICS.map(|(_, label, ranks)| (label, ranks));
        let look = format!("1 {}", "word ".repeat(60));
        let blocks = [
            Block::of_entries(friction.0, &many(3), friction.1),
            Block::of_entries(wear.0, &many(1), wear.1),
            Block::of_entries(damage.0, &many(0), damage.1),
            Block::of_entries(energy.0, &many(9), energy.1),
            Block::of_text(Some("look at"), &look, LOOK),
        ];
        let lines = within(7, &blocks);
        let label = |l: &String| l[2..MARGIN].trim().to_owned();
        let labels: Vec<String> = lines.iter().map(label).collect();
        assert_eq!(
            labels,
            ["friction", "", "", "wear", "energy", "look at", ""].map(str::to_owned)
        );
        assert!(lines[6].ends_with(" ..."), "{lines:?}");
        assert!(lines.iter().all(|l| l.chars().count() <= COLUMNS));
        assert_eq!(within(2, &blocks).len(), 2);
    }
}
