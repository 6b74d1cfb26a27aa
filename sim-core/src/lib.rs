//! Everything that iterates: the persistent-contact yarn simulator and its thread.
//!
//! The model is that of Cirio et al., *Yarn-Level Cloth Simulation with Sliding Persistent Contacts*. The flow within a step
//! is the list of stages in `step.rs`; each force has a file of its own that opens with its energy, gradient and Hessian.
//!
//! | notation | meaning |
//! |---|---|
//! | x, v | position and velocity of a node |
//! | u, u̇ | sliding coordinate of a visit: arc length of unstretched yarn that is at the node, and its rate |
//! | Δu, r, l, d, w | of a segment: u₁ − u₀, x₁ − x₀, \|r\|, r/l, r/Δu |
//! | σ | handedness of a stitch contact |
//! | R, Y, B, ρ | yarn radius, Young's modulus, bending modulus, mass per length |
//! | h | time step |

mod air;
mod assembly;
mod bend;
mod body;
mod body_contact;
mod brace;
mod bvh;
mod carry_over;
mod choice;
mod clearance;
mod closed_mesh;
mod closed_surface;
mod contact_length;
mod costs;
mod curves;
mod energies;
mod facts;
mod forces;
mod friction;
mod gpu;
mod gravity;
mod handover;
mod layers;
mod local;
mod mass;
mod material;
mod materials;
pub mod mesh_relax;
mod mesh_sequence;
mod model;
mod motion;
mod near_pairs;
mod noise;
mod overshoot;
mod pace;
mod parallel;
mod pin;
mod preset;
mod progress;
mod rest_shape;
mod rigid;
mod scene;
mod settle;
mod shear;
mod simulation;
mod simulator;
mod solver;
mod spacing;
mod step;
mod stretch;
mod strips;
mod surgery;
mod surroundings;
mod take_in;
mod thread;
mod woven;
mod wrap;

pub use body::Body;
pub use carry_over::carry_over;
pub use choice::{SharedGpu, SolverChoice};
pub use clearance::least_distance;
pub use closed_mesh::ClosedMesh;
pub use closed_surface::{ClosedMeshError, Triangles};
pub use costs::{Costs, STAGES};
pub use curves::curves;
pub use energies::Energies;
pub use facts::Facts;
pub use forces::{Forces, HoldFact};
pub use gpu::{DeviceYarn, GpuDevice, GpuError, GpuSimulator, YarnRun};
pub use material::{Material, MaterialError};
pub use materials::Materials;
pub use mesh_sequence::{Frames, MeshSequence, SequenceError};
pub use model::{Model, NetError};
pub use motion::{Key, Motion, Pose};
pub use preset::Preset;
pub use progress::Progress;
pub use rest_shape::RestShape;
pub use scene::{Clamp, Pin, Scene, SceneError};
pub use settle::{SettleGoal, SettleProgress, Settled};
pub use simulation::Simulation;
pub use simulator::{SimError, Simulator, StepReport};
pub use solver::{Method, SolveError};
pub use step::Rejection;
pub use surgery::{Operated, Operation, Surgery, SurgeryError, operate};
pub use thread::{See, SimCommand, SimThread, Snapshot};

#[cfg(test)]
mod testing;
