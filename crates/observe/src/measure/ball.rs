//! Balls cut by planes.

use std::f64::consts::PI;

/// Returns the volume of a ball (m^3; m^2 in 2D) below a horizontal plane at height `d` above its
/// centre (m).
pub(crate) fn volume_below(dimension: usize, r: f64, d: f64) -> f64 {
    let d = d.clamp(-r, r);
    if dimension == 2 {
        // This is half the chord, in a form without cancellation near the poles.
        let half = ((r - d) * (r + d)).sqrt();
        r * r * half.atan2(-d) + d * half
    } else {
        PI * (2.0 / 3.0 * r * r * r + r * r * d - d * d * d / 3.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ball_is_cut_in_two() {
        for dimension in [2, 3] {
            let whole = volume_below(dimension, 0.3, 1.0);
            let half = volume_below(dimension, 0.3, 0.0);
            assert!(
                (whole - 2.0 * half).abs() < 1e-15
                    && volume_below(dimension, 0.3, -0.4).abs() < 1e-15
            );
            // The derivative is the area of the section.
            let (d, e) = (0.11, 1e-6);
            let section = (volume_below(dimension, 0.3, d + e)
                - volume_below(dimension, 0.3, d - e))
                / (2.0 * e);
            let c = (0.09f64 - d * d).sqrt();
            let exact = if dimension == 2 { 2.0 * c } else { PI * c * c };
            assert!((section - exact).abs() < 1e-8);
        }
    }
}
