//! Several runs at a time.

use crate::Error;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};

/// Calls `work` on this thread and on `jobs` - 1 others, and waits until all return.
pub fn workers(jobs: usize, work: &(dyn Fn() + Sync)) {
    std::thread::scope(|scope| {
        for _ in 1..jobs {
            // Fewer workers if the system provides no more threads.
            let _ = std::thread::Builder::new().spawn_scoped(scope, work);
        }
        work();
    });
}

/// Processes each item with some workers, in the order of the items; results have that order too.
/// Items that were not begun when `stop` was set, or after an error, have none.
///
/// # Errors
/// The first error of the work.
pub fn each<T: Sync, R: Send>(
    items: &[T],
    jobs: usize,
    stop: &AtomicBool,
    work: &(dyn Fn(&T) -> Result<R, Error> + Sync),
) -> Result<Vec<Option<R>>, Error> {
    let next = Mutex::new(0);
    let results: Mutex<Vec<Option<R>>> = Mutex::new(items.iter().map(|_| None).collect());
    let failure: Mutex<Option<Error>> = Mutex::new(None);
    let take = || {
        if stop.load(Ordering::Relaxed) {
            return None;
        }
        let mut next = next.lock().ok()?;
        let k = *next;
        *next += 1;
        Some((k, items.get(k)?))
    };
    workers(jobs.min(items.len()), &|| {
        while let Some((k, item)) = take() {
            match work(item) {
                Ok(result) => {
                    if let Ok(mut results) = results.lock() {
                        results[k] = Some(result);
                    }
                }
                Err(e) => {
                    if let (Ok(mut next), Ok(mut failure)) = (next.lock(), failure.lock()) {
                        *next = items.len();
                        failure.get_or_insert(e);
                    }
                }
            }
        }
    });
    match failure.into_inner() {
        Ok(Some(e)) => Err(e),
        _ => Ok(results.into_inner().unwrap_or_default()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_stand_in_the_order_of_the_items() {
        let items: Vec<u64> = (0..50).collect();
        let stop = AtomicBool::new(false);
        let double = |x: &u64| Ok(2 * x);
        let doubled = each(&items, 4, &stop, &double).unwrap();
        assert!((0..50).all(|k| doubled[k] == Some(2 * k as u64)));
        let fails = |x: &u64| match x {
            7 => Err(Error::Usage("seven".into())),
            x => Ok(*x),
        };
        let message = each(&items, 4, &stop, &fails).unwrap_err().to_string();
        assert_eq!(message, "seven");
        // Items in the queue are skipped when `stop` is set.
        let stops = |x: &u64| {
            stop.store(*x == 3, Ordering::Relaxed);
            Ok(())
        };
        let begun = each(&items, 1, &stop, &stops).unwrap();
        assert_eq!(begun.iter().flatten().count(), 4);
    }
}
