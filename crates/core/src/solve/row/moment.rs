//! Moments of a contact: rolling and spinning friction, and the bending and twist of a bond.
//!
//! M = M_sc + M_el, dual to the relative spin w = w_i - w_j: M_el = -(a + B w) as for impulses, and
//! M_sc opposes w with |M_sc| <= (friction length) p_n, separately for bending and twist.

use super::response::inverse;
use super::solver_bodies::SolverBody;
use super::system::Term;
use crate::geometry::space::{MatrixLike, Space, VectorLike};
use crate::solve::error::Residual;
use crate::solve::form::{Mobility, RowPlace};
use crate::solve::nodal::NodalSystem;

/// Resistance of a contact to rotation. Moments over the step are in N m s.
#[derive(Clone, Copy, Debug)]
pub struct MomentForm<S: Space> {
    /// Index of the contact, as pushed.
    pub contact: u32,
    /// Rolling friction length (m): |M_bend| <= rolling p_n.
    pub rolling: f64,
    /// Spinning friction length (m): |M_twist| <= spinning p_n.
    pub spinning: f64,
    /// Moment of the bond at w = 0, twist and bending together (N m s).
    pub a: S::Spin,
    /// Twisting stiffness over the step (N m s^2).
    pub b_twist: f64,
    /// Bending stiffness over the step (N m s^2).
    pub b_bend: f64,
    /// Dissipation of the time scheme beyond the change of the stored energy: loss_twist w_n^2 +
    /// loss_bend
    /// |w_t|^2 (J s^2).
    pub loss_twist: f64,
    /// Dissipation of bending, see `loss_twist`.
    pub loss_bend: f64,
    /// Initial moment (N m s).
    pub moment: S::Spin,
}

/// Solution of the moments of one contact.
#[derive(Clone, Copy, Debug)]
pub struct MomentSolution<S: Space> {
    /// The contact, as pushed.
    pub contact: u32,
    /// Total moment on the candidate (N m s).
    pub moment: S::Spin,
    /// Part of the moment due to friction.
    pub friction: S::Spin,
}

#[derive(Clone, Debug)]
pub(in crate::solve) struct MomentRow<S: Space> {
    pub form: MomentForm<S>,
    /// Location of the contact's normal impulse; set when the rows are sorted.
    pub place: RowPlace,
    pub bodies: [u32; 2],
    n: S::Vector,
    /// Inverse lengths of the bodies (1/m); 0 for the body of a dynamical system.
    over: [f64; 2],
    /// Nodes of systems that represent rotation: their velocity times the weight (1/m) is a spin,
    /// and the moment times the weight is the impulse on them.
    terms: Vec<Term>,
    /// Inverse inertias times the lengths (1/(kg m)).
    inverse_spins: [S::Tensor; 2],
    /// Relative spin due to a unit moment; the largest one for anisotropic inertia.
    w: f64,
    iw: f64,
    lever: f64,
    moment: S::Spin,
}

impl<S: Space> MomentRow<S> {
    pub fn new(
        form: &MomentForm<S>,
        place: RowPlace,
        bodies: [u32; 2],
        n: S::Vector,
        mobilities: [&Mobility<S>; 2],
        lengths: [f64; 2],
    ) -> Self {
        let w = mobilities[0].largest_inverse_inertia() + mobilities[1].largest_inverse_inertia();
        Self {
            form: *form,
            place,
            bodies,
            n,
            over: lengths.map(|l| 1.0 / l),
            terms: Vec::new(),
            inverse_spins: std::array::from_fn(|k| mobilities[k].inertia.scaled(lengths[k])),
            w,
            iw: inverse(w),
            lever: lengths[0].min(lengths[1]),
            moment: form.moment,
        }
    }

    /// Returns the row with systems on these sides, by the nodes that represent rotation: their
    /// bodies have no spin of their own.
    pub fn with_systems(mut self, nodes: [Option<Term>; 2], systems: &[NodalSystem<S>]) -> Self {
        for (side, term) in nodes.into_iter().enumerate() {
            let Some(term) = term else { continue };
            self.over[side] = 0.0;
            let block = systems[term.system as usize].block(term.node, term.node);
            let row = |i: usize| {
                (0..S::Spin::N)
                    .map(|j| block.entry(i, j).abs())
                    .sum::<f64>()
            };
            let quickest = (0..S::Spin::N).map(row).fold(0.0, f64::max);
            self.w += quickest * term.weight * term.weight;
            self.terms.push(term);
        }
        self.iw = inverse(self.w);
        self
    }

    /// Whether a moment turns anything.
    pub fn turns(&self) -> bool {
        self.iw > 0.0
    }

    /// Returns the nodes on which the moment acts.
    pub fn terms(&self) -> &[Term] {
        &self.terms
    }

    /// Adds the moment to the impulses on the nodes of the systems, by system.
    pub fn add_impulses(&self, impulses: &mut [Vec<S::Vector>]) {
        for term in &self.terms {
            impulses[term.system as usize][term.node as usize] +=
                turning::<S>(&self.moment) * term.weight;
        }
    }

    fn relative(
        &self,
        a: &SolverBody<S>,
        b: &SolverBody<S>,
        systems: &[NodalSystem<S>],
    ) -> S::Spin {
        let mut spin = a.s * self.over[0] - b.s * self.over[1];
        for term in &self.terms {
            let v = systems[term.system as usize].velocity(term.node);
            for k in 0..S::Spin::N {
                spin[k] += v[k] * term.weight;
            }
        }
        spin
    }

    fn push(
        &self,
        moment: &S::Spin,
        a: &mut SolverBody<S>,
        b: &mut SolverBody<S>,
        systems: &mut [NodalSystem<S>],
    ) {
        self.turn(moment, a, b);
        for term in &self.terms {
            let impulse = turning::<S>(moment) * term.weight;
            systems[term.system as usize].push(term.node, &impulse);
        }
    }

    /// Adds the effect of a moment to the spins of rigid bodies.
    fn turn(&self, moment: &S::Spin, a: &mut SolverBody<S>, b: &mut SolverBody<S>) {
        a.s += self.inverse_spins[0].apply(moment);
        b.s -= self.inverse_spins[1].apply(moment);
    }

    /// Solves for the current spins under the normal impulse `pn`. Where nothing can rotate the
    /// spin is given, and friction against it is at its bound.
    pub fn update(
        &mut self,
        pn: f64,
        a: &mut SolverBody<S>,
        b: &mut SolverBody<S>,
        systems: &mut [NodalSystem<S>],
        relaxation: f64,
    ) {
        let form = &self.form;
        let pn = pn.max(0.0);
        let f = self.relative(a, b, systems) - self.moment * self.w;
        let (f_twist, f_bend) = S::split_spin(&self.n, &f);
        let (a_twist, a_bend) = S::split_spin(&self.n, &form.a);
        let bound = form.spinning * pn;
        let twist = if self.turns() {
            (a_twist - f_twist * self.iw).clamp(-bound, bound)
        } else {
            -bound * sign(f_twist)
        };
        let pull = a_twist + form.b_twist * (self.w * twist + f_twist);
        let twist = twist - pull / (1.0 + self.w * form.b_twist);
        let bound = form.rolling * pn;
        let bend = if self.turns() {
            (a_bend - f_bend * self.iw).limited(bound)
        } else {
            against(&f_bend, bound)
        };
        let pull = a_bend + (bend * self.w + f_bend) * form.b_bend;
        let bend = bend - pull * (1.0 / (1.0 + self.w * form.b_bend));
        let change = (S::spin_about(&self.n, twist) + bend - self.moment) * relaxation;
        self.push(&change, a, b, systems);
        self.moment += change;
    }

    pub fn store(&self, out: &mut Vec<f64>) {
        for k in 0..S::Spin::N {
            out.push(self.moment[k]);
        }
    }

    pub fn restore(&mut self, from: &mut &[f64]) {
        self.moment = S::Spin::from_slice(&from[..S::Spin::N]);
        *from = &from[S::Spin::N..];
    }

    pub fn moment(&self) -> S::Spin {
        self.moment
    }

    pub fn set(&mut self, moment: &S::Spin) {
        self.moment = *moment;
    }

    /// Adds the effect of the stored moment to the velocities; velocities of nodes are valid once
    /// their systems are settled.
    pub fn load(
        &self,
        a: &mut SolverBody<S>,
        b: &mut SolverBody<S>,
        systems: &mut [NodalSystem<S>],
    ) {
        self.turn(&self.moment, a, b);
        for term in &self.terms {
            let impulse = turning::<S>(&self.moment) * term.weight;
            systems[term.system as usize].load(term.node, &impulse);
        }
    }

    /// Returns the bond's moment at a relative spin.
    fn bond(&self, w: &S::Spin) -> S::Spin {
        let form = &self.form;
        let (twist, bend) = S::split_spin(&self.n, w);
        -(form.a + S::spin_about(&self.n, twist * form.b_twist) + bend * form.b_bend)
    }

    /// Computes the natural map times a lever arm, as a velocity.
    pub fn residual(
        &self,
        pn: f64,
        a: &SolverBody<S>,
        b: &SolverBody<S>,
        systems: &[NodalSystem<S>],
    ) -> Residual {
        if self.iw == 0.0 {
            return Residual::default();
        }
        let pn = pn.max(0.0);
        let w = self.relative(a, b, systems);
        let shifted = self.moment - self.bond(&w);
        let rho = self.iw + self.form.b_twist.min(self.form.b_bend);
        let (twist, bend) = S::split_spin(&self.n, &(shifted - w * rho));
        let bound = self.form.spinning * pn;
        let to = S::spin_about(&self.n, twist.clamp(-bound, bound))
            + bend.limited(self.form.rolling * pn);
        let r = (shifted - to) * (1.0 / rho);
        let over = self.lever / rho;
        Residual {
            squared: r.dot(&r) * self.lever * self.lever,
            velocity: w.dot(&w) * self.lever * self.lever,
            impulse: shifted.dot(&shifted) * over * over,
            power: shifted.dot(&r),
            unbalanced: shifted.dot(&r).abs().max(rho * r.dot(&r)),
            slip: shifted.dot(&w).abs(),
        }
    }

    pub fn solution(
        &self,
        a: &SolverBody<S>,
        b: &SolverBody<S>,
        systems: &[NodalSystem<S>],
    ) -> MomentSolution<S> {
        MomentSolution {
            contact: self.form.contact,
            moment: self.moment,
            friction: self.moment - self.bond(&self.relative(a, b, systems)),
        }
    }
}

/// Returns the sign of a spin, 0 for zero spin.
fn sign(spin: f64) -> f64 {
    if spin == 0.0 { 0.0 } else { spin.signum() }
}

/// Returns the moment of magnitude `bound` against a given spin; zero where nothing rotates.
fn against<T: VectorLike>(spin: &T, bound: f64) -> T {
    let size = spin.norm();
    if size > 0.0 {
        *spin * (-bound / size)
    } else {
        T::zero()
    }
}

/// Returns a moment as the impulse on a node that represents rotation, see
/// [`crate::bodies::DynamicalSystem::turning_node`].
pub(in crate::solve) fn turning<S: Space>(spin: &S::Spin) -> S::Vector {
    let mut out = S::Vector::zero();
    for k in 0..S::Spin::N {
        out[k] = spin[k];
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::space::Dim2;
    use crate::solve::Problem;
    use nalgebra::{Matrix1, Vector1, Vector2};

    /// Without rolling friction and bond a moment of 2 N m s is a residual: with W of 1/4 + 1/16 it
    /// causes a spin of w = 5/8 rad/s, which is a velocity over the shorter length of 1/2 m. The
    /// bodies rotate at 3 rad/s relative to each other.
    #[test]
    fn residuals_of_moments_are_velocities_at_the_shorter_length() {
        let mut problem = Problem::<Dim2>::default();
        let mobility = |inertia| Mobility::<Dim2> {
            mass: Vector2::repeat(1.0),
            inertia: Matrix1::new(inertia),
        };
        let inertias = [0.25, 0.0625];
        let lengths = [0.5, 2.0];
        for ((inertia, length), spin) in inertias.iter().zip(lengths).zip([2.0, -1.0]) {
            let Mobility { mass, inertia } = mobility(*inertia);
            problem.push_body(Vector2::zeros(), Vector1::new(spin), mass, inertia, length);
        }
        let form = MomentForm {
            contact: 0,
            rolling: 0.0,
            spinning: 0.0,
            a: Vector1::new(0.0),
            b_twist: 0.0,
            b_bend: 0.0,
            loss_twist: 0.0,
            loss_bend: 0.0,
            moment: Vector1::new(2.0),
        };
        let [a, b] = inertias.map(mobility);
        let normal = Vector2::new(0.0, 1.0);
        let row = MomentRow::<Dim2>::new(
            &form,
            RowPlace::Row { kind: 0, row: 0 },
            [0, 1],
            normal,
            [&a, &b],
            lengths,
        );
        let bodies = &problem.solver_bodies;
        let found = row.residual(1.0, &bodies[0], &bodies[1], &[]);
        let near = |a: f64, b: f64| (a - b).abs() < 1e-14;
        assert!(near(found.velocity, 9.0 * 0.25), "{}", found.velocity);
        let turned = 2.0 * 0.3125;
        assert!(
            near(found.impulse, turned * turned * 0.25),
            "{}",
            found.impulse
        );
        assert!(
            near(found.squared, turned * turned * 0.25),
            "{}",
            found.squared
        );
        assert!(near(found.slip, 6.0), "{}", found.slip);
    }
}
