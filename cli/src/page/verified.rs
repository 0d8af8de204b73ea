//! What a page says of the replay of a solution on the true system.

use super::headline::{Claim, Mark, replayed};
use super::json::Json;
use super::tags::{Cell, table};
use super::units::{of_condition, of_time, of_value};
use crate::output::number::significant;

fn is_confirmed(document: &Json) -> bool {
    document.at("verification").at("confirmed").is_true()
}

/// The whole in one sentence.
pub fn title(document: &Json) -> String {
    let replay = document.at("verification");
    let asked = replay.at("asked").number().map(|it| format!("{it:e}")).unwrap_or_default();
    match is_confirmed(document) {
        true => format!("The solution is confirmed on the true system, to {asked}"),
        false if !replay.at("completed").is_true() => {
            "Not confirmed: the replay on the true system does not reach the end".into()
        }
        false => "The solution is not confirmed on the true system".into(),
    }
}

/// How sure the whole is.
pub fn mark(document: &Json) -> Mark {
    if is_confirmed(document) { Mark::Certain } else { Mark::Wrong }
}

/// What is certain and what is not.
pub fn claims(document: &Json) -> Vec<Claim> {
    let mut claims = replayed(document);
    let objective = document.at("objective").number();
    let replay = document.at("verification").at("objective").number();
    if let Some((own, replay)) = objective.zip(replay) {
        let shown = |it| of_value(document, "objective").value(it, 9);
        let (own, replay) = (shown(own), shown(replay));
        let text = format!("The objective of the replay is {replay}, that of the solution {own}.");
        let mark = if is_confirmed(document) { Mark::Certain } else { Mark::Open };
        claims.push(Claim { mark, text });
    }
    if !document.at("same_source").is_true() {
        let text = "The text of the model is not the one that was solved.".into();
        claims.push(Claim { mark: Mark::Open, text });
    }
    claims
}

/// What differs and what is violated, phase by phase.
pub fn tables(document: &Json) -> String {
    let phases = document.at("phases").pairs();
    let mut tables = match phases {
        [] => gaps(document, document, "") + &conditions(document, document, "conditions", ""),
        _ => phases.iter().map(|(name, it)| of_phase(document, it, name)).collect(),
    };
    tables += &conditions(document, document, "links", "");
    tables
}

fn of_phase(document: &Json, phase: &Json, name: &str) -> String {
    let of = format!(", {name}");
    gaps(document, phase, &of) + &conditions(document, phase, "conditions", &of)
}

fn time(document: &Json, it: &Json) -> Cell {
    let time = it.at("time").number();
    Cell::Number(time.map_or("-".into(), |time| of_time(document).value(time, 6)))
}

fn number(it: &Json, key: &str) -> f64 {
    it.at(key).number().unwrap_or(f64::NAN)
}

fn percent(part: f64) -> Cell {
    Cell::Number(format!("{} %", significant(100.0 * part, 3)))
}

fn gaps(document: &Json, part: &Json, of: &str) -> String {
    let row = |(name, it): &(String, Json)| {
        let difference = of_value(document, name).value(number(it, "difference"), 5);
        vec![
            Cell::text(name),
            Cell::Number(difference),
            percent(number(it, "gap")),
            time(document, it),
        ]
    };
    let rows: Vec<_> = part.at("state_gaps").pairs().iter().map(row).collect();
    let head = ["state", "differs by", "of its motion", "at t"];
    table(&format!("Replay less solution{of}"), &head, &rows)
}

fn conditions(document: &Json, part: &Json, key: &str, of: &str) -> String {
    let row = |(name, it): &(String, Json)| {
        let violation = of_condition(document, name).value(number(it, "violation"), 5);
        vec![
            Cell::text(name),
            Cell::Number(violation),
            percent(number(it, "relative")),
            time(document, it),
        ]
    };
    let rows: Vec<_> = part.at(key).pairs().iter().map(row).collect();
    let title = if key == "links" { "Links between the replays" } else { "Conditions" };
    let head = ["condition", "violated by", "of its terms", "at t"];
    table(&format!("{title}{of}"), &head, &rows)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn document(confirmed: bool) -> Json {
        let text = format!(
            r#"{{"same_source":false,"objective":2,"verification":{{"confirmed":{confirmed},
                "completed":true,"asked":0.001,"state_gap":0.02,"objective":3,
                "relative_violation":0,
                "differs":{{"state":"x","difference":0.003,"time":0.5}}}},
                "display_units":{{"x":{{"unit":"mm","si":0.001}},
                "end x == 1":{{"unit":"mm","si":0.001}}}},
                "state_gaps":{{"x":{{"gap":0.02,"difference":0.003,"time":0.5}}}},
                "conditions":{{"end x == 1":{{"violation":0.001,"relative":0.1,"time":null}}}}}}"#
        );
        serde_json::from_str(&text).expect("it is JSON")
    }

    #[test]
    fn what_differs_and_what_is_violated_is_told_in_units() {
        let document = document(false);
        assert_eq!((mark(&document), &title(&document)[..12]), (Mark::Wrong, "The solution"));
        let told: Vec<String> = claims(&document).into_iter().map(|it| it.text).collect();
        assert!(told[0].contains("x is off by 3 mm"), "{told:?}");
        assert!(told[1].contains("of the replay is 3, that of the solution 2"), "{told:?}");
        assert!(told[2].contains("not the one that was solved"), "{told:?}");
        let html = tables(&document);
        for told in ["3 mm", "2 %", "end x == 1", "1 mm", "10 %"] {
            assert!(html.contains(told), "{told}: {html}");
        }
    }

    #[test]
    fn a_confirmed_one_is_certain() {
        let title = title(&document(true));
        assert_eq!(title, "The solution is confirmed on the true system, to 1e-3");
        assert_eq!(mark(&document(true)), Mark::Certain);
    }
}
