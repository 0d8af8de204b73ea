//! What shows that an answer is an optimum of the true system, as data and in words.

use super::document::{Span, switching};
use super::named::Named;
use super::number::scientific;
use super::units::Units;
use fdcc::names::mode_name;
use fdcc::true_optimum;
use serde::Serialize;

/// All checks, with what was located.
#[derive(Clone, Debug, Serialize)]
pub struct Certificate {
    /// Whether all checks pass: then the answer is the located one, else the smoothed one.
    pub certified: bool,
    pub checks: Vec<Check>,
    pub switches: Vec<Switch>,
    /// What each control does from when to when: `min`, `max` or `free`.
    pub arcs: Named<Vec<Span>>,
}

/// One figure of the true system.
#[derive(Clone, Debug, Serialize)]
pub struct Check {
    pub check: &'static str,
    pub figure: f64,
    /// A larger figure fails.
    pub limit: f64,
    pub passes: bool,
}

/// A change of the mode of a surface.
#[derive(Clone, Debug, Serialize)]
pub struct Switch {
    pub surface: String,
    pub time: f64,
    pub from: &'static str,
    pub to: &'static str,
}

impl Certificate {
    pub fn new(it: &true_optimum::Certificate) -> Self {
        let check = |it: &true_optimum::Check| Check {
            check: it.name,
            figure: it.figure,
            limit: it.limit,
            passes: it.passes(),
        };
        let switch = |it: &true_optimum::Switch| Switch {
            surface: it.surface.clone(),
            time: it.time,
            from: mode_name(it.from),
            to: mode_name(it.to),
        };
        let stretch =
            |it: &true_optimum::Stretch| Span { mode: it.arc.into(), from: it.from, to: it.to };
        let arcs = it.arcs.iter();
        Certificate {
            certified: it.is_certified(),
            checks: it.checks.iter().map(check).collect(),
            switches: it.switches.iter().map(switch).collect(),
            arcs: arcs.map(|(name, of)| (name.clone(), of.iter().map(stretch).collect())).collect(),
        }
    }

    fn figure(&self, name: &str) -> f64 {
        self.checks.iter().find(|it| it.check == name).map_or(f64::NAN, |it| it.figure)
    }

    /// The first line of a certified answer.
    pub fn headline(&self) -> String {
        let located = match self.switches.len() {
            1 => "1 switch located".to_owned(),
            0 => "no switch to locate".into(),
            many => format!("{many} switches located"),
        };
        let replayed = self.figure("replayed").max(self.figure("conditions"));
        format!(
            "local optimum of the true system, {located}, replayed to {}, stationary to {}, second \
             order ok",
            scientific(replayed, 1),
            scientific(self.figure("stationary"), 1)
        )
    }

    /// Why it is not certified, in a line; nothing if it is.
    pub fn failure(&self) -> Option<String> {
        let failed: Vec<String> = self.checks.iter().filter(|it| !it.passes).map(words).collect();
        let what = failed.join(", ");
        (!failed.is_empty())
            .then(|| format!(" true  no certified optimum of the true system: {what}"))
    }

    /// What each control does that is at a bound anywhere.
    pub fn lines<'c>(&'c self, units: &'c Units) -> impl Iterator<Item = String> + 'c {
        let moves = self.arcs.0.iter().filter(|(_, all)| all.iter().any(|it| it.mode != "free"));
        moves
            .filter(|_| self.certified)
            .map(|(name, all)| format!(" {name:<5} {}", switching(all, units)))
    }
}

fn words(it: &Check) -> String {
    let (figure, limit) = (scientific(it.figure, 1), scientific(it.limit, 0));
    match it.check {
        "located" => "no structure of phases could be solved".into(),
        "finished" => "the search was stopped".into(),
        "second order" => "a direction of negative curvature".into(),
        "insertion" => "whether a hold at a switch is better could not be found out".into(),
        "holds" => "a surface that repels is held".into(),
        "replayed" => format!("the replay is off by {figure} (limit {limit})"),
        "conditions" => format!("the replay violates a condition by {figure} (limit {limit})"),
        "modes" => format!("the replay is in other modes on {figure} of the time (limit {limit})"),
        "bounds" => {
            format!("a control leaves its bounds by {figure} between nodes (limit {limit})")
        }
        "arcs" => format!("a bound multiplier has the wrong sign by {figure} (limit {limit})"),
        "hamiltonian" => {
            format!(
                "the Hamiltonian changes inside of a phase by {figure} of its size (limit {limit})"
            )
        }
        name => format!("{name} {figure} (limit {limit})"),
    }
}
