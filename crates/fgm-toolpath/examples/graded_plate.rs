//! Plans one layer of a plate that changes from one colour to another along x, both ways.
//!
//! `cargo run -p fgm-toolpath --example graded_plate`

#![allow(clippy::print_stdout, reason = "an example shows its results")]

use fgm_core::{Band, ColorId, Point2, Polygon, Ring, Sectioner, Span, bead};
use fgm_toolpath::{
    AgainstOptions, ClipperInset, InfillOptions, Inset, LayerPlan, Path, SectionOptions,
    ToolpathError, WallOptions, against, infill, order, region, section, walls,
};

const LENGTH: f64 = 60.0;
const COLORS: u16 = 8;
const WIDTH: f64 = 0.4;
const HEIGHT: f64 = 0.2;

/// Colour by colour along x, in stripes of equal width.
struct Stripes;

impl Sectioner<Band> for Stripes {
    fn section(&self, path: &[Point2], spans: &mut Vec<Span<Band>>) {
        spans.clear();
        let stripe = LENGTH / f64::from(COLORS);
        let label =
            |x: f64| Band::pure(ColorId((x / stripe).clamp(0.0, f64::from(COLORS - 1)) as u16));
        for (i, pair) in path.windows(2).enumerate() {
            let (a, b) = (pair[0].x, pair[1].x);
            let mut cuts: Vec<f64> = (1..COLORS)
                .map(|k| (f64::from(k) * stripe - a) / (b - a))
                .filter(|t| *t > 0.0 && *t < 1.0)
                .collect();
            cuts.sort_by(f64::total_cmp);
            let mut from = 0.0;
            for to in cuts.into_iter().chain([1.0]) {
                let label = label(a + (b - a) * 0.5 * (from + to));
                let (start, end) = (i as f64 + from, i as f64 + to);
                match spans.last_mut() {
                    Some(last) if last.label == label => last.to = end,
                    _ => spans.push(Span { from: start, to: end, label }),
                }
                from = to;
            }
        }
    }
}

fn rectangle(from: f64, to: f64, height: f64) -> Polygon {
    let corners = [(from, 0.0), (to, 0.0), (to, height), (from, height)];
    Polygon::simple(Ring::new(corners.map(|(x, y)| Point2::new(x, y)).into()))
}

fn report(name: &str, plan: &LayerPlan, part: &[Polygon]) {
    let stats = plan.stats();
    let volume = stats.volume_of(|_| true) / (region::area(part) * HEIGHT);
    println!(
        "{name}: {} pieces, {:.0} mm of beads, {:.0} mm of travel, {:.2} % of the volume",
        stats.pieces,
        stats.extruded,
        stats.travel,
        100.0 * volume
    );
}

fn main() -> Result<(), ToolpathError> {
    let inset = ClipperInset::default();
    let part = [rectangle(0.0, LENGTH, 25.0)];
    let colors: Vec<ColorId> = (0..COLORS).map(ColorId).collect();

    // Strategy 1: the lines of an ordinary part, cut by colour.
    let shell = walls(&part, &WallOptions::new(3, WIDTH, HEIGHT), &inset);
    let mut paths: Vec<Path> = shell.paths;
    paths.extend(infill(&shell.inside, &InfillOptions::new(WIDTH, HEIGHT), &inset));
    let mut pieces = Vec::new();
    section(&paths, &Stripes, &SectionOptions::default(), &mut pieces);
    let pieces = order(pieces, &colors, Point2::ZERO);
    report("sectioned", &LayerPlan::new(0, HEIGHT, HEIGHT, pieces)?, &part);

    // Strategy 2: every stripe filled by itself. The outline is shrunk first by what a bead's
    // round side reaches beyond its volume.
    let round = 0.5 * (WIDTH - bead::spacing(WIDTH, HEIGHT));
    let body = inset.inset(&part, round);
    let mut pieces = Vec::new();
    for &color in &colors {
        let stripe = LENGTH / f64::from(COLORS);
        let from = f64::from(color.0) * stripe;
        let face = region::intersection(&body, &[rectangle(from, from + stripe, 25.0)]);
        let paths = against(&face, &AgainstOptions::new(WIDTH, HEIGHT), &inset);
        pieces.extend(paths.into_iter().map(|path| path.in_color(color)));
    }
    let pieces = order(pieces, &colors, Point2::ZERO);
    report("against the gradient", &LayerPlan::new(0, HEIGHT, HEIGHT, pieces)?, &part);
    Ok(())
}
