//! The solver is chosen in the window while the yarn moves.

#![allow(clippy::unwrap_used, clippy::panic, reason = "helpers of tests are tests, which clippy cannot see")]

use egui::accesskit::Role;
use egui_kittest::kittest::Queryable as _;
use tests::window::{Window, fabric};

/// Where the yarn is, how long it has been simulated and by what.
fn yarn(window: &Window) -> (Vec<glam::DVec3>, f64, &'static str) {
    let snapshot = window.editor().yarn().unwrap();
    (snapshot.state.position.clone(), snapshot.time_s, snapshot.solver)
}

#[test]
fn the_yarn_goes_on_by_another_solver_and_goes_back() {
    let (mut window, _) = fabric();
    window.press("Yarn");
    window.wait("yarn", |e| e.yarn().is_some_and(|s| !s.solver.is_empty()));
    let (laid, ..) = yarn(&window);
    window.press("Step");
    window.wait("a step", |e| e.yarn().is_some_and(|s| s.time_s > 0.0));
    let (before, time_s, solver) = yarn(&window);
    assert_ne!(solver, "gpu");
    window.harness.get_by_role_and_label(Role::ComboBox, "solver").click();
    window.rest();
    window.press("GPU");
    window.wait("the GPU", |e| e.yarn().is_some_and(|s| s.solver == "gpu"));
    let (after, same, _) = yarn(&window);
    let furthest = after.iter().zip(&before).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
    // What is left in single precision.
    assert!(furthest < 1e-6 && (same - time_s).abs() < 1e-12, "{furthest}");
    window.press("Step");
    window.wait("another step", |e| e.yarn().is_some_and(|s| s.time_s > time_s));
    assert_eq!(yarn(&window).2, "gpu");
    window.rest();
    window.keep("solver");
    window.press("Reset");
    window.wait("the beginning", |e| e.yarn().is_some_and(|s| s.time_s == 0.0));
    let (reset, ..) = yarn(&window);
    let furthest = reset.iter().zip(&laid).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
    assert!(furthest < 1e-6, "{furthest}");
}
