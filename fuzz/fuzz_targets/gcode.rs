//! Any bytes are read as G-code without a panic, and every line is accounted for.
#![no_main]

use fgm_gcode::Reader;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let mut reader = Reader::new(bytes);
    while let Ok(Some(line)) = reader.next_line() {
        std::hint::black_box(&line);
    }
});
