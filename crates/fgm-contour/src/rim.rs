use crate::ContourError;
use crate::bands::{Border, Event};
use crate::graph::{Chains, Graph, Node};
use crate::lattice::Lattice;
use crate::lines::Lines;
use crate::march::{NAN_CLASS, class_of};
use crate::sweep::Task;
use fgm_core::{Bounds2, Point2};

/// The edge of a field's window with the ends of the lines on it. Open lines stand first among
/// both the chains and the lines, one for one.
///
/// Lines of several levels may end in one place, where the field jumps; their order is that of
/// the crossings on the lattice's edge, which is the order of the levels.
pub(crate) fn window_border(
    task: &Task<'_>,
    graph: &Graph,
    chains: &Chains,
    lines: &Lines,
) -> Result<Border, ContourError> {
    let rim = Rim { x: task.lattice.x.cells(), y: task.lattice.y.cells() };
    let mut ends = Vec::new();
    for (number, chain) in chains.list.iter().take_while(|c| !c.closed).enumerate() {
        let line = &lines.list[number];
        let places = [(chain.from, line.from), (chain.to - 1, line.to - 1)];
        for (k, (node, point)) in places.into_iter().enumerate() {
            let node = &graph.nodes[chains.nodes[node] as usize];
            let Some((edge, forwards)) = rim.edge(node) else {
                return Err(ContourError::FalseBounds { at: lines.points[point] });
            };
            let rises = (node.values[0] < node.values[1]) == forwards;
            let rank = if rises { chain.level } else { u16::MAX - chain.level };
            let (line, level) = (number as u32, chain.level);
            ends.push((rank, Event { line, level, starts: k == 0, edge, corner: 0 }));
        }
    }
    ends.sort_unstable_by_key(|(rank, event)| (event.edge, *rank));
    let mut border = Border::default();
    let mut ends = ends.into_iter().map(|e| e.1).peekable();
    for (corner, edge) in rim.corners(task.lattice) {
        while let Some(event) = ends.next_if(|e| e.edge < edge) {
            border.event(event);
        }
        border.corner(corner);
    }
    ends.for_each(|event| border.event(event));
    let class = if border.events.is_empty() { class_along(task)? } else { 0 };
    border.close(class);
    Ok(border)
}

/// The class of a window's edge that no line ends on: that of most of eight points of it, as a
/// point that is at a level has another where the line around it was too small to be kept.
fn class_along(task: &Task<'_>) -> Result<u16, ContourError> {
    let Bounds2 { min, max } = task.lattice.window();
    let middle = min.midpoint(max);
    let mut classes = Vec::with_capacity(9);
    for x in [min.x, middle.x, max.x] {
        for y in [min.y, middle.y, max.y] {
            let at = Point2::new(x, y);
            if at != middle {
                match class_of(task.field.eval(at), task.levels) {
                    NAN_CLASS => return Err(ContourError::NotANumber { at }),
                    class => classes.push(class),
                }
            }
        }
    }
    classes.sort_unstable();
    Ok(classes[classes.len() / 2 - 1])
}

/// The lattice's outer edges, numbered anticlockwise from the lower left corner.
struct Rim {
    x: u32,
    y: u32,
}

impl Rim {
    /// The number of the edge that a crossing lies on, and whether that runs to the right or up.
    fn edge(&self, node: &Node) -> Option<(u32, bool)> {
        match (node.vertical, node.i, node.j) {
            (false, i, 0) => Some((i, true)),
            (true, i, j) if i == self.x => Some((self.x + j, true)),
            (false, i, j) if j == self.y => Some((2 * self.x + self.y - 1 - i, false)),
            (true, 0, j) => Some((2 * (self.x + self.y) - 1 - j, false)),
            _ => None,
        }
    }

    /// The corners, each with the number of the edge that begins there.
    fn corners(&self, lattice: &Lattice) -> [(Point2, u32); 4] {
        let Self { x, y } = *self;
        [
            (lattice.at(0, 0), 0),
            (lattice.at(x, 0), x),
            (lattice.at(x, y), x + y),
            (lattice.at(0, y), 2 * x + y),
        ]
    }
}
