//! The interior point method: impulses and velocities stay inside their bounds, and approach them
//! as the barrier parameter mu falls.
//!
//! ```text
//! P w = mu,           w = u_n + s_n + c_n (P - tension),  P, w > 0
//! a alpha = mu,       a = g (1 - |tau|^2)/2,  p_t = g tau,  g = mu_f P + cohesion
//! y + alpha tau = 0,  y = u_t + s_t + c_t p_t
//! ```
//!
//! and likewise along the normal of bonds that act in tension only. Each iteration linearises these
//! equations, eliminates all but the velocities, and goes at most so far that the variables stay
//! positive; mu falls with the mean of the products.

use super::Solve;
use super::balance::{Balance, Motion};
use super::law::Slope;
use super::newton;
use crate::geometry::space::{Space, VectorLike};
use crate::solve::form::{ContactForm, Elastic};
use crate::solve::problem::Problem;

/// Largest number of iterations.
const ITERATIONS: u32 = 60;
/// A step shorter than this share is short; after this many in turn the attempt ends.
const SHORT: (f64, u32) = (0.02, 5);
/// Barrier parameter over the mean product.
const TARGET: f64 = 0.2;
/// Share of the way to the nearest bound.
const TO_BOUND: f64 = 0.995;
/// Smallest slack of friction: of the order of rounding.
const LEAST_SLACK: f64 = 1e-15;
/// Smallest first barrier parameter over the mean energy of the load.
const FROM_LOAD: f64 = 1e-3;
/// Barrier parameter of a problem at rest (J).
const LEAST_BARRIER: f64 = 1e-200;
/// Ratio of the residual of the laws to that at the last attempt of Newton at which Newton is tried
/// again.
const NEARER: f64 = 0.3;

/// A complementary pair: both positive, of product mu.
#[derive(Clone, Copy, Default)]
struct ComplementaryPair {
    p: f64,
    w: f64,
}

impl ComplementaryPair {
    /// The pair with p - w/c = `x`.
    fn begin(x: f64, c: f64, mu: f64) -> Self {
        let root = (x * x + 4.0 * mu / c).sqrt();
        let p = if x > 0.0 {
            0.5 * (x + root)
        } else {
            2.0 * mu / c / (root - x)
        };
        Self { p, w: mu / p }
    }
}

/// Friction of a contact: p_t = g tau, and alpha, the rate of slip.
#[derive(Clone, Copy)]
struct Friction<S: Space> {
    tau: S::Tangent,
    alpha: f64,
}

impl<S: Space> Friction<S> {
    /// The slack 1 - |tau|^2 of the bound.
    fn slack(&self) -> f64 {
        let length = self.tau.norm();
        ((1.0 - length) * (1.0 + length)).max(LEAST_SLACK)
    }
}

/// The variables of a contact.
#[derive(Clone, Copy)]
struct Variables<S: Space> {
    normal: ComplementaryPair,
    bond: ComplementaryPair,
    friction: Friction<S>,
}

/// Changes of the variables as linear functions of those of the relative velocity.
#[derive(Clone, Copy)]
struct Changes<S: Space> {
    /// dP = p[0] - p[1] du_n.
    p: [f64; 2],
    /// dP = bond[0] + bond[1] du_n of a bond in tension.
    bond: [f64; 2],
    /// dp_t = t - K_t du_t + pressed tau dP.
    t: S::Tangent,
    pressed: f64,
    /// K_t of friction.
    friction: Slope<S>,
}

/// Whether the normal part of a bond acts in tension only.
fn pulls_only<S: Space>(form: &ContactForm<S>) -> Option<&Elastic<S>> {
    form.elastic
        .as_ref()
        .filter(|e| e.tension_only && e.b_n > 0.0)
}

/// A contact that can press.
fn closes<S: Space>(form: &ContactForm<S>) -> bool {
    form.shift_n < f64::INFINITY
}

fn bound<S: Space>(form: &ContactForm<S>, pressed: f64) -> f64 {
    form.friction * pressed + form.cohesion
}

/// Iterates from some velocities until the problem is solved.
pub(super) fn solve<S: Space>(solve: &mut Solve<S>, problem: &mut Problem<S>, begin: &[Motion<S>]) {
    let at = solve.balance.evaluate(begin.to_vec());
    let mut state = State::new(&solve.balance, begin, at.size);
    let (mut nearest, mut short) = (f64::INFINITY, 0);
    for _ in 0..ITERATIONS {
        solve.iterations += 1;
        let Some(step) = state.advance(&mut solve.balance) else {
            return;
        };
        short = if step < SHORT.0 { short + 1 } else { 0 };
        let at = solve.balance.evaluate(state.motions.clone());
        if at.size < NEARER * nearest {
            nearest = at.size;
            solve.measure(problem, &at);
            if !solve.ended() {
                newton::finish(solve, problem, at);
            }
        }
        if solve.ended() || short == SHORT.1 {
            return;
        }
    }
}

/// Velocities and variables of an iteration.
struct State<S: Space> {
    motions: Vec<Motion<S>>,
    contacts: Vec<Variables<S>>,
}

impl<S: Space> State<S> {
    /// Begins at velocities with this norm of the residual.
    fn new(balance: &Balance<S>, begin: &[Motion<S>], residual: f64) -> Self {
        let mu = first_barrier(balance, begin, residual);
        let contact = |form: &ContactForm<S>| {
            let u = balance.relative(form, begin);
            let (u_n, u_t) = (form.normal.dot(&u), S::tangential(&form.normal, &u));
            let [c_n, c_t] = form.compliance;
            let mut normal = ComplementaryPair::default();
            if closes(form) {
                let overlap = -(u_n + form.shift_n);
                normal = ComplementaryPair::begin(form.tension + overlap / c_n, c_n, mu);
            }
            let bond = pulls_only(form).map_or_else(ComplementaryPair::default, |e| {
                ComplementaryPair::begin(e.a_n + e.b_n * u_n, 1.0 / e.b_n, mu)
            });
            let g = bound(form, normal.p);
            let mut friction = Friction {
                tau: S::Tangent::zero(),
                alpha: 0.0,
            };
            if g > 0.0 {
                let z = (u_t + form.shift_t) * -1.0;
                friction.tau = (z * (1.0 / (c_t * g))).limited(0.9);
                friction.alpha = 2.0 * mu / (g * friction.slack());
            }
            Variables {
                normal,
                bond,
                friction,
            }
        };
        Self {
            motions: begin.to_vec(),
            contacts: balance.forms.iter().map(contact).collect(),
        }
    }

    /// Returns the mean product of the pairs.
    fn mean_product(&self, balance: &Balance<S>) -> f64 {
        let (mut sum, mut count) = (0.0, 0.0);
        let mut add = |product: f64| {
            sum += product;
            count += 1.0;
        };
        for (form, x) in balance.forms.iter().zip(&self.contacts) {
            if closes(form) {
                add(x.normal.p * x.normal.w);
            }
            if pulls_only(form).is_some() {
                add(x.bond.p * x.bond.w);
            }
            let g = bound(form, x.normal.p);
            if g > 0.0 {
                add(0.5 * g * x.friction.slack() * x.friction.alpha);
            }
        }
        if count > 0.0 { sum / count } else { 0.0 }
    }

    /// Does one iteration; returns the share of the whole step, `None` where it is not possible.
    fn advance(&mut self, balance: &mut Balance<S>) -> Option<f64> {
        let mu = TARGET * self.mean_product(balance);
        let linear: Vec<_> = balance
            .forms
            .iter()
            .zip(&self.contacts)
            .map(|(form, x)| linearise(form, x, &balance.relative(form, &self.motions), mu))
            .collect();
        let impulses: Vec<S::Vector> = linear.iter().map(|(p, ..)| *p).collect();
        let slopes: Vec<Slope<S>> = linear.iter().map(|(_, slope, _)| *slope).collect();
        let residual = balance.residual(&self.motions, &impulses);
        let change = balance.direction(&residual, &slopes)?;
        let moved = balance.as_motions(&change);
        let mut changes = Vec::with_capacity(linear.len());
        let mut step = 1.0f64;
        for ((form, x), (.., linear)) in balance.forms.iter().zip(&self.contacts).zip(&linear) {
            let du = balance.relative(form, &moved);
            let change = change_of(form, x, linear, &du, mu);
            step = step.min(x.largest_step(form, &change));
            changes.push(change);
        }
        if step.is_nan() || step <= 0.0 {
            return None;
        }
        self.motions = balance.moved(&self.motions, &change, step);
        for (x, change) in self.contacts.iter_mut().zip(&changes) {
            x.add(change, step);
        }
        Some(step)
    }
}

/// Returns the barrier parameter of the first iteration: the mean energy of the contacts that
/// overlap at the start, or a share of that of the load that is not balanced there, where contacts
/// carry less.
fn first_barrier<S: Space>(balance: &Balance<S>, begin: &[Motion<S>], residual: f64) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0);
    for form in balance.forms.iter().filter(|form| closes(form)) {
        let u_n = form.normal.dot(&balance.relative(form, begin));
        let c_n = form.compliance[0];
        let overlap = c_n * form.tension - (u_n + form.shift_n);
        if overlap > 0.0 {
            sum += overlap * overlap / c_n;
            count += 1.0;
        }
    }
    let pressed = if count > 0.0 { sum / count } else { 0.0 };
    let load = residual * residual / balance.forms.len().max(1) as f64;
    pressed.max(FROM_LOAD * load).max(LEAST_BARRIER)
}

/// Linearises a contact: impulse at unchanged velocity, its slope, and the changes of variables.
fn linearise<S: Space>(
    form: &ContactForm<S>,
    x: &Variables<S>,
    u: &S::Vector,
    mu: f64,
) -> (S::Vector, Slope<S>, Changes<S>) {
    let n = &form.normal;
    let (u_n, u_t) = (n.dot(u), S::tangential(n, u));
    let [c_n, c_t] = form.compliance;
    let mut slope = Slope::<S>::zero();
    let mut changes = Changes {
        p: [0.0; 2],
        bond: [0.0; 2],
        t: S::Tangent::zero(),
        pressed: 0.0,
        friction: Slope::zero(),
    };
    let (mut p_n, mut p_t) = (-form.tension, S::Tangent::zero());
    if closes(form) {
        let ComplementaryPair { p, w } = x.normal;
        let over = 1.0 / (w + c_n * p);
        changes.p = [(mu - p * w) * over, p * over];
        p_n += p + changes.p[0];
        slope.normal += changes.p[1];
    }
    let g = bound(form, x.normal.p);
    if g > 0.0 {
        let Friction { tau, alpha } = x.friction;
        let (length, a) = (tau.norm(), 0.5 * g * x.friction.slack());
        let slides = alpha * g / a * length * length;
        let (across, along) = (c_t * g + alpha, c_t * g + alpha + slides);
        slope.slip = if length > 0.0 {
            tau * (1.0 / length)
        } else {
            S::Tangent::zero()
        };
        (slope.across, slope.along) = (g / across, g / along);
        let y = u_t + form.shift_t + tau * (c_t * g);
        let right = y + tau * (mu / a);
        changes.t = -slope.apply_tangential(&right);
        changes.pressed = form.friction * (2.0 * alpha + slides) / along;
        slope.coupled = length * changes.pressed * changes.p[1];
        p_t = tau * (g + changes.pressed * changes.p[0]) + changes.t;
        changes.friction = slope;
    }
    if let Some(e) = &form.elastic {
        let mut stiffness = e.b_n;
        match pulls_only(form) {
            Some(e) => {
                let ComplementaryPair { p, w } = x.bond;
                let over = 1.0 / (w + p / e.b_n);
                changes.bond = [(mu - p * w) * over, p * over];
                p_n -= p + changes.bond[0];
                stiffness = changes.bond[1];
            }
            None if e.tension_only => p_n -= e.a_n.max(0.0),
            None => p_n -= e.a_n + e.b_n * u_n,
        }
        p_t -= e.a_t + u_t * e.b_t;
        slope.add_bond(stiffness, e.b_t);
    }
    (*n * p_n + S::tangent_vector(n, &p_t), slope, changes)
}

/// Changes of the variables of a contact by a change of its relative velocity.
fn change_of<S: Space>(
    form: &ContactForm<S>,
    x: &Variables<S>,
    linear: &Changes<S>,
    du: &S::Vector,
    mu: f64,
) -> Variables<S> {
    let (du_n, du_t) = (form.normal.dot(du), S::tangential(&form.normal, du));
    let mut out = Variables {
        normal: ComplementaryPair::default(),
        bond: ComplementaryPair::default(),
        friction: Friction {
            tau: S::Tangent::zero(),
            alpha: 0.0,
        },
    };
    if closes(form) {
        let dp = linear.p[0] - linear.p[1] * du_n;
        out.normal = ComplementaryPair {
            p: dp,
            w: du_n + form.compliance[0] * dp,
        };
    }
    if let Some(e) = pulls_only(form) {
        let dp = linear.bond[0] + linear.bond[1] * du_n;
        out.bond = ComplementaryPair {
            p: dp,
            w: dp / e.b_n - du_n,
        };
    }
    let g = bound(form, x.normal.p);
    if g > 0.0 {
        let Friction { tau, alpha } = x.friction;
        let a = 0.5 * g * x.friction.slack();
        let response = linear.friction.apply_tangential(&du_t);
        let dp_t = linear.t - response + tau * (linear.pressed * out.normal.p);
        let dg = form.friction * out.normal.p;
        out.friction.tau = (dp_t - tau * dg) * (1.0 / g);
        let da = dg * a / g - g * tau.dot(&out.friction.tau);
        out.friction.alpha = mu / a - alpha - alpha / a * da;
    }
    out
}

impl<S: Space> Variables<S> {
    /// Returns the largest factor on a change with which all variables stay inside their bounds.
    fn largest_step(&self, form: &ContactForm<S>, change: &Self) -> f64 {
        let mut step = 1.0f64;
        let mut limit = |value: f64, change: f64| {
            if change < 0.0 {
                step = step.min(-TO_BOUND * value / change);
            }
        };
        if closes(form) {
            limit(self.normal.p, change.normal.p);
            limit(self.normal.w, change.normal.w);
        }
        if pulls_only(form).is_some() {
            limit(self.bond.p, change.bond.p);
            limit(self.bond.w, change.bond.w);
        }
        if bound(form, self.normal.p) > 0.0 {
            limit(self.friction.alpha, change.friction.alpha);
            step = step.min(TO_BOUND * to_circle::<S>(&self.friction, &change.friction.tau));
        }
        step
    }

    fn add(&mut self, change: &Self, step: f64) {
        self.normal.p += step * change.normal.p;
        self.normal.w += step * change.normal.w;
        self.bond.p += step * change.bond.p;
        self.bond.w += step * change.bond.w;
        self.friction.tau += change.friction.tau * step;
        self.friction.alpha += step * change.friction.alpha;
    }
}

/// Returns the factor on a change with which tau reaches the unit circle.
fn to_circle<S: Space>(friction: &Friction<S>, change: &S::Tangent) -> f64 {
    // |tau + s d|^2 = 1: s = slack / (b + sqrt(b^2 + slack d^2)), b = tau.d
    let (squared, b) = (change.dot(change), friction.tau.dot(change));
    if squared == 0.0 {
        return f64::INFINITY;
    }
    let slack = friction.slack();
    let root = (b * b + slack * squared).sqrt();
    if b > 0.0 {
        slack / (b + root)
    } else {
        (root - b) / squared
    }
}
