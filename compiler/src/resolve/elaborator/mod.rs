//! The state of resolution: names, graph and findings, with the ways to report and to compute a
//! number.
//!
//! Evaluating an expression never fails: what went wrong is told once, and its value is unknown
//! from there on.

pub(crate) mod constants;
pub(crate) mod context;
pub(crate) mod here;
pub(crate) mod knots;
pub(crate) mod phases;
pub(crate) mod value;

use super::elaborator::constants::ConstantPart;
use super::elaborator::context::Context;
use super::elaborator::here::Here;
use super::elaborator::knots::Site;
use super::elaborator::phases::{Handed, Inner};
use super::elaborator::value::{Parts, Reads, Traits, Value};
use crate::data::Tables;
use crate::expressions::blend::Guards;
use crate::expressions::graph::evaluate_with;
use crate::expressions::graph::{ExprId, Graph};
use crate::model::{self, Ball, Integral, Model, Place, Symbol};
use crate::syntax::scope::Scope;
use crate::units::Readings;
use fdcc_grammar::ast;
use fdcc_grammar::{Code, Diagnostic, Span};
use std::collections::{HashMap, HashSet};

/// A surface, perhaps with a mistake in it.
pub(crate) struct SurfaceEntry {
    /// Name and place.
    pub place: Place,
    /// Its function, if that is known.
    pub psi: Option<ExprId>,
    /// Its selector.
    pub selector: ExprId,
}

/// A curve through measured data.
#[derive(Clone, Copy)]
pub(crate) struct Curve {
    /// Through the rows of this table.
    pub table: usize,
    /// Where it begins and ends.
    pub ends: [f64; 2],
    /// Where it is read.
    pub place: ExprId,
    /// The call.
    pub span: Span,
}

/// The rows of a sum over data.
#[derive(Default)]
pub(crate) struct Rows {
    /// At which time the trajectory is read.
    pub time: Option<ExprId>,
}

/// What a value is used for, and what it is made of: the subject of the checks.
pub(crate) struct Usage<'a> {
    /// What it is used for.
    pub role: Role<'a>,
    /// The value.
    pub parts: Parts,
    /// What it is made of.
    pub traits: Traits,
}

/// What a value is used for.
#[derive(Clone, Copy)]
pub(crate) enum Role<'a> {
    Equation(&'a ast::Equation),
    Path(Option<&'a ast::Ident>, &'a ast::Condition),
    Objective,
    Boundary(&'static str),
    Surface(&'a ast::Ident),
    Report(&'a ast::Ident),
    Number(&'static str),
}

/// Everything that is known while the items of one phase are resolved.
pub(crate) struct Elaborator<'a> {
    /// Declarations.
    pub scope: Scope<'a>,
    /// Which declarations lie on a circle.
    pub circular: Vec<bool>,
    /// All expressions.
    pub graph: Graph,
    /// What the inputs of the graph are.
    pub symbols: Vec<Symbol>,
    /// What each declared name stands for.
    pub values: Vec<Value>,
    /// Values of the parameters, NaN where unknown.
    pub param_values: Vec<f64>,
    /// Where in the text we are.
    pub here: Here<'a>,
    /// Data sets that were read.
    pub tables: &'a Tables,
    /// Curves through them.
    pub curves: Vec<Curve>,
    /// Surfaces, declared and unnamed.
    pub surfaces: Vec<SurfaceEntry>,
    /// The vectors of every `Dir`.
    pub balls: Vec<Ball>,
    /// The surface of a declaration.
    pub surface_of: HashMap<usize, usize>,
    /// Integrals.
    pub integrals: Vec<Integral>,
    /// By what the value of a text is multiplied, because it stands beside something in another
    /// unit than that of SI.
    pub readings: &'a Readings,
    /// The inputs of the states at the start and at the end.
    pub at_ends: [Vec<ExprId>; 2],
    /// The input that is time, if there is a time.
    pub time: Option<u32>,
    /// Results of functions, by function, examination and arguments.
    pub applied: HashMap<(usize, bool, Vec<Value>), Value>,
    /// Piecewise definitions by their place.
    pub sites: HashMap<Span, Site<'a>>,
    /// What selections compare.
    pub guards: Guards,
    /// Stand-ins for the arguments of functions that are examined by themselves.
    pub arguments: Vec<ExprId>,
    /// Calls outside functions, as they were written, with their values.
    pub written: Vec<(&'a ast::Expr, ExprId)>,
    /// The largest parts of formulas that are constant.
    pub constants: Vec<ConstantPart<'a>>,
    /// What constants are divided by.
    pub constant_divisors: Vec<ConstantPart<'a>>,
    /// The states whose equations are understood.
    pub known_rates: HashSet<usize>,
    /// What has been resolved so far; graph, symbols, surfaces and integrals are moved in at the
    /// end.
    pub model: Model,
    /// Whether each boundary row of the model is at the end; its symbols are those of any time
    /// until all are known.
    pub at_end: Vec<bool>,
    /// Values and their uses.
    pub usages: Vec<Usage<'a>>,
    /// The first `fit`, and the sums of all.
    pub fits: Option<(Span, Vec<ExprId>)>,
    /// First and last time.
    pub interval: [ExprId; 2],
    /// On how many equal intervals signals are given from outside, if they are.
    pub intervals: Option<usize>,
    /// The phases, resolved before what stands outside of them.
    pub phases: Vec<Inner<'a>>,
    /// What names the components of what is read of phases.
    pub named_in_phases: Vec<&'a ast::Item>,
    /// What this phase hands over.
    pub handed: Vec<Handed<'a>>,
    /// The guesses of a `guess` block for unknowns.
    pub guessed: Vec<(usize, ExprId)>,
    /// Findings.
    pub diagnostics: Vec<Diagnostic>,
    /// What cannot be solved yet.
    pub not_yet: Vec<Diagnostic>,
}

impl<'a> Elaborator<'a> {
    /// Nothing evaluated yet.
    pub fn new(scope: Scope<'a>, readings: &'a Readings, tables: &'a Tables) -> Self {
        let mut graph = Graph::new();
        let interval = [graph.number(0.0), graph.number(1.0)];
        let values = vec![Value::default(); scope.declarations.len()];
        Elaborator {
            circular: vec![false; values.len()],
            scope,
            graph,
            symbols: Vec::new(),
            values,
            param_values: Vec::new(),
            here: Here::outside(),
            tables,
            curves: Vec::new(),
            surfaces: Vec::new(),
            balls: Vec::new(),
            surface_of: HashMap::new(),
            integrals: Vec::new(),
            readings,
            at_ends: Default::default(),
            time: None,
            applied: HashMap::new(),
            sites: HashMap::new(),
            guards: Guards::default(),
            arguments: Vec::new(),
            written: Vec::new(),
            constants: Vec::new(),
            constant_divisors: Vec::new(),
            known_rates: HashSet::new(),
            model: Model::empty(),
            at_end: Vec::new(),
            usages: Vec::new(),
            fits: None,
            interval,
            intervals: None,
            phases: Vec::new(),
            named_in_phases: Vec::new(),
            handed: Vec::new(),
            guessed: Vec::new(),
            diagnostics: Vec::new(),
            not_yet: Vec::new(),
        }
    }

    /// A new input of the graph.
    pub fn symbol(&mut self, symbol: Symbol) -> ExprId {
        self.symbols.push(symbol);
        self.graph.input(self.symbols.len() as u32 - 1)
    }

    /// The input of a symbol, new or not.
    pub fn known_symbol(&mut self, symbol: Symbol) -> ExprId {
        match self.symbols.iter().position(|known| *known == symbol) {
            Some(input) => self.graph.input(input as u32),
            None => self.symbol(symbol),
        }
    }

    /// Reports and gives the unknown value.
    pub fn fail(&mut self, diagnostic: Diagnostic) -> Value {
        self.diagnostics.push(diagnostic);
        Value::default()
    }

    /// Reports a shape mismatch, unless arguments of an examined function are to blame.
    pub fn fail_shape(&mut self, diagnostic: Diagnostic) -> Value {
        if !self.here.examining {
            self.diagnostics.push(diagnostic);
        }
        Value::default()
    }

    /// Notes something that is understood but cannot be solved yet.
    pub fn not_yet(&mut self, span: Span, what: &str) {
        self.not_yet.push(model::not_yet(span, what));
    }

    /// Evaluates in another context.
    pub fn evaluate_in(&mut self, context: Context, expr: &'a ast::Expr) -> Value {
        let outer = self.here.enter(context);
        let value = self.evaluate(expr);
        self.here.context = outer;
        value
    }

    /// Evaluates for a purpose, which the checks will look at.
    pub fn evaluate_for(&mut self, role: Role<'a>, context: Context, expr: &'a ast::Expr) -> Value {
        let value = self.evaluate_in(context, expr);
        self.note(role, &value);
        value
    }

    /// Notes a value and its purpose.
    pub fn note(&mut self, role: Role<'a>, value: &Value) {
        self.usages.push(Usage { role, parts: value.parts.clone(), traits: value.traits.clone() });
    }

    /// A number that depends on parameters alone.
    pub fn evaluate_number(
        &mut self,
        role: &'static str,
        context: Context,
        expr: &'a ast::Expr,
    ) -> Option<ExprId> {
        let value = self.evaluate_for(Role::Number(role), context, expr);
        self.expect_number(&value, expr.span)
    }

    /// The only component of a value; reports a vector.
    pub fn expect_number(&mut self, value: &Value, span: Span) -> Option<ExprId> {
        match &value.parts {
            Parts::Scalar(part) => Some(*part),
            Parts::Unknown => None,
            Parts::Vector(_) => {
                let label = value.parts.describe();
                let found =
                    Diagnostic::new(Code::ShapeMismatch, "a number is needed here", span, label);
                self.fail_shape(
                    found.help(
                        "take a part such as `.x` or `[1]`, or reduce it with `norm` or `dot`",
                    ),
                );
                None
            }
        }
    }

    /// As many components as a variable has; a number stands for all of them. Empty if unknown.
    pub fn expect_parts(&mut self, value: &Value, wanted: usize, span: Span) -> Vec<ExprId> {
        match &value.parts {
            Parts::Unknown => Vec::new(),
            Parts::Scalar(part) => vec![*part; wanted],
            Parts::Vector(parts) if parts.len() == wanted => parts.to_vec(),
            parts => {
                let needed =
                    if wanted == 1 { "a number".into() } else { format!("a vector of {wanted}") };
                let message = format!("{} where {needed} is needed", parts.describe());
                self.fail_shape(Diagnostic::new(
                    Code::ShapeMismatch,
                    message,
                    span,
                    parts.describe(),
                ));
                Vec::new()
            }
        }
    }

    /// The value with the declared parameters; NaN if it depends on anything else.
    pub fn numeric(&self, id: ExprId) -> f64 {
        if let Some(value) = self.graph.as_number(id) {
            return value;
        }
        let value = |input: u32| match self.symbols[input as usize] {
            Symbol::Param(index) => self.param_values[index],
            _ => f64::NAN,
        };
        evaluate_with(&self.graph, &[id], value, &[])[0]
    }

    /// Whether a value is a constant of the problem.
    pub fn is_constant(value: &Value) -> bool {
        value.traits.reads.beyond(Reads::PARAM).is_empty()
    }
}
