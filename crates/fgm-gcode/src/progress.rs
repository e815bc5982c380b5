use std::{
    fmt::Write as _,
    io::{self, Seek, SeekFrom, Write},
};

use crate::Text;

/// A line that is still to be filled in: a comment as long as the line that takes its place.
const BLANK: &str = ";M73 P--- R----";

/// The lines of a print that tell its progress: `M73 P<percent> R<minutes left>`.
///
/// What is left is known when the print is over. Until then the lines are comments of their
/// length, which [`fill`](Self::fill) writes over: a file is written once, in bounded memory, and
/// one that is never filled in is a print that does not tell its progress.
///
/// The numbers have leading zeros, which every firmware takes, so that no line changes its length.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ProgressLines {
    marks: Vec<Mark>,
    total: f64,
}

/// Where a line stands in the output, and the time of the print before it.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Mark {
    /// Bytes before it.
    offset: u64,
    /// s.
    seconds: f64,
}

impl ProgressLines {
    /// Seconds of print from one line to the next.
    pub(crate) const STEP: f64 = 30.0;

    /// How many lines there are.
    pub fn len(&self) -> usize {
        self.marks.len()
    }

    /// Whether there is none: the firmware is not told.
    pub fn is_empty(&self) -> bool {
        self.marks.is_empty()
    }

    /// When the last line is due, s; the beginning where there is none.
    pub(crate) fn last(&self) -> f64 {
        self.marks.last().map_or(0.0, |mark| mark.seconds)
    }

    /// Writes a line to be filled in.
    pub(crate) fn mark(&mut self, seconds: f64, text: &mut Text) {
        self.marks.push(Mark { offset: text.written(), seconds });
        self.total = self.total.max(seconds);
        text.line(BLANK);
    }

    /// Writes the lines over their places in what the writer wrote, which began at the start of
    /// `file`, and goes back to its end.
    ///
    /// # Errors
    /// Those of `file`.
    pub fn fill(&self, file: &mut (impl Write + Seek + ?Sized)) -> io::Result<()> {
        let mut line = String::new();
        for mark in &self.marks {
            let share = if self.total > 0.0 { mark.seconds / self.total } else { 1.0 };
            let percent = (100.0 * share.clamp(0.0, 1.0)) as u32;
            let minutes = ((self.total - mark.seconds) / 60.0).ceil().clamp(0.0, 99_999.0) as u32;
            line.clear();
            let _ = write!(line, "M73 P{percent:03} R{minutes:05}");
            file.seek(SeekFrom::Start(mark.offset))?;
            file.write_all(line.as_bytes())?;
        }
        if !self.is_empty() {
            file.seek(SeekFrom::End(0))?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Cursor;

    /// What `marks` come to after a total of the last one.
    fn filled(marks: &[f64]) -> String {
        let (mut lines, mut text) = (ProgressLines::default(), Text::new());
        for &seconds in marks {
            lines.mark(seconds, &mut text);
            text.line("G1");
        }
        let mut file = Cursor::new(text.as_bytes().to_vec());
        lines.fill(&mut file).unwrap();
        file.write_all(b";end").unwrap();
        String::from_utf8(file.into_inner()).unwrap()
    }

    #[test]
    fn lines_take_the_place_of_comments() {
        for (marks, want) in [
            (&[][..], ";end"),
            (&[0.0, 30.0, 90.0][..], "000 R00002 033 R00001 100 R00000"),
            (&[0.0][..], "100 R00000"),
            (&[0.0, 1e9][..], "000 R99999 100 R00000"),
            (&[0.0, 59.9, 120.0][..], "000 R00002 049 R00002 100 R00000"),
        ] {
            let told = filled(marks).replace("\nG1\n", " ").replace("M73 P", "");
            assert_eq!(told.trim_end_matches(" ;end"), want, "{marks:?}");
        }
    }

    #[test]
    fn unfilled_lines_are_comments_of_the_same_length() {
        assert_eq!(BLANK.len(), "M73 P100 R99999".len());
        assert!(BLANK.starts_with(';'));
    }
}
