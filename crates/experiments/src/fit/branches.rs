//! Curves that reverse, such as loops: their branches are placed one after the other, so that
//! abscissae increase.
//!
//! Points of a measured and of a simulated loop correspond if they lie on the same branch at the
//! same abscissa. The path length along the loop would not work: measured points seldom lie at the
//! reversals, so that the path between them omits these.

/// Share of the extent of a loop by which it must move back to count as reversed.
const TURNED: f64 = 0.05;

/// Distance of branches over the extent of the loop.
const DISTANCE: f64 = 4.0;

/// Returns the abscissae of a loop after placement, with the number of the branch of each point:
/// branch k, from 0, has `4 k reach + x` where x increases along it and `4 k reach - x` where it
/// decreases.
pub(super) fn laid_out(x: &[f64], reach: f64) -> (Vec<f64>, Vec<usize>) {
    let rises = x
        .iter()
        .find(|v| (*v - x[0]).abs() > TURNED * reach)
        .is_none_or(|v| *v > x[0]);
    let mut sign = if rises { 1.0 } else { -1.0 };
    let (mut out, mut branches) = (Vec::with_capacity(x.len()), Vec::with_capacity(x.len()));
    let (mut branch, mut farthest) = (0, 0);
    let place = |branch: usize, sign: f64, x: f64| branch as f64 * DISTANCE * reach + sign * x;
    for (k, v) in x.iter().enumerate() {
        if sign * v >= sign * x[farthest] {
            farthest = k;
        } else if sign * (x[farthest] - v) > TURNED * reach {
            // The loop reversed at the farthest point: later points are on the next branch.
            sign = -sign;
            branch += 1;
            for later in farthest + 1..k {
                out[later] = place(branch, sign, x[later]);
                branches[later] = branch;
            }
            farthest = k;
        }
        out.push(place(branch, sign, *v));
        branches.push(branch);
    }
    (out, branches)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A loop sampled without its turning points has the same placement as one with many points.
    #[test]
    fn branches_stand_one_behind_the_other() {
        let x = [0.0, 0.6, 1.0, 0.98, 0.3, -0.9, -1.0, 0.2];
        let (places, branches) = laid_out(&x, 1.0);
        assert_eq!(places, [0.0, 0.6, 1.0, 3.02, 3.7, 4.9, 5.0, 8.2]);
        assert_eq!(branches, [0, 0, 0, 1, 1, 1, 1, 2]);
        let laid_out = |x: &[f64]| laid_out(x, 1.0).0;
        assert_eq!(laid_out(&[0.6, 0.3, -0.9, 0.2]), [-0.6, -0.3, 0.9, 4.2]);
        // Noise is not a reversal.
        assert_eq!(laid_out(&[0.0, 0.5, 0.49, 0.8]), [0.0, 0.5, 0.49, 0.8]);
        assert!(laid_out(&[]).is_empty());
    }
}
