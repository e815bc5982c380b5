//! Progress on a terminal, and Ctrl-C.

use std::{
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
    },
    thread,
    time::Duration,
};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use crate::{failure::Failure, output, show};

/// How long a slice may take to stop by itself, between two layers. A layer of a great many faces
/// takes longer than anybody waits.
const GRACE: Duration = Duration::from_secs(1);

/// Layers done on a bar with the time left; warnings above it.
pub(crate) struct Terminal {
    bar: ProgressBar,
    interrupted: Arc<AtomicBool>,
}

impl Terminal {
    /// A bar on standard error; hidden when `quiet` or where that is no terminal.
    pub(crate) fn new(quiet: bool) -> Result<Self, Failure> {
        let interrupted = Arc::new(AtomicBool::new(false));
        let flag = Arc::clone(&interrupted);
        let stop = move || {
            flag.store(true, Ordering::Relaxed);
            thread::sleep(GRACE);
            output::discard_unfinished();
            let failure = Failure::interrupted();
            show::failure(&failure);
            std::process::exit(failure.status().into());
        };
        ctrlc::set_handler(stop)
            .map_err(|e| Failure::could_not(format!("could not watch for Ctrl-C: {e}")))?;
        let target =
            if quiet { ProgressDrawTarget::hidden() } else { ProgressDrawTarget::stderr() };
        let bar = ProgressBar::with_draw_target(None, target);
        let style =
            ProgressStyle::with_template("{msg:>9} [{bar:40}] {pos}/{len} layers, {eta} left");
        if let Ok(style) = style {
            bar.set_style(style.progress_chars("=> "));
        }
        bar.set_message("reading");
        Ok(Self { bar, interrupted })
    }

    /// Takes the bar away.
    pub(crate) fn clear(&self) {
        self.bar.finish_and_clear();
    }
}

impl fgm::Progress for Terminal {
    fn advance(&self, done: usize, total: usize) {
        if done == 0 {
            self.bar.set_message("slicing");
            self.bar.set_length(total as u64);
        }
        self.bar.set_position(done as u64);
    }

    fn warn(&self, warning: &str) {
        self.bar.suspend(|| show::warning(warning));
    }

    fn cancelled(&self) -> bool {
        self.interrupted.load(Ordering::Relaxed)
    }
}
