//! Choice of the method that solves a step.
//!
//! The Gauss-Seidel iteration over bodies is matrix-free and almost always sufficient.
//! [`Method::Auto`] runs it for the estimated cost of twenty factorisations of W (forty at a loose
//! tolerance), then tries Newton on the assembled W, then once the interior point if Newton failed
//! and the contact set is not hyperstatic, and then alternates longer runs of Gauss-Seidel with
//! Newton until one of them converges. For a hyperstatic set Newton starts ten times later. If
//! neither helped, they start later in the following steps, until one of them helps again. All
//! lengths follow from problem sizes, not from timings, so that a case takes the same path on any
//! machine. Where all contacts are springs, Newton in the velocities of the bodies takes the place
//! of both ([`super::velocities`]).

use super::chosen::{Attempt, SolvePath, hyperstaticity};
use super::context::{AutoState, SolveContext};
use super::form::ContactForm;

use super::local::auto::{factorisations_before_newton, sweeps_per_factorisation};
use super::local::solver::Method;
use super::nlgs::{self, Report, SolverOptions};
use super::problem::Problem;
use super::requirements::{Features, Operator, refusal};
use super::row::MomentForm;
use super::standard::Standard;
use super::sticking;
use super::velocities::{self, Start};
use crate::geometry::space::{Space, VectorLike};
use std::ops::RangeInclusive;

/// Number of contacts from which the start is checked before the first iteration, at about the cost
/// of one iteration. In smaller problems a search for undetermined impulses takes place in every
/// step ([`super::sticking`]), and an iteration is often exact.
const CHECKED_FIRST: RangeInclusive<usize> =
    sticking::MAX_SMALL_SET + 1..=sticking::MAX_SEARCHED_SET;

/// Share of the tolerance up to which the initial impulses are kept. Iterations in one order may
/// not contract: rounding errors in a body at rest would otherwise grow from step to step, up to
/// the tolerance.
const AT_REST: f64 = 1e-3;

/// Time of a dense factorisation relative to a sparse one with as many entries, measured on
/// `cases/cylinder_on_flat_fretting.ron` with some 80 contacts of two systems.
const DENSE: f64 = 1.0 / 6.0;
/// Factor on the iterations for a hyperstatic set, where Newton takes more steps and fails in one
/// case of three.
const HYPERSTATIC: u32 = 10;
/// Maximum number of unknowns to factorise.
const MAX_FACTORISED: usize = 60_000;
/// Number of Newton steps of the first attempt.
const NEWTON: u32 = 40;
/// Hyperstaticity below which the interior point is tried after Newton failed: there Newton fails
/// because of slow propagation, as in a column, not for lack of rank. Above it the interior point
/// failed in 7 attempts of 8.
const DETERMINED: f64 = 0.95;
/// Largest number of iterations of Newton in velocities, and the number of iterations in whose time
/// sweeps have to be done for it to be tried.
const ATTEMPT: u32 = 80;
const BRIEF: f64 = 5.0;
/// Number of times that a factorising method is called with a smaller tolerance, in general and
/// where contacts act on systems.
const ATTEMPTS: [u32; 2] = [4, 20];
/// Maximum number of interior-point steps.
const INTERIOR: u32 = 120;

/// Solves the problem in place, starting from the impulses of its forms; Newton in velocities from
/// `start`, without one from the velocities by these impulses.
pub fn solve<S: Space>(
    problem: &mut Problem<S>,
    forms: &[ContactForm<S>],
    moments: &[MomentForm<S>],
    options: &SolverOptions,
    start: Option<Start<S>>,
    auto_state: &mut AutoState,
) -> Report {
    let context = SolveContext {
        forms,
        moments,
        options,
        start,
    };
    let mut report = match options.method {
        Method::Nlgs => context.sweep(problem, options.max_iterations),
        Method::Anderson => context.sweep_accelerated(problem, options.max_iterations),
        Method::Auto => context.auto(problem, auto_state),
        method => context.solve_by(problem, method),
    };
    if !report.unbounded {
        context.prefer_sticking(problem, &mut report, auto_state);
        return report;
    }
    if context.grew(problem) {
        return context.give_up(problem, &report);
    }
    Report {
        unbounded: false,
        ..report
    }
}

/// State of the alternation between factorising methods and Gauss-Seidel.
struct Alternation {
    /// Iterations of Gauss-Seidel before the first attempt.
    sweeps: u32,
    hyperstaticity: f64,
    /// Whether the interior point is to be tried.
    interior: bool,
}

impl<S: Space> SolveContext<'_, S> {
    /// Solves by one method. If the error recomputed over bodies is slightly above the tolerance,
    /// the method continues.
    fn solve_by(&self, problem: &mut Problem<S>, method: Method) -> Report {
        let mut report = nlgs::arrange(problem, self.options);
        if method == Method::Newton
            && !report.converged
            && let Some(solved) = self.solve_in_velocities(problem, self.options.max_iterations)
        {
            report.add(&solved);
            if report.converged {
                return report;
            }
        }
        let (tolerance, most) = (self.options.tolerance, self.options.max_iterations);
        let attempts = ATTEMPTS[usize::from(!problem.of_systems.is_empty())];
        self.improve_until(problem, &mut report, method, (tolerance, most, attempts));
        Report {
            used: method,
            ..report
        }
    }

    /// Improves the solution until its error over bodies is within the tolerance. Each attempt
    /// lowers the tolerance of the method by the same ratio, since the method's own error does not
    /// contain the tractions of systems. Iterations and attempts are limited.
    fn improve_until(
        &self,
        problem: &mut Problem<S>,
        report: &mut Report,
        method: Method,
        (mut tolerance, most, attempts): (f64, u32, u32),
    ) {
        // Largest ratio of the error after an attempt to that before; number of successive attempts
        // that may exceed it; and smallest factor on the tolerance, below which rounding would
        // prevent progress.
        const LESS: f64 = 0.9;
        const STALLED: u32 = 2;
        const FALLS: f64 = 1e-2;
        let (mut left, mut stalled) = (most, 0);
        for _ in 0..attempts {
            if report.converged || left == 0 || stalled == STALLED {
                break;
            }
            let before = report.error;
            let next = self.improve(problem, method, tolerance, left);
            left = left.saturating_sub(next.iterations);
            report.add(&next);
            // A method that did nothing has not failed: its own error lacks a part of the total
            // error.
            let less = report.error < LESS * before || next.iterations == 0;
            stalled = if less { 0 } else { stalled + 1 };
            tolerance *= 0.3 * (self.options.tolerance / report.error).clamp(FALLS, 1.0);
        }
    }

    /// Returns whether the impulses grew in this solve beyond what shifts of velocities and bonds
    /// explain. Otherwise bodies hold each other, and the velocities of bodies at rest are rounding
    /// errors.
    fn grew(&self, problem: &Problem<S>) -> bool {
        /// Squared growth: a load that appears in one step, with any wedges, stays far below it.
        const GROWTH: f64 = 1e12;
        let (mut now, mut explained) = (0.0, 0.0);
        for (k, form) in self.forms.iter().enumerate() {
            let p = problem.solution(k).impulse;
            now += p.dot(&p);
            explained += form.impulse.dot(&form.impulse);
            // An attraction presses at rest.
            explained += form.tension.powi(2) + form.cohesion.powi(2);
            if let Some(e) = &form.elastic {
                explained += e.a_n * e.a_n + e.a_t.dot(&e.a_t);
            }
            let [c_n, c_t] = form.compliance;
            if c_n > 0.0 {
                explained += (form.shift_n / c_n).powi(2);
            }
            if c_t > 0.0 {
                explained += form.shift_t.dot(&form.shift_t) / (c_t * c_t);
            }
        }
        now > GROWTH * explained
    }

    /// Ends a solve whose impulses grew without bound, with the impulses of a few sweeps from zero:
    /// they are finite, oppose bodies that approach, and do not grow from step to step.
    fn give_up(&self, problem: &mut Problem<S>, so_far: &Report) -> Report {
        const SWEEPS: u32 = 10;
        let impulses = vec![Some(S::Vector::zero()); self.forms.len()];
        let moments = vec![Some(S::Spin::zero()); self.moments.len()];
        problem.adopt(&impulses, &moments);
        let mut report = *so_far;
        report.add(&self.sweep(problem, SWEEPS));
        Report {
            converged: false,
            unbounded: true,
            used: so_far.used,
            ..report
        }
    }

    /// Solves by Gauss-Seidel, and by factorising methods where Gauss-Seidel takes longer than they
    /// cost.
    fn auto(&self, problem: &mut Problem<S>, auto_state: &mut AutoState) -> Report {
        let options = self.options;
        if CHECKED_FIRST.contains(&problem.contacts()) {
            let report = nlgs::arrange(problem, options);
            if report.error <= AT_REST * options.tolerance {
                // No sweep was needed.
                return Report {
                    used: Method::Anderson,
                    ..report
                };
            }
        }
        if problem.contacts() > 0
            && self.velocities_serve(problem)
            && let Some(cost) = velocities::sweeps_per_iteration(problem)
        {
            return self.sweeps_or_velocities(problem, cost, auto_state);
        }
        let sweeps = self.sweeps_before_newton(problem, auto_state);
        let rolls = |m: &MomentForm<S>| m.rolling > 0.0 || m.spinning > 0.0;
        let features = Features {
            rotation: self.moments.iter().any(rolls),
            cohesion: false,
            operator: problem.operator(),
        };
        let large =
            problem.contacts() * S::D > MAX_FACTORISED || features.operator < Operator::Matrix;
        let of_the_laws = Features {
            operator: Operator::Matrix,
            ..features
        };
        let without_newton = if refusal(Method::Newton, &of_the_laws).is_some() {
            Some(SolvePath::Unserved)
        } else {
            large.then_some(SolvePath::Large)
        };
        if let Some(chosen) = without_newton {
            let mut report = self.sweep_accelerated(problem, options.max_iterations);
            if report.iterations > sweeps {
                report.chosen = chosen;
            }
            return report;
        }
        let mut report = self.sweep_accelerated(problem, options.max_iterations.min(sweeps));
        let left = options.max_iterations - report.iterations;
        if report.converged || report.unbounded || left == 0 {
            return report;
        }
        let hyperstaticity = hyperstaticity(problem, self.forms);
        if hyperstaticity > 1.0 {
            // Leaves iterations for another attempt of Newton.
            let more = (left / 2).min(sweeps.saturating_mul(HYPERSTATIC - 1));
            report.add(&self.sweep_accelerated(problem, more));
            report.chosen = SolvePath::Longer { hyperstaticity };
        }
        let features = Features {
            cohesion: self.forms.iter().any(|f| f.cohesion > 0.0),
            ..features
        };
        let interior = hyperstaticity < DETERMINED
            && refusal(Method::Interior, &features).is_none()
            && auto_state.interior_is_due();
        self.alternate(
            problem,
            &mut report,
            auto_state,
            Alternation {
                sweeps,
                hyperstaticity,
                interior,
            },
        );
        report
    }

    /// Solves a problem of compliant contacts: by Gauss-Seidel, by Newton in velocities where that
    /// takes longer, and where Newton fails by Gauss-Seidel to the end. An iteration of Newton
    /// takes the time of `cost` sweeps.
    fn sweeps_or_velocities(
        &self,
        problem: &mut Problem<S>,
        cost: f64,
        auto_state: &mut AutoState,
    ) -> Report {
        let most = self.options.max_iterations;
        // A solve that is meant to be brief, or one that may not take the time of Newton.
        if f64::from(most) < BRIEF * cost {
            return self.sweep_accelerated(problem, most);
        }
        let sweeps = (cost * auto_state.velocities.before()) as u32;
        let mut report = self.sweep_accelerated(problem, sweeps.min(most / 2));
        if report.converged {
            auto_state.velocities.sweeps_sufficed();
        }
        if report.converged || report.unbounded {
            return report;
        }
        let after = report.iterations;
        let mut newton = Attempt::No;
        if let Some(solved) = self.solve_in_velocities(problem, ATTEMPT) {
            report.add(&solved);
            newton = if solved.converged {
                Attempt::Ended
            } else {
                Attempt::Failed
            };
            auto_state.velocities.tried(&solved);
        }
        report.chosen = SolvePath::InVelocities { after, newton };
        let left = most.saturating_sub(report.iterations);
        if newton != Attempt::Ended && left > 0 {
            report.add(&self.sweep_accelerated(problem, left));
        }
        report
    }

    /// Returns the number of Gauss-Seidel iterations before Newton, whose cost equals that of some
    /// factorisations.
    fn sweeps_before_newton(&self, problem: &Problem<S>, auto_state: &AutoState) -> u32 {
        // Estimate: a contact between balls shares a body with about eight others.
        let unknowns = problem.contacts() * S::D;
        let (sparse, dense) = ((9 * S::D * unknowns) as f64, problem.coupled_by_systems());
        let mut per = sweeps_per_factorisation(sparse + dense, problem.contacts() as f64);
        if dense > 0.0 {
            // The blocks of a system are dense: their factorisation costs a sixth of that of as
            // many sparse entries.
            let parts = sparse.powf(1.5) + DENSE * dense.powf(1.5);
            per *= parts / (sparse + dense).powf(1.5);
        }
        let worth = factorisations_before_newton(self.options.tolerance);
        let sweeps = worth * per * auto_state.patience;
        sweeps.clamp(200.0, f64::from(u32::MAX / 2)) as u32
    }

    /// Alternates attempts of Newton, of the interior point once if it is due, and longer runs of
    /// Gauss-Seidel, until one of them converges.
    fn alternate(
        &self,
        problem: &mut Problem<S>,
        report: &mut Report,
        auto_state: &mut AutoState,
        Alternation {
            sweeps,
            hyperstaticity,
            mut interior,
        }: Alternation,
    ) {
        let options = self.options;
        let after = report.iterations;
        let (mut newton, mut inside) = (Attempt::No, Attempt::No);
        let mut round = 0;
        let ended = |r: &Report| r.converged || r.unbounded;
        while !ended(report) && report.iterations < options.max_iterations {
            let first = round == 0 && interior && auto_state.interior_first;
            if first {
                inside = self.interior(problem, report, auto_state);
                interior = false;
            }
            let steps = NEWTON << round.min(16);
            // The iterate of Gauss-Seidel may be a poor start for Newton: every other attempt
            // starts from the initial impulses.
            let anew = round % 2 == 1;
            if !ended(report) {
                newton = self.attempt(problem, report, Method::Newton, steps, anew);
            }
            if !ended(report) && interior {
                inside = self.interior(problem, report, auto_state);
                interior = false;
            }
            report.chosen = SolvePath::Factorised {
                after,
                hyperstaticity,
                newton,
                interior: inside,
            };
            let left = options.max_iterations.saturating_sub(report.iterations);
            if !ended(report) && left > 0 {
                let more = sweeps.saturating_mul(HYPERSTATIC << round.min(16));
                report.add(&self.sweep_accelerated(problem, left.min(more)));
            }
            round += 1;
        }
        if let SolvePath::Factorised { .. } = report.chosen {
            auto_state.adapt(newton == Attempt::Ended || inside == Attempt::Ended);
        }
    }

    /// Tries the interior point, which does not depend on the current impulses.
    fn interior(
        &self,
        problem: &mut Problem<S>,
        report: &mut Report,
        auto_state: &mut AutoState,
    ) -> Attempt {
        let tried = self.attempt(problem, report, Method::Interior, INTERIOR, false);
        auto_state.learn(tried == Attempt::Ended);
        tried
    }

    /// Tries a factorising method, from the current impulses or from those of the forms; keeps the
    /// solution with the smaller error.
    fn attempt(
        &self,
        problem: &mut Problem<S>,
        report: &mut Report,
        method: Method,
        steps: u32,
        anew: bool,
    ) -> Attempt {
        let left = self
            .options
            .max_iterations
            .saturating_sub(report.iterations);
        if left == 0 {
            return Attempt::No;
        }
        let mut saved = Vec::new();
        problem.store(&mut saved);
        let before = Report {
            iterations: 0,
            ..*report
        };
        if anew {
            self.start_anew(problem);
        }
        let tolerance = 0.3 * self.options.tolerance;
        let attempts = if problem.of_systems.is_empty() {
            1
        } else {
            ATTEMPTS[1]
        };
        let limits = (tolerance, steps.min(left), attempts);
        self.improve_until(problem, report, method, limits);
        if !report.converged && report.error > before.error {
            problem.restore(&saved);
            report.add(&before);
        }
        if report.converged {
            Attempt::Ended
        } else {
            Attempt::Failed
        }
    }
}

/// Returns the local form of a problem of Coulomb contacts: W, q, mu; `None` where another law
/// acts, or where W is not available as a matrix.
pub fn coulomb<S: Space>(
    problem: &Problem<S>,
    forms: &[ContactForm<S>],
    moments: &[MomentForm<S>],
) -> Option<super::local::LocalProblem> {
    if problem.operator() < Operator::Matrix {
        return None;
    }
    let (w, q, mu) = if S::D == 2 {
        Standard::<S, 2>::new(problem, forms, moments).coulomb()?
    } else {
        Standard::<S, 3>::new(problem, forms, moments).coulomb()?
    };
    Some(super::local::LocalProblem {
        dimension: S::D,
        w,
        q,
        mu,
    })
}
