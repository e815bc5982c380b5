use fgm_core::{Band, Point2, Sectioner, slice_path};

use crate::{
    Path, Piece, section_runs,
    zipper::{Run, color_runs},
};

/// How paths are cut by colour.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(default, deny_unknown_fields))]
pub struct SectionOptions {
    /// A piece shorter than this, mm, is given to the longer of its neighbours on the same path.
    ///
    /// The default of 0.05 only absorbs slivers that no printer resolves. About 5 mm would keep
    /// print quality where a palette is too fine, at the price of misplaced colour.
    pub min_piece: f64,
    /// Added to every turn. The layer's index here makes a zipper alternate from layer to layer
    /// as well; 0 keeps its teeth above each other.
    pub shift: u32,
}

impl Default for SectionOptions {
    fn default() -> Self {
        Self { min_piece: 0.05, shift: 0 }
    }
}

/// Cuts paths by the bands of a layer into pieces of one colour each, appended to `out` in the
/// order of the paths and along each of them.
///
/// The pieces of a path follow each other end to start and their lengths sum to the path's. A
/// closed path is cut all the way round: a piece may go over its first vertex, and a path of one
/// colour stays a loop. Where a band holds two colours (a zipper's overlap) a path takes the one
/// that [`Band::pick`] gives for its [turn](Path::turn), so that neighbours alternate.
///
/// Paths without length give nothing.
pub fn section(
    paths: &[Path],
    sectioner: &dyn Sectioner<Band>,
    options: &SectionOptions,
    out: &mut Vec<Piece>,
) {
    let (mut line, mut spans, mut runs) = (Vec::new(), Vec::new(), Vec::new());
    let mut arc = Vec::new();
    for path in paths {
        line.clear();
        line.extend_from_slice(&path.points);
        if path.closed {
            line.extend(path.points.first());
        }
        if line.len() < 2 {
            continue;
        }
        spans.clear();
        sectioner.section(&line, &mut spans);
        color_runs(path, &spans, options.shift, &mut runs);

        measure(&line, &mut arc, &mut runs);
        if path.closed {
            section_runs::close(&mut runs);
        }
        section_runs::absorb(&mut runs, path.closed, options.min_piece);
        for run in runs.iter().filter(|run| run.length != 0.0) {
            let whole = runs.len() == 1;
            let points = if whole { line.clone() } else { points_of(&line, run) };
            out.push(Piece::new(points, path.role, path.width, run.color));
        }
    }
}

/// Sets the lengths of the runs; `arc` holds the length up to each vertex afterwards.
fn measure(line: &[Point2], arc: &mut Vec<f64>, runs: &mut [Run]) {
    arc.clear();
    arc.push(0.0);
    let mut length = 0.0;
    arc.extend(line.windows(2).map(|w| {
        length += w[0].distance(w[1]);
        length
    }));
    let up_to = |at: f64| {
        let segment = (at.max(0.0) as usize).min(arc.len() - 1);
        let next = arc.get(segment + 1).unwrap_or(&arc[segment]);
        arc[segment] + (next - arc[segment]) * (at - segment as f64)
    };
    for run in runs {
        run.length = (up_to(run.to) - up_to(run.from)).max(0.0);
    }
}

fn points_of(line: &[Point2], run: &Run) -> Vec<Point2> {
    if run.from < run.to {
        let mut points = Vec::with_capacity((run.to - run.from) as usize + 3);
        slice_path(line, run.from, run.to, &mut points);
        return points;
    }
    let end = (line.len() - 1) as f64;
    let mut points = Vec::with_capacity((end - run.from + run.to) as usize + 4);
    slice_path(line, run.from, end, &mut points);
    // The start of the path would stand twice: as the end of one part, the start of the next.
    points.pop();
    slice_path(line, 0.0, run.to, &mut points);
    points
}

#[cfg(test)]
#[path = "section_tests.rs"]
mod tests;
