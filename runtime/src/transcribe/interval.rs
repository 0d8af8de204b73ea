//! What a scheme makes of one interval: its variables, where the functions of the problem are
//! evaluated, and which rows they enter.
//!
//! ```text
//! variables   x_k [w_k]   u_k   y_k | x_{k+1} [w_{k+1}]
//! rows        links - factor h F(node), one block for each node; then links alone
//! ```
//!
//! `y_k` holds the states inside the interval: at the ends of steps, where there are several, and
//! at the inner nodes of a collocation scheme. The controls `u_k` are one value, the values at the
//! nodes, or, where controls are linear, the values at the end of the interval, which `w_{k+1}`
//! hands on to the next.

mod between;

use super::mesh::Mesh;
use super::{collocation, tableau};
use crate::lagrange;
use crate::linalg::Stages;
use crate::problem::{Columns, ControlShape, Layout, Method};

/// A sum of variables of an interval: places from `x_k` on, with factors.
pub(crate) type Combination = Vec<(usize, f64)>;

/// A point of each interval, as the functions of the problem see it.
#[derive(Clone, Debug)]
pub(crate) struct Point {
    /// Which part of the interval has passed.
    pub(crate) time: f64,
    pub(crate) states: Vec<Combination>,
    pub(crate) controls: Vec<Combination>,
}

/// A point at which the right side is evaluated.
#[derive(Clone, Debug)]
pub(crate) struct Node {
    pub(crate) point: Point,
    /// Its weight in integrals.
    pub(crate) weight: f64,
    /// Its rows of the interval, from this on, get `-factor h F`.
    pub(crate) row: usize,
    pub(crate) factor: f64,
}

/// A constant entry of the defects.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Link {
    pub(crate) row: usize,
    pub(crate) place: usize,
    pub(crate) value: f64,
}

/// What a variable of an interval is the value of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Signal {
    State(usize),
    Control(usize),
}

/// A variable of an interval: the value of a signal at a time of it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Slot {
    pub(crate) signal: Signal,
    pub(crate) time: f64,
}

/// One interval of a method.
#[derive(Clone, Debug)]
pub(crate) struct Interval {
    /// States, and controls that go on from interval to interval.
    pub(crate) carried: usize,
    /// Variables that the optimiser chooses in the interval.
    pub(crate) chosen: usize,
    /// All variables before `x_{k+1}`.
    pub(crate) slots: Vec<Slot>,
    pub(crate) nodes: Vec<Node>,
    pub(crate) links: Vec<Link>,
    pub(crate) start: Point,
    pub(crate) end: Point,
    /// Where path constraints hold.
    pub(crate) path: Vec<Point>,
    /// The mean of each control.
    pub(crate) means: Vec<Combination>,
    places: Places,
}

impl Interval {
    pub(crate) fn new(method: &Method, layout: &Layout) -> Self {
        let places = Places::new(method, layout);
        let (nodes, mut links) = match places.nodes {
            None => places.one_step(method),
            Some(nodes) => places.collocated(nodes),
        };
        let row = places.row(places.steps);
        for control in 0..places.carried - places.states {
            let (handed_on, next) =
                (places.carried + control, places.step() + places.states + control);
            links.push(Link { row: row + control, place: next, value: 1.0 });
            links.push(Link { row: row + control, place: handed_on, value: -1.0 });
        }
        let end = places.point(1.0, |state| vec![(places.step() + state, 1.0)]);
        Interval {
            carried: places.carried,
            chosen: places.chosen,
            slots: places.slots(),
            start: places.point(0.0, |state| vec![(state, 1.0)]),
            path: places.path_points(method, &end),
            means: (0..places.controls).map(|control| places.mean(control)).collect(),
            end,
            nodes,
            links,
            places,
        }
    }

    /// The controls at a time of the interval.
    pub(crate) fn controls_at(&self, time: f64) -> Vec<Combination> {
        (0..self.places.controls).map(|control| self.places.control(control, time)).collect()
    }

    /// A signal at a time of the interval.
    pub(crate) fn signal_at(&self, signal: Signal, time: f64) -> Combination {
        match signal {
            Signal::State(state) => self.places.state(state, time),
            Signal::Control(control) => self.places.control(control, time),
        }
    }

    /// Controls that go on from interval to interval.
    pub(crate) fn carried_controls(&self) -> usize {
        self.carried - self.start.states.len()
    }

    /// Inner variables.
    pub(crate) fn inner(&self) -> usize {
        self.slots.len() - self.carried - self.chosen
    }
}

impl Point {
    /// Writes the times of this point in all intervals.
    pub(crate) fn set_times(&self, mesh: &Mesh, points: &mut Columns) {
        for (k, tau) in points.column_mut(0).iter_mut().enumerate() {
            *tau = mesh.at(k, self.time);
        }
    }

    /// Takes the states and controls of all intervals from the variables of the NLP.
    pub(crate) fn load(&self, stages: Stages, layout: &Layout, v: &[f64], points: &mut Columns) {
        let signals = self.states.iter().chain(&self.controls).enumerate();
        signals.for_each(|(i, combination)| {
            add_up(combination, stages, v, points.column_mut(layout.t + i))
        });
    }
}

/// The value of a combination in each interval. A variable without a factor is not touched: it
/// might not be finite.
pub(crate) fn add_up(combination: &Combination, stages: Stages, v: &[f64], target: &mut [f64]) {
    let column = |place: usize| v[place..].iter().step_by(stages.variable_step());
    let Some(((place, factor), others)) = combination.split_first() else {
        return target.fill(0.0);
    };
    target.iter_mut().zip(column(*place)).for_each(|(value, x)| *value = factor * x);
    for (place, factor) in others {
        target.iter_mut().zip(column(*place)).for_each(|(value, x)| *value += factor * x);
    }
}

/// Where the variables of an interval are.
#[derive(Clone, Debug)]
struct Places {
    nodes: Option<&'static [f64]>,
    shape: ControlShape,
    /// Integration steps.
    steps: usize,
    states: usize,
    controls: usize,
    carried: usize,
    chosen: usize,
}

impl Places {
    fn new(method: &Method, layout: &Layout) -> Self {
        let nodes = Some(method.scheme.nodes()).filter(|nodes| !nodes.is_empty());
        let is_allowed = method.scheme.allows(method.controls) && layout.u > 0;
        let shape = if is_allowed { method.controls } else { ControlShape::Constant };
        let controls = layout.u;
        let chosen = match (shape, nodes) {
            (ControlShape::Polynomial, Some(nodes)) => nodes.len() * controls,
            _ => controls,
        };
        let carried = layout.x + if shape == ControlShape::Linear { controls } else { 0 };
        Places { nodes, shape, steps: method.steps, states: layout.x, controls, carried, chosen }
    }

    /// Nodes before the end of the interval, which have variables of their own.
    fn inner_nodes(&self) -> &'static [f64] {
        let nodes = self.nodes.unwrap_or_default();
        if nodes.last() == Some(&1.0) { &nodes[..nodes.len() - 1] } else { nodes }
    }

    /// The first row of a step; behind the last, that of what is handed on.
    fn row(&self, step: usize) -> usize {
        step * (self.inner_nodes().len() + 1) * self.states
    }

    /// All variables before `x_{k+1}`: each step but the last ends inside.
    fn step(&self) -> usize {
        self.carried + self.chosen + self.row(self.steps) - self.states
    }

    /// The place of the states at the beginning of a step, which is the end of the one before.
    fn joint(&self, step: usize) -> usize {
        match step {
            0 => 0,
            step if step == self.steps => self.step(),
            step => self.carried + self.chosen + self.row(step) - self.states,
        }
    }

    /// The place of the states at an inner node of a step.
    fn node(&self, step: usize, node: usize) -> usize {
        self.carried + self.chosen + self.row(step) + node * self.states
    }

    /// The time of the interval at which this part of a step has passed.
    fn time(&self, step: usize, part: f64) -> f64 {
        (step as f64 + part) / self.steps as f64
    }

    /// Times and places inside the interval at which there are states.
    fn inner(&self) -> Vec<(f64, usize)> {
        let mut inner = Vec::new();
        for step in 0..self.steps {
            let nodes = self.inner_nodes().iter().enumerate();
            inner.extend(nodes.map(|(node, part)| (self.time(step, *part), self.node(step, node))));
            if step + 1 < self.steps {
                inner.push((self.time(step, 1.0), self.joint(step + 1)));
            }
        }
        inner
    }

    fn inner_points(&self) -> Vec<Point> {
        let inner = self.inner().into_iter();
        inner.map(|(time, place)| self.point(time, |state| vec![(place + state, 1.0)])).collect()
    }

    /// Where path constraints hold.
    fn path_points(&self, method: &Method, end: &Point) -> Vec<Point> {
        let is_left_out = method.path_at_nodes
            && self.nodes.is_some_and(|nodes| nodes.last().is_some_and(|last| *last < 1.0));
        let end = (!is_left_out).then(|| end.clone());
        self.inner_points().into_iter().chain(end).collect()
    }

    fn slots(&self) -> Vec<Slot> {
        let states =
            |time: f64| (0..self.states).map(move |i| Slot { signal: Signal::State(i), time });
        let controls =
            |time: f64| (0..self.controls).map(move |i| Slot { signal: Signal::Control(i), time });
        let mut slots: Vec<Slot> = states(0.0).collect();
        match (self.shape, self.nodes) {
            (ControlShape::Linear, _) => slots.extend(controls(0.0).chain(controls(1.0))),
            (ControlShape::Polynomial, Some(nodes)) => {
                slots.extend(nodes.iter().flat_map(|c| controls(*c)))
            }
            _ => slots.extend(controls(0.0)),
        }
        slots.extend(self.inner().into_iter().flat_map(|(time, _)| states(time)));
        slots
    }

    fn point(&self, time: f64, state: impl Fn(usize) -> Combination) -> Point {
        let states = (0..self.states).map(state).collect();
        Point {
            time,
            states,
            controls: (0..self.controls).map(|i| self.control(i, time)).collect(),
        }
    }

    /// Times and places of the states through which the solution of a step is a polynomial; of a
    /// step without nodes, its ends.
    fn support(&self, step: usize) -> (Vec<f64>, Vec<usize>) {
        let inner = self.inner_nodes().iter().enumerate();
        let inner = inner.map(|(node, time)| (*time, self.node(step, node)));
        // The end is no node of Gauss: there the polynomial is what it is.
        let ends_in_node = self.nodes.is_none_or(|nodes| nodes.len() > self.inner_nodes().len());
        let end = ends_in_node.then_some((1.0, self.joint(step + 1)));
        [(0.0, self.joint(step))].into_iter().chain(inner).chain(end).unzip()
    }

    fn mean(&self, control: usize) -> Combination {
        let nodes = self.nodes.filter(|_| self.shape == ControlShape::Polynomial).unwrap_or(&[0.5]);
        let parts = nodes.iter().zip(collocation::weights(nodes));
        let terms = parts.flat_map(|(time, weight)| {
            self.control(control, *time)
                .into_iter()
                .map(move |(place, factor)| (place, weight * factor))
        });
        terms.collect()
    }

    /// `x+ - x - h sum_j b_j F(...)` for each step.
    fn one_step(&self, method: &Method) -> (Vec<Node>, Vec<Link>) {
        let (mut nodes, mut links) = (Vec::new(), Vec::new());
        for step in 0..self.steps {
            let (row, now, next) = (self.row(step), self.joint(step), self.joint(step + 1));
            nodes.extend(tableau::nodes(method, self.states).into_iter().map(|node| {
                let ends = |i: usize| {
                    let ends = [(now + i, 1.0 - node.blend[i]), (next + i, node.blend[i])];
                    ends.into_iter().filter(|(_, factor)| *factor != 0.0).collect()
                };
                let weight = node.weight / self.steps as f64;
                Node {
                    point: self.point(self.time(step, node.time), ends),
                    weight,
                    row,
                    factor: weight,
                }
            }));
            self.link(row, &[(now, -1.0), (next, 1.0)], &mut links);
        }
        (nodes, links)
    }

    /// See [`collocation`].
    fn collocated(&self, times: &[f64]) -> (Vec<Node>, Vec<Link>) {
        let length = 1.0 / self.steps as f64;
        let weights = collocation::weights(times);
        let (mut nodes, mut links) = (Vec::new(), Vec::new());
        for step in 0..self.steps {
            let (points, places) = self.support(step);
            for (j, (time, weight)) in times.iter().zip(&weights).enumerate() {
                let (row, place) = (self.row(step) + j * self.states, places[j + 1]);
                let slopes = places.iter().copied().zip(lagrange::slopes(&points, *time));
                self.link(row, &slopes.collect::<Vec<_>>(), &mut links);
                let point = self.point(self.time(step, *time), |state| vec![(place + state, 1.0)]);
                nodes.push(Node { point, weight: weight * length, row, factor: length });
            }
            if self.inner_nodes().len() == times.len() {
                let values = lagrange::values(&points, 1.0).into_iter().map(|value| -value);
                let end = places.iter().copied().zip(values).chain([(self.joint(step + 1), 1.0)]);
                self.link(self.row(step + 1) - self.states, &end.collect::<Vec<_>>(), &mut links);
            }
        }
        (nodes, links)
    }

    /// The same sum for every state.
    fn link(&self, row: usize, sum: &[(usize, f64)], links: &mut Vec<Link>) {
        for state in 0..self.states {
            let entries = sum.iter().map(|(place, value)| (place + state, *value));
            links.extend(entries.map(|(place, value)| Link { row: row + state, place, value }));
        }
    }
}
