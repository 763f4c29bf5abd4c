//! Choices of the method `auto` in a step, and the hyperstaticity of a contact set.

use super::form::{ContactForm, RowPlace};

use super::nodal::NodalSystem;
use super::problem::Problem;
use crate::geometry::space::{MatrixLike, Space, VectorLike};

/// Result of a method in a step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Attempt {
    /// The method was not tried.
    #[default]
    No,
    /// The method did not reach the tolerance.
    Failed,
    /// The method reached the tolerance.
    Ended,
}

/// The choices of [`super::local::solver::Method::Auto`] in a step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum SolvePath {
    /// Gauss-Seidel was enough, or another method was requested.
    #[default]
    Sweeps,
    /// Gauss-Seidel used its initial allowance and was given more, since the set is hyperstatic.
    Longer {
        /// The set's [`hyperstaticity`].
        hyperstaticity: f64,
    },
    /// Gauss-Seidel used its allowance, and factorising methods were tried.
    Factorised {
        /// Number of Gauss-Seidel iterations before the factorising methods.
        after: u32,
        /// The set's [`hyperstaticity`].
        hyperstaticity: f64,
        /// Result of Newton's last attempt.
        newton: Attempt,
        /// Result of the interior point.
        interior: Attempt,
    },
    /// Gauss-Seidel used its allowance, and Newton in velocities was tried.
    InVelocities {
        /// Number of Gauss-Seidel iterations before it.
        after: u32,
        /// Its result.
        newton: Attempt,
    },
    /// Gauss-Seidel used its allowance and continued, because Newton does not support friction
    /// against rotation.
    Unserved,
    /// Gauss-Seidel used its allowance and continued, because the set is too large to factorise.
    Large,
}

impl SolvePath {
    /// Combines the choices of several solves of a step: the first choice that used more than
    /// Gauss-Seidel.
    #[must_use]
    pub fn or(self, later: Self) -> Self {
        if self == Self::Sweeps { later } else { self }
    }
}

/// Returns the number of unknown impulses of active contacts divided by the number of degrees of
/// freedom of the bodies they act on. Above 1 the set is hyperstatic: the motion does not determine
/// the impulses.
///
/// A frictionless contact has one unknown. Rotations count where a contact can rotate the body, by
/// friction or by a lever arm. The impulse of a bond follows from its opening and is no unknown.
/// For a dynamical system the motions of the nodes with contacts count. The result is 0 without
/// active contacts.
pub fn hyperstaticity<S: Space>(problem: &Problem<S>, forms: &[ContactForm<S>]) -> f64 {
    /// Flags of a body with a contact, and of one that contacts can rotate.
    const TOUCHED: u8 = 1;
    const TURNED: u8 = 3;
    let mut state = vec![0u8; problem.masses.len()];
    let still = |system: &NodalSystem<S>| vec![false; system.nodes.len()];
    let mut nodes: Vec<Vec<bool>> = problem.systems.iter().map(still).collect();
    let mut unknowns = 0;
    for (k, form) in forms.iter().enumerate() {
        let solution = problem.solution(k);
        let carries = solution.unilateral_n != 0.0 || solution.unilateral_t != S::Tangent::zero();
        let moves = |b: &u32| problem.masses[*b as usize].moves();
        let terms = match problem.places[k] {
            RowPlace::System(r) => problem.of_systems[r as usize].terms(),
            _ => &[],
        };
        if !carries || (!form.bodies.iter().any(moves) && terms.is_empty()) {
            continue;
        }
        for term in terms {
            nodes[term.system as usize][term.node as usize] = true;
        }
        let rough = form.friction > 0.0 || form.cohesion > 0.0;
        unknowns += if rough { S::D } else { 1 };
        for body in form.bodies {
            state[body as usize] |= if rough || !form.central {
                TURNED
            } else {
                TOUCHED
            };
        }
    }
    let freedoms: usize = state
        .iter()
        .enumerate()
        .filter(|(_, state)| **state != 0)
        .map(|(b, state)| problem.masses[b].freedoms(*state == TURNED))
        .sum();
    let of_nodes = problem.systems.iter().zip(&nodes);
    let of_nodes: usize = of_nodes
        .map(|(system, touched)| {
            let touched = (0..touched.len()).filter(|a| touched[*a]);
            let axes = |a: usize| {
                let block = system.block(a as u32, a as u32);
                (0..S::D).filter(|k| block.entry(*k, *k) > 0.0).count()
            };
            touched.map(axes).sum::<usize>()
        })
        .sum();
    unknowns as f64 / (freedoms + of_nodes).max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::space::{Dim2, MatrixLike};
    use nalgebra::Vector2;

    /// Hyperstaticity of a ball on `supports` fixed bodies, all of them active.
    fn ball(supports: usize, friction: f64) -> f64 {
        let mut problem = Problem::<Dim2>::default();
        let body = |p: &mut Problem<Dim2>, inverse: f64| {
            let mass = Vector2::new(inverse, inverse);
            let inertia = MatrixLike::uniform(inverse);
            p.push_body(Vector2::zeros(), VectorLike::zero(), mass, inertia, 1.0);
        };
        body(&mut problem, 1.0);
        let mut forms = Vec::new();
        for k in 0..supports {
            body(&mut problem, 0.0);
            let angle = 1.0 + 0.1 * k as f64;
            let normal = Vector2::new(angle.cos(), angle.sin());
            let form = ContactForm::<Dim2> {
                bodies: [0, k as u32 + 1],
                normal,
                arms: [-normal, normal],
                friction,
                impulse: normal,
                ..ContactForm::default()
            };
            problem.push(&form);
            forms.push(form);
        }
        hyperstaticity(&problem, &forms)
    }

    #[test]
    fn unknowns_over_freedoms() {
        assert_eq!(ball(0, 0.3), 0.0);
        // One contact, two translations: without friction nothing rotates the ball.
        assert_eq!(ball(1, 0.0), 0.5);
        assert_eq!(ball(2, 0.0), 1.0);
        assert_eq!(ball(3, 0.3), 2.0);
    }
}
