//! Limits of Hertz' theory, and open points of an answer.

use super::{Answer, Contact, Question, Wear};

/// Ratio of the largest semi-axis to a radius above which the parabola of Hertz' theory has an
/// error of more than about one per cent.
const FLAT: f64 = 0.1;

pub(super) fn of(question: &Question, contact: &Contact, answer: &Answer) -> Vec<String> {
    let mut out = Vec::new();
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
    let giga = 1e-9;
    match &answer.strength {
        None => out.push("NO STRENGTH: neither material has a hardness or a yield stress; whether the bodies stay elastic is not known (hardness, yield_stress)".into()),
        Some(s) => {
            let (of, y, p) = (s.name(), s.yield_stress * giga, patch.pressure);
            if s.hardness.is_some_and(|h| p > h) {
                out.push(format!(
                    "NOT ELASTIC: {:.3} GPa is above the hardness, {:.3} GPa; the softer body is indented, and the pressure is about its hardness",
                    p * giga,
                    s.hardness.unwrap_or_default() * giga
                ));
            } else if p > s.shakedown {
                out.push(format!(
                    "BEYOND SHAKEDOWN: {:.3} GPa is above {:.3} GPa; with {y:.3} GPa as {of} the surface deforms plastically in every passage",
                    p * giga,
                    s.shakedown * giga
                ));
            } else if p > s.first_yield {
                out.push(format!(
                    "YIELDS AT FIRST: {:.3} GPa is above {:.3} GPa; with {y:.3} GPa as {of} it flows until residual stresses and hardening make it elastic, over a slightly larger patch",
                    p * giga,
                    s.first_yield * giga
                ));
            }
        }
    }
    let [one, other] = contact.solids();
    // Dundurs' second constant describes tangential displacements under pressure, which the
    // theories here neglect.
    let soft = |s: &fretwork_elastic::patch::Solid| (1.0 - 2.0 * s.poisson) / s.shear();
    let stiff = |s: &fretwork_elastic::patch::Solid| 2.0 * (1.0 - s.poisson) / s.shear();
    let beta = (soft(&one) - soft(&other)) / (stiff(&one) + stiff(&other));
    if beta.abs() > 0.05 && answer.friction.is_some() {
        out.push(format!(
            "UNLIKE MATERIALS: Dundurs' constant is {beta:.2}; pressure alone makes the surfaces slip, which where slip begins and the creep curve leave out"
        ));
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

/// Returns where wear is not mild, or its map is that of other steels.
fn of_wear(question: &Question, contact: &Contact, wear: &Wear) -> Vec<String> {
    let mut out = Vec::new();
    if let Some(regime) = wear.regime.as_ref().filter(|r| r.is_severe()) {
        let [low, high] = regime.coefficient;
        let asked = question.wear.as_ref().map(|k| format!(", not {k}"));
        out.push(format!(
            "SEVERE WEAR: at this slip speed and pressure wear is {} in Jendel's chart of wheel and rail steels (Wear 253 (2002) 89-99): K is {low:e} to {high:e}{}",
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
            "MAP OF ANOTHER PAIR: T gamma/A was measured on {}, and {} has not its hardness, 260 to 300 HBW; the program has no map of other grades (tests: P. Christoforou, D. Fletcher, R. Lewis, Wear 436-437 (2019) 202990; J. F. Santa et al., Wear 432-433 (2019) 102916)",
            map.measured_on,
            super::wear::rail(contact).name
        ));
    }
    out
}
