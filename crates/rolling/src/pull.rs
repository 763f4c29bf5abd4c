//! The creepage at which a patch has a force.

/// Largest creepage of a search.
pub const LARGEST: f64 = 0.5;
/// Largest number of solutions.
const MOST: usize = 60;
/// Change of the creepage to the second trial, and the largest one: it is squared each time, since
/// the first trial is often near.
const GROWTH: [f64; 2] = [1.1, 2.0];

/// Outcome of a search.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Pulled {
    /// The creepage.
    At(f64),
    /// No creepage has the force; the largest force that was found (N).
    Most(f64),
}

/// Returns the creepage at which the size of a force is `wanted` (N) to a share `within`, from a
/// first trial on; `force` has that of a creepage. The lowest is found where there are several.
///
/// # Errors
/// Those of `force`.
pub fn creepage<E>(
    wanted: f64,
    first: f64,
    within: f64,
    mut force: impl FnMut(f64) -> Result<f64, E>,
) -> Result<Pulled, E> {
    let found = |missing: f64| missing.abs() <= within * wanted;
    let mut missing = |size: f64| -> Result<f64, E> { Ok(force(size)? - wanted) };
    let (mut high, mut above) = (first, missing(first)?);
    if found(above) {
        return Ok(Pulled::At(high));
    }
    let mut most = above;
    let mut growth = GROWTH[0];
    let (mut low, mut below) = (high, above);
    while below > 0.0 {
        (high, above) = (low, below);
        low = if low > 1e-9 { low / growth } else { 0.0 };
        growth = (growth * growth).min(GROWTH[1]);
        below = missing(low)?;
        if low == 0.0 {
            break;
        }
    }
    while above < 0.0 {
        if high >= LARGEST {
            return Ok(Pulled::Most(most + wanted));
        }
        (low, below) = (high, above);
        high = (growth * high).min(LARGEST);
        growth = (growth * growth).min(GROWTH[1]);
        above = missing(high)?;
        most = most.max(above);
    }
    // Regula falsi, with the value of an end that stays halved (Illinois).
    for _ in 0..MOST {
        let size = low - below * (high - low) / (above - below);
        let now = missing(size)?;
        if found(now) {
            return Ok(Pulled::At(size));
        }
        if now < 0.0 {
            (low, below) = (size, now);
            above *= 0.5;
        } else {
            (high, above) = (size, now);
            below *= 0.5;
        }
    }
    Ok(Pulled::At(0.5 * (low + high)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn carter(creepage: f64) -> Result<f64, ()> {
        // Q/(mu P) = 1 - (1 - xi/xi_s)^2 in the units of mu P and of the saturation.
        Ok(1.0 - (1.0 - creepage.min(1.0)).powi(2))
    }

    #[test]
    fn a_force_is_found_from_below_and_above() {
        for first in [1e-5, 0.02, 0.4] {
            let Pulled::At(found) = creepage(0.3, first, 1e-9, carter).unwrap() else {
                panic!("it is carried");
            };
            assert!((found - (1.0 - 0.7f64.sqrt())).abs() < 1e-8, "{found}");
        }
    }

    #[test]
    fn what_is_not_carried_is_told() {
        let got = creepage(0.8, 1e-5, 1e-6, carter).unwrap();
        assert_eq!(got, Pulled::Most(0.75));
    }
}
