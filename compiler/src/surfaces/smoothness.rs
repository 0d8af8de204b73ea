//! How smooth an expression is: the largest k for which it is C^k, and the places where that ends.
//!
//! ```text
//! e = P for g <= 0, Q for g >= 0:     e is C^k across g = 0  if and only if  Q - P and its
//!                                     derivatives to the k-th vanish there
//! e = P + Q sqrt(a):                  e is C^m at a = 0, where Q vanishes to the m-th order
//! ```
//!
//! What is said is proved, or is what the single functions promise. Both are decided for the whole
//! expression, so `x*abs(x)` is C^1 and `max(x, 0)^3` is C^2. Knots that the bounds keep out of
//! reach do not count. Where no point of `g = 0` is found, what the single function promises is
//! what is said.

use super::local::Local;
use super::on_side::on_side;
use super::roots::{at_power, at_root};
use super::sample;
use super::view::View;
use crate::expressions::graph::builtins::Builtin;
use crate::expressions::graph::derivative::derivative;
use crate::expressions::graph::{Expr, ExprId, evaluate};
use crate::expressions::interval::{Claim, Prover};
use crate::expressions::polynomial::Polynomial;
use crate::model::numbers::Numbers;
use crate::model::{Model, Symbol};
use std::collections::BTreeMap;

/// How often an expression can be differentiated continuously.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Order {
    /// It jumps.
    Jumps,
    /// So many times.
    Times(u32),
    /// As often as one likes.
    Always,
}

/// Derivatives beyond this are not looked at: what is that smooth is called so.
pub(super) const HIGHEST: u32 = 4;
/// Points of a knot that are looked at, and how far its sides are from it.
const MOST_POINTS: usize = 6;
const NUDGE: f64 = 1e-6;

impl std::fmt::Display for Order {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Order::Jumps => f.write_str("jumps"),
            Order::Times(HIGHEST) => write!(f, "C^{HIGHEST} or smoother"),
            Order::Times(times) => write!(f, "C^{times}"),
            Order::Always => f.write_str("C^infinity"),
        }
    }
}

/// The smoothness of something that has a name.
#[derive(Clone, Debug)]
pub struct Smoothness {
    /// A definition, a report, an equation, a constraint, a surface or the objective.
    pub name: String,
    /// How smooth it is, apart from the selectors of surfaces.
    pub order: Order,
    /// Where that ends: `x == 1`.
    pub knots: Vec<String>,
}

/// Of everything that has a name in a model, with its parameters at their values.
pub(crate) fn smoothness(model: &Model, numbers: &Numbers) -> Vec<Smoothness> {
    let view = View::of_model(model, numbers);
    let named = model.names.iter().map(|(name, id)| (name.as_str(), *id));
    let surfaces = model.surfaces.iter().map(|it| (it.place.name.as_str(), it.psi));
    let equations = model.states.iter().map(|it| (it.equation.name.as_str(), it.rate));
    let path = model.path.iter().map(|it| (it.place.name.as_str(), it.value));
    let objective = model.objective.iter().map(|it| (it.0.name.as_str(), it.1));
    let all = named.chain(surfaces).chain(equations).chain(path).chain(objective);
    all.map(|(name, id)| of_expression(&view, name, id)).collect()
}

/// How smooth expressions are where guards change, as far as a place within the bounds shows it.
pub(crate) fn at_guards(view: &View<'_>, exprs: &[ExprId], guards: &[[ExprId; 2]]) -> Order {
    let mut local = Local::empty();
    let gap = |[smaller, larger]: &[ExprId; 2]| {
        let [smaller, larger] = [*smaller, *larger].map(|side| local.import(view, side));
        local.graph.sub(smaller, larger)
    };
    let gaps: Vec<ExprId> = guards.iter().map(gap).collect();
    let roots: Vec<ExprId> = exprs.iter().map(|expr| local.import(view, *expr)).collect();
    gaps.into_iter().map(|gap| at_places(&mut local, &roots, gap)).min().unwrap_or(Order::Always)
}

fn at_places(local: &mut Local, roots: &[ExprId], gap: ExprId) -> Order {
    let mut worst = Order::Always;
    if !varies(local, gap) || !may_vanish(local, gap) {
        return worst;
    }
    let mut points = sample::zeros(local, gap);
    points.truncate(MOST_POINTS);
    for (point, input) in points.iter().zip(steepest(local, gap, &points)) {
        for root in roots {
            let sides = sides(local, *root, point, input);
            worst = worst.min(first_difference(local, sides, point, input));
        }
    }
    worst
}

/// Whether an expression depends on more than parameters.
fn varies(local: &Local, expr: ExprId) -> bool {
    !varying(local, expr).is_empty()
}

/// Of one expression, under a name.
pub(crate) fn of_expression(view: &View<'_>, name: &str, id: ExprId) -> Smoothness {
    let mut local = Local::empty();
    let root = local.import(view, id);
    let mut found = knots(&mut local, root);
    found.sort_by_key(|knot| knot.0);
    let order = found.first().map_or(Order::Always, |knot| knot.0);
    let worst: Vec<Polynomial> =
        found.into_iter().filter(|knot| knot.0 == order).map(|knot| knot.1).collect();
    let mut knots: Vec<String> =
        worst.iter().map(|zero| equation(&mut local, view, zero)).collect();
    knots.sort();
    knots.dedup();
    Smoothness { name: name.into(), order, knots }
}

/// `x == 1` for `x - 1`.
fn equation(local: &mut Local, view: &View<'_>, zero: &Polynomial) -> String {
    let side = |sign: f64| {
        let terms = zero.terms.iter().filter(|it| it.1.signum() == sign);
        Polynomial { terms: terms.map(|(it, factor)| (it.clone(), factor.abs())).collect() }
    };
    let [left, right] = [side(1.0), side(-1.0)].map(|form| {
        let expr = form.to_expr(&mut local.graph);
        local.text(view, expr).unwrap_or_else(|| "...".into())
    });
    if left == "0" { format!("{right} == 0") } else { format!("{left} == {right}") }
}

/// Every function whose zero set may be a knot, in normal form, with the order there.
fn knots(local: &mut Local, root: ExprId) -> Vec<(Order, Polynomial)> {
    let mut zeros: BTreeMap<ExprId, bool> = BTreeMap::new();
    let mut found = Vec::new();
    for node in local.graph.reachable(&[root]) {
        let Expr::Call(builtin, operands) = local.graph.expr(node).clone() else { continue };
        match builtin {
            Builtin::Abs => note(local, &mut zeros, operands[0], false),
            Builtin::Min | Builtin::Max | Builtin::SelectLe => {
                let gap = local.graph.sub(operands[0], operands[1]);
                note(local, &mut zeros, gap, builtin == Builtin::SelectLe);
            }
            Builtin::Sqrt => found.extend(at_root(local, root, node, operands[0])),
            Builtin::Pow => found.extend(at_power(local, operands[0], operands[1])),
            _ => {}
        }
    }
    let all: Vec<(ExprId, Vec<u32>)> =
        zeros.keys().map(|zero| (*zero, varying(local, *zero))).collect();
    for ((zero, may_jump), at) in zeros.into_iter().zip(0..) {
        found.extend(
            across(local, root, (at, may_jump), &all).map(|order| (order, local.form(zero))),
        );
    }
    found
}

/// The inputs of an expression that are no parameters.
fn varying(local: &Local, expr: ExprId) -> Vec<u32> {
    let mut inputs = local.graph.inputs_of(&[expr]);
    inputs.retain(|&at| !matches!(local.symbols[at as usize], Symbol::Param(_)));
    inputs
}

/// Adds a function where something switches, and whether that may jump; multiples of a function are
/// the same.
fn note(local: &mut Local, zeros: &mut BTreeMap<ExprId, bool>, gap: ExprId, may_jump: bool) {
    let form = local.form(gap);
    let Some((_, lead)) = form.terms.iter().find(|term| !term.0.is_empty()) else { return };
    let zero = form.scaled(1.0 / lead, &Vec::new()).to_expr(&mut local.graph);
    *zeros.entry(zero).or_default() |= may_jump;
}

/// Whether a function has a zero within the bounds, as far as can be proved.
pub(super) fn may_vanish(local: &Local, function: ExprId) -> bool {
    let mut prover = Prover::new(local.domain.clone(), Vec::new());
    !prover.proves(&local.graph, &[(function, Claim::Positive)])
        && !prover.proves(&local.graph, &[(function, Claim::Negative)])
}

/// The order across a zero set, one of `all`, with what varies in each: the first derivative in
/// which the two sides differ, at some points of it.
fn across(
    local: &mut Local,
    root: ExprId,
    (at, may_jump): (usize, bool),
    all: &[(ExprId, Vec<u32>)],
) -> Option<Order> {
    let zero = all[at].0;
    if !may_vanish(local, zero) {
        return None;
    }
    let mut points = sample::zeros(local, zero);
    points.truncate(MOST_POINTS);
    let promised = if may_jump { Order::Jumps } else { Order::Times(0) };
    if points.is_empty() {
        return Some(promised);
    }
    let along = steepest(local, zero, &points);
    let orders =
        points.iter().zip(along).filter_map(|(point, input)| at_point(local, root, point, input));
    let found = orders.min();
    match found {
        Some(order) if order <= promised => found,
        _ if is_alone(local, at, all) && is_affine(local, zero) => found,
        _ if all.len() == 1 => by_division(local, root, zero, &points[0], promised),
        _ => Some(promised),
    }
}

/// Whether the other functions are not 0 where this one is, but at single places: those that depend
/// on the same single input, or differ from it by a number.
fn is_alone(local: &mut Local, at: usize, all: &[(ExprId, Vec<u32>)]) -> bool {
    let (zero, own) = &all[at];
    all.iter().all(|(other, read)| own.len() == 1 && read == own || apart(local, *zero, *other))
}

/// Whether two functions differ by a number, so that they are never 0 together; or are the same.
fn apart(local: &mut Local, zero: ExprId, other: ExprId) -> bool {
    let difference = local.form(zero).plus(-1.0, &local.form(other)).to_expr(&mut local.graph);
    local.graph.as_number(difference).is_some()
}

/// Whether a function is affine in some input, with a constant factor: then a few places stand for
/// all of its zeros.
pub(super) fn is_affine(local: &mut Local, zero: ExprId) -> bool {
    let mut inputs = local.graph.inputs_of(&[zero]);
    inputs.retain(|&at| !matches!(local.symbols[at as usize], Symbol::Param(_)));
    inputs.into_iter().any(|input| {
        let slope = derivative(&mut local.graph, zero, input);
        let slope = local.normal(slope);
        let varies = |&at: &u32| !matches!(local.symbols[at as usize], Symbol::Param(_));
        let is_constant = !local.graph.inputs_of(&[slope]).iter().any(varies);
        is_constant && !may_vanish(local, slope)
    })
}

/// The order by how often the difference of both sides can be divided by the function.
fn by_division(
    local: &mut Local,
    root: ExprId,
    zero: ExprId,
    point: &[f64],
    promised: Order,
) -> Option<Order> {
    let input = steepest(local, zero, &[point.to_vec()])[0];
    let [below, above] = sides(local, root, point, input);
    let difference = local.graph.sub(above, below);
    let (mut rest, by) = (local.form(difference), local.form(zero));
    if rest.is_zero() {
        return None;
    }
    let mut times = 0;
    while let Some(next) = rest.divided(&by).filter(|_| times <= HIGHEST) {
        rest = next;
        times += 1;
    }
    Some(if times == 0 { promised } else { Order::Times((times - 1).min(HIGHEST)) })
}

/// The expression as it is on both sides of a point.
fn sides(local: &mut Local, root: ExprId, point: &[f64], input: u32) -> [ExprId; 2] {
    [-1.0, 1.0].map(|side| {
        let mut near = point.to_vec();
        near[input as usize] += side * NUDGE * (1.0 + point[input as usize].abs());
        on_side(&mut local.graph, root, &near)
    })
}

/// The order at one point, in the direction of one input.
fn at_point(local: &mut Local, root: ExprId, point: &[f64], input: u32) -> Option<Order> {
    let sides = sides(local, root, point, input);
    if sides
        .map(|side| local.form(side).to_expr(&mut local.graph))
        .windows(2)
        .all(|pair| pair[0] == pair[1])
    {
        return None;
    }
    Some(first_difference(local, sides, point, input))
}

/// What two sides of a place are together: the order before the first derivative in which they
/// differ.
fn first_difference(local: &mut Local, mut sides: [ExprId; 2], point: &[f64], input: u32) -> Order {
    for times in 0..=HIGHEST {
        let values = evaluate(&local.graph, &sides, point, &[]);
        if (values[0] - values[1]).abs() > 1e-7 * (1.0 + values[0].abs().max(values[1].abs())) {
            return if times == 0 { Order::Jumps } else { Order::Times(times - 1) };
        }
        sides = sides.map(|side| derivative(&mut local.graph, side, input));
    }
    Order::Times(HIGHEST)
}

/// The derivative of some order by one input.
pub(super) fn along(local: &mut Local, expr: ExprId, input: u32, times: u32) -> ExprId {
    (0..times).fold(expr, |expr, _| derivative(&mut local.graph, expr, input))
}

/// For each point the input by which a function changes most.
pub(super) fn steepest(local: &mut Local, zero: ExprId, points: &[Vec<f64>]) -> Vec<u32> {
    let inputs = local.graph.inputs_of(&[zero]);
    let movable =
        inputs.into_iter().filter(|&at| !matches!(local.symbols[at as usize], Symbol::Param(_)));
    let movable: Vec<u32> = movable.collect();
    let slopes: Vec<ExprId> =
        movable.iter().map(|&at| derivative(&mut local.graph, zero, at)).collect();
    let steepest = |point: &Vec<f64>| {
        let values = evaluate(&local.graph, &slopes, point, &[]);
        let best = (0..movable.len()).max_by(|&a, &b| values[a].abs().total_cmp(&values[b].abs()));
        movable[best.expect("a function with a zero depends on something")]
    };
    points.iter().map(steepest).collect()
}
