use std::io::{self, BufRead, Read};
use std::ops::Range;
use std::path::Path;

use fgm_core::{Point3, TriangleMesh};

use super::weld::Welder;
use crate::problem::MAX_TRIANGLES;
use crate::source::Source;
use crate::{DesignError, Problem};

/// Reads the vertices and faces of an OBJ file, all objects and groups as one mesh.
///
/// Polygons become fans of triangles. Indices may be negative (counted from the end). Vertices
/// with equal coordinates become one. Lines other than `v` and `f` are skipped: texture, normals,
/// colours, materials, curves.
///
/// # Errors
/// [`DesignError`] that points at the line.
///
/// ```
/// let mesh = fgm_design::read_obj(b"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n")?;
/// assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3]]);
/// # Ok::<(), fgm_design::DesignError>(())
/// ```
pub fn read_obj(bytes: &[u8]) -> Result<TriangleMesh, DesignError> {
    read(bytes, Path::new("<obj>"))
}

pub(crate) fn read(bytes: &[u8], file: &Path) -> Result<TriangleMesh, DesignError> {
    let text = String::from_utf8_lossy(bytes);
    let source = Source::new(file, &text);
    let options = tobj::LoadOptions {
        triangulate: true,
        ignore_lines: true,
        ignore_points: true,
        ..Default::default()
    };
    let (kept, lines) = keep(&source)?;
    let mut reader = Lines { text: kept.as_bytes(), done: 0 };
    let loaded = tobj::load_obj_buf(&mut reader, &options, |_| Ok(Default::default()));
    let (models, _) = loaded.map_err(|error| {
        let line = lines.get(reader.done.saturating_sub(1)).cloned().unwrap_or(0..0);
        source.error(line, Problem::Obj { error })
    })?;
    let count: usize = models.iter().map(|m| m.mesh.indices.len() / 3).sum();
    if count > MAX_TRIANGLES {
        return Err(DesignError::file(file, Problem::TooManyTriangles));
    }
    let mut welder = Welder::with_triangles(count);
    for (i, [a, b, c]) in models
        .iter()
        .flat_map(|m| m.mesh.indices.as_chunks().0.iter().map(|t| corners(m, t)))
        .enumerate()
    {
        if ![a, b, c].iter().all(|p| p.is_finite()) {
            return Err(DesignError::file(file, Problem::NotFinite { triangle: i + 1 }));
        }
        welder.triangle([a, b, c]);
    }
    let mesh = welder.finish();
    if mesh.triangles.is_empty() {
        return Err(DesignError::file(file, Problem::NoTriangles));
    }
    Ok(mesh)
}

fn corners(model: &tobj::Model, triangle: &[u32; 3]) -> [Point3; 3] {
    triangle.map(|i| {
        let at = i as usize * 3;
        Point3::from_slice(&model.mesh.positions[at..at + 3])
    })
}

/// The `v` and `f` lines, without textures, normals and colours, and where each stood.
///
/// The reader behind is spared what it does not need, and indices beyond the vertices, which it
/// could only report without a line.
fn keep(source: &Source) -> Result<(String, Vec<Range<usize>>), DesignError> {
    let text = &*source.text;
    let (mut kept, mut lines) = (String::with_capacity(text.len()), Vec::new());
    let mut vertices = 0_usize;
    let mut greatest = (0_i64, 0..0);
    let mut at = 0;
    for line in text.split_inclusive('\n') {
        let span = at..at + line.trim_end().len();
        at += line.len();
        let mut words = line.split_whitespace();
        match words.next() {
            Some("v") => {
                vertices += 1;
                kept.push('v');
                for word in words.take(3) {
                    kept.push(' ');
                    kept.push_str(word);
                }
            }
            Some("f") => {
                kept.push('f');
                for word in words.take_while(|w| !w.starts_with('#')) {
                    let index = word.split('/').next().unwrap_or(word);
                    let value: i64 = index.parse().map_err(|_| {
                        source.error(
                            span.clone(),
                            Problem::Obj { error: tobj::LoadError::FaceParseError },
                        )
                    })?;
                    if value == 0 || (value < 0 && value.unsigned_abs() > vertices as u64) {
                        let problem = Problem::VertexIndex { index: value, count: vertices };
                        return Err(source.error(span, problem));
                    }
                    if value > greatest.0 {
                        greatest = (value, span.clone());
                    }
                    kept.push(' ');
                    kept.push_str(index);
                }
            }
            _ => continue,
        }
        kept.push('\n');
        lines.push(span);
    }
    if greatest.0 as u64 > vertices as u64 {
        let problem = Problem::VertexIndex { index: greatest.0, count: vertices };
        return Err(source.error(greatest.1, problem));
    }
    Ok((kept, lines))
}

/// A text handed out line by line, counting them: so an error's line is known.
struct Lines<'a> {
    text: &'a [u8],
    done: usize,
}

impl Read for Lines<'_> {
    fn read(&mut self, out: &mut [u8]) -> io::Result<usize> {
        let len = self.fill_buf()?.len().min(out.len());
        out[..len].copy_from_slice(&self.text[..len]);
        self.consume(len);
        Ok(len)
    }
}

impl BufRead for Lines<'_> {
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        let end = self.text.iter().position(|&b| b == b'\n').map_or(self.text.len(), |i| i + 1);
        Ok(&self.text[..end])
    }

    fn consume(&mut self, amount: usize) {
        let (taken, rest) = self.text.split_at(amount);
        self.done += usize::from(taken.last() == Some(&b'\n'));
        self.text = rest;
    }
}
