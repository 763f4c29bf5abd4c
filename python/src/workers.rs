//! The threads that compute.

use crate::errors::{run, wrong};
use pyo3::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};

/// Size of the stack of a thread (bytes), that of the main thread of a program.
const STACK: usize = 8 << 20;

/// Largest number of threads, that of the command line.
const MAX_THREADS: usize = 1024;

/// A thread pool. Results do not depend on its number of threads.
pub(crate) struct Workers(ThreadPool);

impl Workers {
    pub(crate) fn new(threads: usize) -> PyResult<Self> {
        if !(1..=MAX_THREADS).contains(&threads) {
            return Err(wrong(
                format!("threads={threads}"),
                format!("take 1 to {MAX_THREADS}"),
            ));
        }
        let made = ThreadPoolBuilder::new()
            .num_threads(threads)
            .stack_size(STACK)
            .build();
        made.map(Self).map_err(|e| {
            let why = format!(
                "cannot start {threads} threads: {e}; take fewer or allow more (ulimit -u)"
            );
            run(&why, None)
        })
    }

    /// Runs a task in the pool.
    pub(crate) fn install<R: Send>(&self, task: impl FnOnce() -> R + Send) -> R {
        self.0.install(task)
    }
}
