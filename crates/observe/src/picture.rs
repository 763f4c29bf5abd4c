//! What an observer shows in pictures of a moment, as data: who draws it is above this layer.

use super::chart::Chart;
use serde::{Deserialize, Serialize};

/// Colour of what sticks (red, green, blue). It differs in lightness from that of what slips, so
/// that the two are told apart with every deficiency of colour vision.
pub const STICKS: (u8, u8, u8) = (0, 90, 170);
/// Colour of what slips (red, green, blue).
pub const SLIPS: (u8, u8, u8) = (250, 225, 40);
/// Colour of what carries no force (red, green, blue).
pub const OPEN: (u8, u8, u8) = (231, 232, 235);

/// What the colour of a grain says.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub enum Paint {
    /// Nothing: grey, from light to dark by its shade.
    #[default]
    Grey,
    /// The layer it belongs to: four colours in turn, as dyed sands.
    Layer(i64),
    /// Part of a first body, by its number: warm, undamaged.
    Tied(usize),
    /// Loose third body: blue.
    Loose,
    /// Ejected: light blue.
    Out,
    /// A value, 0 light to 1 dark; grey where there is none.
    Value(f64),
}

/// A picture of the scene, drawn with those of the run as `frames/NAME_STEP.png`.
#[derive(Clone, Debug)]
pub struct Picture {
    /// Its name.
    pub name: &'static str,
    /// What it shows.
    pub shows: Shows,
}

/// What a picture shows.
#[derive(Clone, Debug)]
pub enum Shows {
    /// Grains coloured by layer if there are layers, otherwise by speed, or by the damage of their
    /// bonds if there are bonds; in the plane also the forces and bonds between them.
    Scene,
    /// Intact and broken bonds.
    Bonds,
    /// Colours of the balls and then of the pieces.
    Paints(Vec<Paint>),
    /// The contacts that carry force, those of force chains apart: sorted pairs of bodies, the
    /// lower first. In the plane only.
    Chains(Vec<[u32; 2]>),
    /// The von Mises stress of deformable bodies, and what sticks and slips along their surfaces.
    /// In the plane only.
    Stress,
    /// Charts, on a page of their own.
    Charts(Vec<Chart>),
    /// A value of each ball.
    Values {
        /// The values.
        values: Vec<f64>,
        /// What they are.
        label: &'static str,
        /// What is drawn darkest.
        top: f64,
    },
}
