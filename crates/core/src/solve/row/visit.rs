//! Operations applied to every row in turn: several contacts at a time with vector instructions
//! where available, otherwise one by one, with bitwise identical results.

use super::kind::{Row, RowKind};
use super::solver_bodies::{SolverBodies, SolverBody};
use super::state::Moving;
use crate::geometry::space::Space;
use crate::lanes::{BatchMut, InstructionSet, Lane, LaneVector, SUMS, Wide, prefetch};
use crate::solve::error::{ROUNDINGS, Scale, Sums};

/// An operation on rows.
pub trait Visit {
    /// Whether to process two vector registers of contacts at a time in 3D, to hide latency.
    const TWO_REGISTERS: bool;

    /// Processes rows with the bodies of either side, from row `at` on. The movable bodies differ,
    /// or are only read.
    fn visit<S: Space, K: RowKind<S>, L: Lane>(
        &mut self,
        rows: BatchMut<Row<S, K>, L>,
        a: BatchMut<SolverBody<S>, L>,
        b: BatchMut<SolverBody<S>, L>,
        at: usize,
    );
}

/// Visits a block of rows, given with the bodies of each row and the starts of its groups followed
/// by the end of the last; contacts of a group share no movable body.
pub fn visit<S: Space, K: RowKind<S>>(
    (rows, pairs): (&mut [Row<S, K>], &[[u32; 2]]),
    groups: &[u32],
    solver_bodies: &SolverBodies<S>,
    what: &mut impl Visit,
) {
    // Groups of a single contact would leave three of four lanes idle.
    let wide =
        (rows.len() >= 2 * groups.len()).then(|| InstructionSet::of_this_machine().next_back());
    match wide.flatten() {
        // SAFETY: the machine has these instructions.
        Some(with) => unsafe { visit_with(with, (rows, pairs), groups, solver_bodies, what) },
        None => visit_one_by_one((rows, pairs), solver_bodies, what),
    }
}

/// Visits rows in turn.
pub(super) fn visit_one_by_one<S: Space, K: RowKind<S>>(
    (rows, pairs): (&mut [Row<S, K>], &[[u32; 2]]),
    solver_bodies: &SolverBodies<S>,
    what: &mut impl Visit,
) {
    for (at, (row, pair)) in rows.iter_mut().zip(pairs).enumerate() {
        let [a, b] = pair.map(|body| solver_bodies.at(body));
        debug_assert!(a != b);
        // SAFETY: see `Sync` of `SolverBodies`.
        let (a, b) = unsafe { (BatchMut::new(a), BatchMut::new(b)) };
        what.visit::<S, K, f64>(BatchMut::one(row), a, b, at);
    }
}

/// Visits rows by groups.
///
/// # Safety
/// The machine has the instructions.
pub(super) unsafe fn visit_with<S: Space, K: RowKind<S>>(
    with: InstructionSet,
    (rows, pairs): (&mut [Row<S, K>], &[[u32; 2]]),
    groups: &[u32],
    solver_bodies: &SolverBodies<S>,
    what: &mut impl Visit,
) {
    debug_assert!(groups.last().map(|end| (end - groups[0]) as usize) == Some(rows.len()));
    let visit = ByGroups {
        rows: rows.as_mut_ptr(),
        pairs: &pairs[..rows.len()],
        groups,
        solver_bodies,
        what,
    };
    // SAFETY: the caller guarantees it.
    unsafe { with.run(visit) }
}

/// Rows that are visited by groups.
struct ByGroups<'a, S: Space, K: RowKind<S>, V> {
    rows: *mut Row<S, K>,
    pairs: &'a [[u32; 2]],
    groups: &'a [u32],
    solver_bodies: &'a SolverBodies<S>,
    what: &'a mut V,
}

impl<S: Space, K: RowKind<S>, V: Visit> Wide for ByGroups<'_, S, K, V> {
    #[inline(always)]
    fn run<L4: Lane, L8: Lane>(mut self) {
        let (row, body) = Row::between_immovable_bodies();
        let mut idle = IdleLanes { row, body };
        let eight = V::TWO_REGISTERS && S::D == 3 && K::EIGHT;
        for group in self.groups.windows(2) {
            let [mut at, end] = [group[0], group[1]].map(|k| (k - self.groups[0]) as usize);
            while eight && at + L8::WIDTH <= end {
                self.visit::<L8>(at, end, &mut idle);
                at += L8::WIDTH;
            }
            while at < end {
                self.visit::<L4>(at, end, &mut idle);
                at += L4::WIDTH;
            }
        }
    }
}

/// Fills the lanes without a contact.
struct IdleLanes<S: Space, K: RowKind<S>> {
    row: Row<S, K>,
    body: SolverBody<S>,
}

/// Prefetch distance in contacts.
const AHEAD: usize = 16;

impl<S: Space, K: RowKind<S>, V: Visit> ByGroups<'_, S, K, V> {
    /// Visits the rows from `at` on, up to at most `end`, the end of the group.
    #[inline(always)]
    fn visit<L: Lane>(&mut self, at: usize, end: usize, idle: &mut IdleLanes<S, K>) {
        let (rows, pairs, count) = (self.rows, self.pairs.as_ptr(), self.pairs.len());
        // SAFETY: there are as many rows as pairs, and they name bodies of `solver_bodies`; in a
        // group movable bodies differ. Idle rows and bodies may be shared, and what is read there
        // does not matter.
        let (rows, a, b) = unsafe {
            let body = |k: usize, side: usize| self.solver_bodies.at((*pairs.add(k))[side]);
            if at + AHEAD + L::WIDTH <= count {
                for k in 0..L::WIDTH {
                    prefetch(body(at + AHEAD + k, 0));
                    prefetch(body(at + AHEAD + k, 1));
                }
            }
            if at + L::WIDTH <= end {
                let rows = L::each(|k| rows.add(at + k));
                let a = L::each(|k| body(at + k, 0));
                (rows, a, L::each(|k| body(at + k, 1)))
            } else {
                let (idle_row, idle_body) = (&raw mut idle.row, &raw mut idle.body);
                let is = |k: usize| at + k < end;
                let each = L::each(|k| if is(k) { rows.add(at + k) } else { idle_row });
                let a = L::each(|k| if is(k) { body(at + k, 0) } else { idle_body });
                let b = L::each(|k| if is(k) { body(at + k, 1) } else { idle_body });
                (each, a, b)
            }
        };
        // SAFETY: as above.
        let (rows, a, b) = unsafe { (BatchMut::new(rows), BatchMut::new(a), BatchMut::new(b)) };
        self.what.visit::<S, K, L>(rows, a, b, at);
    }
}

/// Solves the contact for the current velocities, with the given relaxation, and updates the
/// velocities.
pub struct Update(pub f64);

impl Visit for Update {
    const TWO_REGISTERS: bool = true;

    #[inline(always)]
    fn visit<S: Space, K: RowKind<S>, L: Lane>(
        &mut self,
        rows: BatchMut<Row<S, K>, L>,
        mut a: BatchMut<SolverBody<S>, L>,
        mut b: BatchMut<SolverBody<S>, L>,
        _: usize,
    ) {
        let (mut i, mut j) = (Moving::load(&a), Moving::load(&b));
        Row::update(rows, &mut i, &mut j, L::all(self.0));
        i.store(&mut a);
        j.store(&mut b);
    }
}

/// Applies the stored impulse to the velocities.
pub struct Load;

impl Visit for Load {
    const TWO_REGISTERS: bool = true;

    #[inline(always)]
    fn visit<S: Space, K: RowKind<S>, L: Lane>(
        &mut self,
        rows: BatchMut<Row<S, K>, L>,
        mut a: BatchMut<SolverBody<S>, L>,
        mut b: BatchMut<SolverBody<S>, L>,
        _: usize,
    ) {
        let (mut i, mut j) = (Moving::load(&a), Moving::load(&b));
        Row::load(*rows, &mut i, &mut j);
        i.store(&mut a);
        j.store(&mut b);
    }
}

/// Sums the contributions of contacts to the convergence test.
#[derive(Default)]
pub struct MeasureErrors {
    residual: [f64; SUMS],
    velocity: [f64; SUMS],
    impulse: [f64; SUMS],
    power: [f64; SUMS],
    unbalanced: [f64; SUMS],
    slip: [f64; SUMS],
    worst: [f64; SUMS],
    worst_at: [f64; SUMS],
}

impl MeasureErrors {
    /// Returns the sums; contacts are counted from `first`.
    pub fn sums(&self, first: usize) -> Sums {
        let mut out = Sums::default();
        for k in 0..SUMS {
            out.merge(&Sums {
                residual: self.residual[k],
                velocity: self.velocity[k],
                impulse: self.impulse[k],
                power: self.power[k],
                unbalanced: self.unbalanced[k],
                slip: self.slip[k],
                worst: self.worst[k],
                worst_at: first + self.worst_at[k] as usize,
                ..Sums::default()
            });
        }
        out
    }
}

impl Visit for MeasureErrors {
    const TWO_REGISTERS: bool = false;

    #[inline(always)]
    fn visit<S: Space, K: RowKind<S>, L: Lane>(
        &mut self,
        rows: BatchMut<Row<S, K>, L>,
        a: BatchMut<SolverBody<S>, L>,
        b: BatchMut<SolverBody<S>, L>,
        at: usize,
    ) {
        let r = Row::residual(*rows, &Moving::load(&a), &Moving::load(&b));
        r.squared.add_to(&mut self.residual, at);
        r.velocity.add_to(&mut self.velocity, at);
        r.impulse.add_to(&mut self.impulse, at);
        r.power.add_to(&mut self.power, at);
        r.unbalanced.add_to(&mut self.unbalanced, at);
        r.slip.add_to(&mut self.slip, at);
        r.squared.raise(&mut self.worst, &mut self.worst_at, at);
    }
}

/// Returns the squared rounding of the relative velocity of a contact, from the squared velocities
/// of its sides and its friction.
#[inline(always)]
pub fn noise<L: Lane>(own: L, friction: L) -> L {
    let mu = friction.least(L::all(MAX_FRICTION));
    own * (L::all(1.0) + mu * mu) * L::all(ROUNDINGS)
}

/// Sums the scales of the error from the free velocities, which must be the current ones.
#[derive(Default)]
pub struct Free {
    free: [f64; SUMS],
    energy: [f64; SUMS],
    noise: [f64; SUMS],
}

/// The natural map multiplies the rounding error of a slip by mu; mu is capped here for that
/// purpose.
const MAX_FRICTION: f64 = 1e6;

impl Free {
    /// Returns the sums.
    pub fn scale(&self) -> Scale {
        let [free, energy, noise] =
            [self.free, self.energy, self.noise].map(|x| (x[0] + x[1]) + (x[2] + x[3]));
        Scale {
            free,
            energy,
            noise,
            ..Scale::default()
        }
    }
}

impl Visit for Free {
    const TWO_REGISTERS: bool = false;

    #[inline(always)]
    fn visit<S: Space, K: RowKind<S>, L: Lane>(
        &mut self,
        rows: BatchMut<Row<S, K>, L>,
        a: BatchMut<SolverBody<S>, L>,
        b: BatchMut<SolverBody<S>, L>,
        at: usize,
    ) {
        let (a, b) = (Moving::<S, L>::load(&a), Moving::<S, L>::load(&b));
        let [speed, rho, mu] = Row::speed(*rows, &a, &b);
        speed.add_to(&mut self.free, at);
        (rho * speed).add_to(&mut self.energy, at);
        let own = a.v.dot(&a.v) + a.s.dot(&a.s) + b.v.dot(&b.v) + b.s.dot(&b.s);
        noise(own, mu).add_to(&mut self.noise, at);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sums of all lanes are merged; the index of the worst contact counts from the first lane.
    #[test]
    fn sums_of_lanes_are_merged() {
        let measure = MeasureErrors {
            residual: [1.0, 2.0, 4.0, 8.0],
            slip: [16.0, 32.0, 64.0, 128.0],
            worst: [0.5, 0.75, 3.0, 1.0],
            worst_at: [0.0, 1.0, 6.0, 3.0],
            ..MeasureErrors::default()
        };
        let sums = measure.sums(10);
        assert_eq!((sums.residual, sums.slip), (15.0, 240.0));
        assert_eq!((sums.worst, sums.worst_at), (3.0, 16));
    }
}
