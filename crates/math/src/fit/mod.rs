//! Fits of parameters to measured curves.
//!
//! A fit gets points from [`cma_es`], maps them by [`bounds`] to values of parameters, makes runs
//! with these values (with the number of seeds that [`seeds`] proposes), compares the curves with
//! the measured ones by [`residuals`], and returns the sums of squares to the search. From all
//! these runs [`identify`] then determines how well the data determine each parameter, and which
//! combinations they do not determine.

pub mod bounds;
pub mod cma_es;
pub mod identify;
pub mod residuals;
pub mod seeds;
