//! Antialiased drawing surface in pixels, y downwards, saved as PNG.

use std::fs::File;
use std::io::BufWriter;
use std::path::{Path, PathBuf};

use tiny_skia::{
    FillRule, LineCap, LineJoin, Paint, PathBuilder, Pixmap, PixmapPaint, Rect, Stroke, StrokeDash,
    Transform,
};

use super::font::{self, TextStyle};
use super::notice;

/// Error in drawing a picture.
#[derive(Debug, thiserror::Error)]
pub enum DrawError {
    /// The file could not be written.
    #[error(
        "cannot write the picture {}: {reason}; name a file ending in .png, in an existing folder you may write to",
        path.display()
    )]
    Write {
        /// Requested file.
        path: PathBuf,
        /// Message of the operating system.
        reason: String,
    },
    /// The requested size cannot be drawn.
    #[error(
        "a picture of {width} x {height} pixels cannot be drawn; ask for 200 to 16384 pixels a side"
    )]
    Size {
        /// Requested width, pixels.
        width: u32,
        /// Requested height, pixels.
        height: u32,
    },
    /// The window of a frame is empty or not finite.
    #[error(
        "the frame's window {0:?} m shows nothing; give [xmin, xmax, ymin, ymax] with xmin < xmax and ymin < ymax"
    )]
    Window([f64; 4]),
    /// An axis range is empty or not finite, or not positive on a log axis.
    #[error(
        "the range {from} to {to} of axis '{axis}' shows nothing; give a first bound below the second{}",
        if *.log { ", both above zero on a log axis" } else { "" }
    )]
    Range {
        /// Name of the axis.
        axis: String,
        /// First bound.
        from: f64,
        /// Second bound.
        to: f64,
        /// Whether the axis is logarithmic.
        log: bool,
    },
    /// The built-in fonts cannot be read.
    #[error("the fonts built into this program cannot be read; build it again from clean sources")]
    Font,
}

/// Red, green, blue.
pub(crate) type Rgb = [u8; 3];

pub(crate) const WHITE: Rgb = [255, 255, 255];
pub(crate) const INK: Rgb = [28, 30, 34];
pub(crate) const SOFT_INK: Rgb = [95, 99, 106];

/// Width of a page in layout units. Text is 28 units high: 9 pt if the page is printed 16 cm wide.
pub(crate) const PAGE: f32 = 1400.0;
/// Height of text in layout units.
pub(crate) const TEXT: f32 = 28.0;

/// Wraps text into lines of a width, broken at spaces.
pub(crate) fn wrapped(text: &str, size: f32, room: f32) -> Vec<String> {
    let words: Vec<&str> = text.split_whitespace().collect();
    joined(&words, " ", size, room)
}

/// Joins parts into the fewest lines of a given width.
pub(crate) fn joined<T: AsRef<str>>(
    parts: &[T],
    between: &str,
    size: f32,
    room: f32,
) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for part in parts.iter().map(AsRef::as_ref) {
        match lines.last_mut() {
            Some(line) if font::text_width(&format!("{line}{between}{part}"), size) <= room => {
                *line += between;
                *line += part;
            }
            _ => lines.push(part.to_owned()),
        }
    }
    lines
}

/// Interpolates between two colours, with `t` in 0..1.
pub(crate) fn mix(a: Rgb, b: Rgb, t: f64) -> Rgb {
    let t = t.clamp(0.0, 1.0);
    std::array::from_fn(|i| {
        (f64::from(a[i]) + t * (f64::from(b[i]) - f64::from(a[i]))).round() as u8
    })
}

/// Interpolates along a table of colours, with `t` in 0..1.
pub(crate) fn along(table: &[Rgb], t: f64) -> Rgb {
    let place = t.clamp(0.0, 1.0) * (table.len() - 1) as f64;
    let k = (place as usize).min(table.len() - 2);
    mix(table[k], table[k + 1], place - k as f64)
}

fn paint(colour: Rgb) -> Paint<'static> {
    let mut paint = Paint::default();
    paint.set_color_rgba8(colour[0], colour[1], colour[2], 255);
    paint.anti_alias = true;
    paint
}

/// The surface.
pub(crate) struct Canvas {
    pub pixmap: Pixmap,
}

impl Canvas {
    /// Creates a white surface; an error if the size is out of range.
    pub fn new(width: u32, height: u32) -> Result<Self, DrawError> {
        if font::faces().is_empty() {
            return Err(DrawError::Font);
        }
        let mut canvas = Self::clear(width, height)?;
        canvas.pixmap.fill(tiny_skia::Color::WHITE);
        Ok(canvas)
    }

    /// Creates a transparent surface.
    pub fn clear(width: u32, height: u32) -> Result<Self, DrawError> {
        let error = DrawError::Size { width, height };
        if width > 16384 || height > 16384 {
            return Err(error);
        }
        let pixmap = Pixmap::new(width, height).ok_or(error)?;
        Ok(Self { pixmap })
    }

    pub fn fill_path(&mut self, path: &tiny_skia::Path, colour: Rgb) {
        self.pixmap.fill_path(
            path,
            &paint(colour),
            FillRule::Winding,
            Transform::identity(),
            None,
        );
    }

    /// Fills a closed polygon.
    pub fn polygon(&mut self, points: &[[f32; 2]], colour: Rgb) {
        if let Some(path) = polyline_path(points, true) {
            self.fill_path(&path, colour);
        }
    }

    /// Fills a circle.
    pub fn circle(&mut self, centre: [f32; 2], radius: f32, colour: Rgb) {
        if let Some(path) = PathBuilder::from_circle(centre[0], centre[1], radius) {
            self.fill_path(&path, colour);
        }
    }

    /// Paints a disk with a colour that depends on the offset from its centre and the distance, in
    /// pixels. For thousands of grains this is much faster than paths or gradients.
    pub fn disk(
        &mut self,
        [x, y]: [f32; 2],
        radius: f32,
        colour: impl Fn([f32; 2], f32) -> [f32; 3],
    ) {
        let (width, height) = (self.pixmap.width(), self.pixmap.height());
        let rows =
            (y - radius - 1.0).max(0.0) as u32..((y + radius + 2.0).max(0.0) as u32).min(height);
        let pixels = self.pixmap.data_mut();
        for row in rows {
            let dy = row as f32 + 0.5 - y;
            // Columns that the disk does not reach in this row are skipped.
            let reach = (radius + 1.0) * (radius + 1.0) - dy * dy;
            if reach <= 0.0 {
                continue;
            }
            let half = reach.sqrt();
            let from = (x - half - 1.0).max(0.0) as u32;
            let to = ((x + half + 2.0).max(0.0) as u32).min(width);
            for column in from..to {
                let dx = column as f32 + 0.5 - x;
                let distance = (dx * dx + dy * dy).sqrt();
                let cover = (radius - distance + 0.5).min(1.0);
                if cover <= 0.0 {
                    continue;
                }
                let at = 4 * (row as usize * width as usize + column as usize);
                let ink = colour([dx, dy], distance);
                for (pixel, ink) in pixels[at..at + 3].iter_mut().zip(ink) {
                    let under = f32::from(*pixel);
                    *pixel = (under + cover * (ink - under) + 0.5) as u8;
                }
            }
        }
    }

    /// Writes rows of opaque pixels, `across` per row, from the top left corner.
    pub fn write(&mut self, across: usize, pixels: &[Rgb]) {
        let width = self.pixmap.width() as usize;
        let rows = self.pixmap.data_mut().chunks_exact_mut(4 * width);
        for (to, from) in rows.zip(pixels.chunks_exact(across.max(1))) {
            for (to, from) in to.chunks_exact_mut(4).zip(from) {
                to[..3].copy_from_slice(from);
                to[3] = 255;
            }
        }
    }

    /// Fills a rectangle given by its left, top, width and height.
    pub fn rect(&mut self, [left, top, width, height]: [f32; 4], colour: Rgb) {
        if let Some(rect) = Rect::from_xywh(left, top, width, height) {
            self.pixmap
                .fill_rect(rect, &paint(colour), Transform::identity(), None);
        }
    }

    /// Strokes the edge of a rectangle.
    pub fn frame(&mut self, [left, top, w, h]: [f32; 4], width: f32, colour: Rgb) {
        let corners = [
            [left, top],
            [left + w, top],
            [left + w, top + h],
            [left, top + h],
        ];
        self.stroke(&corners, true, width, colour, None);
    }

    /// Strokes a line through points. Long lines are split into overlapping pieces, since the cost
    /// of a stroke grows faster than its length.
    pub fn stroke(
        &mut self,
        points: &[[f32; 2]],
        closed: bool,
        width: f32,
        colour: Rgb,
        dash: Option<[f32; 2]>,
    ) {
        const PIECE: usize = 1500;
        let stroke = Stroke {
            width,
            line_cap: LineCap::Round,
            line_join: LineJoin::Round,
            dash: dash.and_then(|d| StrokeDash::new(d.to_vec(), 0.0)),
            ..Stroke::default()
        };
        let whole = closed || dash.is_some() || points.len() <= PIECE;
        let step = if whole { points.len().max(1) } else { PIECE };
        for start in (0..points.len()).step_by(step) {
            let end = (start + step + 1).min(points.len());
            if let Some(path) = polyline_path(&points[start..end], closed) {
                self.pixmap.stroke_path(
                    &path,
                    &paint(colour),
                    &stroke,
                    Transform::identity(),
                    None,
                );
            }
        }
    }

    /// Writes a line of text with its anchor on the baseline at a point.
    pub fn text(&mut self, text: &str, at: [f32; 2], style: &TextStyle) {
        let Some(path) = font::text_path(text, style) else {
            return;
        };
        let place = Transform::from_translate(at[0], at[1]);
        let mut outline = |colour: Rgb, width: f32| {
            let stroke = Stroke {
                width,
                line_join: LineJoin::Round,
                ..Stroke::default()
            };
            self.pixmap
                .stroke_path(&path, &paint(colour), &stroke, place, None);
        };
        if let Some(halo) = style.halo {
            outline(halo, 0.28 * style.size);
        }
        outline(style.colour, style.weight * style.size);
        self.pixmap
            .fill_path(&path, &paint(style.colour), FillRule::Winding, place, None);
    }

    /// Composites another surface over this one at a pixel.
    pub fn lay(&mut self, over: &Canvas, left: i32, top: i32) {
        self.pixmap.draw_pixmap(
            left,
            top,
            over.pixmap.as_ref(),
            &PixmapPaint::default(),
            Transform::identity(),
            None,
        );
    }

    /// Copies another surface onto this one; the part outside is clipped.
    pub fn paste(&mut self, over: &Canvas, left: usize, top: usize) {
        let (across, over_across) = (self.pixmap.width() as usize, over.pixmap.width() as usize);
        let kept = over_across.min(across.saturating_sub(left));
        let rows = self.pixmap.pixels_mut().chunks_exact_mut(across).skip(top);
        for (to, from) in rows.zip(over.pixmap.pixels().chunks_exact(over_across)) {
            to[left..left + kept].copy_from_slice(&from[..kept]);
        }
    }

    /// Writes the surface, which is opaque, to a PNG file: without its alpha channel and with fast
    /// compression, about ten times as fast as tiny-skia's own writer. A description of what it
    /// shows is stored in the file as the text `Description`, unless it is empty.
    pub fn save(&self, path: &Path, shows: &str) -> Result<(), DrawError> {
        match notice::current() {
            Some(text) => notice::banded(self, &text)?.write_file(path, shows),
            None => self.write_file(path, shows),
        }
    }

    fn write_file(&self, path: &Path, shows: &str) -> Result<(), DrawError> {
        let size = (self.pixmap.width(), self.pixmap.height());
        let pixels = self.pixmap.data().as_chunks::<4>().0;
        let mut rgb = vec![0; 3 * pixels.len()];
        for (to, from) in rgb.as_chunks_mut::<3>().0.iter_mut().zip(pixels) {
            *to = [from[0], from[1], from[2]];
        }
        write_png(path, size, &rgb, shows).map_err(|e| DrawError::Write {
            path: path.to_owned(),
            reason: reason(&e),
        })
    }
}

/// Writes rows of red, green and blue bytes as a PNG file.
fn write_png(
    path: &Path,
    size: (u32, u32),
    rgb: &[u8],
    shows: &str,
) -> Result<(), png::EncodingError> {
    let file = BufWriter::new(File::create(path)?);
    let mut encoder = png::Encoder::new(file, size.0, size.1);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::Fast);
    // The filter encodes differences between rows. Choosing among all filters for each row takes
    // longer than the rest and saves a tenth of the size.
    encoder.set_filter(png::Filter::Up);
    if !shows.is_empty() {
        encoder.add_itxt_chunk("Description".to_owned(), shows.to_owned())?;
    }
    let mut writer = encoder.write_header()?;
    writer.write_image_data(rgb)?;
    writer.finish()
}

/// The innermost cause, since the errors around it add nothing for a user.
fn reason(error: &dyn std::error::Error) -> String {
    let mut cause = error;
    while let Some(inner) = cause.source() {
        cause = inner;
    }
    cause.to_string()
}

/// Path through points; a single point becomes a dot when stroked.
fn polyline_path(points: &[[f32; 2]], closed: bool) -> Option<tiny_skia::Path> {
    let (first, rest) = points.split_first()?;
    let mut builder = PathBuilder::with_capacity(points.len() + 2, points.len() + 2);
    builder.move_to(first[0], first[1]);
    if rest.is_empty() {
        builder.line_to(first[0] + 0.01, first[1]);
    }
    for p in rest {
        builder.line_to(p[0], p[1]);
    }
    if closed {
        builder.close();
    }
    builder.finish()
}

/// Width and height in the header of a PNG file, for tests.
#[cfg(test)]
pub(crate) fn png_size(path: &Path) -> (u32, u32) {
    let bytes = std::fs::read(path).unwrap();
    assert_eq!(&bytes[..8], b"\x89PNG\r\n\x1a\n", "not a PNG file");
    let number = |at: usize| u32::from_be_bytes(bytes[at..at + 4].try_into().unwrap());
    (number(16), number(20))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn unreasonable_sizes_are_refused() {
        let error = Canvas::new(0, 100).err().unwrap().to_string();
        assert!(error.contains("0 x 100"), "{error}");
        assert!(Canvas::new(100_000, 10).is_err());
    }

    #[test]
    fn unwritable_path_is_named() {
        let path = Path::new("no-such-folder/picture.png");
        let error = Canvas::new(10, 10).unwrap().save(path, "").unwrap_err();
        assert!(error.to_string().contains("no-such-folder"), "{error}");
    }

    #[test]
    fn long_lines_have_no_hole_between_pieces() {
        let mut canvas = Canvas::new(100, 10).unwrap();
        let points: Vec<_> = (0..4000).map(|i| [i as f32 / 40.0, 5.0]).collect();
        canvas.stroke(&points, false, 3.0, INK, None);
        assert!((1..99).all(|x| canvas.pixmap.pixel(x, 5).unwrap().red() == INK[0]));
    }
}
