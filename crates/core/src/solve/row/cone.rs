//! The unilateral law of a contact on a full block of W, in the frame (n, t1, t2) of the contact:
//! Coulomb's friction with tensile strength and shear cohesion. In the plane it is solved in closed
//! form, in space by Newton's method where it slides.

use super::law::LawLimits;
use super::response::{answer_to_slip, inverse, inverse_along, shift_along};
use super::state::Parts;
use crate::geometry::lane_space::{lanes_of, matrix_lanes_of};
use crate::geometry::space::{MatrixLike, Space, VectorLike, least};
use crate::lanes::{BatchMut, Lane, LaneMatrix, LaneVector, Mask, part_mut, record};
use crate::solve::form::ContactForm;
use crate::solve::local::contact::Local;
use crate::solve::slide::slide;

impl<S: Space> LawLimits<S> {
    /// Creates the cone from a form whose block, with an acting bond and the compliance, is
    /// `compliant` in the frame of the contact.
    pub(super) fn on_block(contact: &ContactForm<S>, compliant: &S::Matrix) -> Self {
        let (w_n, w_t) = (compliant.entry(0, 0), largest_tangential::<S>(compliant));
        let rho = if w_n > 0.0 {
            least(inverse(w_n), inverse_along(w_t, w_n))
        } else {
            inverse(w_t)
        };
        // A contact between immovable bodies that moves by its compliance alone is exact after one
        // visit.
        let held = [w_n, w_t] == contact.compliance;
        Self {
            mu: contact.friction,
            tension: contact.tension,
            cohesion: contact.cohesion,
            rho: if held { 0.0 } else { rho },
            shift: Parts {
                n: shift_along(contact, w_n),
                t: lanes_of(&contact.shift_t),
            },
            compliance: contact.compliance,
        }
    }
}

/// The largest response across the normal.
fn largest_tangential<S: Space>(w: &S::Matrix) -> f64 {
    largest_across(matrix_lanes_of::<f64, S::M<f64>>(w))
}

/// The largest response across the normal, of blocks.
#[inline(always)]
fn largest_across<L: Lane, M: LaneMatrix<L>>(w: M) -> L {
    if <M::V as LaneVector<L>>::N == 2 {
        return w.entry(1, 1);
    }
    let (a, c, cross) = (w.entry(1, 1), w.entry(2, 2), w.entry(1, 2));
    let (half, quarter) = (L::all(0.5), L::all(0.25));
    half * (a + c) + (quarter * (a - c) * (a - c) + cross * cross).sqrt()
}

/// Ratio of the response along the normal to that across it, up to which it is rounding: bodies
/// that rotate about a point on the normal are held along it.
pub(in crate::solve) const HELD: f64 = 1e-14;

/// The components of a matrix, given in world axes, in the frame of a contact.
pub(super) fn in_frame<S: Space>(n: &S::Vector, w: &S::Matrix) -> S::Matrix {
    let [t1, t2] = S::tangents(n);
    let axes = [*n, t1, t2];
    let w = S::Matrix::from_entries(|i, j| axes[i].dot(&w.apply(&axes[j])));
    if w.entry(0, 0) > HELD * largest_tangential::<S>(&w) {
        return w;
    }
    S::Matrix::from_entries(|i, j| if i == 0 || j == 0 { 0.0 } else { w.entry(i, j) })
}

/// Frame of the contacts: vectors have components along n, t1 and t2.
#[derive(Clone, Copy)]
pub(super) struct Axes<S: Space, L: Lane>([S::V<L>; 2]);

impl<S: Space, L: Lane> Axes<S, L> {
    #[inline(always)]
    pub fn new(n: &S::V<L>) -> Self {
        Self(S::frame(n))
    }

    #[inline(always)]
    pub fn vector(&self, parts: &Parts<S, L>) -> S::V<L> {
        let [c1, c2] = S::frame_components(&self.0, &parts.t);
        let components = [parts.n, c1, c2];
        <S::V<L>>::from_fn(|k| components[k])
    }

    #[inline(always)]
    pub fn parts(&self, x: &S::V<L>) -> Parts<S, L> {
        Parts {
            n: x[0],
            t: S::from_frame(&self.0, [x[1], x[S::D - 1]]),
        }
    }
}

/// The block W' of a contact and the data for solving its law.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub(super) struct Cone<S: Space, L: Lane = f64> {
    /// W', without compliance.
    pub w: S::M<L>,
    /// (W' + C)^-1; zero where nothing moves along n.
    inverse: S::M<L>,
    /// Term added to a free velocity: the shift less (W' + C) n tension.
    offset: S::V<L>,
    /// In the plane: impulse for a velocity of -1 in slip towards -t1 and t1, and for an open
    /// contact. In space the first entry is the last multiplier of slip.
    answers: [L; 3],
}
record!(Cone);

impl<S: Space> Cone<S> {
    /// Creates the cone from W' in the frame of the contact.
    pub fn new(w: S::Matrix, contact: &ContactForm<S>) -> Self {
        let compliant = compliant::<S>(&w, contact.compliance);
        let (w_nn, w_nt) = (compliant.entry(0, 0), compliant.entry(0, 1));
        let shift = Parts {
            n: shift_along(contact, w_nn),
            t: lanes_of(&contact.shift_t),
        };
        let mut offset = Axes::<S, f64>::new(&lanes_of(&contact.normal)).vector(&shift);
        for k in 0..S::D {
            offset[k] -= compliant.entry(k, 0) * contact.tension;
        }
        let (inverse, answers) = if S::D == 2 {
            let slides = [contact.friction, -contact.friction].map(|mu| 1.0 / (w_nn - mu * w_nt));
            let open = answer_to_slip(compliant.entry(1, 1), w_nn, contact.cohesion);
            let [forth, back] = if w_nn > 0.0 { slides } else { [0.0; 2] };
            let inverse = held::<S, 2>(&compliant, contact.friction);
            (inverse, [forth, back, open])
        } else {
            (held::<S, 3>(&compliant, contact.friction), [0.0; 3])
        };
        Self {
            w: matrix_lanes_of(&w),
            inverse: if w_nn > 0.0 {
                inverse
            } else {
                <S::M<f64>>::zero()
            },
            offset,
            answers,
        }
    }

    /// Returns the cone of a law that never acts.
    pub fn none() -> Self {
        Self {
            w: <S::M<f64>>::zero(),
            inverse: <S::M<f64>>::zero(),
            offset: <S::V<f64>>::zero(),
            answers: [0.0; 3],
        }
    }

    /// Returns the impulses of the unilateral part for free velocities `f`, both in the frame, of
    /// the contacts in `active`; `start` is the initial guess. The block was read from `stored`,
    /// where the multipliers of slip are kept.
    #[inline(always)]
    pub fn solve<L: Lane>(
        block: &Cone<S, L>,
        stored: BatchMut<Self, L>,
        f: &S::V<L>,
        limits: &LawLimits<S, L>,
        active: L::Mask,
        start: &S::V<L>,
    ) -> S::V<L> {
        let f = *f + block.offset;
        let mut p = if S::D == 2 {
            block.solve_plane(&f, limits)
        } else {
            let cohesive = limits.cohesion.above(L::all(0.0));
            let mut p = block.solve_space(stored, &f, limits, active & !cohesive);
            if cohesive.any() {
                p = <S::V<L>>::select(cohesive, block.alternate(&f, limits, start), p);
            }
            p
        };
        p[0] = p[0] - limits.tension;
        p
    }
}

/// Returns the inverse of a block, zero if it is singular.
fn held<S: Space, const D: usize>(w: &S::Matrix, friction: f64) -> S::M<f64> {
    let block = std::array::from_fn(|i| std::array::from_fn(|j| w.entry(i, j)));
    let held = Local::<D>::new(&block, friction).held();
    <S::M<f64>>::from_fn(|i, j| held[i][j])
}

impl<S: Space, L: Lane> Cone<S, L> {
    /// Solves the law in the plane. All branches are computed and one is selected, because branch
    /// prediction would fail: stick; slip with p_t = -s (mu P + c), where s is the sign of the slip
    /// that sticking would have to prevent; and an open contact, which holds |p_t| <= c.
    #[inline(always)]
    fn solve_plane(&self, f: &S::V<L>, limits: &LawLimits<S, L>) -> S::V<L> {
        let (mu, c, w_nt) = (limits.mu, limits.cohesion, self.w.entry(0, 1));
        let ([forth, back, open], zero) = (self.answers, L::all(0.0));
        let stick = self.inverse.times(f);
        let negative = stick[1].below(zero);
        let answer = L::select(negative, back, forth);
        let signed_c = L::select(negative, -c, c);
        let signed_mu = L::select(negative, -mu, mu);
        let n = (signed_c * w_nt - f[0]) * answer;
        let t = -(signed_mu * n + signed_c);
        let sticks = stick[0].below(zero) & stick[1].abs().at_most(c - mu * stick[0]);
        let n = L::select(sticks, -stick[0], n);
        let t = L::select(sticks, -stick[1], t);
        let free = ((-f[1]) * open).greatest(-c).least(c);
        let closes = (f[0] + w_nt * free).below(zero) & n.above(zero);
        let p = [L::select(closes, n, zero), L::select(closes, t, free)];
        <S::V<L>>::from_fn(|k| p[k.min(1)])
    }

    /// Solves the law in space without cohesion. Each branch is computed only if a contact needs
    /// it.
    #[inline(always)]
    fn solve_space(
        &self,
        mut stored: BatchMut<Cone<S>, L>,
        f: &S::V<L>,
        limits: &LawLimits<S, L>,
        active: L::Mask,
    ) -> S::V<L> {
        let (mu, zero) = (limits.mu, L::all(0.0));
        let w_nn = self.w.entry(0, 0) + limits.compliance[0];
        let closes = active & !(f[0].at_least(zero) | w_nn.at_most(zero));
        if !closes.any() {
            return <S::V<L>>::zero();
        }
        let smooth = mu.at_least(zero) & mu.at_most(zero);
        let mut p = <S::V<L>>::zero();
        p[0] = L::select(closes & smooth, -f[0] / w_nn, zero);
        let rough = closes & !smooth;
        let stick = self.inverse.times(f);
        let squared = stick[1] * stick[1] + stick[S::D - 1] * stick[S::D - 1];
        let within = squared.at_most(mu * mu * stick[0] * stick[0]);
        let sticks = rough & stick[0].below(zero) & within;
        p = <S::V<L>>::select(sticks, -stick, p);
        let slides = rough & !sticks;
        if slides.any() {
            let w = self.compliant(limits.compliance);
            let w = [0, 1, 2].map(|i| [0, 1, 2].map(|j| w.entry(i.min(S::D - 1), j.min(S::D - 1))));
            let f = [f[0], f[1], f[S::D - 1]];
            let (slid, lambda) = slide(&w, &f, mu, self.answers[0], slides);
            p = <S::V<L>>::select(slides, <S::V<L>>::from_fn(|k| slid[k]), p);
            part_mut!(stored, answers[0]).write_where(slides, &lambda);
        }
        p
    }

    /// Solves the normal and the tangential part alternately, in space with cohesion. Two rounds
    /// are enough, since each sweep continues from the result of the last one.
    #[inline(always)]
    fn alternate(&self, f: &S::V<L>, limits: &LawLimits<S, L>, start: &S::V<L>) -> S::V<L> {
        const ALTERNATIONS: usize = 2;
        /// Change of an impulse, relative to its value, below which it is exact.
        const EXACT: f64 = 1e-14;
        let w = self.compliant(limits.compliance);
        let (zero, one, w_nn) = (L::all(0.0), L::all(1.0), w.entry(0, 0));
        let iwn = L::select(w_nn.above(zero), one / w_nn, zero);
        let iwt = answer_to_slip(largest_across(w), w_nn, limits.cohesion);
        let mut p = *start;
        p[0] = p[0] + limits.tension;
        let mut ended = zero.above(zero);
        for _ in 0..ALTERNATIONS {
            let old = p;
            let u = w.times(&p) + *f;
            p[0] = (p[0] - u[0] * iwn).greatest(zero);
            let u = w.times(&p) + *f;
            let mut squared = zero;
            for k in 1..S::D {
                p[k] = p[k] - u[k] * iwt;
                squared = squared + p[k] * p[k];
            }
            let bound = limits.mu * p[0] + limits.cohesion;
            let outside = squared.above(bound * bound);
            let share = L::select(outside, bound / squared.sqrt(), one);
            for k in 1..S::D {
                p[k] = p[k] * share;
            }
            p = <S::V<L>>::select(ended, old, p);
            ended = ended | (p - old).norm().at_most(L::all(EXACT) * p.norm());
            if ended.all() {
                break;
            }
        }
        p
    }

    /// Returns W' + C.
    #[inline(always)]
    fn compliant(&self, [c_n, c_t]: [L; 2]) -> S::M<L> {
        <S::M<L>>::from_fn(|i, j| {
            let w = self.w.entry(i, j);
            match (i, j) {
                (0, 0) => w + c_n,
                _ if i == j => w + c_t,
                _ => w,
            }
        })
    }
}

/// Returns W' + C.
pub(super) fn compliant<S: Space>(w: &S::Matrix, [c_n, c_t]: [f64; 2]) -> S::Matrix {
    let mut c = S::Vector::zero();
    for k in 0..S::D {
        c[k] = if k == 0 { c_n } else { c_t };
    }
    *w + S::Matrix::diagonal(&c)
}
