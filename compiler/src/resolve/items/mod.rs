//! Everything that is not a declaration: time, dynamics, conditions, objective, report,
//! expectations.

pub(crate) mod conditions;
mod declare;
mod fit;
mod guess;
mod jumps;
mod plots;
mod settings;
mod signals;
mod sweep;

use super::elaborator::context::Context;
use super::elaborator::value::Value;
use super::elaborator::{Elaborator, Role};
use crate::expressions::graph::ExprId;
use crate::model::{Comparison, Expectation, Place, Report};
use crate::syntax::{scope, text};
use fdcc_grammar::ast::{
    Binding, Check, Equation, Expr, Ident, Interval, Item, ItemKind, Relation, Sense,
};
use fdcc_grammar::{Code, Diagnostic, Span};

impl<'a> Elaborator<'a> {
    /// Resolves what is no declaration; declarations are known.
    pub fn resolve_items(&mut self, items: &[&'a Item]) {
        items.iter().for_each(|item| self.item(item));
        self.add_fits();
        self.move_boundary();
        self.plots(items);
        self.check_curves();
    }

    fn item(&mut self, item: &'a Item) {
        match &item.kind {
            ItemKind::Dynamics { equations } => {
                equations.iter().for_each(|equation| self.equation(equation))
            }
            ItemKind::Start { condition } => self.boundary(condition, false),
            ItemKind::End { condition } => self.boundary(condition, true),
            ItemKind::At { time, condition } => self.at_time(time, condition),
            ItemKind::Path { name, condition } => self.path(name.as_ref(), condition),
            ItemKind::Objective { sense, keyword, value } => {
                self.objective(*sense, *keyword, value)
            }
            ItemKind::Fit { keyword, data, signals } => self.fit(*keyword, data, signals),
            ItemKind::Guess { bindings } => self.guess(bindings),
            ItemKind::Method { settings } => self.settings(settings),
            ItemKind::Sweep { lists } => self.sweep(lists),
            ItemKind::Report { bindings } => {
                bindings.iter().for_each(|binding| self.report(binding))
            }
            ItemKind::Expect { checks } => checks.iter().for_each(|check| self.expectation(check)),
            ItemKind::Metric { weights } => {
                weights.iter().for_each(|(name, weight)| self.weight(name, weight))
            }
            ItemKind::Jump { .. } => self.jump(item),
            ItemKind::Link { from, to, same, assignments } => {
                self.link(from, to, *same, assignments)
            }
            ItemKind::Data { file, file_span, .. }
                if self.tables.get(*file_span, file).is_none() =>
            {
                self.not_yet(*file_span, "a model whose data was not read")
            }
            _ => {}
        }
    }

    /// First and last time.
    pub fn time_interval(&mut self, interval: &'a Interval) {
        for (at, end) in [&interval.lower, &interval.upper].into_iter().enumerate() {
            let value = self.evaluate_for(Role::Number("a bound of time"), Context::TIME, end);
            if let Some(part) = self.expect_number(&value, end.span) {
                self.interval[at] = part;
            }
        }
    }

    /// The declaration of a name that must be of some kind; reports the others.
    pub fn declared_as(
        &mut self,
        name: &Ident,
        wanted: &str,
        fits: fn(&ItemKind) -> bool,
    ) -> Option<usize> {
        let Some(at) = self.scope.find(&name.name) else {
            let rest = if wanted == "surface" { "= x" } else { "start 0" };
            let example = format!("{wanted} {} {rest}", name.name);
            let found = self.scope.unknown(&name.name, name.span, &[], &example);
            self.diagnostics.push(found);
            return None;
        };
        let declaration = self.scope.declarations[at];
        if fits(&declaration.item.kind) {
            return Some(at);
        }
        let kind = scope::kind_word(declaration.item);
        let message = format!("`{}` is a {kind}, not a {wanted}", name.name);
        let found = Diagnostic::new(
            Code::WrongKind,
            message,
            name.span,
            format!("a {wanted} is needed here"),
        )
        .label(declaration.name.span, format!("declared as a {kind}"));
        self.diagnostics.push(
            found.help(format!("declare `{}` as a {wanted}, or name another one", name.name)),
        );
        None
    }

    /// `factor * x' = right`.
    fn equation(&mut self, equation: &'a Equation) {
        let state = self
            .declared_as(&equation.state, "state", |kind| matches!(kind, ItemKind::State { .. }));
        let right = self.evaluate_for(Role::Equation(equation), Context::DYNAMICS, &equation.right);
        let right = match &equation.factor {
            Some(factor) => self.divided(right, equation, factor),
            None => right,
        };
        let Some(first) = state.and_then(|at| self.index_of(at)) else { return };
        let size = self.values[state.expect("its index was found")].parts.as_slice().len();
        let before = self.model.states[first].equation.span;
        if before != self.model.states[first].place.span {
            let message = format!("`{}` has two equations", equation.state.name);
            let found =
                Diagnostic::new(Code::DuplicateName, message, equation.span, "a second equation");
            self.diagnostics.push(found.label(before, "the first one").help("keep one of them"));
            return;
        }
        let parts = self.expect_parts(&right, size, equation.right.span);
        for part in 0..size {
            self.model.states[first + part].equation.span = equation.span;
            if let Some(&rate) = parts.get(part) {
                self.model.states[first + part].rate = rate;
                self.known_rates.insert(first + part);
            }
        }
    }

    fn divided(&mut self, right: Value, equation: &'a Equation, factor: &'a Expr) -> Value {
        let factor_value = self.evaluate_in(Context::DYNAMICS, factor);
        if !self.single_valued(&factor_value.traits.sets, factor.span, "the factor of a derivative")
        {
            return Value::default();
        }
        let traits = right.traits.clone().join(&factor_value.traits);
        let (Some(by), false) =
            (self.expect_number(&factor_value, factor.span), right.parts.as_slice().is_empty())
        else {
            return Value::unknown(traits);
        };
        self.keep_divisor(factor, &factor_value);
        if self.graph.as_number(by) == Some(0.0) {
            let message = format!("`{}'` is multiplied by 0", equation.state.name);
            let found = Diagnostic::new(Code::NotAllowedHere, message, factor.span, "always 0");
            return self.fail(
                found.help(
                    "an equation without derivative is a constraint: write `path ... == ...`",
                ),
            );
        }
        self.map(Value { traits, ..right }, |graph, part| graph.div(part, by))
    }

    fn objective(&mut self, sense: Sense, keyword: Span, value: &'a Expr) {
        let before = self.diagnostics.len();
        let value_of = self.evaluate_for(Role::Objective, Context::OBJECTIVE, value);
        self.along_the_time(before, value);
        if let Some((place, _)) = &self.model.objective {
            let found = Diagnostic::new(
                Code::DuplicateName,
                "a second objective",
                keyword,
                "declared again",
            )
            .label(place.span, "the first one");
            self.diagnostics.push(found.help("add them up in one `minimize`, with weights"));
            return;
        }
        let word = if sense == Sense::Minimize { "minimize" } else { "maximize" };
        self.model.sense = if sense == Sense::Minimize { 1.0 } else { -1.0 };
        if let Some(part) = self.expect_number(&value_of, value.span) {
            self.model.objective = Some((Place { name: word.into(), span: value.span }, part));
        }
    }

    /// Where a control stands in an objective without `integral`, all of it is meant to be added
    /// up.
    fn along_the_time(&mut self, before: usize, value: &Expr) {
        let whole = text::expr(value);
        let has_times =
            ["integral(", "(end)", "(start)", "sum("].iter().any(|it| whole.contains(it));
        for found in self.diagnostics[before..].iter_mut().filter(|_| !has_times) {
            let is_meant = found.help.as_ref().is_some_and(|it| it.starts_with("write `integral("));
            if is_meant {
                found.help = Some(format!("write `integral({whole})`"));
            }
        }
    }

    fn report(&mut self, binding: &'a Binding) {
        let value = self.evaluate_for(Role::Report(&binding.name), Context::REPORT, &binding.value);
        let parts = value.parts.as_slice().to_vec();
        for (at, &part) in parts.iter().enumerate() {
            let name = self.component(&binding.name.name, &value, at);
            self.model.names.push((name.clone(), part));
            self.model
                .report
                .push(Report { place: Place { name, span: binding.name.span }, value: part });
        }
    }

    /// `name`, or `name.x` and `name[1]` for a component of a vector.
    pub fn component(&self, name: &str, value: &Value, at: usize) -> String {
        let size = value.parts.as_slice().len();
        let parts = value.named.map_or(&[][..], |named| scope::parts(self.item_named(named)));
        match parts.get(at) {
            _ if size < 2 => name.into(),
            Some(part) if parts.len() == size => format!("{name}.{}", part.name),
            _ => format!("{name}[{}]", at + 1),
        }
    }

    fn expectation(&mut self, check: &'a Check) {
        let sides = [&check.left, &check.right]
            .map(|side| self.evaluate_for(Role::Number("an expectation"), Context::EXPECT, side));
        let within = match &check.within {
            Some(within) => self.evaluate_number("a tolerance", Context::NUMBER, within),
            None => Some(self.graph.number(0.0)),
        };
        let [left, right] = [(&sides[0], check.left.span), (&sides[1], check.right.span)]
            .map(|(side, span)| self.expect_number(side, span));
        let values: Option<Vec<ExprId>> = [left, right, within].into_iter().collect();
        let comparison = match check.relation {
            Relation::Equal => Comparison::Equal,
            Relation::LessEqual => Comparison::LessEqual,
            Relation::GreaterEqual => Comparison::GreaterEqual,
        };
        let name = format!(
            "{} {} {}",
            text::expr(&check.left),
            text::relation(check.relation),
            text::expr(&check.right)
        );
        let values: Option<[ExprId; 3]> = values.and_then(|values| values.try_into().ok());
        let place = Place { name, span: check.span };
        self.model.expectations.extend(values.map(|values| Expectation {
            place,
            comparison,
            values,
        }));
    }

    /// A weight of the metric; a vector has it in all its components.
    fn weight(&mut self, name: &'a Ident, weight: &'a Expr) {
        let state = self.declared_as(name, "state", |kind| matches!(kind, ItemKind::State { .. }));
        let weight = self.evaluate_number("a weight", Context::NUMBER, weight);
        let (Some(at), Some(weight)) = (state, weight) else { return };
        if let Some(first) = self.index_of(at) {
            let size = self.values[at].parts.as_slice().len();
            self.model.metric.extend((first..first + size).map(|state| (state, weight)));
        }
    }
}
