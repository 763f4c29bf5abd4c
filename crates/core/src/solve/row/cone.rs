//! The unilateral law of a contact on a full block of W, in the frame (n, t1, t2) of the contact: Coulomb's friction with tensile
//! strength and shear cohesion. In the plane it is solved in closed form, in space by Newton's method where it slides.

use super::{answer_to_slip, inverse, inverse_along, shift_along};
use crate::geometry::space::{MatrixLike, Space, VectorLike, greatest, least};
use crate::solve::form::ContactForm;
use crate::solve::local::contact::Local;
use std::hint::select_unpredictable;

/// Strengths and friction of a contact, and the data of the convergence test. `lanes` reads the fields in their order.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub(in crate::solve) struct Limits<S: Space> {
    pub mu: f64,
    /// Tensile strength (N s): the law holds for P = p_n + tension.
    pub tension: f64,
    /// Shear cohesion (N s).
    pub cohesion: f64,
    /// rho of the natural map: the smaller of 1/W' along n and across; 0 where nothing moves.
    pub rho: f64,
    pub shift_n: f64,
    /// Compliance of the unilateral part (1/kg), normal and tangential.
    pub compliance: [f64; 2],
    pub shift_t: S::Tangent,
}

impl<S: Space> Limits<S> {
    /// Of a form whose block, with a bond that acts and the compliance, is `compliant` in the frame of the contact.
    pub fn new(contact: &ContactForm<S>, compliant: &S::Matrix) -> Self {
        let (w_n, w_t) = (compliant.entry(0, 0), quickest::<S>(compliant));
        let rho = if w_n > 0.0 {
            least(inverse(w_n), inverse_along(w_t, w_n))
        } else {
            inverse(w_t)
        };
        // Of a contact that nothing moves: it is right after one visit.
        let held = [w_n, w_t] == contact.compliance;
        Self {
            mu: contact.friction,
            tension: contact.tension,
            cohesion: contact.cohesion,
            rho: if held { 0.0 } else { rho },
            shift_n: shift_along(contact, w_n),
            compliance: contact.compliance,
            shift_t: contact.shift_t,
        }
    }
}

/// The largest response across the normal.
fn quickest<S: Space>(w: &S::Matrix) -> f64 {
    if S::D == 2 {
        return w.entry(1, 1);
    }
    let (a, c, cross) = (w.entry(1, 1), w.entry(2, 2), w.entry(1, 2));
    0.5 * (a + c) + (0.25 * (a - c) * (a - c) + cross * cross).sqrt()
}

/// Response along the normal, as a share of that across, up to which it is rounding: bodies that turn about a place on the normal are held
/// along it.
pub(in crate::solve) const HELD: f64 = 1e-14;

/// The components of a matrix, given in world axes, in the frame of a contact.
pub(super) fn in_frame<S: Space>(n: &S::Vector, w: &S::Matrix) -> S::Matrix {
    let [t1, t2] = S::tangents(n);
    let axes = [*n, t1, t2];
    let w = S::Matrix::from_entries(|i, j| axes[i].dot(&w.apply(&axes[j])));
    if w.entry(0, 0) > HELD * quickest::<S>(&w) {
        return w;
    }
    S::Matrix::from_entries(|i, j| if i == 0 || j == 0 { 0.0 } else { w.entry(i, j) })
}

/// A vector of the frame, from its normal component and its tangential part.
#[inline(always)]
pub(super) fn framed<S: Space>(n: &S::Vector, along: f64, across: &S::Tangent) -> S::Vector {
    let [c1, c2] = S::components(n, across);
    let mut out = S::Vector::zero();
    (out[0], out[1]) = (along, c1);
    if S::D == 3 {
        out[2] = c2;
    }
    out
}

/// The tangential part of a vector of the frame.
#[inline(always)]
pub(super) fn across<S: Space>(n: &S::Vector, x: &S::Vector) -> S::Tangent {
    let second = if S::D == 3 { x[2] } else { 0.0 };
    S::from_components(n, x[1], second)
}

/// A x, summed row by row, as `lanes` does.
#[inline(always)]
pub(super) fn times<S: Space>(a: &S::Matrix, x: &S::Vector) -> S::Vector {
    let mut out = S::Vector::zero();
    for i in 0..S::D {
        let mut sum = a.entry(i, 0) * x[0];
        for j in 1..S::D {
            sum += a.entry(i, j) * x[j];
        }
        out[i] = sum;
    }
    out
}

/// The block W' of a contact and what solving its law needs. `lanes` reads the fields in their order.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub(super) struct Cone<S: Space> {
    /// W', without compliance.
    pub w: S::Matrix,
    /// (W' + C)^-1; zero where nothing moves along n.
    inverse: S::Matrix,
    /// Added to a free velocity: the shift less (W' + C) n tension.
    offset: S::Vector,
    /// In the plane: impulse for a velocity of -1 in slip towards -t1 and t1, and across an open contact. In space the first is the
    /// last multiplier of slip.
    answers: [f64; 3],
}

impl<S: Space> Cone<S> {
    /// From W' in the frame of the contact.
    pub fn new(w: S::Matrix, contact: &ContactForm<S>) -> Self {
        let compliant = compliant::<S>(&w, contact.compliance);
        let (w_nn, w_nt) = (compliant.entry(0, 0), compliant.entry(0, 1));
        let shift_n = shift_along(contact, w_nn);
        let mut offset = framed::<S>(&contact.normal, shift_n, &contact.shift_t);
        for k in 0..S::D {
            offset[k] -= compliant.entry(k, 0) * contact.tension;
        }
        let nothing = S::Matrix::uniform(0.0);
        let (inverse, answers) = if S::D == 2 {
            let block = std::array::from_fn(|i| std::array::from_fn(|j| compliant.entry(i, j)));
            let held = Local::<2>::new(&block, contact.friction).held();
            let slides = [contact.friction, -contact.friction].map(|mu| 1.0 / (w_nn - mu * w_nt));
            let open = answer_to_slip(compliant.entry(1, 1), w_nn, contact.cohesion);
            let [forth, back] = if w_nn > 0.0 { slides } else { [0.0; 2] };
            let inverse = S::Matrix::from_entries(|i, j| held[i][j]);
            (inverse, [forth, back, open])
        } else {
            let block = std::array::from_fn(|i| std::array::from_fn(|j| compliant.entry(i, j)));
            let held = Local::<3>::new(&block, contact.friction).held();
            (S::Matrix::from_entries(|i, j| held[i][j]), [0.0; 3])
        };
        Self {
            w,
            inverse: if w_nn > 0.0 { inverse } else { nothing },
            offset,
            answers,
        }
    }

    /// Of a law that never acts.
    pub fn none() -> Self {
        let zero = S::Matrix::uniform(0.0);
        Self {
            w: zero,
            inverse: zero,
            offset: S::Vector::zero(),
            answers: [0.0; 3],
        }
    }

    /// The impulse of the unilateral part that answers a free velocity `f`, both in the frame; `start` is a guess.
    #[inline(always)]
    pub fn solve(
        &mut self,
        f: &S::Vector,
        limits: &Limits<S>,
        start: impl Fn() -> S::Vector,
    ) -> S::Vector {
        let f = *f + self.offset;
        let mut p = if S::D == 2 {
            self.solve_plane(&f, limits)
        } else if limits.cohesion > 0.0 {
            self.alternate(&f, limits, &start())
        } else {
            self.solve_space(&f, limits)
        };
        p[0] -= limits.tension;
        p
    }

    /// All branches are computed and one is selected, because branch prediction would fail: stick, slip with p_t = -s (mu P + c),
    /// where s is the sign of the slip that sticking would have to prevent, and an open contact, which holds |p_t| <= c.
    #[inline(always)]
    fn solve_plane(&self, f: &S::Vector, limits: &Limits<S>) -> S::Vector {
        let (mu, c, w_nt) = (limits.mu, limits.cohesion, self.w.entry(0, 1));
        let [forth, back, open] = self.answers;
        let stick = times::<S>(&self.inverse, f);
        let negative = stick[1] < 0.0;
        let answer = select_unpredictable(negative, back, forth);
        let signed_c = select_unpredictable(negative, -c, c);
        let signed_mu = select_unpredictable(negative, -mu, mu);
        let n = (signed_c * w_nt - f[0]) * answer;
        let t = -(signed_mu * n + signed_c);
        let sticks = stick[0] < 0.0 && stick[1].abs() <= c - mu * stick[0];
        let n = select_unpredictable(sticks, -stick[0], n);
        let t = select_unpredictable(sticks, -stick[1], t);
        let free = least(greatest(-f[1] * open, -c), c);
        let closes = f[0] + w_nt * free < 0.0 && n > 0.0;
        let mut p = S::Vector::zero();
        p[0] = select_unpredictable(closes, n, 0.0);
        p[1] = select_unpredictable(closes, t, free);
        p
    }

    #[inline(always)]
    fn solve_space(&mut self, f: &S::Vector, limits: &Limits<S>) -> S::Vector {
        let compliant = compliant::<S>(&self.w, limits.compliance);
        let array = |m: &S::Matrix| std::array::from_fn(|i| std::array::from_fn(|j| m.entry(i, j)));
        let f = [f[0], f[1], f[S::D - 1]];
        let (w, inverse) = (array(&compliant), array(&self.inverse));
        let mut local = Local::<3>::known(w, inverse, limits.mu, self.answers[0]);
        let p = local.solve(&f);
        self.answers[0] = local.lambda();
        S::Vector::from_slice(&p)
    }

    /// The normal and the tangential part in turns, in space with cohesion. Two rounds: the sweeps that follow do the rest, since
    /// each begins where the last one ended.
    fn alternate(&self, f: &S::Vector, limits: &Limits<S>, start: &S::Vector) -> S::Vector {
        const ALTERNATIONS: usize = 2;
        let w = compliant::<S>(&self.w, limits.compliance);
        let w_nn = w.entry(0, 0);
        let iwn = inverse(w_nn);
        let iwt = answer_to_slip(quickest::<S>(&w), w_nn, limits.cohesion);
        let mut p = *start;
        p[0] += limits.tension;
        for _ in 0..ALTERNATIONS {
            let old = p;
            let u = times::<S>(&w, &p) + *f;
            p[0] = (p[0] - u[0] * iwn).max(0.0);
            let u = times::<S>(&w, &p) + *f;
            let mut squared = 0.0;
            for k in 1..S::D {
                p[k] -= u[k] * iwt;
                squared += p[k] * p[k];
            }
            let bound = limits.mu * p[0] + limits.cohesion;
            if squared > bound * bound {
                let share = bound / squared.sqrt();
                for k in 1..S::D {
                    p[k] *= share;
                }
            }
            if (p - old).norm() <= 1e-14 * p.norm() {
                break;
            }
        }
        p
    }
}

/// W' + C.
#[inline(always)]
pub(super) fn compliant<S: Space>(w: &S::Matrix, [c_n, c_t]: [f64; 2]) -> S::Matrix {
    let mut c = S::Vector::zero();
    for k in 0..S::D {
        c[k] = if k == 0 { c_n } else { c_t };
    }
    *w + S::Matrix::diagonal(&c)
}
