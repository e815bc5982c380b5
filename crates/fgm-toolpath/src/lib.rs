//! Toolpaths for graded parts, layer by layer: from regions to beads in colours, in the order of
//! printing.
//!
//! A layer comes as regions (slices of [`Polygon`](fgm_core::Polygon)) and leaves as a
//! [`LayerPlan`], a stream of [`Motion`](fgm_core::Motion)s. Nothing here knows a machine, a file
//! or a field; colours come in through a [`Sectioner`](fgm_core::Sectioner).
//!
//! # Two ways to print a gradient
//!
//! | | sectioned | against the gradient |
//! |---|---|---|
//! | lines | as for any part: [`walls`], [`skins`], [`infill`] over the whole layer | [`against`] fills each face of one colour by itself |
//! | colour | [`section`] cuts the lines by the faces, with zippers where two colours overlap | a face's own |
//! | between colours | [`Towers`] take the transition | many small steps need none |
//! | then | [`order_with`], [`LayerPlan`] | the same |
//!
//! # The cast
//!
//! | group | items |
//! |---|---|
//! | lines | [`Path`] before it has a colour, [`Piece`] after |
//! | borders | [`Inset`] (the seam), [`ClipperInset`] (its default), [`region`] (booleans) |
//! | lines of a part | [`walls`], [`skins`], [`infill`] with [`Pattern`] and [`Infill`] (the seam), [`infill_graded`], [`infill_lightning`], [`gap_fill`] |
//! | lines of a face | [`against`], [`route`] |
//! | colour | [`section`]; [`seam_length`] tells how far colours touch |
//! | a wall that rises | [`Turn`], [`fade`] |
//! | over air | [`Support`], [`mark_overhangs`], [`bridges`] |
//! | order | [`order`], [`order_with`], [`order_routes`], [`connect`], [`join_ends`], [`begin_at_seams`], [`find_ways`] |
//! | beside the part | [`Towers`], [`skirt`], [`brim`] |
//! | result | [`LayerPlan`], [`LayerStats`], [`ToolpathError`] |
//!
//! # Volume
//!
//! A bead's section is a capsule ([`fgm_core::bead`]): lines a [spacing](fgm_core::bead::spacing)
//! apart fill the layer to exactly its volume. Everything here keeps to that measure. The first
//! wall lies half a bead inside the outline; from there on each line fills one spacing, and what
//! is too thin for lines takes beads of varying width ([`gap_fill`]).
//!
//! # Example
//!
//! A plate with a bore: walls, and what is inside filled solid.
//!
//! ```
//! use fgm_core::{Point2, Polygon, Ring, bead};
//! use fgm_toolpath::{ClipperInset, InfillOptions, WallOptions, infill, region, walls};
//!
//! let ring = |p: [(f64, f64); 4]| Ring::new(p.map(|(x, y)| Point2::new(x, y)).into());
//! let plate = [Polygon {
//!     outer: ring([(0.0, 0.0), (40.0, 0.0), (40.0, 30.0), (0.0, 30.0)]),
//!     holes: vec![ring([(15.0, 10.0), (15.0, 20.0), (25.0, 20.0), (25.0, 10.0)])],
//! }];
//! let (width, height, inset) = (0.4, 0.2, ClipperInset::default());
//!
//! let walls = walls(&plate, &WallOptions::new(3, width, height), &inset);
//! assert_eq!(walls.paths.len(), 6, "three outside, three in the bore");
//! let solid = infill(&walls.inside, &InfillOptions::new(width, height), &inset);
//!
//! let volume = |p: &fgm_toolpath::Path| p.length() * bead::area(p.width, height);
//! let extruded: f64 = walls.paths.iter().chain(&solid).map(volume).sum();
//! let part = region::area(&plate) * height;
//! assert!((extruded / part - 1.0).abs() < 0.01);
//! ```

mod against;
mod bridge;
mod brim;
mod error;
mod face_fill;
mod gap;
mod infill;
mod inset;
mod join_ends;
mod level_ends;
mod order;
mod order_color;
mod order_monotone;
mod order_near;
mod order_options;
mod order_routes;
mod order_runs;
mod order_seam;
mod order_walk;
mod overhang;
mod path;
mod plan;
pub mod region;
#[cfg(test)]
mod region_shapes;
mod route;
mod seam;
mod section;
mod section_runs;
mod skins;
mod skirt;
mod spiral;
mod support;
mod tower;
mod tower_layout;
mod travel;
mod walls;
mod way;
mod zipper;

pub use against::{AgainstOptions, against};
pub use bridge::{Bridge, BridgeOptions, bridges};
pub use brim::{BrimOptions, brim};
pub use error::ToolpathError;
pub use face_fill::FaceFill;
pub use gap::{GapOptions, gap_fill};
pub use infill::{Infill, InfillOptions, Pattern, infill, infill_graded, infill_lightning};
pub use inset::{ClipperInset, Inset};
pub use join_ends::{Turns, join_ends};
pub use order::{order, order_with};
pub use order_color::{Change, ColorOrder};
pub use order_options::{Monotonic, OrderOptions, RoleOrder};
pub use order_routes::order_routes;
pub use order_seam::{Seam, begin_at_seams};
pub use overhang::mark_overhangs;
pub use path::{Path, Piece};
pub use plan::{LayerPlan, LayerStats, Motions, Rise, SHORT_PIECE};
pub use route::route;
pub use seam::seam_length;
pub use section::{SectionOptions, section};
pub use skins::{Skins, skins, skins_with};
pub use skirt::{SkirtOptions, skirt};
pub use spiral::{Turn, fade};
pub use support::{Hold, Scratch, Stretch, Support};
pub use tower::{TowerOptions, Towers};
pub use tower_layout::Side;
pub use travel::connect;
pub use walls::{WallOptions, Walls, walls};
pub use way::{WayOptions, find_ways};
