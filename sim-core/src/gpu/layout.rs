//! What Rust and WGSL have in common, written once: constants, and records of 4-byte words.
//!
//! A record is declared in Rust and its WGSL text generated from the declaration. All fields are `f32` or `u32`, so both
//! sides agree on every offset, in uniforms and in arrays alike. A test parses what is generated and compares.

use super::constants::{floats, integers};
use std::fmt::Write as _;

/// Declares records of words.
macro_rules! records {
    ($($(#[$doc:meta])* $name:ident { $($(#[$field_doc:meta])* $field:ident: $kind:ident,)* })*) => {
        $(
            $(#[$doc])*
            #[repr(C)]
            #[derive(Clone, Copy, Debug, Default, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
            pub(crate) struct $name { $($(#[$field_doc])* pub $field: $kind,)* }
        )*

        /// Name of each record, and name and type of its fields.
        pub(crate) const RECORDS: &[(&str, &[(&str, &str)])] =
            &[$((stringify!($name), &[$((stringify!($field), stringify!($kind)),)*]),)*];

        #[cfg(test)]
        pub(crate) const OFFSETS: &[(&str, usize, &[usize])] =
            &[$((stringify!($name), size_of::<$name>(), &[$(std::mem::offset_of!($name, $field),)*]),)*];
    };
}

records! {
    /// What is the same for all elements in a step.
    Params {
        /// h [s].
        h: f32,
        /// Stiffness of bodies and layers against a node, over its mass [1/s²].
        stiffness_by_mass: f32,
        /// Acceleration of gravity [m/s²].
        gravity_x: f32, gravity_y: f32, gravity_z: f32,
        /// Where the positions are measured from [m].
        origin_x: f32, origin_y: f32, origin_z: f32,
        /// Density of the air [kg/m³].
        air: f32,
        /// Part of what is to be taken in that has been.
        taken_in: f32,
        /// α of the whole fabric [1/s].
        mass_damping: f32,
        /// 1 where nothing but itself touches the fabric.
        is_free: u32,
        /// Squared tolerance of conjugate gradients.
        tolerance: f32,
        /// Part of the diagonal that is added to it for the factor.
        shift: f32,
        node_count: u32,
        dof_count: u32,
        visit_count: u32,
        body_count: u32,
        /// The largest distance at which layers touch [m].
        touching: f32,
        /// Cells of the grid that near nodes are looked for in.
        cell_count: u32,
        /// Places for contacts of layers.
        contact_capacity: u32,
        /// Stitch contacts.
        joint_count: u32,
        /// Excess of length that a step may leave in some segments, over the length; and in how many.
        far: f32,
        most_left: u32,
    }
    /// The part of the arrays that one dispatch works on.
    Part {
        first: u32,
        count: u32,
    }
    /// How many elements a chunk has, and where their results begin [vec4].
    Counts {
        segments: u32,
        bends: u32,
        wraps: u32,
        shears: u32,
        bends_at: u32,
        wraps_at: u32,
        shears_at: u32,
        first_node: u32,
        node_count: u32,
    }
    /// A yarn; see `material.rs`.
    Material {
        density: f32,
        stretch: f32,
        bend: f32,
        wrap: f32,
        wrap_sin: f32,
        wrap_cos: f32,
        wrap_fade: f32,
        friction: f32,
        cohesion: f32,
        stick: f32,
        length: f32,
        parallel: f32,
        parallel_distance: f32,
        mass_damping: f32,
        stiffness_damping: f32,
        diameter: f32,
        /// 10 (ν/d)^⅔, the share of slow flow in the drag of air.
        creep: f32,
    }
    /// See `SegmentTerm`.
    Segment {
        node_0: u32, node_1: u32,
        visit_0: u32, visit_1: u32,
        dye: u32,
        in_contact: u32,
        /// Its place in the model.
        id: u32,
        /// Δu where both have slid by nothing, and how much of that is to be taken in [m].
        laid: f32,
        taken: f32,
        rest: f32,
        climb: f32,
        closeness: f32,
    }
    /// See `BendTerm`.
    Bend {
        node_0: u32, node_1: u32, node_2: u32,
        visit_0: u32, visit_2: u32,
        dye: u32,
        laid: f32,
        taken: f32,
        jam_angle: f32,
    }
    /// See `WrapTerm`.
    Wrap {
        node_0: u32, node_1: u32, node_2: u32, node_3: u32,
        dye: u32,
        handedness: f32,
        /// Sine and cosine of the rest angle of the stitch's own; both zero where it has that of its material.
        own_sin: f32,
        own_cos: f32,
        /// m L [m].
        rest: f32,
    }
    /// See `ShearTerm`.
    Shear {
        node_0: u32, node_1: u32, node_2: u32, node_3: u32,
        visit_0: u32, visit_1: u32, visit_2: u32, visit_3: u32,
        /// Its place in the model.
        id: u32,
        stiffness: f32,
        length: f32,
        rest: f32,
        jam: f32,
        stiffness_damping: f32,
        /// Δu of both pieces where nothing has slid, signed [m].
        laid_0: f32, laid_1: f32,
        climb_0: f32, climb_1: f32,
        share_0: f32, share_1: f32,
        stretch_0: f32, stretch_1: f32,
        sense: f32,
    }
    /// A node's place in the system, and where its lists are.
    Node {
        dof: u32,
        size: u32,
        /// Its entries in the list of elements around it.
        entry: u32, entry_end: u32,
        /// Its blocks in the list of blocks.
        block: u32, block_end: u32,
        /// Its rows in the matrix, the column in them with which its own block begins, and how many columns they have.
        value: u32,
        own: u32,
        width: u32,
        /// Its visits in the list of stacked visits.
        visit: u32,
        /// Its group.
        group: u32,
        /// What the groups before its own hand on to it.
        incoming: u32, incoming_end: u32,
        /// Its neighbours along yarns.
        around: u32, around_end: u32,
        /// Radius of the yarns at it, doubled; mass; √μ.
        clearance: f32,
        mass: f32,
        grip: f32,
        /// Where it was laid and which way was its front.
        laid_x: f32, laid_y: f32, laid_z: f32,
        normal_x: f32, normal_y: f32, normal_z: f32,
    }
    /// A block of the matrix: the unknowns of its columns, and the row in the front of its group that they are.
    Block {
        dof: u32,
        size: u32,
        front: u32,
    }
    /// The middle of a stitch contact, where yarns pass each other.
    Joint {
        node_0: u32, node_1: u32,
        /// The colour of the new yarn, and those of the old ones in the list of them.
        dye: u32,
        old: u32, old_end: u32,
        /// Its first control point.
        point: u32,
        /// Handedness, turned round where the new yarn lies in front.
        side: f32,
    }
    /// A visit in a stack.
    Stacked {
        visit: u32,
        dye: u32,
        /// Whether the yarn behind it lies parallel.
        parallel: u32,
        /// Elements that pull at it, in the list of pulls.
        pull: u32, pull_end: u32,
    }
    /// Unknowns that are eliminated at once; see `gpu/pattern.rs`.
    Group {
        /// Its own unknowns.
        dof: u32,
        size: u32,
        /// Later unknowns that it is joined to.
        row: u32,
        row_count: u32,
        /// Its front in the factor.
        front: u32,
        node: u32, node_end: u32,
    }
    /// Some rows of a front, which are divided or which earlier groups change; see `gpu/changes.rs`.
    Tile {
        group: u32,
        /// Those to be divided.
        row: u32,
        row_count: u32,
        source: u32, source_end: u32,
    }
    /// An earlier group that changes a tile: of the rows it shares with the front, those that are columns there and those in the tile.
    Source {
        group: u32,
        /// 1 if its front lies in another chunk.
        elsewhere: u32,
        column: u32,
        column_count: u32,
        row: u32,
        row_count: u32,
    }
    /// Body; see `body.rs`. Kinds are 0 ground, 1 sphere, 2 capsule, 3 box, 4 mesh.
    Body {
        kind: u32,
        friction: f32,
        a_x: f32, a_y: f32, a_z: f32,
        b_x: f32, b_y: f32, b_z: f32,
        /// Radius, or side of a cell of a mesh.
        size: f32,
        corners_x: u32, corners_y: u32, corners_z: u32,
        /// First distance of a mesh in the list of all.
        field: u32,
        moves: u32,
        /// Turn of a box about its centre, and poses at both ends of the step: quaternion, shift.
        turn_x: f32, turn_y: f32, turn_z: f32, turn_w: f32,
        from_x: f32, from_y: f32, from_z: f32, from_w: f32,
        from_shift_x: f32, from_shift_y: f32, from_shift_z: f32,
        to_x: f32, to_y: f32, to_z: f32, to_w: f32,
        to_shift_x: f32, to_shift_y: f32, to_shift_z: f32,
    }
    /// A spring that holds a node.
    Pin {
        node: u32,
        stiffness: f32,
        x: f32, y: f32, z: f32,
    }
    /// How far conjugate gradients have come.
    Status {
        /// Squared error, and what it has to come under.
        error: f32,
        goal: f32,
        alpha: f32,
        beta: f32,
        iterations: u32,
        /// 1 when they are done, 2 when they have failed.
        solved: u32,
    }
    /// The rigid motion of the fabric.
    Rigid {
        center_x: f32, center_y: f32, center_z: f32,
        mass: f32,
        mean_x: f32, mean_y: f32, mean_z: f32,
        omega_x: f32, omega_y: f32, omega_z: f32,
        kept_x: f32, kept_y: f32, kept_z: f32,
    }
    /// What a control point of drawn yarn is made from; see `drawn.rs`.
    Lay {
        /// Its place among the points of visits and stitch contacts, and those before and after it on the yarn.
        point: u32,
        before: u32, after: u32,
        /// The entry whose other side this lies on.
        mirror: u32,
        /// What moves it along, and turns it.
        visit: u32,
        node: u32,
        /// Yarn up to it where nothing has slid [diameters], and the diameter [m].
        arc: f32,
        diameter: f32,
        /// 0 where it only helps its neighbours.
        inner: u32,
        mark: u32,
    }
    /// A control point of drawn yarn, as `render` reads it.
    Drawn {
        x: f32, y: f32, z: f32,
        arc: f32,
        normal_x: f32, normal_y: f32, normal_z: f32,
        stretch: u32,
    }
    /// Where a run of drawn yarn is.
    Bound {
        x: f32, y: f32, z: f32,
        far: f32,
        span: f32,
    }
    /// Two nodes of different layers that press each other, seen from one.
    Contact {
        node: u32,
        normal_x: f32, normal_y: f32, normal_z: f32,
        /// What goes into the matrix along the normal and across it.
        along: f32,
        across: f32,
    }
}

/// What every kernel begins with.
pub(crate) fn prelude() -> String {
    let mut text = String::new();
    for (name, value) in floats() {
        let _ = writeln!(text, "const {name}: f32 = {value:e};");
    }
    for (name, value) in integers() {
        let _ = writeln!(text, "const {name}: u32 = {value}u;");
    }
    for (name, fields) in RECORDS {
        let _ = writeln!(text, "struct {name} {{");
        for (field, kind) in *fields {
            let _ = writeln!(text, "    {field}: {kind},");
        }
        let _ = writeln!(text, "}}");
    }
    text + include_str!("kernels/common.wgsl")
}
