//! Any text is read as a design or refused with a place inside it.
#![no_main]

use std::path::Path;

use fgm_design::{LoadOptions, parse_vcad};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    match parse_vcad(text, Path::new("/nowhere"), &LoadOptions::default()) {
        Ok(loaded) => {
            let design = &loaded.design;
            assert!(design.bounds.is_finite(), "{:?}", design.bounds);
            let _ = design.fractions.mixture(design.bounds.center());
        }
        Err(error) => {
            if let Some(place) = error.location() {
                assert!(place.span.start <= place.span.end);
                assert!(place.line >= 1 && place.column >= 1);
            }
            let _ = error.to_string();
        }
    }
});
