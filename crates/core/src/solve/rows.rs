//! Rows of one kind, in the order of the iteration.

use super::colour::ContactOrder;
use super::error::{Scale, Sums};
use super::form::{ContactForm, ContactSolution};
use super::row::{
    self, Free, Load, MeasureErrors, Parts, RigidBodies, Row, RowKind, SolverBodies, SolverBody,
    Update, Visit, visit,
};
use crate::geometry::space::Space;
use crate::threads::{fill, fill_places, map_ranges, worth_dividing};
use std::ops::Range;

/// Number of contacts per task. Sums are formed per chunk and added in order.
const CHUNK: usize = 512;
/// Approximate time to create a row (ns).
const MAKE: f64 = 15.0;
/// Approximate time of a visit of a row (ns).
const VISIT: f64 = 10.0;
/// Approximate time per contact of a sweep (ns), set so that threads share it from about 10,000
/// contacts on.
const ORDERED: f64 = 14.0;

/// The contacts of one kind. Rows are added in any order and sorted once.
#[derive(Debug)]
pub(in crate::solve) struct Rows<S: Space, K: RowKind<S>> {
    rows: Vec<Row<S, K>>,
    /// Bodies of the rows, until they are sorted.
    pushed: Vec<[u32; 2]>,
    order: ContactOrder,
    /// Whether the rows are in the order of the iteration.
    sorted: bool,
}

impl<S: Space, K: RowKind<S>> Default for Rows<S, K> {
    fn default() -> Self {
        Self {
            rows: Vec::new(),
            pushed: Vec::new(),
            order: ContactOrder::default(),
            sorted: true,
        }
    }
}

impl<S: Space, K: RowKind<S>> Rows<S, K> {
    /// Removes all, and keeps the memory and the last order.
    pub fn clear(&mut self) {
        self.rows.clear();
        self.pushed.clear();
        self.sorted = false;
    }

    pub fn len(&self) -> usize {
        self.rows.len()
    }

    /// Returns whether bonds may act on contacts of this kind.
    pub fn may_have_bonds(&self) -> bool {
        K::BONDS && !self.rows.is_empty()
    }

    /// Adds a row; returns its index, valid until rows are sorted.
    pub fn push(&mut self, contact: &ContactForm<S>, bodies: &RigidBodies<S>) -> u32 {
        if self.sorted {
            self.pushed = self.pairs().to_vec();
        }
        self.rows.push(Row::new(contact, bodies));
        self.pushed.push(contact.bodies);
        self.sorted = false;
        self.rows.len() as u32 - 1
    }

    /// Returns the index of each row of [`Self::all`] in the list given to [`Self::set`].
    pub fn sequence(&self) -> &[u32] {
        self.order.sequence()
    }

    /// Returns all rows, in the order of the iteration.
    pub fn all(&self) -> &[Row<S, K>] {
        &self.rows
    }

    /// Returns the bodies of each row of [`Self::all`].
    pub fn pairs(&self) -> &[[u32; 2]] {
        if self.sorted {
            self.order.pairs()
        } else {
            &self.pushed
        }
    }

    pub fn row(&self, place: u32) -> &Row<S, K> {
        &self.rows[place as usize]
    }

    pub fn row_mut(&mut self, place: u32) -> &mut Row<S, K> {
        &mut self.rows[place as usize]
    }

    /// The records of the bodies of a row.
    fn bodies<'a>(&self, place: u32, all: &'a [SolverBody<S>]) -> [&'a SolverBody<S>; 2] {
        self.pairs()[place as usize].map(|b| &all[b as usize])
    }

    /// The solution of a row at the current velocities.
    pub fn solution(&self, place: u32, bodies: &[SolverBody<S>]) -> ContactSolution<S> {
        let [a, b] = self.bodies(place, bodies);
        self.row(place).solution(a, b)
    }

    /// Sets the impulse of a row to the solution for the current velocities, which it does not
    /// change.
    pub fn solve_at(&mut self, place: u32, bodies: &[SolverBody<S>]) {
        let [a, b] = self.bodies(place, bodies);
        self.row_mut(place).solve_at(a, b);
    }

    /// Returns the place of each row in the order of the iteration.
    pub fn places(&self) -> &[u32] {
        self.order.places()
    }

    /// Returns a number that changes with the order of the rows ([`ContactOrder::changes`]).
    pub fn changes(&self) -> u64 {
        self.order.changes()
    }

    /// Whether the rows are in the order of the iteration.
    pub fn sorted(&self) -> bool {
        self.sorted
    }

    /// Sorts the rows by colour.
    pub fn sort(&mut self, movable: &[bool]) {
        let pushed = self.pairs().to_vec();
        self.order
            .update(pushed.len(), |k| pushed[k], movable, false);
        let sorted = self.order.sequence().iter();
        self.rows = sorted.map(|k| self.rows[*k as usize].clone()).collect();
        self.sorted = true;
    }

    /// Creates the rows of the contacts with these indices, in the order of the iteration.
    pub fn set(
        &mut self,
        of: &[u32],
        contacts: &[ContactForm<S>],
        movable: &[bool],
        bodies: &RigidBodies<S>,
        parallel: bool,
    ) {
        let pair = |k: usize| contacts[of[k] as usize].bodies;
        self.order.update(of.len(), pair, movable, parallel);
        let places = self.order.places();
        assert_eq!(places.len(), of.len(), "one place for each contact");
        let divide = worth_dividing(parallel, places.len(), MAKE);
        // SAFETY: the places of an order are a permutation.
        unsafe {
            fill_places(divide, &mut self.rows, places, |k| {
                Row::new(&contacts[of[k] as usize], bodies)
            });
        }
        self.sorted = true;
    }

    /// Solves the contacts one after the other, see [`Update`].
    pub fn sweep(&mut self, solver_bodies: &SolverBodies<S>, relaxation: f64, parallel: bool) {
        self.pass(solver_bodies, parallel, |_, _| Update(relaxation));
    }

    /// Sweeps as [`Self::sweep`] does, from impulses extrapolated by `factor` times their change
    /// since `before`; `before` then holds the impulses before the extrapolation.
    pub fn sweep_extrapolated(
        &mut self,
        solver_bodies: &SolverBodies<S>,
        relaxation: f64,
        parallel: bool,
        (before, factor): (&mut [Parts<S>], f64),
    ) {
        assert_eq!(before.len(), self.rows.len());
        let before = SharedRows(before.as_mut_ptr());
        self.pass(solver_bodies, parallel, |rows, range| {
            // SAFETY: there are as many entries as rows; blocks are disjoint, and each is run once.
            let before = unsafe { before.slice(range) };
            for (row, before) in rows.iter_mut().zip(before) {
                let now = row.local_impulse();
                row.set_local_impulse(now + (now - *before) * factor);
                *before = now;
            }
            Update(relaxation)
        });
    }

    /// Applies the stored impulses to the velocities.
    pub fn load(&mut self, solver_bodies: &SolverBodies<S>, parallel: bool) {
        self.pass(solver_bodies, parallel, |_, _| Load);
    }

    /// Applies a visitor to all rows, block by block; `what` creates the visitor of each block from
    /// its rows and their range.
    fn pass<V: Visit>(
        &mut self,
        solver_bodies: &SolverBodies<S>,
        parallel: bool,
        what: impl Fn(&mut [Row<S, K>], Range<usize>) -> V + Sync,
    ) {
        let (schedule, count) = (self.order.schedule(), self.rows.len());
        assert!(
            schedule.contacts() == count,
            "rows are sorted before they are visited"
        );
        let rows = SharedRows(self.rows.as_mut_ptr());
        let pairs = self.order.pairs();
        schedule.run(worth_dividing(parallel, count, ORDERED), |block| {
            // SAFETY: blocks are disjoint, and each is run once.
            let part = unsafe { rows.slice(schedule.block(block)) };
            let mut visitor = what(part, schedule.block(block));
            let rows = (part, &pairs[schedule.block(block)]);
            visit(rows, schedule.groups(block), solver_bodies, &mut visitor);
        });
    }

    /// Appends the components of the impulses.
    pub fn store(&self, out: &mut Vec<f64>) {
        let rows = self.rows.iter();
        rows.for_each(|r| row::store(r.local_impulse(), out));
    }

    /// Reads the components of the impulses from the front of `from`.
    pub fn restore(&mut self, from: &mut &[f64]) {
        let rows = self.rows.iter_mut();
        rows.for_each(|r| r.set_local_impulse(row::restore(from)));
    }

    /// The impulses.
    pub fn local_impulses(&self, parallel: bool) -> Vec<Parts<S>> {
        let (mut parts, count) = (Vec::new(), self.rows.len());
        fill(
            worth_dividing(parallel, count, VISIT),
            &mut parts,
            count,
            |k| self.rows[k].local_impulse(),
        );
        parts
    }

    /// Adds the contributions to the convergence test; rows are counted from `first`.
    pub fn measure(
        &mut self,
        solver_bodies: &SolverBodies<S>,
        first: usize,
        parallel: bool,
        sums: &mut Sums,
    ) {
        let parts = self.read(solver_bodies, parallel, MeasureErrors::default, |m, at| {
            m.sums(first + at)
        });
        parts.iter().for_each(|part| sums.merge(part));
    }

    /// Returns the work on the compliance of the contacts, see [`Row::work_on_compliance`].
    pub fn work_on_compliance(&self, solver_bodies: &SolverBodies<S>, parallel: bool) -> f64 {
        let (count, pairs) = (self.rows.len(), self.pairs());
        let of = |k: usize| {
            let (a, b) = solver_bodies.read(pairs[k]);
            self.rows[k].work_on_compliance(&a, &b)
        };
        let parts = map_ranges(
            worth_dividing(parallel, count, VISIT),
            count,
            CHUNK,
            |range| range.map(of).sum::<f64>(),
        );
        parts.iter().sum()
    }

    /// Returns the scales of the error from the free velocities, which must be the current ones.
    pub fn free(&mut self, solver_bodies: &SolverBodies<S>, parallel: bool) -> Scale {
        let parts = self.read(solver_bodies, parallel, Free::default, |f, _| f.scale());
        let mut out = Scale::default();
        parts.iter().for_each(|part| out.add(part));
        out
    }

    /// Applies a visitor that only reads to each chunk of rows; returns the visitors in the order
    /// of the chunks.
    fn read<V: Visit, T: Send>(
        &mut self,
        solver_bodies: &SolverBodies<S>,
        parallel: bool,
        what: impl Fn() -> V + Sync,
        found: impl Fn(&V, usize) -> T + Sync,
    ) -> Vec<T> {
        let count = self.rows.len();
        let rows = SharedRows(self.rows.as_mut_ptr());
        let pairs = self.pairs();
        map_ranges(
            worth_dividing(parallel, count, VISIT),
            count,
            CHUNK,
            |range| {
                let at = range.start;
                let groups = [0, range.len() as u32];
                let bodies = &pairs[range.clone()];
                // SAFETY: chunks are disjoint, and each is read once.
                let part = unsafe { rows.slice(range) };
                let mut visitor = what();
                visit((part, bodies), &groups, solver_bodies, &mut visitor);
                found(&visitor, at)
            },
        )
    }
}

/// Rows accessed by several threads, each in its own part.
struct SharedRows<R>(*mut R);

// SAFETY: each part is used by one thread.
unsafe impl<R: Send> Sync for SharedRows<R> {}

impl<R> SharedRows<R> {
    /// # Safety
    /// No one else may use the rows at these places meanwhile.
    #[inline(always)]
    #[expect(clippy::mut_from_ref)]
    unsafe fn slice(&self, places: Range<usize>) -> &mut [R] {
        // SAFETY: the caller guarantees exclusive use of these rows.
        unsafe { std::slice::from_raw_parts_mut(self.0.add(places.start), places.len()) }
    }
}
