//! Fabric: stitches, woven pieces and their yarn, as laid and as it has come to lie.

use sim_core::{Facts, Operation, RestShape, Simulator, Surgery, SurgeryError};
use std::sync::Arc;
use stitch_mesh::ids::NodeId;
use stitch_mesh::lay::{lay, relay};
use stitch_mesh::stitch_mesh::StitchMesh;
use stitch_mesh::weave::Woven;
use stitch_mesh::yarn_net::{YarnNet, YarnState};

/// What is knitted and what is woven, and all its yarn.
#[derive(Clone, Debug)]
pub struct Fabric {
    /// The stitch mesh; without stitches where nothing is knitted.
    pub stitches: Arc<StitchMesh>,
    /// Woven pieces.
    pub woven: Arc<Vec<Woven>>,
    /// The yarn as laid, and as surgery has left it: that of the stitches, then that of each woven piece.
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
        Self::laid(stitches, None, Arc::default())
    }

    /// The fabric of a stitch mesh with loops of these shapes, if any.
    pub fn with_rest_shape(stitches: StitchMesh, shape: Option<Arc<RestShape>>) -> Self {
        Self::laid(stitches, shape, Arc::default())
    }

    /// Stitches with loops of these shapes, if any, and woven pieces, their yarn just laid.
    pub fn laid(stitches: StitchMesh, shape: Option<Arc<RestShape>>, woven: Arc<Vec<Woven>>) -> Self {
        let net = lay(&stitches);
        Self::of(stitches, net, shape, woven)
    }

    /// The fabric after its stitches have been edited, its yarn laid again where it has to be.
    pub fn edited(&self, stitches: StitchMesh) -> Self {
        match &self.rest_shape {
            None if self.surgery == Surgery::default() && self.woven.is_empty() => {
                let net = relay(&self.net, &self.stitches, &stitches);
                Self::of(stitches, net, None, self.woven.clone())
            }
            shape => Self::laid(stitches, shape.clone(), self.woven.clone()),
        }
    }

    /// `net` is that of the stitches alone.
    fn of(
        stitches: StitchMesh,
        mut net: YarnNet,
        rest_shape: Option<Arc<RestShape>>,
        woven: Arc<Vec<Woven>>,
    ) -> Self {
        let mut start = match &rest_shape {
            Some(shape) => shape.apply(&stitches, &mut net),
            None => net.laid_state(),
        };
        for piece in woven.iter() {
            let yarn = piece.lay();
            start.append(yarn.laid_state());
            net.append(yarn);
        }
        let (stitches, net, start) = (Arc::new(stitches), Arc::new(net), Arc::new(start));
        let surgery = Surgery::default();
        Self { stitches, woven, net, rest_shape, surgery, start, state: None, facts: None }
    }

    /// The fabric with one more woven piece; all other yarn stays where it is. Nothing may have been cut: surgery is kept by
    /// the numbers of the yarn as it was laid.
    pub fn with_woven(&self, piece: Woven) -> Self {
        let yarn = piece.lay();
        let longer = |state: &Arc<YarnState>| {
            let mut state = (**state).clone();
            state.append(yarn.laid_state());
            Arc::new(state)
        };
        let (start, state) = (longer(&self.start), self.state.as_ref().map(longer));
        let mut net = (*self.net).clone();
        net.append(yarn);
        let woven = Arc::new(self.woven.iter().cloned().chain([piece]).collect());
        Self { woven, net: Arc::new(net), start, state, facts: None, ..self.clone() }
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
        Self::laid((*self.stitches).clone(), self.rest_shape.clone(), self.woven.clone())
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
