use super::{CheckDesign, CheckOptions, CoverageFigures, region};
use crate::{Coverage, LayerFigures, Picture, Piece, Shades, SimError, picture::Painter};

/// Heights of layers closer than this are one, mm: relative moves add up their rounding.
const SAME: f64 = 1e-6;

/// What is looked at a layer at a time: coverage and pictures.
pub(super) struct Layers<'a> {
    design: Option<&'a CheckDesign<'a>>,
    options: &'a CheckOptions,
    coverage: Option<Coverage>,
    painter: Painter,
    now: Option<Now>,
    figures: Vec<LayerFigures>,
}

/// The layer under way.
#[derive(Clone, Copy)]
struct Now {
    layer: u32,
    /// Beads' tops and thickness, mm.
    z: f64,
    height: f64,
    painted: bool,
}

impl<'a> Layers<'a> {
    pub(super) fn new(
        options: &'a CheckOptions,
        shades: Shades,
        design: Option<&'a CheckDesign<'a>>,
    ) -> Result<Self, SimError> {
        Ok(Self {
            design,
            options,
            coverage: options.cell.map(Coverage::new).transpose()?,
            painter: Painter::new(shades, options.pixel),
            now: None,
            figures: Vec::new(),
        })
    }

    #[inline]
    pub(super) fn piece(&mut self, piece: &Piece) {
        let Some(layer) = piece.layer else { return };
        let painted = match self.now {
            Some(now) if now.layer == layer && now.z >= piece.to.z - SAME => now.painted,
            // Where beads of a layer lie at several heights, the highest part of it counts.
            _ if piece.is_part() || self.now.is_none() => {
                let painted = self.options.pictures.contains(&layer);
                let (z, height) = (piece.to.z, piece.height);
                self.now = Some(Now { layer, z, height, painted });
                painted
            }
            Some(now) => now.painted,
            None => false,
        };
        if let Some(coverage) = &mut self.coverage {
            coverage.piece(piece);
        }
        if painted {
            self.painter.piece(piece);
        }
    }

    /// The layer is complete.
    pub(super) fn finish(
        &mut self,
        show: &mut dyn FnMut(&Picture) -> Result<(), SimError>,
    ) -> Result<(), SimError> {
        let Some(now) = self.now.take() else { return Ok(()) };
        let measured = self.coverage.as_ref().and_then(Coverage::height);
        if measured.is_none() && !now.painted {
            return Ok(());
        }
        let heights = (now.z, now.height);
        let region = self.design.map(|d| region(d, now.layer, heights)).transpose()?;
        if let Some(coverage) = &mut self.coverage {
            self.figures.extend(coverage.finish(region.as_deref())?);
        }
        if now.painted {
            let design = self.design.map(|d| &d.reference).zip(region.as_deref());
            for picture in self.painter.finish(now.layer, design, heights)? {
                show(&picture)?;
            }
        }
        Ok(())
    }

    /// What was measured: over all layers, and each.
    pub(super) fn figures(self) -> (Option<CoverageFigures>, Vec<LayerFigures>) {
        (CoverageFigures::over(&self.figures), self.figures)
    }
}
