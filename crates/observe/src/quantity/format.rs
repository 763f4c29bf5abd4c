//! Formatting of numbers with units: four digits and a suitable SI prefix.

/// Prefixes and their powers of ten.
const PREFIXES: [(i32, &str); 9] = [
    (-15, "f"),
    (-12, "p"),
    (-9, "n"),
    (-6, "u"),
    (-3, "m"),
    (0, ""),
    (3, "k"),
    (6, "M"),
    (9, "G"),
];

/// Formats a number with `digits` significant digits, without an exponent if that is short.
pub fn number(value: f64, digits: i32) -> String {
    if value == 0.0 || !value.is_finite() {
        return format!("{value}");
    }
    // Rounding may carry into another digit.
    let rounded = format!("{value:.*e}", (digits - 1) as usize);
    let power = rounded
        .split_once('e')
        .and_then(|(_, e)| e.parse().ok())
        .unwrap_or(0);
    if (-4..5).contains(&power) {
        format!("{value:.*}", (digits - 1 - power).max(0) as usize)
    } else {
        rounded
    }
}

/// Formats a value in an SI unit: `2.300e-5`, `m` gives `23.00 um`. Kilograms become grams, and
/// cubic metres mm3, so that volumes have a common unit.
pub fn quantity(value: f64, unit: &str) -> String {
    if matches!(unit, "" | "1") {
        return number(value, 4);
    }
    let (base, rest) = unit.split_at(unit.find(['/', ' ']).unwrap_or(unit.len()));
    let (value, base) = match base {
        "kg" => (1e3 * value, "g"),
        other => (value, other),
    };
    let size = value.abs();
    if matches!(base, "m3" | "m^3") {
        let (scale, name) = if size >= 1e-2 {
            (1.0, "m3")
        } else {
            (1e-9, "mm3")
        };
        return format!("{} {name}{rest}", number(value / scale, 4));
    }
    let takes = ["m", "N", "Pa", "s", "J", "W", "Hz", "g"].contains(&base);
    if !takes || size == 0.0 || !size.is_finite() {
        return format!("{} {base}{rest}", number(value, 4));
    }
    let highest = if base == "s" { 0 } else { 9 };
    let magnitude = number(size, 4)
        .parse::<f64>()
        .unwrap_or(size)
        .log10()
        .floor() as i32;
    let power = (3 * magnitude.div_euclid(3)).clamp(-15, highest);
    let prefix = PREFIXES.iter().find(|p| p.0 == power).map_or("", |p| p.1);
    format!(
        "{} {prefix}{base}{rest}",
        number(value / 10f64.powi(power), 4)
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn prefixes_follow_the_size() {
        assert_eq!(quantity(2.3e-5, "m"), "23.00 um");
        assert_eq!(quantity(-0.999_96e-3, "J/m"), "-1.000 mJ/m");
        assert_eq!(quantity(12_345.0, "N/m"), "12.35 kN/m");
        assert_eq!(quantity(5000.0, "s"), "5000 s");
        assert_eq!(quantity(0.0, "J"), "0 J");
        assert_eq!(quantity(3.2e-12, "m^3/m"), "0.003200 mm3/m");
        assert_eq!(quantity(3.2e-15, "m3"), "3.200e-6 mm3");
        assert_eq!(quantity(4.5e-9, "kg/s"), "4.500 ug/s");
        assert_eq!(quantity(0.25, "rad"), "0.2500 rad");
        assert_eq!(quantity(0.412_345, ""), "0.4123");
        assert_eq!(quantity(1e-30, "J"), "1.000e-15 fJ");
        assert_eq!(quantity(1.2e-15, "m^3/(N m)"), "1.200e-6 mm3/(N m)");
    }
}
