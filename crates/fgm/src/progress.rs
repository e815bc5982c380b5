/// What a slice tells while it runs, and how it is stopped.
///
/// Called from the thread that runs the slice.
pub trait Progress {
    /// `done` of `total` layers are written.
    fn advance(&self, done: usize, total: usize) {
        let _ = (done, total);
    }

    /// Something the user should know and the slice goes on after.
    fn warn(&self, warning: &str) {
        let _ = warning;
    }

    /// Whether to stop; asked once a layer.
    fn cancelled(&self) -> bool {
        false
    }
}

/// Tells nothing and never stops.
#[derive(Clone, Copy, Debug, Default)]
pub struct Quiet;

impl Progress for Quiet {}
