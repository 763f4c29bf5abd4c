//! Solving a local problem: the methods, their limits and the figure of the error.

use super::LocalProblem;
use super::block::{BlockMatrix, times};
use std::str::FromStr;
use std::time::Instant;

/// A way to solve a local problem.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// The program chooses.
    Auto,
    /// Gauss-Seidel over contacts, each by projection.
    Nlgs,
}

impl Method {
    /// All of them.
    pub const ALL: &[Method] = &[Method::Auto, Method::Nlgs];

    /// Its name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Auto => "auto",
            Self::Nlgs => "nlgs",
        }
    }

    /// A line about it.
    pub fn about(self) -> &'static str {
        match self {
            Self::Auto => "the program chooses",
            Self::Nlgs => "Gauss-Seidel over contacts, each by projection",
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

/// When to stop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// The [`field_error`] to reach.
    pub tolerance: f64,
    /// Iterations at most.
    pub max_iterations: u32,
    /// Seconds at most.
    pub seconds: f64,
}

/// What a solve gave.
#[derive(Clone, Debug, PartialEq)]
pub struct Outcome {
    /// The method, with what `auto` chose.
    pub method: String,
    /// Contact impulses of the best iterate.
    pub p: Vec<f64>,
    /// Its velocities W p + q.
    pub u: Vec<f64>,
    /// Its [`field_error`].
    pub error: f64,
    /// The contact with the largest share of the error.
    pub worst: Option<usize>,
    /// Iterations done.
    pub iterations: u32,
    /// Seconds taken.
    pub seconds: f64,
    /// Whether the error is within the tolerance.
    pub converged: bool,
}

/// Solves a problem from p = 0.
pub fn solve(problem: &LocalProblem, method: Method, limits: &Limits) -> Outcome {
    match problem.dimension {
        2 => sweep::<2>(problem, method, limits),
        _ => sweep::<3>(problem, method, limits),
    }
}

/// The field's figure: |p - proj_K(p - (u + mu |u_t| n))| / max(|q|, |p|, |u|), Euclidean norms of whole
/// vectors, u = W p + q; not divided when the maximum is 0.
pub fn field_error(problem: &LocalProblem, p: &[f64]) -> f64 {
    match problem.dimension {
        2 => measured::<2>(problem, p).0,
        _ => measured::<3>(problem, p).0,
    }
}

fn measured<const D: usize>(problem: &LocalProblem, p: &[f64]) -> (f64, Option<usize>) {
    let u = problem.velocities(p);
    let norm = |x: &[f64]| x.iter().map(|x| x * x).sum::<f64>().sqrt();
    let scale = norm(&problem.q).max(norm(p)).max(norm(&u));
    let (mut sum, mut worst) = (0.0, None::<(usize, f64)>);
    for (c, mu) in problem.mu.iter().enumerate() {
        let at = |x: &[f64]| -> [f64; D] { std::array::from_fn(|k| x[c * D + k]) };
        let (p, u) = (at(p), at(&u));
        let z = step(&p, &u, *mu, 1.0);
        let gap: f64 = (0..D).map(|k| (p[k] - z[k]).powi(2)).sum();
        sum += gap;
        if worst.is_none_or(|w| gap > w.1) {
            worst = Some((c, gap));
        }
    }
    let error = f64::sqrt(sum) / if scale > 0.0 { scale } else { 1.0 };
    (error, worst.map(|w| w.0))
}

/// proj_K(p - rho (u + mu |u_t| n)).
fn step<const D: usize>(p: &[f64; D], u: &[f64; D], mu: f64, rho: f64) -> [f64; D] {
    let length = |x: &[f64; D]| x[1..].iter().map(|x| x * x).sum::<f64>().sqrt();
    let mut z: [f64; D] = std::array::from_fn(|k| p[k] - rho * u[k]);
    z[0] -= rho * mu * length(u);
    let t = length(&z);
    if t > mu * z[0] {
        let n = ((z[0] + mu * t) / (1.0 + mu * mu)).max(0.0);
        for x in &mut z[1..] {
            *x *= if t > 0.0 { mu * n / t } else { 0.0 };
        }
        z[0] = n;
    }
    z
}

fn sweep<const D: usize>(problem: &LocalProblem, method: Method, limits: &Limits) -> Outcome {
    let start = Instant::now();
    let w = BlockMatrix::<D>::from_csr(&problem.w);
    let count = w.len();
    let rho: Vec<f64> = w
        .diagonal
        .iter()
        .map(|a| {
            let trace: f64 = (0..D).map(|k| a[k][k]).sum();
            if trace > 0.0 { 1.0 / trace } else { 1.0 }
        })
        .collect();
    let mut p = vec![[0.0; D]; count];
    let mut best = vec![0.0; count * D];
    let (mut error, mut worst) = measured::<D>(problem, &best);
    let mut iterations = 0;
    while error > limits.tolerance
        && iterations < limits.max_iterations
        && start.elapsed().as_secs_f64() < limits.seconds
    {
        for c in 0..count {
            let q = std::array::from_fn(|k| problem.q[c * D + k]);
            let free = w.gather(c, &p, q);
            for _ in 0..20 {
                let own = times(&w.diagonal[c], &p[c]);
                let u = std::array::from_fn(|k| free[k] + own[k]);
                p[c] = step(&p[c], &u, problem.mu[c], rho[c]);
            }
        }
        iterations += 1;
        let flat = p.as_flattened();
        let now = measured::<D>(problem, flat);
        if now.0 < error {
            (error, worst) = now;
            best.copy_from_slice(flat);
        }
    }
    Outcome {
        method: match method {
            Method::Auto => "auto: nlgs".to_owned(),
            other => other.name().to_owned(),
        },
        u: problem.velocities(&best),
        p: best,
        error,
        worst,
        iterations,
        seconds: start.elapsed().as_secs_f64(),
        converged: error <= limits.tolerance,
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
}
