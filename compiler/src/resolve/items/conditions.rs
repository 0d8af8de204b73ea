//! Conditions: `a <= b`, `a <= b <= c`, `abs(e) <= c`, componentwise for vectors.
//!
//! Each becomes rows `lower <= value <= upper`. A side that is a constant of the problem becomes
//! the bound, otherwise `left - right` is compared with 0. `abs(e) <= c` is read as `-c <= e <= c`:
//! no kink.

use crate::expressions::graph::ExprId;
use crate::model::{AtTime, Constraint, Place, Range};
use crate::resolve::elaborator::context::Context;
use crate::resolve::elaborator::value::{Traits, Value};
use crate::resolve::elaborator::{Elaborator, Role};
use crate::syntax::text;
use fdcc_grammar::ast::{Argument, Condition, Expr, ExprKind, Ident, Relation};
use fdcc_grammar::{Code, Diagnostic};

/// A side of a comparison.
type Side<'a> = (Value, &'a Expr);

impl<'a> Elaborator<'a> {
    /// A condition at all times.
    pub fn path(&mut self, name: Option<&'a Ident>, condition: &'a Condition) {
        let label = name.map_or_else(|| text::condition(condition), |name| name.name.clone());
        let place = Place { name: label, span: condition.span };
        let rows = self.condition(condition, Role::Path(name, condition), Context::PATH, place);
        self.model.path.extend(rows);
    }

    /// A condition at the start or the end.
    pub fn boundary(&mut self, condition: &'a Condition, at_end: bool) {
        let (word, role) = if at_end { ("end", "the end") } else { ("start", "the start") };
        let place =
            Place { name: format!("{word} {}", text::condition(condition)), span: condition.span };
        let rows = self.condition(condition, Role::Boundary(role), Context::BOUNDARY, place);
        self.at_end.extend(rows.iter().map(|_| at_end));
        self.model.boundary.extend(rows);
    }

    /// A condition at a time between the ends. In a text with phases there is none.
    pub fn at_time(&mut self, time: &'a Expr, condition: &'a Condition) {
        if !self.phases.is_empty() {
            return;
        }
        let known =
            self.evaluate_number("the time of a condition", Context::TIME_OF_CONDITION, time);
        let place = Place { name: text::at_time(time, condition), span: condition.span };
        let rows = self.condition(condition, Role::Boundary("a time"), Context::AT_A_TIME, place);
        let place = Place { name: text::expr(time), span: time.span };
        self.model.at_times.extend(known.map(|time| AtTime { place, time, rows }));
    }

    /// Moves all boundary rows to their ends, in one walk for each end.
    pub fn move_boundary(&mut self) {
        for end in [false, true] {
            let rows: Vec<usize> =
                (0..self.at_end.len()).filter(|&row| self.at_end[row] == end).collect();
            let values = rows.iter().map(|&row| self.model.boundary[row].value).collect();
            let moved = self.move_to_end(values, end);
            rows.into_iter()
                .zip(moved)
                .for_each(|(row, value)| self.model.boundary[row].value = value);
        }
    }

    fn condition(
        &mut self,
        condition: &'a Condition,
        role: Role<'a>,
        context: Context,
        place: Place,
    ) -> Vec<Constraint> {
        let mut rows = Vec::new();
        match &condition.rest[..] {
            [(relation, right)] => {
                let sides = self.sides([&condition.first, right], role, context);
                self.pair(sides, *relation, &place, &mut rows);
            }
            [(first, middle), (second, right)] => {
                let outer = self.sides([&condition.first, middle], role, context);
                let (middle_value, last) =
                    (outer[1].0.clone(), self.sides([middle, right], role, context)[1].clone());
                let [lower, middle_side] = outer;
                if first == second && Self::is_constant(&lower.0) && Self::is_constant(&last.0) {
                    let ends = if *first == Relation::GreaterEqual {
                        [last, lower]
                    } else {
                        [lower, last]
                    };
                    self.between(ends, middle_side, *first, &place, &mut rows);
                } else {
                    self.pair([lower, middle_side], *first, &place, &mut rows);
                    self.pair([(middle_value, middle), last], *second, &place, &mut rows);
                }
            }
            _ => {}
        }
        rows
    }

    /// Both sides with what they are made of.
    fn sides(&mut self, exprs: [&'a Expr; 2], role: Role<'a>, context: Context) -> [Side<'a>; 2] {
        exprs.map(|expr| (self.evaluate_for(role, context, expr), expr))
    }

    /// `a relation b` for each component.
    fn pair(
        &mut self,
        sides: [Side<'a>; 2],
        relation: Relation,
        place: &Place,
        rows: &mut Vec<Constraint>,
    ) {
        let [left, right] = if relation == Relation::GreaterEqual {
            [1, 0].map(|at| sides[at].clone())
        } else {
            sides
        };
        if relation != Relation::Equal
            && let Some(inner) = inside_abs(left.1)
        {
            return self.within(inner, left, right, place, rows);
        }
        let Some((a, b)) = self.same_size(&left, &right) else { return };
        let constant = [Self::is_constant(&left.0), Self::is_constant(&right.0)];
        for (at, (&a, &b)) in a.iter().zip(&b).enumerate() {
            let place = self.row_place(place, &left.0, &right.0, at);
            let (value, bound, is_upper) = match constant {
                [_, true] => (a, b, true),
                [true, _] => (b, a, false),
                _ => (self.graph.sub(a, b), self.graph.number(0.0), true),
            };
            let range = self.one_sided(bound, relation == Relation::Equal, is_upper);
            rows.push(Constraint { place, value, range });
        }
    }

    fn one_sided(&mut self, bound: ExprId, is_equal: bool, is_upper: bool) -> Range {
        let infinite = self.graph.number(if is_upper { f64::NEG_INFINITY } else { f64::INFINITY });
        match (is_equal, is_upper) {
            (true, _) => Range { lower: bound, upper: bound },
            (_, true) => Range { lower: infinite, upper: bound },
            _ => Range { lower: bound, upper: infinite },
        }
    }

    /// `lower <= value <= upper` with constants outside.
    fn between(
        &mut self,
        ends: [Side<'a>; 2],
        middle: Side<'a>,
        relation: Relation,
        place: &Place,
        rows: &mut Vec<Constraint>,
    ) {
        let [lower, upper] = ends;
        let Some((low, values)) = self.same_size(&lower, &middle) else { return };
        let Some((high, _)) = self.same_size(&upper, &middle) else { return };
        if relation == Relation::Equal {
            self.pair([middle.clone(), lower], relation, place, rows);
            return self.pair([middle, upper], relation, place, rows);
        }
        for (at, &value) in values.iter().enumerate() {
            let range = Range { lower: low[at], upper: high[at] };
            let place = self.row_place(place, &middle.0, &lower.0, at);
            rows.push(Constraint { place, value, range });
        }
    }

    /// `abs(e) <= c` as `-c <= e <= c`.
    fn within(
        &mut self,
        inner: &'a Expr,
        left: Side<'a>,
        right: Side<'a>,
        place: &Place,
        rows: &mut Vec<Constraint>,
    ) {
        let context = Context {
            allowed: left.0.traits.reads.or(self.here.context.allowed),
            ..Context::DEFINITION
        };
        let e = (self.evaluate_in(context, inner), inner);
        let Some((values, bounds)) = self.same_size(&e, &right) else { return };
        let is_constant = Self::is_constant(&right.0);
        for (at, (&value, &bound)) in values.iter().zip(&bounds).enumerate() {
            let place = self.row_place(place, &e.0, &right.0, at);
            let negative = self.graph.neg(bound);
            if is_constant {
                rows.push(Constraint {
                    place,
                    value,
                    range: Range { lower: negative, upper: bound },
                });
                continue;
            }
            let gaps = [self.graph.sub(value, bound), self.graph.add(value, bound)];
            let zero = self.graph.number(0.0);
            let ranges = [self.one_sided(zero, false, true), self.one_sided(zero, false, false)];
            rows.extend(gaps.into_iter().zip(ranges).map(|(value, range)| Constraint {
                place: place.clone(),
                value,
                range,
            }));
        }
    }

    /// The components of both sides; a number stands for all components.
    fn same_size(
        &mut self,
        left: &Side<'a>,
        right: &Side<'a>,
    ) -> Option<(Vec<ExprId>, Vec<ExprId>)> {
        let (a, b) = (left.0.parts.as_slice(), right.0.parts.as_slice());
        if a.is_empty() || b.is_empty() {
            return None;
        }
        // `pos == 0` speaks of all parts of `pos`; but one signal cannot equal several different
        // numbers.
        let is_lonely = |one: &Value, many: &Value| {
            one.parts.as_slice().len() == 1 && !Self::is_constant(one) && Self::is_constant(many)
        };
        let is_mixed_up = is_lonely(&left.0, &right.0) || is_lonely(&right.0, &left.0);
        if a.len() != b.len() && (is_mixed_up || a.len() != 1 && b.len() != 1) {
            let message =
                format!("comparing {} with {}", left.0.parts.describe(), right.0.parts.describe());
            let found =
                Diagnostic::new(Code::ShapeMismatch, message, left.1.span, left.0.parts.describe())
                    .label(right.1.span, right.0.parts.describe());
            self.diagnostics.push(
                found.help("both sides need the same size; a number is compared with each part"),
            );
            return None;
        }
        let size = a.len().max(b.len());
        let stretch =
            |parts: &[ExprId]| (0..size).map(|at| parts[at.min(parts.len() - 1)]).collect();
        Some((stretch(a), stretch(b)))
    }

    fn row_place(&self, place: &Place, left: &Value, right: &Value, at: usize) -> Place {
        let (longer, other) = if left.parts.as_slice().len() >= right.parts.as_slice().len() {
            (left, right)
        } else {
            (right, left)
        };
        let named = Value {
            parts: longer.parts.clone(),
            traits: Traits::default(),
            named: longer.named.or(other.named),
        };
        Place { name: self.component(&place.name, &named, at), span: place.span }
    }
}

/// `e` of `abs(e)`.
fn inside_abs(expr: &Expr) -> Option<&Expr> {
    let ExprKind::Call(callee, arguments) = &expr.kind else { return None };
    match (&callee.kind, &arguments[..]) {
        (ExprKind::Name(name), [Argument::Expr(inner)]) if name == "abs" => Some(inner),
        _ => None,
    }
}
