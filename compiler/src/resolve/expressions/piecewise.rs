//! `piecewise { a <= b => x  otherwise => y }` as nested selections; the first arm that holds
//! counts.

use super::knots::Guard;
use crate::expressions::graph::ExprId;
use crate::resolve::elaborator::Elaborator;
use crate::resolve::elaborator::value::{KnotUse, Parts, Reads, Traits, Value};
use crate::syntax::text;
use fdcc_grammar::ast::{Arm, Expr, Relation};
use fdcc_grammar::{Code, Diagnostic, Fix};

impl<'a> Elaborator<'a> {
    /// The value of a piecewise definition.
    pub fn piecewise(&mut self, whole: &'a Expr, arms: &'a [Arm], otherwise: &'a Expr) -> Value {
        let before = self.kept_constants();
        let values: Vec<Value> = arms.iter().map(|arm| self.evaluate(&arm.value)).collect();
        let rest = self.evaluate(otherwise);
        let sides: Vec<Option<Guard<'a>>> = arms.iter().map(|arm| self.guard(arm)).collect();
        let is_choice = |it: &Guard<'_>| it.traits.reads.beyond(Reads::PARAM).is_empty();
        if sides.iter().flatten().any(is_choice) {
            self.forget_constants(before);
        }
        let mut traits = Self::joined(values.iter().chain([&rest]));
        for guard in sides.iter().flatten() {
            traits.reads = traits.reads.or(guard.traits.reads);
        }
        traits = traits.join(&Traits {
            knots: vec![KnotUse { site: whole.span, used: whole.span }],
            ..Traits::default()
        });
        for (value, arm) in values.iter().zip(arms) {
            if values_differ(value, &rest) {
                return self.arms_differ(value, arm.value.span, &rest, otherwise.span);
            }
        }
        let known = values.iter().chain([&rest]).all(|value| value.parts != Parts::Unknown);
        let (Some(guards), true) = (sides.into_iter().collect::<Option<Vec<_>>>(), known) else {
            return Value::unknown(traits);
        };
        let arms: Vec<&[ExprId]> =
            values.iter().chain([&rest]).map(|value| value.parts.as_slice()).collect();
        self.find_knots(whole, &guards, &arms);
        self.guards.written.extend(guards.iter().map(|guard| [guard.smaller, guard.larger]));
        let parts: Vec<ExprId> =
            (0..arms[0].len()).map(|part| self.selection(&guards, &arms, part)).collect();
        Value { parts: Parts::from_list(&parts), traits, named: rest.named }
    }

    fn selection(&mut self, guards: &[Guard<'_>], arms: &[&[ExprId]], part: usize) -> ExprId {
        let last = arms[guards.len()][part];
        guards.iter().zip(arms).rev().fold(last, |rest, (guard, arm)| {
            self.graph.select_le(guard.smaller, guard.larger, arm[part], rest)
        })
    }

    /// The two sides of a guard, the one that must be smaller first.
    fn guard(&mut self, arm: &'a Arm) -> Option<Guard<'a>> {
        let (left, right) = (self.evaluate(&arm.left), self.evaluate(&arm.right));
        if arm.relation == Relation::Equal {
            self.diagnostics.push(equality(arm));
            return None;
        }
        let single = self.single_valued(&left.traits.sets, arm.left.span, "a guard")
            && self.single_valued(&right.traits.sets, arm.right.span, "a guard");
        let (a, b) =
            (self.expect_number(&left, arm.left.span), self.expect_number(&right, arm.right.span));
        let (a, b) = (a.filter(|_| single)?, b?);
        let (smaller, larger) = if arm.relation == Relation::LessEqual { (a, b) } else { (b, a) };
        Some(Guard { arm, smaller, larger, traits: left.traits.join(&right.traits) })
    }
}

fn values_differ(a: &Value, b: &Value) -> bool {
    let known = a.parts != Parts::Unknown && b.parts != Parts::Unknown;
    known && a.parts.as_slice().len() != b.parts.as_slice().len()
}

fn equality(arm: &Arm) -> Diagnostic {
    let repaired = format!(
        "{} <= {} => {}",
        text::expr(&arm.left),
        text::expr(&arm.right),
        text::expr(&arm.value)
    );
    Diagnostic::new(
        Code::EqualityGuard,
        "comparing real numbers with `==` in a guard",
        arm.guard_span,
        "true at a single point only, so this arm never matters",
    )
    .fix(Fix::likely("write `<=`").replace(arm.relation_span, "<="))
    .help(format!(
        "an arm needs a range: write `{repaired}`\n`==` is for conditions such as `end v == 0`"
    ))
}
