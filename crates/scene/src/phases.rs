//! Phases of a case: their changes and ends, checks, and conversion for the simulation.

pub use super::holders::name as holder_name;

use super::case::{BodySpec, Case};
use super::holders;
use super::source::{ValidationError, nearest};
use fretwork_core::bodies::Dof;
use fretwork_core::bodies::pressure::ServoTarget;
use fretwork_core::step::control::{Changes, GravityDrive, Phase, Until};
use fretwork_core::view::{RunSetup, RunView};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// A phase. Quantities that it does not name keep their values.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PhaseSpec {
    /// Name.
    pub name: String,
    /// End condition; only the last phase may have none, and lasts to the end of the run.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub until: Option<Until>,
    /// Drives of bodies, by their names, and of holders of deformable bodies: half-spaces by their
    /// names, parts of bodies of finite elements as `body.part`. Functions use the time since the
    /// phase began.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub drives: BTreeMap<String, Redriven>,
    /// Gravity (m/s^2), one number per axis; ends any earlier drive of gravity.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gravity: Option<Vec<f64>>,
    /// Time dependence of gravity, as a function of the time since the phase began.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gravity_drive: Option<GravityDrive>,
    /// Friction coefficients: the parameter `mu` of the contact laws of interfaces, by their names.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub friction: BTreeMap<String, f64>,
    /// Bodies that are removed.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub open: Vec<String>,
    /// Tolerance of the solver.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tolerance: Option<f64>,
    /// Repetition: at the end of this phase the run goes back, until the group has run the given
    /// number of times.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub repeat: Option<Repeat>,
}

/// A group of phases that runs several times in succession: taps, cycles.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Repeat {
    /// Name of the first phase of the group; the phase itself by default.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub from: Option<String>,
    /// Total number of times the group is run.
    pub times: u32,
}

/// The degrees of freedom of a body with a new drive.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Redriven {
    /// Translation along x.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub x: Option<Dof>,
    /// Translation along y.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub y: Option<Dof>,
    /// Translation along z (3D).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub z: Option<Dof>,
    /// Rotation about x (3D).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rx: Option<Dof>,
    /// Rotation about y (3D).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ry: Option<Dof>,
    /// Rotation about z (the only one in 2D).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rz: Option<Dof>,
}

impl Redriven {
    /// Returns the given drives, with their names and their indices in the order of the dimension.
    pub(super) fn given(
        &self,
        dimension: usize,
    ) -> impl Iterator<Item = (&'static str, Option<usize>, &Dof)> {
        let all = [
            ("x", &self.x),
            ("y", &self.y),
            ("z", &self.z),
            ("rx", &self.rx),
            ("ry", &self.ry),
            ("rz", &self.rz),
        ];
        let names = BodySpec::names(dimension);
        all.into_iter().filter_map(|(name, dof)| {
            let place = names.iter().position(|n| *n == name);
            dof.as_ref().map(|d| (name, place, d))
        })
    }
}

/// Returns all drives of the holder of a deformable body along an axis during the run: its own,
/// then those of the phases.
pub fn drives_of_holder<'a>(
    case: &'a Case,
    holder: &'a str,
    axis: usize,
    own: &'a Option<Dof>,
) -> impl Iterator<Item = &'a Dof> {
    let phases = case.phases.iter().filter_map(move |p| {
        let given = p.drives.get(holder)?;
        [&given.x, &given.y, &given.z][axis].as_ref()
    });
    own.iter().chain(phases)
}

/// Iterates over all drives of a body during the run: its own, then those of the phases.
pub fn drives_of(case: &Case, body: &BodySpec) -> Vec<(usize, Dof)> {
    let dimension = case.dimension as usize;
    let own = body.ordered(dimension).into_iter().enumerate();
    let phases = case.phases.iter().filter_map(|p| p.drives.get(&body.name));
    own.chain(phases.flat_map(|r| {
        r.given(dimension)
            .filter_map(|(_, place, dof)| Some((place?, dof.clone())))
    }))
    .collect()
}

/// Checks the phases of a case.
///
/// # Errors
/// Returns the first error, with its path.
pub(super) fn check(case: &Case) -> Result<(), ValidationError> {
    for (k, phase) in case.phases.iter().enumerate() {
        let last = k + 1 == case.phases.len();
        let name = &phase.name;
        if case.phases[..k].iter().any(|p| p.name == *name) {
            let message = format!(
                "a phase before it is called `{name}` too; give each another name, `repeat` and `--set` go by it"
            );
            return Err(ValidationError::new(format!("phases.{k}.name"), message));
        }
        one(case, phase, last)
            .and_then(|()| repeat(case, k))
            .map_err(|f| f.under(&format!("phases.{k}")))?;
    }
    let all: u64 = groups(case)
        .map(|(group, times)| group.len() as u64 * u64::from(times))
        .sum();
    if all > MAX_PHASES {
        let message = format!("{all} phases with their repeats; a run has at most {MAX_PHASES}");
        return Err(ValidationError::new("phases", message));
    }
    Ok(())
}

/// Limit on the number of phases of a run, including repetitions.
const MAX_PHASES: u64 = 1_000_000;

/// Checks the repetition at phase `k`.
fn repeat(case: &Case, k: usize) -> Result<(), ValidationError> {
    let Some(spec) = &case.phases[k].repeat else {
        return Ok(());
    };
    if spec.times == 0 {
        let message = "a group of phases is done at least once";
        return Err(ValidationError::new("repeat.times", message).expected("a number from 1"));
    }
    if case.phases[k].until.is_none() {
        let message = format!("`{}` is repeated, so it needs `until`", case.phases[k].name);
        return Err(ValidationError::new("repeat", message));
    }
    let Some(from) = &spec.from else {
        return Ok(());
    };
    let before = case.phases[..=k].iter().map(|p| p.name.as_str());
    known("repeat.from", "phase up to here named", from, before)?;
    let first = first(case, k);
    if case.phases[first..k].iter().any(|p| p.repeat.is_some()) {
        let message =
            format!("the group from `{from}` holds another repeat; one group cannot hold another");
        return Err(ValidationError::new("repeat.from", message));
    }
    Ok(())
}

/// Returns the index of the first phase of the group that ends with phase `k`.
fn first(case: &Case, k: usize) -> usize {
    let from = case.phases[k].repeat.as_ref().and_then(|r| r.from.as_ref());
    let place = |name: &String| case.phases[..=k].iter().rposition(|p| p.name == *name);
    from.and_then(place).unwrap_or(k)
}

/// Iterates over the groups of phases in order, with the number of times that each runs.
pub(super) fn groups(case: &Case) -> impl Iterator<Item = (std::ops::Range<usize>, u32)> + '_ {
    let mut groups: Vec<(std::ops::Range<usize>, u32)> = Vec::new();
    for (k, phase) in case.phases.iter().enumerate() {
        let first = first(case, k);
        groups.truncate(groups.len() - (k - first).min(groups.len()));
        groups.push((first..k + 1, phase.repeat.as_ref().map_or(1, |r| r.times)));
    }
    groups.into_iter()
}

fn one(case: &Case, phase: &PhaseSpec, last: bool) -> Result<(), ValidationError> {
    match &phase.until {
        None if !last => {
            let message = format!(
                "another phase follows `{}`, so it needs `until`",
                phase.name
            );
            return Err(ValidationError::new("", message)
                .expected("Time(s), After(s), Steps(n) or AtRest(share, held)"));
        }
        Some(until) => ends(until, weighs(case)).map_err(|m| ValidationError::new("until", m))?,
        None => {}
    }
    let dimension = case.dimension as usize;
    for (name, redriven) in &phase.drives {
        let path = format!("drives.{name}");
        let holders: Vec<String> = holders::names(case).collect();
        let bodies = case.bodies.iter().map(|b| b.name.as_str());
        let all = bodies.clone().chain(holders.iter().map(String::as_str));
        known(&path, "body", name, all)?;
        if !bodies.clone().any(|b| b == name) {
            holders::check(case, name, redriven)?;
        }
        for (dof, place, drive) in redriven.given(dimension) {
            if place.is_none() {
                let message = format!("there is no {dof} in two dimensions");
                return Err(
                    ValidationError::new(format!("{path}.{dof}"), message).expected("x, y or rz")
                );
            }
            if let Some((below, fault)) = drive.error() {
                let at = format!("{path}.{dof}.{below}");
                return Err(ValidationError::new(at.trim_end_matches('.'), fault));
            }
        }
    }
    for name in &phase.open {
        known(
            "open",
            "body",
            name,
            case.bodies.iter().map(|b| b.name.as_str()),
        )?;
    }
    for name in phase.friction.keys() {
        let names = case.interfaces.iter().map(|i| i.name.as_str());
        known(&format!("friction.{name}"), "interface", name, names)?;
    }
    if let Some(g) = &phase.gravity
        && (g.len() != dimension || g.iter().any(|x| !x.is_finite()))
    {
        let message = "gravity needs one finite number an axis";
        return Err(
            ValidationError::new("gravity", message).expected(format!("{dimension} numbers"))
        );
    }
    gravity_drive(phase.gravity_drive.as_ref(), dimension)?;
    if (phase.gravity.is_some() || phase.gravity_drive.is_some()) && case.inertia_scaling != 1.0 {
        let message =
            "a phase with gravity cannot have scaled inertia; leave `inertia_scaling` out";
        return Err(ValidationError::new("", message));
    }
    match phase.tolerance {
        Some(t) if !(t.is_finite() && t >= 0.0) => Err(ValidationError::new(
            "tolerance",
            format!("must not be negative, got {t}"),
        )),
        _ => Ok(()),
    }
}

/// Checks a drive of gravity.
///
/// # Errors
/// Returns the first error, with its path below `gravity_drive`.
pub(super) fn gravity_drive(
    drive: Option<&GravityDrive>,
    dimension: usize,
) -> Result<(), ValidationError> {
    match drive.and_then(|d| d.error(dimension)) {
        Some((below, message)) => {
            let path = format!("gravity_drive.{below}");
            Err(ValidationError::new(path.trim_end_matches('.'), message))
        }
        None => Ok(()),
    }
}

/// Returns whether there is gravity at any time.
fn weighs(case: &Case) -> bool {
    let some = |g: &[f64]| g.iter().any(|x| *x != 0.0);
    let phases = || case.phases.iter();
    some(&case.gravity)
        || case.gravity_drive.is_some()
        || phases().any(|p| p.gravity_drive.is_some() || p.gravity.as_deref().is_some_and(some))
}

fn ends(until: &Until, weighs: bool) -> Result<(), String> {
    let positive = |what: &str, x: f64| {
        if x.is_finite() && x > 0.0 {
            Ok(())
        } else {
            Err(format!("{what} must be positive, got {x}"))
        }
    };
    match until {
        Until::Time(t) => positive("a time", *t),
        Until::After(t) => positive("a duration", *t),
        Until::Steps(n) => positive("the number of steps", *n as f64),
        Until::AtRest {
            share,
            energy,
            held,
            at_most,
        } => {
            positive("`held`", *held)?;
            share.map_or(Ok(()), |s| positive("`share`", s))?;
            energy.map_or(Ok(()), |e| positive("`energy`", e))?;
            at_most.map_or(Ok(()), |t| positive("`at_most`", t))?;
            if share.is_none() && energy.is_none() {
                return Err("rest needs a measure: `share` of m g d, or an `energy` (J)".into());
            }
            if share.is_some() && !weighs {
                return Err(
                    "without gravity there is no m g d; give an `energy` (J) in place of a `share`"
                        .into(),
                );
            }
            Ok(())
        }
    }
}

fn known<'a>(
    path: &str,
    what: &str,
    name: &str,
    names: impl Iterator<Item = &'a str> + Clone,
) -> Result<(), ValidationError> {
    if names.clone().any(|n| n == name) {
        return Ok(());
    }
    let plural = if what == "body" {
        "bodies"
    } else {
        "interfaces"
    };
    Err(
        ValidationError::new(path, format!("there is no {what} `{name}`"))
            .expected_name(names.clone(), plural)
            .nearest(nearest(name, names)),
    )
}

/// Adds gravity, servo drives, gates and phases of a checked case to its simulation.
///
/// # Errors
/// A pressure has no area, or the law has no friction coefficient; the error gives the path.
pub(super) fn install(case: &Case, s: &mut dyn RunSetup) -> Result<(), ValidationError> {
    let dimension = s.dimension();
    s.set_gravity(s.gravity(), case.gravity_drive.clone());
    for (k, body) in case.bodies.iter().enumerate() {
        let Some(place) = place(s, &body.name) else {
            continue;
        };
        for (dof, drive) in body.ordered(dimension).iter().enumerate() {
            let name = BodySpec::names(dimension)[dof];
            let target = ServoTarget::Body(place, dof);
            s.add_pressures(&target, drive)
                .map_err(|m| ValidationError::new(format!("bodies.{k}.dofs.{name}"), m))?;
        }
        if let Some(time) = body.vanishes {
            s.add_gate(place, time);
        }
    }
    for (path, holder, axes) in holders::own(case) {
        for (axis, drive) in axes.into_iter().enumerate() {
            let (Some(drive), Some(held)) = (drive, holders::find(case, s, &holder, axis)) else {
                continue;
            };
            let target = ServoTarget::Holder(held);
            s.add_pressures(&target, drive).map_err(|m| {
                ValidationError::new(format!("{path}.{}", ["x", "y", "z"][axis]), m)
            })?;
        }
    }
    let mut phases = Vec::new();
    for (k, spec) in case.phases.iter().enumerate() {
        phases.push(Phase {
            name: spec.name.clone(),
            until: spec.until.clone(),
            changes: changes(case, spec, s).map_err(|f| f.under(&format!("phases.{k}")))?,
            recurs: false,
        });
    }
    for (group, times) in groups(case) {
        for round in 1..=times {
            let recurs = round < times;
            let once = phases[group.clone()].iter().cloned();
            once.for_each(|p| s.add_phase(Phase { recurs, ..p }));
        }
    }
    s.measure_areas();
    Ok(())
}

fn place(s: &dyn RunView, name: &str) -> Option<usize> {
    s.bodies().driven.iter().position(|d| d.name == name)
}

fn changes(case: &Case, spec: &PhaseSpec, s: &dyn RunSetup) -> Result<Changes, ValidationError> {
    let (mut drives, mut held) = (Vec::new(), Vec::new());
    for (name, redriven) in &spec.drives {
        for (dof, k, drive) in redriven.given(s.dimension()) {
            let Some(k) = k else { continue };
            let target = match (place(s, name), holders::find(case, s, name, k)) {
                (Some(place), _) => {
                    drives.push((place, k, drive.clone()));
                    ServoTarget::Body(place, k)
                }
                (None, Some(holder)) => {
                    held.push((holder.clone(), drive.clone()));
                    ServoTarget::Holder(holder)
                }
                (None, None) => continue,
            };
            s.check_pressures(&target, drive)
                .map_err(|m| ValidationError::new(format!("drives.{name}.{dof}"), m))?;
        }
    }
    let mut contact = Vec::new();
    for (name, mu) in &spec.friction {
        let path = format!("friction.{name}");
        let Some(k) = s.laws().iter().position(|l| l.name == *name) else {
            continue;
        };
        let law = s.laws()[k].contact();
        let Some(p) = law.plugin.parameters.iter().position(|p| p.name == "mu") else {
            let message = format!(
                "the contact law `{}` has no parameter `mu` to change",
                law.plugin.name
            );
            return Err(
                ValidationError::new(path, message).expected("an interface whose law has `mu`")
            );
        };
        let mut values = law.parameters.clone();
        values[p] = *mu;
        law.plugin
            .validate(&values)
            .map_err(|e| ValidationError::new(path, e.to_string()))?;
        contact.push((k, p, *mu));
    }
    Ok(Changes {
        drives,
        holders: held,
        gravity: spec.gravity.as_deref().map(components),
        gravity_drive: spec.gravity_drive.clone(),
        contact,
        open: spec.open.iter().filter_map(|n| place(s, n)).collect(),
        tolerance: spec.tolerance,
    })
}

/// Returns a vector of the case with three components, zero where it has none.
fn components(values: &[f64]) -> [f64; 3] {
    std::array::from_fn(|k| values.get(k).copied().unwrap_or_default())
}
