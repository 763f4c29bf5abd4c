//! Contact of two balls with a spring, a bond, cohesion or tangential restitution, solved in closed
//! form.

use super::kind::RowKind;
use super::law::{LawLimits, RowLaw};
use super::motion::BallLevers;
use super::response::{answer_to_slip, shift_along};
use super::rigid_bodies::RigidBodies;
use super::state::{Parts, RowState};
use crate::geometry::lane_space::lanes_of;
use crate::geometry::space::{Space, least};
use crate::lanes::{Batch, BatchMut, Lane, LaneVector, part, record};
use crate::solve::form::{ContactForm, Elastic};

/// Data of an update. In a direction with w = W_cc, f = u - w p and p_el = -(a + b u): by
/// elimination of u, s = q - f iw while the contact is closed (or sticks), and p_el = -(k + c (w
/// s + f)). With the compliance C of the unilateral part, which keeps u + shift + C s at zero: iw =
/// 1/(w + C (1 + w b)), q = (w a - (1 + w b) shift) iw, k = a/(1 + w b), c = b/(1 + w b).
#[derive(Clone, Copy, Debug)]
#[repr(C, align(16))]
struct Response<S: Space, L: Lane = f64> {
    w: [L; 2],
    iw: [L; 2],
    c: [L; 2],
    q: Parts<S, L>,
    k: Parts<S, L>,
    /// Inactive tension-only bond: s = q_0 - f iw_0.
    q_slack: L,
    iw_slack: L,
    /// Threshold above which the bond's normal part is inactive: 0 for a tension-only bond,
    /// otherwise infinity.
    limit: L,
    mu: L,
    tension: L,
    /// Friction bound at zero normal impulse, mu h c_n + h c_t.
    grip: L,
}
record!(Response);

/// Data of the convergence test in addition to [`LawLimits`]: the bond's impulse at u = 0, and its
/// increase with velocity.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(16))]
struct TestTerms<S: Space, L: Lane = f64> {
    a: Parts<S, L>,
    b: [L; 2],
    cohesion: L,
    /// Step length of the natural map: the smaller value of 1/(W' + C) in the two directions.
    rho: L,
    shift: Parts<S, L>,
    compliance: [L; 2],
}
record!(TestTerms);

/// Law of a contact of two balls with all effects that can act on it.
#[derive(Clone, Debug)]
#[repr(C)]
pub(in crate::solve) struct Full<S: Space> {
    answer: Response<S>,
    test: TestTerms<S>,
}

impl<S: Space> RowLaw<S> for Full<S> {
    #[inline(always)]
    fn solve<L: Lane>(
        law: BatchMut<Self, L>,
        state: &mut RowState<S, L>,
        u: Parts<S, L>,
        relaxation: L,
    ) -> Parts<S, L> {
        let r = part!(law, answer).read();
        let ([w_n, w_t], [iw_n, iw_t], [c_n, c_t]) = (r.w, r.iw, r.c);
        let f = u.n - w_n * state.p.n;
        let with = (r.q.n - f * iw_n).greatest(-r.tension);
        let pull = -(r.k.n + c_n * (w_n * with + f));
        let without = (r.q_slack - f * r.iw_slack).greatest(-r.tension);
        let slack = pull.above(r.limit);
        let sn = L::select(slack, without, with);
        let en = L::select(slack, L::all(0.0), pull);
        let f = u.t - state.p.t * w_t;
        let st = (r.q.t - f * iw_t).limited(r.mu * sn + r.grip);
        let et = -(r.k.t + (st * w_t + f) * c_t);
        let wanted = Parts {
            n: sn + en,
            t: st + et,
        };
        let change = (wanted - state.p) * relaxation;
        state.p = state.p + change;
        change
    }

    #[inline(always)]
    fn limits<L: Lane>(law: Batch<Self, L>) -> LawLimits<S, L> {
        let (answer, test) = (part!(law, answer).read(), part!(law, test).read());
        LawLimits {
            mu: answer.mu,
            tension: answer.tension,
            cohesion: test.cohesion,
            rho: test.rho,
            shift: test.shift,
            compliance: test.compliance,
        }
    }

    #[inline(always)]
    fn bond<L: Lane>(law: Batch<Self, L>, _: &S::V<L>, u: &Parts<S, L>) -> Parts<S, L> {
        let (answer, test) = (part!(law, answer).read(), part!(law, test).read());
        let pull = -(test.a.n + test.b[0] * u.n);
        Parts {
            n: L::select(pull.above(answer.limit), L::all(0.0), pull),
            t: -(test.a.t + u.t * test.b[1]),
        }
    }
}

impl<S: Space> RowKind<S> for Full<S> {
    type Motion = BallLevers;
    const EIGHT: bool = true;
    const BONDS: bool = true;

    fn serves(contact: &ContactForm<S>) -> bool {
        contact.central
    }

    fn new(contact: &ContactForm<S>, bodies: &RigidBodies<S>) -> (Self, BallLevers) {
        let reach = bodies.reach(contact);
        let [w_n, w_t] = bodies.of_balls(contact, reach);
        (Self::of(contact, w_n, w_t), BallLevers(reach))
    }
}

impl<S: Space> Full<S> {
    /// Creates the law from W along and across the normal.
    fn of(contact: &ContactForm<S>, w_n: f64, w_t: f64) -> Self {
        let e = contact.elastic.unwrap_or_else(Elastic::none);
        let (dn, dt) = (1.0 + w_n * e.b_n, 1.0 + w_t * e.b_t);
        let [cn, ct] = contact.compliance;
        let shift_n = shift_along(contact, w_n);
        // Where both bodies are held in a direction, the compliance alone responds; for an open
        // contact any value will do.
        let along = if w_n > 0.0 { w_n } else { cn };
        let iwn = if along > 0.0 { 1.0 / along } else { 1.0 };
        let iwt = if w_t == 0.0 && ct > 0.0 {
            1.0 / ct
        } else {
            answer_to_slip(w_t, along, contact.cohesion)
        };
        // Ratio by which a compliance reduces 1/w, where the bond multiplies w by 1/d; 1 for a
        // rigid contact.
        let share = |w: f64, c: f64, d: f64| {
            if c > 0.0 && w > 0.0 {
                w / (w + c * d)
            } else {
                1.0
            }
        };
        let (share_n, share_t) = (share(w_n, cn, dn), share(w_t, ct, dt));
        let share_slack = share(w_n, cn, 1.0);
        // 1/W' of a direction is (1 + w b)/w.
        let rho_t = iwt * share_t + e.b_t * share_t;
        let rho = match (w_n > 0.0, w_t > 0.0) {
            (true, _) => least(iwn * share_n + e.b_n * share_n, rho_t),
            (false, true) if cn > 0.0 => least(iwn, rho_t),
            (false, true) => rho_t,
            // The impulse does not depend on any motion: it is exact after one visit, and is not
            // tested.
            (false, false) => 0.0,
        };
        // A bond and the other effects share a direction in which something moves.
        let shared = |w: f64| if w > 0.0 { 1.0 } else { 0.0 };
        let q_t = (e.a_t * shared(w_t) - contact.shift_t * (dt * iwt)) * share_t;
        Self {
            answer: Response {
                w: [w_n, w_t],
                iw: [iwn * share_n, iwt * share_t],
                c: [e.b_n / dn, e.b_t / dt],
                q: Parts {
                    n: (e.a_n * shared(w_n) - shift_n * dn * iwn) * share_n,
                    t: lanes_of(&q_t),
                },
                k: Parts {
                    n: e.a_n / dn,
                    t: lanes_of(&(e.a_t * (1.0 / dt))),
                },
                q_slack: -shift_n * iwn * share_slack,
                iw_slack: iwn * share_slack,
                limit: if e.tension_only { 0.0 } else { f64::INFINITY },
                mu: contact.friction,
                tension: contact.tension,
                grip: contact.friction * contact.tension + contact.cohesion,
            },
            test: TestTerms {
                a: Parts {
                    n: e.a_n,
                    t: lanes_of(&e.a_t),
                },
                b: [e.b_n, e.b_t],
                cohesion: contact.cohesion,
                rho,
                shift: Parts {
                    n: shift_n,
                    t: lanes_of(&contact.shift_t),
                },
                compliance: contact.compliance,
            },
        }
    }
}
