//! Default quantity for the colours of grains: their speed, or the damage of their bonds if there
//! are bonds.

use super::is_first;
use crate::{ColourScale, Paint};
use fretwork_core::contact::BondState;
use fretwork_core::view::{GrainFields, RunView};
use fretwork_observe::chart::round_top;
use nalgebra::Vector3;

/// Fraction of the grains whose speed is within the colour bar, so that a few fast grains do not
/// make all others pale.
const WITHIN: f64 = 0.98;

/// Returns the colours of the balls and then of the convex parts, and their scale; `None` if
/// nothing moves. In 2D bonds are drawn individually, and the scale is that of the bonds.
pub(crate) fn of(run: &dyn RunView) -> (Vec<Paint>, Option<ColourScale>) {
    let values = match (run.bonds_made() > 0, run.dimension()) {
        (true, 2) => return (Vec::new(), Some(damage_scale(true))),
        (true, _) => damage(run),
        (false, _) => {
            let velocity = run.bodies().velocity;
            velocity.iter().map(|v| Vector3::from(v).norm()).collect()
        }
    };
    let balls = run.balls().into_iter().map(|b| b.body);
    let of: Vec<u32> = balls
        .chain(run.pieces().into_iter().map(|p| p.body))
        .collect();
    let bodies = run.bodies();
    let grain: Vec<bool> = of
        .iter()
        .map(|b| !is_first(&bodies, *b) && !bodies.removed[*b as usize])
        .collect();
    let scale = if run.bonds_made() > 0 {
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
            unit: unit(run, "velocity_x"),
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

/// Returns the unit of a field of grains from its registry.
fn unit(run: &dyn RunView, name: &str) -> String {
    let fields = run.grain_fields(GrainFields::default());
    let field = fields.iter().find(|f| f.name == name);
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

/// Returns the mean damage of the bonds of each body, where broken bonds count as 1; NaN if the
/// body never had a bond.
fn damage(run: &dyn RunView) -> Vec<f64> {
    let mut sums = vec![(0.0, 0.0); run.bodies().len()];
    let mut add = |body: u32, damage: f64| {
        let (sum, count) = &mut sums[body as usize];
        (*sum, *count) = (*sum + damage, *count + 1.0);
    };
    run.visit_contacts(&mut |contact| {
        if let BondState::Intact { damage } = contact.bond {
            contact.bodies.iter().for_each(|b| add(*b, damage));
        }
    });
    for body in run.broken_pairs().into_iter().flatten() {
        add(body, 1.0);
    }
    sums.into_iter().map(|(sum, n)| sum / n).collect()
}
