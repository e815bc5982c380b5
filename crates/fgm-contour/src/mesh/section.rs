use fgm_core::{Point2, Polygon};

/// What a plane cuts out of a mesh.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Section {
    /// The inside: outer rings anticlockwise, holes clockwise.
    pub polygons: Vec<Polygon>,
    /// What had to be mended or left out. None for a closed mesh.
    pub warnings: Vec<SectionWarning>,
}

/// Where a section of an open mesh had to be mended.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum SectionWarning {
    /// Two ends of the border, a small hole's width apart, were joined.
    #[error("a gap of {gap:.4} mm was closed at ({:.3}, {:.3})", at.x, at.y)]
    GapClosed {
        /// Where, mm.
        at: Point2,
        /// Its width, mm; at most the slicer's greatest gap.
        gap: f64,
    },
    /// The border was open by more than the greatest gap and was closed with a straight line.
    #[error("an opening of {gap:.3} mm was closed straight at ({:.3}, {:.3})", at.x, at.y)]
    OpeningClosed {
        /// Where, mm.
        at: Point2,
        /// Its width, mm.
        gap: f64,
    },
    /// A piece of border encloses nothing and was left out.
    #[error("an open border of {length:.3} mm was left out at ({:.3}, {:.3})", at.x, at.y)]
    Dropped {
        /// Where it begins, mm.
        at: Point2,
        /// Its length, mm.
        length: f64,
    },
}
