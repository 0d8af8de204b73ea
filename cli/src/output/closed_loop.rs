//! A closed loop: as JSON, and in words for people.

use super::named::Named;
use super::number::significant;
use super::plural;
use super::units::{Shown, Units};
use crate::command;
use crate::version::VERSION;
use fdcc::Controller;
use serde::Serialize;

/// What happened in a closed loop.
#[derive(Serialize)]
pub struct ClosedLoopDocument {
    fdcc: &'static str,
    pub model: String,
    /// The arguments that it was run with; absent where there is no command line.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    command: Vec<String>,
    plant: String,
    /// `completed`, or why it ended early.
    ended: &'static str,
    /// When each step begins, and the end of the last.
    time: Vec<f64>,
    /// Of the plant, at these times.
    states: Named<Vec<f64>>,
    /// One value for each step.
    controls: Named<Vec<f64>>,
    status: Vec<&'static str>,
    iterations: Vec<usize>,
    seconds: Vec<f64>,
    #[serde(skip_serializing_if = "Named::is_empty")]
    display_units: Named<Shown>,
    bounds: Named<[f64; 2]>,
    /// The text of the model that controls.
    source: String,
    #[serde(skip)]
    unsolved: usize,
}

/// One step of it.
pub struct ClosedLoopStep {
    pub time: f64,
    pub state: Vec<f64>,
    pub controls: Vec<f64>,
    pub status: &'static str,
    pub is_solved: bool,
    pub iterations: usize,
    pub seconds: f64,
}

impl ClosedLoopDocument {
    pub fn new(controller: &Controller, plant: &str, bounds: Named<[f64; 2]>) -> Self {
        let named = |name: &str| (name.to_owned(), Vec::new());
        ClosedLoopDocument {
            fdcc: VERSION,
            model: controller.model().name().to_owned(),
            command: command::given(),
            plant: plant.to_owned(),
            ended: "completed",
            time: Vec::new(),
            states: controller.states().map(named).collect(),
            controls: controller.controls().map(named).collect(),
            status: Vec::new(),
            iterations: Vec::new(),
            seconds: Vec::new(),
            display_units: Units::from(controller.model()).shown(),
            bounds,
            source: controller.model().source().text.to_string(),
            unsolved: 0,
        }
    }

    /// Adds a step.
    pub fn add(&mut self, step: ClosedLoopStep) {
        self.close(step.time, &step.state);
        for ((_, column), value) in self.controls.0.iter_mut().zip(step.controls) {
            column.push(value);
        }
        self.status.push(step.status);
        self.iterations.push(step.iterations);
        self.seconds.push(step.seconds);
        self.unsolved += usize::from(!step.is_solved);
    }

    /// Adds where the plant is.
    pub fn close(&mut self, time: f64, state: &[f64]) {
        self.time.push(time);
        for ((_, column), value) in self.states.0.iter_mut().zip(state) {
            column.push(*value);
        }
    }

    /// Says why it ended early.
    pub fn end(&mut self, why: &'static str) {
        self.ended = why;
    }

    /// Whether it came to its end and every step was solved.
    pub fn is_fine(&self) -> bool {
        self.ended == "completed" && self.unsolved == 0
    }

    /// The text of `MODEL.mpc.csv`: what each step began with and did.
    pub fn csv(&self) -> String {
        let names = self.states.0.iter().chain(&self.controls.0).map(|(name, _)| name.as_str());
        let head = ["t"].into_iter().chain(names).chain(["status", "iterations", "seconds"]);
        let mut text = head.collect::<Vec<_>>().join(",") + "\n";
        for (k, status) in self.status.iter().enumerate() {
            let columns = self.states.0.iter().chain(&self.controls.0);
            let mut row = vec![self.time[k].to_string()];
            row.extend(columns.map(|(_, column)| column[k].to_string()));
            row.push((*status).to_owned());
            row.extend([self.iterations[k].to_string(), self.seconds[k].to_string()]);
            text += &(row.join(",") + "\n");
        }
        text
    }

    /// ` 400 steps to t = 8 s, all solved: x = 1 m, v = 0 m/s`, and how long they took.
    pub fn words(&self, units: &Units) -> String {
        let time = self.time.last().copied().unwrap_or(f64::NAN);
        let steps = plural(self.status.len(), "step");
        let ended = if self.ended == "completed" { "" } else { self.ended };
        let solved = match self.unsolved {
            0 => "all solved".to_owned(),
            many => format!("{many} not solved"),
        };
        let states = self.states.0.iter().filter_map(|(name, column)| {
            Some(format!("{name} = {}", units.value(name, *column.last()?, 6)))
        });
        let states = states.collect::<Vec<_>>().join(", ");
        let time = units.value("time", time, 6);
        let mut seconds = self.seconds.clone();
        seconds.sort_by(f64::total_cmp);
        let part = |part: usize| {
            seconds.get((seconds.len() * part / 100).min(seconds.len().saturating_sub(1)))
        };
        let micro = |part_of: usize| significant(1e6 * part(part_of).copied().unwrap_or(0.0), 3);
        format!(
            " {steps} to {time}, {solved}{}{ended}: {states}\n a solve takes {} us in the median, \
             {} us in the 99th percentile\n",
            if ended.is_empty() { "" } else { "; " },
            micro(50),
            micro(99)
        )
    }
}
