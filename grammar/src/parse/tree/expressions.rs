//! Expressions: the flat list of the grammar becomes a tree.
//!
//! From weak to strong: `+ -`, `* /`, `-x`, `^`. So `-x^2 = -(x^2)`, `2^3^2 = 2^(3^2)`, and `2^-1`
//! is a half.
//!
//! Long sums and products become balanced trees: a sum of a thousand terms is ten levels deep, and
//! everything that walks a tree by recursion may do so, because no tree is deeper than
//! [`MOST_LEVELS`].

use pest::iterators::Pair;

use super::Reader;
use super::blocks::{child, children, ident};
use crate::ast::{Argument, Arm, BinaryOperator, Expr, ExprKind, Relation};
use crate::parse::grammar::Rule;
use crate::{Code, Diagnostic, Span};

/// The deepest tree that is built.
const MOST_LEVELS: usize = 250;

/// The longest sum or product that is kept as it was written, which leaves its rounding alone.
const LONGEST_CHAIN: usize = 32;

/// An expression and how many levels it has.
struct Tree {
    expr: Expr,
    levels: usize,
}

/// Operands joined by operators of one precedence; the first operator is of no meaning.
type Chain = Vec<(BinaryOperator, Tree)>;

impl Reader<'_> {
    /// The expression in a pair of rule `expression` or `factor`.
    pub(super) fn expression(&mut self, pair: Pair<'_, Rule>) -> Expr {
        self.tree(pair).expr
    }

    /// The first expression directly below a pair.
    pub(super) fn expression_in(&mut self, pair: &Pair<'_, Rule>) -> Option<Expr> {
        child(pair, Rule::expression).map(|pair| self.expression(pair))
    }

    /// All expressions directly below a pair.
    pub(super) fn expressions_in(&mut self, pair: &Pair<'_, Rule>) -> Vec<Expr> {
        children(pair, Rule::expression).map(|pair| self.expression(pair)).collect()
    }

    fn tree(&mut self, pair: Pair<'_, Rule>) -> Tree {
        let (mut terms, mut factors, mut powers) = (Chain::new(), Chain::new(), Vec::new());
        let (mut term_operator, mut factor_operator) =
            (BinaryOperator::Add, BinaryOperator::Multiply);
        let mut minuses = Vec::new();
        for pair in pair.into_inner() {
            match (pair.as_rule(), pair.as_str()) {
                (Rule::negation, _) => minuses.push(self.span(&pair)),
                (Rule::operator | Rule::scaling, "^") => {}
                (Rule::operator | Rule::scaling, sign @ ("*" | "/")) => {
                    factors.push((factor_operator, self.power(std::mem::take(&mut powers))));
                    factor_operator =
                        if sign == "*" { BinaryOperator::Multiply } else { BinaryOperator::Divide };
                }
                (Rule::operator, sign) => {
                    factors.push((factor_operator, self.power(std::mem::take(&mut powers))));
                    terms.push((term_operator, self.chain(std::mem::take(&mut factors))));
                    term_operator =
                        if sign == "+" { BinaryOperator::Add } else { BinaryOperator::Subtract };
                    factor_operator = BinaryOperator::Multiply;
                }
                _ => powers.push((std::mem::take(&mut minuses), self.operand(pair))),
            }
        }
        factors.push((factor_operator, self.power(powers)));
        terms.push((term_operator, self.chain(factors)));
        self.chain(terms)
    }

    /// `-a^-b^c = -(a^(-(b^c)))`, from the right.
    fn power(&mut self, operands: Vec<(Vec<Span>, Tree)>) -> Tree {
        let mut result: Option<Tree> = None;
        for (minuses, operand) in operands.into_iter().rev() {
            let power = match result {
                Some(exponent) => self.binary(BinaryOperator::Power, operand, exponent),
                None => operand,
            };
            result = Some(
                minuses.into_iter().rev().fold(power, |inner, minus| self.negate(minus, inner)),
            );
        }
        result.expect("the grammar has at least one operand")
    }

    fn negate(&mut self, minus: Span, inner: Tree) -> Tree {
        let span = minus.to(inner.expr.span);
        self.node(span, inner.levels, || ExprKind::Negate(Box::new(inner.expr)))
    }

    fn binary(&mut self, operator: BinaryOperator, left: Tree, right: Tree) -> Tree {
        let span = left.expr.span.to(right.expr.span);
        let levels = left.levels.max(right.levels);
        self.node(span, levels, || {
            ExprKind::Binary(operator, Box::new(left.expr), Box::new(right.expr))
        })
    }

    /// From the left as long as it is short, balanced where it is long.
    fn chain(&mut self, mut chain: Chain) -> Tree {
        if chain.len() > LONGEST_CHAIN {
            let right = chain.split_off(chain.len() / 2);
            return self.balance(chain, right);
        }
        let mut operands = chain.into_iter();
        let (_, first) = operands.next().expect("a chain has at least one operand");
        operands.fold(first, |left, (operator, right)| self.binary(operator, left, right))
    }

    /// `a - (b + c - d)` for the chain `a - b - c + d`: on the right of `-` and `/` the signs turn
    /// around.
    fn balance(&mut self, left: Chain, mut right: Chain) -> Tree {
        let joint = right[0].0;
        if matches!(joint, BinaryOperator::Subtract | BinaryOperator::Divide) {
            right.iter_mut().for_each(|(operator, _)| *operator = inverse(*operator));
        }
        let (left, right) = (self.chain(left), self.chain(right));
        self.binary(joint, left, right)
    }

    fn operand(&mut self, pair: Pair<'_, Rule>) -> Tree {
        let mut inner = pair.into_inner();
        let atom = inner.next().expect("an operand begins with an atom");
        let mut tree = self.atom(atom);
        for suffix in inner {
            tree = self.suffix(tree, suffix);
        }
        tree
    }

    fn suffix(&mut self, base: Tree, suffix: Pair<'_, Rule>) -> Tree {
        let span = base.expr.span.to(self.span(&suffix));
        let (mut levels, value) = (base.levels, Box::new(base.expr));
        let kind = match suffix.as_rule() {
            Rule::call => {
                let (arguments, deepest) = self.arguments(&suffix);
                levels = levels.max(deepest);
                ExprKind::Call(value, arguments)
            }
            Rule::part => ExprKind::Part(value, ident(self, &suffix)),
            // A number too large for an index is a part that no vector has.
            Rule::index => ExprKind::Index(value, digits(&suffix).parse().unwrap_or(usize::MAX)),
            _ => ExprKind::Prime(value),
        };
        self.node(span, levels, || kind)
    }

    fn arguments(&mut self, call: &Pair<'_, Rule>) -> (Vec<Argument>, usize) {
        let mut deepest = 0;
        let arguments = children(call, Rule::argument).map(|argument| {
            let inner = argument.into_inner().next().expect("an argument is one of four");
            match inner.as_rule() {
                Rule::kw_end => Argument::End(self.span(&inner)),
                Rule::kw_start => Argument::Start(self.span(&inner)),
                Rule::iteration => {
                    let mut names = children(&inner, Rule::name).map(|name| self.name(&name));
                    let mut next = || names.next().expect("an iteration has two names");
                    Argument::Iteration(next(), next())
                }
                _ => {
                    let tree = self.tree(inner);
                    deepest = deepest.max(tree.levels);
                    Argument::Expr(tree.expr)
                }
            }
        });
        (arguments.collect(), deepest)
    }

    fn atom(&mut self, pair: Pair<'_, Rule>) -> Tree {
        let span = self.span(&pair);
        let leaf = |kind| Tree { expr: Expr { kind, span }, levels: 1 };
        match pair.as_rule() {
            Rule::number => leaf(ExprKind::Number(self.number(&pair))),
            Rule::name => leaf(ExprKind::Name(pair.as_str().to_owned())),
            Rule::quantity => {
                let number = child(&pair, Rule::number).expect("a quantity has a number");
                let unit = self.unit(&pair).expect("a quantity has a unit");
                leaf(ExprKind::Quantity(self.number(&number), unit))
            }
            Rule::group => self.group(&pair, span),
            Rule::piecewise => self.piecewise(&pair, span),
            _ => self.switch(&pair, span),
        }
    }

    /// Parentheses leave no trace but the wider span, and a tuple where there is a comma.
    fn group(&mut self, pair: &Pair<'_, Rule>, span: Span) -> Tree {
        let mut trees: Vec<Tree> =
            children(pair, Rule::expression).map(|inner| self.tree(inner)).collect();
        if trees.len() == 1 {
            let mut tree = trees.remove(0);
            tree.expr.span = span;
            return tree;
        }
        let levels = trees.iter().map(|tree| tree.levels).max().unwrap_or(0);
        self.node(span, levels, || {
            ExprKind::Tuple(trees.into_iter().map(|tree| tree.expr).collect())
        })
    }

    fn piecewise(&mut self, pair: &Pair<'_, Rule>, span: Span) -> Tree {
        let mut levels = 0;
        let arms = children(pair, Rule::arm).map(|arm| self.arm(&arm, &mut levels)).collect();
        let otherwise = child(pair, Rule::expression).expect("a piecewise ends with `otherwise`");
        let otherwise = self.tree(otherwise);
        levels = levels.max(otherwise.levels);
        self.node(span, levels, || ExprKind::Piecewise {
            arms,
            otherwise: Box::new(otherwise.expr),
        })
    }

    fn arm(&mut self, pair: &Pair<'_, Rule>, levels: &mut usize) -> Arm {
        let mut side = |this: &mut Self, pair| {
            let tree = this.tree(pair);
            *levels = (*levels).max(tree.levels);
            tree.expr
        };
        let guard = child(pair, Rule::guard).expect("an arm has a guard");
        let mut sides = children(&guard, Rule::expression);
        let mut next = || sides.next().expect("a guard has two sides");
        let (left, right) = (side(self, next()), side(self, next()));
        let sign = child(&guard, Rule::guard_relation).expect("a guard compares");
        let (relation, relation_span) = (relation(sign.as_str()), self.span(&sign));
        let value = side(self, child(pair, Rule::expression).expect("an arm has a value"));
        Arm { left, relation, relation_span, right, guard_span: self.span(&guard), value }
    }

    fn switch(&mut self, pair: &Pair<'_, Rule>, span: Span) -> Tree {
        let mut sides = children(pair, Rule::expression);
        let mut side = || self.tree(sides.next().expect("a match has two sides"));
        let (below, above) = (side(), side());
        let surface = ident(self, pair);
        let first = child(pair, Rule::kw_below).expect("a match begins below");
        let sides = self.span(&first).to(above.expr.span);
        let levels = below.levels.max(above.levels);
        let (below, above) = (Box::new(below.expr), Box::new(above.expr));
        self.node(span, levels, || ExprKind::Match { surface, sides, below, above })
    }

    /// One more level. Where that is one too many, the place is reported once and the branch ends
    /// in a number.
    fn node(&mut self, span: Span, below: usize, kind: impl FnOnce() -> ExprKind) -> Tree {
        if below >= MOST_LEVELS {
            self.report(too_deep(span));
            return Tree { expr: Expr { kind: ExprKind::Number(0.0), span }, levels: 1 };
        }
        Tree { expr: Expr { kind: kind(), span }, levels: below + 1 }
    }

    fn number(&mut self, pair: &Pair<'_, Rule>) -> f64 {
        let value: f64 = pair.as_str().parse().expect("the grammar's numbers are Rust's numbers");
        let is_lost = value == 0.0 && has_a_digit(pair.as_str());
        if value.is_infinite() || is_lost {
            let [than, limit, help] = match is_lost {
                true => ["smaller than any number but 0", "below 4.9e-324", "write 0"],
                false => ["larger than any number", "above 1.8e308", "write a smaller exponent"],
            };
            let message = format!("`{}` is {than}", pair.as_str());
            let diagnostic = Diagnostic::new(Code::Unfinished, message, self.span(pair), limit);
            self.report(diagnostic.help(help));
        }
        value
    }
}

/// Whether a number has a digit other than 0 before its exponent.
fn has_a_digit(number: &str) -> bool {
    number.chars().take_while(|it| !it.eq_ignore_ascii_case(&'e')).any(|it| matches!(it, '1'..='9'))
}

/// `<` and `<=` mean the same: they differ at a single point.
pub(super) fn relation(sign: &str) -> Relation {
    match sign {
        "<" | "<=" => Relation::LessEqual,
        ">" | ">=" => Relation::GreaterEqual,
        _ => Relation::Equal,
    }
}

fn inverse(operator: BinaryOperator) -> BinaryOperator {
    match operator {
        BinaryOperator::Add => BinaryOperator::Subtract,
        BinaryOperator::Subtract => BinaryOperator::Add,
        BinaryOperator::Multiply => BinaryOperator::Divide,
        BinaryOperator::Divide => BinaryOperator::Multiply,
        BinaryOperator::Power => BinaryOperator::Power,
    }
}

fn digits<'p>(pair: &Pair<'p, Rule>) -> &'p str {
    child(pair, Rule::digits).map_or("", |digits| digits.as_str())
}

fn too_deep(span: Span) -> Diagnostic {
    let message = format!("an expression of more than {MOST_LEVELS} levels");
    // The whole may have a megabyte; its first character is place enough.
    let place = Span { start: span.start, end: span.end.min(span.start + 1) };
    Diagnostic::new(Code::TooDeep, message, place, "nested too deeply from here on")
        .help("name the inner parts with `let` and write the expression in terms of those names")
}
