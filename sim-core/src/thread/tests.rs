use super::*;
use crate::gpu::GpuDevice;
use crate::material::Material;
use std::sync::mpsc::Receiver;
use std::time::Duration;
use stitch_mesh::ids::VisitId;

/// A thread on a device, and what its snapshots arrive at.
fn thread_on(gpu: SharedGpu) -> (SimThread, Receiver<Option<Arc<Snapshot>>>) {
    let (seen, snapshots) = channel();
    let see =
        Box::new(move |snapshot: Option<&Arc<Snapshot>>| seen.send(snapshot.cloned()).unwrap_or_default());
    (SimThread::spawn(gpu, see).unwrap(), snapshots)
}

fn thread() -> (SimThread, Receiver<Option<Arc<Snapshot>>>) {
    thread_on(SharedGpu::default())
}

fn load(thread: &SimThread, spoil: impl Fn(&mut YarnState)) -> u64 {
    let net = Arc::clone(&crate::testing::swatch_model(4, 4).net);
    let mut state = net.laid_state();
    spoil(&mut state);
    let materials = Material::for_loop_width(3e-3).into();
    thread.send(SimCommand::Load { net, materials, scene: Scene::empty(), state: Some(Arc::new(state)) })
}

/// Waits for a snapshot that `is` so.
fn wait(snapshots: &Receiver<Option<Arc<Snapshot>>>, is: impl Fn(&Snapshot) -> bool) -> Arc<Snapshot> {
    loop {
        let seen = snapshots.recv_timeout(Duration::from_secs(20)).expect("a snapshot in time");
        if let Some(snapshot) = seen.filter(|s| is(s)) {
            return snapshot;
        }
    }
}

#[test]
fn plays_pauses_and_steps() {
    let (thread, snapshots) = thread();
    assert!(snapshots.try_recv().is_err());
    assert_eq!(load(&thread, |_| {}), 1);
    let loaded = wait(&snapshots, |s| s.generation == 1);
    assert!(!loaded.playing && loaded.time_s == 0.0 && loaded.error.is_none());
    assert_eq!(thread.send(SimCommand::StepOnce), 1);
    wait(&snapshots, |s| s.time_s > 0.0 && !s.playing);
    thread.send(SimCommand::Play);
    let played = wait(&snapshots, |s| s.time_s > 0.03);
    assert!(played.playing && !played.curves.curves.is_empty());
    thread.send(SimCommand::Pause);
    wait(&snapshots, |s| !s.playing);
    assert_eq!(load(&thread, |_| {}), 2);
    wait(&snapshots, |s| s.generation == 2 && s.time_s == 0.0);
}

#[test]
fn a_cut_goes_on_from_where_the_yarn_is() {
    let (thread, snapshots) = thread();
    load(&thread, |_| {});
    thread.send(SimCommand::StepOnce);
    let whole = wait(&snapshots, |s| s.time_s > 0.0);
    thread.send(SimCommand::Operate(Operation::Cut(VisitId(40))));
    let cut = wait(&snapshots, |s| s.surgery.operations.len() == 1);
    assert_eq!(cut.net.yarns.len(), whole.net.yarns.len() + 1);
    assert!(cut.state.fits(&cut.net) && cut.curves.curves.len() == cut.net.yarns.len());
    assert_eq!(cut.time_s, whole.time_s);
    thread.send(SimCommand::Operate(Operation::Cut(VisitId(1 << 20))));
    let refused = wait(&snapshots, |s| s.error.is_some());
    assert!(refused.error.as_deref().unwrap().contains("there is no visit 1048576"));
    assert_eq!(refused.surgery.operations.len(), 1);
}

#[test]
fn reset_goes_back_to_where_it_was_loaded() {
    let (thread, snapshots) = thread();
    load(&thread, |state| state.position[3].z += 1e-4);
    let loaded = wait(&snapshots, |s| s.generation == 1);
    assert!(!loaded.moved);
    thread.send(SimCommand::Play);
    wait(&snapshots, |s| s.time_s > 0.02);
    thread.send(SimCommand::Operate(Operation::Cut(VisitId(40))));
    wait(&snapshots, |s| s.surgery.operations.len() == 1);
    thread.send(SimCommand::Pause);
    thread.send(SimCommand::Reset);
    let reset = wait(&snapshots, |s| s.moved && s.time_s == 0.0);
    assert_eq!((&reset.state, reset.surgery.operations.len()), (&loaded.state, 0));
    assert!(Arc::ptr_eq(&reset.net, &loaded.net) && !reset.playing);
}

#[test]
fn goes_on_with_another_solver() {
    let (thread, snapshots) = thread();
    load(&thread, |_| {});
    thread.send(SimCommand::StepOnce);
    let before = wait(&snapshots, |s| s.time_s > 0.0);
    assert_eq!(before.solver, "direct");
    thread.send(SimCommand::SetSolver(SolverChoice::Iterative));
    let after = wait(&snapshots, |s| s.solver == "iterative");
    assert_eq!((&after.state, after.time_s), (&before.state, before.time_s));
    load(&thread, |_| {});
    wait(&snapshots, |s| s.generation == 2 && s.solver == "iterative");
}

#[test]
fn a_lost_gpu_is_no_loss() {
    let Ok(gpu) = GpuDevice::open() else {
        println!("SKIPPED: there is no GPU here, nor a software one");
        return;
    };
    let (thread, snapshots) = thread_on(SharedGpu::from(gpu.clone()));
    thread.send(SimCommand::SetSolver(SolverChoice::Gpu));
    load(&thread, |_| {});
    for n in 1..=3 {
        thread.send(SimCommand::StepOnce);
        wait(&snapshots, |s| s.time_s > (f64::from(n) - 0.5) * Scene::empty().time_step);
    }
    let cut = SimCommand::Operate(Operation::Cut(VisitId(40)));
    thread.send(cut);
    let good = wait(&snapshots, |s| s.surgery.operations.len() == 1);
    assert_eq!((good.solver, good.adapter.as_deref()), ("gpu", Some(gpu.adapter.name.as_str())));
    assert!(good.notice.is_none() && good.error.is_none());
    gpu.destroy();
    thread.send(SimCommand::StepOnce);
    let after = wait(&snapshots, |s| s.time_s > good.time_s);
    assert_eq!((after.solver, after.adapter.as_ref()), ("direct", None));
    let notice = after.notice.as_deref().unwrap();
    assert!(notice.starts_with("the GPU was lost") && notice.contains("going on on the CPU"), "{notice}");
    assert!(after.error.is_none());
    // One step further, with the yarn cut and the simulation as long as before.
    assert!(after.surgery.operations.starts_with(&good.surgery.operations));
    assert!((after.time_s - good.time_s - Scene::empty().time_step).abs() < 1e-9);
    let moved = after.state.position.iter().zip(&good.state.position).map(|(a, b)| a.distance(*b));
    let furthest = moved.fold(0.0, f64::max);
    assert!(furthest > 0.0 && furthest < 1e-3, "{furthest}");
    // What is loaded next begins on the CPU.
    load(&thread, |_| {});
    wait(&snapshots, |s| s.generation == 2 && s.solver == "direct" && s.notice.is_some());
}

#[test]
fn reports_what_it_cannot_simulate_and_goes_on() {
    let (thread, snapshots) = thread();
    load(&thread, |state| state.position[3].x = f64::NAN);
    let failed = wait(&snapshots, |s| s.error.is_some());
    assert_eq!(failed.error.as_deref(), Some("the state is not finite"));
    thread.send(SimCommand::Play);
    load(&thread, |_| {});
    wait(&snapshots, |s| s.error.is_none() && s.generation == 2);
    let scene = Scene { time_step: -1.0, ..Scene::empty() };
    thread.send(SimCommand::SetScene(scene));
    let refused = wait(&snapshots, |s| s.error.is_some());
    assert_eq!(refused.error.as_deref(), Some("scene: time step is -1 s, and must be positive"));
}

#[test]
fn stopping_forgets_and_dropping_joins() {
    let (thread, snapshots) = thread();
    load(&thread, |_| {});
    wait(&snapshots, |_| true);
    thread.send(SimCommand::Play);
    thread.send(SimCommand::Stop);
    while snapshots.recv_timeout(Duration::from_secs(20)).expect("word in time").is_some() {}
    load(&thread, |_| {});
    thread.send(SimCommand::Play);
    drop(thread);
}
