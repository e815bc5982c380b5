use fgm_core::Point3;

/// How often a fault occurs in a mesh, and where first.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Issue {
    /// How often.
    pub count: usize,
    /// A place where it occurs, mm.
    pub at: Option<Point3>,
}

impl Issue {
    pub(crate) fn add(&mut self, at: Point3) {
        self.count += 1;
        self.at.get_or_insert(at);
    }

    /// Whether it occurs at all.
    pub fn any(&self) -> bool {
        self.count > 0
    }
}

/// What is wrong with a mesh. None of it keeps it from being cut.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MeshIssues {
    /// Edges of one triangle only: the surface has a hole.
    pub open_edges: Issue,
    /// Edges of more than two triangles.
    pub non_manifold_edges: Issue,
    /// Triangles with two corners in one place; left out.
    pub degenerate_triangles: Issue,
    /// Triangles that repeat another, or lie back to back with it; left out.
    pub duplicate_triangles: Issue,
    /// Edges along which one triangle faces outwards and the other inwards.
    pub flipped_edges: Issue,
    /// Connected parts that face inwards though nothing is around them; taken as solid.
    pub inverted_shells: Issue,
}

impl MeshIssues {
    /// Whether the surface encloses a volume without a gap.
    pub fn is_closed(&self) -> bool {
        !self.open_edges.any()
    }

    /// Whether nothing is wrong.
    pub fn is_clean(&self) -> bool {
        *self == Self::default()
    }
}
