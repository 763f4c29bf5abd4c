//! Units of numbers: parses them, checks them against the unit of the schema, and converts values.
//!
//! Names, prefixes and products are those of the crate `runits`. This module adds angles (which
//! `runits` treats as pure numbers, so that a friction coefficient in degrees would pass) and
//! hardness scales.

mod amount;

pub(crate) use amount::{Amount, Measure};

use super::source::{ValidationError, nearest};
use runits::{Dimension, ParseError, UnknownUnit};

/// Units that are suggested for a wrong or unknown one.
const USUAL: [&str; 63] = [
    "m", "mm", "um", "nm", "cm", "km", "s", "ms", "us", "min", "h", "kg", "g", "mg", "t", "N",
    "mN", "kN", "MN", "Pa", "kPa", "MPa", "GPa", "bar", "J", "mJ", "kJ", "MJ", "W", "kW", "Hz",
    "kHz", "rad", "deg", "K", "m/s", "mm/s", "km/h", "kg/m^3", "g/cm^3", "t/m^3", "N/m", "N/mm",
    "kN/m", "J/m^2", "kJ/m^2", "MJ/m^2", "Pa/m", "MPa/mm", "GPa/mm", "1/Pa", "1/MPa", "m^3/J",
    "mm^3/J", "m^2", "mm^2", "m^3", "mm^3", "Pa s", "J s/m^2", "Pa s/m", "1/s", "%",
];

/// Hardness scales, which are not pressures.
const HARDNESS: [&str; 8] = ["HBW", "HB", "HV", "HK", "HRA", "HRB", "HRC", "HLD"];

/// Reason why a unit does not fit.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnitError {
    /// Description of the error.
    pub message: String,
    /// Description of valid units.
    pub expected: Option<String>,
    /// The nearest unit by name.
    pub nearest: Option<String>,
}

impl UnitError {
    /// Converts to a validation error at a path.
    pub fn at(self, path: impl Into<String>) -> ValidationError {
        let mut fault = ValidationError::new(path, self.message).nearest(self.nearest.as_deref());
        fault.expected = self.expected;
        fault
    }
}

/// A parsed unit.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Unit {
    /// Value in SI units.
    factor: f64,
    dimension: Dimension,
    /// Whether the unit contains an angle.
    angle: bool,
}

/// Converts `value` from the unit `given` to the unit `wanted` of the schema. An empty text
/// is the schema's own unit.
///
/// # Errors
/// The unit is unknown or of another dimension.
pub fn convert(value: f64, given: &str, wanted: &str) -> Result<f64, UnitError> {
    let same = |text: &str| text.split_whitespace().collect::<String>();
    if given.trim().is_empty() || same(given) == same(wanted) {
        return Ok(value);
    }
    if let Some(scale) = hardness(given) {
        return Err(UnitError {
            message: format!(
                "`{scale}` is a scale of hardness, and the unit here is {}",
                named(wanted)
            ),
            expected: fitting(wanted),
            nearest: None,
        });
    }
    let unit = read(given)?;
    let Ok(schema) = read(wanted) else {
        return Err(UnitError {
            message: format!(
                "the unit here is `{wanted}`, which is unknown: `{given}` cannot be converted to it"
            ),
            expected: Some(format!("`{wanted}`, or no unit")),
            nearest: None,
        });
    };
    if unit.dimension != schema.dimension || unit.angle != schema.angle {
        return Err(UnitError {
            message: format!(
                "`{given}` ({}) does not measure the same as {}",
                base(&unit),
                if wanted.is_empty() {
                    named(wanted)
                } else {
                    format!("{} ({})", named(wanted), base(&schema))
                }
            ),
            expected: fitting(wanted),
            nearest: None,
        });
    }
    let factor = decimal(unit.factor / schema.factor);
    let inverse = decimal(schema.factor / unit.factor);
    // Dividing by a round inverse gives the same bits as a value written in the schema's unit.
    Ok(if inverse > 1.0 && inverse == inverse.round() {
        value / inverse
    } else {
        value * factor
    })
}

/// Converts a value to SI units; returns it with the symbol of its unit there, `Pa` for `MPa`,
/// which is empty for pure numbers.
///
/// # Errors
/// The unit is unknown, or a scale of hardness.
pub fn in_si(value: f64, given: &str) -> Result<(f64, String), UnitError> {
    if given.trim().is_empty() {
        return Ok((value, String::new()));
    }
    if let Some(scale) = hardness(given) {
        return Err(UnitError {
            message: format!("`{scale}` is a scale of hardness, which has no unit in SI"),
            expected: None,
            nearest: None,
        });
    }
    let symbol = symbol(&read(given)?);
    Ok((convert(value, given, &symbol)?, symbol))
}

/// Returns the symbol of the SI unit of a dimension, empty for pure numbers.
fn symbol(unit: &Unit) -> String {
    let alike = |name: &&&str| {
        read(name).is_ok_and(|u| {
            u.dimension == unit.dimension
                && u.angle == unit.angle
                && (u.factor - 1.0).abs() < 8.0 * f64::EPSILON
        })
    };
    match USUAL.iter().find(alike) {
        _ if unit.dimension.is_dimensionless() && !unit.angle => String::new(),
        Some(name) => (*name).to_owned(),
        None => {
            let plain = Unit {
                angle: false,
                ..*unit
            };
            let angle = if unit.angle { "rad " } else { "" };
            format!("{angle}{}", base(&plain))
        }
    }
}

/// Checks that a text is a unit or a hardness scale.
///
/// # Errors
/// Returns an error that names the unknown unit.
pub fn known(text: &str) -> Result<(), UnitError> {
    if text.trim().is_empty() || hardness(text).is_some() {
        return Ok(());
    }
    read(text).map(|_| ())
}

/// Returns the hardness scale named by a text, with or without its load: `HBW`, `HV 10`, `HBW
/// 10/3000`.
pub fn hardness(text: &str) -> Option<&'static str> {
    let letters = text.trim();
    let end = letters
        .find(|c: char| !c.is_ascii_alphabetic())
        .unwrap_or(letters.len());
    let load = &letters[end..];
    let plain = load
        .chars()
        .all(|c| c.is_ascii_digit() || matches!(c, ' ' | '/' | '.'));
    HARDNESS
        .into_iter()
        .find(|scale| *scale == &letters[..end] && plain)
}

fn read(text: &str) -> Result<Unit, UnitError> {
    let mut plain = text.trim().to_owned();
    for (sign, ascii) in [
        ("\u{207b}\u{b9}", "^-1"),
        ("\u{207b}\u{b2}", "^-2"),
        ("\u{207b}\u{b3}", "^-3"),
        ("\u{b2}", "^2"),
        ("\u{b3}", "^3"),
        ("\u{b0}", "deg"),
        ("\u{22c5}", " "),
    ] {
        plain = plain.replace(sign, ascii);
    }
    if plain.is_empty() || plain == "-" {
        plain = "1".to_owned();
    }
    let plain = powers(&plain);
    let unknown = |name: &str| UnitError {
        message: if name == text {
            format!("`{name}` is not a known unit")
        } else {
            format!("`{name}` in `{text}` is not a known unit")
        },
        expected: None,
        nearest: match name {
            // As papers write it, for instance in mm^3/Nm.
            "Nm" => Some(text.replacen(name, "(N m)", 1)),
            _ => nearest(name, USUAL).map(|near| text.replacen(name, near, 1)),
        },
    };
    let refused = |why: String| UnitError {
        message: format!("`{text}` is not a unit: {why}"),
        expected: Some("a unit such as `MPa`, `um`, `kJ/m^2` or `J s/m^2`".into()),
        nearest: nearest(text, USUAL).map(str::to_owned),
    };
    if let Some(word) = far(&plain) {
        let small = word.replacen('M', "m", 1);
        let near = (small != word && read(&small).is_ok()).then(|| text.replacen(word, &small, 1));
        return Err(UnitError {
            message: format!(
                "`{word}` is a length of a thousand kilometres or more, which no case has; a millimetre is `mm`"
            ),
            expected: Some("`m`, `mm`, `um`, `nm`".into()),
            nearest: near,
        });
    }
    let mut words = plain.split(|c: char| !c.is_alphabetic() && c != '_');
    if let Some(word) = words.find(|word| is_plural_of_symbol(word)) {
        let singular = text.replacen(word, &word[..word.len() - 1], 1);
        return Err(UnitError {
            nearest: Some(singular),
            ..unknown(word)
        });
    }
    let quantity = runits::parse(&plain).map_err(|error| match error {
        ParseError::Unit(UnknownUnit::Unknown(name)) => unknown(&name),
        ParseError::DivideByZero => refused("it divides by zero".into()),
        ParseError::UnexpectedEnd => refused("it ends too early".into()),
        // The crate's own messages refer to its tokens.
        _ => refused(
            "write names of units with powers such as `m^2`, joined by spaces, `*` and `/`".into(),
        ),
    })?;
    if quantity.value() != 1.0 {
        return Err(refused(
            "it contains a number, which belongs to the value".into(),
        ));
    }
    if quantity.unit().is_affine() {
        return Err(refused(
            "its zero differs from that of the kelvin; use K".into(),
        ));
    }
    Ok(Unit {
        factor: quantity.unit().factor() * si(quantity.dimension()),
        dimension: quantity.dimension(),
        angle: turns(&plain),
    })
}

/// Rewrites `mm3` as `mm^3`: a name that ends with 2 or 3 is a power.
fn powers(text: &str) -> String {
    let mut out = String::with_capacity(text.len() + 2);
    let mut rest = text.chars().peekable();
    let mut name = false;
    while let Some(c) = rest.next() {
        let ends = rest
            .peek()
            .is_none_or(|next| !next.is_alphanumeric() && *next != '.' && *next != '_');
        if name && ends && matches!(c, '2' | '3') {
            out.push('^');
        }
        out.push(c);
        name = c.is_alphabetic();
    }
    out
}

/// Returns whether a unit is a metre with a prefix of mega or above: `Mm` is a common typing error
/// for `mm`, and 1e9 times larger.
fn far(text: &str) -> Option<&str> {
    let mut words = text.split(|c: char| !c.is_alphabetic() && c != '_');
    words.find(|word| {
        matches!(
            word.strip_suffix('m'),
            Some("M" | "G" | "T" | "P" | "E" | "Z" | "Y")
        ) || matches!(*word, "megametre" | "megameter" | "gigametre" | "gigameter")
    })
}

/// Whether the crate reads a word as the plural of a symbol: `mss` as milliseconds, but also `Ns`
/// as newtons and `Pas` as pascals, where a product was meant. Names have plurals, `metres` and
/// `bars`.
fn is_plural_of_symbol(word: &str) -> bool {
    let Some(singular) = word.strip_suffix('s') else {
        return false;
    };
    let (Ok(one), Ok(many)) = (runits::unit(singular), runits::unit(word)) else {
        return false;
    };
    let same = one.factor() == many.factor() && one.dimension() == many.dimension();
    let name = singular.len() > 2 && singular.chars().all(|c| c.is_ascii_lowercase());
    same && (!name || is_plural_of_symbol(singular))
}

/// Returns the factor from the crate's base units, which include the gram, to SI.
fn si(dimension: Dimension) -> f64 {
    1e3f64.powi(-i32::from(dimension.mass))
}

/// Whether a unit contains an angle.
fn turns(text: &str) -> bool {
    let words = text.split(|c: char| !c.is_alphabetic() && c != '_');
    words.filter(|word| !word.is_empty()).any(|word| {
        if matches!(word, "percent" | "ppm" | "count") {
            return false;
        }
        matches!(word, "rpm" | "rps")
            || runits::unit(word).is_ok_and(|unit| unit.dimension().is_dimensionless())
    })
}

/// Returns the nearest number with few digits, if it differs by rounding only.
fn decimal(x: f64) -> f64 {
    let rounded: f64 = format!("{x:.12e}").parse().unwrap_or(x);
    if (rounded - x).abs() <= 8.0 * f64::EPSILON * x.abs() {
        rounded
    } else {
        x
    }
}

fn named(unit: &str) -> String {
    if unit.is_empty() {
        "a pure number".to_owned()
    } else {
        format!("`{unit}`")
    }
}

/// Returns common units of the same dimension.
fn fitting(wanted: &str) -> Option<String> {
    let others = usual(wanted).into_iter().filter(|name| *name != wanted);
    let others = others.map(|name| format!("`{name}`"));
    read(wanted).ok()?;
    let all: Vec<String> = std::iter::once(named(wanted)).chain(others).collect();
    Some(all.join(", "))
}

/// Returns the units that are suggested for a wrong or unknown one.
pub fn all() -> &'static [&'static str] {
    &USUAL
}

/// Returns the common units that measure the same as a unit, empty for pure numbers.
pub fn usual(unit: &str) -> Vec<&'static str> {
    let Ok(schema) = read(unit) else {
        return Vec::new();
    };
    let fits = |name: &&&str| {
        read(name).is_ok_and(|u| u.dimension == schema.dimension && u.angle == schema.angle)
    };
    USUAL.iter().filter(fits).copied().collect()
}

/// Returns the base units of a dimension, such as `kg/s^2`.
fn base(unit: &Unit) -> String {
    let d = &unit.dimension;
    let parts = [
        ("kg", d.mass),
        ("m", d.length),
        ("s", d.time),
        ("A", d.current),
        ("K", d.temperature),
        ("mol", d.substance),
        ("cd", d.luminosity),
    ];
    let mut words: Vec<String> = parts
        .iter()
        .filter(|(_, power)| *power != 0)
        .map(|(name, power)| match power {
            1 => (*name).to_owned(),
            power => format!("{name}^{power}"),
        })
        .collect();
    if unit.angle {
        words.insert(0, "an angle".to_owned());
    }
    if words.is_empty() {
        "a pure number".to_owned()
    } else {
        words.join(" ")
    }
}

#[cfg(test)]
mod tests;
