//! Rolling with a longitudinal creepage: by Carter for a line, by cells for an ellipse.

use super::question::Question;
use super::{Contact, Friction, Theory};
use crate::amounts::{Range, number, positive};
use fretwork_elastic::Elasticity;
use fretwork_elastic::patch::{StripCreep, like_bodies};
use fretwork_rolling::Creep;
use serde::Serialize;

/// Largest ratio of the semi-axes for cells.
const LONGEST: f64 = 20.0;

/// Rolling with a longitudinal creepage.
#[derive(Clone, Debug, Serialize)]
pub struct Rolling {
    /// Creepage above which the whole patch slips.
    pub saturation: Range,
    /// Requested creepage.
    pub creepage: Option<f64>,
    /// Tangential force over load at this creepage.
    pub adhesion: Option<Range>,
    /// Tangential force (N; N/m).
    pub force: Option<Range>,
    /// Work of friction per metre rolled (J/m; J/m²): force times creepage, T gamma.
    pub energy: Option<Range>,
    /// Slip velocity (m/s), as a mean weighted by the pressure.
    pub slip_speed: Option<Range>,
    /// Slip of a point as it passes the patch (m), as a mean weighted by the pressure.
    pub slip_distance: Option<Range>,
    /// Relative error of the adhesion by the cells, which its interval includes; 0 for a line.
    pub grid: Option<f64>,
}

impl Rolling {
    pub(super) fn of(
        question: &Question,
        contact: &Contact,
        friction: Option<&Friction>,
    ) -> Result<Option<Self>, String> {
        if question.creepage.is_some() && question.displacement.is_some() {
            return Err("creepage, displacement: one is of rolling, the other of fretting; give one of them".into());
        }
        let requested = question.creepage.is_some() || question.speed.is_some();
        let Some(friction) = friction else {
            return match requested {
                true => Err(
                    "creepage, speed: rolling needs the friction coefficient; give friction".into(),
                ),
                false => Ok(None),
            };
        };
        let (load, mu) = (contact.load, friction.coefficient);
        let creepage = question.creepage.as_ref();
        let creepage = creepage.map(|t| number("creepage", t, "")).transpose()?;
        if let Some(xi) = creepage.filter(|xi| !(xi.abs() > 0.0 && xi.abs() < 1.0)) {
            return Err(format!(
                "creepage: {xi} is no share between 0 and 1; in per cent write {xi} %"
            ));
        }
        let speed = question.speed.as_ref();
        let speed = speed.map(|t| positive("speed", t, "m/s")).transpose()?;
        let Some(curve) = Curve::of(contact) else {
            return match requested {
                true => Err("creepage: the patch is more than twenty times as long in one direction as in the other, too long for a grid; give the load per length for a line contact".into()),
                false => Ok(None),
            };
        };
        let saturation = curve.saturation()?;
        let xi = creepage.map(f64::abs);
        let share = xi.map(|xi| curve.shares(mu, xi)).transpose()?;
        let adhesion = share.map(|share| share.of(mu));
        let slip = share
            .zip(xi)
            .map(|(share, xi)| share.of(Range::certain(xi)));
        Ok(Some(Self {
            saturation: mu.map(|mu| mu * saturation),
            creepage,
            adhesion,
            force: adhesion.map(|a| a.map(|a| a * load)),
            energy: adhesion.zip(xi).map(|(a, xi)| a.map(|a| a * load * xi)),
            slip_speed: slip.zip(speed).map(|(s, v)| s.map(|s| s * v)),
            slip_distance: slip.map(|s| s.map(|s| s * 2.0 * contact.semi_axis())),
            grid: share.map(|share| share.error),
        }))
    }
}

/// Q/(mu P) of a contact over its creepage.
enum Curve {
    /// Carter's strip.
    Line(StripCreep),
    /// An ellipse, by cells.
    Point(Creep),
}

/// Shares Q/(mu P) at the ends of a range of mu and at its value.
#[derive(Clone, Copy)]
struct Shares {
    at: [f64; 3],
    /// Largest error of the grid.
    error: f64,
}

impl Shares {
    /// Returns shares times the numbers of a range, with the error of the grid.
    fn of(&self, factors: Range) -> Range {
        let [low, value, high] = self.at;
        let ends = [low * factors.low, high * factors.high];
        Range {
            low: ends[0].min(ends[1]) * (1.0 - self.error),
            value: value * factors.value,
            high: ends[0].max(ends[1]) * (1.0 + self.error),
        }
    }
}

impl Curve {
    /// Returns that of a contact; `None` for an ellipse that is too long for a grid.
    fn of(contact: &Contact) -> Option<Self> {
        let point = match &contact.theory {
            Theory::Line(line) => {
                return Some(Self::Line(StripCreep::new(line, contact.curvature[0])));
            }
            Theory::Point(point) => point,
        };
        let ratio = point.along / point.across;
        let like = like_bodies(&contact.solids());
        let body = Elasticity {
            young: like.young,
            poisson: like.poisson,
            density: 0.0,
        };
        let creep = || Creep::new(body, contact.curvature, contact.load);
        (1.0 / LONGEST..=LONGEST)
            .contains(&ratio)
            .then(creep)
            .map(Self::Point)
    }

    /// Returns the creepage over mu above which the whole patch slips.
    fn saturation(&self) -> Result<f64, String> {
        match self {
            Self::Line(strip) => Ok(strip.saturation),
            Self::Point(creep) => creep.saturation().map_err(|e| format!("rolling: {e}")),
        }
    }

    fn shares(&self, mu: Range, xi: f64) -> Result<Shares, String> {
        let of = |mu: f64| match self {
            Self::Line(strip) => Ok((strip.share(xi / mu), 0.0)),
            Self::Point(creep) => {
                let share = creep.share(xi / mu).map_err(|e| format!("creepage: {e}"))?;
                Ok::<_, String>((share.value, share.error / share.value))
            }
        };
        let value = of(mu.value)?;
        let [low, high] = match mu.is_wide() {
            true => [of(mu.low)?, of(mu.high)?],
            false => [value; 2],
        };
        Ok(Shares {
            at: [low.0, value.0, high.0],
            error: low.1.max(value.1).max(high.1),
        })
    }
}
