//! Pixel buffer with depth: nearer objects hide farther ones in any drawing order.

use crate::png::canvas::Rgb;

/// A corner of a polygon: pixels to the right, downwards, and towards the viewer.
pub(crate) type Corner = [f64; 3];

/// A surface of pixels with depths; larger depths are nearer.
pub(crate) struct Raster {
    width: usize,
    height: usize,
    colour: Vec<Rgb>,
    depth: Vec<f32>,
}

/// How a polygon is blended.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Blend {
    /// Hides what is behind it.
    Opaque,
    /// Tints what is behind it by this fraction, and leaves the depth unchanged.
    Veil(f32),
}

impl Raster {
    /// Creates a buffer of one colour at infinite depth.
    pub fn new(width: usize, height: usize, ground: Rgb) -> Self {
        Self {
            width,
            height,
            colour: vec![ground; width * height],
            depth: vec![f32::NEG_INFINITY; width * height],
        }
    }

    /// Pixel rows that a range touches.
    fn rows(&self, low: f64, high: f64) -> std::ops::Range<usize> {
        span(low, high, self.height)
    }

    /// Draws a lit sphere.
    pub fn sphere(&mut self, [x, y, z]: Corner, radius: f64, base: Rgb) {
        // The light comes from the upper left in front of the picture; the vector has unit length.
        const LIGHT: [f32; 3] = [-0.45, -0.6, 0.661];
        // The smallest spheres remain visible.
        let radius = radius.max(0.75);
        let base = base.map(f32::from);
        for row in self.rows(y - radius, y + radius) {
            let ny = (row as f64 + 0.5 - y) / radius;
            let half = radius * (1.0 - ny * ny).max(0.0).sqrt();
            let columns = span(x - half, x + half, self.width);
            let first = ((columns.start as f64 + 0.5 - x) / radius) as f32;
            let (per_column, across) = ((1.0 / radius) as f32, (1.0 - ny * ny) as f32);
            let (z, high, ny) = (z as f32, radius as f32, ny as f32);
            let at = row * self.width;
            let range = at + columns.start..at + columns.end;
            let pixels = self.colour[range.clone()].iter_mut();
            for (k, (pixel, nearest)) in pixels.zip(&mut self.depth[range]).enumerate() {
                let nx = first + k as f32 * per_column;
                let inside = across - nx * nx;
                if inside < 0.0 {
                    continue;
                }
                let nz = inside.sqrt();
                let depth = z + high * nz;
                if depth <= *nearest {
                    continue;
                }
                *nearest = depth;
                let facing = (LIGHT[0] * nx + LIGHT[1] * ny + LIGHT[2] * nz).max(0.0);
                // The rim is darkened as well, so that equal spheres are distinguishable.
                let light = (0.5 + 0.54 * facing) * (0.62 + 0.38 * nz.sqrt());
                let gleam = 36.0 * facing.powi(24);
                // `map` is not used, since it is not inlined.
                let lit = |c: f32| (light * c + gleam).min(255.0) as u8;
                *pixel = [lit(base[0]), lit(base[1]), lit(base[2])];
            }
        }
    }

    /// Calls a function with the index and depth of each pixel of a convex polygon.
    fn scan(&self, corners: &[Corner], mut call: impl FnMut(usize, f32)) {
        let Some([a, b, c]) = plane(corners) else {
            return;
        };
        let ys = corners.iter().map(|p| p[1]);
        let (low, high) = ys.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), y| {
            (l.min(y), h.max(y))
        });
        for row in self.rows(low, high) {
            let y = row as f64 + 0.5;
            let (mut left, mut right) = (f64::INFINITY, f64::NEG_INFINITY);
            for (k, p) in corners.iter().enumerate() {
                let q = &corners[(k + 1) % corners.len()];
                if (p[1] <= y) != (q[1] <= y) {
                    let x = p[0] + (y - p[1]) / (q[1] - p[1]) * (q[0] - p[0]);
                    (left, right) = (left.min(x), right.max(x));
                }
            }
            if left > right {
                continue;
            }
            for column in span(left, right, self.width) {
                let x = column as f64 + 0.5;
                if x >= left && x < right {
                    call(row * self.width + column, (a * x + b * y + c) as f32);
                }
            }
        }
    }

    /// Fills a convex polygon.
    pub fn polygon(&mut self, corners: &[Corner], colour: Rgb, cover: Blend) {
        let (mut pixels, mut depths) = (
            std::mem::take(&mut self.colour),
            std::mem::take(&mut self.depth),
        );
        self.scan(corners, |at, depth| {
            if depth <= depths[at] {
                return;
            }
            match cover {
                Blend::Opaque => (pixels[at], depths[at]) = (colour, depth),
                Blend::Veil(share) => pixels[at] = tinted(pixels[at], colour, share),
            }
        });
        (self.colour, self.depth) = (pixels, depths);
    }

    /// Returns the number of pixels that a convex polygon covers, and of those in front of
    /// something.
    pub fn hidden(&self, corners: &[Corner]) -> (usize, usize) {
        let (mut covered, mut hidden) = (0, 0);
        self.scan(corners, |at, depth| {
            covered += 1;
            let behind = self.depth[at];
            hidden += usize::from(behind > f32::NEG_INFINITY && behind < depth);
        });
        (covered, hidden)
    }

    /// Draws a straight line, hidden by objects nearer by more than `lift` pixels, so that a line
    /// on a steep face is not hidden by that face.
    pub fn line(&mut self, a: Corner, b: Corner, width: f64, lift: f64, colour: Rgb, share: f32) {
        let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
        let length = dx.hypot(dy);
        if !(length > 0.0 && length.is_finite()) {
            return;
        }
        let half = 0.5 * width;
        for row in self.rows(a[1].min(b[1]) - half, a[1].max(b[1]) + half) {
            let y = row as f64 + 0.5;
            // Intersection of the strip about the line with the row.
            let reach = half + 1.0;
            let (from, to) = if dy.abs() > 1e-9 * length {
                let middle = a[0] + (y - a[1]) / dy * dx;
                let wide = reach * length / dy.abs();
                (middle - wide, middle + wide)
            } else {
                (f64::NEG_INFINITY, f64::INFINITY)
            };
            let from = from.max(a[0].min(b[0]) - reach);
            let to = to.min(a[0].max(b[0]) + reach);
            if from > to {
                continue;
            }
            for column in span(from, to, self.width) {
                let (px, py) = (column as f64 + 0.5 - a[0], y - a[1]);
                let t = ((px * dx + py * dy) / (length * length)).clamp(0.0, 1.0);
                let distance = (px - t * dx).hypot(py - t * dy);
                let at = row * self.width + column;
                let depth = (a[2] + t * (b[2] - a[2]) + lift) as f32;
                let cover = (half + 0.5 - distance).clamp(0.0, 1.0) as f32;
                if cover > 0.0 && depth > self.depth[at] {
                    self.colour[at] = tinted(self.colour[at], colour, share * cover);
                }
            }
        }
    }

    /// Halves the resolution by the mean of four pixels. Returns width, height, and rows of red,
    /// green and blue.
    pub fn halved(&self) -> (usize, usize, Vec<Rgb>) {
        let (width, height) = (self.width / 2, self.height / 2);
        let mut out = Vec::with_capacity(width * height);
        for two_rows in self.colour.chunks_exact(2 * self.width).take(height) {
            let (upper, lower) = two_rows.split_at(self.width);
            let (upper, lower) = (upper.as_chunks::<2>().0, lower.as_chunks::<2>().0);
            out.extend(upper.iter().zip(lower).map(|([a, b], [c, d])| {
                let of = |p: &Rgb, i: usize| u16::from(p[i]);
                let mean = |i: usize| ((of(a, i) + of(b, i) + of(c, i) + of(d, i) + 2) / 4) as u8;
                // `map` is not used, since it is not inlined.
                [mean(0), mean(1), mean(2)]
            }));
        }
        (width, height, out)
    }

    /// Returns width, height, and rows of red, green and blue.
    pub fn pixels(self) -> (usize, usize, Vec<Rgb>) {
        (self.width, self.height, self.colour)
    }
}

fn span(low: f64, high: f64, end: usize) -> std::ops::Range<usize> {
    let from = low.floor().max(0.0) as usize;
    let to = (high.ceil().max(0.0) as usize).saturating_add(1).min(end);
    from.min(to)..to
}

fn tinted(under: Rgb, colour: Rgb, share: f32) -> Rgb {
    let mixed = |i: usize| {
        let (u, c) = (f32::from(under[i]), f32::from(colour[i]));
        (u + share * (c - u) + 0.5) as u8
    };
    [mixed(0), mixed(1), mixed(2)]
}

/// Returns the depth of a polygon's plane as `a x + b y + c`; `None` if it is seen edge on.
fn plane(corners: &[Corner]) -> Option<[f64; 3]> {
    let mut n = [0.0; 3];
    for (k, p) in corners.iter().enumerate() {
        let q = &corners[(k + 1) % corners.len()];
        for (i, n) in n.iter_mut().enumerate() {
            let (j, l) = ((i + 1) % 3, (i + 2) % 3);
            *n += (p[j] - q[j]) * (p[l] + q[l]);
        }
    }
    let size = n.iter().map(|x| x * x).sum::<f64>().sqrt();
    if n[2].abs() <= 1e-6 * size || !size.is_finite() {
        return None;
    }
    let (a, b) = (-n[0] / n[2], -n[1] / n[2]);
    let count = corners.len() as f64;
    let mean: Vec<f64> = (0..3)
        .map(|i| corners.iter().map(|p| p[i]).sum::<f64>() / count)
        .collect();
    Some([a, b, mean[2] - a * mean[0] - b * mean[1]])
}

#[cfg(test)]
mod tests {
    use super::*;

    const RED: Rgb = [200, 0, 0];
    const BLUE: Rgb = [0, 0, 200];

    fn square(z: f64) -> [Corner; 4] {
        [
            [2.0, 2.0, z],
            [18.0, 2.0, z],
            [18.0, 18.0, z],
            [2.0, 18.0, z],
        ]
    }

    #[test]
    fn the_nearer_hides_the_farther_in_any_order() {
        let far = |r: &mut Raster| r.polygon(&square(0.0), RED, Blend::Opaque);
        let near = |r: &mut Raster| r.sphere([10.0, 10.0, 5.0], 6.0, BLUE);
        let [mut one, mut other] = [(); 2].map(|()| Raster::new(20, 20, [255; 3]));
        far(&mut one);
        near(&mut one);
        near(&mut other);
        far(&mut other);
        assert_eq!(one.colour, other.colour);
        let middle = one.colour[10 * 20 + 10];
        assert!(middle[2] > 100 && middle[0] < 80, "{middle:?}");
        assert_eq!(one.colour[3 * 20 + 3], RED);
        assert_eq!(one.colour[0], [255; 3]);
    }

    #[test]
    fn what_stands_behind_is_counted_and_seen_through_a_veil() {
        let mut r = Raster::new(20, 20, [255; 3]);
        r.sphere([10.0, 10.0, 5.0], 4.0, RED);
        let (covered, hidden) = r.hidden(&square(20.0));
        assert_eq!(covered, 256);
        assert!((40..=60).contains(&hidden), "{hidden}");
        assert_eq!(r.hidden(&square(-20.0)).1, 0);
        let before = r.colour[10 * 20 + 10];
        r.polygon(&square(20.0), BLUE, Blend::Veil(0.25));
        let after = r.colour[10 * 20 + 10];
        assert!(after[0] < before[0] && after[0] > before[0] / 2 && after[2] >= 50);
        // A slanted polygon has the depth of its plane at each pixel.
        let slanted = [
            [0.0, 0.0, 0.0],
            [20.0, 0.0, 20.0],
            [20.0, 20.0, 20.0],
            [0.0, 20.0, 0.0],
        ];
        assert_eq!(
            plane(&slanted).map(|p| p.map(f64::round)),
            Some([1.0, 0.0, 0.0])
        );
    }

    #[test]
    fn lines_are_hidden_by_what_is_nearer() {
        let mut r = Raster::new(40, 20, [255; 3]);
        r.polygon(&square(50.0), RED, Blend::Opaque);
        r.line([0.0, 10.0, 0.0], [40.0, 10.0, 0.0], 2.0, 3.0, BLUE, 1.0);
        assert_eq!(r.colour[10 * 40 + 10], RED);
        assert_eq!(r.colour[10 * 40 + 30], BLUE);
        r.line([30.0, 0.0, 0.0], [30.0, 0.0, 9.0], 2.0, 3.0, BLUE, 1.0);
        // An almost horizontal line is complete.
        r.line([1.0, 15.0, 60.0], [39.0, 15.001, 60.0], 2.0, 3.0, BLUE, 1.0);
        assert!((2..38).all(|x| r.colour[15 * 40 + x] == BLUE));
        let (w, h, pixels) = r.halved();
        assert_eq!((w, h, pixels.len()), (20, 10, 200));
    }
}
