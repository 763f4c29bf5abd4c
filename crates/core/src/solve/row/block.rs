//! The law of a contact on a full block of W: without a bond, and with one.

use super::cone::{Axes, Cone, compliant, in_frame};
use super::kind::RowKind;
use super::law::{LawLimits, RowLaw};
use super::motion::Levers;
use super::rigid_bodies::RigidBodies;
use super::state::{Parts, RowState};
use crate::geometry::lane_space::{lanes_of, matrix_lanes_of};
use crate::geometry::space::{MatrixLike, Space};
use crate::lanes::{Batch, BatchMut, Lane, LaneMatrix, LaneVector, Mask, part, part_mut, record};
use crate::solve::form::{ContactForm, Elastic};

/// Moves towards the impulse `p` by the factor `relaxation`; returns the change.
#[inline(always)]
fn go_to<S: Space, L: Lane>(
    state: &mut RowState<S, L>,
    p: Parts<S, L>,
    relaxation: L,
) -> Parts<S, L> {
    let change = (p - state.p) * relaxation;
    state.p = state.p + change;
    change
}

/// A contact without a bond.
#[derive(Clone, Debug)]
#[repr(C)]
pub(in crate::solve) struct Unbonded<S: Space> {
    limits: LawLimits<S>,
    cone: Cone<S>,
}

impl<S: Space> Unbonded<S> {
    /// Creates the law from W_cc in world axes.
    fn of(contact: &ContactForm<S>, block: &S::Matrix) -> Self {
        let w = in_frame::<S>(&contact.normal, block);
        Self {
            cone: Cone::new(w, contact),
            limits: LawLimits::on_block(contact, &compliant::<S>(&w, contact.compliance)),
        }
    }
}

impl<S: Space> RowLaw<S> for Unbonded<S> {
    #[inline(always)]
    fn solve<L: Lane>(
        mut law: BatchMut<Self, L>,
        state: &mut RowState<S, L>,
        u: Parts<S, L>,
        relaxation: L,
    ) -> Parts<S, L> {
        let (cone, limits) = (part!(law, cone).read(), part!(law, limits).read());
        let axes = Axes::new(&state.n);
        let p = axes.vector(&state.p);
        let f = axes.vector(&u) - cone.w.times(&p);
        let every = L::all(0.0).at_most(L::all(0.0));
        let stored = part_mut!(law, cone);
        let p = Cone::solve(&cone, stored, &f, &limits, every, &p);
        go_to(state, axes.parts(&p), relaxation)
    }

    #[inline(always)]
    fn limits<L: Lane>(law: Batch<Self, L>) -> LawLimits<S, L> {
        part!(law, limits).read()
    }
}

impl<S: Space> RowKind<S> for Unbonded<S> {
    type Motion = Levers<S>;
    const BONDS: bool = false;

    fn serves(contact: &ContactForm<S>) -> bool {
        contact.elastic.is_none()
    }

    fn new(contact: &ContactForm<S>, bodies: &RigidBodies<S>) -> (Self, Levers<S>) {
        let (levers, block) = bodies.levers(contact);
        (Self::of(contact, &block), levers)
    }
}

/// The unilateral part in parallel with a bond p_el = -(a + B u): by elimination of u, its free
/// velocity is m f - k, with m = (1 + W B)^-1 and k = m W a, and its block is m W.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
struct UnilateralPart<S: Space, L: Lane = f64> {
    m: S::M<L>,
    k: S::V<L>,
    cone: Cone<S, L>,
}
record!(UnilateralPart);

impl<S: Space> UnilateralPart<S> {
    /// Gives the block m W, too.
    fn new(
        w: &S::Matrix,
        a: &S::V<f64>,
        [b_n, b_t]: [f64; 2],
        contact: &ContactForm<S>,
    ) -> (Self, S::Matrix) {
        let one = S::Matrix::uniform(1.0);
        let b = compliant::<S>(&S::Matrix::uniform(0.0), [b_n, b_t]);
        let m = (one + w.times(&b)).inverse().unwrap_or(one);
        let rigid = m.times(w);
        let adjacent = Self {
            m: matrix_lanes_of(&m),
            k: matrix_lanes_of::<f64, S::M<f64>>(&rigid).times(a),
            cone: Cone::new(rigid, contact),
        };
        (adjacent, rigid)
    }

    fn none() -> Self {
        Self {
            m: <S::M<f64>>::zero(),
            k: <S::V<f64>>::zero(),
            cone: Cone::none(),
        }
    }

    /// Returns the unilateral impulses for free velocities that include the bond, and the resulting
    /// velocities, of the contacts in `active`.
    #[inline(always)]
    fn solve<L: Lane>(
        mut stored: BatchMut<Self, L>,
        f: &S::V<L>,
        limits: &LawLimits<S, L>,
        active: L::Mask,
        start: &S::V<L>,
    ) -> [S::V<L>; 2] {
        let adjacent = stored.read();
        let f = adjacent.m.times(f) - adjacent.k;
        let stored = part_mut!(stored, cone);
        let s = Cone::solve(&adjacent.cone, stored, &f, limits, active, start);
        [s, adjacent.cone.w.times(&s) + f]
    }
}

/// W_cc, and the impulse of a bond, in the frame.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
struct ElasticPart<S: Space, L: Lane = f64> {
    w: S::M<L>,
    /// Impulse at u = 0 (N s).
    a: S::V<L>,
    /// Additional impulse per velocity (kg).
    b: [L; 2],
    /// Threshold above which the bond's normal part is inactive: 0 for a tension-only bond,
    /// otherwise infinity.
    limit: L,
}
record!(ElasticPart);

impl<S: Space, L: Lane> ElasticPart<S, L> {
    /// Returns the impulse of the bond, in tension or compression.
    #[inline(always)]
    fn pull(&self, u: &S::V<L>) -> S::V<L> {
        <S::V<L>>::from_fn(|k| -(self.a[k] + self.b[usize::from(k > 0)] * u[k]))
    }
}

/// A contact with a bond.
#[derive(Clone, Debug)]
#[repr(C)]
pub(in crate::solve) struct Bonded<S: Space> {
    limits: LawLimits<S>,
    pulled: UnilateralPart<S>,
    /// Part without the bond's normal component.
    slack: UnilateralPart<S>,
    bond: ElasticPart<S>,
}

impl<S: Space> Bonded<S> {
    /// Creates the law from W_cc in world axes.
    pub fn of(contact: &ContactForm<S>, block: &S::Matrix) -> Self {
        let w = in_frame::<S>(&contact.normal, block);
        let e = contact.elastic.unwrap_or_else(Elastic::none);
        let axes = Axes::<S, f64>::new(&lanes_of(&contact.normal));
        let pull = |n| {
            let t = lanes_of(&e.a_t);
            axes.vector(&Parts { n, t })
        };
        let a = pull(e.a_n);
        let (pulled, rigid) = UnilateralPart::new(&w, &a, [e.b_n, e.b_t], contact);
        let slack = if e.tension_only {
            UnilateralPart::new(&w, &pull(0.0), [0.0, e.b_t], contact).0
        } else {
            UnilateralPart::none()
        };
        Self {
            limits: LawLimits::on_block(contact, &compliant::<S>(&rigid, contact.compliance)),
            pulled,
            bond: ElasticPart {
                w: matrix_lanes_of(&w),
                a,
                b: [e.b_n, e.b_t],
                limit: if e.tension_only { 0.0 } else { f64::INFINITY },
            },
            slack,
        }
    }

    /// Returns whether a bond acts on the contact, which is a second block of unknowns in W.
    pub fn is_bonded(&self) -> bool {
        let ElasticPart { a, b, .. } = &self.bond;
        b[0] > 0.0 || b[1] > 0.0 || (0..S::D).any(|k| a[k] != 0.0)
    }
}

impl<S: Space> RowLaw<S> for Bonded<S> {
    #[inline(always)]
    fn solve<L: Lane>(
        mut law: BatchMut<Self, L>,
        state: &mut RowState<S, L>,
        u: Parts<S, L>,
        relaxation: L,
    ) -> Parts<S, L> {
        let axes = Axes::new(&state.n);
        let (u, p) = (axes.vector(&u), axes.vector(&state.p));
        let (limits, bond) = (part!(law, limits).read(), part!(law, bond).read());
        let f = u - bond.w.times(&p);
        let start = p - bond.pull(&u);
        let zero = L::all(0.0);
        let every = zero.at_most(zero);
        let pulled = part_mut!(law, pulled);
        let [mut s, with] = UnilateralPart::solve(pulled, &f, &limits, every, &start);
        let mut e = bond.pull(&with);
        let slack = e[0].above(bond.limit);
        if slack.any() {
            let [without, with] = {
                let stored = part_mut!(law, slack);
                UnilateralPart::solve(stored, &f, &limits, slack, &start)
            };
            let mut aside = bond.pull(&with);
            aside[0] = zero;
            s = <S::V<L>>::select(slack, without, s);
            e = <S::V<L>>::select(slack, aside, e);
        }
        go_to(state, axes.parts(&(s + e)), relaxation)
    }

    #[inline(always)]
    fn limits<L: Lane>(law: Batch<Self, L>) -> LawLimits<S, L> {
        part!(law, limits).read()
    }

    #[inline(always)]
    fn bond<L: Lane>(law: Batch<Self, L>, n: &S::V<L>, u: &Parts<S, L>) -> Parts<S, L> {
        let bond = part!(law, bond).read();
        let en = -(bond.a[0] + bond.b[0] * u.n);
        let a = Axes::<S, L>::new(n).parts(&bond.a);
        Parts {
            n: L::select(en.above(bond.limit), L::all(0.0), en),
            t: -(a.t + u.t * bond.b[1]),
        }
    }
}

impl<S: Space> RowKind<S> for Bonded<S> {
    type Motion = Levers<S>;
    const BONDS: bool = true;

    fn serves(_: &ContactForm<S>) -> bool {
        true
    }

    fn new(contact: &ContactForm<S>, bodies: &RigidBodies<S>) -> (Self, Levers<S>) {
        let (levers, block) = bodies.levers(contact);
        (Self::of(contact, &block), levers)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::lane_space::vector_of;
    use crate::geometry::space::{Dim2, Dim3, VectorLike};
    use rand::{RngExt, SeedableRng};

    type Made<S, C> = fn(&ContactForm<S>, &<S as Space>::Matrix) -> C;

    /// An open contact with restitution closes freely: no impulse acts on it, for any direction of
    /// its normal.
    fn open_contact_is_free<S: Space, C: RowLaw<S>>(of: Made<S, C>) {
        for axis in 0..S::D {
            let (mut normal, mut u) = (S::Vector::zero(), S::Vector::zero());
            (normal[axis], u[axis], u[0]) = (1.0, -2.0, -1.0);
            let form = ContactForm {
                normal,
                shift_n: f64::INFINITY,
                friction: 0.3,
                ..form()
            };
            let mut law = of(&form, &S::Matrix::uniform(1.0));
            let mut state = RowState::new(&normal, &form.impulse);
            let u = Parts::of(&state.n, &lanes_of(&u));
            let change = C::solve(BatchMut::one(&mut law), &mut state, u, 1.0);
            assert!(change.dot(&change) == 0.0);
            assert_eq!(C::residual(Batch::one(&law), &state, &u).squared, 0.0);
        }
    }

    fn form<S: Space>() -> ContactForm<S> {
        let mut normal = S::Vector::zero();
        normal[0] = 1.0;
        ContactForm {
            normal,
            arms: [S::Vector::zero(); 2],
            central: false,
            ..ContactForm::default()
        }
    }

    #[test]
    fn an_open_contact_with_restitution_is_free() {
        open_contact_is_free::<Dim2, _>(Unbonded::of);
        open_contact_is_free::<Dim3, _>(Unbonded::of);
        open_contact_is_free::<Dim2, _>(Bonded::of);
        open_contact_is_free::<Dim3, _>(Bonded::of);
    }

    /// The impulse of one update satisfies the natural map, with and without bond, tension,
    /// cohesion, compliance and shifts: at once in the plane, after several updates in space with
    /// cohesion.
    fn solves<S: Space, C: RowLaw<S>>(of: Made<S, C>, bonded: bool) {
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
            let mut law = of(&form, &w);
            let mut state = RowState::new(&normal, &form.impulse);
            let n = state.n;
            let relative = |p: &S::Vector| Parts::of(&n, &lanes_of(&(free + w.apply(p))));
            let mut p = form.impulse;
            let rounds = if S::D == 3 && cohesive { 2000 } else { 1 };
            for _ in 0..rounds {
                let change = C::solve(BatchMut::one(&mut law), &mut state, relative(&p), 1.0);
                p += vector_of(&change.joined(&state.n));
            }
            let u = relative(&p);
            let squared = C::residual(Batch::one(&law), &state, &u).squared;
            worst = worst.max(squared.sqrt());
            let solution = law.solution(&state, &u);
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
        solves::<Dim2, _>(Unbonded::of, false);
        solves::<Dim3, _>(Unbonded::of, false);
        solves::<Dim2, _>(Bonded::of, true);
        solves::<Dim3, _>(Bonded::of, true);
    }
}
