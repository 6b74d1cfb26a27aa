//! The force on the yarn of a segment alone: contact length inside of a stitch contact, parallel contact elsewhere.

use crate::contact_length::ContactLength;
use crate::local::{Element, Local};
use crate::material::Material;
use crate::parallel::Parallel;

/// What keeps the two ends of a segment apart along the yarn.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Spacing {
    Contact(ContactLength),
    Free(Parallel),
}

impl Spacing {
    /// Of a segment in a stitch contact that was laid with `rest` [m].
    pub fn contact(material: &Material, rest: f64) -> Self {
        let stiffness = material.length_factor * material.stretch_stiffness();
        Self::Contact(ContactLength { stiffness, rest })
    }

    /// Of any other; `closeness` over the parallel distance.
    pub fn free(material: &Material, closeness: f64, rest: f64) -> Self {
        let distance = (closeness * material.parallel_distance).min(rest);
        Self::Free(Parallel { stiffness: material.parallel_stiffness, distance })
    }
}

impl Element<2> for Spacing {
    #[inline(always)]
    fn energy(&self, q: &[f64; 2]) -> f64 {
        match self {
            Self::Contact(element) => element.energy(q),
            Self::Free(element) => element.energy(q),
        }
    }

    #[inline(always)]
    fn expand(&self, q: &[f64; 2]) -> Local<2> {
        match self {
            Self::Contact(element) => element.expand(q),
            Self::Free(element) => element.expand(q),
        }
    }
}
