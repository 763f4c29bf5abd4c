//! Order of the Gauss-Seidel iteration: groups of contacts that share no movable body, so that several can
//! be solved at once without data dependency, and blocks that are distributed over threads.
//!
//! Contacts arrive sorted in space and are coloured greedily in that order, as in Box2D v3. A small problem
//! is coloured as a whole, and its blocks are pieces of a colour. A large problem is cut into blocks of
//! neighbouring contacts, which are coloured so that blocks of one colour share no movable body; a block is
//! divided into parts whose velocities fit into the L1 cache, and the contacts of each part are coloured in
//! turn. In both cases blocks of one colour can be solved in any order by any number of threads, with
//! bitwise identical results.

use std::sync::atomic::{AtomicUsize, Ordering};

/// Maximum number of colours, of blocks and within a part.
const COLOURS: usize = 32;
/// Maximum number of contacts of a small problem.
const SMALL: usize = 32_768;
/// Number of contacts of a part, and of a block of a small problem.
const PART: usize = 512;
/// Maximum number of parts of a block.
const PARTS: usize = 8;
/// Target number of blocks, where blocks can be small enough.
const BLOCKS: usize = 128;
/// A body in more blocks than this would prevent their parallel solution; its contacts are solved
/// separately.
const HUB: u32 = 16;

/// Groups, blocks of groups, and colours of blocks; each list holds the start indices and the final end.
#[derive(Clone, Debug)]
pub struct Schedule {
    groups: Vec<u32>,
    blocks: Vec<u32>,
    colours: Vec<u32>,
}

impl Default for Schedule {
    fn default() -> Self {
        Self {
            groups: vec![0],
            blocks: vec![0],
            colours: vec![0],
        }
    }
}

impl Schedule {
    /// Iterates over the ranges of blocks of each colour, in the order of the iteration.
    pub fn colours(&self) -> impl Iterator<Item = std::ops::Range<usize>> {
        ranges(&self.colours)
    }

    /// Returns the range of contacts of a block, in the new order.
    pub fn block(&self, k: usize) -> std::ops::Range<usize> {
        let [from, to] = [k, k + 1].map(|k| self.groups[self.blocks[k] as usize] as usize);
        from..to
    }

    /// Returns the starts of the groups of a block, and the end of the last.
    pub fn groups(&self, k: usize) -> &[u32] {
        &self.groups[self.blocks[k] as usize..=self.blocks[k + 1] as usize]
    }

    /// Runs every block once, colour by colour, on the current thread pool if `parallel`.
    ///
    /// Threads take blocks from a shared counter, in the order of the iteration, and wait only for the
    /// blocks of earlier colours that were taken; nobody waits for a thread that has not started.
    pub fn run(&self, parallel: bool, block: impl Fn(usize) + Sync) {
        let blocks = self.blocks.len() - 1;
        let threads = rayon::current_num_threads().min(blocks);
        if !parallel || threads < 2 || self.colours.len() > blocks {
            (0..blocks).for_each(block);
            return;
        }
        let (next, done) = (AtomicUsize::new(0), AtomicUsize::new(0));
        let work = || {
            let mut colour = 0;
            loop {
                let ticket = next.fetch_add(1, Ordering::Relaxed);
                if ticket >= blocks {
                    return;
                }
                while self.colours[colour + 1] as usize <= ticket {
                    colour += 1;
                }
                await_count(&done, self.colours[colour] as usize);
                let _done = Done(&done);
                block(ticket);
            }
        };
        rayon::scope(|scope| {
            for _ in 1..threads {
                scope.spawn(|_| work());
            }
            work();
        });
    }

    /// Turns groups into coloured blocks; small groups share a block.
    fn cut(self) -> Self {
        let mut out = Self::default();
        for group in ranges(&self.groups) {
            if group.len() <= PART {
                out.end_group(group.end);
                let open = *out.blocks.last().unwrap_or(&0) as usize;
                if group.end - out.groups[open] as usize >= PART {
                    out.end_block();
                    out.end_colour();
                }
                continue;
            }
            out.end_block();
            out.end_colour();
            for from in group.clone().step_by(PART) {
                out.end_group(group.end.min(from + PART));
                out.end_block();
            }
            out.end_colour();
        }
        out.end_block();
        out.end_colour();
        out
    }

    fn end_group(&mut self, at: usize) {
        if self.groups.last() != Some(&(at as u32)) {
            self.groups.push(at as u32);
        }
    }

    fn end_block(&mut self) {
        let at = (self.groups.len() - 1) as u32;
        if self.blocks.last() != Some(&at) {
            self.blocks.push(at);
        }
    }

    fn end_colour(&mut self) {
        let at = (self.blocks.len() - 1) as u32;
        if self.colours.last() != Some(&at) {
            self.colours.push(at);
        }
    }
}

/// Waits until `count` blocks are complete.
fn await_count(done: &AtomicUsize, count: usize) {
    let mut turns = 0u32;
    while done.load(Ordering::Acquire) < count {
        turns += 1;
        if turns < 4096 {
            std::hint::spin_loop();
        } else {
            std::thread::yield_now();
        }
    }
}

/// Counts a block as complete on drop, even after a panic, since other threads wait for it.
struct Done<'a>(&'a AtomicUsize);

impl Drop for Done<'_> {
    fn drop(&mut self) {
        self.0.fetch_add(1, Ordering::Release);
    }
}

fn ranges(starts: &[u32]) -> impl Iterator<Item = std::ops::Range<usize>> {
    starts.windows(2).map(|w| w[0] as usize..w[1] as usize)
}

/// Colouring state of a body: the last visitor, and the colours in use.
#[derive(Clone, Copy, Default)]
struct Seen {
    by: u32,
    taken: u32,
}

/// The order of contacts, reused from step to step and recomputed when the contacts change.
#[derive(Clone, Debug, Default)]
pub struct Order {
    bodies: Vec<[u32; 2]>,
    movable: Vec<bool>,
    sequence: Vec<u32>,
    places: Vec<u32>,
    schedule: Schedule,
}

impl Order {
    /// Updates the order for contacts between these bodies.
    pub fn update(&mut self, bodies: impl ExactSizeIterator<Item = [u32; 2]>, movable: &[bool]) {
        let mut same = self.movable == movable && self.bodies.len() == bodies.len();
        self.bodies.resize(bodies.len(), [0, 0]);
        for (old, new) in self.bodies.iter_mut().zip(bodies) {
            same &= *old == new;
            *old = new;
        }
        if same {
            return;
        }
        self.movable.clear();
        self.movable.extend_from_slice(movable);
        (self.sequence, self.schedule) = order(&self.bodies, movable);
        self.places.resize(self.sequence.len(), 0);
        for (k, old) in self.sequence.iter().enumerate() {
            self.places[*old as usize] = k as u32;
        }
    }

    /// Returns the old index of each contact in the new order.
    pub fn sequence(&self) -> &[u32] {
        &self.sequence
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

/// Sorts contacts for the iteration. Returns the permutation (`order[k]` is the old index of the k-th) and
/// the schedule of the new order.
fn order(bodies: &[[u32; 2]], movable: &[bool]) -> (Vec<u32>, Schedule) {
    let count = movable.len();
    let span = PART * (bodies.len().div_ceil(PART * BLOCKS)).clamp(1, PARTS);
    let mut order = Vec::with_capacity(bodies.len());
    let mut schedule = Schedule::default();
    let mut seen = vec![Seen::default(); count];
    let moved = |pair: &[u32; 2]| pair.map(|b| movable[b as usize].then_some(b as usize));
    if bodies.len() <= SMALL {
        group(
            0..bodies.len(),
            1,
            bodies,
            &moved,
            &mut seen,
            &mut order,
            &mut schedule,
        );
        return (order, schedule.cut());
    }
    // Find bodies shared by too many blocks.
    for (block, pairs) in bodies.chunks(span).enumerate() {
        for body in pairs.iter().flat_map(moved).flatten() {
            let seen = &mut seen[body];
            if seen.by != block as u32 + 1 {
                seen.by = block as u32 + 1;
                seen.taken += 1;
            }
        }
    }
    let hub: Vec<bool> = seen.iter().map(|s| s.taken > HUB).collect();
    let of_hub = |pair: &[u32; 2]| moved(pair).iter().flatten().any(|b| hub[*b]);
    let hubs = hub.iter().any(|h| *h);
    // Colour the blocks.
    seen.fill(Seen::default());
    let mut blocks: Vec<(u32, u32)> = Vec::new();
    for (block, pairs) in bodies.chunks(span).enumerate() {
        let own = || pairs.iter().filter(|p| !hubs || !of_hub(p));
        let mut taken = 0;
        for body in own().flat_map(moved).flatten() {
            taken |= seen[body].taken;
        }
        // A block without a free colour gets a new one of its own.
        let colour = (!taken).trailing_zeros();
        for body in own().flat_map(moved).flatten() {
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
    // Form the groups.
    seen.fill(Seen::default());
    let mut mark = 0;
    for same in blocks.chunk_by(|a, b| a.0 == b.0) {
        for (_, block) in same {
            let first = *block as usize * span;
            let end = bodies.len().min(first + span);
            for from in (first..end).step_by(PART) {
                mark += 1;
                let part = from..end.min(from + PART);
                let part = part.filter(|k| !hubs || !of_hub(&bodies[*k]));
                group(
                    part,
                    mark,
                    bodies,
                    &moved,
                    &mut seen,
                    &mut order,
                    &mut schedule,
                );
            }
            schedule.end_block();
        }
        schedule.end_colour();
    }
    if hubs {
        for (k, pair) in bodies.iter().enumerate() {
            if of_hub(pair) {
                order.push(k as u32);
                schedule.end_group(order.len());
            }
        }
        schedule.end_block();
        schedule.end_colour();
    }
    (order, schedule)
}

/// Appends the contacts of a part, grouped by colour.
fn group(
    part: impl Iterator<Item = usize>,
    mark: u32,
    bodies: &[[u32; 2]],
    moved: &impl Fn(&[u32; 2]) -> [Option<usize>; 2],
    seen: &mut [Seen],
    order: &mut Vec<u32>,
    schedule: &mut Schedule,
) {
    let mut sizes = [0u32; COLOURS + 1];
    let mut coloured = Vec::with_capacity(part.size_hint().1.unwrap_or(0));
    for k in part {
        let pair = moved(&bodies[k]);
        let mut taken = 0;
        for body in pair.into_iter().flatten() {
            let seen = &mut seen[body];
            if seen.by != mark {
                *seen = Seen { by: mark, taken: 0 };
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
    let first = order.len();
    let mut next = [0u32; COLOURS + 1];
    let mut at = first;
    for (colour, size) in sizes.iter().enumerate() {
        next[colour] = at as u32;
        if colour < COLOURS {
            at += *size as usize;
            schedule.end_group(at);
        } else {
            // Contacts without a colour may share a body and form groups of one.
            for _ in 0..*size {
                at += 1;
                schedule.end_group(at);
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

#[cfg(test)]
mod tests {
    use super::*;

    fn check(bodies: &[[u32; 2]], fixed: u32, count: usize) -> Schedule {
        let movable: Vec<bool> = (0..count as u32).map(|b| b != fixed).collect();
        let (order, schedule) = order(bodies, &movable);
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
}
