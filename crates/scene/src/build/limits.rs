//! Limits on the pairs of grains that a case may make, tested before any pair is stored.

use super::Builder;
use crate::source::{InputError, ValidationError};
use fretwork_core::contact::detect::LawTable;

/// Limit on the pairs of grains that a large skin may make neighbours, see
/// [`Builder::refuse_wide_skin`].
const MAX_PAIRS: f64 = 2e8;
/// Limits on the pairs of grains at the start, in total and per grain, see
/// [`Builder::refuse_overcrowding`].
const MAX_PAIRS_AT_ALL: usize = 2_000_000;
const MAX_PAIRS_A_GRAIN: usize = 100;

impl Builder<'_> {
    /// Rejects a skin larger than the grains: it makes neighbours of grains that never meet, and
    /// the neighbour list may not fit into memory.
    pub(super) fn refuse_wide_skin(
        &self,
        alert: f64,
        skin: f64,
        largest: f64,
    ) -> Result<(), InputError> {
        if self.case.detection.skin.is_none() || skin <= largest {
            return Ok(());
        }
        let pairs = self.assembly.most_pairs(alert + skin);
        if pairs <= MAX_PAIRS {
            return Ok(());
        }
        let message = format!(
            "a skin of {skin:e} m gives {pairs:.1e} candidate pairs, of {MAX_PAIRS:e} at most; make it smaller than \
             the largest radius ({largest:e} m), the default is 0.3 of the smallest"
        );
        Err(self.fail("detection.skin", message))
    }

    /// Rejects grains that overlap in large numbers, such as all at one position: they make more
    /// pairs than fit into memory. The test runs before any pair is stored. Grains that only touch
    /// have about twenty neighbours each, whatever their sizes.
    pub(super) fn refuse_overcrowding(
        &self,
        alert: f64,
        skin: f64,
        table: &LawTable,
    ) -> Result<(), InputError> {
        // A large skin given in the case has its own limit.
        let reach = alert
            + if self.case.detection.skin.is_some() {
                0.0
            } else {
                skin
            };
        let most = |shapes: usize| MAX_PAIRS_AT_ALL + MAX_PAIRS_A_GRAIN * shapes;
        let Some(crowded) = self.assembly.overcrowding(reach, &most, table) else {
            return Ok(());
        };
        let (most, examined) = (most(self.assembly.radii().len()), crowded.pairs);
        let at = crowded.at[..self.dimension()].iter();
        let at: Vec<String> = at.map(|x| format!("{x:e}")).collect();
        let message = format!(
            "more than {most} pairs of grains are within reach of each other (up to {examined:.1e}), while grains that \
             touch make about 20 each: {} of them are within {:.1e} m of ({}) m",
            crowded.count,
            crowded.size,
            at.join(", ")
        );
        let origin = self
            .origins
            .get(crowded.body as usize)
            .map_or_else(|| "grains".to_owned(), |o| o.path());
        let fault = ValidationError::new(origin, message).expected(
            "grains beside each other: look for positions that occur twice, radii in another unit, or too large a \
             `detection.alert`",
        );
        Err(self.source.locate(fault))
    }

    /// Rejects a period so small that two balls could touch each other on both sides.
    pub(super) fn refuse_small_period(&self, reach: f64) -> Result<(), InputError> {
        let widest = self.assembly.radii().into_iter().fold(0.0, f64::max);
        for (k, name) in ["x", "y", "z"].into_iter().enumerate() {
            let period = self.assembly.periodic().period[k];
            if period.is_some_and(|p| 2.0 * (2.0 * widest + reach) > p) && reach > 2.0 * widest {
                let message = format!(
                    "with the skin, grains are neighbours up to {reach:e} m apart, which reaches twice around the period `periodic.{name}`; make it smaller"
                );
                return Err(self.fail("detection.alert".to_owned(), message));
            }
            if period.is_some_and(|p| p < 8.0 * widest) {
                let message = format!(
                    "the period must be at least 4 diameters of the largest grain ({:e} m)",
                    8.0 * widest
                );
                return Err(self.fail(format!("periodic.{name}"), message));
            }
        }
        Ok(())
    }
}
