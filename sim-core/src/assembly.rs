//! From elements to the linear system of a step.
//!
//! # Theory
//! One linearly implicit step solves [(1 + hα) M + h²K + hβK_d] v₁ = M v₀ − h∇V + (h² + hβ) K_t v_rigid for the velocities
//! v₁ at its end. K is the stiffness of all forces, K_d that of all but stretch (damped stretch makes the system ten times
//! harder and brakes the fabric), K_t the part that is not blind to rotations (`rigid.rs`; for stretch without its β).
//! Friction, bodies and pins touch single nodes and are added by the step itself.
//!
//! # Practice
//! Elements are evaluated and added up strip beside strip (`strips.rs`), which do not depend on the number of threads; so the sums
//! have the same bits whatever that is.

use crate::air;
use crate::friction::FrictionSpring;
use crate::gravity::Gravity;
use crate::local::{Element, point};
use crate::mass::mass;
use crate::material::Material;
use crate::model::{BendTerm, FROZEN, Model, SegmentTerm, WrapTerm};
use crate::solver::matrix::BlockMatrix;
use crate::strips::{Places, Share, Strip, share_out};
use crate::woven::ShearTerm;
use glam::DVec3;
use rayon::prelude::*;
use stitch_mesh::yarn_net::YarnState;

/// Where a step starts from.
#[derive(Clone, Copy)]
pub(crate) struct Start<'a> {
    /// Of each colour of the model.
    pub materials: &'a [Material],
    pub state: &'a YarnState,
    /// Acceleration of gravity [m/s²].
    pub gravity: DVec3,
    /// Density of the air [kg/m³].
    pub air: f64,
    /// ω of the rigid motion [rad/s].
    pub omega: DVec3,
    /// h [s].
    pub step: f64,
}

/// What an element adds to the system.
struct Contribution<const K: usize, const N: usize> {
    /// Part of the matrix, still to be multiplied by the next.
    matrix: [[f64; N]; N],
    by: f64,
    rhs: [f64; N],
    /// Force on its visits that counts for the normal force there [N].
    pull: [DVec3; K],
}

/// The linear system of a step.
pub(crate) struct System {
    pub matrix: BlockMatrix,
    /// Right-hand side [dof_count] [kg m/s].
    pub rhs: Vec<f64>,
    /// Stretch and bend force on each visit, node by node, each front to back, [visit_count] [N].
    pub pull: Vec<DVec3>,
    /// The strips, each with the elements in it.
    strips: Vec<(Strip, Share)>,
    /// The elements across strips.
    across: Share,
}

impl System {
    /// An empty system for `model`.
    pub fn new(model: &Model) -> Self {
        let matrix = BlockMatrix::new(model);
        let (strips, across) = share_out(model, &matrix);
        Self {
            strips,
            across,
            rhs: vec![0.0; model.dof_count()],
            pull: vec![DVec3::ZERO; model.sliding.len()],
            matrix,
        }
    }

    /// Fills the system with every force of the yarn itself.
    pub fn assemble(&mut self, model: &Model, start: Start) {
        let Self { matrix, rhs, pull, strips, across } = self;
        matrix.tail.clear();
        let (mut values, mut sides, mut pulls) = (&mut matrix.value[..], &mut rhs[..], &mut pull[..]);
        let mut sums = Vec::with_capacity(strips.len());
        for (strip, share) in &*strips {
            let (value, rhs, pull);
            (value, values) = values.split_at_mut(strip.entries.len());
            (rhs, sides) = sides.split_at_mut(strip.unknowns.len());
            (pull, pulls) = pulls.split_at_mut(strip.slots.len());
            sums.push((Sum { value, rhs, pull }, share));
        }
        let fill = |(sum, share): &mut (Sum, &Share)| {
            sum.clear();
            sum.add(model, share, start);
        };
        match &mut sums[..] {
            [one] => fill(one),
            many => many.par_iter_mut().for_each(fill),
        }
        Sum { value: &mut matrix.value, rhs, pull }.add(model, across, start);
    }
}

/// Friction.
impl System {
    /// Adds a spring on one sliding coordinate that is at `u`.
    pub fn add_spring(&mut self, dof: usize, spring: &FrictionSpring, u: f64, h: f64) {
        self.matrix.add_diagonal(dof, h * h * spring.stiffness);
        self.rhs[dof] -= h * spring.stiffness * (u - spring.anchor);
    }

    /// Adds a spring between two sliding coordinates of the node whose unknowns begin at `start`; `apart` is their difference.
    pub fn add_spring_between(
        &mut self,
        start: u32,
        dofs: [usize; 2],
        spring: &FrictionSpring,
        apart: f64,
        h: f64,
    ) {
        let force = h * spring.stiffness * (apart - spring.anchor);
        self.rhs[dofs[0]] -= force;
        self.rhs[dofs[1]] += force;
        dofs.iter().for_each(|dof| self.matrix.add_diagonal(*dof, h * h * spring.stiffness));
        let [column, row] = [dofs[0].min(dofs[1]), dofs[0].max(dofs[1])].map(|dof| dof as u32 - start);
        let place = self.matrix.place(start, 0, row, column);
        self.matrix.value[place] -= h * h * spring.stiffness;
    }
}

/// Elements to be added up, compiled for each width of vectors that processors have. Which of them runs makes no difference to the
/// bits, as nothing is fused or put into another order.
struct Adding<'a, 'b> {
    sum: &'a mut Sum<'b>,
    model: &'a Model,
    share: &'a Share,
    start: Start<'a>,
}

impl pulp::WithSimd for Adding<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) {
        self.sum.add_each(self.model, self.share, self.start);
    }
}

/// A part of a system that elements are added to.
struct Sum<'a> {
    value: &'a mut [f64],
    rhs: &'a mut [f64],
    pull: &'a mut [DVec3],
}

impl Sum<'_> {
    fn clear(&mut self) {
        self.value.fill(0.0);
        self.rhs.fill(0.0);
        self.pull.fill(DVec3::ZERO);
    }

    fn add(&mut self, model: &Model, share: &Share, start: Start) {
        pulp::Arch::new().dispatch(Adding { sum: self, model, share, start });
    }

    #[inline(always)]
    fn add_each(&mut self, model: &Model, share: &Share, start: Start) {
        for places in &share.segments {
            self.scatter(&segment(&model.segments[places.term as usize], start), places);
        }
        for places in &share.bends {
            self.scatter(&bend(&model.bends[places.term as usize], start), places);
        }
        for places in &share.wraps {
            self.scatter(&wrap(&model.wraps[places.term as usize], start), places);
        }
        for places in &share.shears {
            self.scatter(&shear(&model.shears[places.term as usize], start), places);
        }
    }

    #[inline(always)]
    fn scatter<const K: usize, const N: usize>(&mut self, add: &Contribution<K, N>, places: &Places<K>) {
        // Three unknowns of a position for each visit, and for some elements one of its yarn.
        let size = N / K;
        for b in 0..K {
            self.pull[places.slot[b] as usize] += add.pull[b];
            let start = places.start[b] as usize;
            let (slides, sliding) = (size == 4 && places.sliding[b] != FROZEN, places.sliding[b] as usize);
            let rhs = &mut self.rhs[start..start + 3];
            for j in 0..3 {
                rhs[j] += add.rhs[size * b + j];
            }
            if slides {
                self.rhs[start + sliding] += add.rhs[size * b + 3];
            }
            for a in 0..K {
                let [row, column] = [places.start[a], places.start[b]];
                if row < column {
                    continue;
                }
                let yarn = (size == 4 && places.sliding[a] != FROZEN).then_some(places.sliding[a] as usize);
                for j in 0..size {
                    if j == 3 && !slides {
                        continue;
                    }
                    let unknown = if j == 3 { sliding } else { j };
                    let first = places.block[a][b] as usize + places.column(b, unknown);
                    let entry = |i: usize| add.by * add.matrix[size * a + i][size * b + j];
                    if row > column {
                        let rows = &mut self.value[first..first + 3];
                        for i in 0..3 {
                            rows[i] += entry(i);
                        }
                    } else {
                        // In a diagonal block only the lower triangle is stored.
                        for i in j..3 {
                            self.value[first + i] += entry(i);
                        }
                    }
                    if let Some(yarn) = yarn.filter(|yarn| row > column || *yarn >= unknown) {
                        self.value[first + yarn] += entry(3);
                    }
                }
            }
        }
    }
}

/// Mass, stretch, gravity, and contact length or parallel contact.
#[inline(always)]
fn segment(
    term: &SegmentTerm,
    Start { materials, state, gravity, air, omega, step: h }: Start,
) -> Contribution<2, 8> {
    let material = &materials[term.dye as usize];
    let q: [f64; 8] = term.stencil.coordinates(state);
    let v: [f64; 8] = term.stencil.velocities(state);
    let mass = mass(material.density, &q);
    let stretch = term.stretch(material);
    let stretched = stretch.expand(&q);
    let spin = stretch.spin(&q, omega);
    let weight = Gravity { weight: material.density * gravity }.expand(&q);
    let spacing = term.spacing(material).expand(&[q[3], q[7]]);

    let speed = 0.5 * (point(&v, 0) + point(&v, 4)).length();
    let drag = air::drag(air, 2.0 * material.drawn_radius, speed);
    let by_mass = 1.0 + h * (material.mass_damping + drag / material.density);
    let mut out = Contribution { matrix: [[0.0; 8]; 8], by: 1.0, rhs: [0.0; 8], pull: [DVec3::ZERO; 2] };
    for i in 0..8 {
        for j in 0..8 {
            out.matrix[i][j] = by_mass * mass[i][j] + h * h * stretched.hessian[i][j];
            out.rhs[i] += mass[i][j] * v[j];
        }
        out.rhs[i] += h * (h * spin[i] - stretched.gradient[i] - weight.gradient[i]);
    }
    let damped = h * (h + material.stiffness_damping);
    for i in 0..2 {
        for j in 0..2 {
            out.matrix[4 * i + 3][4 * j + 3] += damped * spacing.hessian[i][j];
        }
        out.rhs[4 * i + 3] -= h * spacing.gradient[i];
    }
    out.pull = [0, 4].map(|at| -point(&stretched.gradient, at));
    out
}

#[inline(always)]
fn bend(term: &BendTerm, Start { materials, state, omega, step: h, .. }: Start) -> Contribution<3, 12> {
    let material = &materials[term.dye as usize];
    let q = term.stencil.coordinates(state);
    let bend = term.bend(material);
    let bent = bend.expand(&q);
    let spin = bend.spin(&q, omega);
    let damped = h * (h + material.stiffness_damping);
    Contribution {
        matrix: bent.hessian,
        by: damped,
        rhs: std::array::from_fn(|i| damped * spin[i] - h * bent.gradient[i]),
        pull: [0, 4, 8].map(|at| -point(&bent.gradient, at)),
    }
}

#[inline(always)]
fn wrap(term: &WrapTerm, Start { materials, state, step: h, .. }: Start) -> Contribution<4, 12> {
    let material = &materials[term.dye as usize];
    let wrapped = term.wrap(material).expand(&term.stencil.points(state));
    let damped = h * (h + material.stiffness_damping);
    Contribution {
        matrix: wrapped.hessian,
        by: damped,
        rhs: wrapped.gradient.map(|g| -h * g),
        pull: [DVec3::ZERO; 4],
    }
}

#[inline(always)]
fn shear(term: &ShearTerm, Start { materials, state, step: h, .. }: Start) -> Contribution<4, 12> {
    let shear = term.shear(materials);
    let sheared = shear.expand(&term.stencil.points(state));
    let damped =
        h * (h + 0.5 * term.dyes.map(|d| materials[d as usize].stiffness_damping).iter().sum::<f64>());
    let [front, behind] = term.press(materials, state);
    Contribution {
        matrix: sheared.hessian,
        by: damped,
        rhs: sheared.gradient.map(|g| -h * g),
        pull: [DVec3::ZERO, front, behind, DVec3::ZERO],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::materials::Materials;
    use crate::solver::factor::Factor;
    use crate::solver::gradients;
    use crate::solver::pattern::Pattern;
    use std::sync::Arc;
    use stitch_mesh::dye::Dye;
    use stitch_mesh::{edge_counts::StitchSize, lay::lay, pieces::tube, weave::Woven, wrapping::Wrapping};

    /// A tube, so that the seam of closed yarns is in it, some of it wrapped otherwise than its material has it, and woven cloth,
    /// crumpled and with their yarn slid.
    fn crumpled() -> (Model, YarnState) {
        let mut net = lay(&tube(5, 3, StitchSize::of_width(3e-3)).unwrap());
        for contact in net.contacts.iter_mut().step_by(3) {
            contact.wrapping = Wrapping { modulus: 20.0, angle: Some(0.6) };
        }
        let (draft, middle) = ("twill".parse().unwrap(), DVec3::X);
        let [warp, weft] = [[200, 0, 0], [0, 200, 0]].map(|rgb| Dye(rgb).into());
        let cloth = Woven { draft, ends: 5, picks: 4, spacing: 2e-3, warp, weft, middle, flat: false };
        net.append(cloth.lay());
        let net = Arc::new(net);
        let mut state = net.laid_state();
        let mut hash = (0..).map(|i| crate::noise::unit_hash(i) - 0.5);
        let mut noise = |size: f64| size * hash.next().unwrap();
        state.position.iter_mut().for_each(|x| *x += DVec3::new(noise(3e-4), noise(3e-4), noise(3e-4)));
        state.sliding.iter_mut().for_each(|u| *u += noise(1e-4));
        (Model::new(net).unwrap(), state)
    }

    #[test]
    fn right_hand_side_is_the_force_of_the_whole_net() {
        let (model, state) = crumpled();
        let material = Material::for_loop_width(3e-3);
        let mut system = System::new(&model);
        let step = 1e-3;
        let materials = Materials::from(material);
        let start = Start {
            materials: &model.resolve(&materials),
            state: &state,
            gravity: DVec3::ZERO,
            air: 0.0,
            omega: DVec3::ZERO,
            step,
        };
        system.assemble(&model, start);
        let largest = system.rhs.iter().fold(0.0, |m: f64, f| m.max(f.abs())) / step;
        let slope = |change: &dyn Fn(&mut YarnState, f64)| {
            let at = |h: f64| {
                let mut moved = state.clone();
                change(&mut moved, h);
                model.energies(&materials, &moved).elastic()
            };
            (at(-2e-8) - 8.0 * at(-1e-8) + 8.0 * at(1e-8) - at(2e-8)) / 12e-8
        };
        for node in (0..model.net.nodes.len()).step_by(7) {
            for axis in 0..3 {
                let force = system.rhs[model.start[node] as usize + axis] / step;
                let expected = -slope(&|s, h| s.position[node][axis] += h);
                assert!((force - expected).abs() < 1e-4 * largest, "node {node}: {force} {expected}");
            }
        }
        for visit in (0..model.net.visits.len()).step_by(11).filter(|v| model.sliding[*v] != FROZEN) {
            let force = system.rhs[model.sliding[visit] as usize] / step;
            let expected = -slope(&|s, h| s.sliding[visit] += h);
            assert!((force - expected).abs() < 1e-4 * largest, "visit {visit}: {force} {expected}");
        }
    }

    #[test]
    fn factors_solve_the_assembled_system() {
        let (model, state) = crumpled();
        let material = Material::for_loop_width(3e-3);
        let mut system = System::new(&model);
        let start = Start {
            materials: &model.resolve(&material.into()),
            state: &state,
            gravity: DVec3::NEG_Y,
            air: 1.2,
            omega: DVec3::ZERO,
            step: 5e-3,
        };
        system.assemble(&model, start);
        let mut solution = vec![0.0; system.rhs.len()];
        let mut factor = Factor::new(Pattern::complete(&model, &system.matrix));
        factor.factorise(&system.matrix).unwrap();
        let nodes = &model.start[..model.net.nodes.len()];
        let exactly = (20, 1e-13);
        gradients::solve(&system.matrix, &mut factor, nodes, &system.rhs, &mut solution, exactly).unwrap();
        let matrix = &system.matrix;
        let mut product = vec![0.0; solution.len()];
        for (i, j, value) in matrix.entries() {
            product[i] += value * solution[j];
            if i != j {
                product[j] += value * solution[i];
            }
        }
        let largest = system.rhs.iter().fold(0.0, |m: f64, f| m.max(f.abs()));
        for (a, b) in product.iter().zip(&system.rhs) {
            assert!((a - b).abs() < 1e-9 * largest);
        }
        system.matrix.add_diagonal(0, -1.0);
        assert!(factor.factorise(&system.matrix).is_err(), "not positive definite");
    }
}
