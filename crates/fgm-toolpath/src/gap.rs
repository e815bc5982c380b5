//! Beads of varying width along the middle of what is too thin for loops.

mod chains;
mod flip;
mod mesh;
mod ribbon;

use fgm_core::{Point2, Polygon, Role, bead};

use crate::{ClipperInset, Inset, Path, inset::simplify};
use chains::Chain;

/// What is shaved off a gap's border before it is triangulated, mm.
const HAIR: f64 = 2e-3;
/// How far a middle line may be straightened, mm.
const STRAIGHTEN: f64 = 5e-3;
/// The share by which thickness may vary within one bead of constant width.
const STEP: f64 = 0.05;
/// How round what takes a single loop is: a disc is 1, a square 0.785, a rectangle twice as long as
/// wide 0.698.
const ROUND: f64 = 0.72;
/// How far a bead leads on into what is too thin for it, in line spacings.
const MOST_LENGTHENED: f64 = 3.0;

/// How gaps are filled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GapOptions {
    /// Width of an ordinary bead, mm.
    pub width: f64,
    /// Layer height, mm.
    pub height: f64,
    /// The narrowest bead the nozzle lays, mm; narrower gaps stay open.
    pub min_width: f64,
    /// The widest bead the nozzle lays, mm; wider gaps take two beads or more.
    pub max_width: f64,
    /// Whether two beads are laid wherever two fit, and not only where one does not: side by side
    /// they make a loop, which ends where it begins ([`route`](crate::route)). Beads then lead to
    /// the very end of a region, where another begins; else they stop half their width before it.
    pub loops: bool,
}

/// Beads along the middle of thin regions.
///
/// The volume of the beads is the region's, less its ends and what is narrower than `min_width`; a
/// region that tapers off is filled to where it is half as wide as that, which makes up for the tip.
/// A stretch thicker than `max_width` takes several beads side by side. Paths are open or closed,
/// of [`Role::GapFill`], and each of one width; where the thickness changes a new path begins at
/// the end of the last.
///
/// The middle is that of a constrained Delaunay triangulation: the midpoints of the edges that
/// cross the region, an approximation of the medial axis that is exact between parallel sides.
/// Meant for regions up to about three beads thick; thicker ones are filled, but not well.
pub fn gap_fill(region: &[Polygon], options: &GapOptions) -> Vec<Path> {
    fill_thin(&shaved(region, &ClipperInset::default()), options, HAIR)
}

/// A hair less: rings that touch come apart, spikes of no width vanish.
pub(crate) fn shaved(region: &[Polygon], inset: &dyn Inset) -> Vec<Polygon> {
    inset.inset(region, HAIR)
}

/// [`gap_fill`] of simple polygons, `hair` having been shaved off them.
pub(crate) fn fill_thin(region: &[Polygon], options: &GapOptions, hair: f64) -> Vec<Path> {
    let fill = Fill::new(options, hair);
    let mut out = Vec::new();
    for polygon in region {
        let before = out.len();
        if fill.is_spot(polygon) {
            fill.pin(polygon, &mut out);
        }
        if out.len() > before {
            continue;
        }
        let mesh = mesh::Mesh::new(polygon, fill.longest_edge(), 8.0 * fill.spacing);
        if (mesh.area() - polygon.area()).abs() > 1e-3 * polygon.area() {
            // The border touches itself.
            if hair == 0.0 {
                let polygon = shaved(std::slice::from_ref(polygon), &ClipperInset::default());
                out.extend(fill_thin(&polygon, options, HAIR));
            }
            continue;
        }
        for chain in chains::chains(mesh, options.loops) {
            fill.chain(&chain, &mut out);
        }
        if out.len() == before {
            fill.pin(polygon, &mut out);
        }
    }
    out
}

struct Fill {
    /// Distance between ordinary lines.
    spacing: f64,
    /// What a bead's width has over the spacing it fills.
    round: f64,
    least: f64,
    most: f64,
    loops: bool,
    hair: f64,
}

impl Fill {
    fn new(options: &GapOptions, hair: f64) -> Self {
        let spacing = bead::spacing(options.width, options.height);
        let round = options.width - spacing;
        let least = bead::spacing(options.min_width, options.height);
        let most = bead::spacing(options.max_width, options.height).max(least);
        Self { spacing, round, least, most, loops: options.loops, hair }
    }

    /// No border edge may be longer, mm: the triangles would not follow the sides. The ends of what
    /// takes no loop stay whole: cut up, they would look like corners that the middle leads into.
    fn longest_edge(&self) -> f64 {
        if self.loops { 2.1 * self.most } else { 2.7 * self.spacing }
    }

    /// How many beads fill a thickness; 0 where it is too thin for one.
    fn beads(&self, thickness: f64) -> usize {
        if thickness < self.least {
            return 0;
        }
        let one = self.most.min(if self.loops { 2.0 * self.least } else { 1.6 * self.spacing });
        if thickness <= one {
            return 1;
        }
        if self.loops {
            // Pairs, as few as there may be.
            return 2 * ((thickness / (2.0 * self.most)).ceil() as usize).clamp(1, 32);
        }
        ((thickness / self.spacing - 0.1).round() as usize).clamp(2, 64)
    }

    /// Whether loops are asked for and one alone fills a polygon, as thick one way as the other.
    fn is_spot(&self, polygon: &Polygon) -> bool {
        let (area, around) = (polygon.area(), polygon.outer.length());
        let round = 4.0 * std::f64::consts::PI * area / (around * around);
        self.loops && polygon.holes.is_empty() && round > ROUND && area / around <= 0.5 * self.most
    }

    /// A small loop for what has no middle line: as deep inside as its bead is half wide.
    fn pin(&self, polygon: &Polygon, out: &mut Vec<Path>) {
        let area = polygon.area();
        // Half the radius, for a disc.
        let deep = (area / polygon.outer.length()).clamp(0.5 * self.least, 0.5 * self.most);
        let polygon = std::slice::from_ref(polygon);
        let inner = ClipperInset::default().inset(polygon, deep);
        for ring in inner.into_iter().map(|p| p.outer) {
            let fills = (area / ring.length()).clamp(self.least, self.most);
            out.push(Path {
                points: ring.points,
                closed: true,
                role: Role::GapFill,
                width: fills + self.round,
                turn: 0,
                turns: Vec::new(),
            });
        }
    }

    fn chain(&self, chain: &Chain, out: &mut Vec<Path>) {
        if chain.gates.len() < 2 || chain.length() < 0.5 * self.spacing {
            return;
        }
        let mut thickness = chain.smooth_thickness(2.0 * self.spacing);
        thickness.iter_mut().for_each(|t| *t += 2.0 * self.hair);
        let (mut points, mut widths) = (Vec::new(), Vec::new());
        for (from, to, beads) in self.runs(chain, &thickness) {
            if beads == 0 || from == to {
                continue;
            }
            let whole = chain.closed && from == 0 && to == thickness.len();
            widths.clear();
            let width = |t: &f64| (t / beads as f64).max(self.least);
            widths.extend(thickness[from..to].iter().map(width));
            for bead in 0..beads {
                let share = (2 * bead + 1) as f64 / (2 * beads) as f64;
                points.clear();
                points.extend(chain.line(share, from, to));
                self.split(&points, &widths, whole, out);
            }
        }
    }

    /// Stretches of a chain with one number of beads. Short ones join the one before, so that
    /// beads do not begin and end all the time.
    fn runs(&self, chain: &Chain, thickness: &[f64]) -> Vec<(usize, usize, usize)> {
        let mut runs: Vec<(usize, usize, usize)> = Vec::new();
        for (i, &t) in thickness.iter().enumerate() {
            let beads = self.beads(t);
            match runs.last_mut() {
                Some(run) if run.2 == beads => run.1 = i + 1,
                _ => runs.push((i, i + 1, beads)),
            }
        }
        let mut out: Vec<(usize, usize, usize)> = Vec::new();
        for run in runs {
            let length: f64 = (run.0..run.1).map(|i| chain.step(i)).sum();
            let fit = |beads: usize| {
                let each = |t: &f64| t / beads as f64;
                let fits = |w: f64| w >= self.least && w <= self.most;
                length < 3.0 * self.spacing
                    && beads > 0
                    && thickness[run.0..run.1].iter().map(each).all(fits)
            };
            match out.last_mut() {
                Some(last) if last.2 == run.2 || fit(last.2) => last.1 = run.1,
                _ => out.push(run),
            }
        }
        self.lengthen(chain, thickness, &mut out);
        out
    }

    /// Leads beads on into what is too thin for one, as far as it is half as thick as the thinnest and
    /// no more than its volume: where a region ends in a point they then have all of it.
    fn lengthen(&self, chain: &Chain, thickness: &[f64], runs: &mut [(usize, usize, usize)]) {
        let (half, most) = (0.5 * self.least, MOST_LENGTHENED * self.spacing);
        for i in 1..runs.len() {
            let [before, after] = &mut runs[i - 1..=i] else { continue };
            let thin = if before.2 == 0 { before.0..before.1 } else { after.0..after.1 };
            let area: f64 = thin.map(|step| thickness[step] * chain.step(step)).sum();
            let most = most.min(area / self.least);
            let mut length = 0.0;
            let mut leads_on = |step: usize| {
                length += chain.step(step);
                thickness[step] >= half && length <= most
            };
            match (before.2, after.2) {
                (1, 0) => {
                    let on = (after.0..after.1).take_while(|&step| leads_on(step)).count();
                    before.1 += on;
                    after.0 += on;
                }
                (0, 1) => {
                    let on = (before.0..before.1).rev().take_while(|&step| leads_on(step)).count();
                    before.1 -= on;
                    after.0 -= on;
                }
                _ => {}
            }
        }
    }

    /// Cuts a line where its width has changed; writes the parts.
    fn split(&self, points: &[Point2], widths: &[f64], closed: bool, out: &mut Vec<Path>) {
        let mut start = 0;
        while start < widths.len() {
            let (mut low, mut high) = (widths[start], widths[start]);
            let mut end = start + 1;
            while let Some(&w) = widths.get(end) {
                (low, high) = (low.min(w), high.max(w));
                if high > low * (1.0 + STEP) {
                    break;
                }
                end += 1;
            }
            let closed = closed && start == 0 && end == widths.len();
            self.push(&points[start..=end], &widths[start..end], closed, out);
            start = end;
        }
    }

    fn push(&self, points: &[Point2], widths: &[f64], closed: bool, out: &mut Vec<Path>) {
        let steps = || points.windows(2).map(|w| w[0].distance(w[1]));
        let area: f64 = steps().zip(widths).map(|(l, w)| l * w).sum();
        let length: f64 = steps().sum();
        if length < 1e-3 {
            return;
        }
        let fills = area / length;
        if fills < self.least {
            return;
        }
        let mut line = Vec::with_capacity(points.len());
        simplify::line(points, false, STRAIGHTEN, &mut line);
        if closed && line.len() > 3 {
            line.pop();
        }
        let width = fills + self.round;
        let closed = closed && line.len() > 2;
        let turns = Vec::new();
        out.push(Path { points: line, closed, role: Role::GapFill, width, turn: 0, turns });
    }
}

#[cfg(test)]
#[path = "gap_tests.rs"]
mod tests;
