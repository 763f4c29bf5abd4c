//! Durations as text: parsed from a command line, and formatted for a reader.

use std::time::Duration;

/// A duration in readable units.
pub fn seconds(s: f64) -> String {
    match s {
        s if s < 0.0995 => format!("{:.0} ms", 1e3 * s),
        s if s < 99.5 => format!("{s:.1} s"),
        s if s < 599.5 => format!("{s:.0} s"),
        s if s < 5940.0 => format!("{:.0} min", s / 60.0),
        s => format!("{:.1} h", s / 3600.0),
    }
}

/// Parses `90s`, `10m`, `1h30m`; a bare number is in seconds.
///
/// # Errors
/// A sentence.
pub fn parse(text: &str) -> Result<Duration, String> {
    let wrong = || format!("`{text}` is not a time; expected for example 90s, 10m, 1h30m");
    let (mut total, mut digits) = (0.0, String::new());
    for c in text.trim().chars() {
        let unit = match c {
            's' => 1.0,
            'm' => 60.0,
            'h' => 3600.0,
            _ => {
                digits.push(c);
                continue;
            }
        };
        total += unit * number(&digits).ok_or_else(wrong)?;
        digits.clear();
    }
    if !digits.is_empty() {
        total += number(&digits).ok_or_else(wrong)?;
    }
    let most = 365.0 * 86400.0;
    if total > 0.0 && total <= most {
        Ok(Duration::from_secs_f64(total))
    } else {
        Err(wrong())
    }
}

fn number(digits: &str) -> Option<f64> {
    let value: f64 = digits.trim().parse().ok()?;
    (value.is_finite() && value >= 0.0).then_some(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn durations_are_read_as_they_are_spoken() {
        let read = |text| parse(text).map(|d| d.as_secs_f64()).ok();
        assert_eq!(read("90s"), Some(90.0));
        assert_eq!(read("1h30m"), Some(5400.0));
        assert_eq!(read("0.5"), Some(0.5));
        for wrong in ["", "m", "0s", "-1s", "ten", "1d", "nan", "1e9h"] {
            assert_eq!(read(wrong), None, "{wrong}");
        }
    }
}
