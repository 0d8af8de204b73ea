//! The `sweep` block: lists of values for parameters and settings, which go together row by row.

use crate::model::{Place, Swept};
use crate::resolve::elaborator::context::Context;
use crate::resolve::elaborator::{Elaborator, Role};
use crate::settings::{Given, Refused, is_key, keys, nearest_key, set};
use crate::syntax::{closest, text};
use fdcc_grammar::ast::{self, Expr, ExprKind, ItemKind};
use fdcc_grammar::{Code, Diagnostic, Fix, Span};

impl<'a> Elaborator<'a> {
    /// Resolves a `sweep` block.
    pub fn sweep(&mut self, lists: &'a [ast::Swept]) {
        for list in lists {
            if let Some(swept) = self.swept(list) {
                self.model.sweep.push(swept);
            }
        }
        self.rows_match(lists);
    }

    fn swept(&mut self, list: &'a ast::Swept) -> Option<Swept> {
        let name = &list.name.name;
        let found = self.scope.find(name).map(|at| &self.scope.declarations[at].item.kind);
        let is_param = matches!(found, Some(ItemKind::Param { .. }));
        if !is_param && !is_key(name) {
            self.unknown_swept(list);
            return None;
        }
        let values: Option<Vec<String>> =
            list.values.iter().map(|value| self.swept_value(list, is_param, value)).collect();
        let place = Place { name: name.clone(), span: list.name.span };
        Some(Swept { place, values: values?, values_span: span_of(&list.values) })
    }

    /// A value: a number in SI, or a word.
    fn swept_value(&mut self, list: &ast::Swept, is_param: bool, expr: &'a Expr) -> Option<String> {
        let given = match &expr.kind {
            ExprKind::Name(word) if !is_param && self.scope.find(word).is_none() => {
                Given::Word(word.clone())
            }
            _ => {
                let value = self.evaluate_for(Role::Number("a sweep"), Context::SETTING, expr);
                let part = self.expect_number(&value, expr.span)?;
                Given::Number(self.numeric(part))
            }
        };
        if !is_param
            && let Err(refused) = set(&mut self.model.method.clone(), &list.name.name, &given)
        {
            let help = match refused {
                Refused::Value(expected) => format!("give it {expected}"),
                Refused::Removed(instead) => instead.into(),
                _ => "it cannot be solved yet".into(),
            };
            let message = format!("`{}` cannot be `{}`", list.name.name, text::expr(expr));
            let found = Diagnostic::new(
                Code::UnknownSetting,
                message,
                expr.span,
                "this value is not taken",
            );
            self.diagnostics.push(found.help(help));
            return None;
        }
        Some(match given {
            Given::Number(value) => value.to_string(),
            Given::Word(word) => word,
            Given::List(_) => return None,
        })
    }

    fn unknown_swept(&mut self, list: &ast::Swept) {
        let name = &list.name;
        let message = format!("there is no parameter or setting `{}` to sweep", name.name);
        let params = self
            .scope
            .declarations
            .iter()
            .filter(|it| matches!(it.item.kind, ItemKind::Param { .. }));
        let near = closest(&name.name, params.map(|it| it.name.name.as_str()))
            .or_else(|| nearest_key(&name.name));
        let found = Diagnostic::new(
            Code::UnknownSetting,
            message,
            name.span,
            "neither a `param` nor a setting",
        );
        self.diagnostics.push(match near {
            Some(near) => found
                .help(format!("did you mean `{near}`?"))
                .fix(Fix::likely(format!("write `{near}`")).replace(name.span, near)),
            None => found.help(format!("sweep a `param`, or one of the settings {}", keys())),
        });
    }

    /// All lists are of one length, but those of one value.
    fn rows_match(&mut self, lists: &'a [ast::Swept]) {
        let Some(first) = lists.iter().find(|list| list.values.len() > 1) else { return };
        let rows = first.values.len();
        let Some(other) = lists.iter().find(|list| ![1, rows].contains(&list.values.len())) else {
            return;
        };
        let message = "the lists of a sweep have different lengths";
        let label = |list: &ast::Swept| format!("{} values", list.values.len());
        let found =
            Diagnostic::new(Code::ShapeMismatch, message, span_of(&other.values), label(other));
        let found = found.label(span_of(&first.values), label(first));
        self.diagnostics.push(
            found.help("the lists go together row by row: give all the same length, or one value"),
        );
    }
}

fn span_of(values: &[Expr]) -> Span {
    values.iter().map(|value| value.span).reduce(Span::to).unwrap_or_default()
}
