//! Yarn laid out on the device for its renderer, against the curves of the CPU.

use super::{device, ten_fabrics};
use crate::curves::curves;
use crate::gpu::{GpuDevice, GpuSimulator};
use crate::material::Material;
use crate::scene::Scene;
use glam::Vec3;
use std::sync::Arc;

/// What `render` reads of a control point.
fn points(gpu: &GpuDevice, buffer: &wgpu::Buffer) -> Vec<[f32; 8]> {
    let bytes = gpu.read(&[(buffer, 0..buffer.size())]).unwrap().swap_remove(0);
    bytemuck::pod_collect_to_vec(&bytes)
}

/// Direction of the centripetal spline at the second of three control points.
fn tangent([a, b, c]: [Vec3; 3]) -> Vec3 {
    let (ab, bc) = (a.distance(b).sqrt(), b.distance(c).sqrt());
    ((b - a) / ab - (c - a) / (ab + bc) + (c - b) / bc).normalize()
}

#[test]
fn control_points_are_those_of_the_curves() {
    let Some(mut device) = device() else { return };
    device.draws = true;
    for (name, net) in ten_fabrics() {
        let net = Arc::new(net);
        let material = Material::for_loop_width(3e-3);
        let made = GpuSimulator::new(&device, &net, material, Scene::empty(), net.laid_state());
        let mut simulator = made.unwrap();
        (0..3).for_each(|_| {
            simulator.step().unwrap();
        });
        let yarn = simulator.device_yarn().unwrap().unwrap();
        let state = simulator.state().unwrap().clone();
        let expected = curves(&net, &state, simulator.materials());
        let found = points(&device, &yarn.points);
        let at = |i: usize| Vec3::from_slice(&found[i]);
        let mut runs = yarn.runs.iter();
        let mut first = 1;
        for curve in &expected.curves {
            let spans = curve.span_count();
            let mut length = 0.0;
            for i in 0..=spans {
                let n = first + i;
                let right = curve.points[i % curve.points.len()];
                assert!(at(n).distance(right) < 1e-6, "{name}: point {i} is {} m off", at(n).distance(right));
                let normal = Vec3::from_slice(&found[n][4..]);
                let along = tangent([at(n - 1), at(n), at(n + 1)]);
                let off = normal.dot(along).abs().max((normal.length() - 1.0).abs());
                assert!(off < 1e-3, "{name}: {normal} along {along}");
                let ends = !curve.closed && (i == 0 || i == spans);
                assert_eq!(found[n][7].to_bits(), n as u32 | u32::from(ends) << 31, "{name}: {i}");
                if i > 0 {
                    length += at(n).distance(at(n - 1));
                }
            }
            // The wool is as long as the yarn, which these small fabrics hardly stretch.
            let diameters = length / (2.0 * curve.radii[0]);
            let wool = found[first + spans][3] - found[first][3];
            assert!((wool / diameters - 1.0).abs() < 0.3, "{name}: {wool} {diameters}");
            let mut covered = 0;
            while covered < spans {
                let run = runs.next().unwrap();
                assert_eq!(run.first as usize, first + covered, "{name}");
                for n in 0..=run.spans as usize {
                    assert!(at(run.first as usize + n).distance(run.center) <= run.far * 1.001, "{name}");
                }
                covered += run.spans as usize;
            }
            assert_eq!(covered, spans, "{name}");
            first += spans + 4;
        }
        assert!(runs.next().is_none(), "{name}");
    }
}

#[test]
fn a_device_that_nobody_draws_on_keeps_nothing() {
    let Some(device) = device() else { return };
    let (_, net) = ten_fabrics().swap_remove(0);
    let net = Arc::new(net);
    let material = Material::for_loop_width(3e-3);
    let made = GpuSimulator::new(&device, &net, material, Scene::empty(), net.laid_state());
    assert!(made.unwrap().device_yarn().unwrap().is_none());
}
