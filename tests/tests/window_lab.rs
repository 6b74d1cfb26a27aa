//! Experiments in the window.

use egui_kittest::kittest::Queryable as _;
use std::time::{Duration, Instant};
use tests::window::fabric;

/// An experiment runs beside the window, its curve grows, and it can be given up.
#[test]
fn an_experiment_shows_its_curve_while_it_runs_and_can_be_stopped() {
    let (mut window, _) = fabric();
    window.press("Experiments");
    window.harness.get_by_label("Start").click();
    window.harness.step();
    let mut wait = |label: &str| {
        let begin = Instant::now();
        while window.harness.query_by_label(label).is_none() {
            assert!(begin.elapsed() < Duration::from_secs(60), "no '{label}'");
            std::thread::sleep(Duration::from_millis(50));
            window.harness.step();
        }
    };
    wait("Stop");
    // The title of its plot.
    wait("2 × 2 rib drawing in");
    window.keep("experiments");
    window.harness.get_by_label("Stop").click();
    window.harness.step();
    let begin = Instant::now();
    while window.harness.query_by_label("stopped").is_none() {
        assert!(begin.elapsed() < Duration::from_secs(20), "it goes on");
        std::thread::sleep(Duration::from_millis(50));
        window.harness.step();
    }
}
