//! What a page says of a solve that found nothing feasible: what is violated, and how near it came.

use super::headline::{Claim, Mark, claim, time};
use super::json::Json;
use super::units::of_condition;

/// Nothing of what is solved.
pub fn claims(document: &Json) -> Vec<Claim> {
    violated(document).into_iter().chain(reach(document)).collect()
}

/// What is violated most by what was found, and where.
fn violated(document: &Json) -> Option<Claim> {
    let it = document.at("largest_violation");
    let (of, size) = (it.at("of").text(), it.at("violation").number()?);
    let when = it.at("time").number().map(|_| time(document, it.at("time")));
    let when = when.map(|when| format!(" at t = {when}")).unwrap_or_default();
    // What is off is the state of the equation.
    let unit = of_condition(document, of.trim_end_matches('\''));
    let amount = |size: f64| unit.value(size, 3);
    let text = match (it.at("condition").text(), it.at("in_all").number()) {
        ("", _) | (_, None) => {
            format!("The largest violation is that of “{of}”{when}, by {}.", amount(size))
        }
        (condition, Some(in_all)) => format!(
            "The condition “{condition}” stands against the equations most. The largest violation \
             is that of “{of}”{when}: by {} in one step, {} in all.",
            amount(size),
            amount(in_all)
        ),
    };
    Some(claim(Mark::Wrong, text))
}

/// How near the condition in the way comes with all others met.
fn reach(document: &Json) -> Option<Claim> {
    let it = document.at("reach");
    let condition = it.at("condition").text();
    let unit = of_condition(document, condition);
    let [value, bound] = ["value", "bound"].map(|key| it.at(key).number());
    let [value, bound] = [value?, bound?].map(|it| unit.value(it, 4));
    let (mark, sure) = match it.at("proved").is_true() {
        true => (Mark::Certain, "proved: no more is possible on this grid"),
        false => (Mark::Open, "the best near the guess"),
    };
    let text =
        format!("With all else met, “{condition}” comes to {value} instead of {bound} ({sure}).");
    Some(claim(mark, text))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn where_nothing_is_feasible_it_is_told_how_near_and_where() {
        let text = r#"{"display_units":{"x":{"unit":"mm","si":0.001},
            "time":{"unit":"ms","si":0.001}},"status":"none_found",
            "largest_violation":{"of":"x'","condition":"end x == 1",
               "violation":0.002,"in_all":0.05,"time":0.25},
               "reach":{"condition":"end x == 1","value":0.5,"bound":1,"proved":false}}"#;
        let document = serde_json::from_str(text).expect("it is JSON");
        let told: Vec<String> = claims(&document).into_iter().map(|it| it.text).collect();
        assert!(
            told[0].contains("“x'” at t = 250 ms: by 2 mm in one step, 50 mm in all"),
            "{told:?}"
        );
        let near = "With all else met, “end x == 1” comes to 0.5 instead of 1 (the best near";
        assert!(told[1].starts_with(near), "{told:?}");
    }
}
