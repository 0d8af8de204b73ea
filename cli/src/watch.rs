//! When to stop: Ctrl-C and the time limit.

use fdcc_runtime::nlp::Stop;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread;
use std::time::{Duration, Instant};

static INTERRUPTED: AtomicBool = AtomicBool::new(false);

/// The exit code of a program that Ctrl-C ended, by the convention of shells.
const KILLED_BY_INTERRUPT: i32 = 130;

/// How often somebody who waits for other work looks whether to go on.
const BETWEEN_LOOKS: Duration = Duration::from_millis(20);

/// Checking and compiling go as deep as expressions are nested.
const STACK: usize = 64 << 20;

/// From now on Ctrl-C asks solves to stop; a second one ends the program.
pub fn catch_interrupts() {
    // Without a handler Ctrl-C ends the program at once: worse, but no reason to fail.
    let _ = ctrlc::set_handler(|| {
        if INTERRUPTED.swap(true, Ordering::Relaxed) {
            std::process::exit(KILLED_BY_INTERRUPT);
        }
    });
}

/// Whether Ctrl-C has been pressed.
pub fn is_interrupted() -> bool {
    INTERRUPTED.load(Ordering::Relaxed)
}

/// The moment at which a solve has to stop.
#[derive(Clone, Copy, Debug)]
pub struct Deadline(Option<Instant>);

impl Deadline {
    /// Only Ctrl-C stops it, where that is caught.
    pub const NEVER: Deadline = Deadline(None);

    /// So many seconds from `begin`; none where there is no limit, or one that no clock reaches.
    pub fn after(begin: Instant, seconds: Option<f64>) -> Self {
        let limit = seconds.and_then(|seconds| Duration::try_from_secs_f64(seconds).ok());
        Deadline(limit.and_then(|limit| begin.checked_add(limit)))
    }

    /// Whether to go on.
    pub fn check(&self) -> ControlFlow<Stop> {
        if is_interrupted() {
            return ControlFlow::Break(Stop::Interrupted);
        }
        match self.0 {
            Some(limit) if Instant::now() >= limit => ControlFlow::Break(Stop::TimeLimit),
            _ => ControlFlow::Continue(()),
        }
    }

    /// Does work that cannot be asked to stop, such as compiling. Where it takes too long it is
    /// left alone; it ends with the program.
    pub fn within<T: Send + 'static>(
        &self,
        work: impl FnOnce() -> T + Send + 'static,
    ) -> Result<T, Stop> {
        let (sender, result) = channel();
        let worker =
            thread::Builder::new().stack_size(STACK).spawn(move || drop(sender.send(work())));
        let worker = worker.expect("the system has a thread left");
        loop {
            match result.recv_timeout(BETWEEN_LOOKS) {
                Ok(result) => return Ok(result),
                Err(RecvTimeoutError::Timeout) => {
                    if let ControlFlow::Break(stop) = self.check() {
                        return Err(stop);
                    }
                }
                Err(RecvTimeoutError::Disconnected) => {
                    let panic = worker.join().expect_err("it has sent nothing");
                    std::panic::resume_unwind(panic)
                }
            }
        }
    }
}
