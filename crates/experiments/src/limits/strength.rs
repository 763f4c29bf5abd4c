//! Pressures at which the softer body yields, at first and once it has hardened.

use fretwork_observe::quantity::{number, quantity};
use fretwork_scene::material::Sourced;
use fretwork_scene::quantity::hardness_in_pascal;
use serde::Serialize;
use std::collections::BTreeMap;

/// Flow stress over hardness of a metal: its stress at the strain of some 8 % under an indenter (D.
/// Tabor, The Hardness of Metals, 1951). A metal that hardens yields below it.
const HARDNESS_OVER_FLOW: f64 = 2.8;

/// What is known of the strength of a body.
#[derive(Clone, Debug, PartialEq)]
pub struct BodyStrength {
    /// Name of its material, or a name for it without one.
    pub name: String,
    /// Hardness (Pa).
    pub hardness: Option<f64>,
    /// Yield stress (Pa) before it is deformed, with its source.
    pub yield_stress: Option<(f64, String)>,
    /// Yield stress (Pa) once service has hardened it, with its source.
    pub yield_stress_hardened: Option<(f64, String)>,
}

impl BodyStrength {
    /// Returns what the properties of a material say.
    pub fn of(name: &str, properties: &BTreeMap<String, Sourced>) -> Self {
        let sourced = |property: &str| {
            let given = properties.get(property)?;
            Some((given.in_unit("Pa").ok()?, given.source.clone()))
        };
        let hardness = properties.get("hardness");
        Self {
            name: name.to_owned(),
            hardness: hardness.and_then(|h| hardness_in_pascal(h.value, &h.unit)),
            yield_stress: sourced("yield_stress"),
            yield_stress_hardened: sourced("yield_stress_hardened"),
        }
    }
}

/// What a yield stress is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum YieldKind {
    /// Of the question.
    Given,
    /// Of steel that has not been deformed, from the file of its material.
    Monotonic,
    /// Of steel that service has hardened, from the file of its material.
    Hardened,
    /// The flow stress, hardness over 2.8, which is above the yield stress of undeformed steel.
    Flow,
}

/// A yield stress with its origin.
#[derive(Clone, Debug, Serialize)]
pub struct Yield {
    /// Yield stress, or flow stress (Pa).
    pub yield_stress: f64,
    /// What it is.
    pub kind: YieldKind,
    /// The body; `None` where the question gives the yield stress.
    pub body: Option<String>,
    /// Source in the file of the material.
    pub source: Option<String>,
}

impl Yield {
    /// Returns the yield stress of a body that has not been deformed; `None` without a yield stress
    /// and a hardness.
    fn at_first(body: &BodyStrength) -> Option<Self> {
        let flow = || {
            let hardness = body.hardness?;
            Some((YieldKind::Flow, hardness / HARDNESS_OVER_FLOW, None))
        };
        let own = body.yield_stress.clone();
        let own = own.map(|(stress, source)| (YieldKind::Monotonic, stress, Some(source)));
        let (kind, yield_stress, source) = own.or_else(flow)?;
        Some(Self {
            yield_stress,
            kind,
            body: Some(body.name.clone()),
            source,
        })
    }

    /// Returns the yield stress of a body in service, that at first where its file has no other.
    fn in_service(body: &BodyStrength) -> Option<Self> {
        let Some((yield_stress, source)) = body.yield_stress_hardened.clone() else {
            return Self::at_first(body);
        };
        Some(Self {
            yield_stress,
            kind: YieldKind::Hardened,
            body: Some(body.name.clone()),
            source: Some(source),
        })
    }

    /// Returns what the stress is, and whose: `yield stress of rail_steel_r260`.
    pub fn name(&self) -> String {
        let what = match self.kind {
            YieldKind::Flow => "flow stress, hardness/2.8,",
            YieldKind::Hardened => "yield stress, hardened,",
            YieldKind::Given | YieldKind::Monotonic => "yield stress",
        };
        match &self.body {
            Some(body) => format!("{what} of {body}"),
            None => what.to_owned(),
        }
    }
}

/// Tangential force over load by which the shakedown limit is lowered.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Traction {
    /// Q/P.
    pub ratio: f64,
    /// Whether it is that of the creepage, force or displacement of the question, and not the
    /// friction coefficient, which is that of full slip.
    pub asked: bool,
}

/// Largest pressures that the body which yields first can carry.
#[derive(Clone, Debug, Serialize)]
pub struct Strength {
    /// Yield stress of the body that yields first, before it hardens.
    #[serde(flatten)]
    pub first: Yield,
    /// Largest pressure at which nothing yields (Pa): 1.6 Y of a point, 1.79 Y of a line (Johnson,
    /// 6.2).
    pub first_yield: f64,
    /// Yield stress of the body that limits shakedown, hardened where its file says so.
    pub in_service: Yield,
    /// Largest pressure to which the steel shakes down elastically in free rolling (Pa), with k =
    /// Y/sqrt(3): 4 k of a line, 4.7 k of a point (Johnson, 9.2).
    pub shakedown_rolling: f64,
    /// The same under the tangential force (Pa), at most k P/Q: k/mu in full slip.
    pub shakedown: f64,
    /// The tangential force; `None` without a friction coefficient.
    pub traction: Option<Traction>,
    /// Hardness (Pa) of the softer body.
    pub hardness: Option<f64>,
    /// That body.
    pub softer: Option<String>,
}

impl Strength {
    /// Returns the strength of two bodies in a contact along a line or about a point; `given` is a
    /// yield stress (Pa) in place of theirs, `traction` the tangential force. `None` where nothing
    /// is known of either.
    pub fn of(
        bodies: [&BodyStrength; 2],
        is_line: bool,
        given: Option<f64>,
        traction: Option<Traction>,
    ) -> Option<Self> {
        let given = given.map(|yield_stress| Yield {
            yield_stress,
            kind: YieldKind::Given,
            body: None,
            source: None,
        });
        let least = |of: fn(&BodyStrength) -> Option<Yield>| {
            let all = bodies.iter().filter_map(|body| of(body));
            let least = all.min_by(|a, b| a.yield_stress.total_cmp(&b.yield_stress));
            given.clone().or(least)
        };
        let (first, in_service) = least(Yield::at_first).zip(least(Yield::in_service))?;
        let (first_factor, rolling_factor) = match is_line {
            true => (1.79, 4.0),
            false => (1.6, 4.7),
        };
        let factor = traction.map_or(rolling_factor, |t| (1.0 / t.ratio).min(rolling_factor));
        let hard = bodies
            .iter()
            .filter_map(|b| Some((b.hardness?, b.name.clone())));
        let (hardness, softer) = hard.min_by(|a, b| a.0.total_cmp(&b.0)).unzip();
        let shear = in_service.yield_stress / 3.0f64.sqrt();
        Some(Self {
            first_yield: first_factor * first.yield_stress,
            first,
            shakedown_rolling: rolling_factor * shear,
            shakedown: factor * shear,
            in_service,
            traction,
            hardness,
            softer,
        })
    }

    /// Returns a sentence where a pressure (Pa) is above the hardness.
    pub fn indents(&self, pressure: f64) -> Option<String> {
        let hardness = self.hardness.filter(|h| pressure > *h)?;
        Some(format!(
            "NOT ELASTIC: {} is above the hardness of {}, {}; that body is indented, and the pressure is about its hardness",
            quantity(pressure, "Pa"),
            self.softer.as_deref().unwrap_or("the softer body"),
            quantity(hardness, "Pa")
        ))
    }

    /// Returns a sentence where a pressure (Pa) makes the steel yield, at first or in each passage.
    pub fn yields(&self, pressure: f64) -> Option<String> {
        let pascal = |p: f64| quantity(p, "Pa");
        let p = pascal(pressure);
        let with = |of: &Yield| format!("with {} as {}", pascal(of.yield_stress), of.name());
        if pressure > self.shakedown {
            let traction = self
                .traction
                .filter(|_| self.shakedown < self.shakedown_rolling);
            let at = match traction {
                Some(t) if t.asked => format!(" at Q/P {}", number(t.ratio, 3)),
                Some(_) => format!(
                    " in full slip ({} in free rolling; give creepage or force for that at your Q/P)",
                    pascal(self.shakedown_rolling)
                ),
                None => String::new(),
            };
            let hardens = match self.in_service.kind {
                YieldKind::Hardened => ", although it has hardened",
                YieldKind::Monotonic => {
                    "; that is of steel not yet deformed, and hardening in service may raise the limit (its file has no yield_stress_hardened)"
                }
                YieldKind::Flow => ", and it yields below that",
                YieldKind::Given => "",
            };
            return Some(format!(
                "BEYOND SHAKEDOWN: {p} is above {}{at}; {} the surface deforms plastically in every passage{hardens}",
                pascal(self.shakedown),
                with(&self.in_service)
            ));
        }
        (pressure > self.first_yield).then(|| format!(
            "YIELDS AT FIRST: {p} is above {}; {} it flows until residual stresses and hardening make it elastic, over a slightly larger patch",
            pascal(self.first_yield),
            with(&self.first)
        ))
    }
}
