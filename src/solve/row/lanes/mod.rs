//! Four plain contacts at once in the lanes of a vector, and two vectors at a time, so that one does
//! something while the other waits. The operations are those of [`PlainRow::update`] in their order, so
//! the bits are its own.

mod vector;

use super::{Line, Lines, PlainRow, Row};
use crate::geometry::space::{Plane, Solid, Space, VectorLike};
use std::any::TypeId;
use std::arch::x86_64::*;
use vector::*;

/// Updates a block of contacts, given the starts of its groups and the end of the last: contacts of a
/// group share no movable body.
pub(super) fn run<S: Space>(
    rows: &mut [PlainRow<S>],
    groups: &[u32],
    lines: &Lines<S>,
    relaxation: f64,
) {
    // A lone contact a group leaves three lanes of four idle.
    if rows.len() >= 2 * groups.len() && is_x86_feature_detected!("avx2") {
        let (count, first, lines) = (rows.len(), rows.as_mut_ptr(), lines.at(0));
        debug_assert!(groups.last().map(|end| (end - groups[0]) as usize) == Some(count));
        // SAFETY: the machine has AVX2, the types are those asked for, and bodies are as `Lines` says.
        unsafe {
            if TypeId::of::<S>() == TypeId::of::<Plane>() {
                return plane_all(first.cast(), groups, count, lines.cast(), relaxation);
            }
            if TypeId::of::<S>() == TypeId::of::<Solid>() {
                return solid_all(first.cast(), groups, count, lines.cast(), relaxation);
            }
        }
    }
    for row in rows {
        let bodies = row.bodies;
        lines.with(bodies, |a, b| row.update(a, b, relaxation));
    }
}

/// Fills the lanes that have no contact: nothing moves, and nothing is stored.
struct Idle<S: Space> {
    row: PlainRow<S>,
    line: Line<S>,
}

impl<S: Space> Idle<S> {
    #[inline(always)]
    fn new() -> Self {
        let (null, tangent) = (S::Vector::null(), S::Tangent::null());
        Self {
            row: PlainRow {
                n: null,
                pn: 0.0,
                pt: tangent,
                shift: 0.0,
                iwn: 0.0,
                iwt: 0.0,
                mu: 0.0,
                bodies: [0, 0],
            },
            line: Line {
                v: null,
                s: S::Spin::null(),
                im: 0.0,
                is: 0.0,
            },
        }
    }
}

/// Four rows and the lines of their bodies.
struct Four<S: Space> {
    row: [*mut PlainRow<S>; 4],
    a: [*mut Line<S>; 4],
    b: [*mut Line<S>; 4],
}

impl<S: Space> Four<S> {
    /// Those from `first` on, of which no more than `end` belong to the group.
    ///
    /// # Safety
    /// There are `count` rows, of bodies of `lines`.
    #[inline(always)]
    unsafe fn new(
        rows: *mut PlainRow<S>,
        [first, end, count]: [usize; 3],
        lines: *mut Line<S>,
        idle: &mut Idle<S>,
    ) -> Self {
        // SAFETY: as above.
        unsafe {
            if first + AHEAD + 4 <= count {
                for k in 0..4 {
                    for body in (*rows.add(first + AHEAD + k)).bodies {
                        _mm_prefetch::<_MM_HINT_T0>(lines.add(body as usize).cast());
                    }
                }
            }
            if first + 4 <= end {
                let row = [0, 1, 2, 3].map(|k| rows.add(first + k));
                return Self {
                    row,
                    a: row.map(|r| lines.add((*r).bodies[0] as usize)),
                    b: row.map(|r| lines.add((*r).bodies[1] as usize)),
                };
            }
            let line = &raw mut idle.line;
            let mut four = Self {
                row: [&raw mut idle.row; 4],
                a: [line; 4],
                b: [line; 4],
            };
            for k in 0..end.saturating_sub(first) {
                let row = rows.add(first + k);
                four.row[k] = row;
                four.a[k] = lines.add((*row).bodies[0] as usize);
                four.b[k] = lines.add((*row).bodies[1] as usize);
            }
            four
        }
    }
}

/// How many contacts ahead the lines are called for.
const AHEAD: usize = 16;

macro_rules! by_group {
    ($name:ident, $one:ident, $space:ty, $wide:literal) => {
        /// # Safety
        /// There are `count` rows, of bodies of `lines`; their groups are as `run` says.
        #[target_feature(enable = "avx2")]
        unsafe fn $name(
            rows: *mut PlainRow<$space>,
            groups: &[u32],
            count: usize,
            lines: *mut Line<$space>,
            relaxation: f64,
        ) {
            let mut idle = Idle::new();
            for group in groups.windows(2) {
                let [mut first, end] = [group[0], group[1]].map(|k| (k - groups[0]) as usize);
                // SAFETY: as above; bodies of contacts taken together differ where they are written.
                unsafe {
                    while $wide && first + 4 < end {
                        let idle = &mut idle;
                        let one = Four::new(rows, [first, end, count], lines, idle);
                        let two = Four::new(rows, [first + 4, end, count], lines, idle);
                        $one(
                            [one.row, two.row],
                            [one.a, two.a],
                            [one.b, two.b],
                            relaxation,
                        );
                        first += 8;
                    }
                    while first < end {
                        let one = Four::new(rows, [first, end, count], lines, &mut idle);
                        $one([one.row], [one.a], [one.b], relaxation);
                        first += 4;
                    }
                }
            }
        }
    };
}
by_group!(plane_all, plane, Plane, false);
by_group!(solid_all, solid, Solid, true);

/// # Safety
/// Rows and lines are there, and their bodies differ where they are movable.
#[inline]
#[target_feature(enable = "avx2")]
unsafe fn plane<const U: usize>(
    row: [[*mut PlainRow<Plane>; 4]; U],
    a: [[*mut Line<Plane>; 4]; U],
    b: [[*mut Line<Plane>; 4]; U],
    relaxation: f64,
) {
    let relaxation = all(relaxation);
    // SAFETY: as above; rows and lines are `repr(C)`.
    unsafe {
        let [n0, n1, pn, pt] = load(&row, 0);
        let [shift, iwn, iwt, mu] = load(&row, 4);
        let [av0, av1, a_s, aim] = load(&a, 0);
        let [bv0, bv1, b_s, bim] = load(&b, 0);
        let (mut ais, mut bis) = (all::<U>(0.0), all::<U>(0.0));
        for u in 0..U {
            let is = |l: &[*mut Line<Plane>; 4]| {
                _mm256_setr_pd((*l[0]).is, (*l[1]).is, (*l[2]).is, (*l[3]).is)
            };
            ais[u] = is(&a[u]);
            bis[u] = is(&b[u]);
        }
        let (d0, d1) = (sub(av0, bv0), sub(av1, bv1));
        let un = add(mul(n0, d0), mul(n1, d1));
        let ut = sub(sub(mul(n0, d1), mul(n1, d0)), add(a_s, b_s));
        let to_n = sub(pn, mul(add(un, shift), mul(iwn, relaxation)));
        let to_n = max(to_n, all(0.0));
        let bound = mul(mu, to_n);
        let to_t = sub(pt, mul(ut, mul(iwt, relaxation)));
        let to_t = min(max(to_t, xor(bound, all(-0.0))), bound);
        let (dn, dt) = (sub(to_n, pn), sub(to_t, pt));
        let i0 = sub(mul(n0, dn), mul(n1, dt));
        let i1 = add(mul(n1, dn), mul(n0, dt));
        // An idle row takes what it is given: its own zeros.
        store(&row, 0, [15; U], [n0, n1, to_n, to_t]);
        let (a_moves, b_moves) = (movable(aim, ais), movable(bim, bis));
        let (av0, av1) = (add(av0, mul(i0, aim)), add(av1, mul(i1, aim)));
        store(&a, 0, a_moves, [av0, av1, sub(a_s, mul(dt, ais)), aim]);
        let (bv0, bv1) = (sub(bv0, mul(i0, bim)), sub(bv1, mul(i1, bim)));
        store(&b, 0, b_moves, [bv0, bv1, sub(b_s, mul(dt, bis)), bim]);
    }
}

/// # Safety
/// Rows and lines are there, and their bodies differ where they are movable.
#[inline]
#[target_feature(enable = "avx2")]
unsafe fn solid<const U: usize>(
    row: [[*mut PlainRow<Solid>; 4]; U],
    a: [[*mut Line<Solid>; 4]; U],
    b: [[*mut Line<Solid>; 4]; U],
    relaxation: f64,
) {
    let relaxation = all(relaxation);
    // SAFETY: as above; rows and lines are `repr(C)`.
    unsafe {
        let [n0, n1, n2, pn] = load(&row, 0);
        let [t0, t1, t2, shift] = load(&row, 4);
        let [iwn, iwt, mu, _] = load(&row, 8);
        let [av0, av1, av2, as0] = load(&a, 0);
        let [as1, as2, aim, ais] = load(&a, 4);
        let [bv0, bv1, bv2, bs0] = load(&b, 0);
        let [bs1, bs2, bim, bis] = load(&b, 4);
        let n = [n0, n1, n2];
        let d = [sub(av0, bv0), sub(av1, bv1), sub(av2, bv2)];
        let un = dot(n, d);
        let [r0, r1, r2] = cross([add(as0, bs0), add(as1, bs1), add(as2, bs2)], n);
        let u0 = sub(sub(d[0], mul(n0, un)), r0);
        let u1 = sub(sub(d[1], mul(n1, un)), r1);
        let u2 = sub(sub(d[2], mul(n2, un)), r2);
        let to_n = sub(pn, mul(add(un, shift), mul(iwn, relaxation)));
        let to_n = max(to_n, all(0.0));
        let bound = mul(mu, to_n);
        let go = mul(iwt, relaxation);
        let (q0, q1, q2) = (
            sub(t0, mul(u0, go)),
            sub(t1, mul(u1, go)),
            sub(t2, mul(u2, go)),
        );
        let squared = dot([q0, q1, q2], [q0, q1, q2]);
        let sticks = not_above(squared, mul(bound, bound));
        let less = div(bound, root(squared));
        let q0 = choose(sticks, q0, mul(q0, less));
        let q1 = choose(sticks, q1, mul(q1, less));
        let q2 = choose(sticks, q2, mul(q2, less));
        let dn = sub(to_n, pn);
        let dt = [sub(q0, t0), sub(q1, t1), sub(q2, t2)];
        // An idle row takes what it is given: its own zeros.
        store(&row, 3, [15; U], [to_n, q0, q1, q2]);
        let i0 = add(mul(n0, dn), dt[0]);
        let i1 = add(mul(n1, dn), dt[1]);
        let i2 = add(mul(n2, dn), dt[2]);
        let [w0, w1, w2] = cross(n, dt);
        let (a_moves, b_moves) = (movable(aim, ais), movable(bim, bis));
        let (v0, v1, v2) = (
            add(av0, mul(i0, aim)),
            add(av1, mul(i1, aim)),
            add(av2, mul(i2, aim)),
        );
        store(&a, 0, a_moves, [v0, v1, v2, sub(as0, mul(w0, ais))]);
        let (s1, s2) = (sub(as1, mul(w1, ais)), sub(as2, mul(w2, ais)));
        store(&a, 4, a_moves, [s1, s2, aim, ais]);
        let (v0, v1, v2) = (
            sub(bv0, mul(i0, bim)),
            sub(bv1, mul(i1, bim)),
            sub(bv2, mul(i2, bim)),
        );
        store(&b, 0, b_moves, [v0, v1, v2, sub(bs0, mul(w0, bis))]);
        let (s1, s2) = (sub(bs1, mul(w1, bis)), sub(bs2, mul(w2, bis)));
        store(&b, 4, b_moves, [s1, s2, bim, bis]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solve::form::ContactForm;

    /// Pairs of bodies with velocities, masses and impulses that make some contacts stick, some slide and
    /// some open; every seventh second body is fixed.
    fn pairs<S: Space>(count: u32) -> (Vec<PlainRow<S>>, Vec<Line<S>>) {
        let wave = |k: usize, of: u32| (1.7 * k as f64 + 0.9 * f64::from(of * of % 101)).sin();
        let (mut rows, mut lines) = (Vec::new(), Vec::new());
        for pair in 0..count {
            for body in [2 * pair, 2 * pair + 1] {
                let mut line = Line::<S> {
                    v: S::Vector::null(),
                    s: S::Spin::null(),
                    im: 1.0 + 0.3 * wave(9, body),
                    is: 2.0 + 0.5 * wave(10, body),
                };
                for k in 0..S::D {
                    line.v[k] = wave(k, body);
                }
                for k in 0..S::Spin::N {
                    line.s[k] = wave(k + 4, body);
                }
                if body % 14 == 1 {
                    (line.im, line.is) = (0.0, 0.0);
                }
                lines.push(line);
            }
            let mut normal = S::Vector::null();
            for k in 0..S::D {
                normal[k] = wave(k + 20, pair);
            }
            let normal = normal * (1.0 / normal.norm());
            let [a, b] = [&lines[2 * pair as usize], &lines[2 * pair as usize + 1]];
            let contact = ContactForm {
                bodies: [2 * pair, 2 * pair + 1],
                normal,
                arms: [-normal, normal],
                central: true,
                shift_n: 0.1 * wave(30, pair),
                shift_t: S::Tangent::null(),
                friction: 0.3 + 0.3 * wave(31, pair),
                tension: 0.0,
                cohesion: 0.0,
                elastic: None,
                impulse: normal * (1.0 + wave(32, pair)),
            };
            let w_n = a.im + b.im;
            rows.push(PlainRow::new(&contact, w_n, w_n + a.is + b.is));
        }
        (rows, lines)
    }

    fn bits<S: Space>(rows: &[PlainRow<S>], lines: &[Line<S>]) -> Vec<u64> {
        let mut out = Vec::new();
        for row in rows {
            out.push(row.pn);
            out.extend(row.pt.padded());
        }
        for line in lines {
            out.extend(line.v.padded());
            out.extend(line.s.padded());
            out.extend([line.im, line.is]);
        }
        out.into_iter().map(f64::to_bits).collect()
    }

    fn same<S: Space>() {
        // Groups of all remainders, and prefetching to the end.
        let groups: Vec<u32> = vec![0, 1, 3, 6, 10, 15, 21, 28, 36, 45, 145];
        let (mut rows, mut lines) = pairs::<S>(145);
        let (mut rows_1, mut lines_1) = (rows.clone(), lines.clone());
        for relaxation in [1.0, 1.45, 1.0] {
            run(&mut rows, &groups, &Lines::new(&mut lines), relaxation);
            let one = Lines::new(&mut lines_1);
            for row in &mut rows_1 {
                let bodies = row.bodies;
                one.with(bodies, |a, b| row.update(a, b, relaxation));
            }
            assert!(bits(&rows, &lines) == bits(&rows_1, &lines_1));
        }
        let (open, all) = (rows.iter().filter(|r| r.pn == 0.0).count(), rows.len());
        assert!(open > 0 && open < all);
    }

    #[test]
    fn lanes_give_the_bits_of_single_contacts() {
        same::<Plane>();
        same::<Solid>();
    }
}
