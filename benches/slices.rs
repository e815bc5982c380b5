//! Whole slices, from a loaded design to G-code in memory that is thrown away, with the settings
//! of the paper. The Benchy and the meshed vase need `FGM_MODELS` to name the folder they are in.

use std::io;

use criterion::{Criterion, criterion_group, criterion_main};
use fgm::{ColorCount, Quiet, Settings, Slicer, Strategy, field::Design, gcode::Machine};
use fgm_benches::{builtin, model};

const EQ1: &str = "(1 + sin(0.02x + 0.03y) cos(0.03x - 0.02y)) / 2";
const EQ2: &str = "1/2 + 1/2 sin(2pi x/25) cos(2pi y/25) sin(2pi z/25)";

fn slice(c: &mut Criterion, name: &str, printer: &str, design: &Design, settings: &Settings) {
    let machine = Machine::builtin(printer).expect("built in");
    let mut group = c.benchmark_group("slice");
    group.sample_size(10);
    group.bench_function(name, |b| {
        b.iter(|| Slicer::new(design, &machine, settings).slice(&mut io::sink(), &Quiet))
    });
    group.finish();
}

fn settings(strategy: Strategy, colors: usize) -> Settings {
    let mut settings = Settings::default();
    settings.slice.strategy = strategy;
    settings.palette.colors = Some(ColorCount::Count(colors));
    settings
}

fn slices(c: &mut Criterion) {
    let mut slab = settings(Strategy::Sectioned, 16);
    slab.infill.density = 100.0.into();
    let design = builtin("slab");
    slice(c, "slab, sectioned, 16 colors", "geeetech-mizar-m", &design, &slab);
    let against = settings(Strategy::Against, 48);
    slice(c, "slab, against, 48 colors", "geeetech-mizar-m", &design, &against);

    let mut vase = settings(Strategy::Sectioned, 16);
    vase.walls.count = 10;
    vase.infill.density = 0.0.into();
    slice(c, "vase, sectioned, 16 colors", "geeetech-mizar-m", &builtin("vase"), &vase);
    if let Some(mesh) = model("vase.stl", EQ1) {
        slice(c, "vase.stl, sectioned, 16 colors", "geeetech-mizar-m", &mesh, &vase);
    }
    if let Some(benchy) = model("3DBenchy.3mf", EQ2) {
        let against = settings(Strategy::Against, 5);
        slice(c, "3DBenchy.3mf, against, 5 colors", "prusa-xl-5t", &benchy, &against);
    }
}

criterion_group!(benches, slices);
criterion_main!(benches);
