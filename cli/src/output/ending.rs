//! How a simulation ended, and the object that says why it did not reach the last time.

use super::named::Named;
use super::units::Units;
use fdcc::names::event_name;
use fdcc_grammar::SourceFile;
use fdcc_runtime::nlp::Stop;
use fdcc_runtime::problem::Origin;
use fdcc_runtime::simulate::{Candidate, Event, EventKind, Order, Simulation, Status, System};
use serde::Serialize;

/// The status, and one object that explains it unless it is `completed`.
#[derive(Clone, Serialize)]
pub struct Ending {
    status: &'static str,
    #[serde(flatten)]
    why: Option<Why>,
}

/// Why a simulation ended early; the name of the variant is that of the object.
#[derive(Clone, Serialize)]
#[serde(rename_all = "snake_case")]
enum Why {
    NotUnique {
        surface: String,
        time: f64,
        state: Named<f64>,
        candidates: Vec<String>,
    },
    Zeno {
        #[serde(skip_serializing_if = "Option::is_none")]
        jump: Option<String>,
        surface: String,
        limit_time: f64,
        #[serde(skip_serializing_if = "Option::is_none")]
        unsettled: Option<String>,
    },
    NotFinite {
        line: usize,
        of: String,
        time: f64,
        state: Named<f64>,
    },
    Discontinuous {
        surface: String,
        time: f64,
        state: Named<f64>,
    },
    NotHeld {
        surface: String,
        time: f64,
        state: Named<f64>,
    },
    StepLimit {
        time: f64,
        state: Named<f64>,
    },
    TimeLimit {
        time: f64,
        state: Named<f64>,
    },
    Interrupted {
        time: f64,
        state: Named<f64>,
    },
}

impl Ending {
    pub fn new(system: &System, simulation: &Simulation, source: &SourceFile) -> Self {
        let time = simulation.end_time;
        let state = state(system, &simulation.end);
        let surface_name = |at: &usize| system.name_of(*at).to_owned();
        let (status, why) = match &simulation.status {
            Status::Completed => return Ending { status: "completed", why: None },
            Status::NotUnique { surface, candidates } => {
                let candidates = candidates.iter().map(|it| candidate(system, it)).collect();
                let surface = surface_name(surface);
                ("not_unique", Why::NotUnique { surface, time, state, candidates })
            }
            Status::Zeno { jump, surface, limit_time, unsettled } => {
                let jump = jump.map(|jump| system.jumps[jump].name.clone());
                let unsettled = unsettled.map(|state| system.states[state].name.clone());
                let (surface, limit_time) = (surface_name(surface), *limit_time);
                ("zeno", Why::Zeno { jump, surface, limit_time, unsettled })
            }
            Status::NotFinite(origin) => {
                let (line, of) = place(system, simulation, origin, source);
                ("not_finite", Why::NotFinite { line, of, time, state })
            }
            Status::Discontinuous { surface } => {
                let surface = surface_name(surface);
                ("discontinuous", Why::Discontinuous { surface, time, state })
            }
            Status::NotHeld { surface } => {
                ("not_held", Why::NotHeld { surface: surface_name(surface), time, state })
            }
            Status::StepLimit => ("step_limit", Why::StepLimit { time, state }),
            Status::Stopped(Stop::TimeLimit) => ("time_limit", Why::TimeLimit { time, state }),
            Status::Stopped(Stop::Interrupted) => ("interrupted", Why::Interrupted { time, state }),
        };
        Ending { status, why: Some(why) }
    }

    /// Why the last time was not reached, in words.
    pub fn why(&self, units: &Units) -> Option<String> {
        let shown = |time: f64, digits| units.value("time", time, digits);
        Some(match self.why.as_ref()? {
            Why::NotUnique { surface, time, candidates, .. } => {
                not_unique(surface, &shown(*time, 6), candidates)
            }
            Why::Zeno { jump, surface, limit_time, unsettled } => {
                let time = shown(*limit_time, 12);
                zeno([jump.as_deref(), unsettled.as_deref()], surface, &time)
            }
            Why::NotFinite { line, of, time, .. } => {
                format!("not finite: `{of}` (line {line}) at t = {}", shown(*time, 12))
            }
            Why::Discontinuous { surface, time, .. } => {
                format!(
                    "the switching function of `{surface}` jumps over 0 at t = {}: a surface is \
                     where it is 0; write one that is continuous there",
                    shown(*time, 12)
                )
            }
            Why::NotHeld { surface, time, .. } => {
                format!(
                    "not held: at t = {} `{surface}` moves away from what rests on it: after `then \
                     hold` speeds stand still; write the motion relative to the surface, whose \
                     speed is 0 at rest",
                    shown(*time, 6)
                )
            }
            Why::StepLimit { .. } => {
                "step limit: its events may pile up or follow each other faster than times can be \
                 told apart, its tolerances may be too small, or it is stiff and the method is \
                 explicit"
                    .into()
            }
            Why::TimeLimit { time, .. } => {
                format!("time limit: it came to t = {}", shown(*time, 6))
            }
            Why::Interrupted { time, .. } => format!("interrupted at t = {}", shown(*time, 6)),
        })
    }
}

/// The line and the name of what has no value; a start without one is to blame before all that is
/// computed from it.
fn place(
    system: &System,
    simulation: &Simulation,
    origin: &Origin,
    source: &SourceFile,
) -> (usize, String) {
    let line = |origin: &Origin| source.line_column(origin.span.0).line;
    let start = system.states.iter().zip(&system.start).find(|(_, start)| !start.is_finite());
    match start.filter(|_| simulation.end_time == system.interval[0]) {
        Some((state, _)) => (line(&state.origin), format!("{}(start)", state.name)),
        None => (line(origin), origin.label.to_string()),
    }
}

fn not_unique(surface: &str, time: &str, candidates: &[String]) -> String {
    let ways = match candidates {
        [] => "in no single way that can be told".to_string(),
        [only] => format!("like this, but perhaps also otherwise: {only}"),
        several => format!("in several ways: {}", several.join(" | ")),
    };
    format!("not unique: at t = {time} on `{surface}` the state could go on {ways}")
}

fn zeno([jump, unsettled]: [Option<&str>; 2], surface: &str, time: &str) -> String {
    match (jump, unsettled) {
        (Some(jump), None) => {
            format!(
                "zeno: the jumps `{jump}` pile up at t = {time}; say what follows with `then hold \
                 {surface}`"
            )
        }
        (Some(jump), Some(state)) => {
            format!(
                "zeno: the jumps `{jump}` pile up at t = {time}, and change `{state}` infinitely \
                 often, to no limit that can be told; end them with `at most n`"
            )
        }
        (None, _) => format!("zeno: `{surface}` is crossed infinitely often before t = {time}"),
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
            let named =
                several.iter().map(|(i, side)| format!("{} {}", system.name_of(*i), word(*side)));
            named.collect::<Vec<_>>().join(", ")
        }
    }
}

/// An event.
#[derive(Clone, Serialize)]
pub struct EventEntry {
    pub time: f64,
    pub surface: String,
    kind: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    jump: Option<String>,
    pub margin: f64,
    /// The same as `after`.
    pub state: Named<f64>,
    before: Named<f64>,
    after: Named<f64>,
}

/// Two jumps at one time, which lead elsewhere in the other order.
#[derive(Clone, Serialize)]
pub struct OrderEntry {
    time: f64,
    /// The one that acted first, then the other.
    jumps: [String; 2],
}

/// Where the order of jumps matters.
pub fn orders(system: &System, simulation: &Simulation) -> Vec<OrderEntry> {
    let name = |jump: usize| system.jumps[jump].name.clone();
    let entry = |it: &Order| OrderEntry { time: it.time, jumps: it.jumps.map(name) };
    simulation.orders.iter().map(entry).collect()
}

impl OrderEntry {
    /// What is to be known of it.
    pub fn words(&self, units: &Units) -> String {
        let ([first, other], time) = (&self.jumps, units.value("time", self.time, 6));
        format!(
            "`{first}` and `{other}` jump together at t = {time}, and lead elsewhere in the other \
             order; the surface that is declared first went first"
        )
    }
}

/// All events in the order of time.
pub fn events(system: &System, simulation: &Simulation) -> Vec<EventEntry> {
    simulation.events.iter().map(|event| entry(system, event)).collect()
}

impl EventEntry {
    /// `crosses up`, or `jump bounce`.
    pub fn what(&self) -> String {
        self.jump.as_deref().map_or(self.kind.replace('_', " "), |jump| format!("jump {jump}"))
    }
}

fn entry(system: &System, event: &Event) -> EventEntry {
    let jump = match event.kind {
        EventKind::Jump(jump) => Some(system.jumps[jump].name.clone()),
        _ => None,
    };
    EventEntry {
        time: event.time,
        surface: system.name_of(event.surface).to_owned(),
        kind: event_name(event.kind),
        jump,
        margin: event.margin,
        state: state(system, &event.after),
        before: state(system, &event.before),
        after: state(system, &event.after),
    }
}

/// The states without the integrals.
pub fn state(system: &System, values: &[f64]) -> Named<f64> {
    let shown = system.states.iter().zip(values).filter(|(state, _)| !state.hidden);
    shown.map(|(state, value)| (state.name.clone(), *value)).collect()
}
