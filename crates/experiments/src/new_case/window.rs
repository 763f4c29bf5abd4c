//! Debris between two rough surfaces: a window of the contact, periodic along the motion.

use super::patch::{contact, hertz};
use super::{Geometry, Made, NewCase, Question, comment, q};
use crate::contact_patch::material;
use fretwork_core::laws::SearchPath;
use fretwork_scene::material::Material;
use std::f64::consts::PI;
use std::fmt::Write as _;

/// Grains along the window: enough that twice as many change friction by less than its scatter
/// between samples, docs/dev/sensitivity.md.
const COLUMNS: f64 = 60.0;
/// Fewest grains along it and across the layer.
const FEWEST: (f64, f64) = (20.0, 4.0);
/// Grains across the layer, where nothing is said of its thickness.
const ROWS: f64 = 8.0;
/// Thickness of the layer once it is compacted, over its height before.
const COMPACTED: f64 = 0.83;
/// Root mean square of the roughness over the size of a grain: smooth walls slip along the layer.
const ROUGHNESS: f64 = 0.2;
/// Inertial number: adds 1.1 times itself to friction (F. da Cruz et al., Phys. Rev. E 72 (2005)
/// 021309).
const INERTIAL: f64 = 5e-3;
/// Slip of a step over the size of a grain, at most; and over it and Young's modulus over the
/// pressure, since grains that are pressed harder lie deeper in the corners of the surfaces.
const SLIP_OF_STEP: [f64; 2] = [4e-3, 1.6e-5];
/// Steps in which the layer is compacted.
const COMPACTION: f64 = 1000.0;
/// Path over the thickness of the layer in which a layer that slides one way becomes steady and is
/// measured.
const STRAIN: f64 = 8.0;
/// Most steps of a window.
const MOST_STEPS: f64 = 1e6;

/// How the upper surface moves.
enum Motion {
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
    fn velocity(&self) -> f64 {
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
struct Local {
    pressure: f64,
    motion: Motion,
    why: Vec<String>,
    /// Width of the contact (m), where it is known.
    width: Option<f64>,
}

pub(super) fn make(question: &Question, laws: &SearchPath) -> Result<NewCase, String> {
    let [upper, lower] = question.materials()?;
    let debris = question.text("debris");
    let powder = material(debris)?;
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
            let creepage = question.number("creepage", "")?;
            why.push(format!("Slip: {}, by which a point in the middle slips while it passes the contact at a creepage of {:.3} %, with the friction that is given (`fretwork contact-patch` has the formula).", q(path, "m"), 100.0 * creepage));
            Motion::OneWay {
                path,
                speed: speed * creepage,
            }
        }
        geometry => {
            let amplitude = question.number("amplitude", "m")?;
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

/// Everything that is computed for the window.
struct Numbers {
    /// Size of a grain (m).
    d: f64,
    /// Length of the window (m).
    length: f64,
    /// Height of the layer before it is compacted (m).
    height: f64,
    /// Load (N/m).
    load: f64,
    scaling: f64,
    /// Slip of a step (m).
    slip: f64,
    step: f64,
    /// Begin of the motion, end of the run (s).
    start: f64,
    end: f64,
    mass: f64,
}

impl Numbers {
    fn of(
        local: &Local,
        material: &Material,
        d: f64,
        rows: f64,
        columns: f64,
    ) -> Result<Self, String> {
        let density = material.density().map_err(|e| e.message.clone())?;
        let (length, height) = (columns * d, rows * d);
        let velocity = local.motion.velocity();
        let compacted = COMPACTED * height;
        let scaling = (INERTIAL * compacted / (velocity * d)).powi(2) * local.pressure / density;
        let young = material.properties.get("young");
        let young = young.and_then(|e| e.in_unit("Pa").ok()).ok_or(
            "debris: its material has no `young`, which elastic contacts need: add it to the file, or take another",
        )?;
        let slip = d * SLIP_OF_STEP[0].min(SLIP_OF_STEP[1] * young / local.pressure);
        let step = slip / velocity;
        let start = COMPACTION * step;
        let duration = match local.motion {
            Motion::Stroke {
                frequency, cycles, ..
            } => cycles / frequency,
            Motion::OneWay { path, speed } => path / speed,
        };
        if duration / step > MOST_STEPS {
            return Err(format!(
                "debris-size: the motion is {:.0} steps in which grains of {} slip by {} each: take fewer cycles, a smaller amplitude or larger grains",
                duration / step,
                q(d, "m"),
                q(slip, "m")
            ));
        }
        Ok(Self {
            d,
            length,
            height,
            load: local.pressure * length,
            scaling,
            slip,
            step,
            start,
            end: start + duration,
            mass: 0.28 * density * scaling * length * compacted,
        })
    }

    fn text(
        &self,
        question: &Question,
        local: &Local,
        material: &Material,
        [upper, lower, debris]: [&str; 3],
    ) -> Result<String, String> {
        let d = self.d;
        let mut text = comment(
            0,
            &format!(
                "A window of the contact of {}: {} of debris of {} between rough surfaces, under {}. Periodic along the motion: what leaves on one side enters on the other.",
                question.geometry.about(),
                q(self.height, "m"),
                q(d, "m"),
                q(local.pressure, "Pa")
            ),
        );
        for why in &local.why {
            text += "//\n";
            text += &comment(0, why);
        }
        text += "//\n";
        text += &comment(
            0,
            "What to vary before a number is quoted: docs/build_your_case.md, section 9; `fretwork study run FILE --seeds 4` for the scatter of samples.",
        );
        let _ = writeln!(
            text,
            "(\n    name: \"a layer of {debris} in the contact of {}\",\n    dimension: 2,\n    seed: 1,",
            question.geometry.about()
        );
        text += &comment(
            4,
            &format!(
                "step: at {} the surfaces slip by {}, the smaller of 0.004 d and 1.6e-5 d E/p with E of the debris; the layer is compacted in {COMPACTION} steps",
                q(local.motion.velocity(), "m/s"),
                q(self.slip, "m")
            ),
        );
        let _ = writeln!(
            text,
            "    time: (step: {}, end: {}, theta: 0.5),",
            q(self.step, "s"),
            q(self.end, "s")
        );
        text += &comment(
            4,
            &format!(
                "densities times (I h/(v d))^2 P/rho: the inertial number I = v d/h sqrt(rho/P) is {INERTIAL:e}, which adds 1.1 I = {:.4} to friction (F. da Cruz et al., Phys. Rev. E 72 (2005) 021309); h is the compacted layer, {} of its height here",
                1.1 * INERTIAL,
                COMPACTED
            ),
        );
        let _ = writeln!(text, "    inertia_scaling: {:.3e},", self.scaling);
        let _ = writeln!(text, "    periodic: (x: {}),", q(self.length, "m"));
        text += &comment(4, "contacts are looked for within a twentieth of a grain");
        let _ = writeln!(
            text,
            "    detection: (alert: {}, skin: {}),",
            q(0.05 * d, "m"),
            q(0.125 * d, "m")
        );
        text += &comment(
            4,
            "elastic contacts: the heat of the residuals of a step is below a half of that of slip, which is right to 1 % of friction",
        );
        text += "    solver: (norm: Power, tolerance: 0.5, max_iterations: 20000),\n";
        let _ = writeln!(
            text,
            "    materials: {{\"debris\": \"{debris}\", \"upper\": \"{upper}\", \"lower\": \"{lower}\"}},"
        );
        text += &self.interfaces(question, material)?;
        text += "    bodies: [\n";
        let rough = |side: &str| {
            format!(
                "RoughProfile(points: {:.0}, rms: {}, hurst: 0.8, longest: {}, shortest: {}, height: 0.0, side: {side})",
                (8.0 * self.length / d).round(),
                q(ROUGHNESS * d, "m"),
                q(self.length / 4.0, "m"),
                q(1.5 * d, "m")
            )
        };
        text += &comment(
            8,
            "roughness of a fifth of a grain, of waves from one and a half grains to a quarter of the window: smooth surfaces slip along the layer",
        );
        let _ = writeln!(
            text,
            "        (name: \"lower\", material: \"lower\", shapes: [{}]),",
            rough("Below")
        );
        let margin = 4.0 * ROUGHNESS * d;
        let _ = writeln!(
            text,
            "        (\n            name: \"upper\",\n            material: \"upper\",\n            shapes: [{}],",
            rough("Above")
        );
        let _ = writeln!(
            text,
            "            position: [0, {}],",
            q(self.height + 2.0 * margin, "m")
        );
        text += &comment(
            12,
            "about a quarter of the mass of the layer, so that it follows it",
        );
        let _ = writeln!(
            text,
            "            mass: {:.4e},\n            dofs: (",
            self.mass
        );
        match local.motion {
            Motion::Stroke {
                amplitude,
                frequency,
                ..
            } => {
                let _ = writeln!(
                    text,
                    "                x: Displacement(Sine(amplitude: {}, frequency: {}, start: {})),",
                    q(amplitude, "m"),
                    q(frequency, "Hz"),
                    q(self.start, "s")
                );
            }
            Motion::OneWay { path, .. } => {
                let _ = writeln!(
                    text,
                    "                x: Displacement(Ramp(from: 0.0, to: {}, start: {}, end: {})),",
                    q(path, "m"),
                    q(self.start, "s"),
                    q(self.end, "s")
                );
            }
        }
        text += &comment(
            16,
            &format!(
                "half of a per cent of the load while the grains come together, then {} times the window",
                q(local.pressure, "Pa")
            ),
        );
        let small = q(-0.005 * self.load, "N/m");
        let _ = writeln!(
            text,
            "                y: Force(Table([(0 s, {small}), ({}, {small}), ({}, {})])),\n                rz: Fixed,\n            ),\n        ),\n    ],",
            q(0.2 * self.start, "s"),
            q(0.88 * self.start, "s"),
            q(-self.load, "N/m")
        );
        text += "    grains: [\n";
        text += &comment(
            8,
            "angular, as debris is: disks roll on each other. They begin four times the roughness away from the mean heights of the surfaces",
        );
        let _ = writeln!(
            text,
            "        Voronoi(material: \"debris\", size: {}, low: [0, {}], high: [{}, {}], gap: {}),\n    ],",
            q(d, "m"),
            q(margin, "m"),
            q(self.length, "m"),
            q(margin + self.height, "m"),
            q(0.025 * d, "m")
        );
        let from = match local.motion {
            Motion::Stroke { .. } => self.start,
            Motion::OneWay { .. } => self.start + 0.2 * (self.end - self.start),
        };
        let _ = writeln!(
            text,
            "    friction: (body: \"upper\", along: 0, normal: 1, start: {}),",
            q(from, "s")
        );
        text += "    // profiles from one surface to the other, flow, dissipation: docs/third_body.md\n";
        let _ = writeln!(
            text,
            "    measures: [\n        ThirdBody(name: \"layer\", between: (\"lower\", \"upper\"), along: 0, across: 1, slices: 3, every: 40, start: {}),\n    ],",
            q(from, "s")
        );
        text += "    output: (frames: 4, views: 12, every: 8),\n)\n";
        Ok(text)
    }

    /// Laws between grains, and between grains and surfaces: those of the material's file, else
    /// friction alone.
    fn interfaces(&self, question: &Question, material: &Material) -> Result<String, String> {
        let d = self.d;
        let laws = material.laws.as_ref();
        let has = |kind: &str, law: &str| {
            laws.is_some_and(|laws| {
                let mut kinds = laws.slots.iter();
                kinds.any(|(slot, of)| slot.word() == kind && of.contains_key(law))
            })
        };
        let own = has("contact", "hertz-mindlin") && question.given("friction").is_none();
        let bonds = own && has("cohesion", "mac") && has("damage", "mac");
        let wear = match question.wear()? {
            Some(given) => Some(given),
            None if own && has("wear", "archard") => Some("{}".to_owned()),
            None => None,
        };
        let contact = match own {
            true => "{}".to_owned(),
            false => format!(
                "{{\"mu\": {}, \"restitution\": 0.1}}",
                question.number("friction", "")?
            ),
        };
        let mut text = String::from("    interfaces: [\n");
        text += &comment(
            8,
            match (own, question.given("friction").is_some()) {
                (true, _) => {
                    "parameters of the laws from the file of the debris, which names their sources"
                }
                (false, true) => {
                    "grains without cohesion; friction between them, and with the surfaces, as given"
                }
                (false, false) => {
                    "not given, and chosen: grains without cohesion, whose friction decides that of the layer: `fretwork study` over it says how much"
                }
            },
        );
        for (name, first) in [
            ("layer", "debris"),
            ("upper_wall", "upper"),
            ("lower_wall", "lower"),
        ] {
            let _ = write!(
                text,
                "        (\n            name: \"{name}\",\n            between: (\"{first}\", \"debris\"),\n"
            );
            if own {
                text += "            parameters_from: \"debris\",\n";
            }
            text += "            contact: \"hertz-mindlin\",\n";
            let mut parameters = format!("contact: {contact}");
            if bonds {
                text += "            cohesion: \"mac\",\n            damage: \"mac\",\n";
                parameters += ", cohesion: {}, damage: {}";
            }
            if let Some(wear) = wear.as_ref().filter(|_| name != "layer") {
                text += "            wear: \"archard\",\n";
                let _ = write!(parameters, ", wear: {wear}");
            }
            let _ = writeln!(text, "            parameters: ({parameters}),");
            if bonds {
                if name == "layer" {
                    text += &comment(
                        12,
                        "bonds between neighbours within a twentieth of a grain, after the compaction",
                    );
                }
                let _ = writeln!(
                    text,
                    "            bonds: At({}),\n            bonds_within: {},",
                    q(0.96 * self.start, "s"),
                    q(0.05 * d, "m")
                );
            }
            text += "        ),\n";
        }
        text += "    ],\n";
        Ok(text)
    }
}
