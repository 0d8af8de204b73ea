//! What a controller of C is, in safe Rust.

use fdcc::{Model, Options, Solution, Stop};
use std::ffi::{CStr, CString};
use std::ops::ControlFlow;
use std::time::{Duration, Instant};

/// How a call ended; the numbers are those of the header.
#[derive(Clone, Copy)]
pub enum Status {
    /// Solved, or nearly as accurate as asked for.
    Solved = 0,
    /// The best iterate when the time was over.
    TimeLimit = 1,
    /// Nothing was found.
    NotSolved = 2,
    /// The message says why.
    WrongCall = 3,
    /// A mistake of the library.
    Internal = 4,
}

/// A controller with its names and its last solution.
pub struct Controller {
    inner: fdcc::Controller,
    /// The names of the states.
    pub states: Vec<CString>,
    /// The names of the controls.
    pub controls: Vec<CString>,
    /// The names of the signals.
    pub signals: Vec<CString>,
    /// Why the last call was wrong.
    pub message: CString,
    /// Whether a call ended with a mistake of the library.
    pub is_broken: bool,
    budget: Option<Duration>,
}

/// A name of a model has no 0 in it.
fn c_text(text: &str) -> CString {
    CString::new(text.replace('\0', " ")).unwrap_or_default()
}

/// Puts as much of a text into a room as it has place for, with a 0 behind it.
pub fn fill(room: &mut [u8], text: &str) {
    let text = c_text(text);
    let bytes = text.as_bytes();
    let mut length = bytes.len().min(room.len() - 1);
    // A character is not cut.
    while length < bytes.len() && bytes[length] & 0xC0 == 0x80 {
        length -= 1;
    }
    room[..length].copy_from_slice(&bytes[..length]);
    room[length] = 0;
}

/// What is wrong, with the line of the model where that is known.
fn words(error: &fdcc::Error, text: &str) -> String {
    let fdcc::Error::Model(found) = error else { return error.to_string() };
    let line = |start: usize| text[..start].matches('\n').count() + 1;
    let all =
        found.iter().map(|it| format!("line {}: {}", line(it.span().start as usize), it.message));
    all.collect::<Vec<_>>().join("\n")
}

impl Controller {
    /// Of a text.
    pub fn new(text: &str, intervals: usize) -> Result<Self, String> {
        let made = Model::from_text("model", text).and_then(|it| it.controller(intervals));
        let inner = made.map_err(|error| words(&error, text))?;
        let states = inner.states().map(c_text).collect();
        let controls = inner.controls().map(c_text).collect();
        let signals = inner.signals().map(c_text).collect();
        let message = CString::default();
        Ok(Controller { inner, states, controls, signals, message, is_broken: false, budget: None })
    }

    /// Notes why a call is wrong.
    pub fn wrong(&mut self, why: &str) -> Status {
        self.message = c_text(why);
        Status::WrongCall
    }

    /// Notes that it is of no use any more.
    pub fn broken(&mut self) -> Status {
        (self.is_broken, self.message) = (true, c_text("a mistake of the library"));
        Status::Internal
    }

    /// Another value of a parameter.
    pub fn set(&mut self, parameter: Option<&str>, value: f64) -> Status {
        let Some(name) = parameter else { return self.wrong("the name is no text in UTF-8") };
        let set = self.inner.set(name, value);
        self.ended(set)
    }

    /// The values of a signal.
    pub fn set_signal(&mut self, signal: Option<&str>, values: &[f64]) -> Status {
        let Some(name) = signal else { return self.wrong("the name is no text in UTF-8") };
        let set = self.inner.set_signal(name, values);
        self.ended(set)
    }

    /// The time of the signals that were not given.
    pub fn set_time(&mut self, now: f64) -> Status {
        let set = self.inner.set_time(now);
        self.ended(set)
    }

    fn ended(&mut self, call: Result<(), fdcc::Error>) -> Status {
        match call {
            Ok(()) => self.fine(Status::Solved),
            Err(error) => self.wrong(&error.to_string()),
        }
    }

    /// The time for each step; none for 0.
    pub fn set_budget(&mut self, microseconds: u64) -> Status {
        self.budget = Some(Duration::from_micros(microseconds)).filter(|it| !it.is_zero());
        self.fine(Status::Solved)
    }

    fn fine(&mut self, status: Status) -> Status {
        self.message = CString::default();
        status
    }

    /// Solves from a state and fills in the first value of each control.
    pub fn step(&mut self, state: &[f64], controls: &mut [f64]) -> Status {
        let (begin, budget) = (Instant::now(), self.budget);
        let stop = || match budget {
            Some(budget) if begin.elapsed() >= budget => ControlFlow::Break(Stop::TimeLimit),
            _ => ControlFlow::Continue(()),
        };
        let options =
            Options { stop: &stop, executor: fdcc::Executor::serial(), ..Options::default() };
        let found = match self.inner.step(state, &options) {
            Ok(found) => found,
            Err(error) => return self.wrong(&error.to_string()),
        };
        let (first, _) = found.first_controls();
        controls.iter_mut().zip(first).for_each(|(value, first)| *value = first);
        let status = match found.status() {
            fdcc::Status::TimeLimit => Status::TimeLimit,
            _ if found.is_solved() => Status::Solved,
            _ => Status::NotSolved,
        };
        self.fine(status)
    }

    /// The last solution.
    pub fn last(&self) -> Option<&Solution> {
        self.inner.last()
    }

    /// A state at the grid points.
    pub fn state(&self, at: usize) -> Option<&[f64]> {
        self.last()?.state(name(self.states.get(at)?)?)
    }

    /// A control on the intervals.
    pub fn control(&self, at: usize) -> Option<&[f64]> {
        self.last()?.control(name(self.controls.get(at)?)?)
    }
}

fn name(of: &CStr) -> Option<&str> {
    of.to_str().ok()
}
