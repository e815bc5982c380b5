//! Following G-code.

mod arc;
mod commands;
mod follower;
mod heads;
mod known;
mod motors;
mod moves;
mod options;
mod place;
mod tags;

use std::io::BufRead;

use fgm_gcode::Reader;

use crate::{Event, Faults, SimError};

pub use follower::Follower;
pub use options::ReplayOptions;

/// No coordinate of any machine is greater, mm.
const GREATEST: f64 = 1e6;

/// G-code followed line by line: an iterator over what the machine does.
///
/// Memory does not grow with the file: of it only the current line is held.
///
/// ```
/// use fgm_gcode::Reader;
/// use fgm_sim::{Event, Replay, ReplayOptions};
///
/// let gcode = b"M83\nG1 X10 Y10 F3000\nG1 X20 E0.5\n";
/// let mut replay = Replay::new(Reader::new(&gcode[..]), &ReplayOptions::default());
/// let mut length = 0.0;
/// while let Some(event) = replay.next_event()? {
///     if let Event::Bead(bead) = event {
///         length += bead.length();
///     }
/// }
/// assert_eq!((length, replay.faults().total()), (10.0, 0));
/// # Ok::<(), fgm_sim::SimError>(())
/// ```
pub struct Replay<R> {
    reader: Reader<R>,
    follower: Follower,
}

impl<R: BufRead> Replay<R> {
    /// Goes on from where `reader` is.
    pub fn new(reader: Reader<R>, options: &ReplayOptions) -> Self {
        Self { reader, follower: Follower::new(options) }
    }

    /// What happens next; none at the end of the file.
    ///
    /// # Errors
    /// [`SimError::Io`]. What is wrong with the G-code is no error but a fault.
    #[inline]
    pub fn next_event(&mut self) -> Result<Option<Event>, SimError> {
        loop {
            if let Some(event) = self.follower.next_event() {
                return Ok(Some(event));
            }
            let Some(line) = self.reader.next_line()? else { return Ok(None) };
            self.follower.line(&line);
        }
    }

    /// What was wrong so far.
    pub fn faults(&self) -> &Faults {
        self.follower.faults()
    }

    /// Changes of colour so far; see [`Follower::changes`].
    pub fn changes(&self) -> u64 {
        self.follower.changes()
    }

    /// Lines read so far.
    pub fn lines(&self) -> u64 {
        self.reader.line()
    }

    /// Bytes read so far.
    pub fn bytes(&self) -> u64 {
        self.reader.bytes()
    }
}

impl<R: BufRead> Iterator for Replay<R> {
    type Item = Result<Event, SimError>;

    fn next(&mut self) -> Option<Self::Item> {
        self.next_event().transpose()
    }
}
