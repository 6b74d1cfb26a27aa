//! The iteration: implicit steps to rest.
//!
//! # Theory
//! Yuksel et al. eq. 1: backward Euler on ẋ = f(x), (I/h + K) Δx = f with K the stiffness and h the step in (stitch/κ).
//! Small h gives a short step down the gradient, large h Newton's step; only the rest matters, so h is as large as
//! it can be. Every step has to lower the energy:
//! 1. assemble f and K in the frames of the vertices, solve for Δx;
//! 2. no vertex goes further than [`LONGEST`]: beyond, the tangent plane says nothing about the surface;
//! 3. walk along Δx on the surface; while the energy has not fallen by what f·Δx promises (Armijo), halve the way;
//! 4. a whole step makes h ten times as large, a step that was halved often makes it smaller.
//!
//! K is positive semi-definite, so Δx is a direction of descent whenever CG stops, and the energy is bounded from below: the
//! iteration cannot diverge, and it ends. It is settled when a whole step of Newton's kind moves no vertex by more than the
//! tolerance, or when no shortening finds a lower energy any more (on the triangles the energy has kinks, if slight ones).

use super::conjugate::Conjugate;
use super::elements::Elements;
use super::params::RelaxParams;
use super::surface::{Place, Surface};
use super::system::{Frame, System, energy};
use glam::DVec3;
use rayon::prelude::*;

/// Longest way of a vertex in one step [stitches]. With 3 a tube that is badly distorted along takes 14 steps instead of 9;
/// with 30 nothing more is won.
const LONGEST: f64 = 10.0;

/// First step and longest one. At 1e6 a whole fabric may still slide along itself, but the system stays solvable.
const FIRST_H: f64 = 10.0;
const LAST_H: f64 = 1e6;

/// How far the residual of the linear system is brought down, and the most iterations for it. 0.03 costs a quarter more
/// iterations altogether, 0.2 saves a tenth of them for a step more.
const SOLVED: f64 = 0.1;
const MOST_ITERATIONS: usize = 300;

/// Halvings of a step before it is given up.
const MOST_HALVINGS: usize = 8;

/// Part of the promised decrease of energy that a step has to keep.
const KEPT: f64 = 1e-4;

/// A whole step that lowers the energy by no more than this part of it ends the relaxation: 2e-5 is an edge in a thousand
/// less strain than a stitch has at rest. A tube may creep round itself at 1e-5 a step for hundreds of steps.
const NOTHING_GAINED: f64 = 2e-5;

/// What a step did.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepFacts {
    /// Number of steps so far.
    pub step: usize,
    /// Energy after it, over κ_stretch and per vertex.
    pub energy: f64,
    /// Root mean square of the forces before it in the directions in which vertices can move, over κ_stretch.
    pub residual: f64,
    /// Longest way of a vertex [stitches].
    pub moved: f64,
    /// Iterations of the linear solver.
    pub iterations: usize,
    /// Whether the stitches have come to rest.
    pub settled: bool,
}

/// Directions in which vertices can move, by what they move on.
pub(super) trait Domain<const D: usize>: Sync {
    type Place: Copy + Send + Sync;
    fn frame(&self, place: &Self::Place) -> Frame<D>;
    /// The front, zero where there is none.
    fn normal(&self, place: &Self::Place) -> DVec3;
    fn walk(&self, place: &Self::Place, way: DVec3) -> Self::Place;
    fn position(&self, place: &Self::Place) -> DVec3;
}

/// No surface: vertices move in space.
pub(super) struct Space;

impl Domain<3> for Space {
    type Place = DVec3;

    fn frame(&self, _: &DVec3) -> Frame<3> {
        DVec3::AXES
    }

    fn normal(&self, _: &DVec3) -> DVec3 {
        DVec3::ZERO
    }

    fn walk(&self, place: &DVec3, way: DVec3) -> DVec3 {
        *place + way
    }

    fn position(&self, place: &DVec3) -> DVec3 {
        *place
    }
}

impl Domain<2> for Surface {
    type Place = Place;

    fn frame(&self, place: &Place) -> Frame<2> {
        Surface::frame(self, place)
    }

    fn normal(&self, place: &Place) -> DVec3 {
        Surface::normal(self, place)
    }

    fn walk(&self, place: &Place, way: DVec3) -> Place {
        Surface::walk(self, place, way)
    }

    fn position(&self, place: &Place) -> DVec3 {
        Surface::position(self, place)
    }
}

/// A relaxation under way. Lengths in stitches.
pub(super) struct Relaxer<const D: usize, M: Domain<D>> {
    pub domain: M,
    pub places: Vec<M::Place>,
    pub x: Vec<DVec3>,
    normals: Vec<DVec3>,
    frames: Vec<Frame<D>>,
    elements: Elements,
    params: RelaxParams,
    rest_wale: f64,
    system: System<D>,
    solver: Conjugate<D>,
    energy: f64,
    h: f64,
    steps: usize,
    pub settled: bool,
}

impl<const D: usize, M: Domain<D>> Relaxer<D, M> {
    pub fn new(
        domain: M,
        places: Vec<M::Place>,
        elements: Elements,
        params: RelaxParams,
        rest_wale: f64,
    ) -> Self {
        let x: Vec<DVec3> = places.iter().map(|p| domain.position(p)).collect();
        let system = System::new(x.len(), &elements, &params, rest_wale);
        let normals: Vec<DVec3> = places.iter().map(|p| domain.normal(p)).collect();
        let energy = energy(&elements, &params, rest_wale, &x, &normals);
        Self {
            normals,
            frames: vec![[DVec3::ZERO; D]; x.len()],
            solver: Conjugate::new(x.len()),
            settled: !energy.is_finite(), // coordinates beyond all measure: nothing can be made of them
            domain,
            places,
            x,
            elements,
            params,
            rest_wale,
            system,
            energy,
            h: FIRST_H,
            steps: 0,
        }
    }

    pub fn step(&mut self) -> StepFacts {
        if self.settled {
            return self.facts(0.0, 0.0, 0);
        }
        self.steps += 1;
        let domain = &self.domain;
        self.places.par_iter().map(|p| domain.frame(p)).collect_into_vec(&mut self.frames);
        self.system.assemble(&self.x, &self.frames, &self.normals, 1.0 / self.h);
        let iterations = self.solver.solve(&self.system, SOLVED, MOST_ITERATIONS);

        let way =
            |v: usize| -> DVec3 { (0..D).map(|d| self.frames[v][d] * self.solver.solution[v][d]).sum() };
        let longest = (0..self.x.len()).map(|v| way(v).length_squared()).fold(0.0, f64::max).sqrt();
        let (force, solution) = (self.system.force.as_flattened(), self.solver.solution.as_flattened());
        let promised: f64 = force.iter().zip(solution).map(|(f, s)| f * s).sum();
        let residual = (force.iter().map(|f| f * f).sum::<f64>() / self.x.len() as f64).sqrt();
        let whole = if longest > LONGEST { LONGEST / longest } else { 1.0 };

        let before = self.energy;
        let mut part = whole;
        let mut moved = 0.0;
        for _ in 0..=MOST_HALVINGS {
            let places: Vec<M::Place> = (0..self.x.len())
                .into_par_iter()
                .map(|v| domain.walk(&self.places[v], part * way(v)))
                .collect();
            let x: Vec<DVec3> = places.par_iter().map(|p| domain.position(p)).collect();
            let normals: Vec<DVec3> = places.par_iter().map(|p| domain.normal(p)).collect();
            let energy = energy(&self.elements, &self.params, self.rest_wale, &x, &normals);
            if energy <= self.energy - KEPT * part * promised {
                (self.places, self.x, self.normals, self.energy) = (places, x, normals, energy);
                moved = part * longest;
                break;
            }
            part *= 0.5;
        }
        let was_long = self.h >= LAST_H;
        if moved == 0.0 {
            self.settled = self.h <= FIRST_H || longest <= self.params.tolerance;
            self.h = FIRST_H;
        } else if part == whole {
            let gained = before - self.energy;
            self.settled = was_long && (moved <= self.params.tolerance || gained <= NOTHING_GAINED * before);
            self.h = (10.0 * self.h).min(LAST_H);
        } else if part < 0.2 * whole {
            self.h = (0.1 * self.h).max(FIRST_H);
        }
        self.settled |= self.steps >= self.params.most_steps;
        self.facts(residual, moved, iterations)
    }

    fn facts(&self, residual: f64, moved: f64, iterations: usize) -> StepFacts {
        let (step, settled, kappa) = (self.steps, self.settled, self.params.stretch);
        let energy = self.energy / kappa / self.x.len().max(1) as f64;
        StepFacts { step, energy, residual: residual / kappa, moved, iterations, settled }
    }
}
