//! The JSON document of a simulation, its table, and its words for people.

use super::named::Named;
use super::number::{short, significant};
use fdcc_grammar::SourceFile;
use fdcc_runtime::simulate::{Candidate, Event, Kind, Simulation, Status, System};
use serde::Serialize;
use std::fmt::Write;

/// One simulation. Numbers are written so that they read back to the same bits.
#[derive(Serialize)]
pub struct Document {
    fdcc: String,
    pub model: String,
    status: &'static str,
    time: Vec<f64>,
    states: Named<Vec<f64>>,
    events: Vec<EventEntry>,
    /// `time`, then the states.
    end: Named<f64>,
    integrals: Named<f64>,
    objective: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    not_unique: Option<NotUnique>,
    #[serde(skip_serializing_if = "Option::is_none")]
    zeno: Option<Zeno>,
    #[serde(skip_serializing_if = "Option::is_none")]
    not_finite: Option<NotFinite>,
    #[serde(skip_serializing_if = "Option::is_none")]
    step_limit: Option<StepLimit>,
    counts: Counts,
}

#[derive(Serialize)]
struct EventEntry {
    time: f64,
    surface: String,
    kind: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    jump: Option<String>,
    margin: f64,
    state: Named<f64>,
}

#[derive(Serialize)]
struct NotUnique {
    surface: String,
    time: f64,
    state: Named<f64>,
    candidates: Vec<String>,
}

#[derive(Serialize)]
struct Zeno {
    #[serde(skip_serializing_if = "Option::is_none")]
    jump: Option<String>,
    surface: String,
    limit_time: f64,
}

#[derive(Serialize)]
struct NotFinite {
    line: usize,
    of: String,
    time: f64,
    state: Named<f64>,
}

#[derive(Serialize)]
struct StepLimit {
    time: f64,
    state: Named<f64>,
}

#[derive(Serialize)]
struct Counts {
    steps: usize,
    rejected: usize,
    evaluations: usize,
}

impl Document {
    pub fn new(system: &System, simulation: &Simulation, source: &SourceFile) -> Self {
        let ends = simulation.end.iter().zip(&system.states);
        let integrals = ends.filter(|(_, state)| state.hidden);
        let columns = simulation.states.iter().zip(&system.states).filter(|(_, state)| !state.hidden);
        let mut end = vec![("time".to_string(), simulation.end_time)];
        end.extend(state(system, &simulation.end).0);
        let counts = simulation.counts;
        let mut document = Document {
            fdcc: env!("CARGO_PKG_VERSION").to_string(),
            model: system.name.clone(),
            status: "completed",
            time: simulation.time.clone(),
            states: columns.map(|(column, state)| (state.name.clone(), column.clone())).collect(),
            events: simulation.events.iter().map(|event| entry(system, event)).collect(),
            end: Named(end),
            integrals: integrals.map(|(value, state)| (state.name.clone(), *value)).collect(),
            objective: simulation.objective,
            not_unique: None,
            zeno: None,
            not_finite: None,
            step_limit: None,
            counts: Counts {
                steps: counts.steps,
                rejected: counts.rejected,
                evaluations: counts.evaluations,
            },
        };
        document.explain(system, simulation, source);
        document
    }

    /// The status, and the object that says why it is not `completed`.
    fn explain(&mut self, system: &System, simulation: &Simulation, source: &SourceFile) {
        let time = simulation.end_time;
        let state = state(system, &simulation.end);
        match &simulation.status {
            Status::Completed => {}
            Status::NotUnique { surface, candidates } => {
                self.status = "not_unique";
                let surface = system.name_of(*surface).to_owned();
                let candidates = candidates.iter().map(|it| candidate(system, it)).collect();
                self.not_unique = Some(NotUnique { surface, time, state, candidates });
            }
            Status::Zeno { jump, surface, limit_time } => {
                self.status = "zeno";
                let jump = jump.map(|jump| system.jumps[jump].name.clone());
                let surface = system.name_of(*surface).to_owned();
                self.zeno = Some(Zeno { jump, surface, limit_time: *limit_time });
            }
            Status::NotFinite(origin) => {
                self.status = "not_finite";
                let line = source.line_column(origin.span.0).line;
                self.not_finite = Some(NotFinite { line, of: origin.label.to_string(), time, state });
            }
            Status::StepLimit => {
                self.status = "step_limit";
                self.step_limit = Some(StepLimit { time, state });
            }
        }
    }

    /// The text of `MODEL.sim.csv`.
    pub fn csv(&self) -> String {
        let names: Vec<&str> = self.states.0.iter().map(|(name, _)| name.as_str()).collect();
        let mut text = format!("{}\n", [&["t"], names.as_slice()].concat().join(","));
        for (k, t) in self.time.iter().enumerate() {
            let row = self.states.0.iter().map(|(_, column)| column[k].to_string());
            let row: Vec<String> = std::iter::once(t.to_string()).chain(row).collect();
            text += &format!("{}\n", row.join(","));
        }
        text
    }

    /// The events, the end, and a verdict.
    pub fn words(&self) -> String {
        let mut text = String::new();
        for event in &self.events {
            let what =
                event.jump.as_deref().map_or(event.kind.replace('_', " "), |jump| format!("jump {jump}"));
            let (time, surface) = (significant(event.time, 12), &event.surface);
            let state = pairs(&event.state);
            writeln!(text, " {time:>16}  {surface:<10} {what:<16} {state}")
                .expect("a string takes everything");
        }
        let integrals = pairs(&self.integrals);
        let objective = self.objective.map(|value| format!("objective {}  ", significant(value, 12)));
        let last = self.verdict();
        text += &format!(" {last}\n end: {}\n", pairs(&self.end));
        if !integrals.is_empty() || objective.is_some() {
            text += &format!(" {}{integrals}\n", objective.unwrap_or_default());
        }
        text
    }

    fn verdict(&self) -> String {
        let events = super::plural(self.events.len(), "event");
        match (&self.not_unique, &self.zeno, &self.not_finite) {
            (Some(why), _, _) => format!(
                "not unique: at t = {} on `{}` the state could go on in several ways or in none that can be told: {}",
                short(why.time),
                why.surface,
                why.candidates.join(" | ")
            ),
            (_, Some(why), _) => zeno(why),
            (_, _, Some(why)) => {
                format!("not finite: `{}` (line {}) at t = {}", why.of, why.line, significant(why.time, 12))
            }
            _ if self.step_limit.is_some() => {
                "step limit: the system may be stiff, or its events may pile up".into()
            }
            _ => format!("completed: {events}, {} steps", self.counts.steps),
        }
    }
}

fn zeno(why: &Zeno) -> String {
    let (time, surface) = (significant(why.limit_time, 12), &why.surface);
    match &why.jump {
        Some(jump) => {
            format!(
                "zeno: the jumps `{jump}` pile up at t = {time}; say what follows with `then hold {surface}`"
            )
        }
        None => format!("zeno: `{surface}` is crossed infinitely often before t = {time}"),
    }
}

/// `x = 1  v = 0.5`
fn pairs(values: &Named<f64>) -> String {
    let pairs = values.0.iter().map(|(name, value)| format!("{name} = {}", significant(*value, 12)));
    pairs.collect::<Vec<_>>().join("  ")
}

/// The states without the integrals.
fn state(system: &System, values: &[f64]) -> Named<f64> {
    let shown = system.states.iter().zip(values).filter(|(state, _)| !state.hidden);
    shown.map(|(state, value)| (state.name.clone(), *value)).collect()
}

fn entry(system: &System, event: &Event) -> EventEntry {
    let jump = match event.kind {
        Kind::Jump(jump) => Some(system.jumps[jump].name.clone()),
        _ => None,
    };
    EventEntry {
        time: event.time,
        surface: system.name_of(event.surface).to_owned(),
        kind: kind_name(event.kind),
        jump,
        margin: event.margin,
        state: state(system, &event.state),
    }
}

fn kind_name(kind: Kind) -> &'static str {
    match kind {
        Kind::CrossesUp => "crosses_up",
        Kind::CrossesDown => "crosses_down",
        Kind::EntersSliding => "enters_sliding",
        Kind::LeavesUp => "leaves_up",
        Kind::LeavesDown => "leaves_down",
        Kind::Passes => "passes",
        Kind::Jump(_) => "jump",
        Kind::StartsSliding => "starts_sliding",
    }
}

/// `up`, or `edge up, slip slide` where several surfaces meet.
fn candidate(system: &System, candidate: &Candidate) -> String {
    let word = |side: i8| match side {
        1 => "up",
        -1 => "down",
        _ => "slide",
    };
    match candidate.sides.as_slice() {
        [(_, side)] => word(*side).to_string(),
        several => {
            let named = several.iter().map(|(i, side)| format!("{} {}", system.name_of(*i), word(*side)));
            named.collect::<Vec<_>>().join(", ")
        }
    }
}
