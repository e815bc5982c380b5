use std::ops::Range;

use crate::source::Source;
use crate::{DesignError, Problem};

/// What a token is; its text is the source at its span.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    /// A letter or `_`, then letters, digits and `_`.
    Name,
    /// A number without a sign.
    Number,
    /// A string, the quotes included. It may hold newlines; nothing in it is an escape.
    Text,
    /// One of `( ) [ ] { } , ; =`.
    Mark(char),
    /// Any other character of an expression.
    Operator(char),
    /// The end of the file.
    End,
}

/// A token and where it stands.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Token {
    pub(crate) kind: Kind,
    pub(crate) span: Range<usize>,
}

/// Cuts a text into tokens; the last is [`Kind::End`].
pub(crate) fn tokenize(source: &Source) -> Result<Vec<Token>, DesignError> {
    let text = &*source.text;
    let mut tokens = Vec::new();
    let mut at = if text.starts_with('\u{feff}') { '\u{feff}'.len_utf8() } else { 0 };
    while let Some(c) = text[at..].chars().next() {
        let rest = &text[at..];
        let (kind, len) = match c {
            _ if c.is_whitespace() => (None, c.len_utf8()),
            _ if rest.starts_with("//") => (None, rest.find('\n').unwrap_or(rest.len())),
            _ if rest.starts_with("/*") => {
                let Some(end) = rest.find("*/") else {
                    return Err(source.error(at..at + 2, Problem::UnterminatedComment));
                };
                (None, end + 2)
            }
            '"' => {
                let Some(end) = rest[1..].find('"') else {
                    return Err(source.error(at..at + 1, Problem::UnterminatedString));
                };
                (Some(Kind::Text), end + 2)
            }
            '(' | ')' | '[' | ']' | '{' | '}' | ',' | ';' | '=' => (Some(Kind::Mark(c)), 1),
            '+' | '-' | '*' | '/' | '%' | '^' | '<' | '>' | '!' | '&' | '|' | '?' | ':' => {
                (Some(Kind::Operator(c)), 1)
            }
            _ if c.is_ascii_alphabetic() || c == '_' => (Some(Kind::Name), name_len(rest)),
            _ if c.is_ascii_digit() || c == '.' => (Some(Kind::Number), number_len(rest)),
            _ => {
                let span = at..at + c.len_utf8();
                return Err(source.error(span, Problem::UnexpectedCharacter { found: c }));
            }
        };
        if let Some(kind) = kind {
            tokens.push(Token { kind, span: at..at + len });
        }
        at += len;
    }
    tokens.push(Token { kind: Kind::End, span: text.len()..text.len() });
    Ok(tokens)
}

fn name_len(rest: &str) -> usize {
    rest.find(|c: char| !(c.is_ascii_alphanumeric() || c == '_')).unwrap_or(rest.len())
}

/// Digits, a point, digits, and an exponent where digits follow it.
fn number_len(rest: &str) -> usize {
    let bytes = rest.as_bytes();
    let digits = |from: usize| {
        bytes[from.min(bytes.len())..].iter().take_while(|b| b.is_ascii_digit()).count()
    };
    let mut len = digits(0);
    if bytes.get(len) == Some(&b'.') {
        len += 1;
        len += digits(len);
    }
    if matches!(bytes.get(len), Some(b'e' | b'E')) {
        let sign = usize::from(matches!(bytes.get(len + 1), Some(b'+' | b'-')));
        let exponent = digits(len + 1 + sign);
        if exponent > 0 {
            len += 1 + sign + exponent;
        }
    }
    len
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;

    fn words(text: &str) -> Vec<String> {
        let source = Source::new(Path::new("t"), text);
        let tokens = tokenize(&source).unwrap();
        tokens.iter().map(|t| text[t.span.clone()].to_string()).collect()
    }

    #[test]
    fn tokens_of_every_kind() {
        for (text, expected) in [
            (
                "cube(1.5e-3, \"m\"); // end",
                vec!["cube", "(", "1.5e-3", ",", "\"m\"", ")", ";", ""],
            ),
            ("2e x3 .5 5. 1.e2", vec!["2", "e", "x3", ".5", "5.", "1.e2", ""]),
            ("\u{feff}a/* b\n */c //d\ne", vec!["a", "c", "e", ""]),
            ("\"two\nlines // in\"-1", vec!["\"two\nlines // in\"", "-", "1", ""]),
            ("", vec![""]),
        ] {
            assert_eq!(words(text), expected, "{text}");
        }
    }
}
