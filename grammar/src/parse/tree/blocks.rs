//! The smaller parts of items: names, units, intervals, conditions, and the entries of blocks.

use pest::iterators::Pair;

use super::Reader;
use super::expressions::relation;
use crate::ast::*;
use crate::parse::grammar::Rule;
use crate::{Code, Diagnostic, Span};

/// The first pair of a rule directly below a pair.
pub(super) fn child<'p>(pair: &Pair<'p, Rule>, rule: Rule) -> Option<Pair<'p, Rule>> {
    pair.clone().into_inner().find(|inner| inner.as_rule() == rule)
}

/// All pairs of a rule directly below a pair.
pub(super) fn children<'p>(
    pair: &Pair<'p, Rule>,
    rule: Rule,
) -> impl Iterator<Item = Pair<'p, Rule>> {
    pair.clone().into_inner().filter(move |inner| inner.as_rule() == rule)
}

/// The first name directly below a pair, also if it is a reserved word behind a dot.
pub(super) fn ident(reader: &Reader<'_>, pair: &Pair<'_, Rule>) -> Ident {
    let dotted = || child(pair, Rule::dotted).and_then(|it| child(&it, Rule::word));
    let found = child(pair, Rule::name).or_else(|| child(pair, Rule::word)).or_else(dotted);
    reader.name(&found.expect("the grammar has a name here"))
}

impl Reader<'_> {
    /// The names in `(a, b)`, if there are any.
    pub(super) fn names(&self, pair: &Pair<'_, Rule>) -> Vec<Ident> {
        child(pair, Rule::names).map_or(Vec::new(), |names| self.all_names(&names))
    }

    /// All names directly below a pair.
    pub(super) fn all_names(&self, pair: &Pair<'_, Rule>) -> Vec<Ident> {
        children(pair, Rule::name).map(|name| self.name(&name)).collect()
    }

    /// The unit directly below a pair, if there is one.
    pub(super) fn unit(&self, pair: &Pair<'_, Rule>) -> Option<Unit> {
        let unit = child(pair, Rule::unit)?;
        let mut factors = Vec::new();
        let mut sign = 1;
        for inner in unit.clone().into_inner() {
            match inner.as_rule() {
                Rule::unit_operator => sign = if inner.as_str() == "/" { -1 } else { 1 },
                Rule::unit_factor => {
                    factors.extend(self.unit_factor(&inner, sign));
                    sign = 1;
                }
                _ => {}
            }
        }
        Some(Unit { factors, span: self.span(&unit) })
    }

    /// `m^2`; nothing for `1`.
    fn unit_factor(&self, pair: &Pair<'_, Rule>, sign: i32) -> Option<(Ident, i32)> {
        let name = self.name(&child(pair, Rule::unit_name)?);
        // A power too large to be read is one that no unit has.
        let power = child(pair, Rule::exponent)
            .map_or(1, |power| power.as_str().parse().unwrap_or(i16::MAX));
        Some((name, sign * i32::from(power)))
    }

    /// `[a, b]` directly below a pair, if there is one.
    pub(super) fn interval(&mut self, pair: &Pair<'_, Rule>) -> Option<Interval> {
        let interval = child(pair, Rule::interval)?;
        let [lower, upper] = self.two(&interval);
        Some(Interval { lower, upper, span: self.span(&interval) })
    }

    /// The two expressions of a pair.
    fn two(&mut self, pair: &Pair<'_, Rule>) -> [Expr; 2] {
        self.expressions_in(pair).try_into().expect("the grammar has two expressions here")
    }

    /// The one expression of a pair.
    pub(super) fn one(&mut self, pair: &Pair<'_, Rule>) -> Expr {
        self.expression_in(pair).expect("the grammar has an expression here")
    }

    /// The condition of a `start`, `end`, `at` or `path` item.
    pub(super) fn condition(&mut self, item: &Pair<'_, Rule>) -> Condition {
        let pair = child(item, Rule::condition).expect("the item has a condition");
        let relations: Vec<Relation> =
            children(&pair, Rule::relation).map(|sign| relation(sign.as_str())).collect();
        let mut sides = self.expressions_in(&pair).into_iter();
        let first = sides.next().expect("a condition has a left side");
        if let [one, other] = relations[..]
            && one != other
        {
            self.report(crossed_chain(self.span(&pair)));
        }
        Condition {
            first,
            rest: relations.into_iter().zip(sides).collect(),
            span: self.span(&pair),
        }
    }

    /// The equations of a `dynamics` block.
    pub(super) fn equations(&mut self, block: &Pair<'_, Rule>) -> Vec<Equation> {
        children(block, Rule::equation).map(|pair| self.equation(&pair)).collect()
    }

    pub(super) fn equation(&mut self, pair: &Pair<'_, Rule>) -> Equation {
        let becomes = child(pair, Rule::becomes).expect("an equation has `=` or `in`");
        let is_in = becomes.as_str() == "in";
        Equation {
            factor: child(pair, Rule::factor).map(|factor| self.expression(factor)),
            state: ident(
                self,
                &child(pair, Rule::derivative).expect("an equation has a derivative"),
            ),
            relation: if is_in { EquationRelation::In } else { EquationRelation::Equal },
            relation_span: self.span(&becomes),
            right: self.one(pair),
            span: self.span(pair),
        }
    }

    /// The assignments of a `jump` or `link`.
    pub(super) fn assignments(&mut self, block: &Pair<'_, Rule>) -> Vec<Assignment> {
        let read = |pair| Assignment {
            name: ident(self, &pair),
            part: child(&pair, Rule::part).map(|part| ident(self, &part)),
            value: self.one(&pair),
        };
        children(block, Rule::assignment).map(read).collect()
    }

    /// The bindings of a `guess` or `report`.
    pub(super) fn bindings(&mut self, block: &Pair<'_, Rule>) -> Vec<Binding> {
        let read = |pair| Binding { name: ident(self, &pair), value: self.one(&pair) };
        children(block, Rule::binding).map(read).collect()
    }

    /// The lists of a `sweep` block.
    pub(super) fn swept(&mut self, block: &Pair<'_, Rule>) -> Vec<Swept> {
        let read = |pair| Swept { name: ident(self, &pair), values: self.expressions_in(&pair) };
        children(block, Rule::swept).map(read).collect()
    }

    /// The checks of an `expect` block.
    pub(super) fn checks(&mut self, block: &Pair<'_, Rule>) -> Vec<Check> {
        children(block, Rule::check).map(|pair| self.check(&pair)).collect()
    }

    fn check(&mut self, pair: &Pair<'_, Rule>) -> Check {
        let sign = child(pair, Rule::relation).expect("a check has a comparison");
        let [left, right] = self.two(pair);
        let within = child(pair, Rule::within).map(|within| self.one(&within));
        Check { left, relation: relation(sign.as_str()), right, within, span: self.span(pair) }
    }

    /// The settings of a `method` block; `smooth` and `grid` lines fall into their parts.
    pub(super) fn settings(&mut self, block: &Pair<'_, Rule>) -> Vec<Setting> {
        block.clone().into_inner().filter_map(|pair| self.setting(&pair)).collect()
    }

    fn setting(&mut self, pair: &Pair<'_, Rule>) -> Option<Setting> {
        let keyword = || pair.clone().into_inner().next().map(|keyword| self.name(&keyword));
        let (key, value) = match pair.as_rule() {
            Rule::entry => (ident(self, pair), self.entry_value(pair)),
            Rule::kernel => (keyword()?, SettingValue::Expr(self.word(pair))),
            Rule::steps => (keyword()?, SettingValue::Expr(self.one(pair))),
            Rule::scheme => (keyword()?, self.scheme(pair)),
            Rule::continuation => (keyword()?, SettingValue::List(self.expressions_in(pair))),
            _ => return None,
        };
        Some(Setting { key, value, unit: self.unit(pair) })
    }

    /// `scheme = euler` means `scheme euler`.
    fn entry_value(&mut self, pair: &Pair<'_, Rule>) -> SettingValue {
        let value = self.one(pair);
        match value.kind {
            ExprKind::Name(name) if ident(self, pair).name == "scheme" => {
                SettingValue::Scheme { name: Ident { name, span: value.span }, lagged: Vec::new() }
            }
            _ => SettingValue::Expr(value),
        }
    }

    fn scheme(&self, pair: &Pair<'_, Rule>) -> SettingValue {
        let lagged = child(pair, Rule::lagged).map_or(Vec::new(), |lagged| self.names(&lagged));
        SettingValue::Scheme { name: ident(self, pair), lagged }
    }

    fn word(&self, pair: &Pair<'_, Rule>) -> Expr {
        let Ident { name, span } = ident(self, pair);
        Expr { kind: ExprKind::Name(name), span }
    }
}

/// FDC0109: `1 <= x >= 0` is no range.
fn crossed_chain(span: Span) -> Diagnostic {
    let message = "the two comparisons of a condition point different ways";
    let found = Diagnostic::new(Code::NotAllowedHere, message, span, "not a range");
    found.help("write `a <= x <= b`, or two conditions")
}
