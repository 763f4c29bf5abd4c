//! Results of a patch, as numbers in SI units.

use super::fretting::cycles::History;
use super::fretting::map::FrettingMap;
use super::fretting::measured_loops::MeasuredLoop;
use super::method::Method;
use super::profiles::Contact;
use super::rolling::comparison::Comparison;
use super::rolling::passages::Worn;
use super::third_body::ThirdBody;
use crate::limits::Strength;
use fretwork_observe::quantity::DETERMINED;
use fretwork_rolling::{Creepage, Estimate};
use serde::Serialize;

/// The answer.
#[derive(Debug, Serialize)]
pub struct Answer {
    /// Title.
    pub name: String,
    /// Materials of the two bodies.
    pub bodies: [String; 2],
    /// Their names in the file.
    pub names: [String; 2],
    /// Load (N).
    pub load: f64,
    /// Speed (m/s).
    pub speed: Option<f64>,
    /// Laws of the interface: kind and name.
    pub laws: Vec<(String, String)>,
    /// How the patch is solved.
    pub method: Method,
    /// What is known of the error of the method, where it is not of the grid.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub about_method: Option<String>,
    /// What limits the trust in all points.
    pub notes: Vec<String>,
    /// Pressures at which the steel yields, under the largest tangential force of the points.
    pub strength: Option<Strength>,
    /// Of what the errors of points are: of the grid, or of the method and under which law.
    pub errors: String,
    /// Number of cells of the grid along its sides.
    pub cells: [usize; 2],
    /// Sides of a cell (m).
    pub cell: [f64; 2],
    /// Largest pressure (Pa).
    pub pressure: f64,
    /// Approach of distant points of the bodies (m).
    pub approach: f64,
    /// Area under pressure (m²).
    pub area: f64,
    /// The contact of two profiles, where they are given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub contact: Option<Contact>,
    /// The windows of a third body, where they give the friction.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub third_body: Option<ThirdBody>,
    /// Points, one for each creepage or stroke.
    pub points: Vec<Point>,
    /// Curves and measurements beside the adhesion of the points.
    pub comparisons: Vec<Comparison>,
    /// Measured loops beside those of the strokes.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub loops: Vec<MeasuredLoop>,
    /// Bodies after many passages.
    pub passages: Option<Worn>,
    /// Strokes over many cycles.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub cycles: Vec<History>,
    /// The map of fretting.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub map: Option<FrettingMap>,
}

/// How the bodies move in a point.
#[derive(Clone, Copy, Debug, Serialize)]
pub enum Motion {
    /// Steady rolling.
    Rolling(Creepage),
    /// A stroke of an amplitude (m).
    Fretting(f64),
}

/// A point. In fretting forces are those at the end of the stroke.
#[derive(Clone, Debug, Serialize)]
pub struct Point {
    /// How the bodies move.
    pub motion: Motion,
    /// The cycle, in fretting.
    pub stroke: Option<Cycle>,
    /// Forces on the first body along the motion and across it (N), extrapolated to cells of no
    /// size.
    pub force: [f64; 2],
    /// Tangential force over load, extrapolated to cells of no size.
    pub adhesion: f64,
    /// Error of it, by the grid or by the theory that neglects more.
    pub adhesion_error: f64,
    /// Lowest and highest value over the members.
    pub adhesion_band: Option<Band>,
    /// Moment on the first body about the normal (N m). A closed form has none.
    pub moment: Option<f64>,
    /// Energy supplied over the distance rolled (N), T gamma, without the moment where it is not
    /// known; in fretting over a cycle (J).
    pub t_gamma: f64,
    /// Energy dissipated by slip over the distance rolled (N); in fretting over a cycle (J).
    pub dissipation: f64,
    /// Resistance to rolling by unlike bodies (N).
    pub resistance: f64,
    /// Share of the area that sticks; in fretting throughout the cycle. A closed form has none.
    pub stuck: Option<f64>,
    /// Largest velocity of slip (m/s).
    pub slip_speed: Option<f64>,
    /// Error of it, by the grid and the theory (m/s).
    pub slip_speed_error: Option<f64>,
    /// Highest temperature (K).
    pub temperature: Option<f64>,
    /// Error of it, by the grid and the theory (K).
    pub temperature_error: Option<f64>,
    /// Error of the creepage (1) where the force is given, by those of the force; null where it is
    /// not determined.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub creepage_error: Option<f64>,
    /// Wear of a passage; in fretting of a cycle.
    pub wear: Vec<Wear>,
    /// Steps of Newton's method, and iterations of the linear equations.
    pub iterations: [usize; 2],
    /// Whether the solution is the only one nearby.
    pub unique: bool,
    /// What limits the trust in this point.
    pub notes: Vec<String>,
}

/// A cycle of fretting; estimates are extrapolated to cells of no size.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Cycle {
    /// Whether the force is given, not the displacement.
    pub by_force: bool,
    /// Amplitude of the displacement (m).
    pub displacement: Estimate,
    /// Amplitude of the force Q (N).
    pub force: Estimate,
    /// Energy of slip (J).
    pub energy: Estimate,
    /// Share of the area that sticks throughout.
    pub stuck: Estimate,
    /// A, the energy over 4 Q delta.
    pub energy_ratio: f64,
    /// Half of the width of the loop at no force, over the amplitude.
    pub slip_ratio: f64,
    /// Volume worn off the interface (m³).
    pub worn: Estimate,
}

/// Lowest and highest value.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Band {
    /// Lowest value.
    pub low: f64,
    /// Highest value.
    pub high: f64,
}

impl Band {
    /// Returns the range of a value and those of members; `None` without members.
    pub fn of(value: f64, members: &[f64]) -> Option<Self> {
        let low = members.iter().copied().fold(value, f64::min);
        let high = members.iter().copied().fold(value, f64::max);
        (!members.is_empty()).then_some(Self { low, high })
    }
}

/// Wear of a body.
#[derive(Clone, Debug, Serialize)]
pub struct Wear {
    /// The body by its material, or `interface` where the law does not tell the bodies apart.
    pub body: String,
    /// The wear law.
    pub law: String,
    /// Volume over the distance rolled (m²), extrapolated to cells of no size; in fretting the
    /// volume of a cycle (m³).
    pub volume: f64,
    /// Error of it, by the grid and the theory.
    pub volume_error: f64,
    /// Largest depth (m), likewise.
    pub depth: f64,
    /// Error of it, by the grid and the theory (m).
    pub depth_error: f64,
    /// Depth across the motion, one number for each row of cells (m); in fretting empty.
    pub profile: Vec<f64>,
    /// Half-width of the 95 % interval of all of these over the seeds of windows, as a share of
    /// them; null of a law.
    pub half_width: Option<f64>,
}

impl Wear {
    /// Whether grid and seeds determine the volume.
    pub fn is_known(&self) -> bool {
        let by_seeds = self.half_width.is_none_or(|half| half <= DETERMINED);
        by_seeds && self.volume_error <= DETERMINED * self.volume
    }
}
