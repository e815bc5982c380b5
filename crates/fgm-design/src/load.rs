use std::fmt;
use std::fs::File;
use std::io::Read;
use std::path::Path;

use fgm_field::Design;
use glam::DVec3;

use crate::problem::MAX_TEXT_BYTES;
use crate::source::Source;
use crate::vcad::Lowering;
use crate::{DesignError, Problem, Warning, mesh};

/// What is said about a design besides its file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LoadOptions {
    /// Volume fractions as expressions, for meshes, which have none of their own: one for each
    /// material, or one fewer, and the last material is what remains of 1. Without
    /// [`names`](Self::names) to count, a single expression means two materials and more mean as
    /// many. A `.vcad` design is put into an `fgrade` of these.
    pub fractions: Vec<String>,
    /// Makes the design as large as fits into these sides, mm, with its proportions kept, by
    /// scaling about the origin. The material of a `.vcad` design is scaled with it; for a mesh
    /// the expressions see the scaled coordinates.
    pub size: Option<DVec3>,
    /// The names of the materials of [`fractions`](Self::fractions); `A`, `B`, ... where there are
    /// none.
    pub names: Vec<String>,
}

/// A design and what was odd about it.
pub struct Loaded {
    /// The design.
    pub design: Design,
    /// What to tell its author.
    pub warnings: Vec<Warning>,
}

impl fmt::Debug for Loaded {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Loaded")
            .field("name", &self.design.name)
            .field("materials", &self.design.materials)
            .field("bounds", &self.design.bounds)
            .field("warnings", &self.warnings)
            .finish_non_exhaustive()
    }
}

/// Reads a design: a `.vcad` file, or a `.stl`, `.obj` or `.3mf` mesh with
/// [`fractions`](LoadOptions::fractions).
///
/// Its name is the file's without the ending. Colours come from a palette beside the file.
///
/// # Errors
/// [`DesignError`]: a file that cannot be read or is not of its format, and everything wrong with
/// the design; with the place for `.vcad`, text STL and OBJ files and expressions.
pub fn load(path: &Path, options: &LoadOptions) -> Result<Loaded, DesignError> {
    let folder = path.parent().unwrap_or(Path::new(""));
    if extension(path) != "vcad" {
        let mut warnings = Vec::new();
        let mesh = mesh::load(path, &mut warnings)?;
        let source = Source::new(path, "");
        let mut lowering = Lowering::new(&source, folder, options);
        lowering.warnings = warnings;
        return lowering.mesh_design(mesh, path);
    }
    let bytes = read_file(path, MAX_TEXT_BYTES)?;
    let text = String::from_utf8(bytes).map_err(|error| {
        let valid = error.utf8_error().valid_up_to();
        let lossy = String::from_utf8_lossy(error.as_bytes());
        Source::new(path, &lossy).error(valid..valid + 1, Problem::NotText)
    })?;
    let source = Source::new(path, &text);
    Lowering::new(&source, folder, options).text_design(Some(path))
}

/// Reads a `.vcad` design from a text; files it names are relative to `base_dir`.
///
/// # Errors
/// As [`load`]; the file is called `<vcad>`.
///
/// ```
/// use std::path::Path;
/// use fgm_core::{MaterialField, Point3};
/// use fgm_design::{LoadOptions, parse_vcad};
///
/// let text = r#"fgrade(["z/70", "1-z/70"], ["blue", "yellow"]) { cylinder(15, 70); }"#;
/// let design = parse_vcad(text, Path::new("."), &LoadOptions::default())?.design;
/// assert_eq!(design.bounds.max, Point3::new(15.0, 15.0, 70.0));
/// let mixture = design.fractions.mixture(Point3::new(0.0, 0.0, 17.5))?;
/// assert!((mixture.fractions()[0] - 0.25).abs() < 1e-12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn parse_vcad(
    source: &str,
    base_dir: &Path,
    options: &LoadOptions,
) -> Result<Loaded, DesignError> {
    let source = Source::new(Path::new("<vcad>"), source);
    Lowering::new(&source, base_dir, options).text_design(None)
}

/// What follows the last point of a file's name, in lower case.
pub(crate) fn extension(path: &Path) -> String {
    path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase()).unwrap_or_default()
}

/// The bytes of a file of at most `limit`.
pub(crate) fn read_file(path: &Path, limit: u64) -> Result<Vec<u8>, DesignError> {
    let read = |error| DesignError::Read { path: path.to_path_buf(), error };
    let file = File::open(path).map_err(read)?;
    let expected = file.metadata().map_err(read)?.len().min(limit);
    let mut bytes = Vec::with_capacity(expected as usize + 1);
    file.take(limit + 1).read_to_end(&mut bytes).map_err(read)?;
    if bytes.len() as u64 > limit {
        return Err(DesignError::FileTooLarge { path: path.to_path_buf(), limit });
    }
    Ok(bytes)
}
