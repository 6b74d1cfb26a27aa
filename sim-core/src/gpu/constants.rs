//! Constants that Rust and WGSL have in common, each typed once.

use crate::{air, bend, friction, layers, local, mass, overshoot, shear, step, stretch, surroundings};

/// Unknowns that a group may have: its diagonal block is factorised in workgroup memory.
pub(crate) const MOST_GROUP: usize = 80;

/// Invocations of a workgroup that works on a front stand in a square with this side.
pub(crate) const SIDE: u32 = 16;

/// Rows of a front that one workgroup works on: four an invocation.
pub(crate) const TILE: u32 = 4 * SIDE;

/// Columns of a front that one invocation has.
const ACROSS: u32 = MOST_GROUP as u32 / SIDE;
const _: () = assert!(ACROSS * SIDE == MOST_GROUP as u32 && SIDE * SIDE == WIDE);

/// Visits that a node may have.
pub(crate) const MOST_STACK: usize = 12;

/// Contacts with other layers that a node may have: a ball touches at most twelve others of its size, but contacts are taken up
/// a step before. A fold of stockinette that closes with 0.2 m/s has up to 20.
pub(crate) const MOST_CONTACTS: usize = 48;

/// What the count of contacts gets besides where a node has more.
pub(crate) const CROWDED: u32 = 1 << 30;

/// Numbers that one workgroup adds up.
pub(crate) const SUM_SPAN: u32 = 1024;

/// Invocations of a workgroup, in most kernels and in those of which an invocation has much to do.
pub(crate) const WIDE: u32 = 256;
pub(crate) const NARROW: u32 = 64;

/// Why a step is rejected.
pub(crate) const REJECTED_NOT_FINITE: u32 = 1;
pub(crate) const REJECTED_SHRINKING: u32 = 2;
pub(crate) const REJECTED_LEAPING: u32 = 3;

/// Kinds of elements in the lists around nodes.
pub(crate) const OF_SEGMENT: u32 = 0;
pub(crate) const OF_BEND: u32 = 1;
pub(crate) const OF_WRAP: u32 = 2;
pub(crate) const OF_SHEAR: u32 = 3;

/// Columns that the rows of a node have behind those of the matrix: what each row has for a motion of all nodes along an axis.
pub(crate) const RIGID: u32 = 3;

/// Vectors of four numbers that each kind of element leaves.
pub(crate) const SEGMENT_OUT: u32 = 7;
pub(crate) const BEND_OUT: u32 = 6;
pub(crate) const WRAP_OUT: u32 = 7;
pub(crate) const SHEAR_OUT: u32 = 4;

/// Marks what is not there.
pub(crate) const NONE: u32 = u32::MAX;

/// Constants of the physics.
pub(crate) fn floats() -> [(&'static str, f64); 18] {
    [
        ("LEAST_LENGTH", local::LEAST_LENGTH),
        ("BEND_JAM_FACTOR", bend::JAM_FACTOR),
        ("SHEAR_JAM_FACTOR", shear::JAM_FACTOR),
        ("SLIDING_MASS", mass::SLIDING_MASS),
        ("BEYOND", stretch::BEYOND),
        ("NEAREST", layers::NEAREST),
        ("FARTHEST", layers::FARTHEST),
        ("LEAP", step::LEAP),
        ("DRAWN_LEFT", overshoot::LEFT[0]),
        ("DRAWN_FAR_LEFT", overshoot::LEFT[1]),
        ("DRAWN_HEAVIEST", overshoot::HEAVIEST),
        ("DRAWN_PART", overshoot::PART),
        ("DRAWN_LEAST", overshoot::LEAST),
        ("FIRM", surroundings::FIRM),
        ("MOST_DRAG", crate::body_contact::MOST_DRAG),
        ("VISCOSITY", air::VISCOSITY),
        ("PI", std::f64::consts::PI),
        ("HALF_PI", std::f64::consts::FRAC_PI_2),
    ]
}

/// Sizes and marks.
pub(crate) fn integers() -> [(&'static str, u32); 26] {
    [
        ("FROZEN", crate::model::FROZEN),
        ("NONE", NONE),
        ("MOST_GROUP", MOST_GROUP as u32),
        ("MOST_TRIANGLE", (MOST_GROUP * (MOST_GROUP + 1) / 2) as u32),
        ("SIDE", SIDE),
        ("TILE", TILE),
        ("ACROSS", ACROSS),
        ("SHARES", ACROSS * WIDE),
        ("MOST_STACK", MOST_STACK as u32),
        ("MOST_CONTACTS", MOST_CONTACTS as u32),
        ("CROWDED", CROWDED),
        ("SWEEPS", friction::SWEEPS as u32),
        ("SUM_SPAN", SUM_SPAN),
        ("WIDE", WIDE),
        ("NARROW", NARROW),
        ("REJECTED_NOT_FINITE", REJECTED_NOT_FINITE),
        ("REJECTED_SHRINKING", REJECTED_SHRINKING),
        ("REJECTED_LEAPING", REJECTED_LEAPING),
        ("OF_SEGMENT", OF_SEGMENT),
        ("OF_BEND", OF_BEND),
        ("OF_WRAP", OF_WRAP),
        ("RIGID", RIGID),
        ("SEGMENT_OUT", SEGMENT_OUT),
        ("BEND_OUT", BEND_OUT),
        ("WRAP_OUT", WRAP_OUT),
        ("SHEAR_OUT", SHEAR_OUT),
    ]
}
