//! Which grains of a case expand with their temperature.

use super::Properties;
use crate::case::Case;
use crate::source::ValidationError;
use fretwork_core::geometry::space::Space;
use fretwork_core::heat::BodyNodes;
use fretwork_core::step::Simulation;

/// Largest coefficient of linear expansion (1/K): one hundred times that of a metal.
const LARGEST: f64 = 1e-3;

/// Has the rigid grains of a case expand. First bodies do not: what holds them would have to follow.
pub(super) fn install<S: Space>(
    case: &Case,
    properties: &Properties,
    material: &[u16],
    s: &mut Simulation<S>,
) -> Result<(), ValidationError> {
    let mut expands = vec![false; s.state.bodies.len()];
    let balls = s.shapes.balls.iter().map(|b| b.body);
    for body in balls.chain(s.shapes.pieces.iter().map(|p| p.body)) {
        let one = s.heat().map(|h| &h.nodes[body as usize]);
        expands[body as usize] = matches!(one, Some(BodyNodes::One(_)));
    }
    for driven in &s.state.bodies.driven {
        expands[driven.body as usize] = false;
    }
    for (body, expands) in expands.iter_mut().enumerate() {
        *expands &= s.state.bodies.carrier(body).is_none();
    }
    let mut of_materials = Vec::with_capacity(case.materials.len());
    for (k, ((name, file), properties)) in case.materials.iter().zip(properties).enumerate() {
        let used = expands
            .iter()
            .zip(material)
            .any(|(e, m)| *e && usize::from(*m) == k);
        of_materials.push(match properties.get("expansion") {
            _ if !used => 0.0,
            Some(found) => {
                let here = format!("materials.{name}");
                let found = found.in_unit("1/K").map_err(|e| e.at(here.clone()))?;
                if found.is_nan() || found.abs() > LARGEST {
                    let message = format!("`expansion` of `{file}.ron` is {found:e} per kelvin");
                    return Err(ValidationError::new(here, message)
                        .expected(format!("at most {LARGEST:e} 1/K, as 1.2e-5 of steel")));
                }
                found
            }
            None => {
                let message = format!(
                    "`heat.expansion` needs the coefficient of linear expansion of `{name}`, and the file `{file}.ron` has no property `expansion`"
                );
                return Err(ValidationError::new(format!("materials.{name}"), message)
                    .expected("`expansion` among its properties, in 1/K"));
            }
        });
    }
    let all = expands.iter().zip(material);
    let coefficients = all.map(|(expands, m)| match expands {
        true => of_materials[usize::from(*m)],
        false => 0.0,
    });
    let coefficients: Vec<f64> = coefficients.collect();
    if coefficients.iter().all(|c| *c == 0.0) {
        let message = "no body of the case expands: grains do that are rigid and of a material with an `expansion` above zero";
        return Err(ValidationError::new("heat.expansion", message));
    }
    s.set_expansion(coefficients);
    Ok(())
}
