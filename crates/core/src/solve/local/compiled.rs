//! The methods on a block matrix, compiled once for each dimension, so that dependent crates do not
//! compile them again.

use super::block::BlockMatrix;
use super::form::Form;
use super::law::Law;
use super::solver::Method;
use super::state::{Budget, State};
use crate::solve::error::Norm;

/// Dimensions for which this crate compiles the methods; implemented for [`Method`].
pub trait Solves<const D: usize> {
    /// Solves from p = 0 the problem of matrix `w`, free velocities `q` and one law per contact,
    /// with errors in `norm`.
    fn solve_blocks(
        self,
        w: &BlockMatrix<D>,
        q: &[[f64; D]],
        laws: &[Law],
        norm: Norm,
        budget: &mut Budget,
    ) -> State<D>;
}

fn solve<const D: usize>(
    method: Method,
    w: &BlockMatrix<D>,
    q: &[[f64; D]],
    laws: &[Law],
    norm: Norm,
    budget: &mut Budget,
) -> State<D> {
    let form = Form::new(w, q, laws, norm);
    let mut state = State::new(&form, vec![[0.0; D]; q.len()]);
    method.solver().solve(&form, &mut state, budget);
    state
}

macro_rules! compiled {
    ($dimension:literal) => {
        impl Solves<$dimension> for Method {
            fn solve_blocks(
                self,
                w: &BlockMatrix<$dimension>,
                q: &[[f64; $dimension]],
                laws: &[Law],
                norm: Norm,
                budget: &mut Budget,
            ) -> State<$dimension> {
                solve(self, w, q, laws, norm, budget)
            }
        }
    };
}

compiled!(2);
compiled!(3);
