//! `blend(e, width)`: an expression with its knots and kinks rounded; `blend(f, width)` is a
//! function so rounded.

use crate::expressions::blend::rounded;
use crate::model::numbers::no_width;
use crate::resolve::elaborator::Elaborator;
use crate::resolve::elaborator::context::Context;
use crate::resolve::elaborator::value::{Parts, Value};
use crate::syntax::text;
use fdcc_grammar::ast::{Expr, ExprKind, ItemKind};
use fdcc_grammar::{Code, Diagnostic, Fix, Severity, Span};

impl<'a> Elaborator<'a> {
    /// `blend(e, width)`.
    pub fn blend(&mut self, inner: &'a Expr, width: &'a Expr, span: Span) -> Value {
        if self.is_own_function(inner) {
            let written = format!("blend({}, {})", text::expr(inner), text::expr(width));
            let message = format!("`{written}` is a function, not a value");
            let found = Diagnostic::new(Code::WrongKind, message, span, "a function");
            return self.fail(found.help(format!("call it: `{written}(...)`")));
        }
        let value = self.evaluate(inner);
        self.rounded(value, inner.span, width, span)
    }

    fn is_own_function(&self, inner: &Expr) -> bool {
        let ExprKind::Name(name) = &inner.kind else { return false };
        let is_local = self.here.local(name).is_some();
        let found = self.scope.find(name).filter(|_| !is_local);
        found.is_some_and(|at| matches!(self.scope.declarations[at].item.kind, ItemKind::Fn { .. }))
    }

    /// A value, written at `inner`, rounded by the `blend` at `span`.
    pub fn rounded(&mut self, value: Value, inner: Span, width: &'a Expr, span: Span) -> Value {
        let wide = self.evaluate_in(Context::WIDTH, width);
        let size = self.expect_number(&wide, width.span);
        let mut traits = value.traits.join(&wide.traits);
        traits.knots.clear();
        let Some(size) = size.filter(|_| value.parts != Parts::Unknown) else {
            return Value::unknown(traits);
        };
        if self.numeric(size) <= 0.0 {
            return self.fail(no_width(width.span, self.numeric(size)));
        }
        if !self.here.examining {
            self.model.widths.push((width.span, size));
        }
        match rounded(&mut self.graph, value.parts.as_slice(), size, &mut self.guards) {
            Some(parts) => Value { parts: Parts::from_list(&parts), traits, named: value.named },
            None => {
                // Within a function that depends on its arguments; it is told where the function is
                // examined by itself.
                if self.here.examining || self.here.visible().is_empty() {
                    self.diagnostics.push(nothing_to_round(inner, span));
                }
                Value { traits, ..value }
            }
        }
    }
}

fn nothing_to_round(inner: Span, span: Span) -> Diagnostic {
    let mut found = Diagnostic::new(
        Code::NotAllowedHere,
        "there is nothing for `blend` to round",
        inner,
        "no `piecewise`, `abs`, `min` or `max` in it that is not rounded yet",
    );
    found.severity = Severity::Warning;
    let before = Span { start: span.start, end: inner.start };
    let after = Span { start: inner.end, end: span.end };
    found
        .help("leave `blend` out")
        .fix(Fix::likely("leave `blend` out").remove(before).remove(after))
}
