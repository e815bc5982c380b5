//! Strategy 2: every face filled against the gradient.

use fgm_core::{Band, Polygon, bead};
use fgm_toolpath::{AgainstOptions, Inset, Path, Piece, against, route};
use rayon::prelude::*;

use crate::{
    error::SliceError, graded::GradedLayer, job::Job, layers::Layer, stages::StageSeconds,
    stages::timed,
};

/// The pieces of a layer, a round for each face, before ordering.
pub(crate) fn routes(
    job: &Job<'_>,
    layer: &Layer,
    region: &[Polygon],
    seconds: &mut StageSeconds,
) -> Result<(Vec<Vec<Piece>>, usize), SliceError> {
    let settings = job.settings;
    let width = settings.layer.bead_width;
    // Faces are filled up to half a spacing from their border, so that neighbours' beads touch by
    // volume. The part's own border must lie half a width outside the bead instead.
    let shrink = 0.5 * (width - bead::spacing(width, layer.height));
    let region = timed(&mut seconds.toolpath, || job.inset.inset(region, shrink));
    let graded = GradedLayer::new(job, layer, &region, seconds)?;
    let (min_width, max_width) = settings.bead_widths();
    let options = AgainstOptions {
        fill: settings.against.fill,
        min_width,
        max_width,
        angle: settings.infill.angle.to_radians(),
        layer: layer.index,
        ..AgainstOptions::new(width, layer.height)
    };
    timed(&mut seconds.toolpath, || {
        let faces: Vec<_> = graded.faces().collect();
        let fill = |(band, face): &(Band, Polygon)| -> Vec<Piece> {
            let paths = against(std::slice::from_ref(face), &options, &job.inset);
            let simple = |path: Path| path.simplified(settings.contour.resolution);
            let paths = route(paths.into_iter().map(simple).collect(), width, layer.height);
            paths.into_iter().map(|path| path.in_color(band.first)).collect()
        };
        // In parallel, so that no thread waits while another fills the last layer.
        Ok((faces.par_iter().map(fill).collect(), faces.len()))
    })
}
