//! The law of a contact on a full block of W: friction, tension, cohesion and a bond, solved exactly where there is no shear
//! cohesion. What the impulse does to the bodies is the row's part.

use super::{Residual, inverse, inverse_along, natural_map};
use crate::geometry::space::{MatrixLike, Space, VectorLike};
use crate::solve::form::{ContactForm, ContactSolution, Elastic};
use crate::solve::local::contact::Local;

/// (1 + W B)^-1, W' = (1 + W B)^-1 W, and W' + C with the compliance of the unilateral part.
#[derive(Clone, Debug)]
struct Block<S: Space> {
    m: S::Matrix,
    w: S::Matrix,
    compliant: S::Matrix,
    iwn: f64,
    iwt: f64,
    exact: Exact,
}

/// Coulomb's law with W' in the frame of the contact.
#[derive(Clone, Debug)]
enum Exact {
    Dim2(Local<2>),
    Dim3(Local<3>),
}

impl Exact {
    fn new<S: Space>(w: &S::Matrix, n: &S::Vector, mu: f64) -> Self {
        let [t1, t2] = S::tangents(n);
        let axes = [*n, t1, t2];
        let entry = |i: usize, j: usize| axes[i].dot(&w.apply(&axes[j]));
        if S::D == 2 {
            let w = std::array::from_fn(|i| std::array::from_fn(|j| entry(i, j)));
            Self::Dim2(Local::new(&w, mu))
        } else {
            let w = std::array::from_fn(|i| std::array::from_fn(|j| entry(i, j)));
            Self::Dim3(Local::new(&w, mu))
        }
    }

    /// The impulse that answers a free velocity, its normal and its tangential part.
    fn solve<S: Space>(&mut self, n: &S::Vector, f: &S::Vector) -> (f64, S::Tangent) {
        let [t1, t2] = S::components(n, &S::tangential(n, f));
        match self {
            Self::Dim2(local) => {
                let p = local.solve(&[n.dot(f), t1]);
                (p[0], S::from_components(n, p[1], 0.0))
            }
            Self::Dim3(local) => {
                let p = local.solve(&[n.dot(f), t1, t2]);
                (p[0], S::from_components(n, p[1], p[2]))
            }
        }
    }
}

impl<S: Space> Block<S> {
    fn new(w: S::Matrix, contact: &ContactForm<S>, [b_n, b_t]: [f64; 2]) -> Self {
        let (n, mu, [c_n, c_t]) = (&contact.normal, contact.friction, contact.compliance);
        let mut ones = S::Vector::zero();
        for k in 0..S::D {
            ones[k] = 1.0;
        }
        let one = S::Matrix::diagonal(&ones);
        let nn = S::Matrix::dyad(n, n);
        let b = nn.scaled(b_n - b_t) + one.scaled(b_t);
        let m = (one + w.times(&b)).inverse().unwrap_or(one);
        let rigid = m.times(&w);
        let w = rigid + nn.scaled(c_n - c_t) + one.scaled(c_t);
        let [t1, t2] = S::tangents(n);
        let (a, c) = (t1.dot(&w.apply(&t1)), t2.dot(&w.apply(&t2)));
        let cross = t1.dot(&w.apply(&t2));
        let largest = 0.5 * (a + c) + (0.25 * (a - c) * (a - c) + cross * cross).sqrt();
        let w_n = n.dot(&w.apply(n));
        Self {
            m,
            exact: Exact::new::<S>(&w, n, mu),
            w: rigid,
            compliant: w,
            iwn: inverse(w_n),
            iwt: inverse_along(largest, w_n),
        }
    }
}

/// The unilateral part of a contact.
struct Terms<S: Space> {
    n: S::Vector,
    shift_n: f64,
    shift_t: S::Tangent,
    mu: f64,
    tension: f64,
    cohesion: f64,
    start: (f64, S::Tangent),
}

impl<S: Space> Terms<S> {
    /// Solves the contact with a block at a free velocity.
    fn solve(&self, block: &mut Block<S>, f: &S::Vector) -> (f64, S::Tangent) {
        let n = &self.n;
        if self.cohesion > 0.0 {
            return self.alternate(block, f);
        }
        if self.shift_n == f64::INFINITY {
            // An open contact that may close freely. Infinity times an axis of the normal that is zero is no number.
            return (0.0 - self.tension, S::Tangent::zero());
        }
        // In P = s + tension and u + shift it is Coulomb's law.
        let shift = *n * self.shift_n + S::tangent_vector(n, &self.shift_t);
        let f = *f + shift - block.compliant.apply(&(*n * self.tension));
        let (pn, pt) = block.exact.solve::<S>(n, &f);
        (pn - self.tension, pt)
    }

    /// The normal and the tangential part in turns. Two rounds: the sweeps that follow do the rest, since each
    /// begins where the last one ended.
    fn alternate(&self, block: &Block<S>, f: &S::Vector) -> (f64, S::Tangent) {
        const ALTERNATIONS: usize = 2;
        let n = &self.n;
        let (mut sn, mut st) = self.start;
        for _ in 0..ALTERNATIONS {
            let (old_n, old_t) = (sn, st);
            let u = block
                .compliant
                .apply(&(*n * sn + S::tangent_vector(n, &st)))
                + *f;
            sn = (sn - (n.dot(&u) + self.shift_n) * block.iwn).max(-self.tension);
            let u = block
                .compliant
                .apply(&(*n * sn + S::tangent_vector(n, &st)))
                + *f;
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
}

/// A contact and its impulse.
#[derive(Clone, Debug)]
pub(in crate::solve) struct BlockContact<S: Space> {
    n: S::Vector,
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
    compliance: [f64; 2],
    sn: f64,
    st: S::Tangent,
}

impl<S: Space> BlockContact<S> {
    /// From its form and W_cc in world axes.
    pub fn new(contact: &ContactForm<S>, block: S::Matrix) -> Self {
        let n = contact.normal;
        let elastic = contact.elastic.unwrap_or_else(Elastic::none);
        let pulled = Block::new(block, contact, [elastic.b_n, elastic.b_t]);
        let slack = elastic
            .tension_only
            .then(|| Block::new(block, contact, [0.0, elastic.b_t]));
        Self {
            n,
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
            compliance: contact.compliance,
            sn: n.dot(&contact.impulse).max(0.0),
            st: S::Tangent::zero(),
        }
    }

    /// Whether a bond may act on it, which is a second block of unknowns in W.
    pub fn is_bonded(&self) -> bool {
        let e = &self.elastic;
        e.b_n > 0.0 || e.b_t > 0.0 || e.a_n != 0.0 || e.a_t != S::Tangent::zero()
    }

    /// What is unilateral and what rubs, at a free velocity of the block.
    fn terms(&self) -> Terms<S> {
        Terms {
            n: self.n,
            shift_n: self.shift_n,
            shift_t: self.shift_t,
            mu: self.mu,
            tension: self.tension,
            cohesion: self.cohesion,
            start: (self.sn, self.st),
        }
    }

    fn bond(&self, u: &S::Vector) -> (f64, S::Tangent) {
        let e = &self.elastic;
        let en = -(e.a_n + e.b_n * self.n.dot(u));
        let en = if e.tension_only { en.min(0.0) } else { en };
        (en, -(e.a_t + S::tangential(&self.n, u) * e.b_t))
    }

    /// Solves the contact at a relative velocity, goes `relaxation` times as far, and gives the change of its impulse.
    #[inline]
    pub fn update(&mut self, u: S::Vector, relaxation: f64) -> S::Vector {
        let (n, e) = (self.n, self.elastic);
        let f = u - self.block.apply(&self.p);
        let at = S::tangent_vector(&n, &e.a_t);
        let with = self
            .pulled
            .m
            .apply(&(f - self.block.apply(&(n * e.a_n + at))));
        let terms = self.terms();
        let (mut sn, mut st) = terms.solve(&mut self.pulled, &with);
        let mut u = self.pulled.w.apply(&(n * sn + S::tangent_vector(&n, &st))) + with;
        if let Some(slack) = &mut self.slack
            && -(e.a_n + e.b_n * n.dot(&u)) > 0.0
        {
            let without = slack.m.apply(&(f - self.block.apply(&at)));
            (sn, st) = terms.solve(slack, &without);
            u = slack.w.apply(&(n * sn + S::tangent_vector(&n, &st))) + without;
        }
        let (en, et) = self.bond(&u);
        let p = n * (sn + en) + S::tangent_vector(&n, &(st + et));
        let p = self.p + (p - self.p) * relaxation;
        let change = p - self.p;
        self.p = p;
        self.sn = sn;
        self.st = st;
        change
    }

    /// W_cc in world axes, without the bond (1/kg).
    pub fn block(&self) -> &S::Matrix {
        &self.block
    }

    /// The impulse, in world axes (N s).
    pub fn impulse(&self) -> &S::Vector {
        &self.p
    }

    /// See [`super::Row::store`].
    pub fn store(&self, out: &mut Vec<f64>) {
        for k in 0..S::D {
            out.push(self.p[k]);
        }
    }

    /// See [`super::Row::restore`].
    pub fn restore(&mut self, from: &mut &[f64]) {
        self.p = S::Vector::from_slice(&from[..S::D]);
        *from = &from[S::D..];
    }

    /// See [`super::Row::set`].
    pub fn set(&mut self, impulse: &S::Vector) {
        self.p = *impulse;
    }

    /// See [`super::Row::normal`].
    pub fn normal(&self) -> f64 {
        self.n.dot(&self.p)
    }

    /// See [`super::Row::friction`].
    pub fn friction(&self) -> f64 {
        self.mu
    }

    /// See [`super::Row::rho`].
    pub fn rho(&self) -> f64 {
        self.pulled.iwn.min(self.pulled.iwt)
    }

    /// See [`super::Row::residual`], at a relative velocity.
    pub fn residual(&self, u: &S::Vector) -> Residual {
        let n = &self.n;
        let (en, et) = self.bond(u);
        let rho = self.rho();
        let (un, ut) = (n.dot(u), S::tangential(n, u));
        if rho > 0.0 {
            let pn = n.dot(&self.p) - en;
            let pt = S::tangential(n, &self.p) - et;
            let [c_n, c_t] = self.compliance;
            natural_map(
                (pn + self.tension, pt),
                (un, ut),
                (self.shift_n + pn * c_n, self.shift_t + pt * c_t),
                rho,
                self.mu,
                self.cohesion,
            )
        } else {
            Residual::default()
        }
    }

    /// See [`super::Row::solution`], at a relative velocity.
    pub fn solution(&self, u: &S::Vector) -> ContactSolution<S> {
        let (en, et) = self.bond(u);
        ContactSolution {
            impulse: self.p,
            unilateral_n: self.n.dot(&self.p) - en,
            unilateral_t: S::tangential(&self.n, &self.p) - et,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::space::{Dim2, Dim3};

    /// Restitution lets an open contact close freely: nothing acts on it, along whatever axis its normal is.
    fn open_contact_is_free<S: Space>() {
        for axis in 0..S::D {
            let (mut normal, mut u) = (S::Vector::zero(), S::Vector::zero());
            (normal[axis], u[axis], u[0]) = (1.0, -2.0, -1.0);
            let form = ContactForm {
                bodies: [0, 1],
                normal,
                arms: [S::Vector::zero(); 2],
                central: false,
                shift_n: f64::INFINITY,
                shift_t: S::Tangent::zero(),
                friction: 0.3,
                tension: 0.0,
                cohesion: 0.0,
                elastic: None,
                compliance: [0.0; 2],
                impulse: S::Vector::zero(),
            };
            let mut contact = BlockContact::<S>::new(&form, S::Matrix::uniform(1.0));
            assert_eq!(contact.update(u, 1.0), S::Vector::zero());
            assert_eq!(contact.residual(&u).squared, 0.0);
        }
    }

    #[test]
    fn an_open_contact_with_restitution_is_free() {
        open_contact_is_free::<Dim2>();
        open_contact_is_free::<Dim3>();
    }
}
