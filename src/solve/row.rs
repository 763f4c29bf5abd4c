//! The packed records the sweep runs over, and the exact solution of one contact.
//!
//! A contact of two balls has W_nt = 0, W_nn = 1/m_i + 1/m_j and an isotropic W_tt, so its problem is
//! solved in closed form: first the normal part, then the tangential one within the cone.

use super::cone;
use super::form::{ContactForm, ContactSolution, Elastic};
use crate::geometry::space::{MatrixLike, Space, VectorLike};

/// Velocity of a body in the solver: 64 bytes in both dimensions.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub struct Line<S: Space> {
    /// Velocity of the centre (m/s).
    pub v: S::Vector,
    /// Angular velocity times the body's length (m/s).
    pub s: S::Spin,
    /// Inverse mass, where isotropic (1/kg).
    pub im: f64,
    /// Inverse inertia times the length squared (1/kg).
    pub is: f64,
}

/// What the convergence test reads off one contact.
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
}

/// A contact in the solver.
pub(super) trait Row<S: Space>: Clone + Send + Sync {
    fn bodies(&self) -> [u32; 2];
    /// Solves the contact for the velocities at hand and updates them.
    fn update(&mut self, a: &mut Line<S>, b: &mut Line<S>);
    /// Adds what the stored impulse does to the velocities.
    fn load(&self, a: &mut Line<S>, b: &mut Line<S>);
    fn residual(&self, a: &Line<S>, b: &Line<S>) -> Residual;
    fn solution(&self) -> ContactSolution<S>;
}

#[inline(always)]
fn relative<S: Space>(n: &S::Vector, a: &Line<S>, b: &Line<S>) -> (f64, S::Tangent) {
    let d = a.v - b.v;
    (n.dot(&d), S::tangential(n, &d) - S::roll(&(a.s + b.s), n))
}

#[inline(always)]
fn push<S: Space>(n: &S::Vector, dn: f64, dt: S::Tangent, a: &mut Line<S>, b: &mut Line<S>) {
    let impulse = *n * dn + S::lift(n, &dt);
    let twist = S::twist(n, &dt);
    a.v += impulse * a.im;
    b.v -= impulse * b.im;
    a.s -= twist * a.is;
    b.s -= twist * b.is;
}

/// The natural map of the De Saxce form in velocity, for a shifted impulse (P_n, p_t), a velocity and
/// its shift.
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
    let (zn, zt) = cone::project(
        pn - rho * (un + sn + mu * slide.norm()),
        pt - slide * rho,
        mu,
        c,
    );
    let over = 1.0 / rho;
    let (rn, rt) = ((pn - zn) * over, (pt - zt) * over);
    Residual {
        squared: rn * rn + rt.dot(&rt),
        velocity: un * un + ut.dot(&ut),
        impulse: (pn * pn + pt.dot(&pt)) * (over * over),
        power: pn * rn + pt.dot(&rt),
    }
}

/// Frictional contact without memory.
#[derive(Clone, Debug)]
pub(super) struct PlainRow<S: Space> {
    bodies: [u32; 2],
    n: S::Vector,
    pn: f64,
    pt: S::Tangent,
    shift: f64,
    iwn: f64,
    iwt: f64,
    mu: f64,
}

impl<S: Space> PlainRow<S> {
    pub fn new(contact: &ContactForm<S>, w_n: f64, w_t: f64) -> Self {
        let n = contact.normal;
        Self {
            bodies: contact.bodies,
            n,
            pn: n.dot(&contact.impulse),
            pt: S::tangential(&n, &contact.impulse),
            shift: contact.shift_n,
            iwn: inverse(w_n),
            iwt: inverse(w_t),
            mu: contact.friction,
        }
    }
}

/// Of two immovable bodies nothing can be solved: their impulse is zero.
fn inverse(w: f64) -> f64 {
    if w > 0.0 { 1.0 / w } else { 0.0 }
}

impl<S: Space> Row<S> for PlainRow<S> {
    #[inline(always)]
    fn bodies(&self) -> [u32; 2] {
        self.bodies
    }

    #[inline(always)]
    fn update(&mut self, a: &mut Line<S>, b: &mut Line<S>) {
        let (un, ut) = relative(&self.n, a, b);
        let pn = (self.pn - (un + self.shift) * self.iwn).max(0.0);
        let pt = (self.pt - ut * self.iwt).limited(self.mu * pn);
        push(&self.n, pn - self.pn, pt - self.pt, a, b);
        self.pn = pn;
        self.pt = pt;
    }

    fn load(&self, a: &mut Line<S>, b: &mut Line<S>) {
        push(&self.n, self.pn, self.pt, a, b);
    }

    #[inline(always)]
    fn residual(&self, a: &Line<S>, b: &Line<S>) -> Residual {
        let (un, ut) = relative(&self.n, a, b);
        let rho = self.iwn.min(self.iwt);
        if rho > 0.0 {
            natural_map(
                (self.pn, self.pt),
                (un, ut),
                (self.shift, S::Tangent::null()),
                rho,
                self.mu,
                0.0,
            )
        } else {
            Residual::default()
        }
    }

    fn solution(&self) -> ContactSolution<S> {
        ContactSolution {
            impulse: self.n * self.pn + S::lift(&self.n, &self.pt),
            unilateral_n: self.pn,
            unilateral_t: self.pt,
        }
    }
}

/// Contact of two balls with a single-valued part, cohesion or tangential restitution.
///
/// With the bond, u (1 + W B) = W p_sc + f - W a, f = u - W p. What does not change in the sweeps is
/// kept: `wa` = W a, `sd` = s (1 + W B), `gain` = 1/(1 + W B).
#[derive(Clone, Debug)]
pub(super) struct FullRow<S: Space> {
    bodies: [u32; 2],
    n: S::Vector,
    pn: f64,
    pt: S::Tangent,
    sn: f64,
    st: S::Tangent,
    normal: Linear<f64>,
    tangent: Linear<S::Tangent>,
    mu: f64,
    tension: f64,
    cohesion: f64,
    tension_only: bool,
}

/// One direction of a contact with a bond.
#[derive(Clone, Copy, Debug)]
struct Linear<T> {
    w: f64,
    iw: f64,
    a: T,
    b: f64,
    shift: T,
    wa: T,
    sd: T,
    gain: f64,
}

impl<S: Space> FullRow<S> {
    pub fn new(contact: &ContactForm<S>, w_n: f64, w_t: f64) -> Self {
        let n = contact.normal;
        let e = contact.elastic.unwrap_or_else(Elastic::none);
        let (dn, dt) = (1.0 + w_n * e.b_n, 1.0 + w_t * e.b_t);
        Self {
            bodies: contact.bodies,
            n,
            pn: n.dot(&contact.impulse),
            pt: S::tangential(&n, &contact.impulse),
            sn: 0.0,
            st: S::Tangent::null(),
            normal: Linear {
                w: w_n,
                iw: inverse(w_n),
                a: e.a_n,
                b: e.b_n,
                shift: contact.shift_n,
                wa: w_n * e.a_n,
                sd: contact.shift_n * dn,
                gain: 1.0 / dn,
            },
            tangent: Linear {
                w: w_t,
                iw: inverse(w_t),
                a: e.a_t,
                b: e.b_t,
                shift: contact.shift_t,
                wa: e.a_t * w_t,
                sd: contact.shift_t * dt,
                gain: 1.0 / dt,
            },
            mu: contact.friction,
            tension: contact.tension,
            cohesion: contact.cohesion,
            tension_only: e.tension_only,
        }
    }
}

impl<S: Space> Row<S> for FullRow<S> {
    #[inline(always)]
    fn bodies(&self) -> [u32; 2] {
        self.bodies
    }

    #[inline(always)]
    fn update(&mut self, a: &mut Line<S>, b: &mut Line<S>) {
        let (n, t) = (&self.normal, &self.tangent);
        let (un, ut) = relative(&self.n, a, b);
        let free = un - n.w * self.pn;
        let pulled = free - n.wa;
        // Both answers are formed and one is chosen: the branch would be guessed wrong too often.
        let with = (-(pulled + n.sd) * n.iw).max(-self.tension);
        let pull = -(n.a + n.b * ((n.w * with + pulled) * n.gain));
        let without = (-(free + n.shift) * n.iw).max(-self.tension);
        let slack = self.tension_only & (pull > 0.0);
        let sn = std::hint::select_unpredictable(slack, without, with);
        let en = std::hint::select_unpredictable(slack, 0.0, pull);
        let pulled = ut - self.pt * t.w - t.wa;
        let bound = self.mu * (sn + self.tension) + self.cohesion;
        let st = ((pulled + t.sd) * -t.iw).limited(bound);
        let et = -(t.a + (st * t.w + pulled) * (t.b * t.gain));
        let (pn, pt) = (sn + en, st + et);
        push(&self.n, pn - self.pn, pt - self.pt, a, b);
        self.pn = pn;
        self.pt = pt;
        self.sn = sn;
        self.st = st;
    }

    fn load(&self, a: &mut Line<S>, b: &mut Line<S>) {
        push(&self.n, self.pn, self.pt, a, b);
    }

    fn residual(&self, a: &Line<S>, b: &Line<S>) -> Residual {
        let (n, t) = (&self.normal, &self.tangent);
        if n.iw == 0.0 {
            return Residual::default();
        }
        let (un, ut) = relative(&self.n, a, b);
        let en = -(n.a + n.b * un);
        let en = if self.tension_only { en.min(0.0) } else { en };
        let et = -(t.a + ut * t.b);
        let rho = (n.iw / n.gain).min(t.iw / t.gain);
        let shifted = (self.pn - en + self.tension, self.pt - et);
        natural_map(
            shifted,
            (un, ut),
            (n.shift, t.shift),
            rho,
            self.mu,
            self.cohesion,
        )
    }

    fn solution(&self) -> ContactSolution<S> {
        ContactSolution {
            impulse: self.n * self.pn + S::lift(&self.n, &self.pt),
            unilateral_n: self.sn,
            unilateral_t: self.st,
        }
    }
}

/// (1 + W B)^-1 and W' = (1 + W B)^-1 W of a block.
#[derive(Clone, Debug)]
struct Block<S: Space> {
    m: S::Matrix,
    w: S::Matrix,
    iwn: f64,
    iwt: f64,
}

impl<S: Space> Block<S> {
    fn new(w: S::Matrix, n: &S::Vector, b_n: f64, b_t: f64) -> Self {
        let mut ones = S::Vector::null();
        for k in 0..S::D {
            ones[k] = 1.0;
        }
        let one = S::Matrix::diagonal(&ones);
        let nn = S::Matrix::dyad(n, n);
        let b = nn.scaled(b_n - b_t) + one.scaled(b_t);
        let m = (one + w.times(&b)).inverse().unwrap_or(one);
        let w = m.times(&w);
        let [t1, t2] = S::tangents(n);
        let (a, c) = (t1.dot(&w.apply(&t1)), t2.dot(&w.apply(&t2)));
        let cross = t1.dot(&w.apply(&t2));
        let largest = 0.5 * (a + c) + (0.25 * (a - c) * (a - c) + cross * cross).sqrt();
        Self {
            m,
            w,
            iwn: inverse(n.dot(&w.apply(n))),
            iwt: inverse(largest),
        }
    }
}

/// A contact with levers, or of a body that is free along some axes only: a full block.
#[derive(Clone, Debug)]
pub(super) struct GeneralRow<S: Space> {
    bodies: [u32; 2],
    n: S::Vector,
    /// Arms over the lengths of the bodies.
    arms: [S::Vector; 2],
    inverse_masses: [S::Vector; 2],
    inverse_spins: [f64; 2],
    p: S::Vector,
    block: S::Matrix,
    pulled: Block<S>,
    slack: Option<Block<S>>,
    shift_n: f64,
    shift_t: S::Tangent,
    mu: f64,
    tension: f64,
    cohesion: f64,
    elastic: Elastic<S>,
    sn: f64,
    st: S::Tangent,
}

impl<S: Space> GeneralRow<S> {
    pub fn new(
        contact: &ContactForm<S>,
        block: S::Matrix,
        inertia: impl Fn(usize) -> (S::Vector, f64, f64),
    ) -> Self {
        let n = contact.normal;
        let [i, j] = contact.bodies.map(|b| inertia(b as usize));
        let elastic = contact.elastic.unwrap_or_else(Elastic::none);
        let pulled = Block::new(block, &n, elastic.b_n, elastic.b_t);
        let slack = elastic
            .tension_only
            .then(|| Block::new(block, &n, 0.0, elastic.b_t));
        Self {
            bodies: contact.bodies,
            n,
            arms: [contact.arms[0] * (1.0 / i.2), contact.arms[1] * (1.0 / j.2)],
            inverse_masses: [i.0, j.0],
            inverse_spins: [i.1 * i.2 * i.2, j.1 * j.2 * j.2],
            p: contact.impulse,
            block,
            pulled,
            slack,
            shift_n: contact.shift_n,
            shift_t: contact.shift_t,
            mu: contact.friction,
            tension: contact.tension,
            cohesion: contact.cohesion,
            elastic,
            sn: n.dot(&contact.impulse).max(0.0),
            st: S::Tangent::null(),
        }
    }

    fn relative(&self, a: &Line<S>, b: &Line<S>) -> S::Vector {
        a.v + S::sweep(&a.s, &self.arms[0]) - b.v - S::sweep(&b.s, &self.arms[1])
    }

    fn push(&self, p: &S::Vector, a: &mut Line<S>, b: &mut Line<S>) {
        a.v += p.scaled_by(&self.inverse_masses[0]);
        b.v -= p.scaled_by(&self.inverse_masses[1]);
        a.s += S::moment(&self.arms[0], p) * self.inverse_spins[0];
        b.s -= S::moment(&self.arms[1], p) * self.inverse_spins[1];
    }

    /// Solves the contact with block `w`: alternates the normal and the tangential part. Two rounds: the
    /// sweeps that follow do the rest, since each begins where the last one ended.
    fn solve(&self, block: &Block<S>, f: &S::Vector) -> (f64, S::Tangent) {
        const ALTERNATIONS: usize = 2;
        let n = &self.n;
        let (mut sn, mut st) = (self.sn, self.st);
        for _ in 0..ALTERNATIONS {
            let (old_n, old_t) = (sn, st);
            let u = block.w.apply(&(*n * sn + S::lift(n, &st))) + *f;
            sn = (sn - (n.dot(&u) + self.shift_n) * block.iwn).max(-self.tension);
            let u = block.w.apply(&(*n * sn + S::lift(n, &st))) + *f;
            let ut = S::tangential(n, &u) + self.shift_t;
            let bound = self.mu * (sn + self.tension) + self.cohesion;
            st = (st - ut * block.iwt).limited(bound);
            let change = (sn - old_n).abs() + (st - old_t).norm();
            if change <= 1e-14 * (sn.abs() + st.norm()) {
                break;
            }
        }
        (sn, st)
    }

    fn bond(&self, u: &S::Vector) -> (f64, S::Tangent) {
        let e = &self.elastic;
        let en = -(e.a_n + e.b_n * self.n.dot(u));
        let en = if e.tension_only { en.min(0.0) } else { en };
        (en, -(e.a_t + S::tangential(&self.n, u) * e.b_t))
    }
}

impl<S: Space> Row<S> for GeneralRow<S> {
    fn bodies(&self) -> [u32; 2] {
        self.bodies
    }

    fn update(&mut self, a: &mut Line<S>, b: &mut Line<S>) {
        let (n, e) = (self.n, self.elastic);
        let f = self.relative(a, b) - self.block.apply(&self.p);
        let at = S::lift(&n, &e.a_t);
        let with = self
            .pulled
            .m
            .apply(&(f - self.block.apply(&(n * e.a_n + at))));
        let (mut sn, mut st) = self.solve(&self.pulled, &with);
        let mut u = self.pulled.w.apply(&(n * sn + S::lift(&n, &st))) + with;
        if let Some(slack) = &self.slack
            && -(e.a_n + e.b_n * n.dot(&u)) > 0.0
        {
            let without = slack.m.apply(&(f - self.block.apply(&at)));
            (sn, st) = self.solve(slack, &without);
            u = slack.w.apply(&(n * sn + S::lift(&n, &st))) + without;
        }
        let (en, et) = self.bond(&u);
        let p = n * (sn + en) + S::lift(&n, &(st + et));
        self.push(&(p - self.p), a, b);
        self.p = p;
        self.sn = sn;
        self.st = st;
    }

    fn load(&self, a: &mut Line<S>, b: &mut Line<S>) {
        self.push(&self.p, a, b);
    }

    fn residual(&self, a: &Line<S>, b: &Line<S>) -> Residual {
        let n = &self.n;
        let u = self.relative(a, b);
        let (en, et) = self.bond(&u);
        let rho = self.pulled.iwn.min(self.pulled.iwt);
        let (un, ut) = (n.dot(&u), S::tangential(n, &u));
        if rho > 0.0 {
            let pn = n.dot(&self.p) - en + self.tension;
            let pt = S::tangential(n, &self.p) - et;
            natural_map(
                (pn, pt),
                (un, ut),
                (self.shift_n, self.shift_t),
                rho,
                self.mu,
                self.cohesion,
            )
        } else {
            Residual::default()
        }
    }

    fn solution(&self) -> ContactSolution<S> {
        ContactSolution {
            impulse: self.p,
            unilateral_n: self.sn,
            unilateral_t: self.st,
        }
    }
}
