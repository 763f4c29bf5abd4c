//! Debris between two rough surfaces: a window of the contact, periodic along the motion.

use super::patch::{contact, hertz};
use super::window_numbers::Numbers;
use super::{Geometry, Made, NewCase, Question, q};
use crate::contact_patch::material;
use fretwork_core::laws::SearchPath;
use std::f64::consts::PI;

/// Grains along the window: enough that twice as many change friction by less than its scatter
/// between samples, docs/dev/sensitivity.md.
const COLUMNS: f64 = 60.0;
/// Fewest grains along it and across the layer.
const FEWEST: (f64, f64) = (20.0, 4.0);
/// Grains across the layer, where nothing is said of its thickness.
const ROWS: f64 = 8.0;
/// Path over the thickness of the layer in which a layer that slides one way becomes steady and is
/// measured.
const STRAIN: f64 = 8.0;

/// How the upper surface moves.
pub(super) enum Motion {
    Stroke {
        amplitude: f64,
        frequency: f64,
        cycles: f64,
    },
    OneWay {
        path: f64,
        speed: f64,
    },
}

impl Motion {
    /// Largest velocity (m/s).
    pub(super) fn velocity(&self) -> f64 {
        match self {
            Self::Stroke {
                amplitude,
                frequency,
                ..
            } => 2.0 * PI * frequency * amplitude,
            Self::OneWay { speed, .. } => *speed,
        }
    }
}

/// The pressure, the motion, and how they follow from the test.
pub(super) struct Local {
    pub pressure: f64,
    pub motion: Motion,
    pub why: Vec<String>,
    /// Width of the contact (m), where it is known.
    pub width: Option<f64>,
}

pub(super) fn make(question: &Question, laws: &SearchPath) -> Result<NewCase, String> {
    let [upper, lower] = question.materials()?;
    let debris = question.text("debris");
    let powder = material("debris", debris)?;
    let d = question.number("debris-size", "m")?;
    let rows = match question.given("layer") {
        None => ROWS,
        Some(_) => question.number("layer", "m")? / d,
    };
    if rows < FEWEST.1 {
        return Err(format!(
            "layer: {rows:.1} grains across it; from {} on it is a layer: take a thicker one or smaller grains",
            FEWEST.1
        ));
    }
    let local = local(question, laws, d * rows)?;
    let mut columns = COLUMNS.max(2.0 * rows).round();
    if let Some(width) = local.width {
        // Over a tenth of the contact its pressure changes by a half of a per cent.
        columns = columns.min((0.1 * width / d).floor().max(FEWEST.0));
        if columns * d > width {
            return Err(format!(
                "debris-size: {} grains are wider than the contact, {}; take smaller ones",
                FEWEST.0,
                q(width, "m")
            ));
        }
    }
    let numbers = Numbers::of(&local, &powder, d, rows, columns)?;
    let text = numbers.text(question, &local, &powder, [upper, lower, debris])?;
    Ok(NewCase {
        made: Made::Case,
        text,
    })
}

/// Returns pressure and motion in the middle of the contact.
fn local(question: &Question, laws: &SearchPath, thickness: f64) -> Result<Local, String> {
    let mut why = Vec::new();
    let (pressure, width) = match question.geometry {
        Geometry::Window => (question.number("pressure", "Pa")?, None),
        Geometry::FlatOnFlat => {
            let area = question.number("area", "m^2")?;
            let load = question.number("load", "N")?;
            why.push(format!(
                "Pressure: {} over {:.4e} m^2, {}.",
                q(load, "N"),
                area,
                q(load / area, "Pa")
            ));
            (load / area, Some(area.sqrt()))
        }
        Geometry::PinOnDisc
        | Geometry::CylinderOnFlat
        | Geometry::SphereOnFlat
        | Geometry::WheelOnRail => {
            let contact = contact(question, laws)?;
            why.push(
                hertz(&contact, question.geometry)
                    + " The window is in the middle, under the largest pressure.",
            );
            if question.geometry == Geometry::PinOnDisc {
                why.push("A pin flattens as it runs in: then take the load over the area of its flat as the pressure.".into());
            }
            (contact.patch.pressure, Some(2.0 * contact.patch.semi_axis))
        }
    };
    let motion = match question.geometry {
        Geometry::PinOnDisc => {
            let speed = question.number("speed", "m/s")?;
            let path = STRAIN * thickness;
            why.push(format!("Slip: {} one way, {STRAIN} thicknesses of the layer, after which dry grains are steady.", q(path, "m")));
            Motion::OneWay { path, speed }
        }
        Geometry::WheelOnRail => {
            let contact = contact(question, laws)?;
            let slip = contact.window.slip.map(|s| s.value);
            let path = slip.ok_or("creepage: give the creepage, such as 0.5%")?;
            let speed = question.number("speed", "m/s")?;
            let creepage = question.creepage()?;
            why.push(format!("Slip: {}, by which a point in the middle slips while it passes the contact at a creepage of {:.3} %, with the friction that is given (`fretwork contact-patch` has the formula).", q(path, "m"), 100.0 * creepage));
            Motion::OneWay {
                path,
                speed: speed * creepage,
            }
        }
        geometry => {
            let amplitude = question.amplitude()?;
            let frequency = question.number("frequency", "Hz")?;
            let cycles = question.number("cycles", "")?.round().max(1.0);
            let mut local = amplitude;
            if geometry == Geometry::SphereOnFlat {
                let onset = contact(question, laws)?
                    .tangential
                    .and_then(|t| t.slip_displacement);
                let onset = onset.map_or(0.0, |range| range.value);
                if amplitude <= onset {
                    return Err(format!(
                        "amplitude: up to {} the middle of the contact sticks, and debris there does not slip; take a larger amplitude, or leave the debris out",
                        q(onset, "m")
                    ));
                }
                local = amplitude - onset;
                why.push(format!("Slip: the bodies take {} of the displacement before all of the contact slips (3 mu P (2 - nu)/(8 G a), Mindlin); the rest is the slip of the window.", q(onset, "m")));
            } else {
                why.push("Slip: the amplitude is taken as the slip in the window; what the bodies and the machine take of a displacement must be subtracted.".into());
            }
            Motion::Stroke {
                amplitude: local,
                frequency,
                cycles,
            }
        }
    };
    Ok(Local {
        pressure,
        motion,
        why,
        width,
    })
}
