//! Results of a run with their uncertainty, and what they mean.

use crate::html::folder::RunFolder;
use serde_json::Value;

/// A result.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct ResultRow {
    /// What it is.
    pub label: String,
    /// Its value, with unit.
    pub value: String,
    /// Half-widths of its 95 % interval by cause; empty where not estimated.
    pub interval: String,
    /// How it is defined, in a sentence.
    pub meaning: String,
}

/// A group of results with its heading.
pub(crate) type Group = (&'static str, Vec<ResultRow>);

/// A number with its unit, a prefix that suits it, and four digits.
pub(crate) fn quantity(value: f64, unit: &str) -> String {
    let text = fretwork_observe::quantity::quantity(value, unit);
    let (number, unit) = text.split_once(' ').unwrap_or((&text, ""));
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

/// The main results, by group; empty groups are left out.
pub(crate) fn groups(run: &RunFolder) -> Vec<Group> {
    let s = &run.summary;
    let plane = run.dimension() == 2;
    let unit = |solid: &'static str, flat: &'static str| if plane { flat } else { solid };
    let groups = [
        ("Friction", friction(s)),
        ("Damage", damage(s)),
        ("Wear", wear(s, unit)),
        ("Energy", energy(s, unit("J", "J/m"))),
        ("Measures", measures(s)),
    ];
    groups.into_iter().filter(|g| !g.1.is_empty()).collect()
}

/// Half-widths of an estimate, ` ± 0.008 (scatter)`.
fn interval(estimate: &Value, shown: impl Fn(f64) -> String) -> String {
    let size = estimate["value"].as_f64().unwrap_or(0.0).abs();
    let mut known = Vec::new();
    let mut unknown = Vec::new();
    for (key, name) in [
        ("scatter", "scatter"),
        ("step", "time step"),
        ("tolerance", "tolerance"),
        ("coupling", "coupling"),
    ] {
        match estimate[key].as_f64() {
            Some(half) if half < size || key == "scatter" => {
                known.push(format!("± {} ({name})", shown(half)))
            }
            Some(_) => unknown.push(name),
            None => {}
        }
    }
    let mut text = known.join(" ");
    if !unknown.is_empty() {
        text += &format!(
            "{}effect of {} not known",
            if text.is_empty() { "" } else { "; " },
            unknown.join(" and ")
        );
    }
    if let Some(method) = estimate["method"].as_str().filter(|m| !m.is_empty()) {
        text += &format!("{}{method}", if text.is_empty() { "" } else { "; " });
    }
    text
}

fn row(label: &str, value: Option<String>, interval: String, meaning: &str) -> Option<ResultRow> {
    Some(ResultRow {
        label: label.to_owned(),
        value: value?,
        interval,
        meaning: meaning.to_owned(),
    })
}

fn friction(s: &Value) -> Vec<ResultRow> {
    let own = |key: &str| s[key].as_f64().map(number);
    let estimate = &s["uncertainty"]["friction_coefficient"];
    let mean = estimate["value"]
        .as_f64()
        .map(number)
        .or_else(|| own("friction_coefficient"));
    // Without an interval both are the same number.
    let last = own("friction_coefficient").filter(|last| Some(last) != mean.as_ref());
    let regime = s["fretting"]["regime"].as_str().map(str::to_owned);
    [
        row(
            "friction coefficient",
            mean,
            interval(estimate, |h| fretwork_observe::quantity::number(h, 2)),
            "from forces: tangential force along the path over normal force along the path; the mean over the steady cycles (or blocks of time) where an interval stands beside it",
        ),
        row(
            "friction coefficient, last",
            last,
            String::new(),
            "the same over the last complete cycle, or over the second half of the time without cycles",
        ),
        row(
            "from dissipation",
            own("friction_from_dissipation"),
            String::new(),
            "energy dissipated and stored by the energy ledger over the same path: an independent check of the forces",
        ),
        row("peak Q/P", own("peak_friction"), String::new(), "largest tangential force over the mean normal force of the same cycle"),
        row(
            "plateau Q/P",
            own("plateau_friction"),
            String::new(),
            "over the second half of each stroke: friction without the elastic travel after a reversal",
        ),
        row("sliding regime", regime, String::new(), "partial or gross slip, by the energy of the loops over 4 Q delta"),
    ]
    .into_iter()
    .flatten()
    .collect()
}

fn damage(s: &Value) -> Vec<ResultRow> {
    let Some(bonds) = s["bonds"].as_u64().filter(|b| *b > 0) else {
        return Vec::new();
    };
    let broken = s["broken"].as_u64().unwrap_or(0);
    let share = s["fracture"]["released_over_declared"].as_f64();
    [
        row(
            "damage ratio",
            s["damage_ratio"].as_f64().map(number),
            interval(&s["uncertainty"]["damage_ratio"], |h| fretwork_observe::quantity::number(h, 2)),
            &format!("broken bonds over bonds made: {broken} of {bonds}"),
        ),
        row("mean damage", s["mean_damage"].as_f64().map(number), String::new(), "mean damage D over all bonds made, broken ones counting 1"),
        row(
            "energy released",
            share.map(|x| format!("{} %", number(100.0 * x))),
            String::new(),
            "energy that broken bonds released over the fracture energy of their laws: 100 % where the step resolves breaking",
        ),
    ]
    .into_iter()
    .flatten()
    .collect()
}

fn wear(s: &Value, unit: impl Fn(&'static str, &'static str) -> &'static str) -> Vec<ResultRow> {
    let volume = unit("m3", "m3/m");
    let wear = &s["wear"];
    let positive = |v: &Value| v.as_f64().filter(|x| *x != 0.0);
    let mut out = Vec::new();
    out.extend(row(
        "worn off first bodies",
        positive(&wear["volume_first_bodies"]).map(|v| quantity(v, volume)),
        interval(&s["uncertainty"]["wear"], |h| quantity(h, volume)),
        "volume that the wear laws removed from both surfaces",
    ));
    for body in wear["bodies"].as_array().into_iter().flatten() {
        let name = body["body"]
            .as_str()
            .or(body["name"].as_str())
            .unwrap_or("a body");
        let Some(v) = positive(&body["volume"]) else {
            continue;
        };
        let rate = ["specific_rate", "rate", "specific_wear_rate", "k"]
            .iter()
            .find_map(|k| body[*k].as_f64());
        let rate = rate.map(fretwork_observe::quantity::wear_rate);
        let meaning = match rate {
            Some(rate) => format!("volume; specific wear rate k = V/(P s) = {rate}"),
            None => "volume".to_owned(),
        };
        out.extend(row(
            &format!("worn off {name}"),
            Some(quantity(v, volume)),
            String::new(),
            &meaning,
        ));
    }
    out.extend(row(
        "worn between grains",
        positive(&wear["volume_third_body"]).map(|v| quantity(v, volume)),
        String::new(),
        "volume that the wear laws removed within the third body",
    ));
    let flow = wear["unit"].as_str().unwrap_or_default();
    for (key, label, meaning) in [
        (
            "Qs",
            "source flow Qs",
            "mass that comes loose from the first bodies, per time",
        ),
        (
            "Qi",
            "internal flow Qi",
            "mass of third body that crosses a section of the contact, per time",
        ),
        (
            "Qe",
            "ejected flow Qe",
            "mass that leaves the contact, per time",
        ),
        (
            "Qw",
            "wear flow Qw",
            "mass that is lost: ejected and not recirculated, per time",
        ),
    ] {
        out.extend(row(
            label,
            positive(&wear[key]).map(|v| quantity(v, flow)),
            String::new(),
            meaning,
        ));
    }
    out
}

fn energy(s: &Value, unit: &str) -> Vec<ResultRow> {
    let energy = &s["energy"];
    let scale = energy["scale"].as_f64().unwrap_or(0.0);
    let mut out = Vec::new();
    for (key, label, meaning) in [
        (
            "friction",
            "friction",
            "dissipated by friction since the start",
        ),
        ("fracture", "fracture", "released by damage of bonds"),
        ("impact", "impact", "dissipated by impacts"),
        (
            "viscous",
            "damping",
            "dissipated by damping of bonds, contacts and deformable bodies",
        ),
        (
            "adhesion",
            "adhesion",
            "work against attractive forces without opening",
        ),
        (
            "elastic",
            "elastic",
            "stored at the end in bonds, contacts and deformable bodies",
        ),
        ("kinetic", "kinetic", "kinetic energy at the end"),
        (
            "external_work",
            "external work",
            "work of imposed forces and motions",
        ),
    ] {
        let value = energy[key].as_f64().filter(|e| e.abs() > 1e-3 * scale);
        let half = match key {
            "friction" => interval(&s["uncertainty"]["friction_energy"], |h| quantity(h, unit)),
            _ => String::new(),
        };
        out.extend(row(label, value.map(|e| quantity(e, unit)), half, meaning));
    }
    let relative = s["energy_residual_relative"].as_f64();
    out.extend(row(
        "residual of the ledger",
        relative.map(|x| format!("{x:.1e}")),
        String::new(),
        "energy that no entry explains, over the largest energy seen: round-off where the bookkeeping is right",
    ));
    out
}

fn measures(s: &Value) -> Vec<ResultRow> {
    let units = &s["measure_units"];
    let numbers = s["measures"]
        .as_object()
        .into_iter()
        .flatten()
        .filter_map(|(name, value)| {
            let unit = units[name].as_str().unwrap_or_default();
            row(
                name,
                value.as_f64().map(|v| quantity(v, unit)),
                String::new(),
                "",
            )
        });
    let findings = s["findings"].as_object().into_iter().flatten();
    let findings = findings
        .filter_map(|(name, text)| row(name, text.as_str().map(str::to_owned), String::new(), ""));
    findings.chain(numbers).collect()
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
        let estimate =
            json!({"value": 0.5, "scatter": 0.1, "step": 0.6, "tolerance": 0.02, "method": null});
        assert_eq!(
            interval(&estimate, |h| h.to_string()),
            "± 0.1 (scatter) ± 0.02 (tolerance); effect of time step not known"
        );
        assert_eq!(interval(&Value::Null, |h| h.to_string()), "");
    }
}
