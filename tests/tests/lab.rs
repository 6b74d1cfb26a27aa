//! Experiments from the command line: figures, tables, plots and pictures.

use tests::Program;

/// The figures that scripts read, and files that hold what was found.
#[test]
fn rib_draws_in_and_leaves_what_was_measured() {
    let program = Program::new(env!("CARGO_BIN_EXE_purlwise-tested"));
    let found = program.json(&["lab", "rib-draw-in", "--out", "results"]);
    assert_eq!(found["experiment"], "rib-draw-in");
    let figure = |name: &str| found["figures"][name].as_f64().unwrap();
    let (laid, relaxed) = (figure("laid_width_mm"), figure("relaxed_width_mm"));
    assert!((laid - 57.0).abs() < 0.1 && relaxed < 0.6 * laid, "{laid} -> {relaxed}");
    let files: Vec<&str> = found["files"].as_array().unwrap().iter().map(|f| f.as_str().unwrap()).collect();
    let csv = files.iter().find(|f| f.ends_with(".csv")).unwrap();
    let text = String::from_utf8(program.read(csv)).unwrap();
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines[0], "time_s,width_mm");
    let last: Vec<f64> = lines[lines.len() - 1].split(',').map(|x| x.parse().unwrap()).collect();
    assert!((last[1] - relaxed).abs() < 1e-3, "{last:?}");
    let plot = files.iter().find(|f| f.ends_with("-plot.png")).unwrap();
    let plot = image::load_from_memory(&program.read(plot)).unwrap().to_rgb8();
    // The curve is blue.
    let blue = plot.pixels().filter(|p| p[2] > p[0].saturating_add(80)).count();
    assert!(blue > 500, "{blue} pixels of curve");
    assert!(files.iter().filter(|f| f.ends_with(".png")).count() >= 3);
}

#[test]
fn a_pattern_that_cannot_be_knitted_is_an_error() {
    let program = Program::new(env!("CARGO_BIN_EXE_purlwise-tested"));
    program.write("bad.ks", "Row 1: frobnicate.\n");
    let run = program.run(&["lab", "stretch", "--pattern", "bad.ks", "--out", "results"]);
    assert_eq!(run.status, Some(1));
    assert_eq!(run.stderr.lines().filter(|l| l.starts_with("purlwise:")).count(), 1, "{}", run.stderr);
    let run = program.run(&["lab", "no-such-thing"]);
    assert_eq!(run.status, Some(2));
}
