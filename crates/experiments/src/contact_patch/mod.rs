//! From load, radii and moduli to the contact patch: its pressure and size, the onset of gross
//! slip, friction and wear as functions of creepage, and the parameters of a window of a third body
//! in it.
//!
//! ```
//! use fretwork_experiments::contact_patch::{Question, answer};
//!
//! let answer = answer(&Question {
//!     load: "75 kN".into(),
//!     radius: vec!["0.46 m".into(), "flat".into()],
//!     across: vec!["flat".into(), "0.30 m".into()],
//!     material: vec!["wheel_steel_er7".into(), "rail_steel_r260".into()],
//!     ..Question::default()
//! }, &fretwork_core::laws::SearchPath::new(&[]))?;
//! assert!((answer.patch.pressure / 1.12e9 - 1.0).abs() < 0.01);
//! # Ok::<(), String>(())
//! ```

mod alike;
mod friction;
mod question;
mod regime;
mod rolling;
mod runs;
mod setup;
mod slip;
#[cfg(test)]
mod tests;
mod text;
mod warnings;
mod wear;

pub use crate::amounts::Range;
pub use crate::limits::{Strength, Traction, Yield, YieldKind};
pub use alike::{ACCEPTABLE, Conditions};
pub use friction::Friction;
pub use question::Question;
pub(crate) use question::material;
pub use regime::WearRegime;
pub use rolling::Rolling;
pub use slip::{Tangential, Window};
pub use wear::{BodyWear, EnergyMap, Wear, WindowWear};

use crate::amounts;
use fretwork_core::laws::SearchPath;
use fretwork_elastic::patch::{self, LinePatch, PointPatch};
use question::Body;
use serde::Serialize;

/// The answer, in SI units; of a line contact, forces are per metre.
#[derive(Clone, Debug, Serialize)]
pub struct Answer {
    /// `line`, `circle` or `ellipse`.
    pub shape: &'static str,
    /// Load (N; N/m for a line).
    pub load: f64,
    /// Names of the two bodies or their materials.
    pub bodies: [String; 2],
    /// E* (Pa).
    pub effective_modulus: f64,
    /// Hertz' pressure and size.
    pub patch: Patch,
    /// Pressures at which the steel yields.
    pub strength: Option<Strength>,
    /// The friction coefficient, where one was given.
    pub friction: Option<Friction>,
    /// Onset of gross slip under a tangential force or displacement.
    pub tangential: Option<Tangential>,
    /// Rolling with a creepage.
    pub rolling: Option<Rolling>,
    /// Wear while rolling with a creepage.
    pub wear: Option<Wear>,
    /// The window of a third body in the middle of the patch.
    pub window: Window,
    /// Warnings where the theory does not hold, or an answer needs more input.
    pub warnings: Vec<String>,
}

/// Pressure and size of the patch.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Patch {
    /// Largest pressure (Pa).
    pub pressure: f64,
    /// Mean pressure (Pa).
    pub mean_pressure: f64,
    /// Semi-axis along the motion (m).
    pub semi_axis: f64,
    /// Semi-axis perpendicular to the motion (m); `None` for a line.
    pub semi_axis_across: Option<f64>,
    /// Area (m²); `None` for a line.
    pub area: Option<f64>,
    /// Approach of distant points (m); for a line it depends on the form of the bodies at a
    /// distance.
    pub approach: Option<f64>,
}

/// The theory that applies to the patch.
enum Theory {
    Line(LinePatch),
    Point(PointPatch),
}

/// Inputs of all parts of the answer.
struct Contact {
    bodies: [Body; 2],
    /// Load (N; N/m).
    load: f64,
    theory: Theory,
    /// Relative curvatures along the motion and across it (1/m).
    curvature: [f64; 2],
}

impl Contact {
    /// Returns the bodies of a question under its load.
    fn of(question: &Question) -> Result<Self, String> {
        let (load, line) = question.load()?;
        let bodies = question.bodies(line)?;
        let modulus = patch::effective_modulus(&[bodies[0].solid, bodies[1].solid]);
        let relative = |axis: usize| bodies[0].curvature[axis] + bodies[1].curvature[axis];
        let theory = match line {
            true => Theory::Line(patch::line(load, relative(0), modulus)),
            false => Theory::Point(patch::point(load, [relative(0), relative(1)], modulus)),
        };
        let curvature = [relative(0), relative(1)];
        Ok(Self {
            bodies,
            load,
            theory,
            curvature,
        })
    }

    fn solids(&self) -> [patch::Solid; 2] {
        [self.bodies[0].solid, self.bodies[1].solid]
    }

    /// Returns the semi-axis along the motion (m).
    fn semi_axis(&self) -> f64 {
        match &self.theory {
            Theory::Line(line) => line.half_width,
            Theory::Point(point) => point.along,
        }
    }

    fn pressure(&self) -> f64 {
        match &self.theory {
            Theory::Line(line) => line.pressure,
            Theory::Point(point) => point.pressure,
        }
    }

    fn is_line(&self) -> bool {
        matches!(self.theory, Theory::Line(_))
    }
}

/// Answers a question; the map of wear over T gamma/A is that of the law `t-gamma` in `laws`.
///
/// # Errors
/// Returns a sentence on invalid or missing input.
pub fn answer(question: &Question, laws: &SearchPath) -> Result<Answer, String> {
    let contact = Contact::of(question)?;
    let runs = runs::read(&question.runs)?;
    let mut friction = Friction::of(question, &contact, &runs)?;
    let tangential = Tangential::of(question, &contact, friction.as_ref())?;
    let rolling = Rolling::of(question, &contact, friction.as_ref())?;
    let given = question.yield_stress.as_ref();
    let given = given.map(|text| amounts::stress("yield_stress", text));
    let strengths = contact.bodies.each_ref().map(|b| &b.strength);
    let traction = traction(friction.as_ref(), tangential.as_ref(), rolling.as_ref());
    let strength = Strength::of(strengths, contact.is_line(), given.transpose()?, traction);
    let wear = Wear::of(
        question,
        &contact,
        rolling.as_ref(),
        friction.as_ref(),
        &runs.list,
        laws,
    )?;
    let window = Window::of(question, &contact, rolling.as_ref(), tangential.as_ref())?;
    if let Some(friction) = &mut friction {
        friction
            .notes
            .extend(alike::drive(question, &runs, &window)?);
    }
    let patch = match &contact.theory {
        Theory::Line(line) => Patch {
            pressure: line.pressure,
            mean_pressure: contact.mean_pressure(),
            semi_axis: line.half_width,
            semi_axis_across: None,
            area: None,
            approach: None,
        },
        Theory::Point(point) => Patch {
            pressure: point.pressure,
            mean_pressure: contact.mean_pressure(),
            semi_axis: point.along,
            semi_axis_across: Some(point.across),
            area: Some(point.area()),
            approach: Some(point.approach),
        },
    };
    let shape = match patch.semi_axis_across {
        None => "line",
        Some(across) if (across / patch.semi_axis - 1.0).abs() < 1e-9 => "circle",
        Some(_) => "ellipse",
    };
    let mut answer = Answer {
        shape,
        load: contact.load,
        bodies: contact.bodies.each_ref().map(|b| b.strength.name.clone()),
        effective_modulus: patch::effective_modulus(&contact.solids()),
        patch,
        strength,
        friction,
        tangential,
        rolling,
        wear,
        window,
        warnings: Vec::new(),
    };
    answer.warnings = warnings::of(question, &contact, &answer);
    Ok(answer)
}

/// Returns the tangential force of a contact, that of full slip where none was asked for.
fn traction(
    friction: Option<&Friction>,
    tangential: Option<&Tangential>,
    rolling: Option<&Rolling>,
) -> Option<Traction> {
    let mu = friction?.coefficient.value;
    let rolls = rolling.and_then(|r| r.adhesion).map(|a| a.value);
    let share = tangential.and_then(|t| t.share).map(|s| s.value * mu);
    let asked = rolls.or(share);
    Some(Traction {
        ratio: asked.unwrap_or(mu),
        asked: asked.is_some(),
    })
}
