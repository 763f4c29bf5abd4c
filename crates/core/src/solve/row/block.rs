//! A contact on a full block of W, and its impulse: without a bond, and with one. What the impulse does to the bodies is the row's part.

use super::cone::{Cone, Limits, across, compliant, framed, in_frame, times};
use super::{LocalImpulse, Residual, natural_map};
use crate::geometry::space::{MatrixLike, Space, VectorLike};
use crate::solve::form::{ContactForm, ContactSolution, Elastic};

/// A contact on a full block.
pub(in crate::solve) trait OnBlock<S: Space>:
    Clone + Send + Sync + 'static
{
    /// From its form and W_cc in world axes.
    fn new(contact: &ContactForm<S>, block: &S::Matrix) -> Self;
    /// Normal and impulse.
    fn state(&self) -> &State<S>;
    fn state_mut(&mut self) -> &mut State<S>;
    fn limits(&self) -> &Limits<S>;
    /// Solves the contact at a relative velocity, given by its normal and its tangential part, and goes `relaxation` times as far; gives
    /// the change of its impulse.
    fn update(&mut self, un: f64, ut: &S::Tangent, relaxation: f64) -> (f64, S::Tangent);
    /// The impulse of the bond at a relative velocity.
    fn bond(&self, un: f64, ut: &S::Tangent) -> (f64, S::Tangent);

    /// See [`super::Row::residual`], at a relative velocity.
    #[inline(always)]
    fn residual(&self, un: f64, ut: &S::Tangent) -> Residual {
        let (state, limits) = (self.state(), self.limits());
        if limits.rho <= 0.0 {
            return Residual::default();
        }
        let (en, et) = self.bond(un, ut);
        let (sn, st) = (state.pn - en, state.pt - et);
        let [c_n, c_t] = limits.compliance;
        natural_map(
            (sn + limits.tension, st),
            (un, *ut),
            (limits.shift_n + sn * c_n, limits.shift_t + st * c_t),
            limits.rho,
            limits.mu,
            limits.cohesion,
        )
    }

    /// See [`super::Row::yields`], at a relative velocity.
    fn yields(&self, un: f64, ut: &S::Tangent) -> f64 {
        let (state, [c_n, c_t]) = (self.state(), self.limits().compliance);
        let (en, et) = self.bond(un, ut);
        let (sn, st) = (state.pn - en, state.pt - et);
        c_n * sn * sn + c_t * st.dot(&st)
    }

    /// See [`super::Row::solution`], at a relative velocity.
    fn solution(&self, un: f64, ut: &S::Tangent) -> ContactSolution<S> {
        let state = self.state();
        let (en, et) = self.bond(un, ut);
        ContactSolution {
            impulse: state.impulse(),
            unilateral_n: state.pn - en,
            unilateral_t: state.pt - et,
        }
    }
}

/// Normal and impulse of a contact. `lanes` reads its fields in their order.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub(in crate::solve) struct State<S: Space> {
    pub n: S::Vector,
    pub pn: f64,
    pub pt: S::Tangent,
}

impl<S: Space> State<S> {
    fn new(contact: &ContactForm<S>) -> Self {
        let mut state = Self {
            n: contact.normal,
            pn: 0.0,
            pt: S::Tangent::zero(),
        };
        state.set(&contact.impulse);
        state
    }

    /// The impulse in world axes (N s).
    pub fn impulse(&self) -> S::Vector {
        self.n * self.pn + S::tangent_vector(&self.n, &self.pt)
    }

    /// See [`super::Row::set`].
    pub fn set(&mut self, impulse: &S::Vector) {
        self.pn = self.n.dot(impulse);
        self.pt = S::tangential(&self.n, impulse);
    }

    /// See [`super::Row::local_impulse`].
    #[inline(always)]
    pub fn local_impulse(&self) -> LocalImpulse<S> {
        (self.pn, self.pt)
    }

    /// See [`super::Row::set_local_impulse`].
    #[inline(always)]
    pub fn set_local_impulse(&mut self, parts: LocalImpulse<S>) {
        (self.pn, self.pt) = parts;
    }

    /// Goes `relaxation` times as far as to the impulse `p`, given in the frame; gives the change.
    #[inline(always)]
    fn go_to(&mut self, p: &S::Vector, relaxation: f64) -> (f64, S::Tangent) {
        let dn = (p[0] - self.pn) * relaxation;
        let dt = (across::<S>(&self.n, p) - self.pt) * relaxation;
        self.pn += dn;
        self.pt += dt;
        (dn, dt)
    }

    #[inline(always)]
    fn framed(&self) -> S::Vector {
        framed::<S>(&self.n, self.pn, &self.pt)
    }
}

/// A contact without a bond. `lanes` reads its fields in their order.
#[derive(Clone, Debug)]
#[repr(C)]
pub(in crate::solve) struct Loose<S: Space> {
    state: State<S>,
    cone: Cone<S>,
    limits: Limits<S>,
}

impl<S: Space> OnBlock<S> for Loose<S> {
    fn new(contact: &ContactForm<S>, block: &S::Matrix) -> Self {
        let w = in_frame::<S>(&contact.normal, block);
        Self {
            state: State::new(contact),
            cone: Cone::new(w, contact),
            limits: Limits::new(contact, &compliant::<S>(&w, contact.compliance)),
        }
    }

    #[inline(always)]
    fn state(&self) -> &State<S> {
        &self.state
    }

    fn state_mut(&mut self) -> &mut State<S> {
        &mut self.state
    }

    #[inline(always)]
    fn limits(&self) -> &Limits<S> {
        &self.limits
    }

    #[inline(always)]
    fn update(&mut self, un: f64, ut: &S::Tangent, relaxation: f64) -> (f64, S::Tangent) {
        let (u, p) = (framed::<S>(&self.state.n, un, ut), self.state.framed());
        let f = u - times::<S>(&self.cone.w, &p);
        let p = self.cone.solve(&f, &self.limits, || p);
        self.state.go_to(&p, relaxation)
    }

    #[inline(always)]
    fn bond(&self, _: f64, _: &S::Tangent) -> (f64, S::Tangent) {
        (0.0, S::Tangent::zero())
    }
}

/// The unilateral part beside a bond p_el = -(a + B u): by elimination of u, its free velocity is m f - k, with m = (1 + W B)^-1 and
/// k = m W a, and its block m W.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
struct Beside<S: Space> {
    m: S::Matrix,
    k: S::Vector,
    cone: Cone<S>,
}

impl<S: Space> Beside<S> {
    fn new(w: &S::Matrix, a: &S::Vector, [b_n, b_t]: [f64; 2], contact: &ContactForm<S>) -> Self {
        let one = S::Matrix::uniform(1.0);
        let b = compliant::<S>(&S::Matrix::uniform(0.0), [b_n, b_t]);
        let m = (one + w.times(&b)).inverse().unwrap_or(one);
        let rigid = m.times(w);
        Self {
            m,
            k: rigid.apply(a),
            cone: Cone::new(rigid, contact),
        }
    }

    fn none() -> Self {
        Self {
            m: S::Matrix::uniform(0.0),
            k: S::Vector::zero(),
            cone: Cone::none(),
        }
    }

    /// The unilateral impulse for a free velocity of both, and the velocity with both.
    #[inline(always)]
    fn solve(
        &mut self,
        f: &S::Vector,
        limits: &Limits<S>,
        start: impl Fn() -> S::Vector,
    ) -> [S::Vector; 2] {
        let f = times::<S>(&self.m, f) - self.k;
        let s = self.cone.solve(&f, limits, start);
        [s, times::<S>(&self.cone.w, &s) + f]
    }
}

/// A contact with a bond. `lanes` reads its fields in their order.
#[derive(Clone, Debug)]
#[repr(C)]
pub(in crate::solve) struct Bonded<S: Space> {
    state: State<S>,
    w: S::Matrix,
    pulled: Beside<S>,
    /// The bond's impulse at u = 0, in the frame (N s), and what it adds to that by velocity (kg).
    a: S::Vector,
    b: [f64; 2],
    /// Above it the bond's normal part does not act: 0 for a tension-only bond, otherwise infinity.
    limit: f64,
    limits: Limits<S>,
    /// Where the bond's normal part does not act.
    slack: Beside<S>,
}

impl<S: Space> Bonded<S> {
    /// Whether a bond acts on it, which is a second block of unknowns in W.
    pub fn is_bonded(&self) -> bool {
        self.b[0] > 0.0 || self.b[1] > 0.0 || self.a != S::Vector::zero()
    }

    /// The bond's impulse in the frame, pulling or not.
    #[inline(always)]
    fn pull(&self, u: &S::Vector) -> S::Vector {
        let mut out = S::Vector::zero();
        for k in 0..S::D {
            out[k] = -(self.a[k] + self.b[usize::from(k > 0)] * u[k]);
        }
        out
    }
}

impl<S: Space> OnBlock<S> for Bonded<S> {
    fn new(contact: &ContactForm<S>, block: &S::Matrix) -> Self {
        let w = in_frame::<S>(&contact.normal, block);
        let e = contact.elastic.unwrap_or_else(Elastic::none);
        let a = framed::<S>(&contact.normal, e.a_n, &e.a_t);
        let pulled = Beside::new(&w, &a, [e.b_n, e.b_t], contact);
        let slack = if e.tension_only {
            let aside = framed::<S>(&contact.normal, 0.0, &e.a_t);
            Beside::new(&w, &aside, [0.0, e.b_t], contact)
        } else {
            Beside::none()
        };
        Self {
            state: State::new(contact),
            w,
            limits: Limits::new(contact, &compliant::<S>(&pulled.cone.w, contact.compliance)),
            pulled,
            a,
            b: [e.b_n, e.b_t],
            limit: if e.tension_only { 0.0 } else { f64::INFINITY },
            slack,
        }
    }

    #[inline(always)]
    fn state(&self) -> &State<S> {
        &self.state
    }

    fn state_mut(&mut self) -> &mut State<S> {
        &mut self.state
    }

    #[inline(always)]
    fn limits(&self) -> &Limits<S> {
        &self.limits
    }

    #[inline(always)]
    fn update(&mut self, un: f64, ut: &S::Tangent, relaxation: f64) -> (f64, S::Tangent) {
        let (u, p) = (framed::<S>(&self.state.n, un, ut), self.state.framed());
        let f = u - times::<S>(&self.w, &p);
        let (limits, bond) = (self.limits, self.pull(&u));
        let start = || p - bond;
        let [mut s, mut u] = self.pulled.solve(&f, &limits, start);
        let mut e = self.pull(&u);
        if e[0] > self.limit {
            [s, u] = self.slack.solve(&f, &limits, start);
            e = self.pull(&u);
            e[0] = 0.0;
        }
        self.state.go_to(&(s + e), relaxation)
    }

    #[inline(always)]
    fn bond(&self, un: f64, ut: &S::Tangent) -> (f64, S::Tangent) {
        let en = -(self.a[0] + self.b[0] * un);
        let en = if en > self.limit { 0.0 } else { en };
        (en, -(across::<S>(&self.state.n, &self.a) + *ut * self.b[1]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::space::{Dim2, Dim3};
    use rand::{RngExt, SeedableRng};

    /// Restitution lets an open contact close freely: nothing acts on it, along whatever axis its normal is.
    fn open_contact_is_free<S: Space, C: OnBlock<S>>() {
        for axis in 0..S::D {
            let (mut normal, mut u) = (S::Vector::zero(), S::Vector::zero());
            (normal[axis], u[axis], u[0]) = (1.0, -2.0, -1.0);
            let form = ContactForm {
                normal,
                shift_n: f64::INFINITY,
                friction: 0.3,
                ..form()
            };
            let mut contact = C::new(&form, &S::Matrix::uniform(1.0));
            let (un, ut) = (normal.dot(&u), S::tangential(&normal, &u));
            let (dn, dt) = contact.update(un, &ut, 1.0);
            assert!(dn == 0.0 && dt == S::Tangent::zero());
            assert_eq!(contact.residual(un, &ut).squared, 0.0);
        }
    }

    fn form<S: Space>() -> ContactForm<S> {
        let mut normal = S::Vector::zero();
        normal[0] = 1.0;
        ContactForm {
            bodies: [0, 1],
            normal,
            arms: [S::Vector::zero(); 2],
            central: false,
            apart: false,
            shift_n: 0.0,
            shift_t: S::Tangent::zero(),
            friction: 0.0,
            tension: 0.0,
            cohesion: 0.0,
            elastic: None,
            compliance: [0.0; 2],
            impulse: S::Vector::zero(),
        }
    }

    #[test]
    fn an_open_contact_with_restitution_is_free() {
        open_contact_is_free::<Dim2, Loose<Dim2>>();
        open_contact_is_free::<Dim3, Loose<Dim3>>();
        open_contact_is_free::<Dim2, Bonded<Dim2>>();
        open_contact_is_free::<Dim3, Bonded<Dim3>>();
    }

    /// The impulse of one update solves the law of the natural map, with and without a bond, tension, cohesion, compliance and shifts:
    /// in the plane at once, in space with cohesion after some.
    fn solves<S: Space, C: OnBlock<S>>(bonded: bool) {
        let mut rng = rand_pcg::Pcg64::seed_from_u64(7);
        let mut worst = 0.0f64;
        let mut kinds = [0; 3];
        for case in 0..2000 {
            let mut x = |low: f64, high: f64| rng.random_range(low..high);
            let mut vector = || {
                let mut v = S::Vector::zero();
                for k in 0..S::D {
                    v[k] = x(-1.0, 1.0);
                }
                v
            };
            let (normal, u, columns) = (vector(), vector(), [vector(), vector(), vector()]);
            let normal = normal * (1.0 / normal.norm());
            let mut w = S::Matrix::uniform(0.3);
            for c in &columns {
                w = w + S::Matrix::dyad(c, c);
            }
            let cohesive = case % 2 == 0;
            let elastic = Elastic {
                a_n: x(-0.5, 0.5),
                a_t: S::tangential(&normal, &columns[0]) * 0.3,
                b_n: x(0.0, 1.0),
                b_t: x(0.0, 1.0),
                tension_only: case % 3 == 0,
                damped: false,
                loss_n: 0.0,
                curved: false,
                loss_t: 0.0,
            };
            let form = ContactForm {
                normal,
                friction: x(0.0, 0.5),
                shift_n: x(-0.3, 0.3),
                shift_t: S::tangential(&normal, &columns[1]) * 0.2,
                tension: if case % 5 == 0 { x(0.0, 0.5) } else { 0.0 },
                cohesion: if cohesive { x(0.0, 0.5) } else { 0.0 },
                compliance: if case % 7 < 3 {
                    [x(0.0, 0.5), x(0.0, 0.5)]
                } else {
                    [0.0; 2]
                },
                elastic: bonded.then_some(elastic),
                impulse: columns[2],
                ..form()
            };
            let free = u - w.apply(&form.impulse);
            let mut contact = C::new(&form, &w);
            let mut p = form.impulse;
            let rounds = if S::D == 3 && cohesive { 2000 } else { 1 };
            for _ in 0..rounds {
                let u = free + w.apply(&p);
                let (un, ut) = (normal.dot(&u), S::tangential(&normal, &u));
                let (dn, dt) = contact.update(un, &ut, 1.0);
                p += normal * dn + S::tangent_vector(&normal, &dt);
            }
            let u = free + w.apply(&p);
            let (un, ut) = (normal.dot(&u), S::tangential(&normal, &u));
            let squared = contact.residual(un, &ut).squared;
            worst = worst.max(squared.sqrt());
            let solution = contact.solution(un, &ut);
            let pn = solution.unilateral_n + form.tension;
            let bound = form.friction * pn + form.cohesion;
            let kind = if pn <= 1e-12 {
                0
            } else if solution.unilateral_t.norm() < bound * (1.0 - 1e-9) {
                1
            } else {
                2
            };
            kinds[kind] += 1;
        }
        assert!(worst < 1e-9, "{worst:e}");
        assert!(kinds.iter().all(|k| *k > 50), "{kinds:?}");
    }

    #[test]
    fn one_contact_is_solved_exactly() {
        solves::<Dim2, Loose<Dim2>>(false);
        solves::<Dim3, Loose<Dim3>>(false);
        solves::<Dim2, Bonded<Dim2>>(true);
        solves::<Dim3, Bonded<Dim3>>(true);
    }
}
