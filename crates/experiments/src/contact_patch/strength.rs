//! Pressures at which the softer body yields.

use super::question::{self, Body, Question};
use super::{Contact, Friction};
use serde::Serialize;

/// Flow stress over hardness of a metal: its stress at the strain of some 8 % under an indenter (D.
/// Tabor, The Hardness of Metals, 1951). A metal that hardens yields below it.
const HARDNESS_OVER_FLOW: f64 = 2.8;

/// Largest pressures that the body which yields first can carry.
#[derive(Clone, Debug, Serialize)]
pub struct Strength {
    /// Yield stress (Pa), or the flow stress where none is given.
    pub yield_stress: f64,
    /// Whether it is the flow stress from the hardness, H/2.8, which is above the yield stress.
    pub estimated: bool,
    /// The body; `None` where the question gives the yield stress.
    pub body: Option<String>,
    /// Source of the yield stress in the file of the material: whether it is monotonic or of a
    /// hardened steel.
    pub source: Option<String>,
    /// Largest pressure at which nothing yields (Pa): 1.6 Y of a point, 1.79 Y of a line (Johnson,
    /// 6.2).
    pub first_yield: f64,
    /// Largest pressure to which the steel shakes down elastically in rolling (Pa), with k =
    /// Y/sqrt(3): 4 k of a line without friction, 4.7 k of a point, and k/mu of full slip (Johnson,
    /// 9.2).
    pub shakedown: f64,
    /// Hardness (Pa) of the softer body.
    pub hardness: Option<f64>,
}

impl Strength {
    pub(super) fn of(
        question: &Question,
        contact: &Contact,
        friction: Option<&Friction>,
    ) -> Result<Option<Self>, String> {
        let given = question.yield_stress.as_ref();
        let given = given.map(|text| question::positive("yield_stress", text, "Pa"));
        let of_body = |body: &Body| {
            let flow = body.hardness.map(|h| h / HARDNESS_OVER_FLOW);
            Some(Self {
                yield_stress: body.yield_stress.or(flow)?,
                estimated: body.yield_stress.is_none(),
                body: Some(body.name.clone()),
                source: body.yield_source.clone(),
                first_yield: 0.0,
                shakedown: 0.0,
                hardness: None,
            })
        };
        let softest = match given.transpose()? {
            Some(yield_stress) => Some(Self {
                yield_stress,
                estimated: false,
                body: None,
                source: None,
                first_yield: 0.0,
                shakedown: 0.0,
                hardness: None,
            }),
            None => contact
                .bodies
                .iter()
                .filter_map(of_body)
                .min_by(|a, b| a.yield_stress.total_cmp(&b.yield_stress)),
        };
        let (first, frictionless): (f64, f64) = match contact.is_line() {
            true => (1.79, 4.0),
            false => (1.6, 4.7),
        };
        let factor = friction.map_or(frictionless, |f| {
            frictionless.min(1.0 / f.coefficient.value)
        });
        let hardness = contact.bodies.iter().filter_map(|b| b.hardness);
        let hardness = hardness.reduce(f64::min);
        Ok(softest.map(|s| Self {
            first_yield: first * s.yield_stress,
            shakedown: factor * s.yield_stress / 3.0f64.sqrt(),
            hardness,
            ..s
        }))
    }

    /// Returns what the stress is, and whose: `yield stress of rail_steel_r260`.
    pub(super) fn name(&self) -> String {
        let what = match self.estimated {
            true => "flow stress, hardness/2.8,",
            false => "yield stress",
        };
        match &self.body {
            Some(body) => format!("{what} of {body}"),
            None => what.to_owned(),
        }
    }
}
