//! Fabric: stitches and their yarn, as laid and as it has come to lie.

use sim_core::{Facts, Operation, RestShape, Simulator, Surgery, SurgeryError};
use std::sync::Arc;
use stitch_mesh::ids::NodeId;
use stitch_mesh::lay::{lay, relay};
use stitch_mesh::stitch_mesh::StitchMesh;
use stitch_mesh::yarn_net::{YarnNet, YarnState};

/// Stitches and their yarn.
#[derive(Clone, Debug)]
pub struct Fabric {
    /// The stitch mesh.
    pub stitches: Arc<StitchMesh>,
    /// Its yarn as laid, and as surgery has left it.
    pub net: Arc<YarnNet>,
    /// Shapes of relaxed loops with which it was laid, so that it keeps its size; laid as drawn without them.
    pub rest_shape: Option<Arc<RestShape>>,
    /// What has been cut and has slipped out since it was laid.
    pub surgery: Surgery,
    /// Where the yarn begins.
    start: Arc<YarnState>,
    /// Where the yarn has got to, once something was simulated.
    pub state: Option<Arc<YarnState>>,
    /// Figures of that simulation.
    pub facts: Option<Facts>,
}

impl Fabric {
    /// The fabric of a stitch mesh, its yarn just laid.
    pub fn new(stitches: StitchMesh) -> Self {
        let net = lay(&stitches);
        Self::of(stitches, net, None)
    }

    /// The fabric of a stitch mesh with loops of these shapes, if any.
    pub fn with_rest_shape(stitches: StitchMesh, shape: Option<Arc<RestShape>>) -> Self {
        let net = lay(&stitches);
        Self::of(stitches, net, shape)
    }

    /// The fabric after its stitches have been edited, its yarn laid again where it has to be.
    pub fn edited(&self, stitches: StitchMesh) -> Self {
        match &self.rest_shape {
            None if self.surgery == Surgery::default() => {
                let net = relay(&self.net, &self.stitches, &stitches);
                Self::of(stitches, net, None)
            }
            shape => Self::with_rest_shape(stitches, shape.clone()),
        }
    }

    fn of(stitches: StitchMesh, mut net: YarnNet, rest_shape: Option<Arc<RestShape>>) -> Self {
        let start = match &rest_shape {
            Some(shape) => shape.apply(&stitches, &mut net),
            None => net.laid_state(),
        };
        let (stitches, net, start) = (Arc::new(stitches), Arc::new(net), Arc::new(start));
        Self { stitches, net, rest_shape, surgery: Surgery::default(), start, state: None, facts: None }
    }

    /// Where the yarn is: the simulated state, or where it begins.
    pub fn state(&self) -> Arc<YarnState> {
        Arc::clone(self.state.as_ref().unwrap_or(&self.start))
    }

    /// The fabric as it was before anything was simulated: nothing moved, nothing cut.
    pub fn laid_anew(&self) -> Self {
        if self.surgery == Surgery::default() {
            return Self { state: None, facts: None, ..self.clone() };
        }
        Self::with_rest_shape((*self.stitches).clone(), self.rest_shape.clone())
    }

    /// The fabric after `surgery` has been done to it as it was laid.
    ///
    /// # Errors
    /// The surgery is that of another fabric.
    pub fn after(mut self, surgery: Surgery) -> Result<Self, SurgeryError> {
        (self.net, _) = surgery.replay(&self.net)?;
        self.surgery = surgery;
        Ok(self)
    }

    /// Takes over where a simulation that began with this fabric has brought its yarn.
    pub fn take_over(&mut self, moved: Moved, facts: Option<Facts>) {
        self.surgery = std::mem::take(&mut self.surgery).then(&moved.surgery);
        self.net = moved.net;
        self.state = Some(moved.state);
        self.facts = facts;
    }

    /// Cuts or releases yarn. Gives which node each one has become, if it is still there.
    ///
    /// # Errors
    /// There is no such yarn.
    pub fn operate(&mut self, operation: Operation) -> Result<Vec<Option<NodeId>>, SurgeryError> {
        let state = self.state();
        let done = sim_core::operate(&self.net, &state, &operation)?;
        self.surgery.add(operation, state.taken_in);
        (self.net, self.state, self.facts) = (Arc::new(done.net), Some(Arc::new(done.state)), None);
        Ok(done.node)
    }
}

/// Where a simulation has brought the yarn of a fabric.
#[derive(Clone, Debug)]
pub struct Moved {
    /// The net that it began with.
    pub from: Arc<YarnNet>,
    /// The net that this has become.
    pub net: Arc<YarnNet>,
    /// What was cut and what has slipped out meanwhile.
    pub surgery: Surgery,
    /// Where its yarn is.
    pub state: Arc<YarnState>,
}

impl Moved {
    /// Where `simulator` has brought the yarn since it began with `from`.
    pub fn by(simulator: &Simulator, from: &Arc<YarnNet>) -> Self {
        Self {
            from: Arc::clone(from),
            net: Arc::clone(simulator.net()),
            surgery: simulator.surgery().clone(),
            state: Arc::new(simulator.state().clone()),
        }
    }
}
