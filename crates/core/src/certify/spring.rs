//! Check of laws that are springs.

use super::rig::{RADIUS, Rig};
use super::{Check, CheckResult};
use crate::laws::LawError;
use crate::laws::bench::spring::SpringAnswer;

/// The checks of compliant contact laws.
pub const CHECKS: [(&str, Check); 1] = [("spring", slope)];

/// Overlaps, over the reduced radius.
const OVERLAPS: [f64; 5] = [1e-7, 1e-5, 1e-4, 1e-3, 1e-2];
/// Relative change of the overlap for the slope.
const CHANGE: f64 = 1e-4;

/// Checks that the stiffness is the slope of the force, and that there is no force without overlap:
/// with a wrong slope a step converges to a wrong force.
fn slope(rig: &mut Rig) -> Result<CheckResult, LawError> {
    let mut bench = rig.strict_bench();
    let mut at = |overlap: f64| -> Result<SpringAnswer, LawError> {
        Ok(bench.spring(overlap)?.unwrap_or_default())
    };
    let mut worst = 0.0f64;
    for share in OVERLAPS {
        let overlap = share * RADIUS;
        let (less, more) = (at(overlap * (1.0 - CHANGE))?, at(overlap * (1.0 + CHANGE))?);
        let slope = (more.force - less.force) / (2.0 * CHANGE * overlap);
        let here = at(overlap)?;
        let scale = here
            .stiffness
            .max(here.force / overlap)
            .max(f64::MIN_POSITIVE);
        worst = worst.max((slope - here.stiffness).abs() / scale);
        worst = worst.max(at(0.0)?.force / here.force.max(f64::MIN_POSITIVE));
    }
    Ok(CheckResult::below(
        "spring",
        worst,
        1e-3,
        "largest difference between the stiffness and the slope of the force, relative; force without overlap",
    ))
}
