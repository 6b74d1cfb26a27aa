//! The simulation in a thread of its own.
//!
//! Commands go in through a channel; after every step its user sees the newest snapshot, still in this thread, so that what
//! takes a while to make of it is made here. Nobody waits: between two steps the thread looks at everything that was sent meanwhile.
//! The threads of the simulation give way to all others: on two processors that draw the window too, its pictures took 97 ms
//! instead of 173 while a garment of 9 500 loops moved.
//! Time goes no faster than on the clock, so that a small swatch falls as one would see it fall (`pace.rs`).

#[cfg(test)]
mod tests;
mod worker;

use crate::choice::{SharedGpu, SolverChoice};
use crate::forces::HoldFact;
use crate::gpu::DeviceYarn;
use crate::materials::Materials;
use crate::scene::Scene;
use crate::surgery::{Operation, Surgery};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{Sender, channel};
use std::thread::JoinHandle;
use stitch_mesh::yarn_curves::YarnCurves;
use stitch_mesh::yarn_net::{YarnNet, YarnState};
use thread_priority::ThreadPriority;
use worker::Worker;

/// What a simulation thread can be told.
#[derive(Clone, Debug)]
pub enum SimCommand {
    /// Simulate this from now on, paused at first.
    Load {
        /// The net.
        net: Arc<YarnNet>,
        /// The materials of its yarns.
        materials: Materials,
        /// What surrounds it.
        scene: Scene,
        /// Where it starts; as it was laid, if nowhere else.
        state: Option<Arc<YarnState>>,
    },
    /// Let time go by.
    Play,
    /// Hold.
    Pause,
    /// One step while held.
    StepOnce,
    /// Back to where it was loaded, in the scene and of the materials that it has now.
    Reset,
    /// Solve with this from now on, whatever is loaded.
    SetSolver(SolverChoice),
    /// Replace the scene: dragging a pin, moving a body.
    SetScene(Scene),
    /// Replace the materials.
    SetMaterials(Materials),
    /// Change the net: cut a yarn.
    Operate(Operation),
    /// Forget the net.
    Stop,
}

/// The newest state of a simulation thread.
#[derive(Clone, Debug, Default)]
pub struct Snapshot {
    /// Which `Load` it belongs to, counted from 1.
    pub generation: u64,
    /// The state; the one loaded, if that can't be simulated. While a GPU simulates, one of at most 0.05 s of simulated time
    /// before.
    pub state: YarnState,
    /// The net, which is no longer the one loaded once yarn has been cut or has slipped out.
    pub net: Arc<YarnNet>,
    /// What has happened to it since the load.
    pub surgery: Surgery,
    /// Its yarns, drawn with the radii of their materials; none where the state does not belong to the net.
    pub curves: YarnCurves,
    /// The same where it is simulated on the device that it is drawn on; `curves` is then empty.
    pub on_device: Option<DeviceYarn>,
    /// Simulated time since the load [s].
    pub time_s: f64,
    /// Whether time goes by.
    pub playing: bool,
    /// Time since the scene began, by which its bodies move [s].
    pub scene_time_s: f64,
    /// What holds the fabric, or touches it, and how hard.
    pub holds: Vec<HoldFact>,
    /// What last went wrong, if anything. A simulation that is stuck is paused.
    pub error: Option<String>,
    /// Whether it has been stepped or reset since it was loaded.
    pub moved: bool,
    /// What solves it: "direct", "iterative" or "gpu"; nothing, if it can't be simulated.
    pub solver: &'static str,
    /// The name of the GPU that simulates it.
    pub adapter: Option<String>,
    /// Why the GPU that was to simulate it does not, or no longer.
    pub notice: Option<String>,
    /// Clock time of the last step [ms].
    pub ms_per_step: f64,
}

/// Sees the newest snapshot before anybody else.
pub type See = Box<dyn Fn(Option<&Arc<Snapshot>>) + Send>;

/// A simulation thread. Dropping it ends the thread after the step it is in.
pub struct SimThread {
    commands: Option<Sender<SimCommand>>,
    loads: AtomicU64,
    thread: Option<JoinHandle<()>>,
}

impl SimThread {
    /// Starts a thread, idle until something is loaded. It simulates on `gpu` where that is the best. `see` is called, in that
    /// thread, with every new snapshot, and with none when nothing is loaded any more.
    ///
    /// # Errors
    /// The system has no thread to give.
    pub fn spawn(gpu: SharedGpu, see: See) -> std::io::Result<Self> {
        let (commands, received) = channel();
        let worker = Worker::new(gpu, see);
        let threads = rayon::ThreadPoolBuilder::new()
            .thread_name(|i| format!("simulation {i}"))
            .start_handler(|_| give_way())
            .build()
            .map_err(std::io::Error::other)?;
        let thread = std::thread::Builder::new()
            .name("simulation".to_owned())
            .spawn(move || threads.install(|| worker.work(received)))?;
        Ok(Self { commands: Some(commands), loads: AtomicU64::new(0), thread: Some(thread) })
    }

    /// Sends a command. Gives the generation that snapshots will have once it is carried out.
    pub fn send(&self, command: SimCommand) -> u64 {
        let new = u64::from(matches!(command, SimCommand::Load { .. }));
        let generation = self.loads.fetch_add(new, Ordering::Relaxed) + new;
        if let Some(commands) = &self.commands {
            // The thread ends only when this sender is dropped.
            let _ = commands.send(command);
        }
        generation
    }
}

/// Lets all other threads go before this one.
fn give_way() {
    // Where the system does not want that, the window is a little slower.
    if let Err(error) = ThreadPriority::Min.set_for_current() {
        tracing::debug!(?error, "the simulation has the priority of the window");
    }
}

impl Drop for SimThread {
    fn drop(&mut self) {
        self.commands = None;
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}
