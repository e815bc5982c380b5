//! Planar arrangements of polylines: noding with snap rounding, half-edges, faces with holes,
//! labels and point location.
//!
//! Give it any lines, open or closed, crossing, touching, overlapping, doubled; it gives back the
//! regions that they divide the plane into. Each region is a polygon with holes, knows which
//! regions lie beyond which of its borders and which lines those borders come from, and has a
//! point that is really inside.
//!
//! # The cast
//!
//! | item | what it is |
//! |---|---|
//! | [`Chain`], [`ArrangeOptions`] | what goes in: points, open or closed, with a label |
//! | [`Arrangement`] | what comes out; [`Arranger`] makes many with the same memory |
//! | [`Face`], [`FaceId`] | a bounded region: [`Polygon`](fgm_core::Polygon), area, inside point, neighbours |
//! | [`Edge`], [`Border`], [`EdgeLabel`] | a line between faces, and as one of them sees it, with its labels |
//! | [`Location`] | where a point lies: [`Arrangement::locate`] |
//! | [`Cutter`] | cuts open paths by the faces: [`Arrangement::cut`] |
//! | `generators` | hard input for tests, with the feature of that name |
//! | [`ArrangeError`], [`Invalid`] | bad input; a broken invariant, from [`Arrangement::validate`] |
//!
//! # Example
//!
//! A square cut in two by a line that overshoots it:
//!
//! ```
//! use fgm_arrange::{ArrangeOptions, Arrangement, Chain};
//! use fgm_core::Point2;
//!
//! let p = |x, y| Point2::new(x, y);
//! let square = [p(0.0, 0.0), p(10.0, 0.0), p(10.0, 10.0), p(0.0, 10.0)];
//! let line = [p(4.0, -1.0), p(4.0, 11.0)];
//! let chains = [Chain::closed(&square, 'o'), Chain::open(&line, 'l')];
//!
//! let arrangement = Arrangement::new(&chains, &ArrangeOptions::default())?;
//! let areas: Vec<f64> = arrangement.faces().map(|face| face.area()).collect();
//! assert_eq!(areas, [40.0, 60.0]);
//!
//! let left = arrangement.locate(p(1.0, 5.0)).face().unwrap();
//! let mut spans = Vec::new();
//! arrangement.cut(&[p(-2.0, 5.0), p(8.0, 5.0)], &mut spans);
//! assert_eq!(spans[1].label, Some(left));
//! assert_eq!((spans[1].from, spans[1].to), (0.2, 0.6));
//! # Ok::<(), fgm_arrange::ArrangeError>(())
//! ```
//!
//! # How it works
//!
//! 1. Points are rounded to a lattice (1e-6 mm), where every predicate can be answered exactly:
//!    in `f64` with an error bound, in 128-bit integers where that does not decide.
//! 2. Lines are cut into short monotone pieces; a packed tree of their boxes, eight in a block,
//!    gives the pairs of segments that may touch.
//! 3. Crossings are snap-rounded: lines are led through the centres of the lattice's *hot pixels*,
//!    but only those lines that must move. What needs no rounding does not change, so arranging
//!    the result again changes nothing.
//! 4. Arcs between nodes are kept in the order of their places, so that what is near by in the plane
//!    is near by in memory. Large inputs are worked on by several threads, with the same result.
//! 5. Stretches with nothing on them stay whole polylines: the graph has a vertex where lines meet,
//!    not at every point. Its cycles are the faces' borders; components inside faces become holes.
//!
//! # Numbers
//!
//! Lengths in mm, areas in mm². Faces lie to the left of their borders: outer rings run
//! anticlockwise, holes clockwise. Lattice points have whole coordinates up to 2^40 steps.

mod arrangement;
mod block;
mod chain;
mod contact;
mod cut;
mod edge;
mod error;
mod face;
mod faces;
#[cfg(feature = "generators")]
pub mod generators;
mod graph;
mod hilbert;
mod inside;
mod lattice;
mod locate;
mod memory;
mod noder;
mod numbering;
mod parallel;
mod piece;
mod pixel;
mod predicate;
mod rays;
mod rings;
mod slots;
mod snap;
mod strips;
mod topology;
mod tree;
mod validate;

pub use arrangement::{Arrangement, Arranger, EdgeId, EdgeLabel, FaceId, VertexId};
pub use chain::{ArrangeOptions, Chain};
pub use cut::Cutter;
pub use edge::{Border, Borders, Edge};
pub use error::{ArrangeError, Invalid};
pub use face::Face;
pub use locate::Location;
