use super::nodes::{Crossed, Node, Nodes};
use super::strands::Pair;
use super::sweep::Side;
use crate::bands::{Border, Event};
use crate::lines::Lines;
use crate::march::NAN_CLASS;
use fgm_core::Point2;

/// Directions of travel along the border, in quarter turns from east.
const EAST: u8 = 0;
const NORTH: u8 = 1;
const WEST: u8 = 2;
const SOUTH: u8 = 3;

/// An edge of the grid with a whole cell on its left and none on its right.
#[derive(Clone, Copy, Debug)]
struct Edge {
    /// The sample that it begins at.
    i: u32,
    j: u32,
    heading: u8,
    crossed: Crossed,
}

impl Edge {
    fn key(&self) -> (u32, u32) {
        (self.j, self.i)
    }

    fn end(&self) -> (u32, u32) {
        match self.heading {
            EAST => (self.j, self.i + 1),
            NORTH => (self.j + 1, self.i),
            WEST => (self.j, self.i - 1),
            _ => (self.j - 1, self.i),
        }
    }

    fn class(&self) -> u16 {
        self.crossed.classes[usize::from(self.heading >= WEST)]
    }

    /// Whether values rise in the direction of travel: then lines begin here.
    fn rises(&self) -> bool {
        let [a, b] = self.crossed.classes;
        (a < b) == (self.heading < WEST)
    }

    /// The crossings in the order of travel.
    fn nodes(&self) -> impl Iterator<Item = u32> + use<> {
        let Crossed { first, classes: [a, b] } = self.crossed;
        let count = u32::from(a.abs_diff(b));
        let back = self.heading >= WEST;
        (0..count).map(move |k| if back { first + count - 1 - k } else { first + k })
    }
}

fn has_holes(lower: &Side, upper: &Side) -> bool {
    lower.row.has_nan || upper.row.has_nan
}

/// The border of the data: the grid's, and around samples that are not numbers. Whole cells lie
/// on its left.
#[derive(Debug, Default)]
pub(crate) struct Edges {
    list: Vec<Edge>,
    /// Which cells of the row below and of this one are whole; all where `ragged` says no.
    below: Vec<bool>,
    here: Vec<bool>,
    ragged: bool,
    /// Whether any sample is not a number.
    pub(crate) has_holes: bool,
}

impl Edges {
    pub(crate) fn reset(&mut self, columns: usize) {
        self.list.clear();
        for cells in [&mut self.below, &mut self.here] {
            cells.clear();
            cells.resize(columns - 1, false);
        }
        self.ragged = true;
        self.has_holes = false;
    }

    /// Whether a cell of the row between two rows of samples, the next to be added, may have no
    /// whole cell below it.
    pub(crate) fn is_ragged(&self, lower: &Side, upper: &Side) -> bool {
        self.ragged || has_holes(lower, upper)
    }

    /// Adds the edges on the lower side of a row of cells and between its cells.
    pub(crate) fn row(&mut self, j: u32, lower: &Side, upper: &Side, upright: &[u32]) {
        let ragged = has_holes(lower, upper);
        let (low, high) = (&lower.row.classes, &upper.row.classes);
        let last = self.here.len();
        let side = |i: usize| Crossed { first: upright[i], classes: [low[i], high[i]] };
        if self.is_ragged(lower, upper) {
            self.has_holes |= ragged;
            let whole = |i: usize| [low[i], low[i + 1], high[i], high[i + 1]];
            for (i, here) in self.here.iter_mut().enumerate() {
                *here = !whole(i).contains(&NAN_CLASS);
            }
            self.level(j, lower);
            for i in 0..=last {
                let left = i > 0 && self.here[i - 1];
                let right = i < last && self.here[i];
                self.upright(j, i, (left, right), side(i));
            }
            std::mem::swap(&mut self.below, &mut self.here);
        } else {
            self.upright(j, 0, (false, true), side(0));
            self.upright(j, last, (true, false), side(last));
        }
        self.ragged = ragged;
        if !ragged {
            // Only read next to a row with holes.
            self.below.fill(true);
        }
    }

    /// Adds the upper side of the last row of cells.
    pub(crate) fn end(&mut self, j: u32, upper: &Side) {
        self.here.fill(false);
        self.level(j, upper);
    }

    fn upright(&mut self, j: u32, i: usize, whole: (bool, bool), crossed: Crossed) {
        let i = i as u32;
        match whole {
            (true, false) => self.list.push(Edge { i, j, heading: NORTH, crossed }),
            (false, true) => self.list.push(Edge { i, j: j + 1, heading: SOUTH, crossed }),
            _ => {}
        }
    }

    fn level(&mut self, j: u32, side: &Side) {
        for (i, (below, here)) in self.below.iter().zip(&self.here).enumerate() {
            let classes = [side.row.classes[i], side.row.classes[i + 1]];
            let crossed = Crossed { first: side.level_edges[i], classes };
            let i = i as u32;
            match (below, here) {
                (false, true) => self.list.push(Edge { i, j, heading: EAST, crossed }),
                (true, false) => self.list.push(Edge { i: i + 1, j, heading: WEST, crossed }),
                _ => {}
            }
        }
    }

    /// Joins the edges to loops, with the ends of the lines on them.
    pub(crate) fn border(
        &mut self,
        at: impl Fn(u32, u32) -> Point2,
        nodes: &Nodes,
        lines: &Lines,
    ) -> Border {
        self.list.sort_unstable_by_key(|e| (e.key(), e.heading));
        let mut border = Border::default();
        let mut done = vec![false; self.list.len()];
        let mut order = Vec::new();
        for first in 0..self.list.len() {
            if done[first] {
                continue;
            }
            order.clear();
            let mut at_edge = Some(first);
            while let Some(k) = at_edge.filter(|&k| !std::mem::replace(&mut done[k], true)) {
                order.push(k);
                at_edge = self.after(k);
            }
            self.walk(&order, &at, nodes, lines, &mut border);
        }
        border
    }

    /// Adds a loop.
    fn walk(
        &self,
        order: &[usize],
        at: &impl Fn(u32, u32) -> Point2,
        nodes: &Nodes,
        lines: &Lines,
        border: &mut Border,
    ) {
        let edges = || order.iter().map(|&k| &self.list[k]).enumerate();
        let mut before = order.last().map_or(EAST, |&k| self.list[k].heading);
        let mut widest = Widest::new(order.first().map_or(0, |&k| self.list[k].class()));
        for (number, edge) in edges() {
            let begin = at(edge.i, edge.j);
            if std::mem::replace(&mut before, edge.heading) != edge.heading {
                border.corner(begin);
            }
            for id in edge.nodes() {
                let Node { at: point, strand, .. } = nodes.list[id as usize];
                let Some(pair) = nodes.strands.pairs.get(strand as usize / 2) else { continue };
                let Pair { line, level, .. } = *pair;
                let starts = edge.rises();
                let event = Event { line, level, starts, edge: number as u32, corner: 0 };
                if lines.list.get(line as usize).is_some_and(|l| l.from < l.to) {
                    border.event(event);
                } else {
                    let (j, i) = edge.end();
                    let share = point.distance(begin) / at(i, j).distance(begin);
                    widest.pass(number as f64 + share, event.class_after());
                }
            }
        }
        border.close(widest.end(order.len() as f64));
    }

    /// The edge that follows: where four meet, the one to the left, which keeps to the same cell.
    fn after(&self, k: usize) -> Option<usize> {
        let edge = &self.list[k];
        let end = edge.end();
        let from = self.list.partition_point(|e| e.key() < end);
        let next = |k: &usize| self.list.get(*k).is_some_and(|e| e.key() == end);
        let left = (edge.heading + 1) % 4;
        let choices = || [from, from + 1].into_iter().filter(next);
        choices().find(|&k| self.list[k].heading == left).or_else(|| choices().next())
    }
}

/// The class along the widest stretch of a loop: around a sample that is at a level, a line too
/// small to be kept may have cut off the border.
struct Widest {
    class: u16,
    width: f64,
    begin: f64,
    /// The class that the loop begins and ends with, and how far it reaches at the beginning.
    first: (u16, Option<f64>),
    now: u16,
}

impl Widest {
    fn new(class: u16) -> Self {
        Self { class, width: 0.0, begin: 0.0, first: (class, None), now: class }
    }

    /// The class changes at a place along the loop.
    fn pass(&mut self, at: f64, class: u16) {
        let width = at - self.begin;
        if self.first.1.is_none() {
            self.first.1 = Some(width);
        } else if width > self.width {
            (self.class, self.width) = (self.now, width);
        }
        (self.begin, self.now) = (at, class);
    }

    fn end(self, length: f64) -> u16 {
        match self.first.1 {
            Some(width) if length - self.begin + width <= self.width => self.class,
            _ => self.first.0,
        }
    }
}
