//! Dependence of an output on factors.
//!
//! - [`sobol_indices`]: shares of the variance over the whole range of all factors, from the points
//!   of [`saltelli`](crate::design::saltelli);
//! - [`main_effects`]: means per level, and [`anova`]: analysis of variance with interactions, from
//!   a full grid;
//! - [`regression`]: standardised coefficients of a linear model, and [`ranks`]: rank correlations,
//!   from any points.
//!
//! Outputs scatter with the seed of a run. [`points`] groups the seeds of a point, and the analyses
//! separate this noise from the effects of factors.

pub mod anova;
pub mod main_effects;
pub mod points;
pub mod ranks;
pub mod regression;
pub mod sobol_indices;

use thiserror::Error;

/// Reason why an analysis is not possible.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum SensitivityError {
    /// The numbers of inputs and outputs do not match.
    #[error(
        "{outputs} outputs for {inputs} runs: give one output per run, none for a run that failed"
    )]
    Length {
        /// Number of expected runs.
        inputs: usize,
        /// Number of given outputs.
        outputs: usize,
    },
    /// Rows have different lengths.
    #[error("run {run} has {found} factors where the first has {expected}")]
    Ragged {
        /// Number of the run, from 0.
        run: usize,
        /// Number of factors of the first run.
        expected: usize,
        /// Number of factors of this run.
        found: usize,
    },
    /// There are too few successful runs.
    #[error(
        "{complete} complete {what}, at least {needed} are needed: run more points, or find out why runs fail"
    )]
    Few {
        /// Name of the counted items.
        what: &'static str,
        /// Available number.
        complete: usize,
        /// Required number.
        needed: usize,
    },
    /// The output is the same in all runs.
    #[error("the output is the same in all runs: no factor has an effect on it")]
    Constant,
    /// A combination of levels has no value.
    #[error(
        "{missing} of {cells} combinations of levels have no run that succeeded: an analysis of variance needs all of them"
    )]
    Cells {
        /// Number of combinations without a value.
        missing: usize,
        /// Number of all combinations.
        cells: usize,
    },
    /// Factors vary together.
    #[error(
        "the factors of these points cannot be distinguished: one does not vary, or some vary together"
    )]
    Dependent,
}

/// Checks that the rows have one length and there is an output for each.
fn check_lengths<T>(rows: &[Vec<T>], outputs: usize) -> Result<usize, SensitivityError> {
    if rows.len() != outputs {
        return Err(SensitivityError::Length {
            inputs: rows.len(),
            outputs,
        });
    }
    let expected = rows.first().map_or(0, Vec::len);
    match rows.iter().position(|r| r.len() != expected) {
        Some(run) => Err(SensitivityError::Ragged {
            run,
            expected,
            found: rows[run].len(),
        }),
        None => Ok(expected),
    }
}
