//! Axes of a chart: quantity, unit, and SI prefixes instead of exponents.

use serde::{Deserialize, Serialize};

/// An axis of a chart. Data are given in the unit itself; the chart chooses the prefix (data in `m`
/// of the order of 1e-5 are shown in µm).
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Axis {
    /// Quantity, for example `displacement δ`.
    pub name: String,
    /// SI unit without prefix (`m`, `N`, `Pa`, `s`, `J`, `W`, `N/m`, `m/s`, `m^3`, `kg`), or empty
    /// for a pure number. Powers are written `m^2` and shown as superscripts. Other units are shown
    /// with a power of ten.
    pub unit: String,
    /// Logarithmic scale: non-positive values are omitted.
    pub log: bool,
    /// Whether ticks are at whole numbers only, for cycles or grains.
    pub whole: bool,
    /// Whether the unit is that of the column of the statistics in the chart.
    pub unit_of_rows: bool,
}

impl Axis {
    /// Creates an axis for columns of the statistics, with the unit of the column.
    pub fn of_rows(name: impl Into<String>) -> Self {
        Self {
            unit_of_rows: true,
            ..Self::new(name, "")
        }
    }

    /// The axis of time.
    pub fn time() -> Self {
        Self::new("time t", "s")
    }

    /// The axis of the numbers of cycles.
    pub fn cycles() -> Self {
        Self::new("cycle number N", "").whole()
    }

    /// A linear axis.
    pub fn new(name: impl Into<String>, unit: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            unit: unit.into(),
            ..Self::default()
        }
    }

    /// Makes the scale of the axis logarithmic.
    pub fn log(mut self) -> Self {
        self.log = true;
        self
    }

    /// Puts ticks at whole numbers only.
    pub fn whole(mut self) -> Self {
        self.whole = true;
        self
    }

    /// Returns the exponent of ten to divide by, and the axis label, for the largest magnitude
    /// shown.
    pub fn scaled(&self, largest: f64) -> (i32, String) {
        let (exponent, unit) = if self.log || !(largest > 0.0 && largest.is_finite()) {
            (0, raised(&self.unit))
        } else {
            shown_unit(&self.unit, magnitude(largest))
        };
        let label = match unit.as_str() {
            "" => self.name.clone(),
            unit => format!("{} ({unit})", self.name),
        };
        (exponent, label)
    }
}

/// Returns the exponent of ten of the first significant digit.
fn magnitude(value: f64) -> i32 {
    (value * (1.0 + 1e-12)).log10().floor() as i32
}

/// Returns the exponent of ten to divide by, and the resulting unit: with an SI prefix if the unit
/// permits one, otherwise with a power of ten if the numbers would be long.
fn shown_unit(unit: &str, magnitude: i32) -> (i32, String) {
    if let Some((exponent, base, prefix)) = prefix(unit, magnitude) {
        let rest = unit.find('/').map_or("", |at| &unit[at..]);
        return (exponent, raised(&format!("{prefix}{base}{rest}")));
    }
    if (-2..=4).contains(&magnitude) {
        return (0, raised(unit));
    }
    let exponent = 3 * magnitude.div_euclid(3);
    let sign = if unit.is_empty() { "×" } else { "" };
    let power = format!("{sign}10{} {}", superscript(exponent), raised(unit));
    (exponent, power.trim_end().to_owned())
}

/// Formats a unit with superscripts: `m^3` as m³, `deg` as °.
fn raised(unit: &str) -> String {
    let mut out = String::with_capacity(unit.len());
    let mut up = false;
    for c in unit.chars() {
        match c {
            '^' => up = true,
            '*' => out.push('·'),
            c if up && (c.is_ascii_digit() || c == '-') => out.push(raised_digit(c)),
            c => {
                up = false;
                out.push(c);
            }
        }
    }
    if out == "deg" { "°".to_owned() } else { out }
}

/// Formats a value with its unit and `digits` significant digits: `120 ms`, `−5.0 µm`.
pub fn quantity(value: f64, unit: &str, digits: usize) -> String {
    if !value.is_finite() {
        return format!("{value} {}", raised(unit)).trim_end().to_owned();
    }
    let digits = digits.max(1);
    // Rounding may carry over to the next power of ten.
    let rounded: f64 = format!("{value:.*e}", digits - 1).parse().unwrap_or(value);
    let (exponent, unit) = match rounded.abs() {
        size if size > 0.0 => match (prefix(unit, magnitude(size)), magnitude(size)) {
            (None, power) if !(-2..=4).contains(&power) => {
                let text = format!("×10{} {}", superscript(power), raised(unit));
                (power, text.trim_end().to_owned())
            }
            (_, power) => shown_unit(unit, power),
        },
        _ => (0, raised(unit)),
    };
    let shown = rounded / 10f64.powi(exponent);
    let places = match shown.abs() {
        size if size > 0.0 => digits as i32 - 1 - magnitude(size),
        _ => 0,
    };
    let text = number(shown, places.max(0) as usize);
    if unit.starts_with('×') {
        return format!("{text}{unit}");
    }
    format!("{text} {unit}").trim_end().to_owned()
}

/// Returns exponent, base unit and SI prefix for a magnitude, if the unit permits prefixes.
fn prefix(unit: &str, magnitude: i32) -> Option<(i32, &str, &'static str)> {
    let base = unit.split('/').next().unwrap_or_default();
    if let Some(power) = base.strip_prefix("m^").and_then(|p| p.parse::<i32>().ok()) {
        // The prefix is raised to the power of the metre: 1 mm³ is 1e-9 m³.
        let fits = |step: &i32| (-2..5).contains(&(magnitude - step * power));
        let step = [0, -3, -6, -9].into_iter().find(fits)?;
        let name = ["", "m", "µ", "n"][(-step / 3) as usize];
        return (power > 0).then_some((step * power, base, name));
    }
    if base == "kg" {
        return match 3 * magnitude.div_euclid(3) {
            -3 => Some((-3, "g", "")),
            -6 => Some((-6, "g", "m")),
            -9 => Some((-9, "g", "µ")),
            -12 => Some((-12, "g", "n")),
            _ => None,
        };
    }
    let takes = [
        "m", "N", "Pa", "s", "J", "W", "Hz", "K", "N·m", "N*m", "V", "A",
    ];
    if !takes.contains(&base) {
        return None;
    }
    // Kiloseconds and kilokelvins are not in common use.
    let highest = if matches!(base, "s" | "K") { 0 } else { 12 };
    let exponent = (3 * magnitude.div_euclid(3)).min(highest);
    let prefix = match exponent {
        -15 => "f",
        -12 => "p",
        -9 => "n",
        -6 => "µ",
        -3 => "m",
        0 => "",
        3 => "k",
        6 => "M",
        9 => "G",
        12 => "T",
        _ => return None,
    };
    // Four digits of seconds are readable; more are not.
    (magnitude - exponent < 5).then_some((exponent, base, prefix))
}

/// The exponent of `10` in superscript digits.
pub fn superscript(exponent: i32) -> String {
    exponent.to_string().chars().map(raised_digit).collect()
}

fn raised_digit(c: char) -> char {
    match c {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        '4' => '⁴',
        '5' => '⁵',
        '6' => '⁶',
        '7' => '⁷',
        '8' => '⁸',
        '9' => '⁹',
        _ => '⁰',
    }
}

/// A number with the minus sign U+2212.
pub fn number(value: f64, decimals: usize) -> String {
    let text = format!("{:.decimals$}", value + 0.0);
    match text.strip_prefix('-') {
        Some(digits) if digits.chars().any(|c| c.is_ascii_digit() && c != '0') => {
            format!("−{digits}")
        }
        Some(digits) => digits.to_owned(),
        None => text,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn label(unit: &str, largest: f64) -> String {
        Axis::new("q", unit).scaled(largest).1
    }

    #[test]
    fn prefixes_follow_the_magnitude() {
        assert_eq!(label("m", 1.5e-5), "q (µm)");
        assert_eq!(label("m", 1e-3), "q (mm)");
        assert_eq!(label("N", 4.2e4), "q (kN)");
        assert_eq!(label("Pa", 8e8), "q (MPa)");
        assert_eq!(label("N/m", 3e6), "q (MN/m)");
        assert_eq!(label("s", 2e-3), "q (ms)");
        assert_eq!(label("s", 3600.0), "q (s)");
        assert_eq!(label("", 0.7), "q");
        assert_eq!(label("", 3e-6), "q (×10⁻⁶)");
        assert_eq!(label("kg", 3e-6), "q (mg)");
        assert_eq!(label("kg/m", 2e3), "q (kg/m)");
        assert_eq!(label("rad", 3e-6), "q (10⁻⁶ rad)");
        assert_eq!(label("m", 0.0), "q (m)");
    }

    #[test]
    fn powers_are_raised_and_prefixes_with_them() {
        assert_eq!(label("m^3", 3e-10), "q (mm³)");
        assert_eq!(label("m^3/m", 4e-8), "q (mm³/m)");
        assert_eq!(label("m^2", 2.0), "q (m²)");
        assert_eq!(label("W/m^3", 3e7), "q (MW/m³)");
        assert_eq!(label("m^2/s^2", 0.3), "q (m²/s²)");
        assert_eq!(label("J/m^2", 4e-3), "q (mJ/m²)");
        assert_eq!(label("deg", 30.0), "q (°)");
        for unit in ["m^3", "m^3/m", "kg", "N/m", "J", ""] {
            for exponent in -20..20 {
                let value = 3.0 * 10f64.powi(exponent);
                let (shift, shown) = shown_unit(unit, magnitude(value));
                assert!(!shown.contains('^') && !shown.contains('e'), "{shown}");
                let left = value / 10f64.powi(shift);
                assert!(
                    (0.02..1e5).contains(&left),
                    "{value} {unit}: {left} {shown}"
                );
            }
        }
    }

    #[test]
    fn quantities_read_as_in_print() {
        assert_eq!(quantity(0.12, "s", 4), "120.0 ms");
        assert_eq!(quantity(-5e-6, "m", 2), "−5.0 µm");
        assert_eq!(quantity(0.0, "s", 3), "0 s");
        assert_eq!(quantity(0.9999e-3, "m", 2), "1.0 mm");
        assert_eq!(quantity(4.48e5, "N/m", 3), "448 kN/m");
        assert_eq!(quantity(2.5e-16, "", 2), "2.5×10⁻¹⁶");
        assert_eq!(quantity(0.41, "", 2), "0.41");
        assert_eq!(quantity(12345.0, "", 2), "12000");
    }
}
