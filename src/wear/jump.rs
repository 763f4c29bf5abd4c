//! Jumps over cycles: what a computed cycle stands for, and how far off that is.
//!
//! In a jump of N one cycle is computed in which each step wears and damages N times what its laws give: depths and
//! damage go on as over N cycles, step by step, and contacts and bodies follow within the cycle. That is the way of
//! J. J. Madge, S. B. Leen, I. R. McColl, P. H. Shipway, Wear 262 (2007) 1159, who scale the wear of each increment.
//! It is not the extrapolation z + N dz of a field of depths: between rigid bodies what stands proud is all that
//! touches, so an extrapolated field has the next cycle wear just what the extrapolation missed, and never widens.
//!
//! With a the increment of the jump, r the increment of the cycle before it and r' the mean one of the cycles after it,
//! which are computed one by one, what the jump should have added is N (r + r')/2 by the trapezium rule, and it is off
//! by e = sum |a - N (r + r')/2| / sum a.

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

/// By how much a jump of `n` is off, quantity by quantity, in the unit of the quantity: against the trapezium of the
/// increments of a cycle before and after it. Values are compared in groups: `group` gives that of a value.
pub fn error(
    n: f64,
    jumped: &Amounts,
    rates: [&Amounts; 2],
    group: impl Fn(usize, usize) -> usize,
) -> Vec<f64> {
    let at = |a: &Amounts, q: usize, k: usize| a[q].get(k).copied().unwrap_or(0.0);
    let quantity = |(q, list): (usize, &Vec<f64>)| {
        let mut off: Vec<f64> = Vec::new();
        for (k, x) in list.iter().enumerate() {
            let expected = 0.5 * n * (at(rates[0], q, k) + at(rates[1], q, k));
            let g = group(q, k);
            if off.len() <= g {
                off.resize(g + 1, 0.0);
            }
            off[g] += x - expected;
        }
        off.iter().map(|x| x.abs()).sum()
    };
    jumped.iter().enumerate().map(quantity).collect()
}

/// The length of the next jump after one of `n` that was off by `error`, in parts of what it added: the error of a
/// jump grows with the square of its length.
pub fn next_length(n: f64, error: f64, tolerance: f64) -> f64 {
    let factor = if error > 0.0 {
        (tolerance / error).sqrt()
    } else {
        2.0
    };
    n * factor.clamp(0.3, 2.0)
}
