//! Expressions as polynomials over what is not polynomial in them: their normal form.
//!
//! ```text
//! c_1 a^i b^j ... + c_2 ...      exponents may be negative
//! a, b                           atoms: inputs, and calls such as sin(x)
//! cos(x)^2 = 1 - sin(x)^2,   sqrt(x)^2 = x,   abs(x)^2 = x^2
//! ```
//!
//! Two expressions with the same normal form are equal wherever both have a value. What would grow
//! beyond [`MOST_TERMS`] stays an atom.

use super::graph::builtins::Builtin;
use super::graph::{ById, Expr, ExprId, Graph};
use std::cmp::Ordering;
use std::collections::BTreeMap;

/// A product of powers of atoms, ascending by atom.
pub(crate) type Monomial = Vec<(ExprId, i32)>;

/// A sum of products; terms with the factor 0 are left out.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Polynomial {
    /// The factor of each product.
    pub terms: BTreeMap<Monomial, f64>,
}

const MOST_TERMS: usize = 64;
/// Sums that are smaller than this part of their terms are rounding.
const ROUNDING: f64 = 1e-14;

impl Polynomial {
    /// A number.
    pub fn number(value: f64) -> Self {
        Self::term(Monomial::new(), value)
    }
    /// An atom.
    pub fn atom(id: ExprId) -> Self {
        Self::term(vec![(id, 1)], 1.0)
    }
    /// A product of powers of atoms.
    pub fn product(monomial: Monomial) -> Self {
        Self::term(monomial, 1.0)
    }
    fn term(monomial: Monomial, factor: f64) -> Self {
        let terms =
            if factor == 0.0 { BTreeMap::new() } else { BTreeMap::from([(monomial, factor)]) };
        Polynomial { terms }
    }
    /// Whether it is 0.
    pub fn is_zero(&self) -> bool {
        self.terms.is_empty()
    }
    /// Its value, if it is a number.
    pub fn as_number(&self) -> Option<f64> {
        match self.terms.len() {
            0 => Some(0.0),
            1 => self.terms.get(&Monomial::new()).copied(),
            _ => None,
        }
    }
    /// Its only term.
    pub fn as_term(&self) -> Option<(&Monomial, f64)> {
        let mut terms = self.terms.iter();
        let (monomial, factor) = terms.next()?;
        terms.next().is_none().then_some((monomial, *factor))
    }
    /// Times a number and powers of atoms.
    pub fn scaled(&self, factor: f64, monomial: &Monomial) -> Self {
        let terms = self.terms.iter().map(|(it, size)| (multiplied(it, monomial), size * factor));
        Polynomial { terms: terms.collect() }
    }

    /// `self + factor * other`.
    pub fn plus(mut self, factor: f64, other: &Polynomial) -> Self {
        for (monomial, &size) in &other.terms {
            let before = self.terms.get(monomial).copied().unwrap_or(0.0);
            let sum = before + factor * size;
            if sum.abs() <= ROUNDING * before.abs() {
                self.terms.remove(monomial);
            } else {
                self.terms.insert(monomial.clone(), sum);
            }
        }
        self
    }

    /// `self * other`, unless it becomes too large.
    pub fn times(&self, other: &Polynomial) -> Option<Self> {
        if self.terms.len() * other.terms.len() > MOST_TERMS * 2 {
            return None;
        }
        let mut product = Polynomial::default();
        for (a, &left) in &self.terms {
            for (b, &right) in &other.terms {
                product = product.plus(1.0, &Polynomial::term(multiplied(a, b), left * right));
            }
        }
        (product.terms.len() <= MOST_TERMS).then_some(product)
    }

    /// `1 / self`, of a single product.
    fn inverted(&self) -> Option<Self> {
        let (monomial, factor) = self.as_term()?;
        let monomial = monomial.iter().map(|&(atom, power)| (atom, -power)).collect();
        Some(Self::term(monomial, 1.0 / factor))
    }

    /// Its highest term: that with most of the oldest atom, then of the next one, and so on.
    fn lead(&self) -> Option<(&Monomial, f64)> {
        let highest = self.terms.iter().max_by(|a, b| compare(a.0, b.0))?;
        Some((highest.0, *highest.1))
    }

    /// `self / by`, if nothing remains and the quotient is a polynomial again.
    pub fn divided(&self, by: &Polynomial) -> Option<Self> {
        let (lead, factor) = by.lead()?;
        let inverse: Monomial = lead.iter().map(|&(atom, power)| (atom, -power)).collect();
        let (mut rest, mut quotient) = (self.clone(), Polynomial::default());
        for _ in 0..MOST_TERMS {
            let Some((top, size)) = rest.lead() else { return Some(quotient) };
            let step = Polynomial::term(multiplied(top, &inverse), size / factor);
            if step.terms.keys().flatten().any(|power| power.1 < 0 && !self.has_negative(power.0)) {
                return None;
            }
            rest = rest.plus(-1.0, &step.times(by)?);
            quotient = quotient.plus(1.0, &step);
        }
        None
    }

    /// The same wherever `zero` is 0: its highest term is replaced by the others.
    pub fn reduced(&self, zero: &Polynomial) -> Option<Self> {
        let (lead, factor) = zero.lead().filter(|lead| !lead.0.is_empty())?;
        let inverse: Monomial = lead.iter().map(|&(atom, power)| (atom, -power)).collect();
        let mut form = self.clone();
        for _ in 0..MOST_TERMS {
            let divides = |it: &Monomial| {
                lead.iter().all(|power| {
                    it.iter().any(|other| other.0 == power.0 && other.1 >= power.1.max(1))
                })
            };
            let Some((monomial, size)) =
                form.terms.iter().find(|it| divides(it.0)).map(|it| (it.0.clone(), *it.1))
            else {
                return Some(form);
            };
            let step = Polynomial::term(multiplied(&monomial, &inverse), size / factor);
            form = form.plus(-1.0, &step.times(zero)?);
        }
        None
    }

    fn has_negative(&self, atom: ExprId) -> bool {
        self.terms.keys().flatten().any(|power| power.0 == atom && power.1 < 0)
    }

    /// As an expression, with what is added first.
    pub fn to_expr(&self, graph: &mut Graph) -> ExprId {
        let mut terms: Vec<(&Monomial, f64)> =
            self.terms.iter().map(|(it, &factor)| (it, factor)).collect();
        terms.sort_by_key(|term| term.1 < 0.0);
        let terms: Vec<ExprId> =
            terms.into_iter().map(|term| product(graph, term.0, term.1)).collect();
        graph.sum(&terms)
    }
}

fn product(graph: &mut Graph, monomial: &Monomial, factor: f64) -> ExprId {
    let one = graph.number(1.0);
    let powers = monomial.iter().map(|&(atom, power)| {
        let exponent = graph.number(f64::from(power));
        graph.pow(atom, exponent)
    });
    let powers: Vec<ExprId> = powers.collect();
    let product = powers.into_iter().fold(one, |product, power| graph.mul(product, power));
    graph.scale(factor, product)
}

/// The order of terms: lexicographic in the exponents, so that products keep it.
fn compare(a: &Monomial, b: &Monomial) -> Ordering {
    let power =
        |of: &Monomial, atom: ExprId| of.iter().find(|it| it.0 == atom).map_or(0, |it| it.1);
    let mut atoms: Vec<ExprId> = a.iter().chain(b).map(|it| it.0).collect();
    atoms.sort_unstable();
    let differing = atoms.into_iter().find(|&atom| power(a, atom) != power(b, atom));
    differing.map_or(Ordering::Equal, |atom| power(a, atom).cmp(&power(b, atom)))
}

fn multiplied(a: &Monomial, b: &Monomial) -> Monomial {
    let mut powers: BTreeMap<ExprId, i32> = a.iter().copied().collect();
    b.iter().for_each(|&(atom, power)| *powers.entry(atom).or_default() += power);
    powers.into_iter().filter(|power| power.1 != 0).collect()
}

/// `a - b`, without what both have in common: `(T1 + T2) - T1` is `T2`.
pub(crate) fn difference(graph: &mut Graph, a: ExprId, b: ExprId) -> ExprId {
    let written = graph.sub(a, b);
    let collected = NormalForms::default().expr(graph, written);
    let inputs = |id: ExprId| graph.inputs_of(&[id]).len();
    if inputs(collected) < inputs(written) { collected } else { written }
}

/// Normal forms of the expressions of one graph, each computed once.
#[derive(Default)]
pub(crate) struct NormalForms {
    known: ById<Polynomial>,
    /// Whether squares of cosines, roots and absolute values are replaced.
    keeps_squares: bool,
}

impl NormalForms {
    /// Without the rules for squares: what was factored stays divisible.
    pub fn with_squares() -> Self {
        NormalForms { keeps_squares: true, ..NormalForms::default() }
    }

    /// The normal form of an expression.
    pub fn of(&mut self, graph: &mut Graph, root: ExprId) -> Polynomial {
        let mut stack = vec![root];
        while let Some(&id) = stack.last() {
            let unknown = graph.operands(id).iter().filter(|it| !self.known.contains_key(it));
            let from = stack.len();
            stack.extend(unknown.copied().collect::<Vec<_>>());
            if stack.len() == from {
                stack.pop();
                if !self.known.contains_key(&id) {
                    let form = self.step(graph, id);
                    self.known.insert(id, form);
                }
            }
        }
        self.known[&root].clone()
    }

    /// The expression of the normal form.
    pub fn expr(&mut self, graph: &mut Graph, root: ExprId) -> ExprId {
        let form = self.of(graph, root);
        form.to_expr(graph)
    }

    fn step(&mut self, graph: &mut Graph, id: ExprId) -> Polynomial {
        let Expr::Call(builtin, operands) = graph.expr(id).clone() else {
            return graph.as_number(id).map_or_else(|| Polynomial::atom(id), Polynomial::number);
        };
        let forms: Vec<Polynomial> =
            operands.iter().map(|operand| self.known[operand].clone()).collect();
        let found = match builtin {
            Builtin::Add => Some(forms[0].clone().plus(1.0, &forms[1])),
            Builtin::Sub => Some(forms[0].clone().plus(-1.0, &forms[1])),
            Builtin::Neg => Some(Polynomial::default().plus(-1.0, &forms[0])),
            Builtin::Mul => {
                forms[0].times(&forms[1]).and_then(|it| self.without_squares(graph, it))
            }
            Builtin::Div => forms[1].inverted().and_then(|it| forms[0].times(&it)),
            _ => None,
        };
        let fits = |form: &Polynomial| {
            form.terms.len() <= MOST_TERMS && form.terms.values().all(|it| it.is_finite())
        };
        found.filter(fits).unwrap_or_else(|| {
            let operands: Vec<ExprId> = forms.iter().map(|form| form.to_expr(graph)).collect();
            let call = graph.call(builtin, &operands);
            graph.as_number(call).map_or_else(|| Polynomial::atom(call), Polynomial::number)
        })
    }

    /// Squares by the rules at the head of this file, as often as they apply.
    fn without_squares(&mut self, graph: &mut Graph, mut form: Polynomial) -> Option<Polynomial> {
        if self.keeps_squares {
            return Some(form);
        }
        for _ in 0..MOST_TERMS {
            let found = form.terms.iter().find_map(|(monomial, &factor)| {
                let at = monomial
                    .iter()
                    .position(|&(atom, power)| power >= 2 && has_rule(graph, atom))?;
                Some((monomial.clone(), factor, at))
            });
            let Some((monomial, factor, at)) = found else { return Some(form) };
            let square = self.square_of(graph, monomial[at].0)?;
            let mut rest = monomial.clone();
            rest[at].1 -= 2;
            rest.retain(|power| power.1 != 0);
            form.terms.remove(&monomial);
            form = form.plus(1.0, &Polynomial::term(rest, factor).times(&square)?);
        }
        None
    }

    fn square_of(&mut self, graph: &mut Graph, atom: ExprId) -> Option<Polynomial> {
        let Expr::Call(builtin, operands) = graph.expr(atom).clone() else { return None };
        let operand = operands[0];
        match builtin {
            Builtin::Cos => {
                let sine = Polynomial::atom(graph.sin(operand));
                Some(Polynomial::number(1.0).plus(-1.0, &sine.times(&sine)?))
            }
            Builtin::Sqrt => Some(self.of(graph, operand)),
            _ => {
                let form = self.of(graph, operand);
                form.times(&form).and_then(|it| self.without_squares(graph, it))
            }
        }
    }
}

fn has_rule(graph: &Graph, atom: ExprId) -> bool {
    matches!(graph.expr(atom), Expr::Call(Builtin::Cos | Builtin::Sqrt | Builtin::Abs, _))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_equal_has_one_normal_form() {
        let mut graph = Graph::new();
        let [x, y] = [0, 1].map(|input| graph.input(input));
        let mut forms = NormalForms::default();
        let (sine, cosine) = (graph.sin(x), graph.cos(x));
        let squares = [sine, cosine].map(|it| graph.square(it));
        let one = graph.add(squares[0], squares[1]);
        assert_eq!(forms.of(&mut graph, one).as_number(), Some(1.0));
        let (sum, difference) = (graph.add(x, y), graph.sub(x, y));
        let product = graph.mul(sum, difference);
        let (x2, y2) = (graph.square(x), graph.square(y));
        let same = graph.sub(x2, y2);
        assert_eq!(forms.of(&mut graph, product), forms.of(&mut graph, same));
        let (quotient, root) = (graph.div(product, x), graph.sqrt(sum));
        let again = graph.mul(quotient, x);
        assert_eq!(forms.of(&mut graph, again), forms.of(&mut graph, same));
        let square = graph.square(root);
        assert_eq!(forms.of(&mut graph, square), forms.of(&mut graph, sum));
    }

    #[test]
    fn a_product_is_divided_by_its_factor() {
        let mut graph = Graph::new();
        let [x, y] = [0, 1].map(|input| graph.input(input));
        let mut forms = NormalForms::with_squares();
        let sum = graph.add(x, y);
        let square = graph.square(sum);
        let [sum, square] = [sum, square].map(|it| forms.of(&mut graph, it));
        assert_eq!(square.divided(&sum), Some(sum.clone()));
        let x = forms.of(&mut graph, x);
        assert_eq!(square.divided(&x), None);
        // (x + y)^2 = x (x + y) + ... is x + y wherever x + y = 1.
        let one = Polynomial::number(1.0);
        assert_eq!(square.reduced(&sum.plus(-1.0, &one)), Some(one));
    }
}
