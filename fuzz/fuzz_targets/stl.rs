//! Any bytes are read as an STL or refused.
#![no_main]

use fgm_design::read_stl;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    if let Ok(mesh) = read_stl(bytes) {
        let vertices = mesh.vertices.len() as u32;
        assert!(mesh.triangles.iter().flatten().all(|&i| i < vertices));
        assert!(mesh.vertices.iter().all(|v| v.is_finite()));
    }
});
