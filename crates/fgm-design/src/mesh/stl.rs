use std::path::Path;

use fgm_core::{Point3, TriangleMesh};

use super::weld::Welder;
use crate::problem::MAX_TRIANGLES;
use crate::source::Source;
use crate::{DesignError, Problem};

/// Bytes before the triangles of a binary file: a header of 80, then their number.
const HEAD: usize = 84;
/// Bytes of a triangle of a binary file.
const RECORD: usize = 50;

/// Reads an STL file, binary or text.
///
/// Corners with equal coordinates become one vertex; triangles without area are left out. A file
/// is binary when its length is what the count in its head says, even if the head begins with
/// `solid`; the words of the text form may be in either case, and lines end as they like.
///
/// # Errors
/// [`DesignError`] naming the first bad triangle or, in the text form, the place.
///
/// ```
/// let text = "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n\
///             endloop\nendfacet\nendsolid\n";
/// assert_eq!(fgm_design::read_stl(text.as_bytes())?.triangles, [[0, 1, 2]]);
/// # Ok::<(), fgm_design::DesignError>(())
/// ```
pub fn read_stl(bytes: &[u8]) -> Result<TriangleMesh, DesignError> {
    read(bytes, Path::new("<stl>"))
}

pub(crate) fn read(bytes: &[u8], file: &Path) -> Result<TriangleMesh, DesignError> {
    let announced =
        bytes.get(80..HEAD).map(|b| u64::from(u32::from_le_bytes([b[0], b[1], b[2], b[3]])));
    let whole = announced.map(|n| HEAD as u64 + n * RECORD as u64);
    let mesh = if whole == Some(bytes.len() as u64) {
        binary(&bytes[HEAD..], file)?
    } else if is_text(bytes) {
        Text::new(bytes, file).mesh()?
    } else {
        let Some(expected) = announced else {
            return Err(DesignError::file(file, Problem::NotStl));
        };
        let found = ((bytes.len() - HEAD) / RECORD) as u64;
        if found < expected {
            return Err(DesignError::file(file, Problem::Truncated { expected, found }));
        }
        // Some programs write more after the last triangle.
        binary(&bytes[HEAD..HEAD + expected as usize * RECORD], file)?
    };
    if mesh.triangles.is_empty() {
        return Err(DesignError::file(file, Problem::NoTriangles));
    }
    Ok(mesh)
}

fn binary(records: &[u8], file: &Path) -> Result<TriangleMesh, DesignError> {
    let count = records.len() / RECORD;
    if count > MAX_TRIANGLES {
        return Err(DesignError::file(file, Problem::TooManyTriangles));
    }
    let mut welder = Welder::with_triangles(count);
    for (i, record) in records.chunks_exact(RECORD).enumerate() {
        // After the normal, which is not needed, nine little-endian f32.
        let number = |at: usize| {
            let b = &record[12 + 4 * at..16 + 4 * at];
            f64::from(f32::from_le_bytes([b[0], b[1], b[2], b[3]]))
        };
        let corner = |c: usize| Point3::new(number(3 * c), number(3 * c + 1), number(3 * c + 2));
        let corners = [corner(0), corner(1), corner(2)];
        if corners.iter().any(|p| !p.is_finite()) {
            return Err(DesignError::file(file, Problem::NotFinite { triangle: i + 1 }));
        }
        welder.triangle(corners);
    }
    Ok(welder.finish())
}

/// Whether the first word is `solid` and what follows the name is a facet or the end.
fn is_text(bytes: &[u8]) -> bool {
    let start = bytes.iter().position(|b| !b.is_ascii_whitespace()).unwrap_or(bytes.len());
    let head = &bytes[start..];
    let solid = head.get(..5).is_some_and(|w| w.eq_ignore_ascii_case(b"solid"));
    let rest = head.iter().position(|&b| b == b'\n' || b == b'\r').map_or(&[][..], |i| &head[i..]);
    let word = rest.trim_ascii_start();
    solid
        && (word.is_empty()
            || [&b"facet"[..], b"endsolid"]
                .iter()
                .any(|w| word.get(..w.len()).is_some_and(|x| x.eq_ignore_ascii_case(w))))
}

/// The words of the text form.
struct Text<'a> {
    bytes: &'a [u8],
    file: &'a Path,
    at: usize,
}

impl<'a> Text<'a> {
    fn new(bytes: &'a [u8], file: &'a Path) -> Self {
        Self { bytes, file, at: 0 }
    }

    fn mesh(mut self) -> Result<TriangleMesh, DesignError> {
        let mut welder = Welder::with_triangles(self.bytes.len() / 200);
        let mut count = 0;
        while let Some(word) = self.word() {
            if word.eq_ignore_ascii_case(b"solid") || word.eq_ignore_ascii_case(b"endsolid") {
                self.skip_line();
            } else if word.eq_ignore_ascii_case(b"facet") {
                count += 1;
                if count > MAX_TRIANGLES {
                    return Err(DesignError::file(self.file, Problem::TooManyTriangles));
                }
                welder.triangle(self.facet(count)?);
            } else {
                return Err(self.unexpected(word, "`facet` or `endsolid`"));
            }
        }
        Ok(welder.finish())
    }

    /// From the word after `facet` to `endfacet`.
    fn facet(&mut self, triangle: usize) -> Result<[Point3; 3], DesignError> {
        self.expect(b"normal", "`normal`")?;
        for _ in 0..3 {
            // Normals are not used, and some programs write `nan` for those of slivers.
            if self.word().is_none() {
                return Err(self.end("a normal's three numbers"));
            }
        }
        self.expect(b"outer", "`outer loop`")?;
        self.expect(b"loop", "`outer loop`")?;
        let mut corners = [Point3::ZERO; 3];
        for corner in &mut corners {
            self.expect(b"vertex", "`vertex`")?;
            let (x, y, z) = (self.number()?, self.number()?, self.number()?);
            *corner = Point3::new(x, y, z);
            if !corner.is_finite() {
                let word = self.at.saturating_sub(1)..self.at;
                return Err(self.error(word, Problem::NotFinite { triangle }));
            }
        }
        self.expect(b"endloop", "`endloop`: a facet has three vertices")?;
        self.expect(b"endfacet", "`endfacet`")?;
        Ok(corners)
    }

    fn word(&mut self) -> Option<&'a [u8]> {
        let rest = &self.bytes[self.at..];
        let start = rest.iter().position(|b| !b.is_ascii_whitespace())?;
        let rest = &rest[start..];
        let len = rest.iter().position(u8::is_ascii_whitespace).unwrap_or(rest.len());
        self.at += start + len;
        Some(&rest[..len])
    }

    fn skip_line(&mut self) {
        let rest = &self.bytes[self.at..];
        self.at += rest.iter().position(|&b| b == b'\n' || b == b'\r').unwrap_or(rest.len());
    }

    fn expect(&mut self, wanted: &[u8], expected: &'static str) -> Result<(), DesignError> {
        match self.word() {
            Some(word) if word.eq_ignore_ascii_case(wanted) => Ok(()),
            Some(word) => Err(self.unexpected(word, expected)),
            None => Err(self.end(expected)),
        }
    }

    fn number(&mut self) -> Result<f64, DesignError> {
        let Some(word) = self.word() else { return Err(self.end("a number")) };
        std::str::from_utf8(word)
            .ok()
            .and_then(|w| w.parse().ok())
            .ok_or_else(|| self.unexpected(word, "a number"))
    }

    fn unexpected(&self, word: &[u8], expected: &'static str) -> DesignError {
        let shown = String::from_utf8_lossy(&word[..word.len().min(40)]).into_owned();
        let found = format!("`{}`", shown.escape_default());
        self.error(self.at - word.len()..self.at, Problem::Unexpected { found, expected })
    }

    fn end(&self, expected: &'static str) -> DesignError {
        let found = "the end of the file".to_string();
        self.error(self.at..self.at, Problem::Unexpected { found, expected })
    }

    /// Points into the text; into a lossy copy of it where it is not UTF-8.
    fn error(&self, span: std::ops::Range<usize>, problem: Problem) -> DesignError {
        let len = |bytes: &[u8]| String::from_utf8_lossy(bytes).len();
        let start = len(&self.bytes[..span.start]);
        let span = start..start + len(&self.bytes[span]);
        Source::new(self.file, &String::from_utf8_lossy(self.bytes)).error(span, problem)
    }
}
