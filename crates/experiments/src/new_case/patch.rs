//! Two elastic bodies without debris: the file of a patch.

use super::interface::interface;
use super::{Geometry, Made, NewCase, Question, comment, q};
use crate::contact_patch::{self, Answer};
use fretwork_core::laws::SearchPath;
use fretwork_observe::quantity::number;
use fretwork_rolling::pull::LARGEST;
use std::fmt::Write as _;

/// Creepages of the curve over that of the question.
const CREEPAGES: [f64; 5] = [0.1, 0.2, 0.5, 1.0, 2.0];
/// Least amplitude over the displacement at which all of the contact slips: below it the ring that
/// slips, of a width of half of this share of the radius, is far narrower than a cell.
const LEAST_SLIP: f64 = 1e-3;

pub(super) fn make(question: &Question, laws: &SearchPath) -> Result<NewCase, String> {
    let [first, second] = question.materials()?;
    let contact = contact(question, laws)?;
    let radius = q(question.number("radius", "m")?, "m");
    let geometry = question.geometry;
    let (title, names) = match geometry {
        Geometry::WheelOnRail => ("a wheel on a rail", ["wheel", "rail"]),
        Geometry::CylinderOnFlat => ("a cylinder on a flat", ["cylinder", "flat"]),
        _ => ("a ball on a flat", ["ball", "flat"]),
    };
    let round = match geometry {
        Geometry::WheelOnRail => [
            format!("radius: {radius}"),
            format!("across: {}", q(question.number("rail-radius", "m")?, "m")),
        ],
        Geometry::CylinderOnFlat => [format!("radius: {radius}"), String::new()],
        _ => [format!("radius: {radius}, across: {radius}"), String::new()],
    };
    let mut text = comment(
        0,
        &format!(
            "{}{} without debris between them: elastic bodies with the laws of `interfaces` in every cell of their contact, `fretwork patch FILE` (docs/patch.md).",
            title[..1].to_uppercase(),
            &title[1..]
        ),
    );
    text += &comment(0, &hertz(&contact, geometry));
    let _ = write!(
        text,
        "(\n    name: \"{title}\",\n    materials: {{\"{}\": \"{first}\", \"{}\": \"{second}\"}},\n    bodies: (\n",
        names[0], names[1]
    );
    for (name, round) in names.iter().zip(round) {
        let round = match round.is_empty() {
            true => String::new(),
            false => format!(", {round}"),
        };
        let _ = writeln!(text, "        (material: \"{name}\"{round}),");
    }
    text += "    ),\n";
    text += &interface(
        question,
        names,
        "depth = K/H times pressure times slip, H the hardness of each body",
    )?;
    let load = question.load()?;
    match geometry {
        Geometry::CylinderOnFlat => {
            let length = question.number("length", "m")?;
            text += &comment(
                4,
                &format!("{} over the length of the line", q(load, "N/m")),
            );
            let _ = writeln!(
                text,
                "    length: {},\n    load: {},",
                q(length, "m"),
                q(load * length, "N")
            );
            text += &comment(4, "one row of cells: as many as the strips that slip need");
            text += "    cells: 128,\n";
        }
        _ => {
            let _ = writeln!(text, "    load: {},", q(load, "N"));
        }
    }
    match geometry {
        Geometry::WheelOnRail => {
            let creepage = question.creepage()?;
            let speed = question.number("speed", "m/s")?;
            let all = CREEPAGES.iter().map(|part| part * creepage);
            let shares = all.filter(|c| *c <= LARGEST);
            let shares: Vec<String> = shares.map(|c| format!("{:.3} %", 100.0 * c)).collect();
            let _ = writeln!(text, "    speed: {},", q(speed, "m/s"));
            text += &comment(
                4,
                "the creepage of the question is the fourth: a curve says where on it the contact works",
            );
            let _ = writeln!(text, "    motion: Rolling(along: [{}]),", shares.join(", "));
        }
        _ => {
            let amplitude = question.amplitude()?;
            slips(&contact, amplitude)?;
            let frequency = question.number("frequency", "Hz")?;
            let strokes = [0.25, 0.5, 1.0].map(|part| q(part * amplitude, "m"));
            text += &comment(
                4,
                "the stroke of the question is the last; smaller ones show where partial slip ends",
            );
            let _ = writeln!(
                text,
                "    motion: Fretting(amplitude: [{}], frequency: {}),",
                strokes.join(", "),
                q(frequency, "Hz")
            );
        }
    }
    text += ")\n";
    Ok(NewCase {
        made: Made::Patch,
        text,
    })
}

/// Refuses strokes under which next to nothing of a ball's contact slips.
fn slips(contact: &Answer, amplitude: f64) -> Result<(), String> {
    let onset = contact
        .tangential
        .as_ref()
        .and_then(|t| t.slip_displacement);
    let Some(onset) = onset.filter(|onset| amplitude < LEAST_SLIP * onset.value) else {
        return Ok(());
    };
    Err(format!(
        "amplitude: {} is {} % of the displacement at which all of this contact slips, {}, and next to nothing of it slips; take {} or more",
        q(amplitude, "m"),
        number(100.0 * amplitude / onset.value, 2),
        q(onset.value, "m"),
        q(LEAST_SLIP * onset.value, "m")
    ))
}

impl Question {
    /// Load in N, of a cylinder in N/m.
    pub(super) fn load(&self) -> Result<f64, String> {
        let unit = match self.geometry {
            Geometry::CylinderOnFlat => "N/m",
            _ => "N",
        };
        self.number("load", unit)
    }
}

/// The contact of the elastic bodies by Hertz.
pub(super) fn contact(question: &Question, laws: &SearchPath) -> Result<Answer, String> {
    let radius = question.text("radius").to_owned();
    let creepage =
        (question.geometry == Geometry::WheelOnRail).then(|| question.text("creepage").to_owned());
    let displaced = (question.geometry == Geometry::SphereOnFlat)
        .then(|| question.text("amplitude").to_owned());
    let across = match question.geometry {
        Geometry::WheelOnRail => vec!["flat".to_owned(), question.text("rail-radius").to_owned()],
        _ => Vec::new(),
    };
    contact_patch::answer(
        &contact_patch::Question {
            load: question.text("load").to_owned(),
            radius: vec![radius, "flat".into()],
            across,
            material: question.materials()?.map(str::to_owned).to_vec(),
            friction: Some(question.text("friction").to_owned()),
            creepage,
            displacement: displaced,
            ..contact_patch::Question::default()
        },
        laws,
    )
}

/// Pressure and size of the contact in words, and where the theory does not hold.
pub(super) fn hertz(contact: &Answer, geometry: Geometry) -> String {
    let patch = &contact.patch;
    let formula = match geometry {
        Geometry::CylinderOnFlat => "a = sqrt(4 P' R/(pi E*)), p0 = 2 P'/(pi a)",
        Geometry::WheelOnRail => "an ellipse by elliptic integrals",
        _ => "a = (3 P R/(4 E*))^(1/3), p0 = 3 P/(2 pi a^2)",
    };
    let hertz = format!(
        "Hertz (K. L. Johnson, Contact Mechanics, 1985, chapter 4): E* {}, {formula}: half-width along the motion {}, largest pressure {}.",
        q(contact.effective_modulus, "Pa"),
        q(patch.semi_axis, "m"),
        q(patch.pressure, "Pa"),
    );
    let limits = contact.warnings.iter().map(|w| format!(" {w}."));
    hertz + &limits.collect::<String>()
}
