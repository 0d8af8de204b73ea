//! Motions that a jump would change: kept from its surface, or on it in the end.

use super::contacts::{Contacts, Extent, Run};
use super::path_values::{path_values, value_at_end};
use super::tuning::across_surfaces::ON_IT;
use fdcc_runtime::problem::Problem;
use std::ops::Range;

impl Contacts<'_> {
    /// Whether the motion would rather go through the surface of a jump that does not happen, or is
    /// on it in the end, so that it happens for a neighbour.
    pub fn is_at_jump(&self) -> bool {
        let last = self.located.structure.phases.len() - 1;
        let is_kept = |j: usize| self.jump_rows(j).any(|row| self.is_kept(j, row));
        (0..=last).any(is_kept) || self.jump_rows(last).any(|row| self.ends_on(last, row))
    }

    /// The path conditions of a phase that are of surfaces of jumps.
    fn jump_rows(&self, j: usize) -> Range<usize> {
        let first = self.row_of_switch(j, self.model.switches().len());
        let states = self.limits.iter().filter(|it| it.state.is_some()).count();
        first..self.located.chain.phases[j].path_bounds.len() - states
    }

    fn range_of_row(&self, j: usize, row: usize) -> f64 {
        let mut range = Extent::default();
        self.extend(&mut range, j, row);
        range.length()
    }

    fn is_kept(&self, j: usize, row: usize) -> bool {
        let range = self.range_of_row(j, row);
        self.runs(j, row, range).iter().any(|run| self.is_pressed(j, row, run, range))
    }

    /// Whether the multiplier of a bound is more of its size than the distance from the bound is of
    /// the range, somewhere on a run: else it is what the barrier has left.
    fn is_pressed(&self, j: usize, row: usize, run: &Run, range: f64) -> bool {
        let problem = &self.located.chain.phases[j];
        let values = path_values(problem, &self.located.outcome.phases[j].trajectory, row);
        let (own, bounds) = (self.multipliers_of_row(j, row), problem.path_bounds[row]);
        let gap = |value: f64| (value - bounds.lower).abs().min((value - bounds.upper).abs());
        let farther = |k: usize| values[k..].iter().take(2).map(|it| gap(*it)).fold(0.0, f64::max);
        let is_pressed = |k: usize| own[k].abs() * range / self.size(j) > farther(k) / range;
        (run.first..run.behind).any(is_pressed)
    }

    /// Whether the motion ends on the surface, and no condition on what it reads says so.
    fn ends_on(&self, j: usize, row: usize) -> bool {
        let problem = &self.located.chain.phases[j];
        let value = value_at_end(problem, &self.located.outcome.phases[j].trajectory, row);
        let bounds = problem.path_bounds[row];
        let gap = (value - bounds.lower).abs().min((value - bounds.upper).abs());
        gap <= ON_IT * self.range_of_row(j, row) && !is_told(problem, row)
    }
}

/// Whether an equation at the end reads a state that a path condition reads.
fn is_told(problem: &Problem, row: usize) -> bool {
    let (path, boundary) = (&*problem.path, &*problem.boundary);
    let (first, ends) = (path.layout().states(), boundary.layout().states());
    let behind = ends.start + first.len();
    let read = path.jacobian_pattern().entries.iter().filter(|it| it.0 as usize == row);
    let read = read.map(|it| it.1 as usize).filter(|it| first.contains(it));
    let read: Vec<usize> = read.map(|it| it - first.start + behind).collect();
    boundary.jacobian_pattern().entries.iter().any(|&(condition, input)| {
        let bounds = condition.checked_sub(1).map(|at| &problem.boundary_bounds[at as usize]);
        bounds.is_some_and(|it| it.is_equality()) && read.contains(&(input as usize))
    })
}
