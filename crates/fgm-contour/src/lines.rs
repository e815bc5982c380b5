use fgm_core::Point2;

/// One line of [`Lines`]: a range of its points.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Line {
    pub(crate) level: u16,
    pub(crate) closed: bool,
    pub(crate) from: usize,
    pub(crate) to: usize,
}

/// Many open and closed lines in one store of points.
#[derive(Debug, Default)]
pub(crate) struct Lines {
    pub(crate) points: Vec<Point2>,
    pub(crate) list: Vec<Line>,
}

impl Lines {
    pub(crate) fn clear(&mut self) {
        self.points.clear();
        self.list.clear();
    }

    /// Adds a line.
    pub(crate) fn push(&mut self, points: &[Point2], closed: bool, level: u16) {
        self.points.extend_from_slice(points);
        self.finish(closed, level);
    }

    /// Ends a line whose points were pushed.
    pub(crate) fn finish(&mut self, closed: bool, level: u16) {
        let from = self.list.last().map_or(0, |l| l.to);
        self.list.push(Line { level, closed, from, to: self.points.len() });
    }

    /// The points of a line.
    pub(crate) fn points(&self, line: &Line) -> &[Point2] {
        &self.points[line.from..line.to]
    }
}
