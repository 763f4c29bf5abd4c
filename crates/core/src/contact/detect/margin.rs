//! How far two bodies may penetrate before a contact between them is predicted, or reported.

use super::sweep::Pair;
use crate::contact::network::{Contact, Network};
use crate::geometry::space::Space;

/// Penetration, as a fraction of the fast motion, from which a pair without a contact gets one.
pub(super) const TOLERATED: f64 = 0.05;
/// Fraction of the half thickness by which a pair may penetrate before it is reported.
const PASSED: f64 = 0.25;
/// The same for a pair that is held by springs, which overlaps as it is pressed: from the middle on
/// its normal may turn over.
const PASSED_SPRING: f64 = 1.0;

/// Largest penetration that is accepted in addition to a known overlap, as a fraction of the
/// further penetration that is seen.
const SEEN: f64 = 0.5;

/// Stage of the step at which pairs are examined.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Stage {
    /// Before the solve, with the free velocities.
    Before,
    /// After the solve, with its velocities.
    After,
    /// After the solve, to report only.
    Report,
}

/// Accepted penetration of a pair (m).
pub(super) struct Margin {
    /// Penetration from which the pair is treated.
    pub deepest: f64,
    /// Penetration from which the pair is kept from closing.
    pub begins: f64,
}

/// Returns the accepted penetration of a pair with these contacts; `None` if the pair need not be
/// examined.
pub(super) fn margin<S: Space>(
    network: &Network<S>,
    of_pair: &[Contact<S>],
    pair: &Pair<S>,
    stage: Stage,
    compliant: bool,
) -> Option<Margin> {
    let (mut any, mut overlap) = (false, 0.0f64);
    for contact in of_pair {
        // An intact bond keeps its gap.
        if network.bond(contact).is_some_and(|b| b.intact()) {
            return None;
        }
        any = true;
        if !contact.closing {
            overlap = overlap.max(-contact.gap);
        }
    }
    let begins = TOLERATED * network.fast + overlap;
    let deepest = match stage {
        Stage::Before if any => return None,
        Stage::After if any => network.fast + overlap,
        Stage::Before | Stage::After => begins,
        Stage::Report if any && compliant => PASSED_SPRING * pair.half_thickness + overlap,
        Stage::Report => PASSED * pair.half_thickness + overlap,
    };
    // Deeper than a surface sees a penetration would not be found.
    let limit = overlap + SEEN * (pair.seen - overlap).max(0.0);
    Some(Margin {
        deepest: deepest.min(limit),
        begins: begins.min(limit),
    })
}
