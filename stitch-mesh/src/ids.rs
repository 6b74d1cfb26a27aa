//! Typed ids: an index that cannot be mistaken for another kind of index.

use serde::{Deserialize, Serialize};

macro_rules! id {
    ($(#[$doc:meta])* $name:ident) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Debug, Serialize, Deserialize)]
        #[serde(transparent)]
        pub struct $name(pub u32);

        impl $name {
            /// The id of the element at `index` of its array.
            pub fn new(index: usize) -> Self {
                debug_assert!(index <= u32::MAX as usize);
                Self(index as u32)
            }

            /// The place of this element in its array.
            pub fn index(self) -> usize {
                self.0 as usize
            }
        }

        impl std::fmt::Display for $name {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                self.0.fmt(f)
            }
        }
    };
}

id!(
    /// A vertex of a mesh.
    VertexId
);
id!(
    /// A half-edge: one side of an edge, belonging to the face on its left.
    HalfEdgeId
);
id!(
    /// An edge: one or two half-edges.
    EdgeId
);
id!(
    /// A face of a polygon mesh or of a stitch mesh (there, a stitch).
    FaceId
);
id!(
    /// A contact node of a yarn net.
    NodeId
);
id!(
    /// A visit: one yarn passing one contact node.
    VisitId
);
id!(
    /// A piece of yarn.
    YarnId
);
