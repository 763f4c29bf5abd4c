//! Requirements of each method and features of a problem: a method that cannot solve a problem is
//! refused with a sentence, and `auto` skips it.

use super::local::solver::Method;
use super::problem::Problem;
use crate::geometry::space::Space;

/// How W = H A^-1 H^T is available, in ascending order.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Operator {
    /// Contact by contact, with velocities updated in place and the diagonal blocks.
    Sweep,
    /// Products of W with all impulses at once.
    Products,
    /// The matrix W, or a factorisation of it.
    #[default]
    Matrix,
}

/// Features of a problem that not every method supports.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Features {
    /// Rolling or spinning friction: the bound depends on another unknown.
    pub rotation: bool,
    /// Shear cohesion: friction without pressure.
    pub cohesion: bool,
    /// The strongest available form of W.
    pub operator: Operator,
}

impl Method {
    /// Returns the weakest form of W with which the method works in a step.
    pub fn operator(self) -> Operator {
        match self {
            Self::Auto | Self::Nlgs | Self::Anderson => Operator::Sweep,
            Self::Pg | Self::Cpg | Self::Pcpg | Self::Apgd => Operator::Products,
            // The backward sweep of a step goes over the rows of the matrix.
            Self::NlgsSymmetric | Self::Newton | Self::Interior => Operator::Matrix,
        }
    }

    /// Returns the form of W that a method needs in a problem in local form, where sweeps read the
    /// rows of the matrix.
    pub fn operator_in_local_form(self) -> Operator {
        match self.operator() {
            Operator::Products => Operator::Products,
            _ => Operator::Matrix,
        }
    }
}

impl<S: Space> Problem<S> {
    /// Returns the strongest available form of W. All contacts of a dynamical system are coupled:
    /// where they are too many for a matrix, only products are available.
    pub fn operator(&self) -> Operator {
        if self.coupled_by_systems() > MAX_COUPLED {
            Operator::Products
        } else {
            Operator::Matrix
        }
    }

    /// Largest number of entries of W between contacts of the same system; zero without systems.
    pub(super) fn coupled_by_systems(&self) -> f64 {
        let mut contacts = vec![0.0; self.systems.len()];
        for row in &self.of_systems {
            let blocks = if row.is_bonded() { 2.0 } else { 1.0 };
            let systems = row.terms().iter().map(|t| t.system as usize);
            let mut last = None;
            for system in systems {
                if last != Some(system) {
                    contacts[system] += S::D as f64 * blocks;
                }
                last = Some(system);
            }
        }
        contacts.iter().map(|m| m * m).sum()
    }
}

/// Limit of about 100 MB for W, and of about ten seconds for a factorisation.
const MAX_COUPLED: f64 = 1.2e7;

/// Returns why a method cannot solve a problem with these features, and what to use instead; `None`
/// if it can.
pub fn refusal(method: Method, features: &Features) -> Option<&'static str> {
    if method.operator() > features.operator {
        return Some(
            "the contacts of a dynamical system are all coupled, and there are too many of them to form W as a matrix; use auto, \
             anderson, nlgs or a gradient",
        );
    }
    match method {
        Method::Newton if features.rotation => Some(
            "friction against rotation is bounded by another unknown, which newton does not follow; use auto, anderson or a gradient",
        ),
        Method::Interior if features.rotation || features.cohesion => Some(
            "interior solves Coulomb's cone and bonds, without shear cohesion or friction against rotation; use auto, newton or anderson",
        ),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solve::error::Norm;
    use crate::solve::local::block::{Block, BlockMatrix};
    use crate::solve::local::form::{Delassus, Form};
    use crate::solve::local::law::Law;
    use crate::solve::local::state::{Budget, Iteration};

    /// An operator that provides products only.
    struct Products(BlockMatrix<2>);

    impl Delassus<2> for Products {
        fn len(&self) -> usize {
            self.0.len()
        }

        fn diagonal(&self, c: usize) -> &Block<2> {
            self.0.diagonal(c)
        }

        fn velocity(&self, p: &[[f64; 2]], q: &[[f64; 2]], u: &mut [[f64; 2]]) {
            self.0.velocity(p, q, u);
        }

        fn matrix(&self) -> Option<&BlockMatrix<2>> {
            None
        }
    }

    /// Two weakly coupled contacts: methods that declare products as sufficient solve the problem
    /// without the matrix; the others leave it unchanged.
    #[test]
    fn methods_work_with_what_they_ask_for() {
        let mut matrix = BlockMatrix::new(vec![[[1.0, 0.1], [0.1, 2.0]]; 2]);
        for other in [1, 0] {
            matrix.push(other, &[[0.2, 0.0], [0.0, 0.3]]);
            matrix.end_row();
        }
        let q = [[-1.0, 0.5], [-2.0, -3.0]];
        let laws = [Law::Coulomb(0.4); 2];
        let products = Products(matrix.clone());
        for method in Method::ALL {
            let error = |w: &dyn Delassus<2>| {
                let form = Form::new(w, &q, &laws, Norm::Velocity);
                let mut state = Iteration::new(&form, vec![[0.0; 2]; 2]);
                let mut budget = Budget::new(1e-8, 10_000, f64::INFINITY);
                method.solver().solve(&form, &mut state, &mut budget);
                state.error
            };
            let enough = method.operator_in_local_form() <= Operator::Products;
            assert!(error(&matrix) <= 1e-8, "{}", method.name());
            assert_eq!(error(&products) <= 1e-8, enough, "{}", method.name());
        }
    }

    #[test]
    fn sweeps_serve_every_problem_and_matrices_those_that_have_one() {
        let swept = Features {
            operator: Operator::Sweep,
            ..Features::default()
        };
        let products = Features {
            operator: Operator::Products,
            ..Features::default()
        };
        let served = |features: &Features| -> Vec<&str> {
            let methods = Method::ALL.iter().copied();
            let served = methods.filter(|m| refusal(*m, features).is_none());
            served.map(Method::name).collect()
        };
        assert_eq!(served(&swept), ["auto", "nlgs", "anderson"]);
        assert_eq!(
            served(&products),
            ["auto", "nlgs", "anderson", "pg", "cpg", "pcpg", "apgd"]
        );
        assert_eq!(served(&Features::default()).len(), Method::ALL.len());
        let rolls = Features {
            rotation: true,
            ..Features::default()
        };
        assert!(refusal(Method::Newton, &rolls).is_some_and(|r| r.contains("rotation")));
    }
}
