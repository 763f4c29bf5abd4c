//! Numbers that a user types as texts with units: how they are read, and which cannot be meant.

mod range;

pub use range::Range;

use fretwork_observe::quantity::{number as shown, quantity as with_units};
use fretwork_scene::quantity::quantity;

/// A number with a unit.
///
/// # Errors
/// A sentence that begins with what the number is.
pub(crate) fn number(what: &str, text: &str, unit: &str) -> Result<f64, String> {
    quantity(text, unit).map_err(|e| {
        let expected = e.expected.map(|x| format!("; give {x}"));
        format!("{what}: {}{}", e.message, expected.unwrap_or_default())
    })
}

/// A number with a unit, above zero.
///
/// # Errors
/// As of [`number`].
pub(crate) fn positive(what: &str, text: &str, unit: &str) -> Result<f64, String> {
    let value = number(what, text, unit)?;
    match value > 0.0 {
        true => Ok(value),
        false => Err(format!("{what}: `{text}` must be above zero")),
    }
}

/// Returns a number that was typed, without zeros at its end.
pub(crate) fn short(value: f64) -> String {
    let text = shown(value, 4);
    match text.contains('.') && !text.contains('e') {
        true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
        false => text,
    }
}

/// Returns the value of a text that is a number without a unit.
pub(crate) fn bare(text: &str) -> Option<f64> {
    let plain = text.trim().replace('_', "");
    plain.parse::<f64>().ok()
}

/// A number above zero whose unit must be written, by an example of it.
///
/// # Errors
/// As of [`number`], or it has no unit.
pub(crate) fn with_unit(what: &str, text: &str, unit: &str, example: &str) -> Result<f64, String> {
    let value = positive(what, text, unit)?;
    if unit.is_empty() || bare(text).is_none() {
        return Ok(value);
    }
    let plain = text.trim();
    let mut examples = example.split(',').map(str::trim);
    let fits = examples.find(|e| quantity(e, unit).is_ok());
    let usual = fits.unwrap_or_default();
    let usual = usual.trim_start_matches(|c: char| c.is_ascii_digit() || ". ".contains(c));
    let others = match usual.is_empty() || usual == unit {
        true => String::new(),
        false => format!("`{plain} {usual}`, or "),
    };
    Err(format!(
        "{what}: `{plain}` has no unit; write {others}`{plain} {unit}`"
    ))
}

/// Smallest stress without a unit that is taken to be in pascal: below it the unit was forgotten.
const FORGOTTEN: f64 = 1e4;

/// A stress above zero. A number like `260` or `210` is meant in another unit than pascal.
///
/// # Errors
/// As of [`number`], or it is too small for pascal.
pub(crate) fn stress(what: &str, text: &str) -> Result<f64, String> {
    let pascal = positive(what, text, "Pa")?;
    if bare(text).is_none() || pascal >= FORGOTTEN {
        return Ok(pascal);
    }
    let plain = text.trim();
    let units = match what {
        "hardness" => format!("`{plain} HBW` or `{plain} MPa`"),
        "young" => format!("`{plain} GPa`"),
        _ => format!("`{plain} MPa`"),
    };
    Err(format!(
        "{what}: `{plain}` has no unit, and would be in pascal; write {units}, or `{plain} Pa`"
    ))
}

/// Largest coefficient of friction that is one: dry solids in air stay below 2, rubber below 5.
const LARGEST_FRICTION: f64 = 5.0;

/// A friction coefficient as a range.
///
/// # Errors
/// It is no range of positive numbers, or larger than those of solids.
pub(crate) fn friction(what: &str, text: &str) -> Result<Range, String> {
    let found = Range::parse(text).map_err(|e| format!("{what}: {e}"))?;
    if found.high <= LARGEST_FRICTION {
        return Ok(found);
    }
    let high = short(found.high);
    let per_cent = bare(text).map(|_| format!("; in per cent write {} %", text.trim()));
    Err(format!(
        "{what}: no pair of solids has a friction coefficient of {high}, dry ones have 0.1 to 2{}",
        per_cent.unwrap_or_default()
    ))
}

/// Smallest K of metals: well lubricated they wear with 1e-7 or so, and 1e-13 is a k in 1/Pa.
const LEAST_WEAR: f64 = 1e-10;

/// Archard's K, with the hardness (Pa) of the softer body, where it is known.
///
/// # Errors
/// It is no range of numbers up to 1, or k = K/H, whose unit is one over a pressure; then the
/// sentence ends with `instead`, how a k is given.
pub(crate) fn archard(
    what: &str,
    text: &str,
    hardness: Option<f64>,
    instead: &str,
) -> Result<Range, String> {
    let of_pressure = |k: f64| {
        let times = hardness.map_or(String::new(), |h| {
            format!(": {} with {}", shown(k * h, 3), with_units(h, "Pa"))
        });
        format!(
            "{what}: `{text}` looks like k in 1/Pa, and K is k times the hardness, a pure number{times}{instead}"
        )
    };
    let in_pressure = || quantity(text, "1/Pa").ok().filter(|k| *k > 0.0);
    let k = Range::parse(text).map_err(|e| format!("{what}: {e}"));
    let k = k.map_err(|why| in_pressure().map_or(why, of_pressure))?;
    match k.high {
        high if high > 1.0 => Err(format!("{what}: K = {high} is above 1")),
        high if high < LEAST_WEAR => Err(of_pressure(k.value)),
        _ => Ok(k),
    }
}

/// A specific wear rate k = K/H (1/Pa), with the hardness (Pa) of the softer body, where it is
/// known.
///
/// # Errors
/// It is no positive number in 1/Pa, or K = k H is none of solids.
pub(crate) fn wear_rate(what: &str, text: &str, hardness: Option<f64>) -> Result<f64, String> {
    let k = positive(what, text, "1/Pa")?;
    let Some(hardness) = hardness else {
        return Ok(k);
    };
    let pure = k * hardness;
    match (LEAST_WEAR..=1.0).contains(&pure) {
        true => Ok(k),
        false => Err(format!(
            "{what}: `{text}` is a K = k H of {} with the hardness {}, and solids have {LEAST_WEAR:e} to 1: 1e-14 1/Pa is mild wear of steels; a K is written without a unit",
            shown(pure, 3),
            with_units(hardness, "Pa")
        )),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_unit_is_asked_for_where_there_is_one() {
        let load = "50N, 200N/mm, 75kN";
        for (text, unit, example, says) in [
            ("20", "m", "20um", "`20 um`, or `20 m`"),
            ("1e-12", "m", "10mm", "`1e-12 mm`, or `1e-12 m`"),
            ("50", "N", load, "write `50 N`"),
            ("200", "N/m", load, "`200 N/mm`, or `200 N/m`"),
            ("1.1e9", "Pa", "1.1GPa", "`1.1e9 GPa`, or `1.1e9 Pa`"),
        ] {
            let error = with_unit("x", text, unit, example).unwrap_err();
            assert!(error.starts_with("x: ") && error.ends_with(says), "{error}");
        }
        assert_eq!(with_unit("x", "20um", "m", "1um"), Ok(2e-5));
        assert_eq!(with_unit("x", "0.4", "", "0.6"), Ok(0.4));
        assert!(
            with_unit("x", "-1", "m", "1m")
                .unwrap_err()
                .contains("above zero")
        );
    }

    #[test]
    fn coefficients_that_no_solids_have_are_refused() {
        assert_eq!(friction("mu", "60 %").map(|r| r.value), Ok(0.6));
        let error = friction("mu", "60").unwrap_err();
        assert!(error.contains("in per cent write 60 %"), "{error}");
        let hard = Some(2.5e9);
        assert_eq!(archard("wear", "1e-4", hard, "").map(|r| r.value), Ok(1e-4));
        assert_eq!(wear_rate("wear", "1e-14 1/Pa", hard), Ok(1e-14));
        // 1e-15 m³/(N m) is written in units of engineers, too.
        let engineers = wear_rate("wear", "1e-6 mm^3/(N m)", hard).unwrap();
        assert!((engineers / 1e-15 - 1.0).abs() < 1e-12);
        for (error, words) in [
            (
                archard("wear", "1e-15", hard, "").unwrap_err(),
                "looks like k in 1/Pa",
            ),
            (
                archard("wear", "3", hard, "").unwrap_err(),
                "K = 3 is above 1",
            ),
            (
                wear_rate("wear", "1e-4 1/Pa", hard).unwrap_err(),
                "K = k H of 2.5",
            ),
            (
                wear_rate("wear", "1e-22 1/Pa", hard).unwrap_err(),
                "a K is written without",
            ),
        ] {
            assert!(
                error.starts_with("wear: ") && error.contains(words),
                "{error}"
            );
        }
    }
}
