//! Which colour a stretch of a path takes. In a band of two colours, the overlap of a zipper,
//! neighbours alternate: walls by their place, infill lines by theirs, so that the two colours
//! interdigitate across the border whatever its shape.

use fgm_core::{Band, ColorId, Span};

use crate::Path;

/// A stretch of a path in one colour, in the parameters of [`Span`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Run {
    pub(crate) from: f64,
    /// Not after `from` where the run goes on over the start of a closed path.
    pub(crate) to: f64,
    pub(crate) color: ColorId,
    /// mm.
    pub(crate) length: f64,
}

/// Gives every span its colour and joins neighbours that got the same; lengths are left 0.
///
/// `shift` is added to every turn: with the layer's index, a zipper alternates upwards too.
pub(crate) fn color_runs(path: &Path, spans: &[Span<Band>], shift: u32, runs: &mut Vec<Run>) {
    runs.clear();
    for span in spans {
        if span.label.is_pure() || path.turns.is_empty() {
            let color = span.label.pick(shift.wrapping_add(path.turn) as usize);
            push(runs, span.from, span.to, color);
            continue;
        }
        let mut from = span.from;
        while from < span.to {
            let segment = from.floor();
            let to = (segment + 1.0).min(span.to);
            let turn = shift.wrapping_add(path.turn_of(segment as usize));
            push(runs, from, to, span.label.pick(turn as usize));
            from = to;
        }
    }
}

fn push(runs: &mut Vec<Run>, from: f64, to: f64, color: ColorId) {
    match runs.last_mut() {
        Some(last) if last.color == color => last.to = to,
        _ if from < to => runs.push(Run { from, to, color, length: 0.0 }),
        _ => {}
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fgm_core::{Point2, Role};

    fn zigzag(turns: Vec<u32>) -> Path {
        let points = (0..=turns.len().max(4)).map(|i| Point2::new(i as f64, 0.0)).collect();
        Path { points, closed: false, role: Role::Infill, width: 0.4, turn: 1, turns }
    }

    /// Runs as text: `from-to:color`.
    fn told(path: &Path, spans: &[(f64, f64, u16, u16)], shift: u32) -> String {
        let spans: Vec<_> = spans
            .iter()
            .map(|&(from, to, a, b)| Span {
                from,
                to,
                label: Band::overlap(ColorId(a), ColorId(b)),
            })
            .collect();
        let mut runs = Vec::new();
        color_runs(path, &spans, shift, &mut runs);
        let told: Vec<_> =
            runs.iter().map(|r| format!("{}-{}:{}", r.from, r.to, r.color.0)).collect();
        told.join(" ")
    }

    #[test]
    fn colours_of_spans() {
        let whole = zigzag(vec![]);
        let lines = zigzag(vec![4, 4, 5, 5, 6]);
        for (path, spans, shift, want) in [
            (&whole, &[(0.0, 4.0, 2, 2)][..], 0, "0-4:2"),
            (&whole, &[(0.0, 1.5, 0, 0), (1.5, 2.0, 0, 1), (2.0, 4.0, 1, 1)], 0, "0-1.5:0 1.5-4:1"),
            (&whole, &[(0.0, 1.5, 0, 0), (1.5, 2.0, 0, 1), (2.0, 4.0, 1, 1)], 1, "0-2:0 2-4:1"),
            (&lines, &[(0.0, 5.0, 0, 1)], 0, "0-2:0 2-4:1 4-5:0"),
            (&lines, &[(0.0, 0.5, 0, 0), (0.5, 5.0, 0, 1)], 1, "0-0.5:0 0.5-2:1 2-4:0 4-5:1"),
            (&lines, &[(0.0, 5.0, 3, 3)], 1, "0-5:3"),
            (&lines, &[(0.0, 1.0, 1, 1), (1.0, 1.0, 0, 0), (1.0, 5.0, 1, 1)], 0, "0-5:1"),
        ] {
            assert_eq!(told(path, spans, shift), want, "{spans:?} shifted by {shift}");
        }
    }
}
