//! A layer of four loops, cut into three colours by stripes, put in order with purge towers, and
//! told as motions.
#![allow(clippy::print_stdout)]

use fgm_core::{Band, Bounds2, ColorId, Motion, Point2, Role, Sectioner, Span};
use fgm_toolpath::{
    LayerPlan, Path, SectionOptions, ToolpathError, TowerOptions, Towers, order, section,
};

/// A colour for every 10 mm of x; 2 mm around each border two colours alternate.
struct Stripes;

impl Sectioner<Band> for Stripes {
    fn section(&self, path: &[Point2], spans: &mut Vec<Span<Band>>) {
        let edges = [9.0, 11.0, 19.0, 21.0];
        let mut cuts = vec![0.0, (path.len() - 1) as f64];
        for (w, i) in path.windows(2).zip(0_u32..) {
            let crossed = edges.iter().filter(|&&e| (w[0].x < e) != (w[1].x < e));
            cuts.extend(crossed.map(|e| f64::from(i) + (e - w[0].x) / (w[1].x - w[0].x)));
        }
        cuts.sort_by(f64::total_cmp);
        for w in cuts.windows(2).filter(|w| w[0] < w[1]) {
            let x = fgm_core::point_at(path, (w[0] + w[1]) * 0.5).x;
            let stripe = edges.iter().filter(|&&e| e < x).count() as u16;
            let label = Band::overlap(ColorId(stripe / 2), ColorId(stripe.div_ceil(2)));
            spans.push(Span { from: w[0], to: w[1], label });
        }
    }
}

fn main() -> Result<(), ToolpathError> {
    let wall = |turn: u32| {
        let (low, high) = (0.4 * f64::from(turn) + 0.2, 29.8 - 0.4 * f64::from(turn));
        let corners = [(low, low), (high, low), (high, high), (low, high)];
        Path {
            points: corners.map(|(x, y)| Point2::new(x, y)).into(),
            closed: true,
            role: if turn == 0 { Role::OuterWall } else { Role::InnerWall },
            width: 0.4,
            turn,
            turns: Vec::new(),
        }
    };
    let walls: Vec<_> = (0..4).map(wall).collect();
    let mut pieces = Vec::new();
    section(&walls, &Stripes, &SectionOptions::default(), &mut pieces);

    let part = Bounds2::new(Point2::ZERO, Point2::splat(30.0));
    let bed = Bounds2::new(Point2::splat(-60.0), Point2::splat(90.0));
    let colors = [0, 1, 2].map(ColorId);
    let volume = 68.6;
    let options = TowerOptions { volume: 3.0 * volume, ..TowerOptions::default() };
    let tower = Towers::place(&part, &bed, 1, &options)?;
    pieces.extend(tower.grow(0, &colors.map(|color| (volume, color)), colors[0], 0, 0.2));

    let plan = LayerPlan::new(0, 0.2, 0.2, order(pieces, &colors, Point2::ZERO))?;
    let stats = plan.stats();
    println!(
        "{} pieces, {} of them short; {} changes of colour; {:.1} mm of beads, {:.1} of travels",
        stats.pieces, stats.short_pieces, stats.color_changes, stats.extruded, stats.travel
    );
    println!(
        "{:.1} mm³ of part, {:.1} of towers at {:?}",
        stats.volume_of(Role::is_part),
        stats.volume_of(|role| role == Role::PurgeTower),
        tower.bounds()
    );
    let moves = plan.motions(None).filter(|m| matches!(m, Motion::Extrude { .. })).count();
    println!("{moves} straight beads");
    Ok(())
}
