use std::fmt;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::{DesignError, Problem};

/// A place in a text file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Location {
    /// The file, as it was named; `--fraction` for an expression that came from the options.
    pub file: PathBuf,
    /// Bytes of the text.
    pub span: Range<usize>,
    /// Line of the first byte, from 1.
    pub line: usize,
    /// Column of the first byte in characters, from 1.
    pub column: usize,
}

impl fmt::Display for Location {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}:{}", self.file.display(), self.line, self.column)
    }
}

/// A text with its name: what an error needs to point.
#[derive(Clone, Debug)]
pub(crate) struct Source {
    pub(crate) file: PathBuf,
    pub(crate) text: Arc<str>,
}

impl Source {
    pub(crate) fn new(file: &Path, text: &str) -> Self {
        Self { file: file.to_path_buf(), text: text.into() }
    }

    /// The error that points at `span`; a span outside the text is moved into it.
    pub(crate) fn error(&self, span: Range<usize>, problem: Problem) -> DesignError {
        DesignError::Source {
            at: Box::new(self.location(span)),
            text: Arc::clone(&self.text),
            problem: Box::new(problem),
        }
    }

    pub(crate) fn location(&self, span: Range<usize>) -> Location {
        let start = floor_char(&self.text, span.start);
        let end = floor_char(&self.text, span.end).max(start);
        let before = &self.text[..start];
        let line_start = before.rfind('\n').map_or(0, |i| i + 1);
        Location {
            file: self.file.clone(),
            span: start..end,
            line: before.matches('\n').count() + 1,
            column: before[line_start..].chars().count() + 1,
        }
    }
}

/// The last character border at or before `at`.
fn floor_char(text: &str, at: usize) -> usize {
    let mut at = at.min(text.len());
    while !text.is_char_boundary(at) {
        at -= 1;
    }
    at
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_count_characters_and_spans_stay_inside() {
        let source = Source::new(Path::new("a.vcad"), "one\nzwö;x");
        let at = source.location(8..9);
        assert_eq!((at.line, at.column), (2, 4), "after the two-byte letter");
        assert_eq!(source.location(90..99).span, 10..10);
        assert_eq!(source.location(7..8).column, 3, "inside a letter: its start");
        assert_eq!(at.to_string(), "a.vcad:2:4");
    }
}
