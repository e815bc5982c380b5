use super::border::{Border, Loop};
use crate::lines::{Line, Lines};
use fgm_core::{Point2, Ring};

/// No ring.
pub(crate) const NONE: u32 = u32::MAX;

/// The borders of the regions between lines.
#[derive(Debug, Default)]
pub(crate) struct Rings {
    /// Class and ring, the region of that class on the left.
    pub(crate) list: Vec<(u16, Ring)>,
    /// By line: the ring that runs with it, and the one that runs against it.
    pub(crate) of_line: Vec<[u32; 2]>,
    /// By event of the border: the ring that the border after it belongs to.
    pub(crate) of_event: Vec<u32>,
    /// The ring that is all of the first loop, if that has no events.
    pub(crate) of_border: u32,
}

/// Of a line's two rings, the one below its level.
pub(crate) const WITH: usize = 0;
/// And the one above it.
pub(crate) const AGAINST: usize = 1;

/// Goes along lines and border from one to the other.
///
/// A line of level `l` is a border of the regions of class `l`, on its left, and `l + 1`: the
/// same points, in opposite order, so that neighbours share them to the last bit.
pub(crate) struct Assembler<'a> {
    pub(crate) lines: &'a Lines,
    pub(crate) border: &'a Border,
}

impl Assembler<'_> {
    /// The borders of the regions whose class is wanted. `lines` says which lines take part, all
    /// of whose ends are events.
    pub(crate) fn run(
        &self,
        lines: impl Fn(&Line) -> bool,
        wanted: impl Fn(u16) -> bool,
        rings: &mut Rings,
    ) {
        rings.list.clear();
        rings.of_border = NONE;
        rings.of_line.clear();
        rings.of_line.resize(self.lines.list.len(), [NONE; 2]);
        self.loops(&wanted, rings);
        for (k, line) in self.lines.list.iter().enumerate() {
            if !line.closed || line.from == line.to || !lines(line) {
                continue;
            }
            let points = self.lines.points(line);
            if wanted(line.level) {
                rings.of_line[k][WITH] = rings.list.len() as u32;
                rings.list.push((line.level, Ring::new(points.to_vec())));
            }
            if wanted(line.level + 1) {
                rings.of_line[k][AGAINST] = rings.list.len() as u32;
                let points = points.iter().rev().copied().collect();
                rings.list.push((line.level + 1, Ring::new(points)));
            }
        }
    }

    /// The rings that run along the border.
    fn loops(&self, wanted: &impl Fn(u16) -> bool, rings: &mut Rings) {
        let border = self.border;
        rings.of_event.clear();
        rings.of_event.resize(border.events.len(), NONE);
        // Of each line: the events at which it begins and ends.
        let mut ends = vec![[NONE; 2]; self.lines.list.len()];
        let mut loop_of = vec![0; border.events.len()];
        for (number, l) in border.loops.iter().enumerate() {
            for event in l.events.clone() {
                let Some(slot) = ends.get_mut(border.events[event].line as usize) else { continue };
                slot[usize::from(!border.events[event].starts)] = event as u32;
                loop_of[event] = number;
            }
        }
        let mut points = Vec::new();
        for (number, l) in border.loops.iter().enumerate() {
            if l.events.is_empty() && wanted(l.class) {
                if number == 0 {
                    rings.of_border = rings.list.len() as u32;
                }
                let ring = Ring::new(border.corners[l.corners.clone()].to_vec());
                rings.list.push((l.class, ring));
            }
            for first in l.events.clone() {
                let class = border.events[first].class_after();
                if rings.of_event[first] != NONE || !wanted(class) {
                    continue;
                }
                points.clear();
                let id = rings.list.len() as u32;
                let mut event = first;
                while rings.of_event.get(event) == Some(&NONE) {
                    rings.of_event[event] = id;
                    let l = &border.loops[loop_of[event]];
                    event = self.advance(event, l, &ends, rings, &mut points);
                }
                while points.len() > 1 && points.first() == points.last() {
                    points.pop();
                }
                rings.list.push((class, Ring::new(points.clone())));
            }
        }
    }

    /// Goes along the border to the next event and along its line to the other end.
    fn advance(
        &self,
        event: usize,
        l: &Loop,
        ends: &[[u32; 2]],
        rings: &mut Rings,
        points: &mut Vec<Point2>,
    ) -> usize {
        self.border.corners_after(event, l).for_each(|p| push(points, p));
        let id = rings.of_event[event];
        let next = self.border.events[self.border.after(event, l)];
        let number = next.line as usize;
        let line = self.lines.points(&self.lines.list[number]);
        if next.starts {
            rings.of_line[number][WITH] = id;
            line.iter().for_each(|&p| push(points, p));
            ends[number][AGAINST] as usize
        } else {
            rings.of_line[number][AGAINST] = id;
            line.iter().rev().for_each(|&p| push(points, p));
            ends[number][WITH] as usize
        }
    }
}

fn push(points: &mut Vec<Point2>, p: Point2) {
    if points.last() != Some(&p) {
        points.push(p);
    }
}
