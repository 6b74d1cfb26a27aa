//! What the tests share.

pub(crate) mod fabrics;
pub(crate) mod finite_difference;

use crate::model::Model;
use std::sync::Arc;
use stitch_mesh::{edge_counts::StitchSize, lay::lay, pieces::rectangle};

/// The model of a piece of stockinette with loops of 3 mm.
pub(crate) fn swatch_model(wide: usize, high: usize) -> Model {
    Model::new(Arc::new(lay(&rectangle(wide, high, StitchSize::of_width(3e-3)).unwrap()))).unwrap()
}
