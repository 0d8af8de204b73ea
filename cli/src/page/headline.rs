//! What is certain of a solution and what is not, in sentences.

use super::json::{Json, NULL};
use super::located::{all_located, is_smooth};
use super::runs;
use super::units::{of_condition, of_time, of_value};
use super::unsolved;
use crate::output::certificate::{all_missed, system};
use crate::output::number::{scientific, significant};
use crate::output::plural;
use fdcc::names;

/// How sure a sentence is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mark {
    /// It was checked, and holds.
    Certain,
    /// It was not checked, or cannot be.
    Open,
    /// It was checked, and does not hold.
    Wrong,
}

/// A sentence about a solution.
#[derive(Debug, PartialEq, Eq)]
pub struct Claim {
    pub mark: Mark,
    pub text: String,
}

pub(super) fn claim(mark: Mark, text: impl Into<String>) -> Claim {
    Claim { mark, text: text.into() }
}

fn is_solved(document: &Json) -> bool {
    let status = document.at("status").text();
    names::is_solved(status) || status == "uncertified"
}

fn is_confirmed(document: &Json) -> bool {
    let is_contradicted = document.at("optimality").at("contradicted").is_true();
    document.at("verification").at("confirmed").is_true() && !is_contradicted
}

/// Its certificate has a replay.
fn is_certified(document: &Json) -> bool {
    document.at("certificate").at("certified").is_true()
}

/// The whole in one sentence.
pub fn title(document: &Json) -> String {
    if let Some(run) = runs::of(document) {
        return run.title(document);
    }
    if !is_solved(document) {
        return format!("Not solved: {}", document.at("status").text().replace('_', " "));
    }
    if is_certified(document) {
        let what = match document.at("optimality").is_absent() {
            true => "A trajectory",
            false if document.at("global").is_true() => "Global optimum",
            false => "Local optimum",
        };
        let of = format!("{what} of the {}", system(is_smooth(document)));
        return match is_smooth(document) {
            true => of,
            false => format!("{of}, {}", all_located(document)),
        };
    }
    let found = match () {
        _ if document.at("optimality").is_absent() => "A feasible trajectory",
        _ if document.at("global").is_true() => "A global optimum",
        _ => "A local optimum",
    };
    let of = if smoothed(document) { "smoothed" } else { "discretised" };
    let replay = document.at("verification");
    let and = match () {
        _ if is_confirmed(document) => "confirmed on the true system",
        _ if replay.is_absent() => "not replayed on the true system",
        _ if replay.at("confirmed").is_true() => "but contradicted as an optimum",
        _ => "not confirmed on the true system",
    };
    match document.at("status").text() {
        "uncertified" => {
            format!("Not certified: {} of the {of} problem, {and}", found.to_lowercase())
        }
        _ => format!("{found} of the {of} problem, {and}"),
    }
}

fn smoothed(document: &Json) -> bool {
    !document.at("method").at("sigmas").is_absent()
        || document.at("phases").pairs().iter().any(|(_, it)| !it.at("sigmas").is_absent())
}

/// How sure the whole is: as sure as what is least so of what was checked.
pub fn mark(document: &Json) -> Mark {
    if let Some(run) = runs::of(document) {
        return run.mark(document);
    }
    let replay = document.at("verification");
    let is_wrong = document.at("optimality").at("contradicted").is_true()
        || !replay.is_absent() && !replay.at("confirmed").is_true();
    match () {
        _ if !is_solved(document) || is_wrong => Mark::Wrong,
        _ if is_confirmed(document) || is_certified(document) => Mark::Certain,
        _ => Mark::Open,
    }
}

/// What is certain and what is not.
pub fn claims(document: &Json) -> Vec<Claim> {
    if let Some(run) = runs::of(document) {
        return run.claims(document);
    }
    let mut claims = vec![tolerances(document)];
    claims.extend(unsolved::claims(document));
    if is_solved(document) {
        claims.extend(replayed(document));
        claims.extend(certified(document));
        claims.extend(contradicted(document));
        claims.extend(global(document));
    }
    claims
}

fn tolerances(document: &Json) -> Claim {
    let figure = |key: &str| scientific(document.at(key).number().unwrap_or(f64::NAN), 1);
    let (violation, error) = (figure("constraint_violation"), figure("kkt_error"));
    let asked = document.at("method").at("tol").number().unwrap_or(f64::NAN);
    let numbers = format!(
        "the equations hold to {violation}, the conditions of an optimum to {error}; {asked:e} was \
         asked for"
    );
    match document.at("status").text() {
        "solved" | "uncertified" => {
            claim(Mark::Certain, format!("The discretised problem is solved: {numbers}."))
        }
        "acceptable" => claim(Mark::Open, format!("Solved less accurately than asked: {numbers}.")),
        _ => claim(Mark::Wrong, format!("This is the last iterate and no solution: {numbers}.")),
    }
}

pub(super) fn replayed(document: &Json) -> Vec<Claim> {
    let replay = document.at("verification");
    if replay.is_absent() && is_certified(document) {
        return Vec::new();
    }
    if replay.is_absent() {
        return vec![claim(Mark::Open, "Not replayed on the true system.")];
    }
    if !replay.at("completed").is_true() {
        let text = "A replay of the controls on the true system does not reach the end.";
        return vec![claim(Mark::Wrong, text)];
    }
    let [gap, part] = ["state_gap", "relative_violation"].map(|key| number(replay.at(key)));
    let asked = number(replay.at("asked"));
    if replay.at("confirmed").is_true() {
        let off = scientific(gap.max(part), 1);
        let text = format!(
            "Replayed on the true system from event to event, states and conditions agree to \
             {off}; {asked:e} was asked for."
        );
        return vec![claim(Mark::Certain, text)];
    }
    let state = (gap > asked).then(|| differs(document, gap));
    let condition = (part > asked).then(|| violates(document, part));
    state.into_iter().chain(condition).map(|text| claim(Mark::Wrong, text)).collect()
}

/// Which state the replay misses most.
fn differs(document: &Json, part: f64) -> String {
    let differs = document.at("verification").at("differs");
    let state = differs.at("state").text();
    let amount = of_value(document, state).value(number(differs.at("difference")), 3);
    format!(
        "On the true system the same controls lead elsewhere: {state} is off by {amount}, {} of \
         its motion, at t = {}.",
        percent(part),
        time(document, differs.at("time"))
    )
}

/// Which condition the replay violates most.
fn violates(document: &Json, part: f64) -> String {
    let worst = document.at("verification").at("worst");
    let condition = worst.at("condition").text();
    let amount = of_condition(document, condition).value(number(worst.at("violation")), 3);
    let when = worst.at("time").number().map(|_| time(document, worst.at("time")));
    let when = when.map(|when| format!(" at t = {when}")).unwrap_or_default();
    format!(
        "On the true system the condition “{condition}” is off by {amount}, {} of its terms{when}.",
        percent(part)
    )
}

/// What was measured, and what it may be.
fn figures(check: &Json) -> [f64; 2] {
    ["figure", "limit"].map(|key| check.at(key).number().unwrap_or(f64::INFINITY))
}

/// What a certificate says, where one was looked for.
fn certified(document: &Json) -> Option<Claim> {
    let certificate = document.at("certificate");
    let checks = certificate.at("checks").list();
    if is_certified(document) {
        let figure = |name: &str| {
            let it = checks.iter().find(|it| it.at("check").text() == name);
            scientific(number(it.unwrap_or(&NULL).at("figure")), 1)
        };
        let located = match is_smooth(document) {
            true => "It is no longer that of a grid",
            false => "Nothing is smoothed: every switch is located",
        };
        let text = format!(
            "{located}, the optimality conditions of the {} hold to {}, those of second order too. \
             All {} checks of the certificate pass.",
            system(is_smooth(document)),
            figure("stationary"),
            checks.len()
        );
        return Some(claim(Mark::Certain, text));
    }
    let failed = checks.iter().filter(|it| !it.at("passes").is_true());
    let why = all_missed(failed.map(|it| (it.at("check").text(), figures(it))));
    let of = if smoothed(document) { "smoothed" } else { "discretised" };
    let text = format!(
        "This is the optimum of the {of} problem. An optimum of the {} was looked for and is not \
         certified: {}.",
        system(is_smooth(document)),
        why.join("; ")
    );
    // Where nothing was located nothing is wrong, either.
    let is_open = checks
        .iter()
        .any(|it| ["located", "finished", "without data"].contains(&it.at("check").text()));
    let mark = if is_open { Mark::Open } else { Mark::Wrong };
    (!certificate.is_absent()).then(|| claim(mark, text))
}

fn contradicted(document: &Json) -> Option<Claim> {
    let optimality = document.at("optimality");
    let says = optimality.at("says").text();
    let checks = optimality.at("checks").list().len();
    match optimality.at("contradicted").is_true() {
        _ if optimality.is_absent() => None,
        true => Some(claim(Mark::Wrong, format!("Contradicted as an optimum: {says}."))),
        false if checks == 0 => None,
        false => Some(claim(
            Mark::Open,
            format!(
                "Nothing contradicts that it is an optimum, in {}; that proves none.",
                plural(checks, "necessary condition")
            ),
        )),
    }
}

fn global(document: &Json) -> Option<Claim> {
    match document.at("global").is_true() {
        _ if document.at("optimality").is_absent() => None,
        true if is_certified(document) => {
            Some(claim(Mark::Certain, "No other trajectory is better: proved."))
        }
        true => Some(claim(Mark::Certain, "No other trajectory on this grid is better: proved.")),
        false => Some(claim(
            Mark::Open,
            "Not proved to be the best of all: “--starts 20” looks for better ones.",
        )),
    }
}

fn number(it: &Json) -> f64 {
    it.number().unwrap_or(f64::NAN)
}

pub(super) fn time(document: &Json, it: &Json) -> String {
    of_time(document).value(number(it), 4)
}

fn percent(part: f64) -> String {
    format!("{} %", significant(100.0 * part, 2))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn document(more: &str) -> Json {
        let text = format!(
            r#"{{"constraint_violation":1e-10,"kkt_error":1e-9,"method":{{"tol":1e-8,
                "sigmas":{{"slip":0.1}}}},"global":false,
                "display_units":{{"x":{{"unit":"mm","si":0.001}},
                "time":{{"unit":"ms","si":0.001}}}},
                {more}}}"#
        );
        serde_json::from_str(&text).expect("it is JSON")
    }

    #[test]
    fn what_the_replay_misses_is_told_with_its_size_and_place() {
        let document = document(
            r#""status":"solved","optimality":{"contradicted":false,"checks":[1]},
               "verification":{"confirmed":false,"completed":true,"asked":0.001,"state_gap":0.02,
               "differs":{"state":"x","difference":0.003,"time":0.5},"relative_violation":0.0001}"#,
        );
        let title = title(&document);
        assert!(title.ends_with("smoothed problem, not confirmed on the true system"), "{title}");
        assert_eq!(mark(&document), Mark::Wrong);
        let claims = claims(&document);
        assert!(claims.iter().any(|it| it.text.contains("in 1 necessary condition;")));
        let wrong: Vec<&Claim> = claims.iter().filter(|it| it.mark == Mark::Wrong).collect();
        assert_eq!(wrong.len(), 1, "{claims:?}");
        assert!(wrong[0].text.contains("x is off by 3 mm, 2 % of its motion, at t = 500 ms"));
    }

    #[test]
    fn only_a_confirmed_answer_is_certain() {
        let says = |replay: &str, contradicted: bool| {
            let document = document(&format!(
                r#""status":"solved","optimality":{{"contradicted":{contradicted},"says":"it is"}},
                   "verification":{replay}"#
            ));
            (mark(&document), title(&document))
        };
        let confirmed = r#"{"confirmed":true,"completed":true,"state_gap":0,"asked":1}"#;
        assert_eq!(says(confirmed, false).0, Mark::Certain);
        assert_eq!(says(confirmed, true).0, Mark::Wrong);
        assert_eq!(says("null", false).0, Mark::Open);
        assert!(says(confirmed, true).1.ends_with("but contradicted as an optimum"));
        let unsolved = document(r#""status":"iteration_limit""#);
        assert_eq!(title(&unsolved), "Not solved: iteration limit");
        assert_eq!(claims(&unsolved).len(), 1);
    }

    #[test]
    fn what_is_certified_was_replayed_for_it() {
        let of = document(
            r#""status":"solved","optimality":{"contradicted":false},"surfaces":{"slip":[]},
               "certificate":{"certified":true,"switches":[1]}"#,
        );
        assert_eq!(title(&of), "Local optimum of the true system, 1 switch located");
        assert_eq!(mark(&of), Mark::Certain);
        assert!(claims(&of).iter().all(|it| !it.text.contains("Not replayed")));
    }

    #[test]
    fn without_surfaces_the_grid_alone_stood_between() {
        let of = document(
            r#""status":"solved","optimality":{"contradicted":false},
               "certificate":{"certified":true,"switches":[],"checks":[]}"#,
        );
        assert_eq!(title(&of), "Local optimum of the continuous problem");
        assert!(claims(&of).iter().any(|it| it.text.contains("no longer that of a grid")));
    }

    #[test]
    fn a_certificate_names_what_fails() {
        let certificate = |certified: bool, passes: bool| {
            document(&format!(
                r#""status":"solved","verification":{{"confirmed":true,"completed":true,
                   "state_gap":1e-9,"asked":0.001}},"optimality":{{"contradicted":false}},
                   "surfaces":{{"slip":[]}},
                   "certificate":{{"certified":{certified},"switches":[1,2],"checks":[
                   {{"check":"stationary","figure":3e-13,"limit":1e-7,"passes":true}},
                   {{"check":"bounds","figure":0.01,"limit":1e-6,"passes":{passes}}}]}}"#
            ))
        };
        let of = certificate(false, false);
        let told = claims(&of).into_iter().find(|it| it.text.contains("not certified"));
        let told = told.expect("it is told");
        assert_eq!(told.mark, Mark::Wrong);
        assert!(
            told.text.contains("a control leaves its bounds by 1.0e-02 between nodes"),
            "{}",
            told.text
        );
        assert!(title(&of).starts_with("A local optimum of the smoothed problem"));
        let of = certificate(true, true);
        assert_eq!(title(&of), "Local optimum of the true system, 2 switches located");
        assert!(claims(&of).iter().any(|it| it.text.contains("true system hold to 3.0e-13")));
        assert_eq!(mark(&of), Mark::Certain);
    }
}
