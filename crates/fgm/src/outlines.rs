use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use fgm_contour::{ContourOptions, Issue, MeshIssues, MeshSlicer, outline};
use fgm_core::{Bounds2, Field, Polygon};
use fgm_field::{Design, Geometry};
use fgm_toolpath::Support;

use crate::{error::SliceError, layers::Layer};

/// An outline that several layers look at.
pub(crate) type SharedOutline = Arc<Outline>;

/// The outline of one layer.
#[derive(Default)]
pub(crate) struct Outline {
    /// The region of the part, at the height of the layer's cut.
    pub(crate) region: Vec<Polygon>,
    /// What was mended or lost on the way.
    pub(crate) warnings: Vec<String>,
    /// The region's border, made when it is first asked for.
    border: OnceLock<Support>,
}

impl Outline {
    pub(crate) fn new(region: Vec<Polygon>, warnings: Vec<String>) -> Self {
        Self { region, warnings, border: OnceLock::new() }
    }

    /// The region's border.
    pub(crate) fn border(&self) -> &Support {
        self.border.get_or_init(|| Support::new(&self.region))
    }
}

/// Where outlines come from: a field that is sampled, or a mesh that is cut.
enum Source<'a> {
    Field(&'a dyn Field, Bounds2),
    Mesh(Box<MeshSlicer>),
}

/// Cells across the narrower side of a part, at least.
const LEAST_CELLS: f64 = 16.0;
/// No cell is made smaller than this for that, mm.
const SMALLEST_CELL: f64 = 0.01;

/// The outlines of a design.
pub(crate) struct Outliner<'a> {
    source: Source<'a>,
    options: ContourOptions,
}

impl<'a> Outliner<'a> {
    pub(crate) fn new(design: &'a Design, mut options: ContourOptions) -> Result<Self, SliceError> {
        // A part of few cells would lose its shape.
        let least = design.bounds.xy().size().min_element() / LEAST_CELLS;
        options.cell = options.cell.min(least.max(SMALLEST_CELL));
        let source = match &design.geometry {
            Geometry::Field(field) => {
                // The surface may lie on the window's edge; one cell more closes it inside.
                let window = design.bounds.xy().grown(2.0 * options.cell);
                Source::Field(field.as_ref(), window)
            }
            Geometry::Mesh(mesh) => Source::Mesh(Box::new(MeshSlicer::new(mesh)?)),
        };
        Ok(Self { source, options })
    }

    /// What is wrong with the design's surface as a whole, for the user.
    pub(crate) fn warnings(&self) -> Vec<String> {
        match &self.source {
            Source::Mesh(slicer) => mesh_warnings(slicer.issues()),
            Source::Field(..) => Vec::new(),
        }
    }

    /// The outline at a height, mm.
    pub(crate) fn at(&self, z: f64) -> Result<Outline, SliceError> {
        match &self.source {
            Source::Field(field, window) => {
                let region = outline(field.at_z(z).as_ref(), window, &self.options)?;
                Ok(Outline::new(region, Vec::new()))
            }
            Source::Mesh(slicer) => {
                let section = slicer.section(z);
                let warnings = section.warnings.iter().map(ToString::to_string).collect();
                Ok(Outline::new(section.polygons, warnings))
            }
        }
    }
}

/// A mesh's faults in words.
fn mesh_warnings(issues: &MeshIssues) -> Vec<String> {
    let faults = [
        (
            issues.open_edges,
            "open edges: the surface has holes, and layers are closed as well as possible",
        ),
        (issues.non_manifold_edges, "edges of more than two triangles"),
        (issues.degenerate_triangles, "triangles without area, left out"),
        (issues.duplicate_triangles, "triangles that repeat another, left out"),
        (issues.flipped_edges, "edges whose triangles face opposite ways"),
        (issues.inverted_shells, "parts that are inside out, taken as solid"),
    ];
    let words = |(issue, what): (Issue, &str)| {
        let at = issue.at?;
        let place = format!("({:.3}, {:.3}, {:.3})", at.x, at.y, at.z);
        Some(format!("the mesh has {} {what}; first at {place}", issue.count))
    };
    faults.into_iter().filter_map(words).collect()
}

/// Outlines of neighbouring layers, each made once, only so many kept.
///
/// A layer's skins look at the layers above and below; with layers in flight on several threads
/// each outline is asked for many times. The one who asks first makes it, under the lock of its
/// slot, and must not wait for other layers while it does.
pub(crate) struct OutlineWindow<'a> {
    outliner: &'a Outliner<'a>,
    slots: Vec<Mutex<Option<(usize, SharedOutline)>>>,
}

impl<'a> OutlineWindow<'a> {
    /// Keeps the outlines of `span` neighbouring layers.
    pub(crate) fn new(outliner: &'a Outliner<'a>, span: usize) -> Self {
        Self { outliner, slots: (0..span.max(1)).map(|_| Mutex::default()).collect() }
    }

    /// How many outlines are kept.
    pub(crate) fn span(&self) -> usize {
        self.slots.len()
    }

    /// The outline of a layer.
    pub(crate) fn get(&self, layer: &Layer) -> Result<SharedOutline, SliceError> {
        let slot = &self.slots[layer.index % self.slots.len()];
        let mut slot = slot.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((index, outline)) = &*slot
            && *index == layer.index
        {
            return Ok(Arc::clone(outline));
        }
        let outline = Arc::new(self.outliner.at(layer.cut)?);
        *slot = Some((layer.index, Arc::clone(&outline)));
        Ok(outline)
    }
}
