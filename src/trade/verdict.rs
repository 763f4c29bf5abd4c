//! The cheapest setting for a wanted error, and the confidence in it.

use super::compare::{Comparison, Row, share};
use super::interval::{Mean, seeds_for};
use super::output::{Output, Wanted};

/// Verdict for a wanted error.
#[derive(Clone, Debug)]
pub struct Verdict {
    /// The outputs and their wanted errors: `1 % on friction_coefficient`.
    pub wanted: String,
    /// Index of the setting in the rows; `None` if no setting is shown to meet the error.
    pub row: Option<usize>,
    /// Whether the error bound includes the reference's own error, and not only the distance from the
    /// reference.
    pub holds: bool,
    /// Text of the verdict.
    pub text: String,
}

/// One verdict per output, and one for all together if there are several.
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
    let (Wanted::Relative(w) | Wanted::Absolute(w)) = output.wanted;
    w
}

/// An error of an output, with its unit.
pub fn amount(x: f64, output: &Output) -> String {
    match output.wanted {
        Wanted::Relative(_) => format!("{} %", share(x)),
        Wanted::Absolute(_) => format!("{x:.1e}"),
    }
}

fn verdict(found: &Comparison, outputs: &[Output], set: &[usize], random: bool) -> Verdict {
    let names: Vec<String> = set
        .iter()
        .map(|&o| {
            format!(
                "{} on {}",
                amount(limit(&outputs[o]), &outputs[o]),
                outputs[o].name
            )
        })
        .collect();
    // Zero in all runs: they agree because nothing happened.
    let idle = set.iter().find(|&&o| {
        outputs[o].exact.is_none()
            && !found.rows.is_empty()
            && found.rows.iter().all(|r| {
                let still = |v: &Mean| v.mean == 0.0 && v.scatter.is_none_or(|s| s == 0.0);
                r.failed.is_some() || r.errors[o].as_ref().is_some_and(|e| still(&e.value))
            })
    });
    if let Some(&o) = idle {
        return Verdict {
            wanted: names.join(" and "),
            row: None,
            holds: false,
            text: format!(
                "no verdict: {} is zero in all runs, so there is nothing to compare; name another output, or run the case for longer",
                outputs[o].name
            ),
        };
    }
    let all = |row: &Row, good: &dyn Fn(&super::compare::OutputError, f64) -> bool| {
        let mut each = set.iter();
        row.failed.is_none()
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
    // Rows are ordered from the cheapest. First those proven with the reference's own error, then those
    // relative to the reference alone.
    let proved = reference_known
        .then(|| found.rows.iter().position(|r| all(r, &|e, w| e.bound <= w)))
        .flatten();
    let near = found.rows.iter().position(|r| {
        all(r, &|e, w| e.at_most <= w)
            && Some(&r.setting) != found.reference.map(|k| &found.rows[k].setting)
    });
    let exact = set.iter().all(|&o| outputs[o].exact.is_some());
    let told = |k: usize| {
        let row = &found.rows[k];
        if found.reference == Some(k) && !exact {
            return format!("only the reference itself ({})", row.name);
        }
        let errors: Vec<String> = set
            .iter()
            .filter_map(|&o| {
                let e = row.errors[o].as_ref()?;
                let name = if set.len() > 1 {
                    format!("{}: ", outputs[o].name)
                } else {
                    String::new()
                };
                Some(if e.error.may_be_zero() && random {
                    format!(
                        "{name}error not distinguishable from zero, at most {}",
                        amount(e.at_most, &outputs[o])
                    )
                } else {
                    format!(
                        "{name}error {}, at most {}",
                        amount(e.error.mean, &outputs[o]),
                        amount(e.at_most, &outputs[o])
                    )
                })
            })
            .collect();
        format!("{}: {}; {}", row.name, speed(row), errors.join("; "))
    };
    let own: Vec<String> = set
        .iter()
        .filter_map(|&o| {
            let x = found.own[o].as_ref()?;
            Some(if x.at_most.is_finite() {
                format!(
                    "up to {} on {}",
                    amount(x.at_most, &outputs[o]),
                    outputs[o].name
                )
            } else {
                format!("by an unknown amount on {} ({})", outputs[o].name, x.why)
            })
        })
        .collect();
    let (row, holds, text) = match (proved, near) {
        (Some(k), _) if exact => (
            Some(k),
            true,
            format!("{}, against the exact value", told(k)),
        ),
        (Some(k), _) => (
            Some(k),
            true,
            format!(
                "{}, {} with the reference's own error",
                told(k),
                bounds(found, outputs, set, k)
            ),
        ),
        (None, Some(k)) => (
            Some(k),
            false,
            format!(
                "{}. This is the distance from the reference; the REFERENCE IS NOT GOOD ENOUGH to call it the error: it may itself be off {}",
                told(k),
                own.join(", ")
            ),
        ),
        (None, None) => (None, false, nothing(found, outputs, set, random)),
    };
    Verdict {
        wanted: names.join(" and "),
        row,
        holds,
        text,
    }
}

fn bounds(found: &Comparison, outputs: &[Output], set: &[usize], k: usize) -> String {
    let each = set
        .iter()
        .filter_map(|&o| Some(amount(found.rows[k].errors[o].as_ref()?.bound, &outputs[o])));
    each.collect::<Vec<_>>().join(" and ")
}

/// `6.3 times faster than the reference (5.9 to 6.7)`.
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

/// Two or three significant digits.
pub fn three(x: f64) -> String {
    match x {
        x if x >= 100.0 => format!("{x:.0}"),
        x if x >= 1.0 => format!("{x:.1}"),
        _ => format!("{x:.2}"),
    }
}

/// Reason why no setting meets the wanted error.
fn nothing(found: &Comparison, outputs: &[Output], set: &[usize], random: bool) -> String {
    let Some(reference) = found.reference.map(|k| &found.rows[k]) else {
        return "the reference did not run to its end; give more --budget".into();
    };
    let mut parts = Vec::new();
    for &o in set {
        let (output, wanted) = (&outputs[o], limit(&outputs[o]));
        let others = || {
            let good = found
                .rows
                .iter()
                .filter(|r| r.failed.is_none() && r.setting != reference.setting);
            good.filter_map(|r| Some((r, r.errors[o].as_ref()?)))
        };
        if reference.errors[o].is_none() {
            parts.push(format!(
                "{} has no value in the reference, or is zero there",
                output.name
            ));
            continue;
        }
        let Some((row, e)) = others().min_by(|a, b| a.1.at_most.total_cmp(&b.1.at_most)) else {
            parts.push("no other setting ran to its end".into());
            continue;
        };
        if !e.at_most.is_finite() {
            parts.push(format!(
                "{} differs from seed to seed, and one seed gives no scatter: give --seeds 3 or more",
                output.name
            ));
            continue;
        }
        let mut text = format!(
            "the nearest on {} is {}, at most {}",
            output.name,
            row.name,
            amount(e.at_most, output)
        );
        // Whether the scatter, not the error, is too large.
        let scatter = e.error.scatter.unwrap_or(0.0);
        if random && e.error.half_width.is_some_and(|h| h > wanted) {
            // More seeds only narrow the interval; the mean and the reference's own error remain.
            let own = found.own[o].as_ref().map_or(f64::INFINITY, |x| x.at_most);
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
            text.push_str(&format!(
                ": the scatter among its {} seeds ({} of a difference) hides errors below it{needs}",
                e.error.count,
                amount(scatter, output)
            ));
        } else {
            text.push_str("; give finer values");
        }
        parts.push(text);
    }
    format!(
        "no setting can be shown to be within it; {}",
        parts.join("; ")
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
