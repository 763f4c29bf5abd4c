//! The cheapest setting for a wanted error, and the confidence in it.

use super::compare::{Comparison, OutputError, Row, share};
use super::output::{ErrorTarget, Output};
use fretwork_math::statistics::interval::{Mean, seeds_for};

/// Verdict for a wanted error.
#[derive(Clone, Debug)]
pub struct Verdict {
    /// The outputs and their wanted errors: `1 % on friction_coefficient`.
    pub wanted: String,
    /// Index of the setting in the rows; `None` if no setting is shown to meet the error.
    pub row: Option<usize>,
    /// Whether the error bound includes the reference's own error, and not only the distance from
    /// the reference.
    pub holds: bool,
    /// Text of the verdict.
    pub text: String,
}

/// Returns one verdict per output, and one for all together if there are several.
pub fn verdicts(found: &Comparison, outputs: &[Output], random: bool) -> Vec<Verdict> {
    let mut sets: Vec<Vec<usize>> = (0..outputs.len()).map(|o| vec![o]).collect();
    if outputs.len() > 1 {
        sets.push((0..outputs.len()).collect());
    }
    sets.iter()
        .map(|set| verdict(found, outputs, set, random))
        .collect()
}

fn limit(output: &Output) -> f64 {
    let (ErrorTarget::Relative(w) | ErrorTarget::Absolute(w)) = output.wanted;
    w
}

/// Formats an error of an output with its unit.
pub fn amount(x: f64, output: &Output) -> String {
    match output.wanted {
        ErrorTarget::Relative(_) => format!("{} %", share(x)),
        ErrorTarget::Absolute(_) => format!("{x:.1e} {}", output.error_unit())
            .trim_end()
            .to_owned(),
    }
}

fn verdict(found: &Comparison, outputs: &[Output], set: &[usize], random: bool) -> Verdict {
    let wanted = |o: &usize| {
        let output = &outputs[*o];
        format!("{} on {}", amount(limit(output), output), output.name())
    };
    let names: Vec<String> = set.iter().map(wanted).collect();
    let (row, holds, text) = match idle_output(found, outputs, set) {
        Some(o) => {
            let text = format!(
                "no verdict: {} is zero in all runs, so there is nothing to compare; name another output, or run the case for longer",
                outputs[o].name()
            );
            (None, false, text)
        }
        None => cheapest(found, outputs, set, random),
    };
    Verdict {
        wanted: names.join(" and "),
        row,
        holds,
        text,
    }
}

/// Describes an output that is zero in all runs: they agree because nothing happened.
fn idle_output(found: &Comparison, outputs: &[Output], set: &[usize]) -> Option<usize> {
    let zero = |v: &Mean| v.mean == 0.0 && v.scatter.is_none_or(|s| s == 0.0);
    let mut set = set.iter().copied();
    set.find(|&o| {
        outputs[o].exact.is_none()
            && !found.rows.is_empty()
            && found
                .rows
                .iter()
                .all(|r| r.failed.is_some() || r.errors[o].as_ref().is_some_and(|e| zero(&e.value)))
    })
}

/// Returns the cheapest row within the wanted errors, whether that includes the reference's own
/// error, and the text.
fn cheapest(
    found: &Comparison,
    outputs: &[Output],
    set: &[usize],
    random: bool,
) -> (Option<usize>, bool, String) {
    let all = |row: &Row, good: &dyn Fn(&OutputError, f64) -> bool| {
        let mut each = set.iter();
        // A setting whose own runs report that they are not trustworthy is not recommended.
        row.failed.is_none()
            && row.doubted == 0
            && each.all(|&o| {
                row.errors[o]
                    .as_ref()
                    .is_some_and(|e| good(e, limit(&outputs[o])))
            })
    };
    // The reference's own error must be known for outputs without a given exact value.
    let reference_known = set
        .iter()
        .all(|&o| found.own[o].as_ref().is_some_and(|x| x.at_most.is_finite()));
    // Rows are ordered from the cheapest. First come those proven with the reference's own error,
    // then those relative to the reference alone.
    let proved = reference_known
        .then(|| found.rows.iter().position(|r| all(r, &|e, w| e.bound <= w)))
        .flatten();
    let near = found.rows.iter().position(|r| {
        all(r, &|e, w| e.at_most <= w)
            && Some(&r.setting) != found.reference.map(|k| &found.rows[k].setting)
    });
    let exact = set.iter().all(|&o| outputs[o].exact.is_some());
    let describe = |k: usize| match found.reference == Some(k) && !exact {
        true => format!("only the reference itself ({})", found.rows[k].name),
        false => describe_row(&found.rows[k], outputs, set, random),
    };
    match (proved, near) {
        (Some(k), _) if exact => {
            let text = format!("{}, against the exact value", describe(k));
            (Some(k), true, text)
        }
        (Some(k), _) => {
            let text = format!(
                "{}, {} with the reference's own error",
                describe(k),
                bounds(found, outputs, set, k)
            );
            (Some(k), true, text)
        }
        (None, Some(k)) => {
            let text = format!(
                "{}. This is the distance from the reference; the REFERENCE IS NOT GOOD ENOUGH to call it the error: it may itself be off {}",
                describe(k),
                reference_errors(found, outputs, set)
            );
            (Some(k), false, text)
        }
        (None, None) => (None, false, no_setting(found, outputs, set, random)),
    }
}

/// Describes a setting with its cost and its errors.
fn describe_row(row: &Row, outputs: &[Output], set: &[usize], random: bool) -> String {
    let errors = set.iter().filter_map(|&o| {
        let (e, output) = (row.errors[o].as_ref()?, &outputs[o]);
        let name = if set.len() > 1 {
            format!("{}: ", output.name())
        } else {
            String::new()
        };
        let at_most = amount(e.at_most, output);
        Some(if e.error.may_be_zero() && random {
            format!("{name}error not distinguishable from zero, at most {at_most}")
        } else {
            let error = amount(e.error.mean, output);
            format!("{name}error {error}, at most {at_most}")
        })
    });
    let errors: Vec<String> = errors.collect();
    format!("{}: {}; {}", row.name, speed(row), errors.join("; "))
}

/// Describes the largest error of the reference itself.
fn reference_errors(found: &Comparison, outputs: &[Output], set: &[usize]) -> String {
    let errors = set.iter().filter_map(|&o| {
        let (x, output) = (found.own[o].as_ref()?, &outputs[o]);
        let name = output.name();
        Some(if x.at_most.is_finite() {
            format!("up to {} on {name}", amount(x.at_most, output))
        } else {
            format!("by an unknown amount on {name} ({})", x.why)
        })
    });
    errors.collect::<Vec<String>>().join(", ")
}

fn bounds(found: &Comparison, outputs: &[Output], set: &[usize], k: usize) -> String {
    let each = set
        .iter()
        .filter_map(|&o| Some(amount(found.rows[k].errors[o].as_ref()?.bound, &outputs[o])));
    each.collect::<Vec<_>>().join(" and ")
}

/// Formats a speed as `6.3 times faster than the reference (5.9 to 6.7)`.
pub fn speed(row: &Row) -> String {
    match &row.faster {
        Some((x, Some((low, high)))) if *low <= 1.0 && *high >= 1.0 => format!(
            "not distinguishable in cost from the reference ({} times its speed, {} to {})",
            three(*x),
            three(*low),
            three(*high)
        ),
        Some((x, Some((low, high)))) if *high < 1.0 => format!(
            "{} times slower than the reference ({} to {})",
            three(1.0 / x),
            three(1.0 / high),
            three(1.0 / low)
        ),
        Some((x, Some((low, high)))) => format!(
            "{} times faster than the reference ({} to {})",
            three(*x),
            three(*low),
            three(*high)
        ),
        Some((x, None)) if *x < 1.0 => {
            format!("{} times slower than the reference", three(1.0 / x))
        }
        Some((x, None)) => format!("{} times faster than the reference", three(*x)),
        None => "not timed against the reference".into(),
    }
}

/// Formats with two or three significant digits.
pub fn three(x: f64) -> String {
    match x {
        x if x >= 100.0 => format!("{x:.0}"),
        x if x >= 1.0 => format!("{x:.1}"),
        _ => format!("{x:.2}"),
    }
}

/// Returns the reason why no setting meets the wanted error.
fn no_setting(found: &Comparison, outputs: &[Output], set: &[usize], random: bool) -> String {
    let Some(reference) = found.reference.map(|k| &found.rows[k]) else {
        return "the reference did not run to its end; give more --budget".into();
    };
    let parts = set.iter().map(|&o| {
        let output = &outputs[o];
        let others = || {
            let good = found
                .rows
                .iter()
                .filter(|r| r.failed.is_none() && r.setting != reference.setting);
            good.filter_map(|r| Some((r, r.errors[o].as_ref()?)))
        };
        if reference.errors[o].is_none() {
            return format!(
                "{} has no value in the reference, or is zero there",
                output.name()
            );
        }
        let Some((row, e)) = others().min_by(|a, b| a.1.at_most.total_cmp(&b.1.at_most)) else {
            return "no other setting ran to its end".into();
        };
        if !e.at_most.is_finite() {
            return format!(
                "{} differs from seed to seed, and one seed gives no scatter: give --seeds 3 or more",
                output.name()
            );
        }
        let nearest = format!(
            "the nearest on {} is {}, at most {}",
            output.name(),
            row.name,
            amount(e.at_most, output)
        );
        // Whether the scatter, not the error, is too large.
        if random && e.error.half_width.is_some_and(|h| h > limit(output)) {
            let own = found.own[o].as_ref().map_or(f64::INFINITY, |x| x.at_most);
            nearest + &hidden_by_scatter(e, output, own)
        } else {
            nearest + "; give finer values"
        }
    });
    format!(
        "no setting can be shown to be within it; {}",
        parts.collect::<Vec<String>>().join("; ")
    )
}

/// Returns the sentence that the scatter hides the error, and how many seeds would show it. More
/// seeds only narrow the interval; the mean and the reference's own error remain.
fn hidden_by_scatter(e: &OutputError, output: &Output, own: f64) -> String {
    let (scatter, wanted) = (e.error.scatter.unwrap_or(0.0), limit(output));
    let own = if own.is_finite() { own } else { 0.0 };
    let room = wanted - e.error.mean.abs() - own;
    let needs = if room > 0.0 {
        seeds_for(scatter, room).map_or(String::new(), |n| {
            format!("; about {} seeds would be needed", about(n))
        })
    } else if own > 0.0 && wanted > e.error.mean.abs() {
        "; no number of seeds would suffice: the mean with the reference's own error is already outside"
            .into()
    } else {
        "; no number of seeds would suffice: the mean is already outside".into()
    };
    format!(
        ": the scatter among its {} seeds ({} of a difference) hides errors below it{needs}",
        e.error.count,
        amount(scatter, output)
    )
}

fn about(n: usize) -> usize {
    match n {
        0..=20 => n,
        _ => {
            let size = 10usize.pow((n as f64).log10() as u32);
            n.div_ceil(size) * size
        }
    }
}
