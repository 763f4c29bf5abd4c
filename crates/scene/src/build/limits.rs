//! Limits on the pairs of grains that a case may make, tested before any pair is stored.

use super::Builder;
use crate::source::{InputError, ValidationError};
use fretwork_core::contact::detect::{LawTable, centre, piece_centre};
use fretwork_core::geometry::grid::{self, Balls};
use fretwork_core::geometry::space::Space;

/// Limit on the pairs of grains that a large skin may make neighbours, see
/// [`Builder::refuse_wide_skin`].
const MAX_PAIRS: f64 = 2e8;
/// Limits on the pairs of grains at the start, in total and per grain, see
/// [`Builder::refuse_piles`].
const MAX_PAIRS_AT_ALL: usize = 2_000_000;
const MAX_PAIRS_A_GRAIN: usize = 100;

impl<S: Space> Builder<'_, S> {
    /// Radii of all balls, and of the bounding balls of the convex parts (m).
    pub(super) fn radii(&self) -> impl Iterator<Item = f64> + '_ {
        let pieces = self.shapes.pieces.iter().map(|p| p.bound);
        self.shapes.balls.iter().map(|b| b.radius).chain(pieces)
    }

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
        let of = |body: u32| self.bodies.position[body as usize];
        let balls = self.shapes.balls.iter().map(|b| of(b.body));
        let centres: Vec<S::Vector> = balls
            .chain(self.shapes.pieces.iter().map(|p| of(p.body)))
            .collect();
        let radii: Vec<f64> = self.radii().collect();
        let pairs = grid::pairs_bound(&Balls {
            centres: &centres,
            radii: &radii,
            reach: alert + skin,
            periodic: &self.shapes.periodic,
        });
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
    pub(super) fn refuse_piles(
        &self,
        alert: f64,
        skin: f64,
        table: &LawTable,
    ) -> Result<(), InputError> {
        let balls = &self.shapes.balls;
        let owner = |at: u32| match balls.get(at as usize) {
            Some(ball) => (ball.body, ball.material),
            None => {
                let piece = &self.shapes.pieces[at as usize - balls.len()];
                (piece.body, piece.material)
            }
        };
        let mut centres: Vec<S::Vector> = balls.iter().map(|b| centre(b, &self.bodies)).collect();
        let pieces = self.shapes.pieces.iter();
        centres.extend(pieces.map(|p| piece_centre(p, &self.bodies)));
        let radii: Vec<f64> = self.radii().collect();
        // A large skin given in the case has its own limit.
        let reach = alert
            + if self.case.detection.skin.is_some() {
                0.0
            } else {
                skin
            };
        let most = MAX_PAIRS_AT_ALL + MAX_PAIRS_A_GRAIN * centres.len();
        let still = self.bodies.still();
        let keep = |a: u32, b: u32| {
            let ((i, m), (j, n)) = (owner(a), owner(b));
            i != j && !(still[i as usize] && still[j as usize]) && table.get(m, n).is_some()
        };
        let all = Balls {
            centres: &centres,
            radii: &radii,
            reach,
            periodic: &self.shapes.periodic,
        };
        let Some(dense) = grid::dense_cell(&all, most, keep) else {
            return Ok(());
        };
        let (body, _) = owner(dense.ball);
        let at = centres[dense.ball as usize];
        let at: Vec<String> = (0..S::D).map(|k| format!("{:e}", at[k])).collect();
        let examined = grid::pairs_bound(&all);
        let message = format!(
            "more than {most} pairs of grains are within reach of each other (up to {examined:.1e}), while grains that \
             touch make about 20 each: {} of them are within {:.1e} m of ({}) m",
            dense.count,
            dense.size,
            at.join(", ")
        );
        let origin = self
            .origins
            .get(body as usize)
            .map_or_else(|| "grains".to_owned(), |o| o.path());
        let fault = ValidationError::new(origin, message).expected(
            "grains beside each other: look for positions that occur twice, radii in another unit, or too large a \
             `detection.alert`",
        );
        Err(self.source.locate(fault))
    }

    /// Rejects a period so small that two balls could touch each other on both sides.
    pub(super) fn refuse_small_period(&self, reach: f64) -> Result<(), InputError> {
        let widest = self.radii().fold(0.0, f64::max);
        for (k, name) in ["x", "y", "z"].into_iter().enumerate() {
            let period = self.shapes.periodic.period[k];
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
