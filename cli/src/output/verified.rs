//! A replay of a solution on the true system: the short form in every solve, the document and the words of `fdcc verify`.

use super::document::Span;
use super::ending::{Ending, EventEntry, events, state};
use super::named::Named;
use super::number::{scientific, short};
use super::saved::Saved;
use super::units::Units;
use crate::conditions::Condition;
use crate::stays::{Stay, name};
use crate::verification::Verified;
use comfy_table::{CellAlignment, Table, presets};
use fdcc_grammar::SourceFile;
use serde::Serialize;

/// What a replay says of a solution.
#[derive(Clone, Debug, Serialize)]
pub struct Verification {
    /// Whether the solution differs from the true system by no more than asked for.
    pub confirmed: bool,
    /// The largest gap and violation that is called confirmation.
    pub asked: f64,
    /// Whether the replay reached the last time.
    pub completed: bool,
    /// The objective of the replay.
    pub objective: Option<f64>,
    /// The largest difference to the solution over states and grid points, in units of max(1, |x|).
    pub state_gap: Option<f64>,
    /// The largest violation of a bound, a path or an end condition.
    pub constraint_violation: Option<f64>,
    /// Where that is.
    pub worst: Option<Worst>,
    pub events: usize,
}

/// A condition that a replay violates.
#[derive(Clone, Debug, Serialize)]
pub struct Worst {
    pub condition: String,
    /// When; nothing for a condition on the ends.
    pub time: Option<f64>,
    pub violation: f64,
    /// The state at that time, or at the end.
    pub state: Named<f64>,
}

impl Verification {
    /// `asked` is the largest difference that is called confirmation.
    pub fn new(verified: &Verified, asked: f64) -> Self {
        let worst = verified.worst().map(|condition| worst(verified, condition));
        let violation = worst.as_ref().map_or(0.0, |worst| worst.violation);
        let gap = verified.largest_gap();
        let is_whole = verified.is_whole;
        Verification {
            confirmed: is_whole && gap <= asked && violation <= asked,
            asked,
            completed: is_whole,
            objective: verified.simulation.objective,
            state_gap: is_whole.then_some(gap),
            constraint_violation: is_whole.then_some(violation),
            worst: worst.filter(|_| is_whole),
            events: verified.simulation.events.len(),
        }
    }

    /// The verdict in few words.
    pub fn words(&self) -> String {
        match (self.state_gap, self.constraint_violation) {
            (Some(gap), Some(violation)) if self.confirmed => {
                format!("confirmed on the true system to {}", scientific(gap.max(violation), 1))
            }
            (Some(_), Some(_)) => "NOT CONFIRMED on the true system".into(),
            _ => "and its replay on the true system does not reach the end".into(),
        }
    }
}

fn worst(verified: &Verified, condition: &Condition) -> Worst {
    let simulation = &verified.simulation;
    let at = |point: usize| simulation.states.iter().map(|column| column[point]).collect();
    let values: Vec<f64> = condition.point.map_or_else(|| simulation.end.clone(), at);
    Worst {
        condition: condition.label.clone(),
        time: condition.point.map(|point| simulation.time[point]),
        violation: condition.violation,
        state: state(&verified.system, &values),
    }
}

/// What `fdcc verify --json` prints.
#[derive(Serialize)]
pub struct Document {
    fdcc: String,
    pub model: String,
    /// Whether the text of the model is still the one that was solved.
    same_source: bool,
    #[serde(flatten)]
    ending: Ending,
    /// What the solution says of the objective.
    objective: Option<f64>,
    verification: Verification,
    state_gaps: Named<GapEntry>,
    conditions: Named<ConditionEntry>,
    events: Vec<EventEntry>,
    surfaces: Named<Vec<Span>>,
    #[serde(skip_serializing_if = "Units::is_empty")]
    units: Units,
}

#[derive(Serialize)]
struct GapEntry {
    gap: f64,
    time: f64,
}

#[derive(Serialize)]
struct ConditionEntry {
    violation: f64,
    time: Option<f64>,
}

impl Document {
    pub fn new(
        verified: &Verified,
        saved: &Saved,
        source: &SourceFile,
        same_source: bool,
        asked: f64,
    ) -> Self {
        let Verified { system, simulation, gaps, conditions, stays, .. } = verified;
        let gaps = gaps.iter().map(|it| (it.name.clone(), GapEntry { gap: it.gap, time: it.time }));
        let conditions = conditions.iter().map(|it| {
            let time = it.point.map(|point| simulation.time[point]);
            (it.label.clone(), ConditionEntry { violation: it.violation, time })
        });
        let span = |stay: &Stay| Span { mode: name(stay.mode).to_string(), from: stay.from, to: stay.to };
        let surfaces = stays.iter().enumerate().map(|(at, stays)| (system.name_of(at).to_string(), stays));
        let mut surfaces: Vec<(String, Vec<Span>)> =
            surfaces.map(|(name, stays)| (name, stays.iter().map(span).collect())).collect();
        // The components of a ball are one surface.
        surfaces.dedup_by(|later, first| later.0 == first.0);
        Document {
            fdcc: env!("CARGO_PKG_VERSION").to_string(),
            model: system.name.clone(),
            same_source,
            ending: Ending::new(system, simulation, source),
            objective: saved.objective,
            verification: Verification::new(verified, asked),
            state_gaps: gaps.collect(),
            conditions: conditions.collect(),
            events: events(system, simulation),
            surfaces: Named(surfaces),
            units: Units::default(),
        }
    }

    /// The same with the units of its values.
    pub fn in_units(self, units: Units) -> Self {
        Document { units, ..self }
    }

    /// Whether the solution is confirmed.
    pub fn is_confirmed(&self) -> bool {
        self.verification.confirmed
    }

    /// The verdict, and a table each for objective, states, conditions and surfaces.
    pub fn words(&self) -> String {
        let parts = [self.verdict(), self.numbers(), self.states(), self.met(), self.modes()];
        parts.into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join("\n")
    }

    fn verdict(&self) -> String {
        let Verification { asked, state_gap, constraint_violation, worst, .. } = &self.verification;
        let first = match (self.ending.why(), state_gap, constraint_violation) {
            (None, Some(gap), Some(violation)) => {
                let word = if self.is_confirmed() { "confirmed" } else { "NOT CONFIRMED" };
                let violated = match worst {
                    Some(worst) => {
                        let amount = self.units.violation(&worst.condition, *violation, 6);
                        format!("violates `{}` by {amount}", worst.condition)
                    }
                    None => "meets all conditions".into(),
                };
                format!(
                    " {word} on the true system: differs by {}, {violated} (asked for: {})\n",
                    short(*gap),
                    short(*asked)
                )
            }
            (why, ..) => {
                let why = why.unwrap_or_else(|| "it ended early".into());
                format!(" NOT CONFIRMED: the replay on the true system does not reach the end\n {why}\n")
            }
        };
        let place = worst.as_ref().filter(|worst| worst.time.is_some());
        let place = place.map(|it| {
            let time = self.units.value("time", it.time.unwrap_or(f64::NAN), 6);
            format!(" worst at t = {time}: {}\n", self.units.pairs(&it.state, 6))
        });
        first + &place.unwrap_or_default()
    }

    fn numbers(&self) -> String {
        let text = |value: f64| self.units.value("objective", value, 9);
        let of = |value: Option<f64>| value.map_or("-".to_string(), text);
        match (self.objective, self.verification.objective) {
            (_, None) => String::new(),
            (own, replayed) => format!(" objective {}   of the solution {}\n", of(replayed), of(own)),
        }
    }

    fn states(&self) -> String {
        let rows = self.state_gaps.0.iter();
        let rows = rows.map(|(name, it)| {
            vec![name.clone(), self.units.value(name, it.gap, 6), self.units.value("time", it.time, 6)]
        });
        let rows = rows.collect();
        table(["state", "differs by", "at t"].to_vec(), rows)
    }

    fn met(&self) -> String {
        let time = |time: Option<f64>| time.map(|it| self.units.value("time", it, 6)).unwrap_or_default();
        let rows = self.conditions.0.iter();
        let rows = rows.map(|(name, it)| vec![name.clone(), short(it.violation), time(it.time)]).collect();
        table(["condition", "violated by", "at t"].to_vec(), rows)
    }

    fn modes(&self) -> String {
        let rows = self.surfaces.0.iter().flat_map(|(name, spans)| {
            let digits = |time: f64| self.units.value("time", time, 9);
            spans.iter().map(move |it| vec![name.clone(), it.mode.clone(), digits(it.from), digits(it.to)])
        });
        table(["surface", "mode", "from", "to"].to_vec(), rows.collect())
    }
}

/// Aligned columns with a head; nothing without rows.
pub fn table(head: Vec<&str>, rows: Vec<Vec<String>>) -> String {
    if rows.is_empty() {
        return String::new();
    }
    let mut table = Table::new();
    table.load_style(presets::NOTHING);
    table.set_header(head);
    table.add_rows(rows);
    table.column_iter_mut().skip(1).for_each(|column| column.set_cell_alignment(CellAlignment::Right));
    table.lines().map(|line| line.trim_end().to_string() + "\n").collect()
}
