use super::number;

/// One line of G-code, taken apart without copying.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Line<'a> {
    /// The line number after `N`.
    pub number: Option<u64>,
    /// The command, where there is one.
    pub command: Option<Command<'a>>,
    /// The checksum after `*`.
    pub checksum: Option<u8>,
    /// What follows the first `;`, as it is (a leading blank included, the end of line not).
    pub comment: Option<&'a [u8]>,
}

/// A command: `G1 X1 Y2`, `T0`, `M117 Hello`, `SET_MIXING_EXTRUDER FACTORS=0.5:0.5`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Command<'a> {
    /// Which command.
    pub code: Code<'a>,
    /// Everything after it up to the comment or checksum, trimmed.
    pub arguments: &'a [u8],
}

/// Which command.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Code<'a> {
    /// A letter and a number: `G1`, `G92.1`, `T0`.
    Letter {
        /// In upper case.
        letter: u8,
        /// Before the point.
        number: u32,
        /// After the point; 0 where there is none.
        minor: u32,
    },
    /// A word: Klipper's extended commands, `T?`, or anything else that is not a letter and a
    /// number.
    Name(&'a [u8]),
}

/// A letter and its number: `X12.5`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Word {
    /// In upper case.
    pub letter: u8,
    /// None where no number follows: `G28 X`.
    pub value: Option<f64>,
}

impl<'a> Line<'a> {
    /// Takes a line apart. Any bytes are a line: what is no known form is a
    /// [`Code::Name`].
    ///
    /// ```
    /// use fgm_gcode::Line;
    /// let line = Line::parse(b"N7 g1 x10.5E.2*71 ; wall");
    /// let command = line.command.ok_or("no command")?;
    /// assert!(command.is(b'G', 1));
    /// assert_eq!((command.value(b'X'), command.value(b'E')), (Some(10.5), Some(0.2)));
    /// assert_eq!((line.number, line.checksum), (Some(7), Some(71)));
    /// assert_eq!(line.comment, Some(&b" wall"[..]));
    /// # Ok::<(), &str>(())
    /// ```
    pub fn parse(line: &'a [u8]) -> Self {
        let line = line.trim_ascii_end();
        let (text, comment) = match line.iter().position(|&b| b == b';') {
            Some(at) => (&line[..at], Some(&line[at + 1..])),
            None => (line, None),
        };
        let mut text = text.trim_ascii();
        let mut result = Line { comment, ..Line::default() };
        if text.is_empty() {
            return result;
        }
        (result.number, text) = line_number(text);
        (text, result.checksum) = checksum(text);
        result.command = Command::parse(text);
        result
    }
}

/// Splits off `N123`.
fn line_number(text: &[u8]) -> (Option<u64>, &[u8]) {
    if !matches!(text[0], b'N' | b'n') {
        return (None, text);
    }
    let digits = text[1..].iter().take_while(|b| b.is_ascii_digit()).count();
    let number = std::str::from_utf8(&text[1..=digits]).ok().and_then(|n| n.parse().ok());
    match number {
        Some(_) => (number, text[1 + digits..].trim_ascii_start()),
        None => (None, text),
    }
}

/// Splits off `*71` at the end.
fn checksum(text: &[u8]) -> (&[u8], Option<u8>) {
    // Ordinary lines have none, so the digits at the end are looked at first.
    let digits = text.iter().rev().take_while(|b| b.is_ascii_digit()).count();
    let Some(star) = text.len().checked_sub(digits + 1).filter(|&at| text[at] == b'*') else {
        return (text, None);
    };
    let sum = std::str::from_utf8(&text[star + 1..]).ok().and_then(|n| n.parse().ok());
    if sum.is_some() { (text[..star].trim_ascii_end(), sum) } else { (text, None) }
}

impl<'a> Command<'a> {
    fn parse(text: &'a [u8]) -> Option<Self> {
        let first = *text.first()?;
        let digits = |from: usize| text[from..].iter().take_while(|b| b.is_ascii_digit()).count();
        let major = digits(1);
        if !first.is_ascii_alphabetic() || major == 0 {
            return Some(Self::named(text));
        }
        let mut end = 1 + major;
        let mut minor = 0;
        if text.get(end) == Some(&b'.') {
            let count = digits(end + 1);
            minor = decimal(&text[end + 1..end + 1 + count]);
            end += 1 + count;
        }
        // "M117abc" is a command and its text, but "T0_HOME" and "G1_MACRO" are names.
        if matches!(text.get(end), Some(b'_' | b'=')) {
            return Some(Self::named(text));
        }
        let number = decimal(&text[1..=major]);
        let code = Code::Letter { letter: first.to_ascii_uppercase(), number, minor };
        Some(Self { code, arguments: text[end..].trim_ascii_start() })
    }

    fn named(text: &'a [u8]) -> Self {
        let end = text.iter().position(u8::is_ascii_whitespace).unwrap_or(text.len());
        Self { code: Code::Name(&text[..end]), arguments: text[end..].trim_ascii_start() }
    }

    /// Whether it is this command, whatever its minor number.
    #[inline]
    pub fn is(&self, letter: u8, number: u32) -> bool {
        matches!(self.code, Code::Letter { letter: l, number: n, .. } if l == letter && n == number)
    }

    /// Whether it is this extended command, in any case.
    pub fn is_named(&self, name: &str) -> bool {
        matches!(self.code, Code::Name(n) if n.eq_ignore_ascii_case(name.as_bytes()))
    }

    /// Its letters and numbers, in order. For text (`M117 Hello`) see
    /// [`arguments`](Self::arguments).
    #[inline]
    pub fn words(&self) -> Arguments<'a> {
        Arguments { rest: self.arguments }
    }

    /// The number after a letter (in upper case); the last one where it comes twice.
    pub fn value(&self, letter: u8) -> Option<f64> {
        self.words().filter(|w| w.letter == letter).last().and_then(|w| w.value)
    }

    /// Whether a letter is there, with a number or without.
    pub fn has(&self, letter: u8) -> bool {
        self.words().any(|w| w.letter == letter)
    }

    /// The `KEY=value` pairs of an extended command.
    pub fn pairs(&self) -> Pairs<'a> {
        Pairs { rest: self.arguments }
    }

    /// The value of a key of an extended command, in any case.
    pub fn named_value(&self, key: &str) -> Option<&'a [u8]> {
        self.pairs().find(|(k, _)| k.eq_ignore_ascii_case(key.as_bytes())).map(|(_, v)| v)
    }
}

/// Digits as a number; the greatest where they are too many.
fn decimal(digits: &[u8]) -> u32 {
    digits
        .iter()
        .fold(0_u32, |n, d| n.saturating_mul(10).saturating_add(u32::from(d.wrapping_sub(b'0'))))
}

/// Iterates over letters and numbers; see [`Command::words`].
///
/// Blanks between a letter and its number are passed over, `(notes)` and bytes that are no letter
/// too; a text in quotes belongs to the letter before it and gives no number.
#[derive(Clone, Debug)]
pub struct Arguments<'a> {
    rest: &'a [u8],
}

impl Iterator for Arguments<'_> {
    type Item = Word;

    #[inline]
    fn next(&mut self) -> Option<Word> {
        loop {
            let (&first, tail) = self.rest.split_first()?;
            self.rest = tail;
            if first.is_ascii_alphabetic() {
                let mut blanks = 0;
                while matches!(tail.get(blanks), Some(b' ' | b'\t')) {
                    blanks += 1;
                }
                let value = number::parse(&tail[blanks..]).map(|(value, used)| {
                    self.rest = &tail[blanks + used..];
                    value
                });
                return Some(Word { letter: first.to_ascii_uppercase(), value });
            }
            let close = match first {
                b'"' => b'"',
                b'(' => b')',
                _ => continue,
            };
            let end = tail.iter().position(|&b| b == close).map_or(tail.len(), |at| at + 1);
            self.rest = &tail[end..];
        }
    }
}

/// Iterates over `KEY=value` pairs; see [`Command::pairs`]. A value in quotes may have blanks.
#[derive(Clone, Debug)]
pub struct Pairs<'a> {
    rest: &'a [u8],
}

impl<'a> Iterator for Pairs<'a> {
    type Item = (&'a [u8], &'a [u8]);

    fn next(&mut self) -> Option<Self::Item> {
        loop {
            let rest = self.rest.trim_ascii_start();
            if rest.is_empty() {
                return None;
            }
            let end = rest.iter().position(|b| b.is_ascii_whitespace() || *b == b'=');
            let end = end.unwrap_or(rest.len());
            if rest.get(end) != Some(&b'=') {
                self.rest = &rest[end..];
                continue;
            }
            let value = &rest[end + 1..];
            let (value, used) = match value.first() {
                Some(b'"') => {
                    let close = value[1..].iter().position(|&b| b == b'"');
                    let close = close.map_or(value.len(), |at| at + 1);
                    (&value[1..close], (close + 1).min(value.len()))
                }
                _ => {
                    let stop = value.iter().position(u8::is_ascii_whitespace);
                    let stop = stop.unwrap_or(value.len());
                    (&value[..stop], stop)
                }
            };
            self.rest = &rest[end + 1 + used..];
            return Some((&rest[..end], value));
        }
    }
}
