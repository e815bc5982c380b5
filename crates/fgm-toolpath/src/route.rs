//! One way through all the lines of a face.

mod bridge;
mod insert;
mod strand;
mod web;

use fgm_core::bead;

use crate::{Path, order::MEETS};
use strand::strands;
use web::Web;

/// Puts the lines of one face in a row that a nozzle follows with few travels, for beads `width`
/// wide in layers `height` high, mm.
///
/// Loops that run beside each other are cut open and joined by two short bridges, so that a nest of
/// loops becomes one line that ends where it begins: no travel, no seam at every loop, as with
/// connected Fermat spirals (Zhao et al., 2016), and of the same volume, since what is cut out is as
/// long as the bridges. Two beads side by side become a loop first. What cannot be joined so,
/// because it leads from one place to another, is put in where the detour is shortest.
///
/// The result is a round: after the last line comes the first, and it may be begun anywhere, at the
/// cost of the travel, if any, where it is closed. Lines that meet end to start need no travel
/// between them. [`Path::turns`] are dropped; single lines that are joined to none stay as they are.
/// Lines of one face are meant, which lie beside each other; others come out in any order, longest
/// first. The cost is that of sorting the lines' vertices.
pub fn route(mut paths: Vec<Path>, width: f64, height: f64) -> Vec<Path> {
    let spacing = bead::spacing(width, height);
    let good = |p: &Path| p.points.len() >= 2 && p.points.iter().all(|p| p.is_finite());
    if paths.len() < 2 || !(spacing > 0.0 && spacing.is_finite()) || !paths.iter().all(good) {
        return paths;
    }
    let mut web = Web::new(&strands(&mut paths, spacing), spacing);
    bridge::bridge(&mut web);
    insert::insert(&mut web);
    web.round(&paths)
}

#[cfg(test)]
#[path = "route_tests.rs"]
mod tests;
