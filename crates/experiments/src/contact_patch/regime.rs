//! Regimes of wear of wheel and rail steels over slip speed and pressure.

use super::{Contact, Rolling};
use crate::amounts::Range;
use serde::Serialize;

/// Slip speeds between which wear is severe (m/s).
const SEVERE: [f64; 2] = [0.2, 0.7];
/// Pressure over hardness above which the surfaces seize.
const SEIZURE: f64 = 0.8;

/// Archard's K in each regime.
const COEFFICIENTS: [(&str, [f64; 2]); 3] = [
    ("mild", [1e-4, 1e-3]),
    ("severe", [3e-3, 4e-3]),
    ("seizure", [3e-2, 4e-2]),
];

/// Regime of wear by the chart of T. Jendel (Prediction of wheel profile wear - comparisons with
/// field measurements, Wear 253 (2002) 89-99; first in TRITA-FKT 2000:49, KTH Stockholm), of dry
/// wheel and rail steels: mild below 0.2 and above 0.7 m/s of slip, severe between, seizure above
/// 0.8 of the hardness of the softer body.
#[derive(Clone, Debug, Serialize)]
pub struct WearRegime {
    /// Regimes within the interval of the slip speed: `mild`, `severe`, `seizure`.
    pub regimes: Vec<&'static str>,
    /// Slip speed (m/s).
    pub slip_speed: Range,
    /// Largest pressure over the hardness of the softer body.
    pub pressure_over_hardness: f64,
    /// Range of Archard's K in the chart.
    pub coefficient: [f64; 2],
}

impl WearRegime {
    /// The regime of a patch that rolls; `None` without a speed or a hardness.
    pub(super) fn of(contact: &Contact, rolling: &Rolling) -> Option<Self> {
        let hardness = contact.bodies.iter().filter_map(|b| b.strength.hardness);
        let hardness = hardness.reduce(f64::min)?;
        Some(Self::at(rolling.slip_speed?, contact.pressure() / hardness))
    }

    fn at(slip_speed: Range, pressure_over_hardness: f64) -> Self {
        let [from, to] = SEVERE;
        let severe = slip_speed.high >= from && slip_speed.low <= to;
        let mild = slip_speed.low < from || slip_speed.high > to;
        let within = |name: &str| match name {
            "seizure" => pressure_over_hardness > SEIZURE,
            _ if pressure_over_hardness > SEIZURE => false,
            "severe" => severe,
            _ => mild,
        };
        let found = || COEFFICIENTS.iter().filter(|(name, _)| within(name));
        let low = found().map(|(_, k)| k[0]).fold(f64::INFINITY, f64::min);
        let high = found().map(|(_, k)| k[1]).fold(0.0, f64::max);
        Self {
            regimes: found().map(|(name, _)| *name).collect(),
            slip_speed,
            pressure_over_hardness,
            coefficient: [low, high],
        }
    }

    /// Returns whether wear may be worse than mild.
    pub fn is_severe(&self) -> bool {
        self.regimes.iter().any(|r| *r != "mild")
    }

    /// Returns the regimes in words.
    pub(super) fn words(&self) -> String {
        self.regimes.join(" or ")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_chart_has_three_regimes() {
        let at = |low: f64, high: f64, pressure: f64| {
            let value = 0.5 * (low + high);
            WearRegime::at(Range { low, value, high }, pressure)
        };
        for (low, high, pressure, regimes, k) in [
            (0.1, 0.1, 0.5, &["mild"][..], [1e-4, 1e-3]),
            (0.3, 0.5, 0.5, &["severe"], [3e-3, 4e-3]),
            (0.15, 0.25, 0.5, &["mild", "severe"], [1e-4, 4e-3]),
            (1.0, 2.0, 0.5, &["mild"], [1e-4, 1e-3]),
            (0.1, 0.3, 0.9, &["seizure"], [3e-2, 4e-2]),
        ] {
            let found = at(low, high, pressure);
            assert_eq!((found.regimes.as_slice(), found.coefficient), (regimes, k));
            assert_eq!(found.is_severe(), regimes != ["mild"]);
        }
    }
}
