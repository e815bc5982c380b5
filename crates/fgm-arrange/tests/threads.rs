//! Inputs large enough to be shared out among threads.

#![cfg(feature = "parallel")]
#![allow(clippy::unwrap_used)] // Helpers of tests, which clippy does not see as tests.

use fgm_arrange::{ArrangeOptions, Arrangement, Chain};
use fgm_core::Point2;
use std::hash::{DefaultHasher, Hash, Hasher};

/// Long lines that cross each other about 160,000 times.
fn lines() -> Vec<[Point2; 2]> {
    let mut state = 1u64;
    let mut random = move || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 33) as f64 / (1u64 << 31) as f64 * 100.0
    };
    let mut point = || Point2::new(random(), random());
    (0..1200).map(|_| [point(), point()]).collect()
}

/// All that an arrangement says about its edges and faces, in one number.
fn digest(lines: &[[Point2; 2]], keep: bool, threads: usize) -> u64 {
    let chains: Vec<_> = (0..).zip(lines).map(|(i, line)| Chain::open(line, i % 7)).collect();
    let options = ArrangeOptions::default().with_dangling(keep);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    let made: Arrangement<u32> = pool.install(|| Arrangement::new(&chains, &options)).unwrap();
    assert!(made.face_count() > 140_000, "{} faces", made.face_count());
    let mut digest = DefaultHasher::new();
    for edge in made.edges() {
        (edge.ends(), edge.left(), edge.right(), edge.labels()).hash(&mut digest);
        edge.points().for_each(|p| [p.x, p.y].map(f64::to_bits).hash(&mut digest));
    }
    made.faces().for_each(|face| face.area().to_bits().hash(&mut digest));
    digest.finish()
}

#[test]
fn threads_change_nothing() {
    let lines = lines();
    for keep in [true, false] {
        let alone = digest(&lines, keep, 1);
        assert_eq!([2, 3].map(|threads| digest(&lines, keep, threads)), [alone; 2]);
    }
}
