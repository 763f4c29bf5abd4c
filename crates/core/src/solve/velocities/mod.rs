//! Newton's method in the velocities of the bodies, for contacts that are springs.
//!
//! With the impulses of springs as functions of the relative velocities u = H^T v, the step has the
//! velocities as its only unknowns:
//!
//! ```text
//! F(v) = M (v - v_free) - sum_c H_c p_c(H_c^T v) = 0
//! P    = max(0, tension - (u_n + s_n)/c_n),   p_n = P - tension
//! p_t  = z, at most mu P + cohesion long,     z = -(u_t + s_t)/c_t
//! bond: p = -(a + B u), along the normal in tension only where it says so
//! ```
//!
//! The Jacobian M + sum_c H_c K_c H_c^T is sparse: a body is coupled to its neighbours. It is
//! symmetric but for the friction of contacts that slide, whose bound changes with the normal
//! velocity. Without this change it is factorised by Cholesky, which preconditions the iteration of
//! minimal residuals ([`krylov`]) for the whole. The cost of a solve grows little as the inertia of
//! bodies falls, where Gauss-Seidel takes ever more iterations.
//!
//! [`newton`] converges in some 4 to 10 iterations from velocities near the solution. Where many
//! contacts open, close or begin to slide at once it may fail, and [`barrier`] follows: an interior
//! point method, which needs a few tens of iterations from any start.
//!
//! Literature: P. Alart and A. Curnier, Comput. Methods Appl. Mech. Eng. 92 (1991) 353-375 (Newton
//! for contact with friction); A. M. Castro, F. N. Permenter and X. Han, IEEE Trans. Robotics 39
//! (2023) 1301-1320 (the step of compliant contacts in velocities); S. J. Wright, Primal-Dual
//! Interior-Point Methods, SIAM (1997).

mod balance;
mod barrier;
mod krylov;
mod law;
mod matrix;
mod newton;
mod patience;
#[cfg(test)]
mod tests;

use super::form::ContactForm;
use super::nlgs::{self, Report, SolverOptions};
use super::problem::Problem;
use super::row::MomentForm;
use crate::geometry::space::{Space, VectorLike};
use balance::Balance;
pub(super) use matrix::Pattern;
pub(super) use patience::{Patience, sweeps_per_iteration};

/// Velocities and spins of the bodies (m/s, rad/s) from which a solve starts: those before the
/// step, or of its last solve, near to which they are at its end.
#[derive(Clone, Copy, Debug)]
pub struct Start<'a, S: Space> {
    /// Velocities.
    pub velocity: &'a [S::Vector],
    /// Spins.
    pub spin: &'a [S::Spin],
}

/// Whether this method serves a problem: rigid bodies without friction against rotation, all
/// of whose contacts are compliant.
pub(super) fn serves<S: Space>(
    problem: &Problem<S>,
    forms: &[ContactForm<S>],
    moments: &[MomentForm<S>],
) -> bool {
    let turns_freely = |m: &MomentForm<S>| m.rolling == 0.0 && m.spinning == 0.0;
    problem.systems.is_empty() && forms.iter().all(is_compliant) && moments.iter().all(turns_freely)
}

/// Whether the impulses of a contact are functions of its velocities.
fn is_compliant<S: Space>(form: &ContactForm<S>) -> bool {
    let [c_n, c_t] = form.compliance;
    let slides = form.friction > 0.0 || form.cohesion > 0.0;
    let never_closes = form.shift_n == f64::INFINITY && form.cohesion == 0.0;
    never_closes || c_n > 0.0 && (c_t > 0.0 || !slides)
}

/// Solves a problem that [`serves`] accepts, at most with a number of factorisations, until the
/// error over bodies is within the tolerance; see [`nlgs::check_convergence`].
pub(super) fn solve<S: Space>(
    problem: &mut Problem<S>,
    forms: &[ContactForm<S>],
    moments: &[MomentForm<S>],
    start: Option<&Start<S>>,
    options: &SolverOptions,
) -> Report {
    let mut solve = Solve::new(problem, forms, moments, options);
    if solve.best.report.converged {
        return solve.best.report;
    }
    let begin = solve.balance.start(problem, start);
    newton::solve(&mut solve, problem, &begin);
    if !solve.ended() {
        barrier::solve(&mut solve, problem, &begin);
    }
    let Solve {
        balance,
        mut best,
        iterations,
        ..
    } = solve;
    best.report.iterations = iterations;
    problem.velocity_pattern = balance.pattern;
    if !best.report.converged {
        problem.adopt(&best.impulses, &best.moments);
    }
    best.report
}

/// A solve that is under way.
struct Solve<'a, S: Space> {
    balance: Balance<'a, S>,
    options: SolverOptions,
    /// Factorisations so far.
    iterations: u32,
    best: Best<S>,
}

/// The impulses with the smallest error so far, and their report.
struct Best<S: Space> {
    report: Report,
    impulses: Vec<Option<S::Vector>>,
    moments: Vec<Option<S::Spin>>,
}

impl<'a, S: Space> Solve<'a, S> {
    fn new(
        problem: &mut Problem<S>,
        forms: &'a [ContactForm<S>],
        moments: &'a [MomentForm<S>],
        options: &SolverOptions,
    ) -> Self {
        let mut report = nlgs::check_convergence(problem, options);
        let impulses = (0..problem.contacts()).map(|k| problem.solution(k).impulse);
        let impulses: Vec<_> = impulses.map(Some).collect();
        if !impulses.iter().flatten().all(S::Vector::is_finite) {
            (report.converged, report.error) = (false, f64::INFINITY);
        }
        Self {
            best: Best {
                report,
                impulses,
                moments: problem.moments().map(|m| Some(m.moment)).collect(),
            },
            balance: Balance::new(problem, forms, moments),
            options: *options,
            iterations: 0,
        }
    }

    /// Whether the solve has reached the tolerance or its limit.
    fn ended(&self) -> bool {
        self.best.report.converged || self.iterations >= self.options.max_iterations
    }

    /// Measures the error of the impulses at some velocities.
    fn measure(&mut self, problem: &mut Problem<S>, at: &balance::Evaluated<S>) {
        if !at.size.is_finite() {
            return;
        }
        let (impulses, moments) = self.balance.impulses(at);
        problem.adopt(&impulses, &moments);
        let report = nlgs::check_convergence(problem, &self.options);
        let better = report.converged || report.error < self.best.report.error;
        if better {
            self.best = Best {
                report,
                impulses,
                moments,
            };
        }
    }
}
