//! Coloured cells of a chart, with arrows.

use super::{Axis, rows};
use serde::{Deserialize, Serialize};

/// Coloured cells of a plane, and arrows over them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FieldMap {
    /// Corners of each cell, in the units of the axes.
    pub cells: Vec<Vec<[f32; 2]>>,
    /// Meaning of the colours.
    pub colours: Colours,
    /// Arrows at positions, with their length as a share of the longest, along both axes.
    pub arrows: Vec<([f32; 2], [f32; 2])>,
    /// Entry of the arrows in the legend: the meaning of the longest arrow.
    pub arrow_label: String,
}

/// Meaning of the colours of cells.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Colours {
    /// Classes, as indices in a list of names and colours (red, green, blue).
    Classes {
        /// Name and colour of each class.
        classes: Vec<(String, (u8, u8, u8))>,
        /// Class of each cell.
        of: Vec<usize>,
    },
    /// Values, from zero up.
    Values {
        /// Value of each cell; NaN where there is none.
        #[serde(with = "rows::numbers")]
        values: Vec<f64>,
        /// Quantity and unit.
        scale: Axis,
    },
}

impl FieldMap {
    /// Returns the classes that a cell has, in their order; empty where colours are values.
    pub fn classes(&self) -> Vec<&(String, (u8, u8, u8))> {
        let Colours::Classes { classes, of } = &self.colours else {
            return Vec::new();
        };
        let classes = classes.iter().enumerate();
        let classes = classes.filter(|(k, _)| of.contains(k));
        classes.map(|(_, class)| class).collect()
    }

    /// Returns the end of the scale of values, a round number; zero where colours are classes.
    pub fn top(&self) -> f64 {
        match &self.colours {
            Colours::Classes { .. } => 0.0,
            Colours::Values { values, .. } => {
                round_top(values.iter().fold(0.0, |most: f64, v| most.max(*v)))
            }
        }
    }
}

/// Returns the smallest of 1, 1.5, 2, 3, 5, 7 times a power of ten not below a value, as the end of
/// a colour bar.
pub fn round_top(value: f64) -> f64 {
    let power = 10f64.powf(value.log10().floor());
    let steps = [1.0, 1.5, 2.0, 3.0, 5.0, 7.0, 10.0];
    let least = steps.iter().find(|s| **s * power >= value * (1.0 - 1e-9));
    least.copied().unwrap_or(10.0) * power
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colour_bars_end_at_round_values() {
        assert_eq!(round_top(0.2), 0.2);
        assert!((round_top(0.0131) / 0.015 - 1.0).abs() < 1e-12);
        assert!((round_top(880.0) / 1000.0 - 1.0).abs() < 1e-12);
    }
}
