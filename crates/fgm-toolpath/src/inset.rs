//! Moving the border of a region by a distance: the seam, and its default behind `clipper2-rust`.

pub(crate) mod clipper;
pub(crate) mod grid;
mod local;
pub(crate) mod near;
pub(crate) mod simplify;

use fgm_core::Polygon;

/// Moves the border of a region.
///
/// One method is required. Swap it where another offsetter is wanted: everything in this crate
/// that needs parallel lines takes `&dyn Inset`.
pub trait Inset: Sync {
    /// The points of `region` that lie `distance` mm or more from its border; with a negative
    /// distance the region grown by as much.
    ///
    /// Corners stay sharp up to a mitre of twice the distance. The polygons of `region` are
    /// disjoint, as are those of the answer. A ring with a point that is not finite, or with no
    /// area, counts as absent.
    fn inset(&self, region: &[Polygon], distance: f64) -> Vec<Polygon>;

    /// Several insets of one polygon at once, where it is nowhere narrower than `2 * clear` and
    /// every inset up to `clear` keeps its shape (no ring splits, merges or vanishes); `None`
    /// where that is not so or not known.
    ///
    /// `distances` are positive and at most `clear`, or any that the caller knows to be so where
    /// `clear` is 0. The default knows nothing.
    fn nested(&self, polygon: &Polygon, clear: f64, distances: &[f64]) -> Option<Vec<Polygon>> {
        let _ = (polygon, clear, distances);
        None
    }
}

/// [`Inset`] by vertex bisectors where that is exact, else by the Clipper2 algorithm.
///
/// A border whose moved edges all keep their direction, and keep their distance from the whole
/// border, is taken as it is. That is most borders, at a fraction of the cost of a sweep.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClipperInset {
    /// How far a border may be moved by dropping vertices before it is offset, mm. Without this
    /// the number of vertices, and the cost, grow with every step.
    pub simplify: f64,
}

impl Default for ClipperInset {
    fn default() -> Self {
        Self { simplify: 1e-3 }
    }
}

impl Inset for ClipperInset {
    fn inset(&self, region: &[Polygon], distance: f64) -> Vec<Polygon> {
        if !distance.is_finite() {
            return Vec::new();
        }
        let region = simplify::region(region, self.simplify);
        if distance == 0.0 {
            return region;
        }
        if distance < 0.0 {
            return match local::offset(&region, distance) {
                Some(grown) => grown,
                None => clipper::offset(&region, -distance),
            };
        }
        // Inward the polygons do not meet, so each goes its own way.
        let mut out = Vec::with_capacity(region.len());
        let mut hard = Vec::new();
        for polygon in region {
            match local::offset(std::slice::from_ref(&polygon), distance) {
                Some(inner) => out.extend(inner),
                None => hard.push(polygon),
            }
        }
        if !hard.is_empty() {
            out.extend(clipper::offset(&hard, -distance));
        }
        out
    }

    fn nested(&self, polygon: &Polygon, clear: f64, distances: &[f64]) -> Option<Vec<Polygon>> {
        let polygon = simplify::polygon(polygon, self.simplify)?;
        let mut checked = None;
        if clear > 0.0 {
            checked = local::offset(std::slice::from_ref(&polygon), clear)?.pop();
        }
        let mut at = |distance: f64| match checked.take_if(|_| distance == clear) {
            Some(inner) => Some(inner),
            None => local::moved(&polygon, distance),
        };
        distances.iter().map(|&distance| at(distance)).collect()
    }
}

#[cfg(test)]
#[path = "inset_tests.rs"]
mod tests;
