//! Measured quantities of a case other than friction and biaxial tests.

use super::case::Case;
use super::source::{ValidationError, nearest};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A quantity, or several that belong together. "Up" is the last axis: y in 2D, z in 3D.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum MeasureSpec {
    /// Mass of the grains whose centres are above a level along an axis (kg; kg/m in 2D).
    Mass {
        /// Name of the column.
        name: String,
        /// The axis.
        axis: usize,
        /// The level (m).
        above: f64,
        /// Time after which the rate of change is fitted for the summary (s).
        #[serde(default)]
        start: f64,
    },
    /// Angle of the free surface (rad), from the highest grains between two positions along x.
    Slope {
        /// Name of the column.
        name: String,
        /// Left end (m).
        from: f64,
        /// Right end (m).
        to: f64,
        /// Time after which the mean is formed for the summary (s).
        #[serde(default)]
        start: f64,
    },
    /// Time-averaged solid fraction, velocity and spin in slices of a box: `name.csv`, `name.png`.
    Profile {
        /// Name of the files.
        name: String,
        /// Axis along which the box is sliced.
        axis: usize,
        /// Low corner of the box (m).
        low: Vec<f64>,
        /// High corner (m).
        high: Vec<f64>,
        /// Number of slices.
        bins: usize,
        /// Angle by which the box and the velocity axes are rotated about the origin (rad, 2D).
        #[serde(default)]
        turned: f64,
        /// Start of averaging (s).
        #[serde(default)]
        start: f64,
    },
    /// Shear band in a box: angle to the x axis (rad, 0 to pi), width across it (m) and number of
    /// the grains whose local shear exceeds a threshold. Shear is counted from the start of the
    /// second phase (from the start of the run without phases).
    Band {
        /// Prefix of the columns.
        name: String,
        /// Low corner of the box (m).
        low: Vec<f64>,
        /// High corner (m).
        high: Vec<f64>,
        /// Shear above which a grain belongs to the band.
        above: f64,
    },
    /// Plane shear along x between two heights: shear rate, pressure, stress ratio, solid fraction
    /// and inertial number of the grains away from the walls, with the stress of contacts and
    /// motion. x (and y in 3D) must be periodic.
    Shear {
        /// Prefix of the columns.
        name: String,
        /// Lower height (m).
        low: f64,
        /// Upper height (m).
        high: f64,
        /// Time after which means are formed for the summary (s).
        #[serde(default)]
        start: f64,
    },
    /// Profiles across the third body between two first bodies, its clusters, force chains and flow
    /// regime, and the distribution of dissipation.
    ThirdBody(ThirdBodySpec),
}

/// Options of [`MeasureSpec::ThirdBody`].
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ThirdBodySpec {
    /// Prefix of the columns and files.
    pub name: String,
    /// The two first bodies; profiles run from the first to the second.
    pub between: (String, String),
    /// Axis of sliding.
    pub along: usize,
    /// Axis across the layer.
    pub across: usize,
    /// Number of bins across the thickness.
    #[serde(default = "default_bins")]
    pub bins: usize,
    /// Number of time slices with separate profiles.
    #[serde(default = "default_slices")]
    pub slices: usize,
    /// Number of rows of the statistics between evaluations; the rows between repeat the last
    /// values.
    #[serde(default = "every_row")]
    pub every: usize,
    /// Definition of the layer's boundaries.
    #[serde(default)]
    pub extent: Extent,
    /// Start of averaging and of the energy account (s).
    #[serde(default)]
    pub start: f64,
}

/// Boundaries of a third body.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
pub enum Extent {
    /// The mean heights of the faces of the first bodies.
    #[default]
    Faces,
    /// The heights with 1 % of the grains' mass below and above them.
    Grains,
}

fn every_row() -> usize {
    1
}

fn default_bins() -> usize {
    20
}

fn default_slices() -> usize {
    4
}

impl MeasureSpec {
    /// Returns the name of the measure.
    pub fn name(&self) -> &str {
        match self {
            Self::Mass { name, .. }
            | Self::Slope { name, .. }
            | Self::Profile { name, .. }
            | Self::Band { name, .. }
            | Self::Shear { name, .. }
            | Self::ThirdBody(ThirdBodySpec { name, .. }) => name,
        }
    }

    /// Returns the kind of the measure, as written in a case.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Mass { .. } => "Mass",
            Self::Slope { .. } => "Slope",
            Self::Profile { .. } => "Profile",
            Self::Band { .. } => "Band",
            Self::Shear { .. } => "Shear",
            Self::ThirdBody(_) => "ThirdBody",
        }
    }

    /// Returns the start of averaging (s); for a band the start of the run.
    pub fn start(&self) -> f64 {
        match self {
            Self::Mass { start, .. }
            | Self::Slope { start, .. }
            | Self::Profile { start, .. }
            | Self::Shear { start, .. }
            | Self::ThirdBody(ThirdBodySpec { start, .. }) => *start,
            Self::Band { .. } => 0.0,
        }
    }
}

/// Checks the measures of a case.
///
/// # Errors
/// Returns the first error, with its path.
pub(super) fn check(case: &Case) -> Result<(), ValidationError> {
    for (k, spec) in case.measures.iter().enumerate() {
        let twice = case.measures[..k].iter().any(|m| m.name() == spec.name());
        let checked = if twice {
            Err(("name", format!("two measures are named `{}`", spec.name())))
        } else {
            check_measure(case, spec)
        };
        checked.map_err(|(field, message)| {
            ValidationError::new(format!("measures.{k}.{field}"), message)
        })?;
        if let MeasureSpec::ThirdBody(layer) = spec {
            check_bodies(case, layer).map_err(|f| f.under(&format!("measures.{k}")))?;
        }
    }
    Ok(())
}

/// Checks that the first bodies of a layer exist.
fn check_bodies(case: &Case, layer: &ThirdBodySpec) -> Result<(), ValidationError> {
    let names = || case.bodies.iter().map(|b| b.name.as_str());
    for (k, name) in [&layer.between.0, &layer.between.1].into_iter().enumerate() {
        if !names().any(|n| n == name) {
            let all: Vec<&str> = names().collect();
            let fault =
                ValidationError::new(format!("between.{k}"), format!("there is no body `{name}`"));
            return Err(fault
                .expected_name(all, "bodies")
                .nearest(nearest(name, names())));
        }
    }
    Ok(())
}

/// Names of columns and figures that every run may have.
const RESERVED: [&str; 59] = [
    "step",
    "time",
    "cycle",
    "phase",
    "contacts",
    "active",
    "iterations",
    "error",
    "converged",
    "overlap",
    "bonds_intact",
    "bonds_broken",
    "damage_ratio",
    "mean_damage",
    "kinetic",
    "potential",
    "elastic",
    "fracture",
    "friction",
    "impact",
    "adhesion",
    "viscous",
    "correction",
    "scheme",
    "carried",
    "expansion",
    "external_work",
    "initial_kinetic",
    "residual",
    "momentum_drift",
    "angular_momentum_drift",
    "worn_first",
    "worn_third",
    "delta",
    "Q",
    "P",
    "mu",
    "energy",
    "damage",
    "loops",
    "biaxial",
    "bonds",
    "shear",
    "circuit",
    "tied_grains",
    "M_grains",
    "source_grains",
    "attached_grains",
    "ejected_grains",
    "recirculated_grains",
    "lost_grains",
    "M",
    "source",
    "attached",
    "ejected",
    "recirculated",
    "lost",
    "ledger_grains",
    "ledger_mass",
];

/// Field and message of an error in a measure.
type FieldError = (&'static str, String);

/// Checks the name and the numbers of a measure.
fn check_measure(case: &Case, spec: &MeasureSpec) -> Result<(), FieldError> {
    let dimension = case.dimension as usize;
    check_name(spec.name())?;
    if !spec.start().is_finite() {
        return Err(("start", format!("must be finite, got {}", spec.start())));
    }
    match spec {
        MeasureSpec::Mass { axis, above, .. } => {
            check_axis(*axis, dimension)?;
            if above.is_finite() {
                Ok(())
            } else {
                Err(("above", format!("must be finite, got {above}")))
            }
        }
        MeasureSpec::Slope { from, to, .. } => check_order("to", *from, *to),
        MeasureSpec::Profile {
            axis,
            low,
            high,
            bins,
            turned,
            ..
        } => {
            check_axis(*axis, dimension)?;
            check_box(low, high, dimension)?;
            if !(1..=100_000).contains(bins) {
                return Err(("bins", format!("needs 1 to 100000 slices, got {bins}")));
            }
            if !turned.is_finite() || (dimension == 3 && *turned != 0.0) {
                let message = "a box can be turned in two dimensions only, by a finite angle (rad)";
                return Err(("turned", message.into()));
            }
            Ok(())
        }
        MeasureSpec::Band {
            low, high, above, ..
        } => {
            check_box(low, high, dimension)?;
            if above.is_finite() && *above > 0.0 {
                Ok(())
            } else {
                Err(("above", format!("a shear must be positive, got {above}")))
            }
        }
        MeasureSpec::ThirdBody(layer) => check_third_body(case, layer),
        MeasureSpec::Shear { low, high, .. } => {
            check_order("high", *low, *high)?;
            if case.periodic.x.is_none() || (dimension == 3 && case.periodic.y.is_none()) {
                let message = "plane shear is measured in a cell that is periodic along x (and y in 3D); add `periodic`";
                return Err(("name", message.into()));
            }
            Ok(())
        }
    }
}

fn check_name(name: &str) -> Result<(), FieldError> {
    if let Some(message) = super::names::word_fault(name) {
        return Err(("name", message));
    }
    if RESERVED.contains(&name) {
        let message = format!("`{name}` is a column or a figure of every run; take another name");
        return Err(("name", message));
    }
    Ok(())
}

fn check_axis(axis: usize, dimension: usize) -> Result<(), FieldError> {
    if axis < dimension {
        return Ok(());
    }
    let message = format!("axis {axis} does not exist; use a number below {dimension}");
    Err(("axis", message))
}

/// Checks that an upper end is above the lower one.
fn check_order(field: &'static str, low: f64, high: f64) -> Result<(), FieldError> {
    if low.is_finite() && high.is_finite() && low < high {
        Ok(())
    } else {
        Err((field, format!("must be above {low}, got {high}")))
    }
}

/// Checks the corners of a box.
fn check_box(low: &[f64], high: &[f64], dimension: usize) -> Result<(), FieldError> {
    for (field, corner) in [("low", low), ("high", high)] {
        if corner.len() != dimension {
            let message = format!("a corner has {dimension} numbers in this case");
            return Err((field, message));
        }
    }
    let mut sides = low.iter().zip(high);
    sides.try_for_each(|(l, h)| check_order("high", *l, *h))
}

fn check_third_body(case: &Case, layer: &ThirdBodySpec) -> Result<(), FieldError> {
    let dimension = case.dimension as usize;
    for (field, axis) in [("along", layer.along), ("across", layer.across)] {
        if axis >= dimension {
            let message = format!("axis {axis} does not exist; use a number below {dimension}");
            return Err((field, message));
        }
    }
    if layer.along == layer.across {
        let message = format!(
            "the layer slides along axis {0} and is sliced across axis {0}: take two different axes",
            layer.along
        );
        return Err(("across", message));
    }
    let periodic = [case.periodic.x, case.periodic.y, case.periodic.z];
    if periodic[layer.across].is_some() {
        let message = "no layer lies between two bodies across a period; take the axis from one body to the other";
        return Err(("across", message.into()));
    }
    if layer.between.0 == layer.between.1 {
        let message = format!(
            "a third body lies between two first bodies, not between `{0}` and `{0}`",
            layer.between.0
        );
        return Err(("between", message));
    }
    if !(1..=10_000).contains(&layer.bins) {
        let message = format!("needs 1 to 10000 bins, got {}", layer.bins);
        return Err(("bins", message));
    }
    if !(1..=20).contains(&layer.slices) {
        let message = format!("needs 1 to 20 slices of time, got {}", layer.slices);
        return Err(("slices", message));
    }
    if layer.every == 0 {
        return Err((
            "every",
            "looks at every row (1), every second (2), ...; got 0".into(),
        ));
    }
    Ok(())
}
