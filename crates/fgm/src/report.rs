use fgm_field::Design;
use fgm_gcode::{Machine, MachineKind, ProgressLines};
use fgm_sim::{Compensated, Fit};
use serde::Serialize;

use crate::{choice::Aim, purge::PurgeReport, stages::StageSeconds};

/// The figures of a slice.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Report {
    /// Of this program.
    pub version: &'static str,
    /// The design's name.
    pub design: String,
    /// The printer's name.
    pub printer: String,
    /// How the part became paths.
    pub strategy: String,
    /// Layers printed.
    pub layers: usize,
    /// Colours of the palette.
    pub colors: usize,
    /// Faces of one colour, over all layers. Where paths are sectioned straight from the field no
    /// faces are made: then the colours of each layer, which are the fewest faces it can have.
    pub faces: usize,
    /// Pieces of one colour.
    pub pieces: usize,
    /// Moves written, with and without extrusion.
    pub moves: u64,
    /// Laid down in all, the purge included, mm³.
    pub extruded_mm3: f64,
    /// Of the sliced layers: area times thickness, mm³.
    pub model_mm3: f64,
    /// Laid down in purge towers, mm³.
    pub purge_mm3: f64,
    /// Moved without extrusion, mm.
    pub travel_mm: f64,
    /// Commands that changed the colour.
    pub state_changes: u64,
    /// Pieces of one colour shorter than `palette.short_piece`.
    pub short_pieces: usize,
    /// Of the G-code.
    pub bytes: u64,
    /// How long the print takes, s.
    pub print_time_s: f64,
    /// Layers that were slowed so that they can cool.
    pub cooling: CoolingReport,
    /// The lines of the G-code that tell the progress: to be filled in where the output can be
    /// written over. Left as they are they are comments.
    #[serde(skip)]
    pub progress: ProgressLines,
    /// Each input material: name, volume mm³, length of filament m, mass g.
    pub materials: Vec<MaterialUse>,
    /// How long the seams between colours are; none without a zipper.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub zipper: Option<ZipperReport>,
    /// Where the old colour went, and what that saved; none where nothing is purged.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub purge: Option<PurgeReport>,
    /// How far the deposit is predicted to be from what it is to be; none for a printer without a
    /// transition.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub deposit: Option<DepositReport>,
    /// What the user should know.
    pub warnings: Vec<String>,
    /// Where the time of the slice went, s.
    pub seconds: StageSeconds,
}

/// Lengths over which beads of different colours touch, over all layers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct ZipperReport {
    /// With the zipper, mm.
    pub seam_mm: f64,
    /// The same paths cut straight along the palette's boundaries, mm.
    pub straight_mm: f64,
    /// What the zipper adds, mm.
    pub gained_mm: f64,
}

/// Layers slowed by `cooling.min_layer_time`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct CoolingReport {
    /// How many.
    pub slowed_layers: usize,
    /// What that adds to the time of the print, s.
    pub added_s: f64,
    /// Of them, those that take less than the least time even at `cooling.min_speed`.
    pub short_layers: usize,
}

/// How far what is laid down is predicted to be from the design, or from the colours of the part's
/// paths, over their volume. An error is that of a fraction; of more than two materials it is the root of half the
/// summed squares.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DepositReport {
    /// Whether commands were chosen for the deposit; else they are those of the look-ahead alone.
    pub compensated: bool,
    /// What the errors are from: the design's mixtures or the paths' colours.
    pub aim: Aim,
    /// For the printer's transition.
    #[serde(flatten)]
    pub fit: DepositFit,
    /// For transitions that are off by `compensation.uncertainty`: both volumes more, both less,
    /// the delay more and the change less, the delay less and the change more.
    pub off: Vec<DepositFit>,
    /// Volume of hidden infill that took the old colour, mm³; it is not part of the errors above.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub hidden_mm3: Option<f64>,
    /// Root mean square error there, from the design, with the commands written.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub hidden_rms: Option<f64>,
    /// Commands written.
    pub commands: u64,
}

/// Errors of a deposit by one transition.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct DepositFit {
    /// Before a change begins, mm³.
    pub delay_mm3: f64,
    /// During it, mm³.
    pub change_mm3: f64,
    /// Root mean square error with the look-ahead alone.
    pub rms_plain: f64,
    /// Root mean square error with the commands written.
    pub rms: f64,
}

impl DepositReport {
    pub(crate) fn new(compensated: bool, aim: Aim, done: &Compensated) -> Option<Self> {
        let fit = |fit: &Fit| DepositFit {
            delay_mm3: fit.transition.delay,
            change_mm3: fit.transition.length,
            rms_plain: fit.plain,
            rms: fit.told,
        };
        let (first, off) = done.fits.split_first()?;
        let off = off.iter().map(fit).collect();
        Some(Self {
            compensated,
            aim,
            fit: fit(first),
            off,
            hidden_mm3: done.hidden.map(|hidden| hidden.volume),
            hidden_rms: done.hidden.map(|hidden| hidden.told),
            commands: done.commands,
        })
    }
}

/// How much of one input material a print takes.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct MaterialUse {
    /// The material's name.
    pub name: String,
    /// mm³.
    pub volume_mm3: f64,
    /// Metres of filament.
    pub filament_m: f64,
    /// Grams, by the profile's density.
    pub mass_g: f64,
}

/// What each input of the machine takes.
///
/// A mixing machine's inputs are the design's materials; a tool changer's heads each carry a
/// colour; a foaming filament is one.
pub(crate) fn material_use(
    design: &Design,
    machine: &Machine,
    filament_mm3: &[f64],
) -> Vec<MaterialUse> {
    let name = |input: usize| match machine.kind {
        MachineKind::Mixing => design.materials.get(input).map(|m| m.name.clone()),
        MachineKind::ToolChanger => Some(format!("head {input}")),
        MachineKind::Foaming => Some("foaming filament".to_owned()),
    };
    let named = filament_mm3.iter().enumerate().filter_map(|(i, volume)| Some((name(i)?, *volume)));
    named
        .map(|(name, volume_mm3)| MaterialUse {
            name,
            volume_mm3,
            filament_m: volume_mm3 / machine.filament_area() / 1000.0,
            mass_g: volume_mm3 * machine.filament_density / 1000.0,
        })
        .collect()
}
