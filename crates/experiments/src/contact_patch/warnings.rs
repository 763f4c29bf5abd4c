//! Limits of Hertz' theory, and open points of an answer.

use super::{Answer, Contact, Question, Wear};
use crate::amounts::bare;
use crate::limits::{not_hertz, radius_in_metres};
use fretwork_elastic::patch::{UNLIKE, dundurs};

pub(super) fn of(question: &Question, contact: &Contact, answer: &Answer) -> Vec<String> {
    let mut out = without_unit(question);
    let patch = &answer.patch;
    let bodies = contact.bodies.iter();
    out.extend(not_hertz(
        bodies.map(|b| (b.strength.name.as_str(), b.curvature)),
        [Some(patch.semi_axis), patch.semi_axis_across],
    ));
    match &answer.strength {
        None => out.push("NO STRENGTH: neither material has a hardness or a yield stress; whether the bodies stay elastic is not known; give hardness or yield".into()),
        Some(s) => {
            let p = patch.pressure;
            out.extend(s.indents(p).or_else(|| s.yields(p)));
        }
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
        let without = contact
            .bodies
            .iter()
            .filter(|b| b.strength.hardness.is_none());
        for body in without {
            out.push(format!(
                "NO HARDNESS: {} has none, and no wear by Archard's law",
                body.strength.name
            ));
        }
    }
    out
}

/// Returns radii without a unit that are large for metres.
fn without_unit(question: &Question) -> Vec<String> {
    let radii = question.radius.iter().chain(&question.across);
    let notes = radii.filter_map(|text| radius_in_metres(bare(text)?, text.trim()));
    notes.collect()
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
            super::wear::rail(contact).strength.name
        ));
    }
    out
}
