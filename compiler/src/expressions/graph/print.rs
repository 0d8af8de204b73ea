//! Readable infix text: one line for each root, with nodes that are used more than once named `v1`,
//! `v2`, ...

use super::builtins::{Builtin, Notation};
use super::{Expr, ExprId, Graph};
use std::collections::HashMap;

/// Longer texts get a name of their own, also if they are used only once.
const LONGEST_TEXT: usize = 72;
/// Binds most tightly: names, numbers, calls.
const ATOM: u8 = 9;
/// Products, quotients and signs.
const PREFIX: u8 = 2;

/// The roots as lines `name = text`, after the lines of what they share.
pub fn print(graph: &Graph, roots: &[(String, ExprId)], input: &dyn Fn(u32) -> String) -> String {
    let ids: Vec<ExprId> = roots.iter().map(|(_, id)| *id).collect();
    let mut printer =
        Printer { graph, input, texts: HashMap::new(), lines: String::new(), named: 0 };
    let needed = graph.reachable(&ids);
    let uses = count_uses(graph, &needed);
    needed.iter().for_each(|&id| printer.node(id, uses[&id]));
    for (name, id) in roots {
        let text = &printer.texts[id].0;
        printer.lines += &format!("{name} = {text}\n");
    }
    printer.lines
}

fn count_uses(graph: &Graph, needed: &[ExprId]) -> HashMap<ExprId, usize> {
    let mut uses: HashMap<ExprId, usize> = needed.iter().map(|&id| (id, 0)).collect();
    for operand in needed.iter().flat_map(|&id| graph.operands(id)) {
        *uses.entry(*operand).or_default() += 1;
    }
    uses
}

struct Printer<'a> {
    graph: &'a Graph,
    input: &'a dyn Fn(u32) -> String,
    /// Text and how tightly it binds.
    texts: HashMap<ExprId, (String, u8)>,
    lines: String,
    named: usize,
}

impl Printer<'_> {
    fn node(&mut self, id: ExprId, uses: usize) {
        let (mut text, mut binding) = match self.graph.expr(id) {
            Expr::Number(bits) => number(bits.value()),
            Expr::Input(position) => ((self.input)(*position), ATOM),
            Expr::Multiplier(output) => (format!("lambda[{output}]"), ATOM),
            Expr::Call(builtin, operands) => self.call(*builtin, operands),
        };
        let shared = uses > 1 && !self.is_small(id);
        if shared || (uses > 0 && text.len() > LONGEST_TEXT) {
            self.named += 1;
            let name = format!("v{}", self.named);
            self.lines += &format!("{name} = {text}\n");
            (text, binding) = (name, ATOM);
        }
        self.texts.insert(id, (text, binding));
    }

    /// Leaves and their negatives are not worth a name.
    fn is_small(&self, id: ExprId) -> bool {
        match self.graph.expr(id) {
            Expr::Call(Builtin::Neg, operands) => !self.graph.expr(operands[0]).is_call(),
            expr => !expr.is_call(),
        }
    }

    fn call(&self, builtin: Builtin, operands: &[ExprId]) -> (String, u8) {
        let row = builtin.row();
        match row.notation {
            _ if builtin == Builtin::Mul => (self.product(operands[0], operands[1]), PREFIX),
            Notation::Infix(binding) => {
                (self.infix(row.name, binding, operands[0], operands[1]), binding)
            }
            Notation::Prefix => (format!("{}{}", row.name, self.text(operands[0], ATOM)), PREFIX),
            _ if builtin == Builtin::SelectLe => (self.selection(operands), 0),
            _ => (format!("{}({})", row.name, self.list(operands)), ATOM),
        }
    }

    /// A product with a reciprocal that has no name is shown as the quotient it was made from.
    fn product(&self, a: ExprId, b: ExprId) -> String {
        match (self.denominator(b), self.denominator(a)) {
            (Some(denominator), _) => self.infix("/", PREFIX, a, denominator),
            (_, Some(denominator)) => self.infix("/", PREFIX, b, denominator),
            _ => self.infix("*", PREFIX, a, b),
        }
    }

    fn denominator(&self, id: ExprId) -> Option<ExprId> {
        let operands = self.graph.as_call(id, Builtin::Div)?;
        (self.texts[&id].1 != ATOM).then_some(operands[1])
    }

    /// The right operand of `-`, `/` and `^` must bind more tightly than the operator, and the left
    /// one of `^`.
    fn infix(&self, operator: &str, binding: u8, a: ExprId, b: ExprId) -> String {
        let right = if matches!(operator, "+" | "*") { binding } else { binding + 1 };
        let left = if operator == "^" { binding + 1 } else { binding };
        format!("{} {operator} {}", self.text(a, left), self.text(b, right))
    }

    fn selection(&self, operands: &[ExprId]) -> String {
        let [a, b, x, y] = [0, 1, 2, 3].map(|operand| self.text(operands[operand], 1));
        format!("if {a} <= {b} then {x} else {y}")
    }

    fn list(&self, operands: &[ExprId]) -> String {
        let texts: Vec<String> = operands.iter().map(|&operand| self.text(operand, 0)).collect();
        texts.join(", ")
    }

    /// In brackets if it binds less tightly than its place asks for.
    fn text(&self, id: ExprId, place: u8) -> String {
        let (text, binding) = &self.texts[&id];
        if *binding < place { format!("({text})") } else { text.clone() }
    }
}

/// Plain digits where they are few.
fn number(value: f64) -> (String, u8) {
    let few = value == 0.0 || (1e-4..1e7).contains(&value.abs());
    let text = if few { value.to_string() } else { format!("{value:e}") };
    (text, if value < 0.0 { PREFIX } else { ATOM })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn text(build: impl Fn(&mut Graph, ExprId, ExprId) -> ExprId) -> String {
        let mut graph = Graph::new();
        let (x, y) = (graph.input(0), graph.input(1));
        let root = build(&mut graph, x, y);
        print(&graph, &[("f".into(), root)], &|position| ["x", "y"][position as usize].into())
    }

    #[test]
    fn brackets_stand_where_they_are_needed() {
        assert_eq!(
            text(|g, x, y| {
                let d = g.sub(x, y);
                g.mul(d, y)
            }),
            "f = y * (x - y)\n"
        );
        assert_eq!(
            text(|g, x, y| {
                let d = g.sub(x, y);
                g.sub(y, d)
            }),
            "f = y - (x - y)\n"
        );
        assert_eq!(
            text(|g, x, y| {
                let p = g.mul(x, y);
                g.add(p, y)
            }),
            "f = y + x * y\n"
        );
    }

    #[test]
    fn a_quotient_is_shown_as_one() {
        assert_eq!(text(|g, x, y| g.div(x, y)), "f = x / y\n");
    }

    #[test]
    fn what_is_used_twice_gets_a_name() {
        assert_eq!(
            text(|g, x, _| {
                let s = g.sin(x);
                g.square(s)
            }),
            "v1 = sin(x)\nf = v1 * v1\n"
        );
    }
}
