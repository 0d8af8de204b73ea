//! A model with its meaning: names resolved, shapes known, every expression an entry of one graph.
//!
//! An [`Input`](crate::expressions::graph::Expr::Input) of this graph is a *symbol*: time, a state,
//! a control and so on, all scalar. Real time, real units (SI), and a selector for each surface;
//! lowering gives them the places that compiled functions want. Bounds and parameters stay
//! expressions, so that the command line can change a number.

mod along;
mod angles;
mod at_times;
mod declarations;
mod duration;
mod ends;
mod expected;
pub(crate) mod guess;
mod knots;
mod measured;
pub(crate) mod numbers;
mod overrides;
pub(crate) mod phases;
mod plots;
mod signals;
mod switches;
mod unsolved;

pub use along::Along;
pub(crate) use at_times::{Instant, between_times};
pub use declarations::{
    AtTime, Ball, Begins, Constraint, Control, Definition, Free, Integral, Jump, Param, Place,
    Range, Signal, State, Surface, Swept,
};
pub use measured::Sum;
pub(crate) use measured::by_row;
pub use switches::Switch;

use crate::data::Table;
use crate::expressions::graph::{ExprId, Graph};
use crate::settings;
use crate::units::{NamedUnit, WidthUnit};
pub use expected::{Comparison, Expectation, Report, Simulated};
use fdcc_grammar::{Code, Diagnostic, Span};
use fdcc_runtime::problem::Method;
pub use phases::{Link, Phase};
pub use plots::{Border, Plane, Plot};

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
    /// Quantities that are given from outside.
    pub signals: Vec<Signal>,
    /// The parameter that is added to the time at which signals have the values of the text, where
    /// they have points.
    pub signal_time: Option<usize>,
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
    /// Pictures of the answer.
    pub plots: Vec<Plot>,
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
    /// How large names are that an answer showed to be far smaller than one of their unit.
    pub magnitudes: Vec<(String, f64)>,
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
            signals: Vec::new(),
            signal_time: None,
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
            plots: Vec::new(),
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
            magnitudes: Vec::new(),
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
            let message = "a model with phases is no single system";
            let label = "`simulate` goes from phase to phase";
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

/// "This is solved but cannot be differentiated along a simulation yet."
pub(crate) fn not_simulated_yet(span: Span) -> Diagnostic {
    let message = "a sum over rows cannot be differentiated along a simulation yet";
    let label = "understood by `solve`, not yet by `grad`";
    Diagnostic::new(Code::NotYet, message, span, label)
}
