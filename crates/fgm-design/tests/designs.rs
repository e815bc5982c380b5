//! The designs of the repository: where they are, how large, and what they are made of.

#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stderr)]

use std::path::{Path, PathBuf};

use fgm_core::{Bounds3, Point3};
use fgm_design::{LoadOptions, Loaded, load};
use fgm_field::{Design, Geometry};

fn file(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../designs").join(name)
}

fn design(name: &str) -> Option<Design> {
    let path = file(name);
    if !path.exists() {
        eprintln!("skipped: {} is not here", path.display());
        return None;
    }
    let Loaded { design, warnings } = load(&path, &LoadOptions::default()).unwrap();
    assert!(warnings.is_empty(), "{warnings:?}");
    Some(design)
}

/// The volume by the share of points of a lattice that are inside, mm³.
fn volume(design: &Design, steps: usize) -> f64 {
    let Geometry::Field(field) = &design.geometry else { panic!("not a field") };
    let Bounds3 { min, .. } = design.bounds;
    let size = design.bounds.size();
    let at = |i: usize| (i as f64 + 0.5) / steps as f64;
    let mut inside = 0;
    let mut values = vec![0.0; steps];
    for k in 0..steps * steps {
        let (y, z) = (at(k % steps), at(k / steps));
        let row: Vec<_> = (0..steps).map(|i| min + size * Point3::new(at(i), y, z)).collect();
        field.eval_into(&row, &mut values);
        inside += values.iter().filter(|v| **v <= 0.0).count();
    }
    size.element_product() * inside as f64 / (steps * steps * steps) as f64
}

struct Expected {
    name: &'static str,
    min: [f64; 3],
    max: [f64; 3],
    volume: f64,
    materials: &'static [&'static str],
    /// Points and the first material's fraction there.
    fractions: &'static [([f64; 3], f64)],
}

#[test]
fn bounds_volumes_and_fractions() {
    use std::f64::consts::PI;
    let two: &[&str] = &["blue", "yellow"];
    let ring = PI * (50.0 * 50.0 - 15.0 * 15.0);
    // Rectangle less twice: the waist, and the space beside each of four fillets.
    let rise = (76.0_f64 * 76.0 - 73.0 * 73.0).sqrt();
    let fillet = 76.0 * rise - 0.5 * (rise * 73.0 + 76.0 * 76.0 * (rise / 76.0).asin());
    let dogbone = 1.6 * (165.0 * 19.0 - 57.0 * 6.0 - 4.0 * (3.0 * rise - fillet));
    let table = [
        Expected {
            name: "cylinder-z.vcad",
            min: [-15.0, -15.0, 0.0],
            max: [15.0, 15.0, 70.0],
            volume: PI * 15.0 * 15.0 * 70.0,
            materials: two,
            fractions: &[([3.0, 2.0, 17.5], 0.25), ([0.0, 0.0, 70.0], 1.0)],
        },
        Expected {
            name: "plate-y.vcad",
            min: [-75.0, -37.5, -1.25],
            max: [75.0, 37.5, 1.25],
            volume: 150.0 * 75.0 * 2.5,
            materials: two,
            fractions: &[([50.0, 0.0, 1.0], 0.5), ([0.0, -37.5, 0.0], 0.0)],
        },
        Expected {
            name: "ring-phi.vcad",
            min: [-50.0, -50.0, 0.0],
            max: [50.0, 50.0, 15.0],
            volume: ring * 15.0,
            materials: two,
            fractions: &[
                ([30.0, 0.0, 5.0], 0.0),
                ([0.0, -30.0, 5.0], 0.5),
                ([-30.0, 0.0, 5.0], 1.0),
            ],
        },
        Expected {
            name: "ring-rho.vcad",
            min: [-50.0, -50.0, 0.0],
            max: [50.0, 50.0, 10.0],
            volume: ring * 10.0,
            materials: two,
            fractions: &[([15.0, 0.0, 5.0], 0.0), ([0.0, 32.5, 5.0], 0.5)],
        },
        Expected {
            name: "vase.vcad",
            min: [-67.5, -87.5, 0.0],
            max: [67.5, 87.5, 100.0],
            volume: 1_122_953.0,
            materials: two,
            fractions: &[
                ([0.0, 0.0, 50.0], 0.5),
                ([30.0, 20.0, 5.0], (1.0 + 0.932_039_085_967 * 0.877_582_561_890) / 2.0),
            ],
        },
        Expected {
            name: "slab.vcad",
            min: [-67.5, -87.5, 0.0],
            max: [67.5, 87.5, 2.0],
            volume: 33_000.0,
            materials: two,
            fractions: &[([30.0, 20.0, 0.1], (1.0 + 0.932_039_085_967 * 0.877_582_561_890) / 2.0)],
        },
        Expected {
            name: "dogbone.vcad",
            min: [-82.5, -9.5, -0.8],
            max: [82.5, 9.5, 0.8],
            volume: dogbone,
            materials: two,
            fractions: &[([41.25, 0.0, 0.0], 0.75)],
        },
        Expected {
            name: "cube-eq2.vcad",
            min: [-25.0; 3],
            max: [25.0; 3],
            volume: 125_000.0,
            materials: two,
            fractions: &[([6.25, 0.0, 6.25], 1.0), ([6.25, 12.5, 6.25], 0.0)],
        },
        Expected {
            name: "tube.vcad",
            min: [-20.0, -20.0, 0.0],
            max: [20.0, 20.0, 40.0],
            volume: PI * (400.0 - 144.0) * 40.0,
            materials: two,
            fractions: &[
                ([12.0, 0.0, 0.0], 1.0),
                ([0.0, 16.0, 20.0], 0.5),
                ([-20.0, 0.0, 40.0], 0.0),
            ],
        },
        Expected {
            name: "three-materials.vcad",
            min: [-40.0, -40.0, 0.0],
            max: [40.0, 40.0, 3.0],
            volume: PI * 1600.0 * 3.0,
            materials: &["red", "yellow", "blue"],
            fractions: &[([0.0, 0.0, 1.0], 1.0 / 3.0), ([0.0, 40.0, 1.0], 1.0)],
        },
        Expected {
            name: "nonlinear.vcad",
            min: [-50.0, -12.5, -1.5],
            max: [50.0, 12.5, 1.5],
            volume: 100.0 * 25.0 * 3.0,
            materials: two,
            fractions: &[([0.0, 0.0, 0.0], 0.125), ([50.0, 3.0, 0.0], 1.0)],
        },
    ];
    for expected in &table {
        let Some(design) = design(expected.name) else { continue };
        let name = expected.name;
        assert_eq!(format!("{}.vcad", design.name), name);
        let (min, max) = (Point3::from(expected.min), Point3::from(expected.max));
        let off = (design.bounds.min - min).abs().max((design.bounds.max - max).abs());
        assert!(off.max_element() < 1e-9, "{name}: {:?}", design.bounds);
        let volume = volume(&design, 64);
        let share = volume / expected.volume;
        assert!((share - 1.0).abs() < 0.02, "{name}: {volume} for {}", expected.volume);
        let names: Vec<_> = design.materials.iter().map(|m| m.name.as_str()).collect();
        assert_eq!(names, expected.materials, "{name}");
        assert!(design.materials.iter().all(|m| m.color.is_some()), "{name}");
        for (p, fraction) in expected.fractions {
            let mixture = design.fractions.mixture(Point3::from(*p)).unwrap();
            let found = mixture.fractions()[0];
            assert!((found - fraction).abs() < 1e-9, "{name} at {p:?}: {found}");
        }
    }
}

#[test]
fn the_slab_is_the_top_of_the_vase() {
    let (Some(vase), Some(slab)) = (design("vase.vcad"), design("slab.vcad")) else { return };
    let (Geometry::Field(vase_field), Geometry::Field(slab_field)) = (vase.geometry, slab.geometry)
    else {
        panic!("not fields")
    };
    for i in 0..2000 {
        let t = f64::from(i);
        let p = Point3::new(
            (t * 0.37).sin() * 80.0,
            (t * 0.91).cos() * 100.0,
            0.01 + t % 198.0 / 100.0,
        );
        let above = p + Point3::Z * 98.0;
        let (a, b) = (slab_field.eval(p), vase_field.eval(above));
        assert_eq!(a > 0.0, b > 0.0, "at {p}");
        let (a, b) = (slab.fractions.mixture(p).unwrap(), vase.fractions.mixture(above).unwrap());
        assert!(a.distance(&b) < 1e-12, "at {p}");
    }
}

#[test]
fn the_vase_changes_by_about_one_per_millimetre_at_its_surface() {
    let Some(vase) = design("vase.vcad") else { return };
    let Geometry::Field(field) = &vase.geometry else { panic!("not a field") };
    for i in 0..500 {
        let (angle, z) = (f64::from(i) * 0.7, f64::from(i % 97) + 1.5);
        // From the middle outwards to the surface.
        let (mut inside, mut outside) = (0.0, 100.0);
        let at = |r: f64| Point3::new(angle.cos() * r, angle.sin() * r, z);
        for _ in 0..60 {
            let middle = 0.5 * (inside + outside);
            *(if field.eval(at(middle)) <= 0.0 { &mut inside } else { &mut outside }) = middle;
        }
        let p = at(inside);
        let slope = Point3::from_array(std::array::from_fn(|k| {
            let mut step = Point3::ZERO;
            step[k] = 1e-5;
            (field.eval(p + step) - field.eval(p - step)) / 2e-5
        }));
        assert!((0.7..1.4).contains(&slope.length()), "{} at {p}", slope.length());
    }
}

#[test]
fn the_vase_is_the_model() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/models/vase.stl");
    let Ok(bytes) = std::fs::read(&path) else {
        eprintln!("skipped: {} is not here", path.display());
        return;
    };
    let Some(vase) = design("vase.vcad") else { return };
    let Geometry::Field(field) = &vase.geometry else { panic!("not a field") };
    let mesh = fgm_design::read_stl(&bytes).unwrap();
    let mut off = vec![0.0; mesh.vertices.len()];
    field.eval_into(&mesh.vertices, &mut off);
    // The two middles of bottom and top lie on the surface too.
    let worst = off.iter().fold(0.0_f64, |worst, v| worst.max(v.abs()));
    assert!(worst < 1e-4, "{worst} mm");
}
