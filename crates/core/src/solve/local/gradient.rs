//! Projected gradient methods for the quasi-optimisation problem of Renouf and Alart (Comput.
//! Methods Appl. Mech. Eng. 194, 2005): p = argmin over C(mu p_n) of p.W p / 2 + q.p, whose
//! friction bounds s = mu p_n are updated in every iteration (the diagonalised Tresca fixed point).
//!
//! The predicted point is projected onto C^k; gradient and last direction are projected onto the
//! tangent cone of C^k at the iterate. [`GradientKind::Plain`] uses the gradient,
//! [`GradientKind::Conjugate`] conjugate directions, and [`GradientKind::Preconditioned`] conjugate
//! directions in the metric of the diagonal of W.
//!
//! A contact that slips at the end of an iteration is moved to its new friction bound. If it stayed
//! at the old bound while its normal part grows, it would stick in the next iteration and slip in
//! the one after, together with its neighbours; conjugacy would be lost, and the method would be no
//! faster than the plain gradient.
//!
//! Projecting the end point of an exact line search can increase the energy p.W p / 2 + q.p at
//! fixed bounds, and the basic method then cycles. Such a step is undone and replaced by one of the
//! safe length 1 / lambda_max.

use super::form::{Form, dot, largest};
use super::law::{Law, slip};
use super::state::{Best, Budget, Iteration, Solver};

/// Variant of the method.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GradientKind {
    /// Projected gradient, PG.
    Plain,
    /// Conjugate projected gradient, CPG.
    Conjugate,
    /// Conjugate projected gradient preconditioned by the diagonal, PCPG.
    Preconditioned,
}

/// The method.
#[derive(Clone, Copy, Debug)]
pub struct Gradient {
    /// Variant.
    pub kind: GradientKind,
}

/// Fraction of the friction bound from which a contact counts as slipping.
const SLIDES: f64 = 1.0 - 1e-12;

/// Admissible set of a contact at given friction bounds.
#[derive(Clone, Copy, Debug)]
enum Set {
    /// n >= 0, |t| <= s.
    Pushes(f64),
    /// n <= 0, t free.
    Pulls,
    /// All impulses.
    All,
    /// |n| <= a, |t| <= b.
    Box(f64, f64),
}

impl Set {
    fn of<const D: usize>(law: &Law, own: &[f64; D], all: &[[f64; D]]) -> Self {
        match law {
            Law::Coulomb(mu) => Self::Pushes(mu * own[0].max(0.0)),
            Law::Cohesive { mu, cohesion } => Self::Pushes(mu * own[0].max(0.0) + cohesion),
            Law::Free => Self::All,
            Law::Pull => Self::Pulls,
            Law::Moment { of, twist, bend } => {
                let n = all[*of as usize][0].max(0.0);
                Self::Box(twist * n, bend * n)
            }
        }
    }

    fn project<const D: usize>(self, p: &mut [f64; D]) {
        let disc = |p: &mut [f64; D], s: f64| {
            let t = slip(p);
            if t > s {
                for x in &mut p[1..] {
                    *x *= s / t;
                }
            }
        };
        match self {
            Self::Pushes(s) => {
                p[0] = p[0].max(0.0);
                disc(p, s);
            }
            Self::Pulls => p[0] = p[0].min(0.0),
            Self::All => {}
            Self::Box(a, b) => {
                p[0] = p[0].clamp(-a, a);
                disc(p, b);
            }
        }
    }

    /// Projects a direction onto the tangent cone of the set at p.
    fn tangent<const D: usize>(self, p: &[f64; D], d: &mut [f64; D]) {
        let disc = |d: &mut [f64; D], s: f64| {
            let t = slip(p);
            if s == 0.0 {
                for x in &mut d[1..] {
                    *x = 0.0;
                }
            } else if t >= s * SLIDES {
                let out: f64 = (1..D).map(|k| d[k] * p[k]).sum::<f64>() / t;
                if out > 0.0 {
                    for k in 1..D {
                        d[k] -= out * p[k] / t;
                    }
                }
            }
        };
        match self {
            Self::Pushes(s) => {
                if p[0] <= 0.0 {
                    d[0] = d[0].max(0.0);
                }
                disc(d, s);
            }
            Self::Pulls => {
                if p[0] >= 0.0 {
                    d[0] = d[0].min(0.0);
                }
            }
            Self::All => {}
            Self::Box(a, b) => {
                if p[0] >= a {
                    d[0] = d[0].min(0.0);
                }
                if p[0] <= -a {
                    d[0] = d[0].max(0.0);
                }
                disc(d, b);
            }
        }
    }
}

/// Computes the friction bounds from the normal part of the prediction, then projects onto the
/// sets.
fn project<const D: usize>(form: &Form<D>, p: &mut [[f64; D]]) {
    for c in 0..p.len() {
        let mut own = p[c];
        Set::of(&form.laws[c], &own, p).project(&mut own);
        p[c] = own;
    }
}

/// Returns the factor by which the tangential impulse of a contact at its old bound grows with the
/// bound.
fn growth(at: f64, old: f64, new: f64) -> Option<f64> {
    (old > 0.0 && at >= old * SLIDES).then(|| new / old)
}

/// Projects a prediction onto the sets for which it was computed (`fixed`), then sets `p` to the
/// admissible point for its own bounds: contacts that slip in the first set slip in the second.
fn carry<const D: usize>(form: &Form<D>, sets: &[Set], fixed: &mut [[f64; D]], p: &mut [[f64; D]]) {
    fixed.copy_from_slice(p);
    for c in 0..p.len() {
        sets[c].project(&mut fixed[c]);
        let mut own = p[c];
        let now = Set::of(&form.laws[c], &own, p);
        let across = slip(&fixed[c]);
        let [axial, across] = match (sets[c], now) {
            (Set::Pushes(s), Set::Pushes(new)) => [None, growth(across, s, new)],
            (Set::Box(a, b), Set::Box(new_a, new_b)) => [
                growth(fixed[c][0].abs(), a, new_a),
                growth(across, b, new_b),
            ],
            _ => [None, None],
        };
        if let Some(factor) = axial {
            own[0] = factor * fixed[c][0];
        }
        if let Some(factor) = across {
            for k in 1..D {
                own[k] = factor * fixed[c][k];
            }
        }
        now.project(&mut own);
        p[c] = own;
    }
}

/// Estimates 1 / lambda_max of W in the metric by power iteration, with a safety margin.
fn safe_step<const D: usize>(form: &Form<D>, metric: &[[f64; D]]) -> f64 {
    const ROUNDS: usize = 20;
    let zero = vec![[0.0; D]; form.len()];
    // A start vector that is unlikely to be orthogonal to the dominant eigenvector.
    let mut x: Vec<[f64; D]> = (0..form.len())
        .map(|c| std::array::from_fn(|k| 1.0 + 0.5 * (1.3 * c as f64 + 0.7 * k as f64).sin()))
        .collect();
    let mut y = zero.clone();
    let mut lambda = 0.0f64;
    for _ in 0..ROUNDS {
        form.w.velocity(&x, &zero, &mut y);
        for (y, m) in y.iter_mut().zip(metric) {
            for k in 0..D {
                y[k] *= m[k];
            }
        }
        let length = dot(&y, &y).sqrt();
        lambda = lambda.max(length / dot(&x, &x).sqrt());
        if length == 0.0 {
            break;
        }
        for (x, y) in x.iter_mut().zip(&y) {
            *x = y.map(|y| y / length);
        }
    }
    if lambda > 0.0 { 0.9 / lambda } else { 1.0 }
}

/// State of the descent: direction and step of the current iteration, and data of the previous one.
struct Descent<'a, const D: usize> {
    form: &'a Form<'a, D>,
    kind: GradientKind,
    /// Metric of the gradient, as diagonal blocks.
    metric: Vec<[f64; D]>,
    /// Admissible sets at the current bounds.
    sets: Vec<Set>,
    zero: Vec<[f64; D]>,
    direction: Vec<[f64; D]>,
    /// W times the direction.
    w_direction: Vec<[f64; D]>,
    /// Projected gradient, in the metric.
    gradient: Vec<[f64; D]>,
    /// Projected last direction; then the impulses and velocities before the step.
    kept: Vec<[f64; D]>,
    kept_u: Vec<[f64; D]>,
    /// The new point at the old bounds.
    fixed: Vec<[f64; D]>,
    /// Length of a step that does not increase the energy, computed at first use.
    safe: Option<f64>,
    /// Whether there is no last direction.
    restarts: bool,
}

impl<'a, const D: usize> Descent<'a, D> {
    fn new(form: &'a Form<'a, D>, kind: GradientKind) -> Self {
        let n = form.len();
        let zero = vec![[0.0; D]; n];
        Self {
            form,
            kind,
            metric: metric(form, kind),
            sets: vec![Set::All; n],
            direction: zero.clone(),
            w_direction: zero.clone(),
            gradient: zero.clone(),
            kept: zero.clone(),
            kept_u: zero.clone(),
            fixed: zero.clone(),
            zero,
            safe: None,
            restarts: true,
        }
    }

    /// Projects the gradient and the last direction onto the tangent cones at the iterate.
    fn project_gradient(&mut self, state: &Iteration<D>) {
        for c in 0..self.sets.len() {
            let set = Set::of(&self.form.laws[c], &state.p[c], &state.p);
            self.gradient[c] = std::array::from_fn(|k| -self.metric[c][k] * state.u[c][k]);
            set.tangent(&state.p[c], &mut self.gradient[c]);
            self.kept[c] = self.direction[c];
            set.tangent(&state.p[c], &mut self.kept[c]);
            self.sets[c] = set;
        }
    }

    /// Chooses the direction; returns the slope along it.
    fn choose_direction(&mut self, state: &Iteration<D>) -> f64 {
        // `w_direction` and the curvature still belong to the last direction.
        let curvature = dot(&self.direction, &self.w_direction);
        let beta = if self.restarts || self.kind == GradientKind::Plain || curvature <= 0.0 {
            0.0
        } else {
            -dot(&self.gradient, &self.w_direction) / curvature
        };
        for c in 0..self.direction.len() {
            for k in 0..D {
                self.direction[c][k] = self.gradient[c][k] + beta * self.kept[c][k];
            }
        }
        let along = -dot(&self.direction, &state.u);
        if beta != 0.0 && along <= 0.0 {
            // No longer a descent direction: restart with the gradient.
            self.direction.copy_from_slice(&self.gradient);
            return -dot(&self.direction, &state.u);
        }
        along
    }

    /// Forgets the last direction.
    fn restart(&mut self) {
        self.direction.copy_from_slice(&self.zero);
        self.restarts = true;
    }

    /// Moves to the minimum along the direction, projected; returns the increase of the energy by
    /// the projection.
    fn step(&mut self, state: &mut Iteration<D>, alpha: f64, energy: f64) -> f64 {
        for (p, d) in state.p.iter_mut().zip(&self.direction) {
            for k in 0..D {
                p[k] += alpha * d[k];
            }
        }
        carry(self.form, &self.sets, &mut self.fixed, &mut state.p);
        self.form.velocity(&state.p, &mut state.u);
        // The change due to new bounds is not attributed to the step.
        let moved = dot(&state.u, &state.p) - dot(&state.u, &self.fixed);
        self.energy(state) - energy - moved
    }

    /// Replaces the step by a step of safe length along the gradient.
    fn step_safely(&mut self, state: &mut Iteration<D>) {
        let (form, metric) = (self.form, &self.metric);
        let step = *self.safe.get_or_insert_with(|| safe_step(form, metric));
        for c in 0..state.p.len() {
            for k in 0..D {
                state.p[c][k] = self.kept[c][k] - step * metric[c][k] * self.kept_u[c][k];
            }
        }
        project(form, &mut state.p);
        form.velocity(&state.p, &mut state.u);
    }

    /// Returns p.W p / 2 + q.p.
    fn energy(&self, state: &Iteration<D>) -> f64 {
        0.5 * (dot(&state.p, &state.u) + dot(&state.p, self.form.q))
    }
}

/// Returns the metric of the gradient, isotropic in the tangents, so that discs stay discs.
fn metric<const D: usize>(form: &Form<D>, kind: GradientKind) -> Vec<[f64; D]> {
    let of = |c: usize| {
        let w = form.w.diagonal(c);
        if largest(w) == 0.0 {
            // Contacts between immovable bodies keep their impulse.
            return [0.0; D];
        }
        if kind != GradientKind::Preconditioned {
            return [1.0; D];
        }
        let tangential = (1..D).map(|k| w[k][k]).sum::<f64>() / (D - 1) as f64;
        std::array::from_fn(|k| {
            let x = if k == 0 { w[0][0] } else { tangential };
            if x > 0.0 { 1.0 / x } else { 1.0 }
        })
    };
    (0..form.len()).map(of).collect()
}

impl<const D: usize> Solver<D> for Gradient {
    fn solve(&self, form: &Form<D>, state: &mut Iteration<D>, budget: &mut Budget) {
        let mut descent = Descent::new(form, self.kind);
        let mut best = Best::of(state);
        while !budget.ends(state) {
            descent.project_gradient(state);
            let along = descent.choose_direction(state);
            form.w
                .velocity(&descent.direction, &descent.zero, &mut descent.w_direction);
            let curvature = dot(&descent.direction, &descent.w_direction);
            let curved = curvature > 0.0 && curvature.is_finite();
            if !curved && !descent.restarts {
                descent.restart();
                continue;
            }
            let energy = descent.energy(state);
            descent.kept.copy_from_slice(&state.p);
            descent.kept_u.copy_from_slice(&state.u);
            let raised = if curved {
                descent.step(state, along / curvature, energy)
            } else {
                f64::INFINITY
            };
            state.iterations += 1;
            descent.restarts = false;
            if raised > 1e-12 * energy.abs() || raised.is_nan() {
                descent.step_safely(state);
                descent.restart();
            }
            state.update_error(form);
            best.keep(state);
        }
        best.restore(form, state);
    }
}
