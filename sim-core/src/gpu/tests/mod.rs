//! The kernels: valid everywhere, and each against its twin on the CPU wherever there is an adapter, if only a software one.

mod agreement;
mod drawn;
mod factor;
mod failure;
mod rest;
mod scenes;
mod steps;

use super::device::GpuDevice;
use super::kernel::{SOURCES, Source, source};
use super::layout::{OFFSETS, RECORDS, prelude};
use std::sync::OnceLock;
use stitch_mesh::cable::Cable;
use stitch_mesh::dye::Dye;
use stitch_mesh::edge_counts::StitchSize;
use stitch_mesh::lay::lay;
use stitch_mesh::pieces::{from_rows, tube};
use stitch_mesh::stitch::Stitch;
use stitch_mesh::swatches::of_cable;
use stitch_mesh::weave::Woven;
use stitch_mesh::wrapping::Wrapping;
use stitch_mesh::yarn_net::YarnNet;
use wgpu::naga;

/// The device of all tests; none, and a line that says so, on a machine without any adapter.
fn device() -> Option<GpuDevice> {
    static DEVICE: OnceLock<Option<GpuDevice>> = OnceLock::new();
    let device = DEVICE.get_or_init(|| GpuDevice::open().ok());
    if device.is_none() {
        println!("SKIPPED: there is no GPU here, nor a software one");
    }
    device.clone()
}

/// The kernels with a mistake in one file.
fn spoilt(file: &str, right: &str, wrong: &str) -> Vec<Source> {
    let spoil = |&(name, text, stages): &Source| -> Source {
        if name != file {
            return (name, text, stages);
        }
        assert!(text.contains(right), "{right}");
        (name, text.replace(right, wrong).leak(), stages)
    };
    SOURCES.iter().map(spoil).collect()
}

/// Ten small fabrics, each of another construction.
fn ten_fabrics() -> Vec<(&'static str, YarnNet)> {
    let size = StitchSize::of_width(3e-3);
    let row = |symbols: &[&str]| -> Vec<Stitch> { symbols.iter().map(|s| s.parse().unwrap()).collect() };
    let flat = |of: &dyn Fn(usize, usize) -> &'static str| {
        let rows: Vec<Vec<Stitch>> =
            (0..5).map(|t| row(&(0..6).map(|s| of(s, t)).collect::<Vec<_>>())).collect();
        lay(&from_rows(&rows, size).unwrap())
    };
    let lace =
        |t: usize| if t.is_multiple_of(2) { row(&["k"; 6]) } else { row(&["d21k", "ky", "d21k", "ky"]) };
    let narrow = [row(&["k"; 9]), row(&["d123k"; 3]), row(&["k"; 3]), row(&["kpk"; 3])];
    let mut garter = flat(&|_, t| ["k", "p"][t % 2]);
    for contact in garter.contacts.iter_mut().step_by(3) {
        contact.wrapping = Wrapping { modulus: 2.0, angle: Some(0.6) };
    }
    let draft = "twill".parse().unwrap();
    let [warp, weft] = [[200, 0, 0], [0, 200, 0]].map(|rgb| Dye(rgb).into());
    let cloth =
        Woven { draft, ends: 6, picks: 5, spacing: 2e-3, warp, weft, middle: glam::DVec3::ZERO, flat: false };
    vec![
        ("stockinette", flat(&|_, _| "k")),
        ("garter of two wrappings", garter),
        ("rib", flat(&|s, _| ["k", "k", "p"][s % 3])),
        ("seed", flat(&|s, t| ["k", "p"][(s + t) % 2])),
        ("lace", lay(&from_rows(&(0..5).map(lace).collect::<Vec<_>>(), size).unwrap())),
        ("stacks", lay(&from_rows(&narrow, size).unwrap())),
        ("cable", lay(&of_cable(&[(0, Cable::cross(vec![], 2, 2, true))], 5, size).unwrap())),
        ("twisted", flat(&|s, _| ["k1", "p-1", "k", "p"][s % 4])),
        ("tube", lay(&tube(9, 4, size).unwrap())),
        ("woven", cloth.lay()),
    ]
}

#[test]
fn every_shader_is_valid() {
    for (name, text, stages) in SOURCES {
        let whole = source(text);
        let module = naga::front::wgsl::parse_str(&whole)
            .unwrap_or_else(|e| panic!("{name}: {}", e.emit_to_string(&whole)));
        let (flags, capabilities) = (naga::valid::ValidationFlags::all(), naga::valid::Capabilities::empty());
        if let Err(e) = naga::valid::Validator::new(flags, capabilities).validate(&module) {
            panic!("{name}: {}", e.emit_to_string(&whole));
        }
        let found: Vec<&str> = module.entry_points.iter().map(|e| e.name.as_str()).collect();
        assert_eq!(found, *stages, "{name}");
        // What every WebGPU device has.
        let storage = |v: &naga::GlobalVariable| matches!(v.space, naga::AddressSpace::Storage { .. });
        assert!(module.global_variables.iter().filter(|(_, v)| storage(v)).count() <= 8, "{name}");
    }
}

#[test]
fn an_invalid_shader_is_found() {
    let (_, text, _) = SOURCES[0];
    let spoilt = source(&text.replacen("array<vec4<f32>>", "array<vec4<f33>>", 1));
    assert!(naga::front::wgsl::parse_str(&spoilt).is_err());
}

#[test]
fn records_lie_in_wgsl_as_in_rust() {
    let text = prelude();
    let module = naga::front::wgsl::parse_str(&text).unwrap();
    for ((name, fields), (_, size, offsets)) in RECORDS.iter().zip(OFFSETS) {
        let (_, found) = module.types.iter().find(|(_, t)| t.name.as_deref() == Some(name)).unwrap();
        let naga::TypeInner::Struct { members, span } = &found.inner else { panic!("{name}") };
        assert_eq!(*span as usize, *size, "{name}");
        let theirs: Vec<(&str, usize)> =
            members.iter().map(|m| (m.name.as_deref().unwrap(), m.offset as usize)).collect();
        let ours: Vec<(&str, usize)> = fields.iter().zip(*offsets).map(|((f, _), o)| (*f, *o)).collect();
        assert_eq!(theirs, ours, "{name}");
    }
}

#[test]
fn constants_are_those_of_the_physics() {
    let text = prelude();
    for (name, value) in [
        ("BEND_JAM_FACTOR", crate::bend::JAM_FACTOR),
        ("SLIDING_MASS", crate::mass::SLIDING_MASS),
        ("NEAREST", crate::layers::NEAREST),
        ("LEAST_LENGTH", crate::local::LEAST_LENGTH),
    ] {
        assert!(text.contains(&format!("const {name}: f32 = {value:e};")), "{name}");
    }
    // None of them is typed into a kernel a second time.
    for (name, kernel, _) in SOURCES {
        assert!(!kernel.contains("1000.0") && !kernel.contains("1e-9"), "{name}");
    }
}
