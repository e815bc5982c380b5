//! Layers made in parallel and taken in order, a bounded number ahead.

use std::{
    collections::BTreeMap,
    ops::Range,
    panic::{AssertUnwindSafe, catch_unwind, resume_unwind},
    sync::mpsc,
};

use rayon::ThreadPool;

/// Runs `make` for every index on the pool and hands the results to `take` in order, on the
/// calling thread. At most `ahead` results exist at a time, so memory does not grow with the
/// range. Stops at the first error of `take`.
pub(crate) fn ordered<T: Send, E>(
    pool: &ThreadPool,
    range: Range<usize>,
    ahead: usize,
    make: &(dyn Fn(usize) -> T + Sync),
    mut take: impl FnMut(T) -> Result<(), E>,
) -> Result<(), E> {
    let (sender, receiver) = mpsc::channel();
    pool.in_place_scope(|scope| {
        let spawn = |index: usize| {
            let sender = sender.clone();
            scope.spawn(move |_| {
                // A panic must reach the caller: left here it would leave it waiting for ever.
                let made = catch_unwind(AssertUnwindSafe(|| make(index)));
                let _ = sender.send((index, made));
            });
        };
        let mut unspawned = range.clone();
        unspawned.by_ref().take(ahead.max(1)).for_each(spawn);
        let mut early = BTreeMap::new();
        for index in range {
            let made = loop {
                if let Some(made) = early.remove(&index) {
                    break made;
                }
                // The sender above outlives this loop: receiving cannot fail.
                let Ok((i, made)) = receiver.recv() else { return Ok(()) };
                early.insert(i, made);
            };
            take(made.unwrap_or_else(|panic| resume_unwind(panic)))?;
            unspawned.next().map(spawn);
        }
        Ok(())
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::{AtomicUsize, Ordering};

    fn pool(threads: usize) -> ThreadPool {
        rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap()
    }

    #[test]
    fn results_come_in_order_and_few_ahead() {
        for threads in [1, 3] {
            let made = AtomicUsize::new(0);
            let mut taken = Vec::new();
            let make = |i: usize| {
                made.fetch_add(1, Ordering::SeqCst);
                i * i
            };
            let result: Result<(), ()> = ordered(&pool(threads), 5..105, 4, &make, |v| {
                assert!(made.load(Ordering::SeqCst) <= taken.len() + 4);
                taken.push(v);
                Ok(())
            });
            assert_eq!(result, Ok(()));
            assert_eq!(taken, (5..105).map(|i| i * i).collect::<Vec<_>>());
        }
    }

    #[test]
    fn the_first_error_stops() {
        let made = AtomicUsize::new(0);
        let make = |i: usize| {
            made.fetch_add(1, Ordering::SeqCst);
            i
        };
        let result = ordered(&pool(2), 0..1000, 4, &make, |v| if v < 10 { Ok(()) } else { Err(v) });
        assert_eq!(result, Err(10));
        assert!(made.load(Ordering::SeqCst) < 20);
    }

    #[test]
    #[should_panic(expected = "layer seven")]
    fn a_panic_reaches_the_caller() {
        let make = |i: usize| assert_ne!(i, 7, "layer seven");
        let _: Result<(), ()> = ordered(&pool(2), 0..100, 4, &make, |()| Ok(()));
    }
}
