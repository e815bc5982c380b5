//! Work on large inputs, shared out among the threads of rayon's pool with the feature `parallel`.
//! Results do not depend on the number of threads.

use std::ops::Range;

/// Fewer items than these are sorted by one thread.
#[cfg(feature = "parallel")]
const FEW: usize = 1 << 17;

/// Cuts `0..count` into consecutive parts of at least `least`, works on each, and returns what came
/// out, in their order. One part is worked on by the calling thread.
#[cfg(feature = "parallel")]
pub(crate) fn parts<T: Send>(
    count: usize,
    least: usize,
    work: impl Fn(Range<usize>) -> T + Sync,
) -> Vec<T> {
    use rayon::prelude::*;
    let threads = rayon::current_num_threads();
    // More parts than threads, as some take longer than others.
    let number = if threads > 1 { (count / least).min(4 * threads) } else { 1 };
    if number < 2 {
        return vec![work(0..count)];
    }
    let part = |i: usize| count * i / number..count * (i + 1) / number;
    (0..number).into_par_iter().map(|i| work(part(i))).collect()
}

/// Sorts; equal items are the same.
#[cfg(feature = "parallel")]
pub(crate) fn sort<T: Ord + Send>(items: &mut [T]) {
    use rayon::slice::ParallelSliceMut;
    if items.len() < FEW || rayon::current_num_threads() < 2 {
        items.sort_unstable();
    } else {
        items.par_sort_unstable();
    }
}

/// Does both, perhaps at once.
#[cfg(feature = "parallel")]
pub(crate) fn both<A: Send, B: Send>(
    a: impl FnOnce() -> A + Send,
    b: impl FnOnce() -> B + Send,
) -> (A, B) {
    rayon::join(a, b)
}

#[cfg(not(feature = "parallel"))]
pub(crate) fn parts<T>(count: usize, _: usize, work: impl Fn(Range<usize>) -> T) -> Vec<T> {
    vec![work(0..count)]
}

#[cfg(not(feature = "parallel"))]
pub(crate) fn sort<T: Ord>(items: &mut [T]) {
    items.sort_unstable();
}

#[cfg(not(feature = "parallel"))]
pub(crate) fn both<A, B>(a: impl FnOnce() -> A, b: impl FnOnce() -> B) -> (A, B) {
    (a(), b())
}
