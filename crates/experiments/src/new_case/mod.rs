//! A first case from what is known about a test: geometry, load, motion, materials, debris.
//!
//! Two elastic bodies without debris between them make the file of a [patch](crate::patch), which
//! is solved exactly; everything else makes a case. Each number that is chosen stands in the file
//! with its formula.
//!
//! ```
//! use fretwork_experiments::new_case::{Geometry, Question};
//!
//! let made = Question::new(Geometry::PinOnDisc)
//!     .with("material", "rail_steel_r260")
//!     .with("radius", "3 mm")
//!     .with("track-radius", "10 mm")
//!     .with("load", "10 N")
//!     .with("speed", "0.1 m/s")
//!     .with("friction", "0.5")
//!     .make(&fretwork_core::laws::SearchPath::new(&[]))?;
//! assert!(made.text.contains("HalfSpace"));
//! # Ok::<(), String>(())
//! ```

mod inputs;
mod interface;
mod patch;
mod rigid;
#[cfg(test)]
mod tests;
mod window;
mod window_laws;
mod window_numbers;

pub use inputs::{Geometry, Input};

use crate::amounts;
use crate::contact_patch::material;
use crate::patch::rolling::too_large;
use fretwork_core::laws::SearchPath;
use fretwork_observe::quantity::quantity as shown;
use std::collections::BTreeMap;

/// Creepage from which a number without a unit is asked for one: curves of rails end at some per
/// cent, and 0.5 is half of a per cent as often as a half.
const MEANT_IN_PER_CENT: f64 = 0.02;

/// Distance of atoms in a metal (m), and least amplitude: a few of them.
const ATOMS: f64 = 2.5e-10;
const LEAST_AMPLITUDE: f64 = 4.0 * ATOMS;

/// What is known about the test: texts of numbers with units, and names, by the keys of
/// [`Geometry::inputs`].
#[derive(Clone, Debug)]
pub struct Question {
    geometry: Geometry,
    values: BTreeMap<String, String>,
}

/// What a file is the input of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Made {
    /// `fretwork run`.
    Case,
    /// `fretwork patch`.
    Patch,
}

/// A file.
#[derive(Clone, Debug)]
pub struct NewCase {
    /// What it is the input of.
    pub made: Made,
    /// Text of the file.
    pub text: String,
}

impl Question {
    /// A test of which only the geometry is known.
    pub fn new(geometry: Geometry) -> Self {
        Self {
            geometry,
            values: BTreeMap::new(),
        }
    }

    /// Adds what is known, under a key of [`Geometry::inputs`].
    #[must_use]
    pub fn with(mut self, key: &str, value: &str) -> Self {
        self.values.insert(key.to_owned(), value.trim().to_owned());
        self
    }

    /// Returns what must still be said, in the order of [`Geometry::inputs`].
    pub fn missing(&self) -> impl Iterator<Item = &'static Input> {
        self.inputs()
            .filter(|input| input.default.is_none() && self.given(input.key).is_none())
    }

    /// Returns what may be said about this test, with what was said of it in mind.
    pub fn inputs(&self) -> impl Iterator<Item = &'static Input> {
        let debris = self.given("debris").is_some();
        self.geometry.inputs(debris)
    }

    /// Makes the file; the laws are those of the wear of rolling steel.
    ///
    /// # Errors
    /// A sentence that says which value is missing, wrong or belongs to another geometry, and what
    /// to write.
    pub fn make(&self, laws: &SearchPath) -> Result<NewCase, String> {
        for key in self.values.keys() {
            if !self.inputs().any(|input| input.key == key) {
                return Err(self.foreign(key));
            }
        }
        if let Some(input) = self.missing().next() {
            return Err(format!(
                "{}: give {}, such as {}",
                input.key, input.asks, input.example
            ));
        }
        for key in self.values.keys() {
            self.check(key)?;
        }
        let debris = self.given("debris").is_some();
        match self.geometry {
            _ if debris => window::make(self, laws),
            Geometry::Window => Err(
                "debris: a window is one of debris between two surfaces; give its material".into(),
            ),
            Geometry::CylinderOnFlat | Geometry::SphereOnFlat | Geometry::WheelOnRail => {
                patch::make(self, laws)
            }
            Geometry::PinOnDisc => rigid::pin(self),
            Geometry::FlatOnFlat => rigid::flat(self),
        }
    }

    /// Checks what was said under a key by itself.
    ///
    /// # Errors
    /// A sentence that begins with the key.
    pub fn check(&self, key: &str) -> Result<(), String> {
        if self.given(key).is_none() {
            return Ok(());
        }
        match key {
            "material" => {
                let [first, second] = self.materials()?;
                material(key, first)?;
                material(key, second)?;
            }
            "debris" => {
                material(key, self.text(key))?;
            }
            "wear" => {
                self.wear()?;
            }
            "load" => {
                self.load()?;
            }
            "friction" => {
                self.friction()?;
            }
            "creepage" => {
                self.creepage()?;
            }
            "amplitude" => {
                self.amplitude()?;
            }
            "cycles" => {
                self.number(key, "")?;
            }
            _ => {
                let unit = match key {
                    "area" => "m^2",
                    "pressure" => "Pa",
                    "frequency" => "Hz",
                    "speed" => "m/s",
                    _ => "m",
                };
                self.number(key, unit)?;
            }
        }
        Ok(())
    }

    /// A value that this test does not have.
    fn foreign(&self, key: &str) -> String {
        let here: Vec<&str> = self.inputs().map(|input| input.key).collect();
        let with_debris = self.geometry.inputs(true).any(|input| input.key == key);
        let hint = match (
            with_debris,
            self.geometry.inputs(false).any(|i| i.key == key),
        ) {
            (true, false) => " without `debris`",
            (false, true) => " with `debris`",
            _ => "",
        };
        format!(
            "{key}: a {} has none{hint}; it has {}",
            self.geometry.name(),
            here.join(", ")
        )
    }

    /// What was said under a key.
    pub fn given(&self, key: &str) -> Option<&str> {
        let text = self.values.get(key).map(String::as_str);
        text.filter(|text| !text.is_empty())
    }

    /// What was said under a key, or its default; empty where it has none.
    fn text(&self, key: &str) -> &str {
        let default = || {
            let mut inputs = self.inputs();
            inputs
                .find(|input| input.key == key)
                .and_then(|input| input.default)
        };
        self.given(key).or_else(default).unwrap_or_default()
    }

    /// A number above zero, with its unit.
    fn number(&self, key: &str, unit: &str) -> Result<f64, String> {
        let mut inputs = self.inputs();
        let example = inputs.find(|input| input.key == key).map(|i| i.example);
        amounts::with_unit(key, self.text(key), unit, example.unwrap_or_default())
    }

    /// The friction coefficient.
    fn friction(&self) -> Result<f64, String> {
        amounts::friction("friction", self.text("friction"))?;
        self.number("friction", "")
    }

    /// The creepage.
    fn creepage(&self) -> Result<f64, String> {
        let value = self.number("creepage", "")?;
        let text = self.text("creepage");
        let bare = amounts::bare(text).is_some();
        match too_large(value, bare) {
            None if bare && value.abs() >= MEANT_IN_PER_CENT => Err(format!(
                "creepage: is {text} meant in per cent? Write `{text}%`, or `{}%`",
                amounts::short(100.0 * value)
            )),
            None => Ok(value),
            Some(why) => Err(format!("creepage: {why}")),
        }
    }

    /// Half of the range of the displacement (m).
    fn amplitude(&self) -> Result<f64, String> {
        let value = self.number("amplitude", "m")?;
        match value < LEAST_AMPLITUDE {
            false => Ok(value),
            true => Err(format!(
                "amplitude: {} is {} of the distance of atoms in a metal, 0.25 nm, and no contact slips by so little; give the displacement of the test, such as 20um",
                q(value, "m"),
                fretwork_observe::quantity::number(value / ATOMS, 2)
            )),
        }
    }

    /// Names of the materials of the two bodies: one alone is that of both.
    fn materials(&self) -> Result<[&str; 2], String> {
        let names: Vec<&str> = self.text("material").split(',').map(str::trim).collect();
        match names[..] {
            [both] => Ok([both, both]),
            [first, second] => Ok([first, second]),
            _ => Err(format!(
                "material: {} names for two bodies; give one or two, with a comma between them",
                names.len()
            )),
        }
    }

    /// The wear coefficient as a case writes it: `{"K": 1e-4}`, or `{"k": 1e-14}` where it has a
    /// unit; `None` where none was given.
    fn wear(&self) -> Result<Option<String>, String> {
        let Some(text) = self.given("wear") else {
            return Ok(None);
        };
        let mut hardness: Option<f64> = None;
        for name in self.materials()? {
            let own = material("material", name)?.property("hardness");
            hardness = hardness.into_iter().chain(own).reduce(f64::min);
        }
        if amounts::bare(text).is_some() {
            let instead = format!("; with its unit, `{text} 1/Pa`, it is taken as k");
            let pure = amounts::archard("wear", text, hardness, &instead)?;
            return Ok(Some(format!("{{\"K\": {:e}}}", pure.value)));
        }
        let k = amounts::wear_rate("wear", text, hardness)?;
        Ok(Some(format!("{{\"k\": {k:e}}}")))
    }
}

/// A number with its unit as a case reads it and an engineer writes it, of four digits.
fn q(value: f64, unit: &str) -> String {
    let text = shown(value, unit);
    match text.split_once(' ') {
        Some((number, unit)) if number.contains('.') && !number.contains('e') => {
            let short = number.trim_end_matches('0').trim_end_matches('.');
            format!("{short} {unit}")
        }
        _ => text,
    }
}

/// Comment lines, wrapped, with an indent.
fn comment(indent: usize, text: &str) -> String {
    let width = 96 - indent;
    let mut out = String::new();
    let mut line = String::new();
    let mut end = |line: &mut String| {
        out += &format!("{:indent$}// {line}\n", "");
        line.clear();
    };
    for word in text.split_whitespace() {
        if !line.is_empty() && line.chars().count() + 1 + word.chars().count() > width {
            end(&mut line);
        }
        if !line.is_empty() {
            line.push(' ');
        }
        line += word;
    }
    if !line.is_empty() {
        end(&mut line);
    }
    out
}
