//! Rows of one kind, in the order of the iteration.

use super::colour::Order;
use super::error::{Scale, Sums};
use super::form::ContactForm;
use super::row::{
    self, Free, Load, LocalImpulse, Measure, Row, SolverBodies, Update, Visit, visit,
};
use crate::geometry::space::Space;
use crate::threads::{fill, fill_places, map_ranges, pays};
use std::ops::Range;

/// Contacts per task. Sums are formed per chunk and added in order.
const CHUNK: usize = 512;
/// About what making a row takes (ns).
const MAKE: f64 = 15.0;
/// About what a visit of a row takes (ns).
const VISIT: f64 = 10.0;
/// The same in a sweep, which pays from about 10,000 contacts on (ns).
const ORDERED: f64 = 14.0;

/// See the module. Rows are added in any order and sorted once.
#[derive(Debug)]
pub(super) struct Rows<R> {
    rows: Vec<R>,
    order: Order,
    /// Whether the rows are in that order.
    sorted: bool,
}

impl<R> Default for Rows<R> {
    fn default() -> Self {
        Self {
            rows: Vec::new(),
            order: Order::default(),
            sorted: true,
        }
    }
}

impl<R> Rows<R> {
    /// Removes all, and keeps the memory and the last order.
    pub fn clear(&mut self) {
        self.rows.clear();
        self.sorted = false;
    }

    pub fn len(&self) -> usize {
        self.rows.len()
    }

    /// Adds a row; gives its place until rows are sorted.
    pub fn push(&mut self, row: R) -> u32 {
        self.rows.push(row);
        self.sorted = false;
        self.rows.len() as u32 - 1
    }

    /// Where each of [`Self::all`] is in the list that [`Self::set`] made them of.
    pub fn sequence(&self) -> &[u32] {
        self.order.sequence()
    }

    /// All of them, in the order of the iteration.
    pub fn all(&self) -> &[R] {
        &self.rows
    }

    pub fn row(&self, place: u32) -> &R {
        &self.rows[place as usize]
    }

    pub fn row_mut(&mut self, place: u32) -> &mut R {
        &mut self.rows[place as usize]
    }

    /// The place of each row in the order of the iteration.
    pub fn places(&self) -> &[u32] {
        self.order.places()
    }

    /// See [`Order::changes`].
    pub fn changes(&self) -> u64 {
        self.order.changes()
    }

    /// Whether the rows are in the order of the iteration.
    pub fn sorted(&self) -> bool {
        self.sorted
    }

    /// Sorts the rows by colour.
    pub fn sort<S: Space>(&mut self, movable: &[bool])
    where
        R: Row<S>,
    {
        let Self { rows, order, .. } = self;
        order.update(rows.len(), |k| rows[k].bodies(), movable, false);
        let sorted = order.sequence().iter();
        *rows = sorted.map(|k| rows[*k as usize].clone()).collect();
        self.sorted = true;
    }

    /// Makes the rows of the contacts with these indices, in the order of the iteration.
    pub fn set<S: Space>(
        &mut self,
        of: &[u32],
        contacts: &[ContactForm<S>],
        movable: &[bool],
        parallel: bool,
        row: impl Fn(&ContactForm<S>) -> R + Sync + Send,
    ) where
        R: Row<S>,
    {
        let bodies = |k: usize| contacts[of[k] as usize].bodies;
        self.order.update(of.len(), bodies, movable, parallel);
        let places = self.order.places();
        assert_eq!(places.len(), of.len(), "one place for each contact");
        let divide = pays(parallel, places.len(), MAKE);
        // SAFETY: the places of an order are a permutation.
        unsafe {
            fill_places(divide, &mut self.rows, places, |k| {
                row(&contacts[of[k] as usize])
            });
        }
        self.sorted = true;
    }

    /// Solves the contacts one after the other, see [`Update`].
    pub fn sweep<S: Space>(
        &mut self,
        solver_bodies: &SolverBodies<S>,
        relaxation: f64,
        parallel: bool,
    ) where
        R: Row<S>,
    {
        self.pass(solver_bodies, parallel, |_, _| Update(relaxation));
    }

    /// As [`Self::sweep`], from impulses extrapolated by `factor` times their change since `before`, which then holds them as they
    /// were.
    pub fn sweep_extrapolated<S: Space>(
        &mut self,
        solver_bodies: &SolverBodies<S>,
        relaxation: f64,
        parallel: bool,
        (before, factor): (&mut [LocalImpulse<S>], f64),
    ) where
        R: Row<S>,
    {
        assert_eq!(before.len(), self.rows.len());
        let before = Shared(before.as_mut_ptr());
        self.pass(solver_bodies, parallel, |rows, range| {
            // SAFETY: as many as there are rows; blocks are disjoint, and each is run once.
            let before = unsafe { before.slice(range) };
            for (row, before) in rows.iter_mut().zip(before) {
                let (n, t) = row.local_impulse();
                row.set_local_impulse((n + (n - before.0) * factor, t + (t - before.1) * factor));
                *before = (n, t);
            }
            Update(relaxation)
        });
    }

    /// Applies the stored impulses to the velocities.
    pub fn load<S: Space>(&mut self, solver_bodies: &SolverBodies<S>, parallel: bool)
    where
        R: Row<S>,
    {
        self.pass(solver_bodies, parallel, |_, _| Load);
    }

    /// Applies a visitor to all rows, block by block; `what` gives it for each, after it has seen the rows and their range.
    fn pass<S: Space, V: Visit>(
        &mut self,
        solver_bodies: &SolverBodies<S>,
        parallel: bool,
        what: impl Fn(&mut [R], Range<usize>) -> V + Sync,
    ) where
        R: Row<S>,
    {
        let (schedule, count) = (self.order.schedule(), self.rows.len());
        assert!(
            schedule.contacts() == count,
            "rows are sorted before they are visited"
        );
        let rows = Shared(self.rows.as_mut_ptr());
        schedule.run(pays(parallel, count, ORDERED), |block| {
            // SAFETY: blocks are disjoint, and each is run once.
            let part = unsafe { rows.slice(schedule.block(block)) };
            let mut visitor = what(part, schedule.block(block));
            visit(part, schedule.groups(block), solver_bodies, &mut visitor);
        });
    }

    /// Appends the components of the impulses.
    pub fn store<S: Space>(&self, out: &mut Vec<f64>)
    where
        R: Row<S>,
    {
        let rows = self.rows.iter();
        rows.for_each(|r| row::store::<S>(r.local_impulse(), out));
    }

    /// Takes them from the front of `from`.
    pub fn restore<S: Space>(&mut self, from: &mut &[f64])
    where
        R: Row<S>,
    {
        let rows = self.rows.iter_mut();
        rows.for_each(|r| r.set_local_impulse(row::restore::<S>(from)));
    }

    /// The impulses.
    pub fn local_impulses<S: Space>(&self, parallel: bool) -> Vec<LocalImpulse<S>>
    where
        R: Row<S>,
    {
        let (mut parts, count) = (Vec::new(), self.rows.len());
        fill(pays(parallel, count, VISIT), &mut parts, count, |k| {
            self.rows[k].local_impulse()
        });
        parts
    }

    /// Adds the contributions to the convergence test; rows are counted from `first`.
    pub fn measure<S: Space>(
        &mut self,
        solver_bodies: &SolverBodies<S>,
        first: usize,
        parallel: bool,
        sums: &mut Sums,
    ) where
        R: Row<S>,
    {
        let parts = self.read(solver_bodies, parallel, Measure::default, |m, at| {
            m.sums(first + at)
        });
        parts.iter().for_each(|part| sums.merge(part));
    }

    /// The work on the compliance of the contacts, see [`Row::yields`].
    pub fn yields<S: Space>(&self, solver_bodies: &SolverBodies<S>, parallel: bool) -> f64
    where
        R: Row<S>,
    {
        let of = |row: &R| {
            let (a, b) = solver_bodies.read(row.bodies());
            row.yields(&a, &b)
        };
        let count = self.rows.len();
        let parts = map_ranges(pays(parallel, count, VISIT), count, CHUNK, |range| {
            self.rows[range].iter().map(of).sum::<f64>()
        });
        parts.iter().sum()
    }

    /// The scales of the error from the free velocities, which are the current ones.
    pub fn free<S: Space>(&mut self, solver_bodies: &SolverBodies<S>, parallel: bool) -> Scale
    where
        R: Row<S>,
    {
        let parts = self.read(solver_bodies, parallel, Free::default, |f, _| f.scale());
        let mut out = Scale::default();
        parts.iter().for_each(|part| out.add(part));
        out
    }

    /// Applies a visitor that only reads to each chunk of rows; what it found, in their order.
    fn read<S: Space, V: Visit, T: Send>(
        &mut self,
        solver_bodies: &SolverBodies<S>,
        parallel: bool,
        what: impl Fn() -> V + Sync,
        found: impl Fn(&V, usize) -> T + Sync,
    ) -> Vec<T>
    where
        R: Row<S>,
    {
        let count = self.rows.len();
        let rows = Shared(self.rows.as_mut_ptr());
        map_ranges(pays(parallel, count, VISIT), count, CHUNK, |range| {
            let at = range.start;
            let groups = [0, range.len() as u32];
            // SAFETY: chunks are disjoint, and each is read once.
            let part = unsafe { rows.slice(range) };
            let mut visitor = what();
            visit(part, &groups, solver_bodies, &mut visitor);
            found(&visitor, at)
        })
    }
}

/// Rows accessed by several threads, each in its own part.
struct Shared<R>(*mut R);

// SAFETY: each part is used by one thread.
unsafe impl<R: Send> Sync for Shared<R> {}

impl<R> Shared<R> {
    /// # Safety
    /// The places are those of rows that no one else uses meanwhile.
    #[inline(always)]
    #[expect(clippy::mut_from_ref)]
    unsafe fn slice(&self, places: Range<usize>) -> &mut [R] {
        // SAFETY: as above.
        unsafe { std::slice::from_raw_parts_mut(self.0.add(places.start), places.len()) }
    }
}
