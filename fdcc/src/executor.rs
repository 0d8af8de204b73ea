//! Independent pieces of work on several threads.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, OnceLock};

/// Does independent pieces of work, some at the same time; how many makes no difference to their
/// results.
///
/// ```
/// use fdcc::Executor;
///
/// let squares = Executor::threads(2).in_order(4, |i| i * i, |_| false);
/// assert_eq!(squares, [0, 1, 4, 9]);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Executor {
    threads: usize,
}

impl Default for Executor {
    /// As many threads as there are processors.
    fn default() -> Self {
        // To ask the system takes as long as a few iterations of a small problem.
        static PROCESSORS: OnceLock<usize> = OnceLock::new();
        let count = || std::thread::available_parallelism().map_or(1, |count| count.get());
        Executor::threads(*PROCESSORS.get_or_init(count))
    }
}

impl Executor {
    /// So many threads.
    pub fn threads(threads: usize) -> Self {
        Executor { threads }
    }

    /// One piece after the other, on the thread of the caller.
    pub fn serial() -> Self {
        Executor { threads: 1 }
    }

    /// The results of `work(0)`, `work(1)` ... in this order; which thread does what makes no
    /// difference to them. After a result that `ends` it all, nothing more is begun, and the
    /// results may be fewer.
    pub fn in_order<T: Send>(
        &self,
        count: usize,
        work: impl Fn(usize) -> T + Sync,
        ends: impl Fn(&T) -> bool + Sync,
    ) -> Vec<T> {
        let (next, results) = (AtomicUsize::new(0), Mutex::new(Vec::new()));
        let run = || {
            loop {
                let index = next.fetch_add(1, Ordering::Relaxed);
                if index >= count {
                    return;
                }
                let result = work(index);
                if ends(&result) {
                    next.store(count, Ordering::Relaxed);
                }
                results.lock().expect("no thread panics with the lock").push((index, result));
            }
        };
        std::thread::scope(|scope| {
            // This thread works as well.
            (1..self.threads.min(count)).for_each(|_| drop(scope.spawn(run)));
            run();
        });
        let mut results = results.into_inner().expect("no thread panics with the lock");
        results.sort_by_key(|(index, _)| *index);
        results.into_iter().map(|(_, result)| result).collect()
    }
}
