//! From a compiled model to a [`Solution`]: [`multistart`] tries several starting points,
//! [`sequences`] all sequences of jumps.

mod alternatives;
mod at_times;
mod beginning;
mod bounds;
mod cases;
mod certify;
mod controller;
mod families;
mod found;
mod grid;
mod joined_phases;
mod kink_gaps;
mod kink_words;
mod kinks;
mod located;
mod located_at_times;
mod located_in_phases;
mod magnitudes;
mod multistart;
pub mod optimality;
mod other_modes;
mod other_ways;
mod parametric;
mod phases;
mod reach;
mod report;
mod sequence_of_guess;
mod sequences;
mod sequences_in_phases;
mod shown;
mod simulated_start;
mod solution;
mod start_beside;
mod sweep;
mod timing;
pub mod true_optimum;
mod tuning;

pub use cases::{Case, Cases};
pub use controller::Controller;
pub use families::Family;
pub use found::{Jump, Phases, Sequence};
pub use grid::Grid;
pub use parametric::{ParametricSensitivity, PhaseSensitivity};
pub use reach::Reach;
pub use report::{Ended, Options, Part, Report, Start};
pub use shown::{CostatesBefore, PathCondition};
pub use solution::Solution;
pub use sweep::Sweep;

use crate::error::Error;
use crate::executor::Executor;
use crate::model::{Model, frame};
use crate::record::Record;
use crate::warm_start;
use fdcc_compiler::Kinks;
use fdcc_runtime::problem::{Chain, Linear, Method, Problem, often_called};
use fdcc_runtime::transcribe::{conditions, unknowns};
use found::Found;
use tuning::search::STARTS;

/// A model with the problem that is solved for it.
///
/// ```
/// let model = fdcc::Model::from_text("hop", "time t in [0, 1]
/// state x start 0
/// control u in [-1, 1]
/// dynamics { x' = u }
/// end x == 0.5
/// minimize integral(u^2)")?;
/// let compiled = model.compile()?;
/// assert_eq!(compiled.problem().states.len(), 1);
/// # Ok::<(), fdcc::Error>(())
/// ```
pub struct Compiled {
    model: Model,
    problem: Problem,
    chain: Chain,
    /// The same in which unknowns stand for kinks.
    without_kinks: Option<Box<Compiled>>,
}

impl Model {
    /// Makes everything ready that a solve needs, unless a variant with other values has been
    /// compiled already.
    ///
    /// # Errors
    ///
    /// A model that cannot be solved.
    pub fn compile(&self) -> Result<Compiled, Error> {
        let without_kinks = self.without_kinks(Kinks::Relaxed);
        let without_kinks = without_kinks.map(|it| it.compile_as_it_is(None)).transpose()?;
        self.compile_as_it_is(without_kinks)
    }

    fn compile_as_it_is(&self, without_kinks: Option<Compiled>) -> Result<Compiled, Error> {
        let chain = self.chain()?;
        let of_phases = self.meaning().phases.iter().map(|it| it.model.jumps.len());
        let jumps = self.meaning().jumps.len() + of_phases.sum::<usize>();
        refuse_senseless(&chain, jumps)?;
        let is_one = jumps == 0 && self.meaning().at_times.is_empty();
        if is_one && without_kinks.is_none() {
            self.make_ready(|| chain.phases.iter().for_each(make_machine_code));
        }
        let without_kinks = without_kinks.map(Box::new);
        Ok(Compiled { model: self.clone(), problem: frame(&chain), chain, without_kinks })
    }

    /// Solves. That nothing was found is no error: the [status](Solution::status) says so.
    ///
    /// # Errors
    ///
    /// A model that cannot be solved, or not in the way that its method asks for; a start that does
    /// not belong to it.
    pub fn solve(&self, options: &Options) -> Result<Solution, Error> {
        self.compile()?.solve(options)
    }
}

impl Compiled {
    /// The problem: states, controls, bounds, functions. Of a model with jumps, what holds between
    /// them; of one with phases, what these share.
    pub fn problem(&self) -> &Problem {
        &self.problem
    }

    /// The problems of all phases, and the links between them.
    pub fn chain(&self) -> &Chain {
        &self.chain
    }

    /// The model.
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// Whether a solve can begin there.
    ///
    /// # Errors
    ///
    /// A record that has nothing of this model, or a hole in what it has.
    pub fn check_start(&self, start: Start) -> Result<(), Error> {
        match start {
            Start::Record(record) => warm_start::check(record, &self.chain),
            Start::Guess | Start::Solution(_) | Start::Later(_) => Ok(()),
        }
    }

    /// Solves; from several other starts where nothing is found from the guess, and the model does
    /// not name how it is to be discretised.
    ///
    /// # Errors
    ///
    /// See [`Model::solve`].
    pub fn solve(&self, options: &Options) -> Result<Solution, Error> {
        let first = self.solve_from(options)?;
        let is_ours = options.starts <= 1 && !self.model.names_its_discretisation();
        let is_guessed = is_ours && matches!(options.start, Start::Guess);
        if !is_guessed || !first.may_be_found_elsewhere() || (options.stop)().is_break() {
            return Ok(first);
        }
        let more = self.solve_from(&Options { starts: STARTS, ..*options })?;
        Ok(if more.status().is_solved() { more } else { first })
    }

    /// Solves a step of a closed loop. What begins at the plan before stays in the units of the
    /// model: at rest all numbers are far smaller than one of these, and no step has the time to be
    /// compiled in others.
    fn solve_step(&self, options: &Options) -> Result<Solution, Error> {
        let begins_anew = matches!(options.start, Start::Guess | Start::Record(_));
        match begins_anew || self.without_kinks.is_some() {
            true => self.solve(options),
            false => self.solve_in_given_units(options),
        }
    }

    /// From the starts that were asked for; first without kinks, where there are any.
    fn solve_from(&self, options: &Options) -> Result<Solution, Error> {
        let without = self.without_kinks.as_ref();
        let own = without.map(|it| kinks::solve(self, it, options)).transpose()?.flatten();
        own.map_or_else(|| kinks::in_time(self, self.solve_as_it_is(options)?, options), Ok)
    }

    /// Solves; once more in other units where numbers turn out to be far smaller than one of
    /// theirs.
    fn solve_as_it_is(&self, options: &Options) -> Result<Solution, Error> {
        magnitudes::with_own_magnitudes(self.solve_in_given_units(options)?, options)
    }

    /// Solves; once more in another way where nothing is found.
    fn solve_in_given_units(&self, options: &Options) -> Result<Solution, Error> {
        let first = self.with_other_kernel(self.solve_once(options)?, options)?;
        self.with_other_scheme(first, options)
    }

    /// In three ways: time is divided at jumps and at conditions between the ends, and the chain of
    /// its parts is solved; or the model has phases, and is a chain itself; or it is one problem.
    /// Where it can be, the optimum of the true system is looked for at what was found.
    fn solve_once(&self, options: &Options) -> Result<Solution, Error> {
        self.check_start(options.start)?;
        let meaning = self.model.meaning();
        if let Start::Solution(earlier) = options.start
            && let Some(next) = located::continued(&self.model, earlier, &self.problem, options)
        {
            return Ok(next);
        }
        if !meaning.at_times.is_empty() || !meaning.jumps.is_empty() {
            let found = match options.start {
                Start::Guess => self.solve_divided(None, options)?,
                Start::Record(it) => self.solve_divided(Some(it), options)?,
                Start::Solution(it) | Start::Later(it) => {
                    self.solve_divided(Some(&it.record()), options)?
                }
            };
            return Ok(match meaning.at_times.is_empty() {
                true => self.with_certified_jumps(found, options),
                false => located_at_times::solution(&self.model, found, options),
            });
        }
        if meaning.phases.iter().any(|it| !it.model.jumps.is_empty()) {
            return self.solve_with_jumps_in_phases(options);
        }
        let start = match options.start {
            Start::Guess => None,
            Start::Record(record) => Some(warm_start::from_record(record, &self.chain)),
            Start::Solution(it) => Some(it.as_start(&self.chain)),
            Start::Later(it) => Some(it.as_later_start(&self.chain)),
        };
        let is_guessed = start.is_none();
        let mut found = multistart::solve(&self.chain, start, options, Part::default())?;
        let motion = is_guessed.then(|| simulated_start::start(&self.model, &self.chain)).flatten();
        if let Some(motion) = motion {
            found = multistart::also_from(found, motion, options, Part::default())?;
        }
        Ok(match meaning.phases.is_empty() {
            true => {
                let others = found.other_singles();
                families::best(&self.model, found.into_single(), others, options)
            }
            false => located_in_phases::solution(&self.model, found, options),
        })
    }

    /// The answer with the best sequence of jumps; where it is not certified, with the next best
    /// that is.
    fn with_certified_jumps(&self, mut found: Found, options: &Options) -> Solution {
        let next = std::mem::take(&mut found.next);
        certified_or_next(found, next, options, &|it| located::solution(&self.model, it, options))
    }

    /// The same of a model with jumps in its phases.
    fn solve_with_jumps_in_phases(&self, options: &Options) -> Result<Solution, Error> {
        let solve =
            |earlier| sequences_in_phases::solve(&self.model, &self.chain, earlier, options);
        let mut found = match options.start {
            Start::Guess => solve(None)?,
            Start::Record(it) => solve(Some(it))?,
            Start::Solution(it) | Start::Later(it) => solve(Some(&it.record()))?,
        };
        let next = found.divided.as_mut().map(|it| std::mem::take(&mut it.next));
        let locate = |it| located_in_phases::solution(&self.model, it, options);
        Ok(certified_or_next(found, next.unwrap_or_default(), options, &locate))
    }

    /// Where time is divided at certain times, or at jumps.
    fn solve_divided(&self, earlier: Option<&Record>, options: &Options) -> Result<Found, Error> {
        let (meaning, between) = (self.model.meaning(), &self.problem);
        match meaning.at_times.is_empty() {
            true => sequences::solve(meaning, between, earlier, options),
            false => at_times::solve(meaning, between, earlier, options),
        }
    }
}

/// What is located near the first answer; where that is not certified, near the first of the others
/// at which it is.
fn certified_or_next<F>(
    first: F,
    next: Vec<F>,
    options: &Options,
    locate: &dyn Fn(F) -> Solution,
) -> Solution {
    let first = locate(first);
    let is_missing = first.certificate.as_ref().is_some_and(|it| !it.is_certified());
    for other in next.into_iter().filter(|_| is_missing) {
        if (options.stop)().is_break() {
            break;
        }
        let other = locate(other);
        if other.is_certified() {
            return other;
        }
    }
    first
}

/// Makes the machine code that every solve needs, so that it counts as compiling.
fn make_machine_code(problem: &Problem) {
    let functions = often_called(problem);
    let prepare = |i: usize| functions[i].0.prepare(functions[i].1);
    Executor::default().in_order(functions.len(), prepare, |()| false);
}

/// More, conditions included, need more memory than a computer has to spare: about 1 kB each.
const MOST_UNKNOWNS: usize = 2_000_000;

/// What a solver cannot begin with; jumps divide the time before it does.
fn refuse_senseless(chain: &Chain, jumps: usize) -> Result<(), Error> {
    chain.phases.iter().try_for_each(refuse_phase)?;
    if let Some([steps, most]) = Method::excess_of(chain.phases.iter().map(|it| &it.method)) {
        return Err(Error::Call(format!(
            "{steps} steps in all phases together are too many; at most {most} are possible"
        )));
    }
    let sum = |count: fn(&Problem) -> usize| {
        chain.phases.iter().map(count).fold(0, usize::saturating_add)
    };
    let intervals = sum(|it| it.method.intervals());
    // The surface of a jump bounds every piece of a sequence.
    let conditions = sum(conditions).saturating_add(intervals.saturating_mul(jumps));
    let unknowns = sum(unknowns);
    if unknowns.saturating_add(conditions) <= MOST_UNKNOWNS {
        return Ok(());
    }
    let conditions = match conditions {
        0 => String::new(),
        many => format!(" with {many} conditions on them and surfaces beside them"),
    };
    Err(Error::Call(format!("{unknowns} unknowns{conditions} are too many; N = {intervals}")))
}

fn refuse_phase(problem: &Problem) -> Result<(), Error> {
    if let Some(diagnostic) = bounds::empty(problem) {
        return Err(Error::Model(vec![diagnostic]));
    }
    match unknowns(problem) {
        0 => Err(Error::Nothing),
        many if is_too_dense(problem, many) => Err(Error::Call(format!(
            "`linear = riccati` treats all {} unknowns of an interval as dense; leave it out, or \
             choose fewer `steps`",
            many / problem.method.intervals()
        ))),
        _ => Ok(()),
    }
}

/// More numbers in the blocks of the recursion than a computer has room for. Where nobody asks for
/// it, it is not chosen then.
const MOST_DENSE: usize = 200_000_000;

fn is_too_dense(problem: &Problem, unknowns: usize) -> bool {
    let each = unknowns / problem.method.intervals();
    problem.method.linear == Linear::Riccati && unknowns.saturating_mul(each) > MOST_DENSE
}
