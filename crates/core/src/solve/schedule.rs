//! Parallel schedule of an iteration over contacts: groups in blocks, blocks in colours. The blocks
//! of a colour can run at the same time; the results do not depend on the number of threads.

use std::sync::atomic::{AtomicUsize, Ordering};

/// Groups, blocks of groups, and colours of blocks; each list holds the start indices and the final
/// end.
#[derive(Clone, Debug, PartialEq)]
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

    /// Returns the number of contacts.
    pub fn contacts(&self) -> usize {
        self.groups.last().map_or(0, |end| *end as usize)
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
    /// Threads take blocks from a shared counter, in the order of the iteration, and wait only for
    /// the blocks of earlier colours that were taken; no thread waits for one that has not started.
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
                let _done = BlockDone(&done);
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

    /// Turns groups into coloured blocks of about `size` contacts; small groups share a block.
    pub(super) fn cut(self, size: usize) -> Self {
        let mut out = Self::default();
        for group in ranges(&self.groups) {
            if group.len() <= size {
                out.end_group(group.end);
                let open = *out.blocks.last().unwrap_or(&0) as usize;
                if group.end - out.groups[open] as usize >= size {
                    out.end_block();
                    out.end_colour();
                }
                continue;
            }
            out.end_block();
            out.end_colour();
            for from in group.clone().step_by(size) {
                out.end_group(group.end.min(from + size));
                out.end_block();
            }
            out.end_colour();
        }
        out.end_block();
        out.end_colour();
        out
    }

    /// Creates a schedule of groups that end at these contacts, not yet cut into blocks.
    pub(super) fn of_groups(ends: impl IntoIterator<Item = u32>) -> Self {
        let mut out = Self::default();
        ends.into_iter().for_each(|end| out.end_group(end as usize));
        out
    }

    /// Ends a group before the contact `at`.
    pub(super) fn end_group(&mut self, at: usize) {
        if self.groups.last() != Some(&(at as u32)) {
            self.groups.push(at as u32);
        }
    }

    /// Ends a block after the last group.
    pub(super) fn end_block(&mut self) {
        let at = (self.groups.len() - 1) as u32;
        if self.blocks.last() != Some(&at) {
            self.blocks.push(at);
        }
    }

    /// Ends a colour after the last block.
    pub(super) fn end_colour(&mut self) {
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
struct BlockDone<'a>(&'a AtomicUsize);

impl Drop for BlockDone<'_> {
    fn drop(&mut self) {
        self.0.fetch_add(1, Ordering::Release);
    }
}

/// Iterates over the ranges between successive starts.
pub(super) fn ranges(starts: &[u32]) -> impl Iterator<Item = std::ops::Range<usize>> {
    starts.windows(2).map(|w| w[0] as usize..w[1] as usize)
}
