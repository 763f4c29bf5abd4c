//! The file of a patch.

use super::fretting::measured_loops::LoopSpec;
use super::fretting::spec::FrettingSpec;
use super::method::Method;
use super::profiles::ProfilesSpec;
use super::rolling::comparison::{MeasuredSpec, PolachSpec};
use super::rolling::passages::PassagesSpec;
use super::third_body::ThirdBodySpec;
use crate::amounts::short;
use crate::spec::{Spec, SpecFile};
use fretwork_observe::quantity::quantity;
use fretwork_scene::case::{InterfaceSpec, SlotValues};
use fretwork_scene::material::NumberSpec;
use fretwork_scene::source::{InputError, Source};
use fretwork_scene::units;
use serde::Deserialize;
use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer};
use std::collections::BTreeMap;
use std::fmt;
use std::path::PathBuf;

/// The file of a patch, read.
pub type PatchFile = SpecFile<PatchSpec>;

/// The contents of the file of a patch. Materials and interfaces are those of a case.
///
/// ```ron
/// (
///     name: "wheel on rail",
///     materials: {"wheel": "wheel_steel_er7", "rail": "rail_steel_r260"},
///     bodies: (
///         (material: "wheel", radius: 0.46 m),
///         (material: "rail", across: 0.3 m),
///     ),
///     interfaces: [(name: "dry", between: ("wheel", "rail"), contact: "coulomb", parameters: (contact: {"mu": 0.4}))],
///     load: 75 kN,
///     speed: 100 km/h,
///     motion: Rolling(along: [0.1 %, 0.5 %]),
/// )
/// ```
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PatchSpec {
    /// Title.
    pub name: String,
    /// Description.
    #[serde(default)]
    pub doc: String,
    /// Materials: name here, and name of the file in `materials/`.
    pub materials: BTreeMap<String, String>,
    /// Laws between materials.
    pub interfaces: Vec<InterfaceSpec>,
    /// SHA-256 that libraries of laws must have, by `kind/name`.
    #[serde(default)]
    pub pins: BTreeMap<String, String>,
    /// The two bodies.
    pub bodies: (BodySpec, BodySpec),
    /// Measured distance of the bodies across the motion, in place of the radii across.
    #[serde(default)]
    pub distance: Option<DistanceSpec>,
    /// Profiles of both bodies across the motion, in place of the radii across.
    #[serde(default)]
    pub profiles: Option<ProfilesSpec>,
    /// Length of the contact across the motion (m), where the bodies are straight there, as a
    /// cylinder on a plane.
    #[serde(default)]
    pub length: Option<NumberSpec>,
    /// Load (N), a number or a list, under each of which the patch is solved.
    pub load: Numbers,
    /// Speed of rolling (m/s); in fretting the mean speed of the stroke.
    #[serde(default)]
    pub speed: Option<NumberSpec>,
    /// Temperature of both bodies far from the patch (K).
    #[serde(default)]
    pub temperature: Option<NumberSpec>,
    /// An elastic layer between the bodies.
    #[serde(default)]
    pub layer: Option<LayerSpec>,
    /// Runs of a window of a third body, whose friction takes the place of that of the law.
    #[serde(default)]
    pub third_body: Option<ThirdBodySpec>,
    /// How the bodies move over each other.
    pub motion: MotionSpec,
    /// How the patch is solved.
    #[serde(default)]
    pub method: Method,
    /// Passages over which the bodies wear.
    #[serde(default)]
    pub passages: Option<PassagesSpec>,
    /// Curves of Polach beside that of the patch: his dry and wet rail by default.
    #[serde(default)]
    pub polach: Option<Vec<PolachSpec>>,
    /// Measured adhesion beside the curve of the patch.
    #[serde(default)]
    pub measured: Vec<MeasuredSpec>,
    /// Measured loops beside those of the strokes.
    #[serde(default)]
    pub loops: Vec<LoopSpec>,
    /// Number of cells along each side of the grid, which is a tenth larger than the patch, or more
    /// if they are few.
    #[serde(default = "cells")]
    pub cells: usize,
    /// Other values of parameters of the laws: the results have the band of all of these.
    #[serde(default)]
    pub members: Vec<SlotValues>,
}

/// Default number of cells along each side.
fn cells() -> usize {
    48
}

/// A body: radii of curvature at the contact, a plane without one, negative where it is concave.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BodySpec {
    /// Material, by its name in the file.
    pub material: String,
    /// Radius along the motion (m).
    #[serde(default)]
    pub radius: Option<NumberSpec>,
    /// Radius across it (m).
    #[serde(default)]
    pub across: Option<NumberSpec>,
    /// Temperature far from the patch (K), if it is not that of the file.
    #[serde(default)]
    pub temperature: Option<NumberSpec>,
}

/// A table of the distance of the undeformed bodies across the motion.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DistanceSpec {
    /// A CSV file with headings, relative to the file of the patch.
    pub file: PathBuf,
    /// Heading of the places across the motion.
    #[serde(default = "across")]
    pub across: String,
    /// Heading of the distance.
    #[serde(default = "distance")]
    pub distance: String,
}

fn across() -> String {
    "y".into()
}

fn distance() -> String {
    "distance".into()
}

/// An elastic layer.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LayerSpec {
    /// Thickness (m).
    pub thickness: NumberSpec,
    /// Shear modulus (Pa).
    pub shear_modulus: NumberSpec,
}

/// How the bodies move over each other.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum MotionSpec {
    /// Steady rolling with creepages: velocities of the first body relative to the second one over
    /// the speed of rolling. Each is a number, or a list of the numbers of all points.
    Rolling {
        /// Along the rolling.
        #[serde(default)]
        along: Numbers,
        /// Across it.
        #[serde(default)]
        across: Numbers,
        /// Spin (1/m).
        #[serde(default)]
        spin: Numbers,
    },
    /// Steady rolling under forces along it, whose creepages are found.
    Pulling {
        /// Forces on the first body along the rolling (N), a number or a list: a body that is
        /// braked, or drives the other, has a positive creepage and a negative force.
        force: Numbers,
        /// Spin (1/m).
        #[serde(default)]
        spin: Option<NumberSpec>,
    },
    /// Strokes back and forth.
    Fretting(Box<FrettingSpec>),
}

/// A number or several.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Numbers(pub Vec<NumberSpec>);

impl<'de> Deserialize<'de> for Numbers {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct OneOrMany;
        impl<'de> serde::de::Visitor<'de> for OneOrMany {
            type Value = Numbers;

            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("a number, or a list of numbers")
            }

            fn visit_f64<E: serde::de::Error>(self, value: f64) -> Result<Numbers, E> {
                Ok(Numbers(vec![value.into()]))
            }

            fn visit_u64<E: serde::de::Error>(self, value: u64) -> Result<Numbers, E> {
                self.visit_f64(value as f64)
            }

            fn visit_i64<E: serde::de::Error>(self, value: i64) -> Result<Numbers, E> {
                self.visit_f64(value as f64)
            }

            fn visit_map<A: serde::de::MapAccess<'de>>(self, map: A) -> Result<Numbers, A::Error> {
                let one = NumberSpec::deserialize(MapAccessDeserializer::new(map))?;
                Ok(Numbers(vec![one]))
            }

            fn visit_seq<A: serde::de::SeqAccess<'de>>(self, list: A) -> Result<Numbers, A::Error> {
                Vec::deserialize(SeqAccessDeserializer::new(list)).map(Numbers)
            }
        }
        deserializer.deserialize_any(OneOrMany)
    }
}

impl Numbers {
    /// Returns the path of one of the numbers, which are at a path.
    pub fn path(&self, path: &str, k: usize) -> String {
        match self.0.len() > 1 {
            true => format!("{path}.{k}"),
            false => path.to_owned(),
        }
    }
}

/// Returns a number in a unit.
///
/// # Errors
/// The unit is unknown or of another dimension; located at the path.
pub fn value(
    source: &Source,
    path: &str,
    number: &NumberSpec,
    unit: &str,
) -> Result<f64, InputError> {
    let given = number.unit.as_deref().unwrap_or_default();
    let value = units::convert(number.value, given, unit)
        .map_err(|e| source.locate(e.at(format!("{path}.unit"))))?;
    match value.is_finite() {
        true => Ok(value),
        false => Err(source.error_at(path, "a finite number is expected")),
    }
}

/// Returns a number above zero in a unit.
///
/// # Errors
/// Those of [`value`], or the number is not above zero.
pub fn positive(
    source: &Source,
    path: &str,
    number: &NumberSpec,
    unit: &str,
) -> Result<f64, InputError> {
    let value = value(source, path, number, unit)?;
    match value > 0.0 {
        true => Ok(value),
        false => Err(source.error_at(
            path,
            format!("it is {}, and must be above zero", quantity(value, unit)),
        )),
    }
}

/// Zero of degrees Celsius (K), and lowest temperature without a unit that is taken to be in
/// kelvin: below it degrees Celsius were meant.
const CELSIUS: f64 = 273.15;
const COLDEST: f64 = 200.0;

/// Returns a temperature (K).
///
/// # Errors
/// It is not above zero, in another unit, or without one and likely to be in degrees Celsius.
pub fn temperature(source: &Source, path: &str, number: &NumberSpec) -> Result<f64, InputError> {
    let kelvin = positive(source, path, number, "K")?;
    match number.unit.is_none() && kelvin < COLDEST {
        false => Ok(kelvin),
        true => {
            let why = format!(
                "a temperature without a unit is in kelvin: write {:.2} K for {given} degrees Celsius, or {given} K if that is meant",
                kelvin + CELSIUS,
                given = short(kelvin)
            );
            Err(source.error_at(path, why))
        }
    }
}

/// Returns the loads of a file (N).
///
/// # Errors
/// There is none, or one is not above zero.
pub fn loads(file: &PatchFile) -> Result<Vec<f64>, InputError> {
    let (load, source) = (&file.spec.load, &file.source);
    let each = load.0.iter().enumerate();
    let each = each.map(|(k, n)| positive(source, &load.path("load", k), n, "N"));
    let all: Vec<f64> = each.collect::<Result<_, _>>()?;
    match all.is_empty() {
        false => Ok(all),
        true => Err(source.error_at("load", "there is no load: give one, or a list")),
    }
}

/// Returns the load of a file (N) that has one.
///
/// # Errors
/// As of [`loads`], or there are several, which `what` cannot have.
pub fn one_load(file: &PatchFile, what: &str) -> Result<f64, InputError> {
    match loads(file)?[..] {
        [load] => Ok(load),
        _ => Err(file
            .source
            .error_at("load", format!("{what} has one load: give a number"))),
    }
}

/// Fewest and most cells along a side.
const CELLS: [usize; 2] = [12, 512];

impl Spec for PatchSpec {
    fn check(&self, source: &Source) -> Result<(), InputError> {
        let [fewest, most] = CELLS;
        if !(fewest..=most).contains(&self.cells) || !self.cells.is_multiple_of(2) {
            return Err(source.error_at(
                "cells",
                format!(
                    "{} cells: an even number from {fewest} to {most} is expected, since the error of the grid is from one of half as many",
                    self.cells
                ),
            ));
        }
        if let Some(windows) = &self.third_body {
            windows.check(source)?;
        }
        for (k, body) in [&self.bodies.0, &self.bodies.1].into_iter().enumerate() {
            if !self.materials.contains_key(&body.material) {
                let names: Vec<&str> = self.materials.keys().map(String::as_str).collect();
                return Err(source
                    .error_at(
                        &format!("bodies.{k}.material"),
                        format!("there is no material `{}` in `materials`", body.material),
                    )
                    .expected(format!("one of {}", names.join(", "))));
            }
        }
        Ok(())
    }
}
