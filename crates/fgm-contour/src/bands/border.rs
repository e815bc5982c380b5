use fgm_core::Point2;
use std::ops::Range;

/// Where a line begins or ends on the border.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Event {
    pub(crate) line: u32,
    pub(crate) level: u16,
    /// Whether the line begins here; otherwise it ends.
    pub(crate) starts: bool,
    /// The number of the border's edge that it lies on, from the loop's beginning.
    pub(crate) edge: u32,
    /// The first of [`Border::corners`] after it. Set by [`Border::event`].
    pub(crate) corner: u32,
}

impl Event {
    /// The class of the border after this point. The line goes inwards with low values on its
    /// left where it begins, which is where the border comes from.
    pub(crate) fn class_after(&self) -> u16 {
        self.level + u16::from(self.starts)
    }

    fn class_before(&self) -> u16 {
        self.level + u16::from(!self.starts)
    }
}

/// A closed stretch of border.
#[derive(Clone, Debug)]
pub(crate) struct Loop {
    pub(crate) events: Range<usize>,
    pub(crate) corners: Range<usize>,
    /// The class at its beginning.
    pub(crate) class: u16,
}

/// The border of what is contoured, the inside on its left, with the ends of lines on it.
#[derive(Clone, Debug, Default)]
pub(crate) struct Border {
    pub(crate) events: Vec<Event>,
    pub(crate) corners: Vec<Point2>,
    pub(crate) loops: Vec<Loop>,
}

impl Border {
    /// Goes on to a corner.
    pub(crate) fn corner(&mut self, at: Point2) {
        self.corners.push(at);
    }

    /// Goes on to the end of a line.
    pub(crate) fn event(&mut self, event: Event) {
        self.events.push(Event { corner: self.corners.len() as u32, ..event });
    }

    /// Ends a loop, whose class at its beginning is given for the case that it has no events.
    pub(crate) fn close(&mut self, class: u16) {
        let (events, corners) = self.loops.last().map_or((0, 0), |l| (l.events.end, l.corners.end));
        let class = self.events.get(events).map_or(class, Event::class_before);
        let (events, corners) = (events..self.events.len(), corners..self.corners.len());
        self.loops.push(Loop { events, corners, class });
    }

    /// The same border with the ends of one level's lines only.
    pub(crate) fn of_level(&self, level: u16) -> Self {
        let mut events = Vec::new();
        let loops = self.loops.iter().map(|l| {
            let from = events.len();
            events.extend(self.events[l.events.clone()].iter().filter(|e| e.level == level));
            Loop { events: from..events.len(), ..l.clone() }
        });
        let loops = loops.collect();
        Self { events, corners: self.corners.clone(), loops }
    }

    /// The event that follows on the same loop.
    pub(crate) fn after(&self, event: usize, of: &Loop) -> usize {
        if event + 1 == of.events.end { of.events.start } else { event + 1 }
    }

    /// The corners between an event and the one that follows it.
    pub(crate) fn corners_after(
        &self,
        event: usize,
        of: &Loop,
    ) -> impl Iterator<Item = Point2> + '_ {
        let next = self.after(event, of);
        let (from, to) = (self.events[event].corner as usize, self.events[next].corner as usize);
        let (first, second) = if next > event {
            (from..to, 0..0)
        } else {
            (from..of.corners.end, of.corners.start..to)
        };
        self.corners[first].iter().chain(&self.corners[second]).copied()
    }
}
