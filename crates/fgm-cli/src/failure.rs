//! Why a command could not do its work, ready to be shown.

use std::{io, ops::Range, path::Path, process::ExitCode};

/// A message for the user, the place it speaks of, and the exit status.
#[derive(Debug)]
pub(crate) struct Failure {
    /// What is wrong, and what to do; with file, line and column where there is a place.
    pub(crate) message: String,
    /// The place, for showing the line itself.
    pub(crate) place: Option<Place>,
    status: u8,
}

/// A stretch of a text file.
#[derive(Debug)]
pub(crate) struct Place {
    pub(crate) file: String,
    pub(crate) text: String,
    pub(crate) span: Range<usize>,
    /// What to write beside the line.
    pub(crate) label: String,
}

const COULD_NOT: u8 = 1;
const BAD_INPUT: u8 = 2;
/// 128 + SIGINT, as shells expect of an interrupted program.
const INTERRUPTED: u8 = 130;

impl Failure {
    /// The work could not be done: I/O, out of bed, nothing to print.
    pub(crate) fn could_not(message: impl Into<String>) -> Self {
        Self { message: message.into(), place: None, status: COULD_NOT }
    }

    /// The input or the command line is wrong.
    pub(crate) fn usage(message: impl Into<String>) -> Self {
        Self { message: message.into(), place: None, status: BAD_INPUT }
    }

    /// The user stopped it.
    pub(crate) fn interrupted() -> Self {
        Self {
            message: "interrupted; nothing was written".into(),
            place: None,
            status: INTERRUPTED,
        }
    }

    /// A named file could not be read. That it does not exist is the command line's fault.
    pub(crate) fn read(path: &Path, error: &io::Error) -> Self {
        let message = format!("{}: could not read: {error}", path.display());
        match error.kind() {
            io::ErrorKind::NotFound | io::ErrorKind::InvalidData => Self::usage(message),
            _ => Self::could_not(message),
        }
    }

    /// A file could not be written.
    pub(crate) fn write(path: &Path, error: &io::Error) -> Self {
        Self::could_not(format!("{}: could not write: {error}", path.display()))
    }

    /// Something is wrong at a place of a text file.
    pub(crate) fn at(path: &Path, text: &str, span: Range<usize>, what: &str) -> Self {
        let (line, column) = line_and_column(text, span.start);
        let file = path.display().to_string();
        Self {
            message: format!("{file}:{line}:{column}: {what}"),
            place: Some(Place { file, text: text.to_owned(), span, label: what.to_owned() }),
            status: BAD_INPUT,
        }
    }

    /// The same for a place given by line and column, both from 1.
    pub(crate) fn at_line(path: &Path, text: &str, line: usize, column: usize, what: &str) -> Self {
        let before: usize =
            text.split_inclusive('\n').take(line.saturating_sub(1)).map(str::len).sum();
        let rest = text.get(before..).unwrap_or_default();
        let within: usize = rest.chars().take(column.saturating_sub(1)).map(char::len_utf8).sum();
        let start = before + within;
        let end = text[start..].find('\n').map_or(text.len(), |length| start + length);
        Self::at(path, text, start..end, what)
    }

    /// Shows the line that the message speaks of.
    pub(crate) fn with_place(
        mut self,
        file: &Path,
        text: &str,
        span: Range<usize>,
        label: &str,
    ) -> Self {
        self.place = Some(Place {
            file: file.display().to_string(),
            text: text.to_owned(),
            span,
            label: label.to_owned(),
        });
        self
    }

    /// The exit status, as a number.
    pub(crate) fn status(&self) -> u8 {
        self.status
    }

    pub(crate) fn exit_code(&self) -> ExitCode {
        ExitCode::from(self.status)
    }
}

/// Line and column of a byte, both from 1, columns in characters.
fn line_and_column(text: &str, byte: usize) -> (usize, usize) {
    let before = text.get(..byte).unwrap_or(text);
    let line = before.matches('\n').count() + 1;
    let column = before.rsplit('\n').next().unwrap_or_default().chars().count() + 1;
    (line, column)
}
