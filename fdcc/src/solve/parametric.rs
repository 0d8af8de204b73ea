//! How an optimum moves with a parameter: states, controls, unknowns and switching times.

use super::Solution;
use super::tuning::parametric::{CHANGE, MOVED};
use crate::error::Error;
use fdcc_compiler::{compile_chain, is_kink};
use fdcc_runtime::problem::{Chain, Problem, Variable};
use fdcc_runtime::solve::{ChainOutcome, Movement, movement_of_chain};

/// The derivative of an optimum by a parameter, in SI. Where switches are located these move, too;
/// beside them a state changes at once by what it gains until they come. What an optimum that is
/// no strict minimum leaves open is not a number.
///
/// ```
/// use fdcc::{Model, Options};
///
/// let model = Model::from_text("brake", "param mu = 0.5
/// free T in [0.1, 9] guess 3
/// time t in [0, T]
/// state x start 0
/// state v start 0
/// control u in [-2, 2]
/// surface slip = v
/// dynamics { x' = v  v' in u - mu*Sgn(slip) }
/// end x == 1
/// end v == 0
/// minimize T")?;
/// let solution = model.solve(&Options::default())?;
/// let by_mu = solution.parametric_sensitivity("mu")?;
/// // T = 2 sqrt(2/(4 - mu^2)), and the force turns at (2 + mu)/4 T.
/// let (_, of_time) = &by_mu.unknowns[0];
/// assert!((of_time - 0.1947).abs() < 1e-4);
/// let (at, moved) = by_mu.junctions[0];
/// assert!((at - 0.9129).abs() < 1e-4 && (moved - 0.4869).abs() < 1e-4);
/// # Ok::<(), fdcc::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct ParametricSensitivity {
    /// The parameter.
    pub parameter: String,
    /// Of all unknowns, by name.
    pub unknowns: Vec<(String, f64)>,
    /// Each time at which the solution switches, or a control or a limit reaches or leaves a bound,
    /// with its derivative; only of located optima.
    pub junctions: Vec<(f64, f64)>,
    /// Of each phase; one of a model without phases.
    pub phases: Vec<PhaseSensitivity>,
}

/// The derivative of the signals of a phase by a parameter.
///
/// ```
/// let model = fdcc::Model::from_text("charge", "param a = 2
/// time t in [0, 1]
/// state x start 0
/// control u
/// dynamics { x' = u }
/// end x == a
/// minimize integral(u^2)")?;
/// let by_a = model.solve(&fdcc::Options::default())?.parametric_sensitivity("a")?;
/// let (name, u) = &by_a.phases[0].controls[0];
/// assert!(name == "u" && u.iter().all(|it| (it - 1.0).abs() < 1e-6));
/// # Ok::<(), fdcc::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct PhaseSensitivity {
    /// The phase, if the model has any.
    pub phase: Option<String>,
    /// The `N + 1` times of the grid.
    pub time: Vec<f64>,
    /// Of each state at these times; beside a switch behind it.
    pub states: Vec<(String, Vec<f64>)>,
    /// Of each control, `N` numbers: its mean over the interval.
    pub controls: Vec<(String, Vec<f64>)>,
}

impl Solution {
    /// How the optimum moves with a parameter, by the matrix of its optimality conditions.
    ///
    /// # Errors
    ///
    /// Why there is no such derivative.
    pub fn parametric_sensitivity(&self, parameter: &str) -> Result<ParametricSensitivity, Error> {
        let why_none = self.why_not_by(parameter);
        why_none.map_or(Ok(()), |why| Err(Error::Call(why)))?;
        let single;
        let (model, chain, outcome) = match self.in_phases() {
            Some((model, chain, outcome)) => (model, chain.clone(), outcome),
            None => {
                single = ChainOutcome::single(self.outcome.clone());
                (self.model().meaning(), Chain::single(self.problem.clone()), &single)
            }
        };
        let found = self.by_number(parameter, model, (&chain, outcome));
        let all = found.ok_or_else(|| not_strict(parameter))?;
        let told = self.told(parameter, &all, outcome);
        let numbers = told.unknowns.iter().map(|it| it.1);
        let numbers: Vec<f64> = numbers.chain(told.junctions.iter().map(|it| it.1)).collect();
        let is_open = !numbers.is_empty() && numbers.iter().all(|it| it.is_nan());
        if is_open { Err(not_strict(parameter)) } else { Ok(told) }
    }

    fn by_number(
        &self,
        name: &str,
        model: &fdcc_compiler::Model,
        (chain, outcome): (&Chain, &ChainOutcome),
    ) -> Option<Vec<Movement>> {
        let own = chain.phases[0].parameters.iter().find(|it| it.name == name)?;
        let change = CHANGE * if own.value == 0.0 { own.unit } else { own.value.abs() };
        let with = |part: f64| {
            let mut model = model.clone();
            model.set_param_in_si(name, own.value + part * change).ok()?;
            compile_chain(&model).ok()
        };
        let (mut below, mut above) = (with(-0.5)?, with(0.5)?);
        for it in [&mut below, &mut above] {
            // On the grid of the answer.
            let grids = it.phases.iter_mut().zip(&chain.phases);
            grids.for_each(|(it, own)| it.method.clone_from(&own.method));
        }
        movement_of_chain(chain, outcome, [&below, &above], change)
    }

    /// Why there is no derivative; nothing where there may be one.
    fn why_not_by(&self, name: &str) -> Option<String> {
        let params = &self.model().meaning().params;
        let Some(at) = params.iter().position(|it| it.place.name == name) else {
            return Some(self.model().meaning().no_param(name));
        };
        if crate::gradient::quantities::is_computed(name, self.model().meaning()) {
            return Some(format!("`{name}` is computed from other parameters"));
        }
        if !self.is_solved() {
            return Some(format!("no derivative by `{name}`: the model is not solved"));
        }
        let slope = self.sensitivities().get(at).map_or(0.0, |it| it.1);
        let of_holds = self.of_holds.get(at).copied().unwrap_or(0.0);
        // A given start beside a surface that moves away from it is led back at once.
        let is_led = of_holds.abs() > MOVED * slope.abs();
        let has_kink = slope.is_nan() || is_led;
        has_kink.then(|| format!("no derivative by `{name}`: the optimum has a kink there"))
    }

    fn told(
        &self,
        parameter: &str,
        all: &[Movement],
        outcome: &ChainOutcome,
    ) -> ParametricSensitivity {
        let places = &self.problem.parameters;
        let unknowns = self.unknowns().filter_map(|(name, _)| {
            let at = places.iter().position(|it| it.name == name)?;
            (!is_kink(name)).then(|| (name.to_string(), all[0].parameters[at]))
        });
        let names = self.model().meaning().phases.iter().map(|it| it.place.name.clone());
        let (mut first, mut junctions, mut phases) = (0, Vec::new(), Vec::new());
        let parts: Vec<(Option<String>, &Solution)> = match self.phases() {
            [] => vec![(None, self)],
            parts => names.map(Some).zip(parts).collect(),
        };
        for (phase, part) in parts {
            let located = part.between_jumps.as_ref().map(|it| it.chain.phases.len());
            let count = if phase.is_none() { all.len() } else { located.unwrap_or(1) };
            let own = first..first + count;
            let times = outcome.phases[own.clone()].iter().map(|it| &it.trajectory.time[..]);
            let times: Vec<&[f64]> = times.collect();
            let begins = times.iter().zip(&all[own.clone()]).skip(1);
            let junction = |(time, it): (&&[f64], &Movement)| (time[0], it.time[0]);
            let own_junctions = begins.enumerate().filter(|it| part.is_junction(it.0 + 1));
            junctions.extend(own_junctions.map(|it| junction(it.1)));
            phases.push(joined(phase, &part.problem, (&times, &all[own])));
            first += count;
        }
        let (parameter, unknowns) = (parameter.to_string(), unknowns.collect());
        ParametricSensitivity { parameter, unknowns, junctions, phases }
    }
}

impl Solution {
    /// Whether anything changes where a phase of a located optimum begins: some have intervals of
    /// another length only.
    fn is_junction(&self, phase: usize) -> bool {
        let structure = self.located.as_ref().map(|it| &it.structure.phases);
        structure.is_none_or(|all| match all.get(phase - 1..=phase) {
            Some([before, own]) => !own.is_alike(before),
            _ => true,
        })
    }
}

fn not_strict(parameter: &str) -> Error {
    let why = "the optimum is no strict minimum and may be anywhere along some direction, or some \
               of its conditions say the same";
    Error::Call(format!("no derivative by `{parameter}`: {why}"))
}

/// The phases of given modes one after the other.
fn joined(
    phase: Option<String>,
    problem: &Problem,
    (times, all): (&[&[f64]], &[Movement]),
) -> PhaseSensitivity {
    let last = all.len() - 1;
    let at_points = |of: &dyn Fn(usize) -> Vec<f64>| -> Vec<f64> {
        let own = (0..all.len()).flat_map(|j| {
            let mut column = of(j);
            column.truncate(column.len() - usize::from(j < last));
            column
        });
        own.collect()
    };
    let state =
        |(at, it): (usize, &Variable)| (it.name.clone(), at_points(&|j| all[j].states[at].clone()));
    let control = |(at, it): (usize, &Variable)| {
        (it.name.clone(), all.iter().flat_map(|own| own.controls[at].clone()).collect())
    };
    let shown = problem.states.iter().enumerate().filter(|it| !it.1.hidden);
    let moved = problem.controls.iter().enumerate().filter(|it| !is_kink(&it.1.name));
    PhaseSensitivity {
        phase,
        time: at_points(&|j| times[j].to_vec()),
        states: shown.map(state).collect(),
        controls: moved.map(control).collect(),
    }
}
