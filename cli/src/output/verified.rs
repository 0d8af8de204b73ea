//! A replay of a solution on the true system: the short form in every solve, the document and the
//! words of `fdcc verify`.

use super::document::Span;
use super::ending::{Ending, EventEntry, events, state};
use super::named::Named;
use super::number::{scientific, short};
use super::units::Units;
use crate::version::VERSION;
use comfy_table::{CellAlignment, Table, presets};
use fdcc::modes::name;
use fdcc::{Condition, Gap, LinkGap, Stay, TIME_OF};
use fdcc_grammar::SourceFile;
use fdcc_runtime::problem::Variable;
use serde::Serialize;

/// What a replay says of a solution.
#[derive(Clone, Debug, Serialize)]
pub struct Verification {
    /// Whether the solution differs from the true system by no more than asked for.
    pub confirmed: bool,
    /// The largest gap and violation that is called confirmation.
    pub asked: f64,
    /// Whether each phase was replayed by itself, from the state at which it begins in the
    /// solution; absent where there is one phase.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub phase_by_phase: bool,
    /// Whether the replay reached the last time.
    pub completed: bool,
    /// The objective of the replay.
    pub objective: Option<f64>,
    /// The largest difference to the solution over states and grid points, as a part of how far the
    /// state moves.
    pub state_gap: Option<f64>,
    /// Of which state that is; nothing where none differs.
    pub differs: Option<Differs>,
    /// The largest violation of a bound, a path or an end condition, as a part of the size of its
    /// terms.
    pub relative_violation: Option<f64>,
    /// The same in SI.
    pub constraint_violation: Option<f64>,
    /// Where that is.
    pub worst: Option<Worst>,
    pub events: usize,
    /// What the states do in the replay; absent of phases, which have their own.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub replay: Option<Replay>,
}

/// A replay has thousands of times; a picture needs no more than about these.
const SHOWN: usize = 500;

/// The states of a replay at some of its times, the first and the last among them.
#[derive(Clone, Debug, Serialize)]
pub struct Replay {
    pub time: Vec<f64>,
    pub states: Named<Vec<f64>>,
}

impl Replay {
    fn new(verified: &fdcc::Verification) -> Self {
        let states = verified.simulation.states.iter().zip(&verified.system.states);
        let states = states.filter(|(_, state)| !state.hidden);
        let shown = |(column, state): (&Vec<f64>, &Variable)| (state.name.clone(), thinned(column));
        let time = thinned(&verified.simulation.time);
        Replay { time, states: states.map(shown).collect() }
    }
}

fn thinned(column: &[f64]) -> Vec<f64> {
    let last = column.len().saturating_sub(1);
    let step = last.div_ceil(SHOWN).max(1);
    (0..last).step_by(step).chain([last]).filter_map(|k| column.get(k).copied()).collect()
}

/// The state that differs most for how far it moves.
#[derive(Clone, Debug, Serialize)]
pub struct Differs {
    pub state: String,
    /// In SI.
    pub difference: f64,
    pub time: f64,
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
    pub fn new(verified: &fdcc::Verification, asked: f64) -> Self {
        let worst = verified.worst().map(|condition| (condition.part, worst(verified, condition)));
        let (part, worst) = worst.unzip();
        let largest = verified.largest_gap().filter(|it| it.difference > 0.0);
        let differs =
            |it: &Gap| Differs { state: it.name.clone(), difference: it.difference, time: it.time };
        let (gap, part) = (largest.map_or(0.0, |it| it.part), part.unwrap_or(0.0));
        let is_whole = verified.is_whole;
        Verification {
            confirmed: verified.confirms(asked),
            asked,
            phase_by_phase: false,
            completed: is_whole,
            objective: verified.simulation.objective,
            state_gap: is_whole.then_some(gap),
            differs: largest.filter(|_| is_whole).map(differs),
            relative_violation: is_whole.then_some(part),
            constraint_violation: is_whole
                .then_some(worst.as_ref().map_or(0.0, |worst| worst.violation)),
            worst: worst.filter(|_| is_whole),
            events: verified.simulation.events.len(),
            replay: Some(Replay::new(verified)),
        }
    }

    /// Those of phases, with the links between their ends.
    pub fn of_phases(phases: &[(&str, &Verification)], links: &[LinkGap], asked: f64) -> Self {
        let named = |phase: &str, name: &str| format!("{phase}.{name}");
        let completed = phases.iter().all(|(_, it)| it.completed);
        let gap = |it: &Verification| it.state_gap.unwrap_or(0.0);
        let part = |it: &Verification| it.relative_violation.unwrap_or(0.0);
        let most = |of: &dyn Fn(&Verification) -> f64| {
            phases.iter().max_by(|a, b| of(a.1).total_cmp(&of(b.1))).copied()
        };
        let differs = most(&gap).and_then(|(phase, it)| {
            let of = it.differs.clone()?;
            Some(Differs { state: named(phase, &of.state), ..of })
        });
        let worst = most(&part).and_then(|(phase, it)| {
            let of = it.worst.clone()?;
            Some((part(it), Worst { condition: named(phase, &of.condition), ..of }))
        });
        let link = links.iter().max_by(|a, b| a.part.total_cmp(&b.part));
        let link = link.filter(|it| it.part > worst.as_ref().map_or(0.0, |(part, _)| *part));
        let worst = match link {
            Some(LinkGap { label, violation, part }) => {
                let (condition, state) = (label.clone(), Named::default());
                Some((*part, Worst { condition, time: None, violation: *violation, state }))
            }
            None => worst,
        };
        let (part, worst) = worst.unzip();
        let (gap, part) = (phases.iter().map(|(_, it)| gap(it)).fold(0.0, f64::max), part);
        let part = part.unwrap_or(0.0);
        let violation = worst.as_ref().map_or(0.0, |worst: &Worst| worst.violation);
        Verification {
            confirmed: completed && gap <= asked && part <= asked,
            asked,
            phase_by_phase: true,
            completed,
            objective: None,
            state_gap: completed.then_some(gap),
            differs: differs.filter(|_| completed),
            relative_violation: completed.then_some(part),
            constraint_violation: completed.then_some(violation),
            worst: worst.filter(|_| completed),
            events: phases.iter().map(|(_, it)| it.events).sum(),
            replay: None,
        }
    }

    /// The verdict in few words.
    pub fn words(&self) -> String {
        let how = if self.phase_by_phase { ", phase by phase," } else { "" };
        match (self.state_gap, self.relative_violation) {
            (Some(gap), Some(violation)) if self.confirmed => {
                let off = scientific(gap.max(violation), 1);
                format!("confirmed on the true system{how} to {off}")
            }
            (Some(_), Some(_)) => "NOT CONFIRMED on the true system".into(),
            _ => "and its replay on the true system does not reach the end".into(),
        }
    }

    /// By how much the state differs that differs most, in its unit.
    pub fn difference(&self, units: &Units) -> Option<String> {
        let (Differs { state, difference, .. }, part) = (self.differs.as_ref()?, self.state_gap?);
        let amount = units.value(measured(state), *difference, 6);
        Some(format!("`{state}` differs by {amount}, {} of its motion", short(part)))
    }

    /// By how much the condition is violated that is violated most, in its unit.
    pub fn violation(&self, units: &Units) -> Option<String> {
        let (worst, part) = (self.worst.as_ref()?, self.relative_violation?);
        let amount = units.violation(&worst.condition, worst.violation, 6);
        Some(format!("{amount}, {} of its terms", short(part)))
    }
}

/// What a difference is measured in: of a time of a jump that is time.
fn measured(name: &str) -> &str {
    if name.starts_with(TIME_OF) { "time" } else { name }
}

fn worst(verified: &fdcc::Verification, condition: &Condition) -> Worst {
    Worst {
        condition: condition.label.clone(),
        time: condition.time,
        violation: condition.violation,
        state: state(&verified.system, &condition.state),
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
    /// As a part of how far the state moves.
    gap: f64,
    /// In SI.
    difference: f64,
    time: f64,
}

#[derive(Serialize)]
struct ConditionEntry {
    violation: f64,
    /// As a part of the size of its terms.
    relative: f64,
    time: Option<f64>,
}

impl Document {
    pub fn new(
        verified: &fdcc::Verification,
        objective: Option<f64>,
        source: &SourceFile,
        same_source: bool,
        asked: f64,
    ) -> Self {
        let fdcc::Verification { system, simulation, gaps, conditions, stays, .. } = verified;
        let entry = |it: &Gap| GapEntry { gap: it.part, difference: it.difference, time: it.time };
        let gaps = gaps.iter().map(|it| (it.name.clone(), entry(it)));
        let conditions = conditions.iter().map(|it| {
            let (violation, relative, time) = (it.violation, it.part, it.time);
            (it.label.clone(), ConditionEntry { violation, relative, time })
        });
        let span =
            |stay: &Stay| Span { mode: name(stay.mode).to_string(), from: stay.from, to: stay.to };
        let surfaces =
            stays.iter().enumerate().map(|(at, stays)| (system.name_of(at).to_string(), stays));
        let mut surfaces: Vec<(String, Vec<Span>)> =
            surfaces.map(|(name, stays)| (name, stays.iter().map(span).collect())).collect();
        // The components of a ball are one surface.
        surfaces.dedup_by(|later, first| later.0 == first.0);
        Document {
            fdcc: VERSION.to_string(),
            model: system.name.clone(),
            same_source,
            ending: Ending::new(system, simulation, source),
            objective,
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
        let Verification { asked, completed, worst, .. } = &self.verification;
        let first = match self.ending.why().filter(|_| !completed) {
            None if *completed => {
                let word = if self.is_confirmed() { "confirmed" } else { "NOT CONFIRMED" };
                let differs = self.verification.difference(&self.units);
                let differs = differs.unwrap_or_else(|| "no state differs".into());
                let violated = worst.as_ref().zip(self.verification.violation(&self.units));
                let violated = violated
                    .map(|(worst, amount)| format!("violates `{}` by {amount}", worst.condition));
                let violated = violated.unwrap_or_else(|| "meets all conditions".into());
                format!(
                    " {word} on the true system: {differs}, {violated} (asked for: {})\n",
                    short(*asked)
                )
            }
            why => {
                let why = why.unwrap_or_else(|| "it ended early".into());
                format!(
                    " NOT CONFIRMED: the replay on the true system does not reach the end\n {why}\n"
                )
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
            (own, replayed) => {
                format!(" objective {}   of the solution {}\n", of(replayed), of(own))
            }
        }
    }

    fn states(&self) -> String {
        let row = |(name, it): &(String, GapEntry)| {
            let difference = self.units.value(measured(name), it.difference, 6);
            vec![name.clone(), difference, short(it.gap), self.units.value("time", it.time, 6)]
        };
        let rows = self.state_gaps.0.iter().map(row).collect();
        table(["state", "differs by", "of its motion", "at t"].to_vec(), rows)
    }

    fn met(&self) -> String {
        let time =
            |time: Option<f64>| time.map(|it| self.units.value("time", it, 6)).unwrap_or_default();
        let row = |(name, it): &(String, ConditionEntry)| {
            let violation = self.units.violation(name, it.violation, 6);
            vec![name.clone(), violation, short(it.relative), time(it.time)]
        };
        let rows = self.conditions.0.iter().map(row).collect();
        table(["condition", "violated by", "of its terms", "at t"].to_vec(), rows)
    }

    fn modes(&self) -> String {
        let rows = self.surfaces.0.iter().flat_map(|(name, spans)| {
            let digits = |time: f64| self.units.value("time", time, 9);
            spans
                .iter()
                .map(move |it| vec![name.clone(), it.mode.clone(), digits(it.from), digits(it.to)])
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
    table
        .column_iter_mut()
        .skip(1)
        .for_each(|column| column.set_cell_alignment(CellAlignment::Right));
    table.lines().map(|line| line.trim_end().to_string() + "\n").collect()
}
