//! Thermal expansion of the bodies of a case.

use super::Properties;
use crate::case::{Case, HeatSpec};
use crate::source::ValidationError;
use fretwork_core::heat::{BodyNodes, ExpandingSystem, Node, Store};
use fretwork_core::view::{RunSetup, RunView};
use std::collections::BTreeMap;

/// Largest coefficient of linear expansion (1/K): one hundred times that of a metal.
const LARGEST: f64 = 1e-3;

/// Coefficients of linear expansion of the materials of a case.
struct Coefficients<'a> {
    case: &'a Case,
    properties: &'a Properties,
    /// Coefficients found so far, by index of the material.
    found: BTreeMap<usize, f64>,
}

impl Coefficients<'_> {
    /// Returns whether the file of a material has a coefficient.
    fn are_known(&self, material: usize) -> bool {
        self.properties[material].contains_key("expansion")
    }

    /// Returns the coefficient of a material (1/K).
    fn of(&mut self, material: usize) -> Result<f64, ValidationError> {
        if let Some(found) = self.found.get(&material) {
            return Ok(*found);
        }
        let mut materials = self.case.materials.iter();
        let Some((name, file)) = materials.nth(material) else {
            return Ok(0.0);
        };
        let here = format!("materials.{name}");
        let Some(given) = self.properties[material].get("expansion") else {
            let message = format!(
                "`heat.expansion` needs the coefficient of linear expansion of `{name}`, and the file `{file}.ron` has no property `expansion`"
            );
            return Err(ValidationError::new(here, message)
                .expected("`expansion` among its properties, in 1/K"));
        };
        let found = given.in_unit("1/K").map_err(|e| e.at(here.clone()))?;
        if found.is_nan() || found.abs() > LARGEST {
            let message = format!("`expansion` of `{file}.ron` is {found:e} per kelvin");
            return Err(ValidationError::new(here, message)
                .expected(format!("at most {LARGEST:e} 1/K, as 1.2e-5 of steel")));
        }
        self.found.insert(material, found);
        Ok(found)
    }
}

/// Lets bodies of a case expand with temperature: rigid bodies of balls, polygons and polyhedra
/// with a single, variable temperature, and bodies of finite elements.
pub(super) fn install(
    case: &Case,
    spec: &HeatSpec,
    properties: &Properties,
    material: &[u16],
    s: &mut dyn RunSetup,
) -> Result<(), ValidationError> {
    let mut coefficients = Coefficients {
        case,
        properties,
        found: BTreeMap::new(),
    };
    let rigid = rigid(&mut coefficients, material, s)?;
    let systems = systems(&mut coefficients, spec, material, s)?;
    let none = systems.iter().all(|s| s.coefficient == 0.0);
    if none && rigid.iter().all(|c| *c == 0.0) {
        let message = "no body of the case expands; bodies that do are rigid grains, first bodies of balls, polygons or polyhedra with the store `Lumped`, and bodies of `elastic`, of a material with an `expansion` other than zero";
        return Err(ValidationError::new("heat.expansion", message));
    }
    s.add_expansion(rigid, systems);
    Ok(())
}

/// Returns the coefficient of each rigid body (1/K), 0 for those that do not expand.
fn rigid(
    coefficients: &mut Coefficients<'_>,
    material: &[u16],
    s: &dyn RunView,
) -> Result<Vec<f64>, ValidationError> {
    let bodies = s.bodies();
    let mut expands = vec![false; bodies.len()];
    let balls = s.balls().into_iter().map(|b| b.body);
    for body in balls.chain(s.pieces().into_iter().map(|p| p.body)) {
        expands[body as usize] = bodies.carrier(body as usize).is_none();
    }
    // A surface has no size of its own.
    for surface in s.surfaces() {
        expands[surface.body as usize] = false;
    }
    let (heat, state) = (s.heat(), s.heat_state());
    for (body, expands) in expands.iter_mut().enumerate() {
        let warms = heat.zip(state).is_some_and(|(heat, state)| {
            matches!(heat.nodes[body], BodyNodes::One(node) if state.nodes[node as usize].store != Store::Fixed)
        });
        *expands &= warms;
    }
    let each = expands.iter().zip(material);
    let found = each.map(|(expands, m)| match expands {
        true => coefficients.of(usize::from(*m)),
        false => Ok(0.0),
    });
    let found: Vec<f64> = found.collect::<Result<_, _>>()?;
    let driven = bodies.driven.iter();
    match driven
        .filter(|d| found[d.body as usize] != 0.0)
        .find(|d| spans_period(s, d.body))
    {
        None => Ok(found),
        Some(driven) => {
            let message = format!(
                "`{}` reaches over more than half of the period, which would have to grow with it",
                driven.name
            );
            Err(
                ValidationError::new(format!("heat.bodies.{}.store", driven.name), message)
                    .expected(
                        "`Fixed`, `Insulated` or `HalfSpace(..)`, with which it does not expand",
                    ),
            )
        }
    }
}

/// Whether a body is longer than half of a period of the case.
fn spans_period(s: &dyn RunView, body: u32) -> bool {
    let balls = s.balls().into_iter();
    let balls = balls.map(|b| (b.body, b.offset, b.radius));
    let pieces = s.pieces().into_iter();
    let pieces = pieces.map(|p| (p.body, p.offset, p.bound));
    let own = balls.chain(pieces).filter(|(of, ..)| *of == body);
    let parts: Vec<([f64; 3], f64)> = own.map(|(_, at, radius)| (at, radius)).collect();
    (0..s.dimension()).any(|k| {
        let Some(period) = s.periodic().period[k] else {
            return false;
        };
        let high = parts
            .iter()
            .map(|(at, r)| at[k] + r)
            .fold(f64::MIN, f64::max);
        let low = parts
            .iter()
            .map(|(at, r)| at[k] - r)
            .fold(f64::MAX, f64::min);
        high - low > 0.5 * period
    })
}

/// Returns the deformable bodies that expand.
fn systems(
    coefficients: &mut Coefficients<'_>,
    spec: &HeatSpec,
    material: &[u16],
    s: &dyn RunView,
) -> Result<Vec<ExpandingSystem>, ValidationError> {
    let (Some(heat), Some(state)) = (s.heat(), s.heat_state()) else {
        return Ok(Vec::new());
    };
    let systems = (0..s.system_count()).filter_map(|k| Some((k, s.system(k)?)));
    let mut out = Vec::new();
    for (index, system) in systems {
        let name = system.name();
        let (nodes, material) = match s.bodies_of_system(index).first() {
            Some(body) if system.is_grain() => {
                let body = *body as usize;
                (heat.nodes[body].range(), usize::from(material[body]))
            }
            _ => {
                let own = heat.first_bodies.iter().find(|(n, _)| n == name);
                let material = super::systems::material_of(coefficients.case, name);
                (own.map_or(0..0, |own| own.1.clone()), material)
            }
        };
        let given = spec.bodies.get(name).and_then(|b| b.temperature);
        let reference = given.unwrap_or(heat.initial);
        let own = &state.nodes[nodes.clone()];
        let changes = |n: &Node| n.store != Store::Fixed || n.temperature != reference;
        if !system.is_grain() && !own.iter().any(changes) {
            continue;
        }
        if !system.expands() && !coefficients.are_known(material) {
            return Err(does_not_expand(name, system.is_grain()));
        }
        let coefficient = coefficients.of(material)?;
        if coefficient == 0.0 {
            continue;
        }
        if !system.expands() {
            return Err(does_not_expand(name, system.is_grain()));
        }
        out.push(ExpandingSystem {
            system: index,
            nodes,
            coefficient,
            reference,
        });
    }
    Ok(out)
}

fn does_not_expand(name: &str, grain: bool) -> ValidationError {
    match grain {
        true => ValidationError::new(
            "heat.expansion",
            "grains that deform do not expand with their temperature",
        )
        .expected("rigid grains, a material with `expansion` 0, or no `expansion` in `heat`"),
        false => ValidationError::new(
            format!("heat.bodies.{name}.store"),
            format!(
                "`{name}` is an elastic half-space, which does not expand with its temperature"
            ),
        )
        .expected("`Fixed` or `Insulated`, or a body of `elastic`"),
    }
}
