//! Default quantity for the colours of grains: their speed, or the damage of their bonds if there
//! are bonds.

use crate::{ColourScale, Paint};
use fretwork_core::contact::{BondState, ShapeIndex};
use fretwork_core::fields::Field;
use fretwork_core::geometry::space::{Space, VectorLike};
use fretwork_core::step::Simulation;
use fretwork_observe::chart::round_top;
use fretwork_observe::placement::is_first;

/// Fraction of the grains whose speed is within the colour bar, so that a few fast grains do not
/// make all others pale.
const WITHIN: f64 = 0.98;

/// Colours of the balls and then of the convex parts, and their scale; `None` if nothing moves. In
/// 2D bonds are drawn one by one, and the scale is theirs.
pub(crate) fn of<S: Space>(s: &Simulation<S>) -> (Vec<Paint>, Option<ColourScale>) {
    let values = match (s.state.network.bonds_made() > 0, S::D) {
        (true, 2) => return (Vec::new(), Some(damage_scale(true))),
        (true, _) => damage(s),
        (false, _) => {
            let speed = |b: usize| s.state.bodies.velocity[b].norm();
            (0..s.state.bodies.len()).map(speed).collect()
        }
    };
    let balls = s.shapes.balls.iter().map(|b| b.body);
    let of: Vec<u32> = balls
        .chain(s.shapes.pieces.iter().map(|p| p.body))
        .collect();
    let grain: Vec<bool> = of
        .iter()
        .map(|b| !is_first(s, *b) && !s.state.bodies.removed[*b as usize])
        .collect();
    let scale = if s.state.network.bonds_made() > 0 {
        damage_scale(false)
    } else {
        let shown = of.iter().zip(&grain).filter(|(_, grain)| **grain);
        let mut shown: Vec<f64> = shown.map(|(b, _)| values[*b as usize]).collect();
        shown.retain(|v| v.is_finite());
        shown.sort_by(f64::total_cmp);
        let place = (WITHIN * shown.len().saturating_sub(1) as f64).ceil() as usize;
        let high = shown.get(place).copied().unwrap_or(0.0);
        if high <= 0.0 {
            return (Vec::new(), None);
        }
        ColourScale {
            label: "speed |v|".to_owned(),
            unit: unit(s.fields.grains.get("velocity_x")),
            top: round_top(high),
            bonds: false,
        }
    };
    let paint = |(b, grain): (&u32, &bool)| match grain {
        true => Paint::Value(values[*b as usize] / scale.top),
        false => Paint::Grey,
    };
    (of.iter().zip(&grain).map(paint).collect(), Some(scale))
}

/// The unit of a field as its registry has it.
fn unit<S: Space, T>(field: Option<&Field<S, T>>) -> String {
    field.map_or_else(String::new, |f| f.unit.to_owned())
}

fn damage_scale(bonds: bool) -> ColourScale {
    let label = if bonds {
        "damage D of intact bonds"
    } else {
        "mean damage D of the bonds of a grain"
    };
    ColourScale {
        label: label.to_owned(),
        unit: String::new(),
        top: 1.0,
        bonds,
    }
}

/// Mean damage of the bonds of each body, broken ones counting 1; NaN if it never had a bond.
fn damage<S: Space>(s: &Simulation<S>) -> Vec<f64> {
    let mut sums = vec![(0.0, 0.0); s.state.bodies.len()];
    let mut add = |body: u32, damage: f64| {
        let (sum, count) = &mut sums[body as usize];
        (*sum, *count) = (*sum + damage, *count + 1.0);
    };
    let field = s.fields.contacts.get("damage");
    for contact in &s.state.network.contacts {
        let intact = matches!(
            s.state.network.bond_state(contact),
            BondState::Intact { .. }
        );
        if let Some(field) = field.filter(|_| intact) {
            let damage = field.get(s, contact);
            contact.bodies.iter().for_each(|b| add(*b, damage));
        }
    }
    for &(candidate, antagonist) in &s.state.network.broken_pairs {
        for key in [candidate, antagonist] {
            if let Some(body) = ShapeIndex::of(key).body(&s.shapes) {
                add(body, 1.0);
            }
        }
    }
    sums.into_iter().map(|(sum, n)| sum / n).collect()
}
