//! Bridges: what lies over air between places that hold it.

mod span;

use fgm_core::Polygon;

use crate::{Inset, region, support::Support};
use span::Spans;

/// The share of a region that lines held at both ends must cover, else it is no bridge.
const LEAST_HELD: f64 = 0.5;

/// How bridges are found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BridgeOptions {
    /// Width of a bead, mm; nothing narrower is a bridge.
    pub width: f64,
    /// How far a bridge's lines reach on to what holds them, mm.
    pub anchor: f64,
    /// How far beyond the region something may lie that holds its lines, mm: the walls' thickness,
    /// since lines end at the walls and walls stand on what is below them.
    pub reach: f64,
}

/// A region over air, and the direction of its lines.
#[derive(Clone, Debug, PartialEq)]
pub struct Bridge {
    /// What is filled: over air, and on by the anchor.
    pub region: Vec<Polygon>,
    /// Direction of the lines, radians from +x.
    pub angle: f64,
}

/// The bridges in `here`, the inside of a layer's walls, over `below`, the outline of the layer
/// below, whose border is `support`. They are disjoint.
///
/// A part over air is a bridge where lines in some direction are held at both ends over at least
/// half of its area. Among the directions that hold nearly the most, the one with the shortest
/// spans is taken: straight across between two sides, along the shorter way over a hole.
pub fn bridges(
    here: &[Polygon],
    below: &[Polygon],
    support: &Support,
    options: &BridgeOptions,
    inset: &dyn Inset,
) -> Vec<Bridge> {
    if here.is_empty() || below.is_empty() || rests(here, below, support) {
        return Vec::new();
    }
    let half = 0.5 * options.width;
    let bare = region::difference(here, below);
    let core = inset.inset(&bare, half);
    if core.is_empty() {
        return Vec::new();
    }
    let open = region::intersection(&inset.inset(&core, -half), &bare);
    let mut found: Vec<Bridge> = Vec::new();
    for part in open {
        let spans = Spans::new(&part, support, options);
        let Some(angle) = spans.best(LEAST_HELD) else { continue };
        let grown = inset.inset(std::slice::from_ref(&part), -options.anchor);
        let mut region = region::intersection(&grown, here);
        for before in &found {
            region = region::difference(&region, &before.region);
        }
        found.push(Bridge { region, angle });
    }
    found
}

/// Whether all of `here` surely lies over `below`: nothing of their borders crosses, and no gap in
/// `below` lies in `here`.
fn rests(here: &[Polygon], below: &[Polygon], support: &Support) -> bool {
    let mut crossings = Vec::new();
    for ring in here.iter().flat_map(Polygon::rings) {
        let Some(&first) = ring.points.first() else { continue };
        if !support.contains(first) {
            return false;
        }
        for (a, b) in ring.edges() {
            support.crossings(a, b, &mut crossings);
            if !crossings.is_empty() {
                return false;
            }
        }
    }
    // The borders do not cross: one point tells of a whole ring.
    let inside = |ring: &fgm_core::Ring| {
        let first = ring.points.first();
        first.is_some_and(|&p| here.iter().any(|polygon| polygon.contains(p)))
    };
    !below.iter().flat_map(Polygon::rings).any(inside)
}

#[cfg(test)]
#[path = "bridge_tests.rs"]
mod tests;
