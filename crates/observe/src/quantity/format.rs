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

/// Size below which a value in an SI unit with prefixes is round-off: a thousandth of the smallest
/// prefix. Contacts are far smaller than a metre, of which doubles resolve 1e-16.
const ROUND_OFF: f64 = 1e-18;

/// Formats a number with `digits` significant digits, without an exponent if that is short.
pub fn number(value: f64, digits: i32) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    if !value.is_finite() {
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

/// A unit as it is shown: with a prefix that suits the size of a value.
struct ShownUnit {
    /// Factor on values in the SI unit, and a divisor.
    scale: [f64; 2],
    /// Name; empty for pure numbers.
    name: String,
}

impl ShownUnit {
    fn of(value: f64, unit: &str) -> Self {
        if matches!(unit, "" | "1") {
            let (scale, name) = ([1.0, 1.0], String::new());
            return Self { scale, name };
        }
        let (base, rest) = unit.split_at(unit.find(['/', ' ']).unwrap_or(unit.len()));
        let (factor, base) = match base {
            "kg" => (1e3, "g"),
            other => (1.0, other),
        };
        let value = factor * value;
        let size = value.abs();
        if matches!(base, "m3" | "m^3") {
            let (over, name) = if size >= 1e-2 {
                (1.0, "m3")
            } else {
                (1e-9, "mm3")
            };
            let name = format!("{name}{rest}");
            return Self {
                scale: [factor, over],
                name,
            };
        }
        let takes = ["m", "N", "Pa", "s", "J", "W", "Hz", "g"].contains(&base);
        if takes && size < ROUND_OFF {
            let name = format!("{base}{rest}");
            return Self {
                scale: [0.0, 1.0],
                name,
            };
        }
        if !takes || !size.is_finite() {
            let name = format!("{base}{rest}");
            return Self {
                scale: [factor, 1.0],
                name,
            };
        }
        let highest = if base == "s" { 0 } else { 9 };
        let magnitude = number(size, 4)
            .parse::<f64>()
            .unwrap_or(size)
            .log10()
            .floor() as i32;
        let power = (3 * magnitude.div_euclid(3)).clamp(-15, highest);
        let prefix = PREFIXES.iter().find(|p| p.0 == power).map_or("", |p| p.1);
        let name = format!("{prefix}{base}{rest}");
        Self {
            scale: [factor, 10f64.powi(power)],
            name,
        }
    }

    /// Formats a value in the SI unit with `digits` digits.
    fn number(&self, value: f64, digits: i32) -> String {
        number(self.scale[0] * value / self.scale[1], digits)
    }

    /// Adds the name to the text of a number.
    fn after(&self, text: String) -> String {
        if self.name.is_empty() {
            return text;
        }
        format!("{text} {}", self.name)
    }
}

/// Formats a value in an SI unit: `2.300e-5`, `m` gives `23.00 um`. Kilograms become grams, and
/// cubic metres mm3, so that volumes have a common unit.
pub fn quantity(value: f64, unit: &str) -> String {
    let shown = ShownUnit::of(value, unit);
    shown.after(shown.number(value, 4))
}

/// Largest half-width, as a share of its value, that four digits of the value do not show.
const UNSEEN: f64 = 5e-4;

const BELOW: &str = "< 0.1 %";

/// Returns how a half-width is shown that four digits of its value do not show; `None` for others.
pub fn below_digits(half_width: f64, value: f64) -> Option<&'static str> {
    (half_width < UNSEEN * value.abs()).then_some(BELOW)
}

/// Formats a half-width as a share of its value in percent.
pub fn percent(share: f64) -> String {
    let shown = || format!("{} %", number(100.0 * share, 2));
    below_digits(share, 1.0).map_or_else(shown, str::to_owned)
}

/// Formats a half-width of a value in its unit, and in percent where four digits of the value do
/// not show it.
pub fn half_width(half_width: f64, value: f64, unit: &str) -> String {
    match (below_digits(half_width, value), unit) {
        (Some(below), _) => below.to_owned(),
        (None, "1") => number(half_width, 2),
        (None, unit) => quantity(half_width, unit),
    }
}

/// Formats a value with its half-width in one unit: `0.4020 +- 0.012`, `23.00 +- 0.40 um`; a
/// half-width that the digits of the value do not show as `0.4020 +- < 0.1 %`.
pub fn with_half_width(value: f64, half_width: f64, unit: &str) -> String {
    if let Some(below) = below_digits(half_width, value) {
        return format!("{} +- {below}", quantity(value, unit));
    }
    let shown = ShownUnit::of(value, unit);
    let numbers = [shown.number(value, 4), shown.number(half_width, 2)];
    shown.after(numbers.join(" +- "))
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
        assert_eq!(quantity(1e-17, "J"), "0.01000 fJ");
        assert_eq!(quantity(-1.613e-21, "m"), "0 m");
        assert_eq!(quantity(1.2e-15, "m^3/(N m)"), "1.200e-6 mm3/(N m)");
    }

    #[test]
    fn a_half_width_has_the_unit_of_its_value() {
        assert_eq!(with_half_width(0.402, 0.0123, "1"), "0.4020 +- 0.012");
        assert_eq!(with_half_width(2.3e-5, 4e-7, "m"), "23.00 +- 0.40 um");
        assert_eq!(
            with_half_width(2.229e-12, 6.5e-13, "m^3/m"),
            "0.002229 +- 0.00065 mm3/m"
        );
        assert_eq!(with_half_width(4.5e-9, 1e-9, "kg/s"), "4.500 +- 1.0 ug/s");
        assert_eq!(with_half_width(0.4, 1.6e-16, "1"), "0.4000 +- < 0.1 %");
        assert_eq!(with_half_width(-2e-5, 0.0, "m"), "-20.00 um +- < 0.1 %");
        assert_eq!(half_width(4e-7, 2.3e-5, "m"), "400.0 nm");
        assert_eq!(half_width(0.0, 2.3e-5, "m"), "< 0.1 %");
        assert_eq!(
            (percent(3.5e-16), percent(0.0262)),
            ("< 0.1 %".to_owned(), "2.6 %".to_owned())
        );
    }
}
