//! Balls on a lattice.

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

/// Generates a lattice of balls without overlaps, hexagonal in 2D and cubic in 3D, spaced by the
/// largest radius, with radii uniform between two values. It fills the box from the bottom row up
/// with at most `count` balls. With a periodic width the columns fit it exactly.
pub fn lattice(
    dimension: usize,
    periodic: bool,
    count: usize,
    radius: (f64, f64),
    low: &[f64],
    high: &[f64],
    seed: u64,
) -> Vec<(Vec<f64>, f64)> {
    let mut rng = Pcg64::seed_from_u64(seed);
    let spacing = 2.0 * radius.1 * (1.0 + 1e-6);
    let fit = |k: usize| (((high[k] - low[k]) / spacing).floor().max(0.0)) as usize;
    let columns = fit(0);
    if columns == 0 {
        return Vec::new();
    }
    let pitch = (high[0] - low[0]) / columns as f64;
    let mut out = Vec::new();
    let draw = |rng: &mut Pcg64| {
        if radius.0 < radius.1 {
            rng.random_range(radius.0..radius.1)
        } else {
            radius.0
        }
    };
    if dimension == 2 {
        let rise = spacing * (1.0 - 0.25 * (pitch / spacing).powi(2).min(1.0)).sqrt();
        let mut row = 0;
        while out.len() < count {
            let y = low[1] + 0.5 * spacing + row as f64 * rise;
            if y + 0.5 * spacing > high[1] * (1.0 + 1e-12) + spacing * 1e-9 {
                break;
            }
            // Odd rows are offset by half a spacing; in a box they have one ball fewer.
            let even = row % 2 == 0;
            let (shift, columns) = match (periodic, even) {
                (true, true) => (0.25, columns),
                (true, false) => (0.75, columns),
                (false, true) => (0.5, columns),
                (false, false) => (1.0, columns - 1),
            };
            for k in 0..columns {
                if out.len() == count {
                    break;
                }
                out.push((vec![low[0] + (k as f64 + shift) * pitch, y], draw(&mut rng)));
            }
            row += 1;
        }
        out.truncate(count);
        return out;
    }
    let (across, layers) = (fit(1), fit(2));
    if across == 0 {
        return out;
    }
    let depth = (high[1] - low[1]) / across as f64;
    for layer in 0..layers {
        for j in 0..across {
            for i in 0..columns {
                if out.len() == count {
                    return out;
                }
                let at = vec![
                    low[0] + (i as f64 + 0.5) * pitch,
                    low[1] + (j as f64 + 0.5) * depth,
                    low[2] + (layer as f64 + 0.5) * spacing,
                ];
                out.push((at, draw(&mut rng)));
            }
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lattices_do_not_overlap_even_across_the_period() {
        for (dimension, high) in [(2, vec![1.0, 0.7, 0.0]), (3, vec![1.0, 1.0, 0.7])] {
            let grains = lattice(dimension, true, 10_000, (0.03, 0.05), &[0.0; 3], &high, 1);
            assert!(grains.len() > 50);
            for (k, (x, r)) in grains.iter().enumerate() {
                for (y, s) in &grains[..k] {
                    let mut squared = 0.0;
                    for axis in 0..dimension {
                        let mut d = x[axis] - y[axis];
                        if axis == 0 {
                            d -= d.round();
                        }
                        squared += d * d;
                    }
                    assert!(squared.sqrt() >= r + s);
                }
            }
        }
    }
}
