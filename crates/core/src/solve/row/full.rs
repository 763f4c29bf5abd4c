//! Contact of two balls with a spring, a bond, cohesion or tangential restitution, solved in closed form.

use super::{
    LocalImpulse, Residual, Row, SolverBody, inverse, inverse_along, natural_map, push, relative,
};
use crate::geometry::space::{Space, VectorLike, greatest, least};
use crate::solve::form::{ContactForm, ContactSolution, Elastic};

/// One direction with w = W_cc, f = u - w p and p_el = -(a + b u): by elimination of u, s = q - f iw while
/// the contact is closed (or sticks), and p_el = -(k + c (w s + f)). With the compliance C of the unilateral part, which keeps u + shift + C s
/// at zero: iw = 1/(w + C (1 + w b)), q = (w a - (1 + w b) shift) iw, k = a/(1 + w b), c = b/(1 + w b).
#[derive(Clone, Copy, Debug)]
#[repr(C)]
struct Direction<T> {
    w: f64,
    iw: f64,
    q: T,
    k: T,
    c: f64,
}

/// Additional data of the convergence test, not used by the iteration.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
struct Bond<T> {
    a: T,
    b: f64,
    shift: T,
    compliance: f64,
}

/// See the module. `lanes` reads its fields in their order.
#[derive(Clone, Debug)]
#[repr(C)]
pub(in crate::solve) struct FullRow<S: Space> {
    n: S::Vector,
    pn: f64,
    pt: S::Tangent,
    normal: Direction<f64>,
    tangent: Direction<S::Tangent>,
    /// Inactive tension-only bond: s = q_0 - f iw_0.
    q_slack: f64,
    iw_slack: f64,
    /// Threshold above which the bond's normal part is inactive: 0 for a tension-only bond, otherwise
    /// infinity.
    limit: f64,
    mu: f64,
    tension: f64,
    /// Friction bound at zero normal impulse, mu h c_n + h c_t.
    grip: f64,
    cohesion: f64,
    /// Of the natural map: 1/(W' + C), the smaller of both directions.
    rho: f64,
    bond_n: Bond<f64>,
    bond_t: Bond<S::Tangent>,
    bodies: [u32; 2],
}

impl<S: Space> FullRow<S> {
    pub fn new(contact: &ContactForm<S>, w_n: f64, w_t: f64) -> Self {
        let n = contact.normal;
        let e = contact.elastic.unwrap_or_else(Elastic::none);
        let (dn, dt) = (1.0 + w_n * e.b_n, 1.0 + w_t * e.b_t);
        let (iwn, iwt) = (inverse(w_n), inverse_along(w_t, w_n));
        // Between two immovable bodies there is no contact impulse; their bond still acts.
        let movable = f64::from(u8::from(w_n > 0.0));
        let [cn, ct] = contact.compliance;
        // What a compliance leaves of 1/w, where the bond multiplies w by 1/d; 1 for a rigid contact.
        let share = |w: f64, c: f64, d: f64| if c > 0.0 { w / (w + c * d) } else { 1.0 };
        let (share_n, share_t) = (share(w_n, cn, dn), share(w_t, ct, dt));
        let share_slack = share(w_n, cn, 1.0);
        // 1/W' of a direction is (1 + w b)/w.
        let rho = least(
            iwn * share_n + e.b_n * share_n,
            iwt * share_t + e.b_t * share_t,
        );
        Self {
            bodies: contact.bodies,
            n,
            pn: n.dot(&contact.impulse),
            pt: S::tangential(&n, &contact.impulse),
            normal: Direction {
                w: w_n,
                iw: iwn * share_n,
                q: if w_n > 0.0 {
                    (e.a_n - contact.shift_n * dn * iwn) * share_n
                } else {
                    0.0
                },
                k: e.a_n / dn,
                c: e.b_n / dn,
            },
            tangent: Direction {
                w: w_t,
                iw: iwt * share_t,
                q: (e.a_t * movable - contact.shift_t * (dt * iwt)) * share_t,
                k: e.a_t * (1.0 / dt),
                c: e.b_t / dt,
            },
            q_slack: if w_n > 0.0 {
                -contact.shift_n * iwn * share_slack
            } else {
                0.0
            },
            iw_slack: iwn * share_slack,
            limit: if e.tension_only { 0.0 } else { f64::INFINITY },
            mu: contact.friction,
            tension: contact.tension,
            grip: contact.friction * contact.tension + contact.cohesion,
            cohesion: contact.cohesion,
            rho: if iwn == 0.0 { 0.0 } else { rho },
            bond_n: Bond {
                a: e.a_n,
                b: e.b_n,
                shift: contact.shift_n,
                compliance: cn,
            },
            bond_t: Bond {
                a: e.a_t,
                b: e.b_t,
                shift: contact.shift_t,
                compliance: ct,
            },
        }
    }

    /// Returns a row of a contact between immovable bodies.
    #[cfg(target_arch = "x86_64")]
    pub(super) fn idle() -> Self {
        Self::new(&ContactForm::idle(), 0.0, 0.0)
    }

    /// Returns the impulse of the bond at a relative velocity.
    fn bond(&self, un: f64, ut: S::Tangent) -> (f64, S::Tangent) {
        let pull = -(self.bond_n.a + self.bond_n.b * un);
        let en = if pull > self.limit { 0.0 } else { pull };
        (en, -(self.bond_t.a + ut * self.bond_t.b))
    }
}

impl<S: Space> Row<S> for FullRow<S> {
    #[inline(always)]
    fn bodies(&self) -> [u32; 2] {
        self.bodies
    }

    #[inline(always)]
    fn update(&mut self, a: &mut SolverBody<S>, b: &mut SolverBody<S>, relaxation: f64) {
        let (n, t) = (&self.normal, &self.tangent);
        let (un, ut) = relative(&self.n, a, b);
        let f = un - n.w * self.pn;
        // Both branches are computed and one is selected, because the branch would be mispredicted too
        // often.
        let with = greatest(n.q - f * n.iw, -self.tension);
        let pull = -(n.k + n.c * (n.w * with + f));
        let without = greatest(self.q_slack - f * self.iw_slack, -self.tension);
        let slack = pull > self.limit;
        let sn = std::hint::select_unpredictable(slack, without, with);
        let en = std::hint::select_unpredictable(slack, 0.0, pull);
        let f = ut - self.pt * t.w;
        let st = (t.q - f * t.iw).limited(self.mu * sn + self.grip);
        let et = -(t.k + (st * t.w + f) * t.c);
        let (dn, dt) = (sn + en - self.pn, st + et - self.pt);
        let (dn, dt) = (dn * relaxation, dt * relaxation);
        push(&self.n, dn, dt, a, b);
        self.pn += dn;
        self.pt += dt;
    }

    fn load(&self, a: &mut SolverBody<S>, b: &mut SolverBody<S>) {
        push(&self.n, self.pn, self.pt, a, b);
    }

    #[inline(always)]
    fn local_impulse(&self) -> LocalImpulse<S> {
        (self.pn, self.pt)
    }

    #[inline(always)]
    fn set_local_impulse(&mut self, parts: LocalImpulse<S>) {
        (self.pn, self.pt) = parts;
    }

    fn set(&mut self, impulse: &S::Vector) {
        self.pn = self.n.dot(impulse);
        self.pt = S::tangential(&self.n, impulse);
    }

    fn speed(&self, a: &SolverBody<S>, b: &SolverBody<S>) -> f64 {
        let (un, ut) = relative(&self.n, a, b);
        un * un + ut.dot(&ut)
    }

    fn friction(&self) -> f64 {
        self.mu
    }

    fn rho(&self) -> f64 {
        self.rho
    }

    fn residual(&self, a: &SolverBody<S>, b: &SolverBody<S>) -> Residual {
        let rho = self.rho();
        if rho == 0.0 {
            return Residual::default();
        }
        let (un, ut) = relative(&self.n, a, b);
        let (en, et) = self.bond(un, ut);
        let (sn, st) = (self.pn - en, self.pt - et);
        let shifted = (sn + self.tension, st);
        let shift = (
            self.bond_n.shift + sn * self.bond_n.compliance,
            self.bond_t.shift + st * self.bond_t.compliance,
        );
        natural_map(shifted, (un, ut), shift, rho, self.mu, self.cohesion)
    }

    fn yields(&self, a: &SolverBody<S>, b: &SolverBody<S>) -> f64 {
        let (un, ut) = relative(&self.n, a, b);
        let (en, et) = self.bond(un, ut);
        let (sn, st) = (self.pn - en, self.pt - et);
        self.bond_n.compliance * sn * sn + self.bond_t.compliance * st.dot(&st)
    }

    fn solution(&self, a: &SolverBody<S>, b: &SolverBody<S>) -> ContactSolution<S> {
        let (un, ut) = relative(&self.n, a, b);
        let (en, et) = self.bond(un, ut);
        ContactSolution {
            impulse: self.n * self.pn + S::tangent_vector(&self.n, &self.pt),
            unilateral_n: self.pn - en,
            unilateral_t: self.pt - et,
        }
    }
}
