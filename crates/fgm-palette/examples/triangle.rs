//! Prints the nine colours of three materials in the order of printing.
#![allow(clippy::print_stdout)]

use fgm_palette::{Palette, PaletteError};

fn main() -> Result<(), PaletteError> {
    let palette = Palette::new(3, 9)?;
    println!("fractions change colour at {:.4?}", palette.levels(0));
    let mut last = None;
    for id in palette.order(0) {
        let state = palette.state(id);
        let change = last.map_or(0.0, |last| state.distance(&last));
        println!("colour {}: {:.4?}, a change of {change:.4}", id.0, state.fractions());
        last = Some(state);
    }
    Ok(())
}
