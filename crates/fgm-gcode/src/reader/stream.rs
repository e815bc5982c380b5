use std::io::BufRead;

use super::Line;

/// Reads G-code from a file or a stream, a line at a time, through one reused buffer.
///
/// ```
/// use fgm_gcode::Reader;
/// let mut reader = Reader::new(&b"G1 X1 E2\nG1 X2 E3\n"[..]);
/// let mut filament = 0.0;
/// while let Some(line) = reader.next_line()? {
///     filament += line.command.and_then(|c| c.value(b'E')).unwrap_or(0.0);
/// }
/// assert_eq!((filament, reader.line()), (5.0, 2));
/// # Ok::<(), std::io::Error>(())
/// ```
#[derive(Debug)]
pub struct Reader<R> {
    input: R,
    buffer: Vec<u8>,
    line: u64,
    bytes: u64,
}

impl<R: BufRead> Reader<R> {
    /// Reads from `input`.
    pub fn new(input: R) -> Self {
        Self { input, buffer: Vec::new(), line: 0, bytes: 0 }
    }

    /// The next line; none at the end.
    ///
    /// # Errors
    /// What reading `input` gives. No line is an error.
    pub fn next_line(&mut self) -> std::io::Result<Option<Line<'_>>> {
        self.buffer.clear();
        let read = self.input.read_until(b'\n', &mut self.buffer)?;
        if read == 0 {
            return Ok(None);
        }
        self.line += 1;
        self.bytes += read as u64;
        Ok(Some(Line::parse(&self.buffer)))
    }

    /// The first byte of the next line, which stays to be read; none at the end.
    ///
    /// # Errors
    /// What reading `input` gives.
    pub fn peek(&mut self) -> std::io::Result<Option<u8>> {
        Ok(self.input.fill_buf()?.first().copied())
    }

    /// The number of the line last read, from 1.
    pub fn line(&self) -> u64 {
        self.line
    }

    /// Bytes read so far.
    pub fn bytes(&self) -> u64 {
        self.bytes
    }

    /// The line last read as it is, with its end.
    pub fn raw(&self) -> &[u8] {
        &self.buffer
    }
}

/// The lines of a text in memory.
///
/// ```
/// let moves = fgm_gcode::lines(b"G28\r\nG1 X1\r\n;end").filter(|l| l.command.is_some()).count();
/// assert_eq!(moves, 2);
/// ```
pub fn lines(text: &[u8]) -> Lines<'_> {
    Lines { rest: text }
}

/// Iterates over the lines of a text; see [`lines`].
#[derive(Clone, Debug)]
pub struct Lines<'a> {
    rest: &'a [u8],
}

impl<'a> Iterator for Lines<'a> {
    type Item = Line<'a>;

    fn next(&mut self) -> Option<Line<'a>> {
        if self.rest.is_empty() {
            return None;
        }
        let end = self.rest.iter().position(|&b| b == b'\n');
        let (line, rest) = match end {
            Some(at) => (&self.rest[..at], &self.rest[at + 1..]),
            None => (self.rest, &[][..]),
        };
        self.rest = rest;
        Some(Line::parse(line))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Code, Command};
    use proptest::prelude::*;

    fn show(text: &str) -> String {
        let line = Line::parse(text.as_bytes());
        let words = |c: Command<'_>| -> String {
            c.words()
                .map(|w| format!(" {}={:?}", char::from(w.letter), w.value.unwrap_or(f64::NAN)))
                .collect()
        };
        let command = line.command.map_or(String::new(), |c| match c.code {
            Code::Letter { letter, number, minor } => {
                format!("{}{number}.{minor}{}", char::from(letter), words(c))
            }
            Code::Name(name) => format!("<{}>", String::from_utf8_lossy(name)),
        });
        let comment = line.comment.map(|c| format!(" ;{}", String::from_utf8_lossy(c)));
        format!("{command}{}", comment.unwrap_or_default())
    }

    #[test]
    fn ordinary_lines() {
        for (text, expected) in [
            ("G1 X1 Y-2.5 E.03 F1800", "G1.0 X=1.0 Y=-2.5 E=0.03 F=1800.0"),
            ("g1x1y2", "G1.0 X=1.0 Y=2.0"),
            ("  G1 X 1 Y 2  \r\n", "G1.0 X=1.0 Y=2.0"),
            ("G28 X Y", "G28.0 X=NaN Y=NaN"),
            ("G92.1", "G92.1"),
            ("N12 G1 X5*71", "G1.0 X=5.0"),
            ("T0", "T0.0"),
            ("P0 S1 L2 D0", "P0.0 S=1.0 L=2.0 D=0.0"),
            ("M862.3 P \"XL\" X2", "M862.3 P=NaN X=2.0"),
            ("G1 X1 (to the left) Y2", "G1.0 X=1.0 Y=2.0"),
            (";LAYER_CHANGE", " ;LAYER_CHANGE"),
            ("G4 P100 ; wait; really", "G4.0 P=100.0 ; wait; really"),
            ("SET_PIN PIN=fan VALUE=1", "<SET_PIN>"),
            ("T0_PARK", "<T0_PARK>"),
            ("T?", "<T?>"),
            ("%", "<%>"),
            ("", ""),
            ("\r\n", ""),
            ("N", "<N>"),
            ("*", "<*>"),
            ("G", "<G>"),
        ] {
            assert_eq!(show(text), expected, "{text:?}");
        }
    }

    #[test]
    fn texts_are_kept() {
        for (text, expected) in [
            ("M117 Layer 3 of 9*", &b"Layer 3 of 9*"[..]),
            ("M117 50% *7", b"50%"),
            ("m0 Next: PLA", b"Next: PLA"),
            ("M117", b""),
        ] {
            assert_eq!(Line::parse(text.as_bytes()).command.unwrap().arguments, expected, "{text}");
        }
    }

    #[test]
    fn extended_commands() {
        let line = Line::parse(b"set_mixing_extruder extruder=a FACTORS=0.5:0.5 MSG=\"a b\" X");
        let command = line.command.unwrap();
        assert!(command.is_named("SET_MIXING_EXTRUDER"));
        assert_eq!(command.named_value("factors"), Some(&b"0.5:0.5"[..]));
        assert_eq!(command.named_value("MSG"), Some(&b"a b"[..]));
        assert_eq!(command.pairs().count(), 3);
        assert_eq!(command.named_value("NONE"), None);
    }

    #[test]
    fn peeking_takes_nothing() {
        let mut reader = Reader::new(&b";a\nG1\n"[..]);
        assert_eq!(reader.peek().unwrap(), Some(b';'));
        assert!(reader.next_line().unwrap().unwrap().command.is_none());
        assert_eq!(reader.peek().unwrap(), Some(b'G'));
        assert!(reader.next_line().unwrap().unwrap().command.is_some());
        assert_eq!(reader.peek().unwrap(), None);
    }

    proptest! {
        #[test]
        fn any_bytes_are_lines(text in prop::collection::vec(
            prop_oneof![any::<u8>(), prop::sample::select(b"GMTNXYE*;()\"=. \n-0123456789".to_vec())],
            0..200,
        )) {
            let mut reader = Reader::new(&text[..]);
            let mut count = 0;
            while let Some(line) = reader.next_line().unwrap() {
                if let Some(command) = line.command {
                    prop_assert!(command.words().count() <= text.len());
                    prop_assert!(command.pairs().count() <= text.len());
                }
                count += 1;
            }
            prop_assert_eq!(lines(&text).count(), count);
            prop_assert_eq!(reader.bytes(), text.len() as u64);
        }
    }
}
