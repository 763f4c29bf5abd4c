//! Solution of a local problem: methods, limits and error measure.

use super::LocalProblem;
use super::accelerated::Accelerated;
use super::anderson::Anderson;
use super::auto::Auto;
use super::block::BlockMatrix;
use super::form::{Form, coulomb, magnitude};
use super::gradient::{Gradient, GradientKind};
use super::interior::Interior;
use super::law::{self, Law};
use super::newton::Newton;
use super::nlgs::{Nlgs, Order};
use super::scale_free;
pub use super::state::Limits;
use super::state::{Budget, Iteration, Solver};
use crate::solve::error::{Norm, lost, unbounded};
use serde::{Deserialize, Serialize};
use std::str::FromStr;
use std::time::Instant;

/// A way to solve a problem.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Deserialize, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum Method {
    /// Automatic choice.
    #[default]
    Auto,
    /// Gauss-Seidel over contacts.
    Nlgs,
    /// Gauss-Seidel over contacts, forwards and backwards.
    NlgsSymmetric,
    /// Gauss-Seidel with Anderson's acceleration.
    Anderson,
    /// Projected gradient.
    Pg,
    /// Conjugate projected gradient.
    Cpg,
    /// Preconditioned conjugate projected gradient.
    Pcpg,
    /// Accelerated projected gradient.
    Apgd,
    /// Semi-smooth Newton in proximal steps.
    Newton,
    /// Interior point.
    Interior,
}

impl Method {
    /// All methods.
    pub const ALL: &[Method] = &[
        Method::Auto,
        Method::Nlgs,
        Method::NlgsSymmetric,
        Method::Anderson,
        Method::Pg,
        Method::Cpg,
        Method::Pcpg,
        Method::Apgd,
        Method::Newton,
        Method::Interior,
    ];

    /// Solves from p = 0 the problem of matrix `w`, free velocities `q` and one law per contact,
    /// with errors in `norm`.
    pub fn solve_blocks<const D: usize>(
        self,
        w: &BlockMatrix<D>,
        q: &[[f64; D]],
        laws: &[Law],
        norm: Norm,
        budget: &mut Budget,
    ) -> Iteration<D> {
        let form = Form::new(w, q, laws, norm);
        let mut state = Iteration::new(&form, vec![[0.0; D]; q.len()]);
        self.solver().solve(&form, &mut state, budget);
        state
    }

    /// Returns its name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Auto => "auto",
            Self::Nlgs => "nlgs",
            Self::NlgsSymmetric => "nlgs-symmetric",
            Self::Anderson => "anderson",
            Self::Pg => "pg",
            Self::Cpg => "cpg",
            Self::Pcpg => "pcpg",
            Self::Apgd => "apgd",
            Self::Newton => "newton",
            Self::Interior => "interior",
        }
    }

    /// Returns a one-line description.
    pub fn about(self) -> &'static str {
        match self {
            Self::Auto => "automatic choice: Gauss-Seidel first, then methods that factorise",
            Self::Nlgs => "Gauss-Seidel over contacts, each solved exactly",
            Self::NlgsSymmetric => "the same, forwards and backwards",
            Self::Anderson => "Gauss-Seidel with Anderson's acceleration",
            Self::Pg => "projected gradient",
            Self::Cpg => "conjugate projected gradient (Renouf and Alart)",
            Self::Pcpg => "the same, preconditioned by the diagonal",
            Self::Apgd => "accelerated projected gradient with restarts",
            Self::Newton => "semi-smooth Newton in proximal steps",
            Self::Interior => "interior point with the De Saxce correction",
        }
    }

    /// Checks that the method supports blocks of these laws.
    ///
    /// # Errors
    /// Returns a sentence that names the unsupported law.
    pub fn serves(self, laws: &[Law]) -> Result<(), String> {
        match self {
            Self::Newton => Newton::serves(laws),
            Self::Interior => Interior::serves(laws),
            _ => Ok(()),
        }
    }

    /// Creates the solver.
    pub fn solver<const D: usize>(self) -> Box<dyn Solver<D>> {
        let gradient = |kind| Box::new(Gradient { kind });
        match self {
            Self::Auto => Box::new(Auto::default()),
            Self::Nlgs => Box::new(Nlgs::default()),
            Self::NlgsSymmetric => Box::new(Nlgs {
                order: Order::Symmetric,
                ..Nlgs::default()
            }),
            Self::Anderson => Box::new(Anderson::default()),
            Self::Pg => gradient(GradientKind::Plain),
            Self::Cpg => gradient(GradientKind::Conjugate),
            Self::Pcpg => gradient(GradientKind::Preconditioned),
            Self::Apgd => Box::new(Accelerated),
            Self::Newton => Box::new(Newton::default()),
            Self::Interior => Box::new(Interior),
        }
    }
}

impl FromStr for Method {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let found = Self::ALL.iter().copied().find(|m| m.name() == text);
        found.ok_or_else(|| {
            let names: Vec<&str> = Self::ALL.iter().map(|m| m.name()).collect();
            format!(
                "there is no solver `{text}`; there are {}",
                names.join(", ")
            )
        })
    }
}

/// Result of a solve.
#[derive(Clone, Debug, PartialEq)]
pub struct Outcome {
    /// The method, with the choices of `auto`.
    pub method: String,
    /// Contact impulses of the best iterate.
    pub p: Vec<f64>,
    /// Velocities W p + q of that iterate.
    pub u: Vec<f64>,
    /// Error of the iterate, see [`field_error`].
    pub error: f64,
    /// The larger of two additional errors, not contained in `error`, that must be within the
    /// tolerance too: violation of Signorini's law hidden by friction, and unbounded impulses. See
    /// [`crate::solve::error`].
    pub beside: f64,
    /// The error in velocities, independent of units; see [`scale_free`].
    pub scale_free_error: f64,
    /// The contact with the largest share of the error.
    pub worst: Option<usize>,
    /// Iterations done.
    pub iterations: u32,
    /// Seconds taken.
    pub seconds: f64,
    /// Whether the errors are within the requested tolerances.
    pub converged: bool,
}

/// Solves a problem from p = 0. Solves of a few milliseconds are repeated and the best time is
/// reported, since the first one runs with cold caches. For a problem that [`LocalProblem::check`]
/// rejects, the result is p = 0 with an infinite error.
pub fn solve(problem: &LocalProblem, method: Method, limits: &Limits) -> Outcome {
    if problem.check().is_err() {
        let p = vec![0.0; problem.q.len()];
        return Outcome {
            method: method.name().to_owned(),
            u: problem.q.clone(),
            p,
            error: f64::INFINITY,
            beside: f64::INFINITY,
            scale_free_error: f64::INFINITY,
            worst: None,
            iterations: 0,
            seconds: 0.0,
            converged: false,
        };
    }
    match problem.dimension {
        2 => solve_in::<2>(problem, method, limits),
        _ => solve_in::<3>(problem, method, limits),
    }
}

fn solve_in<const D: usize>(problem: &LocalProblem, method: Method, limits: &Limits) -> Outcome {
    const REPEATS: u32 = 20;
    const ENOUGH: f64 = 0.02;
    let w = BlockMatrix::<D>::from_csr(&problem.w);
    let mut q: Vec<[f64; D]> = problem.q.as_chunks().0.to_vec();
    // Impulses scale with the free velocities: scaling these to one keeps squares in range.
    let unit = match magnitude(problem.q.iter()) {
        unit if (1e-50..1e50).contains(&unit) => 1.0,
        unit => unit,
    };
    for x in q.as_flattened_mut() {
        *x /= unit;
    }
    let laws = coulomb(&problem.mu);
    let mut solver = Choice::<D>::new(method);
    let (mut best, mut total) = (f64::INFINITY, 0.0);
    let velocity = Form::new(&w, &q, &laws, Norm::Velocity);
    let mut repeats = 0;
    let state = loop {
        let clock = Instant::now();
        let form = Form::new(&w, &q, &laws, Norm::Field);
        solver.used.clear();
        let mut now = Iteration::new(&form, vec![[0.0; D]; laws.len()]);
        // Slightly below the tolerance, so that the error recomputed in another order of summation
        // is still within it.
        let tolerance = limits.tolerance * (1.0 - 1e-9);
        let mut budget = Budget::new(tolerance, limits.max_iterations, limits.seconds);
        let step = |f: &Form<D>, s: &mut Iteration<D>, b: &mut Budget| solver.solve(f, s, b);
        scale_free::meet(&form, &velocity, &mut now, limits, &mut budget, step);
        let seconds = clock.elapsed().as_secs_f64();
        best = best.min(seconds);
        total += seconds;
        repeats += 1;
        if total > ENOUGH || repeats == REPEATS {
            break now;
        }
    };
    let p: Vec<f64> = state.p.as_flattened().iter().map(|p| p * unit).collect();
    let Measured {
        error,
        beside,
        worst,
    } = measured::<D>(problem, &p);
    let scale_free_error = scale_free::scale_free_error(problem, &p);
    let doubted = limits.scale_free.is_some_and(|t| scale_free_error > t);
    Outcome {
        method: solver.name(method),
        u: problem.velocities(&p),
        p,
        error,
        worst,
        iterations: state.iterations,
        seconds: best,
        beside,
        scale_free_error,
        converged: error <= limits.tolerance && beside <= limits.tolerance && !doubted,
    }
}

/// A method, or `auto`, which can list the methods it used.
struct Choice<const D: usize> {
    kind: Kinds<D>,
    /// Methods used by `auto`, in the order of first use.
    used: Vec<&'static str>,
}

enum Kinds<const D: usize> {
    Auto(Auto),
    Fixed(Box<dyn Solver<D>>),
}

impl<const D: usize> Choice<D> {
    fn new(method: Method) -> Self {
        Self {
            kind: match method {
                Method::Auto => Kinds::Auto(Auto::default()),
                other => Kinds::Fixed(other.solver()),
            },
            used: Vec::new(),
        }
    }

    fn solve(&mut self, form: &Form<D>, state: &mut Iteration<D>, budget: &mut Budget) {
        match &self.kind {
            Kinds::Auto(auto) => {
                auto.solve(form, state, budget);
                for name in auto.names() {
                    if !self.used.contains(&name) {
                        self.used.push(name);
                    }
                }
            }
            Kinds::Fixed(solver) => solver.solve(form, state, budget),
        }
    }

    fn name(&self, method: Method) -> String {
        match self.kind {
            Kinds::Auto(_) => format!("auto: {}", self.used.join(", ")),
            Kinds::Fixed(_) => method.name().to_owned(),
        }
    }
}

/// Returns the error measure of the literature: |p - proj_K(p - (u + mu |u_t| n))| / max(|q|, |p|,
/// |u|), Euclidean norms of whole vectors, u = W p + q; not divided when the maximum is 0. Infinite
/// where a number is not finite.
pub fn field_error(problem: &LocalProblem, p: &[f64]) -> f64 {
    match problem.dimension {
        2 => measured::<2>(problem, p).error,
        _ => measured::<3>(problem, p).error,
    }
}

/// Errors of a solution.
struct Measured {
    /// The error measure of the literature.
    error: f64,
    /// The larger of the two additional errors; see [`crate::solve::error`].
    beside: f64,
    /// The block with the largest residual.
    worst: Option<usize>,
}

fn measured<const D: usize>(problem: &LocalProblem, p: &[f64]) -> Measured {
    let u = problem.velocities(p);
    let all = || problem.q.iter().chain(p).chain(&u);
    if !all().chain(&problem.mu).all(|x| x.is_finite()) {
        return Measured {
            error: f64::INFINITY,
            beside: f64::INFINITY,
            worst: None,
        };
    }
    // Scaling all vectors by one number does not change the error: a power of two, so that no bit
    // changes and no square overflows.
    let unit = magnitude(all());
    let norm = |x: &[f64]| x.iter().map(|x| (x / unit).powi(2)).sum::<f64>().sqrt();
    let velocity = norm(&problem.q).max(norm(&u));
    let over = |x: f64, scale: f64| x / if scale > 0.0 { scale } else { 1.0 };
    let (mut sum, mut unseen, mut worst) = (0.0, 0.0, None::<(usize, f64)>);
    for (c, mu) in problem.mu.iter().enumerate() {
        let at = |x: &[f64]| -> [f64; D] { std::array::from_fn(|k| x[c * D + k] / unit) };
        let (p, u) = (at(p), at(&u));
        let r = law::natural(&p, &u, *mu, 1.0);
        let gap: f64 = r.iter().map(|x| x * x).sum();
        sum += gap;
        unseen += lost(p[0], u[0], *mu).powi(2);
        if worst.is_none_or(|w| gap > w.1) {
            worst = Some((c, gap));
        }
    }
    let scale = velocity.max(norm(p));
    // If q is lost in the rounding of W p, the impulses are no solution.
    let rounding = f64::EPSILON * norm(&problem.sizes(p));
    let growth = over(f64::sqrt(sum).max(rounding), velocity);
    Measured {
        error: over(f64::sqrt(sum), scale),
        beside: over(f64::sqrt(unseen), scale).max(unbounded(growth)),
        worst: worst.map(|w| w.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solve::local::Csr;

    #[test]
    fn one_contact_sticks_and_slides() {
        for (tangent, p) in [(0.1, [1.0, -0.1]), (2.0, [1.0, -0.5])] {
            let problem = LocalProblem {
                dimension: 2,
                w: Csr::from_triplets(2, 2, &[(0, 0, 1.0), (1, 1, 1.0)]),
                q: vec![-1.0, tangent],
                mu: vec![0.5],
            };
            let limits = Limits {
                tolerance: 1e-12,
                scale_free: None,
                max_iterations: 1000,
                seconds: 10.0,
            };
            let outcome = solve(&problem, Method::Auto, &limits);
            assert!(outcome.converged);
            assert_eq!(outcome.error, field_error(&problem, &outcome.p));
            for (x, y) in outcome.p.iter().zip(p) {
                assert!((x - y).abs() < 1e-10, "{:?}", outcome.p);
            }
        }
    }

    #[test]
    fn methods_have_names_of_their_own() {
        for method in Method::ALL.iter().copied() {
            assert_eq!(method.name().parse(), Ok(method));
        }
        let error = "gauss".parse::<Method>().unwrap_err();
        assert!(error.starts_with("there is no solver `gauss`; there are "));
    }

    /// Two coupled contacts with a tolerance of 0.1 in the first measure and of 1e-10 in the
    /// second: the solve continues until both are met, and reports it.
    #[test]
    fn both_tolerances_are_met() {
        let (a, b) = (1.0, 0.3);
        let rows = [
            (0, 0, a),
            (0, 2, b),
            (1, 1, a),
            (1, 3, b),
            (2, 0, b),
            (2, 2, a),
            (3, 1, b),
            (3, 3, a),
        ];
        let problem = LocalProblem {
            dimension: 2,
            w: Csr::from_triplets(4, 4, &rows),
            q: vec![-1.0, 0.4, -0.5, -0.3],
            mu: vec![0.5, 0.2],
        };
        let limits = |scale_free| Limits {
            tolerance: 0.1,
            scale_free,
            max_iterations: 10_000,
            seconds: 10.0,
        };
        let loose = solve(&problem, Method::Nlgs, &limits(None));
        assert!(loose.converged && loose.scale_free_error > 1e-6);
        let tight = solve(&problem, Method::Nlgs, &limits(Some(1e-10)));
        assert!(tight.converged && tight.scale_free_error <= 1e-10);
        assert!(tight.iterations > loose.iterations);
    }
}
