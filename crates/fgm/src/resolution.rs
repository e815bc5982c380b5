use fgm_contour::{simplify_line, simplify_ring};
use fgm_core::{Polyline, Ring};
use fgm_toolpath::Path;

/// Paths without the vertices that lie within `tolerance` of a line past them, mm.
///
/// Offsets keep every vertex of the border they come from and add their own; a printer neither
/// needs nor keeps up with them. Lines joined along a border are left as they are: their segments
/// have places of their own.
pub(crate) fn simplified(paths: Vec<Path>, tolerance: f64) -> Vec<Path> {
    if tolerance <= 0.0 {
        return paths;
    }
    let simplify = |path: Path| {
        if path.points.len() < 4 || !path.turns.is_empty() {
            return path;
        }
        let points = if path.closed {
            let ring = simplify_ring(&Ring::new(path.points.clone()), tolerance);
            // A loop no wider than the tolerance may have nothing left; it is printed as it is.
            if ring.points.len() < 3 { return path } else { ring.points }
        } else {
            simplify_line(&Polyline::new(path.points.clone()), tolerance).points
        };
        Path { points, ..path }
    };
    paths.into_iter().map(simplify).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use fgm_core::{Point2, Role};

    #[test]
    fn loops_and_lines_lose_what_is_straight_and_keep_their_length() {
        let points: Vec<Point2> =
            (0..400).map(|i| 20.0 * Point2::from_angle(f64::from(i) * 0.015)).collect();
        for closed in [false, true] {
            let path = Path {
                points: points.clone(),
                closed,
                role: Role::InnerWall,
                width: 0.4,
                turn: 0,
                turns: Vec::new(),
            };
            let [simple] = simplified(vec![path.clone()], 0.005).try_into().unwrap();
            assert!(simple.points.len() < 200, "{}", simple.points.len());
            assert!((simple.length() / path.length() - 1.0).abs() < 1e-3);
            assert!(simple.points.iter().all(|p| (p.length() - 20.0).abs() < 0.0051));
        }
    }
}
