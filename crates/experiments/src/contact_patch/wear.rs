//! Wear of rolling bodies: Archard's law with K and the hardness of each body, and the map over T
//! gamma/A.

use super::question::Question;
use super::regime::WearRegime;
use super::runs::{self, WindowRun};
use super::{Contact, Friction, Rolling, Theory};
use crate::amounts::{self, Range};
use fretwork_core::laws::{Kind, Plugin, SearchPath};
use serde::Serialize;

/// Wear while rolling with a creepage.
#[derive(Clone, Debug, Serialize)]
pub struct Wear {
    /// Wear of each body with a hardness by Archard's law.
    pub archard: Vec<BodyWear>,
    /// Wear by the map of the law `t-gamma`; `None` for a line contact, which has no area.
    pub energy_map: Option<EnergyMap>,
    /// Wear of each first body of the runs that give the friction coefficient, by its specific wear
    /// rate in these runs.
    pub window: Vec<WindowWear>,
    /// Regime by slip speed and pressure; `None` without a speed or a hardness.
    pub regime: Option<WearRegime>,
}

/// Wear of the patch by the specific wear rate of a first body of a window.
#[derive(Clone, Debug, Serialize)]
pub struct WindowWear {
    /// Name of the body in the case.
    pub body: String,
    /// Specific wear rate (m³/(N m)), volume over load times slip of the window.
    pub specific_rate: Range,
    /// Volume per metre rolled (m³/m; m³/m² for a line).
    pub volume: Range,
    /// Depth (m) by which a point wears as it passes the patch, as a mean over the width of the
    /// patch.
    pub depth_per_passage: Range,
}

/// Wear of a body by Archard's law.
#[derive(Clone, Debug, Serialize)]
pub struct BodyWear {
    /// Name of the body.
    pub body: String,
    /// Coefficient k = K/H (1/Pa).
    pub coefficient: Range,
    /// Volume per metre rolled (m³/m; m³/m² for a line).
    pub volume: Range,
    /// Depth (m) per metre rolled, for a rolling body, as a mean over the width of the patch.
    pub depth_per_metre: Option<Range>,
    /// Depth (m) per passage, for a straight body, as a mean over the width of the patch.
    pub depth_per_passage: Option<Range>,
}

/// Pair of steels on which the map was measured.
pub(super) const MEASURED_ON: &str = "R8T wheel on 900A (now R260) rail steel, dry twin disks";

/// Hardnesses of 900A rail steel, as R260 in EN 13674-1 (Pa).
const RAIL: [f64; 2] = [260.0 * HBW, 300.0 * HBW];
const HBW: f64 = 9.806_65e6;

/// Wear by the map over T gamma/A.
#[derive(Clone, Debug, Serialize)]
pub struct EnergyMap {
    /// Pair of steels on which the map was measured.
    pub measured_on: &'static str,
    /// Whether the hardness of the rail is that of the steel of the map; `None` without a hardness.
    pub same_rail: Option<bool>,
    /// T gamma/A (Pa).
    pub energy_per_area: Range,
    /// Regime at the middle of the interval: `mild`, `severe` or `catastrophic`.
    pub regime: &'static str,
    /// Mass per rolled length and area (kg/m³).
    pub mass_per_area: Range,
    /// Volume per metre rolled (m³/m).
    pub volume: Range,
}

impl Wear {
    pub(super) fn of(
        question: &Question,
        contact: &Contact,
        rolling: Option<&Rolling>,
        friction: Option<&Friction>,
        runs: &[WindowRun],
        laws: &SearchPath,
    ) -> Result<Option<Self>, String> {
        let given = question.wear.as_ref();
        let k = given.map(|t| coefficient(t, contact)).transpose()?;
        let energy = rolling.and_then(|r| r.energy);
        let (Some(energy), Some(friction)) = (energy, friction) else {
            return match k {
                Some(_) => {
                    Err("wear: the rate needs what slips; give friction and creepage".into())
                }
                None => Ok(None),
            };
        };
        // Within the interval of the friction coefficient, energy over coefficient is the load
        // times the slip.
        let slipped = Range {
            low: energy.high / friction.coefficient.high,
            value: energy.value / friction.coefficient.value,
            high: energy.low / friction.coefficient.low,
        };
        let archard = k
            .map(|k| archard(contact, &k, &slipped))
            .unwrap_or_default();
        let map = match &contact.theory {
            Theory::Point(point) => Some(EnergyMap {
                same_rail: rail(contact).strength.hardness.map(is_of_map),
                ..EnergyMap::of(&energy, point.area(), laws)?
            }),
            Theory::Line(_) => None,
        };
        let window = carried_over(contact, runs, &slipped);
        let regime = rolling.and_then(|r| WearRegime::of(contact, r));
        let any = !archard.is_empty() || map.is_some() || !window.is_empty() || regime.is_some();
        Ok(any.then_some(Self {
            archard,
            energy_map: map,
            window,
            regime,
        }))
    }
}

/// Returns Archard's K of a text.
///
/// # Errors
/// It is none, see [`amounts::archard`].
fn coefficient(text: &str, contact: &Contact) -> Result<Range, String> {
    let hardness = contact.bodies.iter().filter_map(|b| b.strength.hardness);
    amounts::archard("wear", text, hardness.reduce(f64::min), "")
}

/// The specific wear rates of a window times load and slip of the patch.
fn carried_over(contact: &Contact, runs: &[WindowRun], slipped: &Range) -> Vec<WindowWear> {
    let of = |(body, specific_rate): (String, Range)| {
        let volume = Range::of(&specific_rate, slipped, |k, s| k * s);
        WindowWear {
            body,
            specific_rate,
            volume,
            depth_per_passage: volume.map(|v| v / width(contact)),
        }
    };
    runs::wear_rates(runs).into_iter().map(of).collect()
}

/// Returns the width of the patch perpendicular to the motion (m); 1 for a line, whose rates are
/// per metre.
fn width(contact: &Contact) -> f64 {
    match &contact.theory {
        Theory::Line(_) => 1.0,
        Theory::Point(point) => 2.0 * point.across,
    }
}

/// Returns V = K/H times load and slip, for each body with its own hardness.
fn archard(contact: &Contact, k: &Range, slipped: &Range) -> Vec<BodyWear> {
    let of = |body: &super::Body| {
        let hardness = body.strength.hardness?;
        let coefficient = k.map(|k| k / hardness);
        let volume = Range::of(&coefficient, slipped, |k, s| k * s);
        let depth = volume.map(|v| v / width(contact));
        let curvature = body.curvature[0];
        let round = std::f64::consts::TAU / curvature;
        Some(BodyWear {
            body: body.strength.name.clone(),
            coefficient,
            volume,
            depth_per_metre: (curvature > 0.0).then(|| depth.map(|d| d / round)),
            depth_per_passage: (curvature == 0.0).then_some(depth),
        })
    };
    contact.bodies.iter().filter_map(of).collect()
}

/// Returns the rail: the straight body, or the second of two that roll.
pub(super) fn rail(contact: &Contact) -> &super::Body {
    let straight = contact.bodies.iter().find(|b| b.curvature[0] == 0.0);
    straight.unwrap_or(&contact.bodies[1])
}

/// Returns whether a hardness (Pa) is that of the rail steel of the map.
fn is_of_map(hardness: f64) -> bool {
    let [low, high] = RAIL;
    hardness > low * (1.0 - 1e-9) && hardness < high * (1.0 + 1e-9)
}

impl EnergyMap {
    /// Evaluates the map of the shipped law, with its default parameters, at an energy per metre
    /// (J/m).
    fn of(energy: &Range, area: f64, laws: &SearchPath) -> Result<Self, String> {
        let plugin = laws.find(Kind::WEAR, "t-gamma");
        let plugin = plugin.map_err(|e| e.to_string())?;
        let map = Map::of(&plugin).ok_or("the wear law t-gamma has other parameters")?;
        let density = map.density;
        let per_area = energy.map(|e| e / area);
        let mass = per_area.map(|x| map.mass(x));
        Ok(Self {
            measured_on: MEASURED_ON,
            same_rail: None,
            energy_per_area: per_area,
            regime: map.regime(per_area.value),
            mass_per_area: mass,
            volume: mass.map(|m| m * area / density),
        })
    }
}

/// Parameters of the map; see `fretwork law show t-gamma`.
struct Map {
    density: f64,
    mild: f64,
    severe: f64,
    catastrophic: f64,
    catastrophic_start: f64,
    mild_end: f64,
    severe_end: f64,
}

impl Map {
    fn of(plugin: &Plugin) -> Option<Self> {
        let default = |name: &str| {
            let found = plugin.parameters.iter().find(|p| p.name == name)?;
            Some(found.default)
        };
        Some(Self {
            density: default("density")?,
            mild: default("mild")?,
            severe: default("severe")?,
            catastrophic: default("catastrophic")?,
            catastrophic_start: default("catastrophic_start")?,
            mild_end: default("mild_end")?,
            severe_end: default("severe_end")?,
        })
    }

    fn regime(&self, x: f64) -> &'static str {
        match x {
            x if x < self.mild_end => "mild",
            x if x <= self.severe_end => "severe",
            _ => "catastrophic",
        }
    }

    /// Returns the mass per rolled length and area (kg/m³).
    fn mass(&self, x: f64) -> f64 {
        match self.regime(x) {
            "mild" => self.mild * x,
            "severe" => self.severe,
            _ => self.catastrophic_start + self.catastrophic * (x - self.severe_end),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fretwork_core::laws::BuiltInLaws;

    /// The regimes follow by hand, in N/mm² and ug/(m mm²), from R. Lewis, R. S. Dwyer-Joyce, Proc.
    /// IMechE J 218 (2004) 467-478.
    #[test]
    fn the_map_is_that_of_the_law() {
        let shipped = BuiltInLaws::new(fretwork_laws::plugins());
        let laws = SearchPath::new(&[]).with_built_in(shipped);
        for (x, regime, mass) in [
            (5.0, "mild", 26.5),
            (20.0, "severe", 55.0),
            (100.0, "catastrophic", 55.0 + 61.9 * 22.8),
        ] {
            // The area is 100 mm².
            let map = EnergyMap::of(&Range::certain(x * 100.0), 1e-4, &laws).unwrap();
            assert_eq!(map.regime, regime);
            assert!((map.mass_per_area.value * 1e3 / mass - 1.0).abs() < 1e-12);
            assert!((map.volume.value / (mass * 100.0 * 1e-9 / 7850.0) - 1.0).abs() < 1e-12);
        }
    }
}
