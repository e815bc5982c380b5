use std::time::Instant;

use serde::Serialize;

/// Seconds of work by stage, summed over threads.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct StageSeconds {
    /// From start to end, by the clock.
    pub total: f64,
    /// Reading the design and preparing it.
    pub read: f64,
    /// Outlines and isolines.
    pub contour: f64,
    /// Faces and their colours.
    pub arrange: f64,
    /// Walls, fills, sectioning, ordering.
    pub toolpath: f64,
    /// Look-ahead, numbers, output.
    pub write: f64,
}

impl StageSeconds {
    /// Adds the stages of another thread's work; totals are not added.
    pub(crate) fn add(&mut self, other: &Self) {
        self.read += other.read;
        self.contour += other.contour;
        self.arrange += other.arrange;
        self.toolpath += other.toolpath;
        self.write += other.write;
    }
}

/// Runs `work` and adds the time it takes.
pub(crate) fn timed<T>(seconds: &mut f64, work: impl FnOnce() -> T) -> T {
    let start = Instant::now();
    let result = work();
    *seconds += start.elapsed().as_secs_f64();
    result
}
