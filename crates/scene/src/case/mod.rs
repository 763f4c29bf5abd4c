//! The case file as the user writes it.

mod accuracy;
mod elastic;
mod elastic_grain;
mod grains;
mod half_space;
mod heat;
mod interface;
pub(crate) mod key_units;
mod materials;
mod read;
mod shapes;
pub(crate) mod slots;
pub(crate) mod text;
mod uncertainty;
mod wear;

pub use accuracy::{AccuracySpec, AccurateResult};
pub use elastic::{
    CoarsenSpec, ElasticSpec, LineSpec, MeshProfileSpec, MeshSpec, ProfileShape, RoundSpec,
    SupportSpec, TouchSpec,
};
pub use elastic_grain::ElasticGrainSpec;
pub use grains::{Edges, GrainSpec, OneCluster, OneGrain, OnePolygon, OnePolyhedron};
pub use half_space::{CellSpec, CellTouch, HalfSpaceProfile, HalfSpaceSpec, HolderSpec};
pub use heat::{
    BodyHeatSpec, ConvectionSpec, DepthSpec, ElectricSpec, FaceSpec, HeatSpec, MeshHeatSpec,
    StoreSpec,
};
pub use interface::{InterfaceSpec, SlotValues};
pub use materials::CaseMaterials;
pub(crate) use materials::TEXT_OR_MATERIAL;
pub use shapes::{Coordinates, ShapeSpec, Side, StandardName};
pub use slots::BySlot;
pub use uncertainty::UncertaintySpec;
pub use wear::WearSpec;

use super::circuit::CircuitSpec;
use super::jump::JumpSpec;
use super::material::NumberSpec;
use super::measures::MeasureSpec;
use super::phases::PhaseSpec;
use fretwork_core::bodies::Dof;
use fretwork_core::solve::error::Norm;
use fretwork_core::solve::local::solver::Method;
use fretwork_core::step::Coupling;
use fretwork_core::step::control::GravityDrive;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// A case, as RON. Every number can be changed with `--set key.path=value`.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Case {
    /// Title.
    pub name: String,
    /// What the case shows, and the sources of its numbers.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub doc: String,
    /// Names of values, which expressions use: `{"p0": "1.12 GPa", "L": "2 mm"}` for
    /// `"${p0 * L}"`. Reading replaces expressions by their values and removes the names.
    #[serde(default, rename = "let", skip_serializing_if = "BTreeMap::is_empty")]
    pub named_values: BTreeMap<String, NumberSpec>,
    /// Dimension, 2 or 3.
    pub dimension: u32,
    /// Seed of all random numbers.
    #[serde(default)]
    pub seed: u64,
    /// Time step and end time.
    pub time: TimeSpec,
    /// Acceleration of gravity (m/s^2), one number per axis.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub gravity: Vec<f64>,
    /// Time dependence of gravity.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gravity_drive: Option<GravityDrive>,
    /// Phases of the run, one after another.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub phases: Vec<PhaseSpec>,
    /// Factor on all densities, for quasi-static runs without gravity. With scaled inertia the time
    /// step must resolve only the motion, not sound waves; results do not depend on the factor
    /// while the inertial number stays below 1e-3 (da Cruz et al. 2005). Reported densities and
    /// wear are unscaled.
    #[serde(default = "one")]
    pub inertia_scaling: f64,
    /// Coupling of damage and opening within a step: `Midpoint` (the default), `Explicit`, or
    /// `Implicit(tolerance: 1e-6, max_iterations: 50)`, see [`Coupling`].
    #[serde(default)]
    pub coupling: Coupling,
    /// Length of the periodic cell along an axis (m).
    #[serde(default, skip_serializing_if = "is_default")]
    pub periodic: PeriodicSpec,
    /// Detection.
    #[serde(default, skip_serializing_if = "is_default")]
    pub detection: DetectionSpec,
    /// Options of the contact solver.
    #[serde(default)]
    pub solver: SolverSpec,
    /// Materials: name in this case, and name of the file in `materials/`, or the material itself.
    pub materials: CaseMaterials,
    /// Interface laws between materials.
    pub interfaces: Vec<InterfaceSpec>,
    /// SHA-256 that libraries of laws must have, in hexadecimal, by `kind/name`; a law without an
    /// entry may have any.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub pins: BTreeMap<String, String>,
    /// First bodies.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub bodies: Vec<BodySpec>,
    /// Bodies that deform.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub elastic: Vec<ElasticSpec>,
    /// Elastic half-spaces.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub half_spaces: Vec<HalfSpaceSpec>,
    /// Grains.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub grains: Vec<GrainSpec>,
    /// Grains that deform, by their material.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub elastic_grains: Vec<ElasticGrainSpec>,
    /// Heat and electric current; not computed if omitted.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub heat: Option<HeatSpec>,
    /// Definition of a friction test.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub friction: Option<FrictionSpec>,
    /// Definition of a biaxial test.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub biaxial: Option<BiaxialSpec>,
    /// The account of grains between first bodies, contact and outside.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub circuit: Option<CircuitSpec>,
    /// Jumps over the cycles of the friction test; none by default.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub jump: Option<JumpSpec>,
    /// Other quantities that are measured.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub measures: Vec<MeasureSpec>,
    /// Requested accuracy of the run; if omitted, step and tolerance are those of the case
    /// throughout.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub accuracy: Option<AccuracySpec>,
    /// Estimate of the run's own error.
    #[serde(default, skip_serializing_if = "is_default")]
    pub uncertainty: UncertaintySpec,
    /// Output files and their intervals.
    #[serde(default)]
    pub output: OutputSpec,
}

/// Time step and end of the run.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TimeSpec {
    /// Time step h (s).
    pub step: f64,
    /// End time (s).
    pub end: f64,
    /// Theta of the time-stepping scheme, 1/2 to 1.
    #[serde(default = "half")]
    pub theta: f64,
}

/// Returns whether a value is the default, which is omitted when a case is written.
fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}

fn one() -> f64 {
    1.0
}

fn half() -> f64 {
    0.5
}

/// Periodic lengths (m).
#[derive(Clone, Debug, Default, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct PeriodicSpec {
    /// Along x.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub x: Option<f64>,
    /// Along y.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub y: Option<f64>,
    /// Along z.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub z: Option<f64>,
}

/// Detection distances (m); by default fractions of the smallest radius.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct DetectionSpec {
    /// Distance below which pairs are contacts.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub alert: Option<f64>,
    /// Range of the neighbour list beyond the alert distance.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub skin: Option<f64>,
}

/// Options of the solver.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct SolverSpec {
    /// The method: `Auto`, `Nlgs`, `Anderson`, `Pg`, `Cpg`, `Pcpg`, `Apgd`, `Newton`, `Interior`;
    /// see `docs/solvers.md`.
    pub method: Method,
    /// Bound on the error; by default that of the norm, [`Norm::default_tolerance`].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tolerance: Option<f64>,
    /// Definition of the error, `Balance`, `Velocity` or `Power`, see
    /// [`fretwork_core::solve::error`]; by default `Power` where all contacts are springs and no
    /// tolerance is given, `Balance` elsewhere.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub norm: Option<Norm>,
    /// Largest number of iterations per step.
    pub max_iterations: u32,
    /// Iterations between convergence tests.
    pub test_every: u32,
    /// Over-relaxation factor, from 1 to below 2, on the change of each contact's impulse in an
    /// iteration.
    pub relaxation: f64,
    /// Fraction of a penetration that is removed per step, 0 to 1. Rigid contacts under a slowly
    /// changing load drift into penetration by the solver's tolerance; 0.1 bounds the penetration
    /// to that of ten steps. The work of the correction is an entry of the energy ledger.
    pub correction: f64,
    /// Penetration, as a fraction of the smaller body's length (a grain's radius), beyond which
    /// bodies are moved apart without a change of velocity; 0 (the default) disables it. See
    /// [`fretwork_core::step::projection`].
    pub projection: f64,
}

impl Default for SolverSpec {
    fn default() -> Self {
        Self {
            method: Method::Auto,
            tolerance: None,
            norm: None,
            max_iterations: 10_000,
            test_every: 10,
            relaxation: 1.45,
            correction: 0.0,
            projection: 0.0,
        }
    }
}

/// A first body.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BodySpec {
    /// Name.
    pub name: String,
    /// Name of its material in this case.
    pub material: String,
    /// Shapes of the body.
    pub shapes: Vec<ShapeSpec>,
    /// Position of its frame (m); the origin by default.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub position: Vec<f64>,
    /// Mass (kg; kg/m in 2D); by default from density and balls.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mass: Option<f64>,
    /// Moment of inertia (kg m^2; per metre in 2D).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub inertia: Option<f64>,
    /// Time at which the body is removed (s); never by default.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub vanishes: Option<f64>,
    /// Recession of its profiles and height fields by wear; none by default.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub wears: Option<WearSpec>,
    /// Degrees of freedom; fixed by default.
    #[serde(default, skip_serializing_if = "is_default")]
    pub dofs: DofSpec,
}

/// Degrees of freedom of a first body.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct DofSpec {
    /// Translation along x.
    #[serde(skip_serializing_if = "is_fixed")]
    pub x: Dof,
    /// Translation along y.
    #[serde(skip_serializing_if = "is_fixed")]
    pub y: Dof,
    /// Translation along z (3D).
    #[serde(skip_serializing_if = "is_fixed")]
    pub z: Dof,
    /// Rotation about x (3D).
    #[serde(skip_serializing_if = "is_fixed")]
    pub rx: Dof,
    /// Rotation about y (3D).
    #[serde(skip_serializing_if = "is_fixed")]
    pub ry: Dof,
    /// Rotation about z (the only one in 2D).
    #[serde(skip_serializing_if = "is_fixed")]
    pub rz: Dof,
}

fn is_fixed(dof: &Dof) -> bool {
    *dof == Dof::Fixed
}

impl Default for DofSpec {
    fn default() -> Self {
        let fixed = || Dof::Fixed;
        Self {
            x: fixed(),
            y: fixed(),
            z: fixed(),
            rx: fixed(),
            ry: fixed(),
            rz: fixed(),
        }
    }
}

/// A friction test: the rubbed body, the axis of sliding and the axis of the load.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FrictionSpec {
    /// Name of the body.
    pub body: String,
    /// Axis of sliding: 0, 1 or 2.
    #[serde(default)]
    pub along: usize,
    /// Axis of the normal load.
    #[serde(default = "axis_y")]
    pub normal: usize,
    /// Time from which the motion counts (s).
    #[serde(default)]
    pub start: f64,
    /// Length of a cycle (s); by default the period of the sine of the body, or else of another one
    /// along the same axis.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub period: Option<f64>,
}

fn axis_y() -> usize {
    1
}

/// A biaxial test of the grains between four flat walls (2D).
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BiaxialSpec {
    /// Names of the walls on the low and high side of the axis along which the sample is loaded.
    pub axial: (String, String),
    /// Names of the walls on the low and high side of the other axis.
    pub lateral: (String, String),
    /// Time at which the confined sample is at rest, from which strains are measured (s).
    #[serde(default)]
    pub start: f64,
}

/// Output of a run.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct OutputSpec {
    /// Number of pictures over the run.
    pub frames: u32,
    /// Number of states recorded in `results.h5` over the run.
    pub views: u32,
    /// Number of steps between rows of the statistics.
    pub every: u64,
    /// Whether figures are drawn at the end.
    pub figures: bool,
    /// Width of a picture (pixels).
    pub width: u32,
    /// Section shown in frames (m): xmin, xmax, ymin, ymax (2D); the extent of the scene by
    /// default.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub window: Option<[f64; 4]>,
    /// Thickness (m) of layers along the last axis that frames show in different colours.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub layers: Option<f64>,
    /// Local shear with the darkest colour in pictures; if given, local shear is recorded and
    /// drawn.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub shear: Option<f64>,
    /// Number of steps between FCLIB problems, `fclib/step-N.hdf5`; 0 for none.
    pub fclib: u64,
    /// Interval of checkpoints, from which `--resume` continues.
    pub checkpoint: Checkpoint,
}

/// Interval of checkpoints.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize, JsonSchema)]
pub enum Checkpoint {
    /// Interval of wall time (s); longer if checkpoints would take more than 5 % of the time.
    Seconds(f64),
    /// Interval in steps.
    Steps(u64),
    /// Never.
    Never,
}

impl Default for OutputSpec {
    fn default() -> Self {
        Self {
            frames: 12,
            views: 20,
            every: 1,
            figures: true,
            width: 1400,
            window: None,
            layers: None,
            shear: None,
            fclib: 0,
            checkpoint: Checkpoint::Seconds(30.0),
        }
    }
}

impl BodySpec {
    /// Returns the degrees of freedom in the order of the dimension: translations, then rotations.
    pub fn ordered(&self, dimension: usize) -> Vec<Dof> {
        let d = self.dofs.clone();
        if dimension == 2 {
            vec![d.x, d.y, d.rz]
        } else {
            vec![d.x, d.y, d.z, d.rx, d.ry, d.rz]
        }
    }

    /// Returns the names of the degrees of freedom, in the order of [`BodySpec::ordered`].
    pub fn names(dimension: usize) -> &'static [&'static str] {
        if dimension == 2 {
            &["x", "y", "rz"]
        } else {
            &["x", "y", "z", "rx", "ry", "rz"]
        }
    }
}
