//! Outputs that a trade compares, each with the wanted error.

use crate::Error;
use crate::runs::output::OutputName;
use crate::runs::unit::heading;
use fretwork_observe::summary::{RELATIVE_RESIDUAL, residual};
use fretwork_scene::quantity::si_quantity;
use fretwork_scene::units::convert;

/// The wanted error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ErrorTarget {
    /// A fraction of the reference's value.
    Relative(f64),
    /// An error in the unit of the output.
    Absolute(f64),
}

/// An output and its wanted error.
#[derive(Clone, Debug, PartialEq)]
pub struct Output {
    /// The number.
    pub quantity: OutputName,
    /// The error wanted.
    pub wanted: ErrorTarget,
    /// Exact value, for example from a closed form; if absent, errors are measured against the
    /// reference.
    pub exact: Option<f64>,
    /// SI unit of the number, `1` for pure numbers; until the case is known that of the wanted
    /// error, which is empty if it has none, or if only the runs of the case give it.
    pub unit: String,
}

impl Output {
    /// Parses `name=1%`, `name=0.003` (in its SI unit), `name=3 um` or `name` (1 %).
    ///
    /// # Errors
    /// A sentence.
    pub fn parse(text: &str) -> Result<Self, Error> {
        let wrong = |why: &str| {
            Error::Usage(format!(
                "--output {text}: {why}; expected NAME=1% or NAME=0.003, such as friction_coefficient=1%"
            ))
        };
        let (name, wanted) = text.split_once('=').unwrap_or((text, "1%"));
        let wanted = wanted.trim();
        let (digits, share) = match wanted.strip_suffix('%') {
            Some(digits) => (digits, true),
            None => (wanted, false),
        };
        let (value, unit) = match digits.trim().parse() {
            Ok(value) => (value, String::new()),
            Err(_) if share => return Err(wrong(&format!("`{wanted}` is not a valid error"))),
            Err(_) => absolute(digits).map_err(|why| wrong(&why))?,
        };
        let value: f64 = value;
        if !(value > 0.0 && value.is_finite()) {
            return Err(wrong("the wanted error must be a number above zero"));
        }
        if share && value >= 100.0 {
            return Err(wrong(
                "an error as large as the output itself is meaningless; ask for less than 100 %",
            ));
        }
        let quantity = OutputName::parse(name).map_err(|why| wrong(&why))?;
        // The exact value of a residual is zero; its value is the error itself.
        let (exact, relative) = match residual(&quantity.name) {
            Some(false) if share => {
                return Err(wrong(&format!(
                    "its exact value is zero, so a relative error is undefined; give joules, or ask for {RELATIVE_RESIDUAL}"
                )));
            }
            Some(_) => (Some(0.0), false),
            None => (None, share),
        };
        let value = if share { value / 100.0 } else { value };
        Ok(Self {
            quantity,
            wanted: if relative {
                ErrorTarget::Relative(value)
            } else {
                ErrorTarget::Absolute(value)
            },
            exact,
            unit,
        })
    }

    /// Takes the unit of the output once the case is known.
    ///
    /// # Errors
    /// The wanted error is of another dimension; in a sentence.
    pub fn take_unit(&mut self, unit: String) -> Result<(), String> {
        if unit.is_empty() {
            return Ok(());
        }
        convert(1.0, &self.unit, &unit).map_err(|e| e.message)?;
        self.unit = unit;
        Ok(())
    }

    /// Returns the name of the output.
    pub fn name(&self) -> &str {
        &self.quantity.name
    }

    /// Returns the unit of its errors, `%` of the reference's value where they are relative; empty
    /// for pure numbers.
    pub fn error_unit(&self) -> &str {
        match self.wanted {
            ErrorTarget::Relative(_) => "%",
            ErrorTarget::Absolute(_) => heading(&self.unit),
        }
    }

    /// Creates the error for an argument that names an output which is refused.
    pub fn refused(&self, why: &str) -> Error {
        Error::Usage(format!("--output {}: {why}", self.name()))
    }
}

/// Returns an error with a unit in SI units, and the symbol of its unit there.
fn absolute(text: &str) -> Result<(f64, String), String> {
    let refused = || format!("`{}` is not a valid error", text.trim());
    si_quantity(text)
        .ok_or_else(refused)?
        .map_err(|e| e.message)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reads_what_is_asked_for() {
        let one = Output::parse("friction_coefficient=2%").unwrap();
        assert_eq!(one.wanted, ErrorTarget::Relative(0.02));
        assert_eq!(
            Output::parse("wear.Qs").unwrap().wanted,
            ErrorTarget::Relative(0.01)
        );
        let absolute = Output::parse("energy_residual_relative=1e-3").unwrap();
        assert_eq!(absolute.wanted, ErrorTarget::Absolute(1e-3));
        let mut with_unit = Output::parse("wear.volume=5 mm^3").unwrap();
        assert_eq!(with_unit.wanted, ErrorTarget::Absolute(5e-9));
        assert!(with_unit.take_unit("m".into()).is_err());
        assert_eq!(with_unit.take_unit("m^3".into()), Ok(()));
        for wrong in [
            "a=",
            "a=b%",
            "a=-1%",
            "=1%",
            "a=0",
            "a=NaN",
            "a=NaN%",
            "a=inf",
            "a=1%%",
            "a=1,5%",
            "a=100%",
            "statistics.q:mid=1%",
        ] {
            let message = Output::parse(wrong).unwrap_err().to_string();
            assert!(message.contains(wrong), "{message}");
        }
    }
}
