//! Expressions in the words of the model: `2*x`, `-2*muN`, `u - 9.81`, `abs(s)*v_t^2`.
//!
//! What is printed is the normal form. Parts of it that have a name in the model, or were written
//! out there, are replaced by that name where this makes the text shorter.

use crate::expressions::graph::builtins::{Builtin, Notation};
use crate::expressions::graph::{Expr, ExprId, Graph};
use crate::expressions::polynomial::{Monomial, NormalForms, Polynomial};
use crate::syntax::text::number;

/// Names for inputs and for some expressions of a graph.
pub(crate) struct Words<'w> {
    /// The name of an input.
    pub input: &'w dyn Fn(u32) -> String,
    /// Named expressions, in a form that can be divided by.
    pub named: Vec<(String, Polynomial)>,
}

/// Longer texts are not read by anybody.
const LONGEST: usize = 72;
/// Nested calls deeper than this are cut off.
const DEEPEST: usize = 12;

impl Words<'_> {
    /// An expression as text; `None` if nobody would read it.
    pub fn of(&self, graph: &mut Graph, expr: ExprId) -> Option<String> {
        let forms = [NormalForms::default(), NormalForms::with_squares()];
        let texts = forms.into_iter().map(|mut forms| {
            let form = forms.of(graph, expr);
            self.polynomial(graph, &form, 0)
        });
        let shortest = texts.min_by_key(|text| text.chars().count())?;
        (shortest.chars().count() <= LONGEST).then_some(shortest)
    }

    /// A normal form as text.
    pub fn polynomial(&self, graph: &mut Graph, form: &Polynomial, depth: usize) -> String {
        if depth > DEEPEST {
            return "...".into();
        }
        let plain = self.sum(graph, form, depth);
        let worth = self.named.iter().map(|it| is_worth_naming(graph, &it.1)).collect::<Vec<_>>();
        let named = self.named.iter().zip(worth).filter(|it| it.1).map(|it| it.0);
        let factored =
            named.filter_map(|(name, part)| self.factored(graph, form, name, part, depth));
        let shortest = factored.min_by_key(|text| text.chars().count());
        shortest.filter(|text| text.chars().count() < plain.chars().count()).unwrap_or(plain)
    }

    /// `form` as a product: a single term, and powers of named parts.
    pub fn as_product(
        &self,
        graph: &Graph,
        form: &Polynomial,
    ) -> Option<(Polynomial, Vec<(&str, i32)>)> {
        let (mut rest, mut powers) = (form.clone(), Vec::new());
        for (name, part) in self.named.iter().filter(|it| is_worth_naming(graph, &it.1)) {
            let mut power = 0;
            while let Some(next) = rest.divided(part).filter(|it| !it.is_zero()) {
                rest = next;
                power += 1;
            }
            if power > 0 {
                powers.push((name.as_str(), power));
            }
        }
        rest.as_term()?;
        Some((rest, powers))
    }

    /// `form` as a product with powers of a named part.
    fn factored(
        &self,
        graph: &mut Graph,
        form: &Polynomial,
        name: &str,
        part: &Polynomial,
        depth: usize,
    ) -> Option<String> {
        let mut rest = form.divided(part).filter(|it| !it.is_zero())?;
        let mut power = 1;
        while let Some(next) = rest.divided(part) {
            rest = next;
            power += 1;
        }
        let text = if power == 1 { name.to_string() } else { format!("{name}^{power}") };
        let single = rest.as_term().map(|(monomial, factor)| (monomial.clone(), factor));
        Some(match single {
            Some((monomial, factor)) => {
                let sign = if factor < 0.0 { "-" } else { "" };
                sign.to_string() + &self.product(graph, &monomial, factor.abs(), Some(text), depth)
            }
            None => format!("({})*{text}", self.polynomial(graph, &rest, depth + 1)),
        })
    }

    fn sum(&self, graph: &mut Graph, form: &Polynomial, depth: usize) -> String {
        let mut terms: Vec<(&Monomial, f64)> =
            form.terms.iter().map(|(it, &factor)| (it, factor)).collect();
        // Positive terms first, constants last.
        terms.sort_by_key(|(monomial, factor)| (*factor < 0.0, monomial.is_empty()));
        let mut text = String::new();
        for (monomial, factor) in terms {
            let sign = match (text.is_empty(), factor < 0.0) {
                (true, true) => "-",
                (true, false) => "",
                (false, true) => " - ",
                (false, false) => " + ",
            };
            text += sign;
            let term =
                Polynomial::default().plus(factor.abs(), &Polynomial::product(monomial.clone()));
            text += &match form.terms.len() {
                1 => self.product(graph, monomial, factor.abs(), None, depth),
                _ => self.polynomial(graph, &term, depth + 1),
            };
        }
        if text.is_empty() { "0".into() } else { text }
    }

    fn product(
        &self,
        graph: &mut Graph,
        monomial: &Monomial,
        factor: f64,
        named: Option<String>,
        depth: usize,
    ) -> String {
        let mut above: Vec<String> = Vec::new();
        let mut below: Vec<String> = Vec::new();
        for &(atom, power) in monomial {
            let text = self.atom(graph, atom, depth);
            let side = if power > 0 { &mut above } else { &mut below };
            side.push(if power.abs() == 1 { text } else { format!("{text}^{}", power.abs()) });
        }
        above.extend(named);
        if factor != 1.0 || above.is_empty() {
            above.insert(0, number(tidy(factor)));
        }
        let above = above.join("*");
        match below.len() {
            0 => above,
            1 => format!("{above}/{}", below[0]),
            _ => format!("{above}/({})", below.join("*")),
        }
    }

    /// An atom as text.
    pub fn atom(&self, graph: &mut Graph, atom: ExprId, depth: usize) -> String {
        let (builtin, operands) = match graph.expr(atom).clone() {
            Expr::Input(position) => return (self.input)(position),
            Expr::Call(builtin, operands) => (builtin, operands),
            _ => return "_".into(),
        };
        let mut forms = NormalForms::default();
        let parts: Vec<String> = operands
            .iter()
            .map(|&operand| {
                let form = forms.of(graph, operand);
                self.polynomial(graph, &form, depth + 1)
            })
            .collect();
        match (builtin, builtin.row().notation) {
            (Builtin::SelectLe, _) => {
                format!("(if {} <= {} then {} else {})", parts[0], parts[1], parts[2], parts[3])
            }
            (_, Notation::Infix(_)) if parts[0] == "1" => format!("(1/({}))", parts[1]),
            (_, Notation::Infix(_)) => {
                format!("(({}){}({}))", parts[0], builtin.row().name, parts[1])
            }
            _ => format!("{}({})", builtin.row().name, parts.join(", ")),
        }
    }
}

/// Numbers and bare inputs are not.
fn is_worth_naming(graph: &Graph, part: &Polynomial) -> bool {
    let is_input = |atom: ExprId| matches!(graph.expr(atom), Expr::Input(_));
    match part.as_term() {
        Some((monomial, factor)) => match monomial.as_slice() {
            [] => false,
            [power] => factor != 1.0 || power.1 != 1 || !is_input(power.0),
            _ => true,
        },
        None => !part.is_zero(),
    }
}

/// A number without the dust of rounding, to be read by people.
pub(crate) fn tidy(value: f64) -> f64 {
    if value == 0.0 || !value.is_finite() {
        return value;
    }
    format!("{value:.9e}").parse().unwrap_or(value)
}
