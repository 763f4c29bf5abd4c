//! A contact with lever arms, or of a body that is free along some axes only: a full block of W.

use super::block::OnBlock;
use super::{LocalImpulse, Residual, Row, SolverBody};
use crate::geometry::space::{MatrixLike, Space, VectorLike};
use crate::solve::form::{ContactForm, ContactSolution, Mobility};

/// How an impulse moves the two bodies. `lanes` reads its fields in their order.
#[derive(Clone, Debug)]
#[repr(C)]
pub(super) struct Levers<S: Space> {
    /// Arms over the lengths of the bodies.
    arms: [S::Vector; 2],
    inverse_masses: [S::Vector; 2],
    /// Inverse inertia times the lengths squared (1/kg).
    inverse_spins: [S::Tensor; 2],
}

/// See the module; `C` is the law with its impulse. `lanes` reads its fields in their order.
#[derive(Clone, Debug)]
#[repr(C)]
pub(in crate::solve) struct LeverRow<S: Space, C> {
    contact: C,
    levers: Levers<S>,
    bodies: [u32; 2],
}

impl<S: Space, C: OnBlock<S>> LeverRow<S, C> {
    pub fn new(contact: &ContactForm<S>, inertia: impl Fn(usize) -> (Mobility<S>, f64)) -> Self {
        let [i, j] = contact.bodies.map(|b| inertia(b as usize));
        let mut block = S::Matrix::diagonal(&S::Vector::zero());
        for ((mobility, _), arm) in [&i, &j].into_iter().zip(&contact.arms) {
            let turning = S::rotation_block(arm, &mobility.inertia);
            block = block + S::Matrix::diagonal(&mobility.mass) + turning;
        }
        Self {
            contact: C::new(contact, &block),
            levers: Levers {
                arms: [contact.arms[0] * (1.0 / i.1), contact.arms[1] * (1.0 / j.1)],
                inverse_masses: [i.0.mass, j.0.mass],
                inverse_spins: [i, j].map(|(m, length)| m.inertia.scaled(length).scaled(length)),
            },
            bodies: contact.bodies,
        }
    }

    /// Returns a row of a contact between immovable bodies.
    #[cfg(target_arch = "x86_64")]
    pub(super) fn idle() -> Self {
        let fixed = Mobility {
            mass: S::Vector::zero(),
            inertia: S::Tensor::uniform(0.0),
        };
        Self::new(&ContactForm::idle(), |_| (fixed, 1.0))
    }
}

impl<S: Space> Levers<S> {
    #[inline(always)]
    fn relative(&self, n: &S::Vector, a: &SolverBody<S>, b: &SolverBody<S>) -> (f64, S::Tangent) {
        let [i, j] = &self.arms;
        let u = a.v + S::spin_velocity(&a.s, i) - b.v - S::spin_velocity(&b.s, j);
        (n.dot(&u), S::tangential(n, &u))
    }

    #[inline(always)]
    fn push(&self, p: &S::Vector, a: &mut SolverBody<S>, b: &mut SolverBody<S>) {
        a.v += p.scaled_by(&self.inverse_masses[0]);
        b.v -= p.scaled_by(&self.inverse_masses[1]);
        a.s += self.inverse_spins[0].apply(&S::moment(&self.arms[0], p));
        b.s -= self.inverse_spins[1].apply(&S::moment(&self.arms[1], p));
    }
}

impl<S: Space, C: OnBlock<S>> Row<S> for LeverRow<S, C> {
    #[inline(always)]
    fn bodies(&self) -> [u32; 2] {
        self.bodies
    }

    #[inline(always)]
    fn update(&mut self, a: &mut SolverBody<S>, b: &mut SolverBody<S>, relaxation: f64) {
        let n = self.contact.state().n;
        let (un, ut) = self.levers.relative(&n, a, b);
        let (dn, dt) = self.contact.update(un, &ut, relaxation);
        self.levers
            .push(&(n * dn + S::tangent_vector(&n, &dt)), a, b);
    }

    fn load(&self, a: &mut SolverBody<S>, b: &mut SolverBody<S>) {
        self.levers.push(&self.contact.state().impulse(), a, b);
    }

    #[inline(always)]
    fn local_impulse(&self) -> LocalImpulse<S> {
        self.contact.state().local_impulse()
    }

    #[inline(always)]
    fn set_local_impulse(&mut self, parts: LocalImpulse<S>) {
        self.contact.state_mut().set_local_impulse(parts);
    }

    fn set(&mut self, impulse: &S::Vector) {
        self.contact.state_mut().set(impulse);
    }

    fn speed(&self, a: &SolverBody<S>, b: &SolverBody<S>) -> f64 {
        let (un, ut) = self.levers.relative(&self.contact.state().n, a, b);
        un * un + ut.dot(&ut)
    }

    fn friction(&self) -> f64 {
        self.contact.limits().mu
    }

    fn rho(&self) -> f64 {
        self.contact.limits().rho
    }

    fn residual(&self, a: &SolverBody<S>, b: &SolverBody<S>) -> Residual {
        let (un, ut) = self.levers.relative(&self.contact.state().n, a, b);
        self.contact.residual(un, &ut)
    }

    fn yields(&self, a: &SolverBody<S>, b: &SolverBody<S>) -> f64 {
        let (un, ut) = self.levers.relative(&self.contact.state().n, a, b);
        self.contact.yields(un, &ut)
    }

    fn solution(&self, a: &SolverBody<S>, b: &SolverBody<S>) -> ContactSolution<S> {
        let (un, ut) = self.levers.relative(&self.contact.state().n, a, b);
        self.contact.solution(un, &ut)
    }
}
