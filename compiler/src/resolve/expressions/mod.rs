//! The value of an expression: one arm per kind, the rest in the files beside this one.

mod blend;
mod calls;
pub(crate) mod data;
mod direction;
mod first_arm;
mod forms;
pub(crate) mod knots;
mod operators;
mod own_functions;
mod piecewise;
mod vectors;

use super::elaborator::Elaborator;
use super::elaborator::value::{Parts, Reads, Traits, Value};
use crate::syntax::DEEPEST;
use crate::syntax::each::{numbered, phase_named};
use crate::syntax::{scope, walk};
use crate::units;
use fdcc_grammar::ast::{Expr, ExprKind, Ident, ItemKind, Unit};
use fdcc_grammar::{Code, Diagnostic, Span};

impl<'a> Elaborator<'a> {
    /// The value of an expression; unknown after a mistake, which has then been reported.
    pub fn evaluate(&mut self, expr: &'a Expr) -> Value {
        if self.here.depth > DEEPEST {
            return self.too_deep(expr.span);
        }
        self.here.depth += 1;
        let before = self.constants.len();
        let value = self.evaluate_kind(expr);
        let value = self.in_its_unit(expr, value);
        self.here.depth -= 1;
        if is_composed(expr) {
            self.keep_constant(expr, &value, before);
        }
        if let (ExprKind::Call(..), Parts::Scalar(part), true) =
            (&expr.kind, &value.parts, self.here.owner.is_none())
        {
            self.written.push((expr, *part));
        }
        value
    }

    /// A number without a unit is read in that of what it stands beside.
    fn in_its_unit(&mut self, expr: &Expr, value: Value) -> Value {
        match self.readings.get(&expr.span) {
            Some(&scale) => self.map(value, |graph, part| graph.scale(scale, part)),
            None => value,
        }
    }

    fn evaluate_kind(&mut self, expr: &'a Expr) -> Value {
        match &expr.kind {
            ExprKind::Number(value) => self.constant(*value),
            ExprKind::Quantity(value, unit) => {
                // Unknown units have been told.
                self.constant(value * units::scale(unit, &mut Vec::new()))
            }
            ExprKind::Name(name) => self.name(name, expr.span),
            ExprKind::Negate(inner) => {
                let inner = self.evaluate(inner);
                self.map(inner, |graph, part| graph.neg(part))
            }
            ExprKind::Binary(..) => self.chain(expr),
            ExprKind::Call(callee, arguments) => self.call(expr, callee, arguments),
            ExprKind::Part(base, part) => self.part(base, part, expr.span),
            ExprKind::Index(base, index) => self.index(base, *index, expr.span),
            ExprKind::Prime(base) => self.prime(base, expr.span),
            ExprKind::Tuple(parts) => self.tuple(parts),
            ExprKind::Piecewise { arms, otherwise } => self.piecewise(expr, arms, otherwise),
            ExprKind::Match { surface, below, above, .. } => {
                self.matched(expr, surface, below, above)
            }
        }
    }

    fn too_deep(&mut self, span: Span) -> Value {
        let message = format!("definitions and parentheses are nested more than {DEEPEST} deep");
        let found = Diagnostic::new(Code::TooDeep, message, span, "too deep here");
        self.fail(found.help("give intermediate results names with `let`"))
    }

    /// A number as a value.
    pub fn constant(&mut self, value: f64) -> Value {
        Value::scalar(self.graph.number(value), Traits::default())
    }

    fn chain(&mut self, expr: &'a Expr) -> Value {
        let (first, links) = walk::spine(expr);
        let before = self.constants.len();
        let mut left = self.evaluate(first);
        for (left_expr, operator, right_expr) in links {
            if is_composed(left_expr) {
                self.keep_constant(left_expr, &left, before);
            }
            let right = self.evaluate(right_expr);
            left = self.binary(operator, (left, left_expr), (right, right_expr));
        }
        left
    }

    fn name(&mut self, name: &'a str, span: Span) -> Value {
        if let Some(value) = self.here.local(name) {
            return value.clone();
        }
        let Some(at) = self.scope.find(name) else {
            return match name {
                "pi" => self.constant(std::f64::consts::PI),
                "inf" => self.infinity(span),
                _ => self.unknown_name(name, span),
            };
        };
        if self.circular[at] {
            return Value::default();
        }
        let item = self.scope.declarations[at].item;
        if let ItemKind::Fn { .. } | ItemKind::Data { .. } | ItemKind::Phase { .. } = item.kind {
            return self.no_value(name, scope::kind_word(item), span);
        }
        let mut value = self.values[at].clone();
        value.traits = value.traits.used_at(span);
        self.admit(name, value, span)
    }

    /// `in [0, inf]`: no bound on that side. Nothing else is infinite.
    fn infinity(&mut self, span: Span) -> Value {
        if self.here.context.is_bound {
            return self.constant(f64::INFINITY);
        }
        let message = format!("`inf` has no meaning in {}", self.here.context.name);
        let found = Diagnostic::new(Code::NotAllowedHere, message, span, "not a number");
        self.fail(found.help("only a side of bounds may be missing: `in [0, inf]`, `in [-inf, 3]`"))
    }

    fn unknown_name(&mut self, name: &str, span: Span) -> Value {
        let owners = self.phases.iter().filter(|phase| phase.names.contains_key(name));
        let owners: Vec<&str> = owners.map(|phase| phase.name.name.as_str()).collect();
        if !owners.is_empty() {
            let message = format!("nothing called `{name}` here");
            let found = Diagnostic::new(Code::UnknownName, message, span, "declared in phases");
            let all = |shown: &dyn Fn(&&str) -> String, between: &str| {
                owners.iter().map(shown).collect::<Vec<_>>().join(between)
            };
            // What reads no phase stands in each of them.
            let help = match Reads::PHASE.beyond(self.here.context.allowed).is_empty() {
                true => format!("write {}", all(&|it| format!("`{it}.{name}`"), " or ")),
                false => format!(
                    "each phase has its own `{name}`: write {} for each, within {}",
                    self.here.context.name,
                    all(&|it| format!("`phase {it}`"), " and ")
                ),
            };
            return self.fail(found.help(help));
        }
        let locals: Vec<&str> =
            self.here.visible().iter().map(|local| local.0).chain(["pi"]).collect();
        let found = self.scope.unknown(name, span, &locals, &format!("param {name} = 1"));
        self.fail(found)
    }

    fn no_value(&mut self, name: &str, kind: &str, span: Span) -> Value {
        let help = match kind {
            "function" => format!("call it: `{name}(...)`"),
            "data set" => format!("take one of its columns: `{name}.COLUMN`"),
            _ => format!("take one of its states at an end: `{name}.STATE(end)`"),
        };
        let message = format!("`{name}` is a {kind}, not a value");
        self.fail(Diagnostic::new(Code::WrongKind, message, span, format!("a {kind}")).help(help))
    }

    fn part(&mut self, base: &'a Expr, part: &'a Ident, span: Span) -> Value {
        if let Some(value) = self.part_of_container(base, part, span) {
            return value;
        }
        let value = self.evaluate(base);
        let Some(item) = value.named.map(|at| self.item_named(at)) else {
            return self.no_part(value, part, &[]);
        };
        if let (ItemKind::Data { columns, .. }, Some(at)) = (&item.kind, value.named) {
            return self.column_named(at, columns, part);
        }
        let names: Vec<&Ident> = scope::parts(item).iter().collect();
        match names.iter().position(|name| name.name == part.name) {
            Some(index) => pick(value, index),
            None => self.no_part(value, part, &names),
        }
    }

    /// `obs.t` of a data set, known by name, without a value here; `coast.h` of a phase.
    fn part_of_container(&mut self, base: &'a Expr, part: &'a Ident, span: Span) -> Option<Value> {
        let name = phase_named(base)?;
        if self.here.local(&name).is_some() {
            return None;
        }
        let at = self.scope.find(&name)?;
        let item = self.scope.declarations[at].item;
        match &item.kind {
            ItemKind::Data { columns, .. } => Some(self.column_named(at, columns, part)),
            ItemKind::Phase { items, .. } => Some(self.of_phase(&name, items, part, span)),
            _ => None,
        }
    }

    fn column_named(
        &mut self,
        at: usize,
        columns: &[(Ident, Option<Unit>)],
        part: &Ident,
    ) -> Value {
        match columns.iter().position(|column| column.0.name == part.name) {
            Some(column) => self.data_column(at, column, part.span),
            None => {
                let names: Vec<&Ident> = columns.iter().map(|column| &column.0).collect();
                self.no_part(Value::default(), part, &names)
            }
        }
    }

    pub fn no_part(&mut self, value: Value, part: &Ident, names: &[&Ident]) -> Value {
        if value.parts == Parts::Unknown && names.is_empty() {
            return Value::default();
        }
        let message = format!("there is no part `{}`", part.name);
        let found = Diagnostic::new(Code::UnknownPart, message, part.span, "no such part");
        let known: Vec<String> = names.iter().map(|name| format!("`.{}`", name.name)).collect();
        let help = match &value.parts {
            _ if !known.is_empty() => format!("there is {}", known.join(", ")),
            Parts::Vector(parts) => {
                format!("its parts have no names: count them, `[1]` to `[{}]`", parts.len())
            }
            _ => "only vectors have parts, such as `state pos(x, y)`".into(),
        };
        self.fail_shape(found.help(help))
    }

    fn index(&mut self, base: &'a Expr, index: usize, span: Span) -> Value {
        if let ExprKind::Name(name) = &base.kind
            && let Some(count) = self.scope.phases_of(name)
        {
            return self.experiment(name, index, count, span);
        }
        let value = self.evaluate(base);
        let length = match &value.parts {
            Parts::Unknown => return value,
            Parts::Scalar(_) => 0,
            Parts::Vector(parts) => parts.len(),
        };
        if (1..=length).contains(&index) {
            return pick(value, index - 1);
        }
        let label = if length == 0 {
            "a number has no parts".to_string()
        } else {
            format!("{length} parts, counted from 1")
        };
        let found = Diagnostic::new(
            Code::UnknownPart,
            format!("there is no part `[{index}]`"),
            span,
            label,
        );
        let help = if length == 0 {
            "leave the index out".to_string()
        } else {
            format!("write `[1]` to `[{length}]`")
        };
        self.fail_shape(found.help(help))
    }

    /// `run[2]` without a name of that phase, or beyond the last one.
    fn experiment(&mut self, name: &str, index: usize, count: usize, span: Span) -> Value {
        if (1..=count).contains(&index) {
            return self.no_value(&numbered(name, index), "phase", span);
        }
        let message = format!("there is no phase `{}`", numbered(name, index));
        let label = format!("{count} files, counted from 1");
        let found = Diagnostic::new(Code::UnknownPart, message, span, label);
        let last = numbered(name, count);
        self.fail(found.help(format!("the phases are `{}` to `{last}`", numbered(name, 1))))
    }

    /// `x'` in a guess: the derivative in real time of what was guessed for `x`.
    fn prime(&mut self, base: &'a Expr, span: Span) -> Value {
        if !self.here.context.is_guess {
            let found = Diagnostic::new(
                Code::NotAllowedHere,
                "a derivative on this side",
                span,
                "only a guess may use `'` here",
            );
            return self.fail(
                found.help("write out the right side of its equation, or name it with `let`"),
            );
        }
        let value = self.evaluate(base);
        let Some(time) = self.time else { return Value::default() };
        self.map(value, |graph, part| {
            crate::expressions::graph::derivative::derivative(graph, part, time)
        })
    }

    fn tuple(&mut self, parts: &'a [Expr]) -> Value {
        let mut traits = Traits::default();
        let mut list = Vec::new();
        for part in parts {
            let value = self.evaluate(part);
            list.extend(self.expect_number(&value, part.span));
            traits = traits.join(&value.traits);
        }
        let complete = list.len() == parts.len();
        let parts = if complete { Parts::from_list(&list) } else { Parts::Unknown };
        Value { parts, traits, named: None }
    }
}

/// Whether a value is computed here, not only named or listed.
fn is_composed(expr: &Expr) -> bool {
    matches!(
        expr.kind,
        ExprKind::Binary(..)
            | ExprKind::Negate(_)
            | ExprKind::Call(..)
            | ExprKind::Piecewise { .. }
    )
}

/// One component.
fn pick(value: Value, index: usize) -> Value {
    let parts =
        value.parts.as_slice().get(index).map_or(Parts::Unknown, |part| Parts::Scalar(*part));
    Value { parts, traits: value.traits, named: None }
}
