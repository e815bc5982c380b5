//! Same input, same bytes out, whatever the number of threads.

mod common;

use common::{parse, settings};
use fgm::{Quiet, Slicer, Strategy, gcode::Machine};

const PART: &str = r#"fgrade(["0.5 + 0.5 sin(x/4) cos(y/5)", "0.5 - 0.5 sin(x/4) cos(y/5)"],
    ["a", "b"]) { difference() { sphere(12); cylinder(4, 12); } }"#;

#[test]
fn threads_do_not_change_the_output() {
    let design = parse(PART);
    let machine = Machine::builtin("generic-mixing").unwrap();
    for (strategy, zipper) in [(Strategy::Sectioned, "0.1"), (Strategy::Against, "0")] {
        let mut settings = settings(strategy, 5);
        settings.layer.height = 0.4;
        settings.layer.bead_width = 0.6;
        settings.palette.zipper = zipper.parse().unwrap();
        let gcode = |threads| {
            let mut out = Vec::new();
            let slicer = Slicer::new(&design, &machine, &settings).threads(threads);
            slicer.slice(&mut out, &Quiet).unwrap();
            out
        };
        let one = gcode(1);
        assert!(one.len() > 100_000);
        for threads in [1, 2, 5, 80] {
            assert!(gcode(threads) == one, "{strategy} on {threads} threads");
        }
    }
}
