//! Both ends of the recursion: the value function of the last state, and the small system of the
//! first.
//!
//! The border is `theta = (g, nu, copy of x_0)`; every coupling row keeps its multiplier in it. The
//! copy exists only where curvature couples `x_0` with `x_N`; at the end it is identified with
//! `x_0` itself.

use super::assemble::{each_family, is_coupling};
use crate::linalg::dense::symmetric::SymmetricFactor;
use crate::linalg::structure::stages::Stages;
use crate::linalg::structure::triplets::Triplets;

/// `matrix[target] += values[source]`
#[derive(Clone, Copy)]
struct Move {
    source: usize,
    target: usize,
}

/// The variables and rows that a border sees.
#[derive(Clone, Copy, PartialEq)]
enum End {
    First(usize),
    Last(usize),
    Global(usize),
    Row(usize),
}

pub(super) struct Border {
    stages: Stages,
    copy: bool,
    /// Fixed variables among `(x_0, g)`.
    fixed: Vec<usize>,
    terminal_hessian: Vec<Move>,
    terminal_jacobian: Vec<Move>,
    initial_hessian: Vec<Move>,
    initial_jacobian: Vec<Move>,
    /// What the initial state adds to the last system.
    initial: Vec<f64>,
    factor: SymmetricFactor,
}

impl Border {
    pub(super) fn new(
        stages: Stages,
        hessian: &Triplets,
        jacobian: &Triplets,
        fixed: &[bool],
    ) -> Self {
        let size = stages.states + stages.globals + stages.coupling_constraints;
        let mut border = Border {
            stages,
            copy: false,
            fixed: stages
                .state(0)
                .chain(stages.globals())
                .enumerate()
                .filter(|(_, i)| fixed[*i])
                .map(|(i, _)| i)
                .collect(),
            terminal_hessian: Vec::new(),
            terminal_jacobian: Vec::new(),
            initial_hessian: Vec::new(),
            initial_jacobian: Vec::new(),
            initial: vec![0.0; size * size],
            factor: SymmetricFactor::new(size),
        };
        border.copy = border.couples_ends(hessian);
        border.map_hessian(hessian);
        border.map_jacobian(jacobian);
        border
    }

    /// Size of `theta`.
    pub(super) fn theta(&self) -> usize {
        self.stages.globals
            + self.stages.coupling_constraints
            + if self.copy { self.stages.states } else { 0 }
    }

    /// Number of rows that the border holds.
    pub(super) fn rows(&self) -> usize {
        self.stages.coupling_constraints
    }

    fn end(&self, variable: usize) -> End {
        let stages = &self.stages;
        if stages.globals().contains(&variable) {
            End::Global(variable - stages.globals().start)
        } else if stages.state(0).contains(&variable) {
            End::First(variable)
        } else {
            End::Last(variable - stages.state(stages.intervals).start)
        }
    }

    fn couples_ends(&self, hessian: &Triplets) -> bool {
        hessian.families.iter().filter(|family| is_coupling(&self.stages, family)).any(|family| {
            matches!(
                (self.end(family.row), self.end(family.column)),
                (End::First(_), End::Last(_)) | (End::Last(_), End::First(_))
            )
        })
    }

    fn map_hessian(&mut self, hessian: &Triplets) {
        let stages = self.stages;
        let (mut terminal, mut initial) = (Vec::new(), Vec::new());
        each_family(hessian, |family, source| {
            if is_coupling(&stages, family) {
                let (row, column) = (self.end(family.row), self.end(family.column));
                self.add(row, column, source as usize, &mut terminal, &mut initial);
            }
            true
        });
        (self.terminal_hessian, self.initial_hessian) = (terminal, initial);
    }

    fn map_jacobian(&mut self, jacobian: &Triplets) {
        let rows = self.stages.coupling();
        let (mut terminal, mut initial) = (Vec::new(), Vec::new());
        each_family(jacobian, |family, source| {
            if family.row >= rows.start {
                let (row, column) = (End::Row(family.row - rows.start), self.end(family.column));
                self.add(row, column, source as usize, &mut terminal, &mut initial);
            }
            true
        });
        (self.terminal_jacobian, self.initial_jacobian) = (terminal, initial);
    }

    /// Sends an entry to the terminal value function or to the initial system, on both sides of the
    /// diagonal.
    fn add(
        &self,
        row: End,
        column: End,
        source: usize,
        terminal: &mut Vec<Move>,
        initial: &mut Vec<Move>,
    ) {
        let is_first = |end| matches!(end, End::First(_));
        let is_last = |end| matches!(end, End::Last(_));
        let at_start = (is_first(row) || is_first(column)) && !is_last(row) && !is_last(column);
        let (list, size) = if at_start {
            (initial, self.size())
        } else {
            (terminal, self.stages.states + self.theta())
        };
        let position =
            |end| if at_start { self.initial_position(end) } else { self.terminal_position(end) };
        let (i, j) = (position(row), position(column));
        list.push(Move { source, target: i * size + j });
        if i != j {
            list.push(Move { source, target: j * size + i });
        }
    }

    /// Size of the last system: `(x_0, g, nu)`.
    pub(super) fn size(&self) -> usize {
        self.stages.states + self.stages.globals + self.stages.coupling_constraints
    }

    fn terminal_position(&self, end: End) -> usize {
        let Stages { states: n, globals: g, coupling_constraints: rows, .. } = self.stages;
        match end {
            End::Last(i) => i,
            End::Global(i) => n + i,
            End::Row(i) => n + g + i,
            End::First(i) => n + g + rows + i,
        }
    }

    fn initial_position(&self, end: End) -> usize {
        match end {
            End::First(i) => i,
            other => self.terminal_position(other),
        }
    }

    /// The value function of `(x_N, theta)`; remembers what belongs to the first state.
    pub(super) fn assemble(
        &mut self,
        hessian: &[f64],
        jacobian: &[f64],
        sigma: &[f64],
        d: &[f64],
        value: &mut [f64],
    ) {
        let stages = self.stages;
        let width = stages.states + self.theta();
        value.fill(0.0);
        self.initial.fill(0.0);
        add_moves(&self.terminal_hessian, hessian, value);
        add_moves(&self.terminal_jacobian, jacobian, value);
        add_moves(&self.initial_hessian, hessian, &mut self.initial);
        add_moves(&self.initial_jacobian, jacobian, &mut self.initial);
        let diagonal = stages.state(stages.intervals).chain(stages.globals()).map(|i| sigma[i]);
        let diagonal = diagonal.chain(stages.coupling().map(|row| -d[row]));
        for (i, entry) in diagonal.enumerate() {
            value[i * width + i] += entry;
        }
    }

    /// Factors the system in `(x_0, g, nu)`; returns its number of negative eigenvalues.
    pub(super) fn factor(&mut self, value: &[f64]) -> Option<usize> {
        let size = self.size();
        let width = self.stages.states + self.theta();
        for i in 0..width {
            for j in 0..width {
                let target = self.merged(i) * size + self.merged(j);
                self.initial[target] += value[i * width + j];
            }
        }
        for &i in &self.fixed {
            for j in 0..size {
                self.initial[i * size + j] = 0.0;
                self.initial[j * size + i] = 0.0;
            }
            self.initial[i * size + i] = 1.0;
        }
        self.factor.factor(&self.initial)
    }

    /// Where entry `i` of `(x, theta)` stands in the last system: the copy of `x_0` is `x_0`.
    fn merged(&self, i: usize) -> usize {
        if i < self.size() { i } else { i - self.size() }
    }

    /// Gradient of the terminal value function.
    pub(super) fn terminal_gradient(&self, a: &[f64], b: &[f64], gradient: &mut [f64]) {
        let stages = &self.stages;
        gradient.fill(0.0);
        let values = stages.state(stages.intervals).chain(stages.globals()).map(|i| -a[i]);
        let values = values.chain(stages.coupling().map(|row| -b[row]));
        gradient.iter_mut().zip(values).for_each(|(target, value)| *target = value);
    }

    /// Solves for `(x_0, theta)`, with room for the right side of the last system.
    pub(super) fn solve(&self, gradient: &[f64], right: &mut [f64], state: &mut [f64]) {
        right.fill(0.0);
        for (i, value) in gradient.iter().enumerate() {
            right[self.merged(i)] -= value;
        }
        for &i in &self.fixed {
            right[i] = 0.0;
        }
        self.factor.solve(right, 1);
        for (i, value) in state.iter_mut().enumerate() {
            *value = right[self.merged(i)];
        }
    }

    /// Writes globals and multipliers of the coupling rows.
    pub(super) fn finish(&self, theta: &[f64], a: &mut [f64], b: &mut [f64]) {
        let (globals, multipliers) = theta.split_at(self.stages.globals);
        a[self.stages.globals()].copy_from_slice(globals);
        b[self.stages.coupling()].copy_from_slice(&multipliers[..self.stages.coupling_constraints]);
    }
}

fn add_moves(moves: &[Move], values: &[f64], matrix: &mut [f64]) {
    for entry in moves {
        matrix[entry.target] += values[entry.source];
    }
}
