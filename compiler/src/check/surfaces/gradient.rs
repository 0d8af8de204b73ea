//! FDC0301: the gradient of a surface vanishes on the surface itself.

use super::Subject;
use crate::surfaces::degenerate::Degenerate;
use crate::syntax::text;
use fdcc_grammar::ast::{BinaryOperator, Expr, ExprKind};
use fdcc_grammar::{Code, Diagnostic, Fix};

impl Subject<'_, '_, '_> {
    /// What is wrong with it, and what to write instead.
    pub(super) fn vanishing(&mut self, degenerate: &Degenerate) -> Diagnostic {
        let name = self.name().to_string();
        let written = self.written();
        let function = written.map_or_else(|| name.clone(), text::expr);
        let (state, slope) = self.local.gradient[0];
        let (state, slope) = (self.view.states[state].place.name.clone(), self.text(slope));
        let label = format!("d/d{state} = {slope}, which is 0 wherever {function} == 0");
        let message = format!("the gradient of surface `{name}` vanishes on the surface itself");
        let instead = self.instead(degenerate);
        let never = degenerate.never.map_or_else(String::new, |sign| {
            let side = if sign < 0.0 { "below" } else { "above" };
            format!(
                "\nNote that `{function}` never changes sign: as written this switch can never go \
                 {side}."
            )
        });
        let help = format!(
            "Lemma 3.1 needs a nonzero gradient where the surface is zero. {instead}{never}"
        );
        let found =
            Diagnostic::new(Code::VanishingGradient, message, self.function(), label).help(help);
        match written.and_then(|value| Some((value, root_of(value)?))) {
            Some((value, root)) => {
                let root = text::expr(root);
                found.fix(Fix::certain(format!("write `{root}`")).replace(value.span, root))
            }
            None => found,
        }
    }

    /// What has the same zero and changes its sign there.
    fn instead(&mut self, degenerate: &Degenerate) -> String {
        let written = self.written();
        let base = match (written.and_then(base_of), degenerate.base) {
            (Some(base), _) => Some(text::expr(base)),
            (None, Some(base)) => Some(self.text(base)),
            (None, None) => None,
        };
        match (base, written) {
            (Some(base), Some(_)) => format!("Write `surface {} = {base}`.", self.name()),
            (Some(base), None) => format!("Write `Sgn({base})`."),
            (None, _) => "A surface has two sides: write what changes its sign there.".into(),
        }
    }
}

/// The base of a written square: it is what was meant, because a square never changes its sign.
fn root_of(value: &Expr) -> Option<&Expr> {
    match &value.kind {
        ExprKind::Binary(BinaryOperator::Power, base, power)
            if power.kind == ExprKind::Number(2.0) =>
        {
            Some(base)
        }
        _ => None,
    }
}

/// The base of a written power.
fn base_of(value: &Expr) -> Option<&Expr> {
    match &value.kind {
        ExprKind::Binary(BinaryOperator::Power, base, _) => Some(base),
        _ => None,
    }
}
