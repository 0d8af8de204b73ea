//! Claims about an expression over a part of a box, proved by dividing the box.
//!
//! The part is where some other expressions lie in given ranges (a surface: `psi` in [0, 0]). A
//! piece on which one of them is out of range is dropped, one on which the claim is seen to hold is
//! done, any other is cut in two, as long as the budget lasts. So a proof is a proof, and its
//! absence says nothing.

use super::{Interval, Tape};
use crate::expressions::graph::{ExprId, Graph};

/// What is claimed of the value of an expression.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Claim {
    /// Above 0.
    Positive,
    /// Below 0.
    Negative,
    /// At least 0.
    NotNegative,
    /// Never taken at all: the part of the box is empty.
    Nowhere,
}

impl Claim {
    /// Whether it is true of a number.
    pub fn is_true(self, value: f64) -> bool {
        match self {
            Claim::Positive => value > 0.0,
            Claim::Negative => value < 0.0,
            // Rounding may make a 0 a little less.
            Claim::NotNegative => value >= -1e-9,
            Claim::Nowhere => false,
        }
    }

    fn holds(self, value: Interval) -> bool {
        match self {
            Claim::Positive => value.is_positive(),
            Claim::Negative => value.is_negative(),
            Claim::NotNegative => value.lower >= 0.0,
            Claim::Nowhere => false,
        }
    }
}

/// Operations that all proofs about one surface may take together, and boxes that one of them may
/// look at.
const BUDGET: usize = 40_000;
const MOST_BOXES: usize = 400;

/// Proves claims over a part of a box.
pub(crate) struct Prover {
    /// One interval for each input of the graph.
    pub domain: Vec<Interval>,
    /// What lies where, in the part that is meant.
    pub constraints: Vec<(ExprId, Interval)>,
    /// Operations that may still be spent.
    budget: usize,
}

impl Prover {
    /// Over all of a box but for the constraints.
    pub fn new(domain: Vec<Interval>, constraints: Vec<(ExprId, Interval)>) -> Self {
        Prover { domain, constraints, budget: BUDGET }
    }

    /// The same over a smaller box, with what is left of the budget.
    pub fn within(
        &mut self,
        smaller: &[(u32, Interval)],
        run: impl FnOnce(&mut Prover) -> bool,
    ) -> bool {
        let domain = self.domain.clone();
        smaller.iter().for_each(|&(input, part)| self.domain[input as usize] = part);
        let result = run(self);
        self.domain = domain;
        result
    }

    /// Whether every one of the claims is proved everywhere.
    pub fn proves(&mut self, graph: &Graph, claims: &[(ExprId, Claim)]) -> bool {
        let constrained = self.constraints.iter().map(|it| it.0);
        let roots: Vec<ExprId> = constrained.chain(claims.iter().map(|it| it.0)).collect();
        let mut tape = Tape::new(graph, &roots);
        let mut inputs: Vec<u32> = tape.inputs().collect();
        inputs.sort_unstable();
        let mut pending = vec![self.domain.clone()];
        let mut boxes = 0;
        while let Some(piece) = pending.pop() {
            boxes += 1;
            if boxes > MOST_BOXES || self.budget < tape.cost() {
                return false;
            }
            self.budget -= tape.cost();
            let values = tape.evaluate(&piece);
            let (of_constraints, of_claims) = values.split_at(self.constraints.len());
            let outside =
                |(value, it): (&Interval, &(ExprId, Interval))| value.intersect(it.1).is_empty();
            let done = of_constraints.iter().zip(&self.constraints).any(outside)
                || of_claims.iter().zip(claims).all(|(value, claim)| claim.1.holds(*value));
            if !done && !divide(&piece, &inputs, &self.domain, &mut pending) {
                return false;
            }
        }
        true
    }

    /// An enclosure of the values of an expression, without division.
    pub fn range(&mut self, graph: &Graph, expr: ExprId) -> Interval {
        Tape::new(graph, &[expr]).evaluate(&self.domain)[0]
    }
}

/// Cuts the widest side, relative to the whole; says whether there is one.
fn divide(
    piece: &[Interval],
    inputs: &[u32],
    whole: &[Interval],
    pending: &mut Vec<Vec<Interval>>,
) -> bool {
    let size = |&input: &u32| {
        let (part, whole) = (piece[input as usize], whole[input as usize]);
        let size = if part.is_bounded() { part.upper - part.lower } else { f64::INFINITY };
        let scale = if whole.is_bounded() { whole.upper - whole.lower } else { 1.0 };
        if size == 0.0 { 0.0 } else { size / scale }
    };
    let widest = inputs.iter().copied().max_by(|a, b| size(a).total_cmp(&size(b)));
    let Some(input) = widest.filter(|input| size(input) > 1e-9) else { return false };
    let side = piece[input as usize];
    let middle = side.middle();
    if !(side.lower < middle && middle < side.upper) {
        return false;
    }
    for half in [Interval::new(middle, side.upper), Interval::new(side.lower, middle)] {
        let mut part = piece.to_vec();
        part[input as usize] = half;
        pending.push(part);
    }
    true
}
