//! Pictures of the scene at a time, as data; a higher layer draws them.

use super::chart::Chart;
use serde::{Deserialize, Serialize};

/// Colour of sticking (red, green, blue). It differs in lightness from that of slip, so that the
/// two can be distinguished with any deficiency of colour vision.
pub const STICK_COLOUR: (u8, u8, u8) = (0, 90, 170);
/// Colour of slip (red, green, blue).
pub const SLIP_COLOUR: (u8, u8, u8) = (250, 225, 40);
/// Colour of points without force (red, green, blue).
pub const OPEN_COLOUR: (u8, u8, u8) = (231, 232, 235);

/// Meaning of the colour of a grain.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub enum Paint {
    /// None: grey, from light to dark by its shade.
    #[default]
    Grey,
    /// The layer to which it belongs, as one of four colours in turn.
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

/// A picture of the scene, written as `frames/NAME_STEP.png`.
#[derive(Clone, Debug)]
pub struct Picture {
    /// Name of the picture.
    pub name: &'static str,
    /// Content of the picture.
    pub shows: PictureContent,
}

/// Content of a picture.
#[derive(Clone, Debug)]
pub enum PictureContent {
    /// Grains coloured by layer if there are layers, otherwise by the damage of their bonds if
    /// there are bonds, or by speed; in the plane also the forces and bonds between them.
    Scene,
    /// Intact and broken bonds.
    Bonds,
    /// Colours of the balls and then of the pieces.
    Paints(Vec<Paint>),
    /// The contacts that carry force, with those of force chains marked: sorted pairs of bodies,
    /// the lower first. In the plane only.
    Chains(Vec<[u32; 2]>),
    /// The von Mises stress of deformable bodies, with stick and slip along their surfaces. In the
    /// plane only.
    Stress,
    /// Charts, on a separate page.
    Charts(Vec<Chart>),
    /// A value for each ball.
    Values {
        /// The values.
        values: Vec<f64>,
        /// Name of the quantity.
        label: &'static str,
        /// Value with the darkest colour.
        top: f64,
    },
}
