//! Designs: the points at which a study evaluates its model.
//!
//! Points of the unit cube [0, 1)^k, one per row, which [`scale::Scale`] maps to the values of
//! factors; the same seed gives the same points. The design depends on the question:
//!
//! - [`grid`]: all combinations of given levels, for effects and interactions by analysis of
//!   variance;
//! - [`latin_hypercube`]: few points for many factors, for regression and rank correlation;
//! - [`sobol`]: points of low discrepancy that may be extended later;
//! - [`saltelli`]: the sets of points from which Sobol's indices follow.

pub mod grid;
pub mod latin_hypercube;
pub mod saltelli;
pub mod scale;
pub mod sobol;

use thiserror::Error;

/// Reason why a design does not exist.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum DesignError {
    /// A grid has more points than any study computes.
    #[error(
        "the levels give {points:e} combinations, more than {most}: take fewer levels or factors, or a Latin hypercube"
    )]
    Grid {
        /// Number of combinations.
        points: f64,
        /// Largest number.
        most: usize,
    },
    /// The Sobol sequence is longer or wider than its tables.
    #[error(
        "a Sobol sequence of {points} points in {dimensions} dimensions: there are at most {most_points} points in {most_dimensions} dimensions (for Sobol indices, two for each factor)"
    )]
    Sobol {
        /// Requested number of points.
        points: usize,
        /// Requested number of dimensions.
        dimensions: usize,
        /// Largest number of points.
        most_points: usize,
        /// Largest number of dimensions.
        most_dimensions: usize,
    },
    /// A scale without a range.
    #[error("{0}")]
    Scale(String),
}
