//! Text as vector outlines from built-in fonts, so that pictures are identical on every machine.

use std::sync::OnceLock;

use ab_glyph::{Font, FontRef, GlyphId, OutlineCurve};
use epaint_default_fonts::{HACK_REGULAR, UBUNTU_LIGHT};
use tiny_skia::{Path, PathBuilder};

use super::canvas::Rgb;

/// Horizontal anchor of a line of text.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Anchor {
    Start,
    Middle,
    End,
}

/// Style of a line of text.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TextStyle {
    /// Em size in pixels.
    pub size: f32,
    pub colour: Rgb,
    pub anchor: Anchor,
    /// Width by which the outline of the light face is thickened, as a fraction of the em. One face
    /// thereby serves as regular and semi-bold, and is readable at small sizes.
    pub weight: f32,
    /// Rotated to read upwards, for vertical axes.
    pub upwards: bool,
    /// Colour of a halo that keeps the text readable over a drawing.
    pub halo: Option<Rgb>,
}

impl TextStyle {
    /// Regular text that starts at its anchor.
    pub fn new(size: f32, colour: Rgb) -> Self {
        Self {
            size,
            colour,
            anchor: Anchor::Start,
            weight: 0.022,
            upwards: false,
            halo: None,
        }
    }

    pub fn anchored(mut self, anchor: Anchor) -> Self {
        self.anchor = anchor;
        self
    }

    pub fn bold(mut self) -> Self {
        self.weight = 0.06;
        self
    }

    pub fn upwards(mut self) -> Self {
        self.upwards = true;
        self
    }

    pub fn halo(mut self, colour: Rgb) -> Self {
        self.halo = Some(colour);
        self
    }
}

/// The text face, and a face with the symbols that it lacks.
pub(crate) fn faces() -> &'static [FontRef<'static>] {
    static FACES: OnceLock<Vec<FontRef<'static>>> = OnceLock::new();
    FACES.get_or_init(|| {
        [UBUNTU_LIGHT, HACK_REGULAR]
            .into_iter()
            .filter_map(|bytes| FontRef::try_from_slice(bytes).ok())
            .collect()
    })
}

/// The first face that has the character, otherwise the missing-glyph box of the first face.
fn glyph(character: char) -> Option<(usize, GlyphId)> {
    let faces = faces();
    faces
        .iter()
        .map(|face| face.glyph_id(character))
        .enumerate()
        .find(|(_, id)| id.0 != 0)
        .or_else(|| faces.first().map(|face| (0, face.glyph_id(character))))
}

/// A glyph of a line.
struct PlacedGlyph {
    face: usize,
    id: GlyphId,
    /// Horizontal position, and em size, pixels.
    pen: f32,
    size: f32,
    /// Distance below the baseline, pixels.
    drop: f32,
}

/// Vertical level of a character.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Level {
    Line,
    Below,
    Above,
}

/// Characters of a line with their levels. One or two letters or digits after a single letter and
/// `_` are subscripts, as in `v_x`; other underscores are part of names. Superscript digits are set
/// from smaller regular digits, since the faces lack some of them.
fn levels(text: &str) -> Vec<(char, Level)> {
    let all: Vec<char> = text.chars().collect();
    let word = |k: usize| all.get(k).is_some_and(|c| c.is_alphanumeric() || *c == '_');
    let mut out = Vec::with_capacity(all.len());
    let mut k = 0;
    while k < all.len() {
        let symbol = k > 0 && all[k - 1].is_alphabetic() && !(k > 1 && word(k - 2));
        let rest = k + 1..all.len();
        let long = rest.take_while(|i| all[*i].is_alphanumeric()).count();
        if all[k] == '_' && symbol && (1..=2).contains(&long) && !word(k + 1 + long) {
            out.extend(all[k + 1..=k + long].iter().map(|c| (*c, Level::Below)));
            k += long + 1;
            continue;
        }
        out.push(match "⁰¹²³⁴⁵⁶⁷⁸⁹⁻".chars().position(|c| c == all[k]) {
            Some(10) => ('−', Level::Above),
            Some(digit) => (char::from(b'0' + digit as u8), Level::Above),
            None => (all[k], Level::Line),
        });
        k += 1;
    }
    out
}

/// Glyphs of a line with their positions, and its width, in pixels.
fn set_line(text: &str, size: f32) -> (Vec<PlacedGlyph>, f32) {
    let mut pen = 0.0;
    let mut previous = None;
    let mut glyphs = Vec::with_capacity(text.len());
    for (character, level) in levels(text) {
        let Some((face_index, id)) = glyph(character) else {
            continue;
        };
        let Some(face) = faces().get(face_index) else {
            continue;
        };
        let (size, drop) = match level {
            Level::Line => (size, 0.0),
            Level::Below => (0.72 * size, 0.2 * size),
            Level::Above => (0.68 * size, -0.36 * size),
        };
        let scale = size / face.units_per_em().unwrap_or(1000.0);
        if let Some((before_face, before)) = previous
            && before_face == face_index
        {
            pen += scale * face.kern_unscaled(before, id);
        }
        glyphs.push(PlacedGlyph {
            face: face_index,
            id,
            pen,
            size,
            drop,
        });
        pen += scale * face.h_advance_unscaled(id);
        previous = Some((face_index, id));
    }
    (glyphs, pen)
}

/// Width of a line of text in pixels for an em size in pixels.
pub(crate) fn text_width(text: &str, size: f32) -> f32 {
    set_line(text, size).1
}

/// Outline of a line of text, with its anchor on the baseline at the origin.
pub(crate) fn text_path(text: &str, style: &TextStyle) -> Option<Path> {
    let (glyphs, width) = set_line(text, style.size);
    let start = match style.anchor {
        Anchor::Start => 0.0,
        Anchor::Middle => -width / 2.0,
        Anchor::End => -width,
    };
    let mut builder = PathBuilder::new();
    for set in glyphs {
        let Some(face) = faces().get(set.face) else {
            continue;
        };
        let Some(outline) = face.outline(set.id) else {
            continue;
        };
        let scale = set.size / face.units_per_em().unwrap_or(1000.0);
        let place = |p: ab_glyph::Point| {
            let (x, y) = (start + set.pen + scale * p.x, set.drop - scale * p.y);
            if style.upwards { (y, -x) } else { (x, y) }
        };
        let mut last = None;
        for curve in &outline.curves {
            let (from, to) = match *curve {
                OutlineCurve::Line(a, b) => (a, b),
                OutlineCurve::Quad(a, _, b) => (a, b),
                OutlineCurve::Cubic(a, _, _, b) => (a, b),
            };
            // The font gives one list of curves; a jump between them starts a new contour.
            if last != Some(from) {
                if last.is_some() {
                    builder.close();
                }
                let (x, y) = place(from);
                builder.move_to(x, y);
            }
            let (x, y) = place(to);
            match *curve {
                OutlineCurve::Line(..) => builder.line_to(x, y),
                OutlineCurve::Quad(_, c, _) => {
                    let (cx, cy) = place(c);
                    builder.quad_to(cx, cy, x, y);
                }
                OutlineCurve::Cubic(_, c, d, _) => {
                    let ((cx, cy), (dx, dy)) = (place(c), place(d));
                    builder.cubic_to(cx, cy, dx, dy, x, y);
                }
            }
            last = Some(to);
        }
        if last.is_some() {
            builder.close();
        }
    }
    builder.finish()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_symbol_of_the_axes_has_a_glyph() {
        for c in "δµφμσθτεωξ→·×−⁰¹²³⁴⁵⁶⁷⁸⁹⁻°≈≤½".chars() {
            let (_, id) = glyph(c).unwrap();
            assert_ne!(id.0, 0, "no glyph for {c}");
        }
    }

    #[test]
    fn symbols_have_subscripts_and_names_keep_their_underscores() {
        let shown = |text: &str| -> String {
            let mark = |(c, level): (char, Level)| match level {
                Level::Line => c.to_string(),
                Level::Below => format!("<{c}>"),
                Level::Above => format!("^{c}"),
            };
            levels(text).into_iter().map(mark).collect()
        };
        assert_eq!(shown("force F_x (N)"), "force F<x> (N)");
        assert_eq!(shown("σ_yy, across"), "σ<y><y>, across");
        assert_eq!(shown("2×10⁻¹⁶ m²"), "2×10^−^1^6 m^2");
        for name in ["damage_ratio", "my_x", "a_long", "v_", "_x", "a_b_c"] {
            assert_eq!(shown(name), name);
        }
        assert!(text_width("v_x", 20.0) < text_width("vx", 20.0));
    }

    #[test]
    fn width_grows_with_text_and_size() {
        assert_eq!(text_width("", 20.0), 0.0);
        assert!(text_width("rail", 20.0) < text_width("rail wheel", 20.0));
        let (small, large) = (text_width("rail", 10.0), text_width("rail", 20.0));
        assert!((2.0 * small - large).abs() < 1e-3);
    }

    #[test]
    fn anchored_text_is_centred() {
        let style = TextStyle::new(30.0, [0, 0, 0]).anchored(Anchor::Middle);
        let bounds = text_path("HoH", &style).unwrap().bounds();
        assert!((bounds.left() + bounds.right()).abs() < 1.0);
        assert!(text_path(" ", &style).is_none());
    }
}
