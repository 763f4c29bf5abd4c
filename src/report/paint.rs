//! What the colour of a grain says.

use super::canvas::{Canvas, INK, Rgb, mix};
use super::font::{Anchor, TextStyle, text_width};
use serde::{Deserialize, Serialize};

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

/// What the colours of [`Paint::Value`] mean.
#[derive(Clone, Debug)]
pub struct Scale {
    /// The quantity.
    pub label: String,
    /// Its value at 1; what lies above is drawn as that.
    pub top: f64,
}

const GREY: [Rgb; 2] = [[238, 238, 236], [150, 151, 152]];
/// Sands of a sand box: neighbours differ in lightness too, so that they stay apart in grey.
const SANDS: [Rgb; 4] = [
    [238, 206, 130],
    [170, 68, 44],
    [248, 240, 222],
    [62, 92, 122],
];
/// First bodies: red, ochre.
const TIED: [Rgb; 2] = [[200, 60, 48], [222, 164, 62]];
const LOOSE: Rgb = [58, 104, 176];
const OUT: Rgb = [168, 200, 226];
const VALUES: [Rgb; 5] = [
    [240, 238, 230],
    [254, 204, 110],
    [240, 104, 44],
    [160, 20, 70],
    [40, 6, 56],
];

impl Paint {
    /// The colour of a grain of this shade, 0 light to 1 dark.
    pub(super) fn colour(self, shade: f64) -> Rgb {
        let dim = |colour| mix(colour, [60, 60, 64], 0.45 * shade);
        match self {
            Self::Grey => mix(GREY[0], GREY[1], shade),
            Self::Layer(k) => dim(SANDS[k.rem_euclid(4) as usize]),
            Self::Tied(k) => dim(TIED[k % TIED.len()]),
            Self::Loose => dim(LOOSE),
            Self::Out => dim(OUT),
            Self::Value(v) if v.is_nan() => mix(GREY[0], GREY[1], 0.6),
            Self::Value(v) => dim(value(v)),
        }
    }
}

fn value(v: f64) -> Rgb {
    let place = v.clamp(0.0, 1.0) * (VALUES.len() - 1) as f64;
    let k = (place as usize).min(VALUES.len() - 2);
    mix(VALUES[k], VALUES[k + 1], place - k as f64)
}

/// The colours of a scale with its ends and its name, from a point on the middle of the line.
pub(super) fn scale(page: &mut Canvas, scale: &Scale, [left, middle]: [f32; 2], u: f32) {
    let em = 23.0 * u;
    let ends = ["0".to_owned(), format!("{} or more", scale.top)];
    let low = left + text_width(&ends[0], em) + 14.0 * u;
    let (length, thick) = ((220.0 * u).round(), 20.0 * u);
    for i in 0..length as i32 {
        let colour = value(f64::from(i) / f64::from(length));
        page.rect([low + i as f32, middle - thick / 2.0, 1.0, thick], colour);
    }
    let style = TextStyle::new(em, INK);
    let base = middle + 0.34 * em;
    page.text(
        &ends[0],
        [low - 14.0 * u, base],
        &style.anchored(Anchor::End),
    );
    page.text(
        &format!("{}: {}", ends[1], scale.label),
        [low + length + 14.0 * u, base],
        &TextStyle::new(em, INK),
    );
}

#[cfg(test)]
mod tests {
    use super::*;

    fn light(c: Rgb) -> u32 {
        c.iter().map(|x| u32::from(*x)).sum()
    }

    #[test]
    fn values_grow_darker_and_layers_alternate() {
        let shades: Vec<u32> = (0..=10)
            .map(|k| light(Paint::Value(0.1 * f64::from(k)).colour(0.0)))
            .collect();
        assert!(shades.windows(2).all(|w| w[1] < w[0]), "{shades:?}");
        assert_eq!(Paint::Value(7.0).colour(0.0), Paint::Value(1.0).colour(0.0));
        for k in -3..4 {
            let [a, b] = [k, k + 1].map(|k| light(Paint::Layer(k).colour(0.0)));
            assert!(a.abs_diff(b) > 100, "layers {k}: {a} and {b}");
        }
        assert_eq!(Paint::Layer(-4).colour(0.3), Paint::Layer(4).colour(0.3));
    }
}
