//! The slicer for graded materials as one library: from a design to G-code.
//!
//! [`Slicer`] composes the crates below, plans layers in parallel and writes them as they come;
//! it tells its progress and can be stopped. Each part can be used alone.
//!
//! | module | crate | what it does |
//! |---|---|---|
//! | [`core`] | fgm-core | points, rings, mixtures, motions, seam traits |
//! | [`field`] | fgm-field | signed distances, expressions, volume fractions, `Design` |
//! | [`design`] | fgm-design | `.vcad`, STL, OBJ, 3MF to `Design` |
//! | [`contour`] | fgm-contour | outlines, isolines, sections of meshes |
//! | [`arrange`] | fgm-arrange | faces of a layer |
//! | [`palette`] | fgm-palette | mixture space divided into colours |
//! | [`toolpath`] | fgm-toolpath | walls, infill, sectioning, towers, order |
//! | [`gcode`] | fgm-gcode | machines, dialects, look-ahead, writer, reader |
//! | [`sim`] | fgm-sim | what the G-code really lays down, checked |
//!
//! Settings are in [`Settings`], listed in [`SETTINGS`]; figures come back in [`Report`].
//!
//! ```
//! use fgm::{Quiet, Settings, Slicer, design, gcode::Machine};
//!
//! let source = r#"fgrade(["z/4", "1 - z/4"], ["blue", "yellow"]) { cylinder(5, 4); }"#;
//! let loaded = design::parse_vcad(source, ".".as_ref(), &Default::default())?;
//! let machine = Machine::builtin("geeetech-mizar-m").ok_or("no such printer")?;
//! let mut settings = Settings::default();
//! settings.infill.density = 100.0.into();
//!
//! let mut gcode = Vec::new();
//! let report = Slicer::new(&loaded.design, &machine, &settings).slice(&mut gcode, &Quiet)?;
//! assert_eq!(report.layers, 20);
//! assert!(String::from_utf8(gcode)?.contains(";LAYER_CHANGE"));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod against;
mod ahead;
mod boundaries;
mod boundary_lines;
mod bridged;
mod choice;
mod colors;
mod cooling;
mod covers;
mod density;
mod error;
mod extent;
mod field_sections;
mod foot;
mod graded;
mod head;
mod heights;
mod inspect;
mod job;
mod layers;
mod machine;
mod onset;
mod outlines;
mod pipeline;
mod placement;
mod progress;
mod purge;
mod report;
mod rising_sections;
mod samples;
mod sectioned;
mod sections;
mod settings;
mod short_sections;
mod slicer;
mod spiral;
mod stages;
mod stream;
mod target;

pub use choice::{Aim, ChoiceError, ColorCount, SectionBy, Strategy, Zipper};
pub use colors::{material_colors, usual_colors};
pub use density::{Density, DensityError, DensityFormula};
pub use error::SliceError;
pub use head::machine_comments;
pub use inspect::{Inspection, MaterialRange, inspect};
pub use layers::{Layer, Layers};
pub use machine::machine;
pub use progress::{Progress, Quiet};
pub use purge::{PurgeInto, PurgeLayout, PurgeReport, PurgeSavings, Saving};
pub use report::{CoolingReport, DepositFit, DepositReport, MaterialUse, Report, ZipperReport};
pub use sections::Sections;
pub use settings::{
    AgainstSettings, BridgeSettings, BrimSettings, CompensationSettings, ContourSettings,
    InfillSettings, LayerSettings, LeadSettings, OrderSettings, PaletteSettings, PurgeSettings,
    SETTINGS, SettingError, SettingInfo, Settings, SkinSettings, SkirtSettings, SliceSettings,
    WallSettings,
};
pub use slicer::{MAX_THREADS, Slicer};
pub use stages::StageSeconds;

pub use fgm_arrange as arrange;
pub use fgm_contour as contour;
pub use fgm_core as core;
pub use fgm_design as design;
pub use fgm_field as field;
pub use fgm_gcode as gcode;
pub use fgm_palette as palette;
pub use fgm_sim as sim;
pub use fgm_toolpath as toolpath;
pub use fgm_toolpath::{FaceFill, Pattern};

/// The README's example runs as a test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
