//! Virtual textile experiments beside the window's own fabric: one at a time, in a thread of its own, its curves live.

use crate::lab::{Direction, Experiment, Report, Setup, plot};
use crate::library::ENTRIES;
use crate::window::editor::Editor;
use clap::ValueEnum as _;
use egui::{ComboBox, Context, Ui};
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// Time between two looks at a running experiment.
const LOOK: Duration = Duration::from_millis(200);
/// Size of the window, height of a plot, and room for the name of its lower axis [points].
const SIZE: [f32; 2] = [540.0, 600.0];
const PLOT: f32 = 300.0;
const AXIS: f32 = 20.0;

/// What the panel remembers.
pub struct State {
    /// Whether it shows.
    pub open: bool,
    chosen: Experiment,
    setup: Setup,
    run: Option<Run>,
}

impl Default for State {
    fn default() -> Self {
        Self { open: false, chosen: Experiment::RibDrawIn, setup: Setup::default(), run: None }
    }
}

/// An experiment that goes on or is done. Dropping it stops it.
struct Run {
    experiment: Experiment,
    seen: Arc<Mutex<Seen>>,
    stopped: Arc<AtomicBool>,
}

/// What is known of it so far.
#[derive(Default)]
struct Seen {
    /// From 0 to 1.
    done: f64,
    report: Arc<Report>,
    /// How it ended, if it has.
    end: Option<Result<(), String>>,
}

impl Run {
    /// Starts an experiment.
    ///
    /// # Errors
    /// The system has no thread to give.
    fn start(experiment: Experiment, setup: Setup) -> std::io::Result<Self> {
        let (seen, stopped) = (Arc::<Mutex<Seen>>::default(), Arc::<AtomicBool>::default());
        let run = Self { experiment, seen: Arc::clone(&seen), stopped: Arc::clone(&stopped) };
        let lock = move |change: &mut dyn FnMut(&mut Seen)| {
            change(&mut seen.lock().unwrap_or_else(PoisonError::into_inner));
        };
        std::thread::Builder::new().name("experiment".to_owned()).spawn(move || {
            let mut told = Instant::now();
            let result = experiment.run(&setup, &mut |done, report| {
                if told.elapsed() > LOOK {
                    told = Instant::now();
                    let report = Arc::new(report.clone());
                    lock(&mut |seen| (seen.done, seen.report) = (done, Arc::clone(&report)));
                }
                if stopped.load(Ordering::Relaxed) {
                    ControlFlow::Break(())
                } else {
                    ControlFlow::Continue(())
                }
            });
            let (report, end) = match result {
                Ok(report) => (Some(Arc::new(report)), Ok(())),
                Err(error) => (None, Err(format!("{error:#}"))),
            };
            lock(&mut |seen| {
                seen.report = report.clone().unwrap_or_else(|| Arc::clone(&seen.report));
                seen.end = Some(end.clone());
            });
        })?;
        Ok(run)
    }
}

impl Drop for Run {
    fn drop(&mut self) {
        self.stopped.store(true, Ordering::Relaxed);
    }
}

/// Shows it, if it is open.
pub fn show(editor: &mut Editor, ctx: &Context) {
    let state = &mut editor.panel.lab;
    let mut open = state.open;
    let window = egui::Window::new("Experiments").open(&mut open).vscroll(true);
    window.default_pos([240.0, 60.0]).default_size(SIZE).show(ctx, |ui| {
        choose(state, ui);
        let Some(run) = &state.run else { return };
        let (experiment, stopped) = (run.experiment, Arc::clone(&run.stopped));
        let (done, report, end) = {
            let seen = run.seen.lock().unwrap_or_else(PoisonError::into_inner);
            (seen.done, Arc::clone(&seen.report), seen.end.clone())
        };
        ui.separator();
        match end {
            None => {
                ui.horizontal(|ui| {
                    if ui.button("Stop").on_hover_text("Gives the experiment up").clicked() {
                        stopped.store(true, Ordering::Relaxed);
                    }
                    let bar = egui::ProgressBar::new(done as f32).text(experiment.name());
                    ui.add(bar.desired_width(300.0));
                });
                ui.ctx().request_repaint_after(LOOK);
            }
            Some(Ok(())) => _ = ui.label(format!("{} is done", experiment.name())),
            Some(Err(error)) => _ = ui.label(error),
        }
        found(&report, ui);
    });
    editor.panel.lab.open = open;
}

/// Which experiment, and on what.
fn choose(state: &mut State, ui: &mut Ui) {
    ui.horizontal(|ui| {
        ComboBox::from_label("experiment").selected_text(state.chosen.name()).show_ui(ui, |ui| {
            for experiment in Experiment::value_variants().iter().copied() {
                ui.selectable_value(&mut state.chosen, experiment, experiment.name())
                    .on_hover_text(experiment.about());
            }
        });
        if ui.button("Start").on_hover_text("Ends the one that goes on, if any").clicked() {
            match Run::start(state.chosen, state.setup.clone()) {
                Ok(run) => state.run = Some(run),
                Err(error) => tracing::warn!("no experiment: {error}"),
            }
        }
    });
    ui.label(state.chosen.about());
    if matches!(state.chosen, Experiment::Stretch | Experiment::Shear) {
        let chosen = state.setup.pattern.as_deref();
        let name = ENTRIES.iter().find(|e| Some(e.text) == chosen).map_or("the usual one", |e| e.title);
        let mut pattern = chosen.map(str::to_owned);
        ComboBox::from_label("fabric").selected_text(name).show_ui(ui, |ui| {
            ui.selectable_value(&mut pattern, None, "the usual one");
            for entry in ENTRIES.iter() {
                ui.selectable_value(&mut pattern, Some(entry.text.to_owned()), entry.title);
            }
        });
        state.setup.pattern = pattern;
    }
    if state.chosen == Experiment::Stretch {
        ui.horizontal(|ui| {
            for (direction, name) in
                [(Direction::Course, "along the course"), (Direction::Wale, "along the wale")]
            {
                ui.radio_value(&mut state.setup.direction, direction, name);
            }
        });
    }
}

/// Curves and figures so far.
fn found(report: &Report, ui: &mut Ui) {
    for shown in &report.plots {
        ui.strong(&shown.title);
        ui.allocate_ui(egui::vec2(ui.available_width(), PLOT), |ui| plot::show(ui, shown));
        ui.add_space(AXIS);
    }
    report.remarks.iter().for_each(|remark| _ = ui.label(remark));
    egui::Grid::new("figures").striped(true).show(ui, |ui| {
        for (name, value) in &report.figures {
            ui.label(name);
            ui.label(format!("{value:.4}"));
            ui.end_row();
        }
    });
}
