/// What went wrong in planning toolpaths.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ToolpathError {
    /// No infill pattern has this name.
    #[error("no infill pattern `{name}`: rectilinear, grid, concentric or gyroid")]
    UnknownPattern {
        /// What was asked for.
        name: String,
    },
}
