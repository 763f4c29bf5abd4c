//! Checks of the heat of a case.

use crate::case::{Case, HeatSpec, StoreSpec};
use crate::source::{ValidationError, nearest};
use fretwork_core::heat::Supply;
use fretwork_core::laws::{Kind, LoadedLaw};
use fretwork_core::view::RunView;

/// Checks numbers and names.
///
/// # Errors
/// Returns the first error, with its path in the case.
pub(crate) fn check(case: &Case) -> Result<(), ValidationError> {
    let Some(heat) = &case.heat else {
        return Ok(());
    };
    temperature("heat.initial", heat.initial)?;
    for (name, value) in &heat.grains {
        let here = format!("heat.grains.{name}");
        if !case.materials.contains_key(name) {
            let names = || case.materials.keys().map(String::as_str);
            let message = format!("the case has no material `{name}`");
            return Err(ValidationError::new(here, message).nearest(nearest(name, names())));
        }
        temperature(&here, *value)?;
    }
    if let Some(convection) = heat.convection {
        not_negative("heat.convection.coefficient", convection.coefficient)?;
        temperature("heat.convection.ambient", convection.ambient)?;
    }
    bodies(case, heat)?;
    if case.jump.is_some() {
        let message = "a jump over cycles repeats wear and damage, not the heat of the cycles that it stands for; leave `jump` or `heat` out";
        return Err(ValidationError::new("jump", message));
    }
    let shares = heat.shares;
    for (name, share) in [
        ("friction", shares.friction),
        ("impact", shares.impact),
        ("viscous", shares.viscous),
        ("adhesion", shares.adhesion),
        ("fracture", shares.fracture),
    ] {
        if !(0.0..=1.0).contains(&share) {
            let message = format!("a share of the dissipated energy is from 0 to 1, got {share}");
            return Err(ValidationError::new(format!("heat.shares.{name}"), message));
        }
    }
    positive("heat.clock", heat.clock)?;
    if !heat.start.is_finite() {
        let message = format!("must be finite, got {}", heat.start);
        return Err(ValidationError::new("heat.start", message));
    }
    if heat.every == 0 {
        let message = "must be at least 1: steps of the mechanics per step of the heat";
        return Err(ValidationError::new("heat.every", message));
    }
    if !(0.5..=1.0).contains(&heat.theta) {
        return Err(
            ValidationError::new("heat.theta", format!("got {}", heat.theta))
                .expected("a number between 0.5 and 1"),
        );
    }
    if let Some(hardness) = heat.flash {
        positive("heat.flash", hardness)?;
    }
    circuit(case, heat)
}

fn bodies(case: &Case, heat: &HeatSpec) -> Result<(), ValidationError> {
    for (name, body) in &heat.bodies {
        let here = format!("heat.bodies.{name}");
        first_body(case, &here, name)?;
        if let Some(t) = body.temperature {
            temperature(&format!("{here}.temperature"), t)?;
        }
        if !body.power.is_finite() {
            let message = format!("must be finite, got {}", body.power);
            return Err(ValidationError::new(format!("{here}.power"), message));
        }
        if let Some(face) = body.convection {
            not_negative(&format!("{here}.convection.coefficient"), face.coefficient)?;
            not_negative(&format!("{here}.convection.area"), face.area)?;
            temperature(&format!("{here}.convection.ambient"), face.ambient)?;
        }
        let keeps = matches!(body.store, StoreSpec::Fixed | StoreSpec::Insulated);
        if keeps && (body.power != 0.0 || body.convection.is_some()) {
            let what = match body.store {
                StoreSpec::Fixed => "keeps its temperature (`store: Fixed`, the default)",
                _ => "is insulated",
            };
            let message = format!(
                "`{name}` {what}, so that power and convection would change nothing; give it `store: Lumped()` or `HalfSpace(..)`"
            );
            return Err(ValidationError::new(here, message));
        }
        if body.store == StoreSpec::Insulated && body.temperature.is_some() {
            let message =
                format!("`{name}` is insulated, so that it has no temperature of its own");
            return Err(ValidationError::new(format!("{here}.temperature"), message));
        }
        match &body.store {
            StoreSpec::Lumped {
                capacity: Some(capacity),
            } => positive(&format!("{here}.store"), *capacity)?,
            StoreSpec::HalfSpace(depth) => {
                for (what, value) in [("depth", depth.depth), ("spacing", depth.spacing)] {
                    if let Some(value) = value {
                        positive(&format!("{here}.store.{what}"), value)?;
                    }
                }
                if depth.growth.is_some_and(|g| !(1.0..=2.0).contains(&g)) {
                    let message = "the growth of the spacing is from 1 to 2";
                    return Err(ValidationError::new(
                        format!("{here}.store.growth"),
                        message,
                    ));
                }
            }
            StoreSpec::Mesh(mesh) => {
                let here = format!("{here}.store");
                for (part, t) in &mesh.fixed {
                    temperature(&format!("{here}.fixed.{part}"), *t)?;
                }
                for (part, convection) in &mesh.convection {
                    let here = format!("{here}.convection.{part}");
                    not_negative(&format!("{here}.coefficient"), convection.coefficient)?;
                    temperature(&format!("{here}.ambient"), convection.ambient)?;
                }
                for (part, flux) in &mesh.flux {
                    if !flux.is_finite() {
                        let message = format!("must be finite, got {flux}");
                        return Err(ValidationError::new(format!("{here}.flux.{part}"), message));
                    }
                }
                if body.power != 0.0 || body.convection.is_some() {
                    let message = format!(
                        "heat enters `{name}` at parts of its mesh; give `flux` or `convection` of a part in `store: Mesh(..)`"
                    );
                    return Err(ValidationError::new(format!("heat.bodies.{name}"), message));
                }
            }
            _ => {}
        }
    }
    Ok(())
}

fn circuit(case: &Case, heat: &HeatSpec) -> Result<(), ValidationError> {
    let Some(circuit) = &heat.circuit else {
        return Ok(());
    };
    let deforms = case.elastic.iter().map(|b| &b.name);
    let mut deforms = deforms.chain(case.half_spaces.iter().map(|b| &b.name));
    if let Some(name) = deforms.next() {
        let message = format!(
            "current is computed in rigid bodies only, and `{name}` deforms; take `circuit` away, or make it a rigid body of `bodies`"
        );
        return Err(ValidationError::new("heat.circuit", message));
    }
    first_body(case, "heat.circuit.from", &circuit.from)?;
    first_body(case, "heat.circuit.to", &circuit.to)?;
    if circuit.from == circuit.to {
        let message = "the current enters and leaves the same body";
        return Err(ValidationError::new("heat.circuit.to", message).expected("another first body"));
    }
    if !case
        .interfaces
        .iter()
        .any(|i| i.law(Kind::TRANSPORT).is_some())
    {
        let message = "no interface has a transport law, so that no current can flow";
        return Err(ValidationError::new("heat.circuit", message)
            .expected("`transport: \"holm\"`, or another transport law, at the interfaces"));
    }
    let here = "heat.circuit.supply";
    match circuit.supply {
        Supply::Voltage(voltage) if voltage.is_finite() => Ok(()),
        Supply::Voltage(voltage) => Err(ValidationError::new(
            here,
            format!("a voltage must be finite, got {voltage}"),
        )),
        Supply::Current { current, limit } => {
            if !current.is_finite() {
                let message = format!("a current must be finite, got {current}");
                return Err(ValidationError::new(here, message));
            }
            positive(&format!("{here}.limit"), limit)
        }
    }
}

/// Whether the interfaces of a material have a transport law.
pub(super) fn carries_current(case: &Case, material: &str) -> bool {
    case.interfaces.iter().any(|i| {
        i.law(Kind::TRANSPORT).is_some() && (i.between.0 == material || i.between.1 == material)
    })
}

fn first_body(case: &Case, here: &str, name: &str) -> Result<(), ValidationError> {
    let rigid = || case.bodies.iter().map(|b| b.name.as_str());
    let elastic = || case.elastic.iter().map(|b| b.name.as_str());
    let half_spaces = || case.half_spaces.iter().map(|b| b.name.as_str());
    let names = || rigid().chain(elastic()).chain(half_spaces());
    if names().any(|n| n == name) {
        return Ok(());
    }
    let message = format!("there is no first body `{name}`");
    Err(ValidationError::new(here, message)
        .expected_name(names(), "first bodies")
        .nearest(nearest(name, names())))
}

fn positive(here: &str, x: f64) -> Result<(), ValidationError> {
    if x.is_finite() && x > 0.0 {
        return Ok(());
    }
    Err(ValidationError::new(
        here,
        format!("must be above zero, got {x}"),
    ))
}

fn not_negative(here: &str, x: f64) -> Result<(), ValidationError> {
    if x.is_finite() && x >= 0.0 {
        return Ok(());
    }
    Err(ValidationError::new(
        here,
        format!("must be zero or more, got {x}"),
    ))
}

fn temperature(here: &str, t: f64) -> Result<(), ValidationError> {
    if t.is_finite() && t >= 0.0 {
        return Ok(());
    }
    let message = format!("a temperature is in kelvin and not below zero, got {t}");
    Err(ValidationError::new(here, message))
}

/// Refuses laws that read temperatures in a case without heat.
pub(super) fn refuse_laws_without_heat(
    case: &Case,
    s: &dyn RunView,
) -> Result<(), ValidationError> {
    for (k, law) in s.laws().iter().enumerate() {
        let of_temperature =
            |l: &&LoadedLaw| l.plugin.kind != Kind::TRANSPORT && l.reads_temperatures();
        let mut reading = law.loaded().filter(of_temperature);
        let Some(found) = reading.next() else {
            continue;
        };
        let slot = found.plugin.kind.word();
        // Interfaces of the simulation are those of the case, in its order.
        let here = match case.interfaces.get(k) {
            Some(_) => format!("interfaces.{k}.{slot}"),
            None => "interfaces".to_owned(),
        };
        let message = format!(
            "the {slot} law `{}` reads temperatures, and the case computes no heat",
            found.plugin.name
        );
        return Err(ValidationError::new(here, message)
            .expected("`heat: ()` in the case, or `heat: (initial: 293.15, ...)`"));
    }
    Ok(())
}
