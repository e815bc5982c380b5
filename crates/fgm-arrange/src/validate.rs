use crate::predicate::{by_angle, in_box, orient};
use crate::topology::{Index, NONE, Topology};
use crate::{Arrangement, EdgeId, FaceId, Invalid, Location, VertexId};
use fgm_core::{Point2, Polygon};
use std::cmp::Ordering;

/// Relative error allowed in sums of areas.
const AREA: f64 = 1e-9;

/// How many units in the last place of its coordinates a face must be thick for a point inside it
/// to be asked for.
const THICK: f64 = 64.0;

impl<L> Arrangement<L> {
    /// Checks every invariant, from the coordinates up: edges meet at common ends only; half-edges
    /// are in order around vertices; each lies in one cycle of one face; Euler's formula; areas of
    /// faces and of their polygons; inside points.
    ///
    /// Costs more than arranging did. Meant for tests.
    ///
    /// # Errors
    /// The first invariant found broken, which is a defect of this crate.
    pub fn validate(&self) -> Result<(), Invalid> {
        let topology = &self.topology;
        self.edges_are_lines()?;
        self.edges_meet_at_ends()?;
        topology.rotations()?;
        topology.cycles()?;
        let [vertices, edges] = [topology.vertices.len(), topology.ends.len()];
        let (faces, components) = (topology.faces.len() + 1, topology.count_components());
        if vertices + faces != 1 + components + edges {
            return Err(Invalid::Euler { vertices, edges, faces, components });
        }
        self.areas()?;
        (0..topology.faces.len() as u32).try_for_each(|id| self.inside_points(FaceId(id)))
    }

    fn edges_are_lines(&self) -> Result<(), Invalid> {
        let topology = &self.topology;
        for (edge, ends) in topology.ends.iter().enumerate() {
            let line = topology.line(edge);
            let end = ends.map(|v| topology.vertices[v as usize]);
            let joined = line.first() == Some(&end[0]) && line.last() == Some(&end[1]);
            let whole = |p: &Point2| p.x.fract() == 0.0 && p.y.fract() == 0.0;
            if !joined || line.windows(2).any(|w| w[0] == w[1]) || !line.iter().all(whole) {
                return Err(Invalid::BrokenEdge { edge: EdgeId(edge as u32) });
            }
        }
        Ok(())
    }

    fn edges_meet_at_ends(&self) -> Result<(), Invalid> {
        let topology = &self.topology;
        let mut clash = None;
        // Pieces do not meet themselves.
        let Index { pieces, tree } = topology.index();
        tree.self_join(|a, b| {
            let (a, b) = (&pieces[a as usize], &pieces[b as usize]);
            for i in a.segments() {
                for j in b.segments() {
                    if clash.is_none() && topology.clash(a.owner, i, b.owner, j) {
                        clash = Some((a.owner, b.owner, topology.points[i]));
                    }
                }
            }
        });
        clash.map_or(Ok(()), |(a, b, p)| {
            let Point2 { x, y } = self.lattice.unscaled(p);
            Err(Invalid::EdgesMeet { a: EdgeId(a), b: EdgeId(b), x, y })
        })
    }

    fn areas(&self) -> Result<(), Invalid> {
        let mut faces = 0.0;
        for face in self.faces() {
            let (area, polygon) = (face.area(), face.polygon());
            let size = polygon.rings().map(|r| r.area().abs()).sum::<f64>();
            let simple = polygon.outer.area() > 0.0 || area < size * AREA || self.is_thin(&polygon);
            // Coordinates in mm are rounded: a sliver's polygon is as good as they allow.
            let blur = polygon.outer.length() * self.blur(&polygon);
            if !simple || (polygon.area() - area).abs() > size * AREA + blur {
                return Err(Invalid::Polygon { face: face.id(), area, polygon: polygon.area() });
            }
            faces += area;
        }
        let border = |half| {
            let mut ring = Vec::new();
            for h in self.topology.cycle(half) {
                let line = self.topology.line(h as usize / 2);
                if h & 1 == 0 { ring.extend(line) } else { ring.extend(line.iter().rev()) }
            }
            -twice_area(&ring)
        };
        let twice: i128 = self.topology.outlines.iter().map(|&half| border(half)).sum();
        let enclosed = self.lattice.area(twice as f64 * 0.5);
        if (faces - enclosed).abs() > AREA * enclosed {
            return Err(Invalid::Area { faces, enclosed });
        }
        Ok(())
    }

    fn inside_points(&self, id: FaceId) -> Result<(), Invalid> {
        let p = self.face(id).inside_point();
        let inside = self.locate(p) == Location::Face(id);
        if inside || self.is_thin(&self.face(id).polygon()) {
            return Ok(());
        }
        Err(Invalid::InsidePoint { face: id, x: p.x, y: p.y })
    }

    /// A unit in the last place of a region's coordinates.
    fn blur(&self, polygon: &Polygon) -> f64 {
        let bounds = polygon.bounds();
        bounds.min.abs().max(bounds.max.abs()).max_element() * f64::EPSILON
    }

    /// Whether a region may be too thin for any point in `f64` to lie inside.
    fn is_thin(&self, polygon: &Polygon) -> bool {
        let length: f64 = polygon.rings().map(fgm_core::Ring::length).sum();
        polygon.area() < length * THICK * self.blur(polygon)
    }
}

/// Twice the signed area of a ring in lattice steps; exact.
fn twice_area(ring: &[Point2]) -> i128 {
    let whole = |p: &Point2| (i128::from(p.x as i64), i128::from(p.y as i64));
    let next = ring.iter().map(whole).cycle().skip(1);
    ring.iter().map(whole).zip(next).map(|(a, b)| a.0 * b.1 - a.1 * b.0).sum()
}

impl Topology {
    /// Whether two segments share anything but a common end.
    fn clash(&self, edge: u32, i: usize, other: u32, j: usize) -> bool {
        let ([a, b], [c, d]) =
            ([self.points[i], self.points[i + 1]], [self.points[j], self.points[j + 1]]);
        let on = |a: Point2, b: Point2, p: Point2| {
            p != a && p != b && in_box(a, b, p) && orient(a, b, p) == 0.0
        };
        if on(a, b, c) || on(a, b, d) || on(c, d, a) || on(c, d, b) {
            return true;
        }
        for (k, p) in [(i, a), (i + 1, b)] {
            for (l, q) in [(j, c), (j + 1, d)] {
                if p == q
                    && !(k == l && edge == other)
                    && !(self.is_end(edge, k) && self.is_end(other, l))
                {
                    return true;
                }
            }
        }
        if (a == c && b == d) || (a == d && b == c) {
            return true;
        }
        let opposite = |a: f64, b: f64| (a > 0.0 && b < 0.0) || (a < 0.0 && b > 0.0);
        opposite(orient(a, b, c), orient(a, b, d)) && opposite(orient(c, d, a), orient(c, d, b))
    }

    /// Whether a point of an edge is an end of it.
    fn is_end(&self, edge: u32, point: usize) -> bool {
        let edge = edge as usize;
        point == self.edge_starts[edge] as usize || point + 1 == self.edge_starts[edge + 1] as usize
    }

    fn rotations(&self) -> Result<(), Invalid> {
        let mut seen = 0;
        for (vertex, range) in self.vertex_starts.windows(2).enumerate() {
            let around = &self.around[range[0] as usize..range[1] as usize];
            seen += around.len();
            let wrong = Invalid::Rotation { vertex: VertexId(vertex as u32) };
            let here = |&half: &u32| self.origin(half) == vertex as u32;
            let direction = |half: u32| {
                let line = self.line(half as usize / 2);
                let n = line.len();
                if half & 1 == 0 { line[1] - line[0] } else { line[n - 2] - line[n - 1] }
            };
            let rises = |w: &[u32]| by_angle(direction(w[0]), direction(w[1])) == Ordering::Less;
            if around.is_empty() || !around.iter().all(here) || !around.windows(2).all(rises) {
                return Err(wrong);
            }
        }
        if seen == self.next.len() { Ok(()) } else { Err(Invalid::Cycle { half_edge: NONE }) }
    }

    fn cycles(&self) -> Result<(), Invalid> {
        let mut entered = vec![false; self.next.len()];
        for (half, &next) in self.next.iter().enumerate() {
            let wrong = Err(Invalid::Cycle { half_edge: half as u32 });
            let Some(entered) = entered.get_mut(next as usize) else { return wrong };
            let joined = self.origin(next) == self.origin(half as u32 ^ 1);
            if *entered || !joined || self.face[half] != self.face[next as usize] {
                return wrong;
            }
            *entered = true;
        }
        // Every cycle is some face's border, and no two are the same.
        let mut borders = vec![false; self.next.len()];
        let mut mark = |first: u32, face: u32| {
            for half in self.cycle(first) {
                if borders[half as usize] || self.face[half as usize] != face {
                    return Err(Invalid::Cycle { half_edge: half });
                }
                borders[half as usize] = true;
            }
            Ok(())
        };
        for (id, face) in self.faces.iter().enumerate() {
            mark(face.outer, id as u32)?;
            for &half in &self.holes[face.holes_start as usize..face.holes_end as usize] {
                mark(half, id as u32)?;
            }
        }
        for &half in &self.outlines {
            mark(half, NONE)?;
        }
        let missed = borders.iter().position(|seen| !seen);
        missed.map_or(Ok(()), |half| Err(Invalid::Cycle { half_edge: half as u32 }))
    }

    /// Counted by flooding, as the builder counts cycles.
    fn count_components(&self) -> usize {
        let mut seen = vec![false; self.vertices.len()];
        let mut stack = Vec::new();
        let mut count = 0;
        for root in 0..self.vertices.len() {
            if seen[root] {
                continue;
            }
            count += 1;
            seen[root] = true;
            stack.push(root);
            while let Some(vertex) = stack.pop() {
                let range =
                    self.vertex_starts[vertex] as usize..self.vertex_starts[vertex + 1] as usize;
                for &half in &self.around[range] {
                    let to = self.origin(half ^ 1) as usize;
                    if !seen[to] {
                        seen[to] = true;
                        stack.push(to);
                    }
                }
            }
        }
        count
    }
}
