//! FDC0203: a `piecewise` that jumps, used as if it were an ordinary function.

use super::joints;
use crate::check::facts::view_of;
use crate::check::facts::{Facts, left_side};
use crate::resolve::elaborator::knots::{Knot, Site};
use crate::resolve::elaborator::value::KnotUse;
use crate::resolve::elaborator::{Elaborator, Role};
use crate::surfaces::Order;
use crate::syntax::scope::declared;
use crate::syntax::text::{self, Style};
use crate::syntax::walk;
use fdcc_grammar::ast::{Argument, BinaryOperator, Equation, Expr, ExprKind, ItemKind, Relation};
use fdcc_grammar::{Code, Diagnostic, Fix, Span};
use std::cell::LazyCell;

/// Reports jumps in everything that the problem is made of; reports and guesses may jump.
pub(crate) fn check(facts: &mut Facts<'_, '_>, found: &mut Vec<Diagnostic>) {
    let meaning = &facts.meaning;
    let view = LazyCell::new(|| view_of(meaning));
    let surface = LazyCell::new(|| new_name(facts));
    for usage in &meaning.usages {
        if matches!(usage.role, Role::Report(_) | Role::Number(_)) {
            continue;
        }
        for knot_use in &usage.traits.knots {
            let Some(site) = meaning.sites.get(&knot_use.site) else { continue };
            let jumps = |knot: &&Knot<'_>| {
                knot.order == 0 && joints::order(meaning, &view, usage, site, knot) == Order::Jumps
            };
            if let Some(knot) = site.knots.iter().find(jumps) {
                let item = facts
                    .items
                    .iter()
                    .map(|item| item.span)
                    .find(|span| holds(*span, knot_use.used));
                found.push(jump(meaning, site, knot, knot_use, &usage.role, item, *surface));
            }
        }
    }
}

fn jump(
    meaning: &Elaborator<'_>,
    site: &Site<'_>,
    knot: &Knot<'_>,
    place: &KnotUse,
    role: &Role<'_>,
    item: Option<Span>,
    surface: &str,
) -> Diagnostic {
    let name = owner(meaning, site).map_or("this `piecewise`".into(), |name| format!("`{name}`"));
    let size = text::number((knot.limits[1] - knot.limits[0]).abs());
    let message = format!(
        "{name} jumps by {size} at `{}`, but it is used as an ordinary function",
        knot_text(knot)
    );
    let [left, right] = knot.limits.map(text::number);
    let label = format!("left limit {left}, right limit {right}");
    let found = Diagnostic::new(Code::HiddenJump, message, knot.arm.guard_span, label);
    let found = match place.used == place.site {
        true => found,
        false => found.label(place.used, format!("used in {}", role.describe())),
    };
    let written = match role {
        Role::Equation(equation) => {
            rewritten(meaning, site, knot, place, equation).map(|it| (*equation, it))
        }
        _ => None,
    };
    let found = found.help(repair(surface, knot, written.as_ref()));
    match (written, item) {
        (Some((equation, written)), Some(item)) => {
            found.fix(as_switch(surface, equation, &written, item))
        }
        _ => found,
    }
}

/// A name for a surface that nothing has.
fn new_name(facts: &Facts<'_, '_>) -> &'static str {
    let outer = || facts.tree.items.iter().filter_map(declared);
    let is_new = |name: &&str| {
        facts.meaning.scope.find(name).is_none() && !outer().any(|it| it.name == **name)
    };
    ["boost", "switch", "switching"].into_iter().find(is_new).unwrap_or("switch_")
}

fn holds(item: Span, place: Span) -> bool {
    item.start <= place.start && place.end <= item.end
}

/// `v == 10`.
pub(super) fn knot_text(knot: &Knot<'_>) -> String {
    format!("{} == {}", text::expr(&knot.arm.left), text::expr(&knot.arm.right))
}

/// The name of the definition that holds the pieces.
pub(super) fn owner<'a>(meaning: &Elaborator<'a>, site: &Site<'_>) -> Option<&'a str> {
    site.owner.map(|at| meaning.scope.declarations[at].name.name.as_str())
}

/// A surface and the right sides below and above it.
type Switch = (String, [String; 2]);

/// The same with a surface, written out where that is simple.
fn repair(surface: &str, knot: &Knot<'_>, written: Option<&(&Equation, Switch)>) -> String {
    let head = "declare the switch so that fdcc can treat it:";
    match written {
        Some((equation, (psi, [below, above]))) => {
            let left = left_side(equation);
            format!(
                "{head}\n  surface {surface} = {psi}\n  {left} in match {surface} {{ below => \
                 {below}, above => {above} }}"
            )
        }
        None => {
            let psi = difference(&knot.arm.left, &knot.arm.right);
            format!(
                "{head}\n  surface {surface} = {psi}\nand choose the side with `match {surface} {{ \
                 below => ..., above => ... }}`"
            )
        }
    }
}

/// The surface before the item of the equation, and the match in the place of its right side.
fn as_switch(
    surface: &str,
    equation: &Equation,
    (psi, [below, above]): &Switch,
    item: Span,
) -> Fix {
    let right = Span { start: equation.relation_span.start, end: equation.right.span.end };
    let choice = format!("in match {surface} {{ below => {below}, above => {above} }}");
    let fix = Fix::likely(format!("declare the surface `{surface}`"));
    fix.insert(item.start, format!("surface {surface} = {psi}\n")).replace(right, choice)
}

/// Longer right sides are not written out, in nodes.
const LONGEST_REPAIR: usize = 100;

/// Surface and right sides for a definition of two pieces that is called once in an equation.
fn rewritten(
    meaning: &Elaborator<'_>,
    site: &Site<'_>,
    knot: &Knot<'_>,
    place: &KnotUse,
    equation: &Equation,
) -> Option<Switch> {
    let ExprKind::Piecewise { arms, otherwise } = &site.expr.kind else { return None };
    let [arm] = &arms[..] else { return None };
    let mut size = 0;
    walk::visit(&equation.right, &mut |_| size += 1);
    if size > LONGEST_REPAIR {
        return None;
    }
    let actual = arguments(meaning, site, &equation.right, place.used)?;
    let psi = difference(&replace(&arm.left, &actual), &replace(&arm.right, &actual));
    let sides = [&arm.value, &**otherwise].map(|value| {
        let value = replace(value, &actual);
        let right =
            substitute(&equation.right, &|expr| (expr.span == place.used).then(|| value.clone()));
        text::styled(&without_ones(right), Style::Compact)
    });
    let [first, second] = sides;
    let ordered =
        if knot.arm.relation == Relation::LessEqual { [first, second] } else { [second, first] };
    Some((psi, ordered))
}

/// The arguments of the function that holds the pieces, by name, at its call.
fn arguments<'e>(
    meaning: &Elaborator<'e>,
    site: &Site<'_>,
    right: &'e Expr,
    used: Span,
) -> Option<Vec<(&'e str, &'e Expr)>> {
    let Some(owner) = site.owner else { return Some(Vec::new()) };
    let ItemKind::Fn { arguments: formal, body, .. } = &meaning.scope.declarations[owner].item.kind
    else {
        return None;
    };
    let mut call = None;
    walk::visit(right, &mut |expr| {
        if expr.span == used {
            call = Some(expr);
        }
    });
    let ExprKind::Call(_, given) = &call?.kind else { return None };
    let given = given.iter().map(|it| match it {
        Argument::Expr(value) => Some(value),
        _ => None,
    });
    let given: Option<Vec<&Expr>> = given.collect();
    let fits = body.span == site.expr.span && given.as_ref()?.len() == formal.len();
    fits.then(|| {
        formal.iter().map(|name| name.name.as_str()).zip(given.into_iter().flatten()).collect()
    })
}

fn replace(expr: &Expr, actual: &[(&str, &Expr)]) -> Expr {
    substitute(expr, &|inner| match &inner.kind {
        ExprKind::Name(name) => {
            actual.iter().find(|pair| pair.0 == name).map(|pair| pair.1.clone())
        }
        _ => None,
    })
}

/// A copy in which some nodes are replaced; nodes of other kinds than arithmetic are kept whole.
fn substitute(expr: &Expr, new: &dyn Fn(&Expr) -> Option<Expr>) -> Expr {
    if let Some(replacement) = new(expr) {
        return replacement;
    }
    let kind = match &expr.kind {
        ExprKind::Negate(inner) => ExprKind::Negate(Box::new(substitute(inner, new))),
        ExprKind::Binary(operator, left, right) => ExprKind::Binary(
            *operator,
            Box::new(substitute(left, new)),
            Box::new(substitute(right, new)),
        ),
        ExprKind::Part(base, part) => ExprKind::Part(Box::new(substitute(base, new)), part.clone()),
        ExprKind::Index(base, index) => ExprKind::Index(Box::new(substitute(base, new)), *index),
        ExprKind::Tuple(parts) => {
            ExprKind::Tuple(parts.iter().map(|part| substitute(part, new)).collect())
        }
        ExprKind::Call(callee, arguments) => {
            let arguments = arguments.iter().map(|argument| match argument {
                Argument::Expr(value) => Argument::Expr(substitute(value, new)),
                other => other.clone(),
            });
            ExprKind::Call(callee.clone(), arguments.collect())
        }
        other => other.clone(),
    };
    Expr { kind, span: expr.span }
}

/// `1 * u` as `u`.
fn without_ones(expr: Expr) -> Expr {
    let ExprKind::Binary(operator, left, right) = expr.kind else { return expr };
    let (left, right) = (without_ones(*left), without_ones(*right));
    let is_one = |side: &Expr| side.kind == ExprKind::Number(1.0);
    match operator {
        BinaryOperator::Multiply if is_one(&left) => right,
        BinaryOperator::Multiply | BinaryOperator::Divide if is_one(&right) => left,
        _ => Expr {
            kind: ExprKind::Binary(operator, Box::new(left), Box::new(right)),
            span: expr.span,
        },
    }
}

/// `v - 10`; `v` alone against 0.
fn difference(left: &Expr, right: &Expr) -> String {
    if right.kind == ExprKind::Number(0.0) {
        return text::styled(left, Style::Compact);
    }
    let operands = (Box::new(left.clone()), Box::new(right.clone()));
    let kind = ExprKind::Binary(BinaryOperator::Subtract, operands.0, operands.1);
    text::styled(&Expr { kind, span: left.span }, Style::Compact)
}
