//! The end of a run in at most 14 lines of 100 columns: the grade with what is known of the error,
//! results by topic, and three things to look at.

use super::lines::{COLUMNS, cut, fitted, flow, wrapped};
use super::{Grade, Summary};
use crate::quantity::unit::WEAR_RATE;
use crate::quantity::{
    Findings, Quantity, Role, Topic, Wording, quantity, short_cause, with_half_width,
};
use fretwork_scene::input_ranges::GivenRange;
use serde_json::Value;

/// Largest number of lines: the caller adds one with the folder of the results.
const LINES: usize = 14;
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
            false => {
                let whole = lines.len() <= count;
                lines.truncate(count);
                // A line that goes on in the next one, which is not shown.
                let goes_on = self.lines.get(count).is_some_and(|l| l.starts_with(' '));
                if let Some(last) = lines.last_mut().filter(|_| !whole && goes_on) {
                    let room = columns_beside(self.label);
                    *last = fitted(&format!("{last} {}", ".".repeat(room)), room);
                }
            }
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
        let mut out = wrapped(&run.verdict, COLUMNS);
        cut(&mut out, 1, COLUMNS);
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

/// End of the depths of a body.
const DEPTHS_END: &str = " at most";

/// Places of results of wear: rates k of bodies with K, volumes with half-widths, others and the
/// depths of bodies, flows.
const RATES: u8 = 0;
const ESTIMATES: u8 = 1;
const OTHERS: u8 = 2;
const FLOWS: u8 = 3;

fn place(q: &Quantity) -> u8 {
    match &q.wording {
        _ if q.topic != Topic::Wear => OTHERS,
        _ if q.role == Role::Headline => FLOWS,
        Wording::Value(_) if q.estimate.is_some() => ESTIMATES,
        Wording::Sentence(label, _) if label.starts_with(WEAR_OF) || q.unit == WEAR_RATE => RATES,
        _ => OTHERS,
    }
}

/// Returns the results of a topic: wear rates first, those with half-widths before others, main
/// results before others. The causes of the half-width of the result of the `sentence` on the error
/// are in that.
fn entries(all: &Findings, topic: Topic, sentence: &str) -> Vec<String> {
    let own = |q: &&Quantity| {
        q.topic == topic && q.role <= Role::Secondary && q.wording != Wording::Silent
    };
    let mut list: Vec<&Quantity> = all.all().iter().filter(own).collect();
    // Values with half-widths come first here: the sentences of bodies do not repeat them.
    list.sort_by_key(|q| (place(q) == FLOWS, q.estimate.is_none(), q.role));
    let dimension = all.dimension();
    let mut causes = topic != Topic::Energy;
    let mut out: Vec<(u8, String)> = Vec::new();
    // Values that were shown with their half-widths.
    let mut shown: Vec<String> = Vec::new();
    for q in list {
        let known = sentence.starts_with(&format!("error of {}", q.label()));
        let Some(entry) = entry(q, dimension, causes && !known) else {
            continue;
        };
        causes = false;
        match (&q.wording, q.value.as_f64()) {
            (_, Some(value)) if q.estimate.is_some() => {
                shown.push(quantity(value, q.unit.symbol(dimension)));
                out.push((place(q), entry));
            }
            (Wording::Sentence(label, text), _) if topic == Topic::Wear => {
                // The label of the block says what it is about.
                let label = label.strip_prefix(WEAR_OF).unwrap_or(label);
                let mut again = shown.iter().filter_map(|v| text.strip_prefix(v.as_str()));
                let text = match again.find_map(|rest| rest.strip_prefix(", ")) {
                    Some(rest) => rest,
                    None => text,
                };
                // Depths may be left out where there is no room.
                let parts = text.rsplit_once("; ");
                let parts = parts.filter(|(_, last)| last.ends_with(DEPTHS_END));
                let (rate, depths) = parts.unwrap_or((text, ""));
                out.push((place(q), format!("{label} {rate}")));
                if !depths.is_empty() {
                    out.push((OTHERS, format!("{label} {depths}")));
                }
            }
            _ => out.push((place(q), entry)),
        }
    }
    out.sort_by_key(|(place, _)| *place);
    out.into_iter().map(|(_, entry)| entry).collect()
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
        let of = estimate.statistic.as_ref();
        let of = of.map_or(String::new(), |of| format!(", {of}"));
        let plain = format!("{} {shown}{of}", q.label());
        let caused = format!("{plain} ({})", estimate.causes().join(", "));
        let fits = causes && caused.chars().count() <= COLUMNS - MARGIN;
        return Some(if fits { caused } else { plain });
    }
    let of = q.estimate.as_ref().and_then(|e| e.statistic.as_ref());
    let of = of.map_or(String::new(), |of| format!(", {of}"));
    match &q.wording {
        Wording::Sentence(label, text) => Some(format!("{label} {text}")),
        _ => {
            let value = match &q.value {
                Value::Number(n) if n.is_f64() => quantity(n.as_f64()?, unit),
                Value::Number(n) => n.to_string(),
                Value::String(text) => text.clone(),
                _ => return None,
            };
            Some(format!("{} {value}{of}", q.label()))
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
        let of = short_cause(&of);
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
