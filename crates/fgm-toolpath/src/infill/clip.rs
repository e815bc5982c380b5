//! Drawn lines cut to a region.

use fgm_core::{Bounds2, Point2, Polygon, Ring};

use super::InfillOptions;
use crate::{Inset, Path, inset::grid::EdgeGrid, inset::simplify};

/// How far lines may be straightened, mm, and as a share of the cell: more would take length off
/// dense fillings.
const STRAIGHTEN: (f64, f64) = (0.01, 0.01);

/// Where a filling's lines may run, in axes turned by its angle.
pub(super) struct Clip {
    /// Of everything inside; finite.
    pub(super) bounds: Bounds2,
    axis: Point2,
    grid: EdgeGrid,
    straighten: f64,
}

impl Clip {
    /// Half a spacing inside the region, for lines that turn over a length of `cell` mm; `None`
    /// where nothing is left.
    pub(super) fn new(
        region: &[Polygon],
        options: &InfillOptions,
        cell: f64,
        inset: &dyn Inset,
    ) -> Option<Self> {
        let centres = inset.inset(region, 0.5 * options.spacing());
        let axis = Point2::from_angle(options.angle);
        let back = axis * Point2::new(1.0, -1.0);
        let edges: Vec<_> = centres
            .iter()
            .flat_map(Polygon::rings)
            .flat_map(Ring::edges)
            .map(|(a, b)| (back.rotate(a), back.rotate(b)))
            .collect();
        let bounds = Bounds2::of(edges.iter().map(|e| e.0));
        let straighten = STRAIGHTEN.0.min(STRAIGHTEN.1 * cell);
        let grid = EdgeGrid::new(edges, cell);
        bounds.is_finite().then_some(Self { bounds, axis, grid, straighten })
    }

    /// Appends the parts inside of a line that begins and ends outside.
    pub(super) fn line(
        &self,
        points: &[Point2],
        turn: u32,
        options: &InfillOptions,
        out: &mut Vec<Path>,
    ) {
        self.inside(points, |part| {
            let mut line = Vec::with_capacity(part.len());
            simplify::line(part, false, self.straighten, &mut line);
            line.iter_mut().for_each(|p| *p = self.axis.rotate(*p));
            out.push(Path {
                points: line,
                closed: false,
                role: options.role,
                width: options.width,
                turn,
                turns: Vec::new(),
            });
        });
    }

    /// Calls `emit` with every part of a line inside the border; the line begins outside.
    fn inside(&self, points: &[Point2], mut emit: impl FnMut(&[Point2])) {
        let mut part: Vec<Point2> = Vec::new();
        let mut shares = Vec::new();
        let mut within = false;
        for pair in points.windows(2) {
            let (a, b) = (pair[0], pair[1]);
            shares.clear();
            self.grid.crossings(a, b, &mut shares);
            for &share in &shares {
                part.push(a + (b - a) * share);
                if within && part.len() > 1 {
                    emit(&part);
                }
                within = !within;
                if !within {
                    part.clear();
                }
            }
            if within {
                part.push(b);
            }
        }
    }
}
