//! Cutting the source into tokens.

use std::ops::Range;

use super::error::{ExprError, ExprErrorKind};

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum TokenKind<'s> {
    Number(f64),
    Name(&'s str),
    Symbol(Symbol),
    End,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Symbol {
    Plus,
    Minus,
    Star,
    Slash,
    Percent,
    Caret,
    Open,
    Close,
    Comma,
    Question,
    Colon,
    Equal,
    NotEqual,
    Less,
    LessEqual,
    Greater,
    GreaterEqual,
    And,
    Or,
}

#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Token<'s> {
    pub(crate) kind: TokenKind<'s>,
    pub(crate) span: Range<usize>,
}

/// Longer symbols before those they begin with.
const SYMBOLS: [(&str, Symbol); 19] = [
    ("==", Symbol::Equal),
    ("!=", Symbol::NotEqual),
    ("<=", Symbol::LessEqual),
    (">=", Symbol::GreaterEqual),
    ("<", Symbol::Less),
    (">", Symbol::Greater),
    ("+", Symbol::Plus),
    ("-", Symbol::Minus),
    ("*", Symbol::Star),
    ("/", Symbol::Slash),
    ("%", Symbol::Percent),
    ("^", Symbol::Caret),
    ("(", Symbol::Open),
    (")", Symbol::Close),
    (",", Symbol::Comma),
    ("?", Symbol::Question),
    (":", Symbol::Colon),
    ("&", Symbol::And),
    ("|", Symbol::Or),
];

/// The token that begins at or after `from`, white space skipped.
pub(crate) fn next_token(source: &str, from: usize) -> Result<Token<'_>, ExprError> {
    let rest = &source[from..];
    let at = from + (rest.len() - rest.trim_start().len());
    let rest = &source[at..];
    let Some(first) = rest.chars().next() else {
        return Ok(Token { kind: TokenKind::End, span: source.len()..source.len() });
    };
    if first.is_ascii_digit() || first == '.' {
        return number(source, at);
    }
    if first.is_ascii_alphabetic() || first == '_' {
        let length = rest.bytes().take_while(|b| b.is_ascii_alphanumeric() || *b == b'_').count();
        return Ok(Token { kind: TokenKind::Name(&rest[..length]), span: at..at + length });
    }
    match SYMBOLS.iter().find(|(text, _)| rest.starts_with(text)) {
        Some((text, symbol)) => {
            Ok(Token { kind: TokenKind::Symbol(*symbol), span: at..at + text.len() })
        }
        None => {
            let expected = match first {
                '=' => "`==` to compare",
                '!' => "`!=` to compare, or `not`",
                '[' | ']' | '{' | '}' => "`(` or `)`",
                _ => "a number, a name or an operator",
            };
            let kind = ExprErrorKind::UnexpectedCharacter { found: first, expected };
            Err(ExprError { span: at..at + first.len_utf8(), kind })
        }
    }
}

/// A number: `12`, `1.5`, `.5`, `1.`, `2e-3`. An `e` without digits after it is not part of it, so
/// that `2e` is twice Euler's number and `2exp(x)` twice a call.
fn number(source: &str, at: usize) -> Result<Token<'_>, ExprError> {
    let bytes = source.as_bytes();
    let digits = |mut i: usize| {
        while bytes.get(i).is_some_and(u8::is_ascii_digit) {
            i += 1;
        }
        i
    };
    let mut end = digits(at);
    if bytes.get(end) == Some(&b'.') {
        end = digits(end + 1);
    }
    let fault = |end: usize| ExprError {
        span: at..end,
        kind: ExprErrorKind::Unexpected {
            found: source[at..end].into(),
            expected: "a number with one decimal point and a digit",
        },
    };
    if end == at + 1 && bytes[at] == b'.' {
        return Err(fault(end));
    }
    if matches!(bytes.get(end), Some(b'e' | b'E')) {
        let sign = usize::from(matches!(bytes.get(end + 1), Some(b'+' | b'-')));
        let exponent = digits(end + 1 + sign);
        if exponent > end + 1 + sign {
            end = exponent;
        }
    }
    if bytes.get(end) == Some(&b'.') {
        return Err(fault(end + 1));
    }
    let value: f64 = source[at..end].parse().map_err(|_| fault(end))?;
    if !value.is_finite() {
        return Err(ExprError { span: at..end, kind: ExprErrorKind::NotFinite { value } });
    }
    Ok(Token { kind: TokenKind::Number(value), span: at..end })
}
