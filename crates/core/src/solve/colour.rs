//! Order of the Gauss-Seidel iteration: groups of contacts that share no movable body, so that
//! several can be solved at once without data dependency, and blocks that are distributed over
//! threads.
//!
//! Contacts arrive sorted in space and are coloured greedily in that order, as in Box2D v3. A small
//! problem is coloured as a whole, and its blocks are pieces of a colour. A large problem is cut
//! into blocks of neighbouring contacts, which are coloured so that blocks of one colour share no
//! movable body; a block is divided into parts whose velocities fit into the L1 cache, and the
//! contacts of each part are coloured in turn. In both cases blocks of one colour can be solved in
//! any order by any number of threads, with bitwise identical results.

use super::schedule::Schedule;
use crate::threads::{map_chunks_mut, map_with_memory, worth_dividing};

/// Maximum number of colours, of blocks and within a part.
const COLOURS: usize = 32;
/// Maximum number of contacts of a small problem.
const MAX_SMALL_PROBLEM: usize = 32_768;
/// Number of contacts of a part, and of a block of a small problem.
const PART: usize = 512;
/// Maximum number of parts of a block.
const PARTS: usize = 8;
/// Target number of blocks, where blocks can be small enough.
const BLOCKS: usize = 128;
/// A body in more blocks than this would prevent their parallel solution; its contacts are solved
/// separately.
const HUB: u32 = 16;

/// Number of contacts of a task.
const CHUNK: usize = 4096;
/// Approximate time to read the bodies of a contact (ns).
const READ: f64 = 4.0;
/// Approximate time to colour a contact (ns).
const COLOUR: f64 = 15.0;

/// Colouring state of a body: the last visitor, and the colours in use.
#[derive(Clone, Copy, Default)]
struct BodyColours {
    by: u32,
    taken: u32,
}

/// The order of contacts, reused from step to step and recomputed when the contacts change.
#[derive(Clone, Debug, Default)]
pub struct ContactOrder {
    bodies: Vec<[u32; 2]>,
    movable: Vec<bool>,
    sequence: Vec<u32>,
    places: Vec<u32>,
    pairs: Vec<[u32; 2]>,
    schedule: Schedule,
    /// Number of times that the order was computed.
    changes: u64,
}

impl ContactOrder {
    /// Returns a number that changes with the contacts, their bodies, or which bodies move.
    pub fn changes(&self) -> u64 {
        self.changes
    }

    /// Updates the order for `count` contacts, between the bodies that `of` gives.
    pub fn update(
        &mut self,
        count: usize,
        of: impl Fn(usize) -> [u32; 2] + Sync,
        movable: &[bool],
        parallel: bool,
    ) {
        let same = self.movable == movable && self.bodies.len() == count;
        self.bodies.resize(count, [0, 0]);
        let divide = worth_dividing(parallel, count, READ);
        let changed = map_chunks_mut(divide, &mut self.bodies, CHUNK, |first, bodies| {
            let mut same = true;
            for (old, k) in bodies.iter_mut().zip(first..) {
                let new = of(k);
                same &= *old == new;
                *old = new;
            }
            !same
        });
        if same && !changed.contains(&true) {
            return;
        }
        self.changes += 1;
        self.movable.clear();
        self.movable.extend_from_slice(movable);
        (self.sequence, self.schedule) = order(&self.bodies, movable, parallel);
        let pairs = self.sequence.iter().map(|k| self.bodies[*k as usize]);
        self.pairs = pairs.collect();
        self.places.resize(self.sequence.len(), 0);
        for (k, old) in self.sequence.iter().enumerate() {
            self.places[*old as usize] = k as u32;
        }
    }

    /// Returns the old index of each contact in the new order.
    pub fn sequence(&self) -> &[u32] {
        &self.sequence
    }

    /// Returns the bodies of each contact in the new order.
    pub fn pairs(&self) -> &[[u32; 2]] {
        &self.pairs
    }

    /// Returns the new index of each contact.
    pub fn places(&self) -> &[u32] {
        &self.places
    }

    /// Returns the schedule of the new order.
    pub fn schedule(&self) -> &Schedule {
        &self.schedule
    }
}

/// Sorts contacts for the iteration. Returns the permutation (`order[k]` is the old index of the
/// k-th) and the schedule of the new order.
fn order(bodies: &[[u32; 2]], movable: &[bool], parallel: bool) -> (Vec<u32>, Schedule) {
    let span = PART * (bodies.len().div_ceil(PART * BLOCKS)).clamp(1, PARTS);
    let mut sorting = Sorting {
        bodies,
        movable,
        seen: vec![BodyColours::default(); movable.len()],
        order: Vec::with_capacity(bodies.len()),
        schedule: Schedule::default(),
    };
    if bodies.len() <= MAX_SMALL_PROBLEM {
        let (mut seen, mut groups) = (sorting.seen, ColourGroups::default());
        groups.add(bodies, movable, &mut seen, 0..bodies.len(), 1);
        return (groups.order, Schedule::of_groups(groups.ends).cut(PART));
    }
    let hubs = Hubs::find(&mut sorting, span);
    let blocks = sorting.colour_blocks(span, &hubs);
    sorting.group_blocks(&blocks, span, &hubs, parallel);
    sorting.append_hubs(&hubs);
    (sorting.order, sorting.schedule)
}

/// The sorting of contacts: the order so far and its schedule.
struct Sorting<'a> {
    bodies: &'a [[u32; 2]],
    movable: &'a [bool],
    seen: Vec<BodyColours>,
    order: Vec<u32>,
    schedule: Schedule,
}

/// Bodies that are shared by too many blocks.
struct Hubs {
    is_hub: Vec<bool>,
    any: bool,
}

impl Hubs {
    fn find(sorting: &mut Sorting, span: usize) -> Self {
        let Sorting {
            bodies,
            movable,
            seen,
            ..
        } = sorting;
        for (block, pairs) in bodies.chunks(span).enumerate() {
            for body in pairs.iter().flat_map(|p| moved(p, movable)).flatten() {
                let seen = &mut seen[body];
                if seen.by != block as u32 + 1 {
                    seen.by = block as u32 + 1;
                    seen.taken += 1;
                }
            }
        }
        let is_hub: Vec<bool> = seen.iter().map(|s| s.taken > HUB).collect();
        Self {
            any: is_hub.iter().any(|h| *h),
            is_hub,
        }
    }

    /// Returns whether a contact moves a hub.
    #[inline]
    fn touch(&self, pair: &[u32; 2], movable: &[bool]) -> bool {
        self.any
            && moved(pair, movable)
                .iter()
                .flatten()
                .any(|b| self.is_hub[*b])
    }
}

/// Returns the movable bodies of a contact.
#[inline]
fn moved(pair: &[u32; 2], movable: &[bool]) -> [Option<usize>; 2] {
    pair.map(|b| movable[b as usize].then_some(b as usize))
}

impl Sorting<'_> {
    /// Colours the blocks, without the contacts of hubs; returns colour and index of each block,
    /// sorted.
    fn colour_blocks(&mut self, span: usize, hubs: &Hubs) -> Vec<(u32, u32)> {
        let Self {
            bodies,
            movable,
            seen,
            ..
        } = self;
        seen.fill(BodyColours::default());
        let mut blocks: Vec<(u32, u32)> = Vec::new();
        for (block, pairs) in bodies.chunks(span).enumerate() {
            let own = || {
                let own = pairs.iter().filter(|p| !hubs.touch(p, movable));
                own.flat_map(|p| moved(p, movable)).flatten()
            };
            let mut taken = 0;
            for body in own() {
                taken |= seen[body].taken;
            }
            // A block without a free colour gets a new one of its own.
            let colour = (!taken).trailing_zeros();
            for body in own() {
                seen[body].taken |= 1u32.checked_shl(colour).unwrap_or(0);
            }
            let alone = if colour < COLOURS as u32 {
                colour
            } else {
                colour + block as u32
            };
            blocks.push((alone, block as u32));
        }
        blocks.sort_unstable();
        blocks
    }

    /// Forms the groups of the blocks, colour by colour and part by part; blocks are divided among
    /// threads.
    fn group_blocks(&mut self, blocks: &[(u32, u32)], span: usize, hubs: &Hubs, parallel: bool) {
        let (bodies, movable) = (self.bodies, self.movable);
        let memory = || (vec![BodyColours::default(); movable.len()], 0);
        let divide = worth_dividing(parallel, bodies.len(), COLOUR);
        let grouped = map_with_memory(divide, blocks.len(), memory, |(seen, mark), k| {
            let first = blocks[k].1 as usize * span;
            let end = bodies.len().min(first + span);
            let mut groups = ColourGroups::default();
            for from in (first..end).step_by(PART) {
                *mark += 1;
                let part = from..end.min(from + PART);
                let part = part.filter(|k| !hubs.touch(&bodies[*k], movable));
                groups.add(bodies, movable, seen, part, *mark);
            }
            groups
        });
        let mut grouped = grouped.into_iter();
        for same in blocks.chunk_by(|a, b| a.0 == b.0) {
            for groups in grouped.by_ref().take(same.len()) {
                let first = self.order.len() as u32;
                self.order.extend(groups.order);
                for end in groups.ends {
                    self.schedule.end_group((first + end) as usize);
                }
                self.schedule.end_block();
            }
            self.schedule.end_colour();
        }
    }

    /// Appends the contacts of hubs in a separate block, each in its own group.
    fn append_hubs(&mut self, hubs: &Hubs) {
        if !hubs.any {
            return;
        }
        for (k, pair) in self.bodies.iter().enumerate() {
            if hubs.touch(pair, self.movable) {
                self.order.push(k as u32);
                self.schedule.end_group(self.order.len());
            }
        }
        self.schedule.end_block();
        self.schedule.end_colour();
    }
}

/// Contacts grouped by colour, part by part.
#[derive(Default)]
struct ColourGroups {
    order: Vec<u32>,
    /// End of each group in the order.
    ends: Vec<u32>,
}

impl ColourGroups {
    /// Appends the contacts of a part. `seen` has one entry per body; `mark` is different for each
    /// part.
    fn add(
        &mut self,
        bodies: &[[u32; 2]],
        movable: &[bool],
        seen: &mut [BodyColours],
        part: impl Iterator<Item = usize>,
        mark: u32,
    ) {
        let Self { order, ends } = self;
        let mut sizes = [0u32; COLOURS + 1];
        let mut coloured = Vec::with_capacity(part.size_hint().1.unwrap_or(0));
        for k in part {
            let pair = moved(&bodies[k], movable);
            let mut taken = 0;
            for body in pair.into_iter().flatten() {
                let seen = &mut seen[body];
                if seen.by != mark {
                    *seen = BodyColours { by: mark, taken: 0 };
                }
                taken |= seen.taken;
            }
            let colour = (!taken).trailing_zeros();
            for body in pair.into_iter().flatten() {
                seen[body].taken |= 1u32.checked_shl(colour).unwrap_or(0);
            }
            sizes[colour as usize] += 1;
            coloured.push((k as u32, colour as u8));
        }
        let mut next = [0u32; COLOURS + 1];
        let mut at = order.len();
        for (colour, size) in sizes.iter().enumerate() {
            next[colour] = at as u32;
            if colour < COLOURS {
                at += *size as usize;
                ends.push(at as u32);
            } else {
                // Contacts without a colour may share a body and form groups of one.
                for _ in 0..*size {
                    at += 1;
                    ends.push(at as u32);
                }
            }
        }
        order.resize(at, 0);
        for (k, colour) in &coloured {
            let slot = &mut next[usize::from(*colour)];
            order[*slot as usize] = *k;
            *slot += 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::schedule::ranges;
    use super::*;

    fn check(bodies: &[[u32; 2]], fixed: u32, count: usize) -> Schedule {
        let movable: Vec<bool> = (0..count as u32).map(|b| b != fixed).collect();
        let (order, schedule) = order(bodies, &movable, false);
        let pool = rayon::ThreadPoolBuilder::new().num_threads(3).build();
        let divided = pool
            .unwrap()
            .install(|| super::order(bodies, &movable, true));
        assert_eq!(divided, (order.clone(), schedule.clone()));
        let mut seen = order.clone();
        seen.sort_unstable();
        assert!(seen.iter().enumerate().all(|(k, o)| k as u32 == *o));
        assert_eq!(order.len(), bodies.len());
        let strangers = |sets: Vec<Vec<u32>>| {
            let mut all = Vec::new();
            for mut set in sets {
                set.sort_unstable();
                set.dedup();
                all.extend(set);
            }
            let n = all.len();
            all.sort_unstable();
            all.dedup();
            assert_eq!(all.len(), n);
        };
        let touched = |places: std::ops::Range<usize>| -> Vec<u32> {
            let pairs = order[places].iter().flat_map(|k| bodies[*k as usize]);
            pairs.filter(|b| *b != fixed).collect()
        };
        let mut covered = 0;
        for blocks in schedule.colours() {
            strangers(blocks.clone().map(|k| touched(schedule.block(k))).collect());
            for block in blocks {
                assert_eq!(schedule.block(block).start, covered);
                for group in ranges(schedule.groups(block)) {
                    assert_eq!(group.start, covered);
                    covered = group.end;
                    strangers(group.map(|k| touched(k..k + 1)).collect());
                }
            }
        }
        assert_eq!(covered, bodies.len());
        schedule
    }

    #[test]
    fn what_runs_at_once_shares_no_movable_body() {
        let blocks = lattice(160);
        assert!(blocks.len() < 8 && blocks.iter().sum::<usize>() > 50);
        lattice(60);
        lattice(10);
    }

    /// Returns the blocks of each colour for a square lattice on a floor.
    fn lattice(side: u32) -> Vec<usize> {
        let mut bodies = Vec::new();
        for k in 0..side * side {
            if k % side + 1 < side {
                bodies.push([k, k + 1]);
            }
            if k + side < side * side {
                bodies.push([k, k + side]);
            }
            if k < side {
                bodies.push([k, side * side]);
            }
        }
        let schedule = check(&bodies, side * side, (side * side + 1) as usize);
        schedule.colours().map(|c| c.len()).collect()
    }

    #[test]
    fn a_hub_does_not_keep_others_apart() {
        // A chain whose links all touch one movable plate.
        let n = 20_000;
        let bodies: Vec<[u32; 2]> = (0..n).flat_map(|k| [[k, k + 1], [k, n + 1]]).collect();
        let schedule = check(&bodies, n + 2, n as usize + 3);
        assert!(schedule.colours().count() < 8);
    }

    #[test]
    fn a_star_runs_in_order() {
        let star: Vec<[u32; 2]> = (1..100).map(|k| [0, k]).collect();
        let schedule = check(&star, 100, 101);
        assert_eq!(schedule.groups(0).len(), 100);
        check(&[], 0, 1);
    }

    /// The bodies 0 and 3 are hubs, of which 3 does not move.
    #[test]
    fn a_contact_touches_the_hubs_that_it_moves() {
        let movable = [true, true, true, false];
        let mut hubs = Hubs {
            is_hub: vec![true, false, false, true],
            any: true,
        };
        for (pair, touches) in [
            ([0, 1], true),
            ([2, 0], true),
            ([1, 2], false),
            ([1, 3], false),
        ] {
            assert_eq!(hubs.touch(&pair, &movable), touches, "{pair:?}");
        }
        hubs.any = false;
        assert!(!hubs.touch(&[1, 2], &movable));
    }
}
