//! Decimal numbers as G-code has them: a sign, digits, a point, digits.

/// `10^i` for every power that is exact in a double.
const POWERS: [f64; 23] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16,
    1e17, 1e18, 1e19, 1e20, 1e21, 1e22,
];

/// The number at the start of `text`, and how many bytes it has; none where there is no digit.
///
/// The value is the nearest double for up to 15 significant digits (a whole number below `2^53`
/// divided by an exact power of ten is rounded once); further digits are read by the standard
/// library.
#[inline]
pub(super) fn parse(text: &[u8]) -> Option<(f64, usize)> {
    let mut at = usize::from(matches!(text.first(), Some(b'-' | b'+')));
    let negative = text.first() == Some(&b'-');
    let first = at;
    let mut mantissa = 0_u64;
    let mut point = None;
    while let Some(&byte) = text.get(at) {
        match byte {
            b'0'..=b'9' => {
                mantissa = mantissa.wrapping_mul(10).wrapping_add(u64::from(byte - b'0'));
            }
            b'.' if point.is_none() => point = Some(at),
            _ => break,
        }
        at += 1;
    }
    let digits = at - first - usize::from(point.is_some());
    if digits == 0 {
        return None;
    }
    let decimals = point.map_or(0, |p| at - p - 1);
    let magnitude = if digits <= 15 {
        mantissa as f64 / POWERS[decimals.min(22)]
    } else {
        std::str::from_utf8(&text[first..at]).ok()?.parse().ok()?
    };
    Some((if negative { -magnitude } else { magnitude }, at))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn table() {
        for (text, expected) in [
            ("1", Some((1.0, 1))),
            ("-12.5X", Some((-12.5, 5))),
            ("+.25 ", Some((0.25, 4))),
            ("3.", Some((3.0, 2))),
            ("1.2.3", Some((1.2, 3))),
            ("1e5", Some((1.0, 1))),
            ("123456789012345678901234567890", Some((1.2345678901234568e29, 30))),
            ("-", None),
            (".", None),
            ("", None),
            ("X", None),
        ] {
            assert_eq!(parse(text.as_bytes()), expected, "{text}");
        }
    }

    proptest! {
        #[test]
        fn reads_what_is_printed(value in -1e6..1e6f64, decimals in 0usize..12) {
            let text = format!("{value:.decimals$}");
            prop_assert_eq!(parse(text.as_bytes()), Some((text.parse().unwrap(), text.len())));
        }
    }
}
