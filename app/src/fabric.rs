//! Fabric: stitches, woven pieces and their yarn, as laid and as it has come to lie.
//!
//! Yarn is laid when somebody first asks for it, once for all who share it. An edit is done when the stitches are changed, and
//! shows at once; the thread of the document asks for the yarn after it has handed the stitches to the window.

use sim_core::{Facts, Operation, RestShape, SimError, Simulation, Surgery, SurgeryError, carry_over};
use std::sync::{Arc, LazyLock, OnceLock};
use stitch_mesh::ids::{FaceId, NodeId};
use stitch_mesh::lay::{lay, relay};
use stitch_mesh::stitch_mesh::StitchMesh;
use stitch_mesh::weave::Woven;
use stitch_mesh::yarn_net::{YarnNet, YarnState};

/// What is found when it is first asked for.
type Later<T> = Arc<LazyLock<T, Box<dyn FnOnce() -> T + Send>>>;

fn later<T>(find: impl FnOnce() -> T + Send + 'static) -> Later<T> {
    Arc::new(LazyLock::new(Box::new(find)))
}

/// What is known already.
fn known<T: Send + 'static>(value: T) -> Later<T> {
    let later = later(|| value);
    LazyLock::force(&later);
    later
}

/// Yarn as it was laid, and as surgery has left it.
#[derive(Debug)]
struct Laid {
    /// That of the stitches, then that of each woven piece.
    net: Arc<YarnNet>,
    /// Where it begins.
    start: OnceLock<Arc<YarnState>>,
}

impl Laid {
    fn new(net: YarnNet) -> Self {
        Self { net: Arc::new(net), start: OnceLock::new() }
    }

    /// `net` is that of the stitches alone.
    fn of(stitches: &StitchMesh, mut net: YarnNet, shape: Option<&RestShape>, woven: &[Woven]) -> Self {
        let shaped = shape.map(|shape| shape.apply(stitches, &mut net));
        let yarn: Vec<YarnNet> = woven.iter().map(Woven::lay).collect();
        let start = shaped.map(|mut start| {
            yarn.iter().for_each(|yarn| start.append(yarn.laid_state()));
            Arc::new(start)
        });
        yarn.into_iter().for_each(|yarn| net.append(yarn));
        Self { net: Arc::new(net), start: start.map(OnceLock::from).unwrap_or_default() }
    }

    fn start(&self) -> Arc<YarnState> {
        Arc::clone(self.start.get_or_init(|| Arc::new(self.net.laid_state())))
    }
}

/// What is knitted and what is woven, and all its yarn.
#[derive(Clone, Debug)]
pub struct Fabric {
    /// The stitch mesh; without stitches where nothing is knitted.
    pub stitches: Arc<StitchMesh>,
    /// Woven pieces.
    pub woven: Arc<Vec<Woven>>,
    laid: Later<Laid>,
    /// Shapes of relaxed loops with which it was laid, so that it keeps its size; laid as drawn without them.
    pub rest_shape: Option<Arc<RestShape>>,
    /// What has been cut and has slipped out since it was laid.
    pub surgery: Surgery,
    /// Where the yarn has got to, once something was simulated.
    state: Option<Later<Arc<YarnState>>>,
    /// Figures of that simulation.
    pub facts: Option<Facts>,
}

impl Fabric {
    /// The fabric of a stitch mesh, its yarn as laid.
    pub fn new(stitches: StitchMesh) -> Self {
        Self::laid(stitches, None, Arc::default())
    }

    /// The fabric of a stitch mesh with loops of these shapes, if any.
    pub fn with_rest_shape(stitches: StitchMesh, shape: Option<Arc<RestShape>>) -> Self {
        Self::laid(stitches, shape, Arc::default())
    }

    /// Stitches with loops of these shapes, if any, and woven pieces, their yarn as laid.
    pub fn laid(stitches: StitchMesh, shape: Option<Arc<RestShape>>, woven: Arc<Vec<Woven>>) -> Self {
        Self::of(Arc::new(stitches), shape, woven, lay)
    }

    /// The fabric after its stitches have been edited, its yarn as laid.
    pub fn edited(&self, stitches: StitchMesh) -> Self {
        let (shape, woven) = (self.rest_shape.clone(), self.woven.clone());
        let whole = shape.is_none() && woven.is_empty() && self.surgery == Surgery::default();
        // What nobody has asked for yet is no way to what comes after it.
        match self.net_if_laid().filter(|_| whole).cloned() {
            Some(net) => {
                let before = self.stitches.clone();
                Self::of(Arc::new(stitches), shape, woven, move |after| relay(&net, &before, after))
            }
            None => Self::laid(stitches, shape, woven),
        }
    }

    fn of(
        stitches: Arc<StitchMesh>,
        rest_shape: Option<Arc<RestShape>>,
        woven: Arc<Vec<Woven>>,
        lay: impl FnOnce(&StitchMesh) -> YarnNet + Send + 'static,
    ) -> Self {
        let laid = {
            let (stitches, shape, woven) = (stitches.clone(), rest_shape.clone(), woven.clone());
            later(move || Laid::of(&stitches, lay(&stitches), shape.as_deref(), &woven))
        };
        Self { stitches, woven, laid, rest_shape, surgery: Surgery::default(), state: None, facts: None }
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
        let start = OnceLock::from(longer(&self.laid.start()));
        let state = self.state.as_ref().map(|s| known(longer(s)));
        let mut net = (**self.net()).clone();
        net.append(yarn);
        let laid = known(Laid { net: Arc::new(net), start });
        let woven = Arc::new(self.woven.iter().cloned().chain([piece]).collect());
        Self { woven, laid, state, facts: None, ..self.clone() }
    }

    /// The yarn as laid, and as surgery has left it: that of the stitches, then that of each woven piece.
    pub fn net(&self) -> &Arc<YarnNet> {
        &self.laid.net
    }

    /// The yarn, if somebody has asked for it before.
    pub fn net_if_laid(&self) -> Option<&Arc<YarnNet>> {
        LazyLock::get(&self.laid).map(|laid| &laid.net)
    }

    /// Where the yarn is: where it has got to in a simulation, or where it begins.
    pub fn state(&self) -> Arc<YarnState> {
        self.simulated().unwrap_or_else(|| self.laid.start())
    }

    /// Where the yarn has got to, once something was simulated.
    pub fn simulated(&self) -> Option<Arc<YarnState>> {
        self.state.as_ref().map(|state| Arc::clone(LazyLock::force(state)))
    }

    /// Whether nothing is another than in `other`, from which this was made.
    pub(crate) fn is_as(&self, other: &Self) -> bool {
        let states = match (&self.state, &other.state) {
            (Some(state), Some(before)) => Arc::ptr_eq(state, before),
            (state, before) => state.is_none() && before.is_none(),
        };
        states && Arc::ptr_eq(&self.laid, &other.laid) && Arc::ptr_eq(&self.stitches, &other.stitches)
    }

    /// Puts the yarn somewhere. The state has to fit the net.
    pub fn put(&mut self, state: YarnState) {
        self.state = Some(known(Arc::new(state)));
    }

    /// Leaves the yarn where it is in another fabric, as far as both have the same faces. `was` tells for each face here which
    /// it is there; without it, both have the same mesh.
    pub fn continue_from(&mut self, from: &Self, was: Option<Vec<Option<FaceId>>>) {
        let to = Arc::clone(&self.laid);
        self.state = from.state.as_ref().map(|state| {
            let (net, state) = (Arc::clone(from.net()), Arc::clone(state));
            later(move || {
                let was = |f: FaceId| was.as_ref().map_or(Some(f), |list| *list.get(f.index())?);
                Arc::new(carry_over(&net, &state, &to.net, was))
            })
        });
        self.facts = from.facts.clone().filter(|_| Arc::ptr_eq(&self.laid, &from.laid));
    }

    /// The fabric as it was before anything was simulated: nothing moved, nothing cut.
    pub fn laid_anew(&self) -> Self {
        if self.surgery == Surgery::default() {
            return Self { state: None, facts: None, ..self.clone() };
        }
        self.laid_again()
    }

    /// Leaves only what is needed to have the fabric again: yarn that has never moved is laid anew when it is asked for.
    pub(crate) fn put_away(&mut self) {
        if self.state.is_none() && self.surgery == Surgery::default() {
            *self = self.laid_again();
        }
    }

    fn laid_again(&self) -> Self {
        Self::of(self.stitches.clone(), self.rest_shape.clone(), self.woven.clone(), lay)
    }

    /// The fabric after `surgery` has been done to it as it was laid.
    ///
    /// # Errors
    /// The surgery is that of another fabric.
    pub fn after(mut self, surgery: Surgery) -> Result<Self, SurgeryError> {
        let (net, _) = surgery.replay(self.net())?;
        self.become_net(net);
        self.surgery = surgery;
        Ok(self)
    }

    /// Takes over where a simulation that began with this fabric has brought its yarn.
    pub fn take_over(&mut self, moved: Moved, facts: Option<Facts>) {
        self.surgery = std::mem::take(&mut self.surgery).then(&moved.surgery);
        self.become_net(moved.net);
        self.state = Some(known(moved.state));
        self.facts = facts;
    }

    /// Cuts or releases yarn. Gives which node each one has become, if it is still there.
    ///
    /// # Errors
    /// There is no such yarn.
    pub fn operate(&mut self, operation: Operation) -> Result<Vec<Option<NodeId>>, SurgeryError> {
        let state = self.state();
        let done = sim_core::operate(self.net(), &state, &operation)?;
        self.surgery.add(operation, state.taken_in);
        self.laid = known(Laid::new(done.net));
        self.put(done.state);
        self.facts = None;
        Ok(done.node)
    }

    fn become_net(&mut self, net: Arc<YarnNet>) {
        if !Arc::ptr_eq(self.net(), &net) {
            self.laid = known(Laid { net, start: OnceLock::new() });
        }
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
    /// Where `simulation` has brought the yarn since it began with `from`.
    ///
    /// # Errors
    /// The GPU that it is on fails, and the CPU can't go on from there.
    pub fn by(simulation: &mut Simulation, from: &Arc<YarnNet>) -> Result<Self, SimError> {
        Ok(Self {
            from: Arc::clone(from),
            state: Arc::new(simulation.state()?.clone()),
            net: Arc::clone(simulation.net()),
            surgery: simulation.progress().surgery.clone(),
        })
    }
}
