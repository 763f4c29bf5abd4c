//! Rows solved several at a time. The operations and their order are those of a single contact, so that
//! results are bitwise identical.

use super::frame::{Frame, Moving, Tuple, push, push_at, relative, relative_at};
use super::vector::*;
use crate::solve::row::{FullRow, PlainRow, Row};

/// As [`super::super::Residual`], in columns.
pub struct Residuals<const U: usize> {
    pub squared: Lanes<U>,
    pub velocity: Lanes<U>,
    pub impulse: Lanes<U>,
    pub power: Lanes<U>,
    pub unbalanced: Lanes<U>,
    pub slip: Lanes<U>,
}

/// Squared relative velocities, with rho of the natural map and friction.
pub struct Speeds<const U: usize> {
    pub speed: Lanes<U>,
    pub rho: Lanes<U>,
    pub mu: Lanes<U>,
}

/// Rows that begin with the normal, the normal impulse and the tangential impulse.
pub trait Wide: Row<Self::Space> {
    type Space: Frame;

    /// Returns a row of a contact between immovable bodies.
    fn idle() -> Self;
    /// Solves the contacts and updates the velocities.
    ///
    /// # Safety
    /// The rows are there.
    unsafe fn updates<const U: usize>(
        rows: &Records<Self, U>,
        a: &mut Moving<Self::Space, U>,
        b: &mut Moving<Self::Space, U>,
        relaxation: Lanes<U>,
    );
    /// Applies the stored impulses to the velocities.
    ///
    /// # Safety
    /// The rows are there.
    unsafe fn loads<const U: usize>(
        rows: &Records<Self, U>,
        a: &mut Moving<Self::Space, U>,
        b: &mut Moving<Self::Space, U>,
    );
    /// # Safety
    /// The rows are there.
    unsafe fn speeds<const U: usize>(
        rows: &Records<Self, U>,
        a: &Moving<Self::Space, U>,
        b: &Moving<Self::Space, U>,
    ) -> Speeds<U>;
    /// # Safety
    /// The rows are there.
    unsafe fn residuals<const U: usize>(
        rows: &Records<Self, U>,
        a: &Moving<Self::Space, U>,
        b: &Moving<Self::Space, U>,
    ) -> Residuals<U>;
}

/// Returns the numbers of components of a vector and of a tangent.
const fn sizes<F: Frame>() -> [usize; 2] {
    if F::D == 2 { [2, 1] } else { [3, 3] }
}

/// Reads the numbers of a record one after the other.
struct Reader<const U: usize> {
    numbers: [Lanes<U>; 32],
    at: usize,
}

impl<const U: usize> Reader<U> {
    /// Loads `count` numbers from `skip` on, rounded up to a multiple of four.
    ///
    /// # Safety
    /// The records have that many numbers.
    #[inline(always)]
    unsafe fn new<T>(rows: &Records<T, U>, skip: usize, count: usize) -> Self {
        let mut numbers = [Lanes::all(0.0); 32];
        for four in 0..count.div_ceil(4) {
            // SAFETY: as asked for.
            let columns = unsafe { load(rows, skip + 4 * four) };
            numbers[4 * four..4 * four + 4].copy_from_slice(&columns);
        }
        Self { numbers, at: 0 }
    }

    #[inline(always)]
    fn number(&mut self) -> Lanes<U> {
        self.at += 1;
        self.numbers[self.at - 1]
    }

    #[inline(always)]
    fn tuple<T: Tuple<U>>(&mut self, size: usize) -> T {
        self.at += size;
        T::from_numbers(&self.numbers[self.at - size..self.at])
    }
}

/// Writes impulses back.
///
/// # Safety
/// The rows are valid and begin with n, p_n, p_t.
#[inline(always)]
pub(super) unsafe fn store_impulses<R, F: Frame, const U: usize>(
    rows: &Records<R, U>,
    n: &F::V<U>,
    pn: Lanes<U>,
    pt: &F::T<U>,
) {
    let all = [15; U];
    // SAFETY: as asked for.
    unsafe {
        if F::D == 2 {
            store(rows, 0, all, [n.number(0), n.number(1), pn, pt.number(0)]);
        } else {
            let t = [0, 1, 2].map(|k| pt.number(k));
            store(rows, 3, all, [pn, t[0], t[1], t[2]]);
        }
    }
}

struct Plain<F: Frame, const U: usize> {
    n: F::V<U>,
    pn: Lanes<U>,
    pt: F::T<U>,
    shift: Lanes<U>,
    iwn: Lanes<U>,
    iwt: Lanes<U>,
    mu: Lanes<U>,
}

impl<F: Frame, const U: usize> Plain<F, U> {
    #[inline(always)]
    unsafe fn new(rows: &Records<PlainRow<F>, U>) -> Self {
        let [v, t] = const {
            let [v, t] = sizes::<F>();
            assert!(size_of::<PlainRow<F>>() == 8 * (v + t + 5 + 1));
            [v, t]
        };
        // SAFETY: the row is those numbers and then two indices.
        let mut r = unsafe { Reader::new(rows, 0, v + t + 5) };
        Self {
            n: r.tuple(v),
            pn: r.number(),
            pt: r.tuple(t),
            shift: r.number(),
            iwn: r.number(),
            iwt: r.number(),
            mu: r.number(),
        }
    }
}

impl<F: Frame> Wide for PlainRow<F> {
    type Space = F;

    fn idle() -> Self {
        Self::idle()
    }

    #[inline(always)]
    unsafe fn updates<const U: usize>(
        rows: &Records<Self, U>,
        a: &mut Moving<F, U>,
        b: &mut Moving<F, U>,
        relaxation: Lanes<U>,
    ) {
        // SAFETY: as asked for.
        unsafe {
            let r = Plain::<F, U>::new(rows);
            let zero = Lanes::all(0.0);
            // One unknown per contact where there is no friction.
            if r.mu.above(zero).bits() == [0; U] {
                let un = r.n.dot(a.v - b.v);
                let pn = (r.pn - (un + r.shift) * (r.iwn * relaxation)).max(zero);
                let impulse = r.n * (pn - r.pn);
                a.v = a.v + impulse * a.im;
                b.v = b.v - impulse * b.im;
                store_impulses::<_, F, U>(rows, &r.n, pn, &r.pt);
                return;
            }
            let (un, ut) = relative(&r.n, a, b);
            let pn = r.pn - (un + r.shift) * (r.iwn * relaxation);
            let pn = pn.max(zero);
            let pt = (r.pt - ut * (r.iwt * relaxation)).limited(r.mu * pn);
            push(&r.n, pn - r.pn, pt - r.pt, a, b);
            store_impulses::<_, F, U>(rows, &r.n, pn, &pt);
        }
    }

    #[inline(always)]
    unsafe fn loads<const U: usize>(
        rows: &Records<Self, U>,
        a: &mut Moving<F, U>,
        b: &mut Moving<F, U>,
    ) {
        // SAFETY: as asked for.
        let r = unsafe { Plain::<F, U>::new(rows) };
        push(&r.n, r.pn, r.pt, a, b);
    }

    #[inline(always)]
    unsafe fn speeds<const U: usize>(
        rows: &Records<Self, U>,
        a: &Moving<F, U>,
        b: &Moving<F, U>,
    ) -> Speeds<U> {
        // SAFETY: as asked for.
        let r = unsafe { Plain::<F, U>::new(rows) };
        let (un, ut) = relative(&r.n, a, b);
        Speeds {
            speed: un * un + ut.dot(ut),
            rho: r.iwn.min(r.iwt),
            mu: r.mu,
        }
    }

    #[inline(always)]
    unsafe fn residuals<const U: usize>(
        rows: &Records<Self, U>,
        a: &Moving<F, U>,
        b: &Moving<F, U>,
    ) -> Residuals<U> {
        // SAFETY: as asked for.
        let r = unsafe { Plain::<F, U>::new(rows) };
        let (un, ut) = relative(&r.n, a, b);
        let rho = r.iwn.min(r.iwt);
        let shift = (r.shift, Tuple::zero());
        natural_map((r.pn, r.pt), (un, ut), shift, rho, r.mu, Lanes::all(0.0))
    }
}

/// A direction of a bonded contact, see `full.rs`.
struct Direction<const U: usize, T> {
    w: Lanes<U>,
    iw: Lanes<U>,
    q: T,
    k: T,
    c: Lanes<U>,
}

struct Full<F: Frame, const U: usize> {
    n: F::V<U>,
    pn: Lanes<U>,
    pt: F::T<U>,
    reach: [Lanes<U>; 2],
    normal: Direction<U, Lanes<U>>,
    tangent: Direction<U, F::T<U>>,
    q_slack: Lanes<U>,
    iw_slack: Lanes<U>,
    limit: Lanes<U>,
    mu: Lanes<U>,
    tension: Lanes<U>,
    grip: Lanes<U>,
}

impl<F: Frame, const U: usize> Full<F, U> {
    #[inline(always)]
    unsafe fn new(rows: &Records<FullRow<F>, U>) -> Self {
        let [v, t] = const {
            let [v, t] = sizes::<F>();
            assert!(size_of::<FullRow<F>>() == 8 * (Bonds::<F, U>::BEFORE + 2 * t + 8 + 1));
            [v, t]
        };
        // SAFETY: the row is those numbers, then those of `Bonds` and two indices.
        let mut r = unsafe { Reader::new(rows, 0, Bonds::<F, U>::BEFORE) };
        Self {
            n: r.tuple(v),
            pn: r.number(),
            pt: r.tuple(t),
            reach: [r.number(), r.number()],
            normal: Direction {
                w: r.number(),
                iw: r.number(),
                q: r.number(),
                k: r.number(),
                c: r.number(),
            },
            tangent: Direction {
                w: r.number(),
                iw: r.number(),
                q: r.tuple(t),
                k: r.tuple(t),
                c: r.number(),
            },
            q_slack: r.number(),
            iw_slack: r.number(),
            limit: r.number(),
            mu: r.number(),
            tension: r.number(),
            grip: r.number(),
        }
    }
}

/// Additional data of the convergence test.
struct Bonds<F: Frame, const U: usize> {
    cohesion: Lanes<U>,
    rho: Lanes<U>,
    a_n: Lanes<U>,
    b_n: Lanes<U>,
    shift_n: Lanes<U>,
    compliance_n: Lanes<U>,
    a_t: F::T<U>,
    b_t: Lanes<U>,
    shift_t: F::T<U>,
    compliance_t: Lanes<U>,
}

impl<F: Frame, const U: usize> Bonds<F, U> {
    /// Number of numbers of a row before these.
    const BEFORE: usize = {
        let [v, t] = sizes::<F>();
        v + 3 * t + 17
    };

    #[inline(always)]
    unsafe fn new(rows: &Records<FullRow<F>, U>) -> Self {
        let [_, t] = const { sizes::<F>() };
        // From the number before them, so that a multiple of four ends with the row. SAFETY: the row ends with them and two indices.
        let mut r = unsafe { Reader::new(rows, Self::BEFORE - 1, 2 * t + 9) };
        r.number();
        Self {
            cohesion: r.number(),
            rho: r.number(),
            a_n: r.number(),
            b_n: r.number(),
            shift_n: r.number(),
            compliance_n: r.number(),
            a_t: r.tuple(t),
            b_t: r.number(),
            shift_t: r.tuple(t),
            compliance_t: r.number(),
        }
    }
}

impl<F: Frame> Wide for FullRow<F> {
    type Space = F;

    fn idle() -> Self {
        Self::idle()
    }

    #[inline(always)]
    unsafe fn updates<const U: usize>(
        rows: &Records<Self, U>,
        a: &mut Moving<F, U>,
        b: &mut Moving<F, U>,
        relaxation: Lanes<U>,
    ) {
        // SAFETY: as asked for.
        unsafe {
            let r = Full::<F, U>::new(rows);
            let (n, t) = (&r.normal, &r.tangent);
            let (un, ut) = relative_at(&r.n, &r.reach, a, b);
            let f = un - n.w * r.pn;
            let with = (n.q - f * n.iw).max(-r.tension);
            let pull = -(n.k + n.c * (n.w * with + f));
            let without = (r.q_slack - f * r.iw_slack).max(-r.tension);
            let slack = pull.above(r.limit);
            let sn = slack.choose(without, with);
            let en = slack.choose(Lanes::all(0.0), pull);
            let f = ut - r.pt * t.w;
            let st = (t.q - f * t.iw).limited(r.mu * sn + r.grip);
            let et = -(t.k + (st * t.w + f) * t.c);
            let (dn, dt) = (sn + en - r.pn, st + et - r.pt);
            let (dn, dt) = (dn * relaxation, dt * relaxation);
            push_at(&r.n, &r.reach, dn, dt, a, b);
            store_impulses::<_, F, U>(rows, &r.n, r.pn + dn, &(r.pt + dt));
        }
    }

    #[inline(always)]
    unsafe fn loads<const U: usize>(
        rows: &Records<Self, U>,
        a: &mut Moving<F, U>,
        b: &mut Moving<F, U>,
    ) {
        // SAFETY: as asked for.
        let r = unsafe { Full::<F, U>::new(rows) };
        push_at(&r.n, &r.reach, r.pn, r.pt, a, b);
    }

    #[inline(always)]
    unsafe fn speeds<const U: usize>(
        rows: &Records<Self, U>,
        a: &Moving<F, U>,
        b: &Moving<F, U>,
    ) -> Speeds<U> {
        // SAFETY: as asked for.
        let (r, bonds) = unsafe { (Full::<F, U>::new(rows), Bonds::<F, U>::new(rows)) };
        let (un, ut) = relative_at(&r.n, &r.reach, a, b);
        Speeds {
            speed: un * un + ut.dot(ut),
            rho: bonds.rho,
            mu: r.mu,
        }
    }

    #[inline(always)]
    unsafe fn residuals<const U: usize>(
        rows: &Records<Self, U>,
        a: &Moving<F, U>,
        b: &Moving<F, U>,
    ) -> Residuals<U> {
        // SAFETY: as asked for.
        let (r, bonds) = unsafe { (Full::<F, U>::new(rows), Bonds::<F, U>::new(rows)) };
        let (un, ut) = relative_at(&r.n, &r.reach, a, b);
        let pull = -(bonds.a_n + bonds.b_n * un);
        let en = pull.above(r.limit).choose(Lanes::all(0.0), pull);
        let et = -(bonds.a_t + ut * bonds.b_t);
        let (sn, st) = (r.pn - en, r.pt - et);
        let shifted = (sn + r.tension, st);
        let shift = (
            bonds.shift_n + sn * bonds.compliance_n,
            bonds.shift_t + st * bonds.compliance_t,
        );
        natural_map(shifted, (un, ut), shift, bonds.rho, r.mu, bonds.cohesion)
    }
}

/// As `natural_map` of one contact; zero where rho is 0.
#[inline(always)]
pub(super) fn natural_map<T: Tuple<U>, const U: usize>(
    (pn, pt): (Lanes<U>, T),
    (un, ut): (Lanes<U>, T),
    (sn, st): (Lanes<U>, T),
    rho: Lanes<U>,
    mu: Lanes<U>,
    c: Lanes<U>,
) -> Residuals<U> {
    let (zero, one) = (Lanes::all(0.0), Lanes::all(1.0));
    let slide = ut + st;
    let (zn, zt) = project(
        pn - rho * (un + sn + mu * slide.norm()),
        pt - slide * rho,
        mu,
        c,
    );
    let any = rho.above(zero);
    let over = any.choose(one / rho, zero);
    let (rn, rt) = ((pn - zn) * over, (pt - zt) * over);
    let natural = rn * rn + rt.dot(rt);
    let most = (pn * over).min(un + sn);
    let squared_mu = (mu * mu).min(Lanes::all(f64::MAX));
    let lost = most * (squared_mu / (one + squared_mu));
    let larger = natural.max(lost * lost);
    let squared = (most * most).not_above(natural).choose(natural, larger);
    let power = any.choose(pn * rn + pt.dot(rt), zero);
    let slip = any.choose(pt.dot(slide), zero);
    Residuals {
        squared: any.choose(squared, zero),
        velocity: any.choose(un * un + ut.dot(ut), zero),
        impulse: (pn * pn + pt.dot(pt)) * (over * over),
        power,
        unbalanced: power.abs().max(any.choose(rho * natural, zero)),
        slip: slip.abs(),
    }
}

/// As [`crate::solve::cone::project`].
#[inline(always)]
fn project<T: Tuple<U>, const U: usize>(
    normal: Lanes<U>,
    tangent: T,
    mu: Lanes<U>,
    c: Lanes<U>,
) -> (Lanes<U>, T) {
    let (zero, one) = (Lanes::all(0.0), Lanes::all(1.0));
    let length = tangent.norm();
    let inside = normal
        .not_below(zero)
        .and(length.not_above(mu * normal + c));
    let closest_point = (normal + mu * (length - c)) / (one + mu * mu);
    let slides = length.above(c).and(closest_point.above(zero));
    let closest_point = slides.choose(closest_point, zero);
    let bound = slides.choose(mu * closest_point + c, length.min(c));
    let n = inside.choose(normal, closest_point);
    if T::SIZE == 1 {
        let on = T::from_numbers(&[bound.signed_as(tangent.number(0))]);
        return (n, T::chosen(inside, tangent, on));
    }
    let share = length.above(zero).choose(bound / length, zero);
    (n, tangent * inside.choose(one, share))
}
