//! Prints the section of a bead and the spacing of lines that fill a layer, for common sizes.

#![allow(clippy::print_stdout, reason = "an example shows what it does")]

use fgm_core::bead;

fn main() {
    println!("width  height  section mm2  spacing mm");
    for (width, height) in [(0.4, 0.1), (0.4, 0.2), (0.45, 0.2), (0.6, 0.3), (0.8, 0.4)] {
        let (area, spacing) = (bead::area(width, height), bead::spacing(width, height));
        println!("{width:5}  {height:6}  {area:11.5}  {spacing:10.5}");
    }
}
