use super::nodes::{NONE, Nodes};
use super::strands::{Pair, Strands};
use super::sweep::Sweep;
use crate::lines::Lines;
use fgm_core::Point2;

/// The lines through the crossings of a grid.
#[derive(Debug, Default)]
pub(crate) struct Traced {
    /// Open lines first. What has no extent stands here without points, so that strands know
    /// their lines by number.
    pub(crate) lines: Lines,
    /// The first crossing of each closed line in a row of samples: the leftmost in the lowest row
    /// that the line comes to.
    pub(crate) firsts: Vec<u32>,
    apart: f64,
    has_holes: bool,
}

impl Traced {
    /// Joins the strands to lines. Neighbours nearer than `apart` to each other become one; not in
    /// open lines where the data have holes, past a corner of which that could lead.
    ///
    /// `rows` tells where the crossings of each row of samples are. Those between it and the next
    /// stand after the next one's, though strands pass through them before.
    pub(crate) fn run(&mut self, sweep: &mut Sweep, apart: f64) {
        let Sweep { nodes, rows, edges, .. } = sweep;
        self.apart = apart;
        self.has_holes = edges.has_holes;
        self.lines.clear();
        self.firsts.clear();
        let Nodes { list, strands } = nodes;
        let end = list.len() as u32;
        let between = |j: usize| {
            let to = rows.get(j + 2).map_or(end, |next| next.0);
            (rows.get(j + 1).map_or(end, |next| next.1), to)
        };
        let ranges = rows.iter().enumerate().flat_map(|(j, &row)| [row, between(j)]);
        strands.gather(ranges.map(|(from, to)| &list[from as usize..to as usize]));
        for closed in [false, true] {
            for pair in 0..strands.pairs.len() as u32 {
                let fresh = strands.pairs[pair as usize].line == NONE;
                if fresh && (closed || strands.met(2 * pair + 1) == NONE) {
                    self.join(strands, pair, closed);
                }
            }
        }
    }

    /// Follows a line from pair to pair.
    fn join(&mut self, strands: &mut Strands, first: u32, closed: bool) {
        let limit = self.apart * self.apart;
        let near = if self.has_holes && !closed { f64::MIN_POSITIVE } else { limit };
        let number = self.lines.list.len() as u32;
        let points = &mut self.lines.points;
        let from = points.len();
        let mut at = first;
        let mut end = None;
        loop {
            strands.pairs[at as usize].line = number;
            let (back, ahead) = (strands.points(2 * at + 1), strands.points(2 * at));
            back.iter().rev().for_each(|&p| push(points, from, p, near));
            ahead.iter().for_each(|&p| push(points, from, p, near));
            end = ahead.last().or(back.first()).copied().or(end);
            let met = strands.met(2 * at);
            if met == NONE {
                break;
            }
            at = met / 2;
            if at == first {
                break;
            }
        }
        finish(points, from, end, closed, limit);
        let Pair { level, first, .. } = strands.pairs[first as usize];
        self.lines.finish(closed, level);
        self.firsts.push(first);
    }
}

fn push(points: &mut Vec<Point2>, from: usize, p: Point2, near: f64) {
    let repeats =
        points.len() > from && points.last().is_some_and(|last| last.distance_squared(p) < near);
    if !repeats {
        points.push(p);
    }
}

/// Merges a closed line's ends where they are near each other, keeps the end of an open line in
/// its place, and takes out what has no extent.
fn finish(points: &mut Vec<Point2>, from: usize, end: Option<Point2>, closed: bool, near: f64) {
    let begin = points[from];
    let is_near = |p: &Point2| p.distance_squared(begin) < near;
    if closed {
        while points.len() > from + 1 && points.last().is_some_and(is_near) {
            points.pop();
        }
    } else if points.len() > from + 1
        && let (Some(last), Some(end)) = (points.last_mut(), end)
    {
        *last = end;
    }
    if points.len() - from < 3 && (closed || points[from..].iter().all(is_near)) {
        points.truncate(from);
    }
}
