//! Links between phases: their conditions and what they add to the objective.

use super::part::Part;
use crate::linalg::{Family, Triplets};
use crate::nlp::Place;
use crate::problem::{Chain, Columns, Degree, End, Link};
use crate::transcribe::interval::Combination;
use crate::transcribe::tables::Tables;
use std::ops::Range;

/// `values[target] += coefficient * column of the function`
#[derive(Clone, Copy)]
struct Move {
    column: usize,
    coefficient: f64,
    target: usize,
}

/// A link on the grids of its phases.
pub(super) struct TranscribedLink<'c> {
    pub link: &'c Link,
    pub rows: Range<usize>,
    pub jacobian: Triplets,
    pub hessian: Triplets,
    /// How many inputs `x` each of its ends has.
    sizes: Vec<usize>,
    /// For each input `x` the sum of variables that it is.
    inputs: Vec<Combination>,
    /// The variable of each entry of `p`; `None` of what is given.
    unknowns: Vec<Option<usize>>,
    tables: Tables,
    gradient_moves: Vec<Move>,
    jacobian_moves: Vec<Move>,
    hessian_moves: Vec<Move>,
}

impl<'c> TranscribedLink<'c> {
    /// All links, their rows behind those of the phases.
    pub fn all(chain: &'c Chain, parts: &[Part], first_unknown: usize) -> Vec<Self> {
        let mut row = parts.last().map_or(0, |part| part.shape.rows.end);
        let of = |link: &'c Link| {
            let rows = row..row + link.bounds.len();
            row = rows.end;
            let mut transcribed = TranscribedLink {
                sizes: link.ends.iter().map(|end| signals(parts, *end).len()).collect(),
                inputs: link.ends.iter().flat_map(|end| signals(parts, *end)).collect(),
                unknowns: unknowns(chain, link, first_unknown),
                tables: Tables::new(&link.function, 1),
                link,
                rows,
                jacobian: Triplets::default(),
                hessian: Triplets::default(),
                gradient_moves: Vec::new(),
                jacobian_moves: Vec::new(),
                hessian_moves: Vec::new(),
            };
            transcribed.map_jacobian();
            transcribed.map_hessian();
            transcribed
        };
        chain.links.iter().map(of).collect()
    }

    /// The variables behind an input, with their factors.
    fn places(&self, input: u32) -> Combination {
        let layout = self.link.function.layout();
        match (input as usize).checked_sub(layout.parameters().start) {
            Some(at) => self.unknowns[at].into_iter().map(|place| (place, 1.0)).collect(),
            None => self.inputs[input as usize - layout.states().start].clone(),
        }
    }

    fn map_jacobian(&mut self) {
        let pattern = &self.link.function.jacobian_pattern().entries;
        for (column, &(output, input)) in pattern.iter().enumerate() {
            for (variable, coefficient) in self.places(input) {
                match (output as usize).checked_sub(1) {
                    None => {
                        self.gradient_moves.push(Move { column, coefficient, target: variable });
                    }
                    Some(row) => {
                        let family = Family::single(self.rows.start + row, variable);
                        let target = place(&mut self.jacobian, family);
                        self.jacobian_moves.push(Move { column, coefficient, target });
                    }
                }
            }
        }
    }

    fn map_hessian(&mut self) {
        let pattern = &self.link.function.hessian_pattern().entries;
        for (column, &(a, b)) in pattern.iter().enumerate() {
            let (first, second) = (self.places(a), self.places(b));
            for (i, &(row, factor)) in first.iter().enumerate() {
                for (j, &(other, other_factor)) in second.iter().enumerate() {
                    // A square gives its mixed term once to the lower triangle.
                    if a == b && j > i {
                        continue;
                    }
                    let family = Family::single(row.max(other), row.min(other));
                    let target = place(&mut self.hessian, family);
                    let coefficient = factor * other_factor;
                    self.hessian_moves.push(Move { column, coefficient, target });
                }
            }
        }
    }

    /// Takes its inputs from all variables.
    pub fn load(&mut self, v: &[f64]) {
        let first = self.link.function.layout().states().start;
        for (input, combination) in self.inputs.iter().enumerate() {
            let value = combination.iter().map(|(place, factor)| factor * v[*place]).sum();
            self.tables.points.column_mut(first + input)[0] = value;
        }
    }

    /// Its inputs `x`.
    pub fn points(&self) -> &Columns {
        &self.tables.points
    }

    /// Writes its rows; returns its part of the objective.
    pub fn values(&mut self, parameters: &[f64], rows: &mut [f64]) -> f64 {
        self.tables.evaluate(self.link.own(parameters));
        for (output, row) in self.rows.clone().enumerate() {
            rows[row] = self.tables.values.column(output + 1)[0];
        }
        self.tables.values.column(0)[0]
    }

    pub fn differentiate(&mut self, parameters: &[f64], weight: f64, multipliers: &[f64]) {
        self.tables.multipliers.column_mut(0)[0] = weight;
        for (output, row) in self.rows.clone().enumerate() {
            self.tables.multipliers.column_mut(output + 1)[0] = multipliers[row];
        }
        self.tables.differentiate(self.link.own(parameters));
    }

    /// Adds to the gradient, and puts its values in front of those of the links behind it, which
    /// are returned.
    pub fn scatter<'a>(
        &self,
        gradient: &mut [f64],
        jacobian: &'a mut [f64],
        hessian: &'a mut [f64],
    ) -> (&'a mut [f64], &'a mut [f64]) {
        let (own, other_rows) = jacobian.split_at_mut(self.jacobian.len());
        let (curvature, other_curvature) = hessian.split_at_mut(self.hessian.len());
        own.fill(0.0);
        curvature.fill(0.0);
        add(&self.gradient_moves, &self.tables.jacobian, gradient);
        add(&self.jacobian_moves, &self.tables.jacobian, own);
        add(&self.hessian_moves, &self.tables.hessian, curvature);
        (other_rows, other_curvature)
    }

    /// What it adds to the gradient of the Lagrangian, at the point and with the multipliers of the
    /// last call of `differentiate`.
    pub fn add_slopes(&self, weight: f64, multipliers: &[f64], gradient: &mut [f64]) {
        let weighted = |entry: &Move| {
            let (output, _) = self.link.function.jacobian_pattern().entries[entry.column];
            let row = (output as usize).checked_sub(1);
            row.map_or(weight, |row| multipliers[self.rows.start + row])
        };
        let rows = self.jacobian_moves.iter().zip(self.jacobian_columns());
        let objective = self.gradient_moves.iter().map(|entry| (entry, entry.target));
        for (entry, target) in objective.chain(rows) {
            let slope = self.tables.jacobian.column(entry.column)[0];
            gradient[target] += weighted(entry) * entry.coefficient * slope;
        }
    }

    /// The variable of each entry of the Jacobian.
    fn jacobian_columns(&self) -> impl Iterator<Item = usize> {
        self.jacobian_moves.iter().map(|entry| self.jacobian.families[entry.target].column)
    }

    pub fn is_linear(&self, row: usize) -> bool {
        self.link.function.degree(row - self.rows.start + 1) == Degree::Affine
    }

    pub fn place(&self, row: usize) -> Place {
        let origin = self.link.function.origin(row - self.rows.start + 1);
        Place { origin, ..Place::default() }
    }

    /// The first output with a value or derivative that is not finite.
    pub fn not_finite(&mut self, parameters: &[f64], rows: usize) -> Option<Place> {
        self.differentiate(parameters, 1.0, &vec![1.0; rows]);
        let is_bad = |table: &Columns, column: usize| !table.column(column)[0].is_finite();
        let tables = &self.tables;
        let pattern = &self.link.function.jacobian_pattern().entries;
        let value = (0..tables.values.columns()).find(|it| is_bad(&tables.values, *it));
        let slope = || pattern.iter().enumerate().find(|(it, _)| is_bad(&tables.jacobian, *it));
        let curvature = || (0..tables.hessian.columns()).any(|it| is_bad(&tables.hessian, it));
        let output = value
            .or_else(|| slope().map(|(_, (output, _))| *output as usize))
            .or_else(|| curvature().then_some(0))?;
        let origin = self.link.function.origin(output);
        Some(Place { origin, ..Place::default() })
    }

    /// By how much each variable of one of its ends has to move for the equation in which it is the
    /// only one of that end to hold.
    pub fn newton_moves(&mut self, end: usize, parameters: &[f64]) -> Vec<(usize, f64)> {
        self.tables.differentiate(self.link.own(parameters));
        let pattern = &self.link.function.jacobian_pattern().entries;
        let own: Vec<usize> = {
            let sizes = self.sizes.iter().take(end).sum::<usize>();
            let inputs = &self.inputs[sizes..sizes + self.sizes[end]];
            inputs.iter().flatten().map(|(variable, _)| *variable).collect()
        };
        let given = |row: usize| {
            let bounds = self.link.bounds[row];
            let entries = self.jacobian_moves.iter().zip(self.jacobian_columns());
            let mut entries = entries.filter(|(it, variable)| {
                pattern[it.column].0 as usize == row + 1 && own.contains(variable)
            });
            let ((entry, variable), None) = (entries.next()?, entries.next()) else { return None };
            let slope = entry.coefficient * self.tables.jacobian.column(entry.column)[0];
            let misses = bounds.lower - self.tables.values.column(row + 1)[0];
            bounds.is_equality().then_some((variable, misses / slope))
        };
        (0..self.link.bounds.len()).filter_map(given).collect()
    }

    /// Variables that a condition by itself gives a value, such as `psi(x) = x - 1 = 0`, with that
    /// value.
    pub fn given(&mut self, parameters: &[f64]) -> Vec<(usize, f64)> {
        self.tables.points.as_mut_slice().fill(0.0);
        self.tables.differentiate(self.link.own(parameters));
        let pattern = &self.link.function.jacobian_pattern().entries;
        let given = |row: usize| {
            let (bounds, output) = (self.link.bounds[row], row + 1);
            let mut own = self.jacobian_moves.iter().zip(self.jacobian_columns());
            let mut own = own.by_ref().filter(|(it, _)| pattern[it.column].0 as usize == output);
            let ((entry, variable), None) = (own.next()?, own.next()) else { return None };
            let slope = entry.coefficient * self.tables.jacobian.column(entry.column)[0];
            let value = (bounds.lower - self.tables.values.column(output)[0]) / slope;
            let is_affine = self.link.function.degree(output) == Degree::Affine;
            let is_simple = bounds.is_equality() && is_affine && slope != 0.0;
            is_simple.then_some((variable, value))
        };
        (0..self.link.bounds.len()).filter_map(given).collect()
    }
}

impl Link {
    /// The entries of `p` that it sees.
    fn own<'p>(&self, parameters: &'p [f64]) -> &'p [f64] {
        &parameters[..self.function.layout().p]
    }
}

/// States, then controls, at an end of a phase.
fn signals(parts: &[Part], end: End) -> Vec<Combination> {
    let part = &parts[end.phase()];
    let (interval, stages) = (part.nlp.interval(), part.nlp.chain());
    let (point, k) = match end {
        End::First(_) => (&interval.start, 0),
        End::Last(_) => (&interval.end, stages.intervals - 1),
    };
    let first = part.shape.variables.start + stages.state(k).start;
    let moved = |it: &Combination| it.iter().map(|(at, factor)| (first + at, *factor)).collect();
    point.states.iter().chain(&point.controls).map(moved).collect()
}

fn unknowns(chain: &Chain, link: &Link, first_unknown: usize) -> Vec<Option<usize>> {
    let mut all = vec![None; link.function.layout().p];
    for (at, unknown) in chain.unknowns.iter().enumerate() {
        if let Some(place) = all.get_mut(unknown.parameter) {
            *place = Some(first_unknown + at);
        }
    }
    all
}

/// The place of an entry, made if needed.
fn place(of: &mut Triplets, family: Family) -> usize {
    of.families.iter().position(|known| *known == family).unwrap_or_else(|| {
        of.families.push(family);
        of.families.len() - 1
    })
}

fn add(moves: &[Move], table: &Columns, values: &mut [f64]) {
    for entry in moves {
        values[entry.target] += entry.coefficient * table.column(entry.column)[0];
    }
}
