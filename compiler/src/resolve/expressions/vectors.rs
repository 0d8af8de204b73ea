//! The builtin functions of vectors: products, lengths.

use super::calls::argument_span;
use crate::resolve::elaborator::Elaborator;
use crate::resolve::elaborator::value::{Parts, Traits, Value};
use fdcc_grammar::ast::Argument;
use fdcc_grammar::{Code, Diagnostic, Span};

impl<'a> Elaborator<'a> {
    pub(super) fn apply_to_vectors(
        &mut self,
        name: &str,
        values: &[Value],
        arguments: &'a [Argument],
        span: Span,
    ) -> Value {
        let traits = Self::joined(values);
        if values.iter().any(|value| value.parts == Parts::Unknown) {
            return Value::unknown(traits);
        }
        let lengths: Vec<usize> = values.iter().map(|value| value.parts.as_slice().len()).collect();
        if lengths.iter().any(|&length| length != lengths[0]) {
            return self.different_sizes(name, values, arguments);
        }
        let (a, b) = (&values[0].parts, &values[values.len() - 1].parts);
        match name {
            "cross" => self.cross(&values[0], &values[1], traits, span),
            "norm" => {
                let square = self.dot(a, b);
                Value::scalar(self.graph.sqrt(square), traits)
            }
            _ => self.product(&values[0], &values[values.len() - 1], name == "dot", traits, span),
        }
    }

    /// `dot(a, b)`, and `normsq(a)` as `dot(a, a)`.
    fn product(&mut self, a: &Value, b: &Value, is_dot: bool, traits: Traits, span: Span) -> Value {
        if is_dot && !self.product_of_sets(&a.traits.sets, &b.traits.sets, span) {
            return Value::default();
        }
        Value::scalar(self.dot(&a.parts, &b.parts), traits)
    }

    fn different_sizes(&mut self, name: &str, values: &[Value], arguments: &[Argument]) -> Value {
        let described: Vec<String> = values.iter().map(|value| value.parts.describe()).collect();
        let message = format!("`{name}` of {}", described.join(" and "));
        let found = Diagnostic::new(
            Code::ShapeMismatch,
            message,
            argument_span(&arguments[0]),
            described[0].as_str(),
        )
        .label(argument_span(&arguments[1]), described[1].as_str());
        self.fail_shape(found.help("both need the same size"))
    }

    /// `a x b`: a number in the plane, a vector in space.
    fn cross(&mut self, a: &Value, b: &Value, traits: Traits, span: Span) -> Value {
        if !self.product_of_sets(&a.traits.sets, &b.traits.sets, span) {
            return Value::default();
        }
        let (a, b) = (a.parts.as_slice(), b.parts.as_slice());
        let mut minor = |i: usize, j: usize| {
            let (left, right) = (self.graph.mul(a[i], b[j]), self.graph.mul(a[j], b[i]));
            self.graph.sub(left, right)
        };
        match a.len() {
            2 => Value::scalar(minor(0, 1), traits),
            3 => Value {
                parts: Parts::from_list(&[minor(1, 2), minor(2, 0), minor(0, 1)]),
                traits,
                named: None,
            },
            _ => {
                let found = Diagnostic::new(
                    Code::ShapeMismatch,
                    "`cross` is for two or three dimensions",
                    span,
                    "other sizes",
                );
                self.fail_shape(found.help("give it vectors of 2 or 3"))
            }
        }
    }
}
