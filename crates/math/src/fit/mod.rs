//! Fits of parameters to measured curves.
//!
//! A fit asks [`cma_es`] for points, maps them by [`bounds`] to values of parameters, runs these
//! (some seeds each, how many says [`seeds`]), compares the curves with the measured ones by
//! [`residuals`], and reports the sums of squares to the search. From all these runs [`identify`]
//! then says how well the data determine each parameter, and which combinations not at all.

pub mod bounds;
pub mod cma_es;
pub mod identify;
pub mod residuals;
pub mod seeds;
