//! The terms of sums over rows of measured data, as functions of what an interval has.
//!
//! A scheme makes states of every time: the polynomial of a collocation scheme, else the cubic
//! Hermite polynomial through the ends of a step with the rates there. With the normalised time
//! `tau_r(p) = (t_r - t0)/(tf - t0)` of a row, at which the parameters have it now, `tau`:
//!
//! ```text
//! polynomial   x = X + X' d + X'' d^2/2                                   d = tau_r(p) - tau
//! Hermite      x = H_0(c) x_0 + H_1(c) x_1 + h (G_0(c) F_0 + G_1(c) F_1)  c = (tau_r(p) - begin)/h
//! ```
//!
//! so that all derivatives, also those by an end of time, come from the graph. `d` itself is 0.
//! Only the values of `d` and its first two powers matter, so the first polynomial is exact for any
//! degree.

use super::function::{Order, VectorFunction};
use super::inputs::{self, Inputs, Sizes};
use super::objective::{Hidden, Objective};
use super::{origin, smoothed};
use crate::expressions::graph::{ExprId, Graph};
use crate::model::numbers::Numbers;
use crate::model::{Model, Sum, Symbol};
use fdcc_runtime::problem::{Columns, Function, Interpolant, Layout, Measurements};
use std::sync::Arc;

/// The term of a sum.
pub struct Measured {
    /// Inputs as [`Measurements`] say.
    pub term: VectorFunction,
    /// One of [`Model::sums`].
    pub sum: usize,
    /// The state that it became.
    state: Option<usize>,
    interpolant: Interpolant,
}

/// Lowers the sums that the objective and the conditions need. `dynamics` are the rates over
/// normalised time.
pub(crate) fn lower(
    model: &Model,
    graph: &mut Graph,
    sizes: &Sizes,
    objective: &Objective,
    dynamics: &VectorFunction,
) -> Vec<Measured> {
    let one = graph.number(1.0);
    let in_states = objective.hidden.iter().enumerate().filter_map(|(at, it)| match it {
        Hidden::Sum(sum) => Some((*sum, one, Some(model.states.len() + at))),
        Hidden::Integral(_) => None,
    });
    let all: Vec<_> = (objective.measured.iter().map(|(sum, factor)| (*sum, *factor, None)))
        .chain(in_states)
        .collect();
    let interpolant = interpolant(model);
    let term = |(sum, factor, state): (usize, ExprId, Option<usize>)| {
        let mut row = Row::new(model, graph, sizes, &model.sums[sum], interpolant);
        let value = row.graph.mul(factor, model.sums[sum].term);
        Measured { term: row.function(value, dynamics), sum, state, interpolant }
    };
    all.into_iter().map(term).collect()
}

/// A value in each row of a sum, for whoever asks for it alone: values only.
pub(crate) fn alone(
    model: &Model,
    graph: &mut Graph,
    sizes: &Sizes,
    (sum, value): (usize, ExprId),
    dynamics: &VectorFunction,
) -> Measured {
    let interpolant = interpolant(model);
    let mut row = Row::new(model, graph, sizes, &model.sums[sum], interpolant);
    let mut term = row.function(value, dynamics);
    term.by.clear();
    Measured { term, sum, state: None, interpolant }
}

fn interpolant(model: &Model) -> Interpolant {
    match model.method.scheme.is_collocation() {
        true => Interpolant::Polynomial,
        false => Interpolant::Hermite,
    }
}

impl Measured {
    /// With the rows of the model, and the function compiled.
    pub(crate) fn with_rows(
        &self,
        model: &Model,
        numbers: &Numbers,
        function: &Arc<dyn Function>,
    ) -> Measurements {
        let sum = &model.sums[self.sum];
        let table = &model.tables[sum.table];
        let mut columns = Columns::new(table.columns.len(), table.rows());
        for (at, column) in table.columns.iter().enumerate() {
            columns.column_mut(at).copy_from_slice(column);
        }
        Measurements {
            origin: origin(&sum.place),
            times: model.row_times(numbers, sum),
            columns,
            function: Arc::clone(function),
            interpolant: self.interpolant,
            state: self.state,
            is_shared: sum.is_shared,
        }
    }
}

/// A row in the making.
struct Row<'m> {
    model: &'m Model,
    graph: &'m mut Graph,
    sizes: &'m Sizes,
    sum: &'m Sum,
    interpolant: Interpolant,
    layout: Layout,
}

impl<'m> Row<'m> {
    fn new(
        model: &'m Model,
        graph: &'m mut Graph,
        sizes: &'m Sizes,
        sum: &'m Sum,
        interpolant: Interpolant,
    ) -> Self {
        let columns = model.tables[sum.table].columns.len();
        let (signals, more) = match interpolant {
            Interpolant::Polynomial if is_at_fixed_times(model, sum) => (1, 0),
            Interpolant::Polynomial => (3, 0),
            Interpolant::Hermite => (2, 2),
        };
        let grid = sizes.grid();
        let layout = Layout { x: signals * grid.x, u: signals * grid.u, s: columns + more, ..grid };
        Row { model, graph, sizes, sum, interpolant, layout }
    }

    /// A value over the symbols of the model, as a function of the interval.
    fn function(&mut self, value: ExprId, dynamics: &VectorFunction) -> VectorFunction {
        let mut inputs = inputs::of_parameters(self.model, self.graph, &self.layout);
        self.place_columns(&mut inputs);
        let time = inputs.apply(self.graph, &[self.sum.time])[0];
        let [states, controls] = match self.interpolant {
            Interpolant::Polynomial => self.expanded(&inputs, time),
            Interpolant::Hermite => self.between_ends(&inputs, time, dynamics),
        };
        inputs.set(self.model, |symbol| match symbol {
            Symbol::Time => Some(time),
            Symbol::State(at) => states.get(at).copied(),
            Symbol::Control(at) => controls.get(at).copied(),
            _ => None,
        });
        let outputs = inputs.apply(self.graph, &[value]);
        VectorFunction {
            name: self.sum.place.name.clone(),
            layout: self.layout,
            outputs: smoothed(self.model, self.graph, &outputs, self.sizes, &self.layout),
            origins: vec![origin(&self.sum.place)],
            by: inputs::solved_for(self.model, &self.layout),
            order: Order::Second,
        }
    }

    fn place_columns(&mut self, inputs: &mut Inputs) {
        let first = self.layout.selectors().start;
        let places: Vec<ExprId> =
            self.layout.selectors().map(|at| self.graph.input(at as u32)).collect();
        debug_assert_eq!(first + places.len(), self.layout.inputs());
        inputs.set(self.model, |symbol| match symbol {
            Symbol::Column(table, column) if table == self.sum.table => Some(places[column]),
            _ => None,
        });
    }

    /// The normalised time of the row; one outside, as it may be on the way to a solution, is at
    /// the end of time, since a polynomial is nothing to go by where it does not belong.
    fn normalised(&mut self, inputs: &Inputs, time: ExprId) -> ExprId {
        let first = inputs.apply(self.graph, &self.model.interval[..1])[0];
        let passed = self.graph.sub(time, first);
        let tau = self.graph.div(passed, inputs.duration);
        let [zero, one] = [0.0, 1.0].map(|it| self.graph.number(it));
        let not_before = self.graph.select_le(tau, zero, zero, tau);
        self.graph.select_le(tau, one, not_before, one)
    }

    /// States and controls from their values and two derivatives at the time where the row is.
    fn expanded(&mut self, inputs: &Inputs, time: ExprId) -> [Vec<ExprId>; 2] {
        let own = self.normalised(inputs, time);
        let here = self.graph.input(0);
        let way = self.graph.sub(own, here);
        let [states, controls] = [self.layout.states(), self.layout.controls()];
        let grid = self.sizes.grid();
        [(states, grid.x), (controls, grid.u)].map(|(places, count)| {
            let is_expanded = places.len() > count;
            let signal = |at: usize| {
                let value = self.graph.input((places.start + at) as u32);
                if !is_expanded {
                    return value;
                }
                let [slope, bend] = [1, 2]
                    .map(|order| self.graph.input((places.start + at + order * count) as u32));
                let square = self.graph.square(way);
                let half = self.graph.scale(0.5, square);
                let terms = [value, self.graph.mul(slope, way), self.graph.mul(bend, half)];
                self.graph.sum(&terms)
            };
            (0..count).map(signal).collect()
        })
    }

    /// States on the cubic through both ends of a step; controls on the line between them.
    fn between_ends(
        &mut self,
        inputs: &Inputs,
        time: ExprId,
        dynamics: &VectorFunction,
    ) -> [Vec<ExprId>; 2] {
        let own = self.normalised(inputs, time);
        let end = self.layout.selectors().end;
        let [begin, h] = [end - 2, end - 1].map(|at| self.graph.input(at as u32));
        let way = self.graph.sub(own, begin);
        let c = self.graph.div(way, h);
        let rates = self.rates_at_ends(dynamics, [begin, h]);
        let weights = hermite(self.graph, c, h);
        let grid = self.sizes.grid();
        let (x, u) = (self.layout.states().start, self.layout.controls().start);
        let states = (0..grid.x).map(|at| {
            let ends = [x + at, x + grid.x + at].map(|place| self.graph.input(place as u32));
            let terms = [ends[0], ends[1], rates[0][at], rates[1][at]];
            let products: Vec<ExprId> =
                weights.iter().zip(terms).map(|(w, term)| self.graph.mul(*w, term)).collect();
            self.graph.sum(&products)
        });
        let states = states.collect();
        let controls = (0..grid.u).map(|at| {
            let ends = [u + at, u + grid.u + at].map(|place| self.graph.input(place as u32));
            let change = self.graph.sub(ends[1], ends[0]);
            let part = self.graph.mul(c, change);
            self.graph.add(ends[0], part)
        });
        [states, controls.collect()]
    }

    /// The rates by normalised time, at the begin and at the end of the step.
    fn rates_at_ends(
        &mut self,
        dynamics: &VectorFunction,
        [begin, h]: [ExprId; 2],
    ) -> [Vec<ExprId>; 2] {
        let (grid, layout) = (dynamics.layout, self.layout);
        let later = self.graph.add(begin, h);
        [begin, later].map(|time| {
            let is_end = usize::from(time == later);
            let place = |input: usize| {
                if grid.states().contains(&input) {
                    input + is_end * grid.x
                } else if grid.controls().contains(&input) {
                    input - grid.controls().start + layout.controls().start + is_end * grid.u
                } else {
                    input - grid.parameters().start + layout.parameters().start
                }
            };
            let places: Vec<ExprId> =
                (1..grid.inputs()).map(|input| self.graph.input(place(input) as u32)).collect();
            let at = |input: u32| Some(if input == 0 { time } else { places[input as usize - 1] });
            self.graph.substitute(&dynamics.outputs[..grid.x], &at)
        })
    }
}

/// Whether nothing that may change moves rows or an end of time.
fn is_at_fixed_times(model: &Model, sum: &Sum) -> bool {
    let [first, last] = model.interval;
    let inputs = model.graph.inputs_of(&[first, last, sum.time]);
    inputs.iter().all(|input| matches!(model.symbols[*input as usize], Symbol::Column(..)))
}

/// The weights of both ends, then of the rates there, at the part `c` of a step of length `h`.
fn hermite(graph: &mut Graph, c: ExprId, h: ExprId) -> [ExprId; 4] {
    let [one, two, three] = [1.0, 2.0, 3.0].map(|it| graph.number(it));
    let square = graph.square(c);
    let doubled = graph.mul(two, c);
    let rest = graph.sub(three, doubled);
    let last = graph.mul(square, rest);
    let first = graph.sub(one, last);
    let left = graph.sub(one, c);
    let left_square = graph.square(left);
    let rise = graph.mul(c, left_square);
    let fall = graph.mul(square, left);
    let fall = graph.neg(fall);
    [first, last, graph.mul(h, rise), graph.mul(h, fall)]
}
