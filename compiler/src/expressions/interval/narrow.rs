//! What the value of an expression says about its inputs: from the root down, each operand is
//! narrowed to what can give the value (HC4: Benhamou, Goualard, Granvilliers & Puget, *Revising
//! hull and box consistency*, 1999).

use super::range::Instruction;
use super::{Interval, Tape};
use crate::expressions::graph::builtins::Builtin;

impl Tape {
    /// Where the inputs lie if they lie in a box and the first root in `wanted`; nothing if it
    /// cannot.
    pub fn narrowed(&mut self, domain: &[Interval], wanted: Interval) -> Vec<(u32, Interval)> {
        self.evaluate(domain);
        let mut known = self.values.clone();
        known[self.roots[0]] = known[self.roots[0]].intersect(wanted);
        let mut inputs = Vec::new();
        for (at, step) in self.instructions.iter().enumerate().rev() {
            let value = known[at];
            if value.is_empty() {
                return Vec::new();
            }
            match step {
                Instruction::Number(_) => {}
                Instruction::Input(position) => inputs.push((*position, value)),
                Instruction::Square(operand) => {
                    let root = either_sign(value.square_root(), known[*operand]);
                    known[*operand] = known[*operand].intersect(root);
                }
                Instruction::Call(builtin, operands) => {
                    for (which, &operand) in operands.iter().enumerate() {
                        let others: Vec<Interval> = operands.iter().map(|&it| known[it]).collect();
                        let inverse = inverse(*builtin, which, value, &others);
                        known[operand] = known[operand].intersect(inverse);
                    }
                }
            }
        }
        inputs
    }
}

/// Where one operand lies if the call has this value and the operands lie there.
fn inverse(builtin: Builtin, which: usize, value: Interval, operands: &[Interval]) -> Interval {
    let other = || operands[1 - which];
    match builtin {
        Builtin::Add => value + -other(),
        Builtin::Sub if which == 0 => value + other(),
        Builtin::Sub => other() + -value,
        Builtin::Neg => -value,
        Builtin::Mul if !other().contains(0.0) => value / other(),
        Builtin::Div if which == 0 => value * other(),
        Builtin::Div if !value.contains(0.0) => other() / value,
        Builtin::Exp => value.logarithm(),
        Builtin::Log => value.grow(f64::exp),
        Builtin::Sqrt => value.square(),
        Builtin::Abs => either_sign(value, operands[0]),
        Builtin::Min => Interval { lower: value.lower, ..Interval::ALL },
        Builtin::Max => Interval { upper: value.upper, ..Interval::ALL },
        Builtin::SelectLe if which >= 2 => selected(which, value, operands),
        _ => Interval::ALL,
    }
}

/// A branch that is known to be taken has the value.
fn selected(which: usize, value: Interval, operands: &[Interval]) -> Interval {
    let [smaller, larger] = [operands[0], operands[1]];
    let is_taken = match which {
        2 => smaller.upper <= larger.lower,
        _ => smaller.lower > larger.upper,
    };
    if is_taken { value } else { Interval::ALL }
}

/// Numbers of this magnitude, of the sign that they can have.
fn either_sign(magnitude: Interval, within: Interval) -> Interval {
    match () {
        _ if within.lower >= 0.0 => magnitude,
        _ if within.upper <= 0.0 => -magnitude,
        _ => (-magnitude).hull(magnitude),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expressions::graph::builtins::ALL;
    use crate::expressions::graph::{Graph, evaluate};

    /// A number that walks through everything between -3 and 3 without repeating itself soon.
    fn walk(state: &mut u64) -> f64 {
        *state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        ((*state >> 11) as f64 / (1u64 << 53) as f64 - 0.5) * 6.0
    }

    #[test]
    fn what_gives_the_value_is_never_lost() {
        let mut state = 11;
        for builtin in ALL {
            for _ in 0..1000 {
                let mut graph = Graph::new();
                let point: Vec<f64> = (0..builtin.row().arity).map(|_| walk(&mut state)).collect();
                let inputs: Vec<_> =
                    (0..point.len()).map(|input| graph.input(input as u32)).collect();
                let root = graph.call(*builtin, &inputs);
                let value = evaluate(&graph, &[root], &point, &[])[0];
                let around = |it: &f64| Interval::new(it - walk(&mut 5).abs() - 1.0, it + 0.5);
                let domain: Vec<Interval> = point.iter().map(around).collect();
                // The value is rounded, and so is what gives exactly that.
                let wanted = Interval::new(value - 0.1, value + 1e-9);
                if !value.is_finite() || !builtin.row().domain.contains(&point) {
                    continue;
                }
                let name = builtin.row().name;
                for (input, narrow) in Tape::new(&graph, &[root]).narrowed(&domain, wanted) {
                    let kept = narrow.contains(point[input as usize]);
                    assert!(kept, "{name} at {point:?} is {value}: {narrow:?}");
                }
            }
        }
    }

    #[test]
    fn a_value_narrows_what_gives_it() {
        let mut graph = Graph::new();
        let [x, y] = [0, 1].map(|input| graph.input(input));
        let square = graph.square(x);
        let exponential = graph.exp(y);
        let sum = graph.add(square, exponential);
        let domain = [Interval::new(0.0, 9.0), Interval::new(0.0, 9.0)];
        let found = Tape::new(&graph, &[sum]).narrowed(&domain, Interval::point(5.0));
        let of = |input: u32| found.iter().find(|it| it.0 == input).expect("it is read").1;
        assert!((of(0).upper - 2.0).abs() < 1e-9 && (of(1).upper - 5f64.ln()).abs() < 1e-9);
    }
}
