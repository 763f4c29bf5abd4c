//! Contact problems given as a matrix: u = W p + q, K* contains u + mu |u_t| n, perpendicular to p
//! in K.
//!
//! This is the form of the public collection FCLIB. Components are (n, t) or (n, t1, t2), contact
//! after contact.
#![allow(
    clippy::needless_range_loop,
    reason = "loops over the components of blocks read like their formulas"
)]

pub mod accelerated;
pub mod anderson;
pub mod auto;
pub mod block;
pub mod contact;
pub mod coulomb_sums;
pub mod csr;
pub mod factor;
pub mod factored;
pub mod form;
pub mod global;
pub mod gradient;
pub mod interior;
pub mod law;
pub mod linear;
mod lorentz;
pub mod newton;
pub mod nlgs;
pub mod reduce;
pub mod scale_free;
pub mod solver;
pub mod state;

pub use csr::Csr;
pub use global::{Equalities, GlobalProblem, Multipliers};
pub use reduce::{Elimination, ReduceError, Reduction};

/// A local problem of either dimension.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LocalProblem {
    /// Components of a contact: 2 or 3.
    pub dimension: usize,
    /// The Delassus operator, a square matrix of size `dimension * mu.len()` (1/kg, or the unit of
    /// the file).
    pub w: Csr,
    /// Free relative velocities.
    pub q: Vec<f64>,
    /// Friction coefficients.
    pub mu: Vec<f64>,
}

impl LocalProblem {
    /// Checks that the sizes agree and every number is usable.
    ///
    /// # Errors
    /// A sentence about the first problem found.
    pub fn check(&self) -> Result<(), String> {
        let (d, n) = (self.dimension, self.q.len());
        if d != 2 && d != 3 {
            return Err(format!("a contact has 2 or 3 components, not {d}"));
        }
        if self.mu.len() * d != n || self.w.rows != n || self.w.columns != n {
            return Err(format!(
                "{} contacts of {d} components ask for W of {m} x {m} and q of {m}, not {} x {} and {n}",
                self.mu.len(),
                self.w.rows,
                self.w.columns,
                m = self.mu.len() * d,
            ));
        }
        let finite = |x: &[f64], name: &str| match x.iter().position(|x| !x.is_finite()) {
            Some(at) => Err(format!("entry {at} of {name} is {}", x[at])),
            None => Ok(()),
        };
        finite(&self.w.values, "W")?;
        finite(&self.q, "q")?;
        finite(&self.mu, "mu")?;
        match self.mu.iter().position(|mu| *mu < 0.0) {
            Some(at) => Err(format!("mu of contact {at} is below 0: {}", self.mu[at])),
            None => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two contacts in 2D, and the error for each change of them.
    #[test]
    fn problems_are_checked() {
        let sound = || LocalProblem {
            dimension: 2,
            w: Csr::from_triplets(4, 4, &[(0, 0, 1.0), (1, 1, 1.0), (2, 2, 1.0), (3, 3, 1.0)]),
            q: vec![0.0; 4],
            mu: vec![0.0, 0.5],
        };
        assert_eq!(sound().check(), Ok(()));
        let said = |change: &dyn Fn(&mut LocalProblem)| {
            let mut problem = sound();
            change(&mut problem);
            problem.check().unwrap_err()
        };
        assert!(said(&|p| p.dimension = 4).contains("not 4"));
        let sizes = "2 contacts of 2 components ask for W of 4 x 4 and q of 4, not ";
        for (rows, columns) in [(3, 4), (4, 3)] {
            let message = said(&|p| p.w = Csr::from_triplets(rows, columns, &[]));
            assert_eq!(message, format!("{sizes}{rows} x {columns} and 4"));
        }
        assert_eq!(said(&|p| p.q.push(0.0)), format!("{sizes}4 x 4 and 5"));
        assert!(said(&|p| p.mu.push(0.0)).starts_with("3 contacts of 2"));
        assert_eq!(said(&|p| p.w.values[1] = f64::NAN), "entry 1 of W is NaN");
        assert_eq!(said(&|p| p.q[3] = f64::INFINITY), "entry 3 of q is inf");
        assert_eq!(said(&|p| p.mu[0] = f64::NAN), "entry 0 of mu is NaN");
        assert_eq!(
            said(&|p| p.mu[1] = -0.5),
            "mu of contact 1 is below 0: -0.5"
        );
    }
}
