//! Results of a run with their uncertainty and their definitions.

use crate::html::folder::RunFolder;
use fretwork_observe::quantity::{
    Catalogue, Compared, Difference, Entry, Estimate, Role, Topic, half_width, with_half_width,
};
use fretwork_observe::summary::{SeedScatter, SlidingTest};
use serde_json::Value;

/// A result.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct ResultRow {
    /// Path in the summary.
    pub path: String,
    /// Name of the result.
    pub label: String,
    /// Value with unit.
    pub value: String,
    /// Value with its half-width of all causes, and their names.
    pub short: String,
    /// Half-widths of the 95 % interval by cause; empty if not estimated.
    pub interval: String,
    /// Definition in one sentence.
    pub meaning: String,
    /// Prominence.
    pub role: Role,
    /// The number, to be compared with that of another run, and its unit.
    pub number: Option<(Compared, String)>,
}

impl ResultRow {
    /// Returns the difference from a base with its significance; `None` where one of the two has no
    /// number. Numbers of different units have none.
    pub fn less(&self, base: &Self) -> Option<String> {
        let ((own, unit), (base, same)) = (self.number.as_ref()?, base.number.as_ref()?);
        Some(match unit == same {
            true => shown(&Difference::new(own, base).text(unit)),
            false => shown(&format!("not comparable: {unit}, and {same}")),
        })
    }
}

/// Returns a text of numbers and units as a page shows it.
fn shown(text: &str) -> String {
    let text = text.replace("+-", "±");
    text.replace("m3", "m³").replace("m2", "m²")
}

/// Heading and rows of a group of results.
pub(crate) type ResultGroup = (&'static str, Vec<ResultRow>);

/// Formats a number with four digits, a suitable prefix and its unit.
pub(crate) fn quantity(value: f64, unit: &str) -> String {
    typeset(&fretwork_observe::quantity::quantity(value, unit))
}

/// Returns a number with its unit as a page shows it.
fn typeset(text: &str) -> String {
    let (number, unit) = text.split_once(' ').unwrap_or((text, ""));
    let micro = unit
        .strip_prefix('u')
        .filter(|rest| rest.starts_with(['m', 'N', 's', 'J', 'g', 'P', 'W']));
    let unit = micro.map_or_else(|| unit.to_owned(), |rest| format!("µ{rest}"));
    let unit = unit.replace("m3", "m³").replace("m2", "m²");
    format!("{number} {unit}").trim_end().to_owned()
}

/// A number with four digits.
pub(crate) fn number(value: f64) -> String {
    if value.is_finite() && value == value.trunc() && value.abs() < 1e7 {
        return format!("{value}");
    }
    let text = fretwork_observe::quantity::number(value, 4);
    match text.split_once('e') {
        Some((digits, power)) => format!("{}e{power}", trimmed(digits)),
        None => trimmed(&text).to_owned(),
    }
}

fn trimmed(digits: &str) -> &str {
    if digits.contains('.') {
        digits.trim_end_matches('0').trim_end_matches('.')
    } else {
        digits
    }
}

/// Returns the main results of a run by topic, in the order in which the run lists them.
pub(crate) fn groups(run: &RunFolder) -> Vec<ResultGroup> {
    let catalogue = Catalogue::of(&run.summary);
    let trusted = run.summary["trustworthy"] == true;
    let random = run.summary["sample"]["random"] == true;
    let seeds = run.summary["sample"]["sliding"].clone();
    let seeds: Option<SeedScatter> = serde_json::from_value(seeds).ok().flatten();
    let mut groups: Vec<(Topic, Vec<ResultRow>)> = Vec::new();
    for (entry, value) in catalogue.shown(&run.summary, Role::Secondary) {
        let mut row = row(entry, value);
        if let Some((number, _)) = &mut row.number {
            (number.trusted, number.random) = (trusted, random);
            if let Some(study) = seeds
                .as_ref()
                .filter(|_| entry.path == SlidingTest::COEFFICIENT)
            {
                let half = study.half_width() * number.value.abs();
                number.half_widths.push(("seeds".to_owned(), half));
                number.random = false;
            }
        }
        match groups.iter_mut().find(|g| g.0 == entry.topic) {
            Some(group) => group.1.push(row),
            None => groups.push((entry.topic, vec![row])),
        }
    }
    // The topic of the run itself is shown with its provenance.
    groups.retain(|g| g.0 != Topic::Run);
    groups.sort_by_key(|g| g.0);
    groups
        .into_iter()
        .map(|(topic, rows)| (topic.title(), rows))
        .collect()
}

fn row(entry: &Entry, value: &Value) -> ResultRow {
    let unit = entry.unit.as_deref().unwrap_or_default();
    let shown = |x: f64| match unit {
        "1" | "" => number(x),
        unit => quantity(x, unit),
    };
    let own = value.as_f64();
    let estimate = entry.estimate.as_ref();
    let mean = estimate.and_then(|e| e.value).or(own);
    let half = |h: f64| typeset(&half_width(h, mean.unwrap_or(0.0), unit));
    let text = value.as_str().map(str::to_owned);
    let shown_value = mean.map(shown).or(text);
    // If an estimate is that of a mean, the value itself is shown beside it.
    let itself = own
        .filter(|own| Some(*own) != mean)
        .map_or(String::new(), |own| {
            format!("; `{}` is {}", entry.path, shown(own))
        });
    let open = estimate.and_then(Estimate::is_determined) == Some(false);
    let shown_value = shown_value.unwrap_or_else(|| value.to_string());
    let marked = |text: String| match open {
        true => format!("not determined: {text}"),
        false => text,
    };
    let all = estimate.and_then(|e| Some((e.half_width()?, e)));
    let short = all.map(|(half, estimate)| {
        let causes: Vec<String> = estimate.shares().into_iter().map(|s| s.0).collect();
        let text = with_half_width(mean.unwrap_or(0.0), half, unit);
        self::shown(&format!("{text} ({})", causes.join(", ")))
    });
    ResultRow {
        path: entry.path.clone(),
        label: entry.label.clone(),
        short: marked(short.unwrap_or_else(|| shown_value.clone())),
        value: marked(shown_value),
        role: entry.role,
        number: own.map(|own| (Compared::new(own, estimate), unit.to_owned())),
        interval: estimate.map_or(String::new(), |e| interval(e, half)),
        meaning: entry.doc.clone() + &itself,
    }
}

/// Formats the half-widths of an estimate, as ` ± 0.008 (scatter)`.
fn interval(estimate: &Estimate, shown: impl Fn(f64) -> String) -> String {
    let (settings, unknown) = estimate.known();
    let scope = estimate.scope.as_deref().unwrap_or("scatter");
    let scatter = estimate.scatter.map(|half| (scope, half));
    let spelled = |of| if of == "step" { "time step" } else { of };
    let known = scatter.into_iter().chain(settings);
    let known: Vec<String> = known
        .map(|(of, half)| format!("± {} ({})", shown(half), spelled(of)))
        .collect();
    let mut parts = vec![known.join(" ")];
    if !unknown.is_empty() {
        let unknown: Vec<&str> = unknown.into_iter().map(spelled).collect();
        parts.push(format!("effect of {} not known", unknown.join(" and ")));
    }
    parts.extend(estimate.method.clone());
    parts.retain(|part| !part.is_empty());
    parts.join("; ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn numbers_have_no_digits_that_say_nothing() {
        for (value, text) in [
            (0.3, "0.3"),
            (7000.0, "7000"),
            (1.2e16, "1.2e16"),
            (0.32591234, "0.3259"),
            (0.0, "0"),
        ] {
            assert_eq!(number(value), text);
        }
    }

    #[test]
    fn half_widths_as_large_as_the_value_are_not_numbers() {
        let estimate = Estimate {
            value: Some(0.5),
            scatter: Some(0.1),
            step: Some(0.6),
            tolerance: Some(0.02),
            ..Estimate::default()
        };
        assert_eq!(
            interval(&estimate, |h| h.to_string()),
            "± 0.1 (scatter) ± 0.02 (tolerance); effect of time step not known"
        );
        assert_eq!(interval(&Estimate::default(), |h| h.to_string()), "");
    }

    /// A row is made of what the run records about a quantity, whatever its name is.
    #[test]
    fn a_row_has_value_unit_interval_and_meaning() {
        let entry = Entry {
            path: "spin.largest".to_owned(),
            unit: Some("N".to_owned()),
            doc: "how it pulls".to_owned(),
            role: Role::Headline,
            topic: Topic::Measures,
            label: "pull".to_owned(),
            estimate: Some(Estimate {
                value: Some(2.5),
                scatter: Some(0.25),
                scope: Some("within this sample (3 cycles)".to_owned()),
                ..Estimate::default()
            }),
        };
        let row = row(&entry, &json!(2.0));
        assert_eq!(
            (row.label.as_str(), row.value.as_str()),
            ("pull", "2.500 N")
        );
        assert_eq!(row.interval, "± 250.0 mN (within this sample (3 cycles))");
        assert_eq!(row.meaning, "how it pulls; `spin.largest` is 2.000 N");
        let base = ResultRow {
            number: Some((Compared::new(2.0, entry.estimate.as_ref()), "N".to_owned())),
            ..row.clone()
        };
        assert_eq!(row.less(&base).as_deref(), Some("equal"));
    }

    #[test]
    fn a_result_with_a_large_half_width_is_not_determined() {
        let entry = Entry {
            path: "damage".to_owned(),
            unit: Some("1".to_owned()),
            doc: String::new(),
            role: Role::Headline,
            topic: Topic::Damage,
            label: "damage".to_owned(),
            estimate: Some(Estimate {
                value: Some(0.31),
                step: Some(0.12),
                ..Estimate::default()
            }),
        };
        let open = row(&entry, &json!(0.31));
        assert_eq!(open.value, "not determined: 0.31");
        assert_eq!(open.less(&open.clone()).as_deref(), Some("equal"));
        let other = row(
            &Entry {
                estimate: None,
                ..entry
            },
            &json!(0.5),
        );
        assert_eq!(other.less(&open).as_deref(), Some("not determined"));
    }
}
