//! The start of a print, where colours would have to be commanded before it begins.

use fgm_core::{ColorId, Mixture, Role, bead};
use fgm_toolpath::Piece;

/// Follows a print for as long as no command can have changed what comes out: over the first dead
/// volume, which comes out in the colour that the print begins with.
pub(crate) struct Onset {
    /// mm³.
    lead: f64,
    /// Wrong material, step of the mixture times volume, that is not worth telling, mm³.
    least: f64,
    palette: Vec<Mixture>,
    first: Option<ColorId>,
    /// Laid down, as far as it is followed, and where another colour first was to come out, mm³.
    laid: f64,
    change: Option<f64>,
    /// Of the part in another colour than its own, and that by the step of the mixture, mm³.
    off: f64,
    wrong: f64,
}

/// Wrong material below this cannot be seen, mm³.
const TRACE: f64 = 0.1;

impl Onset {
    /// For commands that come `lead` mm³ early; 0 where all can be in time. `threshold` is that of
    /// purges, mm³.
    pub(crate) fn new(lead: f64, threshold: f64, palette: &[Mixture]) -> Self {
        Self {
            lead,
            least: threshold.max(TRACE),
            palette: palette.to_vec(),
            first: None,
            laid: 0.0,
            change: None,
            off: 0.0,
            wrong: 0.0,
        }
    }

    /// Takes the pieces of the next layer, `height` mm high.
    pub(crate) fn follow(&mut self, pieces: &[Piece], height: f64) {
        for piece in pieces {
            if self.laid >= self.lead {
                return;
            }
            let first = *self.first.get_or_insert(piece.color);
            let volume = piece.length() * bead::area(piece.width, height);
            if piece.color != first {
                self.change.get_or_insert(self.laid);
                if !matches!(piece.role, Role::Skirt) && !piece.role.is_purge() {
                    let off = volume.min(self.lead - self.laid);
                    self.off += off;
                    self.wrong += off * self.step(first, piece.color);
                }
            }
            self.laid += volume;
        }
    }

    /// How much of the part cannot have its colour, and what would have to be laid down before it
    /// so that it could, mm³; none where that does not show.
    pub(crate) fn off(&self) -> Option<(f64, f64)> {
        let change = self.change.filter(|_| self.wrong > self.least)?;
        Some((self.off, self.lead - change))
    }

    fn step(&self, from: ColorId, to: ColorId) -> f64 {
        let mixture = |color: ColorId| self.palette.get(color.index());
        mixture(from).zip(mixture(to)).map_or(0.0, |(from, to)| from.distance(to))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fgm_core::Point2;

    /// A bead of a volume, mm³.
    fn bead(color: u16, volume: f64, role: Role) -> Piece {
        let length = volume / bead::area(0.4, 0.2);
        Piece::new(vec![Point2::ZERO, Point2::new(length, 0.0)], role, 0.4, ColorId(color))
    }

    #[test]
    fn what_comes_out_before_a_command_can_act_is_told() {
        let palette: Vec<Mixture> = [0.0, 0.5, 1.0]
            .map(|share| Mixture::from_weights(&[share, 1.0 - share]).unwrap())
            .to_vec();
        let wall = |color, volume| bead(color, volume, Role::OuterWall);
        type Case = (&'static str, f64, f64, Vec<Piece>, Option<(f64, f64)>);
        let cases: [Case; 7] = [
            ("early", 30.0, 0.0, vec![wall(0, 10.0), wall(1, 50.0)], Some((20.0, 20.0))),
            (
                "back",
                30.0,
                0.0,
                vec![wall(0, 10.0), wall(2, 5.0), wall(0, 50.0)],
                Some((5.0, 20.0)),
            ),
            ("after", 30.0, 0.0, vec![wall(0, 30.0), wall(1, 50.0)], None),
            (
                "skirt",
                30.0,
                0.0,
                vec![bead(0, 20.0, Role::Skirt), wall(0, 10.0), wall(1, 9.0)],
                None,
            ),
            ("tower", 30.0, 0.0, vec![wall(0, 1.0), bead(1, 40.0, Role::PurgeTower)], None),
            ("no dead volume", 0.0, 0.0, vec![wall(0, 1.0), wall(2, 50.0)], None),
            ("below the threshold", 30.0, 10.0, vec![wall(0, 10.0), wall(1, 50.0)], None),
        ];
        for (name, lead, threshold, pieces, want) in cases {
            let mut onset = Onset::new(lead, threshold, &palette);
            onset.follow(&pieces, 0.2);
            let near = |a: (f64, f64), b: (f64, f64)| (a.0 - b.0).hypot(a.1 - b.1) < 1e-9;
            match (onset.off(), want) {
                (Some(got), Some(want)) => assert!(near(got, want), "{name}: {got:?}"),
                (got, want) => assert_eq!(got, want, "{name}"),
            }
        }
    }
}
