//! Contact of two balls with a spring, a bond, cohesion or tangential restitution, solved in closed form.

use super::{LocalImpulse, Residual, Row, SolverBody, answer_to_slip, natural_map, shift_along};
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
    /// Levers over the lengths of the bodies: 1 where the contact acts on the surfaces of the balls.
    reach: [f64; 2],
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
    pub fn new(contact: &ContactForm<S>, w_n: f64, w_t: f64, reach: [f64; 2]) -> Self {
        let n = contact.normal;
        let e = contact.elastic.unwrap_or_else(Elastic::none);
        let (dn, dt) = (1.0 + w_n * e.b_n, 1.0 + w_t * e.b_t);
        let [cn, ct] = contact.compliance;
        let shift_n = shift_along(contact, w_n);
        // Where both bodies are held in a direction its compliance alone answers; any answer leaves an open contact open.
        let along = if w_n > 0.0 { w_n } else { cn };
        let iwn = if along > 0.0 { 1.0 / along } else { 1.0 };
        let iwt = if w_t == 0.0 && ct > 0.0 {
            1.0 / ct
        } else {
            answer_to_slip(w_t, along, contact.cohesion)
        };
        // What a compliance leaves of 1/w, where the bond multiplies w by 1/d; 1 for a rigid contact.
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
            // The impulse does not depend on any motion: it is right after one visit, and is not tested.
            (false, false) => 0.0,
        };
        // A bond and what is beside it share a direction where something moves.
        let shared = |w: f64| if w > 0.0 { 1.0 } else { 0.0 };
        Self {
            bodies: contact.bodies,
            n,
            pn: n.dot(&contact.impulse),
            pt: S::tangential(&n, &contact.impulse),
            reach,
            normal: Direction {
                w: w_n,
                iw: iwn * share_n,
                q: (e.a_n * shared(w_n) - shift_n * dn * iwn) * share_n,
                k: e.a_n / dn,
                c: e.b_n / dn,
            },
            tangent: Direction {
                w: w_t,
                iw: iwt * share_t,
                q: (e.a_t * shared(w_t) - contact.shift_t * (dt * iwt)) * share_t,
                k: e.a_t * (1.0 / dt),
                c: e.b_t / dt,
            },
            q_slack: -shift_n * iwn * share_slack,
            iw_slack: iwn * share_slack,
            limit: if e.tension_only { 0.0 } else { f64::INFINITY },
            mu: contact.friction,
            tension: contact.tension,
            grip: contact.friction * contact.tension + contact.cohesion,
            cohesion: contact.cohesion,
            rho,
            bond_n: Bond {
                a: e.a_n,
                b: e.b_n,
                shift: shift_n,
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
        Self::new(&ContactForm::idle(), 0.0, 0.0, [1.0; 2])
    }

    /// Relative velocity, normal and tangential.
    #[inline(always)]
    fn relative(&self, a: &SolverBody<S>, b: &SolverBody<S>) -> (f64, S::Tangent) {
        let (n, [i, j]) = (&self.n, self.reach);
        let d = a.v - b.v;
        let turning = S::roll(&(a.s * i + b.s * j), n);
        (n.dot(&d), S::tangential(n, &d) - turning)
    }

    /// Applies an impulse to the velocities.
    #[inline(always)]
    fn push(&self, dn: f64, dt: S::Tangent, a: &mut SolverBody<S>, b: &mut SolverBody<S>) {
        let impulse = self.n * dn + S::tangent_vector(&self.n, &dt);
        let twist = S::twist(&self.n, &dt);
        a.v += impulse * a.im;
        b.v -= impulse * b.im;
        a.s -= twist * (a.is * self.reach[0]);
        b.s -= twist * (b.is * self.reach[1]);
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
        let (un, ut) = self.relative(a, b);
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
        self.push(dn, dt, a, b);
        self.pn += dn;
        self.pt += dt;
    }

    fn load(&self, a: &mut SolverBody<S>, b: &mut SolverBody<S>) {
        self.push(self.pn, self.pt, a, b);
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
        let (un, ut) = self.relative(a, b);
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
        let (un, ut) = self.relative(a, b);
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
        let (un, ut) = self.relative(a, b);
        let (en, et) = self.bond(un, ut);
        let (sn, st) = (self.pn - en, self.pt - et);
        self.bond_n.compliance * sn * sn + self.bond_t.compliance * st.dot(&st)
    }

    fn solution(&self, a: &SolverBody<S>, b: &SolverBody<S>) -> ContactSolution<S> {
        let (un, ut) = self.relative(a, b);
        let (en, et) = self.bond(un, ut);
        ContactSolution {
            impulse: self.n * self.pn + S::tangent_vector(&self.n, &self.pt),
            unilateral_n: self.pn - en,
            unilateral_t: self.pt - et,
        }
    }
}
