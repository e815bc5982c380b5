//! Failures and warnings on the terminal.

use std::io::{IsTerminal, Write};

use ariadne::{Config, IndexType, Label, Report, ReportKind, Source};

use crate::failure::{Failure, Place};

/// Writes a failure to standard error: the message, and the line it speaks of.
pub(crate) fn failure(failure: &Failure) {
    let mut err = std::io::stderr().lock();
    // Nothing is left to tell a failure to when standard error itself is gone.
    let _ = writeln!(err, "fgm: error: {}", failure.message);
    if let Some(place) = &failure.place {
        let _ = snippet(place, &mut err);
    }
}

/// Writes a warning to standard error.
pub(crate) fn warning(text: &str) {
    let _ = writeln!(std::io::stderr().lock(), "fgm: warning: {text}");
}

fn snippet(place: &Place, out: &mut impl Write) -> std::io::Result<()> {
    let end = place.span.end.clamp(place.span.start, place.text.len());
    let span = (place.file.as_str(), place.span.start.min(end)..end);
    let color = std::io::stderr().is_terminal();
    let mut report = Vec::new();
    Report::build(ReportKind::Error, span.clone())
        .with_config(Config::default().with_color(color).with_index_type(IndexType::Byte))
        .with_label(Label::new(span).with_message(&place.label))
        .finish()
        .write((place.file.as_str(), Source::from(place.text.as_str())), &mut report)?;
    // Its first line is a heading; the message above is one already.
    let heading = report.iter().position(|&b| b == b'\n').map_or(0, |end| end + 1);
    out.write_all(&report[heading..])
}
