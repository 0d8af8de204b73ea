//! When to stop a solve: Ctrl-C and the time limit.

use fdcc_runtime::nlp::Stop;
use std::ops::ControlFlow;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

static INTERRUPTED: OnceLock<&'static AtomicBool> = OnceLock::new();

/// From now on Ctrl-C asks solves to stop; a second one ends the program.
pub fn catch_interrupts() {
    static FLAG: AtomicBool = AtomicBool::new(false);
    // Without a handler Ctrl-C ends the program at once: worse, but no reason to fail.
    let _ = ctrlc::set_handler(|| {
        if FLAG.swap(true, Ordering::Relaxed) {
            std::process::exit(130);
        }
    });
    INTERRUPTED.get_or_init(|| &FLAG);
}

/// The moment at which a solve has to stop.
#[derive(Clone, Copy, Debug)]
pub struct Deadline(Option<Instant>);

impl Deadline {
    /// So many seconds from now.
    pub fn after(seconds: Option<f64>) -> Self {
        let limit = seconds.and_then(|seconds| Duration::try_from_secs_f64(seconds).ok());
        Deadline(limit.and_then(|limit| Instant::now().checked_add(limit)))
    }

    /// Whether to go on.
    pub fn check(&self) -> ControlFlow<Stop> {
        if INTERRUPTED.get().is_some_and(|flag| flag.load(Ordering::Relaxed)) {
            return ControlFlow::Break(Stop::Interrupted);
        }
        match self.0 {
            Some(limit) if Instant::now() >= limit => ControlFlow::Break(Stop::TimeLimit),
            _ => ControlFlow::Continue(()),
        }
    }
}
