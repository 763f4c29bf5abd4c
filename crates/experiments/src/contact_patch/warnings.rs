//! Limits of Hertz' theory, and open points of an answer.

use super::{Answer, Contact, Question, Strength, Wear, Yield, YieldKind};
use fretwork_elastic::patch::{UNLIKE, dundurs};
use fretwork_observe::quantity::{number, quantity};

/// Ratio of the largest semi-axis to a radius above which the parabola of Hertz' theory has an
/// error of more than about one per cent.
const FLAT: f64 = 0.1;

pub(super) fn of(question: &Question, contact: &Contact, answer: &Answer) -> Vec<String> {
    let mut out = without_unit(question);
    let patch = &answer.patch;
    let axes = [Some(patch.semi_axis), patch.semi_axis_across];
    for body in &contact.bodies {
        for (axis, curvature) in axes.iter().zip(body.curvature) {
            if let Some(a) = axis.filter(|a| a * curvature.abs() > FLAT) {
                let warning = format!(
                    "NOT HERTZ: the patch, {a:.3e} m, is {:.2} of a radius of {}; the theory takes it as small, and the bodies as half-spaces",
                    a * curvature.abs(),
                    body.name
                );
                // For a sphere both directions are the same.
                if !out.contains(&warning) {
                    out.push(warning);
                }
            }
        }
    }
    match &answer.strength {
        None => out.push("NO STRENGTH: neither material has a hardness or a yield stress; whether the bodies stay elastic is not known; give hardness or yield".into()),
        Some(s) => out.extend(of_pressure(patch.pressure, s)),
    }
    let beta = dundurs(&contact.solids());
    if beta.abs() > UNLIKE && answer.friction.is_some() {
        out.push(format!(
            "UNLIKE MATERIALS: Dundurs' constant is {beta:.2}; pressure alone makes the surfaces slip, which where slip begins and the creep curve leave out"
        ));
    }
    if question.speed.is_some() && question.creepage.is_none() {
        out.push("SPEED NOT USED: slip per second is speed times creepage; give creepage".into());
    }
    if let Some(f) = &answer.friction {
        out.extend(f.notes.iter().cloned());
        if f.runs == 1 {
            out.push("ONE RUN: its interval is over its own cycles; runs with other seeds give the scatter of samples".into());
        }
        if f.runs > 0 && f.numerical.is_none() {
            out.push("NUMERICAL ERROR NOT KNOWN: a run did not estimate the error of its steps; the interval has the scatter alone".into());
        }
    }
    out.extend(
        answer
            .wear
            .iter()
            .flat_map(|wear| of_wear(question, contact, wear)),
    );
    if answer.wear.is_some() && question.wear.is_some() {
        let without = contact.bodies.iter().filter(|b| b.hardness.is_none());
        for body in without {
            out.push(format!(
                "NO HARDNESS: {} has none, and no wear by Archard's law",
                body.name
            ));
        }
    }
    out
}

/// Radius (m) from which a number without a unit is likely to be in millimetres.
const LARGE: f64 = 10.0;

/// Returns radii without a unit that are large for metres.
fn without_unit(question: &Question) -> Vec<String> {
    let radii = question.radius.iter().chain(&question.across);
    let bare = radii.filter_map(|text| Some((text.trim(), text.trim().parse::<f64>().ok()?)));
    let large = bare.filter(|(_, x)| x.is_finite() && x.abs() >= LARGE);
    let note = |(text, _): (&str, f64)| {
        format!(
            "RADIUS IN METRES: `{text}` without a unit is {text} m; if it is in millimetres write {text}mm"
        )
    };
    large.map(note).collect()
}

/// Returns what a pressure does to the steel, if it does not stay elastic.
fn of_pressure(pressure: f64, s: &Strength) -> Option<String> {
    let pascal = |p: f64| quantity(p, "Pa");
    let p = pascal(pressure);
    let with = |of: &Yield| format!("with {} as {}", pascal(of.yield_stress), of.name());
    if let Some(hardness) = s.hardness.filter(|h| pressure > *h) {
        return Some(format!(
            "NOT ELASTIC: {p} is above the hardness, {}; the softer body is indented, and the pressure is about its hardness",
            pascal(hardness)
        ));
    }
    if pressure > s.shakedown {
        let traction = s.traction.filter(|_| s.shakedown < s.shakedown_rolling);
        let at = match traction {
            Some(t) if t.asked => format!(" at Q/P {}", number(t.ratio, 3)),
            Some(_) => format!(
                " in full slip ({} in free rolling; give creepage or force for that at your Q/P)",
                pascal(s.shakedown_rolling)
            ),
            None => String::new(),
        };
        let hardens = match s.in_service.kind {
            YieldKind::Hardened => ", although it has hardened",
            YieldKind::Monotonic => {
                "; that is of steel not yet deformed, and hardening in service raises the limit (its file has no yield_stress_hardened)"
            }
            YieldKind::Flow => ", and it yields below that",
            YieldKind::Given => "",
        };
        return Some(format!(
            "BEYOND SHAKEDOWN: {p} is above {}{at}; {} the surface deforms plastically in every passage{hardens}",
            pascal(s.shakedown),
            with(&s.in_service)
        ));
    }
    (pressure > s.first_yield).then(|| format!(
        "YIELDS AT FIRST: {p} is above {}; {} it flows until residual stresses and hardening make it elastic, over a slightly larger patch",
        pascal(s.first_yield),
        with(&s.first)
    ))
}

/// Returns where wear is not mild, or its map is that of other steels.
fn of_wear(question: &Question, contact: &Contact, wear: &Wear) -> Vec<String> {
    let mut out = Vec::new();
    if let Some(regime) = wear.regime.as_ref().filter(|r| r.is_severe()) {
        let [low, high] = regime.coefficient;
        let asked = question.wear.as_ref().map(|k| format!(", not {k}"));
        out.push(format!(
            "SEVERE WEAR: Jendel's chart of wheel and rail steels (Wear 253 (2002) 89-99) has {} at this slip speed and pressure: K is {low:e} to {high:e}{}",
            regime.words(),
            asked.unwrap_or_default()
        ));
    }
    if question.wear.is_some() && wear.regime.is_none() && !wear.archard.is_empty() {
        out.push(
            "WEAR REGIME NOT KNOWN: K of mild wear holds below 0.2 m/s of slip; give speed".into(),
        );
    }
    if let Some(map) = wear
        .energy_map
        .as_ref()
        .filter(|m| m.same_rail != Some(true))
    {
        out.push(format!(
            "MAP OF ANOTHER PAIR: T gamma/A was measured on {}, and {} has not its hardness, 260 to 300 HBW; the program has no map of other grades (measured: P. Christoforou, D. Fletcher, R. Lewis, Wear 436-437 (2019) 202990; J. F. Santa et al., Wear 432-433 (2019) 102916)",
            map.measured_on,
            super::wear::rail(contact).name
        ));
    }
    out
}
