//! The law of a contact as a row solves it, and its residual.

use super::state::{Parts, RowState};
use crate::geometry::lane_space::vector_of;
use crate::geometry::space::Space;
use crate::lanes::{Batch, BatchMut, Lane, LaneVector, record};
use crate::solve::error::Residual;
use crate::solve::form::ContactSolution;
use crate::solve::{cone, error};
use std::fmt::Debug;

/// Strengths and friction of a contact, and the data of the convergence test.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(16))]
pub(in crate::solve) struct LawLimits<S: Space, L: Lane = f64> {
    pub mu: L,
    /// Tensile strength (N s): the law holds for P = p_n + tension.
    pub tension: L,
    /// Shear cohesion (N s).
    pub cohesion: L,
    /// Step length rho of the natural map: the smaller of 1/W' along n and across; 0 where nothing
    /// moves, and the impulse follows from given velocities.
    pub rho: L,
    /// Shifts of the velocity (m/s).
    pub shift: Parts<S, L>,
    /// Compliance of the unilateral part (1/kg), normal and tangential.
    pub compliance: [L; 2],
}
record!(LawLimits);

/// A contact law in closed form, over lanes.
pub(in crate::solve) trait RowLaw<S: Space>:
    Clone + Debug + Send + Sync + 'static
{
    /// Solves contacts at a relative velocity `u`, and changes their impulses in `state` by
    /// `relaxation` times the increment; returns the changes.
    fn solve<L: Lane>(
        law: BatchMut<Self, L>,
        state: &mut RowState<S, L>,
        u: Parts<S, L>,
        relaxation: L,
    ) -> Parts<S, L>;

    fn limits<L: Lane>(law: Batch<Self, L>) -> LawLimits<S, L>;

    /// The impulses of bonds at relative velocities.
    #[inline(always)]
    fn bond<L: Lane>(_law: Batch<Self, L>, _n: &S::V<L>, _u: &Parts<S, L>) -> Parts<S, L> {
        Parts::zero()
    }

    /// The contributions to the convergence test, at relative velocities.
    #[inline(always)]
    fn residual<L: Lane>(
        law: Batch<Self, L>,
        state: &RowState<S, L>,
        u: &Parts<S, L>,
    ) -> Residual<L> {
        let unilateral = state.p - Self::bond(law, &state.n, u);
        natural_map(&Self::limits(law), unilateral, u)
    }

    /// Returns the work on the compliance of the unilateral part, c |p|^2 (J), at a relative
    /// velocity.
    fn work_on_compliance(&self, state: &RowState<S>, u: &Parts<S>) -> f64 {
        let law = Batch::one(self);
        let p = state.p - Self::bond(law, &state.n, u);
        let [c_n, c_t] = Self::limits(law).compliance;
        c_n * p.n * p.n + c_t * p.t.dot(&p.t)
    }

    /// Returns the solution at a relative velocity: the bond's part follows from the velocity, the
    /// unilateral part is the remainder.
    fn solution(&self, state: &RowState<S>, u: &Parts<S>) -> ContactSolution<S> {
        let unilateral = state.p - Self::bond(Batch::one(self), &state.n, u);
        ContactSolution {
            impulse: state.impulse(),
            unilateral_n: unilateral.n,
            unilateral_t: vector_of(&unilateral.t),
        }
    }
}

/// Returns the natural map of the De Saxce form in velocities, for unilateral impulses and relative
/// velocities; zero where rho is 0.
#[inline(always)]
fn natural_map<S: Space, L: Lane>(
    limits: &LawLimits<S, L>,
    unilateral: Parts<S, L>,
    u: &Parts<S, L>,
) -> Residual<L> {
    let (zero, one) = (L::all(0.0), L::all(1.0));
    let &LawLimits { mu, rho, .. } = limits;
    let [c_n, c_t] = limits.compliance;
    let u_n = u.n + (limits.shift.n + unilateral.n * c_n);
    let slide = u.t + (limits.shift.t + unilateral.t * c_t);
    let p = Parts::<S, L> {
        n: unilateral.n + limits.tension,
        t: unilateral.t,
    };
    let (zn, zt) = cone::project(
        p.n - rho * (u_n + mu * slide.norm()),
        p.t - slide * rho,
        mu,
        limits.cohesion,
    );
    let any = rho.above(zero);
    let over = L::select(any, one / rho, zero);
    let r = Parts::<S, L> {
        n: (p.n - zn) * over,
        t: (p.t - zt) * over,
    };
    let (natural, power) = (r.dot(&r), L::select(any, p.dot(&r), zero));
    let of_law = error::residual(natural, p.n * over, u_n, mu);
    Residual {
        squared: L::select(any, of_law, zero),
        velocity: L::select(any, u.dot(u), zero),
        impulse: p.dot(&p) * (over * over),
        power,
        unbalanced: power.abs().greatest(L::select(any, rho * natural, zero)),
        slip: L::select(any, p.t.dot(&slide), zero).abs(),
    }
}
