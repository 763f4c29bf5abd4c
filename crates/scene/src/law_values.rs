//! Values of the parameters of laws: from the case, its parameter file, and the materials of the
//! interface.

use super::case::InterfaceSpec;
use super::material::{self, NumberSpec, Sourced};
use super::source::{ValidationError, nearest};
use super::units;
use super::wear_coefficient::{self, WearCoefficient};
use fretwork_core::laws::{Kind, LoadedLaw, Plugin};
use std::collections::BTreeMap;

/// An error in the case or in its parameter file.
pub(super) struct InterfaceError {
    pub fault: ValidationError,
    pub in_file: bool,
}

impl From<ValidationError> for InterfaceError {
    fn from(fault: ValidationError) -> Self {
        Self {
            fault,
            in_file: false,
        }
    }
}

/// Parameters of a law by name: value, and where it comes from.
type Origins<'a> = Vec<(&'a str, (f64, String))>;

/// Properties of the two materials of an interface, in its order.
pub(super) type Sides<'a> = [&'a BTreeMap<String, Sourced>; 2];

/// Returns parameters that are properties of materials, where neither the case nor the parameter
/// file gives them: `young_1` is `young` of the first material of the interface, `young_2` that of
/// the second.
pub(super) fn properties_of_sides<'a>(
    plugin: &'a Plugin,
    given: &BTreeMap<&str, (f64, String)>,
    sides: &Sides<'_>,
    spec: &InterfaceSpec,
) -> Result<Origins<'a>, ValidationError> {
    let mut out = Vec::new();
    let names = [&spec.between.0, &spec.between.1];
    for field in &plugin.parameters {
        let name = field.name.as_str();
        let Some((property, side)) = name.strip_suffix("_1").map(|p| (p, 0)).or_else(|| {
            let property = name.strip_suffix("_2")?;
            Some((property, 1))
        }) else {
            continue;
        };
        if !material::is_property(property) || given.contains_key(name) {
            continue;
        }
        let slot = plugin.kind.word();
        let Some(sourced) = sides[side].get(property) else {
            let message = format!(
                "the {slot} law `{}` needs `{property}` of the material `{}`",
                plugin.name, names[side]
            );
            return Err(ValidationError::new(slot, message).expected(format!(
                "`{property}` among the properties of the material's file, or `{name}` in the parameters of the law"
            )));
        };
        let number = GivenNumber {
            value: sourced.value,
            unit: &sourced.unit,
            at: slot.to_owned(),
            in_case: true,
            origin: format!(
                "`{property}` of the material `{}`: {}",
                names[side], sourced.source
            ),
        };
        let value = parameter_value(plugin, plugin.kind, name, &number).map_err(|mut fault| {
            fault.path = slot.to_owned();
            fault.message = format!(
                "{}, a property of the material `{}`",
                fault.message, names[side]
            );
            fault
        })?;
        out.push((name, (value, number.origin)));
    }
    Ok(out)
}

/// Returns `mu` of the contact law, if it has one.
pub(super) fn friction_of(laws: &[LoadedLaw]) -> Option<f64> {
    let contact = laws.iter().find(|l| l.plugin.kind == Kind::CONTACT)?;
    let place = contact
        .plugin
        .parameters
        .iter()
        .position(|p| p.name == "mu")?;
    contact.parameters.get(place).copied()
}

/// Returns the coefficient of a wear law with a given `K`, which is removed from `numbers`. If one
/// of `K` and the coefficient is in the case and the other in the file, the case takes precedence;
/// both in one place contradict each other.
pub(super) fn wear_from_hardness(
    plugin: &Plugin,
    numbers: &mut BTreeMap<&str, GivenNumber<'_>>,
    (sides, spec): (&Sides<'_>, &InterfaceSpec),
    friction: Option<f64>,
) -> Result<Option<WearCoefficient>, InterfaceError> {
    let fields = plugin.parameters.iter();
    let fields = fields.map(|p| (p.name.as_str(), p.unit.as_str()));
    let Some(parameter) = wear_coefficient::parameter(fields) else {
        return Ok(None);
    };
    let Some(number) = numbers.remove(wear_coefficient::NAME) else {
        return Ok(None);
    };
    let law = plugin.name.as_str();
    let error = |fault| InterfaceError {
        fault,
        in_file: !number.in_case,
    };
    match numbers.get(parameter.0).map(|own| own.in_case) {
        Some(in_case) if in_case == number.in_case => {
            let message = format!(
                "the wear law `{law}` is given both `{}` and `{}`, which follow from each other",
                wear_coefficient::NAME,
                parameter.0
            );
            let fault = ValidationError::new(number.at.clone(), message);
            return Err(error(fault.expected("one of the two")));
        }
        Some(true) => return Ok(None),
        _ => {}
    }
    numbers.remove(parameter.0);
    let value = units::convert(number.value, number.unit, "")
        .map_err(|e| error(e.at(format!("{}.unit", number.at))))?;
    let hardness = |side: usize| sides[side].get("hardness");
    let materials = [
        (spec.between.0.as_str(), hardness(0)),
        (spec.between.1.as_str(), hardness(1)),
    ];
    let place = wear_coefficient::CoefficientParameter {
        interface: &spec.name,
        law,
        parameter,
    };
    wear_coefficient::derive(place, value, &materials, friction)
        .map(Some)
        .map_err(|message| ValidationError::new("wear", message).into())
}

/// A number for a parameter of a law, from a case or its parameter file.
pub(super) struct GivenNumber<'a> {
    pub value: f64,
    pub unit: &'a str,
    /// Path in the case or in the file.
    pub at: String,
    /// Whether the number is in the case itself.
    pub in_case: bool,
    /// Where it is, for readers: "the case".
    pub origin: String,
}

/// Returns numbers by parameter; those of the case take precedence over those of the file.
pub(super) fn given_numbers<'a>(
    slot: &str,
    law: &str,
    (file, from): (Option<&'a BTreeMap<String, Sourced>>, Option<&str>),
    own: &'a BTreeMap<String, NumberSpec>,
) -> BTreeMap<&'a str, GivenNumber<'a>> {
    let from = from.unwrap_or_default();
    let of_file = file.into_iter().flatten().map(|(name, number)| {
        let given = GivenNumber {
            value: number.value,
            unit: &number.unit,
            at: format!("{slot}.{law}.{name}"),
            in_case: false,
            origin: format!("parameters_from `{from}`: {}", number.source),
        };
        (name.as_str(), given)
    });
    let of_case = own.iter().map(|(name, number)| {
        let given = GivenNumber {
            value: number.value,
            unit: number.unit.as_deref().unwrap_or_default(),
            at: format!("parameters.{slot}.{name}"),
            in_case: true,
            origin: "the case".to_owned(),
        };
        (name.as_str(), given)
    });
    of_file.chain(of_case).collect()
}

/// The value of a parameter in the unit of the law.
pub(super) fn parameter_value(
    plugin: &Plugin,
    kind: Kind,
    parameter: &str,
    given: &GivenNumber<'_>,
) -> Result<f64, ValidationError> {
    let (law, at) = (&plugin.name, &given.at);
    let plain_number = given.in_case && given.unit.is_empty();
    let at_value = match plain_number {
        true => at.clone(),
        false => format!("{at}.value"),
    };
    let Some(field) = plugin.parameters.iter().find(|p| p.name == *parameter) else {
        let names = || plugin.parameters.iter().map(|p| p.name.as_str());
        return Err(ValidationError::new(
            at_value,
            format!("the {kind} law `{law}` has no parameter `{parameter}`"),
        )
        .expected(format!("one of {}", names().collect::<Vec<_>>().join(", ")))
        .nearest(nearest(parameter, names())));
    };
    let value = units::convert(given.value, given.unit, &field.unit).map_err(|e| {
        let mut fault = e.at(format!("{at}.unit"));
        fault.message = format!("`{parameter}` of the {kind} law `{law}`: {}", fault.message);
        fault
    })?;
    if !value.is_finite() || !(field.minimum..=field.maximum).contains(&value) {
        let range = format!(
            "a value between {:e} and {:e} {}",
            field.minimum, field.maximum, field.unit
        );
        return Err(ValidationError::new(
            at_value,
            format!("`{parameter}` of the {kind} law `{law}` is {value}"),
        )
        .expected(range.trim_end()));
    }
    Ok(value)
}
