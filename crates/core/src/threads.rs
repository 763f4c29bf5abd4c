//! Division of loops among the threads of the current pool, if the work is worth it.
//!
//! Loops are divided into chunks of a fixed size, independent of the number of threads, and the
//! results of the chunks are joined in order: results have the same bits on any number of threads.

use rayon::prelude::*;
use std::ops::Range;
use std::sync::atomic::{AtomicU64, Ordering};

/// Smallest work for which other threads are used (ns): many times the cost of waking them, since
/// other programs may run on their cores.
const MIN_WORK: u64 = 170_000;

/// Smallest number of items of a task in [`fill`].
const MIN_ITEMS: usize = 256;

static MIN_WORK_IN_FORCE: AtomicU64 = AtomicU64::new(MIN_WORK);

/// Sets the least work (ns) that is divided, for the whole process; `None` restores the default.
/// Results do not depend on it: tests set zero, so that small scenes run on several threads too.
pub fn divide_loops_from(nanoseconds: Option<u64>) {
    MIN_WORK_IN_FORCE.store(nanoseconds.unwrap_or(MIN_WORK), Ordering::Relaxed);
}

/// Returns the size of the chunks of a loop whose results do not depend on it; it is reduced if all
/// loops are divided ([`divide_loops_from`] zero).
pub fn chunk_size(size: usize) -> usize {
    match MIN_WORK_IN_FORCE.load(Ordering::Relaxed) {
        0 => size.div_ceil(16),
        _ => size,
    }
}

/// Returns whether to divide a loop of `items`, each of about `each` nanoseconds, if the caller
/// allows several threads.
#[inline]
pub fn worth_dividing(parallel: bool, items: usize, each: f64) -> bool {
    parallel
        && items as f64 * each >= MIN_WORK_IN_FORCE.load(Ordering::Relaxed) as f64
        && rayon::current_num_threads() > 1
}

/// Returns the results of `of` for each chunk of `size` items and the index of its first item, in
/// the order of the chunks.
pub fn map_chunks<T: Sync, R: Send>(
    divide: bool,
    items: &[T],
    size: usize,
    of: impl Fn(usize, &[T]) -> R + Sync,
) -> Vec<R> {
    map_ranges(divide, items.len(), size, |range| {
        of(range.start, &items[range.clone()])
    })
}

/// Returns the results of `of` for each range of `size` indices below `items`, in their order.
pub fn map_ranges<R: Send>(
    divide: bool,
    items: usize,
    size: usize,
    of: impl Fn(Range<usize>) -> R + Sync,
) -> Vec<R> {
    let range = |k: usize| k * size..items.min((k + 1) * size);
    let chunks = 0..items.div_ceil(size);
    if divide && chunks.len() > 1 {
        chunks.into_par_iter().map(|k| of(range(k))).collect()
    } else {
        chunks.map(|k| of(range(k))).collect()
    }
}

/// Returns the results of `of` for each mutable chunk of `size` items and the index of its first
/// item, in the order of the chunks.
pub fn map_chunks_mut<T: Send, R: Send>(
    divide: bool,
    items: &mut [T],
    size: usize,
    of: impl Fn(usize, &mut [T]) -> R + Sync,
) -> Vec<R> {
    if divide && items.len() > size {
        let chunks = items.par_chunks_mut(size).enumerate();
        chunks.map(|(k, chunk)| of(k * size, chunk)).collect()
    } else {
        let chunks = items.chunks_mut(size).enumerate();
        chunks.map(|(k, chunk)| of(k * size, chunk)).collect()
    }
}

/// Returns the results of `of` for each pair of mutable chunks of `size` items of two lists of the
/// same length and the index of the first item, in the order of the chunks.
pub fn map_chunks_of_two<A: Send, B: Send, R: Send>(
    divide: bool,
    size: usize,
    (a, b): (&mut [A], &mut [B]),
    of: impl Fn(usize, &mut [A], &mut [B]) -> R + Sync,
) -> Vec<R> {
    assert_eq!(a.len(), b.len(), "lists of the same length");
    if divide && a.len() > size {
        let chunks = a.par_chunks_mut(size).zip(b.par_chunks_mut(size));
        let chunks = chunks.enumerate();
        chunks.map(|(k, (a, b))| of(k * size, a, b)).collect()
    } else {
        let chunks = a.chunks_mut(size).zip(b.chunks_mut(size)).enumerate();
        chunks.map(|(k, (a, b))| of(k * size, a, b)).collect()
    }
}

/// Replaces the items of a list by the results of `of` for each index below `count`.
pub fn fill<T: Send>(
    divide: bool,
    list: &mut Vec<T>,
    count: usize,
    of: impl Fn(usize) -> T + Sync + Send,
) {
    empty(list, count);
    let out = SharedSlots(list.as_mut_ptr());
    let tasks = if divide {
        count.div_ceil(MIN_ITEMS).max(1)
    } else {
        1
    };
    let task = |task: usize| {
        let each = count.div_ceil(tasks);
        let indices = (task * each).min(count)..((task + 1) * each).min(count);
        // SAFETY: places are below the capacity, and each is written once.
        unsafe { out.fill(indices, &of) }
    };
    if tasks > 1 {
        (0..tasks).into_par_iter().for_each(task);
    } else {
        task(0);
    }
    // SAFETY: all items are written.
    unsafe { list.set_len(count) };
}

/// The memory of a list, of which each place is written by one thread.
struct SharedSlots<T>(*mut T);
// SAFETY: each place is written by one thread.
unsafe impl<T: Send> Sync for SharedSlots<T> {}

impl<T> SharedSlots<T> {
    /// # Safety
    /// The place must be in the allocation, and nobody else may use it.
    unsafe fn put(&self, place: u32, item: T) {
        // SAFETY: guaranteed by the caller.
        unsafe { self.0.add(place as usize).write(item) }
    }

    /// Writes the result of `of` for each index to its place. This is a separate function, so that
    /// `of` is called from one place, where it is inlined and creates its items in the list: large
    /// ones would otherwise be copied.
    ///
    /// # Safety
    /// The places must be in the allocation, and nobody else may use them.
    #[inline(never)]
    unsafe fn fill(&self, indices: Range<usize>, of: &impl Fn(usize) -> T) {
        for k in indices {
            // SAFETY: guaranteed by the caller.
            unsafe { self.0.add(k).write(of(k)) }
        }
    }
}

/// Empties a list that will have `count` items, with room for slightly more, but not for twice as
/// many as in lists that grow by doubling.
fn empty<T>(list: &mut Vec<T>, count: usize) {
    list.clear();
    let capacity = list.capacity();
    if capacity < count || capacity > count + count / 2 + 64 {
        // Frees the old memory before new memory is allocated.
        *list = Vec::new();
        list.reserve_exact(count + count / 16);
    }
}

/// Replaces the items of a list: item `places[k]` is `of(k)`. Items are computed in the order of k,
/// so that their inputs are read in order.
///
/// # Safety
/// `places` must contain each index below its length once.
pub unsafe fn fill_places<T: Send>(
    divide: bool,
    list: &mut Vec<T>,
    places: &[u32],
    of: impl Fn(usize) -> T + Sync + Send,
) {
    let count = places.len();
    empty(list, count);
    let spread = SharedSlots(list.as_mut_ptr());
    // SAFETY: places are below the capacity, and each is written once.
    let one = |k: usize| unsafe { spread.put(places[k], of(k)) };
    if divide {
        let items = (0..count).into_par_iter().with_min_len(MIN_ITEMS);
        items.for_each(one);
    } else {
        (0..count).for_each(one);
    }
    // SAFETY: all items are written.
    unsafe { list.set_len(count) };
}

/// Returns the results of `of` for each index below `count`, in their order. `of` gets memory that
/// `memory` made for its part of the indices: about as many as there are threads; results must not
/// depend on its contents.
pub fn map_with_memory<M, R: Send>(
    divide: bool,
    count: usize,
    memory: impl Fn() -> M + Sync + Send,
    of: impl Fn(&mut M, usize) -> R + Sync + Send,
) -> Vec<R> {
    if divide && count > 1 {
        let least = count.div_ceil(rayon::current_num_threads());
        let indices = (0..count).into_par_iter().with_min_len(least);
        indices.map_init(memory, of).collect()
    } else {
        let mut memory = memory();
        (0..count).map(|k| of(&mut memory, k)).collect()
    }
}

/// Returns the results of `of` for each of some tasks, in their order.
pub fn map_tasks<T: Send, R: Send>(
    divide: bool,
    tasks: Vec<T>,
    of: impl Fn(T) -> R + Send + Sync,
) -> Vec<R> {
    if divide && tasks.len() > 1 {
        tasks.into_par_iter().map(of).collect()
    } else {
        tasks.into_iter().map(of).collect()
    }
}

/// Number of items of a partial sum.
const SUM: usize = 1024;

/// Returns the sum of the results of `of` for each index below `count`, which takes about `each`
/// nanoseconds: partial sums of a fixed number of items, added in their order.
pub fn sum(parallel: bool, count: usize, each: f64, of: impl Fn(usize) -> f64 + Sync) -> f64 {
    let parts = map_ranges(worth_dividing(parallel, count, each), count, SUM, |items| {
        items.map(&of).sum::<f64>()
    });
    parts.iter().sum()
}

/// Returns how many indices below `count` satisfy `of`, which takes about `each` nanoseconds.
pub fn count(parallel: bool, count: usize, each: f64, of: impl Fn(usize) -> bool + Sync) -> usize {
    let parts = map_ranges(worth_dividing(parallel, count, each), count, SUM, |items| {
        items.filter(|k| of(*k)).count()
    });
    parts.iter().sum()
}

/// Returns whether any index below `count` satisfies `of`, which takes about `each` nanoseconds.
pub fn any(parallel: bool, count: usize, each: f64, of: impl Fn(usize) -> bool + Sync) -> bool {
    if !worth_dividing(parallel, count, each) {
        return (0..count).any(of);
    }
    let parts = map_ranges(true, count, SUM, |mut items| items.any(&of));
    parts.contains(&true)
}

/// Returns the largest result of `of` for each index below `count`, which takes about `each`
/// nanoseconds; 0 if none is larger, NaN if one is.
pub fn largest(parallel: bool, count: usize, each: f64, of: impl Fn(usize) -> f64 + Sync) -> f64 {
    let larger = |far: f64, x: f64| if x <= far || far.is_nan() { far } else { x };
    let parts = map_ranges(worth_dividing(parallel, count, each), count, SUM, |items| {
        items.map(&of).fold(0.0, larger)
    });
    parts.into_iter().fold(0.0, larger)
}

/// Calls `on` with each chunk of `size` items and the index of its first.
pub fn for_chunks<T: Send>(
    divide: bool,
    items: &mut [T],
    size: usize,
    on: impl Fn(usize, &mut [T]) + Sync,
) {
    if divide && items.len() > size {
        let chunks = items.par_chunks_mut(size).enumerate();
        chunks.for_each(|(k, chunk)| on(k * size, chunk));
    } else {
        let chunks = items.chunks_mut(size).enumerate();
        chunks.for_each(|(k, chunk)| on(k * size, chunk));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn chunks_come_in_order_on_any_number_of_threads() {
        let items: Vec<f64> = (0..1001).map(|k| f64::from(k).sin()).collect();
        let sums = |threads: usize, divide: bool| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
            let pool = pool.build().unwrap();
            let sum = |first: usize, part: &[f64]| (first, part.iter().sum::<f64>());
            pool.install(|| {
                let mut scaled = items.clone();
                for_chunks(divide, &mut scaled, 64, |first, part| {
                    for (k, x) in part.iter_mut().enumerate() {
                        *x *= (first + k) as f64;
                    }
                });
                (map_chunks(divide, &items, 64, sum), scaled)
            })
        };
        let serial = sums(1, false);
        assert_eq!(serial.0.len(), 16);
        assert!(serial.0.iter().map(|s| s.0).eq((0..1001).step_by(64)));
        assert_eq!(serial.1[1000], items[1000] * 1000.0);
        for threads in 1..4 {
            assert_eq!(sums(threads, true), serial);
        }
        assert_eq!(map_chunks(true, &[0u8; 0], 64, |_, _| ()), []);
    }

    #[test]
    fn counts_and_largest_values_are_the_same_on_any_number_of_threads() {
        let on = |threads: usize, values: &[f64]| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
            pool.build().unwrap().install(|| {
                let (parallel, n) = (threads > 1, values.len());
                // The time per item is long enough for the loop to be divided.
                let each = 1e6;
                (
                    count(parallel, n, each, |k| values[k] > 0.5),
                    any(parallel, n, each, |k| values[k] == 3.0),
                    largest(parallel, n, each, |k| values[k]).to_bits(),
                )
            })
        };
        let plain: Vec<f64> = (0..5000).map(|k| f64::from(k).sin()).collect();
        let with = |at: usize, x: f64| {
            let mut list = plain.clone();
            list[at] = x;
            list
        };
        let lists = [
            Vec::new(),
            plain.clone(),
            with(4999, 3.0),
            with(0, f64::NAN),
            with(4999, f64::NAN),
        ];
        for (k, list) in lists.iter().enumerate() {
            let serial = on(1, list);
            assert_eq!(serial, on(3, list));
            assert_eq!(serial.1, k == 2);
            assert_eq!(f64::from_bits(serial.2).is_nan(), k > 2);
        }
        assert_eq!(on(1, &[]), (0, false, 0f64.to_bits()));
        assert_eq!(f64::from_bits(on(1, &lists[2]).2), 3.0);
        assert_eq!(on(1, &plain).0, plain.iter().filter(|x| **x > 0.5).count());
    }

    #[test]
    fn small_loops_are_not_divided() {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(2);
        pool.build().unwrap().install(|| {
            assert!(worth_dividing(true, 1_000_000, 100.0));
            assert!(!worth_dividing(false, 1_000_000, 100.0));
            assert!(!worth_dividing(true, 10, 1.0));
        });
        let alone = rayon::ThreadPoolBuilder::new().num_threads(1);
        let alone = alone.build().unwrap();
        assert!(!alone.install(|| worth_dividing(true, 1_000_000, 100.0)));
    }
}
