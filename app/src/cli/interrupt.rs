//! Ctrl-C and progress: long work shows how far it is, and stops cleanly when asked to.

use anyhow::Result;
use indicatif::{ProgressBar, ProgressStyle};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};

static INTERRUPTED: AtomicBool = AtomicBool::new(false);
static LISTENING: OnceLock<()> = OnceLock::new();

/// Whether Ctrl-C has been pressed since the first call.
pub fn interrupted() -> bool {
    LISTENING.get_or_init(|| {
        if let Err(error) = ctrlc::set_handler(|| INTERRUPTED.store(true, Ordering::Relaxed)) {
            tracing::warn!("Ctrl-C will not stop cleanly: {error}");
        }
    });
    INTERRUPTED.load(Ordering::Relaxed)
}

/// A progress bar on standard error, if that is a terminal, for work of `length` milliseconds of simulated time.
pub fn progress_bar(length: f64, what: &'static str) -> Result<ProgressBar> {
    let bar = ProgressBar::new((1e3 * length).round() as u64).with_message(what);
    bar.set_style(ProgressStyle::with_template("{msg} {wide_bar} {pos}/{len} ms, {eta} to go")?);
    Ok(bar)
}

/// A progress bar on standard error, if that is a terminal, for work in a thousand parts.
pub fn work_bar(what: String) -> Result<ProgressBar> {
    let bar = ProgressBar::new(1000).with_message(what);
    bar.set_style(ProgressStyle::with_template("{msg} {wide_bar} {percent} %, {eta} to go")?);
    Ok(bar)
}

/// A count of steps on standard error, if that is a terminal, for work that ends when it is done.
pub fn step_counter(what: &'static str) -> Result<ProgressBar> {
    let counter = ProgressBar::new_spinner().with_prefix(what);
    counter.set_style(ProgressStyle::with_template("{spinner} {prefix}: step {pos}, {elapsed}, {msg}")?);
    Ok(counter)
}
