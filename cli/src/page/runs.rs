//! What a page says of a run that is no solve: a simulation, a closed loop, a gradient, or the
//! replay of a solution.

use super::estimates::estimates;
use super::headline::{Claim, Mark};
use super::json::Json;
use super::tags::{Cell, table};
use super::units::of_time;
use super::{gradient, verified};
use crate::output::number::significant;
use crate::output::plural;

/// A run that is no solve.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Run {
    Simulation,
    ClosedLoop,
    Gradient,
    Verification,
}

/// Which one a document is of; nothing for a solve.
pub fn of(document: &Json) -> Option<Run> {
    let has = |key: &str| !document.at(key).is_absent();
    match () {
        _ if has("state_gaps") || !document.at("same_source").is_absent() => {
            Some(Run::Verification)
        }
        _ if !document.at("of").is_absent() && !document.at("trusted").is_absent() => {
            Some(Run::Gradient)
        }
        _ if has("ended") && has("plant") => Some(Run::ClosedLoop),
        _ if !document.at("counts").at("rejected").is_absent() => Some(Run::Simulation),
        _ => None,
    }
}

impl Run {
    /// The whole in one sentence.
    pub fn title(self, document: &Json) -> String {
        let happened = match self {
            Run::Gradient => return gradient::title(document),
            Run::Verification => return verified::title(document),
            Run::Simulation => {
                let phases = document.at("phases").pairs().len();
                let phases = (phases > 0).then(|| plural(phases, "phase"));
                let events = plural(events(document).len(), "event");
                phases.into_iter().chain([events]).collect::<Vec<_>>().join(", ")
            }
            Run::ClosedLoop => plural(statuses(document).len(), "step"),
        };
        let what = if self == Run::Simulation { "Simulated" } else { "In closed loop" };
        match self.early(document) {
            None if self == Run::Simulation => format!("{what} to the end, {happened}"),
            None => format!("{what}: {happened}, {}", solved(document)),
            Some(why) => format!("{what}, {happened}; ended early: {why}"),
        }
    }

    /// How sure the whole is.
    pub fn mark(self, document: &Json) -> Mark {
        match self.early(document) {
            _ if self == Run::Gradient => gradient::mark(document),
            _ if self == Run::Verification => verified::mark(document),
            None if unsolved(document) == 0 => Mark::Certain,
            None => Mark::Open,
            Some(_) => Mark::Wrong,
        }
    }

    /// What is certain and what is not.
    pub fn claims(self, document: &Json) -> Vec<Claim> {
        let claim = |mark: Mark, text: String| Claim { mark, text };
        let end = self
            .early(document)
            .map(|why| claim(Mark::Wrong, format!("The last time is not reached: {why}.")));
        let mut claims = match self {
            Run::Gradient => return gradient::claims(document),
            Run::Verification => return verified::claims(document),
            Run::Simulation => vec![claim(Mark::Certain, located(document))],
            Run::ClosedLoop => {
                let mark = if unsolved(document) == 0 { Mark::Certain } else { Mark::Wrong };
                let steps = match unsolved(document) {
                    0 => "Every step is solved.".to_owned(),
                    _ => format!("Of the steps {}.", solved(document)),
                };
                let other = "This is one run: from another state, or with another plant, the loop \
                             may do something else.";
                let plant = format!(
                    "The plant “{}” is integrated from event to event: nothing of it is smoothed.",
                    document.at("plant").text()
                );
                vec![
                    claim(mark, steps),
                    claim(Mark::Certain, plant),
                    claim(Mark::Open, other.into()),
                ]
            }
        };
        claims.extend(end);
        claims
    }

    /// How it is done again.
    pub fn again(self, document: &Json) -> String {
        let model = document.at("model").text();
        match self {
            Run::Gradient => format!("fdcc grad {model}.fdc --out results"),
            Run::Verification => {
                format!("fdcc verify results/{model}.sol.json {model}.fdc --out results")
            }
            Run::Simulation => format!("fdcc simulate {model}.fdc --out results"),
            Run::ClosedLoop => {
                let steps = statuses(document).len();
                let plant = document.at("plant").text();
                let plant =
                    if plant == model { String::new() } else { format!(" --plant {plant}.fdc") };
                format!("fdcc mpc {model}.fdc{plant} --steps {steps} --out results")
            }
        }
    }

    /// Why it did not come to its end.
    fn early(self, document: &Json) -> Option<String> {
        let key = if self == Run::Simulation { "status" } else { "ended" };
        let how = document.at(key).text();
        // The last phase is the one that does not reach its last time.
        let phase = document.at("phases").pairs().last();
        let phase = phase.map(|(name, _)| format!(" in phase {name}")).unwrap_or_default();
        (how != "completed").then(|| how.replace('_', " ") + &phase)
    }
}

/// What happened, with the phase in which it did; no phase in a model of one piece.
pub fn events(document: &Json) -> Vec<(&str, &Json)> {
    let phases = document.at("phases").pairs().iter().map(|(name, it)| (name.as_str(), it));
    let parts = [("", document)].into_iter().chain(phases);
    parts
        .flat_map(|(phase, it)| it.at("events").list().iter().map(move |event| (phase, event)))
        .collect()
}

fn statuses(document: &Json) -> Vec<&str> {
    let statuses = document.at("status").list();
    statuses.iter().map(Json::text).collect()
}

fn unsolved(document: &Json) -> usize {
    let is_unsolved = |status: &&&str| !["solved", "acceptable"].contains(*status);
    statuses(document).iter().filter(is_unsolved).count()
}

fn solved(document: &Json) -> String {
    match unsolved(document) {
        0 => "all are solved".into(),
        1 => "one is not solved".into(),
        many => format!("{many} are not solved"),
    }
}

fn located(document: &Json) -> String {
    let steps = document.at("counts").at("steps").number().unwrap_or(0.0);
    format!(
        "The system as it was written, integrated in {} from event to event: each of the {} is \
         located, nothing is smoothed.",
        plural(steps as usize, "step"),
        plural(events(document).len(), "event")
    )
}

/// What the curves of the only document are.
pub fn curves(document: &Json) -> &'static str {
    match of(document) {
        Some(Run::Simulation) => "simulation",
        Some(Run::ClosedLoop) => "plant",
        Some(Run::Gradient) => "trajectory",
        _ => "solution",
    }
}

/// What a page is about, before all pictures: derivatives, or the estimates of a fit.
pub fn first_tables(document: &Json) -> String {
    match of(document) {
        Some(Run::Gradient) => gradient::tables(document),
        _ => estimates(document),
    }
}

/// What no plot shows.
pub fn tables(document: &Json) -> String {
    let own = match of(document) {
        Some(Run::Verification) => verified::tables(document),
        _ => String::new(),
    };
    own + &table_of_events(document)
}

/// When what happened, and how far from grazing.
fn table_of_events(document: &Json) -> String {
    let all = events(document);
    let has_phases = all.iter().any(|(phase, _)| !phase.is_empty());
    let row = |(phase, it): &(&str, &Json)| {
        let number = |key: &str| it.at(key).number().unwrap_or(f64::NAN);
        let phase = has_phases.then(|| Cell::text(*phase));
        let own = [
            Cell::text(it.at("surface").text()),
            Cell::text(it.at("kind").text().replace('_', " ")),
            Cell::Number(of_time(document).value(number("time"), 10)),
            Cell::Number(significant(number("margin"), 4)),
        ];
        phase.into_iter().chain(own).collect()
    };
    let rows: Vec<_> = all.iter().map(row).collect();
    let head = ["phase", "surface", "what happens", "time", "margin"];
    table("Events", if has_phases { &head } else { &head[1..] }, &rows)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of_text(text: &str) -> (Run, Json) {
        let json: Json = serde_json::from_str(text).expect("it is JSON");
        (of(&json).expect("it is a run"), json)
    }

    #[test]
    fn a_simulation_that_ends_early_is_not_certain() {
        let text = |status: &str| {
            format!(r#"{{"status":"{status}","counts":{{"rejected":0,"steps":3}},"events":[1]}}"#)
        };
        let (run, json) = of_text(&text("completed"));
        assert_eq!(run.title(&json), "Simulated to the end, 1 event");
        assert_eq!(run.mark(&json), Mark::Certain);
        let (run, json) = of_text(&text("not_unique"));
        assert!(run.title(&json).ends_with("ended early: not unique"), "{}", run.title(&json));
        assert_eq!(run.mark(&json), Mark::Wrong);
        assert!(run.claims(&json).iter().any(|it| it.mark == Mark::Wrong));
    }

    #[test]
    fn a_loop_tells_steps_that_are_not_solved() {
        let (run, json) = of_text(
            r#"{"model":"a","plant":"b","ended":"completed","status":["solved","time_limit"]}"#,
        );
        assert_eq!(run, Run::ClosedLoop);
        assert_eq!(run.title(&json), "In closed loop: 2 steps, one is not solved");
        assert_eq!(run.mark(&json), Mark::Open);
        assert_eq!(run.again(&json), "fdcc mpc a.fdc --plant b.fdc --steps 2 --out results");
    }
}
