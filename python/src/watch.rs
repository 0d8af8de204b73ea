//! Work that takes long: other threads of Python run on, and Ctrl-C is heard.

use fdcc::Stop;
use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;
use std::ops::ControlFlow;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread;
use std::time::{Duration, Instant};

/// How often somebody looks for signals.
const BETWEEN_LOOKS: Duration = Duration::from_millis(20);

/// Checking and compiling go as deep as expressions are nested.
const STACK: usize = 64 << 20;

/// When work has to stop: after some seconds, at Ctrl-C, or where a function of the caller fails.
pub struct Watch {
    begin: Instant,
    limit: Option<Duration>,
    is_interrupted: AtomicBool,
    error: Mutex<Option<PyErr>>,
    looked: AtomicU64,
}

impl Watch {
    /// From now on for so many seconds; for ever without a limit, or with one that no clock has.
    pub fn new(limit: Option<f64>) -> Self {
        Watch {
            begin: Instant::now(),
            limit: limit.and_then(|seconds| Duration::try_from_secs_f64(seconds).ok()),
            is_interrupted: AtomicBool::new(false),
            error: Mutex::new(None),
            looked: AtomicU64::new(0),
        }
    }

    /// Seconds since the begin.
    pub fn seconds(&self) -> f64 {
        self.begin.elapsed().as_secs_f64()
    }

    /// Whether to go on.
    pub fn check(&self) -> ControlFlow<Stop> {
        self.look();
        if self.is_interrupted.load(Ordering::Relaxed) {
            return ControlFlow::Break(Stop::Interrupted);
        }
        match self.limit {
            Some(limit) if self.begin.elapsed() >= limit => ControlFlow::Break(Stop::TimeLimit),
            _ => ControlFlow::Continue(()),
        }
    }

    /// Lets Python handle its signals, now and then.
    fn look(&self) {
        let now = self.begin.elapsed().as_nanos() as u64;
        if now < self.looked.load(Ordering::Relaxed) + BETWEEN_LOOKS.as_nanos() as u64 {
            return;
        }
        self.looked.store(now, Ordering::Relaxed);
        self.hear();
    }

    /// Lets Python handle its signals; does nothing but on its main thread.
    fn hear(&self) {
        Python::attach(|py| self.note(py.check_signals()));
    }

    /// Stops the work where something failed.
    pub fn note(&self, done: PyResult<()>) {
        if let Err(error) = done {
            self.is_interrupted.store(true, Ordering::Relaxed);
            self.error.lock().expect("nobody panics with the lock").get_or_insert(error);
        }
    }

    /// What was raised meanwhile.
    pub fn raised(&self) -> PyResult<()> {
        let error = self.error.lock().expect("nobody panics with the lock").take();
        error.map_or(Ok(()), Err)
    }

    /// What was raised meanwhile but for Ctrl-C, of which the result of the work tells.
    pub fn raised_but_interrupt(&self, py: Python) -> PyResult<()> {
        let is_other = |error: &PyErr| !error.is_instance_of::<PyKeyboardInterrupt>(py);
        self.raised().or_else(|error| if is_other(&error) { Err(error) } else { Ok(()) })
    }

    /// Does work on a thread with a deep stack, and looks for signals meanwhile.
    pub fn aside<T: Send>(&self, py: Python, work: impl FnOnce() -> T + Send) -> T {
        py.detach(|| {
            thread::scope(|scope| {
                let (sender, result) = channel();
                let send = move || drop(sender.send(work()));
                let worker = thread::Builder::new().stack_size(STACK).spawn_scoped(scope, send);
                let worker = worker.expect("the system has a thread left");
                loop {
                    match result.recv_timeout(BETWEEN_LOOKS) {
                        Ok(result) => return result,
                        Err(RecvTimeoutError::Timeout) => self.hear(),
                        Err(RecvTimeoutError::Disconnected) => {
                            let panic = worker.join().expect_err("it has sent nothing");
                            std::panic::resume_unwind(panic)
                        }
                    }
                }
            })
        })
    }
}
