//! A model in closed loop: solved again and again, from the state that was measured.

use super::{Compiled, Options, Solution, Start};
use crate::error::Error;
use crate::model::{Model, Value};

/// Solves a model once for each state that it is told, from the solution before with its
/// multipliers, or from what is left of that after its first interval where the state is nearer to
/// it. The smoothed problem is solved.
///
/// ```
/// let model = fdcc::Model::from_text("hop", "time t in [0, 1]
/// param goal = 0.5
/// state x start 0
/// control u in [-1, 1]
/// dynamics { x' = u }
/// minimize integral((x - goal)^2 + 0.1 * u^2)")?;
/// let mut controller = model.controller(20)?;
/// let mut x = 0.0;
/// for _ in 0..100 {
///     let solution = controller.step(&[x], &fdcc::Options::default())?;
///     let [u, until] = [solution.control("u").expect("it is declared")[0], solution.time()[1]];
///     x += until * u;
/// }
/// assert!((x - 0.5).abs() < 1e-2);
/// # Ok::<(), fdcc::Error>(())
/// ```
pub struct Controller {
    compiled: Compiled,
    last: Option<Solution>,
}

impl Model {
    /// A controller with so many intervals.
    ///
    /// # Errors
    ///
    /// A model that cannot be solved, that has phases, jumps or conditions at times, that names no
    /// width of its layers, or that has signals and chooses its times.
    pub fn controller(&self, intervals: usize) -> Result<Controller, Error> {
        let model = self.with_method("N", intervals as f64)?;
        let meaning = model.meaning();
        let refuse = |what: &str| Err(Error::Call(format!("a controller needs a model {what}")));
        if !meaning.phases.is_empty() || !meaning.jumps.is_empty() {
            return refuse("without phases or jumps");
        }
        if !meaning.at_times.is_empty() {
            return refuse("without conditions at times");
        }
        if !meaning.surfaces.is_empty() && meaning.method.sigma.is_none() {
            return refuse("that names the width of its layers, as in `method { sigma = 0.05 }`");
        }
        let model = match meaning.signals.is_empty() {
            true => model,
            false if meaning.chooses_times() => return refuse("with signals to fix its times"),
            false => model.with_given_signals(intervals)?,
        };
        Ok(Controller { compiled: model.compile()?, last: None })
    }
}

impl Controller {
    /// The model with its values.
    pub fn model(&self) -> &Model {
        self.compiled.model()
    }

    /// The names of the states, in the order in which [`step`](Controller::step) takes them.
    pub fn states(&self) -> impl Iterator<Item = &str> {
        let states = self.compiled.problem().states.iter();
        states.filter(|state| !state.hidden).map(|state| state.name.as_str())
    }

    /// The names of the controls.
    pub fn controls(&self) -> impl Iterator<Item = &str> {
        self.compiled.problem().controls.iter().map(|control| control.name.as_str())
    }

    /// The last solution.
    pub fn last(&self) -> Option<&Solution> {
        self.last.as_ref()
    }

    /// Gives a parameter another value, from the next step on; nothing is compiled anew.
    ///
    /// # Errors
    ///
    /// Those of [`Model::with`].
    pub fn set(&mut self, name: &str, value: impl Into<Value>) -> Result<(), Error> {
        self.compiled = self.compiled.model().with(name, value)?.compile()?;
        Ok(())
    }

    /// The names of the signals, each component by itself.
    pub fn signals(&self) -> impl Iterator<Item = &str> {
        self.model().meaning().signals.iter().map(|it| it.place.name.as_str())
    }

    /// Gives a signal its values from the next step on, in SI: one for each point of the grid, or
    /// one for all of them. Between points it is a straight line.
    ///
    /// ```
    /// let model = fdcc::Model::from_text("follow", "time t in [0, 1]
    /// signal r = 0
    /// state x start 0
    /// control u in [-5, 5]
    /// dynamics { x' = u }
    /// minimize integral((x - r)^2 + 0.001 * u^2)")?;
    /// let mut controller = model.controller(4)?;
    /// controller.set_signal("r", &[0.0, 0.2, 0.4, 0.6, 0.8])?;
    /// let plan = controller.step(&[0.0], &fdcc::Options::default())?;
    /// assert!((plan.state("x").expect("it is declared")[2] - 0.4).abs() < 0.02);
    /// # Ok::<(), fdcc::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// A name that is no signal; another number of values, or one that is not finite.
    pub fn set_signal(&mut self, name: &str, values: &[f64]) -> Result<(), Error> {
        let at = self.signal_at(name)?;
        let wanted = self.model().meaning().signals[at].points.len();
        let is_fine = values.len() == 1 || values.len() == wanted;
        if !is_fine || values.iter().any(|value| !value.is_finite()) {
            let message = format!("`{name}` takes 1 or {wanted} finite values, one for each point");
            return Err(Error::Call(message));
        }
        let all = if values.len() == 1 { vec![values[0]; wanted] } else { values.to_vec() };
        self.change(|meaning| meaning.give_signal(at, &all))
    }

    fn signal_at(&self, name: &str) -> Result<usize, Error> {
        let names: Vec<&str> = self.signals().collect();
        let message = || match names.is_empty() {
            true => format!("`{name}` is no signal; the model has none"),
            false => format!("`{name}` is no signal; signals are {}", names.join(", ")),
        };
        names.iter().position(|it| *it == name).ok_or_else(|| Error::Call(message()))
    }

    /// Signals that were not given have the values of the text from this time on, in SI, instead of
    /// those from the first time on.
    ///
    /// # Errors
    ///
    /// A time that is not finite.
    pub fn set_time(&mut self, now: f64) -> Result<(), Error> {
        match now.is_finite() {
            true if self.model().meaning().signals.is_empty() => Ok(()),
            true => self.change(|meaning| meaning.set_signal_time(now)),
            false => Err(Error::Call(format!("the time cannot be {now}"))),
        }
    }

    fn change(&mut self, change: impl FnOnce(&mut fdcc_compiler::Model)) -> Result<(), Error> {
        self.compiled = self.compiled.model().with_values(change).compile()?;
        Ok(())
    }

    /// Solves from a state, in SI; the options say when to stop, and not where to begin. The first
    /// value of a control is meant until the second point of the grid. That nothing was found is a
    /// status.
    ///
    /// # Errors
    ///
    /// Another number of values than there are states, or one that is not finite.
    pub fn step(&mut self, state: &[f64], options: &Options) -> Result<&Solution, Error> {
        let count = self.states().count();
        if state.len() != count || state.iter().any(|value| !value.is_finite()) {
            return Err(Error::Call(format!("a state has {count} finite values")));
        }
        self.compiled.begin_at(state);
        let start = self.last.as_ref().map_or(Start::Guess, |plan| begin_of(plan, state));
        let found = self.compiled.solve_step(&Options { start, ..*options })?;
        let is_lost = !found.is_solved() && (options.stop)().is_continue() && self.last.is_some();
        let found = match is_lost {
            true => self.compiled.solve_step(&Options { start: Start::Guess, ..*options })?,
            false => found,
        };
        Ok(self.last.insert(found))
    }
}

/// Where a solve from a state begins: at the plan, or at what is left of it after its first
/// interval if the state is nearer to that.
fn begin_of<'p>(plan: &'p Solution, state: &[f64]) -> Start<'p> {
    let shown = plan.problem.states.iter().zip(&plan.outcome.trajectory.states);
    let columns = shown.filter(|(state, _)| !state.hidden).map(|(_, column)| column);
    let (mut now, mut later) = (0.0, 0.0);
    for (column, value) in columns.zip(state) {
        let size = column.iter().fold(0.0, |size: f64, it| size.max((it - column[0]).abs()));
        if size > 0.0 {
            now += ((value - column[0]) / size).powi(2);
            later += ((value - column[1]) / size).powi(2);
        }
    }
    // Where the end of time is chosen, too, an interval later is another part of the plan.
    let is_receding = plan.problem.unknowns.is_empty();
    if is_receding && later < now { Start::Later(plan) } else { Start::Solution(plan) }
}

impl Compiled {
    /// Gives the states that are shown other values at the first time.
    fn begin_at(&mut self, state: &[f64]) {
        for problem in self.chain.phases.iter_mut().chain([&mut self.problem]) {
            let shown = problem.states.iter().map(|it| !it.hidden).zip(&mut problem.start);
            let starts = shown.filter(|(is_shown, _)| *is_shown).map(|(_, start)| start);
            starts.zip(state).for_each(|(start, value)| *start = Some(*value));
        }
    }
}
