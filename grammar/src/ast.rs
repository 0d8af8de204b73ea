//! The syntax tree: what was written, with a place on every node and no meaning yet.
//!
//! Free of pest types, so that the parser can be replaced. Names are not resolved, units are not
//! converted.

use crate::Span;

/// A name and where it stands.
#[derive(Clone, Debug, PartialEq)]
pub struct Ident {
    /// The name.
    pub name: String,
    /// Where it stands.
    pub span: Span,
}

/// A whole file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Model {
    /// The `#!` lines at the head, without the marker.
    pub docs: Vec<String>,
    /// `model NAME`.
    pub name: Option<Ident>,
    /// All items that could be read, in the order of the text.
    pub items: Vec<Item>,
    /// Where each line of the text begins, so that a message can speak of another line.
    pub line_starts: Vec<u32>,
}

impl Model {
    /// The line of a byte, counted from 1.
    pub fn line_of(&self, offset: u32) -> usize {
        self.line_starts.partition_point(|&start| start <= offset)
    }
}

/// One item.
#[derive(Clone, Debug, PartialEq)]
pub struct Item {
    /// What it is.
    pub kind: ItemKind,
    /// The whole item.
    pub span: Span,
}

/// The kinds of items, in the order of the language reference.
#[expect(missing_docs, reason = "the syntax above each variant names its fields")]
#[derive(Clone, Debug, PartialEq)]
pub enum ItemKind {
    /// `param name = expr [unit] in [a, b]`
    Param { name: Ident, value: Option<Expr>, unit: Option<Unit>, bounds: Option<Interval> },
    /// `const name = expr [unit]`
    Const { name: Ident, value: Expr, unit: Option<Unit> },
    /// `let name [unit] = expr`
    Let { name: Ident, unit: Option<Unit>, value: Expr },
    /// `signal name [unit] = expr`
    Signal { name: Ident, unit: Option<Unit>, value: Expr },
    /// `fn name(a, b) = expr`
    Fn { name: Ident, arguments: Vec<Ident>, body: Expr },
    /// `data name = csv("file") columns t [s], x [m]`
    Data { name: Ident, file: String, file_span: Span, columns: Vec<(Ident, Option<Unit>)> },
    /// `free name in [a, b] [unit] guess expr`
    Free { name: Ident, bounds: Option<Interval>, unit: Option<Unit>, guess: Option<Expr> },
    /// `time t in [a, b] [unit]`
    Time { name: Ident, interval: Interval, unit: Option<Unit> },
    /// `state name(parts) [unit] in [a, b] start expr`
    State {
        name: Ident,
        parts: Vec<Ident>,
        unit: Option<Unit>,
        bounds: Option<Interval>,
        start: Option<Start>,
    },
    /// `control name(parts) in [a, b] [unit] guess expr`
    Control {
        name: Ident,
        parts: Vec<Ident>,
        bounds: Option<Interval>,
        unit: Option<Unit>,
        guess: Option<Expr>,
    },
    /// `surface name = expr`
    Surface { name: Ident, value: Expr },
    /// `dynamics { ... }`
    Dynamics { equations: Vec<Equation> },
    /// `metric v1: m1, v2: m2`
    Metric { weights: Vec<(Ident, Expr)> },
    /// `jump name on surface falling at most n then hold surface { x := expr }`
    Jump {
        name: Ident,
        surface: Ident,
        direction: Direction,
        direction_span: Span,
        at_most: Option<Expr>,
        then_hold: Option<Ident>,
        assignments: Vec<Assignment>,
    },
    /// `start condition`
    Start { condition: Condition },
    /// `end condition`
    End { condition: Condition },
    /// `at time: condition`
    At { time: Expr, condition: Condition },
    /// `path name: condition`
    Path { name: Option<Ident>, condition: Condition },
    /// `minimize expr` or `maximize expr`
    Objective { sense: Sense, keyword: Span, value: Expr },
    /// `fit data: expr = column sd expr, expr sd expr`
    Fit { keyword: Span, data: Ident, signals: Vec<Fitted> },
    /// `guess { name = expr }`
    Guess { bindings: Vec<Binding> },
    /// `phase name like other for each csv("files") columns t [s], x [m] { items }`
    Phase { name: Ident, like: Option<Ident>, each: Option<Each>, items: Vec<Item> },
    /// `link a -> b { same  x := expr }`
    Link { from: Ident, to: Ident, same: Option<Span>, assignments: Vec<Assignment> },
    /// `method { settings }`
    Method { settings: Vec<Setting> },
    /// `sweep { name = expr, expr }`
    Sweep { lists: Vec<Swept> },
    /// `report { name = expr }`
    Report { bindings: Vec<Binding> },
    /// `plot name: expr, expr over expr with path`
    Plot { name: Ident, curves: Vec<Expr>, over: Expr, borders: Vec<Ident> },
    /// `expect { expr == expr within expr }`
    Expect { checks: Vec<Check> },
}

/// `for each csv("file*") columns t [s], x [m]`
#[expect(missing_docs, reason = "the syntax above names its fields")]
#[derive(Clone, Debug, PartialEq)]
pub struct Each {
    pub file: String,
    pub file_span: Span,
    pub columns: Vec<(Ident, Option<Unit>)>,
}

/// `[lower, upper]`
#[derive(Clone, Debug, PartialEq)]
pub struct Interval {
    /// Left end.
    pub lower: Expr,
    /// Right end.
    pub upper: Expr,
    /// The brackets and all between.
    pub span: Span,
}

/// What a state is at the start.
#[expect(missing_docs, reason = "the syntax above each variant names its fields")]
#[derive(Clone, Debug, PartialEq)]
pub enum Start {
    /// `start expr`
    Value(Expr),
    /// `start free in [a, b]`
    Free { span: Span, bounds: Option<Interval> },
}

/// `falling` or `rising`
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// From above to below.
    Falling,
    /// From below to above.
    Rising,
}

/// `minimize` or `maximize`
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sense {
    /// `minimize`
    Minimize,
    /// `maximize`
    Maximize,
}

/// `factor * state' = right` or `factor * state' in right`
#[derive(Clone, Debug, PartialEq)]
pub struct Equation {
    /// What multiplies the derivative.
    pub factor: Option<Expr>,
    /// The state.
    pub state: Ident,
    /// `=` or `in`.
    pub relation: EquationRelation,
    /// Where `=` or `in` stands.
    pub relation_span: Span,
    /// The right side.
    pub right: Expr,
    /// The whole equation.
    pub span: Span,
}

/// `=` or `in`
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EquationRelation {
    /// `=`: the right side is a value.
    Equal,
    /// `in`: the right side is a set.
    In,
}

/// `first <= second` or `first <= second <= third`
#[derive(Clone, Debug, PartialEq)]
pub struct Condition {
    /// The leftmost expression.
    pub first: Expr,
    /// One or two further expressions, each with the relation before it.
    pub rest: Vec<(Relation, Expr)>,
    /// The whole condition.
    pub span: Span,
}

/// A comparison.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Relation {
    /// `<=` (and `<` in a guard)
    LessEqual,
    /// `>=` (and `>` in a guard)
    GreaterEqual,
    /// `==`
    Equal,
}

/// `signal = column sd deviation`
#[derive(Clone, Debug, PartialEq)]
pub struct Fitted {
    /// What was measured.
    pub signal: Expr,
    /// The column in which it is, where its name is another.
    pub column: Option<Ident>,
    /// The standard deviation of the measurements.
    pub deviation: Expr,
    /// The whole entry.
    pub span: Span,
}

/// `name = expr`
#[derive(Clone, Debug, PartialEq)]
pub struct Binding {
    /// Left side.
    pub name: Ident,
    /// Right side.
    pub value: Expr,
}

/// `name := expr` or `name.part := expr`
#[derive(Clone, Debug, PartialEq)]
pub struct Assignment {
    /// Left side.
    pub name: Ident,
    /// The part of a vector.
    pub part: Option<Ident>,
    /// Right side.
    pub value: Expr,
}

/// One line of a `method` block: a key and its value, with what may follow it.
///
/// `smooth sigma = e kernel k` is two settings, `sigma` and `kernel`; `grid N = n steps k scheme s
/// lagged (a)` is `N`, `steps`, `scheme`; `continue sigma = a, b` is `continue`. Any other `key =
/// value` is itself.
#[derive(Clone, Debug, PartialEq)]
pub struct Setting {
    /// The key.
    pub key: Ident,
    /// The value.
    pub value: SettingValue,
    /// Unit after the value.
    pub unit: Option<Unit>,
}

/// A line of a `sweep` block.
#[derive(Clone, Debug, PartialEq)]
pub struct Swept {
    /// A parameter or a key of the method.
    pub name: Ident,
    /// Its values, one for each run.
    pub values: Vec<Expr>,
}

/// The value of a setting.
#[expect(missing_docs, reason = "the syntax above each variant names its fields")]
#[derive(Clone, Debug, PartialEq)]
pub enum SettingValue {
    /// A single word or expression (a word is a name).
    Expr(Expr),
    /// Several values after `continue`.
    List(Vec<Expr>),
    /// A scheme, with the states it evaluates at the old time.
    Scheme { name: Ident, lagged: Vec<Ident> },
}

/// `left == right within tolerance`
#[derive(Clone, Debug, PartialEq)]
pub struct Check {
    /// Left side.
    pub left: Expr,
    /// Comparison.
    pub relation: Relation,
    /// Right side.
    pub right: Expr,
    /// Allowed difference.
    pub within: Option<Expr>,
    /// The whole check.
    pub span: Span,
}

/// `[kg m/s^2]`: factors with integer powers.
#[derive(Clone, Debug, PartialEq)]
pub struct Unit {
    /// Each unit name (as written, `1` left out) and its power.
    pub factors: Vec<(Ident, i32)>,
    /// The brackets and all between.
    pub span: Span,
}

/// An expression.
#[derive(Clone, Debug, PartialEq)]
pub struct Expr {
    /// What it is.
    pub kind: ExprKind,
    /// Where it stands.
    pub span: Span,
}

/// The kinds of expressions.
#[expect(missing_docs, reason = "the syntax above each variant names its fields")]
#[derive(Clone, Debug, PartialEq)]
pub enum ExprKind {
    /// `9.81`
    Number(f64),
    /// `9.81 [m/s^2]`
    Quantity(f64, Unit),
    /// `x`
    Name(String),
    /// `-x`
    Negate(Box<Expr>),
    /// `a + b`
    Binary(BinaryOperator, Box<Expr>, Box<Expr>),
    /// `f(a, b)`, `x(end)`, `coast.h(end)`, `integral(e)`, `sum(k in obs, e)`
    Call(Box<Expr>, Vec<Argument>),
    /// `pos.x`
    Part(Box<Expr>, Ident),
    /// `pos[1]`, counted from 1
    Index(Box<Expr>, usize),
    /// `pos'`, only in a guess
    Prime(Box<Expr>),
    /// `(a, b)`
    Tuple(Vec<Expr>),
    /// `piecewise { x <= 1 => a  otherwise => b }`
    Piecewise { arms: Vec<Arm>, otherwise: Box<Expr> },
    /// `match surface { below => a, above => b }`; `sides` is what stands between the braces
    Match { surface: Ident, sides: Span, below: Box<Expr>, above: Box<Expr> },
}

/// `left <= right => value`
#[derive(Clone, Debug, PartialEq)]
pub struct Arm {
    /// Left side of the guard.
    pub left: Expr,
    /// Comparison; `<` is read as `<=`, `>` as `>=`.
    pub relation: Relation,
    /// Where the comparison stands.
    pub relation_span: Span,
    /// Right side of the guard.
    pub right: Expr,
    /// The guard, without `=>`.
    pub guard_span: Span,
    /// The value where the guard holds.
    pub value: Expr,
}

/// An argument of a call.
#[derive(Clone, Debug, PartialEq)]
pub enum Argument {
    /// An expression.
    Expr(Expr),
    /// `end`
    End(Span),
    /// `start`
    Start(Span),
    /// `k in obs`
    Iteration(Ident, Ident),
}

/// `+ - * / ^`
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BinaryOperator {
    /// `+`
    Add,
    /// `-`
    Subtract,
    /// `*`
    Multiply,
    /// `/`
    Divide,
    /// `^`
    Power,
}
