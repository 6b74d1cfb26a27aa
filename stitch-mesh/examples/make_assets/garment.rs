//! Garments in pieces: a front and a back of one cut, sleeves, and the script that labels, knits and sews them.
//!
//! Every piece is a sheet of quadrilaterals in rows that go up from its cast-on, drawn where it lies when the garment is worn: along a
//! seam the vertices of both pieces coincide. Front and back are a tube of superellipses to the underarm; above it they lean to
//! a common shoulder line while their sides bow apart and make the armhole. A sleeve begins with the armhole and turns into a
//! cone along the arm.

use crate::mesh::Mesh;
use glam::{DVec2, DVec3};
use std::f64::consts::{FRAC_PI_2, PI};
use std::fmt::Write as _;

/// Measures of a garment: lengths in metres, the rest in faces.
pub struct Garment {
    /// Half the width and half the depth of the body.
    half: DVec2,
    /// Height of the underarm over the hem.
    underarm: f64,
    /// Outer end of the shoulder line: half the width there, and its height.
    tip: DVec2,
    /// Its inner end, at the neck.
    neck: DVec2,
    /// Half the depth of the armhole.
    bow: f64,
    /// Across the front, and across the back.
    across: i32,
    /// From hem to underarm, and from there to the shoulder.
    rows: [i32; 2],
    /// From the side to the neck.
    strap: i32,
    /// Over the underarm where the neck begins, in front and at the back.
    neck_from: [i32; 2],
    /// How far the neck is lower in the middle, in front and at the back [m].
    scoop: [f64; 2],
    /// The sleeves, if it has any.
    sleeve: Option<Sleeve>,
    /// Rows from the hem, two of each to be knitted.
    chart: &'static str,
    /// A material by its name.
    yarn: &'static str,
}

/// Measures of a sleeve.
struct Sleeve {
    /// Along the arm [m].
    length: f64,
    /// How far the arm hangs below the horizontal [rad].
    slope: f64,
    /// Radius near the armhole, and of the cuff [m].
    radius: [f64; 2],
    /// From cuff to armhole [faces].
    rows: i32,
}

/// A slim youth's sweater: about 56 000 loops at 6.5 stitches an inch.
pub const SWEATER: Garment = Garment {
    half: DVec2::new(0.158, 0.112),
    underarm: 0.30,
    tip: DVec2::new(0.197, 0.452),
    neck: DVec2::new(0.076, 0.492),
    bow: 0.062,
    across: 12,
    rows: [7, 4],
    strap: 4,
    neck_from: [3, 3],
    scoop: [0.030, 0.006],
    sleeve: Some(Sleeve { length: 0.40, slope: 0.5, radius: [0.058, 0.038], rows: 9 }),
    chart: GARTER,
    yarn: "sweater",
};

/// A sleeveless shirt for the same youth: about 325 000 loops at 20 stitches an inch.
pub const T_SHIRT: Garment = Garment {
    half: DVec2::new(0.157, 0.110),
    underarm: 0.33,
    tip: DVec2::new(0.140, 0.500),
    neck: DVec2::new(0.085, 0.520),
    bow: 0.062,
    across: 12,
    rows: [7, 4],
    strap: 3,
    neck_from: [2, 3],
    scoop: [0.035, 0.010],
    sleeve: None,
    chart: GARTER,
    yarn: "shirt",
};

const GARTER: &str = r#"["k","p"]"#;

/// Pieces by number.
const FRONT: i32 = 0;
const BACK: i32 = 1;
/// The sleeves, of the wearer's left and right.
const SLEEVES: [(i32, f64); 2] = [(2, 1.0), (3, -1.0)];

impl Garment {
    /// Writes the mesh, and the script beside it.
    pub fn write(&self, name: &str, what: &str) -> std::io::Result<()> {
        let (mesh, script) = self.make();
        mesh.write(name, what)?;
        std::fs::write(format!("assets/meshes/{name}.jsonl"), script)
    }

    fn make(&self) -> (Mesh, String) {
        let mut mesh = Mesh::default();
        for side in [FRONT, BACK] {
            self.panel(&mut mesh, side);
        }
        for (sleeve, (piece, out)) in self.sleeve.iter().flat_map(|s| SLEEVES.map(|which| (s, which))) {
            self.sleeve(&mut mesh, sleeve, piece, out);
        }
        let script = self.script(&mesh);
        (mesh, script)
    }

    /// Where vertex `i` of row `j` of the front or back is.
    fn on_panel(&self, i: i32, j: i32, side: i32) -> DVec3 {
        let part = |n: i32, of: i32| f64::from(n) / f64::from(of);
        let s = 2.0 * part(i, self.across) - 1.0;
        let t = part(j - self.rows[0], self.rows[1]).max(0.0); // 0 at the underarm, 1 on the shoulder
        let round = (s * FRAC_PI_2).sin();
        let neck = 1.0 - 2.0 * part(self.strap, self.across);
        // On the shoulder line the strap is cut evenly from neck to tip.
        let inner = self.neck.x / self.tip.x;
        let straight = match (s.abs() - neck) / (1.0 - neck) {
            beyond if beyond >= 0.0 => s.signum() * (inner + beyond * (1.0 - inner)),
            _ => inner * s / neck,
        };
        let half = self.half.x + t * (self.tip.x - self.half.x);
        let x = half * (round + t * (straight - round));
        let sloping = ((x.abs() - self.neck.x) / (self.tip.x - self.neck.x)).clamp(0.0, 1.0);
        let shoulder = self.neck.y + sloping * (self.tip.y - self.neck.y);
        let underarm = self.underarm;
        let y = if t > 0.0 { underarm + t * (shoulder - underarm) } else { part(j, self.rows[0]) * underarm };
        // The rows under the neck give way to it, the more the higher they are.
        let neck_row = self.rows[0] + self.neck_from[side as usize];
        let scoop = self.scoop[side as usize] * part(j.min(neck_row), neck_row).powi(2);
        let y = y - scoop * (1.0 - (s / neck).powi(2)).max(0.0);
        let middle = (s * FRAC_PI_2).cos().max(0.0).powf(0.6);
        let z = self.half.y * middle * (1.0 - t * t).sqrt() + self.bow * (1.0 - middle) * (PI * t).sin();
        DVec3::new(x, y, if side == FRONT { z } else { -z })
    }

    fn panel(&self, mesh: &mut Mesh, side: i32) {
        let [body, yoke] = self.rows;
        for j in 0..body + yoke {
            for i in 0..self.across {
                let at_neck = j >= body + self.neck_from[side as usize]
                    && (self.strap..self.across - self.strap).contains(&i);
                if at_neck {
                    continue;
                }
                let corners = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)];
                let mut face =
                    corners.map(|(i, j)| mesh.vertex([i, j, side], self.on_panel(i, j, side))).to_vec();
                if side == BACK {
                    face.reverse();
                }
                mesh.faces.push(face);
            }
        }
    }

    /// Faces around an armhole, from the underarm over the front to the shoulder and down the back.
    fn around(&self) -> i32 {
        2 * self.rows[1]
    }

    /// The vertex of a side at the armhole, counted around it.
    fn at_armhole(&self, i: i32, side: i32, out: f64) -> [i32; 3] {
        let up = if side == FRONT { i } else { self.around() - i };
        [if out > 0.0 { self.across } else { 0 }, self.rows[0] + up, side]
    }

    fn sleeve(&self, mesh: &mut Mesh, sleeve: &Sleeve, piece: i32, out: f64) {
        let around = self.around();
        let armhole: Vec<DVec3> = (0..=around)
            .map(|i| {
                let side = if i <= self.rows[1] { FRONT } else { BACK };
                let [i, j, side] = self.at_armhole(i, side, out);
                self.on_panel(i, j, side)
            })
            .collect();
        let middle = armhole[1..].iter().sum::<DVec3>() / f64::from(around);
        let (sin, cos) = sleeve.slope.sin_cos();
        let (along, up) = (DVec3::new(out * cos, -sin, 0.0), DVec3::new(out * sin, cos, 0.0));
        let mut at = |i: i32, k: i32| {
            let u = 1.0 - f64::from(k) / f64::from(sleeve.rows); // 0 at the armhole, 1 at the cuff
            let (sin, cos) = (2.0 * PI * f64::from(i) / f64::from(around)).sin_cos();
            let radius = sleeve.radius[0] + u * (sleeve.radius[1] - sleeve.radius[0]);
            let round = radius * (sin * DVec3::Z - cos * up);
            let t = (u / 0.4).min(1.0);
            let blend = t * t * (3.0 - 2.0 * t);
            let position =
                middle + u * sleeve.length * along + (armhole[i as usize] - middle).lerp(round, blend);
            mesh.vertex([i, k, piece], position)
        };
        let mut faces = Vec::new();
        for k in 0..sleeve.rows {
            for i in 0..around {
                let mut face = vec![at(i, k), at(i + 1, k), at(i + 1, k + 1), at(i, k + 1)];
                if out < 0.0 {
                    face.reverse();
                }
                faces.push(face);
            }
        }
        mesh.faces.extend(faces);
    }

    /// The commands that label, cut, knit and sew the mesh.
    fn script(&self, mesh: &Mesh) -> String {
        let [body, yoke] = self.rows;
        let (across, top) = (self.across, body + yoke);
        let around = self.around();
        let name = |key: [i32; 3]| mesh.named(key);
        let mut text = String::new();
        let mut begin = |a: [i32; 3], b: [i32; 3]| {
            let _ = writeln!(text, r#"{{"do":"fill_onwards","edge":[{},{}]}}"#, name(a), name(b));
        };
        begin([0, 0, FRONT], [1, 0, FRONT]);
        begin([0, 0, BACK], [1, 0, BACK]);
        let sleeves = self.sleeve.iter().flat_map(|s| SLEEVES.map(|(piece, out)| (s, piece, out)));
        sleeves.clone().for_each(|(_, piece, _)| begin([0, 0, piece], [1, 0, piece]));
        let _ = writeln!(text, r#"{{"do":"tessellate"}}"#);
        let _ = writeln!(text, r#"{{"do":"use_preset","preset":"{}"}}"#, self.yarn);
        let _ = writeln!(text, r#"{{"do":"set_chart","chart":{}}}"#, self.chart);
        let mut sew = |a: Vec<[i32; 3]>, b: Vec<[i32; 3]>| {
            let list = |side: Vec<[i32; 3]>| side.into_iter().map(|key| mesh.named(key)).collect::<Vec<_>>();
            let _ = writeln!(text, r#"{{"do":"sew","a":{:?},"b":{:?}}}"#, list(a), list(b));
        };
        // Sides, shoulders, armholes, then along the sleeves.
        for i in [0, across] {
            let side = |piece| (0..=body).map(|j| [i, j, piece]).collect();
            sew(side(FRONT), side(BACK));
        }
        for strap in [0..=self.strap, across - self.strap..=across] {
            let shoulder = |piece| strap.clone().map(|i| [i, top, piece]).collect();
            sew(shoulder(FRONT), shoulder(BACK));
        }
        for (sleeve, piece, out) in sleeves {
            for (side, half) in [(FRONT, 0..=yoke), (BACK, yoke..=around)] {
                let edge = half.clone().map(|i| [i, sleeve.rows, piece]).collect();
                sew(half.map(|i| self.at_armhole(i, side, out)).collect(), edge);
            }
            let end = |i| (0..=sleeve.rows).map(|k| [i, k, piece]).collect();
            sew(end(0), end(around));
        }
        text
    }
}
