//! What the analysis of surfaces needs of a model, finished or still being checked.

use super::others::SumOfSelectors;
use crate::expressions::graph::{Expr, ExprId, Graph, evaluate};
use crate::expressions::interval::Interval;
use crate::model::numbers::Numbers;
use crate::model::{Ball, Constraint, Control, Free, Model, Param, Place, Range, State, Symbol};
use std::collections::HashMap;
use std::rc::Rc;

/// A surface with its function; none if that is not known.
pub(crate) type KnownSurface<'m> = (&'m Place, Option<ExprId>);

/// A model as the analysis sees it.
#[derive(Clone)]
pub(crate) struct View<'m> {
    pub graph: &'m Graph,
    pub symbols: &'m [Symbol],
    pub states: &'m [State],
    pub controls: &'m [Control],
    pub frees: &'m [Free],
    pub surfaces: Vec<KnownSurface<'m>>,
    pub balls: &'m [Ball],
    pub path: &'m [Constraint],
    pub interval: [ExprId; 2],
    pub params: &'m [Param],
    /// Values of the parameters, NaN where unknown.
    pub values: Vec<f64>,
    /// Whether the rate of each state is known.
    pub has_rate: Vec<bool>,
    /// The states whose rates the selector of each surface enters.
    pub moved: Vec<Vec<usize>>,
    /// The rates that are sums over the selectors of many surfaces, by state.
    pub sums: HashMap<usize, Rc<SumOfSelectors>>,
    /// Weights that the model declares for its states.
    pub metric: &'m [(usize, ExprId)],
    /// Texts for expressions that have a name or were written out.
    pub names: &'m [(String, ExprId)],
    /// What the arguments of a function are called, while it is looked at by itself.
    pub arguments: &'m [String],
}

impl<'m> View<'m> {
    /// Of a model that has no error, with its parameters at these values.
    pub fn of_model(model: &'m Model, numbers: &Numbers) -> Self {
        let values = (0..model.params.len()).map(|at| numbers.of(Symbol::Param(at))).collect();
        let view = View {
            graph: &model.graph,
            symbols: &model.symbols,
            states: &model.states,
            controls: &model.controls,
            frees: &model.frees,
            surfaces: model.surfaces.iter().map(|it| (&it.place, Some(it.psi))).collect(),
            balls: &model.balls,
            path: &model.path,
            interval: model.interval,
            params: &model.params,
            values,
            has_rate: vec![true; model.states.len()],
            moved: moved(&model.graph, &model.symbols, &model.states, model.surfaces.len()),
            sums: HashMap::new(),
            metric: &model.metric,
            names: &model.names,
            arguments: &[],
        };
        view.with_sums()
    }

    /// Once everything else is known.
    pub fn with_sums(mut self) -> Self {
        let known = (0..self.states.len()).filter(|&at| self.has_rate[at]);
        let sums = known.filter_map(|at| Some((at, Rc::new(SumOfSelectors::new(&self, at)?))));
        self.sums = sums.collect();
        self
    }

    /// The value over parameters; NaN if it depends on anything else.
    pub fn number(&self, id: ExprId) -> f64 {
        if let Some(value) = self.graph.as_number(id) {
            return value;
        }
        let value = |symbol: &Symbol| match symbol {
            Symbol::Param(index) => self.values[*index],
            _ => f64::NAN,
        };
        let inputs: Vec<f64> = self.symbols.iter().map(value).collect();
        evaluate(self.graph, &[id], &inputs, &[])[0]
    }

    /// Bounds as an interval.
    pub fn bounds(&self, range: Range) -> Interval {
        Interval::new(self.number(range.lower), self.number(range.upper))
    }

    /// Where a symbol may lie.
    pub fn domain(&self, symbol: Symbol) -> Interval {
        match symbol {
            Symbol::Time => Interval::new(self.number(self.interval[0]), self.end()),
            Symbol::State(at) | Symbol::AtStart(at) | Symbol::AtEnd(at) => {
                self.bounds(self.states[at].range)
            }
            Symbol::Control(at) => self.bounds(self.controls[at].range),
            Symbol::Free(at) => self.bounds(self.frees[at].range),
            Symbol::Param(at) => Interval::point(self.values[at]),
            Symbol::Selector(_) => Interval::new(-1.0, 1.0),
            _ => Interval::ALL,
        }
    }

    /// The last time, if it is a number.
    fn end(&self) -> f64 {
        let end = self.number(self.interval[1]);
        if end.is_nan() { f64::INFINITY } else { end }
    }

    /// What a symbol is called.
    pub fn name(&self, symbol: Symbol) -> String {
        match symbol {
            Symbol::Time => "t".into(),
            Symbol::State(at) => self.states[at].place.name.clone(),
            Symbol::Control(at) => self.controls[at].place.name.clone(),
            Symbol::Free(at) => self.frees[at].place.name.clone(),
            Symbol::Param(at) => self.params[at].place.name.clone(),
            Symbol::Selector(at) => format!("Sgn({})", self.surfaces[at].0.name),
            Symbol::Argument(at) => self.arguments.get(at).cloned().unwrap_or("_".into()),
            _ => "_".into(),
        }
    }
}

/// The states whose rates the selector of each surface enters, found in one pass over the graph.
pub(crate) fn moved(
    graph: &Graph,
    symbols: &[Symbol],
    states: &[State],
    surfaces: usize,
) -> Vec<Vec<usize>> {
    let rates: Vec<ExprId> = states.iter().map(|state| state.rate).collect();
    let mut selectors: HashMap<ExprId, Vec<usize>> = HashMap::new();
    for id in graph.reachable(&rates) {
        let mut own: Vec<usize> = match graph.expr(id) {
            Expr::Input(position) => match symbols[*position as usize] {
                Symbol::Selector(at) => vec![at],
                _ => continue,
            },
            _ => graph
                .operands(id)
                .iter()
                .filter_map(|it| selectors.get(it))
                .flatten()
                .copied()
                .collect(),
        };
        own.sort_unstable();
        own.dedup();
        if !own.is_empty() {
            selectors.insert(id, own);
        }
    }
    let mut found = vec![Vec::new(); surfaces];
    for (state, rate) in rates.iter().enumerate() {
        selectors.get(rate).into_iter().flatten().for_each(|&at| found[at].push(state));
    }
    found
}
