//! Jumps over cycles: what a computed cycle stands for, and how far off that is.
//!
//! In a jump of N one cycle is computed in which each step wears and damages N times what its laws give: depths and
//! damage go on as over N cycles, step by step, and contacts and bodies follow within the cycle. That is the way of
//! J. J. Madge, S. B. Leen, I. R. McColl, P. H. Shipway, Wear 262 (2007) 1159, who scale the wear of each increment.
//! It is not the extrapolation z + N dz of a field of depths: between rigid bodies what stands proud is all that
//! touches, so an extrapolated field has the next cycle wear just what the extrapolation missed, and never widens.
//!
//! What adds up from cycle to cycle (the volume of a scar, the damage of a bond) is checked by the cycles beside the jump,
//! which are computed one by one. With a the increment of the jump, r that of the cycle before it and r' the mean one of
//! the cycles after it, the trapezium rule gives N (r + r')/2, and the jump is off by |a - N (r + r')/2|.
//!
//! The form of a scar does not add up: what a jump misplaces is worn off where it stands proud. Between rigid bodies a
//! single cycle says nothing about it, since it touches at some of the places only; a jump is long enough to. So
//! jumps check each other: with a and b the volumes that the last one and this one wore off place by place, A and B
//! their sums, e_0, e_1, e_2 what was misplaced before, between and after them, b - a B/A is about
//! e_2 - (1 + B/A) e_1 + e_0 B/A. Of errors that do not know of each other that is sqrt(1 + (1 + B/A)^2 + (B/A)^2) times
//! one of them, sqrt(6) for jumps of one length. What the scar truly changed in form is counted with it.
//! What stands proud is worn off by what follows: S misplaced, as a sum of differences, leaves at most
//! S exp(-W/(2 S)) after a volume W, which is an assumption, held against whole runs in `docs/wear.md`.

/// What cycles change, or what they changed it by: one list for each quantity, of values that add up.
pub type Amounts = Vec<Vec<f64>>;

/// now - before, value by value; what fell, or was not there before, did not grow.
pub fn growth(now: &Amounts, before: &Amounts) -> Amounts {
    let list = |(now, before): (&Vec<f64>, &Vec<f64>)| {
        let of = |(k, x): (usize, &f64)| before.get(k).map_or(0.0, |b| (x - b).max(0.0));
        now.iter().enumerate().map(of).collect()
    };
    now.iter().zip(before).map(list).collect()
}

/// By how much a jump of `n` cycles that added `jumped` is off, against the trapezium of the increments of the cycles
/// before and after it.
pub fn error(n: f64, jumped: f64, rates: [f64; 2]) -> f64 {
    (jumped - 0.5 * n * (rates[0] + rates[1])).abs()
}

/// What is misplaced after a jump, as the sum of differences of volume place by place, from the volumes that it and the
/// jump `before` wore off.
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

/// What is left of a misplaced volume when another was worn off after it.
pub fn left(misplaced: f64, worn: f64) -> f64 {
    if misplaced > 0.0 {
        misplaced * (-0.5 * worn / misplaced).exp()
    } else {
        0.0
    }
}

/// The length of the next jump after one of `n` with an error, relative as the tolerance is.
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

    /// Increments of a cycle that grow by the same amount each: the trapezium is exact.
    #[test]
    fn growth_of_second_order_is_jumped_exactly() {
        let rate = |i: u32| 3.0 + 0.25 * f64::from(i);
        for n in [1, 7, 50] {
            let added: f64 = (1..=n).map(rate).sum();
            assert!(error(f64::from(n), added, [rate(0), rate(n + 1)]) < 1e-9);
        }
    }

    /// sum i^2 = n (n + 1) (2 n + 1)/6 beside n (n + 1)^2/2: off by n (n + 1) (n + 2)/6.
    #[test]
    fn growth_of_third_order_is_off_by_its_remainder() {
        let rate = |i: u32| f64::from(i * i);
        for n in [1, 7, 50] {
            let added: f64 = (1..=n).map(rate).sum();
            let expected = f64::from(n * (n + 1) * (n + 2)) / 6.0;
            let off = error(f64::from(n), added, [rate(0), rate(n + 1)]);
            assert!((off / expected - 1.0).abs() < 1e-12, "{off} {expected}");
        }
    }

    #[test]
    fn the_same_form_is_not_misplaced_whatever_its_volume() {
        let before = [1.0, 2.0, 3.0];
        assert!(misplaced(&[10.0, 20.0, 30.0], &before) < 1e-12);
    }

    /// Jumps that wear evenly but for errors that do not know of each other, each taken back by the next jump: what is
    /// left after one is found. Errors are uniform in +-1, |e| is 1/2 on average.
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
        // Half, but for the form of the distribution: a sum of three is nearer to a Gaussian, whose mean |e| is smaller
        // beside its deviation, sqrt(2/pi) against sqrt(3)/2.
        assert!((found / 0.5 - 0.93).abs() < 0.05, "{found}");
    }

    #[test]
    fn what_falls_or_is_new_did_not_grow() {
        let grown = growth(&vec![vec![1.0, 0.5, 0.3]], &vec![vec![0.25, 0.75]]);
        assert_eq!(grown, [[0.75, 0.0, 0.0]]);
    }

    #[test]
    fn lengths_follow_the_error() {
        assert_eq!(next_length(10.0, 0.04, 0.01), 5.0);
        assert_eq!(next_length(10.0, 0.0, 0.01), 20.0);
        assert_eq!(next_length(10.0, 1e3, 0.01), 3.0);
    }
}
