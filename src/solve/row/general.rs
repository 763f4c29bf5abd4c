//! A contact with levers or of a body that is free along some axes only: solved as a block.

use super::{Line, Residual, Row, inverse, inverse_along, natural_map};
use crate::geometry::space::{MatrixLike, Space, VectorLike};
use crate::solve::form::{ContactForm, ContactSolution, Elastic, Mobility};

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
        let w_n = n.dot(&w.apply(n));
        Self {
            m,
            w,
            iwn: inverse(w_n),
            iwt: inverse_along(largest, w_n),
        }
    }
}

/// A contact with levers, or of a body that is free along some axes only: a full block.
#[derive(Clone, Debug)]
pub(in crate::solve) struct GeneralRow<S: Space> {
    bodies: [u32; 2],
    n: S::Vector,
    /// Arms over the lengths of the bodies.
    arms: [S::Vector; 2],
    inverse_masses: [S::Vector; 2],
    /// Inverse inertia times the lengths squared (1/kg).
    inverse_spins: [S::Tensor; 2],
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
        inertia: impl Fn(usize) -> (Mobility<S>, f64),
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
            arms: [contact.arms[0] * (1.0 / i.1), contact.arms[1] * (1.0 / j.1)],
            inverse_masses: [i.0.mass, j.0.mass],
            inverse_spins: [i, j].map(|(m, length)| m.inertia.scaled(length).scaled(length)),
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
        a.s += self.inverse_spins[0].apply(&S::moment(&self.arms[0], p));
        b.s -= self.inverse_spins[1].apply(&S::moment(&self.arms[1], p));
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

    fn update(&mut self, a: &mut Line<S>, b: &mut Line<S>, relaxation: f64) {
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
        let p = self.p + (p - self.p) * relaxation;
        self.push(&(p - self.p), a, b);
        self.p = p;
        self.sn = sn;
        self.st = st;
    }

    fn load(&self, a: &mut Line<S>, b: &mut Line<S>) {
        self.push(&self.p, a, b);
    }

    fn store(&self, out: &mut Vec<f64>) {
        for k in 0..S::D {
            out.push(self.p[k]);
        }
    }

    fn restore(&mut self, from: &mut &[f64]) {
        self.p = S::Vector::from_slice(&from[..S::D]);
        *from = &from[S::D..];
    }

    fn set(&mut self, impulse: &S::Vector) {
        self.p = *impulse;
    }

    fn normal(&self) -> f64 {
        self.n.dot(&self.p)
    }

    fn speed(&self, a: &Line<S>, b: &Line<S>) -> f64 {
        let u = self.relative(a, b);
        u.dot(&u)
    }

    fn friction(&self) -> f64 {
        self.mu
    }

    fn rho(&self) -> f64 {
        self.pulled.iwn.min(self.pulled.iwt)
    }

    fn residual(&self, a: &Line<S>, b: &Line<S>) -> Residual {
        let n = &self.n;
        let u = self.relative(a, b);
        let (en, et) = self.bond(&u);
        let rho = self.rho();
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

    fn solution(&self, a: &Line<S>, b: &Line<S>) -> ContactSolution<S> {
        let (en, et) = self.bond(&self.relative(a, b));
        ContactSolution {
            impulse: self.p,
            unilateral_n: self.n.dot(&self.p) - en,
            unilateral_t: S::tangential(&self.n, &self.p) - et,
        }
    }
}
