//! Heat of a case: checks, and conversion for the simulation.

mod bodies;
mod check;
mod expansion;
mod systems;

pub(crate) use check::check;

use crate::case::{Case, HeatSpec};
use crate::material::Sourced;
use crate::source::ValidationError;
use bodies::Nodes;
use fretwork_core::heat::{Circuit, Heat, HeatState, ThermalMaterial};
use fretwork_core::view::{RunSetup, RunView};
use std::collections::BTreeMap;

/// Properties of the materials of a case, in its order.
pub(crate) type Properties = [BTreeMap<String, Sourced>];

/// Adds heat to a simulation if its case requests it. Densities are without inertia scaling
/// (kg/m^3).
pub(crate) fn install(
    case: &Case,
    properties: &Properties,
    densities: &[f64],
    s: &mut dyn RunSetup,
) -> Result<(), ValidationError> {
    let Some(spec) = &case.heat else {
        return check::refuse_laws_without_heat(case, s);
    };
    let materials = materials(case, spec, properties, densities)?;
    let material = material_of_bodies(s);
    refuse_materials_without_grains(case, spec, &material, s)?;
    let nodes = Nodes::of(case, spec, &materials, &material, s)?;
    let circuit = spec.circuit.as_ref().map(|c| {
        let named = |name: &str| {
            let driven = s.bodies().driven_named(name);
            driven.map_or(0, |d| d.body)
        };
        Circuit {
            from: named(&c.from),
            to: named(&c.to),
            supply: c.supply,
        }
    });
    let heat = Heat {
        pairs: Heat::pairs(&materials),
        materials,
        material: material.clone(),
        nodes: nodes.of_bodies,
        columns: nodes.columns,
        elements: nodes.elements,
        first_bodies: nodes.first_bodies,
        imposed: nodes.imposed,
        shares: spec.shares,
        partition: spec.partition,
        theta: spec.theta,
        clock: spec.clock,
        every: spec.every,
        initial: spec.initial,
        start: spec.start,
        flash: spec.flash,
        circuit,
    };
    let state = HeatState::new(nodes.list, heat.first_bodies.len());
    s.add_heat(heat, state);
    match spec.expansion {
        true => expansion::install(case, spec, properties, &material, s),
        false => Ok(()),
    }
}

/// Refuses initial temperatures of grains of materials that no grain has.
fn refuse_materials_without_grains(
    case: &Case,
    spec: &HeatSpec,
    material: &[u16],
    s: &dyn RunView,
) -> Result<(), ValidationError> {
    let known = |name: &String| {
        let index = case.materials.keys().position(|m| m == name);
        let mut grains = s.grains().into_iter();
        grains.any(|g| Some(usize::from(material[g])) == index)
    };
    match spec.grains.keys().find(|name| !known(name)) {
        None => Ok(()),
        Some(name) => {
            let message = format!(
                "no grain is of `{name}`; temperatures of first bodies stand in `heat.bodies`"
            );
            Err(ValidationError::new(format!("heat.grains.{name}"), message))
        }
    }
}

/// Returns the material of each body: that of its shapes.
fn material_of_bodies(s: &dyn RunView) -> Vec<u16> {
    let mut of = vec![0; s.bodies().len()];
    let balls = s.balls().into_iter().map(|b| (b.body, b.material));
    let pieces = s.pieces().into_iter().map(|p| (p.body, p.material));
    let surfaces = s.surfaces().into_iter().map(|f| (f.body, f.material));
    for (body, material) in balls.chain(pieces).chain(surfaces) {
        of[body as usize] = material;
    }
    of
}

/// Returns the thermal properties of the materials.
fn materials(
    case: &Case,
    spec: &HeatSpec,
    properties: &Properties,
    densities: &[f64],
) -> Result<Vec<ThermalMaterial>, ValidationError> {
    let all = case.materials.iter().zip(properties).zip(densities);
    let each = all.map(|(((name, file), properties), density)| {
        let get = |property: &str, unit: &str, what: &str| {
            let here = format!("materials.{name}");
            let Some(found) = properties.get(property) else {
                let message = format!(
                    "heat needs the {what} of `{name}`, and the file `{file}.ron` has no property `{property}`"
                );
                return Err(ValidationError::new(here, message)
                    .expected(format!("`{property}` among its properties, in {unit}")));
            };
            let value = found.in_unit(unit).map_err(|e| e.at(here.clone()))?;
            if value > 0.0 && value.is_finite() {
                return Ok(value);
            }
            let message = format!("`{property}` of `{file}.ron` must be above zero, got {value}");
            Err(ValidationError::new(here, message))
        };
        let electric = spec.circuit.is_some() && check::carries_current(case, name);
        Ok(ThermalMaterial {
            conductivity: get("conductivity", "W/(m K)", "thermal conductivity")?,
            heat_capacity: get("heat_capacity", "J/(kg K)", "heat capacity")?,
            density: *density,
            resistivity: match electric {
                true => Some(get("resistivity", "ohm m", "electrical resistivity")?),
                false => None,
            },
        })
    });
    each.collect()
}
