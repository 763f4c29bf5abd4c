//! Pareto frontier: settings for which no other is both cheaper and more accurate.

/// Returns which of the points (cost, error) are not dominated: a point is dominated if another is
/// no worse in both and better in one. Points that are not finite are never on the frontier.
pub fn frontier(points: &[(f64, f64)]) -> Vec<bool> {
    let finite = |p: &(f64, f64)| p.0.is_finite() && p.1.is_finite();
    let beats = |a: &(f64, f64), b: &(f64, f64)| {
        finite(a) && a.0 <= b.0 && a.1 <= b.1 && (a.0 < b.0 || a.1 < b.1)
    };
    points
        .iter()
        .map(|p| finite(p) && !points.iter().any(|q| beats(q, p)))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};

    #[test]
    fn keeps_what_nothing_dominates() {
        let points = [(1.0, 5.0), (2.0, 3.0), (2.0, 4.0), (3.0, 3.0), (4.0, 1.0)];
        assert_eq!(frontier(&points), [true, true, false, false, true]);
        // Equal points are both on it; non-finite ones are not.
        let points = [
            (1.0, 1.0),
            (1.0, 1.0),
            (0.5, f64::INFINITY),
            (f64::NAN, 0.0),
        ];
        assert_eq!(frontier(&points), [true, true, false, false]);
        assert!(frontier(&[]).is_empty());
    }

    /// By definition, along the frontier a higher cost gives a lower error, and every other point
    /// is dominated by one on it.
    #[test]
    fn is_sorted_and_covers_the_rest() {
        let mut rng = rand_pcg::Pcg64::seed_from_u64(3);
        for _ in 0..50 {
            let points: Vec<(f64, f64)> = (0..40).map(|_| (rng.random(), rng.random())).collect();
            let on = frontier(&points);
            let mut kept: Vec<(f64, f64)> = points
                .iter()
                .zip(&on)
                .filter(|(_, k)| **k)
                .map(|(p, _)| *p)
                .collect();
            kept.sort_by(|a, b| a.0.total_cmp(&b.0));
            assert!(kept.windows(2).all(|w| w[0].0 < w[1].0 && w[0].1 > w[1].1));
            for p in &points {
                assert!(kept.iter().any(|k| k.0 <= p.0 && k.1 <= p.1));
            }
        }
    }
}
