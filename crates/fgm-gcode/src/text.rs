use crate::{Fixed, GcodeError};

/// The text that dialects write to: bytes of G-code, one line after the other.
///
/// It implements [`std::fmt::Write`], so `write!` works; the methods here are the fast way.
#[derive(Clone, Debug, Default)]
pub struct Text {
    bytes: Vec<u8>,
    taken: u64,
}

impl Text {
    /// No text.
    pub fn new() -> Self {
        Self::default()
    }

    /// Appends anything as it is.
    #[inline]
    pub fn raw(&mut self, text: &str) -> &mut Self {
        self.bytes.extend_from_slice(text.as_bytes());
        self
    }

    /// Appends a whole line.
    pub fn line(&mut self, text: &str) {
        self.raw(text).end();
    }

    /// Ends the line.
    #[inline]
    pub fn end(&mut self) {
        self.bytes.push(b'\n');
    }

    /// Appends ` X12.345`: a blank, a letter and a number with all its decimals.
    #[inline]
    pub fn word<const D: u32>(&mut self, letter: char, value: Fixed<D>) -> &mut Self {
        self.bytes.extend_from_slice(&[b' ', letter as u8]);
        value.write(&mut self.bytes);
        self
    }

    /// Appends ` S3`: a blank, a letter and a whole number.
    #[inline]
    pub fn int(&mut self, letter: char, value: u32) -> &mut Self {
        self.word(letter, Fixed::<0>::from_units(i64::from(value)))
    }

    /// Appends ` P0.25`: a blank, a letter and a number of at most four decimals.
    ///
    /// # Errors
    /// [`GcodeError::NotANumber`].
    pub fn real(&mut self, letter: char, value: f64) -> Result<&mut Self, GcodeError> {
        self.bytes.extend_from_slice(&[b' ', letter as u8]);
        self.number(value)
    }

    /// Appends `0.25`: a number of at most four decimals.
    ///
    /// # Errors
    /// [`GcodeError::NotANumber`].
    pub fn number(&mut self, value: f64) -> Result<&mut Self, GcodeError> {
        Fixed::<4>::round(value)?.write_trimmed(&mut self.bytes);
        Ok(self)
    }

    /// Appends `0.25:0.75`: numbers of at most four decimals with colons between.
    ///
    /// # Errors
    /// [`GcodeError::NotANumber`].
    pub fn list(&mut self, values: &[f64]) -> Result<&mut Self, GcodeError> {
        for (i, &value) in values.iter().enumerate() {
            if i > 0 {
                self.bytes.push(b':');
            }
            self.number(value)?;
        }
        Ok(self)
    }

    /// What has been written and not yet taken.
    pub fn as_bytes(&self) -> &[u8] {
        &self.bytes
    }

    /// The text as a string; bytes that are not UTF-8 become replacement characters.
    pub fn to_text(&self) -> String {
        String::from_utf8_lossy(&self.bytes).into_owned()
    }

    /// How many bytes have been written in all.
    pub fn written(&self) -> u64 {
        self.taken + self.bytes.len() as u64
    }

    /// Forgets the bytes (they are elsewhere now) and keeps the buffer.
    pub(crate) fn taken(&mut self) {
        self.taken += self.bytes.len() as u64;
        self.bytes.clear();
    }
}

impl std::fmt::Write for Text {
    fn write_str(&mut self, text: &str) -> std::fmt::Result {
        self.raw(text);
        Ok(())
    }
}
