use super::nodes::{NONE, Node};
use fgm_core::Point2;

/// A pair of strands: stretches of a line that begin together, at the two ends of a segment, and
/// grow with the sweep, one with the line's direction (an even number) and one against it (the
/// odd number that follows).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pair {
    /// The crossing that was known first of the two that the pair begins at. At the bottom of a
    /// closed line, that is the one in a row of samples.
    pub(crate) first: u32,
    pub(crate) level: u16,
    /// The line that both belong to.
    pub(crate) line: u32,
    strands: [Strand; 2],
}

#[derive(Clone, Copy, Debug)]
struct Strand {
    crossings: u32,
    /// The strand whose end it met with its own.
    met: u32,
}

/// The stretches that lines are put together from.
///
/// Crossings come row by row, lines run from row to row. Following a line from crossing to
/// crossing would be a walk through all of memory; here each crossing is brought to its strand in
/// the order of the sweep, in which few strands grow at a time, and lines are joined of strands.
#[derive(Debug, Default)]
pub(crate) struct Strands {
    pub(crate) pairs: Vec<Pair>,
    /// Where the next point of each strand goes; in the end, where its points end.
    ends: Vec<u32>,
    points: Vec<Point2>,
}

impl Strands {
    pub(crate) fn clear(&mut self) {
        self.pairs.clear();
    }

    /// Begins a pair; answers the strand with the line's direction and the one against it.
    pub(crate) fn begin(&mut self, from: u32, to: u32, level: u16) -> [u32; 2] {
        let number = 2 * self.pairs.len() as u32;
        let strands = [Strand { crossings: 1, met: NONE }; 2];
        self.pairs.push(Pair { first: from.min(to), level, line: NONE, strands });
        [number, number + 1]
    }

    /// Begins a pair at a crossing at which a line comes in from below, if it rises, or leaves;
    /// answers the strand that it is the beginning of. The other stays without crossings.
    pub(crate) fn begin_at_border(&mut self, node: u32, rises: bool, level: u16) -> u32 {
        let [ahead, back] = self.begin(node, node, level);
        let (kept, empty) = if rises { (ahead, back) } else { (back, ahead) };
        self.of(empty).crossings = 0;
        kept
    }

    fn of(&mut self, strand: u32) -> &mut Strand {
        &mut self.pairs[strand as usize / 2].strands[strand as usize % 2]
    }

    /// Makes a strand longer by one crossing; answers the strand.
    pub(crate) fn grow(&mut self, strand: u32) -> u32 {
        self.of(strand).crossings += 1;
        strand
    }

    /// Joins the growing ends of two strands.
    pub(crate) fn meet(&mut self, a: u32, b: u32) {
        self.of(a).met = b;
        self.of(b).met = a;
    }

    /// The strand that was met, or [`NONE`].
    pub(crate) fn met(&self, strand: u32) -> u32 {
        self.pairs[strand as usize / 2].strands[strand as usize % 2].met
    }

    /// Brings the crossings, which come in the order in which strands grow, to their strands.
    pub(crate) fn gather<'a>(&mut self, nodes: impl Iterator<Item = &'a [Node]>) {
        let mut total = 0;
        self.ends.clear();
        self.ends.extend(self.pairs.iter().flat_map(|p| p.strands).map(|s| {
            let begin = total;
            total += s.crossings;
            begin
        }));
        self.points.resize(total as usize, Point2::ZERO);
        for node in nodes.flatten() {
            if let Some(end) = self.ends.get_mut(node.strand as usize) {
                self.points[*end as usize] = node.at;
                *end += 1;
            }
        }
    }

    /// The points of a strand, once gathered.
    pub(crate) fn points(&self, strand: u32) -> &[Point2] {
        let begin = (strand as usize).checked_sub(1).map_or(0, |before| self.ends[before]);
        &self.points[begin as usize..self.ends[strand as usize] as usize]
    }
}
