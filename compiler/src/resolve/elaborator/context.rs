//! What an expression may read, depending on where it stands.

use super::Elaborator;
use super::value::{Reads, Value};
use fdcc_grammar::{Code, Diagnostic, Span};

/// A place of the language and the kinds of symbols that have a meaning there.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Context {
    /// In the words of a message: `the objective`.
    pub name: &'static str,
    /// What may be read.
    pub allowed: Reads,
    /// Whether `x'` stands for the derivative of a guess.
    pub is_guess: bool,
    /// Whether `inf` may stand here, for a side without a bound.
    pub is_bound: bool,
}

const SIGNAL: Reads = Reads::TIME
    .or(Reads::STATE)
    .or(Reads::CONTROL)
    .or(Reads::PARAM)
    .or(Reads::FREE)
    .or(Reads::SELECTOR);
const AT_AN_END: Reads = Reads::TIME.or(Reads::STATE).or(Reads::PARAM).or(Reads::FREE);
const WHOLE: Reads = Reads::PARAM.or(Reads::FREE).or(Reads::WHOLE).or(Reads::PHASE);
/// What a definition outside of all phases reads of a phase has no meaning within another.
const ANY_PHASE: Reads = Reads::PHASE.or(Reads::FOREIGN);

impl Context {
    const fn new(name: &'static str, allowed: Reads) -> Self {
        Context { name, allowed, is_guess: false, is_bound: false }
    }

    pub const DEFINITION: Context = Context::new("a definition", Reads::ALL);
    pub const GIVEN: Context = Context::new("a signal", Reads::TIME.or(Reads::PARAM));
    pub const NUMBER: Context = Context::new("a constant", Reads::PARAM);
    pub const WIDTH: Context = Context::new("a width", Reads::PARAM);
    pub const BOUND: Context = Context { is_bound: true, ..Context::new("a bound", Reads::PARAM) };
    pub const SIGNAL_BOUND: Context =
        Context { is_bound: true, ..Context::new("a bound", Reads::PARAM.or(Reads::FREE)) };
    pub const SETTING: Context = Context::new("a setting", Reads::PARAM);
    pub const TIME: Context = Context::new("the bounds of time", Reads::PARAM.or(Reads::FREE));
    pub const START: Context = Context::new("a start value", Reads::PARAM.or(Reads::FREE));
    pub const FREE_GUESS: Context =
        Context::new("the guess of an unknown", Reads::PARAM.or(Reads::FREE));
    pub const DYNAMICS: Context = Context::new("the dynamics", SIGNAL);
    pub const PATH: Context = Context::new("a path constraint", SIGNAL);
    pub const INTEGRAND: Context = Context::new("an integral", SIGNAL.or(ANY_PHASE));
    pub const REPORT: Context = Context::new("a report", SIGNAL);
    pub const PLOT: Context = Context::new("a plot", SIGNAL);
    pub const SURFACE: Context = Context::new("a surface", AT_AN_END);
    pub const AT_AN_END: Context =
        Context::new("a value at the start or the end", AT_AN_END.or(ANY_PHASE));
    pub const BOUNDARY: Context =
        Context::new("a start or end condition", AT_AN_END.or(Reads::WHOLE).or(Reads::PHASE));
    pub const TIME_OF_CONDITION: Context =
        Context::new("the time of a condition", Reads::PARAM.or(Reads::FREE));
    pub const AT_A_TIME: Context = Context::new("a condition at a time", AT_AN_END);
    pub const LINK: Context = Context::new("a link", AT_AN_END.or(Reads::CONTROL).or(Reads::WHOLE));
    pub const OBJECTIVE: Context = Context::new("the objective", WHOLE);
    pub const SENSITIVITY: Context = Context::new("a sensitivity", WHOLE);
    pub const EXPECT: Context = Context::new("an expectation", WHOLE.or(Reads::SIMULATION));
    pub const TABLE: Context = Context::new("a table", Reads::ROW);
    pub const ROW_TIME: Context = Context::new("the time of a row", Reads::ROW.or(Reads::PARAM));
    pub const AT_A_ROW: Context =
        Context::new("a value at the time of a row", AT_AN_END.or(Reads::CONTROL).or(ANY_PHASE));
    pub const FIT: Context = Context::new("a fit", Reads::ROW);
    pub const DEVIATION: Context =
        Context::new("a standard deviation", Reads::ROW.or(Reads::PARAM));
    pub const GUESS: Context = Context {
        is_guess: true,
        ..Context::new("a guess", Reads::TIME.or(Reads::PARAM).or(Reads::FREE))
    };

    /// The same inside a sum over rows.
    pub fn of_rows(self) -> Context {
        Context { name: "a sum over data", allowed: self.allowed.or(Reads::ROW), ..self }
    }
}

impl Elaborator<'_> {
    /// Lets a value through if all it reads has a meaning here.
    pub fn admit(&mut self, what: &str, value: Value, span: Span) -> Value {
        // What a set has no business in is told in the words of sets.
        let of_sets = if value.traits.sets.is_empty() { Reads::default() } else { Reads::SELECTOR };
        let beyond = value.traits.reads.beyond(self.here.context.allowed.or(of_sets));
        if beyond.is_empty() {
            return value;
        }
        let (label, help) = explain(what, beyond, self.here.context);
        let message = format!("`{what}` has no meaning in {}", self.here.context.name);
        self.fail(Diagnostic::new(Code::NotAllowedHere, message, span, label).help(help))
    }
}

/// Why a kind of symbol has no meaning in a context, and what could be meant.
fn explain(what: &str, beyond: Reads, context: Context) -> (&'static str, String) {
    of_elsewhere(what, beyond, context)
        .or_else(|| of_certain_contexts(what, beyond, context))
        .unwrap_or_else(|| of_time(what, beyond, context))
}

/// Of what is read where it does not stand: in another phase, in rows of data, in a simulation.
fn of_elsewhere(what: &str, beyond: Reads, context: Context) -> Option<(&'static str, String)> {
    let in_a_sum = context.allowed.has(Reads::ROW) && context.allowed.has(Reads::WHOLE);
    Some(if beyond.has(Reads::FOREIGN) {
        (
            "is of another phase",
            "what ties phases together stands outside of them: a `link`, a condition, the \
             objective; what several phases need is declared outside"
                .into(),
        )
    } else if beyond.has(Reads::PHASE) {
        (
            "is of one phase",
            "it may stand in the objective, in `start` and `end` conditions and in `expect`; or \
             write this within the phase"
                .into(),
        )
    } else if beyond.has(Reads::ROW) {
        (
            "a column, which has a value in each row",
            "go through the rows with `sum(k in obs, ...)`, or draw a curve through them with \
             `interpolate(obs.t, obs.y, t)`"
                .into(),
        )
    } else if in_a_sum && beyond.has(Reads::STATE.or(Reads::CONTROL).or(Reads::TIME)) {
        ("at which time?", format!("write `{what}(k.t)`: its value at the time of a row"))
    } else if beyond.has(Reads::SIMULATION) {
        ("only a simulation can tell", "it may stand in `expect`".into())
    } else if beyond.has(Reads::WHOLE) {
        (
            "one number for the whole run",
            "it may stand in the objective, in `start` and `end` conditions and in `expect`".into(),
        )
    } else {
        return None;
    })
}

/// Of conditions at a time, and of guesses.
fn of_certain_contexts(
    what: &str,
    beyond: Reads,
    context: Context,
) -> Option<(&'static str, String)> {
    Some(if context.name == Context::AT_A_TIME.name && beyond.has(Reads::CONTROL) {
        (
            "a control, which may jump at that time",
            format!("bound `{what}` with `path`, or make it a state whose derivative is a control"),
        )
    } else if context.name == Context::TIME_OF_CONDITION.name {
        ("varies over time", "the time is made of numbers, `param` and `free` names".into())
    } else if context.is_guess {
        (
            "has no guess above this line",
            format!(
                "a guess may use time, `free` names and guesses above it: guess `{what}` first"
            ),
        )
    } else {
        return None;
    })
}

/// Of what varies over time, or is chosen.
fn of_time(what: &str, beyond: Reads, context: Context) -> (&'static str, String) {
    let whole = context.allowed.has(Reads::WHOLE);
    if beyond.has(Reads::CONTROL) && whole {
        (
            "a control, which varies over time and has no value at a single time",
            format!("write `integral({what})`, or bound it with `path`"),
        )
    } else if beyond.has(Reads::CONTROL) {
        ("depends on a control", "it may depend on states, time and parameters".into())
    } else if beyond.has(Reads::STATE.or(Reads::TIME)) && whole {
        (
            "varies over time, but one number is needed",
            format!("write `{what}(end)`, `{what}(start)` or `integral({what})`"),
        )
    } else if beyond.has(Reads::STATE.or(Reads::TIME)) {
        ("varies over time", format!("{} is made of numbers, `const` and `param`", context.name))
    } else if beyond.has(Reads::SELECTOR) {
        (
            "depends on the side of a surface",
            "take it along the path instead, with `integral` or `path`".into(),
        )
    } else {
        (
            "chosen by the optimiser",
            format!("{} is made of numbers, `const` and `param`", context.name),
        )
    }
}
