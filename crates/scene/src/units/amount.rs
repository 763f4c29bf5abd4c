//! Amounts with their dimensions, and how these follow in calculations.

use super::{Unit, UnitError, in_si, read, symbol};
use runits::Dimension;

/// Difference of powers of units below which they are equal: roots and powers round them.
const SAME_POWER: f64 = 1e-9;

/// A number in SI units with its dimension.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Amount {
    /// Value in SI units.
    pub value: f64,
    /// Dimension.
    pub measure: Measure,
}

/// The dimension of an amount, as powers of the base units. Angles are kept apart from pure
/// numbers, so that a coefficient of friction in degrees is found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Measure {
    /// Powers of kg, m, s, A, K, mol and cd, which roots may break.
    powers: [f64; 7],
    /// Whether it is an angle, or one per time.
    angle: bool,
}

impl Measure {
    /// The dimension of pure numbers.
    pub const NUMBER: Self = Self {
        powers: [0.0; 7],
        angle: false,
    };

    /// Returns the dimension of a unit.
    ///
    /// # Errors
    /// The unit is unknown.
    pub fn of_unit(unit: &str) -> Result<Self, UnitError> {
        let Unit {
            dimension: d,
            angle,
            ..
        } = read(unit)?;
        let powers = [
            d.mass,
            d.length,
            d.time,
            d.current,
            d.temperature,
            d.substance,
            d.luminosity,
        ];
        Ok(Self {
            powers: powers.map(f64::from),
            angle,
        })
    }

    /// Returns whether this is a pure number, or an angle.
    pub fn is_number(&self) -> bool {
        self.powers.iter().all(|p| p.abs() < SAME_POWER)
    }

    /// Returns whether amounts of both can be added.
    pub fn equals(&self, other: &Self) -> bool {
        self.angle == other.angle && self.same_powers(other)
    }

    /// Returns whether an amount of this dimension may stand where `field` is expected. A number
    /// may stand for an angle, in radians; an angle not for a number.
    pub fn fits(&self, field: &Self) -> bool {
        (field.angle || !self.angle) && self.same_powers(field)
    }

    fn same_powers(&self, other: &Self) -> bool {
        let pairs = self.powers.iter().zip(&other.powers);
        pairs.into_iter().all(|(a, b)| (a - b).abs() < SAME_POWER)
    }

    /// Returns the dimension of a product (`sign` 1) or quotient (-1). A speed of rotation times a
    /// length is a speed: the angle is lost where another base unit than the second comes in.
    pub fn combined(&self, other: &Self, sign: f64) -> Self {
        let powers = std::array::from_fn(|k| self.powers[k] + sign * other.powers[k]);
        let time_only = |m: &Self| {
            let others = m.powers.iter().enumerate().filter(|(k, _)| *k != 2);
            others.into_iter().all(|(_, p)| p.abs() < SAME_POWER)
        };
        let kept = match (self.angle, other.angle) {
            (true, false) => time_only(other),
            (false, true) => time_only(self),
            _ => false,
        };
        Self {
            powers,
            angle: kept,
        }
    }

    /// Returns the dimension of a power.
    pub fn raised_to(&self, exponent: f64) -> Self {
        Self {
            powers: self.powers.map(|p| p * exponent),
            angle: self.angle && exponent == 1.0,
        }
    }

    /// Returns the symbol of the SI unit, empty for pure numbers; `None` if a power is no whole
    /// number.
    pub fn symbol(&self) -> Option<String> {
        let whole = |p: f64| {
            let near = (p - p.round()).abs() < SAME_POWER && p.abs() < 100.0;
            near.then_some(p.round() as i8)
        };
        let [
            mass,
            length,
            time,
            current,
            temperature,
            substance,
            luminosity,
        ] = self.powers;
        let dimension = Dimension {
            mass: whole(mass)?,
            length: whole(length)?,
            time: whole(time)?,
            current: whole(current)?,
            temperature: whole(temperature)?,
            substance: whole(substance)?,
            luminosity: whole(luminosity)?,
        };
        Some(symbol(&Unit {
            factor: 1.0,
            dimension,
            angle: self.angle,
        }))
    }

    /// Says what is measured: "a pure number", or the unit as "in `Pa`".
    pub fn in_words(&self) -> String {
        match self.symbol().as_deref() {
            Some("") => "a pure number".to_owned(),
            Some(symbol) => format!("in `{symbol}`"),
            None => {
                let names = ["kg", "m", "s", "A", "K", "mol", "cd"];
                let parts = names.iter().zip(self.powers);
                let parts = parts.filter(|(_, p)| p.abs() > SAME_POWER);
                let parts: Vec<String> = parts.map(|(name, p)| format!("{name}^{p}")).collect();
                format!("in `{}`", parts.join(" "))
            }
        }
    }
}

impl Amount {
    /// A pure number.
    pub fn number(value: f64) -> Self {
        Self {
            value,
            measure: Measure::NUMBER,
        }
    }

    /// An amount from a number in a unit.
    ///
    /// # Errors
    /// The unit is unknown, or a scale of hardness.
    pub fn of(value: f64, unit: &str) -> Result<Self, UnitError> {
        let (value, _) = in_si(value, unit)?;
        let measure = Measure::of_unit(unit)?;
        Ok(Self { value, measure })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(unit: &str) -> Measure {
        Measure::of_unit(unit).unwrap()
    }

    #[test]
    fn dimensions_follow_in_products_and_powers() {
        let product = of("Pa").combined(&of("m"), 1.0);
        assert!(product.equals(&of("N/m")) && product.fits(&of("N/m")));
        assert_eq!(product.symbol().unwrap(), "N/m");
        // The speed of sound.
        let squared = of("Pa").combined(&of("kg/m^3"), -1.0);
        assert!(squared.raised_to(0.5).equals(&of("m/s")));
        let root = of("Pa").raised_to(0.5);
        assert_eq!(root.symbol(), None);
        assert_eq!(root.in_words(), "in `kg^0.5 m^-0.5 s^-1`");
        assert_eq!(of("GPa").in_words(), "in `Pa`");
        assert_eq!(Measure::NUMBER.in_words(), "a pure number");
    }

    #[test]
    fn angles_are_lost_with_lengths_and_are_no_numbers() {
        let turning = of("rad/s");
        assert!(turning.combined(&of("m"), 1.0).equals(&of("m/s")));
        assert!(turning.combined(&of("s"), 1.0).equals(&of("rad")));
        assert!(!of("deg").fits(&Measure::NUMBER));
        assert!(Measure::NUMBER.fits(&of("rad")));
        assert!(!turning.fits(&of("Hz")));
        assert!(of("deg").combined(&of("rad"), -1.0).fits(&Measure::NUMBER));
        assert_eq!(of("deg").in_words(), "in `rad`");
    }
}
