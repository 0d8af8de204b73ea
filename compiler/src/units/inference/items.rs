//! What the items demand of units: equations, conditions, resets, links, settings and the rest.

use super::requirement::Reason;
use super::value::{Part, Value, pairwise};
use super::{Inference, Operand, named, side};
use crate::syntax::outer::Outer;
use crate::syntax::scope::{Declaration, Scope, parts};
use fdcc_grammar::Span;
use fdcc_grammar::ast::{
    self, Assignment, Check, Condition, Equation, Expr, ExprKind, Ident, Item, ItemKind, Setting,
    SettingValue, Swept, Unit,
};

impl<'a> Inference<'a> {
    /// The whole text: the phases, and what stands outside of them.
    pub fn model(&mut self, tree: &'a ast::Model) {
        let outer: Vec<&'a Item> = tree.items.iter().collect();
        self.enter(Scope::new(&outer, &mut Vec::new()));
        let around = Outer::new(&tree.items);
        for item in &tree.items {
            let ItemKind::Phase { name, items, .. } = &item.kind else { continue };
            let inner: Vec<&'a Item> = items.iter().collect();
            let seen = around.seen_by(name, items);
            let all: Vec<&'a Item> = seen.iter().chain(&inner).copied().collect();
            self.enter(Scope::new(&all, &mut Vec::new()));
            self.items(&inner);
            let scope = std::mem::take(&mut self.scope);
            self.phases.insert(&name.name, scope);
        }
        if !self.phases.is_empty() {
            self.enter(Scope::new(&outer, &mut Vec::new()));
        }
        self.items(&outer);
    }

    /// Everything that is not a declaration: first what a unit is most surely found from, settings
    /// last, when all that switches is known.
    pub fn items(&mut self, items: &[&'a Item]) {
        let mut sorted: Vec<&'a Item> = items.to_vec();
        sorted.sort_by_key(|item| authority(&item.kind));
        sorted.into_iter().for_each(|item| self.item(item));
    }

    fn item(&mut self, item: &'a Item) {
        match &item.kind {
            ItemKind::Dynamics { equations } => equations.iter().for_each(|it| self.equation(it)),
            ItemKind::Start { condition }
            | ItemKind::End { condition }
            | ItemKind::Path { condition, .. } => {
                self.condition(condition);
            }
            ItemKind::At { time, condition } => {
                self.at(time);
                self.condition(condition);
            }
            ItemKind::Objective { keyword, value, .. } => {
                let value = self.evaluate(value);
                self.values.insert(*keyword, value);
            }
            ItemKind::Fit { data, signals, .. } => {
                self.times_of_rows(data);
                signals.iter().for_each(|it| self.fitted(data, it))
            }
            ItemKind::Guess { bindings } => {
                bindings.iter().for_each(|it| self.guess(&it.name, &it.value))
            }
            ItemKind::Report { bindings } => bindings.iter().for_each(|it| {
                let value = self.evaluate(&it.value);
                self.values.insert(it.name.span, value);
            }),
            ItemKind::Plot { curves, over, .. } => {
                curves.iter().chain([over]).for_each(|it| {
                    let value = self.evaluate(it);
                    self.values.insert(it.span, value);
                });
            }
            ItemKind::Expect { checks } => checks.iter().for_each(|it| self.check(it)),
            ItemKind::Metric { weights } => self.metric(weights),
            ItemKind::Jump { at_most, assignments, .. } => {
                at_most.iter().for_each(|number| self.plain("at most", number));
                assignments.iter().for_each(|it| self.reset(it))
            }
            ItemKind::Link { from, to, assignments, .. } => {
                assignments.iter().for_each(|it| self.handed_over(from, to, it))
            }
            ItemKind::Method { settings } => settings.iter().for_each(|it| self.setting(it)),
            ItemKind::Sweep { lists } => lists.iter().for_each(|it| self.swept(it)),
            _ => {}
        }
    }

    /// `m * x' = e`: both sides in the unit of `m x / t`.
    fn equation(&mut self, equation: &'a Equation) {
        let right = self.operand(&equation.right);
        let factor = equation.factor.as_ref().map(|factor| self.evaluate(factor));
        let is_state = |it: &Declaration<'a>| matches!(it.item.kind, ItemKind::State { .. });
        let Some(state) = self.declared(&equation.state).filter(is_state) else { return };
        let rate = pairwise(&self.subject(state).0, &self.time(), Part::over);
        let left = match factor {
            Some(factor) => pairwise(&factor, &rate, Part::times),
            None => rate,
        };
        // The prime stands behind the name.
        let end = (equation.state.span.end + 1).min(equation.relation_span.start);
        let span = Span { start: equation.span.start, end };
        self.equal(Reason::Equation(&equation.state), &(left, named(span)), &right);
    }

    pub fn declared(&self, name: &Ident) -> Option<Declaration<'a>> {
        self.scope.find(&name.name).map(|at| self.scope.declarations[at])
    }

    fn condition(&mut self, condition: &'a Condition) {
        let mut left = self.operand(&condition.first);
        let mut compared = left.0.clone();
        for (_, next) in &condition.rest {
            let right = self.operand(next);
            self.compare(Reason::Comparison, &left, &right);
            if compared.iter().all(|part| part.plain) {
                compared = right.0.clone();
            }
            left = right;
        }
        self.values.insert(condition.span, compared);
    }

    /// The time of a condition measures what time does.
    fn at(&mut self, time: &'a Expr) {
        let is_time = |it: &&Declaration<'a>| matches!(it.item.kind, ItemKind::Time { .. });
        let Some(declared) = self.scope.declarations.iter().find(is_time).copied() else { return };
        let subject = (self.subject(declared).0, named(declared.name.span));
        self.value_for("the time of a condition", declared.name, &subject, time);
    }

    fn check(&mut self, check: &'a Check) {
        let (left, right) = (self.operand(&check.left), self.operand(&check.right));
        self.compare(Reason::Comparison, &left, &right);
        let is_number = left.0.iter().all(|part| part.plain);
        self.values.insert(check.span, if is_number { right.0.clone() } else { left.0.clone() });
        if let Some(within) = &check.within {
            let within = self.operand(within);
            // The tolerance is one of the side that has a unit.
            self.compare(Reason::Comparison, if is_number { &right } else { &left }, &within);
        }
    }

    /// A value for a name in a block.
    fn assigned_value(&mut self, what: &'static str, name: &'a Ident, given: Operand<'a>) {
        if let Some(it) = self.declared(name) {
            let subject = (self.subject(it).0, named(name.span));
            self.compare(Reason::Given(what, name), &subject, &given);
        }
    }

    fn guess(&mut self, name: &'a Ident, curve: &'a Expr) {
        let (value, text) = self.operand(curve);
        let Some(it) = self.declared(name) else { return };
        let subject = (self.subject(it).0, named(name.span));
        self.read_curve(&(value.clone(), text.clone()), &subject);
        let value = if value.iter().all(|it| it.plain) {
            value
        } else {
            self.stretched(&value, &subject.0)
        };
        self.compare(Reason::Given("the guess", name), &subject, &(value, text));
    }

    fn reset(&mut self, reset: &'a Assignment) {
        let given = self.operand(&reset.value);
        if let Some(it) = self.declared(&reset.name) {
            let subject = (self.assigned_to(it, reset), named(reset.name.span));
            self.compare(Reason::Given("the new value", &reset.name), &subject, &given);
        }
    }

    /// What the left side of an assignment measures.
    fn assigned_to(&mut self, it: Declaration<'a>, assignment: &Assignment) -> Value {
        let whole = self.subject(it).0;
        let Some(part) = &assignment.part else { return whole };
        let at = parts(it.item).iter().position(|name| name.name == part.name);
        at.and_then(|at| whole.get(at).or(whole.first()).cloned()).into_iter().collect()
    }

    /// A link reads its right side in the phase before it, and gives it to a state of the phase
    /// after it.
    fn handed_over(&mut self, from: &Ident, to: &Ident, assignment: &'a Assignment) {
        let target = self.phases.get(to.name.as_str());
        let target =
            target.and_then(|scope| Some(scope.declarations[scope.find(&assignment.name.name)?]));
        let Some(source) = self.phases.remove(from.name.as_str()) else { return };
        let outer: Scope<'a> = std::mem::replace(&mut self.scope, source);
        let given = self.operand(&assignment.value);
        if let Some(target) = target {
            let subject = (self.assigned_to(target, assignment), named(assignment.name.span));
            self.compare(Reason::Given("the new value", &assignment.name), &subject, &given);
        }
        let source = std::mem::replace(&mut self.scope, outer);
        let name = self.phase_name(from);
        self.phases.extend(name.map(|name| (name, source)));
    }

    fn phase_name(&self, name: &Ident) -> Option<&'a str> {
        self.declared(name).map(|it| it.name.name.as_str())
    }

    /// Weights make squares of states comparable: `w_1 x_1^2 + w_2 x_2^2 + ...`.
    fn metric(&mut self, weights: &'a [(Ident, Expr)]) {
        let mut first: Option<Operand<'a>> = None;
        for (name, weight) in weights {
            let value = self.evaluate(weight);
            let Some(state) = self.declared(name).map(|it| self.subject(it).0) else { continue };
            if value.iter().any(|part| part.plain) {
                continue;
            }
            let squares = pairwise(&state, &state, Part::times);
            let term = (pairwise(&value, &squares, Part::times), side(weight));
            let one = first.get_or_insert_with(|| term.clone()).clone();
            self.equal(Reason::Together("metric"), &one, &term);
        }
    }

    /// `smooth sigma = 5 [m/s]` is a width of what switches; a plain number is one of every
    /// surface.
    fn setting(&mut self, setting: &'a Setting) {
        let widths: Vec<&'a Expr> = match &setting.value {
            SettingValue::Expr(value) => vec![value],
            SettingValue::List(values) => values.iter().collect(),
            SettingValue::Scheme { .. } => return,
        };
        if !matches!(setting.key.name.as_str(), "sigma" | "continue") {
            // A unit that is written there is told where settings are read.
            let is_told = |value: &&Expr| matches!(value.kind, ExprKind::Quantity(..));
            let others = widths.into_iter().filter(|it| !is_told(it));
            return others.for_each(|value| self.plain(&setting.key.name, value));
        }
        let unit = setting.unit.as_ref().or_else(|| widths.last().and_then(|last| quantity(last)));
        for width in widths {
            let given = self.listed(width, unit);
            self.width(&setting.key, given);
        }
    }

    /// `sigma = 10, 5 [cm/s]` is a list of widths; any other list is one of values for what it
    /// names.
    fn swept(&mut self, list: &'a Swept) {
        let unit = list.values.last().and_then(quantity);
        let name = &list.name;
        let declared = self.declared(name);
        // A parameter that is given as a plain number has no unit, wherever it is read.
        let is_plain = |it| self.subject(it).0.iter().all(|part| part.plain);
        let has_none = declared.map_or(name.name != "sigma", is_plain);
        for value in &list.values {
            if has_none {
                self.plain(&name.name, value);
                continue;
            }
            let given = self.listed(value, unit);
            match declared {
                None => self.width(name, given),
                Some(_) => self.assigned_value("a value of the sweep", name, given),
            }
        }
    }

    /// A number of things, a setting, or a parameter that has no unit.
    fn plain(&mut self, what: &'a str, value: &'a Expr) {
        // A word of the method, such as `auto`, is no name.
        let is_word =
            matches!(&value.kind, ExprKind::Name(name) if self.scope.find(name).is_none());
        if !is_word {
            let given = self.operand(value);
            self.need_none(Reason::Plain(what), value.span, &given);
        }
    }

    /// A value of a list; a plain number has the unit that stands behind the last one.
    fn listed(&mut self, value: &'a Expr, unit: Option<&'a Unit>) -> Operand<'a> {
        let given = self.operand(value);
        let is_number = !given.0.is_empty() && given.0.iter().all(|part| part.plain);
        let Some(unit) = unit.filter(|_| is_number) else { return given };
        self.take(value.span, crate::units::dimension::table::scale(unit, &mut Vec::new()));
        (vec![super::expression::written(unit)], given.1)
    }

    fn width(&mut self, key: &'a Ident, width: Operand<'a>) {
        let surfaces = (self.of_a_width(), named(key.span));
        if !surfaces.0.is_empty() {
            self.compare(Reason::Given("the width", key), &surfaces, &width);
        }
    }

    /// What a width of smoothing measures; nothing where there is no surface. Where surfaces
    /// differ, one number cannot have the unit of all, and goes with everything.
    pub fn of_a_width(&self) -> Value {
        let sum = |one: Part, other: &Part| {
            let declared = one.declared.sum(&other.declared);
            let dimension = one.dimension.filter(|it| other.dimension.as_ref() == Some(it));
            Part { dimension, declared, ..Part::ANY }
        };
        let parts = self.switches.iter().filter(|it| it.dimension.is_some());
        let mut parts = parts.map(|it| Part { plain: false, ..it.clone() });
        parts.next().map(|first| parts.fold(first, |one, it| sum(one, &it))).into_iter().collect()
    }
}

/// The unit of a quantity by itself, perhaps negative.
fn quantity(expr: &Expr) -> Option<&Unit> {
    match &expr.kind {
        ExprKind::Quantity(_, unit) => Some(unit),
        ExprKind::Negate(inner) => quantity(inner),
        _ => None,
    }
}

/// Equations are right more often than the lines that were written to look at the result.
fn authority(kind: &ItemKind) -> u8 {
    match kind {
        ItemKind::Dynamics { .. } => 0,
        ItemKind::Start { .. }
        | ItemKind::End { .. }
        | ItemKind::At { .. }
        | ItemKind::Path { .. }
        | ItemKind::Jump { .. } => 1,
        ItemKind::Method { .. } | ItemKind::Sweep { .. } => 4,
        ItemKind::Guess { .. }
        | ItemKind::Report { .. }
        | ItemKind::Plot { .. }
        | ItemKind::Expect { .. } => 3,
        _ => 2,
    }
}
