//! How pieces may be put in order.

use fgm_core::{Point2, Role};

use crate::{join_ends::Turns, order_seam::Seam};

/// How the pieces of a layer are put in order.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(default, deny_unknown_fields))]
pub struct OrderOptions {
    /// Which roles come first inside a colour.
    pub roles: RoleOrder,
    /// Where loops of the outer wall start.
    pub seam: Seam,
    /// The point that [`Seam::Aligned`] looks at, mm.
    pub seam_point: Point2,
    /// The layer, from 0: [`Seam::Random`] differs by it.
    pub layer: u32,
    /// Changes of the nearest-neighbour order that are tried for each piece, to shorten the
    /// travels; 0 leaves that order as it is.
    pub improve: u32,
    /// Which skins are laid line beside line.
    pub monotonic: Monotonic,
    /// Direction of the skins' lines, radians from +x.
    pub direction: f64,
    /// How lines will turn round at boundaries between colours ([`join_ends`](crate::join_ends)):
    /// where these are too steep, the ends of neighbours are brought to one level, so that they can;
    /// the boundary moves by up to half a spacing. Where none, every line ends where it ends.
    pub turns: Option<Turns>,
}

impl Default for OrderOptions {
    fn default() -> Self {
        Self {
            roles: RoleOrder::Any,
            seam: Seam::Nearest,
            seam_point: Point2::ZERO,
            layer: 0,
            improve: 32,
            monotonic: Monotonic::Off,
            direction: 0.0,
            turns: None,
        }
    }
}

/// Which skins are laid line beside line, in one direction of advance.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum Monotonic {
    /// None: the least travel.
    #[default]
    Off,
    /// Those seen from above.
    Top,
    /// Those seen from above and from below.
    All,
}

impl Monotonic {
    /// Whether it takes pieces of this role.
    pub(crate) fn takes(self, role: Role) -> bool {
        match role {
            Role::TopSkin => self != Self::Off,
            Role::BottomSkin => self == Self::All,
            _ => false,
        }
    }
}

/// Which roles come first inside a colour. Purge towers and skirts always do.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum RoleOrder {
    /// Whatever is nearest: the least travel.
    #[default]
    Any,
    /// Outer walls, then inner walls, then the rest: the truest outline.
    OuterFirst,
    /// Inner walls, then outer walls, then the rest: outer walls find something to lean on.
    InnerFirst,
}
