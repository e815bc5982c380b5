//! Toolpaths for graded parts: walls, skins, infill, sectioning by colour, zippers, fills against the gradient, purge towers, ordering.

mod against;
mod error;
mod gap;
mod infill;
mod inset;
mod order;
mod order_link;
mod order_near;
mod path;
mod plan;
pub mod region;
#[cfg(test)]
mod region_shapes;
mod section;
mod section_runs;
mod skins;
mod skirt;
mod tower;
mod tower_layout;
mod travel;
mod walls;
mod zipper;

pub use against::{AgainstOptions, FaceFill, against};
pub use error::ToolpathError;
pub use gap::{GapOptions, gap_fill};
pub use infill::{Infill, InfillOptions, Pattern, infill};
pub use inset::{ClipperInset, Inset};
pub use order::{OrderOptions, RoleOrder, Seam, order, order_with};
pub use path::{Path, Piece};
pub use plan::{LayerPlan, LayerStats, Motions, SHORT_PIECE};
pub use section::{SectionOptions, section};
pub use skins::{Skins, skins, skins_with};
pub use skirt::{SkirtOptions, skirt};
pub use tower::{TowerOptions, Towers};
pub use tower_layout::Side;
pub use travel::connect;
pub use walls::{WallOptions, Walls, walls};
