//! Numbers with units as written on a command line, and hardnesses as pressures.

use super::units::{UnitError, convert, hardness};

/// The unit kgf/mm² in Pa.
const KGF_PER_SQUARE_MILLIMETRE: f64 = 9.806_65e6;

/// Returns a hardness as a pressure (Pa): for the scales that are a force in kgf over an area in
/// mm² (HBW, HB, HV, HK), or a stress; `None` for other scales and units.
pub fn hardness_in_pascal(value: f64, unit: &str) -> Option<f64> {
    match hardness(unit) {
        Some("HBW" | "HB" | "HV" | "HK") => Some(value * KGF_PER_SQUARE_MILLIMETRE),
        Some(_) => None,
        None => convert(value, unit, "Pa").ok(),
    }
}

/// Parses a number with a unit, such as `75 kN` or `0.46m`, and converts it to the unit `wanted`; a
/// number without a unit is in `wanted`.
///
/// # Errors
/// There is no finite number before the unit, or the unit is unknown or of another dimension.
pub fn quantity(text: &str, wanted: &str) -> Result<f64, UnitError> {
    let text = text.trim();
    let ends = text.char_indices().map(|(k, c)| k + c.len_utf8());
    let number = ends
        .filter_map(|end| {
            let start = text.get(..end)?;
            let digit = start.ends_with(|c: char| c.is_ascii_digit() || c == '.');
            Some((
                end,
                start
                    .parse::<f64>()
                    .ok()
                    .filter(|x| digit && x.is_finite())?,
            ))
        })
        .next_back();
    let Some((end, value)) = number else {
        return Err(UnitError {
            message: format!("`{text}` is not a number with a unit"),
            expected: Some(match wanted {
                "" => "a number".to_owned(),
                unit => format!("a number in {unit}, or with a unit such as `{unit}`"),
            }),
            nearest: None,
        });
    };
    convert(value, text[end..].trim(), wanted)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantities_as_one_writes_them() {
        for (text, wanted, si) in [
            ("75 kN", "N", 75e3),
            ("75kN", "N", 75e3),
            ("13.3 MN/m", "N/m", 13.3e6),
            ("460mm", "m", 0.46),
            ("-1e-3 m", "m", -1e-3),
            ("2.1e11", "Pa", 2.1e11),
            ("0.5 %", "", 0.005),
            (".5", "", 0.5),
        ] {
            let got = quantity(text, wanted).unwrap();
            assert!((got / si - 1.0).abs() < 1e-15, "{text}: {got}");
        }
        for (text, wanted) in [
            ("kN", "N"),
            ("", "m"),
            ("75 kN", "m"),
            ("nan", ""),
            ("inf m", "m"),
        ] {
            assert!(quantity(text, wanted).is_err(), "{text}");
        }
    }

    #[test]
    fn hardness_scales_of_force_over_area_are_pressures() {
        assert_eq!(hardness_in_pascal(1.0, "HBW"), Some(9.80665e6));
        assert_eq!(hardness_in_pascal(100.0, "HV 10"), Some(9.80665e8));
        assert_eq!(hardness_in_pascal(8.7, "GPa"), Some(8.7e9));
        assert_eq!(hardness_in_pascal(8.7e9, ""), Some(8.7e9));
        assert_eq!(hardness_in_pascal(50.0, "HRC"), None);
        assert_eq!(hardness_in_pascal(50.0, "mm"), None);
    }
}
