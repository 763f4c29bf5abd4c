//! Polygons clipped to half-spaces.

/// The half-space n · x ≤ d.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Side<const N: usize> {
    pub normal: [f64; N],
    pub offset: f64,
}

impl<const N: usize> Side<N> {
    /// Returns the distance of a point outside, times the length of the normal.
    pub fn outside(&self, p: &[f64; N]) -> f64 {
        let products = self.normal.iter().zip(p).map(|(n, x)| n * x);
        products.sum::<f64>() - self.offset
    }
}

/// The sides of a box.
pub(crate) fn sides_of_box<const N: usize>(low: &[f64; N], high: &[f64; N]) -> Vec<Side<N>> {
    let side = |axis: usize, sign: f64, at: f64| {
        let mut normal = [0.0; N];
        normal[axis] = sign;
        let offset = sign * at;
        Side { normal, offset }
    };
    let pair = |axis: usize| [side(axis, 1.0, high[axis]), side(axis, -1.0, low[axis])];
    (0..N).flat_map(pair).collect()
}

/// Clips a polygon to all half-spaces. The parts of a clipped non-convex polygon may remain joined
/// by edges.
pub(crate) fn clip<const N: usize>(polygon: Vec<[f64; N]>, sides: &[Side<N>]) -> Vec<[f64; N]> {
    let mut kept = polygon;
    for side in sides {
        let before = std::mem::take(&mut kept);
        for (i, b) in before.iter().enumerate() {
            let a = &before[(i + before.len() - 1) % before.len()];
            let (da, db) = (side.outside(a), side.outside(b));
            if (da > 0.0) != (db > 0.0) {
                let t = da / (da - db);
                kept.push(std::array::from_fn(|k| a[k] + t * (b[k] - a[k])));
            }
            if db <= 0.0 {
                kept.push(*b);
            }
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_polygon_is_cut_to_a_box() {
        let wide = vec![
            [-9.0, -9.0, 0.5],
            [9.0, -9.0, 0.5],
            [9.0, 9.0, 0.5],
            [-9.0, 9.0, 0.5],
        ];
        let sides = sides_of_box(&[0.0; 3], &[1.0, 2.0, 3.0]);
        let found = clip(wide.clone(), &sides);
        let area: f64 = (0..found.len())
            .map(|k| {
                let (p, q) = (found[k], found[(k + 1) % found.len()]);
                0.5 * (p[0] * q[1] - p[1] * q[0])
            })
            .sum();
        assert!((area - 2.0).abs() < 1e-12, "{found:?}");
        assert!(clip(wide, &sides_of_box(&[0.0; 3], &[1.0, 1.0, 0.25])).is_empty());
    }
}
