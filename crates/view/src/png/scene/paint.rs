//! Colours of grains.

use crate::png::canvas::{Canvas, DrawError, INK, Rgb, TEXT, along, mix};
use crate::png::chart::{AxisScale, check_range};
use crate::png::font::{Anchor, TextStyle, text_width};
use fretwork_observe::chart::Axis;
use fretwork_observe::picture::Paint;

/// Legend of the colours of [`Paint::Value`], or of bonds.
#[derive(Clone, Debug)]
pub struct ColourScale {
    /// The quantity.
    pub label: String,
    /// SI unit without prefix, empty for a pure number.
    pub unit: String,
    /// Value at the end of the colour scale; larger values are drawn the same.
    pub top: f64,
    /// Whether the value is the damage of bonds between grains. Otherwise it is a value of the
    /// grains.
    pub bonds: bool,
}

const GREY: [Rgb; 2] = [[238, 238, 236], [150, 151, 152]];
/// Colours of layers; neighbours also differ in lightness, so that they are distinct in grey.
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
/// Bonds: undamaged, and damaged.
pub(crate) const SOUND: Rgb = [150, 0, 12];
pub(crate) const DAMAGED: Rgb = [255, 112, 20];
const VALUES: [Rgb; 5] = [
    [242, 240, 232],
    [254, 204, 110],
    [240, 104, 44],
    [168, 24, 76],
    [66, 14, 84],
];

/// Objects that have a colour in a picture.
pub(crate) trait Coloured {
    /// The colour of a grain of this shade, 0 light to 1 dark.
    fn colour(self, shade: f64) -> Rgb;
}

impl Coloured for Paint {
    fn colour(self, shade: f64) -> Rgb {
        let dim = |colour| mix(colour, [60, 60, 64], 0.45 * shade);
        match self {
            Self::Grey => mix(GREY[0], GREY[1], shade),
            Self::Layer(k) => dim(SANDS[k.rem_euclid(4) as usize]),
            Self::Tied(k) => dim(TIED[k % TIED.len()]),
            Self::Loose => dim(LOOSE),
            Self::Out => dim(OUT),
            Self::Value(v) if v.is_nan() => mix(GREY[0], GREY[1], 0.6),
            Self::Value(v) => dim(along(&VALUES, v)),
        }
    }
}

/// Draws a colour bar of a length in layout units with its ticks and name, from a point on the
/// middle of the bar; the ticks are below.
pub(crate) fn colour_bar(
    page: &mut Canvas,
    scale: &ColourScale,
    [left, middle]: [f32; 2],
    length: f32,
    u: f32,
) -> Result<(), DrawError> {
    let em = 0.9 * TEXT * u;
    let axis = Axis::new(scale.label.clone(), scale.unit.clone());
    let ends = Some((0.0, scale.top));
    check_range(&axis, ends)?;
    let fitted = AxisScale::new(&axis, axis.range([].into_iter(), ends), 3);
    let (length, thick) = ((length * u).round(), (22.0 * u).round());
    let (left, top) = ((left + 0.5 * em).round(), (middle - thick / 2.0).round());
    for i in 0..length as i32 {
        let share = f64::from(i) / f64::from(length);
        let colour = match scale.bonds {
            true => mix(SOUND, DAMAGED, share),
            false => along(&VALUES, share),
        };
        page.rect([left + i as f32, top, 1.0, thick], colour);
    }
    page.frame([left, top, length, thick], 1.3 * u, INK);
    let style = TextStyle::new(em, INK);
    for (at, label) in &fitted.ticks {
        let x = left + length * fitted.share(*at) as f32;
        page.rect([x - 0.8 * u, top + thick, 1.6 * u, 7.0 * u], INK);
        let base = top + thick + 7.0 * u + em;
        page.text(label, [x, base], &style.anchored(Anchor::Middle));
    }
    let name = TextStyle::new(TEXT * u, INK);
    let room = page.pixmap.width() as f32 - left - length - 60.0 * u;
    let size = name.size * (room / text_width(&fitted.label, name.size)).min(1.0);
    let at = [left + length + 24.0 * u, middle + 0.34 * size];
    page.text(&fitted.label, at, &TextStyle::new(size, INK));
    Ok(())
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
