use crate::ContourError;
use crate::graph::{Graph, Node};
use crate::root::Bracket;
use crate::sweep::Task;
use fgm_core::Point2;

/// Searches that are evaluated together.
const BATCH: usize = 512;

/// Puts each crossing on the true curve, many at a time.
#[derive(Debug, Default)]
pub(crate) struct Placer {
    searches: Vec<Search>,
    points: Vec<Point2>,
    values: Vec<f64>,
}

#[derive(Clone, Copy, Debug)]
struct Search {
    node: u32,
    level: f64,
    bracket: Bracket,
    tolerance: f64,
    from: Point2,
    to: Point2,
}

impl Placer {
    /// Replaces `positions` by where the field takes each crossing's level on its lattice edge.
    ///
    /// Crossings stay off the samples by a thousandth of the tolerance, so that lines that meet
    /// nowhere do not touch at a sample that has exactly the level.
    pub(crate) fn place(
        &mut self,
        task: &Task<'_>,
        graph: &Graph,
        tolerance: f64,
        positions: &mut Vec<Point2>,
    ) -> Result<(), ContourError> {
        positions.clear();
        positions.resize(graph.nodes.len(), Point2::ZERO);
        let apart = 1e-3 * tolerance;
        let mut waiting = 0;
        while waiting < graph.nodes.len() || !self.searches.is_empty() {
            while self.searches.len() < BATCH && waiting < graph.nodes.len() {
                let node = &graph.nodes[waiting];
                match Search::new(waiting as u32, node, task, tolerance) {
                    Some(search) => self.searches.push(search),
                    None => positions[waiting] = node.ends(task.lattice).0,
                }
                waiting += 1;
            }
            self.step(task, apart, positions)?;
        }
        order_crowded(task, graph, tolerance, positions);
        Ok(())
    }

    /// One evaluation for every open search; those that are done leave.
    fn step(
        &mut self,
        task: &Task<'_>,
        apart: f64,
        positions: &mut [Point2],
    ) -> Result<(), ContourError> {
        self.points.clear();
        self.points.extend(self.searches.iter().map(Search::point));
        self.values.resize(self.points.len(), 0.0);
        task.field.eval_into(&self.points, &mut self.values);
        let mut failed = None;
        let mut k = 0;
        self.searches.retain_mut(|search| {
            let (value, point) = (self.values[k], self.points[k]);
            k += 1;
            let nan = value.is_nan();
            if nan && !task.skip_nan {
                failed = failed.or(Some(point));
            }
            let done = nan || search.bracket.update(value - search.level, search.tolerance);
            if done {
                positions[search.node as usize] = search.answer(apart);
            }
            !done
        });
        match failed {
            Some(at) => Err(ContourError::NotANumber { at }),
            None => Ok(()),
        }
    }
}

impl Search {
    /// None on an edge without length.
    fn new(id: u32, node: &Node, task: &Task<'_>, tolerance: f64) -> Option<Self> {
        let (from, to) = node.ends(task.lattice);
        let length = (to - from).element_sum();
        let level = task.levels[usize::from(node.level)];
        let bracket = Bracket::new(node.values[0] - level, node.values[1] - level);
        let tolerance = tolerance / length;
        (length > 0.0).then_some(Self { node: id, level, bracket, tolerance, from, to })
    }

    fn point(&self) -> Point2 {
        self.from + (self.to - self.from) * self.bracket.guess()
    }

    /// Where the crossing is, off the ends by `apart` where the edge is long enough.
    fn answer(&self, apart: f64) -> Point2 {
        let edge = self.to - self.from;
        let least = (apart / edge.element_sum()).min(0.25);
        self.from + edge * self.bracket.guess().clamp(least, 1.0 - least)
    }
}

/// Brings the crossings of several levels on one edge into the order of the levels.
///
/// A field that rises and falls between two samples takes a level more than once there, and the
/// searches may have found roots that would let lines of different levels cross.
fn order_crowded(task: &Task<'_>, graph: &Graph, tolerance: f64, positions: &mut [Point2]) {
    for (first, end) in graph.crowded_edges() {
        let node = &graph.nodes[first];
        let rising = node.values[0] < node.values[1];
        let (from, to) = node.ends(task.lattice);
        // From the end with the low values, the place grows with the level.
        let (low, high) = if rising { (from, to) } else { (to, from) };
        let low_value = if rising { node.values[0] } else { node.values[1] };
        let along = |p: Point2| (p - low).dot(high - low);
        for k in (first..end - 1).rev() {
            let limit = positions[k + 1];
            if along(positions[k]) <= along(limit) {
                continue;
            }
            positions[k] = limit;
            let level = task.levels[usize::from(graph.nodes[k].level)];
            let above = task.levels[usize::from(graph.nodes[k + 1].level)] - level;
            let length = low.distance(limit);
            if length <= 2.0 * tolerance {
                continue;
            }
            let mut bracket = Bracket::new(low_value - level, above);
            loop {
                let p = low + (limit - low) * bracket.guess();
                let value = task.field.eval(p) - level;
                if value.is_nan() || bracket.update(value, tolerance / length) {
                    positions[k] = low + (limit - low) * bracket.guess();
                    break;
                }
            }
        }
    }
}
