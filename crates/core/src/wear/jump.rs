//! Cycle jumps: one computed cycle represents many, with an estimate of the error.
//!
//! In a jump of N cycles one cycle is computed in which each step wears and damages N times the
//! amounts that the laws give: depths and damage advance as over N cycles, step by step, and
//! contacts and bodies respond within the cycle. This is the method of J. J. Madge, S. B. Leen, I.
//! R. McColl, P. H. Shipway, Wear 262 (2007) 1159, who scale the wear of each increment. It differs
//! from extrapolating a field of depths, z + N dz: rigid bodies touch only at protruding places, so
//! that after an extrapolation the next cycle wears exactly what the extrapolation missed, and the
//! scar never widens.
//!
//! Quantities that accumulate from cycle to cycle (the volume of a scar, the damage of a bond) are
//! checked by the cycles next to the jump, which are computed one by one: a parabola through the
//! increments of the cycles before the last jump, before this one and after it is summed over the
//! cycles of the jump. The difference is the error of the jump. The trapezium of the two adjacent
//! increments would miss the curvature of the growth. For z' = f(z) an error of z grows like f(z),
//! so that the errors of earlier jumps are multiplied by r'/r where increments grow.
//!
//! The shape of a scar does not accumulate: material misplaced by a jump is worn off where it
//! protrudes. A single cycle between rigid bodies does not show this, since they touch at only some
//! of the places; a jump is long enough. Therefore jumps check each other: with a and b the
//! volumes that the last jump and this one wore off at each place, A and B their sums, and e_0,
//! e_1, e_2 the misplaced volumes before, between and after them, b - a B/A is about e_2 - (1 +
//! B/A) e_1 + e_0 B/A. For independent errors its magnitude is sqrt(1 + (1 + B/A)^2 + (B/A)^2)
//! times that of one of them, sqrt(6) for jumps of equal length. Real changes of the scar's shape
//! are included in the estimate. Protruding material is worn off later: a misplaced volume S, as a
//! sum of differences, is reduced to at most S exp(-W/(2 S)) after a further wear volume W. This is
//! an assumption, compared with complete runs in `docs/wear/jumps.md`.

/// Accumulated quantities, or their increments: one list of values per quantity.
pub type Amounts = Vec<Vec<f64>>;

/// Returns now - before, value by value; new values grow from zero, and decreasing values count as
/// unchanged.
pub fn growth(now: &Amounts, before: &Amounts) -> Amounts {
    let list = |(now, before): (&Vec<f64>, &Vec<f64>)| {
        let of = |(k, x): (usize, &f64)| (x - before.get(k).copied().unwrap_or(0.0)).max(0.0);
        now.iter().enumerate().map(of).collect()
    };
    now.iter().zip(before).map(list).collect()
}

/// Returns the weights of increments at three cycles in the sum over the cycles 1 to n of the
/// parabola through them.
pub fn parabola_weights(n: u32, at: [f64; 3]) -> [f64; 3] {
    let part = |k: usize| {
        let [i, j] = [(k + 1) % 3, (k + 2) % 3];
        let below = (at[k] - at[i]) * (at[k] - at[j]);
        let value = |c: u32| (f64::from(c) - at[i]) * (f64::from(c) - at[j]) / below;
        (1..=n).map(value).sum()
    };
    [part(0), part(1), part(2)]
}

/// Returns the error of a jump that added `jumped`, from increments with their
/// [`parabola_weights`].
pub fn error(jumped: f64, rates: [f64; 3], parts: &[f64; 3]) -> f64 {
    let expected: f64 = rates.iter().zip(parts).map(|(r, p)| r * p).sum();
    (jumped - expected).abs()
}

/// Largest growth of an increment over a jump for which errors are propagated.
const MAX_ERROR_GROWTH: f64 = 10.0;

/// Returns the growth of an error while the increment of a cycle changes from one value to another:
/// for z' = f(z) the error of z grows like f. Decreasing increments give no reduction.
pub fn error_growth(from: f64, to: f64) -> f64 {
    if from > 0.0 {
        (to / from).clamp(1.0, MAX_ERROR_GROWTH)
    } else {
        1.0
    }
}

/// Returns the misplaced volume after a jump, as a sum of differences over the places, from the
/// volumes that it and the jump `before` wore off.
pub fn misplaced(now: &[f64], before: &[f64]) -> f64 {
    let (all, then): (f64, f64) = (now.iter().sum(), before.iter().sum());
    if then <= 0.0 {
        return all;
    }
    let pairs = now.iter().zip(before);
    let differ: f64 = pairs.map(|(x, y)| (x - y * all / then).abs()).sum();
    let ratio = all / then;
    differ / (1.0 + (1.0 + ratio).powi(2) + ratio * ratio).sqrt()
}

/// Returns the remainder of a misplaced volume after a further wear volume.
pub fn remaining(misplaced: f64, worn: f64) -> f64 {
    if misplaced > 0.0 {
        misplaced * (-0.5 * worn / misplaced).exp()
    } else {
        0.0
    }
}

/// Returns the length of the next jump after one of `n` cycles with a given error; error and
/// tolerance are relative to the same quantity.
pub fn next_length(n: f64, error: f64, tolerance: f64) -> f64 {
    let factor = if error > 0.0 {
        (tolerance / error).sqrt()
    } else {
        2.0
    };
    n * factor.clamp(0.3, 2.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Increments that are a parabola in the cycle number (growth of third order) give no error.
    #[test]
    fn growth_of_third_order_is_summed_exactly() {
        let rate = |c: f64| 3.0 + 0.25 * c + 0.01 * c * c;
        for n in [1, 7, 50] {
            let at = [-9.0, 0.0, f64::from(n) + 1.0];
            let added: f64 = (1..=n).map(|c| rate(f64::from(c))).sum();
            assert!(error(added, at.map(rate), &parabola_weights(n, at)) < 1e-9 * added);
        }
    }

    /// For increments c^3 with c = 0, 1 and n + 1 the parabola is (n + 2) c^2 - (n + 1) c, and sums
    /// of powers give the remainder.
    #[test]
    fn growth_of_fourth_order_is_off_by_its_remainder() {
        for n in [3u32, 7, 50] {
            let m = f64::from(n);
            let at = [0.0, 1.0, m + 1.0];
            let squares = m * (m + 1.0) * (2.0 * m + 1.0) / 6.0;
            let added = (0.5 * m * (m + 1.0)).powi(2);
            let parabola = (m + 2.0) * squares - (m + 1.0) * 0.5 * m * (m + 1.0);
            let off = error(added, at.map(|c| c.powi(3)), &parabola_weights(n, at));
            assert!((off / (added - parabola).abs() - 1.0).abs() < 1e-9, "{off}");
        }
    }

    #[test]
    fn the_same_form_is_not_misplaced_whatever_its_volume() {
        let before = [1.0, 2.0, 3.0];
        assert!(misplaced(&[10.0, 20.0, 30.0], &before) < 1e-12);
    }

    /// Jumps that wear evenly apart from independent errors, each corrected by the next jump: the
    /// estimate finds the remaining error. Errors are uniform in +-1, so that the mean of |e| is
    /// 1/2.
    #[test]
    fn errors_of_jumps_are_found_from_the_next() {
        let mut seed = 12345u64;
        let mut random = || {
            seed = seed
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (seed >> 11) as f64 / (1u64 << 52) as f64 - 1.0
        };
        let places = 20_000;
        let errors: Vec<Vec<f64>> = (0..3)
            .map(|_| (0..places).map(|_| random()).collect())
            .collect();
        let worn = |k: usize| -> Vec<f64> {
            let pairs = errors[k + 1].iter().zip(&errors[k]);
            pairs.map(|(e, before)| 10.0 + e - before).collect()
        };
        let found = misplaced(&worn(1), &worn(0)) / f64::from(places);
        // 1/2 times a factor for the distribution: a sum of three is nearer to a Gaussian, whose
        // mean |e| relative to its deviation is sqrt(2/pi) instead of sqrt(3)/2.
        assert!((found / 0.5 - 0.93).abs() < 0.05, "{found}");
    }

    /// z' = z^2 from z = 1 reaches 1/(1 - t); an error d at the start ends as d/(1 - t)^2.
    #[test]
    fn errors_are_carried_as_the_equation_carries_them() {
        let z = |from: f64, t: f64| 1.0 / (1.0 / from - t);
        let (d, t) = (1e-7, 0.6);
        let grown = (z(1.0 + d, t) - z(1.0, t)) / d;
        assert!((error_growth(1.0, z(1.0, t).powi(2)) / grown - 1.0).abs() < 1e-5);
        assert_eq!(error_growth(2.0, 1.0), 1.0);
    }

    #[test]
    fn what_falls_did_not_grow_and_what_is_new_did() {
        let grown = growth(&vec![vec![1.0, 0.5, 0.3]], &vec![vec![0.25, 0.75]]);
        assert_eq!(grown, [[0.75, 0.0, 0.3]]);
    }

    #[test]
    fn lengths_follow_the_error() {
        assert_eq!(next_length(10.0, 0.04, 0.01), 5.0);
        assert_eq!(next_length(10.0, 0.0, 0.01), 20.0);
        assert_eq!(next_length(10.0, 1e3, 0.01), 3.0);
    }
}
