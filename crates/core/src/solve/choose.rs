//! Which method solves a step.
//!
//! Sweeps over bodies are matrix-free and nearly always enough. [`Method::Auto`] lets them run for as long as
//! twenty factorisations of W would take (twice as long at a loose tolerance), then tries Newton on the
//! assembled W, once the interior point where that did not end it and the set is not hyperstatic, and takes turns of longer
//! sweeps and Newton until one of them ends. On a hyperstatic set Newton comes ten times as late. Where neither helped they are tried half as early in
//! the steps that follow, until one helps again. The lengths follow from sizes alone: the same case takes the same path on
//! any machine.

use super::chosen::{Attempt, SolvePath, hyperstaticity};
use super::form::{ContactForm, Problem};
use super::local::auto::sweeps_per_factorisation;
use super::local::solver::Method;
use super::nlgs::{self, Options, Report};
use super::requirements::{Features, Operator, refusal};
use super::row::MomentForm;
use super::standard::{self, Standard};
use crate::geometry::space::Space;
use serde::{Deserialize, Serialize};

/// What the last steps taught.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct AutoState {
    /// Sweeps before Newton over what their costs say.
    patience: f64,
    /// Whether the interior point ended the last step that Newton did not: it then comes first.
    interior_first: bool,
    /// How often the interior point is to be passed over, and was to be after its last failure.
    passed_over: [u32; 2],
}

impl Default for AutoState {
    fn default() -> Self {
        Self {
            patience: 1.0,
            interior_first: false,
            passed_over: [0; 2],
        }
    }
}

impl AutoState {
    /// Whether the interior point has its turn: after each failure it is passed over twice as often, 64 times at most.
    fn interior_is_due(&mut self) -> bool {
        let due = self.passed_over[0] == 0;
        self.passed_over[0] = self.passed_over[0].saturating_sub(1);
        due
    }

    /// Learns from an attempt of the interior point.
    fn learn(&mut self, ended: bool) {
        self.interior_first = ended;
        let next = (2 * self.passed_over[1]).clamp(1, 64);
        self.passed_over = if ended { [0; 2] } else { [next; 2] };
    }
}

/// Solves the problem in place from the impulses of its forms.
pub fn solve<S: Space>(
    problem: &mut Problem<S>,
    forms: &[ContactForm<S>],
    moments: &[MomentForm<S>],
    options: &Options,
    habit: &mut AutoState,
) -> Report {
    let pieces = SolveContext {
        forms,
        moments,
        options,
    };
    match options.method {
        Method::Nlgs => pieces.sweep(problem, false, options.max_iterations),
        Method::Anderson => pieces.sweep(problem, true, options.max_iterations),
        Method::Auto => pieces.auto(problem, habit),
        method => pieces.by(problem, method),
    }
}

struct SolveContext<'a, S: Space> {
    forms: &'a [ContactForm<S>],
    moments: &'a [MomentForm<S>],
    options: &'a Options,
}

impl<S: Space> SolveContext<'_, S> {
    /// Sweeps over bodies, so many at most.
    fn sweep(&self, problem: &mut Problem<S>, accelerated: bool, most: u32) -> Report {
        let options = Options {
            accelerated,
            max_iterations: most,
            ..*self.options
        };
        Report {
            used: if accelerated {
                Method::Anderson
            } else {
                Method::Nlgs
            },
            ..nlgs::solve(problem, &options)
        }
    }

    /// Improves the problem by a method for matrices; its tolerance is that of the blocks' own error.
    fn improve(
        &self,
        problem: &mut Problem<S>,
        method: Method,
        tolerance: f64,
        most: u32,
    ) -> Report {
        let limits = (self.options.norm, tolerance, most);
        let (forms, moments) = (self.forms, self.moments);
        let iterations = if S::D == 2 {
            standard::improve::<S, 2>(problem, forms, moments, method, limits)
        } else {
            standard::improve::<S, 3>(problem, forms, moments, method, limits)
        };
        Report {
            iterations,
            used: method,
            ..nlgs::judge(problem, self.options)
        }
    }

    /// One method alone. Bodies may find the error a little larger than the blocks did: then it goes on.
    fn by(&self, problem: &mut Problem<S>, method: Method) -> Report {
        const ATTEMPTS: u32 = 4;
        let mut report = nlgs::arrange(problem, self.options);
        let mut tolerance = self.options.tolerance;
        for _ in 0..ATTEMPTS {
            let left = self
                .options
                .max_iterations
                .saturating_sub(report.iterations);
            if report.converged || left == 0 {
                break;
            }
            let next = self.improve(problem, method, tolerance, left);
            report.add(&next);
            tolerance *= 0.3;
        }
        Report {
            used: method,
            ..report
        }
    }

    fn auto(&self, problem: &mut Problem<S>, habit: &mut AutoState) -> Report {
        /// Factorisations' worth of sweeps before Newton, at a loose and at a tight tolerance.
        const LOOSE: f64 = 40.0;
        const TIGHT: f64 = 20.0;
        /// Times as many sweeps on a hyperstatic set, where Newton takes more steps and fails in every third.
        const HYPERSTATIC: u32 = 10;
        /// More unknowns than this are not factorised.
        const LARGEST: usize = 60_000;
        /// Newton's steps.
        const NEWTON: u32 = 40;
        /// Below this hyperstaticity what stops Newton is not a lack of rank but the length of the way, as in a column: the
        /// interior point is tried. Above it, it failed in 7 attempts of 8.
        const DETERMINED: f64 = 0.95;
        /// Steps of the interior point.
        const INTERIOR: u32 = 120;
        let options = self.options;
        let unknowns = problem.contacts() * S::D;
        // A contact of balls meets some eight others.
        let entries = (9 * S::D * unknowns) as f64;
        let per = sweeps_per_factorisation(entries, problem.contacts() as f64);
        let worth = if options.tolerance >= 1e-5 {
            LOOSE
        } else {
            TIGHT
        };
        let rolls = self
            .moments
            .iter()
            .any(|m| m.rolling > 0.0 || m.spinning > 0.0);
        let sweeps = worth * per * habit.patience;
        let sweeps = sweeps.clamp(200.0, f64::from(u32::MAX / 2)) as u32;
        let mut features = Features {
            rotation: rolls,
            cohesion: false,
            operator: problem.operator(),
        };
        let without = if refusal(Method::Newton, &features).is_some() {
            Some(SolvePath::Unserved)
        } else {
            (unknowns > LARGEST).then_some(SolvePath::Large)
        };
        if let Some(chosen) = without {
            let mut report = self.sweep(problem, true, options.max_iterations);
            if report.iterations > sweeps {
                report.chosen = chosen;
            }
            return report;
        }
        let mut report = self.sweep(problem, true, options.max_iterations.min(sweeps));
        let left = options.max_iterations - report.iterations;
        if report.converged || left == 0 {
            return report;
        }
        let hyperstaticity = hyperstaticity(problem, self.forms);
        if hyperstaticity > 1.0 {
            // Newton is to have its turn before the iterations end.
            let more = (left / 2).min(sweeps.saturating_mul(HYPERSTATIC - 1));
            report.add(&self.sweep(problem, true, more));
            report.chosen = SolvePath::Longer { hyperstaticity };
        }
        let after = report.iterations;
        features.cohesion = self.forms.iter().any(|f| f.cohesion > 0.0);
        let mut interior = hyperstaticity < DETERMINED
            && refusal(Method::Interior, &features).is_none()
            && habit.interior_is_due();
        let (mut newton, mut inside) = (Attempt::No, Attempt::No);
        let mut round = 0;
        while !report.converged && report.iterations < options.max_iterations {
            let first = round == 0 && interior && habit.interior_first;
            if first {
                inside = self.interior(problem, &mut report, INTERIOR, habit);
                interior = false;
            }
            let steps = NEWTON << round.min(16);
            // What the sweeps came to may be a dead end for Newton: every other time it starts where they did.
            let anew = round % 2 == 1;
            if !report.converged {
                newton = self.attempt(problem, &mut report, Method::Newton, steps, anew);
            }
            if !report.converged && interior {
                inside = self.interior(problem, &mut report, INTERIOR, habit);
                interior = false;
            }
            report.chosen = SolvePath::Factorised {
                after,
                hyperstaticity,
                newton,
                interior: inside,
            };
            let left = options.max_iterations.saturating_sub(report.iterations);
            if !report.converged && left > 0 {
                let more = sweeps.saturating_mul(HYPERSTATIC << round.min(16));
                report.add(&self.sweep(problem, true, left.min(more)));
            }
            round += 1;
        }
        if let SolvePath::Factorised { .. } = report.chosen {
            let ended = newton == Attempt::Ended || inside == Attempt::Ended;
            habit.patience *= if ended { 0.5 } else { 2.0 };
            habit.patience = habit.patience.clamp(1.0, 64.0);
        }
        report
    }

    /// The interior point; it starts from nowhere near, so impulses at hand do not matter to it.
    fn interior(
        &self,
        problem: &mut Problem<S>,
        report: &mut Report,
        steps: u32,
        habit: &mut AutoState,
    ) -> Attempt {
        let tried = self.attempt(problem, report, Method::Interior, steps, false);
        habit.learn(tried == Attempt::Ended);
        tried
    }

    /// A method that factorises, from the impulses at hand or from those of the forms; keeps those with the smaller error.
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
            let impulses: Vec<_> = self.forms.iter().map(|f| Some(f.impulse)).collect();
            let moments: Vec<_> = self.moments.iter().map(|m| Some(m.moment)).collect();
            problem.adopt(&impulses, &moments);
        }
        let tolerance = 0.3 * self.options.tolerance;
        report.add(&self.improve(problem, method, tolerance, steps.min(left)));
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

/// The local form of a problem of Coulomb contacts: W, q, mu; none where another law is at work, or where W cannot be had as a
/// matrix.
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
