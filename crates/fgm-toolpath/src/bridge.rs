//! Bridges: what lies over air between places that hold it.

mod span;

use fgm_core::Polygon;

use crate::{Inset, region, support::Support};
use span::{Across, Spans};

/// The share of a region that lines held at both ends must cover, else it is no bridge.
const LEAST_HELD: f64 = 0.5;
/// Where no place is farther than a ledge's depth from what lies below, lines longer than this many
/// times that depth, or a lesser share of them held at both ends, make no bridge.
const LONG: f64 = 4.0;
const MOST_HELD: f64 = 0.9;
/// What is narrower than twice this, mm, is an offset's rounding.
const HAIR: f64 = 0.01;

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
    /// A region that is nowhere farther than this, mm, from what lies below it is a ledge, not a
    /// bridge, where its lines are much longer, so that it is held along its length, or some are not
    /// held at both ends. 0 where walls are laid around the region, since they are the ledges.
    pub ledge: f64,
    /// Lines that span less than this, mm, make no bridge: loops do not fall so soon. 0 where walls are
    /// laid around the region.
    pub shortest: f64,
    /// What a bridge would leave beside it that is narrower than this, mm, becomes part of it; 0
    /// where that is filled otherwise.
    pub least: f64,
}

/// A region over air, and the direction of its lines.
#[derive(Clone, Debug, PartialEq)]
pub struct Bridge {
    /// What is filled: over air, and on by the anchor.
    pub region: Vec<Polygon>,
    /// Direction of the lines, radians from +x.
    pub angle: f64,
}

/// The bridges in `here`, a layer's region or the inside of its walls, over `below`, the outline of the layer
/// below, whose border is `support`. They are disjoint.
///
/// A part over air is a bridge where lines in some direction are held at both ends over at least
/// half of its area. Among the directions that hold nearly the most, the one with the shortest
/// spans is taken: straight across between two sides, along the shorter way over a hole. What is
/// filled without walls around it is told from ledges by [`BridgeOptions::ledge`].
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
        let Some(across) = spans.best(LEAST_HELD) else { continue };
        if across.span < options.shortest {
            continue;
        }
        if options.ledge > 0.0 && is_ledge(&part, &across, below, options.ledge, inset) {
            continue;
        }
        let grown = inset.inset(std::slice::from_ref(&part), -options.anchor);
        let mut region = region::intersection(&grown, here);
        for before in &found {
            region = region::difference(&region, &before.region);
        }
        found.push(Bridge { region, angle: across.angle });
    }
    if options.least > 0.0 && !found.is_empty() {
        widen(&mut found, here, options.least, inset);
    }
    found
}

/// Whether a region is everywhere near what lies below, and its lines are not what holds it.
fn is_ledge(
    part: &Polygon,
    across: &Across,
    below: &[Polygon],
    ledge: f64,
    inset: &dyn Inset,
) -> bool {
    let near = || inset.inset(below, -ledge);
    (across.span > LONG * ledge || across.held < MOST_HELD)
        && region::difference(std::slice::from_ref(part), &near()).is_empty()
}

/// Gives each bridge what would be left of `here` beside it that is narrower than `least`.
fn widen(found: &mut [Bridge], here: &[Polygon], least: f64, inset: &dyn Inset) {
    let half = 0.5 * least;
    let rest = found.iter().fold(here.to_vec(), |rest, b| region::difference(&rest, &b.region));
    let wide = inset.inset(&inset.inset(&rest, half), -half);
    for narrow in inset.inset(&region::difference(&rest, &wide), HAIR) {
        // A little more, so that it meets what it is cut from.
        let grown = inset.inset(&[narrow], -2.0 * HAIR);
        let beside = found.iter_mut().find(|b| !region::intersection(&grown, &b.region).is_empty());
        if let Some(bridge) = beside {
            bridge.region = region::union(&bridge.region, &region::intersection(&grown, &rest));
        }
    }
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
