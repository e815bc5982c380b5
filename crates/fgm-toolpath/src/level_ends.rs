//! Bringing the ends of neighbouring lines to one level, where a boundary between colours runs too
//! steeply along them to turn round at it.

use fgm_core::{Point2, bead};

use crate::{
    Piece,
    join_ends::{BESIDE, Turns},
};

/// How near to each other neighbours may be, in line spacings.
const NEAREST: f64 = 0.5;
/// The farthest that one may end before the other, in line spacings: the boundary then stands at
/// 7 degrees to them.
const FARTHEST: f64 = 8.0;
/// What is to be left of a line, in line spacings.
const LEAST: f64 = 4.0;
/// Cosine between directions that are one.
const STRAIGHT: f64 = 0.9999;

/// Where pieces end, to find what goes on there in another colour.
pub(crate) struct Ends {
    /// By place.
    ends: Vec<End>,
}

/// One end of a piece, by the piece's number; its last point or its first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct PieceEnd {
    pub(crate) piece: usize,
    pub(crate) last: bool,
}

#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct End {
    place: (u64, u64),
    piece: usize,
    last: bool,
}

fn place(p: Point2) -> (u64, u64) {
    (p.x.to_bits(), p.y.to_bits())
}

impl Ends {
    pub(crate) fn of(pieces: &[Piece]) -> Self {
        let open = pieces.iter().enumerate().filter(|(_, piece)| !piece.is_loop());
        let ends = open.flat_map(|(i, piece)| {
            let end =
                |p: Option<&Point2>, last| p.map(|p| End { place: place(*p), piece: i, last });
            [end(piece.points.first(), false), end(piece.points.last(), true)]
        });
        let mut ends: Vec<End> = ends.flatten().collect();
        ends.sort_unstable();
        Self { ends }
    }

    /// Brings ends to one level where `ordered` pieces follow each other beside a steep boundary and
    /// the lines beyond it are among `rest`, the pieces from number `first` on: what one line gains
    /// in length, the line beyond loses, so that nothing lies bare or twice, and the boundary moves by
    /// less than half a spacing.
    ///
    /// The ends beyond go to `pairs` where they are of one colour: they turn best into each other.
    pub(crate) fn level(
        &self,
        ordered: &mut [Piece],
        rest: &mut [Piece],
        first: usize,
        turns: &Turns,
        pairs: &mut Vec<[PieceEnd; 2]>,
    ) {
        for i in 1..ordered.len() {
            let [before, piece] = &mut ordered[i - 1..=i] else { continue };
            let alike = before.role == piece.role
                && before.width == piece.width
                && before.color == piece.color;
            if alike
                && turns.may_turn(piece.role)
                && let Some(step) = step(&before.points, &piece.points, piece.width, turns)
                && let Some(one) = self.beyond(before.points.last(), rest, first, &step.ahead)
                && let Some(other) = self.beyond(piece.points.first(), rest, first, &step.back)
                && one.piece != other.piece
            {
                step.ahead.apply(before.points.last_mut());
                step.back.apply(piece.points.first_mut());
                step.ahead.apply(point(rest, one));
                step.back.apply(point(rest, other));
                if rest[one.piece].color == rest[other.piece].color {
                    pairs
                        .push([one, other].map(|end| PieceEnd { piece: first + end.piece, ..end }));
                }
            }
        }
    }

    /// The piece of another colour that goes on in a straight line where one ends, if it is long
    /// enough.
    fn beyond(
        &self,
        end: Option<&Point2>,
        rest: &[Piece],
        first: usize,
        shift: &Shift,
    ) -> Option<PieceEnd> {
        let place = place(*end?);
        let from = self.ends.partition_point(|e| e.place < place);
        let here = self.ends[from..].iter().take_while(|e| e.place == place);
        here.filter_map(|e| Some(PieceEnd { piece: e.piece.checked_sub(first)?, last: e.last }))
            .find(|beyond| {
                let Some(piece) = rest.get(beyond.piece) else { return false };
                let [tip, next] = tip(&piece.points, beyond.last);
                crate::level_ends::place(tip) == place && shift.fits(next - tip)
            })
    }
}

fn point(pieces: &mut [Piece], end: PieceEnd) -> Option<&mut Point2> {
    let points = &mut pieces.get_mut(end.piece)?.points;
    if end.last { points.last_mut() } else { points.first_mut() }
}

/// An end of a line and the point before it; not finite where there is none.
fn tip(points: &[Point2], last: bool) -> [Point2; 2] {
    match (points, last) {
        ([.., next, tip], true) | ([tip, next, ..], false) => [*tip, *next],
        _ => [Point2::NAN; 2],
    }
}

/// How an end moves along its line.
struct Shift {
    by: Point2,
    /// Away from the line.
    outward: Point2,
    /// What has to be left, mm.
    least: f64,
}

impl Shift {
    fn apply(&self, end: Option<&mut Point2>) {
        if let Some(end) = end {
            *end += self.by;
        }
    }

    /// Whether a line that leads outward from the end, by `next`, stays straight and long enough.
    fn fits(&self, next: Point2) -> bool {
        let length = next.length();
        next.dot(self.outward) > STRAIGHT * length
            && length - self.by.dot(self.outward) >= self.least
    }
}

struct Step {
    ahead: Shift,
    back: Shift,
}

/// How the end of one line and the start of the next come to one level.
fn step(one: &[Point2], other: &[Point2], width: f64, turns: &Turns) -> Option<Step> {
    let ([end, before], [start, after]) = (tip(one, true), tip(other, false));
    let (ahead, back) = ((end - before).try_normalize()?, (start - after).try_normalize()?);
    let spacing = bead::spacing(width, turns.height);
    let apart = start - end;
    let (along, aside) = (apart.dot(ahead), apart.perp_dot(ahead).abs());
    let steep = apart.length() > turns.reach() * spacing && along.abs() <= FARTHEST * spacing;
    if !steep || !(NEAREST..BESIDE).contains(&(aside / spacing)) || ahead.dot(back) < STRAIGHT {
        return None;
    }
    let least = LEAST * spacing;
    let (half, length) = (0.5 * along, |a: Point2, b: Point2| a.distance(b));
    if length(end, before) + half < least || length(start, after) - half < least {
        return None;
    }
    let shift = |outward: Point2, by: f64| Shift { by: outward * by, outward, least };
    Some(Step { ahead: shift(ahead, half), back: shift(back, -half) })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::join_ends;
    use fgm_core::{ColorId, Role};
    use proptest::prelude::*;

    const TURNS: Turns = Turns { height: 0.2, steepest: std::f64::consts::FRAC_PI_3 };

    fn line(from: f64, to: f64, y: f64, color: u16) -> Piece {
        let points = vec![Point2::new(from, y), Point2::new(to, y)];
        Piece::new(points, Role::Infill, 0.4, ColorId(color))
    }

    /// Lines side by side, each of colour 0 up to a place and of colour 1 from there on; colour 0
    /// comes first, there and back.
    fn hatch(boundary: &[f64], spacing: f64) -> Vec<Piece> {
        let y = |i: usize| i as f64 * spacing;
        let low = boundary.iter().enumerate().map(|(i, &x)| {
            if i % 2 == 0 { line(-9.0, x, y(i), 0) } else { line(x, -9.0, y(i), 0) }
        });
        let high = boundary.iter().enumerate().map(|(i, &x)| line(x, 30.0, y(i), 1));
        low.chain(high).collect()
    }

    fn leveled(mut pieces: Vec<Piece>, count: usize) -> Vec<Piece> {
        let ends = Ends::of(&pieces);
        let (ordered, rest) = pieces.split_at_mut(count);
        let mut pairs = Vec::new();
        ends.level(ordered, rest, count, &TURNS, &mut pairs);
        for pair in pairs {
            let [one, other] = pair.map(|end| {
                let points = &pieces[end.piece].points;
                if end.last { points[points.len() - 1] } else { points[0] }
            });
            assert!((one.x - other.x).abs() < 1e-12);
        }
        pieces
    }

    fn xs(pieces: &[Piece]) -> Vec<(f64, f64)> {
        pieces.iter().map(|p| (p.points[0].x, p.points[1].x)).collect()
    }

    #[test]
    fn both_lines_end_half_way() {
        let spacing = bead::spacing(0.4, 0.2);
        let out = leveled(hatch(&[0.0, 1.0], spacing), 2);
        assert_eq!(xs(&out), [(-9.0, 0.5), (0.5, -9.0), (0.5, 30.0), (0.5, 30.0)]);
        // Which the turn then needs.
        let mut ordered = out[..2].to_vec();
        join_ends(&mut ordered, &TURNS);
        assert_eq!(ordered.len(), 1);
        // A boundary that is not steep, lines that are not neighbours and ends too far from each
        // other stay.
        for pieces in [
            hatch(&[0.0, 0.5], spacing),
            hatch(&[0.0, 1.0], 2.0 * spacing),
            hatch(&[0.0, 5.0], spacing),
        ] {
            assert_eq!(leveled(pieces.clone(), 2), pieces);
        }
    }

    #[test]
    fn what_ends_at_nothing_or_would_be_too_short_stays() {
        let spacing = bead::spacing(0.4, 0.2);
        let whole = hatch(&[0.0, 1.0], spacing);
        let alone = whole[..3].to_vec();
        assert_eq!(leveled(alone.clone(), 2), alone);
        let mut short = whole.clone();
        short[2].points[1].x = 1.0;
        assert_eq!(leveled(short.clone(), 2), short);
        let mut bent = whole;
        bent[2].points[1].y = 3.0;
        assert_eq!(leveled(bent.clone(), 2), bent);
    }

    proptest! {
        #[test]
        fn lines_stay_covered_once(
            boundary in prop::collection::vec(0.0..6.0f64, 2..12),
            spacing in 0.2..0.5f64,
        ) {
            let count = boundary.len();
            let was = hatch(&boundary, spacing);
            let out = leveled(was.clone(), count);
            for (i, &x) in boundary.iter().enumerate() {
                let (low, high) = (&out[i].points, &out[count + i].points);
                let end = low[0].x.max(low[1].x);
                prop_assert_eq!(end, high[0].x);
                prop_assert!((low[0].x.min(low[1].x), high[1].x) == (-9.0, 30.0));
                prop_assert!((end - x).abs() <= 0.5 * FARTHEST * bead::spacing(0.4, 0.2) + 1e-9);
            }
        }
    }
}
