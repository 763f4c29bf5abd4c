//! The tribological circuit in a case: the bonds that attach grains to first bodies, and the zones
//! where grains leave.

use super::case::Case;
use super::source::{ValidationError, nearest};
use fretwork_core::laws::{Interface, Kind};
use fretwork_core::process::circuit::{CircuitParameters, EjectionOutcome, Zone};
use fretwork_core::view::RunView;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The account of grains between first bodies, contact and outside.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CircuitSpec {
    /// Names of the first bodies to which grains can belong. A grain belongs to a first body while
    /// a path of unbroken bonds connects them.
    pub bases: Vec<String>,
    /// Interfaces whose bonds tie grains; by default all that make bonds.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bonds: Option<Vec<String>>,
    /// Start time of the circuit (s); the bonds that attach grains must have formed by then.
    #[serde(default)]
    pub start: f64,
    /// Number of steps between updates of the circuit.
    #[serde(default = "default_interval")]
    pub every: u64,
    /// Zones outside the contact.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub zones: Vec<ZoneSpec>,
}

fn default_interval() -> u64 {
    10
}

/// A region where grains are ejected.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ZoneSpec {
    /// Name.
    pub name: String,
    /// Low corner (m); `-inf` where the zone is unbounded.
    pub low: Vec<f64>,
    /// High corner (m); `inf` where the zone is unbounded.
    pub high: Vec<f64>,
    /// Body with which the zone moves; the corners are then relative to that body's position.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub carried_by: Option<String>,
    /// Time in the zone (s) after which a grain is lost and removed from the scene, 0 for at once;
    /// without it grains stay ejected and may return.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lost_after: Option<f64>,
}

/// Checks the circuit of a case.
///
/// # Errors
/// Returns the first error, with its path.
pub(super) fn check(case: &Case) -> Result<(), ValidationError> {
    let Some(circuit) = &case.circuit else {
        return Ok(());
    };
    if circuit.bases.is_empty() {
        let message = "a circuit needs a first body that grains can belong to; name one in `bases`";
        return Err(ValidationError::new("circuit.bases", message));
    }
    for (k, base) in circuit.bases.iter().enumerate() {
        let path = format!("circuit.bases.{k}");
        body(case, &path, base)?;
        if circuit.bases[..k].contains(base) {
            return Err(ValidationError::new(
                path,
                format!("`{base}` is named twice"),
            ));
        }
    }
    let ties = tying(case, circuit)?;
    for (k, base) in circuit.bases.iter().enumerate() {
        let material = case
            .bodies
            .iter()
            .find(|b| b.name == *base)
            .map(|b| &b.material);
        let bonds = ties.iter().any(|i| {
            let between = &case.interfaces[*i].between;
            Some(&between.0) == material || Some(&between.1) == material
        });
        if !bonds {
            let names: Vec<&str> = ties
                .iter()
                .map(|i| case.interfaces[*i].name.as_str())
                .collect();
            let message = format!(
                "no interface that ties ({}) is with the material of `{base}`, so no grain can belong to it; bond \
                 grains to it, or leave it out",
                names.join(", ")
            );
            return Err(ValidationError::new(format!("circuit.bases.{k}"), message));
        }
    }
    if !(circuit.start.is_finite() && circuit.start >= 0.0 && circuit.start < case.time.end) {
        let message = format!(
            "the account must begin within the run, got {}",
            circuit.start
        );
        return Err(ValidationError::new("circuit.start", message)
            .expected(format!("a time from 0 to below {}", case.time.end)));
    }
    if circuit.every == 0 {
        return Err(ValidationError::new("circuit.every", "must be at least 1"));
    }
    for (k, zone) in circuit.zones.iter().enumerate() {
        self::zone(case, zone).map_err(|f| f.under(&format!("circuit.zones.{k}")))?;
        for other in &circuit.zones[..k] {
            if other.name == zone.name {
                let message = format!("two zones are named `{}`", zone.name);
                return Err(ValidationError::new(
                    format!("circuit.zones.{k}.name"),
                    message,
                ));
            }
            let overlap = other.carried_by == zone.carried_by
                && (0..zone.low.len())
                    .all(|a| other.low[a] < zone.high[a] && zone.low[a] < other.high[a]);
            if overlap {
                let message = format!(
                    "`{}` overlaps `{}`: a grain there would be in both; move one",
                    zone.name, other.name
                );
                return Err(ValidationError::new(format!("circuit.zones.{k}"), message));
            }
        }
    }
    Ok(())
}

fn body(case: &Case, path: &str, name: &str) -> Result<(), ValidationError> {
    if case.bodies.iter().any(|b| b.name == name) {
        return Ok(());
    }
    let names: Vec<&str> = case.bodies.iter().map(|b| b.name.as_str()).collect();
    Err(
        ValidationError::new(path, format!("there is no body `{name}`"))
            .expected_name(names.iter().copied(), "bodies")
            .nearest(nearest(name, names.iter().copied())),
    )
}

/// Returns the indices of the interfaces whose bonds attach grains.
fn tying(case: &Case, circuit: &CircuitSpec) -> Result<Vec<usize>, ValidationError> {
    let all =
        || (0..case.interfaces.len()).filter(|i| case.interfaces[*i].law(Kind::COHESION).is_some());
    let Some(names) = &circuit.bonds else {
        return Ok(all().collect());
    };
    let mut out = Vec::new();
    for (k, name) in names.iter().enumerate() {
        let path = format!("circuit.bonds.{k}");
        let Some(at) = case.interfaces.iter().position(|i| i.name == *name) else {
            let known: Vec<&str> = case.interfaces.iter().map(|i| i.name.as_str()).collect();
            return Err(
                ValidationError::new(path, format!("there is no interface `{name}`"))
                    .expected_name(known.iter().copied(), "interfaces")
                    .nearest(nearest(name, known.iter().copied())),
            );
        };
        if case.interfaces[at].law(Kind::COHESION).is_none() {
            let message = format!("the interface `{name}` has no cohesion law, it makes no bonds");
            return Err(ValidationError::new(path, message));
        }
        out.push(at);
    }
    Ok(out)
}

fn zone(case: &Case, zone: &ZoneSpec) -> Result<(), ValidationError> {
    let dimension = case.dimension as usize;
    for (field, corner) in [("low", &zone.low), ("high", &zone.high)] {
        if corner.len() != dimension || corner.iter().any(|x| x.is_nan()) {
            let message = format!("a corner has {dimension} numbers in this case, got {corner:?}");
            return Err(ValidationError::new(field, message).expected("numbers, -inf or inf"));
        }
    }
    let periods = [case.periodic.x, case.periodic.y, case.periodic.z];
    for (a, (low, high)) in zone.low.iter().zip(&zone.high).enumerate() {
        let width = high - low;
        if let Some(period) = periods[a].filter(|p| width.is_finite() && width > *p) {
            let message = format!(
                "a zone of {width} m along axis {a} is wider than the period of {period} m"
            );
            return Err(ValidationError::new("high", message));
        }
        if periods[a].is_some() && low.is_finite() != high.is_finite() {
            let message = format!(
                "along axis {a}, which is periodic, a zone open on one side is the whole cell, got {low} to {high}; give \
                 both sides, or leave both open"
            );
            return Err(ValidationError::new(
                if low.is_finite() { "high" } else { "low" },
                message,
            ));
        }
        if low >= high {
            let message = format!("must be above {low} along axis {a}, got {high}");
            return Err(ValidationError::new("high", message));
        }
    }
    if let Some(name) = &zone.carried_by {
        body(case, "carried_by", name)?;
    }
    match zone.lost_after {
        Some(time) if !(time.is_finite() && time >= 0.0) => {
            let message = format!("a time must not be negative, got {time}");
            Err(ValidationError::new("lost_after", message))
        }
        _ => Ok(()),
    }
}

/// Returns the circuit's specification in terms of the built scene; the case must have been
/// checked.
pub fn install(case: &Case, s: &dyn RunView) -> Option<CircuitParameters> {
    let circuit = case.circuit.as_ref()?;
    let index = |name: &String| s.bodies().driven_named(name).map(|d| d.body);
    let ties = tying(case, circuit).unwrap_or_default();
    let opens = |i: &usize| s.laws().get(*i).is_some_and(Interface::opens);
    let zones = circuit.zones.iter().map(|z| Zone {
        name: z.name.clone(),
        low: components(&z.low),
        high: components(&z.high),
        carrier: z.carried_by.as_ref().and_then(index),
        outcome: z
            .lost_after
            .map_or(EjectionOutcome::Stays, EjectionOutcome::LostAfter),
    });
    Some(CircuitParameters {
        bases: circuit.bases.iter().filter_map(index).collect(),
        interfaces: ties.into_iter().filter(opens).map(|i| i as u16).collect(),
        zones: zones.collect(),
        scaling: case.inertia_scaling,
    })
}

/// Returns a corner with three components, zero where it has none.
fn components(values: &[f64]) -> [f64; 3] {
    std::array::from_fn(|k| values.get(k).copied().unwrap_or_default())
}
