/// What a bead is for. Speeds, fans and viewers go by it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum Role {
    /// The wall that is seen.
    OuterWall,
    /// The walls behind it.
    InnerWall,
    /// A wall with up to half of its width over air.
    SlightOverhang,
    /// A wall with more than half of its width over air.
    HalfOverhang,
    /// A wall over air.
    FullOverhang,
    /// Sparse filling.
    Infill,
    /// Full filling inside.
    SolidInfill,
    /// Full filling with nothing above.
    TopSkin,
    /// Full filling with nothing below.
    BottomSkin,
    /// Full filling over air.
    Bridge,
    /// Thin beads where nothing else fits.
    GapFill,
    /// Lines around the part on the first layer.
    Skirt,
    /// Held up by, not part of, the part.
    Support,
    /// Where the old colour goes.
    PurgeTower,
    /// Hidden filling of the part in which the old colour goes.
    PurgeInfill,
}

impl Role {
    /// Every role.
    pub const ALL: [Self; 15] = [
        Self::OuterWall,
        Self::InnerWall,
        Self::SlightOverhang,
        Self::HalfOverhang,
        Self::FullOverhang,
        Self::Infill,
        Self::SolidInfill,
        Self::TopSkin,
        Self::BottomSkin,
        Self::Bridge,
        Self::GapFill,
        Self::Skirt,
        Self::Support,
        Self::PurgeTower,
        Self::PurgeInfill,
    ];

    /// Whether the bead belongs to the part itself.
    pub fn is_part(self) -> bool {
        !matches!(self, Self::Skirt | Self::Support | Self::PurgeTower)
    }

    /// Whether the bead takes the old colour: its mixture is not the one it should have.
    pub fn is_purge(self) -> bool {
        matches!(self, Self::PurgeTower | Self::PurgeInfill)
    }

    /// Whether the bead lies behind walls and skins, where nobody sees its colour.
    pub fn is_hidden(self) -> bool {
        matches!(self, Self::Infill | Self::SolidInfill | Self::PurgeInfill)
    }

    /// How far a wall hangs over: 1 for up to half of its width over air, 2 for more, 3 for all of
    /// it; 0 for one that is held, and for what is no wall.
    pub fn overhang(self) -> usize {
        match self {
            Self::SlightOverhang => 1,
            Self::HalfOverhang => 2,
            Self::FullOverhang => 3,
            _ => 0,
        }
    }
}
