//! Slip of the patch under a tangential force or displacement, and in the window of a third body.

use super::question::Question;
use super::{Contact, Friction, Rolling, Theory};
use crate::amounts::{Range, number, positive};
use fretwork_elastic::patch::{PartialSlip, stuck_strip};
use fretwork_observe::quantity::unit::FORCE;
use serde::Serialize;

/// Partial and gross slip of bodies that do not roll.
#[derive(Clone, Debug, Serialize)]
pub struct Tangential {
    /// Force at which gross slip begins (N; N/m), mu P.
    pub slip_force: Range,
    /// Displacement of distant points at the onset of gross slip (m); for a line it depends on the
    /// form of the bodies at a distance.
    pub slip_displacement: Option<Range>,
    /// Ratio Q/(mu P) under the requested force or displacement, 1 in gross slip.
    pub share: Option<Range>,
    /// Ratio of the semi-axis of the stick area to that of the patch; 0 in gross slip.
    pub stuck: Option<Range>,
    /// Amplitude of the slip in the middle of the patch (m), under the requested displacement: 0 in
    /// partial slip.
    pub local_slip: Option<Range>,
}

impl Tangential {
    pub(super) fn of(
        question: &Question,
        contact: &Contact,
        friction: Option<&Friction>,
    ) -> Result<Option<Self>, String> {
        let requested = question.force.is_some() || question.displacement.is_some();
        let Some(friction) = friction else {
            return match requested {
                true => Err("force, displacement: where slip begins needs the friction coefficient; give friction".into()),
                false => Ok(None),
            };
        };
        if question.force.is_some() && question.displacement.is_some() {
            return Err("force, displacement: one follows from the other; give one of them".into());
        }
        let (load, mu) = (contact.load, friction.coefficient);
        let solids = contact.solids();
        let unit = FORCE.symbol(if contact.is_line() { 2 } else { 3 });
        let force = question.force.as_ref();
        let force = force.map(|t| number("force", t, unit)).transpose()?;
        let moved = question.displacement.as_ref();
        let moved = moved
            .map(|t| positive("displacement", t, "m"))
            .transpose()?;
        let mut out = Self {
            slip_force: mu.map(|mu| mu * load),
            slip_displacement: None,
            share: None,
            stuck: None,
            local_slip: None,
        };
        match &contact.theory {
            Theory::Line(_) => {
                if moved.is_some() {
                    return Err("displacement: that of a line contact depends on the form of the bodies at a distance; give force, or a load as a force for a point contact".into());
                }
                if let Some(q) = force {
                    let share = mu.map(|mu| (q.abs() / (mu * load)).min(1.0));
                    out.share = Some(share);
                    out.stuck = Some(share.map(stuck_strip));
                }
            }
            Theory::Point(point) => {
                let slip = |mu| PartialSlip::of(point, load, mu, &solids);
                out.slip_displacement = Some(mu.map(|mu| slip(mu).displacement));
                let under = |mu: f64| {
                    let q = moved.map_or(force.unwrap_or(0.0), |d| slip(mu).force_at(d));
                    q.abs().min(mu * load)
                };
                if requested {
                    out.share = Some(mu.map(|mu| under(mu) / (mu * load)));
                    out.stuck = Some(mu.map(|mu| slip(mu).stuck(under(mu))));
                }
                out.local_slip = moved.map(|d| mu.map(|mu| (d - slip(mu).displacement).max(0.0)));
            }
        }
        Ok(Some(out))
    }
}

/// A window of a third body in the middle of the patch: periodic along the motion, under the
/// largest pressure.
#[derive(Clone, Debug, Serialize)]
pub struct Window {
    /// Width along the motion (m).
    pub width: f64,
    /// Pressure (Pa).
    pub pressure: f64,
    /// Load in two dimensions (N/m): pressure times width.
    pub load: f64,
    /// Relative difference of the pressure at its edges from that in the middle.
    pub pressure_drop: f64,
    /// Increase of the gap of the undeformed bodies from the middle to its edges (m).
    pub gap: f64,
    /// Slip (m): the amplitude in fretting, or the slip of one passage in rolling; `None` where
    /// neither was requested.
    pub slip: Option<Range>,
}

impl Window {
    pub(super) fn of(
        question: &Question,
        contact: &Contact,
        rolling: Option<&Rolling>,
        tangential: Option<&Tangential>,
    ) -> Result<Self, String> {
        let a = contact.semi_axis();
        let width = match &question.window {
            Some(text) => positive("window", text, "m")?,
            None => a / 25.0,
        };
        if width > 2.0 * a {
            return Err(format!(
                "window: {width:e} m is wider than the patch, {:e} m",
                2.0 * a
            ));
        }
        let pressure = contact.pressure();
        let fretting = tangential.and_then(|t| t.local_slip);
        Ok(Self {
            width,
            pressure,
            load: pressure * width,
            pressure_drop: 1.0 - (1.0 - (width / (2.0 * a)).powi(2)).sqrt(),
            gap: contact.curvature[0] * width * width / 8.0,
            slip: fretting.or_else(|| rolling.and_then(|r| r.slip_distance)),
        })
    }
}
