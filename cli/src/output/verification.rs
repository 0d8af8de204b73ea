//! What a replay on the true system says of a solution: a part of every document of a solve.

use super::ending::state;
use super::named::Named;
use super::number::{scientific, short};
use super::units::Units;
use fdcc::{Condition, Gap, LinkGap, TIME_OF};
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

fn worst(verified: &fdcc::Verification, condition: &Condition) -> Worst {
    Worst {
        condition: condition.label.clone(),
        time: condition.time,
        violation: condition.violation,
        state: state(&verified.system, &condition.state),
    }
}

/// What a difference is measured in: of a time of a jump that is time.
pub(super) fn measured(name: &str) -> &str {
    if name.starts_with(TIME_OF) { "time" } else { name }
}
