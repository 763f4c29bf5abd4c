//! The penetration of two bodies from which a contact between them is predicted, or reported.

use super::sweep::SweptPair;
use crate::contact::network::{Contact, Network};
use crate::geometry::space::Space;

/// Penetration, as a fraction of the fast motion, from which a pair without a contact gets one.
pub(super) const TOLERATED: f64 = 0.05;
/// Fraction of the half thickness by which a pair may penetrate before it is reported.
const PASSED: f64 = 0.25;
/// Fraction of the half thickness for a pair held by springs, which overlaps under load: beyond the
/// middle its normal may reverse.
const PASSED_SPRING: f64 = 1.0;

/// Largest penetration accepted in addition to a known overlap, as a fraction of the further
/// penetration that can be detected.
const DETECTABLE: f64 = 0.5;

/// Stage of the step at which pairs are examined.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum SearchStage {
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
    pair: &SweptPair<S>,
    stage: SearchStage,
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
        SearchStage::Before if any => return None,
        SearchStage::After if any => network.fast + overlap,
        SearchStage::Before | SearchStage::After => begins,
        SearchStage::Report if any && compliant => PASSED_SPRING * pair.half_thickness + overlap,
        SearchStage::Report => PASSED * pair.half_thickness + overlap,
    };
    // A penetration deeper than the surface can detect would not be found.
    let limit = overlap + DETECTABLE * (pair.detectable - overlap).max(0.0);
    Some(Margin {
        deepest: deepest.min(limit),
        begins: begins.min(limit),
    })
}
