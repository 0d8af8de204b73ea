//! The document and the words of `fdcc verify`.

use super::ending::{Ending, EventEntry, events};
use super::modes::Span;
use super::named::Named;
use super::number::short;
use super::table::with_head;
use super::units::{Shown, Units};
use super::verification::{Verification, measured};
use crate::command;
use crate::version::VERSION;
use fdcc::modes::name;
use fdcc::{Gap, LinkGap, Record, Stay};
use fdcc_grammar::SourceFile;
use serde::Serialize;

/// What `fdcc verify --json` prints.
#[derive(Serialize)]
pub struct VerifyDocument {
    fdcc: String,
    pub model: String,
    /// The arguments that it was run with; absent in phases.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    command: Vec<String>,
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
    #[serde(flatten)]
    picture: Picture,
}

/// What a picture of it needs beside its numbers: the solution, beside which the replay is drawn.
#[derive(Default, Serialize)]
struct Picture {
    time: Vec<f64>,
    states: Named<Vec<f64>>,
    controls: Named<Vec<f64>>,
    #[serde(skip_serializing_if = "Named::is_empty")]
    display_units: Named<Shown>,
    /// The text of the model; absent in phases.
    #[serde(skip_serializing_if = "String::is_empty")]
    source: String,
}

/// What `fdcc verify --json` prints of a model with phases.
#[derive(Serialize)]
pub struct VerifyPhasesDocument {
    fdcc: String,
    pub model: String,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    command: Vec<String>,
    /// Whether the text of the model is still the one that was solved.
    same_source: bool,
    /// What the solution says of the objective.
    objective: Option<f64>,
    verification: Verification,
    /// How far the conditions of links are violated by the ends of the replays.
    links: Named<ConditionEntry>,
    phases: Named<VerifyDocument>,
    #[serde(skip_serializing_if = "Units::is_empty")]
    units: Units,
    #[serde(flatten)]
    picture: Picture,
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

impl VerifyDocument {
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
        VerifyDocument {
            fdcc: VERSION.to_string(),
            model: system.name.clone(),
            command: Vec::new(),
            same_source,
            ending: Ending::new(system, simulation, source),
            objective,
            verification: Verification::new(verified, asked),
            state_gaps: gaps.collect(),
            conditions: conditions.collect(),
            events: events(system, simulation),
            surfaces: Named(surfaces),
            units: Units::default(),
            picture: Picture::default(),
        }
    }

    /// The same with the units of its values.
    pub fn in_units(mut self, units: Units) -> Self {
        self.picture.display_units = units.shown();
        VerifyDocument { units, ..self }
    }

    /// The same with the solution that was replayed; `source` is the text of its model, or nothing
    /// in a phase.
    pub fn of_solution(mut self, record: &Record, source: &str) -> Self {
        let display_units = self.picture.display_units;
        self.picture = Picture { display_units, ..Picture::new(record, source) };
        self.command = command::given();
        self
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

    /// The tables of a phase.
    fn tables(&self) -> String {
        let parts = [self.states(), self.met(), self.modes()];
        parts.into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join("\n")
    }

    fn verdict(&self) -> String {
        verdict(&self.verification, self.ending.why(&self.units), &self.units)
    }

    fn numbers(&self) -> String {
        numbers(self.objective, self.verification.objective, &self.units)
    }
    fn states(&self) -> String {
        let row = |(name, it): &(String, GapEntry)| {
            let difference = self.units.value(measured(name), it.difference, 6);
            vec![name.clone(), difference, short(it.gap), self.units.value("time", it.time, 6)]
        };
        let rows = self.state_gaps.0.iter().map(row).collect();
        with_head(["state", "differs by", "of its motion", "at t"].to_vec(), rows)
    }

    fn met(&self) -> String {
        let time =
            |time: Option<f64>| time.map(|it| self.units.value("time", it, 6)).unwrap_or_default();
        let row = |(name, it): &(String, ConditionEntry)| {
            let violation = self.units.violation(name, it.violation, 6);
            vec![name.clone(), violation, short(it.relative), time(it.time)]
        };
        let rows = self.conditions.0.iter().map(row).collect();
        with_head(["condition", "violated by", "of its terms", "at t"].to_vec(), rows)
    }

    fn modes(&self) -> String {
        let rows = self.surfaces.0.iter().flat_map(|(name, spans)| {
            let digits = |time: f64| self.units.value("time", time, 9);
            spans
                .iter()
                .map(move |it| vec![name.clone(), it.mode.clone(), digits(it.from), digits(it.to)])
        });
        with_head(["surface", "mode", "from", "to"].to_vec(), rows.collect())
    }
}

impl Picture {
    fn new(record: &Record, source: &str) -> Self {
        let columns = |all: &[(&str, &[f64])]| {
            all.iter().map(|(name, column)| ((*name).to_owned(), column.to_vec())).collect()
        };
        Picture {
            time: record.time.to_vec(),
            states: columns(&record.states),
            controls: columns(&record.controls),
            display_units: Named::default(),
            source: source.to_owned(),
        }
    }
}

impl VerifyPhasesDocument {
    pub fn new(
        (phases, links): (Vec<(String, VerifyDocument)>, &[LinkGap]),
        model: &str,
        objective: Option<f64>,
        same_source: bool,
        asked: f64,
    ) -> Self {
        let own = phases.iter().map(|(name, it)| (name.as_str(), &it.verification));
        let verification = Verification::of_phases(&own.collect::<Vec<_>>(), links, asked);
        let link = |it: &LinkGap| {
            let entry = ConditionEntry { violation: it.violation, relative: it.part, time: None };
            (it.label.clone(), entry)
        };
        VerifyPhasesDocument {
            fdcc: VERSION.to_string(),
            model: model.to_string(),
            command: command::given(),
            same_source,
            objective,
            verification,
            links: links.iter().map(link).collect(),
            phases: Named(phases),
            units: Units::default(),
            picture: Picture::default(),
        }
    }

    /// The same with the units of its values.
    pub fn in_units(mut self, units: Units) -> Self {
        self.picture.display_units = units.shown();
        VerifyPhasesDocument { units, ..self }
    }

    /// The same with the solution that was replayed; phases have their own parts of it.
    pub fn of_solution(mut self, record: &Record, source: &str) -> Self {
        for (name, phase) in &mut self.phases.0 {
            let Some(own) = record.phases.iter().find(|it| it.model == name) else { continue };
            phase.picture = Picture::new(own, "");
        }
        let display_units = self.picture.display_units;
        self.picture = Picture { display_units, ..Picture::new(record, source) };
        self
    }

    /// Whether the solution is confirmed.
    pub fn is_confirmed(&self) -> bool {
        self.verification.confirmed
    }

    /// The verdict, then the tables of each phase, then those of the links.
    pub fn words(&self) -> String {
        let why = self.phases.0.iter().find_map(|(_, it)| it.ending.why(&self.units));
        let mut words = verdict(&self.verification, why, &self.units);
        for (name, phase) in &self.phases.0 {
            words += &format!("\n {name}\n{}", phase.tables());
        }
        let row = |(name, it): &(String, ConditionEntry)| {
            let violation = self.units.violation(name, it.violation, 6);
            vec![name.clone(), violation, short(it.relative)]
        };
        let rows = self.links.0.iter().map(row).collect();
        words + "\n" + &with_head(["link", "violated by", "of its terms"].to_vec(), rows)
    }
}

/// The first line, and where the worst is.
fn verdict(verification: &Verification, why: Option<String>, units: &Units) -> String {
    let Verification { asked, completed, worst, .. } = verification;
    let first = match why.filter(|_| !completed) {
        None if *completed => {
            let word = if verification.confirmed { "confirmed" } else { "NOT CONFIRMED" };
            let how = if verification.phase_by_phase { ", phase by phase" } else { "" };
            let differs = verification.difference(units);
            let differs = differs.unwrap_or_else(|| "no state differs".into());
            let violated = worst.as_ref().zip(verification.violation(units));
            let violated = violated
                .map(|(worst, amount)| format!("violates `{}` by {amount}", worst.condition));
            let violated = violated.unwrap_or_else(|| "meets all conditions".into());
            let asked = short(*asked);
            format!(" {word} on the true system{how}: {differs}, {violated} (asked for: {asked})\n")
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
        let time = units.value("time", it.time.unwrap_or(f64::NAN), 6);
        format!(" worst at t = {time}: {}\n", units.pairs(&it.state, 6))
    });
    first + &place.unwrap_or_default()
}

/// The objective of the replay, if it has one, and that of the solution.
fn numbers(own: Option<f64>, replayed: Option<f64>, units: &Units) -> String {
    let text = |value: f64| units.value("objective", value, 9);
    let of = |value: Option<f64>| value.map_or("-".to_string(), text);
    match replayed {
        None => String::new(),
        Some(_) => format!(" objective {}   of the solution {}\n", of(replayed), of(own)),
    }
}
