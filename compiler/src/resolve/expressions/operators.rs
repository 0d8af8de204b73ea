//! `+ - * / ^` and componentwise functions: shapes, and what becomes of sets.
//!
//! A right side stays affine in every selector: sets may be added and multiplied by single values,
//! and by sets of other surfaces. Anything else is told here.

use crate::expressions::graph::{ExprId, Graph};
use crate::resolve::elaborator::Elaborator;
use crate::resolve::elaborator::value::{Parts, SetUse, Traits, Value};
use crate::syntax::text;
use fdcc_grammar::ast::{BinaryOperator, Expr};
use fdcc_grammar::{Code, Diagnostic, Span};

/// An operand: its value and where it stands.
pub(crate) type Operand<'a> = (Value, &'a Expr);

impl<'a> Elaborator<'a> {
    /// `left operator right`.
    pub fn binary(
        &mut self,
        operator: BinaryOperator,
        left: Operand<'a>,
        right: Operand<'a>,
    ) -> Value {
        let traits = left.0.traits.clone().join(&right.0.traits);
        if !self.sets_allow(operator, &left, &right) {
            return Value::default();
        }
        if operator == BinaryOperator::Divide {
            match Self::is_constant(&left.0) {
                true => self.keep_constant_divisor(right.1, &right.0),
                false => self.keep_divisor(right.1, &right.0),
            }
        }
        let named = left.0.named.or(right.0.named);
        let parts = self.combine(operator, &left, &right);
        Value { parts, traits, named }
    }

    fn combine(
        &mut self,
        operator: BinaryOperator,
        left: &Operand<'a>,
        right: &Operand<'a>,
    ) -> Parts {
        use BinaryOperator::{Add, Divide, Multiply, Power, Subtract};
        let (a, b) = (&left.0.parts, &right.0.parts);
        let apply: fn(&mut Graph, ExprId, ExprId) -> ExprId = match operator {
            Add => Graph::add,
            Subtract => Graph::sub,
            Multiply => Graph::mul,
            Divide => Graph::div,
            Power => Graph::pow,
        };
        match (a, b) {
            (Parts::Unknown, _) | (_, Parts::Unknown) => Parts::Unknown,
            (Parts::Scalar(a), Parts::Scalar(b)) => Parts::Scalar(apply(&mut self.graph, *a, *b)),
            (Parts::Vector(a), Parts::Vector(b))
                if matches!(operator, Add | Subtract) && a.len() == b.len() =>
            {
                let both = a.iter().zip(b.iter());
                Parts::Vector(both.map(|(&a, &b)| apply(&mut self.graph, a, b)).collect())
            }
            (Parts::Vector(a), Parts::Scalar(b)) if matches!(operator, Multiply | Divide) => {
                Parts::Vector(a.iter().map(|&a| apply(&mut self.graph, a, *b)).collect())
            }
            (Parts::Scalar(a), Parts::Vector(b)) if operator == Multiply => {
                Parts::Vector(b.iter().map(|&b| apply(&mut self.graph, *a, b)).collect())
            }
            _ => {
                self.fail_shape(mismatch(operator, left, right));
                Parts::Unknown
            }
        }
    }

    /// Whether the operands keep the right side affine in the selectors.
    fn sets_allow(
        &mut self,
        operator: BinaryOperator,
        left: &Operand<'a>,
        right: &Operand<'a>,
    ) -> bool {
        let (a, b) = (&left.0.traits.sets, &right.0.traits.sets);
        match operator {
            BinaryOperator::Add | BinaryOperator::Subtract => true,
            BinaryOperator::Multiply => {
                let span = left.1.span.to(right.1.span);
                self.product_of_sets(a, b, span)
            }
            BinaryOperator::Divide => self.single_valued(b, right.1.span, "a divisor"),
            BinaryOperator::Power => {
                self.single_valued(a, left.1.span, "the base of a power")
                    && self.single_valued(b, right.1.span, "an exponent")
            }
        }
    }

    /// Reports sets where only a single value can stand.
    pub fn single_valued(&mut self, sets: &[SetUse], span: Span, place: &str) -> bool {
        let Some(set) = sets.first() else { return true };
        let message = format!(
            "{place} is set-valued, so the right side is not affine in `{}`",
            set.form.name()
        );
        let label = format!("a set while `{}` is held at 0", set.surface);
        let found = Diagnostic::new(Code::NotAffine, message, span, label);
        self.diagnostics.push(found.help(
            "a set may be added, and multiplied by what has a single value. For the value that \
             acts write `selected(...)`",
        ));
        false
    }

    /// Products of sets: of one surface not affine, of two surfaces to be warned about.
    pub fn product_of_sets(&mut self, a: &[SetUse], b: &[SetUse], span: Span) -> bool {
        let (Some(first), Some(second)) = (a.first(), b.first()) else { return true };
        if let Some(same) = a.iter().find(|it| b.iter().any(|other| other.surface == it.surface)) {
            let message = format!(
                "`{}` is multiplied by itself, so the right side is not affine in `{}`",
                same.surface,
                same.form.name()
            );
            let found = Diagnostic::new(Code::NotAffine, message, span, "twice the same set");
            self.diagnostics.push(found.help(
                "off the surface `Sgn(s)^2` is 1, and so is `normsq(Dir(v))`: leave it \
                            out, or multiply by a single value",
            ));
            return false;
        }
        let message =
            format!("a product of the sets of `{}` and `{}`", first.surface, second.surface);
        let found = Diagnostic::new(Code::SetProduct, message, span, "two sets multiplied");
        self.diagnostics.push(found.help(
            "where both are held at once, fdcc takes the product of the two selected values; \
             Filippov's convex hull alone would not fix it",
        ));
        true
    }

    /// A function of each component.
    pub fn map(&mut self, value: Value, apply: impl Fn(&mut Graph, ExprId) -> ExprId) -> Value {
        let parts = match &value.parts {
            Parts::Unknown => Parts::Unknown,
            Parts::Scalar(part) => Parts::Scalar(apply(&mut self.graph, *part)),
            Parts::Vector(parts) => {
                Parts::Vector(parts.iter().map(|&part| apply(&mut self.graph, part)).collect())
            }
        };
        Value { parts, ..value }
    }

    /// `sum_i a_i b_i`.
    pub fn dot(&mut self, a: &Parts, b: &Parts) -> ExprId {
        let products: Vec<ExprId> =
            a.as_slice().iter().zip(b.as_slice()).map(|(&a, &b)| self.graph.mul(a, b)).collect();
        self.graph.sum(&products)
    }

    /// The traits of several values together.
    pub fn joined<'v>(values: impl IntoIterator<Item = &'v Value>) -> Traits {
        values.into_iter().fold(Traits::default(), |all, value| all.join(&value.traits))
    }
}

fn mismatch(operator: BinaryOperator, left: &Operand<'_>, right: &Operand<'_>) -> Diagnostic {
    let (a, b) = (left.0.parts.describe(), right.0.parts.describe());
    let (message, help) = match operator {
        BinaryOperator::Add => {
            (format!("adding {a} and {b}"), "both sides of a sum need the same size".into())
        }
        BinaryOperator::Subtract => {
            (format!("subtracting {b} from {a}"), "both sides need the same size".into())
        }
        BinaryOperator::Multiply => {
            let product = format!("dot({}, {})", text::expr(left.1), text::expr(right.1));
            (format!("multiplying {a} by {b}"), format!("for the scalar product write `{product}`"))
        }
        BinaryOperator::Divide => {
            (format!("dividing {a} by {b}"), "divide by a number, such as `norm(...)`".into())
        }
        BinaryOperator::Power => (
            format!("{a} to the power of {b}"),
            "for the squared length write `normsq(...)`".into(),
        ),
    };
    Diagnostic::new(Code::ShapeMismatch, message, left.1.span, a).label(right.1.span, b).help(help)
}
