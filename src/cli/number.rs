//! Parsers of numbers on the command line that reject NaN, infinities and values out of range.

/// A finite number.
pub fn finite(text: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(x) if x.is_finite() => Ok(x),
        _ => Err("a finite number is expected".to_owned()),
    }
}

/// A positive number.
pub fn positive(text: &str) -> Result<f64, String> {
    finite(text)
        .ok()
        .filter(|x| *x > 0.0)
        .ok_or_else(|| "a number above 0 is expected".to_owned())
}

/// A number of at least zero.
pub fn not_negative(text: &str) -> Result<f64, String> {
    finite(text)
        .ok()
        .filter(|x| *x >= 0.0)
        .ok_or_else(|| "a number from 0 up is expected".to_owned())
}

/// A fraction from 0 to 1.
pub fn share(text: &str) -> Result<f64, String> {
    finite(text)
        .ok()
        .filter(|x| (0.0..=1.0).contains(x))
        .ok_or_else(|| "a number from 0 to 1 is expected".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_number_is_refused() {
        for text in ["NaN", "nan", "inf", "-inf", "1e400", "", "one", "0x1"] {
            assert!(finite(text).is_err() && positive(text).is_err(), "{text}");
            assert!(
                not_negative(text).is_err() && share(text).is_err(),
                "{text}"
            );
        }
        assert_eq!((finite("-2"), positive("1e-8")), (Ok(-2.0), Ok(1e-8)));
        assert_eq!((not_negative("0"), share("1")), (Ok(0.0), Ok(1.0)));
        assert!(positive("0").is_err() && not_negative("-1").is_err() && share("1.1").is_err());
    }
}
