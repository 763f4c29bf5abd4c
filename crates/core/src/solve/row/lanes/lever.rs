//! Contacts with lever arms in the plane, several at a time, as `lever`, `block` and `cone` for one.

use super::frame::{Frame, Moving};
use super::vector::*;
use super::wide::{Residuals, Speeds, Wide, natural_map, store_impulses};
use crate::geometry::space::Dim2;
use crate::solve::row::{Bonded, LeverRow, Loose};

/// A vector of the frame: normal and tangential component.
type Pair<const U: usize> = [Lanes<U>; 2];

/// A matrix of the frame by columns, as it is stored.
type Block<const U: usize> = [Lanes<U>; 4];

#[inline(always)]
fn times<const U: usize>(a: &Block<U>, x: Pair<U>) -> Pair<U> {
    [a[0] * x[0] + a[2] * x[1], a[1] * x[0] + a[3] * x[1]]
}

#[inline(always)]
fn minus<const U: usize>(a: Pair<U>, b: Pair<U>) -> Pair<U> {
    [a[0] - b[0], a[1] - b[1]]
}

#[inline(always)]
fn plus<const U: usize>(a: Pair<U>, b: Pair<U>) -> Pair<U> {
    [a[0] + b[0], a[1] + b[1]]
}

/// Normals and impulses.
struct State<const U: usize> {
    n: Columns<U, 2>,
    p: Pair<U>,
}

impl<const U: usize> State<U> {
    /// # Safety
    /// The rows begin with these.
    #[inline(always)]
    unsafe fn new<R>(rows: &Records<R, U>) -> Self {
        // SAFETY: as asked for.
        let [n0, n1, pn, pt] = unsafe { load(rows, 0) };
        Self {
            n: Columns([n0, n1]),
            p: [pn, pt],
        }
    }

    /// Goes `relaxation` times as far as to the impulses `p` and stores them; gives the change.
    ///
    /// # Safety
    /// The rows begin with normal and impulse.
    #[inline(always)]
    unsafe fn go_to<R>(&self, rows: &Records<R, U>, p: Pair<U>, relaxation: Lanes<U>) -> Pair<U> {
        let [dn, dt] = minus(p, self.p).map(|d| d * relaxation);
        // SAFETY: as asked for.
        unsafe {
            let pt = Columns([self.p[1] + dt]);
            store_impulses::<_, Dim2, U>(rows, &self.n, self.p[0] + dn, &pt);
        }
        [dn, dt]
    }
}

/// Friction and strengths.
struct Limits<const U: usize> {
    mu: Lanes<U>,
    tension: Lanes<U>,
    cohesion: Lanes<U>,
    rho: Lanes<U>,
}

impl<const U: usize> Limits<U> {
    /// # Safety
    /// They are the numbers of the rows from `skip` on.
    #[inline(always)]
    unsafe fn new<R>(rows: &Records<R, U>, skip: usize) -> Self {
        // SAFETY: as asked for.
        let [mu, tension, cohesion, rho] = unsafe { load(rows, skip) };
        Self {
            mu,
            tension,
            cohesion,
            rho,
        }
    }

    /// The residual of the law for the unilateral impulses at relative velocities; shifts and compliances follow the limits.
    ///
    /// # Safety
    /// As for [`Self::new`].
    #[inline(always)]
    unsafe fn residuals<R>(
        &self,
        rows: &Records<R, U>,
        skip: usize,
        [sn, st]: Pair<U>,
        [un, ut]: Pair<U>,
    ) -> Residuals<U> {
        // SAFETY: as asked for.
        let [shift_n, c_n, c_t, shift_t] = unsafe { load(rows, skip + 4) };
        natural_map(
            (sn + self.tension, Columns([st])),
            (un, Columns([ut])),
            (shift_n + sn * c_n, Columns([shift_t + st * c_t])),
            self.rho,
            self.mu,
            self.cohesion,
        )
    }
}

/// See `row::cone::Cone`.
struct Cone<const U: usize> {
    w: Block<U>,
    inverse: Block<U>,
    offset: Pair<U>,
    forth: Lanes<U>,
    back: Lanes<U>,
    open: Lanes<U>,
}

/// Numbers of a cone.
const CONE: usize = 4 + 4 + 2 + 3;

impl<const U: usize> Cone<U> {
    /// # Safety
    /// It is the numbers of the rows from `skip` on.
    #[inline(always)]
    unsafe fn new<R>(rows: &Records<R, U>, skip: usize) -> Self {
        // SAFETY: as asked for.
        unsafe {
            let [o0, o1, forth, back] = load(rows, skip + 8);
            Self {
                w: load(rows, skip),
                inverse: load(rows, skip + 4),
                offset: [o0, o1],
                forth,
                back,
                open: load_one(rows, skip + 12),
            }
        }
    }

    #[inline(always)]
    fn solve(&self, f: Pair<U>, limits: &Limits<U>) -> Pair<U> {
        let f = plus(f, self.offset);
        let zero = Lanes::all(0.0);
        let (mu, c, w_nt) = (limits.mu, limits.cohesion, self.w[2]);
        let stick = times(&self.inverse, f);
        let negative = zero.above(stick[1]);
        let answer = negative.choose(self.back, self.forth);
        let signed_c = negative.choose(-c, c);
        let signed_mu = negative.choose(-mu, mu);
        let n = (signed_c * w_nt - f[0]) * answer;
        let t = -(signed_mu * n + signed_c);
        let sticks = zero
            .above(stick[0])
            .and(stick[1].abs().not_above(c - mu * stick[0]));
        let n = sticks.choose(-stick[0], n);
        let t = sticks.choose(-stick[1], t);
        let free = ((-f[1]) * self.open).max(-c).min(c);
        let closes = zero.above(f[0] + w_nt * free).and(n.above(zero));
        [
            closes.choose(n, zero) - limits.tension,
            closes.choose(t, free),
        ]
    }
}

/// See `row::block::Beside`.
struct Beside<const U: usize> {
    m: Block<U>,
    k: Pair<U>,
    cone: Cone<U>,
}

/// Numbers of these.
const BESIDE: usize = 4 + 2 + CONE;

impl<const U: usize> Beside<U> {
    /// # Safety
    /// It is the numbers of the rows from `skip` on.
    #[inline(always)]
    unsafe fn new<R>(rows: &Records<R, U>, skip: usize) -> Self {
        // SAFETY: as asked for; what follows `k` belongs to the cone.
        unsafe {
            let [k0, k1, ..] = load(rows, skip + 4);
            Self {
                m: load(rows, skip),
                k: [k0, k1],
                cone: Cone::new(rows, skip + 6),
            }
        }
    }

    #[inline(always)]
    fn solve(&self, f: Pair<U>, limits: &Limits<U>) -> [Pair<U>; 2] {
        let f = minus(times(&self.m, f), self.k);
        let s = self.cone.solve(f, limits);
        [s, plus(times(&self.cone.w, s), f)]
    }
}

/// See `row::lever::Levers`.
struct Levers<const U: usize> {
    arms: [Columns<U, 2>; 2],
    masses: [Columns<U, 2>; 2],
    spins: Pair<U>,
}

/// Numbers of these, with the indices of the bodies.
const LEVERS: usize = 4 + 4 + 2 + 1;

impl<const U: usize> Levers<U> {
    /// # Safety
    /// They are the numbers of the rows from `skip` on.
    #[inline(always)]
    unsafe fn new<R>(rows: &Records<R, U>, skip: usize) -> Self {
        // SAFETY: as asked for.
        unsafe {
            let ([a, b, c, d], [e, f, g, h]) = (load(rows, skip), load(rows, skip + 4));
            Self {
                arms: [Columns([a, b]), Columns([c, d])],
                masses: [Columns([e, f]), Columns([g, h])],
                spins: [load_one(rows, skip + 8), load_one(rows, skip + 9)],
            }
        }
    }

    #[inline(always)]
    fn relative(&self, n: &Columns<U, 2>, a: &Moving<Dim2, U>, b: &Moving<Dim2, U>) -> Pair<U> {
        let turning = |arm: &Columns<U, 2>, s: Lanes<U>| Columns([(-s) * arm.0[1], s * arm.0[0]]);
        let [i, j] = &self.arms;
        let u = a.v + turning(i, a.s.0[0]) - b.v - turning(j, b.s.0[0]);
        let un = n.dot(u);
        [un, Dim2::across(n, &u, un).0[0]]
    }

    #[inline(always)]
    fn push(
        &self,
        n: &Columns<U, 2>,
        [dn, dt]: Pair<U>,
        a: &mut Moving<Dim2, U>,
        b: &mut Moving<Dim2, U>,
    ) {
        let p = Dim2::impulse(n, dn, &Columns([dt]));
        let scaled = |m: &Columns<U, 2>| Columns([p.0[0] * m.0[0], p.0[1] * m.0[1]]);
        let moment = |arm: &Columns<U, 2>| arm.0[0] * p.0[1] - arm.0[1] * p.0[0];
        a.v = a.v + scaled(&self.masses[0]);
        b.v = b.v - scaled(&self.masses[1]);
        a.s = Columns([a.s.0[0] + self.spins[0] * moment(&self.arms[0])]);
        b.s = Columns([b.s.0[0] - self.spins[1] * moment(&self.arms[1])]);
    }
}

/// Where the numbers of a row begin.
struct Places {
    limits: usize,
    levers: usize,
}

/// State, cone, limits with shifts and compliances, levers.
const LOOSE: Places = Places {
    limits: 4 + CONE,
    levers: 4 + CONE + 8,
};

/// State, W, the part beside a bond that pulls, the bond, limits with shifts and compliances, the part beside a slack bond, levers.
const BONDED: Places = Places {
    limits: 8 + BESIDE + 5,
    levers: 8 + BESIDE + 5 + 8 + BESIDE,
};

type LooseRow = LeverRow<Dim2, Loose<Dim2>>;
type BondedRow = LeverRow<Dim2, Bonded<Dim2>>;

const _: () = assert!(size_of::<LooseRow>() == 8 * (LOOSE.levers + LEVERS));
const _: () = assert!(size_of::<BondedRow>() == 8 * (BONDED.levers + LEVERS));

/// Relative velocities and the squares of these, with what else the scales of the error need.
///
/// # Safety
/// The rows are there.
#[inline(always)]
unsafe fn speeds<R, const U: usize>(
    rows: &Records<R, U>,
    places: &Places,
    a: &Moving<Dim2, U>,
    b: &Moving<Dim2, U>,
) -> Speeds<U> {
    // SAFETY: as asked for.
    unsafe {
        let state = State::new(rows);
        let limits = Limits::new(rows, places.limits);
        let [un, ut] = Levers::new(rows, places.levers).relative(&state.n, a, b);
        Speeds {
            speed: un * un + ut * ut,
            rho: limits.rho,
            mu: limits.mu,
        }
    }
}

impl Wide for LooseRow {
    type Space = Dim2;

    fn idle() -> Self {
        Self::idle()
    }

    #[inline(always)]
    unsafe fn updates<const U: usize>(
        rows: &Records<Self, U>,
        a: &mut Moving<Dim2, U>,
        b: &mut Moving<Dim2, U>,
        relaxation: Lanes<U>,
    ) {
        // SAFETY: as asked for.
        unsafe {
            let state = State::new(rows);
            let levers = Levers::new(rows, LOOSE.levers);
            let u = levers.relative(&state.n, a, b);
            let cone = Cone::new(rows, 4);
            let f = minus(u, times(&cone.w, state.p));
            let p = cone.solve(f, &Limits::new(rows, LOOSE.limits));
            let change = state.go_to(rows, p, relaxation);
            levers.push(&state.n, change, a, b);
        }
    }

    #[inline(always)]
    unsafe fn loads<const U: usize>(
        rows: &Records<Self, U>,
        a: &mut Moving<Dim2, U>,
        b: &mut Moving<Dim2, U>,
    ) {
        // SAFETY: as asked for.
        unsafe {
            let state = State::new(rows);
            Levers::new(rows, LOOSE.levers).push(&state.n, state.p, a, b);
        }
    }

    #[inline(always)]
    unsafe fn speeds<const U: usize>(
        rows: &Records<Self, U>,
        a: &Moving<Dim2, U>,
        b: &Moving<Dim2, U>,
    ) -> Speeds<U> {
        // SAFETY: as asked for.
        unsafe { speeds(rows, &LOOSE, a, b) }
    }

    #[inline(always)]
    unsafe fn residuals<const U: usize>(
        rows: &Records<Self, U>,
        a: &Moving<Dim2, U>,
        b: &Moving<Dim2, U>,
    ) -> Residuals<U> {
        // SAFETY: as asked for.
        unsafe {
            let state = State::new(rows);
            let u = Levers::new(rows, LOOSE.levers).relative(&state.n, a, b);
            let limits = Limits::new(rows, LOOSE.limits);
            limits.residuals(rows, LOOSE.limits, state.p, u)
        }
    }
}

/// A bond's impulse, see `row::block::Bonded`.
struct Bond<const U: usize> {
    a: Pair<U>,
    b: Pair<U>,
    limit: Lanes<U>,
}

impl<const U: usize> Bond<U> {
    /// # Safety
    /// The rows are there.
    #[inline(always)]
    unsafe fn new(rows: &Records<BondedRow, U>) -> Self {
        // SAFETY: as asked for.
        unsafe {
            let [a_n, a_t, b_n, b_t] = load(rows, 8 + BESIDE);
            Self {
                a: [a_n, a_t],
                b: [b_n, b_t],
                limit: load_one(rows, 8 + BESIDE + 4),
            }
        }
    }

    #[inline(always)]
    fn pull(&self, u: Pair<U>) -> Pair<U> {
        [
            -(self.a[0] + self.b[0] * u[0]),
            -(self.a[1] + self.b[1] * u[1]),
        ]
    }
}

impl Wide for BondedRow {
    type Space = Dim2;

    fn idle() -> Self {
        Self::idle()
    }

    #[inline(always)]
    unsafe fn updates<const U: usize>(
        rows: &Records<Self, U>,
        a: &mut Moving<Dim2, U>,
        b: &mut Moving<Dim2, U>,
        relaxation: Lanes<U>,
    ) {
        // SAFETY: as asked for.
        unsafe {
            let state = State::new(rows);
            let levers = Levers::new(rows, BONDED.levers);
            let u = levers.relative(&state.n, a, b);
            let f = minus(u, times(&load(rows, 4), state.p));
            let limits = Limits::new(rows, BONDED.limits);
            let [mut s, u] = Beside::new(rows, 8).solve(f, &limits);
            let bond = Bond::new(rows);
            let mut e = bond.pull(u);
            let slack = e[0].above(bond.limit);
            if slack.bits() != [0; U] {
                let [without, u] = Beside::new(rows, BONDED.limits + 8).solve(f, &limits);
                let aside = bond.pull(u);
                s = [
                    slack.choose(without[0], s[0]),
                    slack.choose(without[1], s[1]),
                ];
                e = [
                    slack.choose(Lanes::all(0.0), e[0]),
                    slack.choose(aside[1], e[1]),
                ];
            }
            let change = state.go_to(rows, plus(s, e), relaxation);
            levers.push(&state.n, change, a, b);
        }
    }

    #[inline(always)]
    unsafe fn loads<const U: usize>(
        rows: &Records<Self, U>,
        a: &mut Moving<Dim2, U>,
        b: &mut Moving<Dim2, U>,
    ) {
        // SAFETY: as asked for.
        unsafe {
            let state = State::new(rows);
            Levers::new(rows, BONDED.levers).push(&state.n, state.p, a, b);
        }
    }

    #[inline(always)]
    unsafe fn speeds<const U: usize>(
        rows: &Records<Self, U>,
        a: &Moving<Dim2, U>,
        b: &Moving<Dim2, U>,
    ) -> Speeds<U> {
        // SAFETY: as asked for.
        unsafe { speeds(rows, &BONDED, a, b) }
    }

    #[inline(always)]
    unsafe fn residuals<const U: usize>(
        rows: &Records<Self, U>,
        a: &Moving<Dim2, U>,
        b: &Moving<Dim2, U>,
    ) -> Residuals<U> {
        // SAFETY: as asked for.
        unsafe {
            let state = State::new(rows);
            let u = Levers::new(rows, BONDED.levers).relative(&state.n, a, b);
            let bond = Bond::new(rows);
            let [en, et] = bond.pull(u);
            let en = en.above(bond.limit).choose(Lanes::all(0.0), en);
            let limits = Limits::new(rows, BONDED.limits);
            let s = minus(state.p, [en, et]);
            limits.residuals(rows, BONDED.limits, s, u)
        }
    }
}
