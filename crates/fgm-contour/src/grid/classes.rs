use crate::march::{class_near, class_of, range_of};

/// Samples classified together.
pub(crate) const CHUNK: usize = 16;
/// Says of a chunk that its samples, the first of the next chunk included, are not of one class.
pub(crate) const MIXED: u16 = u16::MAX - 1;

/// One row of samples, by how many of the levels each is at or above.
#[derive(Debug, Default)]
pub(crate) struct Row {
    /// A class for each sample, whole chunks and one more: beyond the last sample that one's.
    pub(crate) classes: Vec<u16>,
    /// The same, four in a word, the first in its lowest bits.
    words: Vec<u64>,
    /// For each chunk the class that all its samples have, or [`MIXED`].
    pub(crate) chunks: Vec<u16>,
    /// Whether any sample is not a number.
    pub(crate) has_nan: bool,
}

impl Row {
    pub(crate) fn reset(&mut self, samples: usize) {
        let chunks = samples.div_ceil(CHUNK);
        self.classes.clear();
        self.classes.resize(chunks * CHUNK + 1, 0);
        self.words.clear();
        self.words.resize(chunks * WORDS + 1, 0);
        self.chunks.clear();
        self.chunks.resize(chunks, MIXED);
        self.has_nan = false;
    }

    /// Classifies a row of values by levels, which are in order.
    ///
    /// A chunk is first compared with the range of the class before it, which is all that most
    /// chunks of smooth data need, however many levels there are.
    pub(crate) fn classify(&mut self, values: &[f64], levels: &[f64]) {
        self.has_nan = false;
        let mut class = 0;
        let mut range = range_of(class, levels);
        let out = self.classes.chunks_exact_mut(CHUNK).zip(self.words.chunks_exact_mut(WORDS));
        for (q, (out, words)) in out.enumerate() {
            let from = q * CHUNK;
            let chunk = &values[from..(from + CHUNK).min(values.len())];
            let next = values.get(from + CHUNK).copied().unwrap_or(chunk[chunk.len() - 1]);
            if next >= range.0 && next < range.1 && within(chunk, range) {
                out.fill(class);
                words.fill(u64::from(class) * EACH);
                self.chunks[q] = class;
                continue;
            }
            let (least, greatest, nan) = extent(chunk, next);
            if nan {
                self.has_nan = true;
                out.iter_mut().zip(chunk).for_each(|(c, v)| *c = class_of(*v, levels));
                self.chunks[q] = MIXED;
            } else {
                let [first, last] = [least, greatest].map(|v| class_near(class, v, levels));
                out.fill(first);
                for &level in &levels[usize::from(first)..usize::from(last)] {
                    count(out, chunk, level);
                }
                self.chunks[q] = if first == last { first } else { MIXED };
                class = out[chunk.len() - 1];
                range = range_of(class, levels);
            }
            let end = out[chunk.len() - 1];
            out[chunk.len()..].fill(end);
            for (word, c) in words.iter_mut().zip(out.as_chunks::<4>().0) {
                let [a, b, c, d] = c.map(u64::from);
                *word = a | b << 16 | c << 32 | d << 48;
            }
        }
        let end = self.classes.len() - 1;
        self.classes[end] = self.classes[end - 1];
        let last = self.words.len() - 1;
        self.words[last] = u64::from(self.classes[end]);
    }

    /// The words of a chunk, each with the same a sample further.
    fn shifted(&self, chunk: usize) -> [(u64, u64); WORDS] {
        let words =
            self.words.get(chunk * WORDS..=chunk * WORDS + WORDS).unwrap_or(&[0; WORDS + 1]);
        std::array::from_fn(|k| (words[k], words[k] >> 16 | words[k + 1] << 48))
    }
}

/// Words of a chunk.
const WORDS: usize = CHUNK / 4;
/// One in each place of a word.
const EACH: u64 = 0x0001_0001_0001_0001;

/// The edges between neighbours in a chunk of samples and the one after it: which of them are
/// crossed by a level, as their place in the chunk.
pub(crate) fn crossed_edges(row: &Row, chunk: usize) -> impl Iterator<Item = usize> + use<> {
    Places::new(row.shifted(chunk).map(|(a, b)| a ^ b))
}

/// The cells between two chunks of samples and those after them that have corners of more than
/// one class.
pub(crate) fn crossed_cells(
    lower: &Row,
    upper: &Row,
    chunk: usize,
) -> impl Iterator<Item = usize> + use<> {
    let (below, above) = (lower.shifted(chunk), upper.shifted(chunk));
    Places::new(std::array::from_fn(|k| {
        let ((a, b), (d, c)) = (below[k], above[k]);
        (a ^ b) | (a ^ c) | (a ^ d)
    }))
}

/// Places in a chunk, as bits.
struct Places(u32);

impl Places {
    /// The places of what is not 0.
    fn new(words: [u64; WORDS]) -> Self {
        let mut mask = 0;
        for (k, word) in words.into_iter().enumerate() {
            // The highest bit of each place: whether any is set. Then those four side by side.
            let any = ((word & !(EACH << 15)) + !(EACH << 15)) | word;
            let bits = ((any >> 15) & EACH).wrapping_mul(0x0001_0002_0004_0008) >> 48;
            mask |= (bits as u32) << (4 * k);
        }
        Self(mask)
    }
}

impl Iterator for Places {
    type Item = usize;

    #[inline]
    fn next(&mut self) -> Option<usize> {
        if self.0 == 0 {
            return None;
        }
        let place = self.0.trailing_zeros();
        self.0 &= self.0 - 1;
        Some(place as usize)
    }
}

/// Adds one to the class of each value that is at a level or above it.
fn count(classes: &mut [u16], values: &[f64], level: f64) {
    let above = |(class, value): (&mut u16, &f64)| *class += u16::from(*value >= level);
    match (<&mut [u16; CHUNK]>::try_from(&mut *classes), <&[f64; CHUNK]>::try_from(values)) {
        (Ok(classes), Ok(values)) => classes.iter_mut().zip(values).for_each(above),
        _ => classes.iter_mut().zip(values).for_each(above),
    }
}

/// Whether all values lie in a range; counted without a branch, so that it is vectorised.
fn within(values: &[f64], (lower, upper): (f64, f64)) -> bool {
    let inside = |v: &f64| u64::from((*v >= lower) & (*v < upper));
    match <&[f64; CHUNK]>::try_from(values) {
        Ok(values) => values.iter().map(inside).sum::<u64>() == CHUNK as u64,
        Err(_) => values.iter().map(inside).sum::<u64>() == values.len() as u64,
    }
}

/// The least and the greatest of some values and one more, and whether any is not a number.
fn extent(values: &[f64], next: f64) -> (f64, f64, bool) {
    const LANES: usize = 4;
    let (mut least, mut greatest) = ([next; LANES], [next; LANES]);
    let mut numbers = u64::from(!next.is_nan());
    let (lanes, rest) = values.as_chunks::<LANES>();
    for lane in lanes {
        for k in 0..LANES {
            let v = lane[k];
            least[k] = if v < least[k] { v } else { least[k] };
            greatest[k] = if v > greatest[k] { v } else { greatest[k] };
            numbers += u64::from(!v.is_nan());
        }
    }
    for &v in rest {
        (least[0], greatest[0]) = (least[0].min(v), greatest[0].max(v));
        numbers += u64::from(!v.is_nan());
    }
    let least = least.into_iter().fold(next, f64::min);
    (least, greatest.into_iter().fold(next, f64::max), numbers <= values.len() as u64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_classified_as_their_samples_are() {
        let mut state = 3_u64;
        let mut random = |n: u64| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (state >> 33) % n
        };
        let special = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 0.0, -0.0];
        let mut row = Row::default();
        for round in 0..500 {
            let samples = 1 + random(70) as usize;
            // From one class a row to many a chunk, with and without what is special.
            let span = 1 + random(6);
            let values: Vec<f64> = (0..samples)
                .map(|k| match random(40 * (1 + round % 5)) {
                    s @ 0..5 => special[s as usize],
                    _ => (k / 20) as f64 + random(2 * span) as f64 / 2.0,
                })
                .collect();
            let levels: Vec<f64> = (0..random(6)).map(|k| k as f64 * 1.5).collect();
            row.reset(samples);
            row.classify(&values, &levels);
            let expected: Vec<u16> = values.iter().map(|&v| class_of(v, &levels)).collect();
            assert_eq!(row.classes[..samples], expected);
            let beyond = expected[samples - 1];
            assert!(row.classes[samples..].iter().all(|&c| c == beyond));
            assert_eq!(row.has_nan, values.iter().any(|v| v.is_nan()));
            for (q, &chunk) in row.chunks.iter().enumerate() {
                let end = (q * CHUNK + CHUNK + 1).min(samples);
                let whole = expected[q * CHUNK..end].iter().all(|&c| c == chunk);
                assert!(chunk == MIXED || whole, "chunk {q} of {values:?}");
                let places =
                    |k: &usize| row.classes[q * CHUNK + k] != row.classes[q * CHUNK + k + 1];
                let expected: Vec<usize> = (0..CHUNK).filter(places).collect();
                let found: Vec<usize> = crossed_edges(&row, q).collect();
                assert_eq!(found, expected);
                let same =
                    Row { words: vec![u64::from(chunk) * EACH; row.words.len()], ..Row::default() };
                let cells: Vec<usize> = crossed_cells(&row, &row, q).collect();
                assert_eq!(cells, expected);
                let off = |k: &usize| {
                    let at = &row.classes[q * CHUNK + k..][..2];
                    at != [chunk; 2]
                };
                let expected: Vec<usize> = (0..CHUNK).filter(off).collect();
                let cells: Vec<usize> = crossed_cells(&same, &row, q).collect();
                assert_eq!(cells, expected);
            }
        }
    }
}
