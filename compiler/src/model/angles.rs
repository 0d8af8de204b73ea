//! Controls that are angles.

use super::{Model, Symbol};
use crate::expressions::graph::builtins::Builtin;
use crate::expressions::graph::{ById, Expr, ExprId, Graph};

/// How an expression depends on a control.
#[derive(Clone, Copy, PartialEq)]
enum By {
    /// Not at all, or with the period of a full turn.
    Turns,
    /// As a straight line of this slope.
    Slope(f64),
    /// In another way.
    Other,
}

impl Model {
    /// Which controls are angles: a full turn of one changes nothing, because it stands in sines
    /// and cosines of whole multiples of it alone.
    pub fn are_angles(&self) -> Vec<bool> {
        let mut roots: Vec<ExprId> = self.states.iter().map(|it| it.rate).collect();
        roots.extend(self.surfaces.iter().map(|it| it.psi));
        roots.extend(self.path.iter().map(|it| it.value));
        roots.extend(self.integrals.iter().map(|it| it.integrand));
        roots.extend(self.jumps.iter().flat_map(|it| it.resets.iter().map(|reset| reset.1)));
        let is_angle = |control: usize| {
            let input = self.input_of(Symbol::Control(control));
            let at_ends = self.conditions_read(control);
            let all = |input| dependence(&self.graph, input, &roots);
            at_ends == [false; 2]
                && input.is_some_and(|it| all(it).iter().all(|by| *by == By::Turns))
        };
        let are_told = self.sums.is_empty() && self.at_times.is_empty();
        (0..self.controls.len()).map(|it| are_told && is_angle(it)).collect()
    }
}

fn dependence(graph: &Graph, input: u32, roots: &[ExprId]) -> Vec<By> {
    let mut known: ById<By> = ById::default();
    for id in graph.reachable(roots) {
        let by = match graph.expr(id) {
            Expr::Input(position) if *position == input => By::Slope(1.0),
            Expr::Call(builtin, operands) => {
                let all: Vec<By> = operands.iter().map(|it| known[it]).collect();
                let number = |at: usize| graph.as_number(operands[at]);
                of_call(*builtin, &all, number)
            }
            _ => By::Turns,
        };
        known.insert(id, by);
    }
    roots.iter().map(|root| known[root]).collect()
}

/// `number` is the value of an operand that is a constant.
fn of_call(builtin: Builtin, all: &[By], number: impl Fn(usize) -> Option<f64>) -> By {
    if all.iter().all(|it| *it == By::Turns) {
        return By::Turns;
    }
    let scaled = |by: By, factor: Option<f64>| match (by, factor) {
        (By::Slope(slope), Some(factor)) => By::Slope(slope * factor),
        _ => By::Other,
    };
    match (builtin, all) {
        (Builtin::Neg, [a]) => scaled(*a, Some(-1.0)),
        (Builtin::Add, [By::Slope(a), By::Slope(b)]) => By::Slope(a + b),
        (Builtin::Sub, [By::Slope(a), By::Slope(b)]) => By::Slope(a - b),
        (Builtin::Add | Builtin::Sub, [By::Slope(a), By::Turns]) => By::Slope(*a),
        (Builtin::Add, [By::Turns, By::Slope(b)]) => By::Slope(*b),
        (Builtin::Sub, [By::Turns, By::Slope(b)]) => By::Slope(-b),
        (Builtin::Mul, [a, _]) if number(1).is_some() => scaled(*a, number(1)),
        (Builtin::Mul, [_, b]) => scaled(*b, number(0)),
        (Builtin::Sin | Builtin::Cos, [By::Slope(slope)]) if slope.fract() == 0.0 => By::Turns,
        _ => By::Other,
    }
}
