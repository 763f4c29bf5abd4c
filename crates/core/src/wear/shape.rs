//! The shape of a scar: U or W.
//!
//! The scar extends from the first to the last place deeper than a twentieth of its largest depth.
//! The scar is divided into twenty slices of equal width. The depth of its middle is the mean of
//! the two central slices, that of its sides the deepest slice of each half. The scar is a W where
//! the middle is below 0.9 of both sides, otherwise a U. Averaging over slices suppresses the dents
//! of single contacts.

use serde::Serialize;

/// Fraction of the largest depth from which a place belongs to the scar.
const EDGE: f64 = 0.05;
/// Number of slices.
const SLICES: usize = 20;
/// A middle below this fraction of both sides makes a W.
const SHALLOW: f64 = 0.9;

/// Shape of a scar.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum ScarForm {
    /// No wear, or at one or two places only.
    None,
    /// Deepest in the middle, or equally deep.
    U,
    /// Deeper on both sides than in the middle.
    W,
}

/// Extent and shape of a scar.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ScarOutline {
    /// Shape.
    pub form: ScarForm,
    /// Start of the scar (m); NaN where there is none.
    pub from: f64,
    /// End of the scar (m).
    pub to: f64,
    /// Depth of the middle (m).
    pub middle: f64,
    /// Depth of the deepest slice on the left and on the right (m).
    pub sides: [f64; 2],
}

/// Returns extent and shape from depths in order of position; each row holds position (m),
/// tributary length, and depth (m).
pub fn outline(rows: &[[f64; 3]]) -> ScarOutline {
    let none = ScarOutline {
        form: ScarForm::None,
        from: f64::NAN,
        to: f64::NAN,
        middle: 0.0,
        sides: [0.0; 2],
    };
    let most = rows.iter().map(|r| r[2]).fold(0.0, f64::max);
    let deep = |r: &[f64; 3]| most > 0.0 && r[2] > EDGE * most;
    let (Some(first), Some(last)) = (rows.iter().position(deep), rows.iter().rposition(deep))
    else {
        return none;
    };
    let (from, to) = (rows[first][0], rows[last][0]);
    if last < first + 2 {
        return none;
    }
    let slice = (to - from) / SLICES as f64;
    let depths: Vec<f64> = (0..SLICES)
        .map(|k| {
            let left = from + k as f64 * slice;
            integral(rows, left, left + slice) / slice
        })
        .collect();
    let half = SLICES / 2;
    let most = |of: &[f64]| of.iter().copied().fold(0.0, f64::max);
    let middle = 0.5 * (depths[half - 1] + depths[half]);
    let sides = [most(&depths[..half]), most(&depths[half..])];
    let form = if sides.iter().all(|s| middle < SHALLOW * s) {
        ScarForm::W
    } else {
        ScarForm::U
    };
    ScarOutline {
        form,
        from,
        to,
        middle,
        sides,
    }
}

/// Integrates the depth, linear between places, over an interval.
fn integral(rows: &[[f64; 3]], from: f64, to: f64) -> f64 {
    let piece = |w: &[[f64; 3]]| {
        let ([a, _, p], [b, _, q]) = (w[0], w[1]);
        let (low, high) = (from.max(a), to.min(b));
        if high <= low {
            return 0.0;
        }
        let middle = (0.5 * (low + high) - a) / (b - a);
        (high - low) * (p + middle * (q - p))
    };
    rows.windows(2).map(piece).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(depth: impl Fn(f64) -> f64) -> ScarOutline {
        let row = |k: i32| {
            let x = 0.01 * f64::from(k);
            [x, 0.01, depth(x)]
        };
        outline(&(-200..=200).map(row).collect::<Vec<_>>())
    }

    #[test]
    fn a_circle_a_plateau_and_a_slope_are_u_and_two_lobes_are_w() {
        assert_eq!(of(|_| 0.0).form, ScarForm::None);
        assert_eq!(of(|x| (1.0 - x * x).max(0.0)).form, ScarForm::U);
        assert_eq!(
            of(|x| if x.abs() < 1.0 { 1.0 } else { 0.0 }).form,
            ScarForm::U
        );
        assert_eq!(
            of(|x| if x.abs() < 1.0 { 1.5 + x } else { 0.0 }).form,
            ScarForm::U
        );
        // cos^2 with a shallow middle: 1 at x = 0.5, 0.5 at x = 0.
        let w = of(|x| {
            if x.abs() < 1.0 {
                0.5 + 0.5 * (std::f64::consts::PI * x).sin().powi(2)
            } else {
                0.0
            }
        });
        assert_eq!(w.form, ScarForm::W);
        assert!((w.from + 0.99).abs() < 1e-12 && (w.to - 0.99).abs() < 1e-12);
        assert!((w.middle - 0.5).abs() < 0.02 && w.sides.iter().all(|s| (s - 1.0).abs() < 0.02));
    }

    #[test]
    fn a_dent_of_one_contact_makes_no_w() {
        let form = of(|x| {
            let dent = if (x.abs() - 0.5).abs() < 0.005 {
                0.4
            } else {
                0.0
            };
            if x.abs() < 1.0 { 1.0 + dent } else { 0.0 }
        });
        assert_eq!(form.form, ScarForm::U);
    }
}
