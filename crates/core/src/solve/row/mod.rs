//! The packed rows over which the solver iterates, and the exact solution of one contact.
//!
//! A contact of two balls has W_nt = 0, W_nn = 1/m_i + 1/m_j and an isotropic W_tt, so that its problem is
//! solved in closed form: first the normal part, then the tangential part within the cone.

mod block;
mod cone;
mod full;
#[cfg(target_arch = "x86_64")]
mod lanes;
mod lever;
mod moment;
mod plain;
mod solver_bodies;
mod system;
mod visit;

pub(super) use block::{Bonded, Loose, OnBlock};
pub(super) use cone::HELD;
pub(super) use full::FullRow;
pub(super) use lever::LeverRow;
pub use moment::{MomentForm, MomentSolution};
pub(super) use moment::{MomentRow, turning};
pub(super) use plain::PlainRow;
pub(super) use solver_bodies::SolverBodies;
pub(super) use system::{SystemRow, Term};
pub(super) use visit::{Free, Load, Measure, Update, Visit, noise, visit};

use super::form::{ContactForm, ContactSolution};
use super::{cone as cones, error};
use crate::geometry::space::{Space, VectorLike, greatest};

/// Velocity record of a body in the solver: 64 bytes in both dimensions.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub struct SolverBody<S: Space> {
    /// Velocity of the centre (m/s).
    pub v: S::Vector,
    /// Angular velocity times the body's length (m/s).
    pub s: S::Spin,
    /// Inverse mass, the largest of all axes (1/kg).
    pub im: f64,
    /// Inverse inertia times the length squared, the largest about any axis (1/kg).
    pub is: f64,
}

impl<S: Space> SolverBody<S> {
    /// Returns the record of an immovable body.
    #[cfg(target_arch = "x86_64")]
    fn idle() -> Self {
        Self {
            v: S::Vector::zero(),
            s: S::Spin::zero(),
            im: 0.0,
            is: 0.0,
        }
    }
}

/// Contribution of one contact to the convergence test.
#[derive(Clone, Copy, Debug, Default)]
pub struct Residual {
    /// |p - proj(p - rho (u + mu |u_t| n))|^2 / rho^2 (m^2/s^2).
    pub squared: f64,
    /// |u|^2 (m^2/s^2).
    pub velocity: f64,
    /// |p / rho|^2 (m^2/s^2).
    pub impulse: f64,
    /// p . r, r the residual velocity (J).
    pub power: f64,
    /// |p . r|, or rho |r|^2 where that is larger: a contact without the impulse that it should have (J).
    pub unbalanced: f64,
    /// |p_t . (u_t + s_t)|, the work of slip (J).
    pub slip: f64,
}

/// Normal and tangential impulse of a contact (N s).
pub(super) type LocalImpulse<S> = (f64, <S as Space>::Tangent);

/// A contact in the solver.
pub(super) trait Row<S: Space>: Clone + Send + Sync + 'static {
    fn bodies(&self) -> [u32; 2];
    /// Solves the contact for the current velocities, applies `relaxation` times the impulse increment, and
    /// updates the velocities.
    fn update(&mut self, a: &mut SolverBody<S>, b: &mut SolverBody<S>, relaxation: f64);
    /// Applies the stored impulse to the velocities.
    fn load(&self, a: &mut SolverBody<S>, b: &mut SolverBody<S>);
    /// Returns the normal and the tangential impulse.
    fn local_impulse(&self) -> LocalImpulse<S>;
    /// Sets them; the caller updates the velocities.
    fn set_local_impulse(&mut self, parts: LocalImpulse<S>);
    /// Sets an impulse given in world axes; the caller updates the velocities.
    fn set(&mut self, impulse: &S::Vector);
    /// Returns |u|^2 at the current velocities.
    fn speed(&self, a: &SolverBody<S>, b: &SolverBody<S>) -> f64;
    /// Returns rho of the natural map; 0 for a contact that moves nothing, whose impulse follows from given velocities.
    fn rho(&self) -> f64;
    /// Returns the friction coefficient.
    fn friction(&self) -> f64;
    fn residual(&self, a: &SolverBody<S>, b: &SolverBody<S>) -> Residual;
    /// Returns the work on the compliance of the unilateral part, c |p|^2 (J).
    fn yields(&self, _: &SolverBody<S>, _: &SolverBody<S>) -> f64 {
        0.0
    }
    /// Returns the solution at the current velocities: the bond's part follows from them, the unilateral
    /// part is the rest.
    fn solution(&self, a: &SolverBody<S>, b: &SolverBody<S>) -> ContactSolution<S>;
}

/// Appends the components of an impulse.
pub(super) fn store<S: Space>((n, t): LocalImpulse<S>, out: &mut Vec<f64>) {
    out.push(n);
    for k in 0..S::Tangent::N {
        out.push(t[k]);
    }
}

/// Takes them from the front of `from`.
pub(super) fn restore<S: Space>(from: &mut &[f64]) -> LocalImpulse<S> {
    let size = 1 + S::Tangent::N;
    let (parts, rest) = from.split_at(size);
    *from = rest;
    (parts[0], S::Tangent::from_slice(&parts[1..]))
}

#[inline(always)]
fn relative<S: Space>(n: &S::Vector, a: &SolverBody<S>, b: &SolverBody<S>) -> (f64, S::Tangent) {
    let d = a.v - b.v;
    (n.dot(&d), S::tangential(n, &d) - S::roll(&(a.s + b.s), n))
}

#[inline(always)]
fn push<S: Space>(
    n: &S::Vector,
    dn: f64,
    dt: S::Tangent,
    a: &mut SolverBody<S>,
    b: &mut SolverBody<S>,
) {
    let impulse = *n * dn + S::tangent_vector(n, &dt);
    let twist = S::twist(n, &dt);
    a.v += impulse * a.im;
    b.v -= impulse * b.im;
    a.s -= twist * a.is;
    b.s -= twist * b.is;
}

/// Computes the natural map of the De Saxce form in velocities, for a shifted impulse (P_n, p_t), a velocity
/// and its shift.
#[inline]
fn natural_map<T: VectorLike>(
    (pn, pt): (f64, T),
    (un, ut): (f64, T),
    (sn, st): (f64, T),
    rho: f64,
    mu: f64,
    c: f64,
) -> Residual {
    let slide = ut + st;
    let (zn, zt) = cones::project(
        pn - rho * (un + sn + mu * slide.norm()),
        pt - slide * rho,
        mu,
        c,
    );
    let over = 1.0 / rho;
    let (rn, rt) = ((pn - zn) * over, (pt - zt) * over);
    Residual {
        squared: error::residual(rn * rn + rt.dot(&rt), pn * over, un + sn, mu),
        velocity: un * un + ut.dot(&ut),
        impulse: (pn * pn + pt.dot(&pt)) * (over * over),
        power: pn * rn + pt.dot(&rt),
        unbalanced: greatest((pn * rn + pt.dot(&rt)).abs(), rho * (rn * rn + rt.dot(&rt))),
        slip: pt.dot(&slide).abs(),
    }
}

/// Returns 1/w; zero where nothing moves.
fn inverse(w: f64) -> f64 {
    if w > 0.0 { 1.0 / w } else { 0.0 }
}

/// Returns 1/w_t. Where bodies can move only along the normal the slip is given, and friction takes its
/// bound at once.
fn inverse_along(w_t: f64, w_n: f64) -> f64 {
    const MIN_RATIO: f64 = 1e-12;
    inverse(w_t.max(MIN_RATIO * w_n))
}

/// As [`inverse_along`]; where nothing moves at all, a shear cohesion (N s) takes its bound from a slip of 1e-12 m/s on.
fn answer_to_slip(w_t: f64, w_n: f64, cohesion: f64) -> f64 {
    const LEAST_SLIP: f64 = 1e-12;
    if w_t > 0.0 || w_n > 0.0 {
        inverse_along(w_t, w_n)
    } else {
        cohesion / LEAST_SLIP
    }
}

/// The shift along the normal of a contact with this W_nn. Where both bodies are held along the normal, the velocity is given, and the
/// impulse of a rigid contact is not determined: it is open, and its bond, cohesion or damping alone acts. A compliance determines it.
fn shift_along<S: Space>(contact: &ContactForm<S>, w_n: f64) -> f64 {
    if w_n + contact.compliance[0] > 0.0 {
        contact.shift_n
    } else {
        f64::INFINITY
    }
}
