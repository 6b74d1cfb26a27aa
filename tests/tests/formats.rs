//! Exported curves read back by readers that share no code with the writers, in all formats alike.

#![allow(clippy::unwrap_used, clippy::panic, reason = "helpers of tests are tests, which clippy cannot see")]

use serde_json::Value;
use std::process::Command;
use tests::{Program, asset, skip};

/// A curve as a format has it: whether it is closed, and its points.
type Curve = (bool, Vec<[f32; 3]>);

/// The curves of a flat piece (one yarn with ends) and of a tube (rings), exported in all formats as `yarn.*`.
fn exported(name: &str, width: &str) -> Program {
    let program = Program::new(env!("CARGO_BIN_EXE_purlwise-tested"));
    program.json(&["new", &asset(name), "-o", "a.purl", "--stitch-size", width]);
    program.json(&["simulate", "a.purl", "-o", "a.purl", "--seconds", "0.02"]);
    for format in ["bcc", "obj", "usda"] {
        program.json(&["export", "a.purl", "-o", &format!("yarn.{format}")]);
    }
    program
}

/// Reads BCC. Every byte has to be accounted for.
fn read_bcc(mut file: &[u8]) -> Result<Vec<Curve>, String> {
    fn take<const N: usize>(file: &mut &[u8]) -> Result<[u8; N], String> {
        let (head, rest) = file.split_first_chunk().ok_or("it ends too early")?;
        *file = rest;
        Ok(*head)
    }
    let file = &mut file;
    if &take::<8>(file)? != b"BCC\x44C0\x03\x01" {
        return Err("not four-byte uniform Catmull-Rom curves in three dimensions, Y up".into());
    }
    let count = u64::from_le_bytes(take(file)?);
    let total = u64::from_le_bytes(take(file)?);
    let info: [u8; 40] = take(file)?;
    assert!(info.is_ascii() && info.ends_with(&[0]));
    let mut curves = Vec::new();
    for _ in 0..count {
        let n = i32::from_le_bytes(take(file)?);
        let mut points = Vec::new();
        for _ in 0..n.unsigned_abs() {
            let mut point = [0.0; 3];
            for x in &mut point {
                *x = f32::from_le_bytes(take(file)?);
            }
            points.push(point);
        }
        curves.push((n < 0, points));
    }
    if !file.is_empty() {
        return Err(format!("{} bytes are left over", file.len()));
    }
    let points: usize = curves.iter().map(|(_, p)| p.len()).sum();
    if points as u64 != total {
        return Err(format!("{points} points instead of {total}"));
    }
    Ok(curves)
}

/// Takes off what BCC adds to the ends of open curves, whose first and last span readers do not draw.
fn without_padding(curves: Vec<Curve>) -> Vec<Curve> {
    let strip = |(closed, points): Curve| match closed {
        true => (closed, points),
        false => (closed, points[1..points.len() - 1].to_vec()),
    };
    curves.into_iter().map(strip).collect()
}

/// Reads the lines of an OBJ.
fn read_obj(text: &str) -> Vec<Curve> {
    let mut points: Vec<[f32; 3]> = Vec::new();
    let mut curves = Vec::new();
    for line in text.lines() {
        let mut words = line.split_whitespace();
        match words.next() {
            Some("v") => {
                let numbers: Vec<f32> = words.map(|w| w.parse().unwrap()).collect();
                points.push(numbers.try_into().unwrap());
            }
            Some("l") => {
                let mut line: Vec<usize> = words.map(|w| w.parse().unwrap()).collect();
                let closed = line.first() == line.last();
                line.truncate(line.len() - usize::from(closed));
                curves.push((closed, line.into_iter().map(|i| points[i - 1]).collect()));
            }
            _ => {}
        }
    }
    curves
}

fn bytes_of(program: &Program, name: &str) -> Vec<Curve> {
    without_padding(read_bcc(&program.read(name)).unwrap())
}

#[test]
fn bcc_and_obj_hold_the_same_curves_to_the_last_byte() {
    for (name, width, closed) in [("swatch", "24", false), ("cowl", "40", true)] {
        let program = exported(name, width);
        let curves = bytes_of(&program, "yarn.bcc");
        assert!(curves.iter().all(|(c, points)| *c == closed && points.len() > 30), "{name}");
        assert_eq!(curves, read_obj(std::str::from_utf8(&program.read("yarn.obj")).unwrap()), "{name}");
    }
}

#[test]
fn the_bcc_reader_finds_a_byte_too_few_or_too_many() {
    let program = exported("swatch", "24");
    let file = program.read("yarn.bcc");
    assert!(read_bcc(&file).is_ok());
    assert!(read_bcc(&file[..file.len() - 1]).is_err());
    assert!(read_bcc(&[file.as_slice(), &[0]].concat()).is_err());
    let mut wrong_total = file;
    wrong_total[16] ^= 1;
    assert!(read_bcc(&wrong_total).is_err());
}

/// Prints what Pixar's own library finds in a stage.
const READ_USD: &str = r"
import json, sys
from pxr import Usd, UsdGeom
stage = Usd.Stage.Open(sys.argv[1])
prims = [UsdGeom.BasisCurves(p) for p in stage.Traverse() if p.IsA(UsdGeom.BasisCurves)]
print(json.dumps({
    'metres': UsdGeom.GetStageMetersPerUnit(stage),
    'up': str(UsdGeom.GetStageUpAxis(stage)),
    'root': str(stage.GetDefaultPrim().GetPath()),
    'prims': [{
        'wrap': c.GetWrapAttr().Get(),
        'kind': [c.GetTypeAttr().Get(), c.GetBasisAttr().Get()],
        'counts': list(c.GetCurveVertexCountsAttr().Get()),
        'points': [list(p) for p in c.GetPointsAttr().Get()],
        'widths': list(c.GetWidthsAttr().Get()),
        'extent_holds': all(
            low <= x <= high for p in c.GetPointsAttr().Get() for low, x, high in zip(*[c.GetExtentAttr().Get()[0], p, c.GetExtentAttr().Get()[1]])
        ),
    } for c in prims],
}))
";

/// What Pixar's library reads, or None where it is not installed.
fn open_in_usd(program: &Program) -> Option<Value> {
    let python = |arguments: &[&str]| Command::new("python3").args(arguments).output();
    if !python(&["-c", "import pxr"]).is_ok_and(|o| o.status.success()) {
        skip("usd: python3 with usd-core (PyPI) is not here");
        return None;
    }
    let output = python(&["-c", READ_USD, &program.path("yarn.usda").display().to_string()]).unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    Some(serde_json::from_slice(&output.stdout).unwrap())
}

#[test]
fn usd_opens_in_its_own_library_with_the_same_points() {
    for (name, width, wrap) in [("swatch", "24", "pinned"), ("cowl", "40", "periodic")] {
        let program = exported(name, width);
        let Some(stage) = open_in_usd(&program) else { return };
        assert_eq!((stage["metres"].as_f64(), stage["up"].as_str()), (Some(1.0), Some("Y")));
        assert_eq!(stage["root"], "/Yarn");
        let [prim] = stage["prims"].as_array().unwrap().as_slice() else { panic!("{}", stage["prims"]) };
        assert_eq!(
            (&prim["wrap"], &prim["kind"]),
            (&wrap.into(), &serde_json::json!(["cubic", "catmullRom"]))
        );
        assert_eq!(prim["extent_holds"], true);
        let width = prim["widths"][0].as_f64().unwrap();
        assert!((1e-3..2e-2).contains(&width), "a diameter in metres: {width}");

        let curves = bytes_of(&program, "yarn.bcc");
        let counts: Vec<usize> = curves.iter().map(|(_, points)| points.len()).collect();
        assert_eq!(prim["counts"], serde_json::json!(counts));
        let points: Vec<[f32; 3]> = serde_json::from_value(prim["points"].clone()).unwrap();
        assert_eq!(points, curves.into_iter().flat_map(|(_, points)| points).collect::<Vec<_>>());
    }
}
