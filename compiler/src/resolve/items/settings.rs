//! The `method` block.

use crate::resolve::elaborator::context::Context;
use crate::resolve::elaborator::{Elaborator, Role};
use crate::settings::conflicts::misfit;
use crate::settings::{Given, Refused, keys, nearest_key, nearest_word, set};
use crate::syntax::text;
use fdcc_grammar::ast::{Expr, ExprKind, Ident, ItemKind, Setting, SettingValue, Unit};
use fdcc_grammar::{Code, Diagnostic, Fix, Span};

fn shown(given: &Given) -> String {
    match given {
        Given::Number(value) => text::number(*value),
        Given::Word(word) => word.clone(),
        Given::List(values) => {
            values.iter().map(|value| text::number(*value)).collect::<Vec<_>>().join(", ")
        }
    }
}

impl<'a> Elaborator<'a> {
    /// Resolves a `method` block.
    pub fn settings(&mut self, settings: &'a [Setting]) {
        self.each_setting(settings);
        let Some((key, what, help)) = misfit(&self.model.method) else { return };
        if let Some(setting) = settings.iter().find(|setting| setting.key.name == key) {
            let found = Diagnostic::new(
                Code::UnknownSetting,
                what,
                setting.key.span,
                "not with the other settings",
            );
            let found = match (key, self.given(setting)) {
                ("scheme", Some((Given::Word(family), span))) => with_stages(found, span, &family),
                _ => found,
            };
            self.diagnostics.push(found.help(help));
        }
    }

    fn each_setting(&mut self, settings: &'a [Setting]) {
        for setting in settings {
            let key = &setting.key;
            if matches!(key.name.as_str(), "sigma" | "kernel" | "continue") {
                self.model.smooth = true;
            }
            if let Some(unit) = unit_of(setting) {
                self.diagnostics.push(with_unit(key, unit));
                continue;
            }
            let Some((given, span)) = self.given(setting) else { continue };
            let taken = set(&mut self.model.method, &key.name, &given);
            match taken {
                Ok(()) => {}
                Err(Refused::NotYet) => self.setting_not_yet(key, &given, span),
                Err(Refused::Removed(instead)) => self.removed_value(key, &given, instead, span),
                Err(Refused::Key) => self.unknown_key(key),
                Err(Refused::Value(expected)) => self.wrong_value(key, &given, &expected, span),
            }
            if let SettingValue::Scheme { name, lagged } = &setting.value {
                self.lagged(name, lagged);
            }
        }
    }

    /// The value of a setting: a word, a number or a list of numbers.
    fn given(&mut self, setting: &'a Setting) -> Option<(Given, Span)> {
        match &setting.value {
            SettingValue::Scheme { name, .. } => Some((Given::Word(name.name.clone()), name.span)),
            SettingValue::Expr(expr) => match &expr.kind {
                ExprKind::Name(name) if self.is_word(name) => {
                    Some((Given::Word(name.clone()), expr.span))
                }
                _ => self.setting_number(expr).map(|value| (Given::Number(value), expr.span)),
            },
            SettingValue::List(list) => {
                let numbers: Option<Vec<f64>> =
                    list.iter().map(|expr| self.setting_number(expr)).collect();
                let span = list
                    .first()
                    .map_or(setting.key.span, |first| first.span.to(list[list.len() - 1].span));
                numbers.map(|numbers| (Given::List(numbers), span))
            }
        }
    }

    /// A name that is no parameter or constant is a word.
    fn is_word(&self, name: &str) -> bool {
        let is_number = |kind: &ItemKind| {
            matches!(kind, ItemKind::Param { .. } | ItemKind::Const { .. } | ItemKind::Let { .. })
        };
        !self.scope.find(name).is_some_and(|at| is_number(&self.scope.declarations[at].item.kind))
    }

    fn setting_number(&mut self, expr: &'a Expr) -> Option<f64> {
        let value = self.evaluate_for(Role::Number("a setting"), Context::SETTING, expr);
        self.expect_number(&value, expr.span).map(|part| self.numeric(part))
    }

    fn setting_not_yet(&mut self, key: &Ident, given: &Given, span: Span) {
        self.not_yet(span, &format!("a model with `{} = {}`", key.name, shown(given)));
    }

    fn unknown_key(&mut self, key: &Ident) {
        let message = format!("the method has no setting `{}`", key.name);
        let found = Diagnostic::new(Code::UnknownSetting, message, key.span, "not a setting");
        self.diagnostics.push(match nearest_key(&key.name) {
            Some(near) => meant(found, key.span, near),
            None => found.help(format!("the settings are {}", keys())),
        });
    }

    fn removed_value(&mut self, key: &Ident, given: &Given, instead: &str, span: Span) {
        let message = format!("`{}` cannot be `{}`", key.name, shown(given));
        let found = Diagnostic::new(Code::UnknownSetting, message, span, "not a word it takes");
        self.diagnostics.push(found.help(instead));
    }

    fn wrong_value(&mut self, key: &Ident, given: &Given, expected: &str, span: Span) {
        let shown = shown(given);
        let message = format!("`{}` cannot be `{shown}`", key.name);
        let label = if expected.starts_with("one of") {
            "not a word it takes".into()
        } else {
            format!("needs {expected}")
        };
        let found = Diagnostic::new(Code::UnknownSetting, message, span, label);
        self.diagnostics.push(match nearest_word(expected, &shown) {
            Some(near) if matches!(given, Given::Word(_)) => meant(found, span, near),
            _ => found.help(format!("give it {expected}")),
        });
    }

    /// The states that an implicit step takes at the old time.
    fn lagged(&mut self, scheme: &Ident, names: &'a [Ident]) {
        if !names.is_empty() && scheme.name != "implicit_euler" {
            let message = format!("`{}` lags no states", scheme.name);
            let found = Diagnostic::new(
                Code::UnknownSetting,
                message,
                names[0].span,
                "only for `implicit_euler`",
            );
            self.diagnostics.push(
                found.help(
                    "leave `lagged (...)` out, or write `scheme implicit_euler lagged (...)`",
                ),
            );
        }
        for name in names {
            let state =
                self.declared_as(name, "state", |kind| matches!(kind, ItemKind::State { .. }));
            if let Some((at, first)) = state.and_then(|at| Some((at, self.index_of(at)?))) {
                let size = self.values[at].parts.as_slice().len();
                self.model.method.lagged.extend(first..first + size);
            }
        }
    }
}

/// The unit that is written behind a setting that has none. What measures something is told with
/// all units.
fn unit_of(setting: &Setting) -> Option<&Unit> {
    if matches!(setting.key.name.as_str(), "sigma" | "continue") {
        return None;
    }
    let in_value = match &setting.value {
        SettingValue::Expr(Expr { kind: ExprKind::Quantity(_, unit), .. }) => Some(unit),
        _ => None,
    };
    setting.unit.as_ref().or(in_value)
}

fn with_unit(key: &Ident, unit: &Unit) -> Diagnostic {
    let message = format!("`{}` has no unit, but is given one", key.name);
    Diagnostic::new(Code::UnitHere, message, unit.span, "a unit")
        .help("give it a number without a unit")
        .fix(Fix::certain("take the unit out").remove(unit.span))
}

/// Three stages are the most common choice.
fn with_stages(found: Diagnostic, span: Span, family: &str) -> Diagnostic {
    let scheme = format!("{family}3");
    found.fix(Fix::likely(format!("write `{scheme}`")).replace(span, scheme))
}

/// A setting is one of few words, so the nearest is the one that was meant.
fn meant(found: Diagnostic, span: Span, near: &str) -> Diagnostic {
    let fix = Fix::certain(format!("write `{near}`")).replace(span, near);
    found.help(format!("did you mean `{near}`?")).fix(fix)
}
