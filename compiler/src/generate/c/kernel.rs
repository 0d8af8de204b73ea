//! A kernel in C: for one point what the machine code does for many, in the same order and with the
//! same roundings.

use super::super::schedule::{Operation, Table};
use super::super::work;
use super::Exported;
use crate::expressions::graph::builtins::{Builtin, Inline, Lowering};
use crate::expressions::graph::{ExprId, Graph};
use fdcc_runtime::problem::Pattern;

/// What a kernel for derivatives up to an order is called, and what it takes.
const KERNELS: [(&str, &str); 3] = [
    ("value", "const double *z, const double *p, double *y"),
    ("jacobian", "const double *z, const double *p, double *y, double *j"),
    (
        "hessian",
        "const double *z, const double *p, const double *l,\n        double *y, double *j, \
         double *h",
    ),
];

/// The kernel for values, for the Jacobian, too, or for everything.
pub(super) fn kernel(graph: &Graph, function: &Exported, order: usize) -> String {
    let schedule = work(graph, function.symbols, order);
    let mut body = Body { graph, names: vec![String::new(); graph.len()], lines: String::new() };
    for (id, operation) in schedule.before.iter().chain(&schedule.inside) {
        body.compute(*id, operation);
    }
    let constant = schedule.constant.iter().map(|(id, slot)| (id, std::slice::from_ref(slot)));
    for (id, slots) in schedule.varying.iter().map(|(id, it)| (id, it.as_slice())).chain(constant) {
        for slot in slots {
            let table = match slot.table {
                Table::Values => "y",
                Table::Jacobian => "j",
                Table::Hessian => "h",
            };
            body.lines += &format!("    {table}[{}] = {};\n", slot.column, body.operand(*id));
        }
    }
    let (name, parameters) = KERNELS[order];
    let unused: String = ["z", "p", "l", "y", "j", "h"]
        .iter()
        .filter(|it| parameters.contains(&format!("*{it}")))
        .filter(|it| !body.lines.contains(&format!("{it}[")))
        .map(|it| format!("    (void)({it});\n"))
        .collect();
    let export = "CASADI_SYMBOL_EXPORT void";
    format!("{export} {}_{name}({parameters}) {{\n{}{unused}}}\n\n", function.name, body.lines)
}

/// Statements in the making.
struct Body<'g> {
    graph: &'g Graph,
    /// What a node is called, by node.
    names: Vec<String>,
    lines: String,
}

impl Body<'_> {
    /// What stands for a node in an expression.
    fn operand(&self, id: ExprId) -> String {
        match self.graph.as_number(id) {
            Some(number) => literal(number),
            None => self.names[id.index()].clone(),
        }
    }

    fn compute(&mut self, id: ExprId, operation: &Operation) {
        let operands: Vec<String> =
            operation.operands().iter().map(|&it| self.operand(it)).collect();
        let a = |which: usize| operands[which].as_str();
        let value = match operation {
            Operation::Point(at) => return self.name(id, format!("z[{at}]")),
            Operation::Parameter(at) => return self.name(id, format!("p[{at}]")),
            Operation::Multiplier(at) => return self.name(id, format!("l[{at}]")),
            Operation::Call(builtin, _) => call(*builtin, &operands),
            Operation::MultiplyAdd(_) => format!("FDCC_FMA({}, {}, {})", a(0), a(1), a(2)),
            Operation::MultiplySubtract(_) => format!("FDCC_FMA({}, {}, -{})", a(0), a(1), a(2)),
            Operation::SubtractProduct(_) => format!("FDCC_FMA(-{}, {}, {})", a(0), a(1), a(2)),
        };
        let name = format!("v{}", id.index());
        self.lines += &format!("    const double {name} = {value};\n");
        self.name(id, name);
    }

    fn name(&mut self, id: ExprId, name: String) {
        self.names[id.index()] = name;
    }
}

/// A builtin of these operands; a function of the language that C has, too, has the same name
/// there.
fn call(builtin: Builtin, a: &[String]) -> String {
    let row = builtin.row();
    let infix = || format!("{} {} {}", a[0], row.name, a[1]);
    let function = |name: &str| format!("{name}({})", a.join(", "));
    match row.lowering {
        Lowering::Inline(Inline::Add | Inline::Sub | Inline::Mul | Inline::Div) => infix(),
        Lowering::Inline(Inline::Neg) => format!("-{}", a[0]),
        Lowering::Inline(Inline::Abs) => function("fabs"),
        Lowering::Inline(Inline::Min) => function("fdcc_min"),
        Lowering::Inline(Inline::Max) => function("fdcc_max"),
        Lowering::Inline(Inline::SelectLe) => {
            format!("{} <= {} ? {} : {}", a[0], a[1], a[2], a[3])
        }
        _ => match builtin {
            Builtin::Pow => function("pow"),
            Builtin::LogCosh => function("fdcc_log_cosh"),
            _ => function(row.name),
        },
    }
}

/// A number that C reads back to the same bits.
pub(super) fn literal(number: f64) -> String {
    let magnitude = match number.abs() {
        size if size.is_nan() => return "NAN".into(),
        size if size.is_infinite() => "INFINITY".into(),
        size => format!("{size:?}"),
    };
    if number.is_sign_negative() { format!("(-{magnitude})") } else { magnitude }
}

/// The patterns of the derivatives, as `rows, columns, entries, row, column, row, column, ...`.
pub(super) fn patterns(function: &Exported) -> String {
    if !function.is_active() {
        return String::new();
    }
    let pattern = |what: &str, pattern: &Pattern| {
        let Pattern { rows, columns, entries } = pattern;
        let head = [*rows, *columns, entries.len()].into_iter();
        let places = entries.iter().flat_map(|it| [it.0 as usize, it.1 as usize]);
        let numbers: Vec<usize> = head.chain(places).collect();
        let list = super::interface::list(&numbers);
        let (name, length) = (&function.name, numbers.len());
        let array = format!("const int {name}_{what}_pattern[{length}]");
        format!("CASADI_SYMBOL_EXPORT extern {array};\n{array} = {list};\n")
    };
    pattern("jacobian", function.jacobian()) + &pattern("hessian", function.hessian()) + "\n"
}
