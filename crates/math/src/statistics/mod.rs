//! Statistics of runs over their seeds: means with intervals, comparisons, distributions.

pub mod bootstrap;
pub mod comparisons;
pub(crate) mod distribution;
pub(crate) mod eigen;
pub mod interval;
pub(crate) mod least_squares;
pub(crate) mod random;
