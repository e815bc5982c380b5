use fgm_core::{PlanarField, Point2};

use crate::root::Bracket;

/// Where a line crosses a level of a field.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing {
    /// Where along the line: the index of a segment, and the share of that segment behind it.
    pub at: f64,
    /// The index of the level.
    pub level: usize,
}

/// Finds where lines cross levels of a field, without tracing the levels' contours.
///
/// The field is sampled along the line, at vertices and at most `step` mm apart between them. A
/// crossing lies between two samples on different sides of a level, and is found there to
/// `tolerance` mm by root finding; at a jump, it is at the jump. A line that passes a level twice
/// between two samples is not seen to: features smaller than a step may be lost, as with a grid's
/// cells. Samples that are no number count for neither side.
///
/// The scratch memory is kept from line to line, and many searches share each evaluation.
///
/// ```
/// use fgm_contour::Crossings;
/// use fgm_core::Point2;
///
/// let field = |p: Point2| p.length();
/// let line = [Point2::new(-3.0, 0.0), Point2::new(5.0, 0.0)];
/// let mut found = Vec::new();
/// Crossings::new(0.5, 1e-9).find(&field, &line, &[1.0, 4.0], &mut found);
/// let at: Vec<f64> = found.iter().map(|c| -3.0 + 8.0 * c.at).collect();
/// assert!(at.iter().zip([-1.0, 1.0, 4.0]).all(|(a, b)| (a - b).abs() < 1e-9));
/// assert_eq!(found.iter().map(|c| c.level).collect::<Vec<_>>(), [0, 0, 1]);
/// ```
#[derive(Clone, Debug)]
pub struct Crossings {
    step: f64,
    tolerance: f64,
    /// Samples: where along the line, in the plane, and the field there.
    places: Vec<f64>,
    points: Vec<Point2>,
    values: Vec<f64>,
    searches: Vec<Search>,
}

/// A search between two samples on one segment.
#[derive(Clone, Copy, Debug)]
struct Search {
    bracket: Bracket,
    from: f64,
    to: f64,
    level: usize,
    /// The segment's length, mm.
    length: f64,
}

impl Crossings {
    /// Samples at most `step` mm apart, crossings to `tolerance` mm.
    pub fn new(step: f64, tolerance: f64) -> Self {
        let (places, points, values, searches) = Default::default();
        Self { step, tolerance, places, points, values, searches }
    }

    /// Replaces `out` by the crossings of a line with the levels, which are to rise; in order
    /// along the line.
    pub fn find(
        &mut self,
        field: &dyn PlanarField,
        line: &[Point2],
        levels: &[f64],
        out: &mut Vec<Crossing>,
    ) {
        out.clear();
        self.sample(field, line);
        self.bracket(line, levels);
        while !self.searches.is_empty() {
            self.advance(field, line, levels, out);
        }
        out.sort_by(|a, b| a.at.total_cmp(&b.at));
    }

    fn sample(&mut self, field: &dyn PlanarField, line: &[Point2]) {
        self.places.clear();
        self.points.clear();
        for (segment, ends) in line.windows(2).enumerate() {
            let (a, b) = (ends[0], ends[1]);
            // At most a million samples a segment, whatever the step.
            let parts = (a.distance(b) / self.step).ceil().clamp(1.0, 1e6) as usize;
            for part in 0..parts {
                let share = part as f64 / parts as f64;
                self.places.push(segment as f64 + share);
                self.points.push(a + (b - a) * share);
            }
        }
        if let (Some(&last), 2..) = (line.last(), line.len()) {
            self.places.push((line.len() - 1) as f64);
            self.points.push(last);
        }
        self.values.clear();
        self.values.resize(self.points.len(), 0.0);
        field.eval_into(&self.points, &mut self.values);
    }

    /// A search for every level between two samples.
    fn bracket(&mut self, line: &[Point2], levels: &[f64]) {
        self.searches.clear();
        let below = |value: f64| levels.partition_point(|&level| level <= value);
        let mut last = self.values.first().map_or(0, |&v| below(v));
        for i in 1..self.values.len() {
            let (before, value) = (self.values[i - 1], self.values[i]);
            // Most samples lie between the same two levels as the one before.
            let same = last.checked_sub(1).is_none_or(|l| levels[l] <= value)
                && levels.get(last).is_none_or(|&l| value < l);
            if same && !value.is_nan() {
                continue;
            }
            let now = below(value);
            if !before.is_nan() && !value.is_nan() {
                let segment = self.places[i - 1] as usize;
                let length = line[segment].distance(line[segment + 1]);
                let passed = last.min(now)..last.max(now);
                for (level, at) in passed.clone().zip(&levels[passed]) {
                    let bracket = Bracket::new(before - at, value - at);
                    let (from, to) = (self.places[i - 1], self.places[i]);
                    self.searches.push(Search { bracket, from, to, level, length });
                }
            }
            last = now;
        }
    }

    /// One step of every search; those that have ended go to `out`.
    fn advance(
        &mut self,
        field: &dyn PlanarField,
        line: &[Point2],
        levels: &[f64],
        out: &mut Vec<Crossing>,
    ) {
        let point = |search: &Search| {
            let segment = search.from as usize;
            let (a, b) = (line[segment], line[segment + 1]);
            a + (b - a) * (search.place() - segment as f64)
        };
        self.points.clear();
        self.points.extend(self.searches.iter().map(point));
        self.values.clear();
        self.values.resize(self.points.len(), 0.0);
        field.eval_into(&self.points, &mut self.values);
        let mut values = self.values.iter();
        let tolerance = self.tolerance;
        self.searches.retain_mut(|search| {
            let Some(value) = values.next() else { return false };
            let reach = search.length * (search.to - search.from);
            let found = value.is_nan()
                || search.bracket.update(value - levels[search.level], tolerance / reach);
            if found {
                out.push(Crossing { at: search.place(), level: search.level });
            }
            !found
        });
    }
}

impl Search {
    fn place(&self) -> f64 {
        self.from + (self.to - self.from) * self.bracket.guess()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn places(field: impl Fn(Point2) -> f64 + Sync, line: &[Point2], levels: &[f64]) -> Vec<f64> {
        let mut found = vec![Crossing { at: 9.0, level: 9 }];
        Crossings::new(0.5, 1e-9).find(&field, line, levels, &mut found);
        found.iter().map(|c| c.at).collect()
    }

    #[test]
    fn jumps_plateaus_and_what_is_no_number() {
        let line = [Point2::ZERO, Point2::new(10.0, 0.0), Point2::new(10.0, 10.0)];
        let jump = |p: Point2| if p.x < 2.345 { 0.0 } else { 1.0 };
        let found = places(jump, &line, &[0.25, 0.5, 0.75]);
        assert_eq!(found.len(), 3);
        assert!(found.iter().all(|at| (at - 0.2345).abs() < 1e-9), "{found:?}");
        assert_eq!(places(|_| 0.5, &line, &[0.5]), []);
        // From the plateau on the level down: where it is left.
        let ramp = |p: Point2| 5.0_f64.min(10.0 - p.x);
        let found = places(ramp, &line, &[5.0]);
        assert!(found.len() == 1 && (found[0] - 0.5).abs() < 0.05, "{found:?}");
        let gap = |p: Point2| if p.x > 4.0 && p.x < 6.0 { f64::NAN } else { p.x };
        assert_eq!(places(gap, &line, &[5.0]), []);
        assert!(places(gap, &line, &[3.0]).iter().all(|at| (at - 0.3).abs() < 1e-9));
        assert_eq!(places(|p| p.x, &line[..1], &[3.0]), []);
        assert_eq!(places(|p| p.x, &[], &[3.0]), []);
    }

    proptest! {
        #[test]
        fn levels_lie_between_the_sides_of_every_crossing(
            points in prop::collection::vec((-9.0..9.0f64, -9.0..9.0f64), 2..12),
            (a, b, c) in (-1.0..1.0f64, -1.0..1.0f64, 0.0..1.0f64),
            mut levels in prop::collection::vec(-6.0..6.0f64, 1..8),
        ) {
            levels.sort_by(f64::total_cmp);
            let line: Vec<Point2> = points.iter().map(|&(x, y)| Point2::new(x, y)).collect();
            let field = move |p: Point2| a * p.x + b * p.y + c * (0.5 * p.x).sin();
            let mut found = Vec::new();
            Crossings::new(0.25, 1e-9).find(&field, &line, &levels, &mut found);
            let value = |at: f64| field(fgm_core::point_at(&line, at));
            for crossing in &found {
                prop_assert!((value(crossing.at) - levels[crossing.level]).abs() < 1e-6);
            }
            prop_assert!(found.is_sorted_by_key(|c| c.at));
            // Passing them one by one leads from the first vertex's levels to the last one's.
            for (index, level) in levels.iter().enumerate() {
                let count = found.iter().filter(|c| c.level == index).count();
                let (first, last) = (value(0.0) >= *level, value(points.len() as f64) >= *level);
                prop_assert_eq!(count % 2 == 1, first != last);
            }
        }
    }
}
