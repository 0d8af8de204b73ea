//! One walk over the whole text: what it demands of units, and what follows.

use super::Inference;
use super::requirement::Requirement;
use super::solve::{Rank, Solution};
use crate::units::dimension::Dimension;
use fdcc_grammar::{Span, ast};
use std::collections::HashSet;

/// What earlier walks found out.
#[derive(Clone, Default)]
pub(crate) struct Known {
    /// The texts that count as unknown from now on.
    pub wrong: HashSet<Span>,
    /// The names whose unit is that of their uses.
    pub suspects: HashSet<Span>,
}

/// One walk over the whole text: what it demands, and what follows.
pub(crate) struct Walk<'a> {
    pub inference: Inference<'a>,
    pub solution: Solution,
    /// The demands that cannot be met.
    pub contradictions: Vec<usize>,
    /// The one to be told.
    pub first: Option<usize>,
}

impl<'a> Walk<'a> {
    pub fn new(tree: &'a ast::Model, known: Known, listening: bool) -> Self {
        let mut inference = Inference::new(known.wrong, known.suspects, listening);
        inference.model(tree);
        let places = inference.numbers.iter().map(|it| it.place.clone()).collect();
        let mut solution = Solution::new(inference.unknowns, places);
        let differences: Vec<(Rank, Dimension)> =
            inference.requirements.iter().map(Requirement::equation).collect();
        let contradictions = solution.contradictions(&differences);
        let first = innermost(&inference.requirements, &contradictions);
        Walk { inference, solution, contradictions, first }
    }
}

/// The first contradiction, or one inside it, or in a function that is called inside it, from which
/// it may follow.
fn innermost(requirements: &[Requirement<'_>], contradictions: &[usize]) -> Option<usize> {
    let mut first = *contradictions.first()?;
    for _ in contradictions {
        let outer = requirements[first].site;
        let is_inside =
            |place: Span| outer.start <= place.start && place.end <= outer.end && place != outer;
        let is_inner = |&&at: &&usize| {
            let it = &requirements[at];
            is_inside(it.site) || it.calls.iter().any(|call| is_inside(call.span))
        };
        match contradictions.iter().find(is_inner) {
            Some(&inner) => first = inner,
            None => break,
        }
    }
    Some(first)
}
