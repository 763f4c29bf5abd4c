//! Numbers with units as written on a command line, and hardnesses as pressures.

use super::units::{UnitError, convert, hardness, in_si};

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

/// Returns the lengths of the number at the start of a text (0 if there is none), and of the number
/// with the unit after it, up to which blanks may stand: `10 us, ...` gives 2 and 5. A unit ends
/// before a bracket that it does not open, a comma, a comment or the end of the line; a word before
/// a colon is the name of a field and no unit.
pub(crate) fn parts(text: &str) -> (usize, usize) {
    let end = number_length(text);
    if end == 0 {
        return (0, 0);
    }
    (end, end + unit_length(&text[end..]))
}

/// Returns the value of a number as RON and command lines write it, `1_000` too.
pub(crate) fn number(text: &str) -> Option<f64> {
    text.replace('_', "").parse().ok()
}

fn number_length(text: &str) -> usize {
    let bytes = text.as_bytes();
    let digits = |from: usize| {
        let rest = bytes.get(from..).unwrap_or_default();
        let count = rest
            .iter()
            .take_while(|b| b.is_ascii_digit() || **b == b'_');
        from + count.count()
    };
    let sign = usize::from(matches!(bytes.first(), Some(b'+' | b'-')));
    let whole = digits(sign);
    let mut end = whole;
    if bytes.get(end) == Some(&b'.') {
        end = digits(end + 1);
    }
    let some = bytes[sign..end].iter().any(u8::is_ascii_digit);
    if !some || bytes.get(sign) == Some(&b'_') {
        return 0;
    }
    if matches!(bytes.get(end), Some(b'e' | b'E')) {
        let signed = matches!(bytes.get(end + 1), Some(b'+' | b'-'));
        let from = end + 1 + usize::from(signed);
        if bytes.get(from).is_some_and(u8::is_ascii_digit) {
            end = digits(from);
        }
    }
    end
}

/// Length of a unit at the start of a text, with the blanks before it; 0 if there is none.
fn unit_length(text: &str) -> usize {
    let rest = text.trim_start_matches([' ', '\t']);
    let blanks = text.len() - rest.len();
    let symbol = |c: char| c.is_alphabetic() || matches!(c, '%' | '\u{b0}');
    if !(rest.starts_with(symbol) || blanks > 0 && rest.starts_with("1/")) {
        return 0;
    }
    let (mut depth, mut end, mut before_colon) = (0_usize, rest.len(), false);
    for (at, c) in rest.char_indices() {
        let comment = c == '/' && rest[at + 1..].starts_with(['/', '*']);
        match c {
            '(' => depth += 1,
            ')' if depth > 0 => depth -= 1,
            _ if comment || ",:;=#)]}[{\"'\n\r".contains(c) => {
                (end, before_colon) = (at, c == ':');
                break;
            }
            _ => {}
        }
    }
    let mut unit = rest[..end].trim_end();
    if before_colon {
        unit = unit
            .trim_end_matches(|c: char| c == '_' || c.is_alphanumeric())
            .trim_end();
    }
    if unit.is_empty() || depth > 0 {
        return 0;
    }
    blanks + unit.len()
}

/// Parses a number with a unit, such as `75 kN` or `0.46m`, and converts it to the unit `wanted`; a
/// number without a unit is in `wanted`.
///
/// # Errors
/// There is no finite number before the unit, or the unit is unknown or of another dimension.
pub fn quantity(text: &str, wanted: &str) -> Result<f64, UnitError> {
    let text = text.trim();
    let (end, _) = parts(text);
    let value = number(&text[..end]).filter(|x| x.is_finite());
    let Some(value) = value else {
        return Err(UnitError {
            message: format!("`{text}` is not a number with a unit"),
            expected: Some(match wanted {
                "" => "a number".to_owned(),
                unit => format!("a number in {unit}, or with a unit such as `{unit}`"),
            }),
            nearest: None,
        });
    };
    if let Some(written) = decimal_comma(text) {
        return Err(UnitError {
            message: format!("`{text}` has a decimal comma"),
            expected: Some(format!("`{written}`")),
            nearest: None,
        });
    }
    convert(value, text[end..].trim(), wanted)
}

/// Returns how a number with a decimal comma, and with or without a unit, is written; `None` if the
/// text is something else.
pub(crate) fn decimal_comma(text: &str) -> Option<String> {
    let whole = number_length(text);
    let decimals = text[whole..].trim_start().strip_prefix(',')?;
    let digits = whole > 0 && decimals.starts_with(|c: char| c.is_ascii_digit());
    (digits && !decimals.contains(',')).then(|| format!("{}.{decimals}", &text[..whole]))
}

/// Parses a number with or without a unit, and converts it to SI units, see [`in_si`]; `None` if
/// the text is something else.
pub fn si_quantity(text: &str) -> Option<Result<(f64, String), UnitError>> {
    let text = text.trim();
    let (end, all) = parts(text);
    let value = number(&text[..end]).filter(|x| x.is_finite() && end > 0 && all == text.len())?;
    Some(in_si(value, text[end..].trim()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_of_numbers_are_told_from_others() {
        for (text, si, unit) in [
            ("5um", 5e-6, "m"),
            ("0.3", 0.3, ""),
            ("1e3 N/m", 1e3, "N/m"),
        ] {
            assert_eq!(si_quantity(text), Some(Ok((si, unit.to_owned()))), "{text}");
        }
        for text in ["sand", "Explicit", "[1, 2]", "5 us, 3", "", "inf"] {
            assert_eq!(si_quantity(text), None, "{text}");
        }
        assert!(si_quantity("5 foo").is_some_and(|r| r.is_err()));
    }

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
        let comma = quantity("7,5kN", "N").unwrap_err();
        assert_eq!(comma.expected.as_deref(), Some("`7.5kN`"));
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
    fn a_unit_ends_where_the_next_value_begins() {
        for (text, number, unit) in [
            ("10us, end: 1", "10", "us"),
            ("10 us, end: 1", "10", "us"),
            ("-500kN)", "-500", "kN"),
            ("1e-3 mm/s // slow", "1e-3", "mm/s"),
            ("2.5e-4 mm^3/(N m))", "2.5e-4", "mm^3/(N m)"),
            ("1e-13 1/Pa,", "1e-13", "1/Pa"),
            ("40%]", "40", "%"),
            ("30\u{b0})", "30", "\u{b0}"),
            ("10\u{b5}s", "10", "\u{b5}s"),
            (".5 m /* half */", ".5", "m"),
            ("1_000 N", "1_000", "N"),
            ("10 us end: 3", "10", "us"),
            ("10 end: 3", "10", ""),
            ("10 Sine(amplitude: 3)", "10", ""),
            ("1/1000", "1", ""),
            ("1e-3\n s", "1e-3", ""),
            ("1 /* s */", "1", ""),
            ("1.0e", "1.0", "e"),
        ] {
            let (end, all) = parts(text);
            assert_eq!(
                (&text[..end], text[end..all].trim()),
                (number, unit),
                "{text}"
            );
        }
        for text in ["us", "-inf", "", "_1", ".", "+"] {
            assert_eq!(parts(text), (0, 0), "{text}");
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
