//! The question: numbers with units, and materials by name.

use crate::amounts::{number, positive, stress};
use crate::limits::BodyStrength;
use fretwork_elastic::patch::Solid;
use fretwork_observe::quantity::quantity as shown;
use fretwork_observe::quantity::unit::FORCE;
use fretwork_scene::material::{Material, MaterialLibrary};
use fretwork_scene::quantity::{hardness_in_pascal, quantity};
use fretwork_scene::units::hardness as scale_of_hardness;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// The question. Texts are numbers with units, `75 kN`; without a unit they are in SI units.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Question {
    /// Load: a force, or a force per length for a line contact.
    pub load: String,
    /// Radii of the two bodies in the direction of motion: `flat` for a plane, negative where
    /// concave; with a single radius the other body is a plane.
    pub radius: Vec<String>,
    /// Radii perpendicular to the motion; by default those of `radius`.
    pub across: Vec<String>,
    /// Materials of the two bodies by name; a single name is for both.
    pub material: Vec<String>,
    /// Young's moduli, which replace those of the materials.
    pub young: Vec<String>,
    /// Poisson's ratios, which replace those of the materials.
    pub poisson: Vec<String>,
    /// Hardnesses, which replace those of the materials.
    pub hardness: Vec<String>,
    /// Yield stress of the softer body; by default those of its material, before and after it has
    /// hardened, or the flow stress, its hardness over 2.8.
    pub yield_stress: Option<String>,
    /// Friction coefficient: `0.4`, `0.40+-0.03` or `0.3..0.5`.
    pub friction: Option<String>,
    /// Folders of runs from which friction coefficients are read, with their interval.
    pub runs: Vec<PathBuf>,
    /// Differences between these runs and the patch that are accepted, by the names in
    /// [`ACCEPTABLE`](super::ACCEPTABLE).
    pub accept: Vec<String>,
    /// Tangential force: a force, or a force per length for a line contact.
    pub force: Option<String>,
    /// Amplitude of the displacement of distant points of the bodies, in fretting.
    pub displacement: Option<String>,
    /// Longitudinal creepage, in rolling.
    pub creepage: Option<String>,
    /// Speed of rolling.
    pub speed: Option<String>,
    /// Archard's coefficient K, in the form of `friction`.
    pub wear: Option<String>,
    /// Width of the window of a third body; by default a fiftieth of the patch.
    pub window: Option<String>,
}

/// Standard gravity (m/s²), for loads that are given as masses.
const STANDARD_GRAVITY: f64 = 9.806_65;

/// One of the two bodies.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Body {
    /// Curvature along the motion and perpendicular to it (1/m).
    pub curvature: [f64; 2],
    /// Elasticity.
    pub solid: Solid,
    /// What is known of its strength.
    pub strength: BodyStrength,
}

impl Question {
    /// Returns the load, and whether it is per length.
    pub(super) fn load(&self) -> Result<(f64, bool), String> {
        if self.load.trim().is_empty() {
            return Err(
                "load: give the normal load, such as 75 kN, or 13 MN/m for a line contact".into(),
            );
        }
        let [per_metre, force] = [2, 3].map(|dimension| FORCE.symbol(dimension));
        if let Ok(mass) = quantity(&self.load, "kg")
            && quantity(&self.load, force).is_err()
        {
            return Err(format!(
                "load: `{}` is a mass, and the load is a force: give its weight, {}",
                self.load.trim(),
                shown(mass * STANDARD_GRAVITY, force)
            ));
        }
        let per_length =
            quantity(&self.load, force).is_err() && quantity(&self.load, per_metre).is_ok();
        let unit = if per_length { per_metre } else { force };
        Ok((positive("load", &self.load, unit)?, per_length))
    }

    /// The two bodies.
    pub(super) fn bodies(&self, line: bool) -> Result<[Body; 2], String> {
        if self.radius.is_empty() {
            return Err("radius: give the radius of one body or of both along the motion, such as 0.46m or 0.46m,flat".into());
        }
        if line && !self.across.is_empty() {
            return Err("across: a load per length is that of a line contact, which has no radius across; leave it out, or give the load as a force".into());
        }
        let along = curvatures("radius", &self.radius)?;
        let across = match (line, self.across.is_empty()) {
            (true, _) => [0.0; 2],
            (false, true) => along,
            (false, false) => curvatures("across", &self.across)?,
        };
        for (what, pair, needed) in [("radius", along, true), ("across", across, !line)] {
            if needed && pair[0] + pair[1] <= 0.0 {
                return Err(format!(
                    "{what}: the bodies conform, their curvatures 1/R1 + 1/R2 add to {:.3e} 1/m, which must be above zero; Hertz' theory is for bodies that touch in a point or a line",
                    pair[0] + pair[1]
                ));
            }
        }
        let first = self.body(0, [along[0], across[0]])?;
        Ok([first, self.body(1, [along[1], across[1]])?])
    }

    fn body(&self, side: usize, curvature: [f64; 2]) -> Result<Body, String> {
        let material = of_side("material", &self.material, side)?;
        let file = material.map(|name| self::material("material", name));
        let file = file.transpose()?;
        let property = |name: &str, unit: &str| {
            let given = file.as_ref().and_then(|m| m.properties.get(name));
            given.and_then(|p| p.in_unit(unit).ok())
        };
        let elastic = |what: &str, given: &[String], unit: &str| {
            let own = of_side(what, given, side)?.map(|text| match unit {
                "Pa" => stress(what, text),
                _ => number(what, text, unit),
            });
            own.transpose()?
                .or(property(what, unit))
                .ok_or_else(|| match material {
                    Some(name) => format!("{what}: the material `{name}` has none; give it here"),
                    None => "material: name the materials of both bodies, such as wheel_steel_er7,rail_steel_r260, or give young and poisson".to_owned(),
                })
        };
        let young = elastic("young", &self.young, "Pa")?;
        let poisson = elastic("poisson", &self.poisson, "")?;
        if !(young > 0.0 && (0.0..=0.5).contains(&poisson)) {
            return Err(format!(
                "young and poisson: {young:e} Pa and {poisson} must be above zero and within 0 to 0.5"
            ));
        }
        let name = material.map_or_else(|| format!("body {}", side + 1), ToOwned::to_owned);
        let none = BTreeMap::new();
        let properties = file.as_ref().map_or(&none, |m| &m.properties);
        let mut strength = BodyStrength::of(&name, properties);
        if let Some(text) = of_side("hardness", &self.hardness, side)? {
            strength.hardness = Some(hardness(text)?);
        }
        Ok(Body {
            curvature,
            solid: Solid { young, poisson },
            strength,
        })
    }
}

/// Returns the hardness (Pa) of a text such as `260 HBW` or `2.5 GPa`.
fn hardness(text: &str) -> Result<f64, String> {
    let plain = text.trim();
    let digits = plain.find(|c: char| c == 'H' || c.is_whitespace());
    let (value, unit) = plain.split_at(digits.unwrap_or(plain.len()));
    let scaled = value.parse().ok().filter(|_| digits.is_some());
    let scaled = scaled.and_then(|v: f64| hardness_in_pascal(v, unit.trim()));
    match scaled {
        Some(pascal) if pascal > 0.0 => Ok(pascal),
        Some(_) => Err(format!("hardness: `{text}` must be above zero")),
        None if scale_of_hardness(unit).is_some() => Err(format!(
            "hardness: `{text}` is on a scale that is no pressure; give it in HBW or HV, or as a stress"
        )),
        None => stress("hardness", text),
    }
}

/// Returns the entry of a body in a list; a single entry is for both bodies.
fn of_side<'a>(what: &str, list: &'a [String], side: usize) -> Result<Option<&'a str>, String> {
    match list {
        [] => Ok(None),
        [both] => Ok(Some(both)),
        [_, _] => Ok(Some(&list[side])),
        _ => Err(format!(
            "{what}: {} values for two bodies; give one or two",
            list.len()
        )),
    }
}

/// Returns the curvatures (1/m) of the two bodies; with a single one the other body is a plane.
fn curvatures(what: &str, radii: &[String]) -> Result<[f64; 2], String> {
    let mut out = [0.0; 2];
    if radii.len() > 2 {
        return Err(format!("{what}: {} radii for two bodies", radii.len()));
    }
    for (curvature, text) in out.iter_mut().zip(radii) {
        if matches!(text.trim(), "flat" | "inf") {
            continue;
        }
        let radius = number(what, text, "m")?;
        if radius == 0.0 {
            return Err(format!(
                "{what}: a radius of zero; a plane is `flat`, and a comma stands between two radii: write 0.46m, not 0,46m"
            ));
        }
        *curvature = 1.0 / radius;
    }
    Ok(out)
}

/// Returns a material of a folder `materials` here or above, or of the program.
///
/// # Errors
/// There is none of this name, which begins with `what` it is, or its file is wrong.
pub(crate) fn material(what: &str, name: &str) -> Result<Material, String> {
    let library = MaterialLibrary::beside(Path::new("case.ron"));
    let source = library.read(name).map_err(|e| match e {
        Err(error) => error.to_string(),
        Ok(missing) => {
            let near = missing.nearest.as_ref();
            let near = near.map(|n| format!("; did you mean `{n}`?"));
            format!(
                "{what}: there is no file `{name}.ron` in {}{}; there are {}",
                missing.searched,
                near.unwrap_or_default(),
                missing.available
            )
        }
    })?;
    let material: Material = source.parse().map_err(|e| e.to_string())?;
    material
        .density()
        .map_err(|f| source.locate(f).to_string())?;
    Ok(material)
}
