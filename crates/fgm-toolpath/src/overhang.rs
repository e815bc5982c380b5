//! Which beads hang over.

use fgm_core::{Role, slice_path};

use crate::{
    Piece,
    support::{Hold, Scratch, Stretch, Support},
};

/// Stretches shorter than this, in bead widths, count as what lies before or after them.
const SHORTEST: f64 = 1.0;

/// Gives the beads that hang over their roles: pieces are cut where they begin and cease to.
///
/// What has more than `share` of its width (up to a half) over air is [`Role::SlightOverhang`],
/// more than half of it [`Role::HalfOverhang`], nearly all of it (all but `share`)
/// [`Role::FullOverhang`]. `below` is the layer below; pieces of a role that `which` does not take
/// stay as they are. The pieces of a piece follow each other end to start, so that no travel is
/// added; their lengths sum to its own.
pub fn mark_overhangs(
    pieces: Vec<Piece>,
    below: &Support,
    share: f64,
    which: impl Fn(Role) -> bool,
) -> Vec<Piece> {
    let mut out = Vec::with_capacity(pieces.len());
    let (mut scratch, mut stretches) = (Scratch::default(), Vec::new());
    for piece in pieces {
        let finite = piece.points.iter().all(|p| p.is_finite());
        if !which(piece.role) || !finite {
            out.push(piece);
            continue;
        }
        below.stretches(&piece.points, piece.width, share, &mut scratch, &mut stretches);
        if stretches.len() > 1 {
            settle(&piece, &mut stretches);
        }
        match stretches[..] {
            [] => out.push(piece),
            [one] => {
                let role = role_of(one.hold, piece.role);
                out.push(Piece { role, ..piece });
            }
            _ => {
                let first = out.len();
                out.extend(stretches.iter().map(|stretch| part(&piece, stretch)));
                out[first].way = piece.way;
            }
        }
    }
    out
}

fn role_of(hold: Hold, role: Role) -> Role {
    match hold {
        Hold::Held => role,
        Hold::Slight => Role::SlightOverhang,
        Hold::Half => Role::HalfOverhang,
        Hold::Air => Role::FullOverhang,
    }
}

fn part(piece: &Piece, stretch: &Stretch) -> Piece {
    let mut points = Vec::with_capacity((stretch.to - stretch.from) as usize + 3);
    slice_path(&piece.points, stretch.from, stretch.to, &mut points);
    Piece::new(points, role_of(stretch.hold, piece.role), piece.width, piece.color)
}

/// Gives stretches that are too short to tell to the one before, the first ones to the one after:
/// among those that hang over first, since where a bead lies right at a degree's limit they may all
/// be short.
fn settle(piece: &Piece, stretches: &mut Vec<Stretch>) {
    let mut arc = vec![0.0];
    let mut length = 0.0;
    arc.extend(piece.points.windows(2).map(|w| {
        length += w[0].distance(w[1]);
        length
    }));
    let up_to = |at: f64| {
        let i = (at as usize).min(arc.len() - 1);
        let next = arc[(i + 1).min(arc.len() - 1)];
        arc[i] + (next - arc[i]) * (at - i as f64)
    };
    let short = |s: &Stretch| up_to(s.to) - up_to(s.from) < SHORTEST * piece.width;
    let held = |s: &Stretch| s.hold == Hold::Held;
    absorb(stretches, short, |a, b| held(a) == held(b));
    absorb(stretches, short, |_, _| true);
}

/// Joins short stretches to a neighbour, the one before if there is one, where both may join.
fn absorb(
    stretches: &mut Vec<Stretch>,
    short: impl Fn(&Stretch) -> bool,
    may_join: impl Fn(&Stretch, &Stretch) -> bool,
) {
    stretches.dedup_by(|next, into| {
        let join = next.hold == into.hold || (may_join(into, next) && (short(next) || short(into)));
        if join && short(into) && !short(next) {
            into.hold = next.hold;
        }
        if join {
            into.to = next.to;
        }
        join
    });
}

#[cfg(test)]
#[path = "overhang_tests.rs"]
mod tests;
