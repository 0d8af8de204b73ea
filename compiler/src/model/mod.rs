//! A model with its meaning: names resolved, shapes known, every expression an entry of one graph.
//!
//! An [`Input`](crate::expressions::graph::Expr::Input) of this graph is a *symbol*: time, a state,
//! a control and so on, all scalar. Real time, real units (SI), and a selector for each surface;
//! lowering gives them the places that compiled functions want. Bounds and parameters stay
//! expressions, so that the command line can change a number.

mod at_times;
mod expected;
pub(crate) mod guess;
mod measured;
pub(crate) mod numbers;
mod overrides;
pub(crate) mod phases;
mod switches;
mod unsolved;

pub(crate) use at_times::Instant;
pub use measured::Sum;
pub(crate) use measured::by_row;
pub use switches::Switch;

use crate::data::Table;
use crate::expressions::graph::{ExprId, Graph};
use crate::settings;
use crate::units::{NamedUnit, WidthUnit};
pub use expected::{Comparison, Expectation, Report, Simulated};
use fdcc_grammar::ast::Direction;
use fdcc_grammar::{Code, Diagnostic, Span};
use fdcc_runtime::problem::Method;
pub use phases::{Link, Phase};

/// What an input of the model's graph stands for. The numbers are indices into the lists of
/// [`Model`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Symbol {
    /// Real time.
    Time,
    /// A state at the current time.
    State(usize),
    /// A control at the current time.
    Control(usize),
    /// A `param`.
    Param(usize),
    /// A `free` unknown.
    Free(usize),
    /// The selector in [-1, 1] of a surface.
    Selector(usize),
    /// A state at the start.
    AtStart(usize),
    /// A state at the end.
    AtEnd(usize),
    /// The integral over the whole time of [`Model::integrals`].
    Integral(usize),
    /// A sum over rows, one of [`Model::sums`].
    Sum(usize),
    /// In the current row of one of [`Model::tables`], one of its columns.
    Column(usize, usize),
    /// A number that only a simulation can tell, one of [`Model::simulated`].
    Simulated(usize),
    /// An argument of a function, while its body is examined by itself; all functions share them.
    Argument(usize),
    /// A control in the first interval.
    ControlAtStart(usize),
    /// A control in the last interval.
    ControlAtEnd(usize),
    /// What an input of the graph of a phase stands for, as the whole reads it.
    OfPhase {
        /// One of [`Model::phases`].
        phase: usize,
        /// An input of its graph.
        input: u32,
    },
}

/// Where something was written, and what to call it.
#[derive(Clone, Debug, Default)]
pub struct Place {
    /// In the model's words.
    pub name: String,
    /// In its text.
    pub span: Span,
}

/// `lower <= . <= upper` over parameters; infinite numbers where there is no bound.
#[derive(Clone, Copy, Debug)]
pub struct Range {
    /// Lower bound.
    pub lower: ExprId,
    /// Upper bound.
    pub upper: ExprId,
}

/// A `param`.
#[derive(Clone, Debug)]
pub struct Param {
    /// Its declaration.
    pub place: Place,
    /// Its value over other parameters; `None` until the command line gives one.
    pub value: Option<ExprId>,
    /// What the command line may give.
    pub range: Range,
}

/// A `free` unknown.
#[derive(Clone, Debug)]
pub struct Free {
    /// Its declaration.
    pub place: Place,
    /// Its bounds.
    pub range: Range,
    /// Its guess, over parameters and other unknowns.
    pub guess: Option<ExprId>,
}

/// A scalar state.
#[derive(Clone, Debug)]
pub struct State {
    /// Its declaration.
    pub place: Place,
    /// Bounds at all times.
    pub range: Range,
    /// `start EXPR`, over parameters and unknowns.
    pub start: Option<ExprId>,
    /// `start free in [a, b]`.
    pub start_range: Option<Range>,
    /// Its derivative in real time, affine in the selectors.
    pub rate: ExprId,
    /// The equation; named `x'`.
    pub equation: Place,
    /// Its guess over time, parameters and unknowns.
    pub guess: Option<ExprId>,
}

/// A scalar control.
#[derive(Clone, Debug)]
pub struct Control {
    /// Its declaration.
    pub place: Place,
    /// Bounds at all times.
    pub range: Range,
    /// Its guess over time, parameters and unknowns.
    pub guess: Option<ExprId>,
}

/// A switching surface.
#[derive(Clone, Debug)]
pub struct Surface {
    /// Its declaration, or the first use of an unnamed one.
    pub place: Place,
    /// The switching function, whose sign decides.
    pub psi: ExprId,
}

/// The vector of a `Dir`: the length of `s` is at most 1, and `s = psi/|psi|` off 0.
#[derive(Clone, Debug)]
pub struct Ball {
    /// Its first use, named by the text of the vector.
    pub place: Place,
    /// Its components, as indices into [`Model::surfaces`].
    pub surfaces: std::ops::Range<usize>,
}

/// A reset of the state: `x+ = r(t, x-, p)` where a surface is crossed in one direction.
#[derive(Clone, Debug)]
pub struct Jump {
    /// Its declaration.
    pub place: Place,
    /// The surface, as an index into [`Model::surfaces`].
    pub surface: usize,
    /// Which crossing resets.
    pub direction: Direction,
    /// How often at most, over parameters.
    pub at_most: Option<ExprId>,
    /// The surface that is held after the last one.
    pub then_hold: Option<usize>,
    /// States, as indices into [`Model::states`], with their values after the jump.
    pub resets: Vec<(usize, ExprId)>,
}

/// A scalar row of a condition: `lower <= value <= upper`.
#[derive(Clone, Debug)]
pub struct Constraint {
    /// The condition.
    pub place: Place,
    /// What is bounded.
    pub value: ExprId,
    /// By what.
    pub range: Range,
}

/// `at TIME: CONDITION`, between the ends of time.
#[derive(Clone, Debug)]
pub struct AtTime {
    /// The time as it was written.
    pub place: Place,
    /// When the rows hold, over parameters and unknowns.
    pub time: ExprId,
    /// What holds then, over the symbols of any time.
    pub rows: Vec<Constraint>,
}

/// An `integral(...)`.
#[derive(Clone, Debug)]
pub struct Integral {
    /// The call; named by its text.
    pub place: Place,
    /// What is integrated over real time.
    pub integrand: ExprId,
    /// Whether something outside of its phase needs its value.
    pub is_linked: bool,
}

/// A line of the `sweep` block.
#[derive(Clone, Debug)]
pub struct Swept {
    /// The name of a parameter or of a setting.
    pub place: Place,
    /// Its values: numbers in SI, words.
    pub values: Vec<String>,
    /// Where the values stand.
    pub values_span: Span,
}

/// A `const`, `let` or `fn`.
#[derive(Clone, Debug)]
pub struct Definition {
    /// Its name.
    pub name: String,
    /// The names of its arguments, none but for a function.
    pub arguments: Vec<String>,
    /// Its components; a function over [`Symbol::Argument`], none if that gives no value.
    pub parts: Vec<ExprId>,
}

/// A model whose text has no error.
#[derive(Clone)]
pub struct Model {
    /// `model NAME`, or `model`.
    pub name: String,
    /// All expressions, over [`Model::symbols`].
    pub graph: Graph,
    /// What each input of the graph is.
    pub symbols: Vec<Symbol>,
    /// Parameters.
    pub params: Vec<Param>,
    /// Parameters in an order in which each needs only earlier ones.
    pub param_order: Vec<usize>,
    /// Unknowns.
    pub frees: Vec<Free>,
    /// States.
    pub states: Vec<State>,
    /// Controls.
    pub controls: Vec<Control>,
    /// Surfaces.
    pub surfaces: Vec<Surface>,
    /// Which of them are the components of a `Dir`.
    pub balls: Vec<Ball>,
    /// Resets of the state.
    pub jumps: Vec<Jump>,
    /// First and last time, over parameters and unknowns.
    pub interval: [ExprId; 2],
    /// Conditions at all times.
    pub path: Vec<Constraint>,
    /// Which of them need not hold at the last time: what ends the phase says what they say.
    pub half_open: Vec<usize>,
    /// Conditions at the ends.
    pub boundary: Vec<Constraint>,
    /// Conditions at times between the ends.
    pub at_times: Vec<AtTime>,
    /// What is minimised, as written; none for a pure feasibility problem.
    pub objective: Option<(Place, ExprId)>,
    /// `-1` for `maximize`.
    pub sense: f64,
    /// Every `integral` of the objective, of conditions and of expectations.
    pub integrals: Vec<Integral>,
    /// Measured data.
    pub tables: Vec<Table>,
    /// Every `sum` that reads the trajectory at the times of rows.
    pub sums: Vec<Sum>,
    /// The width of every `blend`, where it is written and over parameters.
    pub widths: Vec<(Span, ExprId)>,
    /// What is reported.
    pub report: Vec<Report>,
    /// What expectations ask of a simulation.
    pub simulated: Vec<Simulated>,
    /// What is expected.
    pub expectations: Vec<Expectation>,
    /// Weights of states in the inner product in which the model is one-sided Lipschitz.
    pub metric: Vec<(usize, ExprId)>,
    /// Expressions that have a name in the text: definitions and reports.
    pub names: Vec<(String, ExprId)>,
    /// Constants, definitions and functions, for those who ask about one.
    pub definitions: Vec<Definition>,
    /// How it is to be solved.
    pub method: Method,
    /// The lists of the `sweep` block.
    pub sweep: Vec<Swept>,
    /// Whether `abs`, `min` and `max` are smoothed: there is a surface, or the model says `smooth`.
    pub smooth: bool,
    /// Phases, those that are linked in the order of time; none if the model is of one piece.
    pub phases: Vec<Phase>,
    /// What ties phases together.
    pub links: Vec<Link>,
    /// What is understood but cannot be solved yet, in the order of the text.
    pub not_yet: Vec<Diagnostic>,
    /// The unit of each name, if the text uses units.
    pub units: Vec<NamedUnit>,
    /// The unit of each condition and each expectation, by what it is called.
    pub condition_units: Vec<NamedUnit>,
    /// What a width of smoothing measures, if the text uses units and all surfaces measure the
    /// same.
    pub width_unit: Option<WidthUnit>,
}

impl Model {
    /// A model in which nothing has been declared.
    pub fn empty() -> Self {
        let mut graph = Graph::new();
        let interval = [graph.number(0.0), graph.number(1.0)];
        Model {
            name: "model".into(),
            graph,
            symbols: Vec::new(),
            params: Vec::new(),
            param_order: Vec::new(),
            frees: Vec::new(),
            states: Vec::new(),
            controls: Vec::new(),
            surfaces: Vec::new(),
            balls: Vec::new(),
            jumps: Vec::new(),
            interval,
            path: Vec::new(),
            half_open: Vec::new(),
            boundary: Vec::new(),
            at_times: Vec::new(),
            objective: None,
            sense: 1.0,
            integrals: Vec::new(),
            tables: Vec::new(),
            sums: Vec::new(),
            widths: Vec::new(),
            report: Vec::new(),
            simulated: Vec::new(),
            expectations: Vec::new(),
            metric: Vec::new(),
            names: Vec::new(),
            definitions: Vec::new(),
            method: settings::default_method(),
            sweep: Vec::new(),
            smooth: false,
            phases: Vec::new(),
            links: Vec::new(),
            not_yet: Vec::new(),
            units: Vec::new(),
            condition_units: Vec::new(),
            width_unit: None,
        }
    }

    /// The same model with another objective, over the symbols that an objective may read.
    pub fn with_objective(&self, value: ExprId) -> Model {
        let place = self.objective.as_ref().map(|(place, _)| place.clone()).unwrap_or_default();
        Model { objective: Some((place, value)), sense: 1.0, ..self.clone() }
    }

    /// The first construct that is understood but cannot be simulated or differentiated as a whole.
    pub(crate) fn first_not_yet(&self) -> Option<Diagnostic> {
        let phases = self.phases.iter().map(|it| {
            let message = "a model with phases cannot be simulated as a whole yet";
            let label = "`solve` replays each phase by itself";
            Diagnostic::new(Code::NotYet, message, it.place.span, label)
        });
        self.not_yet.iter().cloned().chain(phases).min_by_key(Diagnostic::span)
    }

    /// The graph input that is a symbol.
    pub fn input_of(&self, symbol: Symbol) -> Option<u32> {
        self.symbols.iter().position(|&known| known == symbol).map(|at| at as u32)
    }
}

/// "This is understood but cannot be solved yet."
pub(crate) fn not_yet(span: Span, what: &str) -> Diagnostic {
    let message = format!("{what} cannot be solved yet");
    Diagnostic::new(Code::NotYet, message, span, "understood by `check`, not yet by `solve`")
}
