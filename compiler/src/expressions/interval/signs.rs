//! Which signs an expression can have. Intervals are closed, so that of `exp(x)` has 0 in it, which
//! `exp(x)` never is.

use super::Interval;
use crate::expressions::graph::builtins::Builtin;
use crate::expressions::graph::{Expr, ExprId, Graph};
use std::collections::HashMap;

/// Some of negative, zero and positive.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) struct Signs(u8);

impl Signs {
    pub const NEGATIVE: Signs = Signs(1);
    pub const ZERO: Signs = Signs(2);
    pub const POSITIVE: Signs = Signs(4);
    pub const ANY: Signs = Signs(7);
    const NONE: Signs = Signs(0);

    /// Those of both.
    pub const fn or(self, other: Signs) -> Signs {
        Signs(self.0 | other.0)
    }
    /// Whether there are none in common.
    pub fn excludes(self, other: Signs) -> bool {
        self.0 & other.0 == 0
    }
    fn has(self, other: Signs) -> bool {
        !self.excludes(other)
    }
    /// Those for which `holds`.
    fn those(holds: impl Fn(Signs) -> bool) -> Signs {
        let each = [Signs::NEGATIVE, Signs::ZERO, Signs::POSITIVE].into_iter();
        each.filter(|it| holds(*it)).fold(Signs::NONE, Signs::or)
    }
    /// Of the numbers of an interval.
    fn of(interval: Interval) -> Signs {
        Signs::those(|it| match it {
            Signs::NEGATIVE => interval.lower < 0.0,
            Signs::ZERO => interval.contains(0.0),
            _ => interval.upper > 0.0,
        })
    }
    fn negated(self) -> Signs {
        Signs::those(|it| match it {
            Signs::NEGATIVE => self.has(Signs::POSITIVE),
            Signs::ZERO => self.has(Signs::ZERO),
            _ => self.has(Signs::NEGATIVE),
        })
    }
    fn magnitude(self) -> Signs {
        Signs::those(|it| match it {
            Signs::NEGATIVE => false,
            Signs::ZERO => self.has(Signs::ZERO),
            _ => self.has(Signs::NEGATIVE.or(Signs::POSITIVE)),
        })
    }
    fn plus(self, other: Signs) -> Signs {
        let cancels = |a: Signs, b: Signs| {
            a.has(Signs::POSITIVE) && b.has(Signs::NEGATIVE)
                || a.has(Signs::NEGATIVE) && b.has(Signs::POSITIVE)
        };
        match () {
            _ if self == Signs::NONE || other == Signs::NONE => Signs::NONE,
            _ if cancels(self, other) => Signs::ANY,
            _ if self.has(Signs::ZERO) && other.has(Signs::ZERO) => self.or(other),
            _ => Signs(self.or(other).0 & !Signs::ZERO.0),
        }
    }
    fn times(self, other: Signs) -> Signs {
        let same = |a: Signs, b: Signs| self.has(a) && other.has(b);
        let (minus, plus) = (Signs::NEGATIVE, Signs::POSITIVE);
        Signs::those(|it| match it {
            Signs::NEGATIVE => same(minus, plus) || same(plus, minus),
            Signs::ZERO => same(Signs::ZERO, Signs::ANY) || same(Signs::ANY, Signs::ZERO),
            _ => same(plus, plus) || same(minus, minus),
        })
    }
    /// The larger of two.
    fn maximum(self, other: Signs) -> Signs {
        Signs::those(|it| match it {
            Signs::NEGATIVE => self.has(it) && other.has(it),
            Signs::ZERO => {
                let below = Signs::NEGATIVE.or(Signs::ZERO);
                self.has(it) && other.has(below) || other.has(it) && self.has(below)
            }
            _ => self.has(it) || other.has(it),
        })
    }
}

/// The signs that an expression can have over a box.
pub(crate) fn signs(graph: &Graph, root: ExprId, domain: &[Interval]) -> Signs {
    let mut known: HashMap<ExprId, Signs> = HashMap::new();
    for id in graph.reachable(&[root]) {
        let of = match graph.expr(id) {
            Expr::Number(bits) => Signs::of(Interval::point(bits.value())),
            Expr::Input(position) => Signs::of(domain[*position as usize]),
            Expr::Multiplier(_) => Signs::ANY,
            Expr::Call(Builtin::Mul, operands) if operands[0] == operands[1] => {
                known[&operands[0]].magnitude()
            }
            Expr::Call(builtin, operands) => {
                let operands: Vec<Signs> = operands.iter().map(|it| known[it]).collect();
                apply(*builtin, &operands)
            }
        };
        known.insert(id, of);
    }
    known[&root]
}

/// Those of a call, whose operands are in the domain of the builtin.
fn apply(builtin: Builtin, operands: &[Signs]) -> Signs {
    let a = operands[0];
    match builtin {
        Builtin::Add => a.plus(operands[1]),
        Builtin::Sub => a.plus(operands[1].negated()),
        // A quotient has the signs of a product, and no divisor is 0.
        Builtin::Mul => a.times(operands[1]),
        Builtin::Div => a.times(Signs(operands[1].0 & !Signs::ZERO.0)),
        Builtin::Neg => a.negated(),
        Builtin::Exp | Builtin::Cosh | Builtin::Pow => Signs::POSITIVE,
        Builtin::Abs | Builtin::LogCosh => a.magnitude(),
        Builtin::Sqrt => Signs(a.0 & !Signs::NEGATIVE.0),
        Builtin::Sinh | Builtin::Tanh | Builtin::Atan | Builtin::Asin => a,
        Builtin::Max => a.maximum(operands[1]),
        Builtin::Min => a.negated().maximum(operands[1].negated()).negated(),
        Builtin::SelectLe => operands[2].or(operands[3]),
        _ => Signs::ANY,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expressions::graph::builtins::ALL;

    #[test]
    fn every_builtin_has_the_signs_of_its_values() {
        let points = [-2.0, -0.5, 0.0, 0.5, 2.0];
        let sign = |value: f64| Signs::of(Interval::point(value));
        for builtin in ALL {
            let arity = builtin.row().arity;
            for number in 0..points.len().pow(arity as u32) {
                let digit = |at: usize| number / points.len().pow(at as u32) % points.len();
                let point: Vec<f64> = (0..arity).map(|at| points[digit(at)]).collect();
                let value = (builtin.row().value)(&point);
                if !builtin.row().domain.contains(&point) || !value.is_finite() {
                    continue;
                }
                let signs: Vec<Signs> = point.iter().map(|it| sign(*it)).collect();
                let image = apply(*builtin, &signs);
                let name = builtin.row().name;
                assert!(image.has(sign(value)), "{name} at {point:?} is {value}: {image:?}");
            }
        }
    }

    #[test]
    fn what_is_never_zero_is_seen() {
        let mut graph = Graph::new();
        let x = graph.input(0);
        let (square, exponential) = (graph.square(x), graph.exp(x));
        let (sum, quotient) = (graph.add(square, exponential), graph.reciprocal(x));
        let of = |root| signs(&graph, root, &[Interval::ALL]);
        assert_eq!(of(sum), Signs::POSITIVE);
        assert!(of(quotient).excludes(Signs::ZERO));
        assert_eq!(of(square), Signs::ZERO.or(Signs::POSITIVE));
    }
}
