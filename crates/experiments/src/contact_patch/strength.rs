//! Pressures at which the softer body yields, at first and once it has hardened.

use super::question::{self, Body, Question};
use super::{Contact, Friction, Rolling, Tangential};
use serde::Serialize;

/// Flow stress over hardness of a metal: its stress at the strain of some 8 % under an indenter (D.
/// Tabor, The Hardness of Metals, 1951). A metal that hardens yields below it.
const HARDNESS_OVER_FLOW: f64 = 2.8;

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
    fn at_first(body: &Body) -> Option<Self> {
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
    fn in_service(body: &Body) -> Option<Self> {
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
    pub(super) fn name(&self) -> String {
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

impl Traction {
    fn of(
        friction: Option<&Friction>,
        tangential: Option<&Tangential>,
        rolling: Option<&Rolling>,
    ) -> Option<Self> {
        let mu = friction?.coefficient.value;
        let rolls = rolling.and_then(|r| r.adhesion).map(|a| a.value);
        let share = tangential.and_then(|t| t.share).map(|s| s.value * mu);
        let asked = rolls.or(share);
        Some(Self {
            ratio: asked.unwrap_or(mu),
            asked: asked.is_some(),
        })
    }
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
}

impl Strength {
    pub(super) fn of(
        question: &Question,
        contact: &Contact,
        friction: Option<&Friction>,
        tangential: Option<&Tangential>,
        rolling: Option<&Rolling>,
    ) -> Result<Option<Self>, String> {
        let given = question.yield_stress.as_ref();
        let given = given.map(|text| question::stress("yield_stress", text));
        let given = given.transpose()?.map(|yield_stress| Yield {
            yield_stress,
            kind: YieldKind::Given,
            body: None,
            source: None,
        });
        let least = |of: fn(&Body) -> Option<Yield>| {
            let all = contact.bodies.iter().filter_map(of);
            let least = all.min_by(|a, b| a.yield_stress.total_cmp(&b.yield_stress));
            given.clone().or(least)
        };
        let pair = least(Yield::at_first).zip(least(Yield::in_service));
        let (first_factor, rolling_factor) = match contact.is_line() {
            true => (1.79, 4.0),
            false => (1.6, 4.7),
        };
        let traction = Traction::of(friction, tangential, rolling);
        let factor = traction.map_or(rolling_factor, |t| (1.0 / t.ratio).min(rolling_factor));
        let hardness = contact.bodies.iter().filter_map(|b| b.hardness);
        let hardness = hardness.reduce(f64::min);
        Ok(pair.map(|(first, in_service)| {
            let shear = in_service.yield_stress / 3.0f64.sqrt();
            Self {
                first_yield: first_factor * first.yield_stress,
                first,
                shakedown_rolling: rolling_factor * shear,
                shakedown: factor * shear,
                in_service,
                traction,
                hardness,
            }
        }))
    }
}
